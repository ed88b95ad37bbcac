// objects.c - objects: their materials, their life
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/tree.h"
#include "material/btf/values.h"
#include "world/object/drawn_objects.h"
#include "world/object/levels.h"
#include "world/object/object.h"
#include "world/object/skin.h"
#include "world/reflect/reflection.h"
#include "world/transport/dipole.h"

#include <relume/exchange.h>
#include <string.h>

enum { MOST_MATERIALS = 1024 };

static void close_material(struct relume_object_material *m)
{
    relume_btf_fitted *model = NULL;  // a surface that has a map owns its model
    if (m->surface && !m->mapped)
        model = (relume_btf_fitted *)relume_btf_surface_info(m->surface)->model;
    relume_btf_surface_destroy((relume_btf_surface **)&m->surface);
    relume_btf_fitted_destroy(&model);
    relume_btf_destroy((relume_btf **)&m->btf);
    skin_destroy(&m->skin);
    mem_free((void *)m->name);
}

static void destroy_surface(relume_objects *o)
{
    trace_destroy(&o->tracer);
    mesh_free(&o->mesh);
    mem_free(o->tint);
    mem_free(o->vertices);
    mem_free(o->triangles);
    mem_free(o->part);
    mem_free(o->choice);
    mem_free(o->fold);
}

void relume_objects_destroy(relume_objects **objects)
{
    relume_objects *o = *objects;
    *objects = NULL;
    if (!o)
        return;
    for (int i = 0; i < o->info.parts && !o->shown_of; i++)
        mem_free((void *)o->part[i].name);
    destroy_surface(o);
    if (o->shown_of) {
        mem_free(o);
        return;
    }
    for (int i = 0; i < o->clouds; i++) {
        relume_billboards_free((struct relume_billboards *)o->cloud[i].cloud);
        mem_free((void *)o->cloud[i].cloud);
    }
    mem_free(o->cloud);
    for (int i = 0; i < o->info.materials; i++) {
        close_material(&o->material[i]);
        relume_baked_destroy(&o->standing[i].baked);
        mem_free(o->folder[i]);
    }
    for (int i = 0; o->reflection && i < o->info.objects; i++)
        relume_reflection_destroy(&o->reflection[i]);
    for (int i = 0; o->levels && i < o->info.objects; i++)
        object_levels_free(&o->levels[i]);
    mem_free(o->levels);
    mem_free(o->wanted);
    mem_free(o->reflection);
    mem_free(o->vertex_tint);
    mem_free(o->material);
    mem_free(o->folder);
    mem_free(o->translucent);
    mem_free(o->standing);
    mem_free(o);
}

const struct relume_objects_info *relume_objects_info(const relume_objects *objects)
{
    return &objects->info;
}

relume_status relume_objects_choose(relume_objects *objects, int part, int material)
{
    if (part < 0 || part >= objects->info.parts || material < 0 ||
        material >= objects->info.materials)
        return RELUME_EINVAL;
    objects->part[part].material = material;
    return RELUME_OK;
}

// ---------------------------------------------------------------- materials

// The last word of a path.
static char *name_of(const char *folder)
{
    size_t end = strlen(folder);
    while (end > 1 && folder[end - 1] == '/')
        end--;
    size_t start = end;
    while (start > 0 && folder[start - 1] != '/')
        start--;
    return mem_format("%.*s", (int)(end - start), folder + start);
}

static relume_status open_surface(struct relume_object_material *m, const char *folder,
                                  const struct relume_btf_params *p)
{
    relume_btf_surface *surface;
    const relume_status status = relume_btf_surface_open(&surface, folder, p);
    m->surface = surface;
    m->mapped = true;
    if (status)
        return status;
    const struct relume_btf_surface_info *info = relume_btf_surface_info(surface);
    m->fitted = info->model;
    m->model = relume_btf_model_name(relume_btf_fitted_info(info->model)->model);
    m->width = info->width, m->height = info->height;
    m->bytes = info->bytes;
    return RELUME_OK;
}

// The sample alone as a surface, which takes over the model.
static relume_status cover_whole(struct relume_object_material *m, relume_btf_fitted *model,
                                 const struct relume_log *log)
{
    relume_btf_surface *surface;
    const relume_status status = relume_btf_surface_create(&surface, model, NULL, log);
    m->surface = surface;
    if (status)
        relume_btf_fitted_destroy(&model);
    return status;
}

