// objects.c - the description of objects in JSON, their materials, their life
#include "base/json.h"
#include "base/params.h"
#include "base/log.h"
#include "base/memory.h"
#include "mesh/mesh_read.h"
#include "object/object.h"
#include "transport/dipole.h"

#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { VERSION = 1, MOST_MATERIALS = 256, MOST_OBJECTS = 4096, MOST_COVERINGS = 1024 };

static void close_material(struct relume_object_material *m)
{
    relume_btf_fitted *model = NULL;  // a surface that has a map owns its model
    if (m->surface && !m->mapped)
        model = (relume_btf_fitted *)relume_btf_surface_info(m->surface)->model;
    relume_btf_surface_destroy((relume_btf_surface **)&m->surface);
    relume_btf_fitted_destroy(&model);
    relume_btf_destroy((relume_btf **)&m->btf);
    mem_free((void *)m->name);
}

void relume_objects_destroy(relume_objects **objects)
{
    relume_objects *o = *objects;
    *objects = NULL;
    if (!o)
        return;
    trace_destroy(&o->tracer);
    mesh_free(&o->mesh);
    for (int i = 0; i < o->info.parts; i++)
        mem_free((void *)o->part[i].name);
    for (int i = 0; i < o->info.materials; i++) {
        close_material(&o->material[i]);
        mem_free(o->folder[i]);
    }
    for (int i = 0; o->reflection && i < o->info.objects; i++)
        relume_reflection_destroy(&o->reflection[i]);
    mem_free(o->reflection);
    mem_free(o->vertices);
    mem_free(o->triangles);
    mem_free(o->part);
    mem_free(o->material);
    mem_free(o->folder);
    mem_free(o->translucent);
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

static bool holds(const char *folder, const char *name)
{
    char *file = mem_format("%s/%s", folder, name);
    struct stat s;
    const bool is = file && !stat(file, &s);
    mem_free(file);
    return is;
}

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

// Takes over the model, whatever is returned.
static relume_status take_model(struct relume_object_material *m, relume_btf_fitted *fitted,
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
    return status ? status : take_model(m, fitted, p->log);
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
    if (holds(folder, "surface.json"))
        return open_surface(m, folder, &p);
    const size_t n = strlen(folder);
    const bool exr = n > 4 && !strcasecmp(folder + n - 4, ".exr");
    return exr || holds(folder, "model.json") ? open_model(m, folder, &p)
                                              : open_measured(m, folder, &p);
}

// Room for one more.
static relume_status need_material(relume_objects *o, const char *name,
                                   const struct relume_log *log)
{
    const size_t count = (size_t)o->info.materials;
    if (o->info.materials == MOST_MATERIALS)
        return log_fail(log, RELUME_ELIMIT, "%s: expected at most %d materials", name,
                        MOST_MATERIALS);
    if (!mem_grow(&o->material, count, sizeof *o->material) ||
        !mem_grow(&o->folder, count, sizeof *o->folder) ||
        !mem_grow(&o->translucent, count, sizeof *o->translucent))
        return RELUME_ENOMEM;
    o->translucent[count] = (struct translucent){.name = NULL};
    return RELUME_OK;
}

relume_status objects_material(relume_objects *o, const char *folder, int *number,
                               const struct relume_objects_params *params)
{
    for (*number = 0; *number < o->info.materials; ++*number)
        if (o->folder[*number] && !strcmp(o->folder[*number], folder))
            return RELUME_OK;
    relume_status status = need_material(o, folder, params ? params->log : NULL);
    if (status)
        return status;
    o->folder[*number] = mem_text(folder);
    status = open_material(&o->material[*number], folder, params);
    if (!status && !o->folder[*number])
        status = RELUME_ENOMEM;
    o->info.materials++;  // destroyed with the others, also when it is broken
    return status;
}

// A material of a few numbers: one like it, or room for it.
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
    const relume_status status = need_material(o, like->name, log);
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
    return status ? status : take_model(added, fitted, params ? params->log : NULL);
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
    relume_status status = need_material(o, translucent->name, log);
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
    return status ? status : take_model(m, fitted, log);
}

// ---------------------------------------------------------------- the description

struct reader {
    relume_objects *o;
    const char *path;
    const struct relume_objects_params *params;
    const struct relume_log *log;  // of an object: it names it
};

