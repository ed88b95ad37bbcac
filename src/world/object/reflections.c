// reflections.c - edits of reflections in JSON, and of which object they are
#include "core/base/json_write.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "world/object/drawn_objects.h"
#include "world/object/object.h"
#include "world/reflect/reflection.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { VERSION = 1 };
static const char FORMAT[] = "relume-reflections";

// What is done to an object, before it is; `*made` is NULL where nothing is.
static relume_status make(relume_reflection **made, const relume_objects *o, int object,
                          const struct relume_reflection_edit *edit,
                          const struct relume_reflection_params *params)
{
    struct relume_reflection_params own = *params;
    size_t first = SIZE_MAX, end = 0;
    *made = NULL;
    if (object < 0 || object >= o->info.objects)
        return log_fail(own.log, RELUME_EINVAL, "%s: object %d does not exist; expected 0 to %d",
                        own.name ? own.name : "reflections", object, o->info.objects - 1);
    for (int i = 0; i < o->info.parts; i++)
        if (o->part[i].object == object) {
            first = o->part[i].first < first ? o->part[i].first : first;
            end = o->part[i].first + o->part[i].count;
        }
    const struct relume_reflection_surface surface = {
        .position = o->vertices->position,
        .stride = sizeof *o->vertices,
        .vertices = o->info.vertex_count,
        .triangle = first < end ? o->info.triangles + first : NULL,
        .triangles = first < end ? end - first : 0,
    };
    own.like = o->reflection[object];
    return edit ? relume_reflection_create(made, edit, &surface, &own) : RELUME_OK;
}

static void take_reflection(relume_objects *o, int object, relume_reflection *made)
{
    relume_reflection_destroy(&o->reflection[object]);
    o->reflection[object] = made;
    o->info.reflections_set++;
}

relume_status relume_objects_set_reflections(relume_objects *o, int object,
                                             const struct relume_reflection_edit *edit,
                                             const struct relume_reflection_params *params)
{
    const struct relume_reflection_params own = PARAMS_WORK(relume_reflection_params, params);
    relume_reflection *made;
    const relume_status status = make(&made, o, object, edit, &own);
    if (!status)
        take_reflection(o, object, made);
    return status;
}

const relume_reflection *relume_objects_reflections(const relume_objects *o, int object)
{
    return object >= 0 && object < o->info.objects ? o->reflection[object] : NULL;
}

// ---------------------------------------------------------------- reading

struct reading {
    const relume_objects *o;
    int object;
    const struct relume_log *log;  // of a constraint or region: it names it
    const char *name;              // of the file and the object
    struct relume_reflection_constraint *constraint;
    struct relume_reflection_region *region;
};

static bool read_vector(const jvalue *value, vec3 *out)
{
    double v[3];
    if (!jvalue_numbers(value, v, 3))
        return false;
    *out = vec3_of(v[0], v[1], v[2]);
    return true;
}

// What the eye sees reflected at the place, which moves onto the surface that it sees.
static relume_status find_original(const struct reading *r, struct relume_reflection_constraint *c)
{
    const double BESIDE = 0.1;  // of the objects' size
    const double size = vec3_length(vec3_sub(r->o->info.max, r->o->info.min));
    const vec3 way = vec3_sub(c->position, c->eye);
    struct relume_object_reflection seen;
    if (!(vec3_length(way) > 0.0) || !relume_objects_reflect(&seen, r->o, c->eye, way) ||
        vec3_length(vec3_sub(seen.place.position, c->position)) > BESIDE * size)
        return log_fail(r->log, RELUME_EFORMAT,
                        "its eye does not see the object at its position; move one of them, or "
                        "give the direction 'original'");
    if (seen.object != r->object)
        return log_fail(r->log, RELUME_EFORMAT,
                        "its eye sees object %d there; move position or eye, or give the direction "
                        "'original'",
                        seen.object);
    c->position = seen.place.position;
    c->original = relume_reflection_original(NULL, c->position, seen.normal, c->eye);
    return RELUME_OK;
}

