// books.h - codebooks on the GPU: indices stay, the vectors are relit for every light
#ifndef VIEWER_BOOKS_H
#define VIEWER_BOOKS_H

#include "gl/gl.h"

#include <relume/relight/relight.h>

enum { TABLE_WIDTH = 1024 };

// A copy of the vectors of `codes`, which its owner may forget; no indices. RELUME_ENOMEM.
relume_status books_keep(struct relume_codes *kept, const struct relume_codes *codes);
void books_forget(struct relume_codes *kept);

// Graphics memory of the indices of `codes`.
size_t books_bytes(const struct relume_codes *codes);
// The indices into the array texture that is bound.
void books_upload(const struct gl *gl, const struct relume_codes *codes);
// The relit vectors into the array texture that is bound, as lookup.frag reads them; the lights are
// those of relume_relight_book, `grid` may be NULL. Its errors, RELUME_ENOMEM.
relume_status books_relight(const struct gl *gl, const struct relume_codes *codes,
                            const struct relume_light *lights, int n,
                            const relume_weight_grid *grid);

#endif
