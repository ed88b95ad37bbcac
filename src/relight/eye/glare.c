// glare.c - a frame as an eye sees it
#include "relight/eye/glare.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/names.h"
#include "core/base/params.h"
#include "core/math/luminance.h"
#include "relight/eye/pattern.h"
#include "relight/eye/veil.h"

#include <math.h>
#include <string.h>

static const double default_fov_deg = 45.0;
enum { DEFAULT_SOURCES = 256 };

relume_status glare_defaults(struct relume_glare_params *out,
                             const struct relume_glare_params *params)
{
    struct relume_glare_params p = PARAMS_WORK(relume_glare_params, params);
    p.fov_deg = p.fov_deg != 0.0 ? p.fov_deg : default_fov_deg;
    p.magnify = p.magnify != 0.0 ? p.magnify : 1.0;
    p.sources = p.sources ? p.sources : DEFAULT_SOURCES;
    *out = p;
    if (!(p.fov_deg >= 0.01 && p.fov_deg <= 170.0))
        return log_fail(p.log, RELUME_EINVAL,
                        "field of view; expected 0.01 to 170 degrees; found %g", p.fov_deg);
    if (!(p.magnify >= 0.01 && p.magnify <= 1000.0))
        return log_fail(p.log, RELUME_EINVAL, "magnification; expected 0.01 to 1000; found %g",
                        p.magnify);
    if ((int)p.mode < 0 || p.mode > RELUME_GLARE_HYBRID || (int)p.border < 0 ||
        p.border > RELUME_GLARE_PERIODIC)
        return log_fail(p.log, RELUME_EINVAL, "mode or border; expected one of their lists");
    if (p.sources < 1 || p.sources > 1 << 20 || !(p.threshold >= 0.0))
        return log_fail(p.log, RELUME_EINVAL,
                        "sources; expected 1 to 1048576 and a threshold of at least 0");
    return RELUME_OK;
}

double relume_glare_luminance(const struct relume_image *frame)
{
    const size_t pixels = (size_t)frame->width * (size_t)frame->height;
    double sum = 0.0;
    for (size_t i = 0; i < pixels; i++) {
        const float *const rgb = frame->data + 3 * i;
        const double y = luminance_709(rgb);
        if (isfinite(y) && y > 0.0)
            sum += y;
    }
    return sum / (double)pixels;
}

// ---------------------------------------------------------------- working memory

struct relume_glare {
    convolver *convolver;
    struct veil_work veil;
    float *clean;  // the frame without what is not a number
    size_t clean_size;
};

relume_status relume_glare_create(relume_glare **out)
{
    *out = mem_zeroed(1, sizeof **out);
    return *out ? RELUME_OK : RELUME_ENOMEM;
}

void relume_glare_destroy(relume_glare **glare)
{
    if (!*glare)
        return;
    convolver_destroy(&(*glare)->convolver);
    veil_destroy(&(*glare)->veil);
    mem_free((*glare)->clean);
    mem_free(*glare);
    *glare = NULL;
}

// Samples that are no numbers.
static size_t count_bad(const float *v, size_t n)
{
    size_t bad = 0;
    for (size_t i = 0; i < n; i++) {
        uint32_t bits;
        memcpy(&bits, &v[i], sizeof bits);
        bad += (bits & 0x7f800000u) == 0x7f800000u;
    }
    return bad;
}

// `frame` itself when it is fine; else a copy.
static relume_status clean_frame(const float **out, relume_glare *glare,
                                 const struct relume_image *frame, const struct relume_log *log)
{
    const size_t n = 3 * (size_t)frame->width * (size_t)frame->height;
    const size_t bad = count_bad(frame->data, n);
    float most = 0.0f;
    *out = frame->data;
    if (!bad)
        return RELUME_OK;
    log_line(log, RELUME_WARNING,
             "%zu pixel%s not numbers; NaN is treated as black, infinity as the brightest pixel",
             bad, bad == 1 ? " is" : "s are");
    if (glare->clean_size != n) {
        mem_free(glare->clean);
        glare->clean = mem_array(n, sizeof *glare->clean);
        glare->clean_size = glare->clean ? n : 0;
    }
    if (!glare->clean)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++)
        if (isfinite(frame->data[i]))
            most = fmaxf(most, frame->data[i]);
    for (size_t i = 0; i < n; i++) {
        const float v = frame->data[i];
        glare->clean[i] = isfinite(v) ? v : isinf(v) && v > 0.0f ? most : 0.0f;
    }
    *out = glare->clean;
    return RELUME_OK;
}

