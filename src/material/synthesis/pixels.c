// pixels.c - texel by texel, from coarse to fine (Meseth 2008, 4.1.4 and 4.2.1; Lefebvre and Hoppe,
// "Parallel Controllable Texture Synthesis", 2005)
//
// A map of every 2^n-th texel holds places in the sample. From level to level each texel hands its
// place to the four that it becomes; then all are put right by what stands around them: candidates
// are the continuations of the places around (Ashikhmin 2001) and of places that look like those
// (k-coherence, Tong et al. 2002), and what is compared is the surroundings and the regular
// structure. Every fourth texel is put right at once, by the others as they were, so that any
// number of threads finds the same. Samples of the levels are blurred and of full size.
#include "material/synthesis/grow.h"
#include "material/synthesis/alike.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "core/math/random.h"
#include "core/math/scalar.h"

#include <math.h>
#include <string.h>

enum {
    BLOCK = 64,      // texels a side of one piece of work
    MOST_SIDE = 9,   // of surroundings
    NEAR = 9,        // places whose continuations are tried
    MOST_ALIKE = 8,  // k
    FIRST = 1024,    // random places of which a first one is chosen by the structure
    AGAIN = 32,      // random places where no other has the structure that belongs there
    ROUNDS = 2,
    FIRST_ROUNDS = 3,
};
// A place that is no continuation must be so much better, squared.
static const float COHERENT = 1.1f;
// What a structure may be off its place, beside the mean square of the whole.
static const float LOOSE = 0.25f;
// Places that look alike are apart by this part of the sample.
static const double APART = 0.06;

struct level {
    struct grow *g;
    int level, spacing, width, height;
    int margin;                   // around the map, as less is known at borders
    int full_width, full_height;  // of the finest level with it
    float *value;                 // the sample, blurred: [texels][values]
    float *mask;                  // its structure: [texels][MASK_VALUES]
    uint32_t *alike;              // [texels][k - 1]
    uint32_t *texel;              // [height][width] of this level
    uint32_t *next;               // of every fourth
    int round;                    // of putting right
    int fourth;                   // which fourth
    float weight;                 // of the structure, squared, over all texels of the surroundings
    float loose;                  // a squared difference of the structure that is another place's
    float near;                   // that of half a texel
    int side, k;
    ptrdiff_t offset[MOST_SIDE * MOST_SIDE];  // of the surroundings, in floats of `value`
    float *scratch;                           // [workers][BLOCK * BLOCK][MASK_VALUES]
    double *turn;                             // [workers][4 BLOCK]
};

// ---------------------------------------------------------------- samples

// One step of a binomial filter whose taps lie `step` apart; [1 4 6 4 1] / 16 along x, then y.
static void blur_line(float *to, const float *from, int n, size_t stride, int values, int step)
{
    static const float tap[5] = {0.0625f, 0.25f, 0.375f, 0.25f, 0.0625f};
    for (int i = 0; i < n; i++)
        for (int k = 0; k < values; k++) {
            float sum = 0.0f;
            for (int t = -2; t <= 2; t++)
                sum +=
                    tap[t + 2] * from[(size_t)index_clamped(i + t * step, n) * stride + (size_t)k];
            to[(size_t)i * stride + (size_t)k] = sum;
        }
}

static bool blur(float *value, int width, int height, int values, int step)
{
    const size_t row = (size_t)width * (size_t)values;
    float *copy = mem_array(row * (size_t)height, sizeof *copy);
    if (!copy)
        return false;
    for (int y = 0; y < height; y++)
        blur_line(copy + (size_t)y * row, value + (size_t)y * row, width, (size_t)values, values,
                  step);
    for (int x = 0; x < width; x++)
        blur_line(value + (size_t)x * (size_t)values, copy + (size_t)x * (size_t)values, height,
                  row, values, step);
    mem_free(copy);
    return true;
}

// ---------------------------------------------------------------- places

static uint32_t texel_of(const struct relume_texture *t, int x, int y)
{
    return (uint32_t)(y * t->width + x);
}

