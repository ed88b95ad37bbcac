// dither.c - contours of a codebook, broken into a pattern within a budget of bytes
#include "format/codebook/dither.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "format/codebook/nearest.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NEIGHBOURS = 8 };

// The band begins so far on the way to the other code, whose middle is the edge.
#define BAND 0.25
// Only where the vectors move less than this part of the way within four pixels: steeper ramps hide
// their contours.
#define MOST_CHANGE 0.5

// ---------------------------------------------------------------- neighbours

struct near {
    double distance;
    int code;
};

static void find_neighbours(void *context, size_t code, int worker)
{
    (void)worker;
    const struct dither *d = context;
    struct near nearest[NEIGHBOURS];
    for (int i = 0; i < NEIGHBOURS; i++)
        nearest[i] = (struct near){INFINITY, (int)code};
    for (int c = 0; c < d->codes; c++) {
        const double apart = squared_distance(d->vectors + code * d->planes,
                                              d->vectors + (size_t)c * d->planes, d->planes);
        int at = NEIGHBOURS;
        while (at > 0 && apart > 0.0 && apart < nearest[at - 1].distance)
            at--;
        if (at == NEIGHBOURS)
            continue;
        memmove(nearest + at + 1, nearest + at, (size_t)(NEIGHBOURS - 1 - at) * sizeof *nearest);
        nearest[at] = (struct near){apart, c};
    }
    for (int i = 0; i < NEIGHBOURS; i++)
        d->neighbour[code * NEIGHBOURS + (size_t)i] = nearest[i].code;
}

relume_status dither_open(struct dither *d, const float *vectors, int codes, size_t planes,
                          size_t width, size_t height, double share, int threads)
{
    *d = (struct dither){vectors, codes, planes, width, height, share, NULL, NULL};
    d->neighbour = mem_array((size_t)codes, NEIGHBOURS * sizeof *d->neighbour);
    d->other = mem_array(width * height, sizeof *d->other);
    if (!d->neighbour || !d->other)
        return RELUME_ENOMEM;
    thread_for(threads, (size_t)codes, find_neighbours, d);
    return RELUME_OK;
}

void dither_close(struct dither *d)
{
    mem_free(d->neighbour);
    mem_free(d->other);
    *d = (struct dither){0};
}

// ---------------------------------------------------------------- bands

// How far the row's vectors move in four pixels, squared.
static double change_at(const struct dither *d, const float *row, size_t x)
{
    const size_t left = x < 2 ? 0 : x - 2, right = x + 2 < d->width ? x + 2 : d->width - 1;
    double sum = 0.0;
    for (size_t p = 0; p < d->planes; p++) {
        const double step = (double)row[p * d->width + right] - (double)row[p * d->width + left];
        sum += step * step;
    }
    return sum;
}

// The part t = (x - a) . (b - a) / |b - a|^2 of the way to a neighbour b of the code a.
static double part_of_way(const struct dither *d, const float *own, const float *from, int next,
                          double *spacing)
{
    const float *to = d->vectors + (size_t)next * d->planes;
    double along = 0.0;
    *spacing = 0.0;
    for (size_t p = 0; p < d->planes; p++) {
        const double way = (double)to[p] - (double)from[p];
        along += ((double)own[p] - (double)from[p]) * way;
        *spacing += way * way;
    }
    return *spacing > 0.0 ? along / *spacing : 0.0;
}

void dither_offer(const struct dither *d, size_t x, size_t y, uint16_t code, const float *own,
                  const float *row)
{
    double best = BAND, width = 0.0, spacing;
    int other = code;
    for (int i = 0; i < NEIGHBOURS; i++) {
        const int next = d->neighbour[(size_t)code * NEIGHBOURS + (size_t)i];
        const double part =
            part_of_way(d, own, d->vectors + (size_t)code * d->planes, next, &spacing);
        if (part > best) {
            best = part;
            width = spacing;
            other = next;
        }
    }
    if (other != code && change_at(d, row, x) > MOST_CHANGE * MOST_CHANGE * width)
        other = code;
    d->other[y * d->width + x] = (uint16_t)other;
}

// ---------------------------------------------------------------- contours

