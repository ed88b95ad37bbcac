// own_looks.c - materials that the file of a mesh names itself: glTF's, or those of an OBJ's
// library
#include "core/base/log.h"
#include "core/base/memory.h"
#include "material/btf/values.h"
#include "world/object/skin.h"

#include <string.h>

static const float PLAIN_GREY = 0.6f;  // linear

// Metal as smooth as this mirrors.
static const float MIRROR_METAL = 0.95f, MIRROR_ROUGHNESS = 0.1f;

enum picture_use { COLOURS, WITH_ALPHA, NUMBERS };

static relume_status load_picture(struct relume_image *out, const struct mesh_picture *picture,
                                  enum picture_use use, const char *path,
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
                                      .channels = use == WITH_ALPHA ? 4 : 3,
                                      .transfer = {.curve = use == NUMBERS ? RELUME_CURVE_LINEAR
                                                                           : RELUME_CURVE_AUTO},
                                      .reader = picture->bytes ? &reader : NULL));
    mem_free(name);
    return status;
}

// The pictures of a look; empty where it has none.
struct pictures {
    struct relume_image colour, opaque, surface, normals, emitted;
};

static void forget_pictures(struct pictures *p)
{
    struct relume_image *const all[] = {&p->colour, &p->opaque, &p->surface, &p->normals,
                                        &p->emitted};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        relume_image_destroy(all[i]);
}

static const struct relume_image *if_any(const struct relume_image *image)
{
    return image->data ? image : NULL;
}

// Four channels become a colour and an opacity.
static relume_status split(struct pictures *p, const struct relume_image *both)
{
    const size_t pixels = (size_t)both->width * (size_t)both->height;
    relume_status status = relume_image_create(&p->colour, both->width, both->height, 3);
    if (!status)
        status = relume_image_create(&p->opaque, both->width, both->height, 1);
    for (size_t i = 0; i < pixels && !status; i++) {
        memcpy(p->colour.data + 3 * i, both->data + 4 * i, 3 * sizeof *both->data);
        p->opaque.data[i] = both->data[4 * i + 3];
    }
    return status;
}

static relume_status load_colour(struct pictures *p, const struct mesh_file *file,
                                 const struct mesh_look *look, const char *path,
                                 const struct relume_objects_params *params)
{
    const struct mesh_picture *picture = &file->pictures[look->picture];
    struct relume_image both = {0};
    if (look->cover == MESH_WHOLE)
        return load_picture(&p->colour, picture, COLOURS, path, params);
    relume_status status = load_picture(&both, picture, WITH_ALPHA, path, params);
    if (!status)
        status = split(p, &both);
    relume_image_destroy(&both);
    return status;
}

static bool sends(const struct mesh_look *look)
{
    return look->emission[0] + look->emission[1] + look->emission[2] > 0.0f;
}

static relume_status load_pictures(struct pictures *p, const struct mesh_file *file,
                                   const struct mesh_look *look, const char *path,
                                   const struct relume_objects_params *params)
{
    relume_status status = RELUME_OK;
    if (look->picture >= 0)
        status = load_colour(p, file, look, path, params);
    if (!status && look->surface >= 0)
        status = load_picture(&p->surface, &file->pictures[look->surface], NUMBERS, path, params);
    if (!status && look->normal >= 0 && look->bump != 0.0f)
        status = load_picture(&p->normals, &file->pictures[look->normal], NUMBERS, path, params);
    if (!status && look->emitted >= 0 && sends(look))
        status = load_picture(&p->emitted, &file->pictures[look->emitted], COLOURS, path, params);
    return status;
}

static relume_status paint(relume_btf_fitted **out, const struct pictures *p,
                           const struct mesh_look *look, const struct relume_objects_params *params)
{
    struct relume_btf_paint_params paint =
        *relume_btf_paint_params(.log = params->log, .threads = params->threads,
                                 .roughness = look->roughness, .metallic = look->metallic,
                                 .colour = if_any(&p->colour), .surface = if_any(&p->surface),
                                 .normals = if_any(&p->normals), .bump = look->bump);
    memcpy(paint.factor, look->colour, sizeof paint.factor);
    return relume_btf_paint(out, &paint);
}

static bool needs_skin(const struct mesh_look *look)
{
    return look->cover != MESH_WHOLE || sends(look);
}

static relume_status add_skin(struct relume_object_material *m, const struct pictures *p,
                              const struct mesh_look *look,
                              const struct relume_objects_params *params)
{
    static const enum relume_object_cover cover[] = {[MESH_WHOLE] = RELUME_COVER_WHOLE,
                                                     [MESH_CUT] = RELUME_COVER_CUT,
                                                     [MESH_BLENDED] = RELUME_COVER_BLENDED};
    struct skin_factors f = {.cover = cover[look->cover],
                             .cutoff = look->cutoff,
                             .opacity = look->opacity,
                             .opaque = if_any(&p->opaque),
                             .emitted = if_any(&p->emitted)};
    memcpy(f.emission, look->emission, sizeof f.emission);
    return needs_skin(look) ? skin_make(&m->skin, &f, params->threads) : RELUME_OK;
}

static bool is_mirror(const struct mesh_look *look)
{
    return look->metallic >= MIRROR_METAL && look->roughness <= MIRROR_ROUGHNESS &&
           !mesh_look_has_picture(look) && !needs_skin(look);
}

// White where colours of vertices are all that the file has.
static struct mesh_look look_of(const struct mesh_file *file, int part)
{
    return file->look[part].given ? file->look[part] : mesh_look_white();
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
    struct pictures pictures = {.colour = {0}};
    status = load_pictures(&pictures, file, &look, path, params);
    if (!status)
        status = paint(&model, &pictures, &look, params);
    if (!status)
        status = objects_take_model(m, model, params->log);
    if (!status)
        status = add_skin(m, &pictures, &look, params);
    forget_pictures(&pictures);
    return status;
}

void objects_plain_look(struct mesh_file *file, const char *path, const struct relume_log *log)
{
    struct mesh_look grey = mesh_look_white();
    bool any = false;
    grey.colour[0] = grey.colour[1] = grey.colour[2] = PLAIN_GREY;
    for (int i = 0; i < file->parts && !file->colour; i++)
        if (!file->look[i].given) {
            file->look[i] = grey;
            any = true;
        }
    if (any)
        log_line(log, RELUME_NOTE, "%s: names no material; shown in matte grey", path);
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
