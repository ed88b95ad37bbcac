// slices.c - the wave on its way through the vitreous body, from one depth to the next
#include "relight/eye/slices.h"

#include "core/base/memory.h"
#include "core/math/fft2d.h"
#include "relight/eye/pupil.h"

#include <math.h>
#include <string.h>

static const double wavelength_mm = 575e-6;
static const double retina_mm = 24.0;    // behind the pupil, as the thesis has it
static const double deepest_mm = 22.0;   // the back of the vitreous body
static const double refraction = 1.336;  // of the vitreous body

struct slices {
    int n;
    double texel_mm;
    fft2d *fft;
    float *wave, *spectrum, *shadow;
    struct relume_eye_disc *disc;  // of one depth
    int capacity;
    float *turn;  // [n] pairs: exp(-i pi lambda z f^2) by frequency along one axis
};

void slices_destroy(struct slices **slices)
{
    struct slices *const s = *slices;
    if (!s)
        return;
    fft2d_destroy(&s->fft);
    mem_free(s->wave);
    mem_free(s->spectrum);
    mem_free(s->shadow);
    mem_free(s->disc);
    mem_free(s->turn);
    mem_free(s);
    *slices = NULL;
}

static relume_status create(struct slices **out, const struct canvas *canvas, int discs,
                            int threads)
{
    struct slices *const s = *out = mem_zeroed(1, sizeof *s);
    const size_t n = (size_t)canvas->n;
    if (!s)
        return RELUME_ENOMEM;
    s->n = canvas->n;
    s->texel_mm = canvas->texel_mm;
    s->capacity = discs;
    bool good = !fft2d_create(&s->fft, s->n, s->n, false, threads);
    s->wave = mem_zeroed(2 * n * n, sizeof *s->wave);
    s->shadow = mem_array(n * n, sizeof *s->shadow);
    s->turn = mem_array(2 * n, sizeof *s->turn);
    s->disc = mem_array((size_t)discs, sizeof *s->disc);
    good = good && s->wave && s->shadow && s->turn && s->disc;
    good = good && (s->spectrum = mem_array(fft2d_size(s->fft), sizeof *s->spectrum));
    if (!good)
        slices_destroy(out);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- one step

static void multiply(float z[2], float re, float im)
{
    const float a = z[0], b = z[1];
    z[0] = a * re - b * im;
    z[1] = a * im + b * re;
}

static void enter_pupil(struct slices *s, const struct canvas *canvas, const float *phase)
{
    const size_t n = (size_t)s->n;
    memset(s->wave, 0, 2 * n * n * sizeof *s->wave);
    for (size_t y = (size_t)canvas->from; y < (size_t)canvas->to; y++)
        for (size_t x = 0; x < n; x++) {
            float *const z = s->wave + 2 * (y * n + x);
            z[0] = canvas->t[y * n + x];
            multiply(z, phase[2 * x], phase[2 * x + 1]);
            multiply(z, phase[2 * y], phase[2 * y + 1]);
        }
}

static void give_row(void *context, int row, float *line)
{
    const struct slices *s = context;
    memcpy(line, s->wave + 2 * (size_t)row * (size_t)s->n, 2 * (size_t)s->n * sizeof *line);
}

static bool turn_phases(void *context, int column, int count, float *lines)
{
    const struct slices *s = context;
    for (int k = 0; k < count; k++)
        for (int y = 0; y < s->n; y++) {
            float *const z = lines + 2 * ((size_t)s->n * (size_t)k + (size_t)y);
            multiply(z, s->turn[2 * (column + k)], s->turn[2 * (column + k) + 1]);
            multiply(z, s->turn[2 * y], s->turn[2 * y + 1]);
        }
    return true;
}

// The wave in the next plane, times what its discs let through.
static void take_row(void *context, int row, const float *line)
{
    const struct slices *s = context;
    const size_t n = (size_t)s->n, at = (size_t)row * n;
    const float scale = 1.0f / ((float)n * (float)n);
    for (size_t x = 0; x < n; x++) {
        s->wave[2 * (at + x)] = scale * s->shadow[at + x] * line[2 * x];
        s->wave[2 * (at + x) + 1] = scale * s->shadow[at + x] * line[2 * x + 1];
    }
}

static void travel(struct slices *s, double distance_mm)
{
    const double span = s->n * s->texel_mm;
    for (int i = 0; i < s->n; i++) {
        const double f = (i <= s->n / 2 ? i : i - s->n) / span;
        const double phase = -M_PI * wavelength_mm * distance_mm * f * f;
        s->turn[2 * i] = (float)cos(phase);
        s->turn[2 * i + 1] = (float)sin(phase);
    }
    fft2d_rows(s->fft, s->spectrum, 0, s->n, give_row, s);
    const struct fft2d_step column_step = {
        .to = s->n, .end = s->n, .visit = turn_phases, .context = s, .back = true};
    fft2d_step_columns(s->fft, s->spectrum, &column_step);
    fft2d_rows_back(s->fft, s->spectrum, 0, s->n, take_row, s);
}

// ---------------------------------------------------------------- all steps

// The discs between two depths as a shadow of `scale`.
static relume_status cast_shadow(struct slices *s, struct canvas *canvas,
                                 const struct relume_aperture *aperture, double from, double to,
                                 double scale, int threads)
{
    const struct relume_eye_disc *const all = aperture->disc + aperture->vitreous.first;
    const size_t texels = (size_t)s->n * (size_t)s->n;
    int count = 0;
    for (int i = 0; i < aperture->vitreous.count; i++)
        if ((double)all[i].depth >= from && (double)all[i].depth < to)
            s->disc[count++] = all[i];
    for (size_t i = 0; i < texels; i++)
        s->shadow[i] = 1.0f;
    return canvas_discs(canvas, s->shadow, s->disc, count, scale, threads);
}

relume_status slices_run(float **wave, struct slices **slices, struct canvas *canvas,
                         const float *phase, const struct relume_aperture *aperture, int planes,
                         int threads)
{
    relume_status status = RELUME_OK;
    *wave = NULL;
    if (*slices && ((*slices)->n != canvas->n || (*slices)->capacity < aperture->vitreous.count))
        slices_destroy(slices);
    if (!*slices)
        status = create(slices, canvas, aperture->vitreous.count, threads);
    if (status)
        return status;
    struct slices *const s = *slices;
    double before = 0.0;
    enter_pupil(s, canvas, phase);
    for (int k = 0; !status && k < planes; k++) {
        const double from = k ? k * deepest_mm / planes : -(double)INFINITY;
        const double to = k + 1 < planes ? (k + 1) * deepest_mm / planes : (double)INFINITY;
        const double depth = (k + 0.5) * deepest_mm / planes;
        const double scale = retina_mm / (retina_mm - depth), now = depth * scale / refraction;
        status = cast_shadow(s, canvas, aperture, from, to, scale, threads);
        if (!status)
            travel(s, now - before);
        before = now;
    }
    *wave = s->wave;
    return status;
}
