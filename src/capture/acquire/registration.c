// registration.c - finds photographs that the camera took after it had been moved
//
// The edges of each photograph are laid over the mean edges of all (hdr/structure.h). Edges change
// little with the light, but shadows and highlights draw some that wander with the lamp: on a coin
// by up to a pixel. A moved camera shows as a step in time instead. Photographs are cut into runs
// at the largest steps. A step is a move where it stands out of the usual ones, or where the
// photographs before it explain those after it much better once these are moved back.
#include "capture/acquire/acquire.h"

#include "capture/hdr/pyramid.h"
#include "capture/hdr/structure.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "core/math/lsq.h"
#include "core/math/sort.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST_SIDE = 640,     // of the pictures that are compared
    MEMORY = 128 << 20,  // for all of them, bytes
    REACH = 6,           // shifts that are tried, pixels of the coarse pictures
    COARSE = 2,          // halvings of the fine pictures
    CLIMB = 24,          // steps on the fine ones
    ROUNDS = 2,          // of a mean of edges and positions on it
    LIKE = 6,            // photographs that explain another
    TRIED = 9,           // photographs of a run that are explained
    DEEPEST = 24,        // cuts of runs into runs: stacks are small
    NEAR = 3,            // photographs on either side of a step
};
static const double LEAST_SHIFT = 0.5;             // pixels of the photograph
static const double SAME_POSITION = 0.5;           // pixels of the pictures that are compared
static const double ALIKE = 0.1, KNOWN = 0.15;     // correlation of edges of one scene, at least
static const double SCATTER = 0.02;                // the least that positions have
static const double DOUBTFUL = 4.0, CLEAR = 10.0;  // a step counts, is a move; in scatters
static const double EXPLAINED = 0.6;               // share of the error without the shift
static const double BETTER = 0.95;
static const double FAR_BETTER = 1.2;  // correlation of a position far away against one near by

int acquire_luma_side(int shots)
{
    const double side = sqrt((double)MEMORY / (8.0 * 0.75 * shots));
    return side > MOST_SIDE ? MOST_SIDE : (int)side;
}

// A photograph as it is compared.
struct edges {
    struct relume_image fine, coarse;
    double x, y;  // where the scene lies, pixels of `fine`, to the right and down
    double like;  // correlation with the mean edges there
    bool here;    // at the position of most photographs
};
struct registration {
    struct acquisition *s;
    struct edges *edges;               // [shots]
    struct relume_image fine, coarse;  // sums of those that are here
    relume_status *status;             // [shots]
};

static relume_status make_edges(struct edges *e, const struct relume_image *luma)
{
    struct relume_image half, quarter = {0};
    relume_status status = structure_make(&e->fine, luma, 1);
    if (!status)
        status = pyramid_halve(&half, luma, 1);
    if (status)
        return status;
    status = pyramid_halve(&quarter, &half, 1);
    if (!status)
        status = structure_make(&e->coarse, &quarter, 1);
    relume_image_destroy(&half);
    relume_image_destroy(&quarter);
    return status;
}

static void make_edges_of(void *context, size_t i, int worker)
{
    struct registration *r = context;
    (void)worker;
    r->status[i] = make_edges(&r->edges[i], &r->s->shot[i].luma);
}

// Adds the picture, shifted back by (dx, dy), `times` to a sum; its border is repeated.
static void add_shifted(struct relume_image *sum, const struct relume_image *image, int dx, int dy,
                        float times)
{
    const int w = sum->width, h = sum->height;
    for (int y = 0; y < h; y++) {
        const float *row = image->data + (size_t)index_clamped(y + dy, h) * (size_t)w;
        float *out = sum->data + (size_t)y * (size_t)w;
        for (int x = 0; x < w; x++)
            out[x] += times * row[index_clamped(x + dx, w)];
    }
}

static void add_edges(struct registration *r, const struct edges *e)
{
    const double scale = 1 << COARSE;
    add_shifted(&r->fine, &e->fine, (int)lround(e->x), (int)lround(e->y), 1.0f);
    add_shifted(&r->coarse, &e->coarse, (int)lround(e->x / scale), (int)lround(e->y / scale), 1.0f);
}

