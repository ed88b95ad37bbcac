// encoder.h - linear light to display codes, fast enough for every pixel of every light
#ifndef IMAGE_ENCODER_H
#define IMAGE_ENCODER_H

#include "image/image/power.h"

#include <relume/image.h>

// Within 1e-7 of the curve on [0, 2), elsewhere the curve itself. Large: one a job, not a pixel.
struct encoder {
    struct relume_transfer transfer;
    struct relume_transfer from;  // LINEAR, or the curve of the codes that it begins with
    float toe;                    // up to here the curve is a line, or steep: not in the table
    float slope;                  // of that line; 0: ask the curve
    float top;  // end of the table; 0 where there is none: linear, log, gamma below 1
    float part[POWER_OCTAVES * POWER_STEPS][4];
};

static inline void encoder_init(struct encoder *e, struct relume_transfer transfer)
{
    const bool gamma = transfer.curve == RELUME_CURVE_GAMMA;
    const bool linear = transfer.curve == RELUME_CURVE_LINEAR;
    const bool log = transfer.curve == RELUME_CURVE_LOG;
    struct power power;
    e->transfer = transfer;
    e->from = (struct relume_transfer){.curve = RELUME_CURVE_LINEAR};
    e->toe = linear || log ? (float)POWER_MAX : gamma ? (float)POWER_MIN : 0.0031308f;
    e->slope = linear ? 1.0f : gamma || log ? 0.0f : 12.92f;
    e->top = linear || log || (gamma && transfer.gamma < 1.0f) ? 0.0f : (float)POWER_MAX;
    if (e->top == 0.0f)
        return;
    power_init(&power, gamma ? 1.0 / (double)transfer.gamma : 1.0 / 2.4);
    for (int i = 0; i < POWER_OCTAVES * POWER_STEPS; i++)
        for (int k = 0; k < 3; k++)
            e->part[i][k] =
                (float)(gamma ? power.part[i][k] : 1.055 * power.part[i][k] - (k ? 0.0 : 0.055));
}

// What begins with codes of the curve `from`, and shows them.
static inline void encoder_init_from(struct encoder *e, struct relume_transfer from,
                                     struct relume_transfer transfer)
{
    encoder_init(e, transfer);
    e->from = from;
}

static inline float encoder_look_up(const struct encoder *e, float v)
{
    enum { MANTISSA = 23, STEP_BITS = 7, SHIFT = MANTISSA - STEP_BITS };
    uint32_t bits;
    memcpy(&bits, &v, sizeof bits);
    const float *c = e->part[(bits >> SHIFT) - ((127 - 9) << STEP_BITS)];
    const float u = (float)(bits & ((1u << SHIFT) - 1)) * (1.0f / (1u << SHIFT));
    return c[0] + u * (c[1] + u * c[2]);
}

static inline void encoder_apply(const struct encoder *e, const float *linear, float *code, int n)
{
    if (e->from.curve != RELUME_CURVE_LINEAR) {
        for (int i = 0; i < n; i++)
            code[i] = relume_transfer_decode(e->from, linear[i]);
        linear = code;
    }
    for (int i = 0; i < n; i++) {
        const float v = linear[i];
        if (v > e->toe && v < e->top)
            code[i] = encoder_look_up(e, v);
        else if (v <= e->toe && v >= 0.0f && e->slope > 0.0f)
            code[i] = e->slope * v;
        else
            code[i] = relume_transfer_encode(e->transfer, v);
    }
}

static inline float encoder_clip(float v)
{
    return v > 1.0f ? 1.0f : v > 0.0f ? v : 0.0f;
}

// The 8-bit code of a clipped display value.
static inline int encoder_code(float display)
{
    return (int)(display * 255.0f + 0.5f);
}

#endif
