// gl_renderer_between.c - frames of a panorama with objects in it and light between them, by passes
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

static void swap(struct target *a, struct target *b)
{
    const struct target was = *a;
    *a = *b;
    *b = was;
}

static relume_status prepare(struct renderer *r, const struct place *place)
{
    relume_status status = renderer_prepare(&r->scene, r, place->width, place->height);
    return status ? status : renderer_prepare(&r->lit, r, place->width, place->height);
}

relume_status renderer_need_points(struct renderer *r, const struct frame_request *q,
                                   enum between_way way)
{
    return between_need(&r->between, &r->drawer, &r->geometry, &r->place[0], way,
                        samples_of(q, way));
}

relume_status renderer_need_between(struct renderer *r, const struct frame_request *q,
                                    const struct place *place)
{
    if (r->between.gl)
        return RELUME_OK;
    r->gl->BindVertexArray(r->vertices);
    relume_status status = prepare(r, place);
    if (!status)
        status = renderer_find_scene(r, q, *place);  // r->place is known then
    return status ? status : between_create(&r->between, r->gl, &r->geometry, &r->place[0], r->log);
}

static relume_status add_light(struct renderer *r, const struct frame_request *q,
                               const struct place *place, const struct between_view *view,
                               const struct relume_light *light)
{
    struct place plain = *place;
    plain.exposure = 1.0f;
    relume_status status = renderer_relight_views(r, q, light, 1);
    if (!status)
        status = renderer_frame(r, q, &plain);
    r->drawer.panorama = (struct mirror_panorama){&r->geometry, r->relit[0], &r->place[0]};
    return status ? status
                  : between_light(&r->between, &r->drawer, view, light, r->relit[0], &r->frame,
                                  &r->lit, place->exposure);
}

static relume_status draw(struct renderer *r, const struct frame_request *q,
                          const struct place *place, const struct between_view *view,
                          const struct relume_light *lights, int count)
{
    relume_status status = between_begin(&r->between, &r->drawer, view);
    target_begin(&r->lit, r->gl);
    for (int i = 0; i < count && !status; i++)
        status = add_light(r, q, place, view, &lights[i]);
    if (status)
        return status;
    swap(&r->frame, &r->lit);
    between_end(&r->between, &r->drawer);
    r->gl->BindVertexArray(r->vertices);
    target_resume(&r->frame, r->gl);
    r->drawer.returned = r->between.thrown.texture;
    objects_drawer_over(&r->drawer, place, r->scene.texture, false);
    r->drawer.returned = 0;
    return RELUME_OK;
}

relume_status renderer_draw_between(bool *drawn, struct renderer *r, const struct frame_request *q,
                                    const struct place *place, const struct relume_light *lights,
                                    int count, enum between_way way)
{
    struct frame_projection projection;
    *drawn = r->with_depth && r->geometry.projection >= RELUME_CYLINDRICAL && r->views == 1 &&
             renderer_projection(&projection, r, q, place);
    if (!*drawn)
        return RELUME_OK;
    relume_status status = renderer_need_between(r, q, place);
    r->gl->BindVertexArray(r->vertices);
    if (!status)
        status = prepare(r, place);
    if (!status)
        status = objects_drawer_see(&r->drawer, &projection);
    if (!status)
        status = renderer_find_scene(r, q, *place);
    if (status)
        return status;
    const int bounces = q->bounces ? q->bounces : BOUNCES;
    const struct between_view view = {
        .geometry = &r->geometry,
        .panorama_places = &r->place[0],
        .scene = &r->scene,
        .projection = &projection,
        .width = place->width,
        .height = place->height,
        .way = way,
        .bounces = bounces > 0 ? bounces : 0,
        .samples = samples_of(q, way),
        .pattern = ways[way].pattern,
        .spacing = relume_transport_spacing(relume_transport_find(ways[way].name)),
        .sends = count ? 1.0f / (float)count : 0.0f};
    return draw(r, q, place, &view, lights, count);
}
