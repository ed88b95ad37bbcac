// page_read.c - a page of annotations, ours or another program's, as notes
#include "exchange/notes/list.h"

#include "core/base/infile.h"
#include "core/base/json.h"
#include "core/base/memory.h"
#include "exchange/notes/shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const jvalue *first(const jvalue *value)
{
    return jvalue_is_array(value) ? jvalue_item(value, 0) : value;
}

// The first text among an annotation's bodies.
static const char *text_of(const jvalue *item)
{
    const jvalue *body = jvalue_member(item, "body");
    if (jvalue_text(body))
        return jvalue_text(body);
    if (jvalue_is_object(body))
        return jvalue_text(jvalue_member(body, "value"));
    for (size_t i = 0; i < jvalue_count(body); i++) {
        const char *text = jvalue_text(jvalue_member(jvalue_item(body, i), "value"));
        if (text)
            return text;
    }
    return jvalue_text(jvalue_member(item, "bodyValue"));
}

static const char *state_of(const jvalue *target)
{
    const jvalue *state = jvalue_member(target, "state");
    const size_t n = jvalue_is_array(state) ? jvalue_count(state) : 1;
    for (size_t i = 0; i < n; i++) {
        const jvalue *one = jvalue_is_array(state) ? jvalue_item(state, i) : state;
        const char *type = jvalue_text(jvalue_member(one, "type"));
        if (type && !strcmp(type, "relume:State"))
            return jvalue_text(jvalue_member(one, "value"));
    }
    return NULL;
}

static const char *name_of(const jvalue *agent)
{
    agent = first(agent);
    const char *text = jvalue_text(agent);
    return text ? text : jvalue_text(jvalue_member(agent, "name"));
}

// Of "canvas#xywh=1,2,3,4", as IIIF writes it.
static relume_status shape_of_address(struct shape *out, const char *address)
{
    const char *at = strchr(address, '#');
    *out = (struct shape){.kind = RELUME_NOTE_VIEW};
    return at && !strncmp(at, "#xywh=", 6) ? shape_read_fragment(out, at + 1) : RELUME_OK;
}

static relume_status shape_of(struct shape *out, const jvalue *target)
{
    const jvalue *selector = first(jvalue_member(target, "selector"));
    const char *address = jvalue_text(target);
    if (!address)
        address = jvalue_text(jvalue_member(target, "source"));
    if (selector)
        return shape_read(out, selector);
    return shape_of_address(out, address ? address : "");
}

// Notes of kinds that are not known here are left out with a warning.
static relume_status read_item(relume_notes *notes, const jvalue *item, size_t number,
                               const struct relume_log *log)
{
    struct log_place place;
    const struct relume_log *at = log_at(&place, log, "note %zu: ", number);
    const jvalue *target = first(jvalue_member(item, "target"));
    struct shape shape;
    relume_status status = shape_of(&shape, target);
    if (status == RELUME_EUNSUPPORTED) {
        log_line(at, RELUME_WARNING,
                 "its place is neither a point, a line nor a polygon; it is left out");
        return RELUME_OK;
    }
    if (status == RELUME_EFORMAT)
        return log_fail(at, status,
                        "its selector cannot be read; expected a PointSelector, an "
                        "SvgSelector or xywh=");
    if (status)
        return status;
    const struct relume_note note = {
        .kind = shape.kind,
        .places = shape.places,
        .place = (const double(*)[2])shape.place,
        .text = text_of(item),
        .state = state_of(target),
        .creator = name_of(jvalue_member(item, "creator")),
        .created = jvalue_text(jvalue_member(item, "created")),
        .id = jvalue_text(jvalue_member(item, "id")),
        .z = shape.z,
    };
    char *raw = jvalue_print(item);
    status = raw ? notes_append(notes, &note, raw, at) : RELUME_ENOMEM;
    if (status)
        mem_free(raw);
    shape_free(&shape);
    return status == RELUME_EINVAL ? RELUME_EFORMAT : status;
}

