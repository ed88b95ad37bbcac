// falloff.c - vignetting and the fall-off of the lamp, from a photograph of an evenly lit surface
#include <relume/image/photograph.h>

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "core/math/luminance.h"

#include <math.h>

static const double least = 0.05;  // of the centre: below, dividing is guessing

// r^2 of a pixel centre, 1 in the corners.
static double radius2(const double center[2], int width, int height, int x, int y)
{
    const double dx = x + 0.5 - center[0], dy = y + 0.5 - center[1];
    return 4.0 * (dx * dx + dy * dy) / ((double)width * width + (double)height * height);
}

static double polynomial(const double k[3], double q)
{
    return 1.0 + q * (k[0] + q * (k[1] + q * k[2]));
}

relume_status relume_falloff_fit(struct relume_falloff *out, const struct relume_image *flat,
                                 const struct relume_log *log)
{
    double gram[16] = {0.0}, b[4] = {0.0};
    *out = (struct relume_falloff){.center = {0.5 * flat->width, 0.5 * flat->height}};
    if (flat->channels != 3)
        return RELUME_EINVAL;
    const float *p = flat->data;
    for (int y = 0; y < flat->height; y++)
        for (int x = 0; x < flat->width; x++, p += 3) {
            const double q = radius2(out->center, flat->width, flat->height, x, y);
            const double row[4] = {1.0, q, q * q, q * q * q};
            for (int i = 0; i < 4; i++) {
                b[i] += row[i] * luminance_709(p);
                for (int j = 0; j <= i; j++)
                    gram[4 * i + j] += row[i] * row[j];
            }
        }
    if (!lsq_solve(gram, 4, b, 1) || !(b[0] > 0.0))
        return log_fail(log, RELUME_EUNFIT,
                        "the flat field is black or too small; expected an evenly lit surface");
    for (int i = 0; i < 3; i++)
        out->k[i] = b[i + 1] / b[0];
    for (int i = 0; i <= 100; i++)
        if (!(polynomial(out->k, i / 100.0) >= least))
            return log_fail(log, RELUME_EUNFIT,
                            "the flat field falls below %g of its centre; expected an evenly lit "
                            "surface",
                            least);
    return RELUME_OK;
}

void relume_falloff_divide(struct relume_image *image, const struct relume_falloff *falloff)
{
    float *p = image->data;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            const double q = radius2(falloff->center, image->width, image->height, x, y);
            const float gain = (float)(1.0 / polynomial(falloff->k, q));
            for (int c = 0; c < image->channels; c++)
                *p++ *= gain;
        }
}

// ---------------------------------------------------------------- flat fields

// Means over `2 half + 1` samples `step` apart; fewer at the ends.
static void smooth_line(float *line, size_t step, int n, int half, double *sum)
{
    sum[0] = 0.0;
    for (int i = 0; i < n; i++)
        sum[i + 1] = sum[i] + (double)line[(size_t)i * step];
    for (int i = 0; i < n; i++) {
        const int from = i < half ? 0 : i - half, to = i + half >= n ? n : i + half + 1;
        line[(size_t)i * step] = (float)((sum[to] - sum[from]) / (to - from));
    }
}

static relume_status smoothed(struct relume_image *out, const struct relume_image *flat)
{
    const size_t width = (size_t)flat->width, height = (size_t)flat->height;
    const int half = flat->width / 128;
    double *sum = mem_array((width > height ? width : height) + 1, sizeof *sum);
    float *data = mem_copy(flat->data, 3 * width * height, sizeof *data);
    *out = (struct relume_image){flat->width, flat->height, 3, .data = data};
    if (!sum || !data) {
        relume_image_destroy(out);
        mem_free(sum);
        return RELUME_ENOMEM;
    }
    for (size_t c = 0; c < 3; c++) {
        for (size_t y = 0; y < height; y++)
            smooth_line(data + 3 * y * width + c, 3, flat->width, half, sum);
        for (size_t x = 0; x < width; x++)
            smooth_line(data + 3 * x + c, 3 * width, flat->height, half, sum);
    }
    mem_free(sum);
    return RELUME_OK;
}

relume_status relume_flat_divide(struct relume_image *image, const struct relume_image *flat,
                                 const struct relume_log *log)
{
    struct relume_image even;
    if (image->channels != 3 || flat->channels != 3 || image->width != flat->width ||
        image->height != flat->height)
        return log_fail(log, RELUME_EINVAL,
                        "the flat field has %d x %d pixels; expected %d x %d as in the photograph",
                        flat->width, flat->height, image->width, image->height);
    const relume_status status = smoothed(&even, flat);
    if (status)
        return status;
    const size_t samples = 3 * (size_t)image->width * (size_t)image->height;
    double mean[3] = {0.0, 0.0, 0.0};
    float lowest = INFINITY;
    for (size_t i = 0; i < samples; i++) {
        mean[i % 3] += (double)even.data[i] * 3.0 / (double)samples;
        lowest = fminf(lowest, even.data[i]);
    }
    for (size_t i = 0; lowest > 0.0f && i < samples; i++)
        image->data[i] *= (float)(mean[i % 3] / (double)even.data[i]);
    relume_image_destroy(&even);
    return lowest > 0.0f ? RELUME_OK
                         : log_fail(log, RELUME_EUNFIT,
                                    "the flat field is black somewhere; expected an evenly lit "
                                    "surface");
}