// Indices cost where neighbours differ, about the logarithm of by how much: so does PIZ. What a
// pixel of a band costs of such an edge: 0.6 on a smooth picture, less on noisy ones.
#define BAND_PRICE 0.6

static double edge_cost(uint16_t a, uint16_t b)
{
    return log2(1.0 + abs(a - b));
}

struct contour {
    uint32_t pair;  // smaller code, larger code
    double area, length;
};

static uint32_t pair_of(uint16_t a, uint16_t b)
{
    return a < b ? (uint32_t)a << 16 | b : (uint32_t)b << 16 | a;
}

static int by_pair(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

static int by_length(const void *a, const void *b)
{
    const struct contour *x = a, *y = b;
    return x->length != y->length ? (x->length < y->length) - (x->length > y->length)
                                  : by_pair(&x->pair, &y->pair);
}

struct contours {
    struct contour *at;
    size_t count;
};

// One for every pair of codes that has a band, in the order of the pairs.
static relume_status find_contours(const struct dither *d, const uint16_t *index,
                                   struct contours *out)
{
    const size_t n = d->width * d->height;
    uint32_t *pairs = mem_array(n, sizeof *pairs);
    size_t found = 0;
    *out = (struct contours){NULL, 0};
    for (size_t i = 0; pairs && i < n; i++)
        if (d->other[i] != index[i])
            pairs[found++] = pair_of(index[i], d->other[i]);
    if (pairs)
        qsort(pairs, found, sizeof *pairs, by_pair);
    out->at = mem_array(found + 1, sizeof *out->at);
    for (size_t i = 0; pairs && out->at && i < found; i++) {
        if (i == 0 || pairs[i] != pairs[i - 1])
            out->at[out->count++] = (struct contour){.pair = pairs[i]};
        out->at[out->count - 1].area += 1.0;
    }
    const bool good = pairs && out->at;
    mem_free(pairs);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

static struct contour *find(const struct contours *c, uint16_t a, uint16_t b)
{
    const struct contour wanted = {.pair = pair_of(a, b)};
    return bsearch(&wanted, c->at, c->count, sizeof *c->at, by_pair);
}

// Lengths of the contours; what all edges cost.
static double measure_edges(const struct dither *d, const uint16_t *index, struct contours *c)
{
    double cost = 0.0;
    for (size_t y = 0; y < d->height; y++)
        for (size_t x = 0; x < d->width; x++) {
            const uint16_t *at = index + y * d->width + x;
            const uint16_t next[2] = {x + 1 < d->width ? at[1] : at[0],
                                      y + 1 < d->height ? at[d->width] : at[0]};
            for (int i = 0; i < 2; i++) {
                struct contour *contour = next[i] == at[0] ? NULL : find(c, at[0], next[i]);
                cost += edge_cost(at[0], next[i]);
                if (contour)
                    contour->length += 1.0;
            }
        }
    return cost;
}

// Leaves the longest contours that fit, in the order of the pairs.
static void choose(const struct dither *d, struct contours *c, double edges)
{
    double left = d->share < 1.0 ? d->share * edges : INFINITY;
    size_t kept = 0;
    qsort(c->at, c->count, sizeof *c->at, by_length);
    for (size_t i = 0; i < c->count; i++) {
        const struct contour *at = &c->at[i];
        const double price =
            BAND_PRICE * at->area * edge_cost((uint16_t)(at->pair >> 16), (uint16_t)at->pair);
        if (price <= left) {
            left -= price;
            c->at[kept++] = *at;
        }
    }
    c->count = kept;
    qsort(c->at, c->count, sizeof *c->at, by_pair);
}

relume_status dither_spend(const struct dither *d, uint16_t *index)
{
    struct contours c;
    relume_status status = find_contours(d, index, &c);
    if (!status) {
        choose(d, &c, measure_edges(d, index, &c));
        for (size_t i = 0; i < d->width * d->height; i++)
            if (d->other[i] != index[i] && (i % d->width / 2 + i / d->width / 2) % 2 &&
                find(&c, index[i], d->other[i]))
                index[i] = d->other[i];
    }
    mem_free(c.at);
    return status;
}
