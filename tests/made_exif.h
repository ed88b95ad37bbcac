// made_exif.h - JPEG files as a camera writes them: notes in EXIF, other application segments
#ifndef MADE_EXIF_H
#define MADE_EXIF_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum exif_type { EXIF_TEXT = 2, EXIF_SHORT = 3, EXIF_LONG = 4, EXIF_RATIONAL = 5 };

struct exif_bytes {
    uint8_t b[65536];
    size_t n;
};

static inline void exif_put16(struct exif_bytes *s, unsigned v)
{
    s->b[s->n++] = (uint8_t)(v >> 8);
    s->b[s->n++] = (uint8_t)v;
}
static inline void exif_put32(struct exif_bytes *s, uint32_t v)
{
    exif_put16(s, v >> 16);
    exif_put16(s, v & 0xffff);
}
static inline void exif_entry(struct exif_bytes *s, unsigned tag, unsigned type, uint32_t count,
                              uint32_t value)
{
    exif_put16(s, tag);
    exif_put16(s, type);
    exif_put32(s, count);
    exif_put32(s, type == EXIF_SHORT ? value << 16 : value);
}

// EXIF 2.3, big endian: an IFD of two entries, the EXIF IFD of four, and their data.
static inline void exif_make(struct exif_bytes *s, int orientation)
{
    enum { FIRST = 8, EXIF = FIRST + 2 + 2 * 12 + 4, DATA = EXIF + 2 + 4 * 12 + 4 };
    *s = (struct exif_bytes){.b = "Exif\0\0MM\0*", .n = 10};
    exif_put32(s, FIRST);
    exif_put16(s, 2);
    exif_entry(s, 0x0112, EXIF_SHORT, 1, (uint32_t)orientation);
    exif_entry(s, 0x8769, EXIF_LONG, 1, EXIF);
    exif_put32(s, 0);
    exif_put16(s, 4);
    exif_entry(s, 0x829a, EXIF_RATIONAL, 1, DATA);      // ExposureTime
    exif_entry(s, 0x829d, EXIF_RATIONAL, 1, DATA + 8);  // FNumber
    exif_entry(s, 0x8827, EXIF_SHORT, 1, 400);          // ISO
    exif_entry(s, 0x9003, EXIF_TEXT, 20, DATA + 16);    // DateTimeOriginal
    exif_put32(s, 0);
    exif_put32(s, 1);
    exif_put32(s, 50);
    exif_put32(s, 28);
    exif_put32(s, 10);
    memcpy(s->b + s->n, "2021:03:04 05:06:07", 20);
    s->n += 20;
}

// Put an application segment behind the first two bytes of a JPEG.
static inline void exif_insert(const char *path, unsigned marker, const struct exif_bytes *s)
{
    struct exif_bytes *out = calloc(1, sizeof *out);
    static uint8_t file[1 << 20];
    FILE *f = fopen(path, "rb");
    if (!f || !out)
        abort();
    const size_t size = fread(file, 1, sizeof file, f);
    fclose(f);
    exif_put16(out, 0xff00 | marker);
    exif_put16(out, (unsigned)s->n + 2);
    f = fopen(path, "wb");
    fwrite(file, 1, 2, f);
    fwrite(out->b, 1, 4, f);
    fwrite(s->b, 1, s->n, f);
    fwrite(file + 2, 1, size - 2, f);
    fclose(f);
    free(out);
}

#endif
