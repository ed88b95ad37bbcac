// gl_relighter.c - views of a file on the GPU: codes are uploaded once, relit when the lights
// change
#include "relit/gl_relighter.h"

#include "cli/program/say.h"
#include "format/coder/coding.h"
#include "relight/frame/relighter.h"
#include "relight/shadow/moving.h"
#include "relit/books.h"
#include "relit/gl_relighter_parts.h"
#include "relit/moving.h"

#include <stdlib.h>
#include <string.h>

// ---------------------------------------------------------------- views

// The library looks at codes for as long as it relights the view.
static void stop_lending(struct gl_relighter *r, struct relit_view *v)
{
    const int view = (int)(v - r->view);
    if (v->lent && r->source.drop && !v->part.memory)
        r->source.drop(r->source.user, view);
    if (v->lent && r->library)
        relume_relighter_drop(r->library, view);
    relume_image_destroy(&v->surface);
    relume_shadows_destroy(&v->shadows);
    relume_codes_part_destroy(&v->part);
}

static int number_of(const struct gl_relighter *r, const struct relit_view *v)
{
    return (int)(v - r->view);
}

static void count_more(struct gl_relighter *r, const struct relit_view *v, size_t bytes)
{
    const int view = number_of(r, v);
    budget_set(&r->memory, view, r->memory.item[view].bytes + bytes);
}

static void release(struct gl_relighter *r, struct relit_view *v)
{
    if (v->array)
        r->gl->DeleteTextures(v->arrays, v->array);
    target_destroy(&v->relit, r->gl);
    budget_forget(&r->memory, number_of(r, v));
    free(v->array);
    free(v->scale);
    nearby_view_destroy(&v->near, r->gl);
    moving_view_destroy(&v->moving, r->gl);
    stop_lending(r, v);
    if (v->codes.books)
        books_forget(&v->codes);
    *v = (struct relit_view){0};
}

// Views that this frame does not use leave, the longest unused first, until `bytes` more fit.
static void free_bytes(struct gl_relighter *r, size_t bytes)
{
    int oldest;
    while ((oldest = budget_excess(&r->memory, bytes)) >= 0)
        release(r, &r->view[oldest]);
}

static relume_status keep(struct gl_relighter *r, int view, const struct relume_codes *codes)
{
    struct relit_view *v = &r->view[view];
    const size_t bytes = gl_relighter_view_bytes(codes);
    free_bytes(r, bytes);
    v->present = true;
    budget_set(&r->memory, view, bytes);
    relume_status status = target_create(&v->relit, r->gl, codes->width, codes->height, r->log);
    if (!status && r->by_library)
        v->lent = codes;
    else if (!status)
        status = codes_upload(r, v, codes);
    if (status)
        release(r, v);
    return status;
}

static void drop(struct gl_relighter *r, int view)
{
    if (r->source.drop && !r->view[view].lent)
        r->source.drop(r->source.user, view);
}

static relume_status load(struct gl_relighter *r, int view)
{
    const struct relume_codes *codes;
    relume_status status = r->source.codes(&codes, r->source.user, view);
    if (status)
        return status;
    status = keep(r, view, codes);
    drop(r, view);
    return status;
}

// What the loader has read, up to `view`; -1: as much as is there.
static relume_status take_loaded(struct gl_relighter *r, int view)
{
    struct loaded loaded;
    relume_status status = RELUME_OK;
    while (!status && (view < 0 || !r->view[view].present) &&
           loader_take(&loaded, r->loader, view >= 0)) {
        status = loaded.status;
        if (status)
            break;
        if (!r->view[loaded.view].present) {
            status = keep(r, loaded.view, loaded.codes);
            drop(r, loaded.view);
        } else if (r->source.drop) {
            r->source.drop(r->source.user, loaded.view);
        }
    }
    return status;
}

// ---------------------------------------------------------------- by the library

static bool has_near(const struct relume_light *lights, int n)
{
    for (int i = 0; i < n; i++)
        if (relume_light_is_near(lights[i].kind))
            return true;
    return false;
}

static relume_status find_surface(struct relume_image *surface, const struct gl_relighter *r,
                                  int view)
{
    const relume_status status =
        r->source.surface ? r->source.surface(surface, r->source.user, view) : RELUME_EINVAL;
    return status != RELUME_EINVAL
               ? status
               : say(r->log, RELUME_EUNFIT,
                     "a near light needs to know how far the surface is; use a file with depth");
}

static size_t bytes_of_library(const struct gl_relighter *r, const struct relit_view *v)
{
    const size_t pixels = (size_t)v->surface.width * (size_t)v->surface.height;
    return relume_relighter_bytes(r->library, (int)(v - r->view)) + 3 * pixels * sizeof(float) +
           (v->shadows ? relume_shadows_bytes(v->shadows) : 0);
}

