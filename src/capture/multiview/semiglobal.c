// semiglobal.c - semi-global matching: minimum over paths from eight directions
//
// Hirschmueller 2008, Eq. 13: along a path r the cost of plane d at pixel p is
//   L(p, d) = C(p, d) + min(L(p-r, d), L(p-r, d+-1) + P1, min_i L(p-r, i) + P2) - min_i L(p-r, i).
// A path is a line of pixels of its own, so lines run on any thread and sums are of integers.
#include "capture/multiview/semiglobal.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

#include <string.h>

// In the scale of costs (0 to 252): a slope of a plane per pixel, and a jump, which edges of the
// guide make cheaper, down to the least.
static const int slope = 4, jump = 60, least_jump = 12, edge = 8;

enum { LINES_AT_ONCE = 16 };

// Lines of one direction: the first `across` begin on a horizontal rim, the others on a vertical
// one.
struct direction {
    const struct semiglobal *s;
    int dx, dy;
    uint16_t *scratch;  // [threads][2][planes + 2]
};

static int line_count(const struct direction *d)
{
    return (d->dy ? d->s->width : 0) + (d->dx ? d->s->height - (d->dy ? 1 : 0) : 0);
}

static void line_start(int xy[2], const struct direction *d, int line)
{
    const int w = d->s->width, h = d->s->height;
    const int across = d->dy ? w : 0;
    if (line < across) {
        xy[0] = line;
        xy[1] = d->dy > 0 ? 0 : h - 1;
        return;
    }
    const int down = line - across + (d->dy > 0);  // the corner has had its line
    xy[0] = d->dx > 0 ? 0 : w - 1;
    xy[1] = down;
}

static int jump_cost(int step)
{
    const int cost = jump * edge / (edge + (step < 0 ? -step : step));
    return cost > least_jump ? cost : least_jump;
}

// `before` and `now` have a guard on both sides; returns the least of `now`.
static uint16_t advance(uint16_t *restrict now, const uint16_t *restrict before, uint16_t least,
                        const uint8_t *restrict cost, uint16_t *restrict sum, int planes, int p2)
{
    const uint16_t from_afar = (uint16_t)(least + p2);
    uint16_t best = UINT16_MAX;
    for (int q = 0; q < planes; q++) {
        const uint16_t left = (uint16_t)(before[q - 1] + slope);
        const uint16_t right = (uint16_t)(before[q + 1] + slope);
        uint16_t m = before[q] < from_afar ? before[q] : from_afar;
        m = left < m ? left : m;
        m = right < m ? right : m;
        const uint16_t v = (uint16_t)(cost[q] + m - least);
        now[q] = v;
        sum[q] = (uint16_t)(sum[q] + v);
        best = v < best ? v : best;
    }
    return best;
}

static void run_line(const struct direction *d, int line, uint16_t *scratch)
{
    enum { GUARD = UINT16_MAX / 2 };
    const struct semiglobal *s = d->s;
    const size_t planes = (size_t)s->planes;
    uint16_t *now = scratch + 1, *before = scratch + planes + 3;
    int xy[2];
    line_start(xy, d, line);
    now[-1] = now[planes] = before[-1] = before[planes] = GUARD;
    memset(before, 0, planes * sizeof *before);
    uint16_t least = 0;
    int guide = s->guide[(size_t)xy[1] * (size_t)s->width + (size_t)xy[0]];
    for (int x = xy[0], y = xy[1]; x >= 0 && y >= 0 && x < s->width && y < s->height;
         x += d->dx, y += d->dy) {
        const size_t at = (size_t)y * (size_t)s->width + (size_t)x;
        least = advance(now, before, least, s->cost + at * planes, s->sum + at * planes, s->planes,
                        jump_cost(s->guide[at] - guide));
        guide = s->guide[at];
        uint16_t *swap = now;
        now = before;
        before = swap;
    }
}

static void run_lines(void *context, size_t item, int worker)
{
    const struct direction *d = context;
    uint16_t *scratch = d->scratch + (size_t)worker * 2 * ((size_t)d->s->planes + 2);
    const int count = line_count(d);
    for (int i = 0; i < LINES_AT_ONCE; i++) {
        const int line = (int)item * LINES_AT_ONCE + i;
        if (line < count)
            run_line(d, line, scratch);
    }
}

relume_status semiglobal_sum(const struct semiglobal *s)
{
    const int threads = thread_count(s->threads);
    uint16_t *scratch = mem_array((size_t)threads * 2, ((size_t)s->planes + 2) * sizeof *scratch);
    if (!scratch)
        return RELUME_ENOMEM;
    for (int i = 0; i < 9; i++) {
        struct direction d = {s, i % 3 - 1, i / 3 - 1, scratch};
        if (d.dx || d.dy)
            thread_for(threads, (size_t)(line_count(&d) + LINES_AT_ONCE - 1) / LINES_AT_ONCE,
                       run_lines, &d);
    }
    mem_free(scratch);
    return RELUME_OK;
}

float semiglobal_best(const uint16_t *sum, int planes)
{
    int best = 0;
    for (int q = 1; q < planes; q++)
        if (sum[q] < sum[best])
            best = q;
    if (best == 0 || best == planes - 1)
        return (float)best;
    const float a = sum[best - 1], b = sum[best], c = sum[best + 1];
    const float bend = a - 2.0f * b + c;
    return (float)best + (bend > 0.0f ? 0.5f * (a - c) / bend : 0.0f);
}
