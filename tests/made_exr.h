// made_exr.h - uncompressed EXR files of luminance and coarser colour, written byte by byte
#ifndef TESTS_MADE_EXR_H
#define TESTS_MADE_EXR_H

#include "core/base/half.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

// Y in floats at every pixel, RY and BY in halves where x and y are even, perhaps A in halves.
struct made_exr {
    int x, y, width, height;  // the data window
    bool alpha;
    const float *chromaticities;              // [8], or NULL
    float (*at)(char channel, int x, int y);  // 'Y', 'R', 'B' or 'A' of a pixel of the picture
};

static inline void made_text(FILE *f, const char *text)
{
    fwrite(text, 1, strlen(text) + 1, f);
}

static inline void made_words(FILE *f, const void *words, int n)
{
    fwrite(words, 4, (size_t)n, f);
}

static inline void made_attribute(FILE *f, const char *name, const char *type, const void *value,
                                  int bytes)
{
    made_text(f, name);
    made_text(f, type);
    made_words(f, &bytes, 1);
    fwrite(value, 1, (size_t)bytes, f);
}

static inline void made_channel(FILE *f, const char *name, bool half, int step)
{
    const int words[4] = {half ? 1 : 2, 0, step, step};
    made_text(f, name);
    made_words(f, words, 4);
}

static inline void made_header(FILE *f, const struct made_exr *m)
{
    const int start[2] = {20000630, 2},
              box[4] = {m->x, m->y, m->x + m->width - 1, m->y + m->height - 1};
    const float one[2] = {1, 0}, centre[2] = {0, 0};
    const int bytes = 2 * (3 + 16) + 2 + 16 + 1 + (m->alpha ? 2 + 16 : 0);
    made_words(f, start, 2);
    made_text(f, "channels");
    made_text(f, "chlist");
    made_words(f, &bytes, 1);
    if (m->alpha)
        made_channel(f, "A", true, 1);
    made_channel(f, "BY", true, 2);
    made_channel(f, "RY", true, 2);
    made_channel(f, "Y", false, 1);
    fputc(0, f);
    made_attribute(f, "compression", "compression", "", 1);
    made_attribute(f, "dataWindow", "box2i", box, 16);
    made_attribute(f, "displayWindow", "box2i", box, 16);
    made_attribute(f, "lineOrder", "lineOrder", "", 1);
    made_attribute(f, "pixelAspectRatio", "float", one, 4);
    made_attribute(f, "screenWindowCenter", "v2f", centre, 8);
    made_attribute(f, "screenWindowWidth", "float", one, 4);
    if (m->chromaticities)
        made_attribute(f, "chromaticities", "chromaticities", m->chromaticities, 32);
    fputc(0, f);
}

static inline int made_row_bytes(const struct made_exr *m, int row)
{
    return m->width * (m->alpha ? 6 : 4) + (row % 2 ? 0 : (m->width + 1) / 2 * 4);
}

static inline void made_halves(FILE *f, const struct made_exr *m, char channel, int row, int step)
{
    for (int x = 0; x < m->width && row % step == 0; x += step) {
        const uint16_t half = half_from_float(m->at(channel, x, row));
        fwrite(&half, 2, 1, f);
    }
}

static inline void made_exr_write(const char *path, const struct made_exr *m)
{
    FILE *f = fopen(path, "wb");
    if (!f)
        return;
    made_header(f, m);
    uint64_t at = (uint64_t)ftell(f) + 8 * (uint64_t)m->height;
    for (int row = 0; row < m->height; at += 8 + (uint64_t)made_row_bytes(m, row++))
        fwrite(&at, 8, 1, f);
    for (int row = 0; row < m->height; row++) {
        const int head[2] = {m->y + row, made_row_bytes(m, row)};
        made_words(f, head, 2);
        if (m->alpha)
            made_halves(f, m, 'A', row, 1);
        made_halves(f, m, 'B', row, 2);
        made_halves(f, m, 'R', row, 2);
        for (int x = 0; x < m->width; x++) {
            const float y = m->at('Y', x, row);
            fwrite(&y, 4, 1, f);
        }
    }
    fclose(f);
}

#endif
