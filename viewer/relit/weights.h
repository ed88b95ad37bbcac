// weights.h - lights folded into one number for each plane and channel (Wong 1998, Eq. 7.6)
//
// The layout is that of the texture which relight.frag reads: [layer][channel][lane], where a layer
// holds LANES planes of the view side by side in one texel. Three more channels give the pixel's
// colour where the coder is a luminance coder.
#ifndef VIEWER_WEIGHTS_H
#define VIEWER_WEIGHTS_H

#include <relume/relight/relight.h>

enum { LANES = 4, CHANNELS = 6 };

struct weights {
    int layers;
    float *plane;       // [layers][CHANNELS][LANES]
    float constant[3];  // added to the dot product
    float colour[3];    // added to the colour's; 1 where there is none
    float *basis;       // scratch: 3 K values of the coder
};

// Memory for `planes` planes of codes by `coder`, all 0. RELUME_ENOMEM.
relume_status weights_create(struct weights *weights, const relume_coder *coder, int planes);
void weights_destroy(struct weights *weights);
void weights_clear(struct weights *weights);
// Add a light of value `rgb` in `direction` (any length but 0). The shader sees a code divided by
// `unit`; scale and offset of `codes` are folded in, its planes are not looked at.
void weights_add(struct weights *weights, const struct relume_codes *codes, double unit,
                 struct relume_vec3 direction, const float rgb[3]);
// Add an environment light; `grid` is of the coder.
void weights_add_environment(struct weights *weights, const struct relume_codes *codes, double unit,
                             const relume_weight_grid *grid, const struct relume_light *light);

#endif
