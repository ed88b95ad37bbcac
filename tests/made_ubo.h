// made_ubo.h - writes .btf files of the University of Bonn from known numbers, in doubles and with
// arithmetic of its own, so that the reader is not tested against itself (docs/btf-bonn.md)
#ifndef MADE_UBO_H
#define MADE_UBO_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct made_ubo {
    const char *signature;  // with its R, if any
    int version;            // of the header
    bool cosine;
    const char *description;
    int views, lights;
    const double (*view)[2], (*light)[2];  // from the pole, azimuth, in radians
    int width, height;
    int rotations;
    int extension;  // of !FMF12FCE: its version
    bool logarithm;
    int map_width, map_height;
    int colours;  // of !DFMF08FC
    float mean[3], matrix[9];
    int scalar[3];
    int rank[3];
    bool turned;  // texels in the first factor
    // What a factor holds: the k-th number of a pair, of a texel. !FMF...: `pair` of each colour.
    double (*pair)(const struct made_ubo *m, int colour, int k, int pair);
    double (*texel)(const struct made_ubo *m, int colour, int k, int texel);
};

struct made_bytes {
    uint8_t *data;
    size_t size;
};

static inline void made_add(struct made_bytes *b, const void *bytes, size_t n)
{
    b->data = realloc(b->data, b->size + n + 1);
    if (!b->data)
        abort();
    if (n && bytes)
        memcpy(b->data + b->size, bytes, n);
    else
        memset(b->data + b->size, 0, n);
    b->size += n;
}

static inline void made_word(struct made_bytes *b, uint32_t w)
{
    const uint8_t bytes[4] = {(uint8_t)w, (uint8_t)(w >> 8), (uint8_t)(w >> 16),
                              (uint8_t)(w >> 24)};
    made_add(b, bytes, 4);
}

static inline void made_float(struct made_bytes *b, double d)
{
    const float f = (float)d;
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    made_word(b, bits);
}

// The nearest half, by its definition: 11 bits from 2^-14 on, steps of 2^-24 below.
static inline double made_round(double d)
{
    int e = 0;
    frexp(d, &e);
    const double step = ldexp(1.0, e < -13 ? -24 : e - 11);
    return nearbyint(d / step) * step;
}

static inline uint16_t made_half(double d)
{
    const double r = fabs(made_round(d));
    const uint16_t sign = d < 0.0 ? 0x8000 : 0;
    int e = 0;
    if (isnan(d))
        return 0x7e00;
    if (r == 0.0)
        return sign;
    if (r >= 65520.0)
        return sign | 0x7c00;
    const double m = frexp(r, &e);  // r = m 2^e, 0.5 <= m < 1
    if (e < -13)
        return sign | (uint16_t)(r * 16777216.0);
    return sign | (uint16_t)((e + 14) << 10) | (uint16_t)((2.0 * m - 1.0) * 1024.0);
}

static inline void made_number(struct made_bytes *b, double d, int scalar)
{
    const uint16_t h = made_half(d);
    const uint8_t half[2] = {(uint8_t)h, (uint8_t)(h >> 8)};
    if (scalar == 2)
        made_add(b, half, 2);
    else if (scalar == 4)
        made_float(b, d);
    else
        made_add(b, &d, 8);
}

static inline void made_head(struct made_bytes *b, const struct made_ubo *m)
{
    static const char *const names[3] = {"R", "green", ""};
    const char *text = m->description ? m->description : "";
    struct made_bytes rest = {NULL, 0};
    made_add(&rest, NULL, 3 * 80);
    made_float(&rest, 12.5);  // pixels a mm
    for (int i = 0; i < 3; i++)
        made_float(&rest, 1.0);
    if (m->version > 1)
        made_word(&rest, m->cosine);
    if (m->version > 2) {
        made_word(&rest, (uint32_t)strlen(text));
        made_add(&rest, text, strlen(text));
    }
    if (m->version > 3)
        made_word(&rest, 3);
    for (int i = 0; m->version > 3 && i < 3; i++) {
        made_word(&rest, (uint32_t)strlen(names[i]));
        made_add(&rest, names[i], strlen(names[i]));
    }
    made_word(b, (uint32_t)rest.size + 8);
    made_word(b, (uint32_t)m->version);
    made_add(b, rest.data, rest.size);
    free(rest.data);
}

