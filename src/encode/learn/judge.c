// judge.c - whether shadows and highlights that wander are better than those that fade, by lights
// left out
#include "relight/shadow/mosaic.h"

#include "capture/manifest/reflectance_table.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "format/coder/coding.h"
#include "relight/shadow/moving.h"

#include <math.h>
#include <string.h>

enum { LEFT_OUT = 6, LEAST_LIGHTS = 8 };
// Ways to interpolate. Highlights wander with the first, shadows with the second.
enum { CHORD, DELAUNAY, COMPARED };
static const double LEAST_SQUARE = 1e-8;  // 80 dB

// One light that is left out.
struct met {
    struct relume_light lamp;
    struct relume_image truth, guess[COMPARED];  // by each coder
    float share[COMPARED];                       // of the light, from where it is taken to come
    float *weights[COMPARED];                    // [3][lights of the coder]
};

// What is compared.
struct judging {
    const relume_capture *capture;
    int view;
    bool gloss;                 // highlights are judged, not shadows
    relume_capture *rest;       // with the lights that are kept
    struct relume_codes codes;  // of no pixels: how lights are interpolated
    relume_shadows *shadows;
    struct relume_transfer display;
    const struct relume_shadows_params *p;
    int *kept;                      // [lights of the coders]: their numbers in the capture
    relume_coder *coder[COMPARED];  // of the same lights
    struct met met[LEFT_OUT];
    int met_count;
    double error[COMPARED + 1];  // mean squares of display values; the last: what wanders
};

static void judging_destroy(struct judging *j)
{
    for (int i = 0; i < j->met_count; i++) {
        struct met *m = &j->met[i];
        relume_image_destroy(&m->truth);
        for (int k = 0; k < COMPARED; k++) {
            relume_image_destroy(&m->guess[k]);
            mem_free(m->weights[k]);
        }
    }
    for (int k = 0; k < COMPARED; k++)
        relume_coder_destroy(&j->coder[k]);
    relume_shadows_destroy(&j->shadows);
    relume_capture_destroy(&j->rest);
    mem_free(j->kept);
}

static float shown(const struct judging *j, float linear)
{
    return relume_transfer_encode(j->display, fminf(fmaxf(linear, 0.0f), 1.0f));
}

static double mean_square(const struct judging *j, const struct relume_image *a,
                          const struct relume_image *b)
{
    const size_t n = 3 * (size_t)a->width * (size_t)a->height;
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        const double d = (double)(shown(j, a->data[i]) - shown(j, b->data[i]));
        sum += d * d;
    }
    return sum / (double)n;
}

// Shadows by the mean square over all lights. Of highlights the lowest lights would decide alone:
// by the mean of decibels.
static void take_error(struct judging *j, int k, const struct relume_image *guess,
                       const struct relume_image *truth)
{
    const double error = mean_square(j, guess, truth);
    j->error[k] += (j->gloss ? log10(fmax(error, LEAST_SQUARE)) : error) / j->met_count;
}

static const char *doing(const struct judging *j)
{
    return j->gloss ? "judging highlights" : "judging shadows";
}

static double decibels(const struct judging *j, double error)
{
    return -10.0 * (j->gloss ? error : log10(error));
}

// ---------------------------------------------------------------- what is read

static bool is_display(const struct judging *j)
{
    return j->codes.domain == RELUME_DOMAIN_DISPLAY;
}

// How the photographs around a light that is left out are summed up.
static relume_status expect(struct judging *j, int light)
{
    struct met *m = &j->met[j->met_count++];
    const int width = relume_capture_width(j->capture), height = relume_capture_height(j->capture);
    relume_status status = RELUME_OK;
    m->lamp =
        (struct relume_light){.kind = RELUME_LIGHT_DIRECTIONAL,
                              .direction = relume_capture_manifest(j->capture)->directions[light],
                              .rgb = {1.0f, 1.0f, 1.0f}};
    for (int k = 0; !status && k < COMPARED; k++) {
        struct relume_vec3 from;
        float constant[3];
        m->share[k] = (float)relume_coder_clamp(&from, j->coder[k], m->lamp.direction);
        m->weights[k] =
            mem_array(3 * (size_t)relume_coder_info(j->coder[k])->lights, sizeof(float));
        status =
            m->weights[k] ? relume_image_create(&m->guess[k], width, height, 3) : RELUME_ENOMEM;
        if (!status)
            relume_coder_weights(j->coder[k], from, m->weights[k], constant);
    }
    return status;
}

