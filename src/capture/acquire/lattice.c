// lattice.c - regions that lie as the patches of a target do
//
// From a region and two neighbours a grid grows: each found region predicts its neighbours by the
// steps found so far, which follow the perspective. Windows of six by four cells that hold enough
// regions are handed on, in both or all four ways that they may be turned.
#include "capture/acquire/chart.h"

#include "core/base/memory.h"

#include <math.h>
#include <string.h>

enum { REACH = 6, SIDE = 2 * REACH + 1, NEAREST = 8, LEAST_SEEN = 12, MOST_ASKED = 3000 };
static const double UNLIKE = 2.5;           // areas of neighbours
static const double NEAR = 0.9, FAR = 3.2;  // a step, in sides of a region
static const double MISS = 0.3;             // of a step
static const double LEAST_SINE = 0.6;       // of the angle between the steps
static const double UNEVEN = 1.8;           // lengths of the steps

struct cell {
    int blob;  // -1: none
    double right[2], down[2];
};

struct grid {
    const struct blob *blob;
    int n;
    struct cell cell[SIDE][SIDE];
    int count;
    int queue[SIDE * SIDE];
};

static bool alike(const struct blob *a, const struct blob *b)
{
    return a->area < UNLIKE * b->area && b->area < UNLIKE * a->area;
}

static bool is_in(const struct grid *g, int blob)
{
    for (int i = 0; i < g->count; i++)
        if (g->cell[g->queue[i] / SIDE][g->queue[i] % SIDE].blob == blob)
            return true;
    return false;
}

// The region nearest to a place, which is like `from` and not in the grid yet; -1: none.
static int region_at(const struct grid *g, const struct blob *from, double x, double y, double miss)
{
    int best = -1;
    double least = miss * miss;
    for (int i = 0; i < g->n; i++) {
        const struct blob *b = &g->blob[i];
        const double dx = b->x - x, dy = b->y - y, d = dx * dx + dy * dy;
        if (d < least && alike(b, from) && !is_in(g, i)) {
            least = d;
            best = i;
        }
    }
    return best;
}

static void put(struct grid *g, int column, int row, int blob, const double right[2],
                const double down[2])
{
    struct cell *c = &g->cell[row][column];
    c->blob = blob;
    memcpy(c->right, right, sizeof c->right);
    memcpy(c->down, down, sizeof c->down);
    g->queue[g->count++] = row * SIDE + column;
}

static void grow(struct grid *g)
{
    static const int across[] = {1, -1, 0, 0}, along[] = {0, 0, 1, -1};
    for (int i = 0; i < g->count; i++) {
        const int row = g->queue[i] / SIDE, column = g->queue[i] % SIDE;
        const struct cell c = g->cell[row][column];
        const struct blob *from = &g->blob[c.blob];
        for (int k = 0; k < 4; k++) {
            const int x = column + across[k], y = row + along[k];
            if (x < 0 || y < 0 || x >= SIDE || y >= SIDE || g->cell[y][x].blob >= 0)
                continue;
            const double *step = k < 2 ? c.right : c.down;
            const double sign = across[k] + along[k];
            const int found = region_at(g, from, from->x + sign * step[0], from->y + sign * step[1],
                                        MISS * hypot(step[0], step[1]));
            if (found < 0)
                continue;
            const double took[2] = {sign * (g->blob[found].x - from->x),
                                    sign * (g->blob[found].y - from->y)};
            put(g, x, y, found, k < 2 ? took : c.right, k < 2 ? c.down : took);
        }
    }
}

// Those of the window with its upper left cell at (left, top).
static int points_in(double (*plane)[2], double (*pixel)[2], const struct grid *g, int left,
                     int top, int columns, int rows)
{
    int n = 0;
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++) {
            const int blob = g->cell[top + y][left + x].blob;
            if (blob < 0)
                continue;
            plane[n][0] = x, plane[n][1] = y;
            pixel[n][0] = g->blob[blob].x, pixel[n][1] = g->blob[blob].y;
            n++;
        }
    return n;
}

// A window's points as those of a target that is turned by quarters.
static void turn(double (*plane)[2], int n, int quarters)
{
    for (int i = 0; i < n; i++) {
        const double x = plane[i][0], y = plane[i][1];
        const double right = CHART_COLUMNS - 1, bottom = CHART_ROWS - 1;
        const double turned[4][2] = {
            {x, y}, {y, bottom - x}, {right - x, bottom - y}, {right - y, x}};
        memcpy(plane[i], turned[quarters], sizeof turned[0]);
    }
}

