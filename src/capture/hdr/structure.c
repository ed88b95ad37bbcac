// structure.c - what stays of a picture when exposure and light change: its edges
#include "capture/hdr/structure.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"

#include <math.h>

enum {
    HALF = 8,    // of the surroundings
    CHUNK = 64,  // pixels whose sums are kept
    BAND = 32    // rows
};
static const double quiet = 0.1;

struct luma {
    const struct relume_image *in;
    struct relume_image *out;
};

static void luma_row(void *context, size_t y, int worker)
{
    const struct luma *l = context;
    (void)worker;
    const size_t width = (size_t)l->in->width, n = (size_t)l->in->channels;
    const float *in = l->in->data + y * width * n;
    float *out = l->out->data + y * width;
    for (size_t x = 0; x < width; x++, in += n) {
        float sum = 0.0f;
        for (size_t c = 0; c < n; c++)
            sum += in[c];
        out[x] = sum > 0.0f ? sqrtf(sum / (float)n) : 0.0f;
    }
}

relume_status structure_luma(struct relume_image *out, const struct relume_image *image,
                             int threads)
{
    const relume_status status = relume_image_create(out, image->width, image->height, 1);
    if (!status)
        thread_for(threads, (size_t)image->height, luma_row, &(struct luma){image, out});
    return status;
}

// ---------------------------------------------------------------- edges

struct edges {
    const struct relume_image *luma;
    struct relume_image magnitude, mean, squares;  // the last two summed along rows
    struct relume_image *out;
    double floor;
};

// Sobel.
static void magnitude_row(void *context, size_t row, int worker)
{
    struct edges *e = context;
    (void)worker;
    const int width = e->luma->width, height = e->luma->height, y = (int)row;
    const size_t stride = (size_t)width;
    const float *a = e->luma->data + (size_t)index_clamped(y - 1, height) * stride;
    const float *b = e->luma->data + row * stride;
    const float *c = e->luma->data + (size_t)index_clamped(y + 1, height) * stride;
    for (int x = 0; x < width; x++) {
        const int l = index_clamped(x - 1, width), r = index_clamped(x + 1, width);
        const float gx = a[r] - a[l] + 2.0f * (b[r] - b[l]) + c[r] - c[l];
        const float gy = c[l] - a[l] + 2.0f * (c[x] - a[x]) + c[r] - a[r];
        e->magnitude.data[row * stride + (size_t)x] = sqrtf(gx * gx + gy * gy);
    }
}

// Running sums along a row, over 2 HALF + 1 pixels with the ends repeated.
static void sum_row(void *context, size_t row, int worker)
{
    struct edges *e = context;
    (void)worker;
    const int width = e->luma->width;
    const float *m = e->magnitude.data + row * (size_t)width;
    double sum = 0.0, squares = 0.0;
    for (int x = -HALF; x < HALF; x++) {
        const double v = (double)m[index_clamped(x, width)];
        sum += v;
        squares += v * v;
    }
    for (int x = 0; x < width; x++) {
        const double in = (double)m[index_clamped(x + HALF, width)],
                     out = (double)m[index_clamped(x - HALF, width)];
        sum += in;
        squares += in * in;
        e->mean.data[row * (size_t)width + (size_t)x] = (float)sum;
        e->squares.data[row * (size_t)width + (size_t)x] = (float)squares;
        sum -= out;
        squares -= out * out;
    }
}

// Adds a row of sums, its border repeated, `times`.
static void add_row(double sum[CHUNK], const struct relume_image *from, int row, size_t first,
                    size_t n, double times)
{
    const size_t i = (size_t)index_clamped(row, from->height) * (size_t)from->width + first;
    for (size_t x = 0; x < n; x++)
        sum[x] += times * (double)from->data[i + x];
}

// Normalises `n` pixels, at most CHUNK, of the rows of a band. Sums move down from row to row.
static void normalise(const struct edges *e, int top, int end, size_t first, size_t n)
{
    const double area = (2.0 * HALF + 1) * (2.0 * HALF + 1);
    double sum[CHUNK] = {0.0}, squares[CHUNK] = {0.0};
    for (int k = -HALF; k < HALF; k++) {
        add_row(sum, &e->mean, top + k, first, n, 1.0);
        add_row(squares, &e->squares, top + k, first, n, 1.0);
    }
    for (int y = top; y < end; y++) {
        add_row(sum, &e->mean, y + HALF, first, n, 1.0);
        add_row(squares, &e->squares, y + HALF, first, n, 1.0);
        const size_t i = (size_t)y * (size_t)e->luma->width + first;
        for (size_t x = 0; x < n; x++) {
            const double mean = sum[x] / area;
            const double variance = fmax(squares[x] / area - mean * mean, 0.0);
            const double v = (double)e->magnitude.data[i + x] - mean;
            e->out->data[i + x] = (float)(v / (sqrt(variance) + e->floor + 1e-12));
        }
        add_row(sum, &e->mean, y - HALF, first, n, -1.0);
        add_row(squares, &e->squares, y - HALF, first, n, -1.0);
    }
}

static void normalise_band(void *context, size_t band, int worker)
{
    struct edges *e = context;
    (void)worker;
    const size_t width = (size_t)e->luma->width;
    const int top = (int)band * BAND;
    const int end = e->luma->height - top < BAND ? e->luma->height : top + BAND;
    for (size_t x = 0; x < width; x += CHUNK)
        normalise(e, top, end, x, width - x < CHUNK ? width - x : CHUNK);
}

static double deviation(const struct relume_image *image)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    double sum = 0.0, squares = 0.0;
    for (size_t i = 0; i < pixels; i++) {
        sum += (double)image->data[i];
        squares += (double)image->data[i] * (double)image->data[i];
    }
    const double mean = sum / (double)pixels;
    return sqrt(fmax(squares / (double)pixels - mean * mean, 0.0));
}

relume_status structure_make(struct relume_image *out, const struct relume_image *luma, int threads)
{
    const size_t rows = (size_t)luma->height;
    struct edges e = {.luma = luma, .out = out};
    relume_status status = relume_image_create(out, luma->width, luma->height, 1);
    struct relume_image *own[] = {&e.magnitude, &e.mean, &e.squares};
    for (int i = 0; !status && i < 3; i++)
        status = relume_image_create(own[i], luma->width, luma->height, 1);
    if (!status) {
        thread_for(threads, rows, magnitude_row, &e);
        e.floor = quiet * deviation(&e.magnitude);
        thread_for(threads, rows, sum_row, &e);
        thread_for(threads, (rows + BAND - 1) / BAND, normalise_band, &e);
    } else {
        relume_image_destroy(out);
    }
    for (int i = 0; i < 3; i++)
        relume_image_destroy(own[i]);
    return status;
}
