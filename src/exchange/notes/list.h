// list.h - a list of notes, inside
#ifndef NOTES_LIST_H
#define NOTES_LIST_H

#include "core/base/log.h"

#include <relume/exchange/notes.h>

struct kept_note {
    struct relume_note note;  // its texts and places are its own
    char *raw;                // the annotation that it was read from; NULL: made here, or changed
};

struct relume_notes {
    char *name;  // of the file
    int width, height, views;
    bool solid;        // it is an object, within
    double box[2][3];  // ... these corners
    bool inside;       // the file holds a list itself, which one beside it hides
    double mm_per_pixel;
    int count;
    struct kept_note *note;  // [count]
    int *slot;               // [slots]: by the hash of an id, 1 + the number of its note; 0: free
    size_t slots;            // a power of two, more than count; 0 while there are no notes
    int last;                // the largest N of an id "nN", 0 without one
};

void notes_forget(struct kept_note *kept);
// A copy with `raw`, which is taken over where it goes well. Checked as relume_notes_add, but for
// names that are taken.
relume_status notes_append(relume_notes *notes, const struct relume_note *note, char *raw,
                           const struct relume_log *log);

// The member of the page that has the scale.
const char *notes_scale_name(const relume_notes *notes);
// The name of the list of the file `path`, to be freed; NULL: no memory.
char *notes_name(const char *path);

#endif
