// scalar.h - numbers as one of a few levels, and such numbers of unlike widths in rows of bits
//
// A number of `bits` bits is the value
//     middle + linear t + cubic t^3,   t = -1 ... 1 in 2^bits - 1 equal steps.
// The cubic term puts levels closer together in the middle, where most numbers are, and costs two
// multiplications to undo. No bits: `middle`.
#ifndef BTF_MODEL_SCALAR_H
#define BTF_MODEL_SCALAR_H

#include <relume/base.h>

enum { LEVELS_BITS = 10 };  // at most

struct levels {
    float middle, linear, cubic;
};

static inline float levels_value(const struct levels *s, int bits, unsigned number)
{
    if (!bits)
        return s->middle;
    const float t = (float)(2 * number) / (float)((1u << bits) - 1) - 1.0f;
    return s->middle + t * (s->linear + s->cubic * t * t);
}

// The nearest level.
unsigned levels_number(const struct levels *s, int bits, float value);

// For each width the levels that lose least on values[count], `stride` apart, and the mean squared
// error that they leave; both have LEVELS_BITS + 1 entries. False: no memory.
bool levels_choose(const float *values, size_t count, size_t stride, struct levels *best,
                   double *error);

// Reads numbers of a row one after the other; never a byte more than it was asked for.
struct bit_reader {
    const uint8_t *next;
    uint32_t held;
    int count;
};

static inline unsigned bit_reader_take(struct bit_reader *r, int bits)
{
    while (r->count < bits) {
        r->held |= (uint32_t)*r->next++ << r->count;
        r->count += 8;
    }
    const unsigned number = r->held & ((1u << bits) - 1);
    r->held >>= bits;
    r->count -= bits;
    return number;
}

// Put a number at bit `at` of a row of zeros.
void bits_put(uint8_t *row, size_t at, int bits, unsigned number);

#endif