// Makes the sum without a picture that is part of it, shifted back by (dx, dy).
static relume_status leave_out(struct relume_image *out, const struct relume_image *sum,
                               const struct relume_image *image, double dx, double dy)
{
    const relume_status status = relume_image_create(out, sum->width, sum->height, 1);
    if (status)
        return status;
    memcpy(out->data, sum->data, (size_t)sum->width * (size_t)sum->height * sizeof *sum->data);
    add_shifted(out, image, (int)lround(dx), (int)lround(dy), -1.0f);
    return RELUME_OK;
}

// Sums over a row, four pixels at a time (a vector type of GCC and Clang, as in hdr/correlate.c).
typedef float four __attribute__((vector_size(16), aligned(4), may_alias));
struct sums {
    four a, b, aa, bb, ab;
};

static void add_four(struct sums *sums, four a, four b)
{
    sums->a += a;
    sums->b += b;
    sums->aa += a * a;
    sums->bb += b * b;
    sums->ab += a * b;
}

static double total(four v, four w)
{
    v += w;
    return ((double)v[0] + (double)v[1]) + ((double)v[2] + (double)v[3]);
}

// Moments of pairs of pixels.
struct pair {
    double a, b, aa, bb, ab, n;
};

static void add_row(struct pair *pair, const float *a, const float *b, int n)
{
    struct sums even = {{0}, {0}, {0}, {0}, {0}}, odd = even;
    int x = 0;
    for (; x + 8 <= n; x += 8) {
        add_four(&even, *(const four *)(a + x), *(const four *)(b + x));
        add_four(&odd, *(const four *)(a + x + 4), *(const four *)(b + x + 4));
    }
    for (; x < n; x++)
        add_four(&odd, (four){a[x]}, (four){b[x]});
    pair->a += total(even.a, odd.a);
    pair->b += total(even.b, odd.b);
    pair->aa += total(even.aa, odd.aa);
    pair->bb += total(even.bb, odd.bb);
    pair->ab += total(even.ab, odd.ab);
    pair->n += n;
}

// The correlation of `all` with `image` moved by (dx, dy).
static double correlate(const struct relume_image *all, const struct relume_image *image, int dx,
                        int dy)
{
    const int w = all->width, h = all->height;
    const int border = (w > h ? w : h) / 16 + 1;
    const int from = border > -dx ? border : -dx, to = w - (border > dx ? border : dx);
    struct pair p = {0};
    for (int y = border; y < h - border && from < to; y++)
        if (y + dy >= 0 && y + dy < h)
            add_row(&p, all->data + (ptrdiff_t)y * w + from,
                    image->data + (ptrdiff_t)(y + dy) * w + from + dx, to - from);
    const double va = p.aa - p.a * p.a / p.n, vb = p.bb - p.b * p.b / p.n;
    return p.n > 0.0 && va > 0.0 && vb > 0.0 ? (p.ab - p.a * p.b / p.n) / sqrt(va * vb) : -1.0;
}

// How far the top of a parabola through three neighbours lies from the middle one.
static double top_of(double before, double at, double after)
{
    const double bend = before - 2.0 * at + after;
    return bend < 0.0 ? fmax(-0.5, fmin(0.5, 0.5 * (before - after) / bend)) : 0.0;
}

