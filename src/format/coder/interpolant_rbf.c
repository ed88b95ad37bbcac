// interpolant_rbf.c - normalised Gaussians: exp(-|l - l_i|^2 / sigma^2); smooths, never overshoots
#include "core/base/memory.h"
#include "format/coder/basis.h"
#include "format/coder/interpolant.h"

struct gaussians {
    int lights;
    double sigma;
    vec3 *light;
};

// Smaller weights are dropped, as the files of web viewers expect; with many lights all are small.
static const double LEAST = 0.001;
enum { MANY = 200 };

static void release(void *data)
{
    struct gaussians *g = data;
    mem_free(g->light);
    mem_free(g);
}

double interpolant_spacing(const struct relume_vec3 *lights, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++) {
        double nearest = 2.0;
        for (int j = 0; j < n; j++) {
            const double d = vec3_length(vec3_sub(lights[i], lights[j]));
            nearest = j != i && d > 1e-6 && d < nearest ? d : nearest;
        }
        sum += nearest;
    }
    return sum / n;
}

// parameter[0]: sigma, default: the spacing of the lights.
static relume_status prepare(void **data, const struct relume_vec3 *lights, int n,
                             const double *parameter, const struct relume_log *log)
{
    (void)log;
    struct gaussians *g = *data = mem_zeroed(1, sizeof *g);
    if (!g)
        return RELUME_ENOMEM;
    *g = (struct gaussians){
        .lights = n,
        .sigma = parameter[0] > 0.0 ? parameter[0] : interpolant_spacing(lights, n),
        .light = mem_copy(lights, (size_t)n, sizeof *lights),
    };
    if (g->light)
        return RELUME_OK;
    release(g);
    *data = NULL;
    return RELUME_ENOMEM;
}

static void normalise(double *weights, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += weights[i];
    for (int i = 0; i < n; i++)
        weights[i] /= sum;
}

static void evaluate(const void *data, struct relume_vec3 light, double *weights)
{
    const struct gaussians *g = data;
    double nearest = 4.0;  // exponents are taken relative to the nearest light: no underflow to 0
    for (int i = 0; i < g->lights; i++) {
        const vec3 d = vec3_sub(light, g->light[i]);
        weights[i] = vec3_dot(d, d);
        nearest = fmin(nearest, weights[i]);
    }
    for (int i = 0; i < g->lights; i++)
        weights[i] = exp((nearest - weights[i]) / (g->sigma * g->sigma));
    normalise(weights, g->lights);
    if (g->lights > MANY)
        return;
    for (int i = 0; i < g->lights; i++)
        weights[i] = weights[i] > LEAST ? weights[i] : 0.0;
    normalise(weights, g->lights);
}

const struct relume_interpolant interpolant_rbf = {
    .name = "rbf",
    .summary = "normalised Gaussians around the lights; smooths, never overshoots",
    .prepare = prepare,
    .evaluate = evaluate,
    .release = release,
};
