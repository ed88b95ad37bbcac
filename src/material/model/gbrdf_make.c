// gbrdf_make.c - a g-BRDF from two photographs (Menzel 2011, section 6.4: the last of its edits)
#include <relume/material/edit.h>

#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/math/scalar.h"
#include "material/gbrdf/fit.h"
#include "material/model/model_gbrdf.h"

enum { USUAL_WIDTH = 256, MOST_WIDTH = 1024, MOST_HEIGHT = 4096 };

static relume_status check_params(const struct relume_gbrdf_make_params *p)
{
    const double share[] = {p->relief, p->roughness, p->r0, p->shine.x, p->shine.y, p->shine.z};
    for (size_t i = 0; i < sizeof share / sizeof *share; i++)
        if (!(share[i] >= 0.0 && share[i] <= 1.0))
            return log_fail(p->log, RELUME_EINVAL,
                            "relief, roughness, r0, shine: expected 0 to 1 each; found %g",
                            share[i]);
    if (p->roughness < 0.1)
        return log_fail(p->log, RELUME_EINVAL, "roughness: expected 0.1 to 1; found %g",
                        p->roughness);
    if (p->width < 1 || p->width > MOST_WIDTH)
        return log_fail(p->log, RELUME_EINVAL, "width: expected 1 to %d texels; found %d",
                        MOST_WIDTH, p->width);
    return isfinite(p->turn_degrees)
               ? RELUME_OK
               : log_fail(p->log, RELUME_EINVAL, "turn: expected a finite angle");
}

static bool fill_texel(struct gbrdf_maps *maps, size_t i, const float *rgb, float height,
                       const struct relume_gbrdf_make_params *p)
{
    bool good = isfinite(height);
    const double up = fmin(fmax((double)height, 0.0), 1.0);
    maps->depth[i] = (float)(p->relief * (up - 0.5));
    maps->rotation[i] =
        half_from_float((float)(remainder(p->turn_degrees, 360.0) * (M_PI / 180.0)));
    maps->r0[i] = half_from_float((float)p->r0);
    for (size_t c = 0; c < 3; c++) {
        good &= isfinite(rgb[c]);
        maps->diffuse[3 * i + c] = half_from_float(fminf(fmaxf(rgb[c], 0.0f), 1.0f));
    }
    return good;
}

static relume_status fill(struct gbrdf_maps *maps, const struct relume_image *colour,
                          const struct relume_image *height,
                          const struct relume_gbrdf_make_params *p)
{
    float ndf[NDF_VALUES];
    for (size_t i = 0; i < (size_t)maps->width * (size_t)maps->height; i++)
        if (!fill_texel(maps, i, colour->data + 3 * i, height->data[i], p))
            return log_fail(p->log, RELUME_EUNFIT,
                            "a picture holds NaN or infinity; expected finite values");
    ndf_ggx(ndf, p->roughness * p->roughness,
            (const double[3]){p->shine.x, p->shine.y, p->shine.z});
    for (int i = 0; i < NDF_VALUES; i++)
        maps->ndf[i] = half_from_float(ndf[i]);
    *maps->light = 1.0f;
    gbrdf_limit_energy(maps);
    return RELUME_OK;
}

relume_status relume_gbrdf_make(relume_btf_fitted **out, const struct relume_image *colour,
                                const struct relume_image *height,
                                const struct relume_gbrdf_make_params *params)
{
    struct relume_gbrdf_make_params p = PARAMS(relume_gbrdf_make_params, params);
    struct relume_image rgb = {.width = 0}, relief = {.width = 0};
    struct gbrdf_maps maps = {.width = 0};
    *out = NULL;
    p.width = p.width ? p.width : smaller_of(colour->width, USUAL_WIDTH);
    p.relief = p.relief != 0.0 ? p.relief : 0.03;
    p.roughness = p.roughness != 0.0 ? p.roughness : 0.5;
    p.r0 = p.r0 != 0.0 ? p.r0 : 0.04;
    if (vec3_is_zero(p.shine))
        p.shine = vec3_of(1.0, 1.0, 1.0);
    relume_status status = check_params(&p);
    const double rows = fmax(rint((double)p.width * colour->height / colour->width), 1.0);
    if (!status && (colour->channels != 3 || height->channels != 1 || rows > MOST_HEIGHT))
        status = log_fail(p.log, RELUME_EINVAL,
                          "expected a picture of 3 channels and one of 1, at most %d rows high; "
                          "found %d and %d, %.0f rows",
                          MOST_HEIGHT, colour->channels, height->channels, rows);
    if (!status)
        status = relume_image_scale(&rgb, colour, p.width, (int)rows, NULL);
    if (!status)
        status = relume_image_scale(&relief, height, p.width, (int)rows, NULL);
    if (!status)
        status = gbrdf_maps_create(&maps, p.width, (int)rows, 1);
    if (!status)
        status = fill(&maps, &rgb, &relief, &p);
    if (!status)
        status = gbrdf_model_of_set(out, &maps, p.directions, p.log);
    relume_image_destroy(&rgb);
    relume_image_destroy(&relief);
    gbrdf_maps_free(&maps);
    return status;
}
