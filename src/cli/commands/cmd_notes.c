// cmd_notes.c - relume notes: what people write on a picture or a baked object, kept beside its
// file
#include "cli/cli.h"

#include "cli/commands/notes_object.h"
#include "cli/program/notes_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct notes_options {
    struct args args;
    struct texts add, remove, import;
    const char *text, *state, *creator, *rewrite;
    double scale, length;
    const char *ruler, *profile, *output, *canvas;
    int view, picture[2];
    struct relume_vec3 eye;
    enum { TO_NOTHING, TO_CSV, TO_SVG, TO_IIIF } to;
    bool embed, extract, json;
};
#define OPTIONS struct notes_options

static const struct option options[] = {
    GROUP("new notes"),
    TEXTS("--add", add, "NOTE",
          "'point X,Y', 'line X,Y X,Y ...', 'polygon X,Y X,Y X,Y ...' in pixels from the upper "
          "left corner, of an object X,Y,Z in its own units, or 'view' for a saved view; "
          "repeatable"),
    TEXT("--text", text, "TEXT", "what the new notes say"),
    TEXT("--state", state, "LINE",
         "the light, eye and pass that they keep, as the pages and viewers copy it"),
    TEXT("--creator", creator, "NAME", "who made them"),
    GROUP("the list"),
    TEXTS("--remove", remove, "ID", "remove this note; repeatable"),
    TEXT("--rewrite", rewrite, "ID", "give this note the new --text"),
    TEXTS("--import", import, "FILE.json",
          "add the notes of this file, as pages save them; repeatable"),
    FLAG("--embed", embed, "keep the list inside the relume file, no longer beside it"),
    FLAG("--extract", extract, "keep the list beside the file, no longer inside it"),
    NUMBER("--scale", scale, "MM", "one pixel, of an object one unit, is so many millimetres wide",
           1e-9, 1e9),
    TEXT("--ruler", ruler, "ID", "this line is --length long: sets the scale"),
    NUMBER("--length", length, "MM", "the length of --ruler in millimetres", 1e-9, 1e12),
    GROUP("output"),
    NAME("--to", to, "FORMAT", "csv: a table; svg: an overlay; iiif: an annotation page", TO_CSV,
         "csv", "svg", "iiif"),
    TEXT("--profile", profile, "ID",
         "the height of the surface along this line, from depth or normals, as a table; on an "
         "object over the straight line, towards the eye"),
    INT("--view", view, "N", "the view for --profile; default: 0", 0, 1 << 20),
    POINT("--eye", eye, "x,y,z",
          "of an object: who sees the overlay, or the profile's upper side; default: the note's "
          "own, of an overlay as the page opens"),
    SIZE("--picture", picture, "WxH",
         "of an object: the picture under the overlay; default: 512x512", 1, 16384),
    TEXT("--canvas", canvas, "URL", "the canvas of an IIIF annotation page"),
    TEXT_AS(OPTION_OUTPUT, "-o", output, "OUT", "the file for --to or --profile"),
    FLAG("--json", json, "print one JSON object"),
    {0},
};

// ---------------------------------------------------------------- changes

struct places {
    double (*place)[2], *z;  // [RELUME_NOTE_MOST_PLACES]
    int count;
};

static relume_status expected_places(const char *given, int across)
{
    return usage_error("--add '%s': expected places as '%s'", given,
                       across > 2 ? "X,Y,Z X,Y,Z" : "X,Y X,Y");
}

// Each of `across` coordinates.
static relume_status parse_places(struct places *p, const char *at, int across, const char *given)
{
    for (p->count = 0; *(at += strspn(at, " ")); p->count++) {
        double v[3];
        char *end;
        for (int c = 0; c < across; c++) {
            v[c] = strtod(at, &end);
            if (end == at || (c + 1 < across ? *end != ',' : *end && *end != ' '))
                return expected_places(given, across);
            at = end + (c + 1 < across);
        }
        if (p->count == RELUME_NOTE_MOST_PLACES)
            return usage_error("--add: expected at most %d places", RELUME_NOTE_MOST_PLACES);
        memcpy(p->place[p->count], v, sizeof p->place[p->count]);
        p->z[p->count] = across > 2 ? v[2] : 0.0;
    }
    return RELUME_OK;
}

