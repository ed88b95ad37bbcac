// plan_components.c - principal components of the pictures as a viewer shows them: one set for R, G
// and B together, in the metric of those pictures, G = sum w A'^T A'
#include "exchange/foreign/plan_view.h"
#include "exchange/foreign/principal.h"

#include "core/base/memory.h"
#include "core/math/lsq.h"

#include <math.h>
#include <string.h>

static double product(const double *a, const double *b, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

static void take_components(struct plan *p, const struct plan_view *v, const struct principal *c)
{
    const int n = p->numbers, f = p->functions.count;
    const size_t row = (size_t)n;
    p->lost += c->total;
    memcpy(p->map, c->forward, (size_t)p->planes * row * sizeof *p->map);
    for (int k = 0; k < p->planes; k++) {
        p->weight[k] = 1.0;
        p->energy[k] = fmax(0.0, c->value[k]);
        p->lost -= p->energy[k];
        p->shift[k] = -product(c->forward + (size_t)k * row, v->mean, n);
    }
    p->lost = fmax(p->lost, 0.0);
    for (int j = 0; j < f; j++)
        for (int ch = 0; ch < 3; ch++) {
            const double *node = v->nodes + (size_t)(3 * j + ch) * (row + 1);
            p->mean[ch * f + j] = node[n] + product(node, v->mean, n);
            for (int k = 0; k < p->planes; k++)
                p->transform[(ch * p->planes + k) * f + j] =
                    product(node, c->back + (size_t)k * row, n);
        }
}

// What the viewer shows, without the constants: [3 directions][P], rows times the root of share.
static double *metric_of(const struct plan_view *v)
{
    const size_t p = (size_t)v->numbers, rows = 3 * (size_t)v->directions;
    double *root = mem_array(rows * p, sizeof *root), *gram = mem_array(p * p, sizeof *gram);
    for (size_t i = 0; root && i < rows; i++)
        for (size_t j = 0; j < p; j++)
            root[i * p + j] = sqrt(v->share[i / 3]) * v->shown[i * (p + 1) + j];
    if (root && gram)
        lsq_product(true, false, v->numbers, v->numbers, (int)rows, root, root, gram);
    if (!root) {
        mem_free(gram);
        gram = NULL;
    }
    mem_free(root);
    return gram;
}

relume_status plan_components(struct plan *p, const struct source *s,
                              const struct functions *functions, int planes, int threads)
{
    const int n = s->numbers;
    *p = (struct plan){.form = FOREIGN_JOINT,
                       .functions = *functions,
                       .terms = planes < n ? planes : n,
                       .planes = planes < n ? planes : n};
    struct plan_view view;
    struct principal c = {0};
    double *metric = NULL;
    relume_status status = plan_view_open(&view, p, s, threads);
    if (!status && !(metric = metric_of(&view)))
        status = RELUME_ENOMEM;
    if (!status)
        status = principal_find(&c, metric, view.covariance, n, p->planes);
    if (!status)
        status = plan_view_loss(&view, &p->lost);
    if (!status)
        take_components(p, &view, &c);
    plan_view_close(&view);
    principal_free(&c);
    mem_free(metric);
    if (status)
        plan_free(p);
    return status;
}
