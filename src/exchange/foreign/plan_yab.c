// plan_yab.c - principal components of luminance and of two chromas, each with planes of its own
//
// With a = R - B, t = B + a/2, b = G - t, Y = t + b/2, the squared error of R, G and B is
//     3 (dY - db/6)^2 + da^2/2 + 2 db^2/3.
// So a and b have components of their own, and Y those of Y less a sixth of what b's leave out:
// the three sets are then the best of their sizes for R, G and B.
//
// A file's mean functions are bytes: what they cannot hold, as all that is below zero, stays with
// the planes. The components are therefore of numbers (x - mean, 1), the last of which follows what
// is left of the mean.
#include "exchange/foreign/plan_view.h"
#include "exchange/foreign/principal.h"

#include "core/base/memory.h"
#include "core/math/lsq.h"

#include <math.h>
#include <string.h>

enum { PARTS = 3 };
enum part_name { PART_Y, PART_A, PART_B };

static const double yab_of_rgb[PARTS][3] = {{0.25, 0.5, 0.25}, {1.0, 0.0, -1.0}, {-0.5, 1.0, -0.5}};
static const double energy_of[PARTS] = {3.0, 0.5, 2.0 / 3.0};

struct part {
    double *node;  // [functions][P + 1] of (x - mean, 1)
    double *kept;  // [functions], what the file's mean holds
    struct principal c;
};

struct maker {
    const struct plan_view *view;
    double *covariance;  // [P + 1][P + 1] of (x - mean, 1)
    double *luminance;   // [functions][P + 1]: Y's own nodes
    struct part part[PARTS];
};

static void destroy(struct maker *m)
{
    for (int k = 0; k < PARTS; k++) {
        mem_free(m->part[k].node);
        mem_free(m->part[k].kept);
        principal_free(&m->part[k].c);
    }
    mem_free(m->covariance);
    mem_free(m->luminance);
}

static size_t width_of(const struct maker *m)
{
    return (size_t)m->view->numbers + 1;
}

static void turn_nodes(struct maker *m)
{
    const size_t n = width_of(m);
    for (size_t k = 0; k < PARTS; k++)
        for (size_t j = 0; j < (size_t)m->view->functions; j++) {
            double *to = m->part[k].node + j * n;
            for (size_t i = 0; i < n; i++)
                for (size_t c = 0; c < 3; c++)
                    to[i] += yab_of_rgb[k][c] * m->view->nodes[(3 * j + c) * n + i];
            for (size_t i = 0; i + 1 < n; i++)
                to[n - 1] += to[i] * m->view->mean[i];
        }
}

static relume_status create(struct maker *m, const struct plan_view *view)
{
    *m = (struct maker){.view = view};
    const size_t n = width_of(m), functions = (size_t)view->functions;
    m->covariance = mem_zeroed(n * n, sizeof *m->covariance);
    m->luminance = mem_array(functions * n, sizeof *m->luminance);
    bool good = m->covariance && m->luminance;
    for (int k = 0; k < PARTS; k++) {
        m->part[k].node = mem_zeroed(functions * n, sizeof(double));
        m->part[k].kept = mem_zeroed(functions, sizeof(double));
        good = good && m->part[k].node && m->part[k].kept;
    }
    if (!good)
        return RELUME_ENOMEM;
    for (size_t i = 0; i + 1 < n; i++)
        memcpy(m->covariance + i * n, view->covariance + i * (n - 1), (n - 1) * sizeof(double));
    m->covariance[n * n - 1] = 1.0;
    turn_nodes(m);
    memcpy(m->luminance, m->part[PART_Y].node, functions * n * sizeof *m->luminance);
    return RELUME_OK;
}

static void keep_mean(const struct maker *m, struct part *p)
{
    const size_t n = width_of(m);
    for (size_t j = 0; j < (size_t)m->view->functions; j++) {
        double *mean = p->node + (j + 1) * n - 1;
        p->kept[j] = rint(255.0 * fmin(fmax(*mean, 0.0), 1.0)) / 255.0;
        *mean -= p->kept[j];
    }
}

// `energy` times the mean over the directions of what the viewer shows for the nodes, squared.
static double *metric_of(const struct maker *m, const double *node, double energy)
{
    const struct plan_view *v = m->view;
    const size_t n = width_of(m), d = (size_t)v->directions;
    double *shown = mem_array(d * n, sizeof *shown), *gram = mem_array(n * n, sizeof *gram);
    if (shown && gram) {
        lsq_product(false, false, v->directions, (int)n, v->functions, v->f, node, shown);
        for (size_t i = 0; i < d * n; i++)
            shown[i] *= sqrt(energy * v->share[i / n]);
        lsq_product(true, false, (int)n, (int)n, v->directions, shown, shown, gram);
    }
    mem_free(shown);
    return gram;
}

static relume_status analyse(const struct maker *m, struct part *p, double energy, int count)
{
    keep_mean(m, p);
    double *metric = metric_of(m, p->node, energy);
    if (!metric)
        return RELUME_ENOMEM;
    const int n = (int)width_of(m);
    const relume_status status = principal_find(&p->c, metric, m->covariance, n, count);
    mem_free(metric);
    return status;
}

