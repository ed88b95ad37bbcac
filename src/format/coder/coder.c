// coder.c - a basis prepared for the lights of one capture: made, asked for weights, destroyed
#include "format/coder/basis.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/math/lsq.h"
#include "format/coder/coding.h"
#include "format/coder/interpolant.h"
#include "format/coder/zone.h"

#include <string.h>

const struct relume_basis *const relume_bases[] = {
    &relume_basis_table, &relume_basis_ptm,   &relume_basis_hsh,
    &relume_basis_sh,    &relume_basis_dct,   &relume_basis_dct_resampled,
    &relume_basis_pca,   &relume_basis_eigen, NULL,
};

const struct relume_basis *relume_basis_find(const char *name)
{
    for (const struct relume_basis *const *b = relume_bases; *b; b++)
        if (!strcmp((*b)->name, name))
            return *b;
    return NULL;
}

const struct relume_interpolant *const relume_interpolants[] = {
    &interpolant_chord,      &interpolant_angular,
    &interpolant_tps,        &interpolant_rbf,
    &interpolant_natural,    &interpolant_hsh,
    &interpolant_delaunay,   &interpolant_gaussian,
    &interpolant_octahedral, NULL,
};

const struct relume_interpolant *relume_interpolant_find(const char *name)
{
    for (const struct relume_interpolant *const *i = relume_interpolants; *i; i++)
        if (!strcmp((*i)->name, name))
            return *i;
    return NULL;
}

void relume_coder_destroy(relume_coder **coder)
{
    relume_coder *c = *coder;
    *coder = NULL;
    if (!c)
        return;
    if (c->info.basis->release)
        c->info.basis->release(c);
    if (c->info.interpolant)
        c->info.interpolant->release(c->interpolant);
    mesh_destroy(&c->around);
    mem_free(c->world);
    mem_free(c->frame);
    mem_free(c->transform);
    mem_free(c->mean);
    mem_free(c->map);
    mem_free(c->base);
    robust_destroy(c->robust);
    mem_free(c);
}

vec3 clamp_to_captured(bool hemispherical, vec3 d)
{
    if (!hemispherical || d.z >= 0.0)
        return d;
    const double r = hypot(d.x, d.y);
    return r > 0.0 ? vec3_of(d.x / r, d.y / r, 0.0) : vec3_of(1.0, 0.0, 0.0);
}

static relume_status choose_count(const struct relume_basis *basis, int lights,
                                  const struct relume_coder_params *p, int *count)
{
    const int want = p->coefficients;
    if (want && !basis->has_count(want))
        return log_fail(p->log, RELUME_EINVAL,
                        "basis %s cannot have %d coefficient%s; the nearest number is %d",
                        basis->name, want, relume_plural(want), basis->fit_count(want, want));
    *count = basis->fit_count(want, lights);
    if (want > *count && p->force && !basis->interpolates) {
        if (!p->decode)
            log_line(
                p->log, RELUME_WARNING,
                "%d light%s too few for %d coefficients of basis %s; smoothing guesses the rest",
                lights, lights == 1 ? " is" : "s are", want, basis->name);
        *count = want;
    }
    if (want && *count < want && !basis->interpolates)
        return log_fail(p->log, RELUME_EUNFIT,
                        "%d coefficient%s of basis %s need at least %d light%s; found %d", want,
                        relume_plural(want), basis->name, want, relume_plural(want), lights);
    if (want && *count != want)
        return log_fail(p->log, RELUME_EUNFIT,
                        "basis %s takes %s%d coefficient%s for %d light%s; found %d", basis->name,
                        basis->learned ? "at most " : "", *count, relume_plural(*count), lights,
                        relume_plural(lights), want);
    if (*count < 1)
        return log_fail(p->log, RELUME_EUNFIT, "basis %s cannot be fitted to %d light%s",
                        basis->name, lights, relume_plural(lights));
    return RELUME_OK;
}

