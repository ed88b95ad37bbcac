// lamps.c - lights that stand in the frame, so that they can dazzle
#include <relume/glare.h>

#include "math/vec.h"

#include <math.h>

// Where the frame shows a direction, pixel centres at + 0.5. False behind the eye.
static bool place(double xy[2], const struct relume_image *frame, const struct relume_sight *s,
                  vec3 towards)
{
    const double depth = vec3_dot(towards, s->ahead);
    const double half = tan(0.5 * s->fov_deg * M_PI / 180.0);
    if (!(depth > 1e-6))
        return false;
    xy[0] = 0.5 * frame->width * (1.0 + vec3_dot(towards, s->right) / (depth * half));
    xy[1] = 0.5 * frame->height - 0.5 * frame->width * vec3_dot(towards, s->up) / (depth * half);
    return true;
}

// The solid angle of a pixel at a place: cos^3 of the angle from the middle times that of the
// middle.
static double solid_angle(const struct relume_image *frame, const struct relume_sight *s,
                          double depth)
{
    const double pixel = 2.0 * tan(0.5 * s->fov_deg * M_PI / 180.0) / frame->width;
    return pixel * pixel * depth * depth * depth;
}

static bool add_light(struct relume_image *frame, double x, double y, const float rgb[3],
                      double scale)
{
    const double left = floor(x - 0.5), top = floor(y - 0.5);
    bool seen = false;
    for (int k = 0; k < 4; k++) {
        const double px = left + k % 2, py = top + k / 2;
        const double share = (1.0 - fabs(x - 0.5 - px)) * (1.0 - fabs(y - 0.5 - py));
        if (!(px >= 0.0 && px < frame->width && py >= 0.0 && py < frame->height))
            continue;
        float *const to = frame->data + 3 * ((size_t)py * (size_t)frame->width + (size_t)px);
        for (int c = 0; c < 3; c++)
            to[c] += (float)(scale * share * (double)rgb[c]);
        seen = true;
    }
    return seen;
}

int relume_glare_lamps(struct relume_image *frame, const struct relume_sight *sight,
                       const struct relume_light *lights, int n)
{
    int seen = 0;
    for (int i = 0; i < n; i++) {
        const struct relume_light *const l = &lights[i];
        vec3 towards = l->direction;
        float rgb[3] = {l->rgb[0], l->rgb[1], l->rgb[2]};
        double xy[2];
        if (l->kind == RELUME_LIGHT_ENVIRONMENT || l->kind == RELUME_LIGHT_AREA)
            continue;
        if (relume_light_is_near(l->kind) && !relume_light_at(&towards, rgb, l, sight->eye))
            continue;
        towards = vec3_unit(towards);
        if (!place(xy, frame, sight, towards))
            continue;
        // A light of value 1 sends pi to the square unit that faces it.
        const double omega = solid_angle(frame, sight, vec3_dot(towards, sight->ahead));
        seen += add_light(frame, xy[0], xy[1], rgb, M_PI / omega);
    }
    return seen;
}
