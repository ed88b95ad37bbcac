// handles.c - reflections of mirrors edited by hand: constraints, regions, back and forth
#include "app/handles.h"

#include "common/vec.h"
#include "world/object/drawn_objects.h"
#include "world/reflect/reflection.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 256 };  // that can be undone

const char *const handles_tool_names[HANDLES_TOOLS + 1] = {"move", "ball", "along", "brush", NULL};

void handles_tell(struct handles *h, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(h->said, sizeof h->said, format, args);
    va_end(args);
}

// ---------------------------------------------------------------- edits

static void edit_release(struct handles_edit *e)
{
    for (int i = 0; i < e->edit.regions; i++)
        free((void *)e->region[i].stroke);
    free(e->constraint);
    free(e->mark);
    free(e->region);
    *e = (struct handles_edit){0};
}

static bool copy_regions(struct handles_edit *to, const struct relume_reflection_edit *from)
{
    for (; to->edit.regions < from->regions; to->edit.regions++) {
        struct relume_reflection_region *r = &to->region[to->edit.regions];
        *r = from->region[to->edit.regions];
        if (r->shape != RELUME_REFLECTION_STROKES)
            continue;
        const size_t bytes = (size_t)r->points * sizeof *r->stroke;
        struct relume_vec3 *stroke = malloc(bytes + sizeof *stroke);
        if (!stroke)
            return false;
        memcpy(stroke, r->stroke, bytes);
        r->stroke = stroke;
    }
    return true;
}

// `mark` may be NULL: none is known. False when memory is short; then `to` is empty.
static bool edit_copy(struct handles_edit *to, const struct relume_reflection_edit *from,
                      const struct handles_mark *mark)
{
    *to = (struct handles_edit){.edited = true, .edit = *from};
    to->edit.regions = 0;
    to->constraint = calloc((size_t)from->constraints + 1, sizeof *to->constraint);
    to->mark = calloc((size_t)from->constraints + 1, sizeof *to->mark);
    to->region = calloc((size_t)from->regions + 1, sizeof *to->region);
    if (!to->constraint || !to->mark || !to->region || !copy_regions(to, from)) {
        edit_release(to);
        return false;
    }
    for (int i = 0; i < from->constraints; i++) {
        to->constraint[i] = from->constraint[i];
        if (mark)
            to->mark[i] = mark[i];
    }
    to->edit.constraint = to->constraint;
    to->edit.region = to->region;
    return true;
}

// The same of one that is as it is.
static bool edit_clone(struct handles_edit *to, const struct handles_edit *from)
{
    const bool copied = edit_copy(to, &from->edit, from->mark);
    to->edited = copied && from->edited;
    return copied;
}

// ---------------------------------------------------------------- begin and end

bool handles_mirror(const relume_objects *objects)
{
    const struct relume_objects_info *info = relume_objects_info(objects);
    for (int i = 0; i < info->materials; i++)
        if (info->material[i].mirror)
            return true;
    return false;
}

static bool is_mirror(const struct relume_objects_info *info, const struct relume_object_part *part)
{
    return info->material[part->material].mirror;
}

// Where `e` is seen unedited from the constraint's eye: the vertex that reflects it best.
static void find_red(struct handles_mark *mark, const relume_objects *objects, int object,
                     const struct relume_reflection_constraint *c)
{
    const double NEAR = 0.995;  // cosine: 6 degrees, an edge of a coarse ball or so
    const struct relume_objects_info *info = relume_objects_info(objects);
    double best = NEAR;
    for (int k = 0; k < info->parts; k++) {
        const struct relume_object_part *part = &info->part[k];
        if (part->object != object || !is_mirror(info, part))
            continue;
        for (size_t i = 3 * part->first; i < 3 * (part->first + part->count); i++) {
            const struct relume_mesh_vertex *v = &info->vertices[info->triangles[i / 3][i % 3]];
            const vec3 at =
                vec3_of((double)v->position[0], (double)v->position[1], (double)v->position[2]);
            const vec3 normal =
                vec3_of((double)v->normal[0], (double)v->normal[1], (double)v->normal[2]);
            const vec3 seen = relume_reflection_original(NULL, at, normal, c->eye);
            if (vec3_dot(normal, vec3_sub(c->eye, at)) <= 0.0 || vec3_dot(seen, c->edited) <= best)
                continue;
            best = vec3_dot(seen, c->edited);
            mark->red = at;
            mark->has_red = true;
        }
    }
}

static bool take_edits(struct handles *h)
{
    static const struct relume_reflection_edit none = {.constraints = 0};
    for (int i = 0; i < h->count; i++) {
        const relume_reflection *r = relume_objects_reflections(h->objects, i);
        struct handles_edit *e = &h->now[i];
        if (!edit_copy(e, r ? relume_reflection_edit(r) : &none, NULL))
            return false;
        e->edited = r != NULL;
        for (int k = 0; k < e->edit.constraints; k++)
            find_red(&e->mark[k], h->objects, i, &e->constraint[k]);
    }
    return true;
}