static bool holds(struct relume_rect a, const struct relume_rect *b)
{
    return a.left <= b->left && a.top <= b->top && a.left + a.width >= b->left + b->width &&
           a.top + a.height >= b->top + b->height;
}

// A quarter more to each side: an eye that moves on finds what it needs for a while.
static struct relume_rect with_margin(const struct relume_rect *at, const int size[2])
{
    const int dx = at->width / 4, dy = at->height / 4;
    const int left = at->left > dx ? at->left - dx : 0, top = at->top > dy ? at->top - dy : 0;
    const int right = at->left + at->width + dx, low = at->top + at->height + dy;
    return (struct relume_rect){left, top, (right < size[0] ? right : size[0]) - left,
                                (low < size[1] ? low : size[1]) - top};
}

static relume_status load_part(struct gl_relighter *r, int view, const struct relume_rect *at)
{
    struct relit_view *v = &r->view[view];
    struct relume_codes_part part;
    release(r, v);
    relume_status status = r->parts.part(&part, r->parts.user, view, at);
    if (status)
        return status;
    status = keep(r, view, &part.codes);
    v->at = *at;
    if (status || !v->lent) {
        relume_codes_part_destroy(&part);
        return status;
    }
    v->part = part;
    v->lent = &v->part.codes;
    return RELUME_OK;
}

static relume_status need_shadows(struct gl_relighter *r, struct relit_view *v)
{
    return v->shadows || !r->source.shadows
               ? RELUME_OK
               : r->source.shadows(&v->shadows, r->source.user, (int)(v - r->view));
}

static relume_status relight_by_library(struct gl_relighter *r, struct relit_view *v,
                                        const struct relume_light *lights, int n,
                                        const struct target *into)
{
    const struct relume_image *image;
    const int view = (int)(v - r->view);
    relume_status status =
        r->library
            ? RELUME_OK
            : relume_relighter_create(&r->library, r->views,
                                      relume_relighter_params(.groups = RELUME_RELIGHTER_GROUPS,
                                                              .threads = r->threads));
    if (!status && has_near(lights, n) && !v->surface.data)
        status = find_surface(&v->surface, r, view);
    if (!status)
        status = need_shadows(r, v);
    if (!status)
        status = relume_relighter_picture(&image, r->library,
                                          &(struct relume_relit){.view = view,
                                                                 .codes = v->lent,
                                                                 .surface = &v->surface,
                                                                 .lights = lights,
                                                                 .count = n,
                                                                 .log = r->log,
                                                                 .shadows = v->shadows,
                                                                 .left = v->at.left,
                                                                 .top = v->at.top});
    if (status)
        return status;
    target_write(into, r->gl, image);
    const size_t kept = bytes_of_library(r, v);
    count_more(r, v, kept - v->kept);
    v->kept = kept;
    return RELUME_OK;
}

// Those of draws are gone.
static relume_status need_lent(struct gl_relighter *r, struct relit_view *v)
{
    const int view = (int)(v - r->view);
    if (v->lent)
        return RELUME_OK;
    if (!v->at.width)
        return r->source.codes(&v->lent, r->source.user, view);
    const relume_status status = r->parts.part(&v->part, r->parts.user, view, &v->at);
    v->lent = status ? NULL : &v->part.codes;
    return status;
}

// Lights of some kinds, beside draws.
static relume_status add_by_library(struct gl_relighter *r, struct relit_view *v,
                                    bool (*is)(enum relume_light_kind))
{
    static const struct relume_transfer linear = {.curve = RELUME_CURVE_LINEAR};
    static const float one[3] = {1.0f, 1.0f, 1.0f};
    struct relume_light *light = malloc((size_t)r->lights * sizeof *light);
    relume_status status = light ? draws_scratch(r, v) : RELUME_ENOMEM;
    int n = 0;
    for (int i = 0; !status && i < r->lights; i++)
        if (is(r->light[i].kind))
            light[n++] = r->light[i];
    if (!status)
        status = need_lent(r, v);
    if (!status)
        status = relight_by_library(r, v, light, n, &r->coded);
    free(light);
    if (status)
        return status;
    target_resume(&v->relit, r->gl);
    draws_develop(r, v, &r->coded, linear, one);
    return RELUME_OK;
}

// ---------------------------------------------------------------- near lights

static struct nearby_codes nearby_codes_of(const struct relit_view *v)
{
    return (struct nearby_codes){&v->codes, v->array[0], v->layers,
                                 code_format_of(&v->codes)->unit};
}

