// tableau.c - a scene file, what it names, and which of it is shown
#include "world/tableau/tableau.h"

#include "core/base/tree.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "shape/mesh/mesh_file.h"

#include <relume/exchange.h>
#include <string.h>

enum { VERSION = 1, MOST_CAPTURES = 64, MOST_LIGHTS = 4096 };
#define FORMAT "relume-scene"
static const uint64_t DEFAULT_MEMORY = (uint64_t)1 << 30;  // of all captures

void relume_tableau_destroy(relume_tableau **tableau)
{
    relume_tableau *t = *tableau;
    *tableau = NULL;
    if (!t)
        return;
    for (int i = 0; i < t->info.entities; i++)
        mem_free((void *)t->entity[i].name);
    for (int i = 0; i < t->info.captures; i++)
        exhibit_destroy(&t->capture[i]);
    bodies_destroy(&t->bodies);
    relume_objects_destroy(&t->shown);
    relume_objects_destroy(&t->objects);
    relume_rig_destroy(&t->rig);
    jvalue_free(&t->root);
    mem_free(t->entity);
    mem_free(t->capture);
    mem_free(t->extent);
    mem_free(t->left_out);
    mem_free(t->path);
    mem_free(t);
}

const struct relume_tableau_info *relume_tableau_info(const relume_tableau *tableau)
{
    return &tableau->info;
}

relume_rig *relume_tableau_rig(relume_tableau *tableau)
{
    return tableau->rig;
}

// ---------------------------------------------------------------- the file

static const jvalue *list_of(const relume_tableau *t, const char *name)
{
    return jvalue_member(t->root, name);
}

static relume_status count(int *n, const relume_tableau *t, const char *name, int least, int most)
{
    const jvalue *list = list_of(t, name);
    *n = list ? (int)jvalue_count(list) : 0;
    if (!list || (jvalue_is_array(list) && *n >= least && *n <= most))
        return RELUME_OK;
    return log_fail(t->params.log, RELUME_EFORMAT, "%s: %s: expected a list of %d to %d", t->path,
                    name, least, most);
}

// What an entry calls itself, or else the last word of its file's path.
static char *name_of(const jvalue *entry, const char *file)
{
    const char *name = jvalue_text(jvalue_member(entry, "name"));
    return mem_text(name && *name ? name : path_name(file));
}

static int object_named(const relume_tableau *t, const char *name)
{
    for (int i = t->info.captures; i < t->info.entities; i++)
        if (!strcmp(t->entity[i].name, name))
            return i;
    return -1;
}

static relume_status read_stand_in(relume_tableau *t, struct relume_tableau_entity *e,
                                   const jvalue *entry, const struct relume_log *log)
{
    const jvalue *value = jvalue_member(entry, "instead_of");
    const char *name = jvalue_text(value);
    e->instead_of = name ? object_named(t, name) : -1;
    if (!value || e->instead_of >= 0)
        return RELUME_OK;
    return log_fail(log, RELUME_EFORMAT,
                    "instead_of: expected the name of one of the objects; found '%s'",
                    name ? name : "no text");
}

