// distant.c - the reflectance that distant lights would show, from near ones
//
// A pixel has samples at directions of its own, L_i. Its value at a direction D_j is interpolated
// from the MOST lights nearest to it. The weights come from a Gaussian process
// (Rasmussen and Williams 2006, 2.2, 2.7) with covariance
//     k(a, b) = LAMBERT a.b + exp(-|a - b|)  (+ NUGGET where a = b).
// The first term makes the answer exact where values are linear in the light, as the shading of a
// matte surface is. The second follows the rest. The third keeps noise from growing where D_j lies
// beside all L_i. Weights change slowly over the picture: they are found at nodes and interpolated.
#include "capture/manifest/distant.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "core/math/lsq.h"

#include <string.h>

enum { MOST = 16 };
static const double LAMBERT = 3000.0;
static const double NUGGET = 1e-3;

struct distant {
    const struct near_view *near;
    const vec3 *direction;
    int lights, most;
    int cell, columns;  // pixels between nodes, columns of nodes
    int threads;
    int *chosen;      // [lights][most]: whose values make light j
    float *node[2];   // [columns][lights][most]: the rows of nodes above and below
    int node_row[2];  // which rows they are; -1: none yet
    double *work;     // [workers][most * most + most]
    // of the band in progress
    int filling;
    int row, rows;
    float *band;
    float *column;   // [columns][lights][most] of the picture row, per worker
    float *pixels;   // [workers][lights][3]
    float *weights;  // [workers][lights][most]
};

void distant_destroy(struct distant **distant)
{
    struct distant *d = *distant;
    *distant = NULL;
    if (!d)
        return;
    mem_free(d->chosen);
    mem_free(d->node[0]);
    mem_free(d->node[1]);
    mem_free(d->work);
    mem_free(d->column);
    mem_free(d->pixels);
    mem_free(d->weights);
    mem_free(d);
}

static void choose_nearest(struct distant *d, int light)
{
    int *chosen = d->chosen + light * d->most, n = 0;
    for (int i = 0; i < d->lights; i++) {
        const double score = vec3_dot(d->direction[i], d->direction[light]);
        int at = n < d->most ? n++ : d->most;
        while (at > 0 && vec3_dot(d->direction[chosen[at - 1]], d->direction[light]) < score) {
            if (at < d->most)
                chosen[at] = chosen[at - 1];
            at--;
        }
        if (at < d->most)
            chosen[at] = i;
    }
}

relume_status distant_create(struct distant **out, const struct near_view *near,
                             const vec3 *direction, int threads)
{
    struct distant *d = *out = mem_zeroed(1, sizeof *d);
    if (!d)
        return RELUME_ENOMEM;
    *d = (struct distant){
        .near = near,
        .direction = direction,
        .lights = near->lights,
        .most = near->lights < MOST ? near->lights : MOST,
        .cell = coarse_cell(near->width, near->height),
        .threads = thread_count(threads),
        .node_row = {-1, -1},
    };
    d->columns = (near->width + d->cell - 1) / d->cell + 1;
    const size_t sparse = (size_t)d->lights * (size_t)d->most, columns = (size_t)d->columns;
    const size_t workers = (size_t)d->threads, most = (size_t)d->most;
    d->chosen = mem_array(sparse, sizeof *d->chosen);
    d->node[0] = mem_array(columns * sparse, sizeof *d->node[0]);
    d->node[1] = mem_array(columns * sparse, sizeof *d->node[1]);
    d->work = mem_array(workers * (most * most + most), sizeof *d->work);
    d->column = mem_array(workers * columns * sparse, sizeof *d->column);
    d->pixels = mem_array(workers * (size_t)d->lights, 3 * sizeof *d->pixels);
    d->weights = mem_array(workers * sparse, sizeof *d->weights);
    if (!d->chosen || !d->node[0] || !d->node[1] || !d->work || !d->column || !d->pixels ||
        !d->weights) {
        distant_destroy(out);
        return RELUME_ENOMEM;
    }
    for (int j = 0; j < d->lights; j++)
        choose_nearest(d, j);
    return RELUME_OK;
}

// ---------------------------------------------------------------- nodes

static double covariance(vec3 a, vec3 b)
{
    return LAMBERT * vec3_dot(a, b) + exp(-vec3_length(vec3_sub(a, b)));
}

