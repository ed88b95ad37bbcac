// chromatic.c - the pattern at 575 nm becomes that of all wavelengths (Ritschel 2009, 8.4.3)
//
// Row by row: for every wavelength two rows of the pattern become one, which is then stretched.
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "relight/eye/pattern.h"
#include "relight/eye/psf.h"

#include <math.h>
#include <string.h>

enum { SLACK = 32 };  // texels that kernels may read beyond a line

size_t chromatic_work(int n, int threads)
{
    return (size_t)thread_count(threads) * ((size_t)n + SLACK);
}

// Row `v` (from the middle, times scale) of the plane between columns [from, to) into `line`.
// False where the plane does not reach.
static bool take_line(float *line, const struct plane *in, double v, int from, int to,
                      const struct psf_kernels *kernels)
{
    const double y = in->middle + v;
    const int j = relume_whole(floor(y));
    if (j < 0 || j + 1 >= in->n)
        return false;
    const float *const row = in->v + (size_t)j * in->stride + from;
    kernels->mix(line, row, row + in->stride, (float)(y - j), to - from);
    return true;
}

// Outputs u in [-half, half] at a scale need the columns [from, to) of the plane; outputs that
// need more are cut.
struct window {
    int half, from, to;
    float at;  // of output -half, from column `from`
};

static struct window window_of(const struct plane *in, int half, double scale)
{
    const int most = relume_whole(floor((in->middle - 1) / scale));
    struct window w = {.half = half < most ? half : most};
    const double first = in->middle - w.half * scale;
    w.from = relume_whole(floor(first));
    w.to = relume_whole(floor(in->middle + w.half * scale)) + 2;
    w.to = w.to < in->n ? w.to : in->n;
    w.at = (float)(first - w.from);
    return w;
}

// ---------------------------------------------------------------- smear

struct smear {
    struct plane *out;
    const struct plane *in;
    const struct relume_psf_spectrum *spectrum;
    const struct psf_kernels *kernels;
    float *work;
};

static void smear_row(void *context, size_t item, int worker)
{
    const struct smear *s = context;
    const int v = (int)item - s->in->middle, n = s->in->n, middle = s->in->middle;
    float *const line = s->work + (size_t)worker * ((size_t)n + SLACK);
    float *const out = s->out->v + item * s->out->stride;
    const int reach = n - 1 - middle < middle ? n - 1 - middle : middle;
    memset(out, 0, (size_t)n * sizeof *out);
    for (int j = 0; j < s->spectrum->fines; j++) {
        const double scale = (double)s->spectrum->fine[j];
        const struct window w = window_of(s->in, reach, scale);
        if (!take_line(line, s->in, v * scale, w.from, w.to, s->kernels))
            continue;
        s->kernels->spread_one(out + middle - w.half, 2 * w.half + 1, line, w.at, (float)scale,
                               (float)(scale * scale / s->spectrum->fines));
    }
}

void chromatic_smear(struct plane *out, const struct plane *in,
                     const struct relume_psf_spectrum *spectrum, const struct psf_kernels *kernels,
                     int threads, float *work)
{
    struct smear smear = {out, in, spectrum, kernels, work};
    thread_for(threads, (size_t)in->n, smear_row, &smear);
}

// ---------------------------------------------------------------- sum

struct sum {
    float *const *out;
    int field;
    const struct plane *in;
    const struct relume_psf_spectrum *spectrum;
    double fade, radius;
    const struct psf_kernels *kernels;
    float *work;
    double (*sums)[3];  // of rows
    float scale[3];
};

static void fade_out(float *const row[3], int half, int v, double fade, double radius)
{
    const double chord = fade * fade - (double)v * v;
    const int kept = chord > 0.0 ? relume_whole(sqrt(chord)) : -1;
    for (int u = kept + 1; u <= half; u++) {
        const double r = sqrt((double)u * u + (double)v * v);
        const float keep = (float)(1.0 - smoothstep(fade, radius, r));
        for (int c = 0; c < 3; c++) {
            row[c][half + u] *= keep;
            if (u)
                row[c][half - u] *= keep;
        }
    }
}

static void sum_row(void *context, size_t item, int worker)
{
    const struct sum *s = context;
    const int half = s->field / 2, v = (int)item - half;
    float *const line = s->work + (size_t)worker * ((size_t)s->in->n + SLACK);
    float *row[3], *inside[3];
    // Within the circle; beyond it everything is faded out.
    const int chord = relume_whole(sqrt(fmax(s->radius * s->radius - (double)v * v, 0.0)));
    for (int c = 0; c < 3; c++) {
        row[c] = s->out[c] + item * (size_t)s->field;
        memset(row[c], 0, (size_t)s->field * sizeof *row[c]);
    }
    for (int i = 0; i < s->spectrum->taps; i++) {
        const struct relume_psf_tap *const tap = &s->spectrum->tap[i];
        const double scale = (double)tap->scale;
        const struct window w = window_of(s->in, chord < half ? chord : half, scale);
        if (!take_line(line, s->in, v * scale, w.from, w.to, s->kernels))
            continue;
        for (int c = 0; c < 3; c++)
            inside[c] = row[c] + half - w.half;
        s->kernels->spread(inside, 2 * w.half + 1, line, w.at, (float)scale, tap->rgb);
    }
    fade_out(row, half, v, s->fade, s->radius);
    for (int c = 0; c < 3; c++) {
        float all = 0.0f;
        for (int i = 0; i < s->field; i++)
            all += row[c][i];
        s->sums[item][c] = (double)all;
    }
}

static void scale_row(void *context, size_t item, int worker)
{
    const struct sum *s = context;
    (void)worker;
    for (int c = 0; c < 3; c++) {
        float *const row = s->out[c] + item * (size_t)s->field;
        for (int i = 0; i < s->field; i++)
            row[i] *= s->scale[c];
    }
}

void chromatic_sum(float *const out[3], int field, const struct plane *in,
                   const struct relume_psf_spectrum *spectrum, double fade, double radius,
                   const struct psf_kernels *kernels, int threads, float *work, double (*sums)[3])
{
    struct sum sum = {out, field, in, spectrum, fade, radius, kernels, work, sums, {0}};
    double all[3] = {0};
    thread_for(threads, (size_t)field, sum_row, &sum);
    for (int y = 0; y < field; y++)
        for (int c = 0; c < 3; c++)
            all[c] += sums[y][c];
    for (int c = 0; c < 3; c++)
        sum.scale[c] = (float)(all[c] > 0.0 ? 1.0 / all[c] : 0.0);
    thread_for(threads, (size_t)field, scale_row, &sum);
}
