// interpolant_natural.c - natural neighbours: a light weighs by what the query takes from its
// Voronoi cell (Sibson 1981), integrated over points s of the sphere (Park et al. 2006). Where
// Sibson counts area, max(s.d - s.l, 0) is summed, l being the nearest light: the weights are then
// smooth in the number of points, and differentiable in d (Hiyoshi and Sugihara 2000).
#include "core/base/memory.h"
#include "format/coder/basis.h"
#include "format/coder/interpolant.h"

#include <string.h>

enum { POINTS = 8192 };

struct cells {
    int lights;
    vec3 *light;
    double x[POINTS], y[POINTS], z[POINTS];
    int owner[POINTS];
    double nearest[POINTS];  // cosine of the angle to the owner
};

static void release(void *data)
{
    struct cells *c = data;
    mem_free(c->light);
    mem_free(c);
}

static int nearest_light(const struct cells *c, vec3 d)
{
    int best = 0;
    for (int i = 1; i < c->lights; i++)
        if (vec3_dot(d, c->light[i]) > vec3_dot(d, c->light[best]))
            best = i;
    return best;
}

static relume_status prepare(void **data, const struct relume_vec3 *lights, int n,
                             const double *parameter, const struct relume_log *log)
{
    (void)parameter;
    (void)log;
    struct cells *c = *data = mem_zeroed(1, sizeof *c);
    if (!c)
        return RELUME_ENOMEM;
    c->lights = n;
    c->light = mem_copy(lights, (size_t)n, sizeof *lights);
    if (!c->light) {
        release(c);
        *data = NULL;
        return RELUME_ENOMEM;
    }
    for (int i = 0; i < POINTS; i++) {
        const double z = 1.0 - (2.0 * i + 1.0) / POINTS, r = sqrt(1.0 - z * z);
        const double phi = i * (M_PI * (3.0 - sqrt(5.0)));
        const vec3 point = vec3_of(r * cos(phi), r * sin(phi), z);
        c->x[i] = point.x;
        c->y[i] = point.y;
        c->z[i] = point.z;
        c->owner[i] = nearest_light(c, point);
        c->nearest[i] = vec3_dot(point, c->light[c->owner[i]]);
    }
    return RELUME_OK;
}

static void evaluate(const void *data, struct relume_vec3 light, double *weights)
{
    const struct cells *c = data;
    enum { RUN = 256 };  // gains are found side by side
    double sum = 0.0, gain[RUN];
    memset(weights, 0, (size_t)c->lights * sizeof *weights);
    for (int first = 0; first < POINTS; first += RUN) {
        const double *x = c->x + first, *y = c->y + first, *z = c->z + first;
        for (int i = 0; i < RUN; i++)
            gain[i] = x[i] * light.x + y[i] * light.y + z[i] * light.z - c->nearest[first + i];
        for (int i = 0; i < RUN; i++)
            if (gain[i] > 0.0) {
                weights[c->owner[first + i]] += gain[i];
                sum += gain[i];
            }
    }
    if (sum < 1e-9) {  // on a light
        weights[nearest_light(c, light)] = 1.0;
        return;
    }
    for (int i = 0; i < c->lights; i++)
        weights[i] /= sum;
}

const struct relume_interpolant interpolant_natural = {
    .name = "natural",
    .summary = "natural neighbours; smooth, never leaves the range of the captured values",
    .prepare = prepare,
    .evaluate = evaluate,
    .release = release,
};
