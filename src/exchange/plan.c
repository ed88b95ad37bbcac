// plan.c - least squares over the directions that a viewer may ask for
//
// Directions: the captured lights, and a spiral over the hemisphere, half of the weight each. A
// viewer's functions f stand for the picture A(l) x as f(l) N x, N by least squares with a small
// pull towards the values at the nodes. In the metric of the pictures so shown, G = sum w A'^T A',
// the principal components of x are those of G^1/2 x; one unit of any of them is one unit of error.
#include "exchange/plan.h"

#include "base/memory.h"
#include "math/lsq.h"
#include "math/vec.h"

#include <math.h>
#include <string.h>

enum { SPIRAL = 2048 };

// Pull towards the nodes' own values, relative to the mean diagonal of the normal equations.
#define NODE_PULL 1e-3
#define FIT_RIDGE 1e-6

void plan_free(struct plan *p)
{
    free(p->map);
    free(p->shift);
    free(p->transform);
    free(p->mean);
    free(p->weight);
    free(p->energy);
    *p = (struct plan){0};
}

// ---------------------------------------------------------------- directions

struct view {
    int directions, functions, numbers;
    struct relume_vec3 *direction;
    double *share;  // [directions], sums to 1
    double *f;      // [directions][functions]
    double *a;      // [directions][3][P + 1]: what the file shows
    double *nodes;  // [functions][3][P + 1]
    double *shown;  // [directions][3][P + 1]: what the viewer shows
};

static void free_view(struct view *v)
{
    free(v->direction);
    free(v->share);
    free(v->f);
    free(v->a);
    free(v->nodes);
    free(v->shown);
}

static void choose_directions(struct view *v, const struct source *s)
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

static relume_status open_view(struct view *v, const struct source *s, const struct functions *f)
{
    *v =
        (struct view){s->lights + SPIRAL, f->count, s->numbers, NULL, NULL, NULL, NULL, NULL, NULL};
    const size_t d = (size_t)v->directions, width = 3 * ((size_t)s->numbers + 1);
    v->direction = mem_array(d, sizeof *v->direction);
    v->share = mem_array(d, sizeof *v->share);
    v->f = mem_array(d * (size_t)f->count, sizeof *v->f);
    v->a = mem_array(d * width, sizeof *v->a);
    v->nodes = mem_array((size_t)f->count * width, sizeof *v->nodes);
    v->shown = mem_array(d * width, sizeof *v->shown);
    if (!v->direction || !v->share || !v->f || !v->a || !v->nodes || !v->shown)
        return RELUME_ENOMEM;
    choose_directions(v, s);
    for (size_t i = 0; i < d; i++) {
        functions_at(f, v->direction[i], v->f + i * (size_t)f->count);
        source_weights(s, v->direction[i], v->a + i * width);
    }
    return RELUME_OK;
}

// out = share x in, row by row
static double *weighted(const struct view *v, const double *in, int columns)
{
    const size_t n = (size_t)v->directions * (size_t)columns;
    double *out = mem_array(n, sizeof *out);
    for (size_t i = 0; out && i < n; i++)
        out[i] = v->share[i / (size_t)columns] * in[i];
    return out;
}

// L^-1 of h = L L^T, in place of h.
static bool invert_factor(double *h, int n)
{
    return lsq_cholesky(h, n) && lsq_invert_lower(h, n);
}

// nodes = (F^T S F + pull)^-1 (F^T S A + pull x prior); no prior: zero.
static relume_status solve_nodes(struct view *v, const double *prior, double pull)
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
        status = invert_factor(h, n) ? RELUME_OK : RELUME_ENOMEM;
    }
    if (!status) {
        lsq_product(false, false, n, width, n, h, b, half);
        lsq_product(true, false, n, width, n, h, half, v->nodes);
        lsq_product(false, false, v->directions, width, n, v->f, v->nodes, v->shown);
    }
    free(sf);
    free(h);
    free(b);
    free(half);
    return status;
}

static relume_status fit_nodes(struct view *v, const struct source *s, const struct functions *f)
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
    free(prior);
    return status;
}

