// basis_dct_resampled.c - the thesis's way (Wong 1998, 9.1.2): resample the captured lights to a
// grid over the disc, transform by cosines, keep the lowest zones. Kept for comparison with dct.
#include "core/base/memory.h"
#include "format/coder/coding.h"
#include "format/coder/disc.h"

enum { GRID = 50 };  // as in Wong 1998, 9.1.3

// Add what the grid point at (row, column) of a disc contributes to the functions of that disc.
static void add_point(relume_coder *coder, const mesh *lights, struct disc_point p)
{
    const int upper = disc_upper_count(coder), all = coder->info.coefficients;
    const int first = p.lower ? upper : 0, count = p.lower ? all - upper : upper;
    const struct blend b = mesh_blend(lights, disc_to_direction(p));
    for (int k = 0; k < count; k++) {
        const double value = disc_cosine(disc_wave_of(k), p) / (GRID * GRID);
        float *row = coder->map + (size_t)(first + k) * (size_t)coder->info.lights;
        for (int i = 0; i < b.count; i++)
            row[b.light[i]] += (float)(value * b.weight[i]);
    }
}

static relume_status prepare(relume_coder *coder, const struct relume_log *log)
{
    (void)log;
    if (coder->decode)
        return RELUME_OK;
    const size_t size = (size_t)coder->info.coefficients * (size_t)coder->info.lights;
    coder->map = mem_zeroed(size, sizeof *coder->map);
    mesh *lights;
    if (!coder->map || mesh_create(&lights, coder->frame, coder->info.lights))
        return RELUME_ENOMEM;
    for (int disc = 0; disc < (coder->info.hemispherical ? 1 : 2); disc++)
        for (int i = 0; i < GRID * GRID; i++)
            add_point(coder, lights,
                      (struct disc_point){(i % GRID + 0.5) / GRID, (i / GRID + 0.5) / GRID, disc});
    mesh_destroy(&lights);
    return RELUME_OK;
}

const struct relume_basis relume_basis_dct_resampled = {
    .name = "dct-resampled",
    .summary = "the same cosines by resampling to a 50 x 50 grid first (Wong 1998)",
    .fit_count = disc_fit_count,
    .has_count = disc_has_count,
    .prepare = prepare,
    .evaluate = disc_evaluate,
    .release = disc_release,
};
