// made_dng.h - a RAW photograph: uncompressed colour filter array in a DNG 1.4 file (a TIFF 6.0)
//
// The camera's colours are linear sRGB, so that an even grey comes back as the number it was.
#ifndef MADE_DNG_H
#define MADE_DNG_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DNG_SIDE = 64, DNG_BLACK = 64, DNG_WHITE = 4095 };
enum { DNG_BYTE = 1, DNG_TEXT = 2, DNG_SHORT = 3, DNG_LONG = 4, DNG_RATIONAL = 5, DNG_SIGNED = 10 };

struct dng {
    uint8_t bytes[16384];
    size_t entries, end;  // where the next entry and the next value go
};

static inline void dng_put(struct dng *d, size_t at, uint32_t v, size_t n)
{
    for (size_t i = 0; i < n; i++)
        d->bytes[at + i] = (uint8_t)(v >> 8 * i);
}

// `values` of the type; those of more than four bytes stand behind the directory.
static inline void dng_entry(struct dng *d, unsigned tag, unsigned type, size_t count,
                             const int *values)
{
    const size_t size = type == DNG_SHORT ? 2 : type >= DNG_LONG ? 4 : 1;
    const size_t numbers = type >= DNG_RATIONAL ? 2 * count : count, bytes = numbers * size;
    dng_put(d, d->entries, tag, 2);
    dng_put(d, d->entries + 2, type, 2);
    dng_put(d, d->entries + 4, (uint32_t)count, 4);
    const size_t at = bytes > 4 ? d->end : d->entries + 8;
    if (bytes > 4) {
        dng_put(d, d->entries + 8, (uint32_t)d->end, 4);
        d->end += (bytes + 1) / 2 * 2;
    }
    for (size_t i = 0; i < numbers; i++)
        dng_put(d, at + i * size, (uint32_t)values[i], size);
    d->entries += 12;
}
#define dng_add(d, tag, type, count, ...) dng_entry(d, tag, type, count, (const int[]){__VA_ARGS__})

// Steps of 8 pixels' width: full x (step + 0.5) / 8 of white. `size` bytes are written, 0: all.
static inline void dng_write(const char *path, double full, size_t size)
{
    enum { ENTRIES = 22, FIRST = 8 };
    static struct dng d;
    memset(&d, 0, sizeof d);
    memcpy(d.bytes, "II*\0\10\0\0\0", 8);
    dng_put(&d, FIRST, ENTRIES, 2);
    d.entries = FIRST + 2;
    d.end = FIRST + 2 + 12 * ENTRIES + 4;
    dng_add(&d, 254, DNG_LONG, 1, 0);
    dng_add(&d, 256, DNG_LONG, 1, DNG_SIDE);
    dng_add(&d, 257, DNG_LONG, 1, DNG_SIDE);
    dng_add(&d, 258, DNG_SHORT, 1, 16);
    dng_add(&d, 259, DNG_SHORT, 1, 1);
    dng_add(&d, 262, DNG_SHORT, 1, 32803);  // CFA
    dng_add(&d, 271, DNG_TEXT, 5, 'm', 'a', 'd', 'e', 0);
    dng_add(&d, 272, DNG_TEXT, 4, 'o', 'n', 'e', 0);
    const size_t strip = d.entries;
    dng_add(&d, 273, DNG_LONG, 1, 0);
    dng_add(&d, 274, DNG_SHORT, 1, 1);
    dng_add(&d, 277, DNG_SHORT, 1, 1);
    dng_add(&d, 278, DNG_LONG, 1, DNG_SIDE);
    dng_add(&d, 279, DNG_LONG, 1, 2 * DNG_SIDE * DNG_SIDE);
    dng_add(&d, 33421, DNG_SHORT, 2, 2, 2);
    dng_add(&d, 33422, DNG_BYTE, 4, 0, 1, 1, 2);
    dng_add(&d, 33434, DNG_RATIONAL, 1, 1, 50);  // 1/50 s
    dng_add(&d, 50706, DNG_BYTE, 4, 1, 4, 0, 0);
    dng_add(&d, 50714, DNG_SHORT, 1, DNG_BLACK);
    dng_add(&d, 50717, DNG_SHORT, 1, DNG_WHITE);
    // XYZ of D65 to linear sRGB
    dng_add(&d, 50721, DNG_SIGNED, 9, 32405, 10000, -15371, 10000, -4985, 10000, -9693, 10000,
            18760, 10000, 416, 10000, 556, 10000, -2040, 10000, 10572, 10000);
    dng_add(&d, 50728, DNG_RATIONAL, 3, 1, 1, 1, 1, 1, 1);
    dng_add(&d, 50778, DNG_SHORT, 1, 21);
    dng_put(&d, strip + 8, (uint32_t)d.end, 4);
    for (int i = 0; i < DNG_SIDE * DNG_SIDE; i++, d.end += 2) {
        const double v = full * (i % DNG_SIDE / 8 + 0.5) / 8.0;
        dng_put(&d, d.end, (uint32_t)(DNG_BLACK + (DNG_WHITE - DNG_BLACK) * v + 0.5), 2);
    }
    FILE *f = fopen(path, "wb");
    const size_t n = size ? size : d.end;
    if (!f || fwrite(d.bytes, 1, n, f) != n || fclose(f))
        abort();
}

#endif
