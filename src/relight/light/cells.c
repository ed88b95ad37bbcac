// cells.c - which cells of a grid are divided, since what the grid holds bends inside them
//
// A cell is divided into four when bilinear interpolation misses the function by more than the
// tolerance in the middle of the cell or of one of its sides; so are its parts. From the cells
// where the function may bend most the search goes on to the neighbours of those that were divided.
#include "relight/light/cells.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

#include <math.h>
#include <string.h>

enum { SIDE = 3, NODES = SIDE * SIDE, DEEPEST = 6, AT_ONCE = 256 };
// What a cusp misses by falls with the distance from it: so many tolerances have reached a
// neighbour.
static const double SPREADS = 2.0;

// A cell to look at: of the grid, or the part of a tile.
struct look {
    struct cell cell;
    int tile, part;  // -1: cell `part` of the grid
};

struct search {
    const struct cells_params *p;
    struct cells *cells;
    struct look *queue;  // [queued], used from `next` on
    size_t next, queued;
    bool *seen;    // cells of the grid
    double *work;  // [AT_ONCE][NODES][values]
    double off[AT_ONCE];
};

// ---------------------------------------------------------------- does it bend

// The largest sum of misses of one sign.
static double missed(const double *at, const double *const *around, int n, int values)
{
    double above = 0.0, below = 0.0;
    for (int v = 0; v < values; v++) {
        double mean = 0.0;
        for (int i = 0; i < n; i++)
            mean += around[i][v] / n;
        const double off = at[v] - mean;
        *(off > 0.0 ? &above : &below) += fabs(off);
    }
    return fmax(above, below);
}

// A tile's own nodes are the corners of its cells.
static void evaluate_nodes(double *value, const struct search *s, const struct look *look)
{
    const struct cells_params *p = s->p;
    const struct cell *c = &look->cell;
    const size_t values = (size_t)p->values;
    for (int i = 0; i < NODES; i++) {
        const int y = i / SIDE, x = i % SIDE;
        const size_t corner = (size_t)((look->part / 2 + y / 2) * SIDE + look->part % 2 + x / 2);
        if (look->tile >= 0 && x != 1 && y != 1)
            memcpy(value + (size_t)i * values,
                   s->cells->value + ((size_t)look->tile * NODES + corner) * values,
                   values * sizeof *value);
        else
            p->evaluate(p->context, c->row + 0.5 * c->size * y, c->column + 0.5 * c->size * x,
                        value + (size_t)i * values);
    }
}

static void look_at(void *context, size_t item, int worker)
{
    (void)worker;
    struct search *s = context;
    const struct cells_params *p = s->p;
    double *value = s->work + item * NODES * (size_t)p->values;
    const double *node[NODES];
    evaluate_nodes(value, s, &s->queue[s->next + item]);
    for (int i = 0; i < NODES; i++)
        node[i] = value + (size_t)i * (size_t)p->values;
    static const struct {
        int at, n, around[4];
    } tests[] = {
        {4, 4, {0, 2, 6, 8}}, {1, 2, {0, 2}}, {3, 2, {0, 6}}, {5, 2, {2, 8}}, {7, 2, {6, 8}}};
    s->off[item] = 0.0;
    for (size_t t = 0; t < sizeof tests / sizeof *tests; t++) {
        const double *around[4];
        for (int i = 0; i < tests[t].n; i++)
            around[i] = node[tests[t].around[i]];
        s->off[item] = fmax(s->off[item], missed(node[tests[t].at], around, tests[t].n, p->values));
    }
}

// ---------------------------------------------------------------- the search

static relume_status ask(struct search *s, struct look look)
{
    if (!mem_grow(&s->queue, s->queued, sizeof *s->queue))
        return RELUME_ENOMEM;
    s->queue[s->queued++] = look;
    return RELUME_OK;
}

static relume_status ask_grid(struct search *s, int row, int column)
{
    const int across = s->p->columns - 1;
    column = (column + across) % across;
    if (row < 0 || row >= s->p->rows - 1 || s->seen[row * across + column])
        return RELUME_OK;
    s->seen[row * across + column] = true;
    return ask(s, (struct look){{row, column, 1.0}, -1, row * across + column});
}

