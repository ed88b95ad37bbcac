// psf.c - the pattern of one point source: aperture, Eq. 8.3, wavelengths (Ritschel 2009, 8.3, 8.4)
//
// Seen from inside, light that leaves the pupil with the phase exp(2 pi i f x) seems to come from
// the angle -lambda f, so coefficient k of the transform is stored at -k.
#include <relume/relight/psf.h>

#include "core/base/clock.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/fft2d.h"
#include "relight/eye/aperture.h"
#include "relight/eye/psf.h"
#include "relight/eye/pattern.h"
#include "relight/eye/pupil.h"
#include "relight/eye/slices.h"

#include <math.h>
#include <string.h>

static const double default_width_mm = 9.0;
static const double field_nm = 400.0;    // the shortest wavelength that matters; fields are its
static const double fade_from = 0.9;     // of the radius
static const double retina_mm = 24.0;    // d as printed
static const double least_light = 1e-3;  // of the pupil; lids that leave less are shut
enum { DEFAULT_SIZE = 1024, DEFAULT_WAVELENGTHS = 32, SPARE = 16 };

struct relume_psf {
    struct relume_psf_params params;
    struct relume_psf_geometry shape;
    struct relume_psf_spectrum spectrum;
    const struct psf_kernels *kernels;
    struct canvas canvas;
    fft2d *real, *complex;  // made when first needed
    struct slices *slices;  // likewise
    const float *wave;      // behind the last of several planes; NULL: one plane
    float *field;           // a spectrum of either
    size_t field_size;
    float *phase;  // [canvas.n][2]: E along one axis; the other is the same
    float *texel;  // [size]: 1 over the transform of a texel, squared, by frequency
    struct plane mono, smeared;
    float *colour[3];  // [field][field]
    float *work;
    double (*sums)[3];  // [field]
    bool mirrored;      // the transform of a real aperture: only half of it is computed
    double light, age, pigment;
    struct relume_psf_times times;
};

// ---------------------------------------------------------------- parameters

relume_status psf_defaults(struct relume_psf_params *out, const struct relume_psf_params *params)
{
    struct relume_psf_params p = PARAMS_WORK(relume_psf_params, params);
    p.size = p.size ? p.size : DEFAULT_SIZE;
    p.wavelengths = p.wavelengths ? p.wavelengths : DEFAULT_WAVELENGTHS;
    *out = p;
    if (p.size < 64 || p.size > 8192 || p.size % 2)
        return log_fail(p.log, RELUME_EINVAL,
                        "size of the pattern; expected an even number from 64 to 8192; found %d",
                        p.size);
    if (p.wavelengths < 1 || p.wavelengths > RELUME_PSF_MOST_TAPS)
        return log_fail(p.log, RELUME_EINVAL, "wavelengths; expected 1 to %d; found %d",
                        RELUME_PSF_MOST_TAPS, p.wavelengths);
    if (p.planes < 0 || p.planes > 16)
        return log_fail(p.log, RELUME_EINVAL, "planes; expected 0 to 16; found %d", p.planes);
    if (p.temperature_k != 0.0 && !(p.temperature_k >= 1000.0 && p.temperature_k <= 40000.0))
        return log_fail(p.log, RELUME_EINVAL, "temperature; expected 1000 to 40000 K; found %g",
                        p.temperature_k);
    if (p.half_field_deg != 0.0 && !(p.half_field_deg > 0.0 && p.half_field_deg <= 20.0))
        return log_fail(p.log, RELUME_EINVAL, "half field; expected up to 20 degrees; found %g",
                        p.half_field_deg);
    if (p.half_field_deg > 0.0)
        out->width_mm = p.size * field_nm * 1e-6 / (2.0 * sin(p.half_field_deg * M_PI / 180.0));
    else if (p.width_mm == 0.0)
        out->width_mm = default_width_mm;
    if (!(out->width_mm >= 0.2 && out->width_mm <= 100.0))
        return log_fail(p.log, RELUME_EINVAL,
                        "width of the aperture; expected 0.2 to 100 mm; found %g", out->width_mm);
    return RELUME_OK;
}

