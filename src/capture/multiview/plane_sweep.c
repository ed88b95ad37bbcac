// plane_sweep.c - plane sweep, one row at a time
#include "capture/multiview/plane_sweep.h"

#include "core/base/memory.h"

#include <math.h>
#include <string.h>

// A side with a smaller share of the cameras has no say: one camera agrees with many planes.
static const double least_share = 0.4;

static double square_distance(const struct plane_sweep *s, int a, int b)
{
    const double dx = s->at[a][0] - s->at[b][0], dy = s->at[a][1] - s->at[b][1];
    return dx * dx + dy * dy;
}

// Sorted in, the farthest falls out; of equally far ones the first stays.
static void keep_nearest(const struct plane_sweep *s, struct plane_sweep_target *t, int view,
                         int most)
{
    int at = t->count < most ? t->count++ : most;
    for (; at > 0 && square_distance(s, t->other[at - 1], t->view) >
                         square_distance(s, view, t->view) * (1.0 + 1e-9);
         at--)
        if (at < most)
            t->other[at] = t->other[at - 1];
    if (at < most)
        t->other[at] = view;
}

static unsigned sides_of(const struct plane_sweep *s, int view, int other)
{
    const double dx = s->at[other][0] - s->at[view][0], dy = s->at[other][1] - s->at[view][1];
    return (dx <= 0.0) | (unsigned)(dx >= 0.0) << 1 | (unsigned)(dy <= 0.0) << 2 |
           (unsigned)(dy >= 0.0) << 3;
}

struct plane_sweep_target plane_sweep_target(const struct plane_sweep *sweep, int view, int most)
{
    struct plane_sweep_target t = {.view = view};
    for (int i = 0; i < sweep->views; i++)
        if (i != view)
            keep_nearest(sweep, &t, i, most);
    int standing[PLANE_SWEEP_SIDES] = {0};
    for (int i = 0; i < t.count; i++) {
        t.sides[i] = sides_of(sweep, view, t.other[i]);
        for (int k = 0; k < PLANE_SWEEP_SIDES; k++)
            standing[k] += (int)(t.sides[i] >> k & 1);
    }
    for (int k = 0; k < PLANE_SWEEP_SIDES; k++)
        t.used[k] = standing[k] > 0 && standing[k] >= least_share * t.count;
    return t;
}

double plane_sweep_reach(const struct plane_sweep *sweep, const struct plane_sweep_target *target)
{
    double most = 0.0;
    for (int i = 0; i < target->count; i++)
        most = fmax(most, square_distance(sweep, target->view, target->other[i]));
    return sqrt(most);
}

relume_status plane_sweep_scratch_create(struct plane_sweep_scratch *out, int width)
{
    const size_t w = (size_t)width;
    out->one = mem_array(w, (1 + 2 * (PLANE_SWEEP_SIDES + 1)) * sizeof(uint16_t));
    if (!out->one)
        return RELUME_ENOMEM;
    out->sum = out->one + w;
    out->count = out->sum + (PLANE_SWEEP_SIDES + 1) * w;
    return RELUME_OK;
}

void plane_sweep_scratch_free(struct plane_sweep_scratch *scratch)
{
    mem_free(scratch->one);
    *scratch = (struct plane_sweep_scratch){0};
}

// A picture moved by whole texels and 16ths.
struct shift {
    int x, y, fx, fy;
    int begin, end;  // columns that stay inside
};

static int clamp_int(int i, int low, int high)
{
    return i < low ? low : i > high ? high : i;
}

static struct shift shift_of(const struct plane_sweep *s, double dx, double dy)
{
    const int x16 = relume_whole(round(dx * 16.0)), y16 = relume_whole(round(dy * 16.0));
    const int x = x16 >> 4, y = y16 >> 4;
    const int fx = x16 & 15, fy = y16 & 15;
    const int begin = clamp_int(-x, 0, s->width);
    const int end = clamp_int(s->width - x - (fx > 0), begin, s->width);
    return (struct shift){x, y, fx, fy, begin, end};
}

