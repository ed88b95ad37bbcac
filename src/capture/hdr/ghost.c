// ghost.c - what moved between the exposures of an aligned bracket
//
// In 11 x 11 pixels the correlation of two pictures, means kept, falls where they show different
// things; it needs no response curve. The reference is first given the tones of the exposure that
// is judged, so that a curved response does not lower the correlation of what stood still and
// brightness counts as well: the threshold can be higher than the 0.95 of untreated codes.
//
// The reference of a pixel is the anchor, or where that is black or saturated, the next exposure on
// the way to the judged one that is not. Where the way ends at the judged one itself nothing else
// knows the pixel, and it stays, unless most of its window could be judged and was a ghost: single
// saturated pixels of a place that something covered.
#include <relume/capture/align.h>

#include "capture/hdr/tones.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"

#include <math.h>

enum { HALF = 5, WINDOW = (2 * HALF + 1) * (2 * HALF + 1) };
static const double default_threshold = 0.985, default_black = 0.05, default_white = 0.95;
// Of a window, resolved by both: below, nothing is said of a pixel, and of one without a reference.
static const double least_part = 0.25, most_part = 0.5;

struct ghosts {
    const struct relume_image *codes;  // the whole bracket
    const int *order;                  // exposures from the anchor to the judged one
    int steps;                         // how many
    int step;                          // which of them is the reference now
    const struct relume_image *like;   // the reference in the tones of the judged one
    float (*rows)[4];                  // [pixels]: sums along rows of 1, aa, bb, ab
    double threshold, black, white;
    struct relume_image *mask;
};

static const struct relume_image *on_the_way(const struct ghosts *g, int step)
{
    return &g->codes[g->order[step]];
}

static bool resolves(const struct ghosts *g, int step, size_t pixel)
{
    const float *c = on_the_way(g, step)->data + 3 * pixel;
    const double mean = ((double)c[0] + (double)c[1] + (double)c[2]) / 3.0;
    return mean > g->black && mean < g->white;
}

static void add_products(const struct ghosts *g, size_t pixel, double sign, double sum[4])
{
    const float *a = g->like->data + 3 * pixel;
    const float *b = on_the_way(g, g->steps - 1)->data + 3 * pixel;
    if (!resolves(g, g->step, pixel) || !resolves(g, g->steps - 1, pixel))
        return;
    sum[0] += sign;
    for (int c = 0; c < 3; c++) {
        sum[1] += sign * (double)a[c] * (double)a[c];
        sum[2] += sign * (double)b[c] * (double)b[c];
        sum[3] += sign * (double)a[c] * (double)b[c];
    }
}

static void sum_row(void *context, size_t row, int worker)
{
    const struct ghosts *g = context;
    (void)worker;
    const int width = g->mask->width;
    const size_t first = row * (size_t)width;
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    for (int x = -HALF; x < HALF; x++)
        add_products(g, first + (size_t)index_clamped(x, width), 1.0, sum);
    for (int x = 0; x < width; x++) {
        add_products(g, first + (size_t)index_clamped(x + HALF, width), 1.0, sum);
        for (int k = 0; k < 4; k++)
            g->rows[first + (size_t)x][k] = (float)sum[k];
        add_products(g, first + (size_t)index_clamped(x - HALF, width), -1.0, sum);
    }
}

// How much of the window has to be resolved for a judgement by the present reference; 2: it is not
// this pixel's.
static double part_needed(const struct ghosts *g, size_t pixel)
{
    for (int step = 0; step < g->step; step++)
        if (resolves(g, step, pixel))
            return 2.0;
    if (resolves(g, g->step, pixel))
        return least_part;
    return g->step + 2 == g->steps ? most_part : 2.0;
}

static bool is_alike(const struct ghosts *g, size_t row, size_t x, double part)
{
    const size_t width = (size_t)g->mask->width;
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    for (int k = -HALF; k <= HALF; k++) {
        const float *s = g->rows[(size_t)index_clamped((int)row + k, g->mask->height) * width + x];
        for (int j = 0; j < 4; j++)
            sum[j] += (double)s[j];
    }
    return sum[0] < part * WINDOW || sum[3] >= g->threshold * 0.5 * (sum[1] + sum[2]);
}

