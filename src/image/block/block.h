// block.h - pictures for graphics cards: 4 x 4 pixels in 8 bytes (BC1) or 16 (BC6H, BC7)
#ifndef BLOCK_BLOCK_H
#define BLOCK_BLOCK_H

#include <stddef.h>
#include <stdint.h>

enum { BLOCK_SIDE = 4, BLOCK_PIXELS = 16, BLOCK_MOST_BYTES = 16 };

// A way of coding blocks. Constant.
struct block_format {
    const char *name;
    size_t bytes;   // of a block
    uint32_t dxgi;  // what DDS files call it
    // rgb[16][3], row by row, and back; NULL in the form of half floats.
    void (*encode)(uint8_t *out, const uint8_t (*rgb)[3]);
    void (*decode)(uint8_t (*rgb)[3], const uint8_t *in);
    // The same of the bits of half floats from 0 on, finite; NULL in the others.
    void (*encode_halves)(uint8_t *out, const uint16_t (*rgb)[3]);
    void (*decode_halves)(uint16_t (*rgb)[3], const uint8_t *in);
};
// S3's texture compression: two colours of 5, 6 and 5 bits, and two between them.
extern const struct block_format block_bc1;
// Two colours of 7 bits and a bit, and 14 between them: mode 6 of BC7, which is all that `decode`
// knows.
extern const struct block_format block_bc7;
// Half floats: two colours of 10 to 16 bits, and 14 between them: the undivided modes of BC6H,
// which are all that its decoder knows.
extern const struct block_format block_bc6h;

#endif
