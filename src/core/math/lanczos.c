// lanczos.c - leading eigenvectors by Krylov projection (Lanczos 1950)
//
// Every new vector is made orthogonal to all before it, twice, which costs little beside products
// with a matrix of many pixels, and keeps what single steps lose to rounding (Parlett, Kahan).
#include "core/math/lanczos.h"

#include "core/base/memory.h"
#include "core/math/lsq.h"

#include <math.h>
#include <string.h>

// What is left of a product of size 1 below that is rounding: the space is exhausted.
static const double NOTHING = 1e-12;

struct space {
    size_t n;
    int most, count;  // vectors: that fit, made
    double *q;        // [most][n], orthonormal
    double *h;        // [most][most]: the matrix in that basis
    double *next;     // [n]
};

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

// Takes from `next` what the space has of it; adds that to column[most], where there is one.
static void take_away(const struct space *s, double *column)
{
    for (int k = 0; k < s->count; k++) {
        const double *q = s->q + (size_t)k * s->n;
        const double part = dot(q, s->next, s->n);
        if (column)
            column[k] += part;
        for (size_t i = 0; i < s->n; i++)
            s->next[i] -= part * q[i];
    }
}

// `next` joins the space where something is left of it.
static bool join(struct space *s, double size)
{
    const double length = sqrt(dot(s->next, s->next, s->n));
    if (!(length > NOTHING * size))
        return false;
    for (size_t i = 0; i < s->n; i++)
        s->q[(size_t)s->count * s->n + i] = s->next[i] / length;
    s->count++;
    return true;
}

// An axis that the space has little of.
static bool join_axis(struct space *s)
{
    for (size_t axis = 0; axis < s->n; axis++) {
        memset(s->next, 0, s->n * sizeof *s->next);
        s->next[axis] = 1.0;
        take_away(s, NULL);
        take_away(s, NULL);
        if (join(s, 0.1 / (sqrt((double)s->n) * NOTHING)))
            return true;
    }
    return false;
}

static void grow(struct space *s, const double *start, lanczos_product *product,
                 const void *context)
{
    memcpy(s->next, start, s->n * sizeof *s->next);
    if (!join(s, 0.0) && !join_axis(s))
        return;
    for (int j = 0;; j++) {
        double *column = s->h + (size_t)j * (size_t)s->most;
        product(context, s->q + (size_t)j * s->n, s->next);
        const double size = sqrt(dot(s->next, s->next, s->n));
        take_away(s, column);
        take_away(s, column);
        if (s->count == s->most || (!join(s, size) && !join_axis(s)))
            return;
    }
}

// Columns are known down to the diagonal.
static void mirror(struct space *s)
{
    const size_t m = (size_t)s->most;
    for (size_t j = 0; j < m; j++)
        for (size_t i = 0; i < j; i++)
            s->h[i * m + j] = s->h[j * m + i];
}

static void turn_back(const struct space *s, const double *small, double *vector)
{
    double most = 0.0;
    memset(vector, 0, s->n * sizeof *vector);
    for (int k = 0; k < s->most; k++)
        for (size_t i = 0; i < s->n; i++)
            vector[i] += small[k] * s->q[(size_t)k * s->n + i];
    for (size_t i = 0; i < s->n; i++)
        most = fabs(vector[i]) > fabs(most) ? vector[i] : most;
    for (size_t i = 0; most < 0.0 && i < s->n; i++)
        vector[i] = -vector[i];
}

relume_status lanczos_eigenvectors(int n, int count, int steps, const double *start,
                                   lanczos_product *product, const void *context, double *values,
                                   double *vectors)
{
    struct space s = {.n = (size_t)n, .most = steps < n ? steps : n};
    const size_t m = (size_t)s.most;
    double *small = mem_array((size_t)count * m, sizeof *small);
    s.q = mem_zeroed(m * s.n, sizeof *s.q);
    s.h = mem_zeroed(m * m, sizeof *s.h);
    s.next = mem_array(s.n, sizeof *s.next);
    bool good = small && s.q && s.h && s.next;
    if (good) {
        grow(&s, start, product, context);
        mirror(&s);
        good = lsq_eigenvectors(s.h, s.most, count, values, small);
    }
    for (int k = 0; good && k < count; k++)
        turn_back(&s, small + (size_t)k * m, vectors + (size_t)k * s.n);
    mem_free(small);
    mem_free(s.q);
    mem_free(s.h);
    mem_free(s.next);
    return good ? RELUME_OK : RELUME_ENOMEM;
}