static relume_status read_translucent(const struct reader *r, const jvalue *value, int *number)
{
    struct translucent t;
    const relume_status status = translucent_read(&t, value, r->log);
    return status ? status : objects_translucent(r->o, &t, number, r->params);
}

// One number for all, or one for each: what a mirror or a matte surface reflects.
static relume_status read_reflectance(const struct reader *r, const jvalue *value, int *number)
{
    static const char *const known[] = {"mirror", "diffuse", "translucent", NULL};
    const bool matte = jvalue_member(value, "diffuse");
    const char *what = matte ? "diffuse" : "mirror";
    const jvalue *m = jvalue_member(value, what);
    double f[3];
    float reflectance[3];
    relume_status status = jvalue_check_known(value, known, r->log);
    if (status)
        return status;
    int members = 0;
    for (int i = 0; known[i]; i++)
        members += jvalue_member(value, known[i]) != NULL;
    if (members != 1)
        return log_fail(r->log, RELUME_EFORMAT,
                        "material: expected one of diffuse, mirror and translucent");
    if (jvalue_member(value, "translucent"))
        return read_translucent(r, jvalue_member(value, "translucent"), number);
    if (!jvalue_numbers(m, f, 3)) {
        if (!jvalue_number(m, &f[0]))
            return log_fail(r->log, RELUME_EFORMAT,
                            "%s: expected the part of light that it reflects, or [r, g, b]", what);
        f[1] = f[2] = f[0];
    }
    for (int c = 0; c < 3; c++) {
        if (!(f[c] >= 0.0 && f[c] <= 1.0))
            return log_fail(r->log, RELUME_EFORMAT, "%s: expected 0 to 1; found %g", what, f[c]);
        reflectance[c] = (float)f[c];
    }
    return (matte ? objects_matte : objects_mirror)(r->o, reflectance, number, r->params);
}

static relume_status read_folder(const struct reader *r, const jvalue *text, int *number)
{
    const char *name = jvalue_text(text);
    if (jvalue_is_object(text))
        return read_reflectance(r, text, number);
    if (!name || !*name)
        return log_fail(r->log, RELUME_EFORMAT,
                        "material: expected the folder of a BTF or of a model, {\"diffuse\": 0.5}, "
                        "{\"mirror\": 1}, {\"translucent\": \"marble\"}, or a list of them");
    char *folder = mesh_beside(r->path, name);
    const relume_status status =
        folder ? objects_material(r->o, folder, number, r->params) : RELUME_ENOMEM;
    mem_free(folder);
    return status;
}

// The first of a list is shown, the others can be chosen.
static relume_status read_material(const struct reader *r, const jvalue *value, int *number)
{
    if (!jvalue_is_array(value))
        return read_folder(r, value, number);
    relume_status status = jvalue_count(value) ? RELUME_OK
                                               : log_fail(r->log, RELUME_EFORMAT,
                                                          "material: expected at least one folder");
    for (size_t i = 0; i < jvalue_count(value) && !status; i++) {
        int other;
        status = read_folder(r, jvalue_item(value, i), i ? &other : number);
    }
    return status;
}

// One number for both, or two.
static bool read_pair(const jvalue *value, double out[2])
{
    if (!value || jvalue_numbers(value, out, 2))
        return true;
    const bool good = jvalue_number(value, &out[0]);
    out[1] = out[0];
    return good;
}

static relume_status read_covering(const struct reader *r, const jvalue *value, struct covering *c)
{
    static const char *const known[] = {"part", "material", "repeat", "offset", "filter", NULL};
    *c = (struct covering){.repeat = {1, 1}};
    if (!jvalue_is_object(value))
        return log_fail(r->log, RELUME_EFORMAT, "parts: expected objects with a material");
    relume_status status = jvalue_check_known(value, known, r->log);
    if (status)
        return status;
    c->part = jvalue_text(jvalue_member(value, "part"));
    const char *filter = jvalue_text(jvalue_member(value, "filter"));
    c->nearest = filter && !strcmp(filter, "nearest");
    if (jvalue_member(value, "part") && !c->part)
        return log_fail(r->log, RELUME_EFORMAT, "part: expected the name of a part of the mesh");
    if (jvalue_member(value, "filter") && !c->nearest && (!filter || strcmp(filter, "bilinear")))
        return log_fail(r->log, RELUME_EFORMAT, "filter: expected \"bilinear\" or \"nearest\"");
    if (!read_pair(jvalue_member(value, "repeat"), c->repeat) || c->repeat[0] == 0.0 ||
        c->repeat[1] == 0.0)
        return log_fail(r->log, RELUME_EFORMAT, "repeat: expected a number or two, not 0");
    if (!read_pair(jvalue_member(value, "offset"), c->offset))
        return log_fail(r->log, RELUME_EFORMAT, "offset: expected a number or two");
    return read_material(r, jvalue_member(value, "material"), &c->material);
}

