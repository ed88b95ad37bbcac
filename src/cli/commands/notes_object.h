// notes_object.h - notes on a baked object as an eye sees them: an overlay, the surface along a
// line
#ifndef CLI_NOTES_OBJECT_H
#define CLI_NOTES_OBJECT_H

#include "cli/cli.h"

#include <relume/exchange/notes.h>

struct notes_sight {
    const struct args *args;        // the object's file is their first input
    const struct relume_vec3 *eye;  // NULL: as the page opens, of a profile the eye of its note
    int size[2];                    // of the picture; 0: 512
    const char *output;
};

// An overlay of the picture that `relume btf render --eye --picture` makes.
relume_status notes_object_overlay(const relume_notes *notes, const struct notes_sight *sight);
// How far the surface lies over each leg of a line, towards the eye, as a table.
relume_status notes_object_profile(const relume_notes *notes, const struct relume_note *note,
                                   const struct notes_sight *sight);

#endif
