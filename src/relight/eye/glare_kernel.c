// glare_kernel.c - the pattern at the scale of a frame's pixels, and the veil beyond it
#include "relight/eye/glare.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "relight/eye/psf.h"
#include "relight/eye/veil.h"

#include <math.h>
#include <string.h>

// The veil is the observer's up to the first of these angles and has faded out at the second.
static const double veil_fade_deg = 7.5, veil_deg = RELUME_VEIL_DEG;
enum { MOST_REACH = 8192 };  // pixels

// CIE 135/1-1999, total glare function of the standard observer (Vos and van den Berg).
double relume_cie_glare(double angle_deg, double age, double pigment)
{
    const double t = fabs(angle_deg), old = pow(age / 70.0, 4.0);
    const double a = 1.0 + pow(t / 0.0046, 2.0), b = 1.0 + pow(t / 0.045, 2.0),
                 c = 1.0 + pow(t / 0.1, 2.0);
    return (1.0 - 0.08 * old) * (9.2e6 * pow(a, -1.5) + 1.5e5 * pow(b, -1.5)) +
           (1.0 + 1.6 * old) *
               (400.0 / c + 3e-8 * t * t + pigment * (1300.0 * pow(c, -1.5) + 0.8 / sqrt(c))) +
           2.5e-3 * pigment;
}

double relume_glare_pixel(double fov_deg, int width)
{
    return 2.0 * tan(0.5 * fov_deg * M_PI / 180.0) / width;
}

// ---------------------------------------------------------------- resampling

// One axis: a texel's light goes to the pixels around its place, falling linearly over one pixel,
// or over one texel where that is wider. What a pixel gets is a run of weights.
struct axis {
    int reach, half;        // pixels and texels on either side of the middle
    double pixels, spread;  // a texel's width; how far its light goes
    int *first, *count;     // [2 reach + 1]: texels of a pixel, from -half on
    float *weight;          // [2 reach + 1][most]
    int most;
};

static float share(const struct axis *a, int pixel, int texel)
{
    const double d = fabs(pixel - texel * a->pixels);
    return (float)(d < a->spread ? (1.0 - d / a->spread) / a->spread : 0.0);
}

static relume_status axis_create(struct axis *a, int reach, int half, double pixels)
{
    const int side = 2 * reach + 1;
    *a = (struct axis){.reach = reach, .half = half, .pixels = pixels, .spread = fmax(pixels, 1.0)};
    a->most = relume_whole(fmin(2.0 * a->spread / pixels + 2.0, 2.0 * half + 1.0));
    a->first = mem_array(2 * (size_t)side, sizeof *a->first);
    a->weight = mem_array((size_t)side * (size_t)a->most, sizeof *a->weight);
    if (!a->first || !a->weight)
        return RELUME_ENOMEM;
    a->count = a->first + side;
    for (int i = 0; i < side; i++) {
        const int pixel = i - reach;
        const int from = relume_whole(fmax(ceil((pixel - a->spread) / pixels), -half));
        const int to = relume_whole(fmin(floor((pixel + a->spread) / pixels), half));
        a->first[i] = from + half;
        a->count[i] = to >= from ? to - from + 1 : 0;
        for (int k = 0; k < a->count[i]; k++)
            a->weight[i * a->most + k] = share(a, pixel, from + k);
    }
    return RELUME_OK;
}

struct resampling {
    struct axis axis;
    const relume_psf *psf;
    float *const out[3];  // [side][side]
    float *work;          // [threads][field]
};

static void resample_row(void *context, size_t item, int worker)
{
    const struct resampling *r = context;
    const struct axis *const a = &r->axis;
    const int field = 2 * a->half + 1, side = 2 * a->reach + 1;
    float *const row = r->work + (size_t)worker * (size_t)field;
    for (int c = 0; c < 3; c++) {
        const float *texels = psf_channel(r->psf, c) + (size_t)a->first[item] * (size_t)field;
        float *const out = r->out[c] + item * (size_t)side;
        memset(row, 0, (size_t)field * sizeof *row);
        for (int k = 0; k < a->count[item]; k++, texels += field) {
            const float w = a->weight[(int)item * a->most + k];
            for (int i = 0; i < field; i++)
                row[i] += w * texels[i];
        }
        for (int i = 0; i < side; i++) {
            const float *const w = a->weight + i * a->most;
            float sum = 0.0f;
            for (int k = 0; k < a->count[i]; k++)
                sum += w[k] * row[a->first[i] + k];
            out[i] = sum;
        }
    }
}

