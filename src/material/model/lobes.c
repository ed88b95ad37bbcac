// lobes.c - Levenberg-Marquardt with Marquardt's scaling (1963). The problems are small (four
// unknowns a lobe) and many (one a texel and view), so everything lies on the stack. Exponents are
// fitted by their logarithm, which keeps them positive.
#include "material/model/lobes.h"

#include "core/math/lsq.h"

#include <string.h>

enum { PER_LOBE = 4, MOST = PER_LOBE * MODEL_LOBES, ROUNDS = 30, TRIALS = 6 };
static const double ENOUGH = 2e-3;  // a round that gains less than this part ends the fit

struct normal {
    double gram[MOST][MOST];  // J'J, the lower triangle
    double right[MOST];       // J'r
    double error;
};

static void clear(struct normal *s, int unknowns)
{
    for (int a = 0; a < unknowns; a++) {
        s->right[a] = 0.0;
        for (int b = 0; b <= a; b++)
            s->gram[a][b] = 0.0;
    }
    s->error = 0.0;
}

static void build(struct normal *s, const struct lobe *lobe, int count,
                  const struct lobe_samples *p)
{
    const int unknowns = PER_LOBE * count;
    clear(s, unknowns);
    for (int i = 0; i < p->n; i++) {
        const double *d = p->d[i], w = p->w ? p->w[i] : 1.0;
        double slope[MOST], rest = p->y[i];
        for (int j = 0; j < count; j++) {
            const double *t = lobe[j].t;
            const double dot = t[0] * d[0] + t[1] * d[1] + t[2] * d[2];
            const double log_dot = dot > 1e-9 ? log(dot) : 0.0;
            const double value = dot > 1e-9 ? w * exp(lobe[j].n * log_dot) : 0.0;
            const double along = dot > 1e-9 ? lobe[j].n * value / dot : 0.0;
            for (int c = 0; c < 3; c++)
                slope[PER_LOBE * j + c] = along * d[c];
            slope[PER_LOBE * j + 3] = lobe[j].n * log_dot * value;
            rest -= value;
        }
        s->error += rest * rest;
        for (int a = 0; a < unknowns; a++) {
            s->right[a] += slope[a] * rest;
            for (int b = 0; b <= a; b++)
                s->gram[a][b] += slope[a] * slope[b];
        }
    }
}

static double error_of(const struct lobe *lobe, int count, const struct lobe_samples *p)
{
    double error = 0.0;
    for (int i = 0; i < p->n; i++) {
        double sum = 0.0;
        for (int j = 0; j < count; j++)
            sum += lobe_at(&lobe[j], p->d[i]);
        const double rest = p->y[i] - (p->w ? p->w[i] * sum : sum);
        error += rest * rest;
    }
    return error;
}

// One damped step from `lobe` to `out`; false when there is none.
static bool step(const struct normal *s, double damping, const struct lobe *lobe, int count,
                 struct lobe *out)
{
    const int unknowns = PER_LOBE * count;
    double matrix[MOST * MOST], change[MOST], trace = 0.0;
    for (int a = 0; a < unknowns; a++)
        trace += s->gram[a][a];
    for (int a = 0; a < unknowns; a++) {
        for (int b = 0; b <= a; b++)
            matrix[a * unknowns + b] = s->gram[a][b];
        matrix[a * unknowns + a] += damping * s->gram[a][a] + 1e-12 * trace;
        change[a] = s->right[a];
    }
    if (!(trace > 0.0) || !lsq_solve(matrix, unknowns, change, 1))
        return false;
    for (int j = 0; j < count; j++) {
        const double *c = change + PER_LOBE * j;
        for (int k = 0; k < 3; k++)
            out[j].t[k] = lobe[j].t[k] + c[k];
        const double grow = fmin(fmax(c[3], -1.0), 1.0);  // by at most e a step
        out[j].n = fmin(fmax(lobe[j].n * exp(grow), LOBE_LEAST_N), LOBE_MOST_N);
    }
    return true;
}

double lobes_fit(struct lobe *lobe, int count, const struct lobe_samples *samples)
{
    struct normal s;
    double damping = 1e-2;
    build(&s, lobe, count, samples);
    for (int round = 0; round < ROUNDS; round++) {
        const double before = s.error;
        bool better = false;
        for (int trial = 0; trial < TRIALS && !better; trial++) {
            struct lobe next[MODEL_LOBES];
            if (step(&s, damping, lobe, count, next) && error_of(next, count, samples) < s.error) {
                memcpy(lobe, next, (size_t)count * sizeof *lobe);
                better = true;
            }
            damping *= better ? 0.2 : 8.0;
        }
        if (!better)
            break;
        build(&s, lobe, count, samples);
        if (before - s.error <= ENOUGH * before)
            break;
    }
    return s.error;
}

struct lobe lobe_along(const double d[3], double n, double height)
{
    const double length = pow(height > 1e-6 ? height : 1e-6, 1.0 / n);
    return (struct lobe){{d[0] * length, d[1] * length, d[2] * length}, n};
}

void lobe_limit(struct lobe *lobe, double most)
{
    const double *t = lobe->t;
    const double length = sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
    const double longest = pow(most > 1e-12 ? most : 1e-12, 1.0 / lobe->n);
    for (int c = 0; length > longest && c < 3; c++)
        lobe->t[c] *= longest / length;
}