static void judge_row(void *context, size_t row, int worker)
{
    const struct ghosts *g = context;
    (void)worker;
    const size_t width = (size_t)g->mask->width;
    for (size_t x = 0; x < width; x++) {
        const double part = part_needed(g, row * width + x);
        if (part <= 1.0)
            g->mask->data[row * width + x] = is_alike(g, row, x, part);
    }
}

// Sets the mask where order[step] is the reference.
static relume_status judge(struct ghosts *g, int threads)
{
    struct relume_image alike;
    const relume_status status =
        tones_match(&alike, on_the_way(g, g->step), on_the_way(g, g->steps - 1), threads);
    if (status)
        return status;
    g->like = &alike;
    thread_for(threads, (size_t)g->mask->height, sum_row, g);
    thread_for(threads, (size_t)g->mask->height, judge_row, g);
    relume_image_destroy(&alike);
    g->like = NULL;
    return RELUME_OK;
}

static relume_status all_good(struct relume_image *mask, const struct relume_image *like)
{
    const relume_status status = relume_image_create(mask, like->width, like->height, 1);
    const size_t pixels = (size_t)like->width * (size_t)like->height;
    for (size_t i = 0; !status && i < pixels; i++)
        mask->data[i] = 1.0f;
    return status;
}

static bool is_bracket(const struct relume_image *codes, int n, int anchor)
{
    bool good = n >= 1 && anchor >= 0 && anchor < n;
    for (int i = 0; good && i < n; i++)
        good = codes[i].channels == 3 && codes[i].width == codes->width &&
               codes[i].height == codes->height;
    return good;
}

// The exposures between the anchor and image i, both included; returns how many.
static int way_to(int *order, const double *exposures, int n, int anchor, int i)
{
    const double sign = exposures[i] < exposures[anchor] ? -1.0 : 1.0;
    int steps = 0;
    order[steps++] = anchor;
    for (int j = 0; j < n; j++) {
        if (j == anchor || j == i || sign * exposures[j] <= sign * exposures[anchor] ||
            sign * exposures[j] >= sign * exposures[i])
            continue;
        int at = steps++;
        for (; at > 1 && sign * exposures[order[at - 1]] > sign * exposures[j]; at--)
            order[at] = order[at - 1];
        order[at] = j;
    }
    order[steps++] = i;
    return steps;
}

relume_status relume_ghost_masks(struct relume_image *masks, const struct relume_image *codes,
                                 const double *exposures, int n, int anchor,
                                 const struct relume_ghost_params *params)
{
    const struct relume_ghost_params p = PARAMS_WORK(relume_ghost_params, params);
    struct ghosts g = {
        .codes = codes,
        .threshold = p.threshold > 0.0 ? p.threshold : default_threshold,
        .black = p.black > 0.0 ? p.black : default_black,
        .white = p.white > 0.0 ? p.white : default_white,
    };
    for (int i = 0; i < n; i++)
        masks[i] = (struct relume_image){0};
    if (!is_bracket(codes, n, anchor))
        return log_fail(p.log, RELUME_EINVAL,
                        "ghosts: expected pictures of 3 channels and equal sizes, and an anchor "
                        "among them");
    int *order = mem_array((size_t)n + 1, sizeof *order);
    g.rows = mem_array((size_t)codes->width * (size_t)codes->height, sizeof *g.rows);
    relume_status status = g.rows && order ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < n; i++) {
        status = all_good(&masks[i], codes);
        g.order = order;
        g.steps = status || i == anchor ? 0 : way_to(order, exposures, n, anchor, i);
        g.mask = &masks[i];
        for (g.step = 0; !status && g.step + 1 < g.steps; g.step++)
            status = judge(&g, p.threads);
    }
    for (int i = 0; status && i < n; i++)
        relume_image_destroy(&masks[i]);
    mem_free(g.rows);
    mem_free(order);
    return status;
}