relume_status handles_create(struct handles **out, relume_objects *objects)
{
    const struct relume_objects_info *info = relume_objects_info(objects);
    const double size = vec3_length(vec3_sub(info->max, info->min));
    *out = NULL;
    if (!handles_mirror(objects))
        return RELUME_EUNFIT;
    struct handles *h = calloc(1, sizeof *h);
    if (!h)
        return RELUME_ENOMEM;
    h->objects = objects;
    h->count = info->objects;
    h->size = size;
    h->radius = 0.1 * size;
    h->border = 0.5;
    h->now = calloc((size_t)h->count, sizeof *h->now);
    h->step = calloc(STEPS, sizeof *h->step);
    if (!h->now || !h->step || !take_edits(h)) {
        handles_destroy(&h);
        return RELUME_ENOMEM;
    }
    *out = h;
    return RELUME_OK;
}

static void step_release(struct handles_step *step)
{
    edit_release(&step->before);
    edit_release(&step->after);
}

void handles_destroy(struct handles **handles)
{
    struct handles *h = *handles;
    *handles = NULL;
    if (!h)
        return;
    for (int i = 0; h->now && i < h->count; i++)
        edit_release(&h->now[i]);
    for (int i = 0; i < h->steps; i++)
        step_release(&h->step[i]);
    edit_release(&h->before);
    free(h->now);
    free(h->step);
    free(h);
}

// ---------------------------------------------------------------- changes

static void keep_sentence(void *user, enum relume_level level, const char *text)
{
    struct handles *h = user;
    if (level != RELUME_NOTE && !h->said[0])
        handles_tell(h, "%s", text);
}

// False when the library does not take it.
static bool apply(struct handles *h, int object, bool listens)
{
    const struct relume_log log = {.message = keep_sentence, .user = h};
    const struct handles_edit *e = &h->now[object];
    const relume_status status = relume_objects_set_reflections(
        h->objects, object, e->edited ? &e->edit : NULL,
        relume_reflection_params(.log = listens ? &log : NULL, .name = "reflections"));
    if (status == RELUME_ENOMEM)
        handles_tell(h, "reflections: out of memory");
    return !status;
}

struct handles_edit *handles_begin(struct handles *h, int object)
{
    struct handles_edit *e = &h->now[object], copy;
    if (h->changes)
        return e;
    if (!edit_clone(&copy, e)) {
        handles_tell(h, "reflections: out of memory");
        return NULL;
    }
    h->before = *e;
    *e = copy;
    h->chosen.object = object;
    h->changes = e->edited = true;
    h->shown = false;
    return e;
}

// What is chosen may be gone.
static void choose_again(struct handles *h)
{
    if (!handles_constraint(h) && !handles_region(h))
        h->chosen.kind = HANDLES_NOTHING;
}

void handles_drop(struct handles *h)
{
    struct handles_edit *e = &h->now[h->chosen.object];
    if (!h->changes)
        return;
    edit_release(e);
    *e = h->before;
    h->before = (struct handles_edit){0};
    h->changes = false;
    choose_again(h);
    (void)apply(h, h->chosen.object, false);
}

bool handles_show(struct handles *h)
{
    h->shown = apply(h, h->chosen.object, false);
    if (h->shown)
        return true;
    if (!h->said[0])
        (void)apply(h, h->chosen.object, true);
    handles_drop(h);
    return false;
}

static void drop_undone(struct handles *h)
{
    for (; h->undone; h->undone--)
        step_release(&h->step[--h->steps]);
}

static void drop_oldest(struct handles *h)
{
    if (h->steps < STEPS)
        return;
    step_release(&h->step[0]);
    memmove(h->step, h->step + 1, (STEPS - 1) * sizeof *h->step);
    h->steps--;
}

bool handles_end(struct handles *h, const char *merges)
{
    const int object = h->chosen.object;
    struct handles_step step = {.object = object, .merges = merges};
    if (!h->changes)
        return false;
    if (!apply(h, object, true) || !edit_clone(&step.after, &h->now[object])) {
        handles_drop(h);
        return false;
    }
    drop_undone(h);
    struct handles_step *last = h->steps ? &h->step[h->steps - 1] : NULL;
    if (merges && last && last->merges == merges && last->object == object) {
        edit_release(&last->after);
        edit_release(&h->before);
        last->after = step.after;
    } else {
        drop_oldest(h);
        step.before = h->before;
        h->step[h->steps++] = step;
    }
    h->before = (struct handles_edit){0};
    h->changes = false;
    h->unsaved = true;
    return true;
}

