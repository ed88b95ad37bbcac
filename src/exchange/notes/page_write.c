// page_write.c - notes as a page of annotations
#include "exchange/notes/list.h"

#include "core/base/json_write.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "exchange/notes/shape.h"
#include "exchange/notes/write.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

static void put_member(struct jwriter *w, const char *name, const char *text)
{
    if (text)
        jput_text(w, name, text);
}

static void put_target(struct jwriter *w, const struct relume_note *note, const char *source)
{
    jopen_object(w, "target");
    jput_text(w, "type", "SpecificResource");
    put_member(w, "source", source);
    if (note->kind != RELUME_NOTE_VIEW) {
        jgap(w, "\n    ");
        shape_put(w, "selector", note);
    }
    if (note->state) {
        jgap(w, "\n    ");
        jopen_object(w, "state");
        jput_text(w, "type", "relume:State");
        jput_text(w, "value", note->state);
        jclose(w);
    }
    jclose(w);
}

void note_put(struct jwriter *w, const struct relume_note *note, const char *source)
{
    jgap(w, "\n");
    jopen_object(w, NULL);
    jput_text(w, "id", note->id);
    jput_text(w, "type", "Annotation");
    jput_text(w, "motivation", note->kind == RELUME_NOTE_VIEW ? "bookmarking" : "commenting");
    put_member(w, "creator", note->creator);
    put_member(w, "created", note->created);
    if (note->text) {
        jgap(w, "\n  ");
        jopen_object(w, "body");
        jput_text(w, "type", "TextualBody");
        jput_text(w, "format", "text/plain");
        jput_text(w, "value", note->text);
        jclose(w);
    }
    jgap(w, "\n  ");
    put_target(w, note, source);
    jclose(w);
}

static void put_file(struct jwriter *w, const relume_notes *notes)
{
    jopen_object(w, "relume:file");
    jput_text(w, "name", notes->name);
    if (notes->width) {
        jput_integer(w, "width", notes->width);
        jput_integer(w, "height", notes->height);
        jput_integer(w, "views", notes->views);
    }
    if (notes->solid) {
        jput_numbers(w, "min", notes->box[0], 3, 0);
        jput_numbers(w, "max", notes->box[1], 3, 0);
    }
    jclose(w);
}

static void put_page(struct jwriter *w, const relume_notes *notes)
{
    jopen_object(w, NULL);
    jput_raw(w, "@context",
             "[\"http://www.w3.org/ns/anno.jsonld\", {\"relume\": \"urn:relume:\"}]");
    jgap(w, "\n");
    jput_text(w, "id", "#notes");
    jput_text(w, "type", "AnnotationPage");
    jgap(w, "\n");
    put_file(w, notes);
    if (notes->mm_per_pixel > 0.0) {
        jgap(w, "\n");
        jput_number(w, notes_scale_name(notes), notes->mm_per_pixel, 0);
    }
    jgap(w, "\n");
    jopen_array(w, "items");
    for (int i = 0; i < notes->count; i++) {
        if (notes->note[i].raw) {
            jgap(w, "\n");
            jput_raw(w, NULL, notes->note[i].raw);
        } else {
            note_put(w, &notes->note[i].note, notes->name);
        }
    }
}

static bool is_empty(const relume_notes *notes)
{
    return !notes->count && notes->mm_per_pixel == 0.0;
}

relume_status relume_notes_text(char **out, const relume_notes *notes)
{
    struct jwriter w = {0};
    *out = NULL;
    if (is_empty(notes))
        return RELUME_OK;
    put_page(&w, notes);
    jend(&w);
    *out = jtake(&w, NULL);
    return *out ? RELUME_OK : RELUME_ENOMEM;
}

relume_status relume_notes_unlink(const char *path, const struct relume_log *log)
{
    char *name = notes_name(path);
    relume_status status = name ? RELUME_OK : RELUME_ENOMEM;
    if (name && unlink(name) && errno != ENOENT)
        status = log_fail(log, RELUME_EIO, "%s: cannot be removed; %s", name, strerror(errno));
    mem_free(name);
    return status;
}

relume_status relume_notes_save(const relume_notes *notes, const char *path,
                                const struct relume_log *log)
{
    if (is_empty(notes) && !notes->inside)
        return relume_notes_unlink(path, log);
    char *name = notes_name(path);
    struct jwriter w = {.status = name ? RELUME_OK : RELUME_ENOMEM};
    put_page(&w, notes);
    const relume_status status = jsave(&w, name, log);
    mem_free(name);
    return status;
}
