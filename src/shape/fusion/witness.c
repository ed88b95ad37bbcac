// witness.c - a view with depth: how far a place lies before or behind what it sees
#include "shape/fusion/witness.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "image/geometry/geometry.h"

static float depth_at(const struct witness *s, int x, int y)
{
    return s->depth.data[(size_t)y * (size_t)s->depth.width + (size_t)x];
}

bool witness_place(vec3 *place, const struct witness *s, int x, int y)
{
    const double d = (double)depth_at(s, x, y);
    if (!isfinite(d))
        return false;
    const struct camera_ray ray = camera_ray_at(&s->camera, x + 0.5, y + 0.5);
    *place = vec3_along(ray.origin, ray.direction, d);
    return true;
}

// Two neighbours along an axis, or one and the pixel itself.
static bool tangent(vec3 *out, const struct witness *s, int x, int y, int dx, int dy)
{
    const double JUMP = 1.3;
    const double d = (double)depth_at(s, x, y);
    vec3 end[2];
    for (int i = 0; i < 2; i++) {
        const int px = x + (i ? dx : -dx), py = y + (i ? dy : -dy);
        const bool in =
            px >= 0 && py >= 0 && px < s->depth.width && py < s->depth.height &&
            relume_geometry_shows(&s->camera.geometry, s->camera.width, s->camera.height, px, py);
        const double other = in ? (double)depth_at(s, px, py) : (double)INFINITY;
        const bool near = other < d * JUMP && d < other * JUMP;
        if (!witness_place(&end[i], s, near ? px : x, near ? py : y))
            return false;
    }
    *out = vec3_sub(end[1], end[0]);
    return vec3_length(*out) > 0.0;
}

static void slope_row(void *context, size_t row, int worker)
{
    (void)worker;
    const struct witness *s = context;
    const double LEAST = 0.05;  // depth is worth little where it is seen from the side
    const int y = (int)row;
    for (int x = 0; x < s->depth.width; x++) {
        float *out = s->cosine + row * (size_t)s->depth.width + (size_t)x;
        vec3 right, down;
        *out = 0.0f;
        if (!isfinite(depth_at(s, x, y)))
            continue;
        *out = (float)LEAST;
        if (!tangent(&right, s, x, y, 1, 0) || !tangent(&down, s, x, y, 0, 1))
            continue;
        const vec3 normal = vec3_cross(right, down);
        const struct camera_ray ray = camera_ray_at(&s->camera, x + 0.5, y + 0.5);
        if (vec3_length(normal) > 0.0)
            *out = (float)fmax(LEAST, fabs(vec3_dot(vec3_unit(normal), ray.direction)));
    }
}

relume_status witness_create(struct witness *out, const struct camera *camera,
                             struct relume_image *depth, double farthest, int threads)
{
    const size_t pixels = (size_t)depth->width * (size_t)depth->height;
    *out = (struct witness){.camera = *camera, .depth = *depth};
    *depth = (struct relume_image){0};
    out->cosine = mem_array(pixels, sizeof *out->cosine);
    if (!out->cosine) {
        witness_destroy(out);
        return RELUME_ENOMEM;
    }
    for (size_t i = 0; i < pixels; i++) {
        const int x = (int)(i % (size_t)out->depth.width), y = (int)(i / (size_t)out->depth.width);
        float *d = &out->depth.data[i];
        if (!(*d > 0.0f) ||
            !relume_geometry_shows(&camera->geometry, camera->width, camera->height, x, y))
            *d = NAN;
        else if ((double)*d > farthest)
            *d = INFINITY;
    }
    thread_for(threads, (size_t)out->depth.height, slope_row, out);
    return RELUME_OK;
}

void witness_destroy(struct witness *s)
{
    relume_image_destroy(&s->depth);
    mem_free(s->cosine);
    s->cosine = NULL;
}

// Between four pixels where they see one surface, else that of the nearest.
static double surface_at(const struct witness *s, const double xy[2], int x, int y, double step)
{
    const double u = xy[0] - 0.5, v = xy[1] - 0.5;
    const int left = relume_whole(floor(u)), top = relume_whole(floor(v));
    const double near = (double)depth_at(s, x, y), a = u - left, b = v - top;
    if (left < 0 || top < 0 || left + 1 >= s->depth.width || top + 1 >= s->depth.height)
        return near;
    double sum = 0.0;
    for (int i = 0; i < 4; i++) {
        const double d = (double)depth_at(s, left + (i & 1), top + (i >> 1));
        if (!(fabs(d - near) <= step))  // also for NaN
            return near;
        sum += (i & 1 ? a : 1.0 - a) * (i >> 1 ? b : 1.0 - b) * d;
    }
    return sum;
}

bool witness_ask(struct sighting *out, const struct witness *s, vec3 place, double step)
{
    double distance;
    if (!camera_project(out->xy, &distance, &s->camera, place))
        return false;
    const int x = relume_whole(floor(out->xy[0])), y = relume_whole(floor(out->xy[1]));
    if (x < 0 || y < 0 || x >= s->depth.width || y >= s->depth.height || isnan(depth_at(s, x, y)))
        return false;
    const bool nothing = isinf(depth_at(s, x, y));
    out->cosine = nothing ? 1.0 : (double)s->cosine[(size_t)y * (size_t)s->depth.width + (size_t)x];
    out->along =
        nothing ? (double)-INFINITY : distance - surface_at(s, out->xy, x, y, step / out->cosine);
    out->distance = out->along * out->cosine;
    return true;
}

void witness_light(float rgb[3], const struct witness *s, const struct relume_image *relit,
                   const double xy[2], double step)
{
    const int x = relume_whole(floor(xy[0])), y = relume_whole(floor(xy[1]));
    const double near = (double)depth_at(s, x, y);
    const struct bilinear b =
        bilinear_at(xy[0] - 0.5, xy[1] - 0.5, relit->width, relit->height, EDGE_CLAMPED);
    double sum[3] = {0}, all = 0.0;
    for (int i = 0; i < 4; i++) {
        const double d = (double)s->depth.data[b.at[i]];
        const double weight = fabs(d - near) <= step ? bilinear_share(&b, i, 1.0) : 0.0;
        for (size_t c = 0; weight > 0.0 && c < 3; c++)
            sum[c] += weight * (double)relit->data[3 * b.at[i] + c];
        all += weight;
    }
    for (size_t c = 0; c < 3; c++)
        rgb[c] = all > 0.0 ? (float)(sum[c] / all)
                           : relit->data[3 * ((size_t)y * (size_t)relit->width + (size_t)x) + c];
}
