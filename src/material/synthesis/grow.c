// grow.c - a larger piece of a texture, as a map of the texels of a small one
#include "material/synthesis/grow.h"
#include "material/synthesis/texture.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"

#include <math.h>
#include <string.h>

enum { MOST_SIDE = 1 << 24, MOST_TEXELS = 1 << 30 };

static int default_patch(const struct relume_texture *t, const struct relume_regular *r)
{
    const int side = smaller_of(t->width, t->height);
    int size = side / 3;
    if (r && r->info.common) {
        const double x = r->info.base[0] > 0.0 ? t->width / r->info.base[0] : 0.0,
                     y = r->info.base[1] > 0.0 ? t->height / r->info.base[1] : 0.0;
        size = larger_of((int)ceil(2.0 * fmax(x, y)), side / 6);
    }
    size = smaller_of(larger_of(size, 16), smaller_of(side / 2, 128));
    return larger_of(size / 2 * 2, 4);
}

// At most `most`, while the sample has 8 texels a side.
static int levels_of(const struct relume_texture *t, int most)
{
    int levels = 1;
    while (levels < most && (smaller_of(t->width, t->height) >> levels) >= 8)
        levels++;
    return levels;
}

static relume_status between(const struct relume_log *log, const char *what, int value, int low,
                             int high, int step)
{
    if (value >= low && value <= high && (value - low) % step == 0)
        return RELUME_OK;
    return log_fail(log, RELUME_EINVAL, "%s: expected %s%d to %d; found %d", what,
                    step == 1 ? ""
                    : low % 2 ? "an odd number from "
                              : "an even number from ",
                    low, high, value);
}

static relume_status check(struct relume_grow_params *p, int width, int height,
                           const struct relume_texture *t)
{
    const int side = smaller_of(t->width, t->height);
    if (width < 1 || height < 1 || width > MOST_SIDE || height > MOST_SIDE ||
        (int64_t)width * height > MOST_TEXELS)
        return log_fail(p->log, RELUME_ELIMIT, "map: expected 1 x 1 to 2^30 texels; found %d x %d",
                        width, height);
    const relume_status fits = limits_memory(
        NULL, (uint64_t)width * (uint64_t)height * sizeof(uint32_t), "the map", p->log);
    if (fits)
        return fits;
    if (p->regular && (p->regular->width != t->width || p->regular->height != t->height))
        return log_fail(p->log, RELUME_EINVAL,
                        "regular structure: of a texture of %d x %d texels; expected %d x %d",
                        p->regular->width, p->regular->height, t->width, t->height);
    p->weight = p->weight != 0.0 ? p->weight : 1.0;
    p->patch = p->patch ? p->patch : default_patch(t, p->regular);
    p->neighbourhood = p->neighbourhood ? p->neighbourhood : 5;
    p->alike = p->alike ? p->alike : 2;
    p->levels = p->levels ? p->levels : 5;
    if (!(p->weight >= 0.01 && p->weight <= 100.0))
        return log_fail(p->log, RELUME_EINVAL, "weight: expected 0.01 to 100; found %g", p->weight);
    relume_status status = between(p->log, "patch", p->patch, 4, smaller_of(256, side), 2);
    if (!status)
        status = between(p->log, "neighbourhood", p->neighbourhood, 3, 9, 2);
    if (!status)
        status = between(p->log, "alike", p->alike, 1, 8, 1);
    if (!status)
        status = between(p->log, "levels", p->levels, 1, 8, 1);
    p->levels = levels_of(t, p->levels);
    return status;
}

// So that a whole number of periods fits into `size`.
static double stretch(double base, int sample, int size)
{
    if (!(base > 0.0))
        return 1.0;
    const double period = sample / base, count = fmax(round(size / period), 1.0);
    return period * count / size;
}

static bool load(struct grow *g)
{
    const struct relume_texture *t = g->texture;
    const size_t texels = (size_t)t->width * (size_t)t->height;
    const int channels = smaller_of(t->channels, GROW_VALUES);
    g->values = channels <= 4 ? 4 : GROW_VALUES;
    g->value = mem_zeroed(texels * (size_t)g->values, sizeof *g->value);
    for (size_t i = 0; g->value && i < texels; i++)
        memcpy(g->value + i * (size_t)g->values, t->value + i * (size_t)t->channels,
               (size_t)channels * sizeof *g->value);
    return g->value != NULL;
}

relume_status relume_texture_grow(uint32_t *texel, int width, int height,
                                  const struct relume_texture *texture,
                                  const struct relume_grow_params *params)
{
    struct relume_grow_params p = PARAMS_WORK(relume_grow_params, params);
    struct grow g = {.texture = texture,
                     .params = &p,
                     .width = width,
                     .height = height,
                     .texel = texel,
                     .stretch_x = 1.0,
                     .stretch_y = 1.0};
    relume_status status = texture_check(texture, p.log);
    if (!status)
        status = check(&p, width, height, texture);
    if (status)
        return status;
    if (p.regular && p.regular->info.regular)
        g.regular = p.regular;
    if (g.regular && p.tile) {
        g.stretch_x = stretch(g.regular->info.base[0], texture->width, width);
        g.stretch_y = stretch(g.regular->info.base[1], texture->height, height);
    }
    status = load(&g) ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = p.method == RELUME_GROW_PIXEL ? grow_pixels(&g) : grow_patches(&g);
    mem_free(g.value);
    return status;
}

// ---------------------------------------------------------------- pictures

struct apply {
    struct relume_image *out;
    const struct relume_image *sample;
    const uint32_t *texel;
};

static void apply_row(void *context, size_t item, int worker)
{
    (void)worker;
    const struct apply *a = context;
    const size_t width = (size_t)a->out->width, channels = (size_t)a->out->channels;
    for (size_t x = 0; x < width; x++)
        memcpy(a->out->data + (item * width + x) * channels,
               a->sample->data + (size_t)a->texel[item * width + x] * channels,
               channels * sizeof *a->out->data);
}

relume_status relume_texture_apply(struct relume_image *out, const uint32_t *texel, int width,
                                   int height, const struct relume_image *sample, int threads)
{
    const size_t texels = (size_t)sample->width * (size_t)sample->height;
    *out = (struct relume_image){0};
    if (width < 1 || height < 1)
        return RELUME_EINVAL;
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
        if (texel[i] >= texels)
            return RELUME_EINVAL;
    const relume_status status = relume_image_create(out, width, height, sample->channels);
    if (!status)
        thread_for(threads, (size_t)height, apply_row, &(struct apply){out, sample, texel});
    return status;
}