relume_status relume_psf_geometry(struct relume_psf_geometry *out,
                                  const struct relume_psf_params *params)
{
    struct relume_psf_params p;
    *out = (struct relume_psf_geometry){0};
    const relume_status status = psf_defaults(&p, params);
    if (status)
        return status;
    const double half = p.wavelengths == 1 ? 0.5 * p.size - 1.0 : 0.5 * p.size * field_nm / PSF_NM;
    *out = (struct relume_psf_geometry){
        .size = p.size,
        .width_mm = p.width_mm,
        .texel_mm = p.width_mm / p.size,
        .step = PSF_NM * 1e-6 / p.width_mm,
        .field = 2 * (int)floor(half) + 1,
        .radius = half * PSF_NM * 1e-6 / p.width_mm,
        .defocus_phase = M_PI / (PSF_NM * 1e-6) * 1e-3,  // a dioptre is 1e-3 / mm
    };
    out->fade = fade_from * out->radius;
    return RELUME_OK;
}

// ---------------------------------------------------------------- tables

// A texel's coverage is an average over it, which lowers high frequencies by a known factor.
static relume_status make_tables(relume_psf *psf)
{
    const int n = psf->shape.size;
    psf->texel = mem_array((size_t)n, sizeof *psf->texel);
    if (!psf->texel)
        return RELUME_ENOMEM;
    for (int i = 0; i < n; i++) {
        const int k = i <= n / 2 ? i : i - n;
        const double x = M_PI * k / n, s = k ? sin(x) / x : 1.0;
        psf->texel[i] = (float)(1.0 / (s * s));
    }
    return RELUME_OK;
}

static relume_status make_plane(struct plane *plane, int n)
{
    plane->n = n + 1;  // texel n is texel 0 of the next period
    plane->middle = n / 2;
    plane->stride = (size_t)n + SPARE;
    plane->v = mem_zeroed(plane->stride * (size_t)(n + 2), sizeof *plane->v);
    return plane->v ? RELUME_OK : RELUME_ENOMEM;
}

relume_status relume_psf_create(relume_psf **out, const struct relume_psf_params *params)
{
    relume_psf *psf = mem_zeroed(1, sizeof *psf);
    *out = NULL;
    if (!psf)
        return RELUME_ENOMEM;
    relume_status status = psf_defaults(&psf->params, params);
    if (!status)
        status = relume_psf_geometry(&psf->shape, params);
    if (!status)
        status = relume_psf_spectrum(&psf->spectrum, params);
    if (!status)
        status = make_tables(psf);
    if (!status)
        status = make_plane(&psf->mono, psf->shape.size);
    if (!status)
        status = make_plane(&psf->smeared, psf->shape.size);
    const size_t texels = (size_t)psf->shape.field * (size_t)psf->shape.field;
    for (int c = 0; !status && c < 3; c++)
        if (!(psf->colour[c] = mem_zeroed(texels, sizeof **psf->colour)))
            status = RELUME_ENOMEM;
    psf->work = status ? NULL
                       : mem_zeroed(chromatic_work(psf->shape.size + 2, psf->params.threads),
                                    sizeof *psf->work);
    psf->sums = mem_array((size_t)psf->shape.field, sizeof *psf->sums);
    if (!status && (!psf->work || !psf->sums))
        status = RELUME_ENOMEM;
    psf->kernels = kernels_choose(psf->params.cpu_off)->psf;
    psf->light = 1.0;
    *out = psf;
    if (status)
        relume_psf_destroy(out);
    return status;
}

void relume_psf_destroy(relume_psf **psf)
{
    relume_psf *const p = *psf;
    if (!p)
        return;
    canvas_destroy(&p->canvas);
    fft2d_destroy(&p->real);
    fft2d_destroy(&p->complex);
    slices_destroy(&p->slices);
    mem_free(p->field);
    mem_free(p->phase);
    mem_free(p->texel);
    mem_free(p->mono.v);
    mem_free(p->smeared.v);
    for (int c = 0; c < 3; c++)
        mem_free(p->colour[c]);
    mem_free(p->work);
    mem_free(p->sums);
    mem_free(p);
    *psf = NULL;
}

// ---------------------------------------------------------------- aperture

