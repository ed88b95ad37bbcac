#include "exchange/measure.h"

#include "base/memory.h"
#include "base/thread.h"

#include <math.h>
#include <relume/image.h>

enum { LIGHTS = 16, BAND_ROWS = 8, SAMPLE_PIXELS = 1 << 18 };

struct judge {
    const struct foreign *f;
    const struct source *s;
    int lights, every;
    double *file;     // [lights][3][P + 1]
    double *foreign;  // [lights][3][K]
    double (*constant)[3];
    double *square;  // [bands][lights]
    relume_status *status;
};

static double code_of(double v, bool linear)
{
    if (linear)
        v = (double)relume_transfer_encode((struct relume_transfer){RELUME_CURVE_SRGB, 0.0f},
                                           (float)v);
    return rint(255.0 * fmin(fmax(v, 0.0), 1.0));
}

static void compare_pixel(const struct judge *j, const float *x, size_t n, size_t pixel,
                          double *square)
{
    const size_t p = (size_t)j->s->numbers, k = (size_t)j->f->terms;
    for (size_t l = 0; l < (size_t)j->lights; l++) {
        double rgb[3];
        foreign_pixel(j->f, pixel, j->foreign + l * 3 * k, j->constant[l], rgb);
        for (size_t c = 0; c < 3; c++) {
            const double *w = j->file + (3 * l + c) * (p + 1);
            double value = w[p];
            for (size_t i = 0; i < p; i++)
                value += w[i] * (double)x[i * n];
            const double d = code_of(value, false) - code_of(rgb[c], j->f->linear);
            square[l] += d * d;
        }
    }
}

static void compare_band(void *context, size_t item, int worker)
{
    (void)worker;
    const struct judge *j = context;
    const int row = (int)item * BAND_ROWS * j->every;
    const int rows = j->s->height - row < BAND_ROWS ? j->s->height - row : BAND_ROWS;
    const size_t n = (size_t)rows * (size_t)j->s->width;
    float *x = mem_array((size_t)j->s->numbers * n, sizeof *x);
    j->status[item] = x ? source_rows(j->s, row, rows, x) : RELUME_ENOMEM;
    for (size_t i = 0; !j->status[item] && i < n; i++)
        compare_pixel(j, x + i, n, (size_t)row * (size_t)j->s->width + i,
                      j->square + item * (size_t)j->lights);
    free(x);
}

static relume_status prepare(struct judge *j, size_t bands)
{
    const size_t n = (size_t)j->lights, p = 3 * ((size_t)j->s->numbers + 1);
    const size_t k = 3 * (size_t)j->f->terms;
    j->file = mem_array(n * p, sizeof *j->file);
    j->foreign = mem_array(n * k, sizeof *j->foreign);
    j->constant = mem_array(n, sizeof *j->constant);
    j->square = mem_zeroed(bands * n, sizeof *j->square);
    j->status = mem_zeroed(bands, sizeof *j->status);
    if (!j->file || !j->foreign || !j->constant || !j->square || !j->status)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        const struct relume_vec3 light = j->s->light[i * (size_t)j->s->lights / n];
        source_weights(j->s, light, j->file + i * p);
        foreign_weights(j->f, light, j->foreign + i * k, j->constant[i]);
    }
    return RELUME_OK;
}

static double mean_psnr(const struct judge *j, size_t bands)
{
    double pixels = 0.0, sum = 0.0;
    for (size_t b = 0; b < bands; b++) {
        const int row = (int)b * BAND_ROWS * j->every;
        pixels +=
            (double)(j->s->height - row < BAND_ROWS ? j->s->height - row : BAND_ROWS) * j->s->width;
    }
    for (int l = 0; l < j->lights; l++) {
        double square = 0.0;
        for (size_t b = 0; b < bands; b++)
            square += j->square[b * (size_t)j->lights + (size_t)l];
        const double mse = square / (3.0 * pixels) / (255.0 * 255.0);
        sum += mse > 1e-20 ? -10.0 * log10(mse) : 200.0;
    }
    return sum / j->lights;
}

relume_status measure_psnr(double *psnr_db, const struct foreign *f, const struct source *s,
                           int threads)
{
    const size_t pixels = (size_t)s->width * (size_t)s->height;
    struct judge j = {.f = f, .s = s, .lights = s->lights < LIGHTS ? s->lights : LIGHTS};
    j.every = (int)(pixels / SAMPLE_PIXELS) + 1;
    const int step = BAND_ROWS * j.every;
    const size_t bands = (size_t)((s->height + step - 1) / step);
    relume_status status = prepare(&j, bands);
    if (!status)
        thread_for(threads, bands, compare_band, &j);
    for (size_t b = 0; !status && b < bands; b++)
        status = j.status[b];
    *psnr_db = status ? 0.0 : mean_psnr(&j, bands);
    free(j.file);
    free(j.foreign);
    free(j.constant);
    free(j.square);
    free(j.status);
    return status;
}
