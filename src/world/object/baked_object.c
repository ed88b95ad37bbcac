// baked_object.c - baked objects (bake.h) among the others: in the world, under its lights
//
// What they do to themselves is in their numbers; others still stand before lamps.
#include "world/object/object.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "world/object/drawn_objects.h"
#include "world/object/baked_object.h"

#include <string.h>

// ---------------------------------------------------------------- in the world

static void add_triangle(relume_objects *o, const struct atlas_corner corner[3],
                         const struct frame *frame)
{
    uint32_t made[3];
    vec3 p[3];
    for (int k = 0; k < 3; k++)
        p[k] = vec3_floats(corner[k].position);
    if (!(vec3_length(vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]))) > 0.0))
        return;
    for (int k = 0; k < 3; k++)
        made[k] = objects_vertex(
            o, frame_point(frame, p[k]), frame_normal(frame, vec3_floats(corner[k].normal)),
            vec3_of((double)corner[k].place[0], (double)corner[k].place[1], 0), NULL);
    mesh_triangle(&o->mesh, made[0], made[1], made[2], (uint32_t)o->info.parts - 1);
}

relume_status objects_add_baked(relume_objects *o, const char *path, const struct frame *frame,
                                const struct relume_objects_params *params)
{
    relume_baked *baked = NULL;
    int number;
    relume_status status = relume_baked_open(&baked, path, params ? params->limits : NULL,
                                             params ? params->log : NULL);
    if (!status)
        status = objects_take_baked(o, &baked, path, frame, &number, params);
    relume_baked_destroy(&baked);
    char *name = status ? NULL : mem_text("baked");
    if (status || !name || !mem_grow(&o->part, (size_t)o->info.parts, sizeof *o->part)) {
        mem_free(name);
        return status ? status : RELUME_ENOMEM;
    }
    const relume_baked *b = o->material[number].baked;
    o->part[o->info.parts++] = (struct relume_object_part){.name = name,
                                                           .material = number,
                                                           .bilinear = true,
                                                           .first = o->mesh.triangle_count,
                                                           .object = o->info.objects++};
    for (size_t i = 0; i < b->info.triangles; i++)
        add_triangle(o, b->triangle[i], frame);
    o->part[o->info.parts - 1].count = o->mesh.triangle_count - o->part[o->info.parts - 1].first;
    return o->mesh.failed ? RELUME_ENOMEM : RELUME_OK;
}

// ---------------------------------------------------------------- light

// Whether anything but the part itself lies on the way; what is baked into it is known.
static bool reached_past(const relume_objects *o, const struct surface_point *p, vec3 towards,
                         double distance)
{
    enum { MOST = 64 };  // of its own triangles
    const vec3 start = point_leave(p);
    float from[3] = {(float)start.x, (float)start.y, (float)start.z};
    const float along[3] = {(float)towards.x, (float)towards.y, (float)towards.z};
    struct trace_hit hit;
    for (int i = 0; i < MOST && o->info.parts > 1; i++) {
        if (!trace_closest(o->tracer, from, along, &hit) || !((double)hit.distance < distance))
            return true;
        if ((int)o->mesh.triangles[hit.triangle].material != p->part)
            return false;
        // off that triangle on its far side
        struct surface_point met;
        float at[3], off[3];
        objects_point(&met, o, &hit, towards);
        at[0] = (float)met.position.x, at[1] = (float)met.position.y, at[2] = (float)met.position.z;
        off[0] = -(float)met.geometric.x, off[1] = -(float)met.geometric.y,
        off[2] = -(float)met.geometric.z;
        trace_leave(at, off, from);
        distance -= (double)hit.distance;
    }
    return true;
}

static bool arrives(const relume_objects *o, const struct surface_point *p,
                    const struct lighting *l, vec3 towards, double distance)
{
    bool is = l->no_shadows || reached_past(o, p, towards, distance);
    for (int i = 0; i < l->sceneries && is && !l->no_shadows; i++)
        is = scenery_reached(l->scenery[i], scenery_leave(l->scenery[i], p->lifted, p->geometric),
                             towards, distance);
    return is;
}