static relume_status copy_lights(relume_coder *c, const struct relume_vec3 *lights)
{
    const size_t n = (size_t)c->info.lights;
    c->world = mem_array(n, sizeof *c->world);
    c->frame = mem_array(n, sizeof *c->frame);
    if (!c->world || !c->frame)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        c->world[i] = lights[i];
        c->frame[i] = pole_from_world(lights[i], c->info.pole_y);
    }
    return RELUME_OK;
}

static relume_status copy_functions(relume_coder *c, const struct relume_coder_params *p)
{
    const size_t raw = (size_t)c->info.functions, k = (size_t)c->info.coefficients;
    const size_t channels = c->info.basis->joint ? 3 : 1;
    if (p->transform) {
        c->transform = mem_copy(p->transform, channels * k * raw, sizeof *c->transform);
        if (!c->transform)
            return RELUME_ENOMEM;
    }
    if (p->mean && c->info.basis->joint) {
        c->mean = mem_copy(p->mean, 3 * raw, sizeof *c->mean);
        if (!c->mean)
            return RELUME_ENOMEM;
    }
    return RELUME_OK;
}

// Sums over many lights need weights that are nowhere negative (relume_coder_hull).
static relume_status find_surround(relume_coder *c)
{
    if (!c->info.interpolant || !c->info.interpolant->extrapolates)
        return RELUME_OK;
    return mesh_create(&c->around, c->frame, c->info.lights);
}

static void find_zone(relume_coder *c)
{
    const struct relume_interpolant *i = c->info.interpolant;
    const struct zone_params p = {.hemispherical = c->info.hemispherical,
                                  .pole_y = c->info.pole_y,
                                  .part = i && !i->extrapolates ? 0.25 : 0.5};
    zone_find(&c->zone, c->world, c->info.lights, &p);
}

const struct relume_captured_region *relume_coder_region(const relume_coder *coder)
{
    return &coder->zone;
}

double relume_coder_clamp(struct relume_vec3 *from, const relume_coder *coder,
                          struct relume_vec3 direction)
{
    const bool pole_y = coder->info.pole_y;
    const vec3 above =
        clamp_to_captured(coder->info.hemispherical, pole_from_world(direction, pole_y));
    return relume_captured_region_clamp(from, &coder->zone, world_from_pole(above, pole_y));
}

// Lights on a circle, great or small, say nothing about directions off it. They lie in a plane
// then: the least eigenvalue of their covariance is their mean squared distance from it.
static relume_status warn_degenerate(const relume_coder *c, const struct relume_log *log)
{
    static const double flat = 0.02;  // about a degree
    const int n = c->info.lights;
    double covariance[9] = {0}, values[3];
    vec3 mean = {0};
    for (int i = 0; i < n; i++)
        mean = vec3_along(mean, c->frame[i], 1.0 / n);
    for (int i = 0; i < n; i++) {
        const vec3 d = vec3_sub(c->frame[i], mean);
        const double row[3] = {d.x, d.y, d.z};
        for (int j = 0; j < 9; j++)
            covariance[j] += row[j / 3] * row[j % 3] / n;
    }
    if (!lsq_eigenvalues(covariance, 3, values))
        return RELUME_ENOMEM;
    if (values[2] < flat * flat)
        log_line(log, RELUME_WARNING,
                 "all %d lights come from one direction; light from anywhere else is guessed", n);
    else if (values[0] < flat * flat)
        log_line(log, RELUME_WARNING,
                 "all %d lamps stand on one ring or arc; light from other directions is guessed",
                 n);
    return RELUME_OK;
}