static struct frame turn(const double axis_angle[4])
{
    const vec3 a = vec3_unit(vec3_of(axis_angle[0], axis_angle[1], axis_angle[2]));
    const double angle_rad = axis_angle[3] * M_PI / 180.0;
    const double c = cos(angle_rad), s = sin(angle_rad);
    struct frame f = frame_world;
    vec3 *const image[3] = {&f.x, &f.y, &f.z};
    for (int i = 0; i < 3; i++) {  // Rodrigues' formula
        const vec3 e = *image[i];
        *image[i] = vec3_along(vec3_along(vec3_scale(e, c), vec3_cross(a, e), s), a,
                               vec3_dot(a, e) * (1.0 - c));
    }
    return f;
}

relume_status objects_read_pose(struct frame *out, const jvalue *value,
                                const struct relume_log *log)
{
    const struct reader only = {.log = log}, *const r = &only;
    static const char *const known[] = {"translate", "rotate", "scale", NULL};
    double move[3] = {0}, axis[4] = {0, 1, 0, 0}, scale = 1.0;
    *out = frame_world;
    if (!value)
        return RELUME_OK;
    if (!jvalue_is_object(value))
        return log_fail(r->log, RELUME_EFORMAT, "pose: expected translate, rotate, scale");
    relume_status status = jvalue_check_known(value, known, r->log);
    const jvalue *m = jvalue_member(value, "translate");
    if (!status && m && !jvalue_numbers(m, move, 3))
        status = log_fail(r->log, RELUME_EFORMAT, "translate: expected [x, y, z]");
    m = jvalue_member(value, "rotate");
    if (!status && m &&
        (!jvalue_numbers(m, axis, 4) || !(vec3_length(vec3_of(axis[0], axis[1], axis[2])) > 0.0)))
        status = log_fail(r->log, RELUME_EFORMAT,
                          "rotate: expected [x, y, z, degrees], an axis that has a length");
    m = jvalue_member(value, "scale");
    if (!status && m && (!jvalue_number(m, &scale) || !(scale > 0.0)))
        status = log_fail(r->log, RELUME_EFORMAT, "scale: expected a number above 0");
    *out = frame_compose(frame_compose(frame_move(move[0], move[1], move[2]), turn(axis)),
                         frame_scale(scale, scale, scale));
    return status;
}

static relume_status read_coverings(const struct reader *r, const jvalue *object,
                                    struct standing *s)
{
    const jvalue *parts = jvalue_member(object, "parts");
    const size_t n = jvalue_is_array(parts) ? jvalue_count(parts) : 0;
    if (n < 1 || n > MOST_COVERINGS)
        return log_fail(r->log, RELUME_EFORMAT, "parts: expected a list of 1 to %d",
                        MOST_COVERINGS);
    s->covering = mem_zeroed(n, sizeof *s->covering);
    s->coverings = s->covering ? (int)n : 0;
    relume_status status = s->covering ? RELUME_OK : RELUME_ENOMEM;
    for (size_t i = 0; i < n && !status; i++)
        status = read_covering(r, jvalue_item(parts, i), &s->covering[i]);
    return status;
}

