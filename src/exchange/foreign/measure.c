// measure.c - how far an exported picture is from the file that it was made from
#include "exchange/foreign/measure.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/lsq.h"
#include "core/math/scalar.h"

#include <math.h>
#include <relume/image.h>

enum { LIGHTS = 16, BAND_ROWS = 8, SAMPLE_PIXELS = 1 << 18 };

struct judge {
    const struct foreign *f;
    const struct source *s;
    const struct measure_weights *weights;
    struct relume_transfer shown;  // coding of what is not linear
    int lights, every;
    float *file, *file_constant;        // [lights][3][P], [lights][3]
    float *foreign, *foreign_constant;  // [lights][3][planes], [lights][3]
    double *square;                     // [bands][lights]
    relume_status *status;
};

static const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
static const struct relume_transfer linear = {.curve = RELUME_CURVE_LINEAR};

static float code_of(float v, struct relume_transfer coding)
{
    if (coding.curve != RELUME_CURVE_SRGB)
        v = relume_transfer_encode(srgb, relume_transfer_decode(coding, fmaxf(v, 0.0f)));
    return rintf(255.0f * fminf(fmaxf(v, 0.0f), 1.0f));
}

static void read_foreign(const struct foreign *f, size_t first, size_t n, float *out)
{
    for (size_t p = 0; p < (size_t)f->planes; p++)
        for (size_t i = 0; i < n; i++)
            out[p * n + i] =
                (float)f->codes[p * foreign_pixels(f) + first + i] * f->scale[p] + f->offset[p];
    for (size_t i = 0; f->knee > 0.0f && i < n; i++) {
        const float gain = f->knee + fabsf(out[i]);
        for (size_t p = 0; p < (size_t)f->planes; p++)
            out[p * n + i] *= gain;
    }
}

static double compare_row(const struct judge *j, size_t row, const float *a, const float *b,
                          const float *colour, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        const float shown = (b[i] + j->foreign_constant[row]) * (colour ? colour[i] : 1.0f);
        const float d = code_of(a[i] + j->file_constant[row], j->s->coding) -
                        code_of(shown, j->f->linear ? linear : j->shown);
        sum += (double)(d * d);
    }
    return sum;
}

static void compare_band(void *context, size_t item, int worker)
{
    (void)worker;
    const struct judge *j = context;
    const int row = (int)item * BAND_ROWS * j->every, views = 3 * j->lights;
    const int rows = j->s->height - row < BAND_ROWS ? j->s->height - row : BAND_ROWS;
    const size_t n = (size_t)rows * (size_t)j->s->width, k = (size_t)j->f->terms;
    const int p = j->s->numbers, q = j->f->planes;
    float *x = mem_array((size_t)p * n, sizeof *x), *c = mem_array((size_t)q * n, sizeof *c);
    float *a = mem_array((size_t)views * n, sizeof *a),
          *b = mem_array((size_t)views * n, sizeof *b);
    j->status[item] = x && c && a && b ? source_rows(j->s, row, rows, x) : RELUME_ENOMEM;
    if (!j->status[item]) {
        const bool coloured = j->f->form == FOREIGN_LUMINANCE;
        read_foreign(j->f, (size_t)row * (size_t)j->s->width, n, c);
        lsq_multiply(views, (int)n, p, j->file, p, x, (int)n, a, (int)n);
        lsq_multiply(views, (int)n, q, j->foreign, q, c, (int)n, b, (int)n);
        for (size_t v = 0; v < (size_t)views; v++)
            j->square[item * (size_t)j->lights + v / 3] +=
                compare_row(j, v, a + v * n, b + v * n, coloured ? c + (k + v % 3) * n : NULL, n);
    }
    mem_free(x);
    mem_free(c);
    mem_free(a);
    mem_free(b);
}

