// books.c - with vector quantisation, relight the codebook, not the image: the dot products of its
// few thousand vectors replace those of all pixels
#include "relight/light/books.h"

#include <string.h>

// A multiple of 3 and of every vector width: products of plane p gather in lane p % LANES.
enum { LANES = 24 };

static void dot(float lane[LANES], const float *vector, const float *weights, int planes)
{
    memset(lane, 0, LANES * sizeof *lane);
    int p = 0;
    for (; p + LANES <= planes; p += LANES)
        for (int l = 0; l < LANES; l++)
            lane[l] += vector[p + l] * weights[p + l];
    for (int l = 0; p + l < planes; l++)
        lane[l] += vector[p + l] * weights[p + l];
}

static void relight_separate(float *rgb, const float *vectors, int count, int k,
                             const float *weights, const float bias[3])
{
    float by_plane[3 * RELUME_MOST_COEFFICIENTS], lane[LANES];
    for (int p = 0; p < 3 * k; p++)
        by_plane[p] = weights[p % 3 * k + p / 3];
    for (int v = 0; v < count; v++) {
        dot(lane, vectors + (size_t)v * 3 * (size_t)k, by_plane, 3 * k);
        memcpy(rgb + 3 * (size_t)v, bias, 3 * sizeof *bias);
        for (int l = 0; l < LANES; l++)
            rgb[3 * (size_t)v + (size_t)(l % 3)] += lane[l];
    }
}

static void relight_joint(float *rgb, const float *vectors, int count,
                          const struct relume_coder_info *info, const float *weights,
                          const float bias[3])
{
    const int k = info->coefficients;
    float lane[LANES];
    for (int v = 0; v < count; v++) {
        const float *vector = vectors + (size_t)v * (size_t)info->planes;
        for (int c = 0; c < 3; c++) {
            float *sum = &rgb[3 * (size_t)v + (size_t)c];
            dot(lane, vector, weights + c * k, k);
            *sum = bias[c];
            for (int l = 0; l < LANES; l++)
                *sum += lane[l];
            if (info->luminance)
                *sum *= vector[k + c];
        }
    }
}

void book_relight(float *rgb, const struct relume_codes *codes, int book, const float *weights,
                  const float bias[3])
{
    const struct relume_coder_info *info = relume_coder_info(codes->coder);
    const float *vectors = codes->vectors[book];
    const int count = codes->book_codes[book];
    if (info->joint)
        relight_joint(rgb, vectors, count, info, weights, bias);
    else
        relight_separate(rgb, vectors, count, info->coefficients, weights, bias);
}
