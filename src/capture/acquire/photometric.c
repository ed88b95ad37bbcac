// photometric.c - normals and albedo from the photographs of a view, band by band
#include <relume/capture/photometric.h>

#include "capture/acquire/photometric.h"
#include "capture/manifest/near_view.h"
#include "capture/manifest/reflectance_table.h"
#include "capture/stereo/field.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/lambert.h"
#include "core/math/luminance.h"
#include "core/math/sort.h"

static const size_t band_bytes = (size_t)256 << 20;  // of samples
static const float clipped = 0.995f;                 // of the largest value
static const float half_sure = 0.05f;                // error of a matte fit, of the albedo
enum { LEAST = 4, JUDGED = 4096 };                   // samples of a fit; pixels that judge lights

struct fit {
    const relume_capture *capture;
    struct relume_photometric_params params;
    struct relume_photometric *out;
    int view, lights, width, height;
    bool is_near;
    struct near_view near;
    const vec3 *distant;  // [lights]
    float (*white)[3];    // [lights]
    struct relume_image mask;
    int row, rows;                   // of the band
    float *samples;                  // [lights][rows][width][3]
    size_t stride;                   // of a light in `samples`
    struct lambert_sample *scratch;  // [workers][lights]
    vec3 *towards;                   // [workers][lights]
    float *bright;                   // [workers][lights]: gains of near lights
    bool is_matte;                   // no more than Lambert's law can be asked of this capture
    bool is_shared;                  // all pixels see the same lights from the same side
    struct stereo_field field;
    size_t step;  // one pixel in `step` judges the lights
    // [JUDGED][lights]: values by Lambert's law and in the photograph, / albedo; NaN: not lit
    float (*judged)[2];
};

struct pixel {
    struct lambert_sample *sample;
    vec3 *direction;
    float *gain;
    size_t at;       // in the band
    size_t of_view;  // in the view
};

static const float *sample_of(const struct fit *f, int light, size_t pixel)
{
    return f->samples + (size_t)light * f->stride + 3 * pixel;
}

static void set_directions(const struct fit *f, const struct pixel *p)
{
    const int width = f->width;
    if (!f->is_near)
        return;
    const vec3 point = near_view_pixel(&f->near, (int)(p->of_view % (size_t)width),
                                       (int)(p->of_view / (size_t)width));
    for (int i = 0; i < f->lights; i++) {
        double gain;
        p->direction[i] = near_view_direction(&gain, &f->near, i, point);
        p->gain[i] = (float)gain;
    }
}

static bool is_clipped(const struct fit *f, const struct pixel *p, int light)
{
    const float *rgb = sample_of(f, light, p->at), *white = f->white[light];
    const float most = clipped * (f->is_near ? p->gain[light] : 1.0f);
    return rgb[0] >= most * white[0] || rgb[1] >= most * white[1] || rgb[2] >= most * white[2];
}

// Samples that clip are left out unless too few remain.
static int gather(const struct fit *f, const struct pixel *p)
{
    int n = 0;
    for (int keep = 0; keep < 2 && n < LEAST; keep++) {
        n = 0;
        for (int i = 0; i < f->lights; i++)
            if (keep || f->params.plain || !is_clipped(f, p, i))
                p->sample[n++] =
                    (struct lambert_sample){luminance_709f(sample_of(f, i, p->at)), 1.0f, i};
    }
    return n;
}

static void find_albedo(const struct fit *f, const struct pixel *p, vec3 normal,
                        const struct lambert_sample *s, int n)
{
    double sum[3] = {0}, norm = 0;
    for (int i = 0; i < n; i++) {
        const float *rgb = sample_of(f, s[i].light, p->at);
        const double cosine = vec3_dot(normal, p->direction[s[i].light]);
        if (cosine <= LAMBERT_GRAZING)
            continue;
        norm += (double)s[i].weight * cosine * cosine;
        for (int c = 0; c < 3; c++)
            sum[c] += (double)s[i].weight * cosine * (double)rgb[c];
    }
    for (int c = 0; c < 3; c++)
        f->out->albedo.data[3 * p->of_view + (size_t)c] =
            norm > 0 ? (float)fmax(sum[c] / norm, 0.0) : 0.0f;
}

static void find_error(const struct fit *f, const struct pixel *p, vec3 g,
                       const struct lambert_sample *s, int n)
{
    double sum = 0.0, weight = 0.0;
    for (int i = 0; i < n; i++) {
        const double d = (double)s[i].value - vec3_dot(g, p->direction[s[i].light]);
        sum += (double)s[i].weight * d * d;
        weight += (double)s[i].weight;
    }
    f->out->error.data[p->of_view] = weight > 0 ? (float)(sqrt(sum / weight) / vec3_length(g)) : 0;
}

