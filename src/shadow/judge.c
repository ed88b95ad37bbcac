// judge.c - whether traced shadows are better than faded ones, by lights left out
#include "base/log.h"
#include "base/memory.h"
#include "base/params.h"

#include <relume/shadow.h>

#include <math.h>
#include <string.h>

enum { LEFT_OUT = 6, LEAST_LIGHTS = 8 };
enum { COMPARED = 2 };  // ways to interpolate: `chord`, `delaunay`; the second is also traced

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
    struct relume_codes codes;  // of no pixels: how lights are interpolated
    relume_shadows *shadows;
    struct relume_transfer display;
    const struct relume_shadows_params *p;
    int *kept;                      // [lights of the coders]: their numbers in the capture
    relume_coder *coder[COMPARED];  // of the same lights
    struct met met[LEFT_OUT];
    int met_count;
    double faded[COMPARED], traced;  // squared errors of display values
    size_t values;
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
    mem_free(j->kept);
}

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
        if (!log_progress(j->p->log, "judging shadows", 0.5 * i / lights))
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
        j->faded[k] += squared_error(j, &m->guess[k], &m->truth);
    }
    struct relume_image *guess = &m->guess[1];
    const relume_status status =
        relume_shadows_add(guess, 0, 0, j->shadows, &j->codes, &m->lamp, 1, j->p->threads);
    if (!status) {
        j->traced += squared_error(j, guess, &m->truth);
        j->values += 3 * (size_t)guess->width * (size_t)guess->height;
    }
    return status;
}

// ---------------------------------------------------------------- what is learnt

// How the lights that are kept are interpolated, both ways.
static relume_status open_rest(struct judging *j, const bool *skip)
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
        status = relume_coder_learn(&j->coder[0], table, rest, relume_coder_params(.choose = true),
                                    &encode);
    if (!status)
        status = relume_coder_learn(&j->coder[1], table, rest, NULL, &encode);
    j->codes.coder = j->coder[1];
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

static relume_status judge(struct judging *j, const bool *skip)
{
    const int lights = relume_capture_manifest(j->capture)->lights;
    const uint64_t pixels =
        (uint64_t)relume_capture_width(j->capture) * (uint64_t)relume_capture_height(j->capture);
    relume_status status = limits_memory(pixels * LEFT_OUT * (1 + COMPARED) * 3 * sizeof(float),
                                         "comparing the shadows of a view", j->p->log);
    if (!status)
        status = learn_rest(j, skip);
    if (!status)
        status = open_rest(j, skip);
    for (int i = 0; !status && i < lights; i++)
        if (skip[i])
            status = expect(j, i);
    if (!status)
        status = read_all(j, skip);
    for (int i = 0; !status && i < j->met_count; i++)
        status = log_progress(j->p->log, "judging shadows", 0.5 + 0.5 * i / j->met_count)
                     ? compare(j, &j->met[i])
                     : RELUME_ECANCEL;
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
    bool *skip = mem_zeroed((size_t)lights, sizeof *skip);
    j.kept = mem_array((size_t)lights, sizeof *j.kept);
    j.codes.display = j.display;
    for (int i = 0; skip && i < out_of; i++)
        skip[(2 * i + 1) * lights / (2 * out_of)] = true;
    const relume_status status = skip && j.kept ? judge(&j, skip) : RELUME_ENOMEM;
    out->faded_db = -10.0 * log10(fmin(j.faded[0], j.faded[1]) / (double)j.values);
    out->traced_db = -10.0 * log10(j.traced / (double)j.values);
    judging_destroy(&j);
    mem_free(skip);
    return status;
}
