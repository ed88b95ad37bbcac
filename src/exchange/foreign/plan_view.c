// plan_view.c - least squares over the directions that a viewer may ask for
#include "exchange/foreign/plan_view.h"

#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "core/math/vec.h"

#include <math.h>
#include <string.h>

enum { SPIRAL = 2048 };

// Pull towards the nodes' own values, relative to the mean diagonal of the normal equations.
#define NODE_PULL 1e-3
#define FIT_RIDGE 1e-6

void plan_free(struct plan *p)
{
    mem_free(p->map);
    mem_free(p->shift);
    mem_free(p->transform);
    mem_free(p->mean);
    mem_free(p->weight);
    mem_free(p->energy);
    *p = (struct plan){0};
}

void plan_view_close(struct plan_view *v)
{
    mem_free(v->direction);
    mem_free(v->share);
    mem_free(v->f);
    mem_free(v->a);
    mem_free(v->nodes);
    mem_free(v->shown);
    mem_free(v->mean);
    mem_free(v->covariance);
    *v = (struct plan_view){0};
}

static void choose_directions(struct plan_view *v, const struct source *s)
{
    const int n = v->directions - SPIRAL;
    for (int i = 0; i < n; i++) {
        v->direction[i] = s->light[i];
        v->share[i] = 0.5 / n;
    }
    for (int i = 0; i < SPIRAL; i++) {
        const double z = (i + 0.5) / SPIRAL, r = sqrt(1.0 - z * z);
        const double phi = i * (M_PI * (3.0 - sqrt(5.0)));
        v->direction[n + i] = vec3_of(r * cos(phi), r * sin(phi), z);
        v->share[n + i] = 0.5 / SPIRAL;
    }
}

static relume_status begin(struct plan_view *v, const struct source *s, const struct functions *f)
{
    *v = (struct plan_view){
        .directions = s->lights + SPIRAL, .functions = f->count, .numbers = s->numbers};
    const size_t d = (size_t)v->directions, width = 3 * ((size_t)s->numbers + 1);
    v->direction = mem_array(d, sizeof *v->direction);
    v->share = mem_array(d, sizeof *v->share);
    v->f = mem_array(d * (size_t)f->count, sizeof *v->f);
    v->a = mem_array(d * width, sizeof *v->a);
    v->nodes = mem_array((size_t)f->count * width, sizeof *v->nodes);
    v->shown = mem_array(d * width, sizeof *v->shown);
    v->mean = mem_array((size_t)s->numbers, sizeof *v->mean);
    v->covariance = mem_array((size_t)s->numbers * (size_t)s->numbers, sizeof *v->covariance);
    if (!v->direction || !v->share || !v->f || !v->a || !v->nodes || !v->shown || !v->mean ||
        !v->covariance)
        return RELUME_ENOMEM;
    choose_directions(v, s);
    for (size_t i = 0; i < d; i++) {
        functions_at(f, v->direction[i], v->f + i * (size_t)f->count);
        source_weights(s, v->direction[i], v->a + i * width);
    }
    return RELUME_OK;
}

// out = share x in, row by row
static double *weighted(const struct plan_view *v, const double *in, int columns)
{
    const size_t n = (size_t)v->directions * (size_t)columns;
    double *out = mem_array(n, sizeof *out);
    for (size_t i = 0; out && i < n; i++)
        out[i] = v->share[i / (size_t)columns] * in[i];
    return out;
}

// nodes = (F^T S F + pull)^-1 (F^T S A + pull x prior); no prior: zero.
static relume_status solve_nodes(struct plan_view *v, const double *prior, double pull)
{
    const int n = v->functions, width = 3 * (v->numbers + 1);
    const size_t nodes = (size_t)n * (size_t)width;
    double *sf = weighted(v, v->f, n);
    double *h = mem_array((size_t)n * (size_t)n, sizeof *h);
    double *b = mem_array(nodes, sizeof *b), *half = mem_array(nodes, sizeof *half);
    relume_status status = sf && h && b && half ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        double trace = 0.0;
        lsq_product(true, false, n, n, v->directions, sf, v->f, h);
        lsq_product(true, false, n, width, v->directions, sf, v->a, b);
        for (int i = 0; i < n; i++)
            trace += h[i * n + i] / n;
        for (int i = 0; i < n; i++)
            h[i * n + i] += pull * trace;
        for (size_t i = 0; prior && i < nodes; i++)
            b[i] += pull * trace * prior[i];
        // L^-1 of h = L L^T, in place of h.
        status = lsq_cholesky(h, n) && lsq_invert_lower(h, n) ? RELUME_OK : RELUME_ENOMEM;
    }
    if (!status) {
        lsq_product(false, false, n, width, n, h, b, half);
        lsq_product(true, false, n, width, n, h, half, v->nodes);
        lsq_product(false, false, v->directions, width, n, v->f, v->nodes, v->shown);
    }
    mem_free(sf);
    mem_free(h);
    mem_free(b);
    mem_free(half);
    return status;
}

