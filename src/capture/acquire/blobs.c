// blobs.c - even regions of a picture that may be patches
//
// Pixels around which nothing changes are joined to regions. A parallelogram of any shape has
// area = 12 sqrt(det of the covariance of its points), which what is hollow or ragged falls short
// of; so perspective and turning do not matter.
#include "capture/acquire/chart.h"

#include "core/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double LEAST_AREA = 9.0, LARGEST = 1.0 / 30.0;  // pixels; share of the picture
static const double LEAST_FILLED = 0.72, MOST_FILLED = 1.12;
static const double LONGEST = 3.0;  // as wide as high
enum { MOST_BLOBS = 1500 };

// Cube root of light, in which equal steps are about equally seen, of a mean over 3 x 3 pixels.
static float *coded(const struct relume_image *image)
{
    const int w = image->width, h = image->height;
    float *out = mem_array((size_t)w * (size_t)h, 3 * sizeof *out);
    if (!out)
        return NULL;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            for (int c = 0; c < 3; c++) {
                float sum = 0.0f;
                for (int j = -1; j <= 1; j++)
                    for (int i = -1; i <= 1; i++) {
                        const int u = x + i < 0 ? 0 : x + i < w ? x + i : w - 1;
                        const int v = y + j < 0 ? 0 : y + j < h ? y + j : h - 1;
                        sum += image->data[3 * ((size_t)v * (size_t)w + (size_t)u) + (size_t)c];
                    }
                out[3 * ((size_t)y * (size_t)w + (size_t)x) + (size_t)c] =
                    cbrtf(fmaxf(sum / 9.0f, 0.0f));
            }
    return out;
}

static bool differ(const float *a, const float *b, float step)
{
    return !(fabsf(a[0] - b[0]) < step && fabsf(a[1] - b[1]) < step && fabsf(a[2] - b[2]) < step);
}

// 1 where neighbours on both sides are alike; nothing at the border.
static void mark_even(unsigned char *even, const float *code, int w, int h, float step)
{
    memset(even, 0, (size_t)w * (size_t)h);
    for (int y = 1; y + 1 < h; y++)
        for (int x = 1; x + 1 < w; x++) {
            const size_t at = (size_t)y * (size_t)w + (size_t)x, down = 3 * (size_t)w;
            const float *p = code + 3 * at;
            even[at] = !differ(p - 3, p + 3, step) && !differ(p - down, p + down, step);
        }
}

struct sums {
    double n, x, y, xx, xy, yy;
};

// All that is connected with `start`; its pixels are forgotten.
static struct sums take_region(unsigned char *even, int w, int *stack, int start)
{
    struct sums s = {0};
    int top = 0;
    stack[top++] = start;
    even[start] = 0;
    while (top) {
        const int at = stack[--top];
        const double x = at % w, y = at / w;
        s.n += 1.0, s.x += x, s.y += y;
        s.xx += x * x, s.xy += x * y, s.yy += y * y;
        const int next[] = {at - 1, at + 1, at - w, at + w};
        for (int i = 0; i < 4; i++)  // the border is never even
            if (even[next[i]]) {
                even[next[i]] = 0;
                stack[top++] = next[i];
            }
    }
    return s;
}

static bool is_patch(struct blob *out, const struct sums *s, double pixels)
{
    const double n = s->n, x = s->x / n, y = s->y / n;
    const double xx = s->xx / n - x * x, yy = s->yy / n - y * y, xy = s->xy / n - x * y;
    const double det = xx * yy - xy * xy, half = 0.5 * (xx + yy);
    if (n < LEAST_AREA || n > LARGEST * pixels || !(det > 0.0))
        return false;
    const double off = sqrt(fmax(half * half - det, 0.0)), filled = n / (12.0 * sqrt(det));
    *out = (struct blob){.x = x + 0.5, .y = y + 0.5, .area = n};
    return filled > LEAST_FILLED && filled < MOST_FILLED &&
           half + off < LONGEST * LONGEST * (half - off);
}

relume_status blobs_find(struct blob **out, int *n, const struct relume_image *image, float step)
{
    const int w = image->width, h = image->height;
    const size_t pixels = (size_t)w * (size_t)h;
    float *code = coded(image);
    unsigned char *even = mem_array(pixels, 1);
    int *stack = mem_array(pixels, sizeof *stack);
    *out = mem_array(MOST_BLOBS, sizeof **out);
    *n = 0;
    const bool good = code && even && stack && *out;
    if (good)
        mark_even(even, code, w, h, step);
    for (size_t i = 0; good && i < pixels && *n < MOST_BLOBS; i++)
        if (even[i]) {
            const struct sums s = take_region(even, w, stack, (int)i);
            *n += is_patch(&(*out)[*n], &s, (double)pixels);
        }
    mem_free(code);
    mem_free(even);
    mem_free(stack);
    if (!good) {
        mem_free(*out);
        *out = NULL;
    }
    return good ? RELUME_OK : RELUME_ENOMEM;
}
