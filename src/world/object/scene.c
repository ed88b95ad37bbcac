// scene.c - the scene that objects stand in: which way it faces, what reaches it past them
#include "world/object/object.h"

#include "core/base/thread.h"
#include "shape/mesh/places.h"
#include "world/object/drawn_objects.h"

// From one pixel to the next: of the steps to both sides the shorter one, which stays on the
// surface.
static vec3 step_across(vec3 before, vec3 at, vec3 after)
{
    const vec3 back = vec3_sub(at, before), on = vec3_sub(after, at);
    const double b = vec3_length(back), o = vec3_length(on);
    const bool is_on = o > 0.0 && !(b > 0.0 && b < o);
    return is_on ? on : b > 0.0 ? back : vec3_of(0, 0, 0);
}

// The next place to one side. In an enlarged picture several pixels in a row show the same one.
static vec3 place_beside(const struct relume_image *places, int x, int y, int dx, int dy)
{
    enum { MOST = 64 };  // so far enlarged
    const vec3 at = places_at_xy(places, x, y);
    vec3 beside = at;
    for (int i = 0; i < MOST && at.x == beside.x && at.y == beside.y && at.z == beside.z; i++) {
        x += dx;
        y += dy;
        if (x < 0 || y < 0 || x >= places->width || y >= places->height)
            break;
        beside = places_at_xy(places, x, y);
    }
    return beside;
}

// Which way the scene faces in a pixel, from the places beside it; 0 where they are too far away.
vec3 scene_normal(const struct relume_image *places, int x, int y)
{
    const vec3 at = places_at_xy(places, x, y);
    const vec3 across =
        step_across(place_beside(places, x, y, -1, 0), at, place_beside(places, x, y, 1, 0));
    const vec3 down =
        step_across(place_beside(places, x, y, 0, -1), at, place_beside(places, x, y, 0, 1));
    const vec3 normal = vec3_cross(down, across);
    return vec3_length(normal) > 0.0 ? vec3_unit(normal) : vec3_of(0, 0, 0);
}

// What a light sample among several of one light counts for in a pixel: its value times n.l.
static double counts_for(const struct relume_object_light *light_sample, vec3 towards, vec3 normal)
{
    const float *rgb = light_sample->is_patch ? light_sample->patch.rgb : light_sample->light.rgb;
    const bool unknown = vec3_length(normal) == 0.0;
    return (double)(rgb[0] + rgb[1] + rgb[2]) *
           (unknown ? 1.0 : fmax(vec3_dot(normal, towards), 0.0));
}

// One light sample does or does not.
double scene_share(const relume_objects *o, const struct relume_object_light *light_sample, int n,
                   vec3 place, vec3 normal, int every, uint64_t key)
{
    double sent = 0.0, arrived = 0.0;
    for (int i = (int)(key % (uint64_t)every); i < n; i += every) {
        float unused[3];
        double distance;
        vec3 towards;
        (void)relume_object_light_at(&towards, unused, &distance, &light_sample[i], place);
        const double value = n > 1 ? counts_for(&light_sample[i], towards, normal) : 1.0;
        sent += value;
        if (value > 0.0 && objects_reached(o, place, vec3_of(0, 0, 0), towards, distance))
            arrived += value;
    }
    return sent > 0.0 ? arrived / sent : 1.0;
}

static void add_row(void *context, size_t row, int worker)
{
    (void)worker;
    const struct scene_in_shadow *s = context;
    const size_t width = (size_t)s->sum->width;
    for (size_t x = 0; x < width; x++) {
        const size_t pixel = row * width + x;
        const float *lone = s->lone->data + 3 * pixel;
        const bool lit = lone[0] != 0.0f || lone[1] != 0.0f || lone[2] != 0.0f;
        const vec3 at = places_at(s->places, pixel);
        const double part = lit && !s->none && !isnan(at.x)
                                ? scene_share(s->o, s->light_sample, s->light_samples, at,
                                              scene_normal(s->places, (int)x, (int)row), 1, 0)
                                : 1.0;
        for (size_t c = 0; c < 3; c++)
            s->sum->data[3 * pixel + c] += (float)(part * (double)lone[c]);
    }
}

void scene_add(const struct scene_in_shadow *s, int threads)
{
    thread_for(threads, (size_t)s->sum->height, add_row, (void *)s);
}
