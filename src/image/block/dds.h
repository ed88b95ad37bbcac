// dds.h - DDS files: a head that says what follows, and blocks or bytes as graphics cards take them
#ifndef BLOCK_DDS_H
#define BLOCK_DDS_H

#include "image/block/block.h"

enum { DDS_HEAD = 148 };

// The blocks of a picture.
static inline size_t block_bytes(int width, int height, const struct block_format *format)
{
    return (size_t)((width + 3) / BLOCK_SIDE) * (size_t)((height + 3) / BLOCK_SIDE) * format->bytes;
}

// Of a picture of blocks, block_bytes of which follow; and of a cube map of bytes, six faces
// +x -x +y -y +z -z.
void dds_head(uint8_t head[DDS_HEAD], int width, int height, const struct block_format *format);
void dds_cube_head(uint8_t head[DDS_HEAD], int side);

#endif
