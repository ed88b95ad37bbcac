// export.c - notes for spreadsheets, drawing programs and IIIF viewers
#include "exchange/notes/list.h"

#include "core/base/json_write.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "exchange/notes/shape.h"
#include "exchange/notes/write.h"

#include <math.h>
#include <string.h>

// ---------------------------------------------------------------- CSV (RFC 4180)

// Quoted; spreadsheets take what begins with one of =+-@ for a formula.
static void cell(FILE *f, const char *text)
{
    fputc('"', f);
    if (text && strchr("=+-@\t\r", *text) && *text)
        fputc('\'', f);
    for (; text && *text; text++)
        fputs(*text == '"' ? "\"\"" : (char[]){*text, 0}, f);
    fputc('"', f);
}

static void cell_number(FILE *f, double value)
{
    if (isfinite(value))
        fprintf(f, ",%s", jnumber_text(value).text);
    else
        fputc(',', f);
}

static bool print_csv(FILE *f, const relume_notes *n, const char *canvas)
{
    (void)canvas;
    const double mm = n->mm_per_pixel;
    fprintf(f, "id,kind,places,%s,degrees%s,text,state,creator,created\r\n",
            n->solid ? "length,area" : "length_px,area_px2", mm > 0.0 ? ",length_mm,area_mm2" : "");
    for (int i = 0; i < n->count; i++) {
        const struct relume_note *note = &n->note[i].note;
        const struct relume_note_measures m = relume_note_measure(note);
        cell(f, note->id);
        fprintf(f, ",%s,\"", relume_note_kind_name(note->kind));
        for (int k = 0; k < note->places; k++)
            fprintf(f, "%s%s %s%s%s", k ? ", " : "", jnumber_text(note->place[k][0]).text,
                    jnumber_text(note->place[k][1]).text, note->z ? " " : "",
                    note->z ? jnumber_text(note->z[k]).text : "");
        fputc('"', f);
        cell_number(f, m.length);
        cell_number(f, m.area);
        cell_number(f, m.degrees);
        if (mm > 0.0) {
            cell_number(f, m.length * mm);
            cell_number(f, m.area * mm * mm);
        }
        const char *const texts[] = {note->text, note->state, note->creator, note->created};
        for (int k = 0; k < 4; k++) {
            fputc(',', f);
            cell(f, texts[k]);
        }
        fputs("\r\n", f);
    }
    return true;
}

// ---------------------------------------------------------------- SVG

static void escape(FILE *f, const char *text)
{
    uint32_t code;
    for (int step; (step = relume_text_step(&code, text)); text += step) {
        if (code == '<' || code == '>' || code == '&' || code == '"' || code == '\'')
            fprintf(f, "&#%u;", (unsigned)code);
        else if (code >= ' ' || code == '\n' || code == '\t')
            fwrite(text, 1, (size_t)step, f);
    }
}

// `at` is where the note is seen, the note itself or its picture.
static void print_label(FILE *f, const struct relume_note *note, const struct relume_note *at,
                        double mm, double size)
{
    const struct relume_note_measures m = relume_note_measure(note);
    fprintf(f, "<text x=\"%g\" y=\"%g\">", at->place[0][0] + size * 0.6,
            at->place[0][1] - size * 0.6);
    if (note->text)
        escape(f, note->text);
    if (note->kind == RELUME_NOTE_LINE && isfinite(m.length))
        fprintf(f, "%s%.4g %s", note->text ? " " : "", m.length * (mm > 0.0 ? mm : 1.0),
                mm > 0.0  ? "mm"
                : note->z ? "units"
                          : "px");
    fputs("</text>\n", f);
}

static void print_shape(FILE *f, const struct relume_note *note, const struct relume_note *at,
                        double mm, double size)
{
    fputs("<g id=\"", f);
    escape(f, note->id);
    fputs("\">", f);
    if (note->kind == RELUME_NOTE_POINT)
        fprintf(f, "<circle cx=\"%s\" cy=\"%s\" r=\"%g\"/>", jnumber_text(at->place[0][0]).text,
                jnumber_text(at->place[0][1]).text, size / 3.0);
    else {
        fputs("<path d=\"", f);
        shape_print_path(f, at);
        fputs("\"/>", f);
    }
    fputs("<g fill=\"#ffd000\" stroke=\"none\">", f);
    print_label(f, note, at, mm, size);
    fputs("</g></g>\n", f);
}