static relume_status need_surface(struct gl_relighter *r, struct relit_view *v)
{
    struct relume_image surface = {0};
    const struct nearby_codes codes = nearby_codes_of(v);
    if (v->near.surface.data)
        return RELUME_OK;
    const relume_status status = find_surface(&surface, r, (int)(v - r->view));
    return status ? status : nearby_view_create(&v->near, &r->near, &codes, &surface);
}

// Highlights move under distant lights alone.
static bool moves_shadows(const struct relit_view *v)
{
    return v->moving.shadows && !v->moving.stage.gloss;
}

// One that is relit alone, in r->coded, with what moves by it.
static relume_status add_near_moving(struct gl_relighter *r, struct relit_view *v,
                                     const struct nearby_codes *codes,
                                     const struct relume_light *light)
{
    struct moving_picture p = {.coded = &r->coded,
                               .picture = {.curve = RELUME_CURVE_LINEAR},
                               .times = {1.0f, 1.0f, 1.0f},
                               .coder = v->codes.coder,
                               .display = {.curve = RELUME_CURVE_LINEAR},
                               .rgb = {1.0f, 1.0f, 1.0f}};
    if (v->codes.domain == RELUME_DOMAIN_DISPLAY)
        p.display = v->codes.display;
    target_begin(&r->coded, r->gl);
    const relume_status status = nearby_draw(&r->near, &v->near, codes, light);
    return status
               ? status
               : moving_draw_near(&r->moving, &v->moving, &p, light, v->near.positions, &v->relit);
}

// Array textures that are several the shaders do not read.
static relume_status add_near(struct gl_relighter *r, struct relit_view *v)
{
    const bool moves = moves_shadows(v);
    bool can = v->arrays == 1;
    relume_status status = RELUME_OK;
    if (can && moves)
        status = moving_near_can(&can, &r->moving, &v->moving, v->codes.coder);
    if (!status && !can)
        return add_by_library(r, v, relume_light_is_near);
    const struct nearby_codes codes = nearby_codes_of(v);
    if (!status)
        status = need_surface(r, v);
    if (!status && moves)
        status = draws_scratch(r, v);
    target_resume(&v->relit, r->gl);
    for (int i = 0; !status && i < r->lights; i++)
        if (relume_light_is_near(r->light[i].kind))
            status = moves ? add_near_moving(r, v, &codes, &r->light[i])
                           : nearby_draw(&r->near, &v->near, &codes, &r->light[i]);
    return status;
}

bool gl_relighter_has_kind(const struct gl_relighter *r, bool (*is)(enum relume_light_kind))
{
    for (int i = 0; i < r->lights; i++)
        if (is(r->light[i].kind))
            return true;
    return false;
}

static relume_status need_moving(struct gl_relighter *r, struct relit_view *v)
{
    relume_status status = need_shadows(r, v);
    if (!status && v->shadows && !v->moving.shadows)
        status = moving_view_create(&v->moving, &r->moving, v->shadows, v->codes.coder);
    return status;
}

static void count_moving(struct gl_relighter *r, struct relit_view *v, size_t before)
{
    count_more(r, v, v->moving.bytes - before);
}

static relume_status add_environments(struct gl_relighter *r, struct relit_view *v)
{
    if (!gl_relighter_has_kind(r, gl_relighter_is_environment))
        return RELUME_OK;
    if (v->moving.shadows)
        return bright_sources_relight(r, v);
    return v->codes.domain == RELUME_DOMAIN_DISPLAY ? linear_copy_relight(r, v) : RELUME_OK;
}

static relume_status relight_by_passes(struct gl_relighter *r, struct relit_view *v)
{
    const size_t before = v->moving.bytes;
    relume_status status = need_moving(r, v);
    if (status)
        return status;
    target_begin(&v->relit, r->gl);
    draws_begin(r);
    status = draws_distant(r, v);
    if (!status)
        status = add_environments(r, v);
    count_moving(r, v, before);
    if (!status && gl_relighter_has_kind(r, relume_light_is_near))
        status = add_near(r, v);
    r->gl->Disable(GL_BLEND);
    return status;
}

static relume_status relight(struct gl_relighter *r, struct relit_view *v)
{
    relume_status status = r->by_library ? relight_by_library(r, v, r->light, r->lights, &v->relit)
                                         : relight_by_passes(r, v);
    if (!status)
        status = gl_check(r->gl, "relighting", r->log);
    v->fresh = !status;
    return status;
}

// ---------------------------------------------------------------- interface

