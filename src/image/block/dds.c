// dds.c - DDS files: a head that says what follows, and blocks or bytes as graphics cards take them
#include "image/block/dds.h"

#include <stdbool.h>
#include <string.h>

enum { CAPS = 0x1, HEIGHT = 0x2, WIDTH = 0x4, PIXELFORMAT = 0x1000, LINEARSIZE = 0x80000 };
enum { FOURCC = 0x4, TEXTURE = 0x1000, COMPLEX = 0x8, CUBE_OF_ALL_FACES = 0xfe00 };
enum { DXGI_R8_UNORM = 61, TEXTURE_2D = 3, MISC_CUBE = 0x4 };

static void word(uint8_t *head, int at, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        head[4 * at + i] = (uint8_t)(value >> 8 * i);
}

// By the head of DirectX 10, which names formats by number.
static void fill(uint8_t head[DDS_HEAD], int width, int height, size_t bytes, uint32_t dxgi,
                 bool cube)
{
    memset(head, 0, DDS_HEAD);
    memcpy(head, "DDS ", 4);
    word(head, 1, 124);
    word(head, 2, CAPS | HEIGHT | WIDTH | PIXELFORMAT | LINEARSIZE);
    word(head, 3, (uint32_t)height);
    word(head, 4, (uint32_t)width);
    word(head, 5, (uint32_t)bytes);
    word(head, 7, 1);  // levels
    word(head, 19, 32);
    word(head, 20, FOURCC);
    memcpy(head + 84, "DX10", 4);
    word(head, 27, TEXTURE | (cube ? COMPLEX : 0));
    word(head, 28, cube ? CUBE_OF_ALL_FACES : 0);
    word(head, 32, dxgi);
    word(head, 33, TEXTURE_2D);
    word(head, 34, cube ? MISC_CUBE : 0);
    word(head, 35, 1);  // pictures, or cubes
}

void dds_head(uint8_t head[DDS_HEAD], int width, int height, const struct block_format *format)
{
    fill(head, width, height, block_bytes(width, height, format), format->dxgi, false);
}

void dds_cube_head(uint8_t head[DDS_HEAD], int side)
{
    fill(head, side, side, (size_t)side * (size_t)side, DXGI_R8_UNORM, true);
}
