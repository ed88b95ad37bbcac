// curve.h - display codes to linear light, fast enough for every pixel of every light
#ifndef IMAGE_CURVE_H
#define IMAGE_CURVE_H

#include <relume/image.h>

enum { CURVE_STEPS = 4096 };

// The curve on [0, 1] as straight pieces, closer than 1e-7 to sRGB and gammas from 2 on (1e-5 for
// gammas near 1), and of a logarithm to 2.5e-6 of the light and delta; elsewhere the curve itself.
struct curve {
    struct relume_transfer transfer;
    bool exact;  // steep at 0, where straight pieces fail: gamma below 1
    float value[CURVE_STEPS + 2];
};

static inline void curve_init(struct curve *c, struct relume_transfer transfer)
{
    c->transfer = transfer;
    c->exact = transfer.curve == RELUME_CURVE_GAMMA && transfer.gamma < 1.0f;
    for (int i = 0; i < CURVE_STEPS + 2; i++)
        c->value[i] = relume_transfer_decode(transfer, (float)i / CURVE_STEPS);
}

static inline float curve_decode(const struct curve *c, float code)
{
    if (c->exact || !(code >= 0.0f && code <= 1.0f))
        return relume_transfer_decode(c->transfer, code);
    const float x = code * CURVE_STEPS;
    const int i = (int)x;
    return c->value[i] + (x - (float)i) * (c->value[i + 1] - c->value[i]);
}

#endif
