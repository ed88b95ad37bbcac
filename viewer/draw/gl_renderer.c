// gl_renderer.c - what the app says becomes a frame: relit views, then the drawing of the framing
#include "draw/gl_renderer.h"

#include "cli/program/say.h"
#include "draw/gl_renderer_parts.h"
#include "relight/frame/viewport.h"

#include <relume/relight/tone.h>

#include <stdlib.h>
#include <string.h>

// ---------------------------------------------------------------- making

relume_status gl_renderer_create(struct gl_renderer *r, const struct gl *gl,
                                 const struct code_source *source,
                                 const struct relume_geometry *geometry, const double (*uv)[2],
                                 int views, const struct relume_log *log)
{
    *r = (struct gl_renderer){.gl = gl, .log = log};
    glare_begin(&r->glare, gl, log);
    gl->GenVertexArrays(1, &r->vertices);
    relume_status status = file_views_create(&r->views, geometry, uv, views, log);
    r->backdrop = (struct hiding_scene){
        .source = *source, .uv = (const double(*)[2])r->views.uv, .views = views};
    if (!status)
        status = view_parts_create(&r->parts, views);
    if (!status)
        status = gl_relighter_create(&r->relighter, gl, source, views, log);
    if (!status)
        status = enhancer_create(&r->enhancer, gl, source, geometry, uv, views, log);
    if (!status)
        status = frame_programs_create(&r->programs, gl, geometry, log);
    if (!status)
        status = slab_drawer_create(&r->slabs, gl, log);
    if (status)
        gl_renderer_destroy(r);
    return status;
}

void gl_renderer_use_slabs(struct gl_renderer *r, const relume_slab_set *slabs,
                           const double (*uv)[2], const int *slab_of)
{
    file_views_use_slabs(&r->views, slabs, uv, slab_of);
    enhancer_use_slabs(&r->enhancer, slabs, (const double(*)[2])r->views.uv, slab_of);
}

relume_status gl_renderer_use_depth(struct gl_renderer *r, const struct depth_source *source)
{
    const size_t budget = r->relighter.memory.most / 4;
    const relume_status status = file_views_use_depth(&r->views, r->gl, source, budget);
    if (r->views.depths.views)
        r->relighter.memory.most -= budget;
    return status;
}

void gl_renderer_use_parts(struct gl_renderer *r, const struct part_source *parts,
                           const struct relume_pack_info *info)
{
    r->relighter.parts = *parts;
    view_parts_use(&r->parts, info);
}

relume_status gl_renderer_use_tiles(struct gl_renderer *r, const struct code_source *source,
                                    const struct tile_map *map)
{
    const struct view_parts *p = &r->parts;
    if (!map->first[map->levels] || r->views.count > 1)
        return RELUME_OK;
    const relume_status status = tile_layer_create(&r->tiles, source, map, &r->relighter);
    if (p->view_bytes)
        r->tiles.tile_bytes =
            p->view_bytes / (size_t)p->size[0] * TILE_SIDE / (size_t)p->size[1] * TILE_SIDE;
    return status;
}

void gl_renderer_use_painter(struct gl_renderer *r, const struct view_painter *painter)
{
    painted_view_use(&r->painted, painter);
}

void gl_renderer_use_capture(struct gl_renderer *r, const relume_capture *capture)
{
    r->enhancer.capture = capture;
}

void gl_renderer_destroy(struct gl_renderer *r)
{
    if (!r->gl)
        return;
    frame_programs_destroy(&r->programs, r->gl);
    gl_relighter_destroy(&r->relighter);
    tile_layer_destroy(&r->tiles);
    enhancer_destroy(&r->enhancer);
    glare_end(&r->glare);
    hiding_scene_forget(&r->backdrop);
    painted_view_destroy(&r->painted, r->gl);
    gl_renderer_ways_destroy(r);
    gl_renderer_objects_destroy(r);
    slab_drawer_destroy(&r->slabs);
    target_destroy(&r->frame, r->gl);
    target_destroy(&r->small, r->gl);
    view_parts_destroy(&r->parts);
    file_views_destroy(&r->views);
    r->gl->DeleteVertexArrays(1, &r->vertices);
    *r = (struct gl_renderer){0};
}

// ---------------------------------------------------------------- framings

static relume_status draw_framed_view(struct gl_renderer *r, const struct frame_request *q,
                                      const struct frame_area *area)
{
    const struct target *view = r->views.relit[q->camera.view];
    if (r->tiles.map)
        tile_layer_draw(&r->tiles, &r->programs.picture, area, view);
    else
        draw_picture(&r->programs.picture, r->gl, area, view);
    return RELUME_OK;
}

static relume_status draw_framed_eye(struct gl_renderer *r, const struct frame_request *q,
                                     const struct frame_area *area)
{
    return slab_drawer_draw(&r->slabs, &r->views, &r->parts, q, area, &r->frame);
}

static relume_status draw_framed_look(struct gl_renderer *r, const struct frame_request *q,
                                      const struct frame_area *area)
{
    draw_panorama(&r->programs.panorama, r->gl, area, &r->views.geometry, q->camera.look,
                  r->views.relit[0]);
    return RELUME_OK;
}