static void judge_lights(const struct fit *f, const struct pixel *p, vec3 g)
{
    const size_t judge = p->of_view / f->step;
    if (p->of_view % f->step || judge >= JUDGED)
        return;
    const double albedo = vec3_length(g);
    for (int i = 0; i < f->lights; i++) {
        const double expected = vec3_dot(g, p->direction[i]);
        if (expected > LAMBERT_GRAZING * albedo && !is_clipped(f, p, i)) {
            float *to = f->judged[judge * (size_t)f->lights + (size_t)i];
            to[0] = (float)(expected / albedo);
            to[1] = (float)((double)luminance_709f(sample_of(f, i, p->at)) / albedo);
        }
    }
}

// ---------------------------------------------------------------- more than matte

static vec3 towards_eye(const struct fit *f, size_t of_view)
{
    const struct relume_geometry *g = &relume_capture_manifest(f->capture)->geometry;
    const int x = (int)(of_view % (size_t)f->width), y = (int)(of_view / (size_t)f->width);
    if (!g->perspective)
        return vec3_of(0, 0, 1);
    const double u = (x + 0.5) / f->width, v = (y + 0.5) / f->height;
    const vec3 flat = vec3_of(g->window_min[0] + u * (g->window_max[0] - g->window_min[0]),
                              g->window_max[1] - v * (g->window_max[1] - g->window_min[1]), 0);
    const vec3 point = f->is_near ? near_view_pixel(&f->near, x, y) : flat;
    return vec3_unit(vec3_sub(vec3_of(0, 0, g->camera_z), point));
}

// What clips is not known, unless too little else is.
static void set_values(const struct fit *f, const struct pixel *p, float *value)
{
    int known = 0;
    for (int keep = 0; keep < 2 && known < STEREO_LEAST_LIGHTS; keep++) {
        known = 0;
        for (int i = 0; i < f->lights; i++) {
            const bool counts = keep || !is_clipped(f, p, i);
            value[i] = counts ? fmaxf(luminance_709f(sample_of(f, i, p->at)), 0.0f) : -1.0f;
            known += counts;
        }
    }
}

static float improve(struct fit *f, const struct pixel *p, int worker, vec3 *normal)
{
    set_values(f, p, stereo_field_values(&f->field, worker));
    return stereo_field_solve(&f->field, worker, p->direction, towards_eye(f, p->of_view), normal);
}

static void fit_pixel(struct fit *f, const struct pixel *p, int worker)
{
    vec3 g;
    set_directions(f, p);
    int n = gather(f, p);
    const struct lambert_sample *s = lambert_fit(&g, p->direction, p->sample, &n, f->params.plain);
    if (!s)
        return;
    vec3 normal = vec3_unit(g);
    find_error(f, p, g, s, n);
    const float miss = f->out->error.data[p->of_view] / half_sure;
    f->out->confidence.data[p->of_view] =
        f->is_matte ? 1.0f / (1.0f + miss * miss) : improve(f, p, worker, &normal);
    float *to = f->out->normal.data + 3 * p->of_view;
    to[0] = (float)normal.x;
    to[1] = (float)normal.y;
    to[2] = (float)normal.z;
    find_albedo(f, p, normal, s, n);
    judge_lights(f, p, g);
}

static void fit_row(void *context, size_t item, int worker)
{
    struct fit *f = context;
    const size_t width = (size_t)f->width, first = (size_t)worker * (size_t)f->lights;
    struct pixel p = {
        .sample = f->scratch + first, .direction = f->towards + first, .gain = f->bright + first};
    for (int i = 0; i < f->lights; i++)
        p.direction[i] = f->distant[i];
    for (size_t x = 0; x < width; x++) {
        p.at = item * width + x;
        p.of_view = (size_t)f->row * width + p.at;
        if (!f->mask.data || f->mask.data[p.of_view] > 0.5f)
            fit_pixel(f, &p, worker);
    }
}

static void add_learner(struct fit *f, struct pixel *p)
{
    vec3 g;
    if (!stereo_field_next(&f->field))
        return;
    set_directions(f, p);
    int n = gather(f, p);
    if (lambert_fit(&g, p->direction, p->sample, &n, false))
        set_values(
            f, p,
            stereo_field_add(&f->field, vec3_unit(g), p->direction, towards_eye(f, p->of_view)));
}