static relume_status prepare_interpolant(relume_coder *c, const struct relume_coder_params *p)
{
    const struct relume_interpolant *own =
        c->info.basis->learned ? &interpolant_chord : &interpolant_delaunay;
    const struct relume_interpolant *i = p->choose        ? &interpolant_chord
                                         : p->interpolant ? p->interpolant
                                                          : own;
    relume_status status = RELUME_OK;
    if (p->choose && (!p->samples || p->samples->lights != c->info.lights || !p->samples->pixels))
        return log_fail(p->log, RELUME_EINVAL, "choosing an interpolant needs samples");
    if (p->choose)
        status = interpolant_choose(c->info.parameter, &c->info.predicted_rms, c->frame, p->samples,
                                    p->threads);
    for (int k = 0; !status && k < 4; k++)
        if (!(c->info.parameter[k] >= 0.0) || isinf(c->info.parameter[k]))
            status = log_fail(p->log, RELUME_EUNFIT,
                              "parameter %d of interpolant %s: expected 0 or more, found %g", k + 1,
                              i->name, c->info.parameter[k]);
    if (!status)
        status = i->prepare(&c->interpolant, c->frame, c->info.lights, c->info.parameter, p->log);
    if (!status)
        c->info.interpolant = i;
    return status;
}

relume_status relume_coder_create(relume_coder **out, const struct relume_basis *basis,
                                  const struct relume_vec3 *lights, int n,
                                  const struct relume_coder_params *params)
{
    const struct relume_coder_params p = PARAMS_WORK(relume_coder_params, params);
    *out = NULL;
    if (n < 1 || p.ridge < 0.0 || p.ridge > 1.0 || (p.no_ridge && p.ridge > 0.0))
        return RELUME_EINVAL;
    if (p.luminance && basis->learned)
        return log_fail(p.log, RELUME_EINVAL,
                        "basis %s cannot be fitted to luminance only; leave out --colour luminance",
                        basis->name);
    if (basis->interpolates && n > RELUME_MOST_COEFFICIENTS)
        return log_fail(p.log, RELUME_EUNFIT, "basis %s takes at most %d lights; found %d",
                        basis->name, RELUME_MOST_COEFFICIENTS, n);
    if (p.robust && !basis->fits)
        return log_fail(p.log, RELUME_EINVAL,
                        "basis %s has no robust fit; use another basis, or leave out --robust",
                        basis->name);
    if (basis->learned && p.decode && !p.transform)
        return log_fail(p.log, RELUME_EUNFIT, "basis %s without its functions", basis->name);
    if (basis->upper_only && !p.hemispherical)
        return log_fail(p.log, RELUME_EUNFIT,
                        "basis %s covers one hemisphere of lights; found lights on both sides",
                        basis->name);
    int count = 0;
    relume_status status = choose_count(basis, n, &p, &count);
    if (status)
        return status;
    relume_coder *c = mem_zeroed(1, sizeof *c);
    if (!c)
        return RELUME_ENOMEM;
    c->info = (struct relume_coder_info){
        .basis = basis,
        .coefficients = count,
        .joint = basis->joint || p.luminance,
        .luminance = p.luminance,
        .planes = basis->joint  ? count
                  : p.luminance ? count + 3
                                : 3 * count,
        .functions = basis->interpolates ? n : count,
        .hemispherical = p.hemispherical,
        .pole_y = p.pole_y,
        .ridge = p.ridge,
        .lights = n,
    };
    memcpy(c->info.parameter, p.parameter, sizeof p.parameter);
    c->decode = p.decode;
    c->force = p.force;
    c->no_ridge = p.no_ridge;
    c->samples = p.samples;
    c->threads = p.threads;
    status = copy_lights(c, lights);
    if (!status)
        status = copy_functions(c, &p);
    if (!status && !p.decode && n > 3)
        status = warn_degenerate(c, p.log);
    if (!status && basis->interpolates)
        status = prepare_interpolant(c, &p);
    if (!status)
        status = basis->prepare(c, p.log);
    if (!status && p.robust && !p.decode)
        status = robust_create(&c->robust, c);
    if (!status)
        status = find_surround(c);
    c->samples = NULL;
    if (status) {
        relume_coder_destroy(&c);
        return status;
    }
    find_zone(c);
    c->info.directions = c->world;
    c->info.transform = c->transform;
    c->info.mean = c->mean;
    *out = c;
    return RELUME_OK;
}