struct asking {
    bool (*seen)(void *context, const struct homography *h);
    void *context;
    int asked;
    bool known;  // that was one
};

static int most_in_window(const struct grid *g, int quarters)
{
    const int columns = quarters % 2 ? CHART_ROWS : CHART_COLUMNS;
    const int rows = CHART_COLUMNS + CHART_ROWS - columns;
    double plane[CHART_PATCHES][2], pixel[CHART_PATCHES][2];
    int most = 0;
    for (int top = 0; top + rows <= SIDE; top++)
        for (int left = 0; left + columns <= SIDE; left++) {
            const int n = points_in(plane, pixel, g, left, top, columns, rows);
            most = n > most ? n : most;
        }
    return most;
}

static void ask(struct asking *a, const struct grid *g, int quarters, int least)
{
    const int columns = quarters % 2 ? CHART_ROWS : CHART_COLUMNS;
    const int rows = CHART_COLUMNS + CHART_ROWS - columns;
    double plane[CHART_PATCHES][2], pixel[CHART_PATCHES][2];
    struct homography h;
    for (int top = 0; top + rows <= SIDE; top++)
        for (int left = 0; left + columns <= SIDE; left++) {
            const int n = points_in(plane, pixel, g, left, top, columns, rows);
            if (n < least)
                continue;
            turn(plane, n, quarters);
            if (homography_fit(&h, (const double(*)[2])plane, (const double(*)[2])pixel, n)) {
                a->known |= a->seen(a->context, &h);
                a->asked++;
            }
        }
}

// A grid from three regions, and the windows in it that hold the most.
static void try_grid(struct asking *a, struct grid *g, int origin, int right, int down)
{
    const struct blob *o = &g->blob[origin], *r = &g->blob[right], *d = &g->blob[down];
    const double across[2] = {r->x - o->x, r->y - o->y}, along[2] = {d->x - o->x, d->y - o->y};
    const double la = hypot(across[0], across[1]), lb = hypot(along[0], along[1]);
    const double sine = (across[0] * along[1] - across[1] * along[0]) / (la * lb);
    if (!(sine > LEAST_SINE) || la > UNEVEN * lb || lb > UNEVEN * la)
        return;
    g->count = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            g->cell[y][x].blob = -1;
    put(g, REACH, REACH, origin, across, along);
    grow(g);
    if (g->count < LEAST_SEEN)
        return;
    int most = most_in_window(g, 0);
    const int turned = most_in_window(g, 1);
    most = turned > most ? turned : most;
    for (int quarters = 0; most >= LEAST_SEEN && quarters < 4; quarters++)
        ask(a, g, quarters, most - 1 > LEAST_SEEN ? most - 1 : LEAST_SEEN);
}

// Neighbours of a region, near first.
static int neighbours(int out[NEAREST], const struct blob *blob, int n, int of)
{
    double far[NEAREST];
    int count = 0;
    const double side = sqrt(blob[of].area);
    for (int i = 0; i < n; i++) {
        const double d = hypot(blob[i].x - blob[of].x, blob[i].y - blob[of].y);
        if (i == of || d < NEAR * side || d > FAR * side || !alike(&blob[i], &blob[of]))
            continue;
        int at = count < NEAREST ? count++ : NEAREST;
        for (; at > 0 && d < far[at - 1]; at--)
            if (at < NEAREST) {
                far[at] = far[at - 1];
                out[at] = out[at - 1];
            }
        if (at < NEAREST) {
            far[at] = d;
            out[at] = i;
        }
    }
    return count;
}

relume_status lattice_find(const struct blob *blob, int n,
                           bool (*seen)(void *context, const struct homography *h), void *context)
{
    struct asking a = {.seen = seen, .context = context};
    struct grid g = {.blob = blob, .n = n};
    bool *known = mem_zeroed((size_t)n, sizeof *known);  // part of a target that was seen
    if (!known)
        return RELUME_ENOMEM;
    for (int i = 0; i < n && a.asked < MOST_ASKED; i++) {
        int near[NEAREST];
        const int count = known[i] ? 0 : neighbours(near, blob, n, i);
        for (int k = 0; k < count * count && !known[i]; k++) {
            a.known = false;
            if (k / count != k % count)
                try_grid(&a, &g, i, near[k / count], near[k % count]);
            for (int j = 0; a.known && j < g.count; j++)
                known[g.cell[g.queue[j] / SIDE][g.queue[j] % SIDE].blob] = true;
        }
    }
    mem_free(known);
    return RELUME_OK;
}
