// basis_table.c - the captured samples themselves, interpolated over the lights: the reference that
// every other basis is measured against
#include "core/base/memory.h"
#include "format/coder/basis.h"

// One coefficient per light, neither more nor fewer.
static int fit_count(int want, int lights)
{
    (void)want;
    return basis_takes_any(lights) ? lights : 0;
}

static relume_status prepare(relume_coder *coder, const struct relume_log *log)
{
    (void)log;
    const size_t n = (size_t)coder->info.lights;
    if (coder->decode)
        return RELUME_OK;
    coder->map = mem_zeroed(n * n, sizeof *coder->map);
    if (!coder->map)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++)
        coder->map[i * n + i] = 1.0f;
    return RELUME_OK;
}

const struct relume_basis relume_basis_table = {
    .name = "table",
    .summary = "every photograph, interpolated between lights (the reference; large)",
    .interpolates = true,
    .fit_count = fit_count,
    .has_count = basis_takes_any,
    .prepare = prepare,
    .evaluate = coder_interpolate,
};
