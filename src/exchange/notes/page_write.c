// page_write.c - notes as a page of annotations
#include "exchange/notes/list.h"

#include "core/base/json.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "exchange/notes/shape.h"
#include "exchange/notes/write.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

bool note_quote(FILE *f, const char *text)
{
    char *quoted = jvalue_quote(text);
    fputs(quoted ? quoted : "\"\"", f);
    mem_free(quoted);
    return quoted != NULL;
}

static bool member(FILE *f, const char *name, const char *text)
{
    if (!text)
        return true;
    fprintf(f, ", \"%s\": ", name);
    return note_quote(f, text);
}

bool note_print(FILE *f, const struct relume_note *note, const char *source)
{
    bool good = true;
    fputs("{\"id\": ", f);
    good = note_quote(f, note->id) && good;
    fprintf(f, ", \"type\": \"Annotation\", \"motivation\": \"%s\"",
            note->kind == RELUME_NOTE_VIEW ? "bookmarking" : "commenting");
    good = member(f, "creator", note->creator) && good;
    good = member(f, "created", note->created) && good;
    if (note->text) {
        fputs(",\n  \"body\": {\"type\": \"TextualBody\", \"format\": \"text/plain\"", f);
        good = member(f, "value", note->text) && good;
        fputc('}', f);
    }
    fputs(",\n  \"target\": {\"type\": \"SpecificResource\"", f);
    good = member(f, "source", source) && good;
    if (note->kind != RELUME_NOTE_VIEW) {
        fputs(",\n    \"selector\": ", f);
        shape_print(f, note);
    }
    if (note->state) {
        fputs(",\n    \"state\": {\"type\": \"relume:State\"", f);
        good = member(f, "value", note->state) && good;
        fputc('}', f);
    }
    fputs("}}", f);
    return good;
}

static void print_box(FILE *f, const relume_notes *notes)
{
    for (int k = 0; k < 2; k++) {
        fprintf(f, ", \"%s\": [", k ? "max" : "min");
        for (int c = 0; c < 3; c++)
            fprintf(f, "%s%s", c ? ", " : "", jvalue_number_text(notes->box[k][c]).text);
        fputc(']', f);
    }
}

static bool print_page(FILE *f, const relume_notes *notes)
{
    bool good = true;
    fputs("{\"@context\": [\"http://www.w3.org/ns/anno.jsonld\", {\"relume\": \"urn:relume:\"}],\n"
          "\"id\": \"#notes\", \"type\": \"AnnotationPage\",\n\"relume:file\": {\"name\": ",
          f);
    good = note_quote(f, notes->name) && good;
    if (notes->width)
        fprintf(f, ", \"width\": %d, \"height\": %d, \"views\": %d", notes->width, notes->height,
                notes->views);
    if (notes->solid)
        print_box(f, notes);
    fputs("},\n", f);
    if (notes->mm_per_pixel > 0.0)
        fprintf(f, "\"%s\": %s,\n", notes_scale_name(notes),
                jvalue_number_text(notes->mm_per_pixel).text);
    fputs("\"items\": [", f);
    for (int i = 0; i < notes->count; i++) {
        fputs(i ? ",\n" : "\n", f);
        if (notes->note[i].raw)
            fputs(notes->note[i].raw, f);
        else
            good = note_print(f, &notes->note[i].note, notes->name) && good;
    }
    fputs("]}\n", f);
    return good;
}

static bool is_empty(const relume_notes *notes)
{
    return !notes->count && notes->mm_per_pixel == 0.0;
}

// What print_page says, *size bytes, to be freed by mem_free_libc.
static relume_status print_text(char **text, size_t *size, const relume_notes *notes)
{
    *text = NULL;
    FILE *f = open_memstream(text, size);
    const bool good = f && print_page(f, notes);
    return f && !fclose(f) && good ? RELUME_OK : RELUME_ENOMEM;
}

relume_status relume_notes_text(char **out, const relume_notes *notes)
{
    char *text = NULL;
    size_t size = 0;
    *out = NULL;
    if (is_empty(notes))
        return RELUME_OK;
    const relume_status status = print_text(&text, &size, notes);
    if (!status)
        *out = mem_text(text);
    mem_free_libc(text);
    return status || *out ? status : RELUME_ENOMEM;
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
    char *text = NULL;
    size_t size = 0;
    if (is_empty(notes) && !notes->inside)
        return relume_notes_unlink(path, log);
    char *name = notes_name(path);
    relume_status status = name ? print_text(&text, &size, notes) : RELUME_ENOMEM;
    if (!status)
        status = outfile_save(name, text, size, log);
    mem_free_libc(text);
    mem_free(name);
    return status;
}