static relume_status read_capture(relume_tableau *t, int number)
{
    static const char *const known[] = {"file", "name", "pose", "instead_of", NULL};
    const jvalue *entry = jvalue_item(list_of(t, "captures"), (size_t)number);
    const char *file = jvalue_text(jvalue_member(entry, "file"));
    struct relume_tableau_entity *e = &t->entity[number];
    struct log_place place;
    const struct relume_log *log =
        log_at(&place, t->params.log, "%s: capture %d: ", t->path, number);
    struct frame pose;
    if (!jvalue_is_object(entry) || !file || !*file)
        return log_fail(log, RELUME_EFORMAT, "file: expected the name of a file");
    e->name = name_of(entry, file);
    char *path = path_beside(t->path, file);
    relume_status status = e->name && path ? jvalue_check_known(entry, known, log) : RELUME_ENOMEM;
    if (!status && relume_kind_of(path) == RELUME_KIND_SCENE)
        status = log_fail(log, RELUME_EFORMAT,
                          "'%s' is a scene file itself; name what is in it here instead", file);
    if (!status)
        status = objects_read_pose(&pose, jvalue_member(entry, "pose"), log);
    if (!status && !number && jvalue_member(entry, "pose"))
        status = log_fail(log, RELUME_EFORMAT,
                          "the first capture stands where it was captured; leave out its pose, and "
                          "give one to the others");
    if (!status && !number && jvalue_member(entry, "instead_of"))
        status = log_fail(log, RELUME_EFORMAT,
                          "the first capture is always seen; give instead_of to another");
    if (!status)
        status = read_stand_in(t, e, entry, log);
    if (!status)
        status = exhibit_open(&t->capture[number], path, &pose, &t->params);
    t->capture[number].name = e->name;
    e->pack = t->capture[number].pack;
    mem_free(path);
    return status;
}

static struct relume_objects_params objects_params(const relume_tableau *t)
{
    return (struct relume_objects_params){.struct_size = sizeof(struct relume_objects_params),
                                          .log = t->params.log,
                                          .limits = t->params.limits,
                                          .scratch = t->params.scratch,
                                          .threads = t->params.threads};
}

// All but those that are left out; when that fails, what there is stays.
static relume_status read_objects(relume_tableau *t, const bool *left_out)
{
    const struct relume_objects_params params = objects_params(t);
    relume_objects *objects;
    bool any = false;
    for (int i = 0; i < tableau_objects(t); i++)
        any |= !left_out[i];
    const relume_status status =
        objects_read(&objects, any ? list_of(t, "objects") : NULL, t->path, left_out, &params);
    if (status)
        return status;
    bodies_destroy(&t->bodies);
    relume_objects_destroy(&t->shown);
    relume_objects_destroy(&t->objects);
    t->objects = objects;
    return RELUME_OK;
}

static relume_status name_objects(relume_tableau *t)
{
    for (int i = t->info.captures; i < t->info.entities; i++) {
        const jvalue *entry = jvalue_item(list_of(t, "objects"), (size_t)(i - t->info.captures));
        const char *mesh = jvalue_text(jvalue_member(entry, "mesh"));
        t->entity[i].name = name_of(entry, mesh ? mesh : "");
        t->entity[i].instead_of = -1;
        if (!t->entity[i].name)
            return RELUME_ENOMEM;
    }
    return RELUME_OK;
}

static void widen(vec3 *min, vec3 *max, vec3 p)
{
    *min = vec3_of(fmin(min->x, p.x), fmin(min->y, p.y), fmin(min->z, p.z));
    *max = vec3_of(fmax(max->x, p.x), fmax(max->y, p.y), fmax(max->z, p.z));
}

static void measure(relume_tableau *t)
{
    const relume_objects *o = t->objects;
    const vec3 none = vec3_of(INFINITY, INFINITY, INFINITY);
    for (int i = 0, part = 0; i < tableau_objects(t); i++) {
        struct relume_tableau_entity *e = &t->entity[t->info.captures + i];
        vec3 min = none, max = vec3_scale(none, -1.0);
        double area = 0.0;
        for (; part < o->info.parts && o->part[part].object == i; part++) {
            const size_t first = o->part[part].first, count = o->part[part].count;
            for (size_t k = first; k < first + count; k++) {
                vec3 corner[3];
                mesh_corners(corner, &o->mesh, k);
                area += 0.5 * vec3_length(mesh_twice_area(corner));
                for (int c = 0; c < 3; c++)
                    widen(&min, &max, corner[c]);
            }
            e->triangles += count;
        }
        t->extent[i] = (struct extent){.middle = vec3_scale(vec3_add(min, max), 0.5),
                                       .radius = 0.5 * vec3_length(vec3_sub(max, min)),
                                       .triangle = area / fmax((double)e->triangles, 1.0)};
    }
}

