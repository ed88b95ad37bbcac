// glare_kernel.c - the pattern at the scale of a frame's pixels, and the veil beyond it
#include "pass/glare.h"

#include "base/log.h"
#include "base/memory.h"
#include "base/thread.h"
#include "pass/psf.h"

#include <math.h>

static const double veil_deg = 10.0;  // the pattern ends there
enum { MOST_REACH = 8192 };           // pixels

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
// or over one texel where that is wider.
struct axis {
    int reach, half;        // pixels and texels on either side of the middle
    double pixels, spread;  // a texel's width; how far its light goes
};

static double share(const struct axis *a, int pixel, int texel)
{
    const double d = fabs(pixel - texel * a->pixels);
    return d < a->spread ? (1.0 - d / a->spread) / a->spread : 0.0;
}

static void texels_of(const struct axis *a, int pixel, int *from, int *to)
{
    const double low = (pixel - a->spread) / a->pixels, high = (pixel + a->spread) / a->pixels;
    *from = (int)fmax(ceil(low), -a->half);
    *to = (int)fmin(floor(high), a->half);
}

struct resampling {
    struct axis axis;
    const relume_psf *psf;
    float *out[3];  // [side][side]
    float *work;    // [threads][field]
};

static void resample_row(void *context, size_t item, int worker)
{
    const struct resampling *r = context;
    const struct axis *const a = &r->axis;
    const int field = 2 * a->half + 1, side = 2 * a->reach + 1;
    const int pixel = (int)item - a->reach;
    float *const row = r->work + (size_t)worker * (size_t)field;
    int from, to, first, last;
    texels_of(a, pixel, &from, &to);
    for (int c = 0; c < 3; c++) {
        const float *const in = psf_channel(r->psf, c);
        float *const out = r->out[c] + item * (size_t)side;
        for (int i = 0; i < field; i++)
            row[i] = 0.0f;
        for (int k = from; k <= to; k++) {
            const float w = (float)share(a, pixel, k);
            const float *const texels = in + (size_t)(k + a->half) * (size_t)field;
            for (int i = 0; i < field; i++)
                row[i] += w * texels[i];
        }
        for (int i = 0; i < side; i++) {
            float sum = 0.0f;
            texels_of(a, i - a->reach, &first, &last);
            for (int k = first; k <= last; k++)
                sum += (float)share(a, i - a->reach, k) * row[k + a->half];
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
        sum += relume_cie_glare(t, age, pigment) * 2.0 * M_PI * sin(t * M_PI / 180.0) * t * ratio *
               M_PI / 180.0;
    }
    return sum;
}

struct veil {
    float *out[3];
    int reach;
    double deg;         // of a pixel
    double fade, edge;  // degrees: it comes where the pattern goes
    double age, pigment, solid;
};

static void veil_row(void *context, size_t item, int worker)
{
    const struct veil *v = context;
    const int side = 2 * v->reach + 1, y = (int)item - v->reach;
    (void)worker;
    for (int x = -v->reach; x <= v->reach; x++) {
        const double t = v->deg * sqrt((double)x * x + (double)y * y);
        if (t <= v->fade || t >= veil_deg)
            continue;
        const double s = fmin((t - v->fade) / (v->edge - v->fade), 1.0);
        const float light =
            (float)(s * s * (3.0 - 2.0 * s) * v->solid * relume_cie_glare(t, v->age, v->pigment));
        for (int c = 0; c < 3; c++)
            v->out[c][item * (size_t)side + (size_t)(x + v->reach)] += light;
    }
}

// ---------------------------------------------------------------- kernel

void kernel_destroy(struct kernel *kernel)
{
    free(kernel->v[0]);
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
    *reach = (int)pixels;
    return RELUME_OK;
}

static void normalise(struct kernel *kernel, double light)
{
    const size_t side = 2 * (size_t)kernel->reach + 1;
    for (int c = 0; c < 3; c++) {
        double sum = 0.0;
        for (size_t i = 0; i < side * side; i++)
            sum += (double)kernel->v[c][i];
        const float scale = (float)(sum > 0.0 ? light / sum : 0.0);
        for (size_t i = 0; i < side * side; i++)
            kernel->v[c][i] *= scale;
    }
}

relume_status kernel_create(struct kernel *out, const relume_psf *psf, double pixel,
                            const struct relume_glare_params *p)
{
    const struct relume_psf_geometry *const shape = relume_psf_shape(psf);
    const double fine = pixel / (p->magnify > 0.0 ? p->magnify : 1.0);
    const double deg = fine * 180.0 / M_PI, edge = shape->radius * 180.0 / M_PI;
    const bool veiled = !p->no_veil && edge < veil_deg;
    struct resampling r = {.psf = psf};
    *out = (struct kernel){0};
    relume_status status = reach_of(&r.axis.reach, veiled ? veil_deg * M_PI / 180.0 : shape->radius,
                                    shape->step, fine, p->log);
    if (status)
        return status;
    const size_t side = 2 * (size_t)r.axis.reach + 1;
    r.axis.half = shape->field / 2;
    r.axis.pixels = shape->step / fine;
    r.axis.spread = fmax(r.axis.pixels, 1.0);
    out->reach = r.axis.reach;
    out->v[0] = mem_zeroed(3 * side * side, sizeof *out->v[0]);
    r.work = mem_array((size_t)thread_count(p->threads) * (size_t)shape->field, sizeof *r.work);
    if (!out->v[0] || !r.work) {
        free(r.work);
        kernel_destroy(out);
        return RELUME_ENOMEM;
    }
    out->v[1] = out->v[0] + side * side;
    out->v[2] = out->v[1] + side * side;
    for (int c = 0; c < 3; c++)
        r.out[c] = out->v[c];
    thread_for(p->threads, side, resample_row, &r);
    free(r.work);
    if (!veiled) {
        normalise(out, 1.0);
        return RELUME_OK;
    }
    struct veil v = {.reach = out->reach,
                     .deg = deg,
                     .fade = shape->fade * 180.0 / M_PI,
                     .edge = edge,
                     .solid = fine * fine};
    psf_observer(psf, &v.age, &v.pigment);
    const double far = light_between(edge, veil_deg, v.age, v.pigment);
    normalise(out, 1.0 - far);
    for (int c = 0; c < 3; c++)
        v.out[c] = out->v[c];
    thread_for(p->threads, side, veil_row, &v);
    normalise(out, 1.0);
    return RELUME_OK;
}

relume_status relume_glare_kernel(struct relume_image *out, const relume_psf *psf, double pixel,
                                  const struct relume_glare_params *params)
{
    struct relume_glare_params p;
    struct kernel kernel;
    *out = (struct relume_image){0};
    relume_status status = glare_defaults(&p, params);
    if (!status)
        status = kernel_create(&kernel, psf, pixel, &p);
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
