// principal.c - principal components of numbers x whose errors count by a metric
#include "exchange/foreign/principal.h"

#include "core/base/memory.h"
#include "core/math/lsq.h"

#include <math.h>

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

void principal_free(struct principal *c)
{
    mem_free(c->value);
    mem_free(c->forward);
    mem_free(c->back);
    *c = (struct principal){0};
}

relume_status principal_find(struct principal *out, double *metric, const double *covariance, int n,
                             int count)
{
    const size_t size = (size_t)n * (size_t)n, kept = (size_t)count * (size_t)n;
    double *values = mem_array((size_t)n, sizeof *values),
           *vectors = mem_array(size, sizeof *vectors);
    double *half = mem_array(size, sizeof *half), *z = mem_array(size, sizeof *z);
    double *root = NULL, *inverse = NULL;
    *out = (struct principal){count, 0.0, mem_array((size_t)count, sizeof(double)),
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
    mem_free(values);
    mem_free(vectors);
    mem_free(half);
    mem_free(z);
    mem_free(root);
    mem_free(inverse);
    return good ? RELUME_OK : RELUME_ENOMEM;
}