// The texel of the map at (x, y), or beyond its side: that of the other, or none.
static bool map_place(const struct level *l, int x, int y, uint32_t *out)
{
    if (l->g->params->tile) {
        x = index_wrapped(x, l->width);
        y = index_wrapped(y, l->height);
    } else if (x < 0 || y < 0 || x >= l->width || y >= l->height) {
        return false;
    }
    *out = l->texel[(size_t)y * (size_t)l->width + (size_t)x];
    return true;
}

struct site {
    const float *around[MOST_SIDE * MOST_SIDE];  // what stands there, or NULL
    const float *mask;                           // what the structure is there, or NULL
};

// The squared difference of the structure at a texel of the sample from what it is to be, beyond
// what lies within half a texel: else only moves by whole periods and whole texels would do.
static float out_of_place(const struct level *l, const float *mask, size_t texel)
{
    float sum = 0.0f;
    for (int k = 0; k < MASK_VALUES; k++) {
        const float d = l->mask[texel * MASK_VALUES + (size_t)k] - mask[k];
        sum += d * d;
    }
    return fmaxf(sum - l->near, 0.0f);
}

// How wrong texel (x, y) of the sample is at a site; more than `most` may be anything above it.
static inline __attribute__((always_inline)) float compare_values(const struct level *l,
                                                                  const struct site *s, int x,
                                                                  int y, float most, int values)
{
    const struct relume_texture *t = l->g->texture;
    const int r = l->side / 2, reach = r * l->spacing;
    const size_t at = (size_t)y * (size_t)t->width + (size_t)x;
    float sum = s->mask ? l->weight * out_of_place(l, s->mask, at) : 0.0f;
    const bool inside = x >= reach && y >= reach && x + reach < t->width && y + reach < t->height;
    const float *centre = l->value + at * (size_t)values;
    for (int j = 0, n = 0; j < l->side; j++) {
        if (sum >= most)
            return sum;
        for (int i = 0; i < l->side; i++, n++) {
            const float *a = s->around[n], *b = centre + l->offset[n];
            if (!a)
                continue;
            if (!inside)
                b = l->value +
                    (size_t)values * texel_of(t, index_clamped(x + (i - r) * l->spacing, t->width),
                                              index_clamped(y + (j - r) * l->spacing, t->height));
            float part = 0.0f;
            for (int k = 0; k < values; k++)
                part += (a[k] - b[k]) * (a[k] - b[k]);
            sum += part;
        }
    }
    return sum;
}

static float compare(const struct level *l, const struct site *s, int x, int y, float most)
{
    return l->g->values == 4 ? compare_values(l, s, x, y, most, 4)
                             : compare_values(l, s, x, y, most, GROW_VALUES);
}

// What stands around (x, y); the texel itself is open.
static void look_around(const struct level *l, struct site *s, int x, int y)
{
    const int r = l->side / 2;
    for (int j = -r, n = 0; j <= r; j++)
        for (int i = -r; i <= r; i++, n++) {
            uint32_t id;
            s->around[n] = (i || j) && map_place(l, x + i, y + j, &id)
                               ? l->value + (size_t)id * (size_t)l->g->values
                               : NULL;
        }
}

// ---------------------------------------------------------------- putting right

struct choice {
    int count;
    uint32_t tried[NEAR * MOST_ALIKE + AGAIN];
    uint32_t best;
    float wrong;
};

static void try_place(const struct level *l, const struct site *s, struct choice *c, uint32_t id,
                      int dx, int dy, float factor)
{
    const struct relume_texture *t = l->g->texture;
    const int x = (int)(id % (uint32_t)t->width) - dx * l->spacing,
              y = (int)(id / (uint32_t)t->width) - dy * l->spacing;
    if (x < 0 || y < 0 || x >= t->width || y >= t->height)
        return;
    const uint32_t place = texel_of(t, x, y);
    for (int i = 0; i < c->count; i++)
        if (c->tried[i] == place)
            return;
    c->tried[c->count++] = place;
    const float wrong = factor * compare(l, s, x, y, c->wrong / factor);
    if (wrong < c->wrong) {
        c->wrong = wrong;
        c->best = place;
    }
}

