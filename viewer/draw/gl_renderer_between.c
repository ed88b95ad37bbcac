// gl_renderer_between.c - frames of a panorama with objects in it and light between them, by draws
#include "draw/gl_renderer.h"
#include "draw/gl_renderer_parts.h"

#include <relume/world/transport.h>

enum { BOUNCES = 2 };  // as relume_render_params
static const struct {
    const char *name;
    int pattern;  // as its `relume_transport` has it
} ways[] = {[BETWEEN_AMBIENT] = {"ssao", 4},
            [BETWEEN_DIRECTIONAL] = {"ssdo", 4},
            [BETWEEN_MICRO] = {"micro", 1},
            [BETWEEN_ISM] = {"ism", ISM_PATTERN}};

static int samples_of(const struct frame_request *q, enum between_way way)
{
    return q->way_samples ? q->way_samples
                          : relume_transport_samples(relume_transport_find(ways[way].name));
}

static relume_status need_targets(struct gl_renderer *r, const struct frame_area *area)
{
    relume_status status = gl_renderer_need(&r->objects.scene, r, area);
    return status ? status : gl_renderer_need(&r->objects.lit, r, area);
}

relume_status gl_renderer_need_points(struct gl_renderer *r, const struct frame_request *q,
                                      enum between_way way)
{
    return between_need(&r->exchange.between, &r->objects.drawer, &r->views.geometry,
                        &r->objects.position[0], way, samples_of(q, way));
}

relume_status gl_renderer_need_between(struct gl_renderer *r, const struct frame_request *q,
                                       const struct frame_area *area)
{
    if (r->exchange.between.gl)
        return RELUME_OK;
    r->gl->BindVertexArray(r->vertices);
    relume_status status = need_targets(r, area);
    if (!status)
        status = gl_renderer_find_scene(r, q, *area);  // r->objects.position is known then
    return status ? status
                  : between_create(&r->exchange.between, r->gl, &r->views.geometry,
                                   &r->objects.position[0], r->log);
}

static relume_status add_light(struct gl_renderer *r, const struct frame_request *q,
                               const struct frame_area *area, const struct between_view *view,
                               const struct relume_light *light)
{
    struct frame_area plain = *area;
    plain.exposure = 1.0f;
    relume_status status = gl_renderer_relight_views(r, q, light, 1);
    if (!status)
        status = gl_renderer_frame(r, q, &plain);
    r->objects.drawer.panorama =
        (struct mirror_panorama){&r->views.geometry, r->views.relit[0], &r->objects.position[0]};
    return status ? status
                  : between_light(&r->exchange.between, &r->objects.drawer, view, light,
                                  r->views.relit[0], &r->frame, &r->objects.lit, area->exposure);
}

static relume_status draw_lights(struct gl_renderer *r, const struct frame_request *q,
                                 const struct frame_area *area, const struct between_view *view,
                                 const struct relume_light *lights, int count)
{
    relume_status status = between_begin(&r->exchange.between, &r->objects.drawer, view);
    target_begin(&r->objects.lit, r->gl);
    for (int i = 0; i < count && !status; i++)
        status = add_light(r, q, area, view, &lights[i]);
    if (status)
        return status;
    target_swap(&r->frame, &r->objects.lit);
    between_end(&r->exchange.between, &r->objects.drawer);
    r->gl->BindVertexArray(r->vertices);
    target_resume(&r->frame, r->gl);
    r->objects.drawer.returned = r->exchange.between.frame.thrown.texture;
    objects_drawer_over(&r->objects.drawer, area, r->objects.scene.texture, false);
    r->objects.drawer.returned = 0;
    return RELUME_OK;
}

relume_status gl_renderer_draw_between(bool *drawn, struct gl_renderer *r,
                                       const struct frame_request *q, const struct frame_area *area,
                                       const struct relume_light *lights, int count,
                                       enum between_way way)
{
    struct frame_projection projection;
    *drawn = r->exchange.with_depth && r->views.geometry.projection >= RELUME_CYLINDRICAL &&
             r->views.count == 1 && gl_renderer_projection(&projection, r, q, area);
    if (!*drawn)
        return RELUME_OK;
    relume_status status = gl_renderer_need_between(r, q, area);
    r->gl->BindVertexArray(r->vertices);
    if (!status)
        status = need_targets(r, area);
    if (!status)
        status = objects_drawer_see(&r->objects.drawer, &projection);
    if (!status)
        status = gl_renderer_find_scene(r, q, *area);
    if (status)
        return status;
    const int bounces = q->bounces ? q->bounces : BOUNCES;
    const struct between_view view = {
        .geometry = &r->views.geometry,
        .panorama_places = &r->objects.position[0],
        .scene = &r->objects.scene,
        .projection = &projection,
        .width = area->width,
        .height = area->height,
        .way = way,
        .bounces = bounces > 0 ? bounces : 0,
        .samples = samples_of(q, way),
        .pattern = ways[way].pattern,
        .spacing = relume_transport_spacing(relume_transport_find(ways[way].name)),
        .sends = count ? 1.0f / (float)count : 0.0f};
    return draw_lights(r, q, area, &view, lights, count);
}