static relume_status add(relume_notes *notes, const char *given, bool solid,
                         const struct notes_options *o)
{
    char kind[16] = "", now[32] = "";
    const size_t n = strcspn(given, " ");
    struct relume_note note = {.text = o->text, .state = o->state, .creator = o->creator};
    if (n < sizeof kind)
        memcpy(kind, given, n);
    if (relume_note_kind_parse(&note.kind, kind))
        return unknown_word(o->args.log, "kind of note", kind,
                            NAMES("point", "line", "polygon", "view"));
    const time_t seconds = time(NULL);
    struct tm parts;
    if (gmtime_r(&seconds, &parts) && strftime(now, sizeof now, "%Y-%m-%dT%H:%M:%SZ", &parts))
        note.created = now;
    struct places p = {malloc(RELUME_NOTE_MOST_PLACES * sizeof *p.place),
                       malloc(RELUME_NOTE_MOST_PLACES * sizeof *p.z), 0};
    relume_status status =
        p.place && p.z ? parse_places(&p, given + n, solid ? 3 : 2, given) : RELUME_ENOMEM;
    note.places = p.count;
    note.place = (const double(*)[2])p.place;
    note.z = solid ? p.z : NULL;
    if (!status)
        status = relume_notes_add(notes, &note, o->args.log);
    free(p.place);
    free(p.z);
    return status;
}

// The note of that name among `notes`.
static relume_status find(int *out, const relume_notes *notes, const char *id, const char *option)
{
    *out = relume_notes_find(notes, id);
    return *out >= 0 ? RELUME_OK : usage_error("%s: there is no note '%s'", option, id);
}

static relume_status set_scale(relume_notes *notes, const struct notes_options *o)
{
    int i;
    if (o->scale > 0.0)
        return relume_notes_set_scale(notes, o->scale);
    if (!o->ruler)
        return RELUME_OK;
    const relume_status status = find(&i, notes, o->ruler, "--ruler");
    if (status)
        return status;
    const double pixels = relume_note_measure(relume_notes_get(notes, i)).length;
    if (!(pixels > 0.0))
        return usage_error("--ruler: note '%s' has no length; expected a line", o->ruler);
    return relume_notes_set_scale(notes, o->length / pixels);
}

static bool changes(const struct notes_options *o)
{
    return o->add.count || o->remove.count || o->import.count || o->rewrite || o->scale > 0.0 ||
           o->ruler;
}

static relume_status change(relume_notes *notes, bool solid, const struct notes_options *o)
{
    relume_status status = RELUME_OK;
    int n;
    for (int i = 0; !status && i < o->import.count; i++) {
        status = relume_notes_import(notes, o->import.text[i], &n, o->args.log);
        if (!status)
            announce(&o->args, RELUME_NOTE, "%s: %d new note%s", o->import.text[i], n,
                     relume_plural(n));
    }
    for (int i = 0; !status && i < o->remove.count; i++) {
        status = find(&n, notes, o->remove.text[i], "--remove");
        if (!status)
            relume_notes_remove(notes, n);
    }
    if (!status && o->rewrite) {
        status = find(&n, notes, o->rewrite, "--rewrite");
        if (!status)
            status = relume_notes_rewrite(notes, n, o->text, o->args.log);
    }
    for (int i = 0; !status && i < o->add.count; i++)
        status = add(notes, o->add.text[i], solid, o);
    return status ? status : set_scale(notes, o);
}

// ---------------------------------------------------------------- profiles

