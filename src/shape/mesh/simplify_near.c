// simplify_near.c - whether places lie near the original surface: its triangles in a grid of cells
//
// Cells are as large as places may be off, so that those around a place hold all that is near it;
// most often the first triangle that is looked at is near enough.
#include "shape/mesh/simplify.h"

#include <string.h>

struct box {
    int low[3], high[3];
};

static void coordinates(vec3 p, double out[3])
{
    out[0] = p.x, out[1] = p.y, out[2] = p.z;
}

// The cells within `radius` of points; of the grid only.
static struct box box_of(const struct near_grid *g, const vec3 *p, int n, double radius)
{
    struct box b;
    for (int c = 0; c < 3; c++) {
        double low = INFINITY, high = -INFINITY, at[3];
        for (int i = 0; i < n; i++) {
            coordinates(p[i], at);
            low = fmin(low, at[c]);
            high = fmax(high, at[c]);
        }
        const double most = g->across - 1;
        b.low[c] = (int)fmin(fmax(floor((low - radius + 0.5) / g->side), 0.0), most);
        b.high[c] = (int)fmin(fmax(floor((high + radius + 0.5) / g->side), 0.0), most);
    }
    return b;
}

static size_t cell_at(const struct near_grid *g, int x, int y, int z)
{
    return ((size_t)z * (size_t)g->across + (size_t)y) * (size_t)g->across + (size_t)x;
}

static void corners(const struct simplify *s, size_t triangle, vec3 p[3])
{
    for (int k = 0; k < 3; k++)
        p[k] = place(s, s->mesh->triangle[triangle][k]);
}

// Every cell that a triangle may go through, by its box and its plane: counted, or entered where
// there is memory already. The number of all.
static uint64_t enter(const struct simplify *s, struct near_grid *g)
{
    const double reach = 0.5 * sqrt(3.0) * g->side * (1.0 + 1e-9);
    uint64_t all = 0;
    for (size_t t = 0; t < s->mesh->triangle_count; t++) {
        vec3 p[3];
        corners(s, t, p);
        const struct box b = box_of(g, p, 3, 0.0);
        const vec3 across = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
        const double length = vec3_length(across);
        const vec3 normal = length > 0.0 ? vec3_scale(across, 1.0 / length) : across;
        for (int z = b.low[2]; z <= b.high[2]; z++)
            for (int y = b.low[1]; y <= b.high[1]; y++)
                for (int x = b.low[0]; x <= b.high[0]; x++) {
                    const vec3 middle =
                        vec3_of((x + 0.5) * g->side - 0.5, (y + 0.5) * g->side - 0.5,
                                (z + 0.5) * g->side - 0.5);
                    if (fabs(vec3_dot(vec3_sub(middle, p[0]), normal)) > reach)
                        continue;
                    uint32_t *end = &g->first[cell_at(g, x, y, z)];
                    if (g->triangle)
                        g->triangle[--*end] = (uint32_t)t;
                    else
                        ++*end;
                    all++;
                }
    }
    return all;
}

// Cells that hold not too much in all: twice as large as long as they do.
static relume_status count(const struct simplify *s, struct near_grid *g, size_t *all)
{
    const uint64_t most = (uint64_t)NEAR_REFERENCES * s->mesh->triangle_count + 4096;
    for (;; g->across = (g->across + 1) / 2) {
        const size_t cells = (size_t)g->across * (size_t)g->across * (size_t)g->across;
        g->side = 1.0 / g->across;
        g->first = mem_zeroed(cells + 1, sizeof *g->first);
        if (!g->first)
            return RELUME_ENOMEM;
        const uint64_t n = enter(s, g);
        *all = (size_t)n;
        if ((n <= most && n < UINT32_MAX) || g->across == 1)
            return RELUME_OK;
        mem_free(g->first);
    }
}

relume_status near_create(struct near_grid *g, const struct simplify *s, double radius)
{
    size_t all = 0;
    *g = (struct near_grid){.radius = radius};
    const double cells_most = (double)NEAR_CELLS * (double)s->mesh->triangle_count;
    g->across = (int)fmax(fmin(1.0 / radius, cbrt(cells_most)), 1.0);
    const relume_status status = count(s, g, &all);
    if (status)
        return status;
    const size_t cells = (size_t)g->across * (size_t)g->across * (size_t)g->across;
    for (size_t i = 1; i <= cells; i++)
        g->first[i] += g->first[i - 1];
    g->triangle = mem_array(all, sizeof *g->triangle);
    if (!g->triangle)
        return RELUME_ENOMEM;
    (void)enter(s, g);
    return RELUME_OK;
}

void near_free(struct near_grid *g)
{
    mem_free(g->first);
    mem_free(g->triangle);
    *g = (struct near_grid){0};
}

static bool is_near_in(const struct near_grid *g, const struct simplify *s, size_t cell, vec3 p)
{
    for (uint32_t i = g->first[cell]; i < g->first[cell + 1]; i++) {
        vec3 t[3], at;
        double w[3];
        corners(s, g->triangle[i], t);
        nearest_place(t, p, w);
        at = vec3_along(vec3_along(vec3_scale(t[0], w[0]), t[1], w[1]), t[2], w[2]);
        if (vec3_length(vec3_sub(at, p)) <= g->radius)
            return true;
    }
    return false;
}

bool near_is(const struct near_grid *g, const struct simplify *s, vec3 p)
{
    const struct box own = box_of(g, &p, 1, 0.0), b = box_of(g, &p, 1, g->radius);
    const size_t first = cell_at(g, own.low[0], own.low[1], own.low[2]);
    if (is_near_in(g, s, first, p))
        return true;
    for (int z = b.low[2]; z <= b.high[2]; z++)
        for (int y = b.low[1]; y <= b.high[1]; y++)
            for (int x = b.low[0]; x <= b.high[0]; x++)
                if (cell_at(g, x, y, z) != first && is_near_in(g, s, cell_at(g, x, y, z), p))
                    return true;
    return false;
}