// Moves to the best of nine neighbouring positions until none is better; `near` remembers them.
static double climb(const struct relume_image *all, const struct relume_image *image,
                    int position[2], double found[2])
{
    double near[3][3] = {{0.0}}, known[3][3];
    int by[2] = {3, 3};  // the last step; 3: no neighbour is known yet
    for (int step = 0; step < CLIMB && (by[0] || by[1]); step++) {
        int best[2] = {0, 0};
        memcpy(known, near, sizeof known);
        for (int j = 0; j < 3; j++)
            for (int i = 0; i < 3; i++) {
                const int x = i + by[0], y = j + by[1];
                near[j][i] = x >= 0 && y >= 0 && x < 3 && y < 3
                                 ? known[y][x]
                                 : correlate(all, image, position[0] + i - 1, position[1] + j - 1);
            }
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++)
                if (near[j + 1][i + 1] > near[best[1] + 1][best[0] + 1]) {
                    best[0] = i;
                    best[1] = j;
                }
        memcpy(by, best, sizeof by);
        position[0] += by[0];
        position[1] += by[1];
    }
    found[0] = position[0] - by[0] + top_of(near[1][0], near[1][1], near[1][2]);
    found[1] = position[1] - by[1] + top_of(near[0][1], near[1][1], near[2][1]);
    return near[1][1];
}

// Where `e` lies on a pair of pictures; returns the correlation there. Along stripes every position
// is about as good: one far away has to be better by FAR_BETTER than the one near by.
static double position_on(const struct edges *e, const struct relume_image *fine,
                          const struct relume_image *coarse, double found[2])
{
    // from the best position on the coarse picture, from where it was, and from where most are
    int start[3][2] = {{0, 0}, {(int)lround(e->x), (int)lround(e->y)}, {0, 0}};
    double best = -2.0;
    for (int j = -REACH; j <= REACH; j++)
        for (int i = -REACH; i <= REACH; i++) {
            const double like = correlate(coarse, &e->coarse, i, j);
            if (like > best) {
                best = like;
                start[0][0] = i * (1 << COARSE);
                start[0][1] = j * (1 << COARSE);
            }
        }
    best = -2.0;
    int top[3][2];  // climbs from one position end at one
    for (int k = 2; k >= 0; k--) {
        double at[2];
        memcpy(top[k], start[k], sizeof top[k]);
        bool again = false;
        for (int j = k + 1; j < 3; j++)
            again |= !memcmp(start[k], start[j], sizeof start[k]) ||
                     !memcmp(start[k], top[j], sizeof start[k]);
        if (again)
            continue;
        const double like = climb(fine, &e->fine, top[k], at);
        if (like > (k < 2 && best > 0.0 ? FAR_BETTER * best : best)) {
            best = like;
            memcpy(found, at, sizeof at);
        }
    }
    return best;
}

// On the edges of all others.
static relume_status position_among(struct edges *e, const struct registration *r, double found[2])
{
    const double scale = 1 << COARSE;
    struct relume_image fine = {0}, coarse = {0};
    relume_status status = leave_out(&fine, &r->fine, &e->fine, e->x, e->y);
    if (!status)
        status = leave_out(&coarse, &r->coarse, &e->coarse, e->x / scale, e->y / scale);
    if (!status)
        e->like = position_on(e, &fine, &coarse, found);
    relume_image_destroy(&fine);
    relume_image_destroy(&coarse);
    return status;
}

static void find_position(void *context, size_t at, int worker)
{
    struct registration *r = context;
    struct edges *e = &r->edges[at];
    double found[2];
    (void)worker;
    if (e->here)
        r->status[at] = position_among(e, r, found);
    else
        e->like = position_on(e, &r->fine, &r->coarse, found);
    if (r->status[at])
        return;
    e->x = found[0];
    e->y = found[1];
}

// Steps from one photograph to the next, whose lamps are often close. What shows nothing takes the
// position of the one before it.
static void follow(struct registration *r)
{
    const struct edges *last = &r->edges[0];
    for (int i = 1; i < r->s->shots; i++) {
        struct edges *e = &r->edges[i];
        double step[2];
        const double like = position_on(e, &last->fine, &last->coarse, step);
        const bool stays = like < ALIKE || hypot(step[0], step[1]) < SAME_POSITION;
        e->x = last->x + (stays ? 0.0 : step[0]);
        e->y = last->y + (stays ? 0.0 : step[1]);
        last = like < ALIKE ? last : e;
    }
}

