// shadows.c - a view whose shadows are traced, and what that adds to a relit picture
#include "shadow/gloss.h"
#include "shadow/shadows.h"

#include "base/memory.h"
#include "base/thread.h"

#include <math.h>
#include <string.h>

enum { MATTE = RELUME_SHADOW_CHANNELS - RELUME_SHADOW_COLOUR };

bool relume_shadows_suit(const struct relume_geometry *geometry)
{
    return stage_suits(geometry);
}

// ---------------------------------------------------------------- life

static void take_model(relume_shadows *s, const struct relume_image *model)
{
    const size_t n = (size_t)model->width * (size_t)model->height;
    for (size_t i = 0; i < n; i++) {
        const float *from = model->data + RELUME_SHADOW_CHANNELS * i;
        s->stage.thick[i] = from[RELUME_SHADOW_THICK];
        memcpy(s->matte + MATTE * i, from + RELUME_SHADOW_COLOUR, MATTE * sizeof *from);
    }
}

relume_status relume_shadows_create(relume_shadows **out, const struct relume_geometry *geometry,
                                    const double uv[2], const struct relume_image *depth,
                                    const struct relume_image *model)
{
    *out = NULL;
    if (!stage_suits(geometry) || depth->channels != 1 ||
        model->channels != RELUME_SHADOW_CHANNELS || model->width != depth->width ||
        model->height != depth->height)
        return RELUME_EINVAL;
    relume_shadows *s = *out = mem_zeroed(1, sizeof *s);
    if (!s)
        return RELUME_ENOMEM;
    s->matte = mem_array((size_t)model->width * (size_t)model->height, MATTE * sizeof *s->matte);
    relume_status status = stage_create(&s->stage, geometry, uv, depth);
    if (!status && !s->matte)
        status = RELUME_ENOMEM;
    if (status)
        relume_shadows_destroy(out);
    else
        take_model(s, model);
    return status;
}

relume_status relume_gloss_create(relume_shadows **out, const struct relume_image *model)
{
    *out = NULL;
    if (model->channels != RELUME_GLOSS_CHANNELS)
        return RELUME_EINVAL;
    relume_shadows *s = *out = mem_zeroed(1, sizeof *s);
    if (!s)
        return RELUME_ENOMEM;
    const size_t n = (size_t)model->width * (size_t)model->height * RELUME_GLOSS_CHANNELS;
    const relume_status status =
        relume_image_create(&s->gloss, model->width, model->height, RELUME_GLOSS_CHANNELS);
    if (status)
        relume_shadows_destroy(out);
    else
        memcpy(s->gloss.data, model->data, n * sizeof *model->data);
    return status;
}

void relume_shadows_destroy(relume_shadows **shadows)
{
    relume_shadows *s = *shadows;
    *shadows = NULL;
    if (!s)
        return;
    for (int i = 0; s->reached && i < s->lights; i++)
        mem_free(s->reached[i]);
    mem_free(s->reached);
    relume_coder_destroy(&s->between);
    stage_destroy(&s->stage);
    relume_image_destroy(&s->gloss);
    mem_free(s->matte);
    mem_free(s);
}

static size_t pixels_of(const relume_shadows *s)
{
    return (size_t)s->stage.width * (size_t)s->stage.height;
}

uint64_t relume_shadows_bytes(const relume_shadows *s)
{
    if (s->gloss.data)
        return (uint64_t)s->gloss.width * (uint64_t)s->gloss.height * RELUME_GLOSS_CHANNELS *
               sizeof(float);
    uint64_t each = (4 + MATTE) * sizeof(float);
    for (int i = 0; s->reached && i < s->lights; i++)
        each += s->reached[i] != NULL;
    return each * pixels_of(s);
}

// ---------------------------------------------------------------- where light arrives

// A rectangle of the view, traced with a border of one pixel around it.
struct tracing {
    const struct stage *stage;
    vec3 direction;  // of the view
    struct relume_rect rect;
    uint8_t *quarters;  // [height + 2][width + 2]
    uint8_t *out;       // [height][width]
};

