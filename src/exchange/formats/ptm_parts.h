// ptm_parts.h - what the readers and writers of .ptm share
#ifndef EXCHANGE_PTM_PARTS_H
#define EXCHANGE_PTM_PARTS_H

#include "exchange/foreign/foreign.h"
#include "exchange/formats/bytes.h"

#include <stdio.h>

enum { PTM_TERMS = 6, PTM_MOST_PLANES = 3 * PTM_TERMS };

// Our order of the terms (1 x y x2 xy y2) by the file's place of each (x2 y2 xy x y 1).
extern const int ptm_term_of_place[PTM_TERMS];

struct ptm_header {
    const char *path;
    const struct relume_limits *limits;
    const struct relume_log *log;
    double version;
    bool luminance, jpeg;
    long width, height;
    double scale[PTM_TERMS];
    long bias[PTM_TERMS];
};

// An input status and "PATH: what; expected ...".
// Space for the header's picture, with its scales and offsets.
relume_status ptm_create(struct foreign *f, const struct ptm_header *h);

// The table of the JPEG forms, a line of numbers for every field, a number for every plane.
enum ptm_field {
    PTM_TRANSFORM,
    PTM_MOTION_X,
    PTM_MOTION_Y,
    PTM_ORDER,
    PTM_REFERENCE,
    PTM_BYTES,
    PTM_SIDE_BYTES,
    PTM_FIELDS
};

// How a plane's reference is changed before the plane is added to it. Which way a motion vector
// points, and what stands outside the picture, is nowhere written; no reader of the field knows.
enum ptm_transform { PTM_AS_IT_IS, PTM_INVERTED, PTM_MOVED, PTM_TRANSFORMS };

// A record of the side information: the pixel's number, big endian, and its code.
enum { PTM_RECORD = 5, PTM_RECORD_BITS = 8 * PTM_RECORD };

// The body of the JPEG forms.
relume_status ptm_read_jpegs(struct foreign *f, const struct ptm_header *h, struct bytes *b);

// The number of our plane for plane `i` of the JPEG forms: six terms, or six for each channel, then
// the colour.
int ptm_plane(bool luminance, int i);

// The lines up to the bias.
void ptm_print_header(const struct foreign *f, bool jpeg, FILE *out);

static inline uint8_t *ptm_row(const struct foreign *f, int plane, int row_from_below)
{
    const size_t row = (size_t)(f->height - 1 - row_from_below);
    return f->codes + (size_t)plane * foreign_pixels(f) + row * (size_t)f->width;
}

#endif