// The position with the most photographs becomes (0, 0).
static void centre(struct registration *r)
{
    const int n = r->s->shots;
    int most = 0, at = 0;
    for (int i = 0; i < n; i++) {
        int near = 0;
        for (int k = 0; k < n; k++)
            near +=
                hypot(r->edges[k].x - r->edges[i].x, r->edges[k].y - r->edges[i].y) < SAME_POSITION;
        if (near > most) {
            most = near;
            at = i;
        }
    }
    const double x = r->edges[at].x, y = r->edges[at].y;
    for (int i = 0; i < n; i++) {
        struct edges *e = &r->edges[i];
        e->x -= x;
        e->y -= y;
        e->here = hypot(e->x, e->y) < SAME_POSITION;
    }
}

static void sum_edges(struct registration *r)
{
    const int n = r->s->shots;
    memset(r->fine.data, 0, (size_t)r->fine.width * (size_t)r->fine.height * sizeof *r->fine.data);
    memset(r->coarse.data, 0,
           (size_t)r->coarse.width * (size_t)r->coarse.height * sizeof *r->coarse.data);
    for (int i = 0; i < n; i++)
        if (r->edges[i].here)
            add_edges(r, &r->edges[i]);
}

static relume_status find_positions(struct registration *r)
{
    const size_t n = (size_t)r->s->shots;
    relume_status status = RELUME_OK;
    thread_for(r->s->p.threads, n, make_edges_of, r);
    for (size_t i = 0; i < n && !status; i++)
        status = r->status[i];
    if (!status)
        status = relume_image_create(&r->fine, r->edges->fine.width, r->edges->fine.height, 1);
    if (!status)
        status =
            relume_image_create(&r->coarse, r->edges->coarse.width, r->edges->coarse.height, 1);
    if (!status) {
        follow(r);
        centre(r);
    }
    for (int round = 0; !status && round < ROUNDS; round++) {
        sum_edges(r);
        thread_for(r->s->p.threads, n, find_position, r);
        for (size_t i = 0; i < n && !status; i++)
            status = r->status[i];
        centre(r);
    }
    return status;
}

// ---------------------------------------------------------------- runs of one position

// Photographs that follow each other, but for single ones that lie apart.
struct run {
    int first, end;  // in `order`
    double x, y;     // beside the run before it, or of a single photograph the run around it; once
                     // moves are known, beside the base; pixels of `fine`
};
struct runs {
    double (*off)[2];  // [shots] positions beside the others around them
    int *order;        // [shots] photographs by number: members of runs, then single ones
    int kept;          // members of runs
    struct run *run;   // [shots] at most
    int count, long_runs;
    double scatter, least;  // between neighbours; the least step that counts
    double *work;           // [shots]
};

// Medians of the positions of photographs order[first .. end).
static void middle(const struct registration *r, const struct runs *runs, int first, int end,
                   double xy[2])
{
    for (int k = 0; k < 2; k++) {
        for (int i = first; i < end; i++) {
            const struct edges *e = &r->edges[runs->order[i]];
            runs->work[i - first] = k ? e->y : e->x;
        }
        sort_doubles(runs->work, (size_t)(end - first));
        xy[k] = runs->work[(end - first) / 2];
    }
}

// Steps from one photograph to the next: the lamp's part in positions, since moves are few.
static double scatter_of(const struct registration *r, double *work)
{
    const int n = r->s->shots;
    for (int i = 1; i < n; i++)
        work[i - 1] = hypot(r->edges[i].x - r->edges[i - 1].x, r->edges[i].y - r->edges[i - 1].y);
    sort_doubles(work, (size_t)n - 1);
    return fmax(work[(n - 1) / 2], SCATTER);
}

// The distance to the median of up to NEAR photographs before or after, whichever is nearer.
static void beside_others(const struct registration *r, struct runs *runs, int i, double off[2])
{
    const int n = r->s->shots;
    off[0] = off[1] = INFINITY;
    for (int side = -1; side <= 1; side += 2) {
        double other[2];
        int count = 0;
        for (int k = i + side; k >= 0 && k < n && count < NEAR; k += side)
            runs->order[count++] = k;
        if (!count)
            continue;
        middle(r, runs, 0, count, other);
        const double x = r->edges[i].x - other[0], y = r->edges[i].y - other[1];
        if (hypot(x, y) < hypot(off[0], off[1])) {
            off[0] = x;
            off[1] = y;
        }
    }
}

