// shadows.c - a view whose shadows are traced, and what that adds to a relit picture
#include "relight/shadow/gloss.h"
#include "relight/shadow/shadows.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/luminance.h"
#include "format/coder/coding.h"
#include "format/pack/views.h"
#include "relight/light/environment.h"
#include "relight/shadow/moving.h"

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
    relume_coder_destroy(&s->summed);
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

enum { AROUND = SHADOWS_AROUND };
static const float SHARE = 1.0f / RELUME_SHADOW_REACHED;

struct adding {
    const relume_shadows *s;
    const struct relume_image *relit;  // what the codes show of the rectangle
    struct relume_image *more;         // what is added there
    struct relume_rect rect;
    vec3 light;
    uint8_t *arrives;  // of the light, in the rectangle
    float rgb[3];
    int around;
    vec3 captured[AROUND];
    float weight[AROUND];
    const uint8_t *reached[AROUND];
    const struct relume_transfer *display;  // NULL: linear codes
    bool summed;                            // the light is one of an environment's
};

// What the captured lights around show of the matte surface, between them: `known` of each.
static float between_of(const struct adding *a, float colour, const float known[AROUND])
{
    float between = 0.0f;
    for (int i = 0; i < a->around; i++)
        between +=
            a->weight[i] * (a->display ? relume_transfer_encode(*a->display, colour * known[i])
                                       : colour * known[i]);
    return a->display ? relume_transfer_decode(*a->display, between) : between;
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
    float *more = a->more->data + 3 * row * (size_t)a->more->width, known[AROUND];
    for (int i = 0; i < a->rect.width; i++, more += 3) {
        const size_t pixel = pixel_at(a, row, i);
        const float *matte = a->s->matte + MATTE * pixel;
        if (!is_seen(a->s, pixel))
            continue;
        for (int k = 0; k < a->around; k++)
            known[k] = SHARE * (float)a->reached[k][pixel] * shadows_matte(matte, a->captured[k]);
        const float lit = SHARE * (float)a->arrives[row * (size_t)a->rect.width + (size_t)i] *
                          shadows_matte(matte, a->light);
        for (int c = 0; c < 3; c++)
            more[c] = a->rgb[c] * (matte[c] * lit - between_of(a, matte[c], known));
    }
}

static relume_status need_reached(struct adding *a, relume_shadows *s, int light, float weight,
                                  vec3 direction, int threads)
{
    if (!s->reached)
        s->reached = mem_zeroed((size_t)s->lights, sizeof *s->reached);
    if (!s->reached)
        return RELUME_ENOMEM;
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
static relume_status look_around(struct adding *a, relume_shadows *s, const relume_coder *coder,
                                 int threads)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    int light[AROUND], n;
    float weight[AROUND];
    relume_status status = relume_shadows_around(light, weight, &n, s, coder, a->light, false);
    for (int i = 0; !status && i < n; i++)
        status = need_reached(a, s, light[i], weight[i], info->directions[light[i]], threads);
    return status;
}

static relume_status add_distant(struct adding *a, relume_shadows *s, const relume_coder *coder,
                                 int threads)
{
    relume_status status = look_around(a, s, coder, threads);
    if (status || !a->around)
        return status;
    a->arrives = mem_array((size_t)a->rect.width, (size_t)a->rect.height);
    status = a->arrives ? trace(a->arrives, &s->stage, a->light, &a->rect, threads) : RELUME_ENOMEM;
    if (!status)
        thread_for(threads, (size_t)a->rect.height, add_row, a);
    mem_free(a->arrives);
    return status;
}

// ---------------------------------------------------------------- near lights

enum { MOST_SIDE = 4 };  // of an area light's patches

// Every pixel has a direction of its own, and captured lights of its own around it.
struct nearing {
    struct adding all;
    const struct relume_light *light;
    struct relume_light_patch patch[MOST_SIDE * MOST_SIDE];
    int patches;                // 0: the light shines from its position
    const relume_coder *coder;  // of the codes
    int lights;                 // that were captured
    float *scratch;             // [workers][4][lights]: weights of three colours, what is known
    bool surround;              // surfaces are all around a lamp
};

// One pixel, and one direction that light comes from.
struct near_pixel {
    int x, y;
    size_t pixel;
    vec3 point, towards;  // world
    double distance;
};

static float quarter_share(const struct stage *s, int x, int y, vec3 direction, double distance)
{
    return 0.25f * (float)quarters_reached(s, x, y, stage_turn(s, direction), distance);
}

// What captured lights show of a pixel, each of which is asked once: NAN, not yet.
static float know(const struct adding *a, const struct near_pixel *p, int light, float *known)
{
    const vec3 from = relume_coder_info(a->s->between)->directions[light];
    if (isnan(known[light]))
        known[light] = quarter_share(&a->s->stage, p->x, p->y, from, INFINITY) *
                       shadows_matte(a->s->matte + MATTE * p->pixel, from);
    return known[light];
}

