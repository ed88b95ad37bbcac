// gl_renderer.c - what the app says becomes a frame: relit views, then the drawing of the framing
#include "draw/gl_renderer.h"

#include "cli/program/say.h"
#include "draw/gl_renderer_parts.h"

#include <relume/relight/tone.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---------------------------------------------------------------- making

static relume_status create_programs(struct gl_renderer *r)
{
    const struct {
        struct program *program;
        const struct fragment *fragment;
    } list[] = {
        {&r->picture, &draw_picture_fragment},
        {&r->slab, &draw_slab_fragment},
        {&r->slab_depth, &draw_slab_depth_fragment},
        {&r->slab_lens, &draw_slab_lens_fragment},
        {&r->slabs, &draw_slabs_fragment},
        {&r->slabs_depth, &draw_slabs_depth_fragment},
        {&r->mean, &draw_mean_fragment},
        {&r->ball, &draw_ball_fragment},
        {&r->source, &draw_source_fragment},
        {&r->present, &draw_present_fragment},
        {&r->apart, &draw_apart_fragment},
    };
    relume_status status = RELUME_OK;
    for (size_t i = 0; !status && i < sizeof list / sizeof *list; i++)
        status = program_create_fragment(list[i].program, r->gl, list[i].fragment, r->log);
    if (!status && r->geometry.projection >= RELUME_CYLINDRICAL)
        status = draw_panorama_create(&r->panorama, r->gl, &r->geometry, r->log);
    return status;
}

relume_status gl_renderer_create(struct gl_renderer *r, const struct gl *gl,
                                 const struct code_source *source,
                                 const struct relume_geometry *geometry, const double (*uv)[2],
                                 int views, const struct relume_log *log)
{
    *r = (struct gl_renderer){.gl = gl, .log = log, .geometry = *geometry, .views = views};
    glare_begin(&r->glare, gl, log);
    gl->GenVertexArrays(1, &r->vertices);
    r->uv = calloc((size_t)views, sizeof *r->uv);
    if (r->uv && uv)
        memcpy(r->uv, uv, (size_t)views * sizeof *r->uv);
    r->needed = calloc((size_t)views, sizeof *r->needed);
    r->part = calloc((size_t)views, sizeof *r->part);
    r->relit = calloc((size_t)views, sizeof *r->relit);
    r->backdrop =
        (struct hiding_scene){.source = *source, .uv = (const double(*)[2])r->uv, .views = views};
    relume_status status = r->uv && r->needed && r->part && r->relit ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = gl_relighter_create(&r->relighter, gl, source, views, log);
    if (!status)
        status = enhancer_create(&r->enhancer, gl, source, geometry, uv, views, log);
    if (!status)
        status = create_programs(r);
    if (!status && geometry->projection == RELUME_SLAB && uv) {
        status = relume_slab_create(&r->grid, geometry, uv, views);
        if (status == RELUME_EINVAL)
            status = say(log, RELUME_EUNFIT, "the slab's cameras do not stand on a grid");
    }
    if (status)
        gl_renderer_destroy(r);
    return status;
}

void gl_renderer_use_slabs(struct gl_renderer *r, const relume_slab_set *slabs,
                           const double (*uv)[2], const int *slab_of)
{
    r->around = slabs;
    r->slab_of = slab_of;
    memcpy(r->uv, uv, (size_t)r->views * sizeof *r->uv);
    enhancer_use_slabs(&r->enhancer, slabs, (const double(*)[2])r->uv, slab_of);
}

relume_status gl_renderer_use_depth(struct gl_renderer *r, const struct depth_source *source)
{
    const relume_slab *slab[RELUME_MOST_SLABS] = {r->grid};
    int slabs = r->grid != NULL;
    for (; r->around && slabs < relume_slab_set_count(r->around); slabs++)
        slab[slabs] = relume_slab_set_slab(r->around, slabs);
    if (!slabs)
        return RELUME_OK;
    const relume_status status = depths_create(&r->depths, r->gl, slab, slabs, source);
    r->depths.budget = r->relighter.budget / 4;
    r->relighter.budget -= r->depths.budget;
    return status;
}

