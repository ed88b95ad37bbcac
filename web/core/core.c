// core.c - what the page of a published file computes by the library itself: weights for a
// direction, and the lights that stand for an environment
//
// It is compiled to WebAssembly (make web) and, for tests, natively. A page calls it by numbers and
// addresses alone; nothing here outlives its handle. In the joint form that pages have (web/README)
// with F raw functions f(l) of the light
//     value_c(l) = mean_c . f(l) + sum_k C_k T_{c,k} . f(l)
// so that f is asked of a coder without functions of its own, and T and mean are applied here.
#include "core.h"

#include <relume/format/coder.h>
#include <relume/light.h>

#include "core/base/memory.h"
#include "format/coder/coding.h"
#include "relight/light/environment.h"
#include "relight/light/grid.h"
#include "relight/light/refit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define EXPORT __attribute__((visibility("default"), used))

// One open file.
struct core {
    relume_coder *coder;
    int functions, planes;  // F, K
    float *turned;          // [3][K + 1][F]: T, then the mean
    float *raw;             // [3][F], what the coder answers
    double from[3];         // the direction that was asked for last, as the coder takes it
};

// Memory for the page to write into.
EXPORT void *core_allocate(int bytes)
{
    return malloc((size_t)bytes);
}

EXPORT void core_free(void *memory)
{
    free(memory);
}

EXPORT void core_close(struct core *core)
{
    if (!core)
        return;
    relume_coder_destroy(&core->coder);
    mem_free(core->turned);
    mem_free(core->raw);
    mem_free(core);
}

static struct relume_vec3 *read_lights(const double *xyz, int n)
{
    struct relume_vec3 *lights = n > 0 ? mem_array((size_t)n, sizeof *lights) : NULL;
    for (int i = 0; lights && i < n; i++)
        lights[i] = (struct relume_vec3){xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
    return lights;
}

static bool open_coder(struct core *core, const struct relume_basis *basis,
                       const struct relume_vec3 *lights, int n, const struct relume_coder_params *p)
{
    if (!basis || basis->joint || relume_coder_create(&core->coder, basis, lights, n, p))
        return false;
    core->functions = relume_coder_info(core->coder)->functions;
    core->raw = mem_zeroed(3 * (size_t)core->functions, sizeof *core->raw);
    return core->raw != NULL;
}

// A basis and its interpolant by their names, or no name; `parameter[4]`, lights[3 n]. 0 when there
// is no such basis, or no memory.
EXPORT struct core *core_open(const char *basis, const char *interpolant, const double *parameter,
                              int coefficients, int hemispherical, int pole_y, const double *xyz,
                              int n)
{
    struct relume_coder_params p = {
        .coefficients = coefficients,
        .hemispherical = hemispherical,
        .pole_y = pole_y,
        .interpolant = relume_interpolant_find(interpolant),
        .decode = true,
        .force = true,
    };
    memcpy(p.parameter, parameter, sizeof p.parameter);
    struct relume_vec3 *lights = read_lights(xyz, n);
    struct core *core = mem_zeroed(1, sizeof *core);
    if (!lights || !core || !open_coder(core, relume_basis_find(basis), lights, n, &p)) {
        core_close(core);
        core = NULL;
    }
    mem_free(lights);
    return core;
}

EXPORT int core_functions(const struct core *core)
{
    return core->functions;
}

// transform[3][K][F], mean[3][F]. 0 without memory.
EXPORT int core_turn(struct core *core, const float *transform, const float *mean, int planes)
{
    const size_t f = (size_t)core->functions, k = (size_t)planes;
    mem_free(core->turned);
    core->turned = mem_array(3 * (k + 1) * f, sizeof *core->turned);
    core->planes = planes;
    for (size_t c = 0; core->turned && c < 3; c++) {
        float *to = core->turned + c * (k + 1) * f;
        memcpy(to, transform + c * k * f, k * f * sizeof *to);
        memcpy(to + k * f, mean + c * f, f * sizeof *to);
    }
    return core->turned != NULL;
}

static double dot(const float *a, const float *b, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += (double)a[i] * (double)b[i];
    return sum;
}

// out[3][K + 1]: the weights of the planes, then the constant, for light from (x, y, z), of any
// length but 0. Returns the share of the light that is shown (relume_coder_clamp).
EXPORT double core_weights(struct core *core, double x, double y, double z, float *out)
{
    const double length = sqrt(x * x + y * y + z * z);
    struct relume_vec3 from;
    const double share = relume_coder_clamp(
        &from, core->coder, (struct relume_vec3){x / length, y / length, z / length});
    float constant[3];
    memcpy(core->from, (double[3]){from.x, from.y, from.z}, sizeof core->from);
    relume_coder_weights(core->coder, from, core->raw, constant);
    for (int i = 0; i < 3 * (core->planes + 1); i++)
        out[i] = (float)dot(core->turned + (size_t)i * (size_t)core->functions, core->raw,
                            core->functions);
    return share;
}

// x, y, z.
EXPORT const double *core_from(const struct core *core)
{
    return core->from;
}

// The triangles of captured lights whose pictures a table interpolates, at most `most`: of each the
// nodes, -1 for none, and relume_weight_triangle.inverse, out[12 n]. -1 without memory.
EXPORT int core_triangles(const struct core *core, float *out, int most)
{
    relume_weight_grid *grid = NULL;
    if (relume_weight_grid_create(&grid, core->coder, NULL))
        return -1;
    const struct relume_weight_grid_info *info = relume_weight_grid_info(grid);
    const int n = info->triangles < most ? info->triangles : most;
    for (int t = 0; t < n; t++, out += 12) {
        for (int i = 0; i < 3; i++)
            out[i] = (float)info->triangle[t].node[i];
        memcpy(out + 3, info->triangle[t].inverse, sizeof info->triangle[t].inverse);
    }
    relume_weight_grid_destroy(&grid);
    return n;
}

// The captured lights, at most as many as core_open had, that stand for an environment: out[6 n],
// direction and colour. `rgb` is a lat-long map. -1 without memory.
EXPORT int core_environment(const struct core *core, float *rgb, int width, int height,
                            double rotate_deg, double *out)
{
    const struct relume_image map = {width, height, 3, .data = rgb};
    struct relume_light light = {
        .kind = RELUME_LIGHT_ENVIRONMENT, .rotate_deg = rotate_deg, .rgb = {1.0f, 1.0f, 1.0f}};
    relume_environment *environment = NULL;
    int count = 0;
    struct relume_light *lights =
        mem_zeroed((size_t)relume_coder_info(core->coder)->lights, sizeof *lights);
    relume_status status =
        lights ? relume_environment_create(&environment, &map, NULL) : RELUME_ENOMEM;
    light.environment = environment;
    if (!status)
        status = environment_on_lights(lights, &count, core->coder, &light, 1);
    for (int i = 0; !status && i < count; i++) {
        const double line[6] = {lights[i].direction.x,    lights[i].direction.y,
                                lights[i].direction.z,    (double)lights[i].rgb[0],
                                (double)lights[i].rgb[1], (double)lights[i].rgb[2]};
        memcpy(out + 6 * i, line, sizeof line);
    }
    relume_environment_destroy(&environment);
    mem_free(lights);
    return status ? -1 : count;
}