// What the captured lights around a->light show; into `a` and around[AROUND].
static void know_around(struct adding *a, float around[AROUND], const struct nearing *n,
                        const struct near_pixel *p, float *scratch)
{
    float constant[3], *known = scratch + 3 * (size_t)n->lights;
    relume_coder_weights(a->s->between, a->light, scratch, constant);
    a->around = 0;
    for (int i = 0; i < n->lights && a->around < AROUND; i++)
        if (scratch[i] != 0.0f) {
            around[a->around] = know(a, p, i, known);
            a->weight[a->around++] = scratch[i];
        }
}

// Patches are many: a ray each, from another quarter of the pixel than those beside it.
static float near_share(const struct nearing *n, const struct near_pixel *p, int patch)
{
    const struct stage *s = &n->all.s->stage;
    vec3 from;
    if (!n->patches)
        return quarter_share(s, p->x, p->y, p->towards, p->distance);
    const int quarter = (patch + patch / MOST_SIDE) & 3;
    return !stage_point(&from, s, p->x + (quarter & 1 ? 0.75 : 0.25),
                        p->y + (quarter & 2 ? 0.75 : 0.25)) ||
                   stage_reaches(s, from, stage_turn(s, p->towards), p->distance)
               ? 1.0f
               : 0.0f;
}

// `relit` is what the codes show. Where less is between the captured lights than the surface would
// show there, something out of sight darkened these; of a panorama, whose surfaces are all around a
// lamp, it stands behind them, and not in the way of the lamp.
static void add_near_pixel(float *more, const float *relit, struct adding *a,
                           const struct nearing *n, struct near_pixel *p, float *scratch)
{
    const float *matte = a->s->matte + MATTE * p->pixel;
    float around[AROUND], between[3] = {0.0f};
    for (int i = 0; i < n->lights; i++)
        scratch[3 * n->lights + i] = NAN;
    for (int k = 0; k < (n->patches ? n->patches : 1); k++) {
        if (!(n->patches ? relume_light_patch_at(&p->towards, a->rgb, &n->patch[k], p->point)
                         : relume_light_at(&p->towards, a->rgb, n->light, p->point)))
            continue;
        const float share = (float)relume_coder_clamp(&a->light, n->coder, p->towards);
        for (int c = 0; c < 3; c++)
            a->rgb[c] *= share;
        know_around(a, around, n, p, scratch);
        p->distance =
            vec3_length(vec3_sub(n->patches ? n->patch[k].position : n->light->position, p->point));
        const float lit = near_share(n, p, k) * shadows_matte(matte, a->light);
        for (int c = 0; c < 3; c++) {
            more[c] += a->rgb[c] * matte[c] * lit;
            between[c] += a->rgb[c] * between_of(a, matte[c], around);
        }
    }
    for (int c = 0; c < 3; c++) {
        const float rest = relit[c] - between[c];
        more[c] += (n->surround ? fmaxf(rest, 0.0f) : rest) - relit[c];
    }
}

static void add_near_row(void *context, size_t row, int worker)
{
    const struct nearing *n = context;
    struct adding a = n->all;
    float *scratch = n->scratch + 4 * (size_t)worker * (size_t)n->lights;
    float *more = a.more->data + 3 * row * (size_t)a.more->width;
    const float *relit = a.relit->data + 3 * row * (size_t)a.more->width;
    for (int i = 0; i < a.rect.width; i++, more += 3, relit += 3) {
        struct near_pixel p = {
            .x = a.rect.left + i, .y = a.rect.top + (int)row, .pixel = pixel_at(&a, row, i)};
        vec3 point;
        if (!is_seen(a.s, p.pixel) || !stage_point(&point, &a.s->stage, p.x + 0.5, p.y + 0.5))
            continue;
        p.point = stage_world(&a.s->stage, point);
        add_near_pixel(more, relit, &a, n, &p, scratch);
    }
}

static relume_status add_near(const struct adding *a, const struct relume_light *light,
                              const relume_coder *coder, int threads)
{
    struct nearing n = {.all = *a,
                        .light = light,
                        .coder = coder,
                        .lights = relume_coder_info(a->s->between)->lights,
                        .surround =
                            a->s->stage.kind == STAGE_CYLINDER || a->s->stage.kind == STAGE_SPHERE};
    if (light->kind == RELUME_LIGHT_AREA) {
        relume_light_patches(n.patch, light, MOST_SIDE);
        n.patches = MOST_SIDE * MOST_SIDE;
    }
    n.scratch = mem_array((size_t)thread_count(threads) * 4, (size_t)n.lights * sizeof *n.scratch);
    if (!n.scratch)
        return RELUME_ENOMEM;
    thread_for(threads, (size_t)a->rect.height, add_near_row, &n);
    mem_free(n.scratch);
    return RELUME_OK;
}

