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
    *out = (struct neighbours){n, direction, NULL};
    if (n < LEAST)
        return RELUME_EUNFIT;
    out->inverse = mem_zeroed((size_t)m * (size_t)m, sizeof *out->inverse);
    if (!out->inverse)
        return RELUME_ENOMEM;
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
    *set = (struct neighbours){0};
}

// Dubrule's formula serves the photograph's own light; any other light needs the inverse
// of the system without it, Q - q q^T / q_ii.
double neighbours_weights(const struct neighbours *set, int left_out, vec3 d, double *weight)
{
    const int n = set->n, m = n + TREND, i = left_out;
    const double *q = set->inverse + (size_t)i * (size_t)m;
    double side[TREND], along = 0.0, variance = 0.0, trend_part[TREND];
    trend(side, d);
    for (int k = 0; k < n; k++)
        along += k == i ? 0.0 : q[k] * kernel(d, set->direction[k]);
    for (int k = 0; k < TREND; k++)
        along += q[n + k] * side[k];
    for (int r = 0; r < m; r++) {
        const double *row = set->inverse + (size_t)r * (size_t)m;
        double sum = -q[r] / q[i] * along;
        for (int k = 0; k < n && r != i; k++)
            sum += k == i ? 0.0 : row[k] * kernel(d, set->direction[k]);
        for (int k = 0; k < TREND && r != i; k++)
            sum += row[n + k] * side[k];
        if (r < n)
            weight[r] = r == i ? 0.0 : sum;
        else
            trend_part[r - n] = sum;
    }
    for (int k = 0; k < n; k++)
        variance -= k == i ? 0.0 : weight[k] * kernel(d, set->direction[k]);
    for (int k = 0; k < TREND; k++)
        variance -= trend_part[k] * side[k];
    return sqrt(fmax(variance, NUGGET));
}
