// judge.c - how good a map is: what repeats in it, and whether it looks like the sample
#include "material/synthesis/regular.h"
#include "material/synthesis/texture.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/fft2d.h"
#include "core/math/random.h"
#include "core/math/scalar.h"

#include <math.h>
#include <string.h>

enum {
    WINDOW = 2048,  // of a large map its middle, for repetition
    SITES = 600,    // neighbourhoods that are compared
    RADIUS = 2,
    SIDE = 2 * RADIUS + 1,
    LEAST = 2 * SIDE + 2 * RADIUS,  // side from which on every neighbourhood has one apart
    MOST_VALUES = 8,
};

// ---------------------------------------------------------------- repetition

struct repeats {
    const uint32_t *texel;  // the window, its rows `stride` apart
    size_t stride;
    int width, height, columns;
    float *plain;  // of the sample: the first channel without structure and mean
    float *found;  // [height][width]: correlations
};

static void fill_row(void *context, int row, float *line)
{
    const struct repeats *r = context;
    memset(line, 0, (size_t)r->columns * sizeof *line);
    for (int x = 0; x < r->width; x++)
        line[x] = r->plain[r->texel[(size_t)row * r->stride + (size_t)x]];
}

static bool square(void *context, int column, int count, float *lines)
{
    const int height = *(const int *)context;
    (void)column;
    for (size_t i = 0; i < (size_t)count * (size_t)height; i++) {
        const float p = lines[2 * i] * lines[2 * i] + lines[2 * i + 1] * lines[2 * i + 1];
        lines[2 * i] = p;
        lines[2 * i + 1] = 0.0f;
    }
    return true;
}

// Moves to the left by up to half of the window as well as to the right.
static void take_row(void *context, int row, const float *line)
{
    const struct repeats *r = context;
    float *to = r->found + (size_t)row * (size_t)r->width;
    for (int i = 0; i < r->width; i++) {
        const int x = i - r->width / 2;
        to[i] = line[x < 0 ? x + r->columns : x];
    }
}

// What is left of the sample when its structure and its mean are taken off.
static relume_status without_structure(float **out, const struct relume_texture *t,
                                       const relume_regular *regular)
{
    const size_t n = (size_t)t->width * (size_t)t->height;
    float *plain = mem_array(n, sizeof *plain), *mask = regular ? mask_of_sample(regular) : NULL;
    const bool good = plain && (mask || !regular);
    double sum = 0.0;
    for (size_t i = 0; good && i < n; i++) {
        plain[i] = t->value[i * (size_t)t->channels] - (mask ? mask[i * MASK_VALUES] : 0.0f);
        sum += (double)plain[i];
    }
    for (size_t i = 0; good && i < n; i++)
        plain[i] -= (float)(sum / (double)n);
    mem_free(mask);
    if (!good)
        mem_free(plain);
    *out = good ? plain : NULL;
    return good ? RELUME_OK : RELUME_ENOMEM;
}

static void find_highest(struct relume_grow_quality *out, const struct repeats *r,
                         const struct relume_texture *t)
{
    const double whole = (double)r->found[r->width / 2] / ((double)r->width * r->height);
    for (int y = 0; y <= r->height / 2; y++)
        for (int i = 0; i < r->width; i++) {
            const int x = i - r->width / 2;
            if ((abs(x) < t->width / 2 && y < t->height / 2) || (y == 0 && x <= 0))
                continue;
            const double both = (double)(r->width - abs(x)) * (r->height - y),
                         value = (double)r->found[(size_t)y * (size_t)r->width + (size_t)i] / both;
            if (whole > 1e-14 && value / whole > out->repetition) {
                out->repetition = value / whole;
                out->repetition_at[0] = x;
                out->repetition_at[1] = y;
            }
        }
}

