// tone.c - tone operators: constant tables of curves from linear light to [0, 1]
#include <relume/relight/tone.h>

#include "core/base/params.h"

#include "core/math/float_steps.h"
#include "core/math/luminance.h"

#include <math.h>
#include <string.h>

// NaN becomes 0.
static float clip(float x)
{
    const float above = x > 0.0f ? x : 0.0f;
    return above < 1.0f ? above : 1.0f;
}

// ---------------------------------------------------------------- operators

static void tone_linear(float out[3], const float rgb[3], float white)
{
    (void)white;
    for (int c = 0; c < 3; c++)
        out[c] = clip(rgb[c]);
}

// Reinhard, Stark, Shirley, Ferwerda 2002, Eq. 4; colours keep their hue until a channel clips.
static void tone_reinhard(float out[3], const float rgb[3], float white)
{
    const float l = fmaxf(luminance_709f(rgb), 0.0f);
    const float scale = (1.0f + l / (white * white)) / (1.0f + l);
    for (int c = 0; c < 3; c++)
        out[c] = clip(rgb[c] * scale);
}

// Narkowicz 2015, "ACES filmic tone mapping curve": a fit of the ACES reference transform.
static void tone_filmic(float out[3], const float rgb[3], float white)
{
    const float a = 2.51f, b = 0.03f, c = 2.43f, d = 0.59f, e = 0.14f;
    const float most = 65504.0f;  // keeps the squares finite; the curve is flat there
    (void)white;
    for (int k = 0; k < 3; k++) {
        const float x = fminf(fmaxf(rgb[k], 0.0f), most);
        out[k] = clip(x * (a * x + b) / (x * (c * x + d) + e));
    }
}

// Ritschel 2009, 8.4.4: the picture is shown with a gamma of 2.2, here through the sRGB curve that
// comes after it: what that curve makes x^(1 / 2.2) of.
static void tone_gamma(float out[3], const float rgb[3], float white)
{
    (void)white;
    for (int k = 0; k < 3; k++) {
        const float coded = powf(clip(rgb[k]), 1.0f / 2.2f);
        out[k] = coded <= 0.04045f ? coded / 12.92f : powf((coded + 0.055f) / 1.055f, 2.4f);
    }
}

const struct relume_tone relume_tone_linear = {"linear", "clipped at 1", tone_linear};
const struct relume_tone relume_tone_reinhard = {
    "reinhard", "highlights of up to the white luminance are compressed", tone_reinhard};
const struct relume_tone relume_tone_filmic = {"filmic", "the S-shaped curve of film (ACES)",
                                               tone_filmic};
const struct relume_tone relume_tone_gamma = {
    "gamma", "clipped at 1, a gamma of 2.2 in place of the sRGB curve", tone_gamma};
const struct relume_tone *const relume_tones[] = {
    &relume_tone_linear, &relume_tone_reinhard, &relume_tone_filmic, &relume_tone_gamma, NULL,
};

