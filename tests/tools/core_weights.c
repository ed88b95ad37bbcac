// core_weights.c - what the page's core answers natively (web/core), case by case, for core.mjs to
// compare with its WebAssembly: core_weights CORE.so
//
// Each line is a case in JSON; floats as the bits of an integer. The last one says how far the
// core's own inverse takes weights from those of the library, of the largest of each case.
#include "format/coder/coding.h"

#include <dlfcn.h>
#include <math.h>
#include <relume/format/coder.h>
#include <relume/image/directions.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../web/core/core.h"

enum { LIGHTS = 49, DIRECTIONS = 12, MAP = 16, MOST = 64 };

struct calls {
    struct core *(*open)(const char *, const char *, const double *, int, int, int, const double *,
                         int);
    void (*close)(struct core *);
    int (*functions)(const struct core *);
    int (*turn)(struct core *, const float *, const float *, int);
    double (*weights)(const struct core *, double, double, double, float *);
    int (*environment)(const struct core *, float *, int, int, double, double *);
};

static void *call_of(void *library, const char *name)
{
    void *found = dlsym(library, name);
    if (!found) {
        fprintf(stderr, "core_weights: no %s\n", name);
        exit(1);
    }
    return found;
}

static void find_calls(struct calls *c, const char *path)
{
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        fprintf(stderr, "core_weights: %s\n", dlerror());
        exit(1);
    }
    void *const found[] = {
        call_of(library, "core_open"),      call_of(library, "core_close"),
        call_of(library, "core_functions"), call_of(library, "core_turn"),
        call_of(library, "core_weights"),   call_of(library, "core_environment")};
    memcpy(c, found, sizeof found);
}

// ---------------------------------------------------------------- lights

// A spiral over the hemisphere about +z (or +y), or the whole sphere.
static struct relume_vec3 light_of(int i, int n, bool hemisphere, bool pole_y)
{
    const double share = (i + 0.5) / n, phi = 2.399963229728653 * i;
    const double z = hemisphere ? 0.05 + 0.9 * share : 1.9 * share - 0.95, r = sqrt(1.0 - z * z);
    const double x = r * cos(phi), y = r * sin(phi);
    return pole_y ? (struct relume_vec3){x, z, -y} : (struct relume_vec3){x, y, z};
}

static void print_numbers(const char *name, const double *value, int n)
{
    printf("\"%s\":[", name);
    for (int i = 0; i < n; i++)
        printf("%s%.17g", i ? "," : "", value[i]);
    printf("],");
}