// A region whose structure is moved goes on as well as any: chance finds a place that is not.
static void try_others(const struct level *l, const struct site *s, struct choice *c, uint64_t at)
{
    const double texels = (double)l->g->texture->width * l->g->texture->height;
    struct random random =
        random_stream(l->g->params->seed, (uint64_t)(l->level * 256 + l->round), at);
    for (int i = 0; i < AGAIN; i++)
        try_place(l, s, c, (uint32_t)(random_next(&random) * texels), 0, 0, COHERENT);
}

static uint32_t best_place(const struct level *l, const float *mask, int x, int y)
{
    static const signed char step[NEAR][2] = {{0, 0},   {-1, 0}, {1, 0},  {0, -1}, {0, 1},
                                              {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    struct site s = {.mask = mask};
    struct choice c = {.wrong = INFINITY};
    uint32_t id;
    look_around(l, &s, x, y);
    map_place(l, x, y, &c.best);
    for (int n = 0; n < NEAR; n++)
        if (map_place(l, x + step[n][0], y + step[n][1], &id))
            try_place(l, &s, &c, id, step[n][0], step[n][1], 1.0f);
    for (int n = 0; n < NEAR && l->k > 1; n++)
        if (map_place(l, x + step[n][0], y + step[n][1], &id))
            for (int k = 0; k < l->k - 1; k++)
                try_place(l, &s, &c, l->alike[(size_t)id * (size_t)(l->k - 1) + (size_t)k],
                          step[n][0], step[n][1], COHERENT);
    if (mask && out_of_place(l, mask, c.best) > l->loose)
        try_others(l, &s, &c, (uint64_t)y * (uint64_t)l->width + (uint64_t)x);
    return c.best;
}

static int blocks_across(const struct level *l)
{
    return (l->width + BLOCK - 1) / BLOCK;
}

static size_t block_count(const struct level *l)
{
    return (size_t)blocks_across(l) * (size_t)((l->height + BLOCK - 1) / BLOCK);
}

static struct mask_area block_area(const struct level *l, size_t item)
{
    const int across = blocks_across(l);
    const int x = (int)(item % (size_t)across) * BLOCK, y = (int)(item / (size_t)across) * BLOCK;
    return (struct mask_area){.x = x,
                              .y = y,
                              .width = smaller_of(BLOCK, l->width - x),
                              .height = smaller_of(BLOCK, l->height - y),
                              .spacing = l->spacing,
                              .stretch_x = l->g->stretch_x,
                              .stretch_y = l->g->stretch_y};
}

// The structure in a block, in the worker's scratch; NULL where there is none.
static float *block_mask(const struct level *l, const struct mask_area *block, int worker)
{
    if (!l->g->regular)
        return NULL;
    float *mask = l->scratch + (size_t)worker * BLOCK * BLOCK * MASK_VALUES;
    struct mask_area area = *block;
    area.x -= l->margin / l->spacing;
    area.y -= l->margin / l->spacing;
    mask_fill(mask, l->g->regular, &area, l->turn + (size_t)worker * 4 * BLOCK);
    return mask;
}

static size_t next_at(const struct level *l, int x, int y)
{
    return (size_t)(y / 2) * (size_t)((l->width + 1) / 2) + (size_t)(x / 2);
}

static void right_block(void *context, size_t item, int worker)
{
    const struct level *l = context;
    const struct mask_area a = block_area(l, item);
    const float *mask = block_mask(l, &a, worker);
    for (int y = a.y + l->fourth / 2; y < a.y + a.height; y += 2)
        for (int x = a.x + l->fourth % 2; x < a.x + a.width; x += 2) {
            const size_t in = (size_t)(y - a.y) * (size_t)a.width + (size_t)(x - a.x);
            l->next[next_at(l, x, y)] = best_place(l, mask ? mask + in * MASK_VALUES : NULL, x, y);
        }
}

static void take_block(void *context, size_t item, int worker)
{
    (void)worker;
    const struct level *l = context;
    const struct mask_area a = block_area(l, item);
    for (int y = a.y + l->fourth / 2; y < a.y + a.height; y += 2)
        for (int x = a.x + l->fourth % 2; x < a.x + a.width; x += 2)
            l->texel[(size_t)y * (size_t)l->width + (size_t)x] = l->next[next_at(l, x, y)];
}

static relume_status put_right(struct level *l, int rounds, double done, double share)
{
    static const unsigned char order[4] = {0, 3, 1, 2};
    for (int i = 0; i < 4 * rounds; i++) {
        l->round = i / 4;
        l->fourth = order[i % 4];
        thread_for(l->g->params->threads, block_count(l), right_block, l);
        thread_for(l->g->params->threads, block_count(l), take_block, l);
        if (!log_progress(l->g->params->log, "texels", done + share * (i + 1.0) / (4.0 * rounds)))
            return RELUME_ECANCEL;
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- levels

// Of some random places the one where the structure is right.
static void first_block(void *context, size_t item, int worker)
{
    const struct level *l = context;
    const struct relume_texture *t = l->g->texture;
    const struct mask_area a = block_area(l, item);
    const float *mask = block_mask(l, &a, worker);
    const size_t texels = (size_t)t->width * (size_t)t->height;
    for (int y = a.y; y < a.y + a.height; y++)
        for (int x = a.x; x < a.x + a.width; x++) {
            const size_t at = (size_t)y * (size_t)l->width + (size_t)x;
            const float *here =
                mask
                    ? mask + ((size_t)(y - a.y) * (size_t)a.width + (size_t)(x - a.x)) * MASK_VALUES
                    : NULL;
            struct random random = random_stream(l->g->params->seed, 7, at);
            float least = INFINITY;
            for (int i = 0; i < (here ? FIRST : 1); i++) {
                const size_t id = (size_t)(random_next(&random) * (double)texels);
                const float wrong = here ? out_of_place(l, here, id) : 0.0f;
                if (wrong < least) {
                    least = wrong;
                    l->texel[at] = (uint32_t)id;
                }
                if (wrong <= 0.0f)
                    break;
            }
        }
}

// Each place for the four texels that it becomes.
static void refine(const struct level *l, const uint32_t *coarse, int coarse_width)
{
    const struct relume_texture *t = l->g->texture;
    for (int y = 0; y < l->height; y++)
        for (int x = 0; x < l->width; x++) {
            const uint32_t id = coarse[(size_t)(y / 2) * (size_t)coarse_width + (size_t)(x / 2)];
            const int sx = (int)(id % (uint32_t)t->width) + x % 2 * l->spacing,
                      sy = (int)(id / (uint32_t)t->width) + y % 2 * l->spacing;
            l->texel[(size_t)y * (size_t)l->width + (size_t)x] =
                texel_of(t, index_clamped(sx, t->width), index_clamped(sy, t->height));
        }
}

static relume_status prepare(struct level *l)
{
    const struct grow *g = l->g;
    const struct relume_texture *t = g->texture;
    const size_t texels = (size_t)t->width * (size_t)t->height;
    memcpy(l->value, g->value, texels * (size_t)g->values * sizeof *l->value);
    for (int i = 0; i < l->level; i++)
        if (!blur(l->value, t->width, t->height, g->values, 1 << i))
            return RELUME_ENOMEM;
    for (int j = 0, n = 0; j < l->side; j++)
        for (int i = 0; i < l->side; i++, n++)
            l->offset[n] = ((ptrdiff_t)(j - l->side / 2) * t->width + (i - l->side / 2)) *
                           l->spacing * g->values;
    if (l->k < 2)
        return RELUME_OK;
    const int apart =
        larger_of((int)(APART * smaller_of(t->width, t->height)), larger_of(2, l->spacing));
    return alike_find(l->alike, l->k - 1, apart,
                      &(struct alike_texels){.width = t->width,
                                             .height = t->height,
                                             .value = l->value,
                                             .values = g->values,
                                             .own = g->regular ? l->mask : NULL,
                                             .owns = g->regular ? MASK_VALUES : 0,
                                             .weight = l->weight,
                                             .side = l->side,
                                             .spacing = l->spacing},
                      g->params->threads);
}

static bool alloc(struct level *l)
{
    const struct grow *g = l->g;
    const size_t texels = (size_t)g->texture->width * (size_t)g->texture->height,
                 workers = (size_t)thread_count(g->params->threads),
                 fourth = (size_t)((l->full_width + 1) / 2) * (size_t)((l->full_height + 1) / 2);
    l->value = mem_array(texels * (size_t)g->values, sizeof *l->value);
    l->mask = g->regular ? mask_of_sample(g->regular) : NULL;
    l->alike = mem_array(texels * (size_t)larger_of(l->k - 1, 1), sizeof *l->alike);
    l->texel = mem_array((size_t)l->full_width * (size_t)l->full_height, sizeof *l->texel);
    l->next = mem_array(fourth, sizeof *l->next);
    l->scratch = mem_array(workers * BLOCK * BLOCK * MASK_VALUES, sizeof *l->scratch);
    l->turn = mem_array(workers * 4 * BLOCK, sizeof *l->turn);
    return l->value && (l->mask || !g->regular) && l->alike && l->texel && l->next && l->scratch &&
           l->turn;
}

static relume_status run_level(struct level *l, int index, int levels, double done, double share)
{
    const struct grow *g = l->g;
    const int coarse_width = l->width;
    l->level = levels - 1 - index;
    l->spacing = 1 << l->level;
    l->width = (l->full_width + l->spacing - 1) / l->spacing;
    l->height = (l->full_height + l->spacing - 1) / l->spacing;
    relume_status status = prepare(l);
    if (status)
        return status;
    if (index == 0) {
        thread_for(g->params->threads, block_count(l), first_block, l);
    } else {
        memcpy(l->next, l->texel,
               (size_t)coarse_width * (size_t)((l->height + 1) / 2) * sizeof *l->next);
        refine(l, l->next, coarse_width);
    }
    return put_right(l, index == 0 ? FIRST_ROUNDS : ROUNDS, done, share);
}

relume_status grow_pixels(struct grow *g)
{
    struct level l = {.g = g, .side = g->params->neighbourhood, .k = g->params->alike};
    const float all = (float)(l.side * l.side - 1), weight = (float)g->params->weight;
    l.weight = weight * weight * all;
    l.margin = g->params->tile ? 0 : 1 << g->params->levels;
    l.full_width = g->width + 2 * l.margin;
    l.full_height = g->height + 2 * l.margin;
    relume_status status = alloc(&l) ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; i < (g->regular ? g->regular->info.count : 0); i++) {
        const struct relume_wave *w = &g->regular->wave[i];
        const double power = (w->re * w->re + w->im * w->im) / (255.0 * 255.0),
                     x = M_PI * w->x / g->texture->width, y = M_PI * w->y / g->texture->height;
        if (w->x != 0.0 || w->y != 0.0) {
            l.loose += LOOSE * (float)power;
            l.near += (float)(power * (x * x + y * y));
        }
    }
    l.near = fminf(l.near, 0.5f * l.loose);
    double done = 0.0;
    for (int i = 0; i < g->params->levels && !status; i++) {
        const double share =
            i + 1 < g->params->levels ? 0.75 * pow(0.25, g->params->levels - 1 - i) : 1.0 - done;
        status = run_level(&l, i, g->params->levels, done, share);
        done += share;
    }
    for (int y = 0; y < g->height && !status; y++)
        memcpy(g->texel + (size_t)y * (size_t)g->width,
               l.texel + (size_t)(y + l.margin) * (size_t)l.full_width + (size_t)l.margin,
               (size_t)g->width * sizeof *g->texel);
    mem_free(l.value);
    mem_free(l.mask);
    mem_free(l.alike);
    mem_free(l.texel);
    mem_free(l.next);
    mem_free(l.scratch);
    mem_free(l.turn);
    return status;
}
