// compare.c - how far an image is from its reference: RMS, PSNR, SSIM (Wang, Bovik, Sheikh,
// Simoncelli 2004: luma, 11 x 11 Gaussian window, sigma 1.5), CIEDE2000 (Sharma, Wu, Dalal 2005)
#include <relume/image.h>

#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/luminance.h"
#include "core/math/scalar.h"
#include "image/compare/ciede2000.h"
#include "image/compare/ssim.h"
#include "image/image/encoder.h"

#include <math.h>
#include <string.h>

// Rows of one block; SSIM filters 10 rows beside its own.
enum { ROWS = 16, SSIM_ROWS = 64 };

struct sums {  // of one block of rows
    double linear, display, coded, delta_e, max_abs;
    struct ssim_sum ssim;
    size_t pixels;
};

struct job {
    const struct relume_image *a, *b;
    const struct relume_image *mask;
    struct encoder display;
    const struct ciede_tables *tables;  // NULL: delta E is not asked for
    bool is_srgb;
    float *luma[2];  // display luma of both images; NULL: SSIM is not asked for
    struct sums *block;
    double *scratch;  // [threads][ssim_scratch]
};

static bool is_inside(const struct job *j, size_t pixel)
{
    return !j->mask || j->mask->data[pixel] > 0.5f;
}

// Up to CIEDE_BLOCK pixels of both images.
struct block {
    int n;
    const float *linear[2];
    float display[2][3 * CIEDE_BLOCK];
    float delta_e[CIEDE_BLOCK];
};

// CIEDE2000 looks at display codes as sRGB whatever they are.
static void find_lab(const struct job *j, const struct block *b, int i, struct lab_block *lab)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    float rgb[3 * CIEDE_BLOCK];
    for (int x = 0; x < 3 * b->n; x++)
        rgb[x] = j->is_srgb ? encoder_clip(b->linear[i][x])
                            : relume_transfer_decode(srgb, b->display[i][x]);
    lab_from_linear(j->tables, lab, rgb, b->n);
}

static void find_delta_e(const struct job *j, struct block *b)
{
    struct lab_block lab[2];
    memset(lab, 0, sizeof lab);
    for (int i = 0; i < 2; i++)
        find_lab(j, b, i, &lab[i]);
    ciede2000_block(j->tables, &lab[0], &lab[1], b->delta_e);
}

static void add_pixel(struct sums *s, const struct block *b, int pixel)
{
    for (int x = 3 * pixel; x < 3 * pixel + 3; x++) {
        const double d = (double)b->linear[0][x] - (double)b->linear[1][x];
        const double e = (double)b->display[0][x] - (double)b->display[1][x];
        const double f = encoder_code(b->display[0][x]) - encoder_code(b->display[1][x]);
        s->linear += d * d;
        s->display += e * e;
        s->coded += f * f;
        s->max_abs = fabs(d) > s->max_abs ? fabs(d) : s->max_abs;
    }
    s->delta_e += (double)b->delta_e[pixel];
    s->pixels++;
}

static void measure_rows(void *context, size_t item, int worker)
{
    (void)worker;
    struct job *j = context;
    const size_t width = (size_t)j->a->width, height = (size_t)j->a->height;
    const size_t first = item * ROWS, end = first + ROWS < height ? first + ROWS : height;
    struct block b = {0};
    for (size_t at = first * width; at < end * width; at += (size_t)b.n) {
        const size_t left = end * width - at;
        b.n = left < CIEDE_BLOCK ? (int)left : CIEDE_BLOCK;
        b.linear[0] = j->a->data + 3 * at;
        b.linear[1] = j->b->data + 3 * at;
        for (int i = 0; i < 2; i++) {
            encoder_apply(&j->display, b.linear[i], b.display[i], 3 * b.n);
            for (int x = 0; x < 3 * b.n; x++)
                b.display[i][x] = encoder_clip(b.display[i][x]);
        }
        if (j->tables)
            find_delta_e(j, &b);
        for (int i = 0; j->luma[1] && i < 2; i++)
            for (int x = 0; x < b.n; x++)
                j->luma[i][at + (size_t)x] = luma_601f(b.display[i] + 3 * x);
        for (int x = 0; x < b.n; x++)
            if (is_inside(j, at + (size_t)x))
                add_pixel(&j->block[item], &b, x);
    }
}