// Heights in pixels, where depth is along parallel rays.
static void heights_of_depth(struct relume_image *depth, const struct relume_geometry *g)
{
    const double pixel = (g->window_max[0] - g->window_min[0]) / depth->width;
    for (size_t i = 0; i < (size_t)depth->width * (size_t)depth->height; i++)
        depth->data[i] = isfinite(depth->data[i]) ? (float)(-(double)depth->data[i] / pixel) : NAN;
}

static relume_status profile_of(struct relume_profile *out, const struct relume_note *note,
                                relume_pack *pack, const struct notes_options *o)
{
    const struct relume_geometry *g = relume_pack_geometry(pack, o->view);
    const bool flat = g->projection == RELUME_PLANAR && !g->perspective;
    const struct relume_codes *codes;
    struct relume_image depth = {0};
    struct relume_normals normals = {0};
    relume_status status = RELUME_OK;
    if (!flat)
        return data_error("%s: profiles need a planar file that is seen straight on",
                          o->args.input[0]);
    if (relume_pack_info(pack)->has_depth) {
        status = relume_pack_depth(&depth, pack, o->view);
        if (!status) {
            heights_of_depth(&depth, g);
            status = relume_profile_of_heights(out, &depth, note->place, note->places);
        }
    } else {
        status = relume_pack_codes(&codes, pack, o->view);
        if (!status)
            status = relume_normals_fit(&normals, codes,
                                        relume_normals_params(.log = o->args.log,
                                                              .threads = o->args.threads,
                                                              .eye = relume_geometry_eye(g)));
        if (!status)
            status = relume_profile_of_normals(out, &normals.normal, note->place, note->places);
    }
    relume_image_destroy(&depth);
    relume_normals_destroy(&normals);
    return status;
}

struct table {
    const struct relume_profile *profile;
    double mm;
};

static void print_cell(FILE *f, double value)
{
    if (isfinite(value))
        fprintf(f, ",%.6g", value);
    else
        fputc(',', f);
}

static void print_profile(const void *context, FILE *f)
{
    const struct table *t = context;
    fprintf(f, "along_px,x,y,height_px%s\r\n", t->mm > 0.0 ? ",along_mm,height_mm" : "");
    for (int i = 0; i < t->profile->count; i++) {
        const struct relume_profile *p = t->profile;
        fprintf(f, "%.6g,%.6g,%.6g", p->along[i], p->place[i][0], p->place[i][1]);
        print_cell(f, p->height[i]);
        if (t->mm > 0.0) {
            print_cell(f, p->along[i] * t->mm);
            print_cell(f, p->height[i] * t->mm);
        }
        fputs("\r\n", f);
    }
}

static struct notes_sight sight_of(const struct notes_options *o)
{
    return (struct notes_sight){.args = &o->args,
                                .eye = given(o, &o->eye) ? &o->eye : NULL,
                                .size = {o->picture[0], o->picture[1]},
                                .output = o->output};
}

static relume_status write_profile(const relume_notes *notes, relume_pack *pack,
                                   const struct notes_options *o)
{
    int i;
    struct relume_profile profile = {0};
    const struct notes_sight sight = sight_of(o);
    relume_status status = find(&i, notes, o->profile, "--profile");
    if (status)
        return status;
    const struct relume_note *note = relume_notes_get(notes, i);
    if (note->kind != RELUME_NOTE_LINE)
        return usage_error("--profile: note '%s' is a %s; expected a line", o->profile,
                           relume_note_kind_name(note->kind));
    if (!pack)
        return notes_object_profile(notes, note, &sight);
    status = profile_of(&profile, note, pack, o);
    if (!status)
        status =
            relume_file_print(o->output, print_profile,
                              &(struct table){&profile, relume_notes_scale(notes)}, o->args.log);
    relume_profile_destroy(&profile);
    return status;
}

// ---------------------------------------------------------------- the list

