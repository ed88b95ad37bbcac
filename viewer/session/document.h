// document.h - kinds of documents that a session shows, in one table, and the one that is open
//
// Adding a kind of document takes one file, document_NAME.c, and one line of document_kinds.
#ifndef VIEWER_DOCUMENT_H
#define VIEWER_DOCUMENT_H

#include "app/app.h"
#include "relit/pack_source.h"
#include "session/object_set.h"

#include <relume/material/edit.h>

enum { DOCUMENT_LINES = 10, DOCUMENT_TEXT = 256 };

struct document_kind;
struct session;

// The open document. Pack and slabs are for every kind; `own` is known to the kind alone.
struct document {
    const struct document_kind *kind;
    char name[DOCUMENT_TEXT];      // for the title
    char path[APP_SPEC];           // as it was opened ...
    bool as_panorama;              // ... with the options of a panorama
    char folder[APP_SPEC];         // of the last file that had a folder
    relume_pack *pack;             // of a relume file, or NULL
    struct relume_relief *relief;  // captured lights of the pack that show relief, or NULL
    struct pack_source *source;    // of the pack, for the renderer and its threads
    relume_slab_set *slabs;        // around which the eye goes, NULL for one view or one slab
    void *own;
    bool beside_warned;                        // that the eye stands beside all camera grids
    char line[DOCUMENT_LINES][DOCUMENT_TEXT];  // description for the panel
    int lines;
    char edits[1024];      // of material or maps, for the panel
    int edited_materials;  // number of materials of an edited g-BRDF
};

// What open makes. The session takes it when all went well, and destroys it otherwise.
struct opening {
    struct document document;
    struct app app;
    struct object_set objects;  // of the session at first; a kind may put others there
};

// Thread-safety: constant tables; their functions belong to the thread of the session.
struct document_kind {
    // Whether a document is of this kind. `path` is NULL when no file was named.
    bool (*is)(const char *path, const struct object_set *objects);
    // Opens the document and starts the app, without changing what the session shows. Input
    // statuses with a sentence, RELUME_EUNFIT, RELUME_ENOMEM.
    relume_status (*open)(struct opening *out, struct session *s, const char *path,
                          const struct app_state *start, bool look_ahead);
    // Makes the renderer of the open document. RELUME_ESYSTEM, RELUME_ENOMEM, RELUME_EUNFIT.
    relume_status (*make)(struct session *s);
    // Writes the lines of the panel once the document is open. NULL: open has written them.
    void (*describe)(struct session *s);
    // Whether the document can be edited, and an edit, as session_edit. NULL: it never can.
    bool (*can_edit)(const struct session *s);
    relume_status (*edit)(struct session *s, const char *words, const struct relume_log *log);
    // Frees `own`; NULL: there is none.
    void (*close)(struct document *d);
    bool has_maps;  // edits are of maps, which can be written to a folder
};

extern const struct document_kind document_nothing, document_scene, document_maps, document_objects,
    document_pack;

// The first kind of the table that is it.
const struct document_kind *document_kind_of(const char *path, const struct object_set *objects);
// Frees all but the objects.
void document_close(struct document *d);

// Sets name, path and folder.
void document_set_path(struct document *d, const char *path);
// Adds a line to the description, which holds DOCUMENT_LINES.
void document_add_line(struct document *d, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
// Shows a list of edits in the panel.
void document_describe_edits(struct document *d, const relume_edits *edits);

#endif
