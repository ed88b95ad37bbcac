// texel.c - light on its way to one texel
#include "world/bake/texel.h"

#include "core/base/memory.h"
#include "core/math/random.h"
#include "material/surface/texels.h"
#include "world/object/drawn_objects.h"

#include <math.h>
#include <string.h>

// Values hold n.l, the shares of rays too.
static const double GRAZING = 0.05;

relume_status scratch_make(struct texel_scratch *out, const struct baking *b)
{
    const size_t views = (size_t)b->views * 3;
    out->samples = mem_array((b->fixed ? 1 : (size_t)b->lights) * views, sizeof *out->samples);
    out->vector = mem_array(baking_length(b), sizeof *out->vector);
    return out->samples && out->vector ? RELUME_OK : RELUME_ENOMEM;
}

void scratch_free(struct texel_scratch *s)
{
    mem_free(s->samples);
    mem_free(s->vector);
}

// ---------------------------------------------------------------- the place

// Steps of a texel of the atlas in the texture of the material.
static void find_steps(struct surface_point *p, const struct baking *b,
                       const struct atlas_corner corner[3])
{
    const struct relume_objects_info *i = &b->o->info;
    const uint32_t *v = i->triangles[p->triangle];
    double e[2][2], f[2][2];
    for (int k = 0; k < 2; k++) {
        const double side[2] = {b->atlas.width, b->atlas.height};
        for (int a = 0; a < 2; a++) {
            e[k][a] = (double)(corner[k + 1].place[a] - corner[0].place[a]) * side[a];
            f[k][a] = (double)(i->vertices[v[k + 1]].texture[a] - i->vertices[v[0]].texture[a]);
        }
    }
    const double area = e[0][0] * e[1][1] - e[0][1] * e[1][0];
    for (int a = 0; a < 2 && fabs(area) > 1e-12; a++) {
        p->right[a] = (f[0][a] * e[1][1] - f[1][a] * e[0][1]) / area;
        p->down[a] = (f[1][a] * e[0][0] - f[0][a] * e[1][0]) / area;
    }
}

void texel_point(struct surface_point *out, const struct baking *b, uint32_t texel)
{
    const struct atlas_texel *t = &b->atlas.texel[texel];
    const struct trace_hit hit = {.triangle = t->triangle, .u = t->u, .v = t->v};
    objects_point(out, b->o, &hit, vec3_of(0, 0, 0));
    find_steps(out, b, b->triangle[t->triangle]);
}

static vec3 across(const struct surface_point *p)
{
    return vec3_cross(p->normal, p->tangent);
}

static bool is_mirrored(const struct surface_point *p)
{
    return vec3_dot(across(p), p->bitangent) < 0.0;
}

// A view of the map, and a direction of the world, in the frame of the material. Of a mirrored
// texture it is left-handed, the map's never.
static vec3 view_local(const struct surface_point *p, int side, int number)
{
    const vec3 v = view_direction(side, number);
    return vec3_of(v.x, is_mirrored(p) ? -v.y : v.y, v.z);
}

static vec3 local(const struct surface_point *p, vec3 d)
{
    return vec3_unit(
        vec3_of(vec3_dot(d, p->tangent), vec3_dot(d, p->bitangent), vec3_dot(d, p->normal)));
}

// What the material shows of light from there in all views: rgb[views][3].
static void material(float (*rgb)[3], const struct baking *b, const struct surface_point *p,
                     vec3 light)
{
    for (int v = 0; v < b->views; v++)
        objects_ask(rgb[v], b->o, p,
                    &(struct relume_btf_ray){.view = view_local(p, b->side, v), .light = light});
}

// ---------------------------------------------------------------- straight light

// What arrives of one of the lights; false: nothing.
static bool arrives(vec3 *towards, float arriving[3], const struct baking *b,
                    const struct surface_point *p, const struct relume_object_light *light)
{
    double distance;
    return relume_object_light_at(towards, arriving, &distance, light, p->position) &&
           vec3_dot(*towards, p->normal) > 0.0 &&
           objects_reached(b->o, p->lifted, p->geometric, *towards, distance);
}