static void add_weighted(struct relume_image *sum, const struct relume_image *image, float weight)
{
    const size_t n = 3 * (size_t)sum->width * (size_t)sum->height;
    for (size_t i = 0; weight != 0.0f && i < n; i++)
        sum->data[i] += weight * image->data[i];
}

// A photograph that is kept, to all that is expected.
static void take_kept(struct judging *j, struct relume_image *image, int rank)
{
    const size_t n = 3 * (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; is_display(j) && i < n; i++)
        image->data[i] = relume_transfer_encode(j->display, image->data[i]);
    for (int i = 0; i < j->met_count; i++)
        for (int k = 0; k < COMPARED; k++)
            add_weighted(&j->met[i].guess[k], image, j->met[i].weights[k][rank]);
}

// Every photograph of the view, once.
static relume_status read_all(struct judging *j, const bool *skip)
{
    const int lights = relume_capture_manifest(j->capture)->lights;
    relume_status status = RELUME_OK;
    for (int i = 0, rank = 0, left = 0; !status && i < lights; i++) {
        struct relume_image image = {0};
        if (!log_progress(j->p->log, doing(j), 0.5 * i / lights))
            return RELUME_ECANCEL;
        status = relume_capture_masked(&image, j->capture, j->view, i, j->p->log);
        if (!status && skip[i]) {
            j->met[left++].truth = image;
            continue;
        }
        if (!status)
            take_kept(j, &image, rank++);
        relume_image_destroy(&image);
    }
    return status;
}

// ---------------------------------------------------------------- the comparison

// Sums of codes become linear light.
static void show(const struct judging *j, struct relume_image *guess, float share)
{
    const size_t n = 3 * (size_t)guess->width * (size_t)guess->height;
    for (size_t i = 0; i < n; i++)
        guess->data[i] = share * (is_display(j) ? relume_transfer_decode(j->display, guess->data[i])
                                                : guess->data[i]);
}

static relume_status compare(struct judging *j, struct met *m)
{
    for (int k = 0; k < COMPARED; k++) {
        show(j, &m->guess[k], m->share[k]);
        take_error(j, k, &m->guess[k], &m->truth);
    }
    struct relume_image *guess = &m->guess[j->gloss ? CHORD : DELAUNAY];
    const relume_status status =
        relume_shadows_add(guess, 0, 0, j->shadows, &j->codes, &m->lamp, j->p->threads);
    if (!status)
        take_error(j, COMPARED, guess, &m->truth);
    return status;
}

// ---------------------------------------------------------------- what is learnt

static relume_status select_rest(struct judging *j, const bool *skip)
{
    const int lights = relume_capture_manifest(j->capture)->lights;
    int n = 0;
    for (int i = 0; i < lights; i++)
        if (!skip[i])
            j->kept[n++] = i;
    return relume_capture_select(&j->rest, j->capture, j->kept, n);
}

// How the lights that are kept are interpolated, both ways.
static relume_status open_rest(struct judging *j)
{
    const struct relume_basis *table = relume_basis_find("table");
    const struct relume_project_params encode = {
        .log = j->p->log, .domain = j->codes.domain, .threads = j->p->threads};
    relume_status status = relume_coder_learn(&j->coder[CHORD], table, j->rest,
                                              relume_coder_params(.choose = true), &encode);
    if (!status)
        status = relume_coder_learn(&j->coder[DELAUNAY], table, j->rest, NULL, &encode);
    j->codes.coder = j->coder[j->gloss ? CHORD : DELAUNAY];
    return status;
}

static relume_status learn_gloss(struct judging *j)
{
    struct relume_image model;
    relume_status status = relume_gloss_learn(&model, j->rest, is_display(j), j->p);
    if (!status)
        status = relume_gloss_create(&j->shadows, &model);
    relume_image_destroy(&model);
    return status;
}

