// plan_fit.c - planes that are coefficients of a viewer's own functions
#include "exchange/foreign/plan_view.h"

#include <math.h>
#include <string.h>

// Plane 3 k + c is the coefficient of function k in channel c.
static void take_channels(struct plan *p, const struct plan_view *v)
{
    const size_t n = (size_t)p->numbers;
    for (int i = 0; i < p->planes; i++) {
        const double *node = v->nodes + (size_t)i * (n + 1);
        memcpy(p->map + (size_t)i * n, node, n * sizeof *p->map);
        p->shift[i] = node[n];
    }
}

// The colour of a pixel is its mean over the captured lights, low and grazing ones counting less.
static void take_colour(struct plan *p, const struct plan_view *v, const struct source *s)
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

static void take_luminance(struct plan *p, const struct plan_view *v, const struct source *s)
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
static void show_ycc(const struct plan *p, struct plan_view *v)
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

static void take_ycc(struct plan *p, struct plan_view *v)
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

static void take_weights(struct plan *p, const struct plan_view *v)
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

relume_status plan_fit(struct plan *p, const struct source *s, const struct functions *functions,
                       enum foreign_form form, int threads)
{
    *p = (struct plan){.form = form,
                       .functions = *functions,
                       .terms = functions->count,
                       .planes = form == FOREIGN_LUMINANCE ? functions->count + 3
                                 : form == FOREIGN_YCC     ? functions->count + 2
                                                           : 3 * functions->count};
    struct plan_view view;
    relume_status status = plan_view_open(&view, p, s, threads);
    if (!status && form == FOREIGN_LUMINANCE)
        take_luminance(p, &view, s);
    else if (!status && form == FOREIGN_YCC)
        take_ycc(p, &view);
    else if (!status)
        take_channels(p, &view);
    if (!status) {
        take_weights(p, &view);
        status = plan_view_loss(&view, &p->lost);
    }
    plan_view_close(&view);
    if (status)
        plan_free(p);
    return status;
}
