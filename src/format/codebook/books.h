// books.h - the inside of the codebooks of a file
#ifndef CODEBOOK_BOOKS_H
#define CODEBOOK_BOOKS_H

#include "format/codebook/nearest.h"
#include "format/coder/coding.h"

#include <relume/format/codebook.h>

// What a codebook is; pointers belong to it.
struct relume_codebook_info {
    int codes, dim;
    const float *vectors;  // [codes][dim]
    int rounds;            // Lloyd rounds of the training (splitting start: of its last level)
    double squared_error;  // sum over the training vectors, as the last round found it: before its
                           // codes moved to their means
    int moved;             // codes without vectors that were moved, over all rounds
};
// It belongs to the book.
const struct relume_codebook_info *relume_codebook_info(const relume_codebook *book);

// What the vectors of a book are.
enum relume_book_kind {
    RELUME_BOOK_PLANES = 0,  // number d of a vector belongs to plane first + d
    RELUME_BOOK_LUMA,        // number d: Y of R, G, B in planes first + 3 d ..., each Y / sqrt 3
    RELUME_BOOK_CHROMA,      // numbers 2 d, 2 d + 1: U and V, R = U / sqrt 2 + V / sqrt 6,
                             // G = -2 V / sqrt 6, B = -U / sqrt 2 + V / sqrt 6
};

// A book as it is stored. Plain data, borrowed.
struct relume_book {
    enum relume_book_kind kind;
    int first, last;              // planes [first, last)
    int codes;                    // vectors, [1, 65536]
    int dim;                      // numbers of a vector, as the kind says
    enum relume_storage storage;  // of the numbers
    const void *numbers;          // [dim][codes] of uint8_t, uint16_t or half bits
    const float *scale, *offset;  // [dim]: number x scale + offset
};

// The numbers in a vector of a book of that kind for planes [first, last); 0 when there is no such
// book: an empty range, or one that is not of whole R, G, B triples where the kind needs them.
int relume_book_dim(enum relume_book_kind kind, int first, int last);
// vectors[codes][planes]: the vectors as they are added up, 0 in planes that the book leaves alone.
void relume_book_expand(float *vectors, const struct relume_book *book, int planes);

// Books that belong together. Never changes. Thread-safety: safe.
typedef struct relume_books relume_books;

// Learn from the coefficients of `n` views by one coder, all of one storage, in which the numbers
// will be stored. Stages and splits multiply to at most RELUME_MOST_BOOKS books. Returns
// RELUME_EINVAL (params; several books for a luminance coder), RELUME_EUNFIT (more codes than
// pixels), RELUME_EIO, RELUME_ENOMEM, RELUME_ECANCEL.
relume_status relume_books_train(relume_books **out, const relume_coefficients *const *views, int n,
                                 const struct relume_books_params *params);
void relume_books_destroy(relume_books **books);

// What belongs to the books.
struct relume_books_info {
    int books, planes;
    const struct relume_book *book;  // [books]
    const float *const *vectors;     // [books] -> [codes][planes], as expanded
    const int *codes;                // [books]
};
// It belongs to the books.
const struct relume_books_info *relume_books_info(const relume_books *books);

// The nearest vectors for every pixel of a view: index[books] -> [height][width], one book after
// another. `store_rms` (may be NULL) receives what that cost, as in struct relume_fidelity.
// RELUME_EIO, RELUME_ENOMEM, RELUME_ECANCEL. Only log, dither and threads of `params` are read.
relume_status relume_books_assign(uint16_t *const *index, double *store_rms,
                                  const relume_books *books, const relume_coefficients *view,
                                  const struct relume_books_params *params);

// Number d of a vector as a reader sees it.
float book_number(const struct relume_book *book, int d, int code);
// The part of coefficients v[planes] that is the book's, in orthonormal coordinates: out[dim].
void book_project(float *out, const struct relume_book *book, const float *v);
// vectors[codes][dim] become numbers[dim][codes] with a scale and offset for each d.
void book_store(void *numbers, float *scale, float *offset, const float *vectors, int codes,
                int dim, enum relume_storage storage);
// Reorder vectors[codes][dim] so that neighbours are alike: images of indices then compress better.
relume_status book_sort(float *vectors, int codes, int dim);

// What the indices of row `y` of a view say: planes[plane * stride + x].
void books_row(float *planes, size_t stride, const relume_books *books, uint16_t *const *index,
               size_t width, size_t y);

struct relume_books {
    struct relume_books_info info;
    struct relume_book book[RELUME_MOST_BOOKS];
    int codes[RELUME_MOST_BOOKS];
    const float *vectors[RELUME_MOST_BOOKS];
    struct own {
        void *numbers;
        float *scale, *offset, *vectors;
        struct nearest nearest;
    } own[RELUME_MOST_BOOKS];
};

// As relume_books_train. `by` (drawing.h) or NULL: views that are NULL are encoded by it, and the
// drawing of pixels is shared.
struct books_team;
relume_status books_train(relume_books **out, const relume_coefficients *const *views, int n,
                          const struct relume_books_params *params, const struct books_team *by);

#endif
