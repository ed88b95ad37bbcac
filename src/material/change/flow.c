// flow.c - see flow.h
//
// Lucas and Kanade's equations (1981), summed over the neighbourhoods of nodes with tent weights,
// and each node held to the mean of its neighbours (Horn, Schunck 1981). Normals and brightness are
// compared, each by how much it says beyond its noise; Cauchy weights leave changes aside. From
// smoothed pictures to sharp ones.
#include "material/change/flow.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "core/math/scalar.h"
#include "core/math/sort.h"
#include "material/change/smooth.h"

#include <math.h>
#include <string.h>

enum {
    VALUES = 4,
    LEVELS = 3,
    WARPS = 4,
    SWEEPS = 60,
    LEAST_STEP = 12,
    MOST_STEP = 64,
    SOME = 20000
};
static const double sigmas[LEVELS] = {4.0, 2.0, 1.0};
static const double neighbours = 0.3;  // pixels, by which nodes side by side usually differ
static const double anywhere = 6.0;    // pixels, a usual displacement
static const double shared = 25.0;     // pixels that say the same, since pictures are smooth
static const double tuning = 2.385;

struct node {
    double xx, xy, yy, x, y;
};

struct flow {
    struct place *place;
    struct relume_image a, b;  // VALUES channels
    struct relume_image known;
    double scale[VALUES];  // of the differences
    struct node *node;     // [threads of rows] summed row by row of nodes
    int threads;
};

// Brightness counts as a slope does: a tenth of white as 0.1.
static relume_status values_of(struct relume_image *out, const struct surface *s)
{
    const size_t n = (size_t)s->width * (size_t)s->height;
    const relume_status status = relume_image_create(out, s->width, s->height, VALUES);
    for (size_t i = 0; !status && i < n; i++) {
        memcpy(out->data + VALUES * i, s->normal.data + 3 * i, 3 * sizeof(float));
        out->data[VALUES * i + 3] = s->colour.data[3 * i];
    }
    return status;
}

static relume_status known_of(struct relume_image *out, const struct surface *a,
                              const struct surface *b)
{
    const size_t n = (size_t)a->width * (size_t)a->height;
    const relume_status status = relume_image_create(out, a->width, a->height, 1);
    for (size_t i = 0; !status && i < n; i++)
        out->data[i] = surface_knows(a, i) && surface_knows(b, i) ? 1.0f : 0.0f;
    return status;
}

static relume_status load(struct flow *f, const struct surface *a, const struct surface *b,
                          const struct level *level, double sigma)
{
    struct surface laid = {0};
    relume_status status = place_sample(&laid, b, f->place, a->width, a->height, f->threads);
    if (!status) {
        level_apply(level, &laid, f->threads);
        status = known_of(&f->known, a, &laid);
    }
    if (!status)
        status = values_of(&f->a, a);
    if (!status)
        status = values_of(&f->b, &laid);
    surface_free(&laid);
    if (!status)
        status = smooth_known(&f->a, &f->known, sigma, f->threads);
    if (!status)
        status = smooth_known(&f->b, &f->known, sigma, f->threads);
    return status;
}

static void unload(struct flow *f)
{
    relume_image_destroy(&f->a);
    relume_image_destroy(&f->b);
    relume_image_destroy(&f->known);
}

static relume_status find_scales(struct flow *f)
{
    const size_t n = (size_t)f->a.width * (size_t)f->a.height, step = n / SOME + 1;
    double *some = mem_array(n / step + 1, sizeof *some);
    for (size_t v = 0; some && v < VALUES; v++) {
        size_t count = 0;
        for (size_t i = 0; i < n; i += step)
            if (f->known.data[i] > 0.5f)
                some[count++] =
                    fabs((double)f->a.data[VALUES * i + v] - (double)f->b.data[VALUES * i + v]);
        sort_doubles(some, count);
        f->scale[v] = fmax(count ? 1.4826 * some[count / 2] : 1.0, 1e-4);
    }
    mem_free(some);
    return some ? RELUME_OK : RELUME_ENOMEM;
}

// The equations of one pixel: (difference, gradient across and down) of each value over its scale.
static void add_pixel(struct node *sum, const struct flow *f, int x, int y)
{
    const int width = f->a.width, height = f->a.height;
    const size_t at = (size_t)y * (size_t)width + (size_t)x;
    const size_t left = at - (x > 0), right = at + (x + 1 < width);
    const size_t above = at - (y > 0 ? (size_t)width : 0),
                 below = at + (y + 1 < height ? (size_t)width : 0);
    const float *k = f->known.data;
    if (k[at] < 0.5f || k[left] < 0.5f || k[right] < 0.5f || k[above] < 0.5f || k[below] < 0.5f)
        return;
    double square = 0.0, gx[VALUES], gy[VALUES], r[VALUES];
    for (size_t v = 0; v < VALUES; v++) {
        const float *a = f->a.data + v, *b = f->b.data + v;
        const double s = 1.0 / f->scale[v];
        gx[v] =
            0.25 * s *
            (double)(a[VALUES * right] - a[VALUES * left] + b[VALUES * right] - b[VALUES * left]);
        gy[v] =
            0.25 * s *
            (double)(a[VALUES * below] - a[VALUES * above] + b[VALUES * below] - b[VALUES * above]);
        r[v] = s * (double)(a[VALUES * at] - b[VALUES * at]);
        square += r[v] * r[v];
    }
    const double w = 1.0 / (shared * (1.0 + square / (VALUES * tuning * tuning)));
    for (int v = 0; v < VALUES; v++) {
        sum->xx += w * gx[v] * gx[v];
        sum->xy += w * gx[v] * gy[v];
        sum->yy += w * gy[v] * gy[v];
        sum->x += w * gx[v] * r[v];
        sum->y += w * gy[v] * r[v];
    }
}

