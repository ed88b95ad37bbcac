// foreign.c - a picture of another format: planes of 8-bit codes, and what they mean
#include "exchange/foreign/foreign.h"

#include "core/base/log.h"
#include "core/base/memory.h"

const double foreign_rgb_of_ycc[3][3] = {
    {1.0, 0.0, 1.402}, {1.0, -0.344136, -0.714136}, {1.0, 1.772, 0.0}};

relume_status foreign_create(struct foreign *f, const char *path, long width, long height,
                             int planes, const struct relume_limits *limits,
                             const struct relume_log *log)
{
    const relume_status allowed = limits_picture(limits, path, width, height, log);
    if (allowed)
        return allowed;
    f->width = (int)width;
    f->height = (int)height;
    f->planes = planes;
    f->codes = mem_array((size_t)planes, foreign_pixels(f));
    f->scale = mem_zeroed((size_t)planes, sizeof *f->scale);
    f->offset = mem_zeroed((size_t)planes, sizeof *f->offset);
    return f->codes && f->scale && f->offset ? RELUME_OK : RELUME_ENOMEM;
}

void foreign_free(struct foreign *f)
{
    mem_free(f->codes);
    mem_free(f->scale);
    mem_free(f->offset);
    mem_free(f->transform);
    mem_free(f->mean);
    mem_free((void *)(uintptr_t)f->functions.lights);
    *f = (struct foreign){0};
}

void foreign_weights(const struct foreign *f, struct relume_vec3 light, double *weights,
                     double constant[3])
{
    double values[FUNCTIONS_MOST];
    const int k = f->terms, n = f->functions.count;
    const bool joint = f->form == FOREIGN_JOINT;
    functions_at(&f->functions, light, values);
    for (int c = 0; c < 3; c++) {
        constant[c] = 0.0;
        for (int j = 0; joint && j < n; j++)
            constant[c] += f->mean[c * n + j] * values[j];
        for (int i = 0; i < k; i++) {
            const size_t row = (size_t)((joint ? c * k : 0) + i) * (size_t)n;
            double sum = f->transform ? 0.0 : values[i];
            for (int j = 0; f->transform && j < n; j++)
                sum += f->transform[row + (size_t)j] * values[j];
            weights[c * k + i] = sum;
        }
    }
}