static void compare_structure(void *context, size_t item, int worker)
{
    struct job *j = context;
    const int width = j->a->width, first = (int)item * SSIM_ROWS;
    double *scratch = j->scratch + (size_t)worker * ssim_scratch(width);
    j->block[item].ssim = ssim_rows(j->luma[0], j->luma[1], j->mask ? j->mask->data : NULL, width,
                                    j->a->height, first, first + SSIM_ROWS, scratch);
}

static void collect(struct relume_difference *out, const struct sums *block, size_t blocks,
                    bool with_delta_e)
{
    struct sums t = {0};
    for (size_t i = 0; i < blocks; i++) {  // in order, so that threads change no bit
        t.linear += block[i].linear;
        t.display += block[i].display;
        t.coded += block[i].coded;
        t.delta_e += block[i].delta_e;
        t.ssim.sum += block[i].ssim.sum;
        t.ssim.windows += block[i].ssim.windows;
        t.max_abs = fmax(t.max_abs, block[i].max_abs);
        t.pixels += block[i].pixels;
    }
    const double samples = 3.0 * (double)t.pixels;
    *out = (struct relume_difference){
        .rms = sqrt(t.linear / samples),
        .max_abs = t.max_abs,
        .psnr_db = decibels(t.coded / (255.0 * 255.0) / samples),
        .mse = t.display / samples,
        .ssim = t.ssim.windows ? t.ssim.sum / (double)t.ssim.windows : (double)NAN,
        .delta_e = with_delta_e ? t.delta_e / (double)t.pixels : (double)NAN,
        .pixels = t.pixels,
    };
}

relume_status relume_image_compare(struct relume_difference *out, const struct relume_image *image,
                                   const struct relume_image *reference,
                                   const struct relume_compare_params *params)
{
    const struct relume_compare_params p = PARAMS(relume_compare_params, params);
    *out = (struct relume_difference){0};
    if (image->channels != 3 || reference->channels != 3 || image->width != reference->width ||
        image->height != reference->height)
        return RELUME_EINVAL;
    const bool masked = p.mask && p.mask->data;
    if (masked && (p.mask->width != image->width || p.mask->height != image->height))
        return RELUME_EINVAL;

    const size_t pixels = (size_t)image->width * (size_t)image->height;
    const size_t blocks = ((size_t)image->height + ROWS - 1) / ROWS;
    const size_t parts = ((size_t)image->height + SSIM_ROWS - 1) / SSIM_ROWS;
    struct job job = {
        .a = image,
        .b = reference,
        .mask = masked ? p.mask : NULL,
        .tables = p.no_delta_e ? NULL : ciede_tables(),
        .is_srgb = p.display.curve == RELUME_CURVE_SRGB || p.display.curve == RELUME_CURVE_AUTO,
        .block = mem_zeroed(blocks, sizeof *job.block),
    };
    encoder_init(&job.display, p.display);
    bool good = job.block;
    if (good && !p.no_ssim) {
        job.luma[0] = mem_array(pixels, sizeof(float));
        job.luma[1] = mem_array(pixels, sizeof(float));
        job.scratch = mem_array((size_t)thread_count(p.threads) * ssim_scratch(image->width),
                                sizeof *job.scratch);
        good = job.luma[0] && job.luma[1] && job.scratch;
    }
    if (good) {
        thread_for(p.threads, blocks, measure_rows, &job);
        if (!p.no_ssim)
            thread_for(p.threads, parts, compare_structure, &job);
        collect(out, job.block, blocks, !p.no_delta_e);
    }
    mem_free(job.luma[0]);
    mem_free(job.luma[1]);
    mem_free(job.block);
    mem_free(job.scratch);
    return good ? RELUME_OK : RELUME_ENOMEM;
}