relume_status objects_take_model(struct relume_object_material *m, relume_btf_fitted *fitted,
                                 const struct relume_log *log)
{
    const relume_status status = cover_whole(m, fitted, log);
    if (status)
        return status;
    const struct relume_btf_fitted_info *info = relume_btf_fitted_info(fitted);
    m->fitted = fitted;
    m->model = relume_btf_model_name(info->model);
    m->width = info->width, m->height = info->height;
    m->bytes = info->bytes_levels;
    return RELUME_OK;
}

static relume_status open_model(struct relume_object_material *m, const char *folder,
                                const struct relume_btf_params *p)
{
    relume_btf_fitted *fitted;
    const relume_status status = relume_btf_fitted_open(&fitted, folder, p);
    return status ? status : objects_take_model(m, fitted, p->log);
}

static relume_status open_measured(struct relume_object_material *m, const char *folder,
                                   const struct relume_btf_params *p)
{
    relume_btf *btf;
    relume_btf_fitted *values;
    relume_status status = relume_btf_open(&btf, folder, p);
    m->btf = btf;
    if (!status)
        status = relume_btf_as_model(&values, btf, p->log);
    if (!status)
        status = cover_whole(m, values, p->log);
    if (status)
        return status;
    const struct relume_btf_info *i = relume_btf_info(btf);
    m->width = i->width, m->height = i->height;
    m->bytes = relume_btf_bytes(i->width, i->height, i->views, i->lights);
    return RELUME_OK;
}

static relume_status open_material(struct relume_object_material *m, const char *folder,
                                   const struct relume_objects_params *params)
{
    const struct relume_btf_params p = {
        .log = params ? params->log : NULL,
        .limits = params ? params->limits : NULL,
        .scratch = params ? params->scratch : NULL,
        .threads = params ? params->threads : 0,
    };
    *m = (struct relume_object_material){.name = name_of(folder), .model = "measured"};
    if (!m->name)
        return RELUME_ENOMEM;
    const enum relume_kind kind = relume_kind_of(folder);
    return kind == RELUME_KIND_SURFACE                               ? open_surface(m, folder, &p)
           : kind == RELUME_KIND_FITTED || path_ends(folder, ".exr") ? open_model(m, folder, &p)
                                                                     : open_measured(m, folder, &p);
}

relume_status objects_need_material(relume_objects *o, const char *name,
                                    const struct relume_log *log)
{
    const size_t count = (size_t)o->info.materials;
    if (o->info.materials == MOST_MATERIALS)
        return log_fail(log, RELUME_ELIMIT, "%s: expected at most %d materials", name,
                        MOST_MATERIALS);
    if (!mem_grow(&o->material, count, sizeof *o->material) ||
        !mem_grow(&o->folder, count, sizeof *o->folder) ||
        !mem_grow(&o->translucent, count, sizeof *o->translucent) ||
        !mem_grow(&o->standing, count, sizeof *o->standing))
        return RELUME_ENOMEM;
    o->standing[count] = (struct standing_baked){.baked = NULL};
    o->translucent[count] = (struct translucent){.name = NULL};
    return RELUME_OK;
}

relume_status objects_material(relume_objects *o, const char *folder, int *number,
                               const struct relume_objects_params *params)
{
    for (*number = 0; *number < o->info.materials; ++*number)
        if (o->folder[*number] && !strcmp(o->folder[*number], folder))
            return RELUME_OK;
    relume_status status = objects_need_material(o, folder, params ? params->log : NULL);
    if (status)
        return status;
    o->folder[*number] = mem_text(folder);
    status = open_material(&o->material[*number], folder, params);
    if (!status && !o->folder[*number])
        status = RELUME_ENOMEM;
    o->info.materials++;  // destroyed with the others, also when it is broken
    return status;
}

// A material of a few numbers: one like it, or a new one.
static relume_status find_reflectance(struct relume_object_material **out, relume_objects *o,
                                      const struct relume_object_material *like, int *number,
                                      const struct relume_log *log)
{
    *out = NULL;
    for (*number = 0; *number < o->info.materials; ++*number) {
        const struct relume_object_material *m = &o->material[*number];
        if (m->mirror == like->mirror && !strcmp(m->name, like->name) && !o->folder[*number] &&
            !memcmp(m->reflectance, like->reflectance, sizeof m->reflectance))
            return RELUME_OK;
    }
    const relume_status status = objects_need_material(o, like->name, log);
    char *name = status ? NULL : mem_text(like->name);
    if (!name)
        return status ? status : RELUME_ENOMEM;
    struct relume_object_material *m = *out = &o->material[*number];
    *m = *like;
    m->name = name;
    o->folder[*number] = NULL;
    o->info.materials++;
    return RELUME_OK;
}