static relume_status fit_nodes(struct plan_view *v, const struct source *s,
                               const struct functions *f)
{
    if (f->kind != FUNCTIONS_GRID && f->kind != FUNCTIONS_GAUSS)
        return solve_nodes(v, NULL, FIT_RIDGE);
    const size_t width = 3 * ((size_t)s->numbers + 1);
    double *prior = mem_array((size_t)f->count * width, sizeof *prior);
    if (!prior)
        return RELUME_ENOMEM;
    for (int i = 0; i < f->count; i++)
        source_weights(
            s, f->kind == FUNCTIONS_GRID ? functions_grid_node(f->resolution, i) : f->lights[i],
            prior + (size_t)i * width);
    relume_status status = RELUME_OK;
    if (f->kind == FUNCTIONS_GRID) {
        status = solve_nodes(v, prior, NODE_PULL);
    } else {
        memcpy(v->nodes, prior, (size_t)f->count * width * sizeof *prior);
        lsq_product(false, false, v->directions, (int)width, f->count, v->f, v->nodes, v->shown);
    }
    mem_free(prior);
    return status;
}

static relume_status alloc_plan(struct plan *p, const struct source *s)
{
    const size_t planes = (size_t)p->planes;
    p->numbers = s->numbers;
    p->map = mem_zeroed(planes * (size_t)s->numbers, sizeof *p->map);
    p->shift = mem_zeroed(planes, sizeof *p->shift);
    p->weight = mem_zeroed(planes, sizeof *p->weight);
    p->energy = mem_zeroed(planes, sizeof *p->energy);
    if (p->form == FOREIGN_JOINT) {
        const size_t n = 3 * (size_t)p->functions.count;
        p->transform = mem_zeroed(planes * n, sizeof *p->transform);
        p->mean = mem_zeroed(n, sizeof *p->mean);
        if (!p->transform || !p->mean)
            return RELUME_ENOMEM;
    }
    return p->map && p->shift && p->weight && p->energy ? RELUME_OK : RELUME_ENOMEM;
}

relume_status plan_view_open(struct plan_view *v, struct plan *p, const struct source *s,
                             int threads)
{
    relume_status status = begin(v, s, &p->functions);
    if (!status)
        status = alloc_plan(p, s);
    if (!status)
        status = source_statistics(s, threads, v->mean, v->covariance);
    return status ? status : fit_nodes(v, s, &p->functions);
}

relume_status plan_view_loss(const struct plan_view *v, double *lost)
{
    const size_t p = (size_t)v->numbers, rows = 3 * (size_t)v->directions;
    double *clean = mem_array(rows * p, sizeof *clean);
    double *product = mem_array(rows * p, sizeof *product);
    *lost = 0.0;
    for (size_t i = 0; clean && i < rows; i++)
        for (size_t j = 0; j < p; j++)
            clean[i * p + j] = v->a[i * (p + 1) + j] - v->shown[i * (p + 1) + j];
    if (clean && product)
        lsq_product(false, false, (int)rows, v->numbers, v->numbers, clean, v->covariance, product);
    for (size_t i = 0; clean && product && i < rows; i++) {
        double bias = v->a[i * (p + 1) + p] - v->shown[i * (p + 1) + p], square = 0.0;
        for (size_t j = 0; j < p; j++) {
            bias += clean[i * p + j] * v->mean[j];
            square += clean[i * p + j] * product[i * p + j];
        }
        *lost += v->share[i / 3] * (square + bias * bias);
    }
    const bool good = clean && product;
    mem_free(clean);
    mem_free(product);
    return good ? RELUME_OK : RELUME_ENOMEM;
}