static relume_status ask_neighbours(struct search *s, int cell)
{
    const int across = s->p->columns - 1;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < NODES; i++) {
        const int down = i / SIDE - 1, row = cell / across + down;
        status = ask_grid(s, row == s->p->seam ? row + down : row, cell % across + i % SIDE - 1);
    }
    return status;
}

static relume_status divide(struct search *s, struct look look, size_t item)
{
    const double *value = s->work + item * NODES * (size_t)s->p->values;
    struct cells *c = s->cells;
    const size_t values = NODES * (size_t)s->p->values;
    if (!mem_grow(&c->tile, (size_t)c->count, sizeof *c->tile) ||
        !mem_grow(&c->child, (size_t)c->count, sizeof *c->child) ||
        !mem_grow(&c->value, (size_t)c->count, values * sizeof *c->value))
        return RELUME_ENOMEM;
    const int tile = c->count++;
    c->tile[tile] = look.cell;
    memcpy(c->value + (size_t)tile * values, value, values * sizeof *value);
    memset(c->child[tile], -1, sizeof c->child[tile]);
    *(look.tile < 0 ? &c->of[look.part] : &c->child[look.tile][look.part]) = tile;
    relume_status status = RELUME_OK;
    if (look.tile < 0 && s->off[item] > SPREADS * s->p->tolerance)
        status = ask_neighbours(s, look.part);
    const double half = 0.5 * look.cell.size;
    for (int i = 0; !status && i < 4 && half > ldexp(1.0, -DEEPEST); i++)
        status = ask(s, (struct look){{look.cell.row + half * (i / 2),
                                       look.cell.column + half * (i % 2), half},
                                      tile,
                                      i});
    return status;
}

static relume_status search(struct search *s)
{
    relume_status status = RELUME_OK;
    while (!status && s->next < s->queued && s->cells->count < s->p->most) {
        const size_t left = s->queued - s->next, n = left < AT_ONCE ? left : AT_ONCE;
        thread_for(s->p->threads, n, look_at, s);
        for (size_t i = 0; !status && i < n; i++)
            if (s->off[i] > s->p->tolerance && s->cells->count < s->p->most)
                status = divide(s, s->queue[s->next + i], i);
        s->next += n;
    }
    return status;
}

relume_status cells_create(struct cells *out, const struct cells_params *params)
{
    const size_t cells = (size_t)(params->rows - 1) * (size_t)(params->columns - 1);
    *out = (struct cells){.of = mem_array(cells, sizeof *out->of)};
    struct search s = {.p = params, .cells = out, .seen = mem_zeroed(cells, sizeof *s.seen)};
    s.work = mem_array(AT_ONCE * NODES * (size_t)params->values, sizeof *s.work);
    relume_status status = out->of && s.seen && s.work ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        memset(out->of, -1, cells * sizeof *out->of);
    for (int i = 0; !status && i < params->starts; i++)
        status = ask_grid(&s, params->start[i][0], params->start[i][1]);
    if (!status)
        status = search(&s);
    mem_free(s.queue);
    mem_free(s.seen);
    mem_free(s.work);
    if (status)
        cells_destroy(out);
    return status;
}

void cells_destroy(struct cells *cells)
{
    mem_free(cells->tile);
    mem_free(cells->child);
    mem_free(cells->of);
    mem_free(cells->value);
    *cells = (struct cells){0};
}

int cells_find(const struct cells *cells, int columns, int *row, int *column, double *x, double *y)
{
    int tile = -1;
    for (int in = cells->of[*row * (columns - 1) + *column]; in >= 0;) {
        tile = in;
        *column = *x >= 0.5;
        *row = *y >= 0.5;
        *x = 2.0 * *x - *column;
        *y = 2.0 * *y - *row;
        in = cells->child[tile][2 * *row + *column];
    }
    return tile;
}