static bool light_sample(float (*rgb)[3], const struct baking *b, const struct surface_point *p,
                         const struct relume_object_light *light)
{
    float arriving[3];
    vec3 towards;
    if (!arrives(&towards, arriving, b, p, light))
        return false;
    material(rgb, b, p, local(p, towards));
    for (int v = 0; v < b->views; v++)
        for (int c = 0; c < 3; c++)
            rgb[v][c] *= arriving[c];
    return true;
}

static const struct convolved *convolved_of(const struct baking *b, const struct surface_point *p)
{
    return b->convolved ? b->convolved[b->o->part[p->part].material] : NULL;
}

static void show_at_once(float *out, const struct baking *b, const struct surface_point *p,
                         const struct convolved *c)
{
    float light[CONVOLVE_COUNT][3] = {{0.0f}}, arriving[3];
    for (int i = 0; i < b->lights; i++) {
        vec3 towards;
        if (arrives(&towards, arriving, b, p, &b->light[i]))
            convolved_add(light, local(p, towards), arriving);
    }
    convolved_show(out, c, p->s, p->t, is_mirrored(p), light);
}

relume_status texel_direct(float *out, const struct baking *b, const struct surface_point *p,
                           struct texel_scratch *s)
{
    const size_t views = (size_t)b->views * 3;
    if (b->fixed) {
        memset(out, 0, views * sizeof *out);
        if (convolved_of(b, p))
            show_at_once(out, b, p, convolved_of(b, p));
        for (int i = 0; i < b->lights && !convolved_of(b, p); i++)
            if (light_sample((float(*)[3])s->samples, b, p, &b->light[i]))
                for (size_t k = 0; k < views; k++)
                    out[k] += s->samples[k];
        return RELUME_OK;
    }
    for (int i = 0; i < b->lights; i++) {
        float *at = s->samples + (size_t)i * views;
        if (!light_sample((float(*)[3])at, b, p, &b->light[i]))
            memset(at, 0, views * sizeof *at);
    }
    return basis_analyse(out, b->basis, s->samples, b->views);
}

// ---------------------------------------------------------------- light from surfaces

// Direction i of n, spread as the cosine to the normal (Hammersley's points, turned by the key).
static vec3 ray_direction(const struct surface_point *p, int i, int n, const double turned[2])
{
    double radical = 0.0, part = 0.5;
    for (unsigned bits = (unsigned)i; bits; bits >>= 1, part *= 0.5)
        radical += bits & 1u ? part : 0.0;
    const double u = fmod((i + 0.5) / n + turned[0], 1.0), w = fmod(radical + turned[1], 1.0);
    const double r = sqrt(u), phi_rad = 2.0 * M_PI * w;
    const vec3 flat =
        vec3_along(vec3_scale(p->tangent, r * cos(phi_rad)), across(p), r * sin(phi_rad));
    return vec3_along(flat, p->normal, sqrt(fmax(1.0 - u, 0.0)));
}

static vec3 position(const struct atlas_corner *c)
{
    return vec3_of((double)c->position[0], (double)c->position[1], (double)c->position[2]);
}

// Which of the used texels lies where a ray from the outside meets a surface; UINT32_MAX: it goes
// on into the distance, or meets one from behind.
static uint32_t meet(const struct baking *b, vec3 origin, vec3 direction)
{
    const float from[3] = {(float)origin.x, (float)origin.y, (float)origin.z};
    const float along[3] = {(float)direction.x, (float)direction.y, (float)direction.z};
    struct trace_hit hit;
    if (!trace_closest(b->o->tracer, from, along, &hit))
        return UINT32_MAX;
    const struct atlas_corner *c = b->triangle[hit.triangle];
    const vec3 first = position(&c[0]);
    const vec3 normal =
        vec3_cross(vec3_sub(position(&c[1]), first), vec3_sub(position(&c[2]), first));
    if (!(vec3_dot(normal, direction) < 0.0))
        return UINT32_MAX;
    int at[2];
    const int side[2] = {b->atlas.width, b->atlas.height};
    for (int a = 0; a < 2; a++) {
        const double place = (double)((1.0f - hit.u - hit.v) * c[0].place[a] +
                                      hit.u * c[1].place[a] + hit.v * c[2].place[a]);
        at[a] = (int)fmin(fmax(floor(place * side[a]), 0.0), side[a] - 1.0);
    }
    return b->number[(size_t)at[1] * (size_t)b->atlas.width + (size_t)at[0]];
}

