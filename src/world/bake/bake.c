// bake.c - objects become a baked one: straight light and what goes from surface to surface at
// every texel, then compression
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "relight/light/environment.h"
#include "world/bake/compress.h"
#include "world/object/drawn_objects.h"

#include <string.h>

// ---------------------------------------------------------------- what is asked for

static int or_default(int value, int usual)
{
    return value ? value : usual;
}

static bool power_of_two(int n)
{
    return n > 0 && !(n & (n - 1));
}

static bool within(int value, int low, int high)
{
    return value >= low && value <= high;
}

static relume_status check_ranges(const struct relume_bake_params *p)
{
    const struct {
        const char *what;
        int value, low, high;
    } ranges[] = {
        {"texels across the atlas", p->width, 4, 8192},
        {"rows of the atlas", p->height, 4, 8192},
        {"a side of the map of views", p->side, 0, RELUME_BAKED_MOST_SIDE},
        {"wavelets of a face that are kept", p->kept, 1,
         RELUME_BAKED_MOST_CUBE * RELUME_BAKED_MOST_CUBE},
        {"clusters", p->clusters, 1, RELUME_BAKED_MOST_CLUSTERS},
        {"components", p->components, 1, RELUME_BAKED_MOST_COMPONENTS},
        {"bounces", p->bounces, 0, 64},
        {"rays from each texel", p->rays, 1, 65536},
        {"fixed lights", p->fixed ? p->fixed_count : 1, 1, 65536},
    };
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        if (!within(ranges[i].value, ranges[i].low, ranges[i].high))
            return log_fail(p->log, RELUME_EINVAL, "baking: %s: %d; expected %d to %d",
                            ranges[i].what, ranges[i].value, ranges[i].low, ranges[i].high);
    return RELUME_OK;
}

// What light of all kinds becomes: a cube, or a basis.
static relume_status check_light(const struct relume_bake_params *p)
{
    const struct relume_log *log = p->log;
    const int most_lights = limits_or_default(limits_of(NULL, log)).max_lights;
    if (p->cube)
        return power_of_two(p->cube) && within(p->cube, 2, RELUME_BAKED_MOST_CUBE)
                   ? RELUME_OK
                   : log_fail(log, RELUME_EINVAL,
                              "the cube of lights: expected 2, 4, 8, 16 or 32 texels a side; found "
                              "%d",
                              p->cube);
    if (p->basis->learned || p->basis->upper_only || p->basis->joint)
        return log_fail(log, RELUME_EINVAL,
                        "basis %s cannot hold light from all sides; expected sh or table",
                        p->basis->name);
    if (!within(p->coefficients, 1, RELUME_MOST_COEFFICIENTS) ||
        !p->basis->has_count(p->coefficients))
        return log_fail(log, RELUME_EINVAL,
                        "baking: basis %s cannot have %d coefficients; expected %s, at most %d",
                        p->basis->name, p->coefficients,
                        p->basis == &relume_basis_sh ? "1, 4, 9, 16, 25, ..." : "another number",
                        RELUME_MOST_COEFFICIENTS);
    return within(p->lights, p->coefficients, most_lights)
               ? RELUME_OK
               : log_fail(log, RELUME_EINVAL,
                          "baking: light from %d directions; expected as many as there are "
                          "coefficients, %d, to %d",
                          p->lights, p->coefficients, most_lights);
}

static relume_status check(const struct relume_bake_params *p)
{
    const relume_status status = check_ranges(p);
    return status || p->fixed ? status : check_light(p);
}

static int usual_lights(int coefficients)
{
    const int enough = coefficients < 1024 / 12 ? 12 * coefficients : 1024;
    return enough > coefficients ? enough : coefficients;
}

static struct relume_bake_params complete(const struct relume_bake_params *params)
{
    struct relume_bake_params p = PARAMS_WORK(relume_bake_params, params);
    const bool table = p.basis == &relume_basis_table;
    p.basis = p.basis ? p.basis : &relume_basis_sh;
    p.lights = or_default(p.lights, table ? or_default(p.coefficients, 256) : 0);
    p.coefficients = table ? p.lights : or_default(p.coefficients, 36);
    p.lights = or_default(p.lights, usual_lights(p.coefficients));
    p.kept = or_default(p.kept, 20);
    p.width = or_default(p.width, 256);
    p.height = or_default(p.height, p.width);
    p.clusters = or_default(p.clusters, 128);
    p.components = or_default(p.components, p.fixed ? 4 : 8);
    p.bounces = p.bounces ? p.bounces : 2;
    p.bounces = p.bounces < 0 ? 0 : p.bounces;
    p.rays = or_default(p.rays, 64);
    return p;
}

