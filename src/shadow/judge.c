// judge.c - whether traced shadows are better than faded ones, by lights left out
#include "base/log.h"
#include "base/memory.h"
#include "base/params.h"

#include <relume/shadow.h>

#include <math.h>
#include <string.h>

enum { LEFT_OUT = 6, LEAST_LIGHTS = 8 };

// What is compared.
struct judging {
    const relume_capture *capture;
    int view;
    struct relume_codes codes;  // of no pixels: how lights are interpolated
    relume_shadows *shadows;
    struct relume_transfer display;
    const struct relume_shadows_params *p;
    int *kept;                  // [lights of the coder]: their numbers in the capture
    const relume_coder *chord;  // of the same lights
    double faded[2], traced;    // squared errors of display values: by both coders, and traced
    size_t values;
};

static float shown(const struct judging *j, float linear)
{
    return relume_transfer_encode(j->display, fminf(fmaxf(linear, 0.0f), 1.0f));
}

static double squared_error(const struct judging *j, const struct relume_image *a,
                            const struct relume_image *b)
{
    const size_t n = 3 * (size_t)a->width * (size_t)a->height;
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        const double d = (double)(shown(j, a->data[i]) - shown(j, b->data[i]));
        sum += d * d;
    }
    return sum;
}

static void add_weighted(struct relume_image *sum, const struct relume_image *image, float weight,
                         const struct judging *j)
{
    const size_t n = 3 * (size_t)sum->width * (size_t)sum->height;
    const bool display = j->codes.domain == RELUME_DOMAIN_DISPLAY;
    for (size_t i = 0; i < n; i++)
        sum->data[i] += weight * (display ? relume_transfer_encode(j->display, image->data[i])
                                          : image->data[i]);
}

// What the photographs around a direction say of it.
static relume_status interpolate(struct relume_image *out, const struct judging *j,
                                 const relume_coder *coder, struct relume_vec3 direction)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    struct relume_vec3 from;
    const float share = (float)relume_coder_clamp(&from, coder, direction);
    float *weights = mem_array(3 * (size_t)info->lights, sizeof *weights), constant[3];
    const int width = relume_capture_width(j->capture), height = relume_capture_height(j->capture);
    relume_status status = weights ? relume_image_create(out, width, height, 3) : RELUME_ENOMEM;
    if (!status)
        relume_coder_weights(coder, from, weights, constant);
    for (int i = 0; !status && i < info->lights; i++) {
        struct relume_image image = {0};
        if (weights[i] == 0.0f)
            continue;
        status = relume_capture_masked(&image, j->capture, j->view, j->kept[i], j->p->log);
        if (!status)
            add_weighted(out, &image, weights[i], j);
        relume_image_destroy(&image);
    }
    const size_t n = 3 * (size_t)width * (size_t)height;
    for (size_t i = 0; !status && i < n; i++)
        out->data[i] = share * (j->codes.domain == RELUME_DOMAIN_DISPLAY
                                    ? relume_transfer_decode(j->display, out->data[i])
                                    : out->data[i]);
    mem_free(weights);
    return status;
}

static relume_status meet(struct judging *j, int light)
{
    const struct relume_light lamp = {.kind = RELUME_LIGHT_DIRECTIONAL,
                                      .direction =
                                          relume_capture_manifest(j->capture)->directions[light],
                                      .rgb = {1.0f, 1.0f, 1.0f}};
    struct relume_image truth = {0}, smooth = {0}, guess = {0};
    relume_status status = relume_capture_masked(&truth, j->capture, j->view, light, j->p->log);
    if (!status)
        status = interpolate(&smooth, j, j->chord, lamp.direction);
    if (!status)
        status = interpolate(&guess, j, j->codes.coder, lamp.direction);
    if (!status) {
        j->faded[0] += squared_error(j, &smooth, &truth);
        j->faded[1] += squared_error(j, &guess, &truth);
        status = relume_shadows_add(&guess, 0, 0, j->shadows, &j->codes, &lamp, 1, j->p->threads);
    }
    if (!status) {
        j->traced += squared_error(j, &guess, &truth);
        j->values += 3 * (size_t)truth.width * (size_t)truth.height;
    }
    relume_image_destroy(&truth);
    relume_image_destroy(&smooth);
    relume_image_destroy(&guess);
    return status;
}

// How the lights that are kept are interpolated, both ways.
static relume_status open_rest(struct judging *j, relume_coder *coder[2], const bool *skip)
{
    const struct relume_manifest *m = relume_capture_manifest(j->capture);
    const struct relume_basis *table = relume_basis_find("table");
    const struct relume_encode_params encode = {
        .log = j->p->log, .domain = j->codes.domain, .threads = j->p->threads};
    relume_capture *rest = NULL;
    int n = 0;
    for (int i = 0; i < m->lights; i++)
        if (!skip[i])
            j->kept[n++] = i;
    relume_status status = relume_capture_select(&rest, j->capture, j->kept, n);
    if (!status)
        status = relume_coder_learn(&coder[0], table, rest, relume_coder_params(.choose = true),
                                    &encode);
    if (!status)
        status = relume_coder_learn(&coder[1], table, rest, NULL, &encode);
    j->chord = coder[0];
    j->codes.coder = coder[1];
    relume_capture_destroy(&rest);
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

relume_status relume_shadows_judge(struct relume_shadows_gain *out, const relume_capture *capture,
                                   int view, bool display,
                                   const struct relume_shadows_params *params)
{
    const struct relume_shadows_params p = PARAMS_WORK(relume_shadows_params, params);
    const int lights = relume_capture_manifest(capture)->lights;
    const int out_of = lights / 4 < LEFT_OUT ? lights / 4 : LEFT_OUT;
    struct judging j = {.capture = capture,
                        .view = view,
                        .codes.domain = display ? RELUME_DOMAIN_DISPLAY : RELUME_DOMAIN_LINEAR,
                        .display = relume_encode_display(capture),
                        .p = &p};
    *out = (struct relume_shadows_gain){.lights = out_of};
    if (lights < LEAST_LIGHTS)
        return RELUME_EINVAL;
    relume_coder *coder[2] = {NULL, NULL};
    bool *skip = mem_zeroed((size_t)lights, sizeof *skip);
    j.kept = mem_array((size_t)lights, sizeof *j.kept);
    j.codes.display = j.display;
    for (int i = 0; skip && i < out_of; i++)
        skip[(2 * i + 1) * lights / (2 * out_of)] = true;
    relume_status status = skip && j.kept ? learn_rest(&j, skip) : RELUME_ENOMEM;
    if (!status)
        status = open_rest(&j, coder, skip);
    for (int i = 0; !status && i < lights; i++)
        if (skip[i])
            status = log_progress(p.log, "judging shadows", (double)i / lights) ? meet(&j, i)
                                                                                : RELUME_ECANCEL;
    out->faded_db = -10.0 * log10(fmin(j.faded[0], j.faded[1]) / (double)j.values);
    out->traced_db = -10.0 * log10(j.traced / (double)j.values);
    relume_shadows_destroy(&j.shadows);
    relume_coder_destroy(&coder[0]);
    relume_coder_destroy(&coder[1]);
    mem_free(j.kept);
    mem_free(skip);
    return status;
}
