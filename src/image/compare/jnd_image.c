// jnd_image.c - the difference of two pictures in just noticeable differences
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/math/sort.h"
#include "image/compare/jnd.h"
#include "image/compare/sight.h"

#include <math.h>

// One channel's difference, over all bands, into what the channels have so far.
static void add_channel(struct sight *s, enum relume_opponent channel, float *sum, float *most)
{
    const size_t pixels = (size_t)s->width * (size_t)s->height;
    sight_look(s, channel);
    for (int band = 0; band < SIGHT_BANDS; band++) {
        sight_difference(s, band, -1);
        for (size_t i = 0; i < pixels; i++)
            sum[i] = band ? sum[i] + s->over[i] : s->over[i];
    }
    for (size_t i = 0; i < pixels; i++)
        most[i] = channel ? fmaxf(most[i], fabsf(sum[i])) : fabsf(sum[i]);
}

// `spare` is spoilt.
static void sum_up(struct relume_jnd *out, const struct sight *s, const float *most, float *spare)
{
    const size_t pixels = (size_t)s->width * (size_t)s->height;
    double sum = 0.0;
    size_t n = 0, seen = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (s->mask && !(s->mask[i] > 0.5f))
            continue;
        sum += (double)most[i];
        seen += most[i] > 1.0f;
        spare[n++] = most[i];
    }
    *out = (struct relume_jnd){.pixels = n};
    if (!n)
        return;
    sort_floats(spare, n);
    out->mean = sum / (double)n;
    out->seen = (double)seen / (double)n;
    out->max = (double)spare[n - 1];
    out->most = (double)spare[n - 1 - n / 100];
}

relume_status relume_image_jnd(struct relume_jnd *out, struct relume_image *map,
                               const struct relume_image *image,
                               const struct relume_image *reference,
                               const struct relume_jnd_params *params)
{
    const struct relume_jnd_params p = PARAMS(relume_jnd_params, params);
    struct sight s;
    struct relume_image most = {0}, sum = {0};
    *out = (struct relume_jnd){0};
    if (map)
        *map = (struct relume_image){0};
    relume_status status = sight_create(&s, image, reference, &p);
    if (!status)
        status = relume_image_create(&most, s.width, s.height, 1);
    if (!status)
        status = relume_image_create(&sum, s.width, s.height, 1);
    for (int c = 0; !status && c < RELUME_OPPONENTS; c++)
        add_channel(&s, (enum relume_opponent)c, sum.data, most.data);
    if (!status)
        sum_up(out, &s, most.data, sum.data);
    if (!status && map) {
        *map = most;
        most = (struct relume_image){0};
    }
    relume_image_destroy(&most);
    relume_image_destroy(&sum);
    sight_destroy(&s);
    return status;
}
