// blend.c - see blend.h
//
// Bands without decimation: each is the difference of two pictures smoothed by the binomial kernel
// 1 4 6 4 1, the second with holes twice as wide (Holschneider et al. 1989), so that their plain
// sum is the picture, for panoramas of any width. The owner's mask is smoothed along; a band takes
// the mask that is as smooth as the coarser of its two pictures.
#include "capture/multiview/blend.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"

#include <math.h>
#include <string.h>

static const float kernel[5] = {1.0f / 16, 4.0f / 16, 6.0f / 16, 4.0f / 16, 1.0f / 16};

// ---------------------------------------------------------------- boxes

// The shortest stretch of columns, across the panorama's ends if need be, that holds all `used`.
static void columns_of(struct blend_box *box, const uint8_t *used, int width)
{
    int gap = 0, longest = 0, behind = 0;
    for (int x = 0; x < 2 * width; x++) {
        gap = used[x % width] ? 0 : gap + 1;
        if (gap > longest) {
            longest = gap;
            behind = x + 1;
        }
    }
    box->width = longest < width ? width - longest : 0;
    box->x = behind % width;
}

// Margin for smoothing: of the picture where its mask counts, and that is as far again. Over a pole
// rows go on at the other side, so there all columns are needed.
static void add_margin(struct blend_box *box, const struct blend *b)
{
    // Twice how far smoothing over all levels looks.
    const int margin = 4 * ((1 << (b->bands - 1)) - 1);
    const int top = box->y - margin, bottom = box->y + box->height + margin;
    box->y = top > 0 ? top : 0;
    box->height = (bottom < b->height ? bottom : b->height) - box->y;
    box->x = ((box->x - margin) % b->width + b->width) % b->width;
    box->width += 2 * margin;
    if (top < 0 || bottom > b->height || box->width >= b->width) {
        box->x = 0;
        box->width = b->width;
    }
}

static void find_box(struct blend_box *box, uint8_t *used, const struct blend *b, int picture)
{
    int top = b->height, bottom = 0;
    memset(used, 0, (size_t)b->width);
    for (int y = 0; y < b->height; y++) {
        const uint16_t *owner = b->owner + (size_t)y * (size_t)b->width;
        for (int x = 0; x < b->width; x++)
            if (owner[x] == picture) {
                used[x] = 1;
                top = y < top ? y : top;
                bottom = y + 1;
            }
    }
    *box = (struct blend_box){.y = top, .height = bottom - top};
    columns_of(box, used, b->width);
    if (box->width)
        add_margin(box, b);
}