static void solve_light(const struct distant *d, const vec3 *seen, int light, double *work,
                        float *weights)
{
    const int n = d->most, *chosen = d->chosen + light * n;
    double *m = work, *b = work + n * n;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= i; j++)
            m[i * n + j] = covariance(seen[chosen[i]], seen[chosen[j]]) + (i == j ? NUGGET : 0.0);
        b[i] = covariance(seen[chosen[i]], d->direction[light]);
    }
    const bool solved = lsq_solve(m, n, b, 1);
    for (int i = 0; i < n; i++)
        weights[i] = solved ? (float)b[i] : (float)(chosen[i] == light);
}

static void solve_node(void *context, size_t item, int worker)
{
    struct distant *d = context;
    const int n = d->most, row = d->node_row[d->filling];
    const vec3 point =
        near_view_around(d->near, (double)item * d->cell, (double)row * d->cell, d->cell / 2);
    vec3 *seen = mem_array((size_t)d->lights, sizeof *seen);
    float *to = d->node[d->filling] + item * (size_t)(d->lights * n);
    double *work = d->work + (size_t)worker * (size_t)(n * n + n);
    double gain;
    for (int i = 0; seen && i < d->lights; i++)
        seen[i] = near_view_direction(&gain, d->near, i, point);
    for (int j = 0; j < d->lights; j++)
        if (seen)
            solve_light(d, seen, j, work, to + j * n);
        else
            to[j * n] = NAN;
    mem_free(seen);
}

// The nodes of row `row` lie in node[row % 2] afterwards. False when memory is short.
static bool need_nodes(struct distant *d, int row)
{
    d->filling = row % 2;
    if (d->node_row[d->filling] == row)
        return true;
    d->node_row[d->filling] = row;
    thread_for(d->threads, (size_t)d->columns, solve_node, d);
    for (int c = 0; c < d->columns; c++)
        if (isnan(d->node[d->filling][(size_t)c * (size_t)(d->lights * d->most)])) {
            d->node_row[d->filling] = -1;
            return false;
        }
    return true;
}

// ---------------------------------------------------------------- pixels

static void mix(float *to, const float *a, const float *b, float part, size_t n)
{
    for (size_t i = 0; i < n; i++)
        to[i] = a[i] + part * (b[i] - a[i]);
}

// The value of one pixel under every distant light.
static void resample_pixel(const struct distant *d, const float *weights, float *pixel, float *band,
                           size_t stride)
{
    const int n = d->most;
    for (int i = 0; i < d->lights; i++)
        memcpy(pixel + 3 * i, band + (size_t)i * stride, 3 * sizeof *pixel);
    for (int j = 0; j < d->lights; j++) {
        const int *chosen = d->chosen + j * n;
        const float *w = weights + j * n;
        float sum[3] = {0.0f};
        for (int i = 0; i < n; i++)
            for (int c = 0; c < 3; c++)
                sum[c] += w[i] * pixel[3 * chosen[i] + c];
        memcpy(band + (size_t)j * stride, sum, sizeof sum);
    }
}

static void resample_row(void *context, size_t item, int worker)
{
    struct distant *d = context;
    const size_t sparse = (size_t)d->lights * (size_t)d->most, width = (size_t)d->near->width;
    const int y = d->row + (int)item, cell = d->cell, above = y / cell;
    float *column = d->column + (size_t)worker * (size_t)d->columns * sparse;
    float *weights = d->weights + (size_t)worker * sparse;
    float *pixel = d->pixels + (size_t)worker * (size_t)d->lights * 3;
    mix(column, d->node[above % 2], d->node[(above + 1) % 2],
        ((float)(y - above * cell) + 0.5f) / (float)cell, (size_t)d->columns * sparse);
    for (size_t x = 0; x < width; x++) {
        const float *left = column + x / (size_t)cell * sparse;
        mix(weights, left, left + sparse, ((float)(x % (size_t)cell) + 0.5f) / (float)cell, sparse);
        resample_pixel(d, weights, pixel, d->band + 3 * (item * width + x),
                       3 * (size_t)d->rows * width);
    }
}

relume_status distant_resample(struct distant *distant, int row, int rows, float *band)
{
    const int last = row + rows;
    distant->rows = rows;
    for (int y = row; y < last;) {
        const int node = y / distant->cell, next = (node + 1) * distant->cell;
        const int end = next < last ? next : last;
        if (!need_nodes(distant, node) || !need_nodes(distant, node + 1))
            return RELUME_ENOMEM;
        distant->row = y;
        distant->band = band + 3 * (size_t)(y - row) * (size_t)distant->near->width;
        thread_for(distant->threads, (size_t)(end - y), resample_row, distant);
        y = end;
    }
    return RELUME_OK;
}
