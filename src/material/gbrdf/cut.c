// cut.c - the least cut by the greatest flow (Dinic 1970) in a grid (Roy and Cox 1998)
//
// A column of nodes stands over each texel, one between two layers: from the source through layer
// after layer to the sink. An arc through a layer carries as much as the layer costs, one back is
// without limit, so that each column is cut once; arcs to the eight neighbours carry the cost of
// being of another layer. What cannot be reached when no more flows is beyond the cut.
//
// The thesis puts the factor of smoothness on the arcs through the layers and calls similarity
// their capacity; so the cut would go where pictures agree least.
#include "material/gbrdf/cut.h"

#include "core/base/memory.h"
#include "core/math/bilinear.h"

#include <string.h>

enum { DOWN, UP, ASIDE, ARCS = 10, ENDLESS = 1 << 30, PER_COST = 4096 };

static const int aside[8][2] = {{1, 0},  {0, 1},  {1, 1},   {-1, 1},
                                {-1, 0}, {0, -1}, {-1, -1}, {1, -1}};

struct graph {
    int width, height, nodes;  // nodes of a column
    size_t columns;
    int *arc;                // [column][node][ARCS]: what can still flow
    int *from_source;        // [column]: into node 0
    int *to_sink;            // [column]: out of the last node
    int *level;              // [column][node] of the last search, or -1
    unsigned char *current;  // the arc that is tried
    int *queue;              // of nodes; then the path
};

static int opposite(int arc)
{
    return arc < ASIDE ? 1 - arc : ASIDE + (arc - ASIDE + 4) % 8;
}

// The node that an arc leads to, or -1.
static int neighbour(const struct graph *g, int node, int arc)
{
    const int at = node % g->nodes, column = node / g->nodes;
    if (arc == DOWN)
        return at + 1 < g->nodes ? node + 1 : -1;
    if (arc == UP)
        return at ? node - 1 : -1;
    const int x = index_wrapped(column % g->width + aside[arc - ASIDE][0], g->width),
              y = index_wrapped(column / g->width + aside[arc - ASIDE][1], g->height);
    return (y * g->width + x) * g->nodes + at;
}

static int *capacity(const struct graph *g, int node, int arc)
{
    return &g->arc[(size_t)node * ARCS + (size_t)arc];
}

static int units(double cost)
{
    return (int)(PER_COST * fmin(fmax(cost, 0.0), 1000.0));
}

static void fill(struct graph *g, const float *cost, double smooth)
{
    for (size_t c = 0; c < g->columns; c++) {
        g->from_source[c] = units((double)cost[c]);
        g->to_sink[c] = units((double)cost[(size_t)g->nodes * g->columns + c]);
        for (int n = 0; n < g->nodes; n++) {
            const int node = (int)c * g->nodes + n;
            // node n lies between the layers n and n + 1
            const size_t above = (size_t)n * g->columns, below = above + g->columns;
            *capacity(g, node, DOWN) = n + 1 < g->nodes ? units((double)cost[below + c]) : 0;
            *capacity(g, node, UP) = n ? ENDLESS : 0;
            for (int k = ASIDE; k < ARCS; k++) {
                const size_t other = (size_t)(neighbour(g, node, k) / g->nodes);
                const double sum = (double)cost[above + c] + (double)cost[below + c] +
                                   (double)cost[above + other] + (double)cost[below + other];
                *capacity(g, node, k) = other == c ? 0 : units(0.25 * smooth * sum);
            }
        }
    }
}

