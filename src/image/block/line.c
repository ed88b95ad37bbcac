// line.c - the line in colour space along which the pixels of a block are placed
#include "image/block/line.h"

#include <limits.h>
#include <math.h>

enum { ROUNDS = 8 };

static float clip(float v, float most)
{
    return fminf(fmaxf(v, 0.0f), most);
}

void line_values(float out[BLOCK_PIXELS][3], const uint8_t (*rgb)[3])
{
    for (int i = 0; i < BLOCK_PIXELS; i++)
        for (int c = 0; c < 3; c++)
            out[i][c] = (float)rgb[i][c];
}

static void find_mean(float mean[3], const float (*rgb)[3])
{
    for (int c = 0; c < 3; c++) {
        mean[c] = 0.0f;
        for (int i = 0; i < BLOCK_PIXELS; i++)
            mean[c] += rgb[i][c] / BLOCK_PIXELS;
    }
}

// By repeated products with the covariance, from its longest row on.
static void find_axis(float axis[3], const float (*rgb)[3], const float mean[3])
{
    float m[3][3] = {{0.0f}};
    int longest = 0;
    for (int i = 0; i < BLOCK_PIXELS; i++)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                m[a][b] += (rgb[i][a] - mean[a]) * (rgb[i][b] - mean[b]);
    for (int c = 1; c < 3; c++)
        longest = m[c][c] > m[longest][longest] ? c : longest;
    for (int c = 0; c < 3; c++)
        axis[c] = m[longest][c];
    for (int round = 0; round < ROUNDS; round++) {
        float next[3], length = 0.0f;
        for (int a = 0; a < 3; a++) {
            next[a] = m[a][0] * axis[0] + m[a][1] * axis[1] + m[a][2] * axis[2];
            length += next[a] * next[a];
        }
        length = sqrtf(length);
        for (int c = 0; c < 3; c++)
            axis[c] = length > 0.0f ? next[c] / length : 0.0f;
    }
}

struct line line_fit(const float (*rgb)[3], float highest)
{
    float mean[3], axis[3], least = 0.0f, most = 0.0f;
    struct line line;
    find_mean(mean, rgb);
    find_axis(axis, rgb, mean);
    for (int i = 0; i < BLOCK_PIXELS; i++) {
        float at = 0.0f;
        for (int c = 0; c < 3; c++)
            at += axis[c] * (rgb[i][c] - mean[c]);
        least = fminf(least, at);
        most = fmaxf(most, at);
    }
    for (int c = 0; c < 3; c++) {
        line.end[0][c] = clip(mean[c] + least * axis[c], highest);
        line.end[1][c] = clip(mean[c] + most * axis[c], highest);
    }
    return line;
}

int line_refit(struct line *out, const float (*rgb)[3], const float at[BLOCK_PIXELS], float highest)
{
    float aa = 0.0f, ab = 0.0f, bb = 0.0f;
    for (int i = 0; i < BLOCK_PIXELS; i++) {
        const float b = at[i], a = 1.0f - b;
        aa += a * a;
        ab += a * b;
        bb += b * b;
    }
    const float determinant = aa * bb - ab * ab;
    if (!(determinant > 1e-3f))
        return 0;
    for (int c = 0; c < 3; c++) {
        float a = 0.0f, b = 0.0f;
        for (int i = 0; i < BLOCK_PIXELS; i++) {
            a += (1.0f - at[i]) * rgb[i][c];
            b += at[i] * rgb[i][c];
        }
        out->end[0][c] = clip((a * bb - b * ab) / determinant, highest);
        out->end[1][c] = clip((b * aa - a * ab) / determinant, highest);
    }
    return 1;
}

int line_nearest(uint8_t index[BLOCK_PIXELS], const int (*palette)[3], int colours,
                 const uint8_t (*rgb)[3])
{
    int sum = 0;
    for (int i = 0; i < BLOCK_PIXELS; i++) {
        int least = INT_MAX;
        for (int k = 0; k < colours; k++) {
            int error = 0;
            for (int c = 0; c < 3; c++)
                error += (rgb[i][c] - palette[k][c]) * (rgb[i][c] - palette[k][c]);
            if (error < least) {
                least = error;
                index[i] = (uint8_t)k;
            }
        }
        sum += least;
    }
    return sum;
}
