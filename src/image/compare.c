// compare.c - how far an image is from its reference: RMS, PSNR, SSIM (Wang, Bovik, Sheikh,
// Simoncelli 2004: luma, 11 x 11 Gaussian window, sigma 1.5), CIEDE2000 (Sharma, Wu, Dalal 2005)
#include <relume/image.h>

#include "base/memory.h"
#include "base/thread.h"
#include "image/ciede2000.h"

#include <math.h>
#include <string.h>

enum { RADIUS = 5, ROWS = 16 };

struct sums {  // of one block of rows
    double linear, display, coded, delta_e, ssim, max_abs;
    size_t pixels, windows;
};

struct job {
    const struct relume_image *a, *b;
    const struct relume_image *mask;
    struct relume_transfer display;
    float *luma[2];  // display luma of both images
    struct sums *block;
    double *products;  // [threads][width][5], see filter_columns
};

static bool is_inside(const struct job *j, size_t pixel)
{
    return !j->mask || j->mask->data[pixel] > 0.5f;
}

static float display_value(const struct job *j, float linear)
{
    const float v = relume_transfer_encode(j->display, linear);
    return v > 1.0f ? 1.0f : v > 0.0f ? v : 0.0f;
}

static void measure_pixel(struct job *j, struct sums *s, size_t pixel)
{
    float a[3], b[3];
    const float *la = j->a->data + 3 * pixel, *lb = j->b->data + 3 * pixel;
    for (int c = 0; c < 3; c++) {
        a[c] = display_value(j, la[c]);
        b[c] = display_value(j, lb[c]);
    }
    j->luma[0][pixel] = 0.299f * a[0] + 0.587f * a[1] + 0.114f * a[2];
    j->luma[1][pixel] = 0.299f * b[0] + 0.587f * b[1] + 0.114f * b[2];
    if (!is_inside(j, pixel))
        return;
    for (int c = 0; c < 3; c++) {
        const double d = (double)la[c] - (double)lb[c];
        const double e = (double)a[c] - (double)b[c];
        const double f =
            (floor((double)a[c] * 255.0 + 0.5) - floor((double)b[c] * 255.0 + 0.5)) / 255.0;
        s->linear += d * d;
        s->display += e * e;
        s->coded += f * f;
        s->max_abs = fmax(s->max_abs, fabs(d));
    }
    s->delta_e += ciede2000_srgb(a, b);
    s->pixels++;
}

static void measure_rows(void *context, size_t item, int worker)
{
    (void)worker;
    struct job *j = context;
    const size_t width = (size_t)j->a->width;
    const int first = (int)item * ROWS;
    const int end = first + ROWS < j->a->height ? first + ROWS : j->a->height;
    for (size_t p = (size_t)first * width; p < (size_t)end * width; p++)
        measure_pixel(j, &j->block[item], p);
}

// One row of the five filtered products that SSIM needs: a, b, aa, bb, ab, filtered down columns.
static void filter_columns(const struct job *j, int row, const double *kernel, double *products)
{
    const size_t width = (size_t)j->a->width;
    memset(products, 0, 5 * width * sizeof *products);
    for (int dy = -RADIUS; dy <= RADIUS; dy++) {
        const double w = kernel[dy + RADIUS];
        const size_t at = (size_t)(row + dy) * width;
        for (size_t x = 0; x < width; x++) {
            const double a = (double)j->luma[0][at + x], b = (double)j->luma[1][at + x];
            double *p = products + 5 * x;
            p[0] += w * a;
            p[1] += w * b;
            p[2] += w * a * a;
            p[3] += w * b * b;
            p[4] += w * a * b;
        }
    }
}

static double ssim_of(const double m[5])
{
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;  // values lie in [0, 1]
    const double va = m[2] - m[0] * m[0], vb = m[3] - m[1] * m[1], cov = m[4] - m[0] * m[1];
    return (2.0 * m[0] * m[1] + c1) * (2.0 * cov + c2) /
           ((m[0] * m[0] + m[1] * m[1] + c1) * (va + vb + c2));
}