static int by_id(const void *a, const void *b)
{
    const struct kept_note *const *x = a, *const *y = b;
    return strcmp((*x)->note.id, (*y)->note.id);
}

static relume_status check_names(const relume_notes *notes, const struct relume_log *log)
{
    relume_status status = RELUME_OK;
    const struct kept_note **order = mem_array((size_t)notes->count, sizeof *order);
    if (!order)
        return RELUME_ENOMEM;
    for (int i = 0; i < notes->count; i++)
        order[i] = &notes->note[i];
    qsort(order, (size_t)notes->count, sizeof *order, by_id);
    for (int i = 1; !status && i < notes->count; i++)
        if (!by_id(&order[i - 1], &order[i]))
            status = log_fail(log, RELUME_EFORMAT, "two notes have the id '%s'", order[i]->note.id);
    mem_free(order);
    return status;
}

static relume_status read_file(const relume_notes *notes, const jvalue *file,
                               const struct relume_log *log)
{
    int width = 0, height = 0, views = 0;
    if (!jvalue_whole(jvalue_member(file, "width"), 1, 1 << 30, &width) ||
        !jvalue_whole(jvalue_member(file, "height"), 1, 1 << 30, &height) ||
        !jvalue_whole(jvalue_member(file, "views"), 1, 1 << 30, &views))
        return log_fail(log, RELUME_EFORMAT, "\"relume:file\"; expected width, height and views");
    if (width != notes->width || height != notes->height || views != notes->views)
        return log_fail(log, RELUME_EUNFIT,
                        "these notes are on a file of %d view%s of %d x %d pixels; found %d of "
                        "%d x %d in %s",
                        views, relume_plural(views), width, height, notes->views, notes->width,
                        notes->height, notes->name);
    return RELUME_OK;
}

// An object's box, whose corners may be off by a thousandth of it: a page has them rounded.
static relume_status read_box(const relume_notes *notes, const jvalue *file,
                              const struct relume_log *log)
{
    static const char *const names[] = {"min", "max"};
    double corner[3], away = 0.0, across = 0.0;
    for (int k = 0; k < 2; k++) {
        if (!jvalue_numbers(jvalue_member(file, names[k]), corner, 3))
            return log_fail(log, RELUME_EFORMAT,
                            "\"relume:file\"; expected min and max of the object");
        for (int c = 0; c < 3; c++) {
            away = fmax(away, fabs(corner[c] - notes->box[k][c]));
            across = fmax(across, notes->box[1][c] - notes->box[0][c]);
        }
    }
    if (!(away <= 1e-3 * across))
        return log_fail(log, RELUME_EUNFIT, "these notes are on an object of another shape than %s",
                        notes->name);
    return RELUME_OK;
}

static relume_status read_scale(relume_notes *notes, const jvalue *root,
                                const struct relume_log *log)
{
    const char *name = notes_scale_name(notes);
    const jvalue *scale = jvalue_member(root, name);
    double mm = 0.0;
    if (scale && (!jvalue_number(scale, &mm) || relume_notes_set_scale(notes, mm)))
        return log_fail(log, RELUME_EFORMAT, "\"%s\"; expected a number above 0", name);
    return RELUME_OK;
}

// What a page of ours says of its file.
static relume_status read_head(relume_notes *notes, const jvalue *root,
                               const struct relume_log *log)
{
    const jvalue *file = jvalue_member(root, "relume:file");
    if (!file)
        return RELUME_OK;
    const bool boxed = jvalue_member(file, "min") != NULL;
    relume_status status = RELUME_OK;
    if (notes->width)
        status = read_file(notes, file, log);
    if (!status && notes->solid && (boxed || !notes->width))
        status = read_box(notes, file, log);
    return status ? status : read_scale(notes, root, log);
}