// sum[begin..end) += |here - there|, truncated; `there` begins at the same column, shifted.
static void add_differences(uint16_t *restrict sum, const uint8_t *restrict here,
                            const uint8_t *restrict top, const uint8_t *restrict bottom,
                            const struct shift *m, int n)
{
    const int right = m->fx > 0;  // the last column has no neighbour
    const uint16_t w11 = (uint16_t)(m->fx * m->fy), w10 = (uint16_t)(m->fx * (16 - m->fy));
    const uint16_t w01 = (uint16_t)((16 - m->fx) * m->fy);
    const uint16_t w00 = (uint16_t)((16 - m->fx) * (16 - m->fy));
    for (int x = 0; x < n; x++) {
        const uint16_t there = (uint16_t)(top[x] * w00 + top[x + right] * w10 + bottom[x] * w01 +
                                          bottom[x + right] * w11 + 128) >>
                               8;
        const int16_t d = (int16_t)(here[x] - there);
        const int16_t a = (int16_t)(d < 0 ? -d : d);
        sum[x] = (uint16_t)(sum[x] + (a < PLANE_SWEEP_MOST ? a : PLANE_SWEEP_MOST));
    }
}

// False when the row lies outside the other picture.
static bool one_camera(const struct plane_sweep *s, int view, int other, const struct shift *m,
                       int row, uint16_t *one)
{
    const int y = row + m->y, n = m->end - m->begin;
    if (y < 0 || y + (m->fy > 0) >= s->height || n <= 0)
        return false;
    const size_t plane = (size_t)s->width * (size_t)s->height;
    memset(one, 0, (size_t)n * sizeof *one);
    for (int c = 0; c < s->channels; c++) {
        const uint8_t *here = s->picture[view] + c * plane + (size_t)row * (size_t)s->width;
        const uint8_t *top = s->picture[other] + c * plane + (size_t)y * (size_t)s->width;
        const uint8_t *bottom = top + (m->fy > 0 ? s->width : 0);
        const int at = m->begin + m->x;
        add_differences(one, here + m->begin, top + at, bottom + at, m, n);
    }
    return true;
}

static void add_row(uint16_t *restrict sum, uint16_t *restrict count, const uint16_t *restrict one,
                    int n)
{
    for (int x = 0; x < n; x++) {
        sum[x] = (uint16_t)(sum[x] + one[x]);
        count[x]++;
    }
}

// Where no camera looks the cost is that of not knowing.
static float mean_cost(uint16_t sum, uint16_t count, float scale)
{
    return count ? (float)sum * scale / (float)count : PLANE_SWEEP_SCALE * PLANE_SWEEP_MOST / 2.0f;
}

void plane_sweep_row(uint8_t *least, uint8_t *mean, const struct plane_sweep *sweep,
                     const struct plane_sweep_target *target, double disparity, int row,
                     const struct plane_sweep_scratch *scratch)
{
    const size_t w = (size_t)sweep->width;
    const double *here = sweep->at[target->view];
    memset(scratch->sum, 0, 2 * (PLANE_SWEEP_SIDES + 1) * w * sizeof *scratch->sum);
    for (int i = 0; i < target->count; i++) {
        const double *there = sweep->at[target->other[i]];
        const struct shift m =
            shift_of(sweep, disparity * (here[0] - there[0]), disparity * (here[1] - there[1]));
        if (!one_camera(sweep, target->view, target->other[i], &m, row, scratch->one))
            continue;
        for (int k = 0; k <= PLANE_SWEEP_SIDES; k++)
            if (k == PLANE_SWEEP_SIDES || (target->used[k] && target->sides[i] >> k & 1))
                add_row(scratch->sum + k * w + m.begin, scratch->count + k * w + m.begin,
                        scratch->one, m.end - m.begin);
    }
    const float scale = (float)PLANE_SWEEP_SCALE / (float)sweep->channels;
    for (size_t x = 0; x < w; x++) {
        const float all = mean_cost(scratch->sum[PLANE_SWEEP_SIDES * w + x],
                                    scratch->count[PLANE_SWEEP_SIDES * w + x], scale);
        float best = all;
        for (int k = 0; k < PLANE_SWEEP_SIDES; k++)
            if (scratch->count[k * w + x])
                best = fminf(best,
                             mean_cost(scratch->sum[k * w + x], scratch->count[k * w + x], scale));
        least[x] = (uint8_t)lrintf(best);
        if (mean)
            mean[x] = (uint8_t)lrintf(all);
    }
}