// The step between photographs `at` - 1 and `at` of a run, by a few on either side.
static double step_at(const struct registration *r, const struct runs *runs, int first, int at,
                      int end, double step[2])
{
    double before[2], after[2];
    middle(r, runs, at - NEAR > first ? at - NEAR : first, at, before);
    middle(r, runs, at, at + NEAR < end ? at + NEAR : end, after);
    step[0] = after[0] - before[0];
    step[1] = after[1] - before[1];
    return hypot(step[0], step[1]);
}

// Cuts a run at its largest step, and the parts again, `deep` times at most.
static void cut(const struct registration *r, struct runs *runs, int first, int end, int deep)
{
    double step[2], most = 0.0;
    int at = 0;
    for (int i = first + 1; i < end; i++) {
        const double far = step_at(r, runs, first, i, end, step);
        if (far > most) {
            most = far;
            at = i;
        }
    }
    if (most >= runs->least && deep) {
        cut(r, runs, first, at, deep - 1);
        cut(r, runs, at, end, deep - 1);
        return;
    }
    step[0] = step[1] = 0.0;
    if (runs->count)
        (void)step_at(r, runs, runs->run[runs->count - 1].first, first, end, step);
    runs->run[runs->count++] = (struct run){first, end, step[0], step[1]};
}

// A single photograph is a run of its own.
static void add_single(struct runs *runs, int i, const double off[2])
{
    const int at = runs->kept + runs->count - runs->long_runs;
    runs->run[runs->count++] = (struct run){at, at + 1, off[0], off[1]};
    runs->order[at] = i;
}

static void find_runs(const struct registration *r, struct runs *runs)
{
    const int n = r->s->shots;
    for (int i = 0; i < n; i++)
        beside_others(r, runs, i, runs->off[i]);
    for (int i = 0; i < n; i++)
        if (hypot(runs->off[i][0], runs->off[i][1]) <= runs->least)
            runs->order[runs->kept++] = i;
    cut(r, runs, 0, runs->kept, DEEPEST);
    runs->long_runs = runs->count;
    for (int i = 0; i < n; i++)
        if (hypot(runs->off[i][0], runs->off[i][1]) > runs->least)
            add_single(runs, i, runs->off[i]);
}

// ---------------------------------------------------------------- explained by others

// Values of a luma in positions of the middle, shifted by a part of a pixel, blurred by 2 x 2
// pixels.
static float luma_at(const struct relume_image *luma, double x, double y)
{
    const int i = (int)floor(x), j = (int)floor(y), w = luma->width;
    const float s = (float)(x - i), t = (float)(y - j);
    float sum = 0.0f;
    for (int v = -1; v <= 2; v++)
        for (int u = -1; u <= 2; u++) {
            const float a = u < 0 ? 1.0f - s : u > 1 ? s : 1.0f;
            const float b = v < 0 ? 1.0f - t : v > 1 ? t : 1.0f;
            sum += a * b * luma->data[(size_t)(j + v) * (size_t)w + (size_t)(i + u)];
        }
    return sum / 9.0f;
}

