// ptm_tree.c - which plane of a JPEG-coded .ptm is predicted from which
#include "exchange/formats/ptm_tree.h"

#include "core/base/memory.h"
#include "image/image/trellis.h"

#include <math.h>
#include <string.h>

enum { SAMPLE_PIXELS = 1 << 15, BLOCK = 8 };

struct samples {
    int planes;
    size_t pixels, coefficients;          // of one plane
    uint8_t *code[PTM_MOST_PLANES];       // [pixels]
    float *coefficient[PTM_MOST_PLANES];  // [blocks][64], DC as differences along a row of blocks
};

static void transform_band(const uint8_t *codes, int width, int rows, float *work, float *out)
{
    for (int i = 0; i < width * rows; i++)
        work[i] = codes[i];
    trellis_transform(work, width, rows, out);
    float before = 0.0f;
    for (size_t b = 0; b < trellis_blocks(width, rows); b++) {
        const float dc = out[64 * b];
        out[64 * b] = dc - before;
        before = dc;
    }
}

static void take_plane(struct samples *s, const struct foreign *f, int i, int every, float *work)
{
    const int plane = ptm_plane(f->form == FOREIGN_LUMINANCE, i);
    uint8_t *code = s->code[i];
    float *coefficient = s->coefficient[i];
    for (int y = 0; y < f->height; y += BLOCK * every) {
        const int rows = f->height - y < BLOCK ? f->height - y : BLOCK;
        const size_t pixels = (size_t)f->width * (size_t)rows;
        for (int r = 0; r < rows; r++)
            memcpy(code + (size_t)r * (size_t)f->width, ptm_row(f, plane, y + r), (size_t)f->width);
        transform_band(code, f->width, rows, work, coefficient);
        code += pixels;
        coefficient += 64 * trellis_blocks(f->width, rows);
    }
}

static relume_status take_samples(struct samples *s, const struct foreign *f)
{
    const int every = (int)(foreign_pixels(f) / SAMPLE_PIXELS) + 1;
    float *work = mem_array((size_t)f->width * BLOCK, sizeof *work);
    bool good = work != NULL;
    *s = (struct samples){.planes = f->planes};
    for (int y = 0; y < f->height; y += BLOCK * every) {
        const int rows = f->height - y < BLOCK ? f->height - y : BLOCK;
        s->pixels += (size_t)f->width * (size_t)rows;
        s->coefficients += 64 * trellis_blocks(f->width, rows);
    }
    for (int i = 0; i < s->planes; i++) {
        s->code[i] = mem_array(s->pixels, sizeof *s->code[i]);
        s->coefficient[i] = mem_array(s->coefficients, sizeof *s->coefficient[i]);
        good = good && s->code[i] && s->coefficient[i];
    }
    for (int i = 0; good && i < s->planes; i++)
        take_plane(s, f, i, every, work);
    mem_free(work);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// Bits of a coefficient of so many steps: its logarithm where it is large, little below half a
// step.
static double bits_of(float steps)
{
    return 0.5 * (double)log2f(1.0f + 4.0f * steps * steps);
}

// Of plane `i` given plane `r`; what does not fit into a byte takes a record.
static double cost_given(const struct samples *s, int i, int step, int r, bool inverted)
{
    const float scale = 1.0f / (float)step, sign = inverted ? 1.0f : -1.0f;
    const float *a = s->coefficient[i], *b = s->coefficient[r];
    double bits = 0.0;
    for (size_t k = 0; k < s->coefficients; k++)
        bits += bits_of(scale * (a[k] + sign * b[k]));
    size_t outside = 0;
    for (size_t k = 0; k < s->pixels; k++) {
        const int reference = inverted ? 255 - s->code[r][k] : s->code[r][k];
        const int apart = s->code[i][k] - reference + 128;
        outside += apart < 0 || apart > 255;
    }
    return bits + PTM_RECORD_BITS * (double)outside;
}

static void offer(struct ptm_tree *tree, double *cost, const struct samples *s, const int *step,
                  int r)
{
    for (int i = 0; i < s->planes; i++)
        for (int inverted = 0; tree->turn[i] < 0 && inverted < 2; inverted++) {
            const double bits = cost_given(s, i, step[i], r, inverted);
            if (bits < cost[i]) {
                cost[i] = bits;
                tree->reference[i] = r;
                tree->inverted[i] = inverted;
                tree->depth[i] = tree->depth[r] + 1;
            }
        }
}

relume_status ptm_tree_grow(struct ptm_tree *out, const struct foreign *f, const int *step)
{
    struct samples s;
    double cost[PTM_MOST_PLANES];
    const relume_status status = take_samples(&s, f);
    *out = (struct ptm_tree){0};
    for (int i = 0; !status && i < f->planes; i++) {
        const float scale = 1.0f / (float)step[i];
        cost[i] = 0.0;
        for (size_t k = 0; k < s.coefficients; k++)
            cost[i] += bits_of(scale * s.coefficient[i][k]);
        out->reference[i] = out->turn[i] = -1;
    }
    for (int turn = 0; !status && turn < f->planes; turn++) {
        int next = 0;
        while (out->turn[next] >= 0)
            next++;
        for (int i = next + 1; i < f->planes; i++)
            if (out->turn[i] < 0 && cost[i] < cost[next])
                next = i;
        out->turn[next] = turn;
        offer(out, cost, &s, step, next);
    }
    for (int i = 0; i < s.planes; i++) {
        mem_free(s.code[i]);
        mem_free(s.coefficient[i]);
    }
    return status;
}