static relume_status read_constraint(const struct reading *r, size_t number, const jvalue *value)
{
    static const char *const known[] = {"position", "eye", "original", "direction", "target", NULL};
    struct relume_reflection_constraint *c = &r->constraint[number];
    const jvalue *original = jvalue_member(value, "original");
    const jvalue *direction = jvalue_member(value, "direction");
    const jvalue *target = jvalue_member(value, "target");
    if (!jvalue_is_object(value) || jvalue_unknown(value, known))
        return log_fail(r->log, RELUME_EFORMAT,
                        "expected position, eye, direction or target, and perhaps original%s%s",
                        jvalue_unknown(value, known) ? "; found " : "",
                        jvalue_unknown(value, known) ? jvalue_unknown(value, known) : "");
    if (!read_vector(jvalue_member(value, "position"), &c->position) ||
        !read_vector(jvalue_member(value, "eye"), &c->eye))
        return log_fail(r->log, RELUME_EFORMAT, "position and eye: expected [x, y, z]");
    if (!direction == !target || !read_vector(direction ? direction : target, &c->edited))
        return log_fail(r->log, RELUME_EFORMAT,
                        "expected what it shall reflect, as direction or as target: [x, y, z]");
    if (original && !read_vector(original, &c->original))
        return log_fail(r->log, RELUME_EFORMAT, "original: expected [x, y, z]");
    const relume_status status = original ? RELUME_OK : find_original(r, c);
    if (target)
        c->edited = vec3_sub(c->edited, c->position);
    return status;
}

static relume_status read_stroke(const struct reading *r, const jvalue *value,
                                 struct relume_reflection_region *g)
{
    enum { MOST = 4096 };
    const size_t n = jvalue_is_array(value) ? jvalue_count(value) : 0;
    if (n < 1 || n > MOST)
        return log_fail(r->log, RELUME_EFORMAT, "stroke: expected 1 to %d points", MOST);
    vec3 *point = mem_array(n, sizeof *point);
    if (!point)
        return RELUME_ENOMEM;
    g->shape = RELUME_REFLECTION_STROKES;
    g->stroke = point;
    g->points = (int)n;
    for (size_t i = 0; i < n; i++)
        if (!read_vector(jvalue_item(value, i), &point[i]))
            return log_fail(r->log, RELUME_EFORMAT, "stroke: expected points [x, y, z]");
    return RELUME_OK;
}

static relume_status read_region(const struct reading *r, size_t number, const jvalue *value)
{
    static const char *const known[] = {"ball", "geodesic", "stroke", "radius", "border", NULL};
    struct relume_reflection_region *g = &r->region[number];
    const jvalue *ball = jvalue_member(value, "ball"), *along = jvalue_member(value, "geodesic");
    const jvalue *stroke = jvalue_member(value, "stroke"), *border = jvalue_member(value, "border");
    const char *stranger = jvalue_unknown(value, known);
    if (!jvalue_is_object(value) || stranger || !!ball + !!along + !!stroke != 1)
        return log_fail(r->log, RELUME_EFORMAT,
                        "expected one of ball, geodesic and stroke, radius, and perhaps border%s%s",
                        stranger ? "; found " : "", stranger ? stranger : "");
    if (!jvalue_number(jvalue_member(value, "radius"), &g->radius) ||
        (border && !jvalue_number(border, &g->border)))
        return log_fail(r->log, RELUME_EFORMAT, "radius and border: expected numbers");
    if (stroke)
        return read_stroke(r, stroke, g);
    g->shape = ball ? RELUME_REFLECTION_BALL : RELUME_REFLECTION_GEODESIC;
    return read_vector(ball ? ball : along, &g->centre)
               ? RELUME_OK
               : log_fail(r->log, RELUME_EFORMAT, "centre: expected [x, y, z]");
}

// `noun` names one of the list, whose name has an s.
static relume_status read_list(const struct reading *r, const jvalue *edit, const char *noun,
                               int most, int *count,
                               relume_status (*read)(const struct reading *, size_t,
                                                     const jvalue *))
{
    char member[32];
    snprintf(member, sizeof member, "%ss", noun);
    const jvalue *list = jvalue_member(edit, member);
    const size_t n = jvalue_count(list);
    relume_status status = RELUME_OK;
    if ((list && !jvalue_is_array(list)) || n > (size_t)most)
        return log_fail(r->log, RELUME_EFORMAT, "%s: %s: expected a list of at most %d", r->name,
                        member, most);
    for (size_t i = 0; i < n && !status; i++) {
        struct log_place place;
        struct reading one = *r;
        one.log = log_at(&place, r->log, "%s: %s %zu: ", r->name, noun, i);
        status = read(&one, i, jvalue_item(list, i));
        *count = (int)i + 1;
    }
    return status;
}

