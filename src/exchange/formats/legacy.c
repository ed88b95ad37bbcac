// legacy.c - .ptm and .rti from a relume file: its own codes where they fit, else a fit
#include "exchange/foreign/measure.h"
#include "exchange/foreign/planes.h"
#include "exchange/formats/export.h"
#include "exchange/formats/legacy.h"
#include "exchange/formats/ptm.h"
#include "exchange/formats/rti.h"

#include "core/base/log.h"
#include "core/base/memory.h"

#include <math.h>
#include <string.h>

struct target {
    struct functions functions;
    bool luminance;
};

static struct target target_of(const struct export *e, enum relume_exchange format)
{
    if (format == RELUME_EXCHANGE_RTI)
        return (struct target){
            {.kind = FUNCTIONS_HSH, .count = e->params->coefficients ? e->params->coefficients : 9},
            false};
    return (struct target){{.kind = FUNCTIONS_PTM, .count = 6}, format == RELUME_EXCHANGE_LPTM};
}

// ---------------------------------------------------------------- codes as they are

// Whether the file's functions are the target's own, in their order and scale.
static bool same_functions(const struct export *e, const struct target *t)
{
    const struct relume_coder_info *info = relume_coder_info(e->source->codes->coder);
    const int k = t->functions.count;
    float w[3 * FUNCTIONS_MOST_OWN], constant[3];
    if (info->basis->learned || info->luminance != t->luminance || info->coefficients != k)
        return false;
    for (int i = 0; i < 40; i++) {
        const double z = 0.1 + 0.9 * (i + 0.5) / 40, r = sqrt(1.0 - z * z), phi = 2.4 * i;
        const struct relume_vec3 l = {r * cos(phi), r * sin(phi), z};
        double values[FUNCTIONS_MOST_OWN];
        functions_at(&t->functions, l, values);
        relume_coder_weights(e->source->codes->coder, l, w, constant);
        for (int j = 0; j < 3 * k; j++)
            if (fabs((double)w[j] - values[j % k]) > 1e-5)
                return false;
    }
    return true;
}

static bool near(double a, double b)
{
    return fabs(a - b) <= 1e-5 * fmax(fabs(a), fabs(b)) + 1e-9;
}

// Whether the file's quantisers are of the kind that the format holds.
static bool same_quantisers(const struct relume_codes *codes, const struct target *t)
{
    const int copies = t->luminance ? 1 : 3, terms = t->functions.count;
    for (int c = 0; t->luminance && c < 3; c++)
        if (!near((double)codes->scale[terms + c], 1.0 / 255.0) ||
            !near((double)codes->offset[terms + c], 0.0))
            return false;
    for (int k = 0; k < terms; k++) {
        const float *scale = codes->scale + copies * k, *offset = codes->offset + copies * k;
        for (int c = 1; c < copies; c++)
            if (!near((double)scale[c], (double)scale[0]) ||
                !near((double)offset[c], (double)offset[0]))
                return false;
        const double bias = -(double)offset[0] / (double)scale[0];
        if (t->functions.kind == FUNCTIONS_PTM && !(fabs(bias - rint(bias)) < 1e-3))
            return false;
    }
    return true;
}

