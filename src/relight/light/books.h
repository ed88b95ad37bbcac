// books.h - relighting code vectors instead of pixels
#ifndef RELIGHT_BOOKS_H
#define RELIGHT_BOOKS_H

#include <relume/format/coder.h>

// What the vectors of one book add under one weight vector: rgb[v][c] = bias[c] + sum over k of
// weights[c K + k] x coefficient (k, c) of vector v.
void book_relight(float *rgb, const struct relume_codes *codes, int book, const float *weights,
                  const float bias[3]);

#endif
