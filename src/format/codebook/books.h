// books.h - the inside of the codebooks of a file
#ifndef CODEBOOK_BOOKS_H
#define CODEBOOK_BOOKS_H

#include "format/codebook/nearest.h"

#include <relume/format/codebook.h>

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
