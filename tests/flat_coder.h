// flat_coder.h - the coder by which environments are summed
#ifndef FLAT_CODER_H
#define FLAT_CODER_H

#include "format/coder/coding.h"

#include "test.h"

// The same functions at the lights, over flat triangles between them; NULL where the coder itself
// is asked.
static inline relume_coder *flat_coder(const relume_coder *coder)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    struct relume_coder_triangles unused;
    relume_coder *flat = NULL;
    if (relume_coder_hull(&unused, coder))
        CHECK_OK(relume_coder_create(
            &flat, info->basis, info->directions, info->lights,
            relume_coder_params(.coefficients = info->coefficients,
                                .hemispherical = info->hemispherical, .pole_y = info->pole_y,
                                .interpolant = relume_interpolant_find("delaunay"), .decode = true,
                                .transform = info->transform, .mean = info->mean)));
    return flat;
}

#endif
