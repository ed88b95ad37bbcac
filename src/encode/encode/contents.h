// contents.h - what goes into a file while it is made: of all views, or of those of one part
#ifndef ENCODE_CONTENTS_H
#define ENCODE_CONTENTS_H

#include "format/codebook/books.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"
#include "format/lossy/lossy.h"
#include "format/pack/pack_write.h"

#include <relume/encode/pack_encode.h>
#include <relume/format/team.h>

struct contents {
    const relume_capture *capture;
    const relume_coder *coder;
    const struct relume_pack_encode_params *p;
    const struct relume_project_params *encode;
    struct relume_pack_view *view;
    struct relume_pack_levels *levels;  // [views]
    relume_coefficients **coefficients;
    struct relume_image *depth, *mask, *shadow;  // [views]
    relume_books **books;                        // [views], or the first for all
    uint16_t **index;                            // [views][RELUME_MOST_BOOKS]
    struct lossy_words *words;                   // [views]
    struct relume_fidelity *report;              // [views]
    int views;
    int first, end;      // those that are encoded
    int row, rows;       // of one view alone; 0 rows: all
    relume_pack *again;  // the file that has the coefficients, of which there are no photographs
};

// `f` begins with the first four. RELUME_ENOMEM.
relume_status contents_create(struct contents *f, const struct encode_share *share);
void contents_destroy(struct contents *f);
// The coefficients of view i, of the rows of this part; and its depth and mask.
relume_status contents_encode(struct contents *f, int i);
relume_status contents_extras(struct contents *f, int i);
// The reduced levels of view i, where it gets any.
relume_status contents_reduce(struct contents *f, int i);

// What all of a file has in common; its preview is that of `contents`.
void contents_describe(struct relume_pack_contents *contents, const struct contents *f);
// What this part of the work is, with the digest of the capture. An input status.
relume_status contents_share(struct relume_pack_share *out, char digest[RELUME_DIGEST],
                             const struct contents *f);
relume_status contents_write(const struct relume_pack_contents *contents, const char *path,
                             const struct relume_pack_encode_params *p);

#endif
