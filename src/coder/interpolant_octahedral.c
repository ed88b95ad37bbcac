// interpolant_octahedral.c - the lights are the nodes of a square grid onto which the octahedron
// maps the hemisphere; bilinear between them. Files of web viewers have such lights, captures do
// not.
#include "base/log.h"
#include "base/memory.h"
#include "coder/basis.h"
#include "coder/interpolant.h"

#include <string.h>

struct grid {
    int lights, side;
};

// parameter[0]: the side, default: the root of the number of lights.
static relume_status prepare(void **data, const struct relume_vec3 *lights, int n,
                             const double *parameter, const struct relume_log *log)
{
    (void)lights;
    *data = NULL;
    const double wanted = parameter[0] > 0.0 ? parameter[0] : sqrt(n);
    const int side = wanted < 1024.0 ? (int)lround(wanted) : 0;
    if (side < 2 || side * side != n)
        return log_fail(log, RELUME_EDATA,
                        "interpolant octahedral takes the nodes of a square grid; found %d lights",
                        n);
    struct grid *g = *data = mem_array(1, sizeof *g);
    if (!g)
        return RELUME_ENOMEM;
    *g = (struct grid){n, side};
    return RELUME_OK;
}

static void evaluate(const void *data, struct relume_vec3 light, double *weights)
{
    const struct grid *g = data;
    const int last = g->side - 1;
    const double sum = fabs(light.x) + fabs(light.y) + fabs(light.z);
    const double u = ((light.x + light.y) / sum + 1.0) / 2.0 * last;
    const double v = ((light.y - light.x) / sum + 1.0) / 2.0 * last;
    const int x = (int)fmin(fmax(floor(u), 0.0), last - 1);
    const int y = (int)fmin(fmax(floor(v), 0.0), last - 1);
    memset(weights, 0, (size_t)g->lights * sizeof *weights);
    double *at = weights + x + (size_t)y * (size_t)g->side;
    at[0] = (1.0 - (u - x)) * (1.0 - (v - y));
    at[1] = (u - x) * (1.0 - (v - y));
    at[g->side] = (1.0 - (u - x)) * (v - y);
    at[g->side + 1] = (u - x) * (v - y);
}

const struct relume_interpolant interpolant_octahedral = {
    .name = "octahedral",
    .summary = "bilinear in an octahedral grid, whose nodes the lights must be (imported files)",
    .prepare = prepare,
    .evaluate = evaluate,
    .release = free,
};