static void gather_learners(struct fit *f)
{
    struct pixel p = {.sample = f->scratch, .direction = f->towards, .gain = f->bright};
    const size_t pixels = (size_t)f->rows * (size_t)f->width;
    for (int i = 0; i < f->lights; i++)
        p.direction[i] = f->distant[i];
    for (p.at = 0; p.at < pixels; p.at++) {
        p.of_view = (size_t)f->row * (size_t)f->width + p.at;
        if (!f->mask.data || f->mask.data[p.of_view] > 0.5f)
            add_learner(f, &p);
    }
}

static relume_status learn(struct fit *f)
{
    const relume_status status = stereo_field_learn(&f->field);
    f->is_matte = f->field.is_matte;
    return status;
}

static relume_status for_bands(struct fit *f, relume_status (*use)(struct fit *))
{
    relume_table *table;
    const int rows = f->rows;
    relume_status status = relume_table_open(
        &table, f->capture, f->view,
        relume_table_params(.keep_near = true, .log = f->params.log, .threads = f->params.threads));
    for (f->row = 0; !status && f->row < f->height; f->row += rows) {
        f->rows = f->height - f->row < rows ? f->height - f->row : rows;
        f->stride = 3 * (size_t)f->rows * (size_t)f->width;
        status = relume_table_read(table, f->rows, f->samples);
        if (!status)
            status = use(f);
    }
    f->rows = rows;
    relume_table_destroy(&table);
    return status;
}

static relume_status gather_band(struct fit *f)
{
    gather_learners(f);
    return RELUME_OK;
}

static relume_status fit_band(struct fit *f)
{
    relume_status status = RELUME_OK;
    if (!f->is_matte && f->rows == f->height) {  // there is one band alone
        gather_learners(f);
        status = learn(f);
    }
    if (!status)
        thread_for(f->params.threads, (size_t)f->rows, fit_row, f);
    if (!status && !log_progress(f->params.log, "normals", (f->row + f->rows) / (double)f->height))
        status = RELUME_ECANCEL;
    return status;
}

static relume_status fit_bands(struct fit *f)
{
    relume_status status = RELUME_OK;
    if (!f->is_matte && f->rows < f->height) {
        status = for_bands(f, gather_band);
        if (!status)
            status = learn(f);
    }
    return status ? status : for_bands(f, fit_band);
}

// ---------------------------------------------------------------- how well it went

static double median(float *v, size_t n)
{
    sort_floats(v, n);
    return n ? (double)v[n / 2] : 0.0;
}

// The median |miss| / albedo under a light that is `gain` times as bright.
static double median_miss(float *some, const struct fit *f, int light, double gain)
{
    size_t n = 0;
    for (size_t k = 0; k < JUDGED; k++) {
        const float *j = f->judged[k * (size_t)f->lights + (size_t)light];
        if (!isnan(j[0]))
            some[n++] = fabsf(j[1] / (float)gain - j[0]);
    }
    return median(some, n);
}

// Median ratio of shown to expected values of a light; 1 where it is dark.
static double median_gain(float *some, const struct fit *f, int light)
{
    size_t n = 0;
    for (size_t k = 0; k < JUDGED; k++) {
        const float *j = f->judged[k * (size_t)f->lights + (size_t)light];
        if (!isnan(j[0]))
            some[n++] = j[1] / j[0];
    }
    const double gain = median(some, n);
    return gain > 0.0 ? gain : 1.0;
}

static relume_status find_residuals(struct fit *f)
{
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    struct relume_photometric *out = f->out;
    float *some = mem_array(pixels > JUDGED ? pixels : JUDGED, sizeof *some);
    if (!some)
        return RELUME_ENOMEM;
    for (int i = 0; i < f->lights; i++) {
        out->light_residual[i] = median_miss(some, f, i, 1.0);
        out->light_gain[i] = median_gain(some, f, i);
        out->mended_residual[i] = median_miss(some, f, i, out->light_gain[i]);
    }
    size_t n = 0;
    for (size_t k = 0; k < pixels; k++)
        if (out->normal.data[3 * k] != 0.0f || out->normal.data[3 * k + 1] != 0.0f ||
            out->normal.data[3 * k + 2] != 0.0f)
            some[n++] = out->error.data[k];
    out->residual = median(some, n);
    mem_free(some);
    return RELUME_OK;
}

static relume_status alloc_stereo(struct fit *f)
{
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    size_t known = 0;
    for (size_t i = 0; i < pixels; i++)
        known += !f->mask.data || f->mask.data[i] > 0.5f;
    return stereo_field_create(&f->field, f->lights, f->params.threads,
                               f->is_shared ? f->distant : NULL, vec3_of(0, 0, 1),
                               known / STEREO_LEARNERS + 1);
}

