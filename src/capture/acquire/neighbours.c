// neighbours.c - interpolation over the directions of lights, without one photograph in turn
//
// Kriging with the linear kernel -angle(a, b) and the trend 1, x, y. Each prediction follows from
// one inverse of the whole system (Dubrule 1983). Interpolation follows gloss and shadows as they
// move from light to light, which no law of reflection does.
#include "capture/acquire/neighbours.h"

#include "core/base/memory.h"
#include "core/math/lsq.h"

enum { TREND = 3, LEAST = TREND + 2 };
static const double NUGGET = 0.02;  // radians: photographs differ by noise and by lights' errors

static double kernel(vec3 a, vec3 b)
{
    return -vec3_angle(a, b);
}

static void trend(double out[TREND], vec3 d)
{
    out[0] = 1.0;
    out[1] = d.x;
    out[2] = d.y;
}

relume_status neighbours_create(struct neighbours *out, const vec3 *direction, int n)
{
    const int m = n + TREND;
    *out = (struct neighbours){n, direction, NULL, NULL};
    if (n < LEAST)
        return RELUME_EUNFIT;
    out->inverse = mem_zeroed((size_t)m * (size_t)m, sizeof *out->inverse);
    out->kernel = mem_array((size_t)n, sizeof *out->kernel);
    if (!out->inverse || !out->kernel) {
        neighbours_destroy(out);
        return RELUME_ENOMEM;
    }
    for (int i = 0; i < n; i++) {
        double t[TREND];
        trend(t, direction[i]);
        for (int k = 0; k < n; k++)
            out->inverse[i * m + k] = kernel(direction[i], direction[k]) - (i == k ? NUGGET : 0.0);
        for (int k = 0; k < TREND; k++)
            out->inverse[i * m + n + k] = out->inverse[(n + k) * m + i] = t[k];
    }
    const relume_status status = lsq_invert(out->inverse, m);
    if (status)
        neighbours_destroy(out);
    return status;
}

void neighbours_destroy(struct neighbours *set)
{
    mem_free(set->inverse);
    mem_free(set->kernel);
    *set = (struct neighbours){0};
}

void neighbours_all_weights(const struct neighbours *set, vec3 d, double *weight)
{
    const int n = set->n, m = n + TREND;
    double side[TREND];
    trend(side, d);
    for (int k = 0; k < n; k++)
        set->kernel[k] = kernel(d, set->direction[k]);
    for (int r = 0; r < n; r++) {
        const double *row = set->inverse + (size_t)r * (size_t)m;
        double sum = 0.0;
        for (int k = 0; k < n; k++)
            sum += row[k] * set->kernel[k];
        for (int k = 0; k < TREND; k++)
            sum += row[n + k] * side[k];
        weight[r] = sum;
    }
}

const double *neighbours_row(const struct neighbours *set, int i)
{
    return set->inverse + (size_t)i * (size_t)(set->n + TREND);
}

// Dubrule's formula serves the photograph's own light; any other light needs the inverse
// of the system without it, Q - q q^T / q_ii.
double neighbours_weights(const struct neighbours *set, int left_out, vec3 d, double *weight)
{
    const int n = set->n, m = n + TREND, i = left_out;
    const double *q = neighbours_row(set, i);
    double *const near = set->kernel;
    double side[TREND], along = 0.0, variance = 0.0, trend_part[TREND] = {0.0};
    trend(side, d);
    for (int k = 0; k < n; k++)
        near[k] = k == i ? 0.0 : kernel(d, set->direction[k]);
    for (int k = 0; k < n; k++)
        along += q[k] * near[k];
    for (int k = 0; k < TREND; k++)
        along += q[n + k] * side[k];
    for (int r = 0; r < m; r++) {
        const double *row = set->inverse + (size_t)r * (size_t)m;
        double sum = -q[r] / q[i] * along;
        for (int k = 0; k < n && r != i; k++)
            sum += row[k] * near[k];
        for (int k = 0; k < TREND && r != i; k++)
            sum += row[n + k] * side[k];
        if (r < n)
            weight[r] = r == i ? 0.0 : sum;
        else
            trend_part[r - n] = sum;
    }
    for (int k = 0; k < n; k++)
        variance -= weight[k] * near[k];
    for (int k = 0; k < TREND; k++)
        variance -= trend_part[k] * side[k];
    return sqrt(fmax(variance, NUGGET));
}