static relume_status read_edit(struct reading *r, struct relume_reflection_edit *e,
                               const jvalue *value)
{
    static const char *const known[] = {"object",   "constraints", "regions",
                                        "distance", "frozen",      NULL};
    static const char *const distances[] = {"straight", "geodesic"};
    const jvalue *distance = jvalue_member(value, "distance");
    const jvalue *frozen = jvalue_member(value, "frozen");
    const char *words = jvalue_text(distance);
    if (!jvalue_is_object(value) || jvalue_unknown(value, known))
        return log_fail(r->log, RELUME_EFORMAT,
                        "%s: expected constraints, regions, distance, frozen%s%s", r->name,
                        jvalue_unknown(value, known) ? "; found " : "",
                        jvalue_unknown(value, known) ? jvalue_unknown(value, known) : "");
    e->geodesic = words && !strcmp(words, distances[1]);
    if (distance && !e->geodesic && (!words || strcmp(words, distances[0])))
        return log_fail(r->log, RELUME_EFORMAT,
                        "%s: distance: expected \"straight\" or \"geodesic\"", r->name);
    e->frozen = frozen;
    if (frozen && !read_vector(frozen, &e->eye))
        return log_fail(r->log, RELUME_EFORMAT, "%s: frozen: expected the eye [x, y, z]", r->name);
    relume_status status = read_list(r, value, "constraint", RELUME_REFLECTION_CONSTRAINTS_MOST,
                                     &e->constraints, read_constraint);
    if (!status)
        status =
            read_list(r, value, "region", RELUME_REFLECTION_REGIONS_MOST, &e->regions, read_region);
    return status;
}

static relume_status read_reflections(relume_reflection **made, const relume_objects *o, int object,
                                      const jvalue *value, const char *path,
                                      const struct relume_reflection_params *params)
{
    char *name = mem_format("%s: object %d: reflections", path, object);
    struct reading r = {
        .o = o,
        .object = object,
        .log = params->log,
        .name = name,
        .constraint = mem_zeroed(RELUME_REFLECTION_CONSTRAINTS_MOST, sizeof *r.constraint),
        .region = mem_zeroed(RELUME_REFLECTION_REGIONS_MOST, sizeof *r.region),
    };
    struct relume_reflection_edit edit = {.constraint = r.constraint, .region = r.region};
    struct relume_reflection_params own = *params;
    own.name = name;
    relume_status status =
        name && r.constraint && r.region ? read_edit(&r, &edit, value) : RELUME_ENOMEM;
    if (!status) {
        status = make(made, o, object, &edit, &own);
        if (status == RELUME_EINVAL)
            status = RELUME_EFORMAT;
    }
    for (int i = 0; r.region && i < RELUME_REFLECTION_REGIONS_MOST; i++)
        mem_free((void *)r.region[i].stroke);
    mem_free(r.constraint);
    mem_free(r.region);
    mem_free(name);
    return status;
}

relume_status objects_read_reflections(relume_objects *o, int object, const jvalue *value,
                                       const char *path,
                                       const struct relume_reflection_params *params)
{
    relume_reflection *made = NULL;
    const relume_status status = read_reflections(&made, o, object, value, path, params);
    if (!status)
        take_reflection(o, object, made);
    return status;
}

// The next would take the place of one that the same file asks for, without a word.
static relume_status read_edit_of_file(relume_reflection **made, const relume_objects *o, size_t i,
                                       const jvalue *edit, const char *path,
                                       const struct relume_reflection_params *params)
{
    const jvalue *number = jvalue_member(edit, "object");
    int object = 0;
    if (number && !jvalue_whole(number, 0, o->info.objects - 1, &object))
        return log_fail(params->log, RELUME_EFORMAT,
                        "%s: edit %zu: object: expected a whole number from 0 to %d", path, i,
                        o->info.objects - 1);
    if (made[object])
        return log_fail(params->log, RELUME_EFORMAT,
                        "%s: edit %zu: object %d has an edit already; expected one with all its "
                        "constraints and regions",
                        path, i, object);
    return read_reflections(&made[object], o, object, edit, path, params);
}