static relume_status alloc(struct fit *f)
{
    const size_t lights = (size_t)f->lights, workers = (size_t)f->params.threads;
    const size_t row_bytes = (size_t)f->width * lights * 3 * sizeof(float);
    const size_t fitting = band_bytes / row_bytes;
    f->rows = fitting < 1 ? 1 : fitting < (size_t)f->height ? (int)fitting : f->height;
    f->step = ((size_t)f->width * (size_t)f->height + JUDGED - 1) / JUDGED;
    f->samples = mem_array(3 * lights * (size_t)f->rows * (size_t)f->width, sizeof *f->samples);
    f->white = mem_array(lights, sizeof *f->white);
    f->scratch = mem_array(workers * lights, sizeof *f->scratch);
    f->towards = mem_array(workers * lights, sizeof *f->towards);
    f->bright = mem_array(workers * lights, sizeof *f->bright);
    f->judged = mem_array(JUDGED * lights, sizeof *f->judged);
    f->out->light_residual = mem_zeroed(lights, sizeof *f->out->light_residual);
    f->out->light_gain = mem_zeroed(lights, sizeof *f->out->light_gain);
    f->out->mended_residual = mem_zeroed(lights, sizeof *f->out->mended_residual);
    if (!f->samples || !f->white || !f->scratch || !f->towards || !f->bright || !f->judged ||
        !f->out->light_residual || !f->out->light_gain || !f->out->mended_residual)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < JUDGED * lights; i++)
        f->judged[i][0] = NAN;
    for (int i = 0; i < f->lights; i++)
        relume_capture_white(f->capture, i, f->white[i]);
    relume_status status = relume_image_create(&f->out->normal, f->width, f->height, 3);
    if (!status)
        status = relume_image_create(&f->out->albedo, f->width, f->height, 3);
    if (!status)
        status = relume_image_create(&f->out->error, f->width, f->height, 1);
    if (!status)
        status = relume_image_create(&f->out->confidence, f->width, f->height, 1);
    return status || f->is_matte ? status : alloc_stereo(f);
}

static void release(struct fit *f)
{
    mem_free(f->samples);
    mem_free(f->white);
    mem_free(f->scratch);
    mem_free(f->towards);
    mem_free(f->bright);
    mem_free(f->judged);
    stereo_field_destroy(&f->field);
    near_view_close(&f->near);
    relume_image_destroy(&f->mask);
}

void relume_photometric_destroy(struct relume_photometric *photometric)
{
    relume_image_destroy(&photometric->normal);
    relume_image_destroy(&photometric->albedo);
    relume_image_destroy(&photometric->error);
    relume_image_destroy(&photometric->confidence);
    mem_free(photometric->light_residual);
    mem_free(photometric->light_gain);
    mem_free(photometric->mended_residual);
    *photometric = (struct relume_photometric){0};
}

relume_status relume_photometric_fit(struct relume_photometric *out, const relume_capture *capture,
                                     int view, const struct relume_photometric_params *params)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    struct fit f = {
        .capture = capture,
        .params = PARAMS_WORK(relume_photometric_params, params),
        .out = out,
        .lights = m->lights,
        .width = relume_capture_width(capture),
        .height = relume_capture_height(capture),
        .distant = m->directions,
    };
    *out = (struct relume_photometric){.lights = m->lights};
    if (view < 0 || view >= m->views)
        return RELUME_EINVAL;
    if (m->lights < 3 || !lambert_spans(m->directions, m->lights))
        return log_fail(f.params.log, RELUME_EUNFIT,
                        "normals cannot be computed; expected three lights or more that do not lie "
                        "in one plane; found %d",
                        m->lights);
    f.view = view;
    f.params.threads = thread_count(f.params.threads);
    f.is_near = near_view_applies(capture, view);
    f.is_matte = f.params.plain || m->lights < STEREO_LEAST_LIGHTS ||
                 m->geometry.projection != RELUME_PLANAR;
    f.is_shared = !f.is_near && !m->geometry.perspective;
    relume_status status = relume_capture_mask(&f.mask, capture, view, f.params.log);
    if (!status && f.is_near)
        status = near_view_open(&f.near, capture, view, f.params.log);
    if (!status)
        status = alloc(&f);
    if (!status)
        status = fit_bands(&f);
    if (!status)
        status = find_residuals(&f);
    release(&f);
    if (status)
        relume_photometric_destroy(out);
    return status;
}