relume_status objects_mirror(relume_objects *o, const float reflectance[3], int *number,
                             const struct relume_objects_params *params)
{
    struct relume_object_material like = {.name = "mirror", .model = "mirror", .mirror = true};
    struct relume_object_material *added;
    memcpy(like.reflectance, reflectance, sizeof like.reflectance);
    return find_reflectance(&added, o, &like, number, params ? params->log : NULL);
}

// The model of a lit texture, fitted to one texel that is that matte.
static relume_status fit_matte(relume_btf_fitted **out, const float reflectance[3],
                               const struct relume_objects_params *params)
{
    const struct relume_btf_set *set = relume_btf_set_find("coarse");
    struct relume_vec3 *direction = mem_array((size_t)set->count, sizeof *direction);
    const struct relume_btf_params kept = {.scratch = params ? params->scratch : NULL};
    relume_btf *btf = NULL;
    if (!direction)
        return RELUME_ENOMEM;
    relume_btf_set_directions(set, direction);
    relume_status status = relume_btf_create(&btf,
                                             &(struct relume_btf_info){.name = "diffuse",
                                                                       .width = 1,
                                                                       .height = 1,
                                                                       .views = set->count,
                                                                       .lights = set->count,
                                                                       .view = direction,
                                                                       .light = direction},
                                             &kept);
    for (int v = 0; v < set->count && !status; v++)
        for (int l = 0; l < set->count; l++) {
            float rgb[3];
            for (int c = 0; c < 3; c++)
                rgb[c] = reflectance[c] * (float)direction[l].z;
            relume_btf_store(btf, v, l, rgb);
        }
    if (!status)
        status = relume_btf_fit(out, btf, relume_btf_model_find("lit"), NULL);
    relume_btf_destroy(&btf);
    mem_free(direction);
    return status;
}

relume_status objects_matte(relume_objects *o, const float reflectance[3], int *number,
                            const struct relume_objects_params *params)
{
    struct relume_object_material like = {.name = "diffuse"};
    struct relume_object_material *added;
    relume_btf_fitted *fitted = NULL;
    memcpy(like.reflectance, reflectance, sizeof like.reflectance);
    relume_status status = find_reflectance(&added, o, &like, number, params ? params->log : NULL);
    if (status || !added)
        return status;
    status = fit_matte(&fitted, reflectance, params);
    return status ? status : objects_take_model(added, fitted, params ? params->log : NULL);
}

static bool is_like(const struct translucent *a, const struct translucent *b)
{
    return a->name && !strcmp(a->name, b->name) && a->mm == b->mm &&
           !memcmp(&a->scattering, &b->scattering, sizeof a->scattering);
}

relume_status objects_translucent(relume_objects *o, const struct translucent *translucent,
                                  int *number, const struct relume_objects_params *params)
{
    const struct relume_log *log = params ? params->log : NULL;
    struct dipole d;
    float matte[3];
    relume_btf_fitted *fitted = NULL;
    for (*number = 0; *number < o->info.materials; ++*number)
        if (is_like(&o->translucent[*number], translucent))
            return RELUME_OK;
    dipole_make(&d, &translucent->scattering, 1.0);
    for (int c = 0; c < 3; c++)
        matte[c] = (float)(d.enters * dipole_disc(&d, c, INFINITY));
    relume_status status = objects_need_material(o, translucent->name, log);
    char *name = status ? NULL : mem_text(translucent->name);
    if (!name)
        return status ? status : RELUME_ENOMEM;
    struct relume_object_material *m = &o->material[*number];
    *m = (struct relume_object_material){.name = name, .translucent = true};
    memcpy(m->reflectance, matte, sizeof matte);
    o->folder[*number] = NULL;
    o->translucent[*number] = *translucent;
    o->info.materials++;
    status = fit_matte(&fitted, matte, params);
    return status ? status : objects_take_model(m, fitted, log);
}

relume_status objects_take_baked(relume_objects *o, relume_baked **baked, const char *path,
                                 const struct frame *frame, int *number,
                                 const struct relume_objects_params *params)
{
    const relume_status status = objects_need_material(o, path, params ? params->log : NULL);
    char *name = status ? NULL : name_of(path);
    if (!name)
        return status ? status : RELUME_ENOMEM;
    const struct relume_baked_info *info = relume_baked_info(*baked);
    *number = o->info.materials++;
    o->material[*number] = (struct relume_object_material){.name = name,
                                                           .model = "baked",
                                                           .width = info->width,
                                                           .height = info->height,
                                                           .bytes = info->bytes,
                                                           .baked = *baked};
    o->folder[*number] = NULL;
    o->standing[*number] = (struct standing_baked){*baked, *frame};
    *baked = NULL;
    return RELUME_OK;
}
