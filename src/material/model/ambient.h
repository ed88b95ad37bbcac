// btf_environment.h - the inside of prefiltered environments, and how models are lit by them
#ifndef BTF_MODEL_AMBIENT_H
#define BTF_MODEL_AMBIENT_H

#include "material/btf/values.h"
#include "material/model/environment.h"
#include "material/model/model.h"
#include "relight/light/environment.h"

struct relume_prefiltered_maps {
    int width, height;
    double rim;
    float *diffuse, *specular, *part;
    struct relume_environment_cell *cell;  // in the world: E dw / pi
    int cells;
    struct relume_prefiltered_maps_info info;  // of the above
};

// Maps of `cells`, a copy of which they keep; nothing is cut off at a horizon. RELUME_ENOMEM.
relume_status prefiltered_from_cells(relume_prefiltered_maps **out,
                                     const struct relume_environment_cell *cell, int cells,
                                     int height, double rim, int threads);

struct relume_btf_oriented_light {
    const relume_btf_fitted *model;
    const relume_prefiltered_maps *prefiltered;
    relume_prefiltered_maps *own;  // of this orientation, in the frame of the sample, or NULL
    struct relume_btf_frame frame;
    float *weight;     // [lights][3]
    float even[2][3];  // of a constant, and of n.l: ambient_even
};

// What a constant in place of a lobe shows; `cosine`: it is multiplied by n.l.
void ambient_even(const relume_btf_oriented_light *a, bool cosine, float rgb[3]);

// What a lobe of a model, in the frame of the sample, shows; `cosine`: the same.
void ambient_lobe(const relume_btf_oriented_light *a, const float t[3], float exponent, bool cosine,
                  float rgb[3]);

// The value under the environment from a view that is blended already.
void ambient_blend(const relume_btf_oriented_light *a, const relume_btf_fitted *level, size_t texel,
                   const struct relume_direction_blend *view, float rgb[3]);

struct relume_btf_environment {
    const relume_btf_fitted *model;
    const relume_prefiltered_maps *prefiltered;
    struct relume_btf_light_lobe *cone;  // [lights]
};

// What a model that has `lit` is asked for, in one orientation.
struct relume_btf_oriented_light sky_ambient(const relume_btf_environment *sky,
                                             const struct relume_btf_frame *frame);

#endif