// Mean squared error with which photographs of the base explain photograph `i` moved back by
// (x, y): least squares with a constant, over positions two pixels apart, away from the border.
static double unexplained(const struct registration *r, int i, double x, double y, int border,
                          const int *like, int count)
{
    enum { MOST = LIKE + 1 };
    const struct relume_image *luma = &r->s->shot[i].luma;
    const int w = luma->width, h = luma->height;
    const int n = count + 1;
    double gram[MOST * MOST] = {0.0}, right[MOST] = {0.0}, value[MOST], square = 0.0, sum = 0.0;
    size_t positions = 0;
    for (int v = border; v < h - border; v += 2)
        for (int u = border; u < w - border; u += 2, positions++) {
            const double own = (double)luma_at(luma, u + x, v + y);
            for (int k = 0; k < count; k++)
                value[k] = (double)luma_at(&r->s->shot[like[k]].luma, u, v);
            value[count] = 1.0;
            for (int a = 0; a < n; a++) {
                right[a] += value[a] * own;
                for (int b = 0; b <= a; b++)
                    gram[a * n + b] += value[a] * value[b];
            }
            square += own * own;
        }
    double solved[MOST];
    memcpy(solved, right, sizeof solved);
    for (int a = 0; a < n; a++)
        gram[a * n + a] *= 1.0 + 1e-6;
    if (!positions || !lsq_solve(gram, n, solved, 1))
        return NAN;
    for (int a = 0; a < n; a++)
        sum += right[a] * solved[a];
    return fmax(square - sum, 0.0) / (double)positions;
}

struct likeness {
    double like;
    int index;
};

static int by_likeness(const void *a, const void *b)
{
    const double x = ((const struct likeness *)a)->like, y = ((const struct likeness *)b)->like;
    return x > y ? -1 : x < y;
}

// Correlation of two small photographs, whose light decides it.
static double likeness(const struct relume_image *a, const struct relume_image *b)
{
    const size_t n = 3 * (size_t)a->width * (size_t)a->height;
    double sa = 0.0, sb = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
    for (size_t i = 0; i < n; i++) {
        const double x = (double)a->data[i], y = (double)b->data[i];
        sa += x;
        sb += y;
        aa += x * x;
        bb += y * y;
        ab += x * y;
    }
    const double va = aa - sa * sa / (double)n, vb = bb - sb * sb / (double)n;
    return va > 0.0 && vb > 0.0 ? (ab - sa * sb / (double)n) / sqrt(va * vb) : 0.0;
}

// The photographs of a run that are most like photograph `i`.
static int most_alike(const struct registration *r, const struct runs *runs, int i,
                      const struct run *base, int like[LIKE], struct likeness *list)
{
    int n = 0;
    for (int k = base->first; k < base->end; k++) {
        const int other = runs->order[k];
        list[n++] =
            (struct likeness){likeness(&r->s->shot[i].small, &r->s->shot[other].small), other};
    }
    qsort(list, (size_t)n, sizeof *list, by_likeness);
    for (int k = 0; k < n && k < LIKE; k++)
        like[k] = list[k].index;
    return n < LIKE ? n : LIKE;
}

// How much of the error is left with which photographs of `base` explain the photographs of a run,
// once these are moved back: the median over some of the run.
static double error_left(const struct registration *r, const struct runs *runs,
                         const struct run *run, const struct run *base, struct likeness *list)
{
    const int n = run->end - run->first, tried = n < TRIED ? n : TRIED;
    const int border = r->fine.width / 12 + (int)fmax(fabs(run->x), fabs(run->y)) + 3;
    double left[TRIED] = {0.0};
    int like[LIKE], known = 0;
    for (int k = 0; k < tried; k++) {
        const int i = runs->order[run->first + k * n / tried];
        const int count = most_alike(r, runs, i, base, like, list);
        const double before = unexplained(r, i, 0.0, 0.0, border, like, count);
        const double after = unexplained(r, i, run->x, run->y, border, like, count);
        if (before > 0.0 && isfinite(after))
            left[known++] = after / before;
    }
    if (!known)
        return INFINITY;
    sort_doubles(left, (size_t)known);
    return left[known / 2];
}

static bool is_moved(const struct registration *r, const struct runs *runs, const struct run *run,
                     const struct run *base, struct likeness *list)
{
    const double far = hypot(run->x, run->y);
    double like = 0.0;
    for (int k = run->first; k < run->end; k++)
        like += r->edges[runs->order[k]].like / (run->end - run->first);
    if (far < runs->least || like < KNOWN)
        return false;
    const double left = error_left(r, runs, run, base, list);
    return left < EXPLAINED || (far > CLEAR * runs->scatter && left < BETTER);
}

