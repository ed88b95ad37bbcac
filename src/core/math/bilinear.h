// bilinear.h - values between the texels of a grid, and what lies beyond its edges
//
// Places count from the centre of the first texel: where pixel centres lie at +0.5, take half from
// both coordinates.
#ifndef MATH_BILINEAR_H
#define MATH_BILINEAR_H

#include <relume/base.h>
#include <math.h>

enum edge { EDGE_CLAMPED, EDGE_WRAPPED };  // the outermost texel again; the grid again

static inline int index_clamped(int i, int n)
{
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

static inline int index_wrapped(int i, int n)
{
    return (i % n + n) % n;
}

// The side in pixels of the cells of a coarse grid over a picture.
static inline int coarse_cell(int width, int height)
{
    const int cell = (width > height ? width : height) / 32;
    return cell < 4 ? 4 : cell > 32 ? 32 : cell;
}

// The four texels around a place, row by row, and how far it is from the first of them.
struct bilinear {
    size_t at[4];
    double across, down;  // [0, 1)
};

// Of a grid that begins at texel (first, top).
static inline struct bilinear bilinear_within(double x, double y, int first, int top, int width,
                                              int height, enum edge columns)
{
    const double left = floor(x), above = floor(y);
    struct bilinear b = {.across = x - left, .down = y - above};
    for (int k = 0; k < 4; k++) {
        const int i = relume_whole(left) - first + k % 2, j = relume_whole(above) - top + k / 2;
        const int column =
            columns == EDGE_WRAPPED ? index_wrapped(i, width) : index_clamped(i, width);
        b.at[k] = (size_t)index_clamped(j, height) * (size_t)width + (size_t)column;
    }
    return b;
}

static inline struct bilinear bilinear_at(double x, double y, int width, int height,
                                          enum edge columns)
{
    return bilinear_within(x, y, 0, 0, width, height, columns);
}

// The same of a grid that is repeated to all sides, from anywhere on the plane.
static inline struct bilinear bilinear_tiled(double x, double y, int width, int height)
{
    const double u = x - width * floor(x / width), v = y - height * floor(y / height);
    // a place a hair below 0 becomes the whole side
    const int i = index_clamped(relume_whole(u), width), j = index_clamped(relume_whole(v), height);
    const size_t row = (size_t)j * (size_t)width,
                 below = (size_t)(j + 1 < height ? j + 1 : 0) * (size_t)width;
    const size_t column = (size_t)i, right = (size_t)(i + 1 < width ? i + 1 : 0);
    return (struct bilinear){
        .at = {row + column, row + right, below + column, below + right},
        .across = fmin(u - i, 1.0),
        .down = fmin(v - j, 1.0),
    };
}

// `weight` times the share of texel k.
static inline double bilinear_share(const struct bilinear *b, int k, double weight)
{
    return weight * (k % 2 ? b->across : 1.0 - b->across) * (k / 2 ? b->down : 1.0 - b->down);
}

static inline float bilinear_sharef(const struct bilinear *b, int k, float weight)
{
    const float x = (float)b->across, y = (float)b->down;
    return weight * (k % 2 ? x : 1.0f - x) * (k / 2 ? y : 1.0f - y);
}

// One channel of data[texel][channels] in double precision, and in single.
static inline double bilinear_value(const struct bilinear *b, const float *data, size_t channels,
                                    size_t channel)
{
    const float *v = data + channel;
    const double x = b->across, y = b->down;
    const double top = v[channels * b->at[0]] * (1.0 - x) + v[channels * b->at[1]] * x;
    const double low = v[channels * b->at[2]] * (1.0 - x) + v[channels * b->at[3]] * x;
    return top * (1.0 - y) + low * y;
}

static inline float bilinear_valuef(const struct bilinear *b, const float *data, size_t channels,
                                    size_t channel)
{
    const float *v = data + channel, x = (float)b->across, y = (float)b->down;
    const float top = v[channels * b->at[0]] * (1.0f - x) + v[channels * b->at[1]] * x;
    const float low = v[channels * b->at[2]] * (1.0f - x) + v[channels * b->at[3]] * x;
    return top * (1.0f - y) + low * y;
}

// Adds the shares of a place in weights[side][side]; beyond the edges the outermost cell goes on.
static inline void bilinear_spread(double *weights, int side, double x, double y)
{
    const int i = (int)fmax(0.0, fmin(floor(x), side - 2)),
              j = (int)fmax(0.0, fmin(floor(y), side - 2));
    const struct bilinear b = {.across = x - i, .down = y - j};
    for (int k = 0; k < 4; k++)
        weights[i + k % 2 + side * (j + k / 2)] = bilinear_share(&b, k, 1.0);
}

#endif
