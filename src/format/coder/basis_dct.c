// basis_dct.c - cosines on the stereographic discs, fitted directly to the captured directions: no
// resampling, and the corners of the square outside the disc carry no data at all
#include "core/base/memory.h"
#include "format/coder/coding.h"
#include "format/coder/disc.h"

// Bending: the square of the Laplacian's eigenvalue on the square.
static relume_status prepare(relume_coder *coder, const struct relume_log *log)
{
    if (coder->decode)
        return RELUME_OK;
    const int upper = disc_upper_count(coder), all = coder->info.coefficients;
    double *roughness = mem_array((size_t)all, sizeof *roughness);
    if (!roughness)
        return RELUME_ENOMEM;
    for (int k = 0; k < all; k++) {
        const struct disc_wave w = disc_wave_of(k < upper ? k : k - upper);
        const double square = w.u * w.u + w.v * w.v;
        roughness[k] = square * square;
    }
    const relume_status status = fit_map(coder, roughness, log);
    mem_free(roughness);
    return status;
}

const struct relume_basis relume_basis_dct = {
    .name = "dct",
    .summary = "cosines on the stereographic disc, fitted to the photographs by least squares",
    .halves = true,
    .fits = true,
    .fit_count = disc_fit_count,
    .has_count = disc_has_count,
    .prepare = prepare,
    .evaluate = disc_evaluate,
    .release = disc_release,
};
