// fields.h - reflectance fields with non-linear lobes (thesis, Eq. 3.1): for each measured view
//     RF_v(l) ~ rho_d + rho_v * sum_j max(0, t_vj . l)^n_vj
// rho_d is one for all views; lobes are of luminance, the two rho give the colour.
#ifndef BTF_MODEL_FIELDS_H
#define BTF_MODEL_FIELDS_H

#include "material/model/environment.h"
#include "material/model/lobes.h"

// The arrays of a model that keeps fields, `entries` of them: 6 bytes each and 38 a view with two
// lobes (thesis, Tab. 3.3).
enum { FIELD_DIFFUSE, FIELD_SPECULAR, FIELD_LOBE, FIELD_ARRAYS };
void fields_layout(relume_btf_fitted *m, size_t entries, bool each);

// What all fits of one set of lights share. Freed with fields_end.
struct fields {
    relume_btf_fitted *m;
    double (*light)[3];
    int (*near)[6];     // the lights around each
    double inverse[9];  // of sum l l', for the first lobe
};
relume_status fields_start(struct fields *s, relume_btf_fitted *m);
void fields_end(struct fields *s);

// Fit entry `entry` to values [view][light][3]; false: no memory. Safe on several cores.
bool fields_fit(const struct fields *s, size_t entry, const float *values);

// For three views: the colours, and for each lobe a scalar product, a power, a sum.
struct relume_btf_cost fields_cost(const relume_btf_fitted *m);
void fields_eval(const relume_btf_fitted *m, size_t entry, const struct model_at *at, float rgb[3]);
void fields_lit(const relume_btf_fitted *m, size_t entry, const struct model_at *at,
                const struct relume_btf_oriented_light *ambient, float rgb[3]);

#endif