// What `chroma` components leave of a node of b.
static void find_rest(const struct maker *m, const double *node, int chroma, double *rest)
{
    const size_t n = width_of(m);
    const struct principal *c = &m->part[PART_B].c;
    memcpy(rest, node, n * sizeof *rest);
    for (size_t k = 0; k < (size_t)chroma; k++) {
        double weight = 0.0;
        for (size_t i = 0; i < n; i++)
            weight += node[i] * c->back[k * n + i];
        for (size_t i = 0; i < n; i++)
            rest[i] -= weight * c->forward[k * n + i];
    }
}

static relume_status analyse_luminance(struct maker *m, int chroma, int count)
{
    const size_t n = width_of(m), functions = (size_t)m->view->functions;
    struct part *y = &m->part[PART_Y];
    double *rest = mem_array(n, sizeof *rest);
    for (size_t j = 0; rest && j < functions; j++) {
        find_rest(m, m->part[PART_B].node + j * n, chroma, rest);
        for (size_t i = 0; i < n; i++)
            y->node[j * n + i] = m->luminance[j * n + i] - rest[i] / 6.0;
    }
    principal_free(&y->c);
    const relume_status status = rest ? analyse(m, y, energy_of[PART_Y], count) : RELUME_ENOMEM;
    mem_free(rest);
    return status;
}

struct split {
    int luminance, chroma;
};

// So many pairs of chroma planes that each is worth more than the luminance planes in its stead.
static struct split choose_split(const struct maker *m, int planes)
{
    const struct principal *y = &m->part[PART_Y].c, *a = &m->part[PART_A].c,
                           *b = &m->part[PART_B].c;
    struct split s = {1, 1};
    while (s.luminance + 2 * s.chroma < planes) {
        const bool allowed = s.chroma < s.luminance && s.chroma < a->count &&
                             s.luminance + 2 * (s.chroma + 1) <= planes;
        const bool more = s.luminance < y->count;
        if (allowed &&
            (!more || (a->value[s.chroma] + b->value[s.chroma]) / 2.0 > y->value[s.luminance]))
            s.chroma++;
        else if (more)
            s.luminance++;
        else
            break;
    }
    return s;
}

// ---------------------------------------------------------------- planes

struct place {
    enum part_name part;
    size_t component;
};

static void take_plane(struct plan *p, const struct maker *m, size_t plane)
{
    const size_t n = width_of(m), functions = (size_t)p->functions.count;
    const struct place at = plane < 3 * (size_t)p->chroma
                                ? (struct place){(enum part_name)(plane % 3), plane / 3}
                                : (struct place){PART_Y, plane - 2 * (size_t)p->chroma};
    const struct part *part = &m->part[at.part];
    const double *forward = part->c.forward + at.component * n;
    const double *back = part->c.back + at.component * n;
    memcpy(p->map + plane * (n - 1), forward, (n - 1) * sizeof *p->map);
    p->weight[plane] = 1.0;
    p->energy[plane] = fmax(0.0, part->c.value[at.component]);
    p->lost -= p->energy[plane];
    p->shift[plane] = forward[n - 1];
    for (size_t i = 0; i + 1 < n; i++)
        p->shift[plane] -= forward[i] * m->view->mean[i];
    double *weights = p->transform + ((size_t)at.part * (size_t)p->planes + plane) * functions;
    for (size_t j = 0; j < functions; j++)
        for (size_t i = 0; i < n; i++)
            weights[j] += part->node[j * n + i] * back[i];
}

static void take_planes(struct plan *p, const struct maker *m)
{
    const size_t functions = (size_t)p->functions.count;
    for (size_t k = 0; k < PARTS; k++) {
        p->lost += m->part[k].c.total;
        memcpy(p->mean + k * functions, m->part[k].kept, functions * sizeof *p->mean);
    }
    for (size_t plane = 0; plane < (size_t)p->planes; plane++)
        take_plane(p, m, plane);
    p->lost = fmax(p->lost, 0.0);
}

static int min_of(int a, int b)
{
    return a < b ? a : b;
}

relume_status plan_yab(struct plan *p, const struct source *s, const struct functions *functions,
                       int planes, int most_chroma, int threads)
{
    const int most = s->numbers + 1;
    most_chroma = min_of(most_chroma, min_of(planes / 3, most));
    const int count = min_of(planes, 3 * most);
    *p = (struct plan){
        .form = FOREIGN_JOINT, .functions = *functions, .terms = count, .planes = count};
    struct plan_view view;
    struct maker m = {0};
    relume_status status = plan_view_open(&view, p, s, threads);
    if (!status)
        status = create(&m, &view);
    if (!status)
        status = analyse(&m, &m.part[PART_A], energy_of[PART_A], most_chroma);
    if (!status)
        status = analyse(&m, &m.part[PART_B], energy_of[PART_B], most_chroma);
    if (!status)
        status = analyse_luminance(&m, most_chroma, min_of(count, most));
    if (!status) {
        const struct split split = choose_split(&m, count);
        p->chroma = split.chroma;
        p->planes = p->terms = split.luminance + 2 * split.chroma;
        status = analyse_luminance(&m, p->chroma, min_of(count, most));
    }
    if (!status)
        status = plan_view_loss(&view, &p->lost);
    if (!status)
        take_planes(p, &m);
    plan_view_close(&view);
    destroy(&m);
    if (status)
        plan_free(p);
    return status;
}
