// bits.h - fields of a block: bits are filled from the lowest of the first byte on
#ifndef BLOCK_BITS_H
#define BLOCK_BITS_H

#include <stdint.h>

struct bits {
    uint8_t *byte;
    int at;
};

static inline void bits_put(struct bits *b, int value, int count)
{
    for (int i = 0; i < count; i++, b->at++)
        b->byte[b->at / 8] |= (uint8_t)((value >> i & 1) << b->at % 8);
}

static inline int bits_get(struct bits *b, int count)
{
    int value = 0;
    for (int i = 0; i < count; i++, b->at++)
        value |= (b->byte[b->at / 8] >> b->at % 8 & 1) << i;
    return value;
}

#endif
