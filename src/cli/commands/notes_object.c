// notes_object.c - relume notes on an object: what an eye sees of them
#include "cli/commands/notes_object.h"

#include <relume/core/vec.h>
#include <relume/relight/slab_set.h>
#include <relume/world/object.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double behind = 0.01;  // diagonals under the surface that still are on it, as on pages
enum { SAMPLES = 256 };             // of a profile

struct sight {
    relume_objects *objects;
    struct relume_window window;
    struct relume_vec3 middle, eye;
    double across;  // the diagonal of the box
    int size[2];
};

static relume_status open_sight(struct sight *s, const struct notes_sight *given)
{
    const struct relume_log *log = given->args->log;
    const relume_status status =
        relume_objects_open(&s->objects, given->args->input[0],
                            relume_objects_params(.log = log, .threads = given->args->threads));
    if (status)
        return status;
    const struct relume_objects_info *i = relume_objects_info(s->objects);
    const struct relume_vec3 from = {0.0, 0.6, 1.8};
    s->middle = relume_vec3_scale(relume_vec3_add(i->min, i->max), 0.5);
    s->across = relume_vec3_length(relume_vec3_sub(i->max, i->min));
    s->eye = given->eye ? *given->eye : relume_vec3_along(s->middle, from, s->across);
    return RELUME_OK;
}

// The first place of the surface along a ray; false where there is none.
static bool meet(struct relume_vec3 *out, const struct sight *s, struct relume_vec3 from,
                 struct relume_vec3 way)
{
    struct relume_object_reflection hit;
    if (!relume_objects_reflect(&hit, s->objects, from, way))
        return false;
    *out = hit.place.position;
    return true;
}

// ---------------------------------------------------------------- overlay

// Pixels of the picture; false behind the eye and behind the surface.
static bool see(void *context, double xy[2], const double place[3])
{
    const struct sight *s = context;
    const struct relume_window *w = &s->window;
    const struct relume_vec3 to =
        relume_vec3_sub(relume_vec3_of(place[0], place[1], place[2]), w->eye);
    const struct relume_vec3 corner = relume_vec3_sub(w->corner, w->eye);
    const struct relume_vec3 ahead = relume_vec3_cross(w->down, w->right);
    const double far = relume_vec3_dot(to, ahead) / relume_vec3_dot(corner, ahead);
    struct relume_vec3 first;
    if (!(far > 0.0))
        return false;
    const struct relume_vec3 on = relume_vec3_sub(relume_vec3_scale(to, 1.0 / far), corner);
    xy[0] = relume_vec3_dot(on, w->right) / relume_vec3_dot(w->right, w->right) * s->size[0];
    xy[1] = relume_vec3_dot(on, w->down) / relume_vec3_dot(w->down, w->down) * s->size[1];
    return !meet(&first, s, w->eye, to) || relume_vec3_length(relume_vec3_sub(first, w->eye)) >=
                                               relume_vec3_length(to) - behind * s->across;
}

relume_status notes_object_overlay(const relume_notes *notes, const struct notes_sight *sight)
{
    struct sight s = {
        .size = {sight->size[0] ? sight->size[0] : 512, sight->size[1] ? sight->size[1] : 512}};
    const struct relume_look_at look = {.aimed = false};
    relume_status status = open_sight(&s, sight);
    if (!status && !relume_objects_window(&s.window, s.objects, s.eye, &look, s.size[0], s.size[1]))
        status = usage_error("--eye: expected a point away from the middle of the object");
    if (!status)
        status = relume_notes_write_overlay(
            notes, sight->output,
            &(struct relume_notes_sight){
                .width = s.size[0], .height = s.size[1], .see = see, .context = &s},
            sight->args->log);
    relume_objects_destroy(&s.objects);
    return status;
}

// ---------------------------------------------------------------- profile

struct table {
    const struct sight *sight;
    const struct relume_note *note;
    double mm, length;
};