// ---------------------------------------------------------------- a light

static const float MORE = 1.01f;  // than an even share, rounding aside

static float luminance_of(const struct relume_light *light)
{
    return luminance_709f(light->rgb);
}

// Those beyond the captured lights fade: a sum has other shares of them than a light alone
// (relume_environment_weights).
relume_status relume_shadows_bright_sources(struct relume_light *lamp, int *count,
                                            const struct relume_light *environment,
                                            const relume_coder *coder)
{
    vec3 from;
    const struct relume_coder_info *info = relume_coder_info(coder);
    const relume_status status =
        relume_environment_sample(lamp, RELUME_SHADOW_LAMPS, environment, 0);
    float total = 0.0f;
    *count = 0;
    for (int i = 0; !status && i < RELUME_SHADOW_LAMPS; i++)
        total += luminance_of(&lamp[i]);
    for (int i = 0; !status && i < RELUME_SHADOW_LAMPS; i++)
        if (luminance_of(&lamp[i]) > MORE * total / RELUME_SHADOW_LAMPS &&
            !(info->hemispherical && pole_from_world(lamp[i].direction, info->pole_y).z < 0.0) &&
            relume_coder_clamp(&from, coder, vec3_unit(lamp[i].direction)) == 1.0)
            lamp[(*count)++] = lamp[i];
    return status;
}

static relume_status add_highlights(struct adding *a, relume_shadows *s, const relume_coder *coder,
                                    int threads)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    const size_t most = (size_t)info->lights;
    int *which = mem_array(most, sizeof *which);
    float *weight = mem_array(most, sizeof *weight);
    vec3 *from = mem_array(most, sizeof *from);
    struct gloss_light light = {
        .light = a->light, .from = from, .weight = weight, .display = a->display};
    relume_status status = which && weight && from ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status =
            relume_shadows_around(which, weight, &light.captured, s, coder, a->light, a->summed);
    for (int i = 0; !status && i < light.captured; i++)
        from[i] = info->directions[which[i]];
    if (!status)
        gloss_add(a->more, a->rect.left, a->rect.top, &s->gloss, &light, a->rgb, threads);
    mem_free(which);
    mem_free(weight);
    mem_free(from);
    return status;
}

static relume_status add_lamp(struct adding *a, relume_shadows *s, const relume_coder *coder,
                              const struct relume_light *lamp, int threads)
{
    const float share = (float)relume_coder_clamp(&a->light, coder, vec3_unit(lamp->direction));
    for (int c = 0; c < 3; c++)
        a->rgb[c] = share * lamp->rgb[c];
    return (s->gloss.data ? add_highlights : add_distant)(a, s, coder, threads);
}

static relume_status add_light(struct adding *a, relume_shadows *s, const relume_coder *coder,
                               const struct relume_light *light, int threads)
{
    if (light->kind == RELUME_LIGHT_DIRECTIONAL)
        return add_lamp(a, s, coder, light, threads);
    return s->gloss.data ? RELUME_OK : add_near(a, light, coder, threads);
}

// `display`: the curve of the codes that the picture was relit from, NULL where these are linear.
static relume_status add(struct relume_image *picture, int left, int top, relume_shadows *shadows,
                         const relume_coder *coder, const struct relume_transfer *display,
                         bool summed, const struct relume_light *light, int threads)
{
    const size_t n = 3 * (size_t)picture->width * (size_t)picture->height;
    struct relume_image more;
    relume_status status = relume_image_create(&more, picture->width, picture->height, 3);
    struct adding a = {.s = shadows,
                       .relit = picture,
                       .more = &more,
                       .rect = {left, top, picture->width, picture->height},
                       .display = display,
                       .summed = summed};
    if (!status && !shadows->gloss.data)
        status = shadows_need_between(shadows, relume_coder_info(coder), false);
    if (!status)
        status = add_light(&a, shadows, coder, light, threads);
    for (size_t i = 0; !status && i < n; i++)
        picture->data[i] = fmaxf(picture->data[i] + more.data[i], fminf(picture->data[i], 0.0f));
    relume_image_destroy(&more);
    return status;
}

relume_status relume_shadows_add(struct relume_image *picture, int left, int top,
                                 relume_shadows *shadows, const struct relume_codes *codes,
                                 const struct relume_light *light, int threads)
{
    if (light->kind == RELUME_LIGHT_ENVIRONMENT)
        return RELUME_EINVAL;
    return add(picture, left, top, shadows, codes->coder,
               codes->domain == RELUME_DOMAIN_DISPLAY ? &codes->display : NULL, false, light,
               threads);
}

relume_status relume_shadows_add_bright_source(struct relume_image *picture, int left, int top,
                                               relume_shadows *shadows, const relume_coder *coder,
                                               const struct relume_light *source, int threads)
{
    return add(picture, left, top, shadows, coder, NULL, true, source, threads);
}
