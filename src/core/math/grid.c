// grid.c - least squares of the differences between neighbours
#include "core/math/grid.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

#include <math.h>
#include <string.h>

enum { LEVELS = 16, SIDE = 3, LAST = 8 };  // the coarsest side, and how often it is relaxed
enum { SERIAL = 1 << 14 };                 // fewer pixels are no work for threads
// Cells whose values are all equal are too stiff: a slope costs them twice what it should.
static const float OVERCORRECTION = 0.5f;

struct level {
    int width, height, threads;
    float screen;
    float *right, *down, *x, *b;  // A x = b
};

struct grid_work {
    int levels;
    struct level level[LEVELS];
    float *along, *pushed;  // the direction of a step, A times it: `across` and `below` before
    double *sums;           // [height]
    double scale;           // of a step, for the loops over rows
    struct grid *grid;
};

// ---------------------------------------------------------------- planes with zeros around them

static size_t margin(int width)
{
    return (size_t)width + 1;
}

static float *plane_create(int width, int height)
{
    float *const all = mem_zeroed((size_t)width * (size_t)height + 2 * margin(width), sizeof *all);
    return all ? all + margin(width) : NULL;
}

static void plane_destroy(float *plane, int width)
{
    if (plane)
        mem_free(plane - margin(width));
}

static void for_rows(const struct level *l, void (*body)(void *, size_t, int), void *context)
{
    const size_t pixels = (size_t)l->width * (size_t)l->height;
    thread_for(pixels < SERIAL ? 1 : l->threads, (size_t)l->height, body, context);
}

// ---------------------------------------------------------------- one level

static inline float diagonal(const struct level *l, size_t at)
{
    return l->right[at] + l->right[at - 1] + l->down[at] + l->down[at - (size_t)l->width] +
           l->screen;
}

// What the four neighbours pull at a pixel.
static inline float pull(const struct level *l, const float *x, size_t at)
{
    const size_t w = (size_t)l->width;
    return l->right[at] * x[at + 1] + l->right[at - 1] * x[at - 1] + l->down[at] * x[at + w] +
           l->down[at - w] * x[at - w];
}

// -A x at a pixel, of differences: what all pixels have in common leaves no rounding behind.
static inline float draw(const struct level *l, const float *x, size_t at)
{
    const size_t w = (size_t)l->width;
    const float here = x[at];
    return l->right[at] * (x[at + 1] - here) + l->right[at - 1] * (x[at - 1] - here) +
           l->down[at] * (x[at + w] - here) + l->down[at - w] * (x[at - w] - here) -
           l->screen * here;
}

static void relax_row(const struct level *l, size_t y, size_t colour)
{
    const size_t w = (size_t)l->width, row = y * w;
    for (size_t x = (y + colour) & 1; x < w; x += 2) {
        const float d = diagonal(l, row + x);
        l->x[row + x] = d > 0.0f ? (l->b[row + x] + pull(l, l->x, row + x)) / d : 0.0f;
    }
}

static void relax_red(void *context, size_t y, int worker)
{
    (void)worker;
    relax_row(context, y, 0);
}

static void relax_black(void *context, size_t y, int worker)
{
    (void)worker;
    relax_row(context, y, 1);
}

// ---------------------------------------------------------------- from one level to the next

static void merge_weights(void *context, size_t y, int worker)
{
    (void)worker;
    struct level *const l = context, *const fine = l - 1;
    const size_t w = (size_t)fine->width;
    const bool two_rows = 2 * y + 1 < (size_t)fine->height;
    for (size_t x = 0; x < (size_t)l->width; x++) {
        const size_t at = 2 * y * w + 2 * x, to = y * (size_t)l->width + x;
        const bool two_columns = 2 * x + 1 < w;
        float right = 0.0f, down = 0.0f;
        if (two_columns)
            right = fine->right[at + 1] + (two_rows ? fine->right[at + w + 1] : 0.0f);
        if (two_rows)
            down = fine->down[at + w] + (two_columns ? fine->down[at + w + 1] : 0.0f);
        l->right[to] = OVERCORRECTION * right;
        l->down[to] = OVERCORRECTION * down;
    }
}

