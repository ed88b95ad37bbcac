// seen.c - what leaves translucent bodies, for the pixels of a picture (Menzel 2010, chapter 7.3):
// found at some of them, and in between where its neighbours are alike
//
// From a coarse grid to the next finer one each pixel lies between four that are known. It takes
// from them what leaves it unless something of this holds: they are not all of its body; one is
// before or behind its surface; the mean of their normals is short; one is darker or brighter than
// their mean.
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "world/object/object.h"

enum { COARSEST = 16 };
static const double NORMALS = 0.9, LIGHT = 0.1;  // the length of their mean; a part of the mean

struct seen_pixel {
    int body;  // -1: none
    float place[3], normal[3];
    float leaves[3];
};
struct seen {
    const struct lighting *lighting;
    struct seen_pixel *pixel;
    int width, height;
    // While it is made.
    const relume_objects *o;
    pixel_ray *ray;
    const void *context;
    int step, first;
};

static struct seen_pixel *pixel_at(const struct seen *s, int x, int y)
{
    return &s->pixel[(size_t)y * (size_t)s->width + (size_t)x];
}

static void find_place(struct seen *s, int x, int y)
{
    struct seen_pixel *p = pixel_at(s, x, y);
    const struct ray ray = s->ray(s->context, x + 0.5, y + 0.5);
    struct surface_point point;
    p->body = -1;
    if (!objects_hit(&point, s->o, ray.origin, ray.direction))
        return;
    p->body = translucent_body(s->lighting, point.part);
    vec3_store(p->place, point.position);
    vec3_store(p->normal, point.normal);
}

static void find_row(void *context, size_t item, int worker)
{
    (void)worker;
    struct seen *s = context;
    for (int x = 0; x < s->width; x++)
        find_place(s, x, (int)item);
}

// Whether a pixel's neighbour belongs to the same piece of the surface.
static bool is_near(const struct seen_pixel *p, const struct seen_pixel *other)
{
    const double STEEP = 0.5;
    const vec3 to = vec3_sub(vec3_floats(other->place), vec3_floats(p->place));
    return other->body == p->body &&
           fabs(vec3_dot(to, vec3_floats(p->normal))) <= STEEP * vec3_length(to);
}

static bool are_alike(const struct seen_pixel *const four[4])
{
    vec3 normal = {0, 0, 0};
    for (int i = 0; i < 4; i++)
        normal = vec3_along(normal, vec3_floats(four[i]->normal), 0.25);
    if (vec3_length(normal) < NORMALS)
        return false;
    for (int c = 0; c < 3; c++) {
        double mean = 0.0, most = 0.0;
        for (int i = 0; i < 4; i++)
            mean += 0.25 * (double)four[i]->leaves[c];
        for (int i = 0; i < 4; i++)
            most = fmax(most, fabs((double)four[i]->leaves[c] - mean));
        if (most > LIGHT * mean)
            return false;
    }
    return true;
}

static bool interpolate(struct seen *s, int x, int y)
{
    const int coarse = 2 * s->step, left = x - x % coarse, top = y - y % coarse;
    struct seen_pixel *p = pixel_at(s, x, y);
    if (coarse > COARSEST || left + coarse >= s->width || top + coarse >= s->height)
        return false;
    const struct seen_pixel *const four[4] = {
        pixel_at(s, left, top), pixel_at(s, left + coarse, top), pixel_at(s, left, top + coarse),
        pixel_at(s, left + coarse, top + coarse)};
    for (int i = 0; i < 4; i++)
        if (!is_near(p, four[i]))
            return false;
    if (!are_alike(four))
        return false;
    const float u = (float)(x - left) / (float)coarse, v = (float)(y - top) / (float)coarse;
    for (int c = 0; c < 3; c++)
        p->leaves[c] = (1.0f - v) * ((1.0f - u) * four[0]->leaves[c] + u * four[1]->leaves[c]) +
                       v * ((1.0f - u) * four[2]->leaves[c] + u * four[3]->leaves[c]);
    return true;
}

static void fill_row(void *context, size_t item, int worker)
{
    (void)worker;
    struct seen *s = context;
    const int y = (s->first + (int)item) * s->step, coarse = 2 * s->step;
    for (int x = 0; x < s->width; x += s->step) {
        struct seen_pixel *p = pixel_at(s, x, y);
        const bool known = coarse <= COARSEST && x % coarse == 0 && y % coarse == 0;
        if (known || p->body < 0 || interpolate(s, x, y))
            continue;
        translucent_leaves(p->leaves, s->lighting, p->body, vec3_floats(p->place),
                           vec3_floats(p->normal));
    }
}

static relume_status fill(struct seen *s, const struct relume_render_params *params)
{
    enum { AT_ONCE = 32 };
    for (s->step = COARSEST; s->step; s->step /= 2) {
        const int rows = (s->height + s->step - 1) / s->step;
        for (s->first = 0; s->first < rows; s->first += AT_ONCE) {
            const int left = rows - s->first;
            thread_for(params->threads, (size_t)(left < AT_ONCE ? left : AT_ONCE), fill_row, s);
            if (!log_progress(params->log, "light leaves objects", (double)s->first / rows))
                return RELUME_ECANCEL;
        }
    }
    return RELUME_OK;
}

relume_status seen_create(struct seen **out, const relume_objects *o,
                          const struct lighting *lighting, int width, int height, pixel_ray *ray,
                          const void *context, const struct relume_render_params *params)
{
    *out = NULL;
    if (!lighting_scatters(lighting))
        return RELUME_OK;
    struct seen *s = mem_zeroed(1, sizeof *s);
    if (!s)
        return RELUME_ENOMEM;
    *s = (struct seen){.lighting = lighting,
                       .pixel = mem_zeroed((size_t)width * (size_t)height, sizeof *s->pixel),
                       .width = width,
                       .height = height,
                       .o = o,
                       .ray = ray,
                       .context = context};
    relume_status status = s->pixel ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        thread_for(params->threads, (size_t)height, find_row, s);
        status = fill(s, params);
    }
    if (status)
        seen_destroy(&s);
    *out = s;
    return status;
}

void seen_destroy(struct seen **s)
{
    if (*s)
        mem_free((*s)->pixel);
    mem_free(*s);
    *s = NULL;
}

bool seen_shade(float rgb[3], const struct seen *s, const struct surface_point *point, vec3 eye,
                double x, double y)
{
    if (!s)
        return false;
    const struct seen_pixel *p = pixel_at(s, (int)x, (int)y);
    struct seen_pixel here = {.body = translucent_body(s->lighting, point->part)};
    vec3_store(here.place, point->position);
    vec3_store(here.normal, point->normal);
    if (here.body < 0 || !is_near(&here, p) ||
        vec3_dot(vec3_floats(p->normal), point->normal) < NORMALS)
        return false;
    for (int c = 0; c < 3; c++)
        rgb[c] = p->leaves[c] * (float)translucent_lets_out(s->lighting, here.body, point, eye);
    return true;
}
