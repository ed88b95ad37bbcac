// learnt.c - what was learnt of the pixels of a view, as few coded bytes
#include "format/pack/learnt.h"

#include "core/base/memory.h"
#include "format/pack/views.h"

#include <float.h>
#include <math.h>

// Of libaom's 63. Finer than 12 takes twice the bytes for 0.02 dB; coarser is seen as lost
// highlights, and is what models that are mostly noise are left with.
enum { FINEST = 12, COARSEST = 60, COARSER = 8 };

// From a number to what has even steps, and back.
enum curve {
    CURVE_NONE,
    CURVE_ROOT,     // x |x|: colours, and what becomes small
    CURVE_PARTED,   // as CURVE_ROOT, but both signs keep away from each other: they are two kinds
    CURVE_DOUBLING  // 2^x, and infinity
};

// Steps are no finer than this.
struct channel {
    enum curve curve;
    float step;
};

static const struct channel channels[][LEARNT] = {
    [LEARNT_SHADOW] = {[RELUME_SHADOW_THICK] = {CURVE_DOUBLING, 1.0f / 256},
                       [RELUME_SHADOW_COLOUR] = {CURVE_ROOT, 1.0f / 1024},
                       {CURVE_ROOT, 1.0f / 1024},
                       {CURVE_ROOT, 1.0f / 1024},
                       [RELUME_SHADOW_MATTE] = {CURVE_ROOT, 1.0f / 1024},
                       {CURVE_ROOT, 1.0f / 1024},
                       {CURVE_ROOT, 1.0f / 1024},
                       {CURVE_ROOT, 1.0f / 1024}},
    [LEARNT_GLOSS] = {[RELUME_GLOSS_COLOUR] = {CURVE_ROOT, 1.0f / 2048},
                      {CURVE_ROOT, 1.0f / 2048},
                      {CURVE_ROOT, 1.0f / 2048},
                      [RELUME_GLOSS_NORMAL] = {CURVE_NONE, 1.0f / 4096},
                      {CURVE_NONE, 1.0f / 4096},
                      [RELUME_GLOSS_ROUGHNESS] = {CURVE_NONE, 1.0f / 4096},
                      [RELUME_GLOSS_SHINE] = {CURVE_PARTED, 1.0f / 2048},
                      [RELUME_GLOSS_SHARE] = {CURVE_NONE, 1.0f / 1024}},
};

// Codes above END are infinite; coding errs by less than what lies between it and TOP.
enum { TOP = AV1_TOP, END = AV1_TOP - 96, INFINITE = AV1_TOP - 48 };
static const float APART = 0.125f, LEAST_LOG = -20.0f, MOST_LOG = 40.0f;

static bool can_be(float value, enum curve curve)
{
    return curve == CURVE_DOUBLING ? value >= 0.0f : isfinite(value) != 0;
}

static float to_even(float value, enum curve curve)
{
    const float root = sqrtf(fabsf(value));
    switch (curve) {
    case CURVE_NONE: return value;
    case CURVE_ROOT: return copysignf(root, value);
    case CURVE_PARTED: return copysignf(root + APART, value);
    case CURVE_DOUBLING: break;
    }
    return fminf(fmaxf(log2f(value), LEAST_LOG), MOST_LOG);
}

static float from_even(float x, enum curve curve)
{
    const float root = fmaxf(fabsf(x) - APART, 0.0f);
    switch (curve) {
    case CURVE_NONE: return x;
    case CURVE_ROOT: return x * fabsf(x);
    case CURVE_PARTED: return copysignf(root * root, x);
    case CURVE_DOUBLING: break;
    }
    return exp2f(x);
}

// RELUME_EINVAL for numbers that cannot be.
static relume_status find_steps(struct learnt_steps *out, const struct relume_image *model,
                                const struct channel *channel)
{
    const size_t n = (size_t)model->width * (size_t)model->height;
    for (int c = 0; c < LEARNT; c++) {
        float least = FLT_MAX, most = -FLT_MAX;
        for (size_t i = 0; i < n; i++) {
            const float value = model->data[i * LEARNT + (size_t)c];
            const float x = to_even(value, channel[c].curve);
            if (!can_be(value, channel[c].curve))
                return RELUME_EINVAL;
            if (isinf(value))
                continue;
            least = fminf(least, x);
            most = fmaxf(most, x);
        }
        out->offset[c] = least <= most ? least : 0.0f;
        out->scale[c] = fmaxf(channel[c].step, (most - out->offset[c]) / END);
        if (!isfinite(out->scale[c]))
            return RELUME_EINVAL;
    }
    return RELUME_OK;
}

relume_status learnt_encode(struct lossy_words *out, struct learnt_steps *steps,
                            const struct relume_image *model, enum learnt_kind kind, double bytes,
                            int threads, const struct relume_log *log)
{
    const struct channel *channel = channels[kind];
    const size_t n = (size_t)model->width * (size_t)model->height;
    const struct lossy_shape shape = {model->width, model->height, LEARNT, false, NULL, NULL};
    uint16_t *codes = mem_array(n * LEARNT, sizeof *codes);
    *out = (struct lossy_words){0};
    relume_status status = codes ? find_steps(steps, model, channel) : RELUME_ENOMEM;
    for (int c = 0; !status && c < LEARNT; c++)
        for (size_t i = 0; i < n; i++) {
            const float value = model->data[i * LEARNT + (size_t)c];
            const float x = to_even(value, channel[c].curve);
            codes[(size_t)c * n + i] =
                isinf(value) ? TOP : (uint16_t)rintf((x - steps->offset[c]) / steps->scale[c]);
        }
    for (int q = FINEST; !status && q <= COARSEST; q += COARSER) {
        const struct av1_effort effort = {q * AV1_STEPS, AV1_GOOD_3_SCREEN};
        mem_free(out->word);
        status = lossy_encode_codes(out, codes, &shape, &effort, threads, log);
        if (4.0 * (double)out->count <= bytes)
            break;
    }
    mem_free(codes);
    return status;
}

relume_status learnt_decode(struct relume_image *model, const struct lossy_words *words,
                            const struct learnt_steps *steps, enum learnt_kind kind, int threads)
{
    const struct channel *channel = channels[kind];
    const size_t n = (size_t)model->width * (size_t)model->height;
    const struct lossy_shape shape = {model->width, model->height, LEARNT, false, NULL, NULL};
    const struct relume_rect all = {0, 0, model->width, model->height};
    uint16_t *codes = mem_array(n * LEARNT, sizeof *codes);
    if (!codes)
        return RELUME_ENOMEM;
    const relume_status status = lossy_decode(codes, &shape, &all, words, NULL, threads, NULL);
    for (int c = 0; !status && c < LEARNT; c++)
        for (size_t i = 0; i < n; i++) {
            const uint16_t code = codes[(size_t)c * n + i];
            const float x = (float)code * steps->scale[c] + steps->offset[c];
            const bool infinite = channel[c].curve == CURVE_DOUBLING && code > INFINITE;
            model->data[i * LEARNT + (size_t)c] =
                infinite ? INFINITY : from_even(x, channel[c].curve);
        }
    mem_free(codes);
    return status;
}