static inline float rest(const struct level *l, size_t at)
{
    return l->b[at] + draw(l, l->x, at);
}

// After black pixels were relaxed the red ones alone are off.
static void restrict_row(void *context, size_t y, int worker)
{
    (void)worker;
    struct level *const l = context, *const fine = l - 1;
    const size_t w = (size_t)fine->width;
    const bool two_rows = 2 * y + 1 < (size_t)fine->height;
    for (size_t x = 0; x < (size_t)l->width; x++) {
        const size_t at = 2 * y * w + 2 * x;
        float sum = rest(fine, at);
        if (two_rows && 2 * x + 1 < w)
            sum += rest(fine, at + w + 1);
        l->b[y * (size_t)l->width + x] = sum;
        l->x[y * (size_t)l->width + x] = 0.0f;
    }
}

static void extend_row(void *context, size_t y, int worker)
{
    (void)worker;
    struct level *const l = context;
    const struct level *const coarse = l + 1;
    float *const x = l->x + y * (size_t)l->width;
    const float *const from = coarse->x + y / 2 * (size_t)coarse->width;
    for (size_t i = 0; i < (size_t)l->width; i++)
        x[i] += from[i / 2];
}

// x = an approximation of A^-1 b, linear and symmetric in b.
static void cycle(struct grid_work *g, int level)
{
    struct level *const l = g->level + level;
    const bool coarsest = level + 1 == g->levels;
    for (int i = 0; i < (coarsest ? LAST : 1); i++) {
        for_rows(l, relax_red, l);
        for_rows(l, relax_black, l);
    }
    if (!coarsest) {
        for_rows(l + 1, restrict_row, l + 1);
        cycle(g, level + 1);
        for_rows(l, extend_row, l);
    }
    for (int i = 0; i < (coarsest ? LAST : 1); i++) {
        for_rows(l, relax_black, l);
        for_rows(l, relax_red, l);
    }
}

// ---------------------------------------------------------------- conjugate gradients

static double sum_of(const struct grid_work *g)
{
    double sum = 0.0;
    for (int y = 0; y < g->grid->height; y++)
        sum += g->sums[y];
    return sum;
}

static void dot_row(void *context, size_t y, int worker)
{
    (void)worker;
    struct grid_work *const g = context;
    const size_t w = (size_t)g->grid->width, row = y * w;
    const float *const a = g->level[0].x + row, *const b = g->level[0].b + row;
    double sum = 0.0;
    for (size_t i = 0; i < w; i++)
        sum += (double)(a[i] * b[i]);
    g->sums[y] = sum;
}

// The part of b that M b sees: (b, M b), with M b left in x.
static double precondition(struct grid_work *g)
{
    struct level *const l = g->level;
    memset(l->x, 0, (size_t)l->width * (size_t)l->height * sizeof *l->x);
    cycle(g, 0);
    for_rows(l, dot_row, g);
    return sum_of(g);
}

static void turn_row(void *context, size_t y, int worker)
{
    (void)worker;
    struct grid_work *const g = context;
    const size_t w = (size_t)g->grid->width, row = y * w;
    const float scale = (float)g->scale;
    for (size_t i = row; i < row + w; i++)
        g->along[i] = g->level[0].x[i] + scale * g->along[i];
}

static void push_row(void *context, size_t y, int worker)
{
    (void)worker;
    struct grid_work *const g = context;
    const size_t w = (size_t)g->grid->width, row = y * w;
    double sum = 0.0;
    for (size_t i = row; i < row + w; i++) {
        g->pushed[i] = -draw(g->level, g->along, i);
        sum += (double)(g->pushed[i] * g->along[i]);
    }
    g->sums[y] = sum;
}

static void step_row(void *context, size_t y, int worker)
{
    (void)worker;
    struct grid_work *const g = context;
    const size_t w = (size_t)g->grid->width, row = y * w;
    const float scale = (float)g->scale;
    for (size_t i = row; i < row + w; i++) {
        g->grid->z[i] += scale * g->along[i];
        g->level[0].b[i] -= scale * g->pushed[i];
    }
}