void gl_renderer_use_parts(struct gl_renderer *r, const struct part_source *parts,
                           const struct relume_pack_info *info)
{
    const struct relume_codes codes = {.width = info->width,
                                       .height = info->height,
                                       .planes = info->planes,
                                       .storage = info->books ? RELUME_STORE_16 : info->storage};
    r->relighter.parts = *parts;
    r->size[0] = info->width;
    r->size[1] = info->height;
    r->view_bytes = gl_relighter_view_bytes(&codes);
    r->display = info->domain == RELUME_DOMAIN_DISPLAY;
}

void gl_renderer_use_capture(struct gl_renderer *r, const relume_capture *capture)
{
    r->enhancer.capture = capture;
}

void gl_renderer_destroy(struct gl_renderer *r)
{
    if (!r->gl)
        return;
    struct program *const programs[] = {&r->picture, &r->slab,        &r->slab_depth, &r->slab_lens,
                                        &r->slabs,   &r->slabs_depth, &r->mean,       &r->panorama,
                                        &r->ball,    &r->source,      &r->present,    &r->apart};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        program_destroy(programs[i], r->gl);
    gl_relighter_destroy(&r->relighter);
    gl_renderer_tiles_destroy(r);
    enhancer_destroy(&r->enhancer);
    glare_end(&r->glare);
    hiding_scene_forget(&r->backdrop);
    target_destroy(&r->frame, r->gl);
    target_destroy(&r->painted, r->gl);
    free(r->painted_light);
    target_destroy(&r->small, r->gl);
    target_destroy(&r->sum, r->gl);
    target_destroy(&r->beside, r->gl);
    target_destroy(&r->pinholes, r->gl);
    gl_renderer_ways_destroy(r);
    gl_renderer_objects_destroy(r);
    if (r->depths.views)
        depths_destroy(&r->depths);
    r->gl->DeleteVertexArrays(1, &r->vertices);
    relume_slab_destroy(&r->grid);
    free(r->uv);
    free(r->needed);
    free(r->part);
    free(r->relit);
    *r = (struct gl_renderer){0};
}

// ---------------------------------------------------------------- framings

relume_status gl_renderer_prepare(struct target *target, const struct gl_renderer *r, int width,
                                  int height)
{
    if (target->width == width && target->height == height)
        return RELUME_OK;
    target_destroy(target, r->gl);
    return target_create(target, r->gl, width, height, r->log);
}

static void mark_view(struct gl_renderer *r, const struct frame_request *q)
{
    r->needed[q->camera.view] = true;
}

// Of the pinholes of a lens, while something moves.
enum { MOVING_SHARE = 8 };

static int picture_width(const struct frame_request *q)
{
    return (int)lround(q->picture.right - q->picture.left);
}

static void mark_eye(struct gl_renderer *r, const struct frame_request *q)
{
    if (r->around) {
        if (q->has_window)
            (void)relume_slab_set_needs(r->needed, r->around, &q->window, picture_width(q),
                                        &q->view);
        return;
    }
    (void)relume_slab_needs(r->needed, r->grid, q->camera.eye, &q->view);
}

static void mark_look(struct gl_renderer *r, const struct frame_request *q)
{
    (void)q;
    r->needed[0] = true;
}

static relume_status draw_framed_view(struct gl_renderer *r, const struct frame_request *q,
                                      const struct frame_area *area)
{
    if (r->map)
        gl_renderer_draw_tiles(r, area, r->relit[q->camera.view]);
    else
        draw_picture(&r->picture, r->gl, area, r->relit[q->camera.view]);
    return RELUME_OK;
}

static bool takes_lens(const struct frame_request *q)
{
    return q->view.aperture != 0.0 || q->view.focus != 0.0;
}

// An eye at a slab's camera sees its view alone, whatever the depth.
static bool takes_depth(const struct gl_renderer *r, const struct frame_request *q)
{
    const enum relume_interpolation i = q->view.interpolation;
    int views = 0;
    for (int k = 0; k < r->views; k++)
        views += r->needed[k];
    return r->depths.views && (r->around || (views > 1 && !takes_lens(q))) &&
           (i == RELUME_INTERPOLATE_DEFAULT || i == RELUME_INTERPOLATE_DEPTH);
}