static void make_kernel(double kernel[2 * RADIUS + 1])
{
    double sum = 0.0;
    for (int i = -RADIUS; i <= RADIUS; i++)
        sum += kernel[i + RADIUS] = exp(-i * i / (2.0 * 1.5 * 1.5));
    for (int i = 0; i <= 2 * RADIUS; i++)
        kernel[i] /= sum;
}

// Windows that lie wholly inside the image, as in the paper's own program.
static void compare_structure(void *context, size_t item, int worker)
{
    struct job *j = context;
    const int width = j->a->width, height = j->a->height;
    double kernel[2 * RADIUS + 1];
    make_kernel(kernel);
    double *products = j->products + 5 * (size_t)worker * (size_t)width;
    struct sums *s = &j->block[item];
    for (int y = (int)item * ROWS; y < ((int)item + 1) * ROWS; y++) {
        if (y < RADIUS || y >= height - RADIUS)
            continue;
        filter_columns(j, y, kernel, products);
        for (int x = RADIUS; x < width - RADIUS; x++) {
            if (!is_inside(j, (size_t)y * (size_t)width + (size_t)x))
                continue;
            double mean[5] = {0.0, 0.0, 0.0, 0.0, 0.0};
            for (int dx = -RADIUS; dx <= RADIUS; dx++)
                for (int i = 0; i < 5; i++)
                    mean[i] += kernel[dx + RADIUS] * products[5 * (x + dx) + i];
            s->ssim += ssim_of(mean);
            s->windows++;
        }
    }
}

static double psnr(double mse)
{
    return mse > 1e-20 ? fmin(-10.0 * log10(mse), 200.0) : 200.0;
}

static void collect(struct relume_difference *out, const struct sums *block, size_t blocks)
{
    struct sums t = {0};
    for (size_t i = 0; i < blocks; i++) {  // in order, so that threads change no bit
        t.linear += block[i].linear;
        t.display += block[i].display;
        t.coded += block[i].coded;
        t.delta_e += block[i].delta_e;
        t.ssim += block[i].ssim;
        t.max_abs = fmax(t.max_abs, block[i].max_abs);
        t.pixels += block[i].pixels;
        t.windows += block[i].windows;
    }
    const double samples = 3.0 * (double)t.pixels;
    *out = (struct relume_difference){
        .rms = sqrt(t.linear / samples),
        .max_abs = t.max_abs,
        .psnr_db = psnr(t.coded / samples),
        .mse = t.display / samples,
        .ssim = t.windows ? t.ssim / (double)t.windows : (double)NAN,
        .delta_e = t.delta_e / (double)t.pixels,
        .pixels = t.pixels,
    };
}

relume_status relume_image_compare(struct relume_difference *out, const struct relume_image *image,
                                   const struct relume_image *reference,
                                   const struct relume_compare_params *params)
{
    const struct relume_compare_params p = params ? *params : (struct relume_compare_params){0};
    *out = (struct relume_difference){0};
    if (image->channels != 3 || reference->channels != 3 || image->width != reference->width ||
        image->height != reference->height)
        return RELUME_EINVAL;
    const bool masked = p.mask && p.mask->data;
    if (masked && (p.mask->width != image->width || p.mask->height != image->height))
        return RELUME_EINVAL;

    const size_t pixels = (size_t)image->width * (size_t)image->height;
    const size_t blocks = ((size_t)image->height + ROWS - 1) / ROWS;
    struct job job = {
        .a = image,
        .b = reference,
        .mask = masked ? p.mask : NULL,
        .display = p.display,
        .luma = {mem_array(pixels, sizeof(float)), mem_array(pixels, sizeof(float))},
        .block = mem_zeroed(blocks, sizeof *job.block),
        .products = mem_array((size_t)thread_count(p.threads) * (size_t)image->width,
                              5 * sizeof *job.products),
    };
    const bool good = job.luma[0] && job.luma[1] && job.block && job.products;
    if (good) {
        thread_for(p.threads, blocks, measure_rows, &job);
        thread_for(p.threads, blocks, compare_structure, &job);
        collect(out, job.block, blocks);
    }
    free(job.luma[0]);
    free(job.luma[1]);
    free(job.block);
    free(job.products);
    return good ? RELUME_OK : RELUME_ENOMEM;
}