// ---------------------------------------------------------------- modes

struct job {
    relume_glare *glare;
    const relume_psf *psf;
    const float *in;  // [height][width][3]
    int width, height;
    bool same;
    double pixel;
    struct relume_glare_params p;
};

static relume_status convolve(float *out, convolver **kept, const float *in, int width, int height,
                              bool same, const struct kernel *kernel,
                              const struct relume_glare_params *p)
{
    relume_status status = RELUME_OK;
    if (!convolver_fits(*kept, width, height, kernel->reach, p->border, p->threads)) {
        convolver_destroy(kept);
        same = false;
        status = convolver_create(kept, width, height, kernel->reach, p->border, p->threads);
    }
    return status ? status : convolver_run(*kept, out, in, same, kernel);
}

static relume_status by_fft(float *out, const struct job *j)
{
    struct kernel kernel;
    relume_status status = kernel_create(&kernel, j->psf, j->pixel, KERNEL_ALL, &j->p);
    if (!status)
        status = convolve(out, &j->glare->convolver, j->in, j->width, j->height, j->same, &kernel,
                          &j->p);
    kernel_destroy(&kernel);
    return status;
}

// What shines, as sources, and a copy of the frame without it.
static relume_status split(struct sources *sources, float *rest, const struct job *j, bool spots)
{
    const size_t pixels = (size_t)j->width * (size_t)j->height;
    const double threshold =
        j->p.threshold > 0.0 ? j->p.threshold : sources_threshold(j->in, pixels, j->p.sources);
    memcpy(rest, j->in, 3 * pixels * sizeof *rest);
    return sources_find(sources, rest, j->width, j->height, threshold, spots);
}

static relume_status by_billboards(float *out, const struct job *j)
{
    struct kernel kernel = {0};
    struct sources sources = {0};
    struct relume_glare_params p = j->p;
    p.no_veil = true;
    relume_status status = split(&sources, out, j, true);
    if (!status)
        status = kernel_create(&kernel, j->psf, j->pixel, KERNEL_PATTERN, &p);
    if (!status)
        status = sources_splat(out, j->width, j->height, &sources, &kernel, p.threads);
    kernel_destroy(&kernel);
    sources_destroy(&sources);
    return status;
}

static relume_status by_both(float *out, const struct job *j)
{
    struct kernel kernel = {0};
    struct sources sources = {0};
    relume_status status = split(&sources, out, j, false);
    if (!status)
        status =
            veil_add(out, &j->glare->veil, j->in, j->width, j->height, j->psf, j->pixel, &j->p);
    if (!status)
        status = kernel_create(&kernel, j->psf, j->pixel, KERNEL_PATTERN, &j->p);
    if (!status)
        status = sources_splat(out, j->width, j->height, &sources, &kernel, j->p.threads);
    kernel_destroy(&kernel);
    sources_destroy(&sources);
    return status;
}

relume_status relume_glare_apply(struct relume_image *out, relume_glare *glare,
                                 const struct relume_image *frame, bool same_frame,
                                 const relume_psf *psf, const struct relume_glare_params *params)
{
    static relume_status (*const modes[])(float *, const struct job *) = {by_fft, by_billboards,
                                                                          by_both};
    struct job job = {.glare = glare,
                      .psf = psf,
                      .width = frame->width,
                      .height = frame->height,
                      .same = same_frame};
    *out = (struct relume_image){0};
    relume_status status = glare_defaults(&job.p, params);
    if (status)
        return status;
    if (!frame->data || frame->channels != 3)
        return log_fail(job.p.log, RELUME_EINVAL, "frame; expected three channels");
    job.pixel = relume_glare_pixel(job.p.fov_deg, frame->width);
    status = relume_image_create(out, frame->width, frame->height, 3);
    if (!status)
        status = clean_frame(&job.in, glare, frame, job.p.log);
    if (!status)
        status = modes[job.p.mode](out->data, &job);
    const float light = job.p.keep_light ? 1.0f : (float)relume_psf_light(psf);
    for (size_t i = 0; !status && light != 1.0f && i < 3 * (size_t)out->width * (size_t)out->height;
         i++)
        out->data[i] *= light;
    if (status)
        relume_image_destroy(out);
    return status;
}