static relume_status read_page(relume_notes *notes, const jvalue *root,
                               const struct relume_log *log)
{
    const char *type = jvalue_text(jvalue_member(root, "type"));
    const jvalue *items = jvalue_member(root, "items");
    if (!type || strcmp(type, "AnnotationPage") || !jvalue_is_array(items))
        return log_fail(log, RELUME_EFORMAT,
                        "no notes; expected \"type\": \"AnnotationPage\" and its items");
    relume_status status = read_head(notes, root, log);
    for (size_t i = 0; !status && i < jvalue_count(items); i++)
        status = read_item(notes, jvalue_item(items, i), i + 1, log);
    return status ? status : check_names(notes, log);
}

static relume_status read_named(relume_notes *notes, const char *name, bool replaced,
                                const struct relume_log *log)
{
    jvalue *root = NULL;
    struct log_place place;
    struct relume_log own = log ? *log : (struct relume_log){0};
    own.leave_unnoted = replaced;
    relume_status status = jvalue_load(&root, name, &own);
    if (!status)
        status = read_page(notes, root, log_at(&place, log, "%s: ", name));
    jvalue_free(&root);
    return status;
}

static relume_status read_inside(relume_notes *notes, const char *text, const char *path,
                                 const struct relume_log *log)
{
    jvalue *root = NULL;
    struct log_place place;
    const struct relume_log *at = log_at(&place, log, "%s: the notes inside: ", path);
    relume_status status = jvalue_parse(&root, text, at);
    if (!status)
        status = read_page(notes, root, at);
    jvalue_free(&root);
    return status;
}

relume_status relume_notes_open(relume_notes **out, const char *path,
                                const struct relume_notes_file *file, const struct relume_log *log)
{
    relume_status status = relume_notes_create(out, file);
    if (status)
        return status;
    char *name = notes_name(path);
    status = !name                     ? RELUME_ENOMEM
             : input_exists(name, log) ? read_named(*out, name, true, log)
             : file->inside            ? read_inside(*out, file->inside, path, log)
                                       : RELUME_OK;
    mem_free(name);
    if (status)
        relume_notes_destroy(out);
    return status;
}

static bool same_text(const char *a, const char *b)
{
    return a && b ? !strcmp(a, b) : a == b;
}

static bool same_note(const struct relume_note *a, const struct relume_note *b)
{
    return a->kind == b->kind && a->places == b->places && same_text(a->text, b->text) &&
           same_text(a->state, b->state) &&
           (!a->places || !memcmp(a->place, b->place, (size_t)a->places * sizeof *a->place)) &&
           (!a->z || !memcmp(a->z, b->z, (size_t)a->places * sizeof *a->z));
}

relume_status relume_notes_import(relume_notes *notes, const char *path, int *added,
                                  const struct relume_log *log)
{
    relume_notes *other = NULL;
    struct relume_notes_file file = {.name = notes->name,
                                     .width = notes->width,
                                     .height = notes->height,
                                     .views = notes->views,
                                     .solid = notes->solid};
    memcpy(file.box, notes->box, sizeof file.box);
    relume_status status = relume_notes_create(&other, &file);
    *added = 0;
    if (!status)
        status = read_named(other, path, false, log);
    for (int i = 0; !status && i < other->count; i++) {
        struct kept_note *from = &other->note[i];
        const int there = relume_notes_find(notes, from->note.id);
        if (there >= 0 && same_note(&from->note, &notes->note[there].note))
            continue;
        struct relume_note note = from->note;
        if (there >= 0)
            note.id = NULL;
        status = notes_append(notes, &note, there < 0 ? from->raw : NULL, log);
        if (!status && there < 0)
            from->raw = NULL;
        *added += !status;
    }
    if (!status && notes->mm_per_pixel == 0.0)
        notes->mm_per_pixel = other->mm_per_pixel;
    relume_notes_destroy(&other);
    return status;
}
