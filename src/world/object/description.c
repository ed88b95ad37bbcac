// description.c - the description of objects in JSON
#include "core/base/tree.h"
#include "core/base/json.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/tree.h"
#include "shape/mesh/mesh_read.h"
#include "world/object/object.h"

#include <relume/exchange.h>
#include <string.h>

enum { VERSION = 1, MOST_OBJECTS = 4096, MOST_COVERINGS = 1024 };

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
    char *folder = path_beside(r->path, name);
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
    c->material = -1;
    const jvalue *material = jvalue_member(value, "material");
    return material ? read_material(r, material, &c->material) : RELUME_OK;
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
    if (!parts)  // the mesh shows its own look
        return RELUME_OK;
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

// An object of which light is known beforehand has its mesh and materials in its file.
static relume_status read_baked(const struct reader *r, const jvalue *object)
{
    static const char *const known[] = {"baked", "name", "pose", NULL};
    const char *name = jvalue_text(jvalue_member(object, "baked"));
    struct frame frame;
    if (!name || !*name)
        return log_fail(r->log, RELUME_EFORMAT, "baked: expected the name of a file");
    char *path = path_beside(r->path, name);
    relume_status status = path ? jvalue_check_known(object, known, r->log) : RELUME_ENOMEM;
    if (!status)
        status = objects_read_pose(&frame, jvalue_member(object, "pose"), r->log);
    if (!status)
        status = objects_add_baked(r->o, path, &frame, r->params);
    mem_free(path);
    return status;
}

static relume_status read_billboards(const struct reader *r, const jvalue *error,
                                     struct standing *s)
{
    if (!error ||
        (jvalue_number(error, &s->billboards) && s->billboards > 0.0 && s->billboards <= 1.0))
        return RELUME_OK;
    return log_fail(r->log, RELUME_EFORMAT,
                    "billboards: expected their error, above 0 and at most 1, of the longest side "
                    "of the object");
}

// true, or the pixels that their error may be seen as.
static relume_status read_levels(const struct reader *r, const jvalue *value, struct standing *s)
{
    const double USUAL = 0.25, MOST = 100.0;
    bool wanted;
    if (!value)
        return RELUME_OK;
    if (jvalue_truth(value, &wanted)) {
        s->levels = wanted ? USUAL : 0.0;
        return RELUME_OK;
    }
    if (jvalue_number(value, &s->levels) && s->levels > 0.0 && s->levels <= MOST)
        return RELUME_OK;
    return log_fail(r->log, RELUME_EFORMAT,
                    "levels: expected true, false, or the pixels that their error may be seen as, "
                    "above 0 and at most %g",
                    MOST);
}

static relume_status read_object(const struct reader *r, const jvalue *object)
{
    static const char *const known[] = {"mesh",        "name",       "pose",   "parts",
                                        "reflections", "billboards", "levels", NULL};
    struct standing s = {.frame = frame_world};
    const char *mesh = jvalue_text(jvalue_member(object, "mesh"));
    if (!jvalue_is_object(object) || !mesh || !*mesh)
        return log_fail(r->log, RELUME_EFORMAT, "mesh: expected the name of a file");
    char *path = path_beside(r->path, mesh);
    relume_status status = path ? jvalue_check_known(object, known, r->log) : RELUME_ENOMEM;
    if (!status)
        status = objects_read_pose(&s.frame, jvalue_member(object, "pose"), r->log);
    if (!status)
        status = read_billboards(r, jvalue_member(object, "billboards"), &s);
    if (!status)
        status = read_levels(r, jvalue_member(object, "levels"), &s);
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
            status = jvalue_member(jvalue_item(list, i), "baked")
                         ? read_baked(&one, jvalue_item(list, i))
                         : read_object(&one, jvalue_item(list, i));
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

static relume_status open_baked(relume_objects **out, const char *path,
                                const struct relume_objects_params *params)
{
    relume_objects *o = mem_zeroed(1, sizeof *o);
    relume_status status = o ? objects_add_baked(o, path, &frame_world, params) : RELUME_ENOMEM;
    if (!status)
        status = objects_finish(o, params);
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
    const enum relume_kind kind = relume_kind_of(path);
    if (kind == RELUME_KIND_BAKED || path_ends(path, ".exr"))
        return open_baked(out, path, &own);
    if (kind == RELUME_KIND_MODEL)
        return relume_objects_of_mesh(out, path, NULL, 0, 0.0, &own);
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
    struct covering c = {.material = count ? 0 : -1, .repeat = {times, times}};
    struct standing s = {.frame = frame_world, .covering = &c, .coverings = 1, .bare = !count};
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
