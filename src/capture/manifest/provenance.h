// provenance.h - what a capture or a file remembers of its photographs (docs/format.md)
#ifndef CAPTURE_PROVENANCE_H
#define CAPTURE_PROVENANCE_H

#include <relume/capture/ball.h>
#include <relume/image.h>

enum { PROVENANCE_BALLS = 16 };

struct provenance {
    char photograph[65];      // check sum of the first one; "": not known
    struct relume_rect part;  // of the upright photographs that was kept; width 0: all
    struct relume_ball ball[PROVENANCE_BALLS];  // that stand in the photographs, pixels of the part
    int balls;
};

// Reads the JSON text; NULL, and what is not as expected, says nothing.
void provenance_read(struct provenance *out, const char *text);

// Returns the text once a part of the images was kept, to be freed; NULL without memory.
char *provenance_crop(const char *text, const struct relume_rect *part);

#endif
