// ghost.c - what moved between the exposures of an aligned bracket
//
// In 11 x 11 pixels the correlation of two pictures, means kept, falls below 0.95 where they show
// different things; it needs no response curve. The anchor is first given the tones of the other
// exposure, so that a curved response does not lower the correlation of what stood still.
#include <relume/align.h>

#include "base/log.h"
#include "base/memory.h"
#include "base/thread.h"
#include "capture/tones.h"

#include <math.h>

enum { HALF = 5 };
static const double default_threshold = 0.985, default_black = 0.05, default_white = 0.95;

struct ghosts {
    const struct relume_image *a, *b;  // the anchor in the tones of b, and b
    float (*rows)[3];                  // [pixels]: sums along rows of aa, bb, ab
    const struct relume_image *codes;  // the whole bracket
    int n, i;
    bool is_end;  // the longest or the shortest
    double threshold, black, white;
    struct relume_image *mask;
};

static int clamp(int i, int n)
{
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

static void products(const struct ghosts *g, size_t pixel, double sign, double sum[3])
{
    const float *a = g->a->data + 3 * pixel, *b = g->b->data + 3 * pixel;
    for (int c = 0; c < 3; c++) {
        sum[0] += sign * (double)a[c] * (double)a[c];
        sum[1] += sign * (double)b[c] * (double)b[c];
        sum[2] += sign * (double)a[c] * (double)b[c];
    }
}

static void sum_row(void *context, size_t row, int worker)
{
    const struct ghosts *g = context;
    (void)worker;
    const int width = g->a->width;
    const size_t first = row * (size_t)width;
    double sum[3] = {0.0, 0.0, 0.0};
    for (int x = -HALF; x < HALF; x++)
        products(g, first + (size_t)clamp(x, width), 1.0, sum);
    for (int x = 0; x < width; x++) {
        products(g, first + (size_t)clamp(x + HALF, width), 1.0, sum);
        for (int k = 0; k < 3; k++)
            g->rows[first + (size_t)x][k] = (float)sum[k];
        products(g, first + (size_t)clamp(x - HALF, width), -1.0, sum);
    }
}

static bool resolves(const struct ghosts *g, int image, size_t pixel)
{
    const float *c = g->codes[image].data + 3 * pixel;
    const double mean = ((double)c[0] + (double)c[1] + (double)c[2]) / 3.0;
    return mean > g->black && mean < g->white;
}

// Whether nothing but this end of the bracket knows the pixel.
static bool is_only_source(const struct ghosts *g, size_t pixel)
{
    if (!g->is_end)
        return false;
    for (int j = 0; j < g->n; j++)
        if (j != g->i && resolves(g, j, pixel))
            return false;
    return true;
}

static void judge_row(void *context, size_t row, int worker)
{
    const struct ghosts *g = context;
    (void)worker;
    const size_t width = (size_t)g->a->width;
    for (size_t x = 0; x < width; x++) {
        const size_t pixel = row * width + x;
        double sum[3] = {0.0, 0.0, 0.0};
        for (int k = -HALF; k <= HALF; k++) {
            const float *s = g->rows[(size_t)clamp((int)row + k, g->a->height) * width + x];
            for (int j = 0; j < 3; j++)
                sum[j] += (double)s[j];
        }
        const bool alike = sum[2] >= g->threshold * 0.5 * (sum[0] + sum[1]);
        g->mask->data[pixel] = alike || is_only_source(g, pixel);
    }
}

static relume_status judge(struct ghosts *g, const struct relume_image *anchor, int threads)
{
    struct relume_image alike;
    relume_status status = tones_match(&alike, anchor, g->b, threads);
    if (status)
        return status;
    g->a = &alike;
    status = relume_image_create(g->mask, anchor->width, anchor->height, 1);
    if (!status) {
        thread_for(threads, (size_t)anchor->height, sum_row, g);
        thread_for(threads, (size_t)anchor->height, judge_row, g);
    }
    relume_image_destroy(&alike);
    return status;
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

static bool is_end(const double *exposures, int n, int i)
{
    bool longest = true, shortest = true;
    for (int j = 0; j < n; j++) {
        longest &= exposures[j] <= exposures[i];
        shortest &= exposures[j] >= exposures[i];
    }
    return longest || shortest;
}

relume_status relume_ghost_masks(struct relume_image *masks, const struct relume_image *codes,
                                 const double *exposures, int n, int anchor,
                                 const struct relume_ghost_params *params)
{
    const struct relume_ghost_params p = params ? *params : (struct relume_ghost_params){0};
    struct ghosts g = {
        .codes = codes,
        .n = n,
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
    g.rows = mem_array((size_t)codes->width * (size_t)codes->height, sizeof *g.rows);
    relume_status status = g.rows ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < n; i++) {
        g.i = i;
        g.b = &codes[i];
        g.mask = &masks[i];
        g.is_end = is_end(exposures, n, i);
        status = i == anchor ? all_good(&masks[i], codes) : judge(&g, &codes[anchor], p.threads);
    }
    for (int i = 0; status && i < n; i++)
        relume_image_destroy(&masks[i]);
    free(g.rows);
    return status;
}
