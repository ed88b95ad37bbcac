// ssim.c - the index from filtered sums and differences
//
// With s = a + b and d = a - b the five filtered products of the paper become four, and all of them
// subtract only at the end:
//     2 ma mb = (ms^2 - md^2) / 2    ma^2 + mb^2 = (ms^2 + md^2) / 2
//     2 cov   = (vs - vd) / 2        va + vb     = (vs + vd) / 2
// Each row of the planes is filtered along x once and kept in a ring of 11; rows of the ring are
// then filtered along y. The window is symmetric, so that equal weights share a product.
#include "image/compare/ssim.h"

#include <math.h>

enum { RADIUS = 5, TAPS = 2 * RADIUS + 1, FIELDS = 4 };

static void make_kernel(double kernel[RADIUS + 1])
{
    double sum = 0.0;
    for (int i = 0; i <= RADIUS; i++) {
        kernel[i] = exp(-i * i / (2.0 * 1.5 * 1.5));
        sum += i ? 2.0 * kernel[i] : kernel[i];
    }
    for (int i = 0; i <= RADIUS; i++)
        kernel[i] /= sum;
}

// Beside the ring: the four fields of one row, and the index of one row.
size_t ssim_scratch(int width)
{
    return (size_t)(TAPS * FIELDS + FIELDS + 1) * (size_t)width;
}

static void filter_along(const double *from, double *to, int width, const double *k)
{
    for (int x = RADIUS; x < width - RADIUS; x++)
        to[x] = k[0] * from[x] + k[1] * (from[x - 1] + from[x + 1]) +
                k[2] * (from[x - 2] + from[x + 2]) + k[3] * (from[x - 3] + from[x + 3]) +
                k[4] * (from[x - 4] + from[x + 4]) + k[5] * (from[x - 5] + from[x + 5]);
}

static void filter_row(const float *a, const float *b, int width, const double *kernel,
                       double *field, double *ring)
{
    double *s = field, *d = s + width, *ss = d + width, *dd = ss + width;
    for (int x = 0; x < width; x++) {
        s[x] = (double)a[x] + (double)b[x];
        d[x] = (double)a[x] - (double)b[x];
        ss[x] = s[x] * s[x];
        dd[x] = d[x] * d[x];
    }
    for (int f = 0; f < FIELDS; f++)
        filter_along(field + f * width, ring + f * width, width, kernel);
}

static inline double filter_across(const double *const row[TAPS], int x, const double *k)
{
    return k[0] * row[5][x] + k[1] * (row[4][x] + row[6][x]) + k[2] * (row[3][x] + row[7][x]) +
           k[3] * (row[2][x] + row[8][x]) + k[4] * (row[1][x] + row[9][x]) +
           k[5] * (row[0][x] + row[10][x]);
}

static void index_row(const double *const row[TAPS], int width, const double *k, double *index)
{
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;  // values lie in [0, 1]
    for (int x = RADIUS; x < width - RADIUS; x++) {
        const double ms = filter_across(row, x, k), md = filter_across(row, width + x, k);
        const double vs = filter_across(row, 2 * width + x, k) - ms * ms;
        const double vd = filter_across(row, 3 * width + x, k) - md * md;
        index[x] = (0.5 * (ms * ms - md * md) + c1) * (0.5 * (vs - vd) + c2) /
                   ((0.5 * (ms * ms + md * md) + c1) * (0.5 * (vs + vd) + c2));
    }
}

static void add_row(struct ssim_sum *total, const double *index, const float *mask, int width)
{
    for (int x = RADIUS; x < width - RADIUS; x++)
        if (!mask || mask[x] > 0.5f) {
            total->sum += index[x];
            total->windows++;
        }
}

struct ssim_sum ssim_rows(const float *a, const float *b, const float *mask, int width, int height,
                          int first, int end, double *scratch)
{
    struct ssim_sum total = {0.0, 0};
    const size_t w = (size_t)width;
    double *field = scratch + TAPS * FIELDS * w, *index = field + FIELDS * w;
    double kernel[RADIUS + 1];
    make_kernel(kernel);
    first = first < RADIUS ? RADIUS : first;
    end = end > height - RADIUS ? height - RADIUS : end;
    if (width < TAPS || first >= end)
        return total;
    for (int y = first - RADIUS; y < end + RADIUS; y++) {
        const size_t at = (size_t)y * w;
        filter_row(a + at, b + at, width, kernel, field, scratch + (size_t)(y % TAPS) * FIELDS * w);
        if (y < first + RADIUS)
            continue;
        const double *row[TAPS];
        for (int i = 0; i < TAPS; i++)
            row[i] = scratch + (size_t)((y - 2 * RADIUS + i) % TAPS) * FIELDS * w;
        index_row(row, width, kernel, index);
        add_row(&total, index, mask ? mask + at - (size_t)RADIUS * w : NULL, width);
    }
    return total;
}
