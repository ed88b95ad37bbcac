// gloss.h - a view whose highlights wander: what its pixels show by their normal, colour and gloss
//
// f(L) = c n.L + s pi D V n.L with D of GGX, V of Smith (src/material/maps/ggx.h), Fresnel's term
// taken where it is constant: seen from above, the half vector is within 45 degrees of the eye.
#ifndef SHADOW_GLOSS_H
#define SHADOW_GLOSS_H

#include "core/math/vec.h"

#include <relume/format/coder.h>
#include <relume/image.h>
#include <relume/light.h>

// What pixel[RELUME_GLOSS_CHANNELS] shows under a light, its share left aside: at most 1, as
// photographs do.
void gloss_shown(float rgb[3], const float *pixel, vec3 light);

// What wanders of f: f(L) less what lies between the captured lights, by their weights and in the
// domain of the codes (`display`: its curve, or NULL for linear light).
struct gloss_light {
    vec3 light;
    int captured;         // how many of
    const vec3 *from;     // [captured]
    const float *weight;  // [captured]
    const struct relume_transfer *display;
};
void gloss_wanders(float rgb[3], const float *pixel, const struct gloss_light *l);

// Adds what wanders under a light of value `rgb` to a picture of `model` from (left, top) on.
void gloss_add(struct relume_image *more, int left, int top, const struct relume_image *model,
               const struct gloss_light *light, const float rgb[3], int threads);

#endif
