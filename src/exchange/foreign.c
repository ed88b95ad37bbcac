#include "exchange/foreign.h"

#include "base/log.h"
#include "base/memory.h"

relume_status foreign_create(struct foreign *f, const char *path, long width, long height,
                             int planes, const struct relume_limits *limits,
                             const struct relume_log *log)
{
    if (!limits_allow(limits, width, height))
        return log_fail(log, RELUME_EDATA,
                        "%s: claims %ld x %ld pixels; expected sizes from 1 within the limits",
                        path, width, height);
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
    free(f->codes);
    free(f->scale);
    free(f->offset);
    free(f->transform);
    free(f->mean);
    free((void *)(uintptr_t)f->functions.lights);
    *f = (struct foreign){0};
}

static double coefficient(const struct foreign *f, int plane, size_t pixel)
{
    return (double)f->codes[(size_t)plane * foreign_pixels(f) + pixel] * (double)f->scale[plane] +
           (double)f->offset[plane];
}

// Row `row` of the transform times the functions.
static double weight(const struct foreign *f, int row, const double *values)
{
    const int n = f->functions.count;
    double sum = 0.0;
    if (!f->transform)
        return values[row];
    for (int j = 0; j < n; j++)
        sum += f->transform[row * n + j] * values[j];
    return sum;
}

void foreign_pixel(const struct foreign *f, size_t pixel, struct relume_vec3 light, double rgb[3])
{
    double values[FUNCTIONS_MOST];
    const int k = f->terms, n = f->functions.count;
    functions_at(&f->functions, light, values);
    for (int c = 0; c < 3; c++) {
        rgb[c] = 0.0;
        for (int i = 0; i < k; i++)
            if (f->form == FOREIGN_JOINT)
                rgb[c] += coefficient(f, i, pixel) * weight(f, c * k + i, values);
            else if (f->form == FOREIGN_LUMINANCE)
                rgb[c] += coefficient(f, i, pixel) * weight(f, i, values);
            else
                rgb[c] += coefficient(f, 3 * i + c, pixel) * weight(f, i, values);
        if (f->form == FOREIGN_LUMINANCE)
            rgb[c] *= coefficient(f, k + c, pixel);
        for (int j = 0; f->form == FOREIGN_JOINT && j < n; j++)
            rgb[c] += f->mean[c * n + j] * values[j];
    }
}
