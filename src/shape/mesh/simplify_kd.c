// simplify_kd.c - cells of a kd tree over the middles of some of the triangles (Bentley 1975)
#include "shape/mesh/simplify_kd.h"

#include <math.h>

enum { LOOKED_AT = 65536, MOST_CELLS = 65536 };

struct cutting {
    struct kd *cells;
    double (*middle)[3];
    size_t most;  // of the middles, in a cell
    double share;
    bool failed;
};

static void middle_of(const struct simplify *s, const uint32_t t[3], double out[3])
{
    const vec3 sum = vec3_add(vec3_add(place(s, t[0]), place(s, t[1])), place(s, t[2]));
    out[0] = sum.x, out[1] = sum.y, out[2] = sum.z;
}

static int by_axis(const void *a, const void *b, int axis)
{
    const double x = ((const double *)a)[axis], y = ((const double *)b)[axis];
    return x < y ? -1 : x > y;
}
static int by_x(const void *a, const void *b)
{
    return by_axis(a, b, 0);
}
static int by_y(const void *a, const void *b)
{
    return by_axis(a, b, 1);
}
static int by_z(const void *a, const void *b)
{
    return by_axis(a, b, 2);
}

static int longest_axis(double (*p)[3], size_t n)
{
    double longest = -1.0;
    int axis = 0;
    for (int c = 0; c < 3; c++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < n; i++) {
            low = fmin(low, p[i][c]);
            high = fmax(high, p[i][c]);
        }
        if (high - low > longest) {
            longest = high - low;
            axis = c;
        }
    }
    return axis;
}

// What to write as `next` of the node above: cells of n middles.
static int cut(struct cutting *c, double (*p)[3], size_t n)
{
    static int (*const by[3])(const void *, const void *) = {by_x, by_y, by_z};
    const int axis = n > c->most ? longest_axis(p, n) : 0, at = c->cells->nodes;
    size_t below = n;
    if (n > c->most && c->cells->count + c->cells->nodes < MOST_CELLS) {
        qsort(p, n, sizeof *p, by[axis]);
        below = (size_t)(c->share * (double)n);
        while (below < n && p[below][axis] <= p[0][axis])
            below++;
    }
    if (below == n)
        return ~c->cells->count++;
    if (!mem_grow(&c->cells->node, (size_t)at, sizeof *c->cells->node)) {
        c->failed = true;
        return ~0;
    }
    c->cells->nodes++;
    c->cells->node[at] = (struct kd_node){.axis = axis, .cut = p[below][axis]};
    while (below > 1 && p[below - 1][axis] >= p[below][axis])
        below--;
    const int low = cut(c, p, below), high = cut(c, p + below, n - below);
    if (!c->failed) {
        c->cells->node[at].next[0] = low;
        c->cells->node[at].next[1] = high;
    }
    return at;
}

relume_status kd_create(struct kd *out, const struct simplify *s, size_t most, double share)
{
    const size_t triangles = s->mesh->triangle_count;
    const size_t step = triangles > LOOKED_AT ? triangles / LOOKED_AT : 1, n = triangles / step;
    *out = (struct kd){0};
    struct cutting c = {.cells = out,
                        .middle = mem_array(n, sizeof *c.middle),
                        .most = most / step > 1 ? most / step : 1,
                        .share = share};
    if (!c.middle)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++)
        middle_of(s, s->mesh->triangle[i * step], c.middle[i]);
    (void)cut(&c, c.middle, n);
    mem_free(c.middle);
    return c.failed ? RELUME_ENOMEM : RELUME_OK;
}

void kd_free(struct kd *c)
{
    mem_free(c->node);
    *c = (struct kd){0};
}

int kd_find(const struct kd *c, const struct simplify *s, const uint32_t triangle[3])
{
    double p[3];
    int at = 0;
    if (!c->nodes)
        return 0;
    middle_of(s, triangle, p);
    while (at >= 0) {
        const struct kd_node *node = &c->node[at];
        at = node->next[p[node->axis] >= node->cut];
    }
    return ~at;
}
