// fit.h - a g-BRDF from measured values
#ifndef GBRDF_FIT_H
#define GBRDF_FIT_H

#include "material/btf/btf.h"
#include "material/gbrdf/gbrdf.h"

struct gbrdf_fit_params {
    const struct relume_log *log;
    int materials;  // at most, or, where `exact`, that many
    bool exact;
    bool resample;  // where the BTF has no reciprocal pairs, find the relief with interpolated
                    // lights
    uint64_t seed;
    int threads;
};

// Maps of zeros. RELUME_ENOMEM.
relume_status gbrdf_maps_create(struct gbrdf_maps *out, int width, int height, int materials);
void gbrdf_maps_free(struct gbrdf_maps *maps);

// Whether the relief can be found without resampling: by reciprocal pairs, or where it is a plane.
bool gbrdf_fits(const relume_btf *btf);

// `out->materials` says how many were found; the caller frees it, also on failure. RELUME_EUNFIT
// without reciprocal pairs, RELUME_ENOMEM, RELUME_ESYSTEM, RELUME_ECANCEL.
relume_status gbrdf_fit(struct gbrdf_maps *out, const relume_btf *btf,
                        const struct gbrdf_fit_params *params);

#endif