// ---------------------------------------------------------------- the objects

static relume_status check_materials(bool *matte, const relume_objects *o,
                                     const struct relume_log *log)
{
    *matte = true;
    for (int i = 0; i < o->info.parts; i++) {
        const struct relume_object_material *m = &o->material[o->part[i].material];
        if (m->mirror)
            return log_fail(log, RELUME_EUNFIT,
                            "part '%s' is a mirror; only surfaces that scatter light can be baked",
                            o->part[i].name);
        if (!m->surface)
            return log_fail(log, RELUME_EUNFIT, "part '%s' is baked already", o->part[i].name);
        if (m->translucent)
            log_line(log, RELUME_WARNING, "part '%s' is translucent; it is baked as a matte one",
                     o->part[i].name);
        *matte = *matte && m->fitted && !strcmp(m->model, "lit");
    }
    return RELUME_OK;
}

static void set_corner(struct atlas_corner *to, const struct relume_mesh_vertex *v)
{
    memcpy(to->position, v->position, sizeof to->position);
    memcpy(to->normal, v->normal, sizeof to->normal);
    memcpy(to->place, v->texture, sizeof to->place);
}

static relume_status find_texels(struct baking *b)
{
    const struct relume_objects_info *info = &b->o->info;
    const size_t texels = (size_t)b->atlas.width * (size_t)b->atlas.height;
    for (size_t i = 0; i < info->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            set_corner(&b->triangle[i][k], &info->vertices[info->triangles[i][k]]);
    const relume_status status = atlas_make(&b->atlas, b->triangle, info->triangle_count,
                                            b->atlas.width, b->atlas.height, 0.0, b->log);
    if (status)
        return status;
    b->used = mem_array(b->atlas.used, sizeof *b->used);
    b->number = mem_array(texels, sizeof *b->number);
    if (!b->used || !b->number)
        return RELUME_ENOMEM;
    uint32_t n = 0;
    for (size_t i = 0; i < texels; i++) {
        const bool is = b->atlas.texel[i].triangle != UINT32_MAX;
        b->number[i] = is ? n : UINT32_MAX;
        if (is)
            b->used[n++] = (uint32_t)i;
    }
    return n ? RELUME_OK
             : log_fail(b->log, RELUME_EUNFIT, "the objects cover no texel of the atlas");
}

// ---------------------------------------------------------------- lights

enum { SKY = 1024 };  // lamps that a fixed environment becomes

static relume_status add_fixed(struct baking *b, const struct relume_light *light)
{
    struct relume_object_light *own = NULL, *grown;
    struct relume_light *lamp = NULL;
    int n = SKY;
    relume_status status = RELUME_OK;
    if (light->kind == RELUME_LIGHT_ENVIRONMENT) {
        lamp = mem_array(SKY, sizeof *lamp);
        status = lamp ? relume_environment_sample(lamp, SKY, light, 0) : RELUME_ENOMEM;
    } else {
        status = relume_objects_lights(&own, &n, b->o, light, 1);
    }
    grown = status ? NULL : mem_resize(b->light, (size_t)(b->lights + n), sizeof *grown);
    if (grown) {
        b->light = grown;
        for (int i = 0; i < n; i++)
            grown[b->lights++] = own ? own[i] : (struct relume_object_light){.light = lamp[i]};
    }
    relume_free(own);
    mem_free(lamp);
    return status ? status : grown ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status find_lights(struct baking *b, const struct relume_bake_params *p)
{
    relume_status status = RELUME_OK;
    for (int i = 0; i < p->fixed_count && p->fixed && !status; i++)
        status = relume_light_check(&p->fixed[i], "light", p->log);
    for (int i = 0; i < p->fixed_count && p->fixed && !status; i++)
        status = add_fixed(b, &p->fixed[i]);
    if (p->fixed || status)
        return status;
    b->lights = b->basis->directions;
    b->light = mem_zeroed((size_t)b->lights, sizeof *b->light);
    for (int i = 0; b->light && i < b->lights; i++)
        b->light[i].light = (struct relume_light){.kind = RELUME_LIGHT_DIRECTIONAL,
                                                  .direction = b->basis->direction[i],
                                                  .rgb = {1.0f, 1.0f, 1.0f}};
    return b->light ? RELUME_OK : RELUME_ENOMEM;
}

// Materials at once under light from all sides, where there are more texels of the atlas than of
// the material.
static relume_status find_convolved(struct baking *b, const struct relume_bake_params *p)
{
    const uint64_t MOST = (uint64_t)1 << 30;
    const relume_objects *o = b->o;
    relume_status status = RELUME_OK;
    if (!p->fixed || b->matte || p->light_by_light)
        return RELUME_OK;
    b->convolved = mem_zeroed((size_t)o->info.materials, sizeof(struct convolved *));
    if (!b->convolved)
        return RELUME_ENOMEM;
    for (int i = 0; i < o->info.parts && !status; i++) {
        const int m = o->part[i].material;
        const struct relume_object_material *from = &o->material[m];
        if (!b->convolved[m] && (size_t)from->width * (size_t)from->height < b->atlas.used)
            status = convolved_create(&b->convolved[m], from->surface, from->width, from->height,
                                      b->side, MOST, b->threads);
    }
    return status;
}

// ---------------------------------------------------------------- all of it

static void baking_free(struct baking *b)
{
    atlas_free(&b->atlas);
    mem_free(b->used);
    mem_free(b->number);
    mem_free(b->light);
    for (int i = 0; b->convolved && i < b->o->info.materials; i++)
        convolved_destroy(&b->convolved[i]);
    mem_free(b->convolved);
    mem_free(b->sent);
    mem_free(b->bounced);
}

static relume_status begin(struct baking *b, relume_baked *out, const relume_objects *o,
                           const struct relume_bake_params *p)
{
    *b = (struct baking){.o = o,
                         .basis = &out->basis,
                         .atlas = {.width = p->width, .height = p->height},
                         .fixed = p->fixed != NULL,
                         .rays = p->rays,
                         .bounces = p->bounces,
                         .threads = p->threads,
                         .log = p->log};
    relume_status status = check_materials(&b->matte, o, p->log);
    b->side = or_default(p->side, b->matte ? 1 : p->fixed ? 16 : 8);
    b->views = b->side * b->side;
    b->matte = b->matte && b->side == 1;
    if (!status && !p->fixed)
        status = basis_make(&out->basis, p->basis, p->coefficients, p->cube, p->lights, p->log);
    if (p->fixed)
        out->basis.count = 1;
    b->count = out->basis.count;
    b->triangle = out->triangle = mem_array(o->info.triangle_count, sizeof *out->triangle);
    if (!status && !b->triangle)
        status = RELUME_ENOMEM;
    if (!status)
        status = find_lights(b, p);
    if (!status)
        status = find_texels(b);
    return status ? status : find_convolved(b, p);
}

static void describe(relume_baked *out, const struct baking *b, const struct relume_bake_params *p)
{
    out->info = (struct relume_baked_info){
        .fixed = b->fixed,
        .basis = b->fixed || p->cube ? NULL : p->basis,
        .coefficients = b->count,
        .cube = b->fixed ? 0 : p->cube,
        .width = p->width,
        .height = p->height,
        .texels = b->atlas.used,
        .side = b->side,
        .clusters = p->clusters,
        .components = p->components,
        .per_view = p->per_view && b->views > 1,
        .bounces = p->bounces,
        .triangles = b->o->info.triangle_count,
    };
    const int face = p->cube * p->cube;
    out->info.kept = out->info.cube ? (p->kept < face ? p->kept : face) : 0;
    out->kept = out->info.cube ? 6 * out->info.kept : b->count;
    out->blocks = out->info.per_view ? b->views : 1;
    out->views = b->views / out->blocks;
}

relume_status relume_bake(relume_baked **out, const relume_objects *objects,
                          const struct relume_bake_params *params)
{
    const struct relume_bake_params p = complete(params);
    struct baking b = {.o = NULL};
    *out = NULL;
    relume_status status = check(&p);
    if (status)
        return status;
    relume_baked *baked = mem_zeroed(1, sizeof *baked);
    status = baked ? begin(&b, baked, objects, &p) : RELUME_ENOMEM;
    if (!status) {
        describe(baked, &b, &p);
        b.taught = bake_count_taught(baked, &b);
        status = baked_check_file(baked, p.log);
    }
    if (!status)
        status = bake_bounces(&b);
    if (!status)
        status = bake_compress(baked, &b);
    baking_free(&b);
    if (status)
        relume_baked_destroy(&baked);
    *out = baked;
    return status;
}
