// notes.h - what people write on a relightable picture or an object: points, lines, polygons and
// saved views that keep the light, the eye and the pass in which they were made; lengths, areas,
// angles and profiles of them
//
// A list is kept beside its file, coin.exr has coin.notes.json, as a page of annotations (Web
// Annotation Data Model, W3C recommendation 2017), so that other programs read it (docs/notes.md),
// or inside it (relume_pack_keep_notes).
// Places are counted in pixels of a view at its full size, (0, 0) being the upper left corner of
// the upper left pixel, x to the right and y down; of a slab they lie on the window that all its
// cameras see, of a panorama on the view unfolded. Of an object they are its own coordinates, in
// its own units.
#ifndef RELUME_NOTES_H
#define RELUME_NOTES_H

#include <relume/base.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

enum relume_note_kind {
    RELUME_NOTE_POINT = 0,  // one place
    RELUME_NOTE_LINE,       // two places and more: a ruler; of three the middle one has an angle
    RELUME_NOTE_POLYGON,    // three places and more, the last joined to the first
    RELUME_NOTE_VIEW,       // no place: a saved view, whose state is all
};
// "point", "line", "polygon", "view"; constant.
RELUME_API const char *relume_note_kind_name(enum relume_note_kind kind);
// RELUME_EINVAL when `name` is none of these.
RELUME_RESULT relume_status relume_note_kind_parse(enum relume_note_kind *out, const char *name);

// Most notes of a list, most places of a note, longest of its texts in bytes.
enum { RELUME_NOTES_MOST = 100000, RELUME_NOTE_MOST_PLACES = 10000, RELUME_NOTE_MOST_TEXT = 65536 };

// One note. Texts are UTF-8. Thread-safety: plain data.
struct relume_note {
    enum relume_note_kind kind;
    int places;
    const double (*place)[2];  // [places], pixels; of an object: x and y
    const char *text;          // what it says; NULL: nothing
    const char *state;         // eye, lights, exposure and pass, as `--state` takes it; NULL: any
    const char *creator;       // who made it; NULL: unknown
    const char *created;       // when, as "2026-11-28T12:00:00Z"; NULL: unknown
    const char *id;            // its name within the list; NULL: relume_notes_add finds one
    const double *z;           // [places]: the third coordinates on an object; NULL on a picture
};

// A list of notes on one file. Thread-safety: one thread at a time.
typedef struct relume_notes relume_notes;

// What a list is for: notes are refused for a file of another size, or an object of another box.
struct relume_notes_file {
    const char *name;   // of the file, without its folder
    int width, height;  // of each of its views; of an object without views 0
    int views;
    const char *inside;  // the page that the file itself holds (relume_pack_info.notes); NULL: none
    bool solid;          // it is an object, baked or amid several slabs
    double box[2][3];    // ... and lies between these corners, least and largest coordinates
};

// An empty list. RELUME_EINVAL for sizes below 1, of an object for a box without extent;
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_notes_create(relume_notes **out,
                                                const struct relume_notes_file *file);
// The list kept beside the file `path`; where there is none that inside it, or an empty one.
// RELUME_EUNFIT for notes
// on a file of another size, RELUME_EFORMAT for what is no list, an input status, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_notes_open(relume_notes **out, const char *path,
                                              const struct relume_notes_file *file,
                                              const struct relume_log *log);
// Add what another list holds, `path` being its own name: one that a page has saved, or another
// program. Notes whose names and contents are there already are left out; those whose names alone
// are get new ones. `*added` is how many came. As relume_notes_open; an unknown kind of selector
// is a warning, and its note is left out.
RELUME_RESULT relume_status relume_notes_import(relume_notes *notes, const char *path, int *added,
                                                const struct relume_log *log);
// Keep it beside the file `path`, in place of the list that is there; without notes and scale the
// list disappears, unless it hides one inside the file. Notes that were read and not changed keep
// whatever other programs wrote of them. RELUME_EIO, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_notes_save(const relume_notes *notes, const char *path,
                                              const struct relume_log *log);
// The same as text, for relume_pack_keep_notes; NULL without notes and scale. Free `*out` with
// relume_free(). RELUME_ENOMEM.
RELUME_RESULT relume_status relume_notes_text(char **out, const relume_notes *notes);
// The list beside the file `path` is removed, if there is one. RELUME_EIO, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_notes_unlink(const char *path, const struct relume_log *log);
RELUME_API void relume_notes_destroy(relume_notes **notes);

// Append a copy. RELUME_EINVAL with a sentence for a number of places that its kind has not, places
// that are not finite or farther than the picture's size beside it, of an object than its diagonal
// from its box, a note on a picture for an object and the other way round, text that is no UTF-8 or
// too long, a name that is taken, a full list; RELUME_ENOMEM.
RELUME_RESULT relume_status relume_notes_add(relume_notes *notes, const struct relume_note *note,
                                             const struct relume_log *log);