// Joins runs between which nothing moved.
static void join_runs(const struct registration *r, struct runs *runs, struct likeness *list)
{
    int joined = 0;
    for (int k = 1; k < runs->long_runs; k++) {
        struct run *last = &runs->run[joined];
        if (is_moved(r, runs, &runs->run[k], last, list))
            runs->run[++joined] = runs->run[k];
        else
            last->end = runs->run[k].end;
    }
    const int singles = runs->count - runs->long_runs, dropped = runs->long_runs - joined - 1;
    memmove(&runs->run[joined + 1], &runs->run[runs->long_runs],
            (size_t)singles * sizeof *runs->run);
    runs->long_runs -= dropped;
    runs->count -= dropped;
}

// The longest run becomes the base. Single photographs that were not moved join the run around
// them.
static void set_positions(const struct registration *r, struct runs *runs, struct likeness *list)
{
    int base = 0;
    runs->run[0].x = runs->run[0].y = 0.0;
    for (int k = 1; k < runs->long_runs; k++) {
        struct run *run = &runs->run[k];
        if (run->end - run->first > runs->run[base].end - runs->run[base].first)
            base = k;
    }
    for (int k = runs->long_runs; k < runs->count; k++) {
        struct run *single = &runs->run[k];
        int around = 0;
        while (around + 1 < runs->long_runs &&
               runs->order[runs->run[around + 1].first] < runs->order[single->first])
            around++;
        if (!is_moved(r, runs, single, &runs->run[around], list))
            single->x = single->y = 0.0;
        for (int i = 1; i <= around; i++) {
            single->x += runs->run[i].x;
            single->y += runs->run[i].y;
        }
    }
    for (int k = 1; k < runs->long_runs; k++) {
        runs->run[k].x += runs->run[k - 1].x;
        runs->run[k].y += runs->run[k - 1].y;
    }
    const double x = runs->run[base].x, y = runs->run[base].y;
    for (int k = 0; k < runs->count; k++) {
        runs->run[k].x -= x;
        runs->run[k].y -= y;
    }
}

// ---------------------------------------------------------------- sentences

static void put_shift(char *out, size_t room, const double shift[2])
{
    const double x = shift[0], y = shift[1];
    char across[40] = "", along[40] = "";
    if (fabs(x) >= 0.05)
        snprintf(across, sizeof across, "%.1f pixels to the %s", fabs(x),
                 x > 0.0 ? "right" : "left");
    if (fabs(y) >= 0.05)
        snprintf(along, sizeof along, "%.1f pixels %s", fabs(y), y > 0.0 ? "down" : "up");
    snprintf(out, room, "%s%s%s", across, *across && *along ? " and " : "", along);
}

static relume_status say_moved(struct acquisition *s, const struct runs *runs,
                               const struct run *run)
{
    static const char taken_out[] =
        "the camera was moved; this is taken out (--align none leaves it)";
    const int i = runs->order[run->first], last = runs->order[run->end - 1];
    char shift[96];
    put_shift(shift, sizeof shift, s->shot[i].shift);
    if (i == last)
        return acquire_warn(s, "%s: the scene lies %s: %s", s->shot[i].path, shift, taken_out);
    if (last == s->shots - 1)
        return acquire_warn(s, "from %s on the scene lies %s: %s", s->shot[i].path, shift,
                            taken_out);
    return acquire_warn(s, "from %s to %s the scene lies %s: %s", s->shot[i].path,
                        s->shot[last].path, shift, taken_out);
}

// ---------------------------------------------------------------- the call

