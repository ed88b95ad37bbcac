// near_lights.h - lights whose direction differs from pixel to pixel
#ifndef RELIGHT_NEAR_LIGHTS_H
#define RELIGHT_NEAR_LIGHTS_H

#include "image/image/curve.h"
#include "relight/light/environment.h"

#include <relume/relight/relight.h>

// A point-like light, or a patch of an area light.
struct near_source {
    const struct relume_light *light;  // or NULL
    struct relume_light_patch patch;
};

struct near_lights {
    const struct relume_codes *codes;
    const relume_weight_grid *grid;
    const struct relume_image *surface;
    const struct curve *display;  // of display-domain codes, else NULL
    const struct relume_log *log;
    int count;
    struct near_source *source;
};

// Cut the near ones of `lights` into sources. Everything is borrowed. RELUME_ENOMEM.
relume_status near_lights_create(struct near_lights *near, const struct relume_light *lights,
                                 int n);
void near_lights_destroy(struct near_lights *near);

// Add what they give to the `n` pixels from `first` on: out[n][3], linear. `scratch` has
// near_lights_scratch floats.
size_t near_lights_scratch(const struct near_lights *near);
void near_lights_add(const struct near_lights *near, size_t first, size_t n, float *out,
                     float *scratch);

#endif