static struct relume_vec3 place_of(const struct relume_note *n, int i)
{
    return relume_vec3_of(n->place[i][0], n->place[i][1], n->z[i]);
}

// At the share `t` of a leg: rays come down from as high as the leg is long, across it in the plane
// of the eye, so that what lies before the surface elsewhere does not count.
static bool rise(struct relume_vec3 *on, double *height, const struct sight *s,
                 struct relume_vec3 a, struct relume_vec3 b, double t)
{
    const struct relume_vec3 leg = relume_vec3_sub(b, a), at = relume_vec3_along(a, leg, t);
    const struct relume_vec3 to = relume_vec3_sub(s->eye, relume_vec3_along(a, leg, 0.5));
    const double reach = relume_vec3_length(leg);
    const struct relume_vec3 up =
        relume_vec3_unit(relume_vec3_along(to, leg, -relume_vec3_dot(to, leg) / (reach * reach)));
    const struct relume_vec3 top = relume_vec3_along(at, up, reach);
    if (!meet(on, s, top, relume_vec3_scale(up, -1.0)))
        return false;
    *height = reach - relume_vec3_length(relume_vec3_sub(*on, top));
    return *height >= -reach;
}

static void print_row(FILE *f, const struct table *t, double along, int leg, double share)
{
    struct relume_vec3 on;
    double height;
    fprintf(f, "%.6g", along);
    const bool known =
        rise(&on, &height, t->sight, place_of(t->note, leg), place_of(t->note, leg + 1), share);
    if (known)
        fprintf(f, ",%.6g,%.6g,%.6g,%.6g", on.x, on.y, on.z, height);
    else
        fputs(",,,,", f);
    if (t->mm > 0.0)
        fprintf(f, ",%.6g,", along * t->mm);
    if (t->mm > 0.0 && known)
        fprintf(f, "%.6g", height * t->mm);
    fputs("\r\n", f);
}

static void print_profile(const void *context, FILE *f)
{
    const struct table *t = context;
    double before = 0.0;
    int leg = 0;
    fprintf(f, "along,x,y,z,height%s\r\n", t->mm > 0.0 ? ",along_mm,height_mm" : "");
    for (int k = 0; k < SAMPLES; k++) {
        const double along = t->length * k / (SAMPLES - 1);
        double length;
        while ((length = relume_vec3_length(
                    relume_vec3_sub(place_of(t->note, leg + 1), place_of(t->note, leg)))),
               leg + 2 < t->note->places && along > before + length) {
            before += length;
            leg++;
        }
        print_row(f, t, along, leg, length > 0.0 ? fmin((along - before) / length, 1.0) : 0.0);
    }
}

// The eye that a state line has.
static bool eye_of(struct relume_vec3 *out, const char *state)
{
    for (const char *at = state; at && *at; at += strcspn(at, "&"), at += *at == '&')
        if (sscanf(at, "eye=%lf,%lf,%lf", &out->x, &out->y, &out->z) == 3)
            return isfinite(out->x) && isfinite(out->y) && isfinite(out->z);
    return false;
}

relume_status notes_object_profile(const relume_notes *notes, const struct relume_note *note,
                                   const struct notes_sight *sight)
{
    struct sight s = {.size = {0}};
    struct relume_vec3 eye;
    struct notes_sight given = *sight;
    if (!given.eye) {
        if (!eye_of(&eye, note->state))
            return usage_error("--profile: note '%s' keeps no eye; expected --eye, above the line",
                               note->id);
        given.eye = &eye;
    }
    const struct table t = {&s, note, relume_notes_scale(notes), relume_note_measure(note).length};
    if (!(t.length > 0.0))
        return usage_error("--profile: note '%s' has no length", note->id);
    relume_status status = open_sight(&s, &given);
    if (!status)
        status = relume_file_print(sight->output, print_profile, &t, sight->args->log);
    relume_objects_destroy(&s.objects);
    return status;
}