relume_status gl_renderer_frame(struct gl_renderer *r, const struct frame_request *q,
                                const struct frame_area *area)
{
    static relume_status (*const draw[])(struct gl_renderer *, const struct frame_request *,
                                         const struct frame_area *) = {
        [RELUME_FRAME_VIEW] = draw_framed_view,
        [RELUME_FRAME_EYE] = draw_framed_eye,
        [RELUME_FRAME_LOOK] = draw_framed_look,
    };
    r->gl->BindVertexArray(r->vertices);
    target_begin(&r->frame, r->gl);
    return draw[q->camera.framing](r, q, area);
}

// ---------------------------------------------------------------- frame

relume_status gl_renderer_need(struct target *target, const struct gl_renderer *r,
                               const struct frame_area *area)
{
    return target_need(target, r->gl, area->width, area->height, r->log);
}

static relume_status paint_view(struct gl_renderer *r, const struct relume_light *lights, int count)
{
    r->views.relit[0] = &r->painted.target;
    return painted_view_light(&r->painted, r->gl, lights, count, r->log);
}

relume_status gl_renderer_relight_views(struct gl_renderer *r, const struct frame_request *q,
                                        const struct relume_light *lights, int count)
{
    if (r->painted.painter.paint)
        return paint_view(r, lights, count);
    struct file_views *v = &r->views;
    r->enhancer.params = q->enhance;
    relume_status status = gl_relighter_begin(&r->relighter, lights, count);
    r->parts.in_use = !r->objects.drawer.gl && view_parts_suit(&r->parts, v, &r->relighter, q);
    if (!status && r->parts.in_use)
        return view_parts_relight(&r->parts, v, &r->relighter, q);
    relume_status (*const look_up)(const struct target **, struct gl_relighter *, int) =
        q->pass == RELUME_PASS_COLOUR ? gl_relighter_view : gl_relighter_wait;  // no stand-ins
    for (int i = 0; !status && i < v->count; i++) {
        v->relit[i] = NULL;
        if (!v->needed[i])
            continue;
        status = look_up(&v->relit[i], &r->relighter, i);
        if (!status && q->pass != RELUME_PASS_COLOUR)
            status =
                enhancer_view(&v->relit[i], &r->enhancer, i, v->relit[i], q->pass, lights, count);
    }
    if (!status && r->tiles.map)
        status = tile_layer_relight(&r->tiles, q, lights, count);
    return status ? status : file_views_stand_in(v, &r->relighter);
}

// The views that the frame needs.
static relume_status prepare_frame(struct gl_renderer *r, const struct frame_request *q)
{
    struct file_views *v = &r->views;
    memset(v->needed, 0, (size_t)v->count * sizeof *v->needed);
    if (!r->stage && !r->empty)
        file_views_mark(v, q);
    return target_need(&r->frame, r->gl, q->width, q->height, r->log);
}

// Normals and the like are for looking up, not at.
static relume_status apply_glare(struct gl_renderer *r, const struct frame_request *q)
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
    draw_sources(&r->programs.source, r->gl, area, sources, n);
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
    relume_status status = prepare_frame(r, q);
    if (!status && r->empty)
        target_begin(&r->frame, r->gl);
    else if (!status && (r->objects.drawer.gl || r->exchange.source.scene))
        status = gl_renderer_draw_ways(r, q, &area, q->light, q->lights);
    else if (!status)
        status = gl_renderer_relight_views(r, q, q->light, q->lights);
    if (!status && !r->objects.drawer.gl && !r->exchange.source.scene && !r->empty)
        status = gl_renderer_frame(r, q, &area);
    if (!status)
        status = draw_lights_in_view(r, q, &area);
    if (!status)
        status = apply_glare(r, q);
    if (status)
        return status;
    target_resume(r->shown, r->gl);
    r->gl->BindVertexArray(r->vertices);
    if (q->ball)
        draw_ball(&r->programs.ball, r->gl, &area, q->ball_place, q->ball_light, q->ball_rgb);
    return gl_check(r->gl, "drawing", r->log);
}

relume_status gl_renderer_stream(struct gl_renderer *r)
{
    const relume_status status = gl_relighter_stream(&r->relighter);
    return status || !r->tiles.map ? status : gl_relighter_stream(&r->tiles.relighter);
}

bool gl_renderer_is_pending(const struct gl_renderer *r)
{
    return r->relighter.pending || r->tiles.relighter.pending;
}

relume_status gl_renderer_read(struct relume_image *out, const struct gl_renderer *r)
{
    return target_read(out, r->shown, r->gl);
}

relume_status gl_renderer_meter(double *ev, struct gl_renderer *r, const struct relume_tone *tone)
{
    enum { SIDE = 128 };
    const int width = r->frame.width < SIDE ? r->frame.width : SIDE;
    const int height = r->frame.height < SIDE ? r->frame.height : SIDE;
    const struct frame_area area = {width, height, {0, 0, width, height}, 1};
    struct relume_image image;
    *ev = 0;
    relume_status status = target_need(&r->small, r->gl, width, height, r->log);
    if (status)
        return status;
    r->gl->BindVertexArray(r->vertices);
    target_begin(&r->small, r->gl);
    draw_picture(&r->programs.picture, r->gl, &area, &r->frame);
    status = target_read(&image, &r->small, r->gl);
    if (!status)
        *ev = relume_tone_meter_for(&image, tone);
    relume_image_destroy(&image);
    return status;
}

void gl_renderer_present(const struct gl_renderer *r, const struct window_place *window, int tone,
                         double white, GLuint framebuffer)
{
    r->gl->BindVertexArray(r->vertices);
    draw_present(&r->programs.present, r->gl, r->shown, window, tone, white, framebuffer);
}
