// interpolant_octahedral.c - the lights are the nodes of a square grid onto which the octahedron
// maps the hemisphere; bilinear between them. Files of web viewers have such lights, captures do
// not.
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/bilinear.h"
#include "format/coder/basis.h"
#include "format/coder/interpolant.h"

#include <string.h>

struct grid {
    int lights, side;
};

// Where a direction lies in the grid, in nodes.
static void place_direction(const struct grid *g, vec3 d, double *u, double *v)
{
    const double sum = fabs(d.x) + fabs(d.y) + fabs(d.z);
    *u = ((d.x + d.y) / sum + 1.0) / 2.0 * (g->side - 1);
    *v = ((d.y - d.x) / sum + 1.0) / 2.0 * (g->side - 1);
}

static bool holds(const struct grid *g, const struct relume_vec3 *lights)
{
    static const double near = 0.05;
    bool all = true;
    for (int i = 0; i < g->lights; i++) {
        double u, v;
        place_direction(g, lights[i], &u, &v);
        all &= fabs(u - i % g->side) < near && fabs(v - i / g->side) < near;
    }
    return all;
}

// parameter[0]: the side, default: the root of the number of lights.
static relume_status prepare(void **data, const struct relume_vec3 *lights, int n,
                             const double *parameter, const struct relume_log *log)
{
    *data = NULL;
    const double wanted = parameter[0] > 0.0 ? parameter[0] : sqrt(n);
    const struct grid grid = {n, wanted < 1024.0 ? (int)lround(wanted) : 0};
    if (grid.side < 2 || grid.side * grid.side != n || !holds(&grid, lights))
        return log_fail(log, RELUME_EUNFIT,
                        "interpolant octahedral needs lights exactly on the nodes of its grid; "
                        "found %d elsewhere",
                        n);
    *data = mem_copy(&grid, 1, sizeof grid);
    return *data ? RELUME_OK : RELUME_ENOMEM;
}

static void evaluate(const void *data, struct relume_vec3 light, double *weights)
{
    const struct grid *g = data;
    double u, v;
    place_direction(g, light, &u, &v);
    memset(weights, 0, (size_t)g->lights * sizeof *weights);
    bilinear_spread(weights, g->side, u, v);
}

const struct relume_interpolant interpolant_octahedral = {
    .name = "octahedral",
    .summary = "bilinear in an octahedral grid, whose nodes the lights must be (imported files)",
    .prepare = prepare,
    .evaluate = evaluate,
    .release = mem_free,
};