// A canvas that the pupil fits into; wider than the transform when it has to be folded. Steps of 64
// texels keep one canvas while the pupil breathes.
static relume_status prepare_canvas(relume_psf *psf, const struct relume_aperture *aperture)
{
    const int size = psf->shape.size;
    const double wanted = 2.0 * (double)aperture->pupil_radius / psf->shape.texel_mm + 4.0;
    int n = size;
    if (wanted > n)
        n = 64 * relume_whole(ceil(wanted / 64.0)) + 128;
    if (psf->canvas.n >= n && psf->canvas.texel_mm == psf->shape.texel_mm && psf->canvas.t)
        return RELUME_OK;
    mem_free(psf->phase);
    psf->phase = mem_array(2 * (size_t)n, sizeof *psf->phase);
    const relume_status status = canvas_resize(&psf->canvas, n, psf->shape.texel_mm);
    return psf->phase ? status : RELUME_ENOMEM;
}

static void make_phase(relume_psf *psf, double dioptres)
{
    const double strength = psf->params.retina_distance ? 1e3 / retina_mm : dioptres;
    for (int i = 0; i < psf->canvas.n; i++) {
        const double x = (i - psf->canvas.n / 2) * psf->shape.texel_mm;
        const double phase = psf->shape.defocus_phase * strength * x * x;
        psf->phase[2 * i] = (float)cos(phase);
        psf->phase[2 * i + 1] = (float)sin(phase);
    }
}

// ---------------------------------------------------------------- diffraction

// The first canvas row from `from` on that folds onto `row` of the transform.
static int first_row(const relume_psf *psf, int row)
{
    const int n = psf->shape.size, shift = psf->canvas.n / 2 - n / 2;
    int y = row + shift;
    while (y - n >= psf->canvas.from)
        y -= n;
    while (y < psf->canvas.from)
        y += n;
    return y;
}

// Canvas column x lies at (x - shift) modulo the size; `at` walks along.
static void fill_real(void *context, int row, float *line)
{
    const relume_psf *psf = context;
    const int n = psf->shape.size, m = psf->canvas.n;
    const int start = ((n / 2 - m / 2) % n + n) % n;
    memset(line, 0, (size_t)n * sizeof *line);
    for (int y = first_row(psf, row); y < psf->canvas.to; y += n) {
        const float *const t = psf->canvas.t + (size_t)y * (size_t)m;
        for (int x = 0, at = start; x < m; at = 0) {
            const int run = n - at < m - x ? n - at : m - x;
            for (int i = 0; i < run; i++)
                line[at + i] += t[x + i];
            x += run;
        }
    }
}

static void fill_complex(void *context, int row, float *line)
{
    const relume_psf *psf = context;
    const int n = psf->shape.size, m = psf->canvas.n;
    const int start = ((n / 2 - m / 2) % n + n) % n;
    memset(line, 0, 2 * (size_t)n * sizeof *line);
    for (int y = first_row(psf, row); y < psf->canvas.to; y += n) {
        const float *const t = psf->canvas.t + (size_t)y * (size_t)m;
        const float c = psf->phase[2 * y], s = psf->phase[2 * y + 1];
        for (int x = 0, at = start; x < m; x++, at = at + 1 < n ? at + 1 : 0) {
            const float re = psf->phase[2 * x], im = psf->phase[2 * x + 1];
            line[2 * at] += t[x] * (c * re - s * im);
            line[2 * at + 1] += t[x] * (c * im + s * re);
        }
    }
}

static void fill_wave(void *context, int row, float *line)
{
    const relume_psf *psf = context;
    const int n = psf->shape.size, m = psf->canvas.n;
    const int start = ((n / 2 - m / 2) % n + n) % n;
    memset(line, 0, 2 * (size_t)n * sizeof *line);
    for (int y = (row + m / 2 - n / 2) % n; y < m; y += n) {
        const float *const wave = psf->wave + 2 * (size_t)y * (size_t)m;
        for (int x = 0, at = start; x < m; x++, at = at + 1 < n ? at + 1 : 0) {
            line[2 * at] += wave[2 * x];
            line[2 * at + 1] += wave[2 * x + 1];
        }
    }
}

