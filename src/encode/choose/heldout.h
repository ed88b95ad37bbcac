// heldout.h - what is in memory of a capture whose coders are judged
#ifndef SELECTION_HELDOUT_H
#define SELECTION_HELDOUT_H

#include "format/codebook/books.h"
#include "format/coder/sums.h"
#include "image/image/encoder.h"

#include <relume/encode/heldout.h>

// Rows of one view that follow each other in memory.
struct strip {
    int view, row, rows;
    size_t first;  // pixel number in memory
};

// Pixels of one strip that are worked on at once, at most CODER_CHUNK.
struct chunk {
    int view;
    size_t first, n;
};

struct relume_heldout {
    struct relume_heldout_params params;
    struct relume_heldout_info info;
    const relume_capture *capture;
    int lights, all;  // captured; with those of the test capture
    int width, height, views;
    bool hemispherical, pole_y;
    struct relume_transfer curve;    // of the samples
    struct relume_transfer screen;   // of display values
    bool shown;                      // samples are display values
    float *gain;                     // [all lights]: the exposure of each, or NULL
    struct relume_vec3 *directions;  // [all]
    int *light_at;                   // [all]: which light's samples are in a place
    size_t pixels;
    float *samples;  // [all places][pixels][rgb]
    uint8_t *codes;  // [all lights][pixels][rgb], display values rounded
    float *luma;     // [all lights][pixels], of display values
    float *mask;     // [pixels], or NULL
    bool *masked;    // [views]
    struct strip *strip;
    int strips;
    struct chunk *chunk;
    int chunks;
    struct relume_samples learning;  // of all captured lights; read when first needed
    struct relume_sample_sums sums;  // of them
};

// Display values, unclipped, of samples under a light (not its place). `e` is heldout_encoder's.
void heldout_encoder(struct encoder *e, const relume_heldout *h);
void heldout_show(const relume_heldout *h, const struct encoder *e, size_t light,
                  const float *value, float *out, size_t n);

// Codebooks of one fold, and which vectors each pixel uses.
struct fold_books {
    int views;
    relume_books **books;  // [views], or the first for all
    bool share;
    uint16_t **index;  // [views * RELUME_MOST_BOOKS] -> pixels of the view
    size_t *first;     // [views]: where the view begins in memory
};

// Learn codebooks from coefficients value[planes][pixels] and assign every pixel.
relume_status fold_books_make(struct fold_books *out, const relume_heldout *h,
                              const relume_coder *coder, const float *value,
                              const struct relume_heldout_store *store);
void fold_books_drop(struct fold_books *b);
// The coefficients to[plane][pixel] of `n` pixels from `first` on, of one view.
void fold_books_restore(const struct fold_books *b, int view, size_t first, size_t n, float *to);

// The rows of a view in memory, which follow each other from pixel `*first` on, whichever strips
// they come from.
int heldout_rows(const relume_heldout *h, int view, size_t *first);

// Reads everything that relume_heldout_measure needs.
relume_status heldout_load(relume_heldout *h);

#endif