static relume_status read_rig(relume_tableau *t)
{
    const jvalue *lights = list_of(t, "lights");
    relume_status status = relume_rig_create(&t->rig);
    int n = 0;
    if (!status)
        status = count(&n, t, "lights", 0, MOST_LIGHTS);
    const int length = path_folder(t->path);
    char *folder = length ? mem_format("%.*s", length, t->path) : mem_text(".");
    if (!folder)
        status = RELUME_ENOMEM;
    if (!status && !lights)
        status = relume_rig_add(t->rig, "dir 0 0 1", NULL, t->params.log);
    for (int i = 0; i < n && !status; i++) {
        struct log_place place;
        const struct relume_log *log = log_at(&place, t->params.log, "%s: light %d: ", t->path, i);
        const char *spec = jvalue_text(jvalue_item(lights, (size_t)i));
        status = spec ? relume_rig_add(t->rig, spec, folder, log)
                      : log_fail(log, RELUME_EFORMAT, "expected a text such as \"dir 0 1 1\"");
    }
    mem_free(folder);
    return status;
}

static void look_at_objects(struct relume_camera *camera, const relume_objects *o)
{
    const vec3 middle = objects_middle(o);
    const double radius = 0.5 * vec3_length(vec3_sub(o->info.max, o->info.min));
    *camera = (struct relume_camera){
        .framing = RELUME_FRAME_EYE,
        .eye = vec3_along(middle, vec3_of(0, 0, 1), 3.0 * radius),
        .look_at = {true, middle, {0, 1, 0}, 45.0},
        .width = 800,
        .height = 600,
    };
}

static relume_status read_point(const relume_tableau *t, const char *name, vec3 *out)
{
    const jvalue *value = jvalue_member(t->root, name);
    double p[3];
    if (!value)
        return RELUME_OK;
    if (!jvalue_numbers(value, p, 3))
        return log_fail(t->params.log, RELUME_EFORMAT, "%s: %s: expected [x, y, z]", t->path, name);
    *out = vec3_of(p[0], p[1], p[2]);
    return RELUME_OK;
}

static relume_status read_camera(relume_tableau *t)
{
    enum { MOST_SIDE = 65536 };
    struct relume_camera *camera = &t->info.camera;
    const jvalue *fov = jvalue_member(t->root, "fov"), *size = jvalue_member(t->root, "size");
    if (t->info.captures)
        *camera = exhibit_camera(&t->capture[0]);
    else
        look_at_objects(camera, t->objects);
    relume_status status = read_point(t, "eye", &camera->eye);
    if (!status)
        status = read_point(t, "look_at", &camera->look_at.at);
    if (!status)
        status = read_point(t, "up", &camera->look_at.up);
    if (!status && fov &&
        !(jvalue_number(fov, &camera->look_at.field_of_view_deg) &&
          camera->look_at.field_of_view_deg > 0.0 && camera->look_at.field_of_view_deg < 180.0))
        status = log_fail(t->params.log, RELUME_EFORMAT,
                          "%s: fov: expected degrees between 0 and 180", t->path);
    if (!status && size &&
        !(jvalue_is_array(size) && jvalue_count(size) == 2 &&
          jvalue_whole(jvalue_item(size, 0), 1, MOST_SIDE, &camera->width) &&
          jvalue_whole(jvalue_item(size, 1), 1, MOST_SIDE, &camera->height)))
        status = log_fail(t->params.log, RELUME_EFORMAT,
                          "%s: size: expected [width, height], 1 to %d pixels", t->path, MOST_SIDE);
    return status;
}