static relume_status draw_lens(struct gl_renderer *r, const struct frame_request *q,
                               const struct frame_area *area, const struct slab_inputs *in)
{
    relume_status status = gl_renderer_prepare(&r->sum, r, area->width, area->height);
    if (status)
        return status;
    target_begin(&r->sum, r->gl);
    draw_slab_lens(&r->slab_lens, r->gl, area, in, q->view.aperture, q->view.focus);
    target_resume(&r->frame, r->gl);
    draw_mean(&r->mean, r->gl, area, &r->sum);
    return RELUME_OK;
}

// The mean of `in`, by way of `sum`, added to what `onto` holds.
static void add_mean(struct gl_renderer *r, const struct frame_request *q,
                     const struct frame_area *area, const struct target *onto,
                     const struct slabs_inputs *in, const struct target *sum)
{
    target_begin(sum, r->gl);
    if (in->disparity)
        draw_slabs_depth(&r->slabs_depth, r->gl, area, in);
    else
        draw_slabs(&r->slabs, r->gl, area, in,
                   q->view.interpolation == RELUME_INTERPOLATE_CONSTANT);
    target_resume(onto, r->gl);
    r->gl->Enable(GL_BLEND);
    draw_mean(&r->mean, r->gl, area, sum);
    r->gl->Disable(GL_BLEND);
}

// Whether there are rays that pass the cameras of no slab, looked for at places so far apart.
static bool has_others(const struct gl_renderer *r, const struct relume_window *window)
{
    enum { PLACES = 32 };
    for (int i = 0; i < PLACES * PLACES; i++)
        if (!relume_slab_set_passes(r->around, window, (i % PLACES + 0.5) / PLACES,
                                    (i / PLACES + 0.5) / PLACES))
            return true;
    return false;
}

// All slabs through one window, added to what `onto` holds.
static relume_status add_around(struct gl_renderer *r, const struct frame_request *q,
                                const struct frame_area *area, const struct target *onto,
                                const struct relume_window *window, bool by_depth)
{
    struct slabs_inputs in = {
        .slabs = r->around,
        .window = window,
        .views = r->relit,
        .disparity = by_depth ? r->depths.texture : NULL,
        .range = (const double(*)[2])r->depths.range,
    };
    in.others = has_others(r, window);
    add_mean(r, q, area, onto, &in, &r->sum);
    if (!in.others)
        return RELUME_OK;
    const relume_status status = gl_renderer_prepare(&r->beside, r, area->width, area->height);
    in.passed = &r->sum;
    if (!status)
        add_mean(r, q, area, onto, &in, &r->beside);
    return status;
}

// Twin of relume_slab_set_frame: the mean over the pinholes that show anything.
static relume_status draw_around_lens(struct gl_renderer *r, const struct frame_request *q,
                                      const struct frame_area *area,
                                      const struct relume_window *window, bool by_depth)
{
    const double aperture = q->view.aperture, focus = q->view.focus;
    const int width = picture_width(q);
    struct frame_area plain = *area;
    relume_status status = gl_renderer_prepare(&r->pinholes, r, area->width, area->height);
    if (status || !relume_lens_fits(window, aperture, focus))
        return status;
    plain.exposure = 1;
    target_begin(&r->pinholes, r->gl);
    const int all = relume_lens_points(window, aperture, focus, width);
    const int n = q->moves ? (all + MOVING_SHARE - 1) / MOVING_SHARE : all;
    for (int i = 0; !status && i < n; i++) {
        const struct relume_window from = relume_lens_window(window, aperture, focus, i, n);
        status = add_around(r, q, &plain, &r->pinholes, &from, by_depth);
    }
    target_resume(&r->frame, r->gl);
    draw_mean(&r->mean, r->gl, area, &r->pinholes);
    return status;
}

static relume_status draw_around(struct gl_renderer *r, const struct frame_request *q,
                                 const struct frame_area *area)
{
    double range[2];
    relume_status status = gl_renderer_prepare(&r->sum, r, area->width, area->height);
    const bool by_depth = takes_depth(r, q);
    if (!status && by_depth)
        status = depths_use(&r->depths, r->needed, range);
    if (status || !q->has_window)
        return status;
    if (takes_lens(q))
        return draw_around_lens(r, q, area, &q->window, by_depth);
    return add_around(r, q, area, &r->frame, &q->window, by_depth);
}

