// export_web.c - a folder of the size or quality that is asked for
//
// One number, the common quantiser step, decides both. Trials run on at most half a million pixels'
// worth of block rows; the last steps are on the whole picture, so that a size is never exceeded
// and a PSNR, measured on what was written, is reached.
#include "exchange/foreign/measure.h"
#include "exchange/formats/export.h"
#include "exchange/formats/tiles.h"
#include "exchange/formats/web.h"
#include "exchange/formats/web_step.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outdir.h"
#include "core/math/scalar.h"

#include <limits.h>
#include <math.h>

enum { CORRECTIONS = 5, DEFAULT_PLANES = 27, DEFAULT_YAB_PLANES = 45, FIRST_QUALITY = 80 };

struct maker {
    const struct export *e;
    struct planes planes, sample;
    struct plan plan;
    bool all;         // the number of planes was asked for
    int most_chroma;  // mycc
    const char *path;
    double step;
    int quality;  // that was asked for or chosen; 0: a size or a PSNR decides
};

static double pixels_of(const struct planes *p)
{
    return (double)p->width * p->height;
}

static struct web_trials trials_of(const struct maker *m)
{
    return (struct web_trials){.plan = &m->plan,
                               .planes = m->sample.data ? &m->sample : &m->planes,
                               .all = m->all,
                               .threads = m->e->params->threads,
                               .log = m->e->log};
}

// The whole picture at the step that was found, made coarser until it is as small as was asked.
static relume_status encode_whole(struct maker *m, struct web_folder *w)
{
    const double target = m->e->params->bytes_per_pixel;
    for (int i = 0; i <= CORRECTIONS; i++) {
        const relume_status status = web_encode(w, m->step, m->all, m->e->params->threads);
        const double found = (double)w->bytes / pixels_of(&m->planes);
        if (status || !(target > 0.0) || found <= target)
            return status;
        if (m->step >= WEB_MOST_STEP)
            break;
        m->step = fmin(m->step * pow(found / target, 1.3) * 1.002, WEB_MOST_STEP);
    }
    return log_fail(m->e->log, RELUME_EUNFIT,
                    "%s: %g bytes a pixel is too small; the smallest possible is %.3f", m->path,
                    target, (double)w->bytes / pixels_of(&m->planes));
}

static relume_status measure_folder(const struct maker *m, const char *path,
                                    struct relume_export_report *report)
{
    struct foreign f;
    relume_status status = web_read(&f, path, NULL, m->e->log);
    if (!status)
        status = measure_psnr(&report->psnr_db, &f, m->e->source, NULL, m->e->params->threads);
    foreign_free(&f);
    return status;
}

// One attempt: the folder is written and looked at.
static relume_status attempt(struct maker *m, struct web_folder *w, double wanted, const char *path,
                             struct relume_export_report *report)
{
    const struct web_trials t = trials_of(m);
    relume_status status = wanted > 0.0 ? web_step_of_psnr(&m->step, &t, wanted) : RELUME_OK;
    if (!status)
        status = encode_whole(m, w);
    if (!status)
        status = web_write_info(w, path, m->quality, m->e->log);
    if (!status)
        status = m->e->tiles ? tiles_write(w, m->step, path, m->e->params->threads, m->e->log)
                             : web_write_planes(w, path, m->e->log);
    if (!status)
        status = measure_folder(m, path, report);
    report->planes = web_planes(w);
    report->quality = m->quality;
    report->bytes_per_pixel = (double)w->bytes / pixels_of(&m->planes);
    return status;
}

static relume_status make_folder(struct maker *m, const char *path,
                                 struct relume_export_report *report)
{
    const double target = m->e->params->psnr_db;
    double wanted = target;
    for (int i = 0; i <= CORRECTIONS && !(i > 0 && m->step < 1.01 * WEB_LEAST_STEP); i++) {
        struct web_folder w = {.plan = &m->plan, .planes = &m->planes};
        const relume_status status = attempt(m, &w, wanted, path, report);
        const bool reached = !(target > 0.0) || report->psnr_db >= target;
        web_folder_free(&w);
        if (status || reached)
            return status;
        wanted += target - report->psnr_db + 0.01;
    }
    return log_fail(m->e->log, RELUME_EUNFIT,
                    "%s: %g dB cannot be reached in this format; the best is %.2f dB", m->path,
                    target, report->psnr_db);
}

// Finer than the lights by half again, for the grid lies across them; 15 does well for domes of
// some fifty lights, where 9 to 13 lose detail and finer ones gain nothing
// (docs/measurements/compression.md).
static int default_resolution(int lights)
{
    const int side = (int)(1.5 * sqrt(lights)) | 1;
    return side < 15 ? 15 : side > 33 ? 33 : side;
}

