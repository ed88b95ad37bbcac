// dct_block.h - the cosine transform of 8 x 8 samples, orthonormal
#ifndef ENCODE_DCT_BLOCK_H
#define ENCODE_DCT_BLOCK_H

#include <math.h>

enum { DCT_SIDE = 8, DCT_AREA = DCT_SIDE * DCT_SIDE };

// cosine[frequency][sample]
static inline void dct_set_cosines(float cosine[DCT_SIDE][DCT_SIDE])
{
    for (int k = 0; k < DCT_SIDE; k++)
        for (int x = 0; x < DCT_SIDE; x++)
            cosine[k][x] =
                (float)(sqrt((k ? 2.0 : 1.0) / DCT_SIDE) * cos(M_PI * (x + 0.5) * k / DCT_SIDE));
}

// block[y][x] becomes block[v][u].
static inline void dct_transform(float block[DCT_AREA], float cosine[DCT_SIDE][DCT_SIDE])
{
    float half[DCT_SIDE][DCT_SIDE];
    for (int y = 0; y < DCT_SIDE; y++)
        for (int u = 0; u < DCT_SIDE; u++) {
            half[y][u] = 0.0f;
            for (int x = 0; x < DCT_SIDE; x++)
                half[y][u] += cosine[u][x] * block[y * DCT_SIDE + x];
        }
    for (int v = 0; v < DCT_SIDE; v++)
        for (int u = 0; u < DCT_SIDE; u++) {
            float sum = 0.0f;
            for (int y = 0; y < DCT_SIDE; y++)
                sum += cosine[v][y] * half[y][u];
            block[v * DCT_SIDE + u] = sum;
        }
}

#endif