static relume_status draw_framed_eye(struct gl_renderer *r, const struct frame_request *q,
                                     const struct frame_area *area)
{
    const struct slab_inputs in = {r->grid,
                                   &r->geometry,
                                   q->camera.eye,
                                   r->relit,
                                   r->by_parts ? r->part : NULL,
                                   {r->size[0], r->size[1]}};
    bool any = false;
    for (int i = 0; i < r->views; i++)
        any |= r->needed[i];
    if (!any)
        return RELUME_OK;
    if (r->around)
        return draw_around(r, q, area);
    if (takes_lens(q))
        return draw_lens(r, q, area, &in);
    if (!takes_depth(r, q)) {
        draw_slab(&r->slab, r->gl, area, &in, q->view.interpolation == RELUME_INTERPOLATE_CONSTANT);
        return RELUME_OK;
    }
    double range[2];
    const relume_status status = r->by_parts
                                     ? depths_use_parts(&r->depths, r->needed, r->part, range)
                                     : depths_use(&r->depths, r->needed, range);
    if (!status)
        draw_slab_depth(&r->slab_depth, r->gl, area, &in, r->depths.texture, range);
    return status;
}

static relume_status draw_framed_look(struct gl_renderer *r, const struct frame_request *q,
                                      const struct frame_area *area)
{
    draw_panorama(&r->panorama, r->gl, area, &r->geometry, q->camera.look, r->relit[0]);
    return RELUME_OK;
}

// Which views a framing needs, and how it is drawn from them.
static const struct framing {
    void (*mark)(struct gl_renderer *r, const struct frame_request *q);
    relume_status (*draw)(struct gl_renderer *r, const struct frame_request *q,
                          const struct frame_area *area);
} framings[] = {
    [RELUME_FRAME_VIEW] = {mark_view, draw_framed_view},
    [RELUME_FRAME_EYE] = {mark_eye, draw_framed_eye},
    [RELUME_FRAME_LOOK] = {mark_look, draw_framed_look},
};

// ---------------------------------------------------------------- frame

// How far apart the cameras of two views stand, squared.
static double apart(const struct gl_renderer *r, int a, int b)
{
    const double du = r->uv[a][0] - r->uv[b][0], dv = r->uv[a][1] - r->uv[b][1];
    return du * du + dv * dv;
}

// The view on the GPU that stands nearest to a missing one of the same slab, or -1.
static int nearest_present(const struct gl_renderer *r, int missing)
{
    int nearest = -1;
    for (int i = 0; i < r->views; i++)
        if (gl_relighter_has(&r->relighter, i) &&
            (!r->slab_of || r->slab_of[i] == r->slab_of[missing]) &&
            (nearest < 0 || apart(r, i, missing) < apart(r, nearest, missing)))
            nearest = i;
    return nearest;
}

// Of several slabs those that are not there yet say nothing while others do.
static relume_status stand_in(struct gl_renderer *r)
{
    relume_status status = RELUME_OK;
    bool any = false;
    for (int i = 0; r->slab_of && i < r->views; i++)
        any |= r->relit[i] != NULL;
    for (int i = 0; !status && i < r->views; i++) {
        if (!r->needed[i] || r->relit[i])
            continue;
        const int nearest = nearest_present(r, i);
        if (nearest < 0 && any)
            continue;
        status = nearest < 0 ? gl_relighter_wait(&r->relit[i], &r->relighter, i)
                             : gl_relighter_view(&r->relit[i], &r->relighter, nearest);
    }
    return status;
}