// ---------------------------------------------------------------- veil

// Share of the observer's light between two angles: the ring's solid angle is 2 pi sin t dt.
static double light_between(double from_deg, double to_deg, double age, double pigment)
{
    enum { STEPS = 256 };
    const double ratio = log(to_deg / from_deg) / STEPS;
    double sum = 0.0;
    for (int i = 0; i < STEPS; i++) {
        const double t = from_deg * exp((i + 0.5) * ratio);
        sum += (1.0 - smoothstep(veil_fade_deg, veil_deg, t)) * relume_cie_glare(t, age, pigment) *
               2.0 * M_PI * sin(t * M_PI / 180.0) * t * ratio * M_PI / 180.0;
    }
    return sum;
}

void relume_veil(struct relume_veil *out, const struct relume_psf_geometry *pattern, double age,
                 double pigment)
{
    const double edge = pattern->radius * 180.0 / M_PI, fade = pattern->fade * 180.0 / M_PI;
    *out = (struct relume_veil){.step = veil_deg / RELUME_VEIL_STEPS * M_PI / 180.0};
    if (!(edge < veil_deg))
        return;
    out->share = light_between(edge, veil_deg, age, pigment);
    for (int i = 0; i < RELUME_VEIL_STEPS; i++) {
        const double t = i * veil_deg / RELUME_VEIL_STEPS;
        const double share =
            smoothstep(fade, edge, t) * (1.0 - smoothstep(veil_fade_deg, veil_deg, t));
        out->light[i] = (float)(share * relume_cie_glare(t, age, pigment));
    }
}

struct veil {
    float *const out[3];
    int reach;
    double pixel_steps;  // steps of the table in a pixel
    float solid;         // angle of a pixel
    const float *light;
};

static void veil_row(void *context, size_t item, int worker)
{
    const struct veil *v = context;
    const size_t side = 2 * (size_t)v->reach + 1;
    const int y = (int)item - v->reach;
    (void)worker;
    for (int x = -v->reach; x <= v->reach; x++) {
        const double at = v->pixel_steps * sqrt((double)x * x + (double)y * y);
        if (at >= RELUME_VEIL_STEPS)
            continue;
        const int i = relume_whole(at);
        const float light =
            v->solid * (v->light[i] + (float)(at - i) * (v->light[i + 1] - v->light[i]));
        for (int c = 0; c < 3; c++)
            v->out[c][item * side + (size_t)(x + v->reach)] += light;
    }
}

// ---------------------------------------------------------------- kernel

void kernel_destroy(struct kernel *kernel)
{
    mem_free(kernel->v[0]);
    *kernel = (struct kernel){0};
}

static relume_status reach_of(int *reach, double angle, double texel, double pixel,
                              const struct relume_log *log)
{
    const double pixels = ceil((angle + texel) / pixel);
    if (pixels > MOST_REACH)
        return log_fail(log, RELUME_EINVAL,
                        "the pattern would be %.0f pixels wide; expected at most %d: a wider field "
                        "of view or a smaller magnification",
                        2.0 * pixels, 2 * MOST_REACH);
    *reach = relume_whole(pixels);
    return RELUME_OK;
}

struct scaling {
    struct kernel *kernel;
    double light;
};

static void normalise_channel(void *context, size_t c, int worker)
{
    const struct scaling *s = context;
    const size_t side = 2 * (size_t)s->kernel->reach + 1;
    float *const v = s->kernel->v[c];
    double sum = 0.0;
    (void)worker;
    for (size_t y = 0; y < side; y++) {
        float row = 0.0f;
        for (size_t x = 0; x < side; x++)
            row += v[y * side + x];
        sum += (double)row;
    }
    const float scale = (float)(sum > 0.0 ? s->light / sum : 0.0);
    for (size_t i = 0; i < side * side; i++)
        v[i] *= scale;
}