static inline void made_directions(struct made_bytes *b, const struct made_ubo *m)
{
    made_word(b, (uint32_t)m->views);
    for (int v = 0; v < m->views; v++) {
        for (int i = 0; i < 2; i++)
            made_float(b, m->view[v][i]);
        made_word(b, (uint32_t)m->lights);
        for (int l = 0; l < m->lights; l++)
            for (int i = 0; i < 2; i++)
                made_float(b, m->light[l][i]);
    }
}

// A factor: `of` pairs or texels of colours `first` to `last`, a row each.
static inline void made_factor(struct made_bytes *b, const struct made_ubo *m, bool pairs, int of,
                               int first, int last)
{
    for (int i = 0; i < of; i++)
        for (int c = first; c <= last; c++)
            for (int k = 0; k < m->rank[first]; k++)
                made_number(b, pairs ? m->pair(m, c, k, i) : m->texel(m, c, k, i),
                            m->scalar[first]);
}

static inline void made_plane(struct made_bytes *b, const struct made_ubo *m, int first, int last)
{
    const int pairs = m->views * m->lights, texels = m->width * m->height, each = last - first + 1;
    const uint8_t scalar = (uint8_t)m->scalar[first];
    made_add(b, &scalar, 1);
    made_word(b, (uint32_t)m->rank[first]);
    made_word(b, (uint32_t)(each * (m->turned ? texels : pairs)));
    made_word(b, (uint32_t)(m->turned ? pairs : texels));
    for (int k = 0; k < m->rank[first]; k++)
        made_number(b, 7.0, scalar);  // singular values, which nobody needs
    made_factor(b, m, !m->turned, m->turned ? texels : pairs, first, last);
    made_factor(b, m, m->turned, m->turned ? pairs : texels, first, first);
}

static inline struct made_bytes made_ubo(const struct made_ubo *m)
{
    const size_t n = strlen(m->signature);
    struct made_bytes b = {NULL, 0};
    made_add(&b, m->signature, n);
    made_head(&b, m);
    made_directions(&b, m);
    made_word(&b, (uint32_t)m->width);
    made_word(&b, (uint32_t)m->height);
    if (m->signature[n - 1] == 'R')
        made_word(&b, (uint32_t)m->rotations);
    made_add(&b, NULL, (size_t)m->rotations * 36);
    if (m->signature[1] == 'D') {
        made_word(&b, (uint32_t)(m->rank[0] + m->rank[1] + m->rank[2]));
        made_word(&b, (uint32_t)m->colours);
        for (int i = 0; i < 3; i++)
            made_float(&b, m->mean[i]);
        for (int i = 0; i < 9; i++)
            made_float(&b, m->matrix[i]);
        for (int c = 0; c < 3; c++)
            made_plane(&b, m, c, c);
        return b;
    }
    if (!strncmp(m->signature, "!FMF12", 6)) {
        const uint8_t version = (uint8_t)m->extension;
        made_add(&b, &version, 1);
        if (version > 0)
            made_word(&b, m->logarithm ? 3 : 0);
        if (version > 1) {
            made_word(&b, (uint32_t)m->map_width);
            made_word(&b, (uint32_t)m->map_height);
            made_add(&b, NULL, 2 * (size_t)m->map_width * (size_t)m->map_height);
        }
    }
    made_word(&b, (uint32_t)m->rank[0]);
    made_plane(&b, m, 0, 2);
    return b;
}

static inline void made_ubo_save(const char *path, const struct made_ubo *m)
{
    struct made_bytes b = made_ubo(m);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(b.data, 1, b.size, file) != b.size || fclose(file))
        abort();
    free(b.data);
}

#endif