// Whether the views that a slab's eye needs would be too much for the graphics memory, whole, and
// may be parts: light alone, that falls from afar and is not refitted.
static bool takes_parts(const struct gl_renderer *r, const struct frame_request *q)
{
    const struct gl_relighter *l = &r->relighter;
    size_t views = 0;
    for (int i = 0; i < r->views; i++)
        views += r->needed[i];
    for (int i = 0; i < q->lights; i++)
        if (relume_light_is_near(q->light[i].kind) ||
            (r->display && q->light[i].kind == RELUME_LIGHT_ENVIRONMENT))
            return false;
    return l->parts.part && r->size[0] && r->grid && !r->drawer.gl &&
           q->camera.framing == RELUME_FRAME_EYE && q->pass == RELUME_PASS_COLOUR &&
           !takes_lens(q) && views * r->view_bytes > l->budget;
}

static relume_status relight_parts(struct gl_renderer *r, const struct frame_request *q)
{
    const int *size = r->size;
    const int frame[2] = {picture_width(q), (int)lround(q->picture.bottom - q->picture.top)};
    struct relume_view_params params = q->view;
    relume_status status = RELUME_OK;
    params.size[0] = size[0];
    params.size[1] = size[1];
    if (takes_depth(r, q)) {
        status = depths_find_ranges(&r->depths, r->needed);
        params.range = (const double(*)[2])r->depths.range;
    }
    if (!status && relume_slab_parts(r->part, r->grid, q->camera.eye, frame, &params) < 0)
        status = RELUME_ENOMEM;
    for (int i = 0; !status && i < r->views; i++) {
        r->relit[i] = NULL;
        if (r->part[i].width)
            status = gl_relighter_part(&r->relit[i], &r->part[i], &r->relighter, i, size);
    }
    return status;
}

// Anew when the lights have changed.
static relume_status paint_view(struct gl_renderer *r, const struct relume_light *lights, int count)
{
    const size_t bytes = (size_t)count * sizeof *lights;
    struct relume_image image;
    relume_status status = RELUME_OK;
    r->relit[0] = &r->painted;
    if (r->is_painted && count == r->painted_lights && !memcmp(lights, r->painted_light, bytes))
        return RELUME_OK;
    struct relume_light *kept = realloc(r->painted_light, bytes + sizeof *kept);
    if (!kept)
        return RELUME_ENOMEM;
    memcpy(kept, lights, bytes);
    r->painted_light = kept;
    r->painted_lights = count;
    status = r->painter.paint(&image, r->painter.user, lights, count);
    if (status)
        return status;
    if (!r->painted.texture)
        status = target_create(&r->painted, r->gl, image.width, image.height, r->log);
    if (!status)
        target_write(&r->painted, r->gl, &image);
    r->is_painted = !status;
    relume_image_destroy(&image);
    return status;
}

void gl_renderer_use_painter(struct gl_renderer *r, const struct view_painter *painter)
{
    r->painter = *painter;
    r->is_painted = false;
}

relume_status gl_renderer_relight_views(struct gl_renderer *r, const struct frame_request *q,
                                        const struct relume_light *lights, int count)
{
    if (r->painter.paint)
        return paint_view(r, lights, count);
    r->enhancer.params = q->enhance;
    relume_status status = gl_relighter_begin(&r->relighter, lights, count);
    r->by_parts = takes_parts(r, q);
    if (!status && r->by_parts)
        return relight_parts(r, q);
    relume_status (*const look_up)(const struct target **, struct gl_relighter *, int) =
        q->pass == RELUME_PASS_COLOUR ? gl_relighter_view : gl_relighter_wait;  // no stand-ins
    for (int i = 0; !status && i < r->views; i++) {
        r->relit[i] = NULL;
        if (r->needed[i])
            status = look_up(&r->relit[i], &r->relighter, i);
        if (!status && r->needed[i] && q->pass != RELUME_PASS_COLOUR)
            status =
                enhancer_view(&r->relit[i], &r->enhancer, i, r->relit[i], q->pass, lights, count);
    }
    if (!status && r->map)
        status = gl_renderer_relight_tiles(r, q, lights, count);
    return status ? status : stand_in(r);
}

relume_status gl_renderer_frame(struct gl_renderer *r, const struct frame_request *q,
                                const struct frame_area *area)
{
    r->gl->BindVertexArray(r->vertices);
    target_begin(&r->frame, r->gl);
    return framings[q->camera.framing].draw(r, q, area);
}