// Power of the columns' coefficients at their places; at the mirrored ones too when only half of
// them is there. Column 0 stands in the middle, and its row repeats after n.
static bool store_power(void *context, int column, int count, float *lines)
{
    relume_psf *const psf = context;
    const int n = psf->shape.size, middle = n / 2;
    int to[FFT2D_BLOCK], across[FFT2D_BLOCK];
    float gain[FFT2D_BLOCK];
    for (int k = 0; k < count; k++) {
        to[k] = (middle - column - k + n) % n;
        across[k] = (middle + column + k) % n;
        gain[k] = psf->texel[column + k];
    }
    for (int y = 0; y < n; y++) {
        const int row = middle - y + (y > middle ? n : 0);
        const int opposite = middle + y - (y >= n - middle ? n : 0);
        float *const here = psf->mono.v + (size_t)row * psf->mono.stride;
        float *const there = psf->mono.v + (size_t)opposite * psf->mono.stride;
        for (int k = 0; k < count; k++) {
            const float *const z = lines + 2 * ((size_t)n * (size_t)k + (size_t)y);
            const float power = (z[0] * z[0] + z[1] * z[1]) * psf->texel[y] * gain[k];
            here[to[k]] = power;
            if (psf->mirrored)
                there[across[k]] = power;
        }
    }
    return false;
}

