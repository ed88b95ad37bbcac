// parts.h - rectangles of views that are kept, where a frame reads little of each
#ifndef FRAME_PARTS_H
#define FRAME_PARTS_H

#include "format/coder/coding.h"

#include <relume/format/coder.h>

// Of one view: the rectangle `at`, and what is known of it.
struct part {
    uint64_t lit;                    // the lighting that the image shows; 0: none
    struct relume_codes_part codes;  // empty: to be read
    struct relume_image surface;     // for near lights; empty: not asked for
};

struct parts {
    int views;
    struct part *part;                       // [views]
    struct relume_rect *at;                  // [views]
    struct relume_image *image, *disparity;  // [views]
};

// RELUME_ENOMEM.
relume_status parts_create(struct parts **out, int views);
void parts_destroy(struct parts **parts);
uint64_t parts_codes_bytes(const struct relume_codes *codes);

// Of parts that may be NULL: what is kept of a view; its codes go, which can be read again;
// everything of it goes.
uint64_t parts_bytes(const struct parts *parts, int view);
void parts_drop_codes(struct parts *parts, int view);
void parts_forget(struct parts *parts, int view);

#endif