// Which share of a distant light reaches the point past others, by the samples of that light.
static void find_share(float share[3], const relume_objects *o, const struct surface_point *p,
                       const struct lighting *l, int number)
{
    float sent[3] = {0.0f, 0.0f, 0.0f}, arrived[3] = {0.0f, 0.0f, 0.0f};
    share[0] = share[1] = share[2] = 1.0f;
    if (l->no_shadows || (o->info.parts < 2 && !l->sceneries))
        return;
    for (int i = 0; i < l->light_samples; i++) {
        const struct relume_object_light *sample = &l->light_sample[i];
        const double cosine = vec3_dot(sample->light.direction, p->normal);
        if (sample->number != number || !(cosine > 0.0))
            continue;
        const bool is = arrives(o, p, l, sample->light.direction, INFINITY);
        for (int c = 0; c < 3; c++) {
            sent[c] += (float)cosine * sample->light.rgb[c];
            arrived[c] += is ? (float)cosine * sample->light.rgb[c] : 0.0f;
        }
    }
    for (int c = 0; c < 3; c++)
        share[c] = sent[c] > 0.0f ? arrived[c] / sent[c] : 1.0f;
}

static struct baked_look look_at(const struct standing_baked *b, const struct surface_point *p,
                                 vec3 eye)
{
    return (struct baked_look){{p->s, p->t},
                               frame_turned_back(&b->frame, vec3_sub(eye, p->position))};
}

static void add_near(float rgb[3], const relume_objects *o, const struct surface_point *p,
                     const struct lighting *l, const struct standing_baked *b,
                     const struct baked_look *look, const struct relume_object_light *sample)
{
    float arriving[3], shown[3];
    double distance;
    vec3 towards;
    if (!relume_object_light_at(&towards, arriving, &distance, sample, p->position) ||
        !arrives(o, p, l, towards, distance))
        return;
    baked_lamp(shown, b->baked, look, frame_turned_back(&b->frame, towards), arriving);
    for (int c = 0; c < 3; c++)
        rgb[c] += shown[c];
}

static bool is_near(const struct relume_object_light *sample)
{
    return sample->is_patch || relume_light_is_near(sample->light.kind);
}

bool baked_shade(float rgb[3], const relume_objects *o, const struct surface_point *p, vec3 eye,
                 const struct lighting *l)
{
    const int material = o->part[p->part].material;
    const struct standing_baked *b = &o->standing[material];
    if (!b->baked)
        return false;
    const struct baked_look look = look_at(b, p, eye);
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    for (int i = 0; i < (b->baked->info.fixed ? 1 : l->surround.lights); i++) {
        const baked_lit *lit = l->baked[(size_t)i * (size_t)l->materials + (size_t)material];
        float shown[3], share[3] = {1.0f, 1.0f, 1.0f};
        if (!lit)
            continue;
        lit_colour(shown, b->baked, lit, &look);
        if (!b->baked->info.fixed)
            find_share(share, o, p, l, i);
        for (int c = 0; c < 3; c++)
            rgb[c] += share[c] * shown[c];
    }
    for (int i = 0; i < l->light_samples && !b->baked->info.fixed; i++)
        if (is_near(&l->light_sample[i]))
            add_near(rgb, o, p, l, b, &look, &l->light_sample[i]);
    return true;
}

bool baked_return(float rgb[3], const relume_objects *o, const struct surface_point *p, vec3 eye,
                  const struct arrival *arrival)
{
    const double GRAZING = 0.05;  // values hold n.l, the arrival's share too
    const struct standing_baked *b = &o->standing[o->part[p->part].material];
    const double cosine = vec3_dot(arrival->towards, p->normal);
    float light[3];
    if (!b->baked)
        return false;
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (!(cosine > 0.0))
        return true;
    for (int c = 0; c < 3; c++)
        light[c] = (float)(arrival->share / fmax(cosine, GRAZING)) * arrival->with[c];
    const struct baked_look look = look_at(b, p, eye);
    baked_lamp(rgb, b->baked, &look, frame_turned_back(&b->frame, arrival->towards), light);
    return true;
}

// ---------------------------------------------------------------- for other renderers