// Rows of weights as matrices over the source's numbers and over the stored planes.
static void fill_rows(struct judge *j, size_t light, const double *file, const double *foreign,
                      const double constant[3])
{
    const size_t p = (size_t)j->s->numbers, q = (size_t)j->f->planes, k = (size_t)j->f->terms;
    for (size_t c = 0; c < 3; c++) {
        const size_t row = 3 * light + c;
        for (size_t i = 0; i < p; i++)
            j->file[row * p + i] = (float)file[c * (p + 1) + i];
        j->file_constant[row] = (float)file[c * (p + 1) + p];
        for (size_t i = 0; i < k; i++)
            j->foreign[row * q + (j->f->form == FOREIGN_CHANNELS ? 3 * i + c : i)] =
                (float)foreign[c * k + i];
        j->foreign_constant[row] = (float)constant[c];
    }
}

static relume_status prepare(struct judge *j, size_t bands)
{
    const size_t n = (size_t)j->lights, p = (size_t)j->s->numbers, q = (size_t)j->f->planes;
    double *file = mem_array(3 * (p + 1), sizeof *file);
    double *foreign = mem_array(3 * (size_t)j->f->terms, sizeof *foreign), constant[3];
    j->file = mem_array(3 * n * p, sizeof *j->file);
    j->file_constant = mem_array(3 * n, sizeof *j->file_constant);
    j->foreign = mem_zeroed(3 * n * q, sizeof *j->foreign);
    j->foreign_constant = mem_array(3 * n, sizeof *j->foreign_constant);
    j->square = mem_zeroed(bands * n, sizeof *j->square);
    j->status = mem_zeroed(bands, sizeof *j->status);
    const bool good = file && foreign && j->file && j->file_constant && j->foreign &&
                      j->foreign_constant && j->square && j->status;
    for (size_t i = 0; good && i < n; i++) {
        const struct relume_vec3 light = j->s->light[i * (size_t)j->s->lights / n];
        source_weights(j->s, light, file);
        if (j->weights)
            j->weights->at(j->weights->user, light, foreign, constant);
        else
            foreign_weights(j->f, light, foreign, constant);
        fill_rows(j, i, file, foreign, constant);
    }
    mem_free(file);
    mem_free(foreign);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

static double mean_psnr(const struct judge *j, size_t bands)
{
    double pixels = 0.0, sum = 0.0, all = 0.0;
    for (size_t b = 0; b < bands; b++) {
        const int row = (int)b * BAND_ROWS * j->every;
        pixels +=
            (double)(j->s->height - row < BAND_ROWS ? j->s->height - row : BAND_ROWS) * j->s->width;
    }
    for (int l = 0; l < j->lights; l++) {
        double square = 0.0;
        for (size_t b = 0; b < bands; b++)
            square += j->square[b * (size_t)j->lights + (size_t)l];
        sum += decibels(square / (3.0 * pixels) / (255.0 * 255.0));
        all += square / (3.0 * pixels) / (255.0 * 255.0);
    }
    return j->weights ? decibels(all / j->lights) : sum / j->lights;
}

relume_status measure_psnr(double *psnr_db, const struct foreign *f, const struct source *s,
                           const struct measure_weights *weights, int threads)
{
    const size_t pixels = (size_t)s->width * (size_t)s->height;
    struct judge j = {.f = f,
                      .s = s,
                      .weights = weights,
                      .shown = weights ? s->coding : srgb,
                      .lights = s->lights < LIGHTS ? s->lights : LIGHTS};
    j.every = (int)(pixels / SAMPLE_PIXELS) + 1;
    const int step = BAND_ROWS * j.every;
    const size_t bands = (size_t)((s->height + step - 1) / step);
    relume_status status = prepare(&j, bands);
    if (!status)
        thread_for(threads, bands, compare_band, &j);
    for (size_t b = 0; !status && b < bands; b++)
        status = j.status[b];
    *psnr_db = status ? 0.0 : mean_psnr(&j, bands);
    mem_free(j.file);
    mem_free(j.file_constant);
    mem_free(j.foreign);
    mem_free(j.foreign_constant);
    mem_free(j.square);
    mem_free(j.status);
    return status;
}
