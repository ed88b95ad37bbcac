// own_looks.c - materials that the file of a mesh names itself: glTF's, or those of an OBJ's
// library
#include "base/log.h"
#include "base/memory.h"
#include "object/object.h"

#include <string.h>

// Metal as smooth as this mirrors.
static const float MIRROR_METAL = 0.95f, MIRROR_ROUGHNESS = 0.1f;

static relume_status load_picture(struct relume_image *out, const struct mesh_picture *picture,
                                  bool colour, const char *path,
                                  const struct relume_objects_params *params)
{
    const bool numbered = picture->name[0] == '*';  // within the model
    char *name =
        picture->bytes ? mem_format("%s, picture %s", path, picture->name + numbered) : NULL;
    const struct relume_reader reader = relume_memory_reader(picture->bytes, picture->size);
    const relume_status status =
        picture->bytes && !name
            ? RELUME_ENOMEM
            : relume_image_load(
                  out, name ? name : picture->name,
                  relume_image_params(.log = params->log, .limits = params->limits,
                                      .transfer = {.curve = colour ? RELUME_CURVE_AUTO
                                                                   : RELUME_CURVE_LINEAR},
                                      .reader = picture->bytes ? &reader : NULL));
    mem_free(name);
    return status;
}

static relume_status load_pictures(struct relume_image picture[2], const struct mesh_file *file,
                                   const struct mesh_look *look, const char *path,
                                   const struct relume_objects_params *params)
{
    relume_status status = RELUME_OK;
    if (look->picture >= 0)
        status = load_picture(&picture[0], &file->pictures[look->picture], true, path, params);
    if (!status && look->surface >= 0)
        status = load_picture(&picture[1], &file->pictures[look->surface], false, path, params);
    return status;
}

static relume_status paint(relume_btf_fitted **out, const struct mesh_file *file,
                           const struct mesh_look *look, const char *path,
                           const struct relume_objects_params *params)
{
    struct relume_image picture[2] = {{0}, {0}};
    relume_status status = load_pictures(picture, file, look, path, params);
    if (!status) {
        struct relume_btf_paint_params p =
            *relume_btf_paint_params(.log = params->log, .threads = params->threads,
                                     .roughness = look->roughness, .metallic = look->metallic,
                                     .colour = picture[0].data ? &picture[0] : NULL,
                                     .surface = picture[1].data ? &picture[1] : NULL);
        memcpy(p.factor, look->colour, sizeof p.factor);
        status = relume_btf_paint(out, &p);
    }
    relume_image_destroy(&picture[0]);
    relume_image_destroy(&picture[1]);
    return status;
}

static bool is_mirror(const struct mesh_look *look)
{
    return look->metallic >= MIRROR_METAL && look->roughness <= MIRROR_ROUGHNESS &&
           look->picture < 0 && look->surface < 0;
}

// White where colours of vertices are all that the file has.
static struct mesh_look look_of(const struct mesh_file *file, int part)
{
    const struct mesh_look white = {
        .colour = {1, 1, 1}, .roughness = 1, .picture = -1, .surface = -1};
    return file->look[part].given ? file->look[part] : white;
}

// One that is there already: the same mesh may stand in several places.
static bool find(int *number, const relume_objects *o, const char *folder)
{
    for (*number = 0; *number < o->info.materials; ++*number)
        if (o->folder[*number] && !strcmp(o->folder[*number], folder))
            return true;
    return false;
}

static relume_status add(relume_objects *o, const struct mesh_file *file, int part,
                         const char *path, char *folder, const struct relume_objects_params *params)
{
    const struct mesh_look look = look_of(file, part);
    relume_btf_fitted *model;
    relume_status status = objects_need_material(o, path, params->log);
    char *name = status ? NULL : mem_text(file->part[part]);
    if (!name) {
        mem_free(folder);
        return status ? status : RELUME_ENOMEM;
    }
    struct relume_object_material *m = &o->material[o->info.materials];
    *m = (struct relume_object_material){
        .name = name, .model = "mirror", .mirror = is_mirror(&look)};
    o->folder[o->info.materials++] = folder;
    memcpy(m->reflectance, look.colour, sizeof m->reflectance);
    if (m->mirror)
        return RELUME_OK;
    status = paint(&model, file, &look, path, params);
    return status ? status : objects_take_model(m, model, params->log);
}

relume_status objects_own_look(relume_objects *o, const struct mesh_file *file, int part,
                               const char *path, int *number,
                               const struct relume_objects_params *params)
{
    if (!file->look[part].given && !file->colour)
        return log_fail(params->log, RELUME_EUNFIT,
                        "%s: part '%s' has no material, here or in the description", path,
                        file->part[part]);
    char *folder = mem_format("%s: %d", path, part);
    if (!folder)
        return RELUME_ENOMEM;
    if (find(number, o, folder)) {
        mem_free(folder);
        return RELUME_OK;
    }
    return add(o, file, part, path, folder, params);
}