// What the pairs push at a pixel.
static void force_row(void *context, size_t y, int worker)
{
    (void)worker;
    struct grid_work *const g = context;
    const size_t w = (size_t)g->grid->width, h = (size_t)g->grid->height;
    for (size_t x = 0; x < w; x++) {
        const size_t at = y * w + x;
        g->level[0].b[at] = (x > 0 ? g->along[at - 1] : 0.0f) - (x + 1 < w ? g->along[at] : 0.0f) +
                            (y > 0 ? g->pushed[at - w] : 0.0f) - (y + 1 < h ? g->pushed[at] : 0.0f);
    }
}

static void clear_row(void *context, size_t y, int worker)
{
    (void)worker;
    struct grid_work *const g = context;
    const size_t w = (size_t)g->grid->width;
    memset(g->along + y * w, 0, w * sizeof *g->along);
}

static void rest_row(void *context, size_t y, int worker)
{
    (void)worker;
    struct grid_work *const g = context;
    const size_t w = (size_t)g->grid->width, row = y * w;
    const float *const z = g->grid->z;
    for (size_t i = row; i < row + w; i++)
        g->level[0].b[i] += draw(g->level, z, i);
}

void grid_solve(struct grid *grid, int steps, double share)
{
    struct grid_work *const g = grid->work;
    struct level *const l = g->level;
    for_rows(l, force_row, g);
    for_rows(l, clear_row, g);
    for (int i = 1; i < g->levels; i++)
        for_rows(l + i, merge_weights, l + i);
    const double all = precondition(g);
    for_rows(l, rest_row, g);
    double left = precondition(g);
    const double enough = share * share * fmin(all, left);
    g->scale = 0.0;
    for (int i = 0; i < steps && left > enough; i++) {
        for_rows(l, turn_row, g);
        for_rows(l, push_row, g);
        g->scale = left / sum_of(g);
        for_rows(l, step_row, g);
        const double before = left;
        left = precondition(g);
        g->scale = left / before;
    }
}

// ---------------------------------------------------------------- memory

static bool level_create(struct level *l)
{
    l->right = plane_create(l->width, l->height);
    l->down = plane_create(l->width, l->height);
    l->x = plane_create(l->width, l->height);
    l->b = plane_create(l->width, l->height);
    return l->right && l->down && l->x && l->b;
}

relume_status grid_create(struct grid *out, int width, int height, float screen, int threads)
{
    struct grid_work *const g = mem_zeroed(1, sizeof *g);
    *out = (struct grid){width, height, threads, screen, .work = g};
    if (!g)
        return RELUME_ENOMEM;
    g->grid = out;
    g->along = plane_create(width, height);
    g->pushed = plane_create(width, height);
    g->sums = mem_array((size_t)height, sizeof *g->sums);
    out->z = plane_create(width, height);
    struct level next = {.width = width, .height = height, .threads = threads, .screen = screen};
    bool good = g->along && g->pushed && g->sums && out->z;
    while (good && g->levels < LEVELS) {
        struct level *const l = g->level + g->levels++;
        *l = next;
        good = level_create(l);
        if (l->width <= SIDE && l->height <= SIDE)
            break;
        next = (struct level){.width = (l->width + 1) / 2,
                              .height = (l->height + 1) / 2,
                              .threads = threads,
                              .screen = 4.0f * l->screen};
    }
    out->right = g->level[0].right;
    out->down = g->level[0].down;
    out->across = g->along;
    out->below = g->pushed;
    return good ? RELUME_OK : RELUME_ENOMEM;
}

void grid_destroy(struct grid *grid)
{
    struct grid_work *const g = grid->work;
    for (int i = 0; g && i < g->levels; i++) {
        struct level *const l = g->level + i;
        plane_destroy(l->right, l->width);
        plane_destroy(l->down, l->width);
        plane_destroy(l->x, l->width);
        plane_destroy(l->b, l->width);
    }
    plane_destroy(grid->z, grid->width);
    if (g) {
        plane_destroy(g->along, grid->width);
        plane_destroy(g->pushed, grid->width);
        mem_free(g->sums);
    }
    mem_free(g);
    *grid = (struct grid){0};
}