static void add_row(float *out, const float factor[3], const float *row, int count)
{
    for (size_t k = 0; k < (size_t)count; k++)
        for (size_t c = 0; c < 3; c++)
            out[3 * k + c] += factor[c] * row[3 * k + c];
}

// Likewise, in harmonics.
static void add_to_light(float light[][3], const struct baking *b, const struct surface_point *p,
                         vec3 towards, const float *row)
{
    const vec3 direction = local(p, towards);
    const float share = (float)(1.0 / (b->rays * fmax(direction.z, GRAZING)));
    const float rgb[3] = {share * row[0], share * row[1], share * row[2]};
    convolved_add(light, direction, rgb);
}

// In all views what comes along one ray.
static void add_ray(float *out, const struct baking *b, const struct surface_point *p, vec3 towards,
                    const float *row)
{
    const vec3 light = local(p, towards);
    const float share = (float)(1.0 / (b->rays * fmax(light.z, GRAZING)));
    float rgb[3];
    for (int v = 0; v < b->views; v++, out += 3 * (size_t)b->count) {
        objects_ask(rgb, b->o, p,
                    &(struct relume_btf_ray){.view = view_local(p, b->side, v), .light = light});
        for (int c = 0; c < 3; c++)
            rgb[c] *= share;
        add_row(out, rgb, row, b->count);
    }
}

void texel_gather(float *out, const struct baking *b, const struct surface_point *p, uint32_t texel,
                  const float *from)
{
    struct random random = random_stream(1, texel, 0);
    const double turned[2] = {random_next(&random), random_next(&random)};
    const size_t row = 3 * (size_t)b->count;
    const vec3 origin = point_leave(p);
    const struct convolved *c = convolved_of(b, p);
    float albedo[3], light[CONVOLVE_COUNT][3] = {{0.0f}};
    objects_ask(albedo, b->o, p,
                &(struct relume_btf_ray){.view = vec3_of(0, 0, 1), .light = vec3_of(0, 0, 1)});
    for (int i = 0; i < 3; i++)
        albedo[i] /= (float)b->rays;
    for (int i = 0; i < b->rays; i++) {
        const vec3 towards = ray_direction(p, i, b->rays, turned);
        const uint32_t met =
            vec3_dot(towards, p->geometric) > 0.0 ? meet(b, origin, towards) : UINT32_MAX;
        if (met == UINT32_MAX)
            continue;
        if (b->matte)
            add_row(out, albedo, from + met * row, b->count);
        else if (c)
            add_to_light(light, b, p, towards, from + met * row);
        else
            add_ray(out, b, p, towards, from + met * row);
    }
    if (c && !b->matte)
        convolved_show(out, c, p->s, p->t, is_mirrored(p), light);
}

void texel_mean(float *out, const struct baking *b, const float *vector)
{
    const size_t row = 3 * (size_t)b->count;
    const bool rim = b->side == 2;  // a map of corners, which are all alike
    double sum = 0.0;
    memset(out, 0, row * sizeof *out);
    for (int v = 0; v < b->views; v++) {
        const double s = b->side > 1 ? 2.0 * (v % b->side) / (b->side - 1) - 1.0 : 0.0;
        const double t = b->side > 1 ? 2.0 * (v / b->side) / (b->side - 1) - 1.0 : 0.0;
        const double q = s * s + t * t;
        if (!(q < 1.0) && !rim)
            continue;
        // n.v times the solid angle of a piece of the map
        const double weight = rim ? 1.0 : (1.0 - q) / pow(1.0 + q, 3.0);
        sum += weight;
        for (size_t k = 0; k < row; k++)
            out[k] += (float)weight * vector[(size_t)v * row + k];
    }
    for (size_t k = 0; k < row; k++)
        out[k] /= (float)sum;
}
