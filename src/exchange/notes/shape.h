// shape.h - places of a note as selectors of an annotation write them
#ifndef NOTES_SHAPE_H
#define NOTES_SHAPE_H

#include "core/base/json.h"
#include "core/base/json_write.h"

#include <relume/exchange/notes.h>
#include <stdio.h>

struct shape {
    enum relume_note_kind kind;
    int places;
    double (*place)[2];  // [places]
    double *z;           // [places]: of a place in space; NULL: on a picture
};
void shape_free(struct shape *shape);

// IIIF's PointSelector, with a z in space, WktSelector (a line or polygon in space), SvgSelector
// (one path, line, polyline, polygon, rect or circle) or FragmentSelector (xywh in pixels).
// RELUME_EUNSUPPORTED for others, RELUME_EFORMAT for those that break their grammar, without a
// sentence; RELUME_ENOMEM.
relume_status shape_read(struct shape *out, const jvalue *selector);
// Such a fragment, "xywh=1,2,3,4".
relume_status shape_read_fragment(struct shape *out, const char *text);

// The path of a line or polygon, as an attribute `d`.
void shape_print_path(FILE *f, const struct relume_note *note);
// A selector; the note is no view.
void shape_put(struct jwriter *w, const char *key, const struct relume_note *note);

#endif
