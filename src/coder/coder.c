#include "coder/basis.h"

#include "base/log.h"
#include "base/memory.h"

#include <string.h>

const struct relume_basis *const relume_bases[] = {
    &relume_basis_table,
    &relume_basis_sh,
    NULL,
};

const struct relume_basis *relume_basis_find(const char *name)
{
    for (const struct relume_basis *const *b = relume_bases; *b; b++)
        if (!strcmp((*b)->name, name))
            return *b;
    return NULL;
}

void relume_coder_destroy(relume_coder **coder)
{
    relume_coder *c = *coder;
    *coder = NULL;
    if (!c)
        return;
    c->info.basis->release(c);
    free(c->world);
    free(c->frame);
    free(c->transform);
    free(c->map);
    free(c);
}

vec3 clamp_to_captured(bool hemispherical, vec3 d)
{
    if (!hemispherical || d.z >= 0.0)
        return d;
    const double r = hypot(d.x, d.y);
    return r > 0.0 ? vec3_of(d.x / r, d.y / r, 0.0) : vec3_of(1.0, 0.0, 0.0);
}

static relume_status choose_count(const struct relume_basis *basis, int want, int lights,
                                  const struct relume_log *log, int *count)
{
    if (want && !basis->has_count(want))
        return log_fail(log, RELUME_EINVAL,
                        "basis %s has no form with %d coefficients; nearest: %d", basis->name, want,
                        basis->fit_count(want, want));
    *count = basis->fit_count(want, lights);
    if (want && *count < want)
        return log_fail(log, RELUME_EDATA,
                        "%d coefficients of basis %s need at least %d lights; found %d", want,
                        basis->name, want, lights);
    if (want && *count != want)
        return log_fail(log, RELUME_EDATA, "basis %s takes %d coefficients for %d lights; found %d",
                        basis->name, *count, lights, want);
    if (*count < 1)
        return log_fail(log, RELUME_EDATA, "basis %s cannot be fitted to %d lights", basis->name,
                        lights);
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

relume_status relume_coder_create(relume_coder **out, const struct relume_basis *basis,
                                  const struct relume_vec3 *lights, int n,
                                  const struct relume_coder_params *params)
{
    const struct relume_coder_params p = params ? *params : (struct relume_coder_params){0};
    *out = NULL;
    if (n < 1 || p.ridge < 0.0 || p.ridge > 1.0)
        return RELUME_EINVAL;
    int count = 0;
    relume_status status = choose_count(basis, p.coefficients, n, p.log, &count);
    if (status)
        return status;
    relume_coder *c = mem_zeroed(1, sizeof *c);
    if (!c)
        return RELUME_ENOMEM;
    c->info = (struct relume_coder_info){
        .basis = basis,
        .coefficients = count,
        .planes = 3 * count,
        .hemispherical = p.hemispherical,
        .pole_y = p.pole_y,
        .ridge = p.ridge,
        .lights = n,
    };
    c->decode = p.decode;
    status = copy_lights(c, lights);
    if (!status && p.transform) {
        c->transform = mem_copy(p.transform, (size_t)count * (size_t)count, sizeof *c->transform);
        status = c->transform ? RELUME_OK : RELUME_ENOMEM;
    }
    if (!status)
        status = basis->prepare(c, p.log);
    if (status) {
        relume_coder_destroy(&c);
        return status;
    }
    c->info.directions = c->world;
    c->info.transform = c->transform;
    *out = c;
    return RELUME_OK;
}

const struct relume_coder_info *relume_coder_info(const relume_coder *coder)
{
    return &coder->info;
}

void relume_coder_weights(const relume_coder *coder, struct relume_vec3 light, float *weights,
                          float constant[3])
{
    const int k = coder->info.coefficients;
    const vec3 d =
        clamp_to_captured(coder->info.hemispherical, pole_from_world(light, coder->info.pole_y));
    double values[CODER_MAX_COEFFICIENTS];
    coder->info.basis->evaluate(coder, d, values);
    for (int i = 0; i < k; i++) {
        double w = 0.0;
        if (coder->transform)
            for (int j = 0; j < k; j++)
                w += (double)coder->transform[i * k + j] * values[j];
        else
            w = values[i];
        weights[i] = weights[k + i] = weights[2 * k + i] = (float)w;
    }
    constant[0] = constant[1] = constant[2] = 0.0f;
}