static int quarters_reached(const struct stage *s, int x, int y, vec3 direction, double distance)
{
    int arrives = 0;
    for (int i = 0; i < 4; i++) {
        vec3 p;
        arrives += !stage_point(&p, s, x + (i & 1 ? 0.75 : 0.25), y + (i & 2 ? 0.75 : 0.25)) ||
                   stage_reaches(s, p, direction, distance);
    }
    return arrives;
}

// Beyond the border of a picture that does not close is what lies on it.
static int inside(int i, int side, bool closes)
{
    return closes ? (i + side) % side : i < 0 ? 0 : i < side ? i : side - 1;
}

static void trace_row(void *context, size_t row, int worker)
{
    (void)worker;
    const struct tracing *t = context;
    const struct stage *s = t->stage;
    const int width = t->rect.width + 2, y = inside(t->rect.top + (int)row - 1, s->height, false);
    for (int i = 0; i < width; i++)
        t->quarters[row * (size_t)width + (size_t)i] = (uint8_t)quarters_reached(
            s, inside(t->rect.left + i - 1, s->width, s->kind >= STAGE_CYLINDER), y, t->direction,
            INFINITY);
}

// Edges are known to a pixel, and as soft as that: five parts of a pixel, one of each beside it.
static void soften(const struct tracing *t)
{
    const size_t width = (size_t)t->rect.width, step = width + 2;
    for (size_t y = 0; y < (size_t)t->rect.height; y++)
        for (size_t x = 0; x < width; x++) {
            const uint8_t *q = t->quarters + y * step + x;
            int sum = 0;
            for (size_t i = 0; i < 9; i++)
                sum += (i == 4 ? 5 : i % 2) * q[i / 3 * step + i % 3];
            t->out[y * width + x] = (uint8_t)sum;
        }
}

static relume_status trace(uint8_t *out, const struct stage *s, vec3 direction,
                           const struct relume_rect *rect, int threads)
{
    struct tracing t = {s, stage_turn(s, direction), *rect, NULL, out};
    t.quarters = mem_array((size_t)rect->width + 2, (size_t)rect->height + 2);
    if (!t.quarters)
        return RELUME_ENOMEM;
    thread_for(threads, (size_t)rect->height + 2, trace_row, &t);
    soften(&t);
    mem_free(t.quarters);
    return RELUME_OK;
}

static struct relume_rect whole(const relume_shadows *s)
{
    return (struct relume_rect){0, 0, s->stage.width, s->stage.height};
}

relume_status relume_shadows_trace(uint8_t *out, const relume_shadows *s, vec3 direction,
                                   int threads)
{
    const struct relume_rect rect = whole(s);
    return trace(out, &s->stage, direction, &rect, threads);
}

// ---------------------------------------------------------------- what it adds

enum { AROUND = 4 };  // captured lights around a direction, at most
static const float SHARE = 1.0f / RELUME_SHADOW_REACHED;

struct adding {
    const relume_shadows *s;
    struct relume_image *picture;
    struct relume_rect rect;
    vec3 light;
    uint8_t *arrives;  // of the light, in the rectangle
    float rgb[3];
    int around;
    vec3 captured[AROUND];
    float weight[AROUND];
    const uint8_t *reached[AROUND];
    const struct relume_transfer *display;  // NULL: linear codes
};

// `lit` and `known` are what the matte surface shows under the light and under those around it.
static void add_pixel(float *out, const struct adding *a, const float *colour, float lit,
                      const float known[AROUND])
{
    for (int c = 0; c < 3; c++) {
        float between = 0.0f;
        for (int i = 0; i < a->around; i++)
            between += a->weight[i] *
                       (a->display ? relume_transfer_encode(*a->display, colour[c] * known[i])
                                   : colour[c] * known[i]);
        if (a->display)
            between = relume_transfer_decode(*a->display, between);
        const float sum = out[c] + a->rgb[c] * (colour[c] * lit - between);
        out[c] = fmaxf(sum, fminf(out[c], 0.0f));
    }
}

static size_t pixel_at(const struct adding *a, size_t row, int column)
{
    return ((size_t)a->rect.top + row) * (size_t)a->s->stage.width +
           (size_t)(a->rect.left + column);
}

static bool is_seen(const relume_shadows *s, size_t pixel)
{
    const float *colour = s->matte + MATTE * pixel;
    return colour[0] + colour[1] + colour[2] > 0.0f && isfinite(s->stage.far[pixel]);
}

