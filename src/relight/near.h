// near.h - lights whose direction differs from pixel to pixel
#ifndef RELIGHT_NEAR_H
#define RELIGHT_NEAR_H

#include "image/curve.h"

#include <relume/relight.h>

// A point-like light, or a facet of an area light.
struct emitter {
    const struct relume_light *light;  // or NULL
    struct relume_light_patch facet;
};

struct near {
    const struct relume_codes *codes;
    const relume_weight_grid *grid;
    const struct relume_image *surface;
    const struct curve *display;  // of display-domain codes, else NULL
    int count;
    struct emitter *emitter;
};

// Cut the near ones of `lights` into emitters. Everything is borrowed. RELUME_ENOMEM.
relume_status near_create(struct near *near, const struct relume_light *lights, int n);
void near_destroy(struct near *near);

// Add what they give to the `n` pixels from `first` on: out[n][3], linear. `room` has near_room
// floats.
size_t near_room(const struct near *near);
void near_add(const struct near *near, size_t first, size_t n, float *out, float *room);

#endif
