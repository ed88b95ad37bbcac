// exchange_request.c - a picture of light between a scene and objects, as it is asked for
#include "relit/exchange_request.h"

#include <stdlib.h>
#include <string.h>

void exchange_request_forget(struct exchange_request *q)
{
    free((void *)q->lights);
    *q = (struct exchange_request){.transport = NULL};
}

bool exchange_request_copy(struct exchange_request *out, const struct exchange_request *q)
{
    struct relume_light *lights = malloc(((size_t)q->count + 1) * sizeof *lights);
    if (!lights)
        return false;
    if (q->count)
        memcpy(lights, q->lights, (size_t)q->count * sizeof *lights);
    *out = *q;
    out->lights = lights;
    return true;
}

static bool same_vec(struct relume_vec3 a, struct relume_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static bool same_camera(const struct relume_camera *a, const struct relume_camera *b)
{
    return a->framing == b->framing && a->view == b->view && same_vec(a->eye, b->eye) &&
           a->through == b->through && a->width == b->width && a->height == b->height &&
           a->look_at.aimed == b->look_at.aimed && same_vec(a->look_at.at, b->look_at.at) &&
           same_vec(a->look_at.up, b->look_at.up) &&
           a->look_at.field_of_view_deg == b->look_at.field_of_view_deg &&
           a->look.pan_deg == b->look.pan_deg && a->look.tilt_deg == b->look.tilt_deg &&
           a->look.zoom == b->look.zoom && a->look.stereographic == b->look.stereographic;
}

bool exchange_same_way(const struct exchange_request *a, const struct exchange_request *b)
{
    return a->transport == b->transport && a->samples == b->samples && a->bounces == b->bounces;
}

bool exchange_same_eye(const struct exchange_request *a, const struct exchange_request *b)
{
    return exchange_same_way(a, b) && same_camera(&a->camera, &b->camera) &&
           a->interpolation == b->interpolation && a->aperture == b->aperture &&
           a->focus == b->focus;
}

bool exchange_same_request(const struct exchange_request *a, const struct exchange_request *b)
{
    return exchange_same_eye(a, b) && a->count == b->count &&
           (!a->count || !memcmp(a->lights, b->lights, (size_t)a->count * sizeof *a->lights));
}