static void normalise(struct kernel *kernel, double light, int threads)
{
    struct scaling s = {kernel, light};
    thread_for(threads, 3, normalise_channel, &s);
}

static relume_status allocate(struct kernel *out, int reach)
{
    const size_t side = 2 * (size_t)reach + 1;
    out->reach = reach;
    out->v[0] = mem_zeroed(3 * side * side, sizeof *out->v[0]);
    if (!out->v[0])
        return RELUME_ENOMEM;
    out->v[1] = out->v[0] + side * side;
    out->v[2] = out->v[1] + side * side;
    return RELUME_OK;
}

static relume_status add_pattern(struct kernel *out, const relume_psf *psf, double fine,
                                 int threads)
{
    const struct relume_psf_geometry *const shape = relume_psf_shape(psf);
    struct resampling r = {
        .psf = psf,
        .out = {out->v[0], out->v[1], out->v[2]},
        .work = mem_array((size_t)thread_count(threads) * (size_t)shape->field, sizeof(float)),
    };
    relume_status status = axis_create(&r.axis, out->reach, shape->field / 2, shape->step / fine);
    if (!r.work)
        status = RELUME_ENOMEM;
    if (!status)
        thread_for(threads, 2 * (size_t)out->reach + 1, resample_row, &r);
    mem_free(r.axis.first);
    mem_free(r.axis.weight);
    mem_free(r.work);
    return status;
}

static void add_veil(struct kernel *out, const struct relume_veil *veil, double fine, int threads)
{
    struct veil v = {.out = {out->v[0], out->v[1], out->v[2]},
                     .reach = out->reach,
                     .pixel_steps = fine / veil->step,
                     .solid = (float)(fine * fine),
                     .light = veil->light};
    thread_for(threads, 2 * (size_t)out->reach + 1, veil_row, &v);
}

relume_status kernel_create(struct kernel *out, const relume_psf *psf, double pixel,
                            enum kernel_part part, const struct relume_glare_params *p)
{
    const struct relume_psf_geometry *const shape = relume_psf_shape(psf);
    const double fine = pixel / p->magnify;
    struct relume_veil veil;
    double age, pigment;
    int reach = 0;
    *out = (struct kernel){0};
    psf_observer(psf, &age, &pigment);
    relume_veil(&veil, shape, age, pigment);
    const bool veiled = !p->no_veil && veil.share > 0.0;
    const double widest = veiled && part & KERNEL_VEIL ? veil_deg * M_PI / 180.0 : shape->radius;
    relume_status status = reach_of(&reach, widest, shape->step, fine, p->log);
    if (!status)
        status = allocate(out, reach);
    if (!status && part & KERNEL_PATTERN)
        status = add_pattern(out, psf, fine, p->threads);
    const double share = veiled ? veil.share : 0.0;
    if (!status && part & KERNEL_PATTERN)
        normalise(out, 1.0 - share, p->threads);
    if (!status && veiled && part & KERNEL_VEIL)
        add_veil(out, &veil, fine, p->threads);
    if (!status && part != KERNEL_PATTERN)
        normalise(out, part == KERNEL_VEIL ? share : 1.0, p->threads);
    if (status)
        kernel_destroy(out);
    return status;
}

relume_status relume_glare_kernel(struct relume_image *out, const relume_psf *psf, double pixel,
                                  const struct relume_glare_params *params)
{
    struct relume_glare_params p;
    struct kernel kernel;
    *out = (struct relume_image){0};
    relume_status status = glare_defaults(&p, params);
    if (!status)
        status = kernel_create(&kernel, psf, pixel, KERNEL_ALL, &p);
    if (status)
        return status;
    const int side = 2 * kernel.reach + 1;
    status = relume_image_create(out, side, side, 3);
    for (size_t i = 0; !status && i < (size_t)side * (size_t)side; i++)
        for (size_t c = 0; c < 3; c++)
            out->data[3 * i + c] = kernel.v[c][i];
    kernel_destroy(&kernel);
    return status;
}