static void add_row(void *context, size_t row, int worker)
{
    (void)worker;
    const struct adding *a = context;
    float *out = a->picture->data + 3 * row * (size_t)a->picture->width, known[AROUND];
    for (int i = 0; i < a->rect.width; i++, out += 3) {
        const size_t pixel = pixel_at(a, row, i);
        const float *matte = a->s->matte + MATTE * pixel;
        if (!is_seen(a->s, pixel))
            continue;
        for (int k = 0; k < a->around; k++)
            known[k] = SHARE * (float)a->reached[k][pixel] * shadows_matte(matte, a->captured[k]);
        add_pixel(out, a, matte,
                  SHARE * (float)a->arrives[row * (size_t)a->rect.width + (size_t)i] *
                      shadows_matte(matte, a->light),
                  known);
    }
}

// A table of the same lights, asked for their weights.
static relume_status need_between(relume_shadows *s, const struct relume_coder_info *info)
{
    if (s->between)
        return RELUME_OK;
    s->lights = info->lights;
    if (!s->reached)
        s->reached = mem_zeroed((size_t)info->lights, sizeof *s->reached);
    return !s->reached
               ? RELUME_ENOMEM
               : relume_coder_create(&s->between, relume_basis_find("table"), info->directions,
                                     info->lights,
                                     relume_coder_params(.hemispherical = info->hemispherical,
                                                         .pole_y = info->pole_y, .decode = true));
}

static relume_status need_reached(struct adding *a, relume_shadows *s, int light, float weight,
                                  vec3 direction, int threads)
{
    if (!s->reached[light]) {
        if (!(s->reached[light] = mem_array(pixels_of(s), 1)))
            return RELUME_ENOMEM;
        const relume_status status = relume_shadows_trace(s->reached[light], s, direction, threads);
        if (status) {
            mem_free(s->reached[light]);
            s->reached[light] = NULL;
            return status;
        }
    }
    a->captured[a->around] = direction;
    a->weight[a->around] = weight;
    a->reached[a->around++] = s->reached[light];
    return RELUME_OK;
}

// The captured lights around a->light.
static relume_status look_around(struct adding *a, relume_shadows *s, int threads)
{
    const struct relume_coder_info *info = relume_coder_info(s->between);
    float *weights = mem_array(3 * (size_t)info->lights, sizeof *weights), constant[3];
    relume_status status = weights ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        relume_coder_weights(s->between, a->light, weights, constant);
    for (int i = 0; !status && i < info->lights && a->around < AROUND; i++)
        if (weights[i] != 0.0f)
            status = need_reached(a, s, i, weights[i], info->directions[i], threads);
    mem_free(weights);
    return status;
}

static relume_status add_distant(struct adding *a, relume_shadows *s, int threads)
{
    relume_status status = look_around(a, s, threads);
    if (status || a->weight[0] > 0.9999f)  // it is a photograph
        return status;
    a->arrives = mem_array((size_t)a->rect.width, (size_t)a->rect.height);
    status = a->arrives ? trace(a->arrives, &s->stage, a->light, &a->rect, threads) : RELUME_ENOMEM;
    if (!status)
        thread_for(threads, (size_t)a->rect.height, add_row, a);
    mem_free(a->arrives);
    return status;
}

// ---------------------------------------------------------------- near lights

// Every pixel has a direction of its own, and captured lights of its own around it.
struct nearing {
    struct adding all;
    const struct relume_light *light;
    const relume_coder *coder;  // of the codes
    float *weights;             // [workers][3][lights]
};

static float quarter_share(const struct stage *s, int x, int y, vec3 direction, double distance)
{
    return 0.25f * (float)quarters_reached(s, x, y, stage_turn(s, direction), distance);
}