static relume_status choose_functions(const struct export *e, struct functions *f)
{
    const struct relume_export_params *p = e->params;
    static const enum function_kind kinds[] = {
        [RELUME_WEB_BILINEAR] = FUNCTIONS_GRID, [RELUME_WEB_RBF] = FUNCTIONS_GAUSS,
        [RELUME_WEB_PTM] = FUNCTIONS_PTM,       [RELUME_WEB_LPTM] = FUNCTIONS_PTM,
        [RELUME_WEB_HSH] = FUNCTIONS_HSH,       [RELUME_WEB_SH] = FUNCTIONS_SH,
    };
    *f = (struct functions){.kind = kinds[p->type]};
    if (f->kind == FUNCTIONS_GRID) {
        f->resolution = p->resolution ? p->resolution : default_resolution(e->source->lights);
        f->count = f->resolution * f->resolution;
        return RELUME_OK;
    }
    if (f->kind == FUNCTIONS_GAUSS) {
        f->lights = e->source->light;
        f->count = e->source->lights;
        f->sigma = export_light_spacing(e->source);
        return RELUME_OK;
    }
    f->count = p->coefficients ? p->coefficients : f->kind == FUNCTIONS_PTM ? 6 : 9;
    if (web_has_count(f->kind, f->count))
        return RELUME_OK;
    return log_fail(e->log, RELUME_EINVAL, "%d coefficient%s; expected %s", f->count,
                    relume_plural(f->count),
                    f->kind == FUNCTIONS_PTM ? "3 or 6 for ptm" : "1, 4 or 9 for hsh and sh");
}

static relume_status make_plan(struct maker *m)
{
    const struct relume_export_params *p = m->e->params;
    const bool joint = p->type == RELUME_WEB_BILINEAR || p->type == RELUME_WEB_RBF;
    struct functions f;
    if (p->ycc && p->type == RELUME_WEB_LPTM)
        return log_fail(m->e->log, RELUME_EINVAL,
                        "colour space ycc: expected type bilinear, rbf, ptm, hsh or sh");
    if (joint && p->ycc && p->coefficients && p->coefficients < 3)
        return log_fail(m->e->log, RELUME_EINVAL,
                        "%d coefficients; expected at least 3 in colour space mycc",
                        p->coefficients);
    const relume_status status = choose_functions(m->e, &f);
    if (status)
        return status;
    m->all = p->coefficients != 0;
    if (joint && p->ycc)
        return plan_yab(&m->plan, m->e->source, &f,
                        p->coefficients ? p->coefficients : DEFAULT_YAB_PLANES, m->most_chroma,
                        p->threads);
    if (joint)
        return plan_components(&m->plan, m->e->source, &f,
                               p->coefficients ? p->coefficients : DEFAULT_PLANES, p->threads);
    const enum foreign_form form = p->type == RELUME_WEB_LPTM ? FOREIGN_LUMINANCE
                                   : p->ycc                   ? FOREIGN_YCC
                                                              : FOREIGN_CHANNELS;
    return plan_fit(&m->plan, m->e->source, &f, form, p->threads);
}

static relume_status choose_step(struct maker *m)
{
    const struct relume_export_params *p = m->e->params;
    const struct web_trials t = trials_of(m);
    if (p->bytes_per_pixel > 0.0)
        return web_step_of_bytes(&m->step, &t, p->bytes_per_pixel);
    if (p->psnr_db > 0.0 && m->plan.chroma > 1)
        return web_step_of_psnr(&m->step, &t, p->psnr_db);
    if (!(p->psnr_db > 0.0) && !p->quality)
        return web_step_unseen(&m->step, &m->quality, &t);
    m->step = web_step_of_quality(p->quality ? p->quality : FIRST_QUALITY);
    return RELUME_OK;
}

static void free_planes(struct maker *m)
{
    planes_free(&m->planes);
    planes_free(&m->sample);
    plan_free(&m->plan);
}

static relume_status prepare(struct maker *m)
{
    const struct export *e = m->e;
    relume_status status = make_plan(m);
    if (!status)
        status = planes_make(&m->planes, &m->plan, e->source, m->path, e->params->threads);
    const int every = status ? 1 : (int)(pixels_of(&m->planes) / WEB_TRIAL_PIXELS) + 1;
    if (!status && every > 1)
        status = planes_sample(&m->sample, &m->planes, every, m->path, e->log);
    return status ? status : choose_step(m);
}

// How many chroma planes are worth their bytes depends on the step; where the plan has more, it is
// made again with as many.
static relume_status spare_chroma(struct maker *m)
{
    struct web_folder w = {.plan = &m->plan, .planes = m->sample.data ? &m->sample : &m->planes};
    if (m->all || m->plan.chroma < 2)
        return RELUME_OK;
    const relume_status status = web_encode(&w, m->step, true, m->e->params->threads);
    const int useful = status ? 0 : web_useful_chroma(&w, m->step);
    web_folder_free(&w);
    if (status || useful == m->plan.chroma)
        return status;
    m->most_chroma = useful;
    free_planes(m);
    return prepare(m);
}

relume_status export_web(const struct export *e, const char *path,
                         struct relume_export_report *report)
{
    struct maker m = {.e = e, .path = path, .most_chroma = INT_MAX, .quality = e->params->quality};
    outdir *dir = NULL;
    relume_status status = outdir_open(&dir, path, e->params->force, e->log);
    if (!status)
        status = prepare(&m);
    if (!status)
        status = spare_chroma(&m);
    if (!status)
        status = make_folder(&m, outdir_path(dir), report);
    status = outdir_end(&dir, status);
    free_planes(&m);
    return status;
}