static void print_text(const relume_notes *notes, const char *unit)
{
    const double mm = relume_notes_scale(notes);
    const char *const what = mm > 0.0 ? "mm" : unit;
    struct shown text;
    for (int i = 0; i < relume_notes_count(notes); i++) {
        const struct relume_note *n = relume_notes_get(notes, i);
        const struct relume_note_measures m = relume_note_measure(n);
        printf("%-5s", shown(&text, n->id));
        printf(" %-8s", relume_note_kind_name(n->kind));
        if (n->kind == RELUME_NOTE_POINT)
            printf(" at %.6g,%.6g", n->place[0][0], n->place[0][1]);
        if (n->kind == RELUME_NOTE_POINT && n->z)
            printf(",%.6g", n->z[0]);
        if (isfinite(m.length))
            printf(" %.6g %s", m.length * (mm > 0.0 ? mm : 1.0), what);
        if (isfinite(m.area))
            printf(" around %.6g square %s", m.area * (mm > 0.0 ? mm * mm : 1.0), what);
        if (isfinite(m.degrees))
            printf(" %.4g degrees", m.degrees);
        printf("%s%s\n", n->text ? "  " : "", n->text ? shown(&text, n->text) : "");
    }
}

static void put_places(struct jwriter *w, const struct relume_note *n)
{
    jopen_array(w, "places");
    for (int k = 0; k < n->places; k++) {
        const double at[] = {n->place[k][0], n->place[k][1], n->z ? n->z[k] : 0.0};
        jput_numbers(w, NULL, at, n->z ? 3 : 2, 17);
    }
    jclose(w);
}

static void put_note(struct jwriter *w, const struct relume_note *n)
{
    const struct relume_note_measures m = relume_note_measure(n);
    jopen_object(w, NULL);
    jput_text(w, "id", n->id);
    jput_text(w, "kind", relume_note_kind_name(n->kind));
    put_places(w, n);
    jput_number(w, "length", m.length, 9);
    jput_number(w, "area", m.area, 9);
    jput_number(w, "degrees", m.degrees, 9);
    jput_text(w, "text", n->text);
    jput_text(w, "state", n->state);
    jput_text(w, "creator", n->creator);
    jput_text(w, "created", n->created);
    jclose(w);
}

static void print_json(const relume_notes *notes, bool solid)
{
    const double mm = relume_notes_scale(notes);
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jput_number(&w, solid ? "mm_per_unit" : "mm_per_pixel", mm > 0.0 ? mm : (double)NAN, 9);
    jopen_array(&w, "notes");
    for (int i = 0; i < relume_notes_count(notes); i++)
        put_note(&w, relume_notes_get(notes, i));
    jend(&w);
}

// ---------------------------------------------------------------- all

static relume_status check(const struct notes_options *o)
{
    if ((o->text || o->state || o->creator) && !o->add.count && !(o->rewrite && o->text))
        return usage_error("--text, --state and --creator belong to --add (--text also to "
                           "--rewrite)");
    if (o->rewrite && !o->text)
        return usage_error("--rewrite needs --text");
    if (!o->ruler != !(o->length > 0.0))
        return usage_error("--ruler and --length need each other");
    if (o->ruler && o->scale > 0.0)
        return usage_error("--scale and --ruler: choose one of them");
    if (o->embed && o->extract)
        return usage_error("--embed and --extract: choose one of them");
    if (o->to && o->profile)
        return usage_error("--to and --profile: choose one of them");
    if ((o->to || o->profile) && !o->output)
        return usage_error("%s needs -o OUT", o->to ? "--to" : "--profile");
    if (o->output && !o->to && !o->profile)
        return usage_error("-o needs --to or --profile");
    return o->output ? relume_file_check(o->output, o->args.log) : RELUME_OK;
}

// Into the file, which the context knows as an input: here it is meant to be replaced.
static relume_status keep_inside(const char *path, const char *text, const struct relume_log *log)
{
    struct relume_log own = *log;
    own.context = NULL;
    return relume_pack_keep_notes(path, text, &own);
}

static relume_status embed(const relume_notes *notes, const char *path,
                           const struct relume_log *log)
{
    char *text = NULL;
    relume_status status = relume_notes_text(&text, notes);
    if (!status)
        status = keep_inside(path, text, log);
    relume_free(text);
    return status ? status : relume_notes_unlink(path, log);
}

