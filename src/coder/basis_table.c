// basis_table.c - the captured samples themselves, interpolated over a triangulation of the lights:
// the reference that every other basis is measured against
#include "coder/basis.h"

#include "base/log.h"
#include "base/memory.h"

#include <string.h>

static bool has_count(int count)
{
    return count >= 1 && count <= CODER_MAX_COEFFICIENTS;
}

// One coefficient per light, neither more nor fewer.
static int fit_count(int want, int lights)
{
    (void)want;
    return has_count(lights) ? lights : 0;
}

static relume_status prepare(relume_coder *coder, const struct relume_log *log)
{
    const size_t n = (size_t)coder->info.lights;
    if (coder->info.coefficients != coder->info.lights)
        return log_fail(log, RELUME_EINVAL, "basis table keeps one coefficient per light (%d)",
                        coder->info.lights);
    mesh *m;
    const relume_status status = mesh_create(&m, coder->frame, coder->info.lights);
    if (status)
        return status;
    coder->data = m;
    if (coder->decode)
        return RELUME_OK;
    coder->map = mem_zeroed(n * n, sizeof *coder->map);
    if (!coder->map)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++)
        coder->map[i * n + i] = 1.0f;
    return RELUME_OK;
}

static void evaluate(const relume_coder *coder, struct relume_vec3 light, double *values)
{
    const struct blend b = mesh_blend(coder->data, light);
    memset(values, 0, (size_t)coder->info.coefficients * sizeof *values);
    for (int i = 0; i < b.count; i++)
        values[b.light[i]] += b.weight[i];
}

static void release(relume_coder *coder)
{
    mesh *m = coder->data;
    mesh_destroy(&m);
}

const struct relume_basis relume_basis_table = {
    .name = "table",
    .summary = "every captured light, interpolated on the sphere (the reference; large)",
    .fit_count = fit_count,
    .has_count = has_count,
    .prepare = prepare,
    .evaluate = evaluate,
    .release = release,
};