// Another text for note number `i`. RELUME_EINVAL, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_notes_rewrite(relume_notes *notes, int i, const char *text,
                                                 const struct relume_log *log);
RELUME_API void relume_notes_remove(relume_notes *notes, int i);
RELUME_API int relume_notes_count(const relume_notes *notes);
// Number `i` from 0, in the order in which they came; belongs to the list until it changes.
RELUME_API const struct relume_note *relume_notes_get(const relume_notes *notes, int i);
// The number of the note of that name, -1 when there is none.
RELUME_API int relume_notes_find(const relume_notes *notes, const char *id);

// Millimetres a pixel, of an object a unit; 0: not known. RELUME_EINVAL unless it is 0 or positive
// and finite.
RELUME_API double relume_notes_scale(const relume_notes *notes);
RELUME_RESULT relume_status relume_notes_set_scale(relume_notes *notes, double mm_per_pixel);

// Splits notes by a part of their picture, which may reach beyond it. `inside` has the notes that
// meet the part, moved, and saved views, on a file of the part's size. `outside` has the
// remaining notes as they were. Both lists have the scale. RELUME_EINVAL for notes on an object,
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_notes_crop(relume_notes **inside, relume_notes **outside,
                                              const relume_notes *notes,
                                              const struct relume_rect *part);

// Finds the part of the views of `from` that the views of `to` show. It may reach beyond. Returns
// false unless the provenance of both names the same photographs.
struct relume_pack_info;
RELUME_API bool relume_notes_part(struct relume_rect *part, const struct relume_pack_info *from,
                                  const struct relume_pack_info *to);

// ---------------------------------------------------------------- measures

// What can be measured in the picture's plane, in an object's units through space; NaN where the
// kind of note has no such thing.
struct relume_note_measures {
    double length;   // pixels: of a line, around a polygon
    double area;     // square pixels: of a polygon that does not cross itself; in space half of the
                     // sum of its edges' crosses
    double degrees;  // [0, 180]: at the middle of a line of three places
};
RELUME_API struct relume_note_measures relume_note_measure(const struct relume_note *note);

// The surface along a line of `places` places, sampled once a pixel and at its end.
struct relume_profile {
    int count;
    double *along;       // [count], pixels from the first place
    double (*place)[2];  // [count]
    double *height;      // [count], pixels towards the eye, above the first one that is known; NaN
                         // where nothing is known yet
};
// From normals (three channels, world, 0: not known; relume/relight/normals.h) of a planar view, by
// adding up slopes along the line; gaps are level. RELUME_EINVAL for fewer than two places,
// RELUME_ELIMIT for a line of over 10 million pixels, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_profile_of_normals(struct relume_profile *out,
                                                      const struct relume_image *normals,
                                                      const double (*place)[2], int places);
// From heights in pixels (one channel, NaN: not known). As above.
RELUME_RESULT relume_status relume_profile_of_heights(struct relume_profile *out,
                                                      const struct relume_image *heights,
                                                      const double (*place)[2], int places);
RELUME_API void relume_profile_destroy(struct relume_profile *profile);

// ---------------------------------------------------------------- for other programs

// Formats that lists of notes are written in.
enum relume_notes_format {
    RELUME_NOTES_CSV = 0,  // a row a note: id, kind, places, length, area, angle, text, state
    RELUME_NOTES_SVG,      // an overlay of the picture's size
    RELUME_NOTES_IIIF,     // annotation page of IIIF Presentation 3, on the canvas of `publish`
};
// Write the file `path`. `canvas` is the canvas's address for IIIF, of an object its scene's or its
// own; NULL: the name of the file. RELUME_EUNSUPPORTED (an overlay of an object), RELUME_EIO,
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_notes_write(const relume_notes *notes, const char *path,
                                               enum relume_notes_format format, const char *canvas,
                                               const struct relume_log *log);

// How an object is seen in a picture of it. Borrowed during the call.
struct relume_notes_sight {
    int width, height;  // of the picture, pixels, above 0
    // Where a place of the object is seen, in pixels from the upper left corner; false: nowhere.
    bool (*see)(void *context, double xy[2], const double place[3]);
    void *context;
};
// The file `path` is an overlay, as RELUME_NOTES_SVG, of a picture of the object that the notes are
// on; those of which a place is not seen are left out. Lengths are those on the object.
// RELUME_EINVAL for notes on a picture and sizes below 1, RELUME_EIO, RELUME_ENOMEM. `see` is
// called from the thread of the call.
RELUME_RESULT relume_status relume_notes_write_overlay(const relume_notes *notes, const char *path,
                                                       const struct relume_notes_sight *sight,
                                                       const struct relume_log *log);

#ifdef __cplusplus
}
#endif
#endif
