// cut.c - maximum flow on a grid (Dinitz 1970): the minimum cut is what the last flow fills
#include "material/synthesis/cut.h"

#include "core/base/memory.h"

enum { LEFT, RIGHT, UP, DOWN, WAYS, NO_LEVEL = -1 };

struct grid {
    int width, height, cells;
    const unsigned char *side;
    int *rest[WAYS];  // what may still flow from a cell that way
    int *level;       // steps from the sources
    int *queue, *path;
    unsigned char *way;  // the next way to try
};

static int neighbour(const struct grid *g, int cell, int way)
{
    const int x = cell % g->width, y = cell / g->width;
    switch (way) {
    case LEFT: return x > 0 ? cell - 1 : -1;
    case RIGHT: return x + 1 < g->width ? cell + 1 : -1;
    case UP: return y > 0 ? cell - g->width : -1;
    default: return y + 1 < g->height ? cell + g->width : -1;
    }
}

// Distances from all cells that are new; whether one that is old was reached.
static bool find_levels(struct grid *g)
{
    int head = 0, tail = 0;
    bool reached = false;
    for (int i = 0; i < g->cells; i++) {
        g->level[i] = g->side[i] == CUT_NEW ? 0 : NO_LEVEL;
        g->way[i] = 0;
        if (g->side[i] == CUT_NEW)
            g->queue[tail++] = i;
    }
    while (head < tail) {
        const int cell = g->queue[head++];
        reached |= g->side[cell] == CUT_OLD;
        for (int way = 0; way < WAYS; way++) {
            const int to = g->rest[way][cell] > 0 ? neighbour(g, cell, way) : -1;
            if (to >= 0 && g->level[to] == NO_LEVEL) {
                g->level[to] = g->level[cell] + 1;
                g->queue[tail++] = to;
            }
        }
    }
    return reached;
}

// Along ways that lead one level on; the length of the path to an old cell, or 0.
static int find_path(struct grid *g, int from)
{
    int length = 0, cell = from;
    while (g->side[cell] != CUT_OLD) {
        int to = -1;
        for (; g->way[cell] < WAYS; g->way[cell]++) {
            to = g->rest[g->way[cell]][cell] > 0 ? neighbour(g, cell, g->way[cell]) : -1;
            if (to >= 0 && g->level[to] == g->level[cell] + 1)
                break;
            to = -1;
        }
        if (to >= 0) {
            g->path[length++] = cell;
            cell = to;
        } else if (length == 0) {
            return 0;
        } else {  // a dead end
            cell = g->path[--length];
            g->way[cell]++;
        }
    }
    return length;
}

static void send(struct grid *g, int length)
{
    int most = g->rest[g->way[g->path[0]]][g->path[0]];
    for (int i = 1; i < length; i++) {
        const int rest = g->rest[g->way[g->path[i]]][g->path[i]];
        most = rest < most ? rest : most;
    }
    for (int i = 0; i < length; i++) {
        const int way = g->way[g->path[i]], to = neighbour(g, g->path[i], way);
        g->rest[way][g->path[i]] -= most;
        g->rest[way ^ 1][to] += most;
    }
}

static bool alloc(struct grid *g)
{
    const size_t n = (size_t)g->cells;
    bool good = true;
    for (int way = 0; way < WAYS; way++)
        good &= (g->rest[way] = mem_zeroed(n, sizeof(int))) != NULL;
    g->level = mem_array(n, sizeof *g->level);
    g->queue = mem_array(n, sizeof *g->queue);
    g->path = mem_array(n, sizeof *g->path);
    g->way = mem_array(n, sizeof *g->way);
    return good && g->level && g->queue && g->path && g->way;
}

static void release(struct grid *g)
{
    for (int way = 0; way < WAYS; way++)
        mem_free(g->rest[way]);
    mem_free(g->level);
    mem_free(g->queue);
    mem_free(g->path);
    mem_free(g->way);
}

static void fill(struct grid *g, const int *right, const int *down)
{
    for (int i = 0; i < g->cells; i++) {
        if (neighbour(g, i, RIGHT) >= 0)
            g->rest[RIGHT][i] = g->rest[LEFT][i + 1] = right[i];
        if (neighbour(g, i, DOWN) >= 0)
            g->rest[DOWN][i] = g->rest[UP][i + g->width] = down[i];
    }
}

relume_status cut_grid(unsigned char *side, int width, int height, const int *right,
                       const int *down)
{
    struct grid g = {.width = width, .height = height, .cells = width * height, .side = side};
    const bool good = alloc(&g);
    if (good)
        fill(&g, right, down);
    while (good && find_levels(&g))
        for (int i = 0; i < g.cells; i++)
            for (int n = side[i] == CUT_NEW ? find_path(&g, i) : 0; n; n = find_path(&g, i))
                send(&g, n);
    for (int i = 0; good && i < g.cells; i++)
        side[i] = g.level[i] == NO_LEVEL ? CUT_OLD : CUT_NEW;
    release(&g);
    return good ? RELUME_OK : RELUME_ENOMEM;
}