static relume_status judge_repetition(struct relume_grow_quality *out, const uint32_t *texel,
                                      int width, int height, const struct relume_texture *t,
                                      const struct relume_grow_quality_params *p)
{
    struct repeats r = {.stride = (size_t)width,
                        .width = smaller_of(width, WINDOW),
                        .height = smaller_of(height, WINDOW)};
    const int rows = fft_good_size(2 * r.height);
    fft2d *f = NULL;
    r.columns = fft_good_size(2 * r.width);
    r.texel =
        texel + (size_t)((height - r.height) / 2) * r.stride + (size_t)((width - r.width) / 2);
    relume_status status =
        without_structure(&r.plain, t, p->regular && p->regular->info.regular ? p->regular : NULL);
    r.found = mem_array((size_t)r.width * (size_t)(r.height / 2 + 1), sizeof *r.found);
    if (!status)
        status = r.found ? fft2d_create(&f, r.columns, rows, true, p->threads) : RELUME_ENOMEM;
    float *bins = status ? NULL : mem_large(fft2d_size(f) * sizeof *bins);
    if (bins) {
        int lines = rows;
        fft2d_rows(f, bins, 0, r.height, fill_row, &r);
        fft2d_step_columns(f, bins,
                           &(struct fft2d_step){.to = r.height,
                                                .end = fft2d_columns(f),
                                                .visit = square,
                                                .context = &lines,
                                                .back = true});
        fft2d_rows_back(f, bins, 0, r.height / 2 + 1, take_row, &r);
        find_highest(out, &r, t);
    } else if (!status) {
        status = RELUME_ENOMEM;
    }
    mem_free(bins);
    fft2d_destroy(&f);
    mem_free(r.plain);
    mem_free(r.found);
    return status;
}

// ---------------------------------------------------------------- likeness

struct likeness {
    const struct relume_texture *t;
    const uint32_t *texel;
    int width, height, values;
    float *distance;  // [2][SITES]: of the map, of the sample
};

static float difference(const struct likeness *l, const float *around, int x, int y, float most)
{
    const struct relume_texture *t = l->t;
    float sum = 0.0f;
    for (int j = -RADIUS; j <= RADIUS; j++) {
        const float *b = t->value + ((size_t)(y + j) * (size_t)t->width + (size_t)(x - RADIUS)) *
                                        (size_t)t->channels;
        for (int i = 0; i < SIDE; i++, b += t->channels, around += l->values)
            for (int k = 0; k < l->values; k++)
                sum += (around[k] - b[k]) * (around[k] - b[k]);
        if (sum >= most)
            return sum;
    }
    return sum;
}

// The distance to the nearest neighbourhood of the sample, those around (x, y) left out.
static float nearest(const struct likeness *l, const float *around, int x, int y)
{
    const struct relume_texture *t = l->t;
    float most = INFINITY;
    for (int j = RADIUS; j < t->height - RADIUS; j++)
        for (int i = RADIUS; i < t->width - RADIUS; i++)
            if (abs(i - x) >= SIDE || abs(j - y) >= SIDE)
                most = fminf(most, difference(l, around, i, j, most));
    return sqrtf(most);
}

// Sites 0 to SITES - 1 are of the map, the others of the sample.
static void compare_site(void *context, size_t item, int worker)
{
    (void)worker;
    const struct likeness *l = context;
    const struct relume_texture *t = l->t;
    const bool own = item >= SITES;
    const int width = own ? t->width : l->width, height = own ? t->height : l->height;
    struct random random = random_stream(3, own, item);
    const int x = RADIUS + (int)(random_next(&random) * (width - 2 * RADIUS)),
              y = RADIUS + (int)(random_next(&random) * (height - 2 * RADIUS));
    float around[SIDE * SIDE * MOST_VALUES], *to = around;
    for (int j = -RADIUS; j <= RADIUS; j++)
        for (int i = -RADIUS; i <= RADIUS; i++, to += l->values) {
            const size_t at = (size_t)(y + j) * (size_t)width + (size_t)(x + i);
            const size_t id = own ? at : l->texel[at];
            memcpy(to, t->value + id * (size_t)t->channels, (size_t)l->values * sizeof *to);
        }
    l->distance[item] = nearest(l, around, own ? x : -SIDE, own ? y : -SIDE);
}