static relume_status need_field(relume_psf *psf, const fft2d *fft)
{
    if (psf->field_size >= fft2d_size(fft))
        return RELUME_OK;
    mem_free(psf->field);
    psf->field = mem_array(fft2d_size(fft), sizeof *psf->field);
    psf->field_size = psf->field ? fft2d_size(fft) : 0;
    return psf->field ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status diffract(relume_psf *psf, bool real)
{
    fft2d **const fft = real ? &psf->real : &psf->complex;
    const int n = psf->shape.size;
    relume_status status = RELUME_OK;
    psf->mirrored = real;
    if (!*fft)
        status = fft2d_create(fft, n, n, real, psf->params.threads);
    if (!status)
        status = need_field(psf, *fft);
    if (status)
        return status;
    // Rows that the pupil folds onto.
    const int shift = psf->canvas.n / 2 - n / 2;
    const bool folded = psf->canvas.n > n || psf->wave;
    const int from = folded ? 0 : psf->canvas.from - shift;
    const int to = folded ? n : psf->canvas.to - shift;
    fft2d_rows(*fft, psf->field, from, to,
               psf->wave ? fill_wave
               : real    ? fill_real
                         : fill_complex,
               psf);
    const struct fft2d_step column_step = {
        .from = from, .to = to, .end = fft2d_columns(*fft), .visit = store_power, .context = psf};
    fft2d_step_columns(*fft, psf->field, &column_step);
    return RELUME_OK;
}

// ---------------------------------------------------------------- wavelengths

static void colour(relume_psf *psf)
{
    const double step = psf->shape.step;
    const struct plane *from = &psf->mono;
    const int field = psf->shape.field;
    if (psf->spectrum.fines > 1) {
        chromatic_smear(&psf->smeared, &psf->mono, &psf->spectrum, psf->kernels,
                        psf->params.threads, psf->work);
        from = &psf->smeared;
    }
    chromatic_sum(psf->colour, field, from, &psf->spectrum, psf->shape.fade / step,
                  psf->shape.radius / step, psf->kernels, psf->params.threads, psf->work,
                  psf->sums);
}

// ---------------------------------------------------------------- update

relume_status psf_update_aperture(relume_psf *psf, const struct relume_aperture *aperture,
                                  double dioptres)
{
    const struct relume_psf_params *const p = &psf->params;
    const bool several = p->planes > 1 && !(p->parts_off & RELUME_EYE_VITREOUS);
    const bool real = dioptres == 0.0 && !p->retina_distance && !several;
    const double start = now_s();
    relume_status status = prepare_canvas(psf, aperture);
    if (!status)
        status = canvas_draw(&psf->canvas, aperture,
                             p->parts_off | (several ? RELUME_EYE_VITREOUS : 0u), p->threads);
    if (status)
        return status;
    psf->light = psf->canvas.light;
    if (psf->light < least_light)
        return RELUME_OK;
    const double drawn = now_s();
    float *wave = NULL;
    make_phase(psf, dioptres);
    if (several)
        status = slices_run(&wave, &psf->slices, &psf->canvas, psf->phase, aperture, p->planes,
                            p->threads);
    psf->wave = wave;
    if (!status)
        status = diffract(psf, real);
    if (status)
        return status;
    const double diffracted = now_s();
    // Texel n of a row and row n repeat the first ones, so that lookups may stand between them.
    const int n = psf->mono.n - 1;
    for (int y = 0; y < n; y++)
        psf->mono.v[(size_t)y * psf->mono.stride + (size_t)n] =
            psf->mono.v[(size_t)y * psf->mono.stride];
    memcpy(psf->mono.v + (size_t)n * psf->mono.stride, psf->mono.v,
           psf->mono.stride * sizeof *psf->mono.v);
    colour(psf);
    psf->times = (struct relume_psf_times){drawn - start, diffracted - drawn, now_s() - diffracted};
    return RELUME_OK;
}

relume_status relume_psf_update(relume_psf *psf, const relume_eye *eye)
{
    const struct relume_subject *const subject = relume_eye_subject(eye);
    psf->age = subject->optics.age;
    psf->pigment = subject->optics.pigment;
    return psf_update_aperture(psf, relume_eye_aperture(eye), subject->optics.defocus_dpt);
}

// ---------------------------------------------------------------- results

struct relume_psf_times relume_psf_times(const relume_psf *psf)
{
    return psf->times;
}

double relume_psf_light(const relume_psf *psf)
{
    return psf->light;
}

const struct relume_psf_geometry *relume_psf_shape(const relume_psf *psf)
{
    return &psf->shape;
}

const float *psf_channel(const relume_psf *psf, int channel)
{
    return psf->colour[channel];
}

float *psf_channel_to_fill(relume_psf *psf, int channel)
{
    return psf->colour[channel];
}

void psf_filled(relume_psf *psf, double light, double age, double pigment)
{
    psf->light = light;
    psf->age = age;
    psf->pigment = pigment;
}

int psf_threads(const relume_psf *psf)
{
    return psf->params.threads;
}

void psf_observer(const relume_psf *psf, double *age, double *pigment)
{
    *age = psf->age;
    *pigment = psf->pigment;
}

relume_status relume_psf_image(struct relume_image *out, const relume_psf *psf)
{
    const size_t texels = (size_t)psf->shape.field * (size_t)psf->shape.field;
    const relume_status status = relume_image_create(out, psf->shape.field, psf->shape.field, 3);
    for (size_t i = 0; !status && i < texels; i++)
        for (int c = 0; c < 3; c++)
            out->data[3 * i + (size_t)c] = psf->colour[c][i];
    return status;
}

// The middle `size` texels: all of it unless it is folded.
relume_status relume_psf_aperture(struct relume_image *out, const relume_psf *psf)
{
    const int n = psf->canvas.n > psf->shape.size ? psf->canvas.n : psf->shape.size;
    const relume_status status = relume_image_create(out, n, n, 1);
    for (int y = psf->canvas.from; !status && psf->canvas.t && y < psf->canvas.to; y++)
        memcpy(out->data + (size_t)y * (size_t)n, psf->canvas.t + (size_t)y * (size_t)n,
               (size_t)n * sizeof *out->data);
    return status;
}

relume_status relume_psf_monochrome(struct relume_image *out, const relume_psf *psf)
{
    const int n = psf->shape.size;
    const relume_status status = relume_image_create(out, n, n, 1);
    if (status)
        return status;
    double sum = 0.0;
    for (int y = 0; y < n; y++)
        for (int x = 0; x < n; x++)
            sum += (double)psf->mono.v[(size_t)y * psf->mono.stride + (size_t)x];
    for (int y = 0; y < n; y++)
        for (int x = 0; x < n; x++)
            out->data[(size_t)y * (size_t)n + (size_t)x] =
                (float)((double)psf->mono.v[(size_t)y * psf->mono.stride + (size_t)x] /
                        (sum > 0.0 ? sum : 1.0));
    return RELUME_OK;
}