// How far each node is from the source; whether the sink is reached.
static bool search(struct graph *g)
{
    const int all = (int)g->columns * g->nodes;
    int head = 0, tail = 0;
    bool reached = false;
    memset(g->level, 0xff, (size_t)all * sizeof *g->level);
    for (size_t c = 0; c < g->columns; c++)
        if (g->from_source[c] > 0) {
            g->level[c * (size_t)g->nodes] = 0;
            g->queue[tail++] = (int)c * g->nodes;
        }
    while (head < tail) {
        const int node = g->queue[head++];
        reached |= node % g->nodes == g->nodes - 1 && g->to_sink[node / g->nodes] > 0;
        for (int k = 0; k < ARCS; k++) {
            const int next = *capacity(g, node, k) > 0 ? neighbour(g, node, k) : -1;
            if (next >= 0 && g->level[next] < 0) {
                g->level[next] = g->level[node] + 1;
                g->queue[tail++] = next;
            }
        }
    }
    memset(g->current, 0, (size_t)all);
    return reached;
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

// Send along the path queue[0 .. length), whose arcs are the current ones; where it may go on from.
static int send(struct graph *g, int length)
{
    const int first = g->queue[0] / g->nodes, last = g->queue[length - 1] / g->nodes;
    int flow = least(g->from_source[first], g->to_sink[last]), keep = length;
    for (int i = 0; i + 1 < length; i++)
        flow = least(flow, *capacity(g, g->queue[i], g->current[g->queue[i]]));
    g->from_source[first] -= flow;
    g->to_sink[last] -= flow;
    for (int i = length - 2; i >= 0; i--) {
        const int node = g->queue[i], arc = g->current[node];
        const int next = neighbour(g, node, arc);
        int *there = capacity(g, node, arc), *back = capacity(g, next, opposite(arc));
        *there -= *there < ENDLESS / 2 ? flow : 0;
        *back += *back < ENDLESS / 2 ? flow : 0;
        if (*there == 0)
            keep = i + 1;
    }
    return g->from_source[first] == 0 ? 0 : keep;
}

// All paths of one search from one column on.
static void augment(struct graph *g, size_t column)
{
    int length = 1;
    g->queue[0] = (int)column * g->nodes;
    while (length && g->from_source[column] > 0) {
        const int node = g->queue[length - 1];
        if (node % g->nodes == g->nodes - 1 && g->to_sink[node / g->nodes] > 0) {
            length = send(g, length);
            continue;
        }
        int next = -1;
        for (; g->current[node] < ARCS; g->current[node]++) {
            const int to = *capacity(g, node, g->current[node]) > 0
                               ? neighbour(g, node, g->current[node])
                               : -1;
            if (to >= 0 && g->level[to] == g->level[node] + 1) {
                next = to;
                break;
            }
        }
        if (next >= 0)
            g->queue[length++] = next;
        else if (--length)
            g->current[g->queue[length - 1]]++;
    }
}

relume_status cut_volume(int *label, const float *cost, int width, int height, int layers,
                         double smooth)
{
    struct graph g = {width, height, layers - 1, (size_t)width * (size_t)height, NULL, NULL, NULL,
                      NULL,  NULL,   NULL};
    const size_t all = g.columns * (size_t)g.nodes;
    g.arc = mem_array(all, ARCS * sizeof *g.arc);
    g.from_source = mem_array(g.columns, sizeof *g.from_source);
    g.to_sink = mem_array(g.columns, sizeof *g.to_sink);
    g.level = mem_array(all, sizeof *g.level);
    g.current = mem_array(all, 1);
    g.queue = mem_array(all, sizeof *g.queue);
    const bool good = g.arc && g.from_source && g.to_sink && g.level && g.current && g.queue;
    if (good) {
        fill(&g, cost, smooth);
        while (search(&g))
            for (size_t c = 0; c < g.columns; c++)
                augment(&g, c);
        for (size_t c = 0; c < g.columns; c++) {
            label[c] = 0;
            while (label[c] < g.nodes && g.level[c * (size_t)g.nodes + (size_t)label[c]] >= 0)
                label[c]++;
        }
    }
    mem_free(g.arc);
    mem_free(g.from_source);
    mem_free(g.to_sink);
    mem_free(g.level);
    mem_free(g.current);
    mem_free(g.queue);
    return good ? RELUME_OK : RELUME_ENOMEM;
}