// The mean over pixels and directions of |(A - A') x|^2, summed over the channels.
static relume_status measure_loss(struct view *v, const double *mean, const double *covariance,
                                  double *lost)
{
    const size_t p = (size_t)v->numbers, rows = 3 * (size_t)v->directions;
    double *clean = mem_array(rows * p, sizeof *clean);
    double *product = mem_array(rows * p, sizeof *product);
    *lost = 0.0;
    for (size_t i = 0; clean && i < rows; i++)
        for (size_t j = 0; j < p; j++)
            clean[i * p + j] = v->a[i * (p + 1) + j] - v->shown[i * (p + 1) + j];
    if (clean && product)
        lsq_product(false, false, (int)rows, v->numbers, v->numbers, clean, covariance, product);
    for (size_t i = 0; clean && product && i < rows; i++) {
        double bias = v->a[i * (p + 1) + p] - v->shown[i * (p + 1) + p], square = 0.0;
        for (size_t j = 0; j < p; j++) {
            bias += clean[i * p + j] * mean[j];
            square += clean[i * p + j] * product[i * p + j];
        }
        *lost += v->share[i / 3] * (square + bias * bias);
    }
    const bool good = clean && product;
    free(clean);
    free(product);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- principal components

// Q diag(value^power), Q's columns being the eigenvectors; tiny values give zero.
static double *scaled_columns(const double *vectors, const double *values, int n, double power)
{
    double *out = mem_array((size_t)n * (size_t)n, sizeof *out);
    const double least = 1e-12 * values[0];
    for (int i = 0; out && i < n; i++)
        for (int j = 0; j < n; j++)
            out[i * n + j] = values[j] > least ? vectors[j * n + i] * pow(values[j], power) : 0.0;
    return out;
}

// Principal components in a metric, the largest first.
struct components {
    int count;
    double total;            // variance of all
    double *value;           // [count] variances
    double *forward, *back;  // [count][P]: c = forward (x - mean), x = mean + back^T c
};

static void free_components(struct components *c)
{
    free(c->value);
    free(c->forward);
    free(c->back);
}

// `metric` [P][P] is destroyed.
static relume_status find_components(struct components *out, double *metric,
                                     const double *covariance, int n, int count)
{
    const size_t size = (size_t)n * (size_t)n, kept = (size_t)count * (size_t)n;
    double *values = mem_array((size_t)n, sizeof *values),
           *vectors = mem_array(size, sizeof *vectors);
    double *half = mem_array(size, sizeof *half), *z = mem_array(size, sizeof *z);
    double *root = NULL, *inverse = NULL;
    *out = (struct components){count, 0.0, mem_array((size_t)count, sizeof(double)),
                               mem_array(kept, sizeof(double)), mem_array(kept, sizeof(double))};
    bool good = values && vectors && half && z && out->value && out->forward && out->back &&
                lsq_eigenvectors(metric, n, n, values, vectors);
    if (good) {
        root = scaled_columns(vectors, values, n, 0.5);
        inverse = scaled_columns(vectors, values, n, -0.5);
        good = root && inverse;
    }
    if (good) {
        lsq_product(false, false, n, n, n, covariance, root, half);
        lsq_product(true, false, n, n, n, root, half, z);
        for (int i = 0; i < n; i++)
            out->total += z[i * n + i];
        good = lsq_eigenvectors(z, n, count, out->value, vectors);
    }
    if (good) {
        lsq_product(false, true, count, n, n, vectors, root, out->forward);
        lsq_product(false, true, count, n, n, vectors, inverse, out->back);
    }
    free(values);
    free(vectors);
    free(half);
    free(z);
    free(root);
    free(inverse);
    return good ? RELUME_OK : RELUME_ENOMEM;
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

static double product(const double *a, const double *b, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

static void take_components(struct plan *p, const struct view *v, const double *mean,
                            const struct components *c)
{
    const int n = p->numbers, f = p->functions.count;
    const size_t row = (size_t)n;
    p->lost += c->total;
    memcpy(p->map, c->forward, (size_t)p->planes * row * sizeof *p->map);
    for (int k = 0; k < p->planes; k++) {
        p->weight[k] = 1.0;
        p->energy[k] = fmax(0.0, c->value[k]);
        p->lost -= p->energy[k];
        p->shift[k] = -product(c->forward + (size_t)k * row, mean, n);
    }
    p->lost = fmax(p->lost, 0.0);
    for (int j = 0; j < f; j++)
        for (int ch = 0; ch < 3; ch++) {
            const double *node = v->nodes + (size_t)(3 * j + ch) * (row + 1);
            p->mean[ch * f + j] = node[n] + product(node, mean, n);
            for (int k = 0; k < p->planes; k++)
                p->transform[(ch * p->planes + k) * f + j] =
                    product(node, c->back + (size_t)k * row, n);
        }
}

// What the viewer shows, without the constants: [3 directions][P], rows times the root of share.
static double *metric_of(const struct view *v)
{
    const size_t p = (size_t)v->numbers, rows = 3 * (size_t)v->directions;
    double *root = mem_array(rows * p, sizeof *root), *gram = mem_array(p * p, sizeof *gram);
    for (size_t i = 0; root && i < rows; i++)
        for (size_t j = 0; j < p; j++)
            root[i * p + j] = sqrt(v->share[i / 3]) * v->shown[i * (p + 1) + j];
    if (root && gram)
        lsq_product(true, false, v->numbers, v->numbers, (int)rows, root, root, gram);
    if (!root) {
        free(gram);
        gram = NULL;
    }
    free(root);
    return gram;
}

// What every plan is made from.
struct preparation {
    struct view view;
    double *mean, *covariance;  // [P], [P][P]
};

static void free_preparation(struct preparation *prepared)
{
    free_view(&prepared->view);
    free(prepared->mean);
    free(prepared->covariance);
}

static relume_status prepare(struct preparation *prepared, struct plan *p, const struct source *s,
                             int threads)
{
    const size_t n = (size_t)s->numbers;
    prepared->mean = mem_array(n, sizeof *prepared->mean);
    prepared->covariance = mem_array(n * n, sizeof *prepared->covariance);
    relume_status status = open_view(&prepared->view, s, &p->functions);
    if (!status && (!prepared->mean || !prepared->covariance))
        status = RELUME_ENOMEM;
    if (!status)
        status = alloc_plan(p, s);
    if (!status)
        status = source_statistics(s, threads, prepared->mean, prepared->covariance);
    return status ? status : fit_nodes(&prepared->view, s, &p->functions);
}

relume_status plan_components(struct plan *p, const struct source *s,
                              const struct functions *functions, int planes, int threads)
{
    const int n = s->numbers;
    *p = (struct plan){.form = FOREIGN_JOINT,
                       .functions = *functions,
                       .terms = planes < n ? planes : n,
                       .planes = planes < n ? planes : n};
    struct preparation prepared;
    struct components c = {0};
    double *metric = NULL;
    relume_status status = prepare(&prepared, p, s, threads);
    if (!status && !(metric = metric_of(&prepared.view)))
        status = RELUME_ENOMEM;
    if (!status)
        status = find_components(&c, metric, prepared.covariance, n, p->planes);
    if (!status)
        status = measure_loss(&prepared.view, prepared.mean, prepared.covariance, &p->lost);
    if (!status)
        take_components(p, &prepared.view, prepared.mean, &c);
    free_preparation(&prepared);
    free_components(&c);
    free(metric);
    if (status)
        plan_free(p);
    return status;
}

// ---------------------------------------------------------------- least squares

// Plane 3 k + c is the coefficient of function k in channel c.
static void take_channels(struct plan *p, const struct view *v)
{
    const size_t n = (size_t)p->numbers;
    for (int i = 0; i < p->planes; i++) {
        const double *node = v->nodes + (size_t)i * (n + 1);
        memcpy(p->map + (size_t)i * n, node, n * sizeof *p->map);
        p->shift[i] = node[n];
    }
}

// The colour of a pixel is its mean over the captured lights, low and grazing ones counting less.
static void take_colour(struct plan *p, const struct view *v, const struct source *s)
{
    const size_t n = (size_t)p->numbers;
    double total = 0.0;
    for (int i = 0; i < s->lights; i++) {
        const double t = asin(fmax(-1.0, fmin(1.0, s->light[i].z))) / (M_PI / 2.0) - 0.5;
        const double share = fmax(0.25 - t * t, 1e-3);
        total += share;
        for (size_t c = 0; c < 3; c++) {
            const double *a = v->a + (3 * (size_t)i + c) * (n + 1);
            const size_t plane = (size_t)p->terms + c;
            for (size_t j = 0; j < n; j++)
                p->map[plane * n + j] += share * a[j];
            p->shift[plane] += share * a[n];
        }
    }
    for (size_t plane = (size_t)p->terms; plane < (size_t)p->planes; plane++) {
        for (size_t j = 0; j < n; j++)
            p->map[plane * n + j] /= total;
        p->shift[plane] /= total;
    }
}

static void take_luminance(struct plan *p, const struct view *v, const struct source *s)
{
    const size_t n = (size_t)p->numbers;
    for (int k = 0; k < p->terms; k++)
        for (size_t c = 0; c < 3; c++) {
            const double *node = v->nodes + (3 * (size_t)k + c) * (n + 1);
            for (size_t j = 0; j < n; j++)
                p->map[(size_t)k * n + j] += node[j];
            p->shift[k] += node[n];
        }
    take_colour(p, v, s);
}

// Y of the nodes; Cb and Cr the mean over the directions, zero standing at 0.5.
static const double ycc_of_rgb[3][3] = {
    {0.299, 0.587, 0.114}, {-0.168736, -0.331264, 0.5}, {0.5, -0.418688, -0.081312}};

// row[P + 1] += factor x (row of ycc_of_rgb) x rgb[3][P + 1]
static void add_component(double *map, double *shift, const double *rgb, size_t n, int component,
                          double factor)
{
    for (size_t c = 0; c < 3; c++) {
        const double f = factor * ycc_of_rgb[component][c];
        for (size_t j = 0; j < n; j++)
            map[j] += f * rgb[c * (n + 1) + j];
        *shift += f * rgb[c * (n + 1) + n];
    }
}

// What the viewer shows: the luminance of v->shown with the mean chrominance.
static void show_ycc(const struct plan *p, struct view *v)
{
    const size_t n = (size_t)p->numbers, k = (size_t)p->terms;
    double *row = v->shown;
    for (int d = 0; d < v->directions; d++)
        for (size_t j = 0; j <= n; j++) {
            double *at = row + (size_t)d * 3 * (n + 1) + j, y = 0.0;
            for (size_t c = 0; c < 3; c++)
                y += ycc_of_rgb[0][c] * at[c * (n + 1)];
            for (size_t c = 0; c < 3; c++) {
                at[c * (n + 1)] = y;
                for (size_t i = 0; i < 2; i++)
                    at[c * (n + 1)] += foreign_rgb_of_ycc[c][i + 1] *
                                       (j < n ? p->map[(k + i) * n + j] : p->shift[k + i] - 0.5);
            }
        }
}

static void take_ycc(struct plan *p, struct view *v)
{
    const size_t n = (size_t)p->numbers, k = (size_t)p->terms, width = 3 * (n + 1);
    for (size_t i = 0; i < k; i++)
        add_component(p->map + i * n, &p->shift[i], v->nodes + i * width, n, 0, 1.0);
    for (size_t i = 0; i < 2; i++) {
        for (int d = 0; d < v->directions; d++)
            add_component(p->map + (k + i) * n, &p->shift[k + i], v->a + (size_t)d * width, n,
                          (int)i + 1, v->share[d]);
        p->shift[k + i] += 0.5;
    }
    show_ycc(p, v);
}

// The root of the squared error of R, G and B together for a unit of error in Y, Cb or Cr.
static double ycc_weight(int component)
{
    double square = 0.0;
    for (int c = 0; c < 3; c++)
        square += foreign_rgb_of_ycc[c][component] * foreign_rgb_of_ycc[c][component];
    return sqrt(square);
}

static void take_weights(struct plan *p, const struct view *v)
{
    for (int k = 0; k < p->terms; k++) {
        double square = 0.0;
        for (int d = 0; d < v->directions; d++) {
            const double f = v->f[d * p->terms + k];
            square += v->share[d] * f * f;
        }
        if (p->form != FOREIGN_CHANNELS)
            p->weight[k] = sqrt(square) * (p->form == FOREIGN_YCC ? ycc_weight(0) : 1.0);
        for (int c = 0; p->form == FOREIGN_CHANNELS && c < 3; c++)
            p->weight[3 * k + c] = sqrt(square);
    }
    for (int i = p->terms; p->form != FOREIGN_CHANNELS && i < p->planes; i++)
        p->weight[i] = p->form == FOREIGN_YCC ? ycc_weight(i - p->terms + 1) : 1.0;
}

static int planes_of(enum foreign_form form, int terms)
{
    return form == FOREIGN_LUMINANCE ? terms + 3 : form == FOREIGN_YCC ? terms + 2 : 3 * terms;
}

relume_status plan_fit(struct plan *p, const struct source *s, const struct functions *functions,
                       enum foreign_form form, int threads)
{
    *p = (struct plan){.form = form,
                       .functions = *functions,
                       .terms = functions->count,
                       .planes = planes_of(form, functions->count)};
    struct preparation prepared;
    relume_status status = prepare(&prepared, p, s, threads);
    if (!status && form == FOREIGN_LUMINANCE)
        take_luminance(p, &prepared.view, s);
    else if (!status && form == FOREIGN_YCC)
        take_ycc(p, &prepared.view);
    else if (!status)
        take_channels(p, &prepared.view);
    if (!status) {
        take_weights(p, &prepared.view);
        status = measure_loss(&prepared.view, prepared.mean, prepared.covariance, &p->lost);
    }
    free_preparation(&prepared);
    if (status)
        plan_free(p);
    return status;
}