// ---------------------------------------------------------------- back and forth

static bool go_to(struct handles *h, int object, const struct handles_edit *edit)
{
    struct handles_edit was = h->now[object], to;
    if (!edit_clone(&to, edit)) {
        handles_tell(h, "reflections: out of memory");
        return false;
    }
    h->now[object] = to;
    if (!apply(h, object, true)) {
        edit_release(&to);
        h->now[object] = was;
        return false;
    }
    edit_release(&was);
    choose_again(h);
    h->unsaved = true;
    return true;
}

bool handles_undo(struct handles *h)
{
    const int at = h->steps - 1 - h->undone;
    if (h->changes || at < 0 || !go_to(h, h->step[at].object, &h->step[at].before))
        return false;
    h->undone++;
    if (at > 0)
        h->step[at - 1].merges = NULL;
    return true;
}

bool handles_redo(struct handles *h)
{
    const int at = h->steps - h->undone;
    if (h->changes || !h->undone || !go_to(h, h->step[at].object, &h->step[at].after))
        return false;
    h->undone--;
    return true;
}

// ---------------------------------------------------------------- lists

static void choose(struct handles *h, enum handles_kind kind, int number)
{
    h->chosen.kind = kind;
    h->chosen.number = number;
}

bool handles_add_constraint(struct handles *h, struct handles_edit *e,
                            const struct relume_reflection_constraint *constraint)
{
    if (e->edit.constraints >= RELUME_REFLECTION_CONSTRAINTS_MOST) {
        handles_tell(h, "an object has at most %d constraints", RELUME_REFLECTION_CONSTRAINTS_MOST);
        return false;
    }
    e->constraint[e->edit.constraints] = *constraint;
    e->mark[e->edit.constraints] =
        (struct handles_mark){.red = constraint->position, .has_red = true};
    choose(h, HANDLES_CONSTRAINT, e->edit.constraints++);
    return true;
}

bool handles_add_region(struct handles *h, struct handles_edit *e,
                        const struct relume_reflection_region *region)
{
    struct relume_vec3 *stroke = NULL;
    if (e->edit.regions >= RELUME_REFLECTION_REGIONS_MOST) {
        handles_tell(h, "an object has at most %d regions", RELUME_REFLECTION_REGIONS_MOST);
        return false;
    }
    if (region->shape == RELUME_REFLECTION_STROKES) {
        stroke = malloc(sizeof *stroke);
        if (!stroke)
            return false;
        *stroke = region->centre;
    }
    struct relume_reflection_region *to = &e->region[e->edit.regions];
    *to = *region;
    to->stroke = stroke;
    to->points = stroke ? 1 : 0;
    choose(h, HANDLES_REGION, e->edit.regions++);
    return true;
}

bool handles_add_point(struct handles *h, struct relume_reflection_region *region,
                       struct relume_vec3 point)
{
    enum { MOST = 4096 };  // of a file
    struct relume_vec3 *stroke =
        region->points < MOST
            ? realloc((void *)region->stroke, ((size_t)region->points + 1) * sizeof *stroke)
            : NULL;
    if (!stroke) {
        handles_tell(h, "a stroke has at most %d points", MOST);
        return false;
    }
    stroke[region->points++] = point;
    region->stroke = stroke;
    return true;
}

bool handles_remove(struct handles *h)
{
    const struct handles_choice c = h->chosen;
    struct handles_edit *e =
        handles_constraint(h) || handles_region(h) ? handles_begin(h, c.object) : NULL;
    if (!e)
        return false;
    if (c.kind == HANDLES_CONSTRAINT) {
        const size_t after = (size_t)(--e->edit.constraints - c.number);
        memmove(e->constraint + c.number, e->constraint + c.number + 1,
                after * sizeof *e->constraint);
        memmove(e->mark + c.number, e->mark + c.number + 1, after * sizeof *e->mark);
    } else {
        free((void *)e->region[c.number].stroke);
        const size_t after = (size_t)(--e->edit.regions - c.number);
        memmove(e->region + c.number, e->region + c.number + 1, after * sizeof *e->region);
    }
    h->chosen.kind = HANDLES_NOTHING;
    return handles_end(h, NULL);
}

const struct relume_reflection_constraint *handles_constraint(const struct handles *h)
{
    const struct handles_choice c = h->chosen;
    return c.kind == HANDLES_CONSTRAINT && c.number < h->now[c.object].edit.constraints
               ? &h->now[c.object].constraint[c.number]
               : NULL;
}

const struct relume_reflection_region *handles_region(const struct handles *h)
{
    const struct handles_choice c = h->chosen;
    return c.kind == HANDLES_REGION && c.number < h->now[c.object].edit.regions
               ? &h->now[c.object].region[c.number]
               : NULL;
}