// The list, where it shall be; `inside`: where the file has one.
static relume_status keep(const relume_notes *notes, const char *inside,
                          const struct notes_options *o)
{
    const char *path = o->args.input[0];
    if (o->embed)
        return embed(notes, path, o->args.log);
    if (o->extract && !inside)
        return data_error("%s: it holds no notes; --embed puts them there", path);
    const relume_status status = relume_notes_save(notes, path, o->args.log);
    return status || !o->extract ? status : keep_inside(path, NULL, o->args.log);
}

// On a picture, or on an object, which is no pack.
static relume_status edit_notes(relume_pack *pack, const struct relume_notes_file *file,
                                const struct notes_options *o)
{
    relume_notes *notes = NULL;
    relume_status status = relume_notes_open(&notes, o->args.input[0], file, o->args.log);
    if (!status)
        status = change(notes, file->solid, o);
    const struct notes_sight sight = sight_of(o);
    if (!status && o->to == TO_SVG && file->solid && !pack)
        status = notes_object_overlay(notes, &sight);
    else if (!status && o->to)
        status = relume_notes_write(notes, o->output, (enum relume_notes_format)(o->to - TO_CSV),
                                    o->canvas, o->args.log);
    if (!status && o->profile)
        status = write_profile(notes, pack, o);
    if (!status && (changes(o) || o->embed || o->extract))
        status = keep(notes, file->inside, o);
    if (!status && o->json)
        print_json(notes, file->solid);
    else if (!status && !o->output)
        print_text(notes, file->solid ? "units" : "pixels");
    relume_notes_destroy(&notes);
    return status;
}

static relume_status on_picture(const struct notes_options *o)
{
    const char *path = o->args.input[0];
    relume_pack *pack = NULL;
    if (given(o, &o->eye) || given(o, o->picture))
        return usage_error("--eye and --picture are of objects; %s is a picture", path);
    relume_status status = relume_open(&pack, path, relume_open_params(.log = o->args.log));
    if (!status) {
        const struct relume_pack_info *info = relume_pack_info(pack);
        const struct relume_notes_file file = notes_file_of(pack, path_name(path));
        status = o->view < info->views
                     ? edit_notes(pack, &file, o)
                     : usage_error("--view %d: %s has %d view%s, counted from 0", o->view, path,
                                   info->views, relume_plural(info->views));
    }
    relume_pack_destroy(&pack);
    return status;
}

static relume_status on_object(const struct notes_options *o)
{
    const char *path = o->args.input[0];
    struct relume_notes_file file = {.name = path_name(path), .solid = true};
    relume_baked *baked = NULL;
    float box[2][3];
    if (o->embed || o->extract)
        return usage_error("%s: %s is an object, whose notes lie beside it",
                           o->embed ? "--embed" : "--extract", path);
    const relume_status status = relume_baked_open(&baked, path, NULL, o->args.log);
    if (status)
        return status;
    relume_baked_box(box, baked);
    relume_baked_destroy(&baked);
    for (int k = 0; k < 2; k++)
        for (int c = 0; c < 3; c++)
            file.box[k][c] = (double)box[k][c];
    return edit_notes(NULL, &file, o);
}

static relume_status run_notes(const struct args *args)
{
    const struct notes_options *o = (const void *)args;
    const relume_status status = check(o);
    return status                                                ? status
           : relume_kind_of(args->input[0]) == RELUME_KIND_BAKED ? on_object(o)
                                                                 : on_picture(o);
}

const struct command command_notes = {
    COMMAND(run_notes, "notes", "FILE [--add NOTE] [--to FORMAT -o OUT] [OPTION ...]",
            "write notes on a picture, measure in it, hand them to other programs",
            "relume notes coin.exr --add 'line 120,80 300,95' --text 'a scratch'", 1, 1),
};
