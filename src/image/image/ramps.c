// ramps.c - how much of a smooth slope is left between contours
#include <relume/image.h>

#include "core/math/bilinear.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"

#include <math.h>

enum { RADIUS = 6 };
static const double SIGMA = 2.0;
static const float LEAST_SLOPE = 0.2f, MOST_SLOPE = 4.0f, MOST_CHANGE = 0.25f;  // of 255 levels

struct smoothing {
    const struct relume_image *image;
    struct relume_transfer display;
    float kernel[2 * RADIUS + 1];
    float *luma, *rows, *out;  // [height][width]
};

static float coded(struct relume_transfer display, float linear)
{
    const float v = relume_transfer_encode(display, linear);
    return v > 0.0f ? v < 1.0f ? 255.0f * v : 255.0f : 0.0f;
}

static void find_luma(void *context, size_t y, int worker)
{
    (void)worker;
    const struct smoothing *s = context;
    const size_t width = (size_t)s->image->width;
    for (size_t i = y * width; i < (y + 1) * width; i++) {
        const float *p = s->image->data + 3 * i;
        s->luma[i] = 0.299f * coded(s->display, p[0]) + 0.587f * coded(s->display, p[1]) +
                     0.114f * coded(s->display, p[2]);
    }
}

static void smooth_across(void *context, size_t y, int worker)
{
    (void)worker;
    const struct smoothing *s = context;
    const int width = s->image->width;
    const float *from = s->luma + y * (size_t)width;
    for (int x = 0; x < width; x++) {
        float sum = 0.0f;
        for (int k = -RADIUS; k <= RADIUS; k++)
            sum += s->kernel[k + RADIUS] * from[index_clamped(x + k, width)];
        s->rows[y * (size_t)width + (size_t)x] = sum;
    }
}

static void smooth_down(void *context, size_t y, int worker)
{
    (void)worker;
    const struct smoothing *s = context;
    const size_t width = (size_t)s->image->width;
    for (size_t x = 0; x < width; x++) {
        float sum = 0.0f;
        for (int k = -RADIUS; k <= RADIUS; k++)
            sum += s->kernel[k + RADIUS] *
                   s->rows[(size_t)index_clamped((int)y + k, s->image->height) * width + x];
        s->out[y * width + x] = sum;
    }
}

static relume_status smooth(float *out, const struct relume_image *image,
                            struct relume_transfer display, int threads)
{
    const size_t height = (size_t)image->height, n = (size_t)image->width * height;
    struct smoothing s = {.image = image, .display = display, .out = out};
    double sum = 0.0;
    for (int k = -RADIUS; k <= RADIUS; k++)
        sum += exp(-0.5 * k * k / (SIGMA * SIGMA));
    for (int k = -RADIUS; k <= RADIUS; k++)
        s.kernel[k + RADIUS] = (float)(exp(-0.5 * k * k / (SIGMA * SIGMA)) / sum);
    s.luma = mem_array(n, sizeof *s.luma);
    s.rows = mem_array(n, sizeof *s.rows);
    const bool good = s.luma && s.rows;
    if (good) {
        thread_for(threads, height, find_luma, &s);
        thread_for(threads, height, smooth_across, &s);
        thread_for(threads, height, smooth_down, &s);
    }
    mem_free(s.luma);
    mem_free(s.rows);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

struct slope {
    float x, y;
    bool ramp;
};

static struct slope slope_at(const float *v, size_t width)
{
    const float left = v[0] - v[-1], right = v[1] - v[0];
    const float above = v[0] - v[-(ptrdiff_t)width], below = v[width] - v[0];
    const struct slope s = {0.5f * (left + right), 0.5f * (above + below), false};
    const float steep = hypotf(s.x, s.y);
    return (struct slope){s.x, s.y,
                          steep >= LEAST_SLOPE && steep <= MOST_SLOPE &&
                              fabsf(right - left) <= MOST_CHANGE &&
                              fabsf(below - above) <= MOST_CHANGE};
}

static void measure(struct relume_ramps *out, const float *image, const float *reference,
                    const struct relume_image *size, const struct relume_image *mask)
{
    const size_t width = (size_t)size->width, height = (size_t)size->height;
    *out = (struct relume_ramps){0};
    for (size_t y = 1; y + 1 < height; y++)
        for (size_t x = 1; x + 1 < width; x++) {
            const size_t i = y * width + x;
            const struct slope want = slope_at(reference + i, width);
            if (!want.ramp || (mask && !(mask->data[i] > 0.5f)))
                continue;
            const struct slope got = slope_at(image + i, width);
            const double dx = (double)(got.x - want.x), dy = (double)(got.y - want.y);
            out->error += dx * dx + dy * dy;
            out->slope += (double)(want.x * want.x + want.y * want.y);
            out->pixels++;
        }
    out->error = out->pixels ? out->error / (double)out->pixels : 0.0;
    out->slope = out->pixels ? out->slope / (double)out->pixels : 0.0;
}

relume_status relume_image_ramps(struct relume_ramps *out, const struct relume_image *image,
                                 const struct relume_image *reference,
                                 const struct relume_compare_params *params)
{
    const struct relume_compare_params p = PARAMS(relume_compare_params, params);
    const struct relume_image *mask = p.mask && p.mask->data ? p.mask : NULL;
    *out = (struct relume_ramps){0};
    if (mask && (mask->width != image->width || mask->height != image->height))
        return RELUME_EINVAL;
    if (image->channels != 3 || reference->channels != 3 || image->width != reference->width ||
        image->height != reference->height)
        return RELUME_EINVAL;
    const size_t n = (size_t)image->width * (size_t)image->height;
    float *a = mem_array(n, sizeof *a), *b = mem_array(n, sizeof *b);
    relume_status status = a && b ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = smooth(a, image, p.display, p.threads);
    if (!status)
        status = smooth(b, reference, p.display, p.threads);
    if (!status)
        measure(out, a, b, image, mask);
    mem_free(a);
    mem_free(b);
    return status;
}