// What the captured lights around a->light show; into `a` and known[AROUND].
static void know_around(struct adding *a, float known[AROUND], float *weights, size_t pixel)
{
    const struct stage *s = &a->s->stage;
    const struct relume_coder_info *info = relume_coder_info(a->s->between);
    const int x = (int)(pixel % (size_t)s->width), y = (int)(pixel / (size_t)s->width);
    float constant[3];
    relume_coder_weights(a->s->between, a->light, weights, constant);
    a->around = 0;
    for (int i = 0; i < info->lights && a->around < AROUND; i++)
        if (weights[i] != 0.0f) {
            known[a->around] = quarter_share(s, x, y, info->directions[i], INFINITY) *
                               shadows_matte(a->s->matte + MATTE * pixel, info->directions[i]);
            a->weight[a->around++] = weights[i];
        }
}

static void add_near_row(void *context, size_t row, int worker)
{
    const struct nearing *n = context;
    const struct stage *s = &n->all.s->stage;
    struct adding a = n->all;
    float *weights =
        n->weights + 3 * (size_t)worker * (size_t)relume_coder_info(a.s->between)->lights;
    float *out = a.picture->data + 3 * row * (size_t)a.picture->width, known[AROUND];
    for (int i = 0; i < a.rect.width; i++, out += 3) {
        const size_t pixel = pixel_at(&a, row, i);
        const float *matte = a.s->matte + MATTE * pixel;
        const int x = a.rect.left + i, y = a.rect.top + (int)row;
        vec3 point, towards;
        if (!is_seen(a.s, pixel) || !stage_point(&point, s, x + 0.5, y + 0.5))
            continue;
        point = stage_world(s, point);
        if (!relume_light_at(&towards, a.rgb, n->light, point))
            continue;
        const float share = (float)relume_coder_clamp(&a.light, n->coder, towards);
        for (int c = 0; c < 3; c++)
            a.rgb[c] *= share;
        know_around(&a, known, weights, pixel);
        const double distance = vec3_length(vec3_sub(n->light->position, point));
        add_pixel(out, &a, matte,
                  quarter_share(s, x, y, towards, distance) * shadows_matte(matte, a.light), known);
    }
}

static relume_status add_near(const struct adding *a, const struct relume_light *light,
                              const relume_coder *coder, int threads)
{
    struct nearing n = {.all = *a, .light = light, .coder = coder};
    const size_t lights = (size_t)relume_coder_info(a->s->between)->lights;
    n.weights = mem_array((size_t)thread_count(threads) * 3, lights * sizeof *n.weights);
    if (!n.weights)
        return RELUME_ENOMEM;
    thread_for(threads, (size_t)a->rect.height, add_near_row, &n);
    mem_free(n.weights);
    return RELUME_OK;
}

static relume_status add_gloss(struct relume_image *picture, int left, int top,
                               const relume_shadows *s, const struct relume_codes *codes,
                               const struct relume_light *lights, int n, int threads)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < n; i++)
        if (lights[i].kind == RELUME_LIGHT_DIRECTIONAL)
            status = gloss_add(picture, left, top, &s->gloss, codes, &lights[i], threads);
    return status;
}

bool relume_shadows_count(enum relume_light_kind kind)
{
    return kind == RELUME_LIGHT_DIRECTIONAL ||
           (relume_light_is_near(kind) && kind != RELUME_LIGHT_AREA);
}

relume_status relume_shadows_add(struct relume_image *picture, int left, int top,
                                 relume_shadows *shadows, const struct relume_codes *codes,
                                 const struct relume_light *lights, int n, int threads)
{
    if (shadows->gloss.data)
        return add_gloss(picture, left, top, shadows, codes, lights, n, threads);
    relume_status status = need_between(shadows, relume_coder_info(codes->coder));
    for (int i = 0; !status && i < n; i++) {
        struct adding a = {
            .s = shadows, .picture = picture, .rect = {left, top, picture->width, picture->height}};
        a.display = codes->domain == RELUME_DOMAIN_DISPLAY ? &codes->display : NULL;
        if (!relume_shadows_count(lights[i].kind))
            continue;
        if (lights[i].kind != RELUME_LIGHT_DIRECTIONAL) {
            status = add_near(&a, &lights[i], codes->coder, threads);
            continue;
        }
        const float share =
            (float)relume_coder_clamp(&a.light, codes->coder, vec3_unit(lights[i].direction));
        for (int c = 0; c < 3; c++)
            a.rgb[c] = share * lights[i].rgb[c];
        status = add_distant(&a, shadows, threads);
    }
    return status;
}