// Encoding, the coefficient of the mean is 1 whatever the samples are.
static bool append_row(relume_coder *coder, size_t k, size_t samples)
{
    float *map = coder->map ? mem_zeroed((k + 1) * samples, sizeof *map) : NULL;
    float *base = coder->map ? mem_zeroed(k + 1, sizeof *base) : NULL;
    if (!coder->map)
        return true;
    if (!map || !base) {
        mem_free(map);
        mem_free(base);
        return false;
    }
    memcpy(map, coder->map, k * samples * sizeof *map);
    memcpy(base, coder->base, k * sizeof *base);
    base[k] = 1.0f;
    mem_free(coder->map);
    mem_free(coder->base);
    coder->map = map;
    coder->base = base;
    return true;
}

relume_status relume_coder_append_mean(relume_coder *coder)
{
    const size_t k = (size_t)coder->info.coefficients, raw = (size_t)coder->info.functions;
    if (!coder->mean || !coder->transform || coder->robust || k >= RELUME_MOST_COEFFICIENTS)
        return RELUME_OK;
    float *grown = mem_array(3 * (k + 1) * raw, sizeof *grown);
    if (!grown || !append_row(coder, k, 3 * raw)) {
        mem_free(grown);
        return RELUME_ENOMEM;
    }
    for (size_t c = 0; c < 3; c++) {
        float *to = grown + c * (k + 1) * raw;
        memcpy(to, coder->transform + c * k * raw, k * raw * sizeof *to);
        memcpy(to + k * raw, coder->mean + c * raw, raw * sizeof *to);
    }
    mem_free(coder->transform);
    mem_free(coder->mean);
    coder->transform = grown;
    coder->mean = NULL;
    coder->info.transform = grown;
    coder->info.mean = NULL;
    coder->info.coefficients++;
    coder->info.planes++;
    return RELUME_OK;
}

const struct relume_coder_info *relume_coder_info(const relume_coder *coder)
{
    return &coder->info;
}

void coder_interpolate(const relume_coder *coder, struct relume_vec3 light, double *values)
{
    coder->info.interpolant->evaluate(coder->interpolant, light, values);
}

bool relume_coder_triangles(struct relume_coder_triangles *out, const relume_coder *coder)
{
    const struct relume_interpolant *i = coder->info.interpolant;
    const bool flat = i && i->triangles;
    *out = flat ? i->triangles(coder->interpolant) : (struct relume_coder_triangles){.points = 0};
    return flat;
}

bool relume_coder_hull(struct relume_coder_triangles *out, const relume_coder *coder)
{
    *out = coder->around ? mesh_triangles(coder->around) : (struct relume_coder_triangles){0};
    return coder->around;
}

static double dot(const float *a, const double *b, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += (double)a[i] * b[i];
    return sum;
}

void relume_coder_weights(const relume_coder *coder, struct relume_vec3 light, float *weights,
                          float constant[3])
{
    const int k = coder->info.coefficients, raw = coder->info.functions;
    const size_t size = (size_t)k * (size_t)raw;
    const vec3 d =
        clamp_to_captured(coder->info.hemispherical, pole_from_world(light, coder->info.pole_y));
    double values[RELUME_MOST_COEFFICIENTS];
    coder->info.basis->evaluate(coder, d, values);
    const int channels = coder->info.basis->joint ? 3 : 1;
    for (int c = 0; c < channels; c++)
        for (int i = 0; i < k; i++)
            weights[c * k + i] =
                (float)(coder->transform
                            ? dot(coder->transform + (size_t)c * size + (size_t)i * (size_t)raw,
                                  values, raw)
                            : values[i]);
    for (int c = channels; c < 3; c++)
        memcpy(weights + c * k, weights, (size_t)k * sizeof *weights);
    for (int c = 0; c < 3; c++)
        constant[c] = coder->mean ? (float)dot(coder->mean + c * raw, values, raw) : 0.0f;
}
