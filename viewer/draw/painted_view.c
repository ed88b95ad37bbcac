// painted_view.c - a planar view that a painter shows under lights, without codes
#include "draw/painted_view.h"

#include <stdlib.h>
#include <string.h>

void painted_view_use(struct painted_view *v, const struct view_painter *painter)
{
    v->painter = *painter;
    v->fresh = false;
}

static relume_status keep_lights(struct painted_view *v, const struct relume_light *lights, int n)
{
    const size_t bytes = (size_t)n * sizeof *lights;
    struct relume_light *kept = realloc(v->light, bytes + sizeof *kept);
    if (!kept)
        return RELUME_ENOMEM;
    memcpy(kept, lights, bytes);
    v->light = kept;
    v->lights = n;
    return RELUME_OK;
}

relume_status painted_view_light(struct painted_view *v, const struct gl *gl,
                                 const struct relume_light *lights, int n,
                                 const struct relume_log *log)
{
    struct relume_image image;
    if (v->fresh && n == v->lights && !memcmp(lights, v->light, (size_t)n * sizeof *lights))
        return RELUME_OK;
    relume_status status = keep_lights(v, lights, n);
    if (!status)
        status = v->painter.paint(&image, v->painter.user, lights, n);
    if (status)
        return status;
    if (!v->target.texture)
        status = target_create(&v->target, gl, image.width, image.height, log);
    if (!status)
        target_write(&v->target, gl, &image);
    v->fresh = !status;
    relume_image_destroy(&image);
    return status;
}

void painted_view_destroy(struct painted_view *v, const struct gl *gl)
{
    target_destroy(&v->target, gl);
    free(v->light);
    *v = (struct painted_view){.lights = 0};
}