// The views that the frame needs.
static relume_status prepare(struct gl_renderer *r, const struct frame_request *q)
{
    relume_status status = gl_renderer_prepare(&r->frame, r, q->width, q->height);
    memset(r->needed, 0, (size_t)r->views * sizeof *r->needed);
    if (!r->stage && !r->empty)
        framings[q->camera.framing].mark(r, q);
    return status;
}

// Normals and the like are for looking up, not at.
static relume_status see(struct gl_renderer *r, const struct frame_request *q)
{
    r->shown = &r->frame;
    if (!q->observer.on || q->pass != RELUME_PASS_COLOUR)
        return RELUME_OK;
    const relume_status status = glare_see(&r->glare, &r->frame, q);
    r->shown = &r->glare.seen;
    return status;
}

static relume_status draw_lights_in_view(struct gl_renderer *r, const struct frame_request *q,
                                         const struct frame_area *area)
{
    if (!q->observer.sources || q->pass != RELUME_PASS_COLOUR)
        return RELUME_OK;
    struct relume_visible_light *sources = malloc(RELUME_VISIBLE_LIGHTS_MOST * sizeof *sources);
    if (!sources)
        return RELUME_ENOMEM;
    const int n = visible_lights(sources, q, q->light, q->lights, &r->backdrop);
    draw_sources(&r->source, r->gl, area, sources, n);
    free(sources);
    return RELUME_OK;
}

relume_status gl_renderer_draw(struct gl_renderer *r, const struct frame_request *q)
{
    const struct frame_area area = {
        .width = q->width,
        .height = q->height,
        .picture = q->picture,
        .exposure = q->exposure,
    };
    relume_status status = prepare(r, q);
    if (!status && r->empty)
        target_begin(&r->frame, r->gl);
    else if (!status && (r->drawer.gl || r->exchange.scene))
        status = gl_renderer_draw_ways(r, q, &area, q->light, q->lights);
    else if (!status)
        status = gl_renderer_relight_views(r, q, q->light, q->lights);
    if (!status && !r->drawer.gl && !r->exchange.scene && !r->empty)
        status = gl_renderer_frame(r, q, &area);
    if (!status)
        status = draw_lights_in_view(r, q, &area);
    if (!status)
        status = see(r, q);
    if (status)
        return status;
    target_resume(r->shown, r->gl);
    r->gl->BindVertexArray(r->vertices);
    if (q->ball)
        draw_ball(&r->ball, r->gl, &area, q->ball_place, q->ball_light, q->ball_rgb);
    return gl_check(r->gl, "drawing", r->log);
}

relume_status gl_renderer_stream(struct gl_renderer *r)
{
    const relume_status status = gl_relighter_stream(&r->relighter);
    return status || !r->map ? status : gl_relighter_stream(&r->tiles);
}

bool gl_renderer_is_pending(const struct gl_renderer *r)
{
    return r->relighter.pending || r->tiles.pending;
}

relume_status gl_renderer_read(struct relume_image *out, const struct gl_renderer *r)
{
    return target_read(out, r->shown, r->gl);
}

relume_status gl_renderer_meter(double *ev, struct gl_renderer *r)
{
    enum { SIDE = 128 };
    const int width = r->frame.width < SIDE ? r->frame.width : SIDE;
    const int height = r->frame.height < SIDE ? r->frame.height : SIDE;
    const struct frame_area area = {width, height, {0, 0, width, height}, 1};
    struct relume_image image;
    *ev = 0;
    relume_status status = gl_renderer_prepare(&r->small, r, width, height);
    if (status)
        return status;
    r->gl->BindVertexArray(r->vertices);
    target_begin(&r->small, r->gl);
    draw_picture(&r->picture, r->gl, &area, &r->frame);
    status = target_read(&image, &r->small, r->gl);
    if (!status)
        *ev = relume_tone_meter(&image);
    relume_image_destroy(&image);
    return status;
}

void gl_renderer_present(const struct gl_renderer *r, const struct window_place *window, int tone,
                         double white, GLuint framebuffer)
{
    r->gl->BindVertexArray(r->vertices);
    draw_present(&r->present, r->gl, r->shown, window, tone, white, framebuffer);
}
