// guide.h - planes of linear light in steps that grow with the brightness of a pixel
//
// Eyes and displays see a dark place err twelve times as much as a white one, and 8 bits of linear
// light are too few for a room that is mostly dark. So the planes are turned until the first is the
// mean of the pictures under all lights, and zero in all of them is black; then a pixel's steps are
// those of a square root of that:
//     C_0 = u_0 h, C_k = u_k h, h = knee + |u_0|
// u being what is coded. A page multiplies the sum of its planes by h once a light.
#ifndef PUBLISH_GUIDE_H
#define PUBLISH_GUIDE_H

#include "exchange/foreign/planes.h"
#include "exchange/foreign/principal.h"

#include <math.h>

// Where steps stop getting smaller. Tried on a dark room: 0.02, 0.04, 0.08 and 0.2 are 0.66, 0.71,
// 0.85 and 1.23 of 255 off on the mean, in 1.29, 1.26, 1.20 and 1.04 MB.
#define GUIDE_KNEE 0.03f
// The error of such codes in decibels of u, less that of the picture in those of sRGB.
#define GUIDE_DB 4.5

// u_0 of C_0.
static inline float guide_root(float c)
{
    const float u = 0.5f * (sqrtf(GUIDE_KNEE * GUIDE_KNEE + 4.0f * fabsf(c)) - GUIDE_KNEE);
    return copysignf(u, c);
}

static inline float guide_gain(float u)
{
    return GUIDE_KNEE + fabsf(u);
}

// Components of the pictures of `s`, which has `mean`: turned until the first is the brightness;
// the mean becomes black. RELUME_ENOMEM.
relume_status guide_turn(struct principal *components, double *mean, const struct source *s,
                         const struct relume_vec3 *lights, const double *shares, int count);

// Planes C become u in place; only their ranges become those of u.
void guide_divide(struct planes *p);
void guide_find_ranges(struct planes *p, int threads);

#endif
