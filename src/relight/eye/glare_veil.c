// glare_veil.c - glare of what does not shine, coarsely: the light of a dim pixel that falls far
// from it is smooth when it arrives
#include "core/math/bilinear.h"
#include "relight/eye/glare.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

#include <math.h>
#include <string.h>

enum { COARSE = 4 };  // pixels to one of the veil, along each side

struct coarse {
    const float *in;
    float *out;
    int width, height;  // of the frame
    int columns, rows;  // of the veil
    const float *keep;  // what stays in its pixel, by channel
};

static void shrink_row(void *context, size_t item, int worker)
{
    const struct coarse *s = context;
    float *const out = s->out + 3 * item * (size_t)s->columns;
    (void)worker;
    memset(out, 0, 3 * (size_t)s->columns * sizeof *out);
    // Beyond the frame's edge the last cell is dark: light is neither lost nor made.
    for (int y = (int)item * COARSE; y < s->height && y < ((int)item + 1) * COARSE; y++) {
        const float *const row = s->in + 3 * (size_t)y * (size_t)s->width;
        for (int cell = 0; cell < s->columns; cell++) {
            const int end = (cell + 1) * COARSE < s->width ? (cell + 1) * COARSE : s->width;
            float sum[3] = {0};
            for (int x = cell * COARSE; x < end; x++)
                for (int c = 0; c < 3; c++)
                    sum[c] += row[3 * x + c];
            for (int c = 0; c < 3; c++)
                out[3 * cell + c] += sum[c] * (1.0f / (COARSE * COARSE));
        }
    }
}

// Cell by cell between the middles of two cells: what stands left and right is mixed from the rows
// above and below once for its pixels.
static void enlarge_row(void *context, size_t item, int worker)
{
    const struct coarse *s = context;
    const double v = ((double)item + 0.5) / COARSE - 0.5;
    const int j = relume_whole(floor(v));
    const float ty = (float)(v - j);
    const float *const a = s->in + 3 * (size_t)index_clamped(j, s->rows) * (size_t)s->columns;
    const float *const b = s->in + 3 * (size_t)index_clamped(j + 1, s->rows) * (size_t)s->columns;
    float *const out = s->out + 3 * item * (size_t)s->width;
    float left[3], right[3];
    (void)worker;
    for (int c = 0; c < 3; c++)
        right[c] = a[c] + ty * (b[c] - a[c]);
    for (int cell = 0; cell <= s->columns; cell++) {
        const int at = 3 * index_clamped(cell, s->columns), first = cell * COARSE - COARSE / 2;
        for (int c = 0; c < 3; c++) {
            left[c] = right[c];
            right[c] = a[at + c] + ty * (b[at + c] - a[at + c]);
        }
        for (int k = 0; k < COARSE; k++) {
            const float tx = ((float)k + 0.5f) / COARSE;
            const int x = first + k;
            if (x < 0 || x >= s->width)
                continue;
            for (int c = 0; c < 3; c++)
                out[3 * x + c] = s->keep[c] * out[3 * x + c] + left[c] + tx * (right[c] - left[c]);
        }
    }
}

// The middle of a coarse kernel stays in its pixel; returns its share by channel.
static void take_middle(struct kernel *kernel, float keep[3])
{
    const size_t side = 2 * (size_t)kernel->reach + 1;
    const int near = kernel->reach < 1 ? kernel->reach : 1;
    for (int c = 0; c < 3; c++) {
        keep[c] = 0.0f;
        for (int y = -near; y <= near; y++)
            for (int x = -near; x <= near; x++) {
                float *const v =
                    kernel->v[c] + (size_t)(y + kernel->reach) * side + (size_t)(x + kernel->reach);
                keep[c] += *v;
                *v = 0.0f;
            }
    }
}

void veil_destroy(struct veil_work *work)
{
    convolver_destroy(&work->convolver);
}

static relume_status need_convolver(struct veil_work *work, const struct coarse *s, int reach,
                                    const struct relume_glare_params *p)
{
    if (convolver_fits(work->convolver, s->columns, s->rows, reach, p->border, p->threads))
        return RELUME_OK;
    convolver_destroy(&work->convolver);
    return convolver_create(&work->convolver, s->columns, s->rows, reach, p->border, p->threads);
}

// coarse[0] of all that is seen, [1] without the sources, [2] and [3] what they become.
static relume_status draw_veil(struct veil_work *work, struct coarse *s, float *const coarse[4],
                               const struct kernel *far, const struct kernel *whole,
                               const struct relume_glare_params *p)
{
    const size_t n = 3 * (size_t)s->columns * (size_t)s->rows;
    relume_status status = need_convolver(work, s, whole->reach, p);
    if (!status)
        status = convolver_run(work->convolver, coarse[3], coarse[1], false, whole);
    if (!status)
        status = need_convolver(work, s, far->reach, p);
    for (size_t i = 0; i < n; i++)
        coarse[0][i] -= coarse[1][i];
    if (!status)
        status = convolver_run(work->convolver, coarse[2], coarse[0], false, far);
    for (size_t i = 0; !status && i < n; i++)
        coarse[3][i] += coarse[2][i];
    return status;
}

relume_status veil_add(float *out, struct veil_work *work, const float *in, int width, int height,
                       const relume_psf *psf, double pixel, const struct relume_glare_params *p)
{
    float keep[3];
    struct coarse s = {.width = width,
                       .height = height,
                       .columns = (width + COARSE - 1) / COARSE,
                       .rows = (height + COARSE - 1) / COARSE,
                       .keep = keep};
    const size_t n = 3 * (size_t)s.columns * (size_t)s.rows;
    struct kernel whole = {0}, far = {0};
    float *const memory = mem_array(4 * n, sizeof *memory);
    float *const coarse[4] = {memory, memory + n, memory + 2 * n, memory + 3 * n};
    relume_status status = memory ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = kernel_create(&whole, psf, COARSE * pixel, KERNEL_ALL, p);
    if (!status)
        status = kernel_create(&far, psf, COARSE * pixel, KERNEL_VEIL, p);
    if (!status) {
        take_middle(&whole, keep);
        for (int k = 0; k < 2; k++) {
            s.in = k ? out : in;
            s.out = coarse[k];
            thread_for(p->threads, (size_t)s.rows, shrink_row, &s);
        }
        status = draw_veil(work, &s, coarse, &far, &whole, p);
    }
    if (!status) {
        s.in = coarse[3];
        s.out = out;
        thread_for(p->threads, (size_t)height, enlarge_row, &s);
    }
    kernel_destroy(&whole);
    kernel_destroy(&far);
    mem_free(memory);
    return status;
}