relume_status relume_objects_load_reflections(relume_objects *o, const char *path,
                                              const struct relume_reflection_params *params)
{
    static const char *const known[] = {"format", "version", "edits", NULL};
    const struct relume_reflection_params own = PARAMS_WORK(relume_reflection_params, params);
    jvalue *root;
    relume_status status = jvalue_load(&root, path, own.log);
    if (!status)
        status = jvalue_check_format(root, path, FORMAT, VERSION, own.log);
    const jvalue *list = status ? NULL : jvalue_member(root, "edits");
    if (!status && (!jvalue_is_array(list) || jvalue_unknown(root, known)))
        status =
            log_fail(own.log, RELUME_EFORMAT, "%s: expected a list 'edits' and nothing else", path);
    relume_reflection **made = mem_zeroed((size_t)o->info.objects, sizeof *made);
    if (!status && !made)
        status = RELUME_ENOMEM;
    for (size_t i = 0; i < jvalue_count(list) && !status; i++)
        status = read_edit_of_file(made, o, i, jvalue_item(list, i), path, &own);
    for (int i = 0; made && i < o->info.objects; i++)
        if (made[i] && !status)
            take_reflection(o, i, made[i]);
        else
            relume_reflection_destroy(&made[i]);
    mem_free(made);
    jvalue_free(&root);
    return status;
}

// ---------------------------------------------------------------- writing

static void put_region(struct jwriter *w, const struct relume_reflection_region *g)
{
    static const char *const words[] = {"ball", "geodesic", "stroke"};
    jgap(w, "\n        ");
    jopen_object(w, NULL);
    if (g->shape == RELUME_REFLECTION_STROKES) {
        jopen_array(w, words[g->shape]);
        for (int i = 0; i < g->points; i++)
            jput_vector(w, NULL, g->stroke[i], 9);
        jclose(w);
    } else {
        jput_vector(w, words[g->shape], g->centre, 9);
    }
    jput_number(w, "radius", g->radius, 9);
    jput_number(w, "border", g->border, 9);
    jclose(w);
}

static void put_constraint(struct jwriter *w, const struct relume_reflection_constraint *c)
{
    jgap(w, "\n        ");
    jopen_object(w, NULL);
    jput_vector(w, "position", c->position, 9);
    jput_vector(w, "eye", c->eye, 9);
    jgap(w, "\n         ");
    jput_vector(w, "original", c->original, 9);
    jput_vector(w, "direction", c->edited, 9);
    jclose(w);
}

static void put_edit(struct jwriter *w, int object, const struct relume_reflection_edit *e)
{
    jgap(w, "\n    ");
    jopen_object(w, NULL);
    jput_integer(w, "object", object);
    jput_text(w, "distance", e->geodesic ? "geodesic" : "straight");
    if (e->frozen)
        jput_vector(w, "frozen", e->eye, 9);
    jgap(w, "\n      ");
    jopen_array(w, "constraints");
    for (int i = 0; i < e->constraints; i++)
        put_constraint(w, &e->constraint[i]);
    jclose(w);
    jgap(w, "\n      ");
    jopen_array(w, "regions");
    for (int i = 0; i < e->regions; i++)
        put_region(w, &e->region[i]);
    jclose_levels(w, 2);
}

// What is there and is no list of reflections is kept.
static relume_status check_replaced(const char *path, const struct relume_log *log)
{
    jvalue *root = NULL;
    struct stat there;
    if (stat(path, &there) || !S_ISREG(there.st_mode))
        return RELUME_OK;
    relume_status status = jvalue_load(&root, path, NULL);
    if (status != RELUME_ENOMEM &&
        (status || jvalue_check_format(root, path, FORMAT, VERSION, NULL)))
        status = log_fail(log, RELUME_EINVAL,
                          "%s: is no list of reflections, and is kept; choose another name", path);
    jvalue_free(&root);
    return status;
}

relume_status relume_objects_save_reflections(const relume_objects *o, const char *path,
                                              const struct relume_log *log)
{
    const relume_status status = check_replaced(path, log);
    if (status)
        return status;
    struct jwriter w = {0};
    jopen_object(&w, NULL);
    jput_text(&w, "format", FORMAT);
    jput_integer(&w, "version", VERSION);
    jopen_array(&w, "edits");
    for (int i = 0; i < o->info.objects; i++)
        if (o->reflection[i])
            put_edit(&w, i, relume_reflection_edit(o->reflection[i]));
    jgap(&w, "\n");
    return jsave(&w, path, log);
}
