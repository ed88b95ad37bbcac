// light_layout.h - which three numbers of its lines are the lights of a list without titles
#ifndef CAPTURE_LIGHT_LAYOUT_H
#define CAPTURE_LIGHT_LAYOUT_H

#include "capture/manifest/light_text.h"

struct light_layout {
    bool commas;  // commas separate words; without, they are decimal commas or parts of names
    int run;      // among sequences of three and more numbers in a line, 0 for the first
    int offset;   // numbers of that sequence before x, or behind z with `from_end`
    bool from_end;
};

// Chooses one layout for all lines from `first` on, comments excepted. The layout that most lines
// have wins; among several the one whose vectors have unit length in most lines, or without one the
// one whose vectors differ least in length. RELUME_EFORMAT with a message that names two layouts
// that fit equally.
relume_status light_layout_find(struct light_layout *out, struct light_line first, const char *path,
                                const struct relume_log *log);
// The index of the word x; -1 where the line does not have that layout.
int light_layout_at(const struct light_layout *layout, const struct light_row *row);

#endif
