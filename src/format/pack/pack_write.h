//
#ifndef PACK_PACK_WRITE_H
#define PACK_PACK_WRITE_H

#include "format/codebook/books.h"
#include "format/coder/coding.h"
#include "format/pack/views.h"

#include <relume/format/pack_write.h>

// The reduced levels of a view, each half of the one before. The first pixel of one covers the
// first 2 x 2 of the one before; of an odd side the last covers what is left.
struct relume_pack_levels {
    int levels;                                      // how many
    relume_coefficients *level[RELUME_MOST_LEVELS];  // [levels], relume_coefficients_destroy
    struct relume_image share[RELUME_MOST_LEVELS];   // of each pixel, within the mask; or empty
    // Of views that are coded, as relume_pack_view.coded; mem_free
    uint32_t *coded[RELUME_MOST_LEVELS];
    size_t coded_words[RELUME_MOST_LEVELS];  // how many
};

// What goes into a file beside the coefficients. Borrowed.
struct relume_pack_view {
    const relume_coefficients *coefficients;
    double uv[2];                      // slab: where the camera stands
    int slab;                          // which of several slabs
    const struct relume_image *depth;  // one channel, or NULL
    const struct relume_image *mask;   // one channel, or NULL
    // Codebooks instead of planes: all views or none, as many books in each. Views that have the
    // same ones share them in the file when all do.
    const relume_books *books;
    const uint16_t *const *index;             // [books] -> [height][width], as relume_books_assign
    const struct relume_pack_levels *levels;  // NULL: none. All views have as many. With them the
                                              // view is kept in tiles, of which a reader takes
                                              // those that it needs
    // The planes coded with loss, in place of what `coefficients` hold, of all views or none: words
    // of docs/format.md, "Coded planes". `coefficients` are of RELUME_STORE_12.
    const uint32_t *coded;
    size_t coded_words;  // how many
    bool predicted;      // coded planes: from those of another view, which is not predicted itself
    int anchor;          // that view
    float depth_step;    // depth is written in steps of its inverse, of that size; 0: as it is
    const struct relume_image *shadow;  // as relume_shadows_learn gives it, or NULL; it is coded
                                        // with a little loss
    const struct relume_image *gloss;   // likewise, as relume_gloss_learn gives it, of files of one
                                        // view without `shadow`
    double model_bytes;  // what either may take: it is coded more coarsely, within limits, for
                         // that; 0: half a byte a pixel
};
// Which part of a file is written, where several machines share the work; relume_pack_join makes
// one file of all parts. Borrowed.
struct relume_pack_share {
    int part, parts;                // 1 .. parts
    int first, views;               // those that it holds, or rows of one
    const char *capture, *options;  // what must be the same in all parts; texts
    bool free_storage;              // nobody asked for the storage: join refuses coarse steps
    enum relume_step step;          // what was asked for
    enum relume_pyramid pyramid;    // likewise
    bool shared_books;              // all views of all parts have the same
    const struct relume_fidelity *measured;  // [views] of it; `coded`: one of all views
    bool coded;  // planes are coded with loss: it holds the views that have `coded` words, of all
                 // tiles or of some; tiles of 0 bytes are another part's
    int group;   // then: the number of its first group
};

// What is written. Everything is borrowed while relume_pack_write runs.
struct relume_pack_contents {
    const relume_coder *coder;
    enum relume_domain domain;
    struct relume_transfer display;  // the curve of DOMAIN_DISPLAY
    struct relume_geometry geometry;
    int slabs;                           // as struct relume_manifest
    const struct relume_geometry *slab;  // [slabs]
    int views;
    const struct relume_pack_view *view;  // [views]
    struct relume_fidelity report;        // over all views; NaN: not known
    // The picture of the first part, for ordinary EXR viewers, of the views' size, or where they
    // have reduced levels, of that of relume_pack_shown: fill linear rgb[rows][width][3] from `row`
    // on, and return what failed. Called from several threads. NULL: black. relume_pack_preview
    // makes one.
    relume_status (*preview)(void *user, int row, int rows, float *rgb);
    void *preview_user;                     // of `preview`
    const struct relume_pack_share *share;  // NULL: all of it
    const char *provenance;                 // as struct relume_manifest, or NULL
};

// Which level the first part shows, 0: the view itself.
int relume_pack_shown(const struct relume_pack_view *view);

// Write `path` whole or not at all. Returns RELUME_EIO, RELUME_ENOMEM, RELUME_ECANCEL,
// RELUME_ESYSTEM, RELUME_EINVAL for a `shadow` or `gloss` whose numbers are not finite (a thickness
// may be infinite) or too far apart for a float, or what `preview` returned.
relume_status relume_pack_write(const struct relume_pack_contents *contents, const char *path,
                                const struct relume_pack_params *params);

#endif