static int by_size(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

static double mean(const float *list, int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++)
        sum += (double)list[i];
    return sum / count;
}

static relume_status judge_likeness(struct relume_grow_quality *out, const uint32_t *texel,
                                    int width, int height, const struct relume_texture *t,
                                    int threads)
{
    enum { WORST = SITES / 20 };
    struct likeness l = {.t = t,
                         .texel = texel,
                         .width = width,
                         .height = height,
                         .values = smaller_of(t->channels, MOST_VALUES)};
    if (width < SIDE || height < SIDE || (t->width < LEAST && t->height < LEAST))
        return RELUME_OK;
    l.distance = mem_array(2 * (size_t)SITES, sizeof *l.distance);
    if (!l.distance)
        return RELUME_ENOMEM;
    thread_for(threads, 2 * (size_t)SITES, compare_site, &l);
    float *own = l.distance + SITES;
    qsort(l.distance, SITES, sizeof *l.distance, by_size);
    qsort(own, SITES, sizeof *own, by_size);
    const double usual = fmax(mean(own, SITES), 1e-9),
                 high = fmax(mean(own + SITES - WORST, WORST), 1e-9);
    out->novelty = mean(l.distance, SITES) / usual;
    out->worst = mean(l.distance + SITES - WORST, WORST) / high;
    mem_free(l.distance);
    return RELUME_OK;
}

// ---------------------------------------------------------------- what is used

static relume_status judge_use(struct relume_grow_quality *out, const uint32_t *texel, int width,
                               int height, const struct relume_texture *t)
{
    const size_t all = (size_t)t->width * (size_t)t->height;
    unsigned char *used = mem_zeroed(all, 1);
    size_t count = 0, cuts = 0, pairs = 0;
    if (!used)
        return RELUME_ENOMEM;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t at = (size_t)y * (size_t)width + (size_t)x;
            used[texel[at]] = 1;
            if (x + 1 < width) {
                cuts += texel[at + 1] != texel[at] + 1 || texel[at + 1] % (uint32_t)t->width == 0;
                pairs++;
            }
            if (y + 1 < height) {
                cuts += texel[at + (size_t)width] != texel[at] + (uint32_t)t->width;
                pairs++;
            }
        }
    for (size_t i = 0; i < all; i++)
        count += used[i];
    mem_free(used);
    out->coverage = (double)count / (double)all;
    out->cuts = pairs ? (double)cuts / (double)pairs : 0.0;
    return RELUME_OK;
}

relume_status relume_grow_judge(struct relume_grow_quality *out, const uint32_t *texel, int width,
                                int height, const struct relume_texture *texture,
                                const struct relume_grow_quality_params *params)
{
    const struct relume_grow_quality_params p = PARAMS_WORK(relume_grow_quality_params, params);
    const size_t all = (size_t)texture->width * (size_t)texture->height;
    *out = (struct relume_grow_quality){0};
    relume_status status = texture_check(texture, p.log);
    if (!status && (width < 1 || height < 1 ||
                    (p.regular &&
                     (p.regular->width != texture->width || p.regular->height != texture->height))))
        status = RELUME_EINVAL;
    for (size_t i = 0; !status && i < (size_t)width * (size_t)height; i++)
        if (texel[i] >= all)
            status =
                log_fail(p.log, RELUME_EINVAL, "map: expected texels of %d x %d; found number %u",
                         texture->width, texture->height, texel[i]);
    if (!status)
        status = judge_use(out, texel, width, height, texture);
    if (!status)
        status = judge_repetition(out, texel, width, height, texture, &p);
    if (!status)
        status = judge_likeness(out, texel, width, height, texture, p.threads);
    return status;
}