static relume_status find_moved(struct registration *r, struct runs *runs, bool *moved)
{
    struct acquisition *s = r->s;
    const double step = (double)s->width / s->shot->luma.width;
    struct likeness *list = mem_array((size_t)s->shots, sizeof *list);
    relume_status status = list ? RELUME_OK : RELUME_ENOMEM;
    runs->scatter = scatter_of(r, runs->work);
    runs->least = fmax(LEAST_SHIFT / step, DOUBTFUL * runs->scatter);
    if (!status) {
        find_runs(r, runs);
        join_runs(r, runs, list);
        set_positions(r, runs, list);
    }
    for (int k = 0; k < runs->count && !status; k++) {
        const struct run *run = &runs->run[k];
        const double shift[2] = {step * run->x, step * run->y};
        if (hypot(shift[0], shift[1]) < LEAST_SHIFT)
            continue;
        for (int i = run->first; i < run->end; i++)
            memcpy(s->shot[runs->order[i]].shift, shift, sizeof shift);
        *moved = true;
        status = say_moved(s, runs, run);
    }
    mem_free(list);
    return status;
}

relume_status acquire_register(struct acquisition *s, bool *moved)
{
    const size_t n = (size_t)s->shots;
    struct registration r = {
        .s = s, .edges = mem_zeroed(n, sizeof *r.edges), .status = mem_zeroed(n, sizeof *r.status)};
    struct runs runs = {.off = mem_array(n, sizeof *runs.off),
                        .order = mem_array(n, sizeof *runs.order),
                        .run = mem_array(n, sizeof *runs.run),
                        .work = mem_array(n, sizeof *runs.work)};
    const bool made = r.edges && r.status && runs.off && runs.order && runs.run && runs.work;
    relume_status status = made ? find_positions(&r) : RELUME_ENOMEM;
    if (!status)
        status = find_moved(&r, &runs, moved);
    for (size_t i = 0; r.edges && i < n; i++) {
        relume_image_destroy(&r.edges[i].fine);
        relume_image_destroy(&r.edges[i].coarse);
    }
    relume_image_destroy(&r.fine);
    relume_image_destroy(&r.coarse);
    mem_free(r.edges);
    mem_free(r.status);
    mem_free(runs.off);
    mem_free(runs.order);
    mem_free(runs.run);
    mem_free(runs.work);
    return status;
}

// ---------------------------------------------------------------- shifted pictures

// Weights of four samples about a position between the middle two (Catmull and Rom 1974).
static void cubic(double t, float weight[4])
{
    weight[0] = (float)(((-0.5 * t + 1.0) * t - 0.5) * t);
    weight[1] = (float)((1.5 * t - 2.5) * t * t + 1.0);
    weight[2] = (float)(((-1.5 * t + 2.0) * t + 0.5) * t);
    weight[3] = (float)((0.5 * t - 0.5) * t * t);
}

// A shift of nearly whole pixels is one.
static double rounded(double shift)
{
    return fabs(shift - round(shift)) < 0.05 ? round(shift) : shift;
}

relume_status acquire_move_back(struct relume_image *image, const double shift[2])
{
    const double x = rounded(shift[0]), y = rounded(shift[1]);
    const int i = (int)floor(x), j = (int)floor(y), w = image->width, h = image->height;
    float across[4], along[4];
    struct relume_image out;
    if (x == 0.0 && y == 0.0)
        return RELUME_OK;
    const relume_status status = relume_image_create(&out, w, h, image->channels);
    if (status)
        return status;
    cubic(x - i, across);
    cubic(y - j, along);
    const int n = image->channels;
    for (int row = 0; row < h; row++)
        for (int column = 0; column < w; column++)
            for (int c = 0; c < n; c++) {
                float sum = 0.0f;
                for (int v = 0; v < 4; v++) {
                    const int from = index_clamped(row + j + v - 1, h);
                    for (int u = 0; along[v] != 0.0f && u < 4; u++)
                        sum += along[v] * across[u] *
                               image->data[((size_t)from * (size_t)w +
                                            (size_t)index_clamped(column + i + u - 1, w)) *
                                               (size_t)n +
                                           (size_t)c];
                }
                out.data[((size_t)row * (size_t)w + (size_t)column) * (size_t)n + (size_t)c] =
                    fmaxf(sum, 0.0f);
            }
    relume_image_destroy(image);
    *image = out;
    return RELUME_OK;
}