static relume_status learn_rest(struct judging *j, const bool *skip)
{
    const struct relume_manifest *m = relume_capture_manifest(j->capture);
    const struct relume_manifest_view *v = &m->view[j->view];
    struct relume_shadows_params p = *j->p;
    struct relume_image depth = {0}, model = {0};
    p.skip = skip;
    relume_status status = relume_shadows_learn(&model, j->capture, j->view, &p);
    if (!status)
        status = relume_capture_depth(&depth, j->capture, j->view, p.log);
    if (!status)
        status = relume_shadows_create(&j->shadows, m->slabs ? &m->slab[v->slab] : &m->geometry,
                                       v->uv, &depth, &model);
    relume_image_destroy(&depth);
    relume_image_destroy(&model);
    return status;
}

static relume_status judge(struct judging *j, const bool *skip)
{
    const int lights = relume_capture_manifest(j->capture)->lights;
    const uint64_t pixels =
        (uint64_t)relume_capture_width(j->capture) * (uint64_t)relume_capture_height(j->capture);
    relume_status status = limits_memory(
        NULL, pixels * LEFT_OUT * (1 + COMPARED) * 3 * sizeof(float),
        j->gloss ? "comparing the highlights of a view" : "comparing the shadows of a view",
        j->p->log);
    if (!status)
        status = select_rest(j, skip);
    if (!status)
        status = j->gloss ? learn_gloss(j) : learn_rest(j, skip);
    if (!status)
        status = open_rest(j);
    for (int i = 0; !status && i < lights; i++)
        if (skip[i])
            status = expect(j, i);
    if (!status)
        status = read_all(j, skip);
    for (int i = 0; !status && i < j->met_count; i++)
        status = log_progress(j->p->log, doing(j), 0.5 + 0.5 * i / j->met_count)
                     ? compare(j, &j->met[i])
                     : RELUME_ECANCEL;
    return status;
}

static relume_status judge_lights(struct relume_shadows_gain *out, struct judging *j)
{
    const int lights = relume_capture_manifest(j->capture)->lights;
    const int out_of = lights / 4 < LEFT_OUT ? lights / 4 : LEFT_OUT;
    *out = (struct relume_shadows_gain){.lights = out_of};
    if (lights < LEAST_LIGHTS)
        return RELUME_EINVAL;
    bool *skip = mem_zeroed((size_t)lights, sizeof *skip);
    j->kept = mem_array((size_t)lights, sizeof *j->kept);
    j->codes.display = j->display = relume_encode_display(j->capture);
    for (int i = 0; skip && i < out_of; i++)
        skip[(2 * i + 1) * lights / (2 * out_of)] = true;
    const relume_status status = skip && j->kept ? judge(j, skip) : RELUME_ENOMEM;
    out->faded_db = decibels(j, fmin(j->error[CHORD], j->error[DELAUNAY]));
    out->traced_db = decibels(j, j->error[COMPARED]);
    judging_destroy(j);
    mem_free(skip);
    return status;
}

relume_status relume_shadows_judge(struct relume_shadows_gain *out, const relume_capture *capture,
                                   int view, bool display,
                                   const struct relume_shadows_params *params)
{
    const struct relume_shadows_params p = PARAMS_WORK(relume_shadows_params, params);
    struct judging j = {.capture = capture,
                        .view = view,
                        .codes.domain = display ? RELUME_DOMAIN_DISPLAY : RELUME_DOMAIN_LINEAR,
                        .p = &p};
    return judge_lights(out, &j);
}

relume_status relume_gloss_judge(struct relume_shadows_gain *out, const relume_capture *capture,
                                 bool display, const struct relume_shadows_params *params)
{
    const struct relume_shadows_params p = PARAMS_WORK(relume_shadows_params, params);
    const struct relume_manifest *m = relume_capture_manifest(capture);
    struct mosaic mosaic = {0};
    struct judging j = {.gloss = true,
                        .codes.domain = display ? RELUME_DOMAIN_DISPLAY : RELUME_DOMAIN_LINEAR,
                        .p = &p};
    *out = (struct relume_shadows_gain){0};
    if (m->views != 1 || m->geometry.projection != RELUME_PLANAR || m->positions)
        return RELUME_EINVAL;
    relume_status status = mosaic_open(&mosaic, capture, p.log);
    j.capture = mosaic.capture;
    if (!status)
        status = judge_lights(out, &j);
    mosaic_close(&mosaic);
    return status;
}
