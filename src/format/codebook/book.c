// book.c - one codebook as numbers in a file, and the vectors that they code
#include "format/codebook/books.h"
#include "format/coder/codes.h"
#include "format/coder/coefficients.h"

#include <math.h>
#include <string.h>

static const float SQRT_HALF = 0.70710678f, SQRT_THIRD = 0.57735027f, SQRT_SIXTH = 0.40824829f;

int relume_book_dim(enum relume_book_kind kind, int first, int last)
{
    if (first < 0 || last <= first)
        return 0;
    if (kind == RELUME_BOOK_PLANES)
        return last - first;
    if (first % 3 || last % 3)
        return 0;
    return (last - first) / 3 * (kind == RELUME_BOOK_LUMA ? 1 : 2);
}

float book_number(const struct relume_book *b, int d, int code)
{
    const size_t at = (size_t)d * (size_t)b->codes + (size_t)code;
    float number;
    codes_restore(&number, b->storage, b->numbers, at, 1, b->scale[d], b->offset[d]);
    return number;
}

static void expand_vector(float *v, const struct relume_book *b, int code)
{
    const int triples = (b->last - b->first) / 3;
    v += b->first;
    if (b->kind == RELUME_BOOK_PLANES)
        for (int d = 0; d < b->dim; d++)
            v[d] = book_number(b, d, code);
    else if (b->kind == RELUME_BOOK_LUMA)
        for (int t = 0; t < triples; t++)
            v[3 * t] = v[3 * t + 1] = v[3 * t + 2] = SQRT_THIRD * book_number(b, t, code);
    else
        for (int t = 0; t < triples; t++) {
            const float U = book_number(b, 2 * t, code), V = book_number(b, 2 * t + 1, code);
            v[3 * t] = SQRT_HALF * U + SQRT_SIXTH * V;
            v[3 * t + 1] = -2.0f * SQRT_SIXTH * V;
            v[3 * t + 2] = SQRT_SIXTH * V - SQRT_HALF * U;
        }
}

void relume_book_expand(float *vectors, const struct relume_book *book, int planes)
{
    memset(vectors, 0, (size_t)book->codes * (size_t)planes * sizeof *vectors);
    for (int c = 0; c < book->codes; c++)
        expand_vector(vectors + (size_t)c * (size_t)planes, book, c);
}

void book_project(float *out, const struct relume_book *b, const float *v)
{
    const int triples = (b->last - b->first) / 3;
    v += b->first;
    if (b->kind == RELUME_BOOK_PLANES)
        memcpy(out, v, (size_t)b->dim * sizeof *out);
    else if (b->kind == RELUME_BOOK_LUMA)
        for (int t = 0; t < triples; t++)
            out[t] = SQRT_THIRD * (v[3 * t] + v[3 * t + 1] + v[3 * t + 2]);
    else
        for (int t = 0; t < triples; t++) {
            out[2 * t] = SQRT_HALF * (v[3 * t] - v[3 * t + 2]);
            out[2 * t + 1] = SQRT_SIXTH * (v[3 * t] - 2.0f * v[3 * t + 1] + v[3 * t + 2]);
        }
}

// Codes 0 .. top span the numbers; where these hold 0, 0 is a code of its own, so that black stays
// black.
static void choose_step(const float *vectors, int codes, int dim, int d,
                        enum relume_storage storage, float *scale, float *offset)
{
    const int top = relume_storage_top(storage);
    const bool whole = storage == RELUME_STORE_FLOAT;
    float min = vectors[d], max = vectors[d];
    for (int c = 0; c < codes; c++) {
        const float v = vectors[(size_t)c * (size_t)dim + (size_t)d];
        min = v < min ? v : min;
        max = v > max ? v : max;
    }
    const bool holds_zero = min <= 0.0f && max >= 0.0f;
    *scale = top && max - min > 1e-30f ? (max - min) / (float)(holds_zero ? top - 1 : top)
             : top || whole            ? 1.0f
                                       : coefficients_half_scale((struct range){min, max});
    *offset = !top ? 0.0f : holds_zero ? -ceilf(-min / *scale) * *scale : min;
}

void book_store(void *numbers, float *scale, float *offset, const float *vectors, int codes,
                int dim, enum relume_storage storage)
{
    const float top = (float)relume_storage_top(storage);
    for (int d = 0; d < dim; d++) {
        choose_step(vectors, codes, dim, d, storage, &scale[d], &offset[d]);
        for (int c = 0; c < codes; c++) {
            const float v = vectors[(size_t)c * (size_t)dim + (size_t)d];
            const float number = (v - offset[d]) / scale[d];
            const float kept = top > 0.0f ? fminf(fmaxf(rintf(number), 0.0f), top) : number;
            (void)codes_keep(numbers, storage, (size_t)d * (size_t)codes + (size_t)c, &kept, 1);
        }
    }
}
