// material.h - what goes into a file while it is made: of all views, or of those of one part
#ifndef ENCODE_MATERIAL_H
#define ENCODE_MATERIAL_H

#include "format/codebook/books.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"
#include "format/lossy/lossy.h"
#include "format/pack/pack_write.h"

#include <relume/encode/pack_encode.h>
#include <relume/format/team.h>

struct material {
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
    int first, end;  // those that are encoded
    int row, rows;   // of one view alone; 0 rows: all
};

// `m` begins with the first four. RELUME_ENOMEM.
relume_status material_create(struct material *m, const struct encode_share *share);
void material_destroy(struct material *m);
// The coefficients of view i, of the rows of this part; and its depth and mask.
relume_status material_encode(struct material *m, int i);
relume_status material_extras(struct material *m, int i);
// The reduced levels of view i, where it gets any.
relume_status material_reduce(struct material *m, int i);

// What all of a file has in common; its preview is that of `contents`.
void material_contents(struct relume_pack_contents *contents, const struct material *m);
// What this part of the work is, with the digest of the capture. An input status.
relume_status material_share(struct relume_pack_share *out, char digest[RELUME_DIGEST],
                             const struct material *m);
relume_status material_write(const struct relume_pack_contents *contents, const char *path,
                             const struct relume_pack_encode_params *p);

#endif