static relume_status allocate_entries(relume_tableau *t)
{
    enum { MOST_OBJECTS = 4096 };
    int captures = 0, objects = 0;
    relume_status status = count(&captures, t, "captures", 1, MOST_CAPTURES);
    if (!status)
        status = count(&objects, t, "objects", 1, MOST_OBJECTS);
    if (!status && captures + objects == 0)
        status =
            log_fail(t->params.log, RELUME_EFORMAT, "%s: expected captures or objects", t->path);
    if (status)
        return status;
    t->entity = mem_zeroed((size_t)(captures + objects), sizeof *t->entity);
    t->capture = mem_zeroed((size_t)captures, sizeof *t->capture);
    t->extent = mem_zeroed((size_t)objects, sizeof *t->extent);
    t->left_out = mem_zeroed((size_t)objects, sizeof *t->left_out);
    if (!t->entity || !t->capture || !t->extent || !t->left_out)
        return RELUME_ENOMEM;
    t->info.entity = t->entity;
    t->info.captures = captures;
    t->info.entities = captures + objects;
    if (captures)
        t->params.memory =
            (t->params.memory ? t->params.memory : DEFAULT_MEMORY) / (uint64_t)captures + 1;
    return RELUME_OK;
}

static relume_status read_all(relume_tableau *t)
{
    static const char *const known[] = {"format", "version", "captures", "objects",
                                        "lights", "eye",     "look_at",  "up",
                                        "fov",    "size",    NULL};
    struct log_place place;
    relume_status status = jvalue_check_format(t->root, t->path, FORMAT, VERSION, t->params.log);
    if (!status)
        status = jvalue_check_known(t->root, known, log_at(&place, t->params.log, "%s: ", t->path));
    if (!status)
        status = allocate_entries(t);
    if (!status)
        status = name_objects(t);
    for (int i = 0; i < t->info.captures && !status; i++)
        status = read_capture(t, i);
    if (!status)
        status = read_objects(t, t->left_out);
    if (!status) {
        measure(t);
        status = read_rig(t);
    }
    return status ? status : read_camera(t);
}

relume_status relume_tableau_open(relume_tableau **out, const char *path,
                                  const struct relume_tableau_params *params)
{
    relume_tableau *t = mem_zeroed(1, sizeof *t);
    *out = NULL;
    if (!t)
        return RELUME_ENOMEM;
    t->params = PARAMS_WORK(relume_tableau_params, params);
    t->path = mem_text(path);
    relume_status status = t->path ? jvalue_load(&t->root, path, t->params.log) : RELUME_ENOMEM;
    if (!status)
        status = read_all(t);
    if (status)
        relume_tableau_destroy(&t);
    *out = t;
    return status;
}

// ---------------------------------------------------------------- near and far

// Whether the mean triangle of an object covers less than a pixel where it is nearest. Triangles
// face anywhere: seen from one side each shows half of its area on average.
static bool is_too_fine(const struct extent *extent, const struct relume_window *w, int width,
                        int height)
{
    const vec3 middle = vec3_along(vec3_along(w->corner, w->right, 0.5), w->down, 0.5);
    const double away = vec3_length(vec3_sub(middle, w->eye));
    const double pixel =
        vec3_length(w->right) * vec3_length(w->down) / (away * away * width * height);
    const double distance = vec3_length(vec3_sub(extent->middle, w->eye)) - extent->radius;
    return distance > 0.0 && 0.5 * extent->triangle < pixel * distance * distance;
}

relume_status tableau_choose(bool *shown, relume_tableau *t, const struct relume_window *window,
                             int width, int height)
{
    const size_t objects = (size_t)tableau_objects(t);
    bool *left_out = mem_zeroed(objects, sizeof *left_out);
    if (!left_out)
        return RELUME_ENOMEM;
    for (int i = 0; i < t->info.captures; i++) {
        const int object = t->entity[i].instead_of - t->info.captures;
        shown[i] = object < 0 || is_too_fine(&t->extent[object], window, width, height);
        if (object >= 0)
            left_out[object] = shown[i];
    }
    relume_status status = RELUME_OK;
    if (objects && memcmp(left_out, t->left_out, objects * sizeof *left_out)) {
        status = read_objects(t, left_out);
        if (!status)
            memcpy(t->left_out, left_out, objects * sizeof *left_out);
    }
    mem_free(left_out);
    return status;
}
