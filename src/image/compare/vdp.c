// vdp.c - how likely the difference of two pictures is seen (Daly 1993, "The visible differences
// predictor"; Mantiuk, Myszkowski, Seidel 2004, "Visible difference predicator for high dynamic
// range images")
//
// Detections in different bands are independent: what all of them miss is the product of what each
// misses, so that exponents add up.
#include "core/base/params.h"
#include "image/compare/jnd.h"
#include "image/compare/sight.h"

#include <math.h>

// The slope of the psychometric function (Daly 1993).
#define SLOPE 3.5

// (|d|)^3.5, of which the probability of missing is 2^-.
static float exponent(float difference)
{
    return powf(fabsf(difference), (float)SLOPE);
}

static void add_band(struct sight *s, int band, int direction, float *sum)
{
    const size_t pixels = (size_t)s->width * (size_t)s->height;
    sight_difference(s, band, direction);
    for (size_t i = 0; i < pixels; i++)
        sum[i] += exponent(s->over[i]);
}

static void to_probability(struct relume_vdp *out, const struct sight *s, float *p)
{
    const size_t pixels = (size_t)s->width * (size_t)s->height;
    double sum = 0.0;
    size_t n = 0, likely = 0, sure = 0;
    for (size_t i = 0; i < pixels; i++) {
        p[i] = 1.0f - exp2f(-p[i]);
        if (s->mask && !(s->mask[i] > 0.5f))
            continue;
        n++;
        sum += (double)p[i];
        likely += p[i] > 0.75f;
        sure += p[i] > 0.95f;
    }
    const double share = n ? 1.0 / (double)n : 0.0;
    *out = (struct relume_vdp){.p75 = share * (double)likely,
                               .p95 = share * (double)sure,
                               .mean = share * sum,
                               .pixels = n};
}

relume_status relume_image_vdp(struct relume_vdp *out, struct relume_image *map,
                               const struct relume_image *image,
                               const struct relume_image *reference,
                               const struct relume_jnd_params *params)
{
    const struct relume_jnd_params p = PARAMS(relume_jnd_params, params);
    struct sight s;
    struct relume_image seen = {0};
    *out = (struct relume_vdp){0};
    if (map)
        *map = (struct relume_image){0};
    relume_status status = sight_create(&s, image, reference, &p);
    if (!status)
        status = relume_image_create(&seen, s.width, s.height, 1);
    if (!status)
        sight_look(&s, RELUME_OPPONENT_WHITE);
    for (int band = 0; !status && band < SIGHT_BANDS; band++)
        for (int d = 0; d < (band ? SIGHT_DIRECTIONS : 1); d++)
            add_band(&s, band, band ? d : -1, seen.data);
    if (!status)
        to_probability(out, &s, seen.data);
    if (!status && map) {
        *map = seen;
        seen = (struct relume_image){0};
    }
    relume_image_destroy(&seen);
    sight_destroy(&s);
    return status;
}