static relume_status read_object(const struct reader *r, const jvalue *object)
{
    static const char *const known[] = {"mesh", "name", "pose", "parts", "reflections", NULL};
    struct standing s = {.frame = frame_world};
    const char *mesh = jvalue_text(jvalue_member(object, "mesh"));
    if (!jvalue_is_object(object) || !mesh || !*mesh)
        return log_fail(r->log, RELUME_EFORMAT, "mesh: expected the name of a file");
    char *path = mesh_beside(r->path, mesh);
    relume_status status = path ? jvalue_check_known(object, known, r->log) : RELUME_ENOMEM;
    if (!status)
        status = objects_read_pose(&s.frame, jvalue_member(object, "pose"), r->log);
    if (!status)
        status = read_coverings(r, object, &s);
    if (!status)
        status = objects_add(r->o, path, &s, r->params);
    mem_free(s.covering);
    mem_free(path);
    return status;
}

static relume_status read_list(const struct reader *r, const jvalue *list, const bool *left_out)
{
    const size_t n = jvalue_is_array(list) ? jvalue_count(list) : 0;
    if (n < 1 || n > MOST_OBJECTS)
        return log_fail(r->log, RELUME_EFORMAT, "%s: objects: expected a list of 1 to %d", r->path,
                        MOST_OBJECTS);
    relume_status status = RELUME_OK;
    for (size_t i = 0; i < n && !status; i++) {
        struct log_place place;
        struct reader one = *r;
        one.log = log_at(&place, r->log, "%s: object %zu: ", r->path, i);
        if (!left_out || !left_out[i])
            status = read_object(&one, jvalue_item(list, i));
    }
    return status ? status : objects_finish(r->o, r->params);
}

// Of the finished objects: edits ask where their surface is.
static relume_status read_edits(const struct reader *r, const jvalue *list, const bool *left_out)
{
    relume_status status = RELUME_OK;
    int object = 0;
    for (size_t i = 0; i < jvalue_count(list) && !status; i++) {
        const jvalue *edit = jvalue_member(jvalue_item(list, i), "reflections");
        if (left_out && left_out[i])
            continue;
        if (edit)
            status = objects_read_reflections(
                r->o, object, edit, r->path,
                relume_reflection_params(.log = r->log, .threads = r->params->threads));
        object++;
    }
    return status;
}

relume_status objects_read(relume_objects **out, const jvalue *list, const char *path,
                           const bool *left_out, const struct relume_objects_params *params)
{
    relume_objects *o = mem_zeroed(1, sizeof *o);
    const struct reader r = {o, path, params, params->log};
    *out = NULL;
    relume_status status = o ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status =
            list ? read_list(&r, list, left_out) : trace_create(&o->tracer, &o->mesh, params->log);
    if (!status && list)
        status = read_edits(&r, list, left_out);
    if (status)
        relume_objects_destroy(&o);
    *out = o;
    return status;
}

relume_status relume_objects_open(relume_objects **out, const char *path,
                                  const struct relume_objects_params *params)
{
    static const char *const known[] = {"format", "version", "objects", NULL};
    const struct relume_objects_params own = PARAMS_WORK(relume_objects_params, params);
    jvalue *root = NULL;
    *out = NULL;
    relume_status status = jvalue_load(&root, path, own.log);
    if (!status)
        status = jvalue_check_format(root, path, "relume-objects", VERSION, own.log);
    if (!status && jvalue_unknown(root, known))
        status = log_fail(own.log, RELUME_EFORMAT, "%s: unknown member '%s'", path,
                          jvalue_unknown(root, known));
    if (!status)
        status = objects_read(out, jvalue_member(root, "objects"), path, NULL, &own);
    jvalue_free(&root);
    return status;
}

relume_status relume_objects_of_mesh(relume_objects **out, const char *mesh,
                                     const char *const *materials, int count, double repeat,
                                     const struct relume_objects_params *params)
{
    const struct relume_objects_params own = PARAMS_WORK(relume_objects_params, params);
    relume_objects *o = mem_zeroed(1, sizeof *o);
    const double times = repeat != 0.0 ? repeat : 1.0;
    struct covering c = {.repeat = {times, times}};
    struct standing s = {frame_world, &c, 1};
    relume_status status = o ? RELUME_OK : RELUME_ENOMEM;
    *out = NULL;
    for (int i = 0, number; i < count && !status; i++)
        status = objects_material(o, materials[i], &number, &own);
    if (!status)
        status = mesh ? objects_add(o, mesh, &s, &own) : objects_add_cushion(o, &s, &own);
    if (!status)
        status = objects_finish(o, &own);
    if (status)
        relume_objects_destroy(&o);
    *out = o;
    return status;
}