// A row of nodes takes the pixels less than a step away from each.
static void sum_nodes(void *context, size_t row, int worker)
{
    (void)worker;
    struct flow *f = context;
    const struct place *p = f->place;
    const int step = (int)p->step, bottom = smaller_of(((int)row + 1) * step, f->a.height);
    for (int column = 0; column < p->columns; column++) {
        struct node *to = f->node + row * (size_t)p->columns + (size_t)column;
        *to = (struct node){0};
        const int end = smaller_of((column + 1) * step, f->a.width);
        for (int y = larger_of(((int)row - 1) * step, 0); y < bottom; y++)
            for (int x = larger_of((column - 1) * step, 0); x < end; x++) {
                const double w = (1.0 - fabs(x + 0.5 - column * step) / step) *
                                 (1.0 - fabs(y + 0.5 - (int)row * step) / step);
                struct node one = {0};
                add_pixel(&one, f, x, y);
                to->xx += w * one.xx, to->xy += w * one.xy, to->yy += w * one.yy;
                to->x += w * one.x, to->y += w * one.y;
            }
    }
}

static void mean_around(double mean[2], int *count, const struct place *p, const double (*d)[2],
                        int column, int row)
{
    static const int side[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    mean[0] = mean[1] = 0.0;
    *count = 0;
    for (int k = 0; k < 4; k++) {
        const int i = column + side[k][0], j = row + side[k][1];
        if (i < 0 || j < 0 || i >= p->columns || j >= p->rows)
            continue;
        for (int c = 0; c < 2; c++)
            mean[c] += d[(size_t)j * (size_t)p->columns + (size_t)i][c];
        ++*count;
    }
    for (int c = 0; c < 2; c++)
        mean[c] /= *count;
}

// From the step that the equations are of to the whole displacement.
static void add_present(struct flow *f)
{
    const struct place *p = f->place;
    for (size_t i = 0; i < (size_t)p->columns * (size_t)p->rows; i++) {
        struct node *n = f->node + i;
        n->x += n->xx * p->d[i][0] + n->xy * p->d[i][1];
        n->y += n->xy * p->d[i][0] + n->yy * p->d[i][1];
    }
}

// Gauss and Seidel's sweeps.
static void solve(struct flow *f)
{
    struct place *p = f->place;
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (int row = 0; row < p->rows; row++)
            for (int column = 0; column < p->columns; column++) {
                const size_t at = (size_t)row * (size_t)p->columns + (size_t)column;
                const struct node *n = f->node + at;
                double mean[2];
                int count;
                mean_around(mean, &count, p, (const double(*)[2])p->d, column, row);
                const double hold = count / (neighbours * neighbours);
                const double own = hold + 1.0 / (anywhere * anywhere);
                const double xx = n->xx + own, yy = n->yy + own;
                const double x = n->x + hold * mean[0], y = n->y + hold * mean[1];
                const double det = xx * yy - n->xy * n->xy;
                p->d[at][0] = (yy * x - n->xy * y) / det;
                p->d[at][1] = (xx * y - n->xy * x) / det;
            }
}

static relume_status warp(struct flow *f, const struct surface *a, const struct surface *b,
                          const struct level *level, double sigma)
{
    relume_status status = load(f, a, b, level, sigma);
    if (!status)
        status = find_scales(f);
    if (!status) {
        thread_for(f->threads, (size_t)f->place->rows, sum_nodes, f);
        add_present(f);
        solve(f);
    }
    unload(f);
    return status;
}

relume_status flow_find(struct place *place, double *longest, const struct surface *a,
                        const struct surface *b, const struct level *level, int threads)
{
    const int side = larger_of(a->width, a->height);
    struct flow f = {.place = place, .threads = threads};
    place->step = smaller_of(larger_of(side / 24, LEAST_STEP), MOST_STEP);
    place->columns = (int)ceil(a->width / place->step) + 1;
    place->rows = (int)ceil(a->height / place->step) + 1;
    const size_t nodes = (size_t)place->columns * (size_t)place->rows;
    place->d = mem_zeroed(nodes, sizeof *place->d);
    f.node = mem_array(nodes, sizeof *f.node);
    relume_status status = place->d && f.node ? RELUME_OK : RELUME_ENOMEM;
    for (int k = 0; !status && k < LEVELS * WARPS; k++)
        status = warp(&f, a, b, level, sigmas[k / WARPS]);
    *longest = 0.0;
    for (size_t i = 0; !status && i < nodes; i++)
        *longest = fmax(*longest, hypot(place->d[i][0], place->d[i][1]));
    mem_free(f.node);
    return status;
}
