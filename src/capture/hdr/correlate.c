// correlate.c - how well a block of one picture fits another at a shift
#include "capture/hdr/correlate.h"

#include "core/base/thread.h"

#include <math.h>
#include <string.h>

static const double least_overlap = 0.25;
static const double noise = 1e-6;  // a thousandth of full scale, squared: less than 8 bits hold

struct rectangle rectangle_clip(struct rectangle r, int x, int y, int width, int height)
{
    const int x1 = r.x + r.width < x + width ? r.x + r.width : x + width;
    const int y1 = r.y + r.height < y + height ? r.y + r.height : y + height;
    r.x = r.x > x ? r.x : x;
    r.y = r.y > y ? r.y : y;
    r.width = x1 > r.x ? x1 - r.x : 0;
    r.height = y1 > r.y ? y1 - r.y : 0;
    return r;
}

// Sums of a block's samples and products, four at a time (a vector type of GCC and Clang: from
// loops over arrays neither makes good code); a block has few enough samples for single precision.
typedef float four __attribute__((vector_size(16)));

struct sums {
    four b, bb, ab;
};

static four load(const float *from)
{
    four v;
    memcpy(&v, from, sizeof v);
    return v;
}

static void add_row(struct sums *s, const float *a, const float *b, int n)
{
    struct sums even = *s, odd = {{0}, {0}, {0}};
    int i = 0;
    for (; i + 8 <= n; i += 8) {
        const four a0 = load(a + i), a1 = load(a + i + 4), b0 = load(b + i), b1 = load(b + i + 4);
        even.b += b0;
        even.bb += b0 * b0;
        even.ab += a0 * b0;
        odd.b += b1;
        odd.bb += b1 * b1;
        odd.ab += a1 * b1;
    }
    for (; i < n; i++) {
        odd.b[0] += b[i];
        odd.bb[0] += b[i] * b[i];
        odd.ab[0] += a[i] * b[i];
    }
    *s = (struct sums){even.b + odd.b, even.bb + odd.bb, even.ab + odd.ab};
}

static double total(four v)
{
    return ((double)v[0] + (double)v[1]) + ((double)v[2] + (double)v[3]);
}

struct moments block_moments(const struct relume_image *image, const struct rectangle *r)
{
    const size_t stride = 3 * (size_t)image->width;
    struct sums sum = {{0}, {0}, {0}};
    for (int y = r->y; y < r->y + r->height; y++) {
        const float *row = image->data + (size_t)y * stride + 3 * (size_t)r->x;
        add_row(&sum, row, row, 3 * r->width);
    }
    return (struct moments){total(sum.b), total(sum.bb)};
}

double block_correlation(const struct relume_image *anchor, const struct relume_image *image,
                         const struct rectangle *r, struct moments known, int dx, int dy)
{
    const struct rectangle p = rectangle_clip(*r, -dx, -dy, image->width, image->height);
    if ((double)p.width * p.height < least_overlap * r->width * r->height)
        return (double)-INFINITY;
    const size_t stride = 3 * (size_t)anchor->width;
    const bool whole = p.width == r->width && p.height == r->height;
    const struct moments m = whole ? known : block_moments(anchor, &p);
    struct sums sum = {{0}, {0}, {0}};
    for (int y = p.y; y < p.y + p.height; y++)
        add_row(&sum, anchor->data + (size_t)y * stride + 3 * (size_t)p.x,
                image->data + (size_t)(y + dy) * stride + 3 * (size_t)(p.x + dx), 3 * p.width);
    const double n = 3.0 * p.width * p.height, b = total(sum.b);
    const double aa = m.aa - m.a * m.a / n, bb = total(sum.bb) - b * b / n;
    if (!(aa > noise * n) || !(bb > noise * n))
        return 0.0;
    return (total(sum.ab) - m.a * b / n) / sqrt(aa * bb);
}

static void sharpen_row(void *context, size_t y, int worker)
{
    struct relume_image *const *io = context;
    (void)worker;
    const struct relume_image *in = io[0];
    const size_t n = (size_t)in->channels, width = (size_t)in->width, stride = n * width;
    const float *row = in->data + y * stride;
    const float *up = y > 0 ? row - stride : row;
    const float *down = y + 1 < (size_t)in->height ? row + stride : row;
    float *out = io[1]->data + y * stride;
    for (size_t x = 0; x < width; x++)
        for (size_t c = 0; c < n; c++) {
            const size_t i = x * n + c, left = x > 0 ? i - n : i, right = x + 1 < width ? i + n : i;
            out[i] = 2.0f * row[i] - 0.25f * (row[left] + row[right] + up[i] + down[i]);
        }
}

relume_status sharpen(struct relume_image *image, int threads)
{
    struct relume_image out;
    const relume_status status =
        relume_image_create(&out, image->width, image->height, image->channels);
    if (status)
        return status;
    struct relume_image *io[2] = {image, &out};
    thread_for(threads, (size_t)image->height, sharpen_row, io);
    relume_image_destroy(image);
    *image = out;
    return RELUME_OK;
}
