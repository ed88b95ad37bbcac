// between_white.c - objects under a white sky: how much of the light on them they return
#include "draw/between_white.h"

#include "draw/objects_drawer_parts.h"
#include "relight/light/environment.h"

#include <string.h>

relume_status between_white_create(struct between_white *w)
{
    enum { WIDE = 8, HIGH = 4 };
    const relume_status status = relume_image_create(&w->map, WIDE, HIGH, 3);
    for (int i = 0; i < 3 * WIDE * HIGH && !status; i++)
        w->map.data[i] = 1.0f;
    return status ? status : relume_environment_create(&w->sky, &w->map, NULL);
}

void between_white_destroy(struct between_white *w, const struct gl *gl)
{
    target_destroy(&w->objects, gl);
    relume_environment_destroy(&w->sky);
    relume_image_destroy(&w->map);
}

relume_status between_white_need(struct between_white *w, struct objects_drawer *t,
                                 const struct frame_projection *projection, uint64_t materials)
{
    const struct relume_light white = {
        .kind = RELUME_LIGHT_ENVIRONMENT, .rgb = {1, 1, 1}, .environment = w->sky};
    const struct target *like = &t->surface.position;
    if (w->of == materials && w->objects.width == like->width &&
        w->objects.height == like->height && !memcmp(w->clip, projection->clip, sizeof w->clip))
        return RELUME_OK;
    w->of = 0;
    relume_status status = target_need(&w->objects, t->gl, like->width, like->height, t->log);
    if (!status)
        status = objects_drawer_show_sky(t, &white);
    if (status)
        return status;
    target_swap(&t->sky.shown, &w->objects);
    w->of = materials;
    memcpy(w->clip, projection->clip, sizeof w->clip);
    return RELUME_OK;
}