bool relume_objects_baked(struct relume_baked_arrays *out, const relume_objects *o, int material)
{
    if (material < 0 || material >= o->info.materials || !o->standing[material].baked)
        return false;
    const struct standing_baked *s = &o->standing[material];
    const relume_baked *b = s->baked;
    *out = (struct relume_baked_arrays){
        .cluster = b->cluster,
        .weight = b->weight,
        .frame = (const float(*)[6])b->frame,
        .vectors = b->vectors,
        .blocks = b->blocks,
        .views = b->views,
        .axis = {vec3_unit(s->frame.x), vec3_unit(s->frame.y), vec3_unit(s->frame.z)},
    };
    return true;
}

// A light as it shines on the middle of the objects, and whether it does. RELUME_ENOMEM.
static relume_status from_afar(struct relume_light *out, bool *shines, const relume_objects *o,
                               const struct relume_light *light)
{
    const vec3 middle = vec3_scale(vec3_add(o->info.min, o->info.max), 0.5);
    struct relume_object_light *sample;
    int n;
    *out = *light;
    *shines = !relume_light_is_near(light->kind);
    if (*shines)
        return RELUME_OK;
    *out = (struct relume_light){.kind = RELUME_LIGHT_DIRECTIONAL, .direction = {0, 0, 0}};
    const relume_status status = relume_objects_lights(&sample, &n, o, light, 1);
    if (status)
        return status;
    for (int i = 0; i < n; i++) {
        float rgb[3];
        double distance;
        vec3 towards;
        if (!relume_object_light_at(&towards, rgb, &distance, &sample[i], middle))
            continue;
        *shines = true;
        out->direction = vec3_along(out->direction, towards, (double)(rgb[0] + rgb[1] + rgb[2]));
        for (int c = 0; c < 3; c++)
            out->rgb[c] += rgb[c];
    }
    relume_free(sample);
    *shines = *shines && vec3_length(out->direction) > 0.0;
    return RELUME_OK;
}

relume_status relume_objects_baked_colours(float (**out)[3], const relume_objects *o, int material,
                                           const struct relume_light *lights, int n)
{
    struct relume_baked_arrays a;
    int used = 0;
    *out = NULL;
    if (!relume_objects_baked(&a, o, material))
        return RELUME_EINVAL;
    const struct standing_baked *s = &o->standing[material];
    struct relume_light *far = mem_array((size_t)n, sizeof *far);
    relume_status status = far ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; i < n && !status; i++) {
        bool shines;
        status = from_afar(&far[used], &shines, o, &lights[i]);
        used += !status && shines;
    }
    baked_lit *lit;
    if (!status)
        status = lit_create(&lit, s->baked, &s->frame, far, used, 0);
    mem_free(far);
    if (status)
        return status;
    *out = lit_take(&lit);
    return RELUME_OK;
}

// ---------------------------------------------------------------- the lights of a lighting

relume_status lighting_bakes(struct lighting *l, const relume_objects *o, int threads)
{
    const struct relume_light *lights = l->surround.light;
    const int n = l->surround.lights;
    relume_status status = RELUME_OK;
    l->baked_count = (size_t)(n > 1 ? n : 1) * (size_t)l->materials;
    l->baked = mem_zeroed(l->baked_count, sizeof(baked_lit *));
    if (!l->baked)
        return RELUME_ENOMEM;
    for (int m = 0; m < l->materials; m++) {
        const struct standing_baked *b = &o->standing[m];
        if (!b->baked)
            continue;
        if (b->baked->info.fixed)
            status = lit_create(&l->baked[m], b->baked, &b->frame, NULL, 0, threads);
        for (int i = 0; i < n && !status && !b->baked->info.fixed; i++)
            if (!relume_light_is_near(lights[i].kind))
                status = lit_create(&l->baked[(size_t)i * (size_t)l->materials + (size_t)m],
                                    b->baked, &b->frame, &lights[i], 1, threads);
        if (status)
            return status;
    }
    return RELUME_OK;
}

void lighting_bakes_free(struct lighting *l)
{
    for (size_t i = 0; l->baked && i < l->baked_count; i++)
        lit_destroy(&l->baked[i]);
    mem_free(l->baked);
}