relume_status relume_tone_apply(struct relume_image *image, const struct relume_tone_params *params)
{
    const struct relume_tone_params p = PARAMS(relume_tone_params, params);
    const struct relume_tone *tone = p.tone ? p.tone : &relume_tone_linear;
    const float white = (float)(p.white != 0.0 ? p.white : RELUME_TONE_WHITE);
    const float gain = (float)exp2(p.exposure_ev);
    if (!image->data || image->channels != 3 || !(white > 0.0f))
        return RELUME_EINVAL;
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    if (tone->apply == tone_linear) {  // which compilers vectorise by itself
        for (size_t i = 0; i < 3 * pixels; i++)
            image->data[i] = clip(gain * image->data[i]);
        return RELUME_OK;
    }
    for (size_t i = 0; i < pixels; i++) {
        float *at = image->data + 3 * i;
        const float rgb[3] = {gain * at[0], gain * at[1], gain * at[2]};
        tone->apply(at, rgb, white);
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- meter

// Luminances are counted in steps of 1/16 EV, finer than an eye sees, from 2^-40 to 2^40.
enum { PER_EV = 16, RANGE_EV = 40, BINS = 2 * RANGE_EV * PER_EV };
static const double mid_grey = 0.18;
static const double dark = 0.10, bright = 0.02;  // parts left out
static const int black_ev = 20;                  // below the brightest
// Below what is bright: with that as white, less than a code of 8 bits of the sRGB curve.
static const double unseen_ev = 11.7;
static const double most_ev = 16.0;
static const double bright_part = 0.99, bright_value = 0.9;

// The bin of a value and 1; 0 below all, BINS + 1 above.
static int bin_at(float value)
{
    const double place = value > 0.0f ? ((double)log2f(value) + RANGE_EV) * PER_EV : -1.0;
    return place < 0.0 ? 0 : place < BINS ? 1 + relume_whole(place) : BINS + 1;
}

static float brightest_of(const float rgb[3])
{
    return fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
}

// Returns how many values are in a bin.
static size_t count_bins(size_t bin[BINS], const struct relume_image *image,
                         float (*value)(const float rgb[3]))
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    size_t all[BINS + 2] = {0};
    struct float_steps steps;
    float_steps_init(&steps, bin_at, BINS + 1);
    for (size_t i = 0; i < pixels; i++)
        all[float_step(&steps, value(image->data + 3 * i))]++;
    memcpy(bin, all + 1, BINS * sizeof *bin);
    return pixels - all[0] - all[BINS + 1];
}

// The bin up to which `count` values are.
static int bin_of(const size_t bin[BINS], double count)
{
    double below = 0.0;
    int i = 0;
    while (i < BINS - 1 && below + (double)bin[i] < count)
        below += (double)bin[i++];
    return i;
}

// Beside a few lamps in a dark room, and beside a large object: what a file of 8 bits has as black
// is not quite 0 under a sky.
static void forget_black(size_t bin[BINS], size_t *count)
{
    const int top = bin_of(bin, (double)*count) - black_ev * PER_EV;
    const int seen = bin_of(bin, (1.0 - bright) * (double)*count) - (int)(unseen_ev * PER_EV);
    for (int i = 0; i < (top > seen ? top : seen); i++) {
        *count -= bin[i];
        bin[i] = 0;
    }
}

double relume_tone_meter(const struct relume_image *image)
{
    size_t bin[BINS];
    if (!image->data || image->channels != 3)
        return 0.0;
    size_t count = count_bins(bin, image, luminance_709f);
    if (!count)
        return 0.0;
    forget_black(bin, &count);
    const double from = dark * (double)count;
    const double to = (1.0 - bright) * (double)count;
    double below = 0.0;
    double sum = 0.0;
    double weight = 0.0;
    for (int i = 0; i < BINS; i++) {
        const double above = below + (double)bin[i];
        const double part = fmax(fmin(above, to) - fmax(below, from), 0.0);
        sum += part * ((i + 0.5) / PER_EV - RANGE_EV);
        weight += part;
        below = above;
    }
    return fmin(fmax(log2(mid_grey) - sum / weight, -most_ev), most_ev);
}

double relume_tone_meter_bright(const struct relume_image *image)
{
    size_t bin[BINS];
    if (!image->data || image->channels != 3)
        return 0.0;
    const size_t count = count_bins(bin, image, brightest_of);
    if (!count)
        return 0.0;
    const double top = (bin_of(bin, bright_part * (double)count) + 0.5) / PER_EV - RANGE_EV;
    return fmin(fmax(log2(bright_value) - top, -most_ev), most_ev);
}

double relume_tone_meter_for(const struct relume_image *image, const struct relume_tone *tone)
{
    return !tone || tone == &relume_tone_linear ? relume_tone_meter_bright(image)
                                                : relume_tone_meter(image);
}