relume_status blend_begin(struct blend *b)
{
    uint8_t *used = mem_array((size_t)b->width, 1);
    b->box = mem_zeroed((size_t)b->pictures, sizeof *b->box);
    for (int i = 0; b->box && used && i < b->pictures; i++)
        find_box(&b->box[i], used, b, i);
    mem_free(used);
    return b->box && used ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- one picture

struct adding {
    const struct blend *b;
    struct blend_box box;
    int picture;
    blend_fetch *fetch;
    const void *context;
    float *sums;
    float *fine, *coarse;  // [4 * width * height] of the box: colour and mask
    float *lines;          // for each worker one line with a margin for the kernel at both ends
    size_t line;           // floats
    int step;              // of the kernel
};

static bool whole_ring(const struct adding *a)
{
    return a->box.width == a->b->width;
}

static size_t row_of(const struct adding *a, int y)
{
    return 4 * (size_t)y * (size_t)a->box.width;
}

static int column_of(const struct adding *a, int x)
{
    x += a->box.x;
    return x < a->b->width ? x : x - a->b->width;
}

static void fetch_row(void *context, size_t item, int worker)
{
    const struct adding *a = context;
    const int y = a->box.y + (int)item;
    float *row = a->fine + row_of(a, (int)item);
    const uint16_t *owner = a->b->owner + (size_t)y * (size_t)a->b->width;
    (void)worker;
    a->fetch(row, a->context, a->picture, a->box.x, y, a->box.width);
    for (int x = 0; x < a->box.width; x++)
        row[4 * x + 3] = (owner[column_of(a, x)] & ~BLEND_UNSEEN) == a->picture ? 1.0f : 0.0f;
}

// Row y of the box and the column at which it begins: half around where y lies beyond a pole.
static const float *source_row(int *first, const struct adding *a, int y)
{
    const int top = -a->box.y, bottom = a->b->height - a->box.y;  // the poles
    *first = 0;
    if (whole_ring(a) && (y < top || y >= bottom)) {
        y = y < top ? 2 * top - 1 - y : 2 * bottom - 1 - y;
        *first = a->box.width / 2;
    }
    y = y < 0 ? 0 : y >= a->box.height ? a->box.height - 1 : y;
    return a->fine + row_of(a, y);
}

static void smooth_down(float *line, const struct adding *a, int y)
{
    const size_t width = 4 * (size_t)a->box.width;
    memset(line, 0, width * sizeof *line);
    for (int k = 0; k < 5; k++) {
        int first;
        const float *row = source_row(&first, a, y + (k - 2) * a->step);
        const size_t head = width - 4 * (size_t)first;
        add_scaled(line, row + 4 * (size_t)first, kernel[k], head);
        add_scaled(line + head, row, kernel[k], width - head);
    }
}

// Continue a line by `margin` pixels at both ends: around the sphere, else by its last pixels.
static void continue_line(float *line, const struct adding *a, int margin)
{
    const int width = a->box.width;
    for (int i = 1; i <= margin; i++) {
        const int left = whole_ring(a) ? (width - i % width) % width : 0;
        const int right = whole_ring(a) ? (i - 1) % width : width - 1;
        memcpy(line - 4 * i, line + 4 * left, 4 * sizeof *line);
        memcpy(line + 4 * (width - 1 + i), line + 4 * right, 4 * sizeof *line);
    }
}

// The band between two rows of pixels, by the mask of the coarser.
static void add_band(const struct adding *a, int y, const float *fine, const float *coarse)
{
    float *sums = a->sums + 3 * (size_t)(a->box.y + y) * (size_t)a->b->width;
    for (int x = 0; x < a->box.width; x++) {
        float *to = sums + 3 * column_of(a, x);
        for (int c = 0; c < 3; c++)
            to[c] += coarse[4 * x + 3] * (fine[4 * x + c] - coarse[4 * x + c]);
    }
}

static void split_row(void *context, size_t item, int worker)
{
    const struct adding *a = context;
    const int margin = 2 * a->step;
    const size_t n = 4 * (size_t)a->box.width;
    float *line = a->lines + (size_t)worker * a->line + 4 * (size_t)margin;
    float *row = a->coarse + row_of(a, (int)item);
    smooth_down(line, a, (int)item);
    continue_line(line, a, margin);
    memset(row, 0, n * sizeof *row);
    for (int k = 0; k < 5; k++)
        add_scaled(row, line + (k - 2) * 4 * a->step, kernel[k], n);
    add_band(a, (int)item, a->fine + row_of(a, (int)item), row);
}

static void add_rest_row(void *context, size_t item, int worker)
{
    const struct adding *a = context;
    const float *row = a->fine + row_of(a, (int)item);
    float *sums = a->sums + 3 * ((size_t)a->box.y + item) * (size_t)a->b->width;
    (void)worker;
    for (int x = 0; x < a->box.width; x++)
        for (int c = 0; c < 3; c++)
            sums[3 * column_of(a, x) + c] += row[4 * x + 3] * row[4 * x + c];
}

relume_status blend_add(float *sums, const struct blend *b, int picture, blend_fetch *fetch,
                        const void *context, int threads)
{
    struct adding a = {
        .b = b,
        .box = b->box[picture],
        .picture = picture,
        .fetch = fetch,
        .context = context,
        .sums = sums,
    };
    if (!a.box.width)
        return RELUME_OK;
    const size_t rows = (size_t)a.box.height, n = 4 * rows * (size_t)a.box.width;
    a.line = 4 * ((size_t)a.box.width + 2 * ((size_t)2 << (b->bands - 1)));
    a.fine = mem_array(n, sizeof *a.fine);
    a.coarse = mem_array(n, sizeof *a.coarse);
    a.lines = mem_array((size_t)thread_count(threads) * a.line, sizeof *a.lines);
    const bool fits = a.fine && a.coarse && a.lines;
    if (fits)
        thread_for(threads, rows, fetch_row, &a);
    for (int k = 0; fits && k < b->bands - 1; k++) {
        a.step = 1 << k;
        thread_for(threads, rows, split_row, &a);
        float *swap = a.fine;
        a.fine = a.coarse;
        a.coarse = swap;
    }
    if (fits)
        thread_for(threads, rows, add_rest_row, &a);
    mem_free(a.fine);
    mem_free(a.coarse);
    mem_free(a.lines);
    return fits ? RELUME_OK : RELUME_ENOMEM;
}

void blend_finish(float *sums, const struct blend *b)
{
    const size_t n = (size_t)b->width * (size_t)b->height;
    for (size_t i = 0; i < n; i++)
        for (size_t c = 0; c < 3; c++)
            sums[3 * i + c] = b->owner[i] & BLEND_UNSEEN ? 0.0f : fmaxf(sums[3 * i + c], 0.0f);
}