relume_status gl_relighter_create(struct gl_relighter *r, const struct gl *gl,
                                  const struct code_source *source, int views,
                                  const struct relume_log *log)
{
    *r = (struct gl_relighter){.gl = gl, .log = log, .source = *source, .views = views};
    moving_create(&r->moving, gl, log);
    r->view = calloc((size_t)views, sizeof *r->view);
    const bool good = budget_create(&r->memory, views, (uint64_t)1 << 30) && r->view;
    relume_status status = good ? draws_create(r) : RELUME_ENOMEM;
    if (!status)
        status = nearby_create(&r->near, gl, log);
    if (status)
        gl_relighter_destroy(r);
    return status;
}

void gl_relighter_destroy(struct gl_relighter *r)
{
    if (!r->gl)
        return;
    loader_destroy(&r->loader);
    for (int i = 0; r->view && r->memory.item && i < r->views; i++)
        release(r, &r->view[i]);
    relume_relighter_destroy(&r->library);
    linear_copy_destroy(r);
    bright_sources_destroy(r);
    draws_destroy(r);
    nearby_destroy(&r->near);
    moving_destroy(&r->moving);
    budget_destroy(&r->memory);
    free(r->view);
    free(r->light);
    *r = (struct gl_relighter){0};
}

static bool same_lights(const struct gl_relighter *r, const struct relume_light *lights, int n)
{
    if (!r->light || r->lights != n)
        return false;
    for (int i = 0; i < n; i++)
        if (!relume_light_equal(&r->light[i], &lights[i]))
            return false;
    return true;
}

static relume_status begin_frame(struct gl_relighter *r)
{
    r->memory.round++;
    r->pending = false;
    if (!r->loader)
        return RELUME_OK;
    loader_clear(r->loader);
    return take_loaded(r, -1);
}

relume_status gl_relighter_begin(struct gl_relighter *r, const struct relume_light *lights, int n)
{
    const relume_status status = begin_frame(r);
    if (status || same_lights(r, lights, n))
        return status;
    const size_t bytes = (size_t)n * sizeof *lights;
    struct relume_light *copy = malloc(bytes ? bytes : 1);
    if (!copy)
        return RELUME_ENOMEM;
    memcpy(copy, lights, bytes);
    free(r->light);
    r->light = copy;
    r->lights = n;
    for (int i = 0; i < r->views; i++)
        r->view[i].fresh = false;
    return RELUME_OK;
}

void gl_relighter_forget(struct gl_relighter *r)
{
    nearby_forget(&r->near);
    moving_forget(&r->moving);
    free(r->light);
    r->light = NULL;
    if (r->library)
        relume_relighter_forget(r->library);
    if (r->linear)
        gl_relighter_forget(r->linear);
}

static relume_status show_view(const struct target **out, struct gl_relighter *r,
                               struct relit_view *v)
{
    budget_use(&r->memory, number_of(r, v));
    const relume_status status = v->fresh ? RELUME_OK : relight(r, v);
    if (!status)
        *out = &v->relit;
    return status;
}

relume_status gl_relighter_view(const struct target **out, struct gl_relighter *r, int view)
{
    struct relit_view *v = &r->view[view];
    relume_status status = RELUME_OK;
    *out = NULL;
    if (v->at.width)
        release(r, v);
    if (!v->present && r->loader) {
        loader_ask(r->loader, view);
        r->pending = true;
        return RELUME_OK;
    }
    if (!v->present)
        status = load(r, view);
    return status ? status : show_view(out, r, v);
}

relume_status gl_relighter_wait(const struct target **out, struct gl_relighter *r, int view)
{
    *out = NULL;
    if (!r->loader || gl_relighter_has(r, view))
        return gl_relighter_view(out, r, view);
    if (r->view[view].present)
        release(r, &r->view[view]);
    loader_ask(r->loader, view);
    const relume_status status = take_loaded(r, view);
    return status ? status : show_view(out, r, &r->view[view]);
}

relume_status gl_relighter_part(const struct target **out, struct relume_rect *at,
                                struct gl_relighter *r, int view, const int size[2])
{
    struct relit_view *v = &r->view[view];
    const struct relume_rect wider = with_margin(at, size), all = {0, 0, size[0], size[1]};
    *out = NULL;
    const bool here = v->present && (v->at.width == 0 || holds(v->at, at));
    relume_status status = here ? RELUME_OK : load_part(r, view, &wider);
    if (!status)
        status = show_view(out, r, v);
    *at = v->at.width ? v->at : all;
    return status;
}

bool gl_relighter_has(const struct gl_relighter *r, int view)
{
    return r->view[view].present && r->view[view].at.width == 0;
}

size_t gl_relighter_view_bytes(const struct relume_codes *codes)
{
    return (size_t)codes->width * (size_t)codes->height * 4 * sizeof(float) + codes_bytes(codes);
}

relume_status gl_relighter_stream(struct gl_relighter *r)
{
    return loader_create(&r->loader, &r->source, r->views);
}
