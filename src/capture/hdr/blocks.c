// blocks.c - the nodes of hierarchical macroblocks, level by level
#include "capture/hdr/blocks.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "core/math/lsq.h"

#include <math.h>

enum { LEAST_TRUSTED = 6 };

struct node *grid_node(const struct grid *grid, int column, int row)
{
    return &grid->node[(size_t)row * (size_t)grid->count + (size_t)column];
}

void grid_interpolate(const struct grid *grid, double x, double y, double d[2], double *score)
{
    const double u = (x - grid->origin[0]) / grid->side - 0.5;
    const double v = (y - grid->origin[1]) / grid->side - 0.5;
    const struct bilinear b = bilinear_at(u, v, grid->count, grid->count, EDGE_CLAMPED);
    d[0] = d[1] = *score = 0.0;
    for (int k = 0; k < 4; k++) {
        const struct node *n = &grid->node[b.at[k]];
        const double w = bilinear_share(&b, k, 1.0);
        d[0] += w * n->d[0];
        d[1] += w * n->d[1];
        *score += w * n->score;
    }
}

static void follow(const struct grid *g, int column, int row, struct node *node)
{
    double gram[9] = {0.0}, b[2][3] = {{0.0}};
    for (int j = 0; j < g->count; j++)
        for (int i = 0; i < g->count; i++) {
            const struct node *n = grid_node(g, i, j);
            const double x = i - column, y = j - row, q = 1.0 + 0.25 * (x * x + y * y);
            const double w = n->trusted ? 1.0 / (q * q) : 0.0, r[3] = {1.0, x, y};
            for (int k = 0; k < 3; k++) {
                b[0][k] += w * r[k] * n->d[0];
                b[1][k] += w * r[k] * n->d[1];
                for (int l = 0; l <= k; l++)
                    gram[3 * k + l] += w * r[k] * r[l];
            }
        }
    for (int k = 1; k < 3; k++)  // a small weight of level ground where all lie on one line
        gram[4 * k] += 1e-3 * gram[0];
    if (lsq_solve(gram, 3, b[0], 2)) {
        node->d[0] = b[0][0];
        node->d[1] = b[1][0];
    }
}

static void fill_row(void *context, size_t row, int worker)
{
    const struct grid *g = context;
    (void)worker;
    for (int column = 0; column < g->count; column++) {
        struct node *node = grid_node(g, column, (int)row);
        if (!node->trusted)
            follow(g, column, (int)row, node);
    }
}

void grid_fill(struct grid *grid, int threads)
{
    const size_t nodes = (size_t)grid->count * (size_t)grid->count;
    int trusted = 0;
    for (size_t i = 0; i < nodes; i++)
        trusted += grid->node[i].trusted;
    if (trusted >= LEAST_TRUSTED)
        thread_for(threads, (size_t)grid->count, fill_row, grid);
}

static double off(const double m[3][3], const double r[3], const struct node *n)
{
    return hypot(m[0][0] * r[0] + m[0][1] * r[1] + m[0][2] - r[0] - n->d[0],
                 m[1][0] * r[0] + m[1][1] * r[1] + m[1][2] - r[1] - n->d[1]);
}

// Least squares over the trusted, each weighted by how near the last map came to it.
bool grid_affine(double m[3][3], const struct grid *grid)
{
    enum { ROUNDS = 12 };
    const double near = 2.0;  // pixels
    double found[3][3] = {{0.0}};
    for (int round = 0; round < ROUNDS; round++) {
        double gram[9] = {0.0}, b[2][3] = {{0.0}}, total = 0.0;
        for (int i = 0; i < grid->count * grid->count; i++) {
            const struct node *n = &grid->node[i];
            const double r[3] = {grid->origin[0] + (i % grid->count + 0.5) * grid->side,
                                 grid->origin[1] + (i / grid->count + 0.5) * grid->side, 1.0};
            const double miss = round ? off((const double(*)[3])found, r, n) / near : 0.0;
            const double w = n->trusted ? 1.0 / (1.0 + miss * miss) : 0.0;
            total += w;
            for (int k = 0; k < 3; k++) {
                b[0][k] += w * r[k] * (r[0] + n->d[0]);
                b[1][k] += w * r[k] * (r[1] + n->d[1]);
                for (int l = 0; l <= k; l++)
                    gram[3 * k + l] += w * r[k] * r[l];
            }
        }
        if (total < LEAST_TRUSTED || !lsq_solve(gram, 3, b[0], 2))
            return false;
        for (int k = 0; k < 3; k++) {
            found[0][k] = b[0][k];
            found[1][k] = b[1][k];
        }
    }
    for (int k = 0; k < 6; k++)
        m[k / 3][k % 3] = found[k / 3][k % 3];
    return true;
}

static double median(double *v, int n)
{
    for (int i = 1; i < n; i++) {
        const double x = v[i];
        int at = i;
        for (; at > 0 && v[at - 1] > x; at--)
            v[at] = v[at - 1];
        v[at] = x;
    }
    return v[n / 2];
}

bool grid_median(struct grid *grid)
{
    const int n = grid->count;
    struct node *out = mem_copy(grid->node, (size_t)n * (size_t)n, sizeof *out);
    for (int i = 0; out && i < n * n; i++)
        for (int k = 0; k < 2; k++) {
            double v[9];
            for (int j = 0; j < 9; j++)
                v[j] = grid_node(grid, index_clamped(i % n + j % 3 - 1, n),
                                 index_clamped(i / n + j / 3 - 1, n))
                           ->d[k];
            out[i].d[k] = median(v, 9);
        }
    if (out) {
        mem_free(grid->node);
        grid->node = out;
    }
    return out != NULL;
}
