// model_gbrdf.h - the maps of a model that is a g-BRDF
#ifndef BTF_MODEL_MODEL_GBRDF_H
#define BTF_MODEL_MODEL_GBRDF_H

#include "material/gbrdf/gbrdf.h"
#include "material/model/model.h"

// They belong to the model.
struct gbrdf_maps gbrdf_maps_of(const relume_btf_fitted *m);
// Arrays for as many materials as `maps` have, with these in them. RELUME_ENOMEM.
relume_status gbrdf_maps_store(relume_btf_fitted *m, const struct gbrdf_maps *maps);

// A g-BRDF of directions and maps, ready to be shown. RELUME_ENOMEM.
struct gbrdf_directions {
    const vec3 *view, *light;
    int views, lights;
    bool without_cosine;
};
relume_status gbrdf_model_create(relume_btf_fitted **out, const struct gbrdf_maps *maps,
                                 const struct gbrdf_directions *directions,
                                 const struct relume_log *log);
// The same of one set for views and lights; NULL: bonn.
relume_status gbrdf_model_of_set(relume_btf_fitted **out, const struct gbrdf_maps *maps,
                                 const struct relume_btf_set *set, const struct relume_log *log);

#endif
