// absent.c - what the page's core has in place of the rest of the library
//
// A page only decodes, in one thread: nothing here learns, fits a basis or reads files, so that
// Eigen, threads and logs stay out of what is downloaded. Interpolants ask for one inverse, which
// is plain C here. What opens dropped files (web/open) has most of the library, and takes only
// what is plain or missing here in place of Eigen: OPENS_FILES.
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/lsq.h"
#include "format/coder/basis.h"
#include "format/coder/coding.h"
#include "format/coder/interpolant.h"
#include "format/coder/pca.h"

#include <math.h>
#include <string.h>

#ifndef OPENS_FILES
// ---------------------------------------------------------------- base

void *mem_array(size_t count, size_t size)
{
    const size_t n = count ? count : 1;
    return size && n > SIZE_MAX / size ? NULL : malloc(n * size);
}

void *mem_zeroed(size_t count, size_t size)
{
    return calloc(count ? count : 1, size);
}

void *mem_copy(const void *from, size_t count, size_t size)
{
    void *copy = mem_array(count, size);
    return copy ? memcpy(copy, from, count * size) : NULL;
}

bool mem_grow(void *array, size_t count, size_t size)
{
    void *old, *grown;
    memcpy(&old, array, sizeof old);
    if (count && (count < 16 || (count & (count - 1))))
        return true;
    const size_t capacity = count < 16 ? 16 : 2 * count;
    grown = capacity > SIZE_MAX / size ? NULL : realloc(old, capacity * size);
    if (grown)
        memcpy(array, &grown, sizeof grown);
    return grown != NULL;
}

void mem_free(void *memory)
{
    free(memory);
}

void log_line(const struct relume_log *log, enum relume_level level, const char *format, ...)
{
    (void)log, (void)level, (void)format;
}

relume_status log_fail(const struct relume_log *log, relume_status status, const char *format, ...)
{
    (void)log, (void)format;
    return status;
}

const char *relume_plural(int64_t n)
{
    return n == 1 ? "" : "s";
}

void *params_copy(void *own, size_t size, const void *params)
{
    return params ? memcpy(own, params, size) : own;
}

void *params_work(void *own, size_t size, const void *params, size_t log, size_t threads)
{
    (void)log, (void)threads;
    return params_copy(own, size, params);
}

void thread_for(int threads, size_t items, void (*body)(void *context, size_t item, int worker),
                void *context)
{
    (void)threads;
    for (size_t i = 0; i < items; i++)
        body(context, i, 0);
}

// ---------------------------------------------------------------- images

relume_status relume_image_create(struct relume_image *out, int width, int height, int channels)
{
    float *data = mem_zeroed((size_t)width * (size_t)height, (size_t)channels * sizeof *data);
    *out = (struct relume_image){0};
    if (data)
        *out = (struct relume_image){width, height, channels, .data = data};
    return data ? RELUME_OK : RELUME_ENOMEM;
}

void relume_image_destroy(struct relume_image *image)
{
    mem_free(image->data);
    *image = (struct relume_image){0};
}

relume_status relume_image_load(struct relume_image *out, const char *path,
                                const struct relume_image_params *params)
{
    (void)path, (void)params;
    *out = (struct relume_image){0};
    return RELUME_ENOTFOUND;
}

#endif
// ---------------------------------------------------------------- algebra

// Gauss and Jordan, rows exchanged for the largest pivot.
relume_status lsq_invert(double *matrix, int n)
{
    const size_t size = (size_t)n;
    size_t *row = mem_array(size, sizeof *row);
    if (!row)
        return RELUME_ENOMEM;
    relume_status status = RELUME_OK;
    for (size_t k = 0; !status && k < size; k++) {
        size_t best = k;
        for (size_t i = k; i < size; i++)
            best = fabs(matrix[i * size + k]) > fabs(matrix[best * size + k]) ? i : best;
        row[k] = best;
        for (size_t j = 0; best != k && j < size; j++) {
            const double kept = matrix[k * size + j];
            matrix[k * size + j] = matrix[best * size + j];
            matrix[best * size + j] = kept;
        }
        const double pivot = matrix[k * size + k];
        if (!(fabs(pivot) > 0.0))
            status = RELUME_EUNFIT;
        matrix[k * size + k] = 1.0;
        for (size_t j = 0; j < size; j++)
            matrix[k * size + j] /= pivot;
        for (size_t i = 0; i < size; i++) {
            const double factor = matrix[i * size + k];
            if (i == k)
                continue;
            matrix[i * size + k] = 0.0;
            for (size_t j = 0; j < size; j++)
                matrix[i * size + j] -= factor * matrix[k * size + j];
        }
    }
    for (size_t k = size; k-- > 0;)
        for (size_t i = 0; row[k] != k && i < size; i++) {
            const double kept = matrix[i * size + k];
            matrix[i * size + k] = matrix[i * size + row[k]];
            matrix[i * size + row[k]] = kept;
        }
    mem_free(row);
    return status;
}

void lsq_add_gram(double *gram, int n, const double *rows, int count)
{
    for (int r = 0; r < count; r++)
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++)
                gram[i * n + j] += rows[r * n + i] * rows[r * n + j];
}

// ---------------------------------------------------------------- what only encoding needs

bool lsq_eigenvalues(double *matrix, int n, double *values)
{
    (void)matrix, (void)n, (void)values;
    return false;
}

relume_status fit_map(relume_coder *coder, const double *roughness, const struct relume_log *log)
{
    (void)coder, (void)roughness, (void)log;
    return RELUME_EUNFIT;
}

relume_status interpolant_choose(double *parameter, double *rms, const vec3 *lights,
                                 const struct relume_samples *samples, int threads)
{
    (void)parameter, (void)rms, (void)lights, (void)samples, (void)threads;
    return RELUME_EUNFIT;
}

relume_status robust_create(struct robust **out, const relume_coder *coder)
{
    (void)coder;
    *out = NULL;
    return RELUME_EUNFIT;
}

void robust_destroy(struct robust *robust)
{
    (void)robust;
}

#ifndef OPENS_FILES
const struct relume_basis relume_basis_pca = {.name = "pca"};
const struct relume_basis relume_basis_eigen = {.name = "eigen"};
#endif
