// agreement.c - each exposure against the merge of the others
#include "capture/hdr/agreement.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "image/image/merge_weight.h"

#include <math.h>

enum { PER_EV = 256, RANGE_EV = 8, BINS = 2 * RANGE_EV * PER_EV, PIXELS = 1 << 18 };
static const float dark = 0.05f, bright = 0.95f;  // what an exposure resolves
static const float saturated = 0.995f, black = 0.005f;
static const double sigma_of_mad = 1.4826;  // of a normal distribution

struct tally {
    size_t bin[BINS];  // of log2(own / others)
    size_t count, saturated, black;
    double squares, weight;
};

static void tally_add(struct tally *t, double ev)
{
    const int bin = relume_whole((ev + RANGE_EV) * PER_EV);
    t->bin[bin < 0 ? 0 : bin < BINS ? bin : BINS - 1]++;
    t->squares += ev * ev;
    t->count++;
}

static double tally_median(const struct tally *t)
{
    size_t sum = 0;
    int i = 0;
    while (i < BINS - 1 && 2 * (sum + t->bin[i]) < t->count)
        sum += t->bin[i++];
    const double part =
        t->bin[i] ? (0.5 * (double)t->count - (double)sum) / (double)t->bin[i] : 0.5;
    return (i + part) / PER_EV - RANGE_EV;
}

// The half width about `center` that holds half of the values.
static double tally_spread(const struct tally *t, double center)
{
    double low = 0.0, high = RANGE_EV;
    for (int round = 0; round < 24; round++) {
        const double half = 0.5 * (low + high);
        double inside = 0.0;
        for (int i = 0; i < BINS; i++) {
            const double from = fmax((double)i / PER_EV - RANGE_EV, center - half);
            const double to = fmin((i + 1.0) / PER_EV - RANGE_EV, center + half);
            inside += to > from ? (to - from) * PER_EV * (double)t->bin[i] : 0.0;
        }
        *(2.0 * inside < (double)t->count ? &low : &high) = half;
    }
    return high;
}

static void summarise(struct relume_exposure_report *r, const struct tally *t, size_t pixels)
{
    *r = (struct relume_exposure_report){
        .residual_ev = NAN,
        .bias_ev = NAN,
        .noise_ev = NAN,
        .saturated = (double)t->saturated / (double)pixels,
        .black = (double)t->black / (double)pixels,
        .used = t->weight / (3.0 * (double)pixels),
    };
    if (!t->count)
        return;
    r->residual_ev = sqrt(t->squares / (double)t->count);
    r->bias_ev = tally_median(t);
    r->noise_ev = sigma_of_mad * tally_spread(t, r->bias_ev);
}

struct sample {
    float weight, ev;  // of one channel of one exposure; weight 0: not resolved
};

static float mask_at(const struct relume_merge_params *p, int i, size_t pixel)
{
    return p->masks && p->masks[i].data ? p->masks[i].data[pixel] : 1.0f;
}

static void compare(struct tally *t, const struct sample *s, int n)
{
    double total = 0.0, sum = 0.0;
    for (int i = 0; i < n; i++) {
        total += (double)s[i].weight;
        sum += (double)s[i].weight * (double)s[i].ev;
    }
    for (int i = 0; i < n; i++) {
        const double w = (double)s[i].weight, others = total - w;
        if (w > 0.0 && others > 0.05)
            tally_add(&t[i], (double)s[i].ev - (sum - w * (double)s[i].ev) / others);
    }
}

static void count_ends(struct tally *t, const float *rgb)
{
    t->saturated += rgb[0] >= saturated || rgb[1] >= saturated || rgb[2] >= saturated;
    t->black += rgb[0] <= black && rgb[1] <= black && rgb[2] <= black;
}

// The last code that says nothing.
static float black_level(const struct relume_response *response, int c)
{
    int i = 0;
    while (i < RELUME_CODES - 1 && !(response->exposure[c][i + 1] > 0.0f))
        i++;
    return (float)i / (RELUME_CODES - 1);
}

relume_status agreement(struct relume_exposure_report *report, const struct relume_image *codes,
                        const double *exposures, int n, const struct relume_response *response,
                        const struct relume_merge_params *params)
{
    const size_t all = (size_t)codes->width * (size_t)codes->height;
    const size_t step = all / PIXELS + 1;
    struct tally *t = mem_zeroed((size_t)n, sizeof *t);
    struct sample *s = mem_array((size_t)n, sizeof *s);
    size_t resolved = 0, pixels = 0;
    for (size_t i = 0; t && s && i < all; i += step, pixels++) {
        for (int j = 0; j < n; j++)
            count_ends(&t[j], codes[j].data + 3 * i);
        for (int c = 0; c < 3; c++) {
            const float low = black_level(response, c) + dark;
            for (int j = 0; j < n; j++) {
                const float code = codes[j].data[3 * i + (size_t)c], mask = mask_at(params, j, i);
                const float f = relume_response_decode(response, c, code);
                const bool good = code > low && code < bright;
                const float w = relume_merge_weight(params->weights, code, false, false) * mask;
                s[j] = good ? (struct sample){w, log2f(f) - (float)log2(exposures[j])}
                            : (struct sample){0};
                t[j].weight += (double)w;
                resolved += good;
            }
            compare(t, s, n);
        }
    }
    for (int j = 0; t && s && report && j < n; j++)
        summarise(&report[j], &t[j], pixels);
    const relume_status status = t && s ? RELUME_OK : RELUME_ENOMEM;
    mem_free(t);
    mem_free(s);
    return status || resolved ? status
                              : log_fail(params->log, RELUME_EUNFIT,
                                         "no exposure shows anything but black and saturated "
                                         "pixels; expected a picture");
}