// Shapes of a picture of `width` x `height` pixels; `print` prints them.
static bool print_frame(FILE *f, int width, int height, const relume_notes *n,
                        bool (*print)(FILE *f, const struct relume_note *note, double mm,
                                      double size, const struct relume_notes_sight *sight),
                        const struct relume_notes_sight *sight)
{
    const double size = fmax(width, height) / 64.0;
    bool good = true;
    fprintf(f,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
            "viewBox=\"0 0 %d %d\" fill=\"none\" stroke=\"#ffd000\" stroke-width=\"%g\" "
            "font-family=\"sans-serif\" font-size=\"%g\">\n",
            width, height, width, height, size / 8.0, size);
    for (int i = 0; good && i < n->count; i++)
        if (n->note[i].note.kind != RELUME_NOTE_VIEW)
            good = print(f, &n->note[i].note, n->mm_per_pixel, size, sight);
    fputs("</svg>\n", f);
    return good;
}

static bool print_as_it_is(FILE *f, const struct relume_note *note, double mm, double size,
                           const struct relume_notes_sight *sight)
{
    (void)sight;
    print_shape(f, note, note, mm, size);
    return true;
}

static bool print_svg(FILE *f, const relume_notes *n, const char *canvas)
{
    (void)canvas;
    return print_frame(f, n->width, n->height, n, print_as_it_is, NULL);
}

// False: no memory.
static bool print_seen(FILE *f, const struct relume_note *note, double mm, double size,
                       const struct relume_notes_sight *sight)
{
    double(*place)[2] = mem_array((size_t)note->places, sizeof *place);
    if (!place)
        return false;
    bool seen = true;
    for (int i = 0; seen && i < note->places; i++)
        seen = sight->see(sight->context, place[i],
                          (double[3]){note->place[i][0], note->place[i][1], note->z[i]});
    struct relume_note at = *note;
    at.place = (const double(*)[2])place;
    at.z = NULL;
    if (seen)
        print_shape(f, note, &at, mm, size);
    mem_free(place);
    return true;
}

// ---------------------------------------------------------------- IIIF

static bool print_iiif(FILE *f, const relume_notes *n, const char *canvas)
{
    struct jwriter w = {.file = f};
    char *id = mem_format("%s/notes", canvas ? canvas : n->name);
    jopen_object(&w, NULL);
    jput_raw(
        &w, "@context",
        "[\"http://www.w3.org/ns/anno.jsonld\",\n"
        "  \"http://iiif.io/api/presentation/3/context.json\", {\"relume\": \"urn:relume:\"}]");
    jgap(&w, "\n");
    jput_text(&w, "id", id);
    jput_text(&w, "type", "AnnotationPage");
    jgap(&w, "\n");
    jopen_array(&w, "items");
    for (int i = 0; i < n->count; i++)
        note_put(&w, &n->note[i].note, canvas ? canvas : n->name);
    const bool good = id && !jend(&w);
    mem_free(id);
    return good;
}

// ---------------------------------------------------------------- all

static const struct {
    const char *name;
    bool (*print)(FILE *f, const relume_notes *notes, const char *canvas);
} formats[] = {
    [RELUME_NOTES_CSV] = {"csv", print_csv},
    [RELUME_NOTES_SVG] = {"svg", print_svg},
    [RELUME_NOTES_IIIF] = {"iiif", print_iiif},
};

static relume_status save(FILE *f, bool good, char **text, const size_t *size, const char *path,
                          const struct relume_log *log)
{
    const relume_status status =
        !fclose(f) && good ? outfile_save(path, *text, *size, log) : RELUME_ENOMEM;
    mem_free_libc(*text);
    return status;
}

relume_status relume_notes_write(const relume_notes *notes, const char *path,
                                 enum relume_notes_format format, const char *canvas,
                                 const struct relume_log *log)
{
    char *text = NULL;
    size_t size = 0;
    if (notes->solid && format == RELUME_NOTES_SVG)
        return log_fail(log, RELUME_EUNSUPPORTED,
                        "notes on an object have an overlay of a picture alone; expected csv or "
                        "iiif");
    FILE *f = open_memstream(&text, &size);
    if (!f)
        return RELUME_ENOMEM;
    return save(f, formats[format].print(f, notes, canvas), &text, &size, path, log);
}

relume_status relume_notes_write_overlay(const relume_notes *notes, const char *path,
                                         const struct relume_notes_sight *sight,
                                         const struct relume_log *log)
{
    char *text = NULL;
    size_t size = 0;
    if (!notes->solid || sight->width < 1 || sight->height < 1)
        return log_fail(log, RELUME_EINVAL, "expected notes on an object, and a picture of it");
    FILE *f = open_memstream(&text, &size);
    if (!f)
        return RELUME_ENOMEM;
    return save(f, print_frame(f, sight->width, sight->height, notes, print_seen, sight), &text,
                &size, path, log);
}