static relume_status take_codes(struct foreign *f, const struct export *e)
{
    const struct relume_codes *codes = e->source->codes;
    const size_t pixels = foreign_pixels(f);
    for (int p = 0; p < f->planes; p++) {
        f->scale[p] = codes->scale[p];
        f->offset[p] = codes->offset[p];
        memcpy(f->codes + (size_t)p * pixels, codes->plane[p], pixels);
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- a fit

static void quantise(struct foreign *f, const struct planes *planes, int first, int count)
{
    const size_t pixels = foreign_pixels(f);
    double min = planes->minimum[first], max = planes->maximum[first];
    for (int p = first; p < first + count; p++) {
        min = fmin(min, planes->minimum[p]);
        max = fmax(max, planes->maximum[p]);
    }
    double scale = max > min ? (max - min) / 255.0 : 1.0, offset = min;
    if (f->functions.kind == FUNCTIONS_PTM) {
        const struct ptm_quantiser q = ptm_quantiser(min, max);
        scale = (double)(float)q.scale;
        offset = -q.bias * scale;
    }
    for (int p = first; p < first + count; p++) {
        const float *from = planes_at(planes, p);
        uint8_t *to = f->codes + (size_t)p * pixels;
        f->scale[p] = (float)scale;
        f->offset[p] = (float)offset;
        for (size_t i = 0; i < pixels; i++)
            to[i] = (uint8_t)fmin(fmax(rint(((double)from[i] - offset) / scale), 0.0), 255.0);
    }
}

static void take_colours(struct foreign *f, const struct planes *planes)
{
    const size_t pixels = foreign_pixels(f);
    for (int p = f->terms; p < f->planes; p++) {
        const float *from = planes_at(planes, p);
        f->scale[p] = 1.0f / 255.0f;
        for (size_t i = 0; i < pixels; i++)
            f->codes[(size_t)p * pixels + i] =
                (uint8_t)fminf(fmaxf(rintf(255.0f * from[i]), 0.0f), 255.0f);
    }
}

static relume_status fit(struct foreign *f, const struct export *e, const struct target *t,
                         const char *path)
{
    struct plan plan;
    struct planes planes = {0};
    relume_status status =
        plan_fit(&plan, e->source, &t->functions,
                 t->luminance ? FOREIGN_LUMINANCE : FOREIGN_CHANNELS, e->params->threads);
    if (!status)
        status = planes_make(&planes, &plan, e->source, path, e->params->threads);
    for (int k = 0; !status && k < t->functions.count; k++)
        quantise(f, &planes, t->luminance ? k : 3 * k, t->luminance ? 1 : 3);
    if (!status && t->luminance)
        take_colours(f, &planes);
    planes_free(&planes);
    plan_free(&plan);
    return status;
}

// ---------------------------------------------------------------- files

static relume_status write_raw(const struct foreign *f, const struct export *e, const char *path,
                               struct relume_export_report *report)
{
    const relume_status status =
        measure_psnr(&report->psnr_db, f, e->source, NULL, e->params->threads);
    report->bytes_per_pixel = f->planes;
    if (status)
        return status;
    return f->functions.kind == FUNCTIONS_HSH ? rti_write(f, path, e->params->writer, e->log)
                                              : ptm_write(f, path, e->params->writer, e->log);
}

relume_status export_legacy(const struct export *e, const char *path, enum relume_exchange format,
                            struct relume_export_report *report)
{
    const struct target t = target_of(e, format);
    const struct relume_codes *codes = e->source->codes;
    const bool jpeg = legacy_wants_jpeg(e->params);
    struct foreign f = {.form = t.luminance ? FOREIGN_LUMINANCE : FOREIGN_CHANNELS,
                        .functions = t.functions,
                        .terms = t.functions.count};
    if (!functions_has_count(t.functions.kind, t.functions.count))
        return log_fail(e->log, RELUME_EINVAL, "%d coefficient%s; expected 1, 4, 9 or 16 for hsh",
                        t.functions.count, relume_plural(t.functions.count));
    relume_status status = jpeg ? legacy_check_jpeg(e, path, format) : RELUME_OK;
    if (!status)
        status = foreign_create(&f, path, codes->width, codes->height,
                                t.luminance ? f.terms + 3 : 3 * f.terms, NULL, e->log);
    report->exact = !e->source->between && codes->storage == RELUME_STORE_8 &&
                    same_functions(e, &t) && same_quantisers(codes, &t);
    if (!status)
        status = report->exact ? take_codes(&f, e) : fit(&f, e, &t, path);
    report->planes = f.planes;
    if (!status)
        status = jpeg ? legacy_write_jpeg(&f, e, path, report) : write_raw(&f, e, path, report);
    foreign_free(&f);
    return status;
}