static unsigned bits_of(float value)
{
    unsigned bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

// ---------------------------------------------------------------- a case

struct basis_case {
    const char *basis, *interpolant;
    double parameter[4];
    int coefficients;
    bool hemispherical, pole_y;
};

static const struct basis_case cases[] = {
    {"table", "chord", {0}, 0, true, false},
    {"table", "chord", {1.5, 0.7, 0.03, 0}, 0, true, false},
    {"table", "chord", {1.8, 0.7, 0.03, 4}, 0, false, true},
    {"table", "angular", {0}, 0, true, false},
    {"table", "tps", {0}, 0, true, false},
    {"table", "rbf", {0}, 0, true, false},
    {"table", "natural", {0}, 0, true, false},
    {"table", "hsh", {0}, 0, true, false},
    {"table", "delaunay", {0}, 0, true, false},
    {"table", "delaunay", {0}, 0, false, true},
    {"table", "gaussian", {0}, 0, true, false},
    {"ptm", "", {0}, 6, true, false},
    {"hsh", "", {0}, 16, true, false},
    {"sh", "", {0}, 16, false, false},
    {"sh", "", {0}, 25, false, true},
    {"dct", "", {0}, 21, true, false},
    {"dct", "", {0}, 30, false, true},
    {"dct-resampled", "", {0}, 21, true, false},
};

// The largest difference from the library's own weights, of the largest of these.
static double differ_from_library(const struct basis_case *b, const struct relume_vec3 *lights,
                                  struct relume_vec3 direction, const float *weights, int functions)
{
    struct relume_coder_params p = {.coefficients = b->coefficients,
                                    .hemispherical = b->hemispherical,
                                    .pole_y = b->pole_y,
                                    .interpolant = relume_interpolant_find(b->interpolant),
                                    .decode = true,
                                    .force = true};
    static float own[3 * RELUME_MOST_COEFFICIENTS];
    relume_coder *coder = NULL;
    struct relume_vec3 from;
    float constant[3];
    double most = 0.0, size = 1e-30;
    memcpy(p.parameter, b->parameter, sizeof p.parameter);
    if (relume_coder_create(&coder, relume_basis_find(b->basis), lights, LIGHTS, &p))
        return (double)INFINITY;
    (void)relume_coder_clamp(&from, coder, direction);
    relume_coder_weights(coder, from, own, constant);
    for (int i = 0; i < functions; i++) {
        most = fmax(most, fabs((double)own[i] - (double)weights[i]));
        size = fmax(size, fabs((double)own[i]));
    }
    relume_coder_destroy(&coder);
    return most / size;
}

// Of few cases: it takes as long as all their weights together.
static void print_environment(const struct calls *call, const struct core *core)
{
    static float map[3 * MAP * 2 * MAP];
    double out[6 * MOST];
    for (int i = 0; i < 3 * MAP * 2 * MAP; i++)
        map[i] = (float)(i * 37 % 101);
    const int n = call->environment(core, map, 2 * MAP, MAP, 30.0, out);
    print_numbers("environment", out, 6 * n);
}

static double run_case(const struct calls *call, const struct basis_case *b)
{
    static float identity[3 * MOST * MOST], mean[3 * MOST], weights[3 * (MOST + 1)];
    struct relume_vec3 lights[LIGHTS];
    double xyz[3 * LIGHTS], most = 0.0;
    for (int i = 0; i < LIGHTS; i++) {
        lights[i] = light_of(i, LIGHTS, b->hemispherical, b->pole_y);
        memcpy(xyz + 3 * i, &lights[i], sizeof lights[i]);
    }
    struct core *core = call->open(b->basis, b->interpolant, b->parameter, b->coefficients,
                                   b->hemispherical, b->pole_y, xyz, LIGHTS);
    const int f = core ? call->functions(core) : 0;
    memset(identity, 0, sizeof identity);
    for (int i = 0; i < 3 * f; i++)
        identity[i * f + i % f] = 1.0f;
    if (!core || f > MOST || !call->turn(core, identity, mean, f)) {
        fprintf(stderr, "core_weights: %s %s cannot be opened\n", b->basis, b->interpolant);
        exit(1);
    }
    printf("{\"basis\":\"%s\",\"interpolant\":\"%s\",\"coefficients\":%d,\"functions\":%d,"
           "\"hemispherical\":%d,\"pole\":%d,",
           b->basis, b->interpolant, b->coefficients, f, b->hemispherical, b->pole_y);
    print_numbers("parameter", b->parameter, 4);
    print_numbers("lights", xyz, 3 * LIGHTS);
    if (b == &cases[1] || b == &cases[9])
        print_environment(call, core);
    printf("\"answers\":[");
    for (int i = 0; i < DIRECTIONS; i++) {
        const struct relume_vec3 d = light_of(i, DIRECTIONS, false, b->pole_y);
        const double share = call->weights(core, d.x, d.y, d.z, weights);
        printf("%s{\"direction\":[%.17g,%.17g,%.17g],\"share\":%.17g,\"bits\":[", i ? "," : "", d.x,
               d.y, d.z, share);
        for (int k = 0; k < f; k++)
            printf("%s%u", k ? "," : "", bits_of(weights[k]));
        printf("]}");
        most = fmax(most, differ_from_library(b, lights, d, weights, f));
    }
    printf("]}\n");
    call->close(core);
    return most;
}

int main(int argc, char **argv)
{
    struct calls call;
    double most = 0.0;
    if (argc != 2)
        return 2;
    find_calls(&call, argv[1]);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        most = fmax(most, run_case(&call, &cases[i]));
    printf("{\"library\":%.3g}\n", most);
    return 0;
}
