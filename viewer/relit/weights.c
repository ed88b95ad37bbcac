// weights.c - lights folded into one number for each plane and channel (Wong 1998, Eq. 7.6)
#include "relit/weights.h"

#include "common/vec.h"
#include "format/coder/coding.h"

#include <stdlib.h>
#include <string.h>

relume_status weights_create(struct weights *w, const relume_coder *coder, int planes)
{
    const size_t k = (size_t)relume_coder_info(coder)->coefficients;
    *w = (struct weights){.layers = (planes + LANES - 1) / LANES};
    w->plane = calloc((size_t)w->layers * CHANNELS * LANES, sizeof *w->plane);
    w->basis = calloc(3 * k, sizeof *w->basis);
    if (w->plane && w->basis) {
        weights_clear(w);
        return RELUME_OK;
    }
    weights_destroy(w);
    return RELUME_ENOMEM;
}

void weights_destroy(struct weights *w)
{
    free(w->plane);
    free(w->basis);
    *w = (struct weights){0};
}

void weights_clear(struct weights *w)
{
    memset(w->plane, 0, (size_t)w->layers * CHANNELS * LANES * sizeof *w->plane);
    memset(w->constant, 0, sizeof w->constant);
    for (int c = 0; c < 3; c++)
        w->colour[c] = 1.0f;
}

static float *weight_of(const struct weights *w, int plane, int channel)
{
    return &w->plane[(plane / LANES * CHANNELS + channel) * LANES + plane % LANES];
}

// The basis [3][K] in `w`, and what it adds to each channel, times `rgb`.
static void add_basis(struct weights *w, const struct relume_codes *codes, double unit,
                      const float constant[3], const float rgb[3])
{
    const struct relume_coder_info *info = relume_coder_info(codes->coder);
    const int coefficients = info->coefficients;
    for (int c = 0; c < 3; c++) {
        double sum = constant[c];
        for (int k = 0; k < coefficients; k++) {
            const int plane = relume_coder_plane(info, k, c);
            const double b = w->basis[c * coefficients + k];
            *weight_of(w, plane, c) += (float)(rgb[c] * b * codes->scale[plane] * unit);
            sum += b * codes->offset[plane];
        }
        w->constant[c] += (float)(rgb[c] * sum);
        if (info->luminance) {
            const int plane = coefficients + c;
            *weight_of(w, plane, 3 + c) = (float)(codes->scale[plane] * unit);
            w->colour[c] = codes->offset[plane];
        }
    }
}

void weights_add(struct weights *w, const struct relume_codes *codes, double unit,
                 struct relume_vec3 direction, const float rgb[3])
{
    float constant[3], value[3];
    struct relume_vec3 from;
    const float share = (float)relume_coder_clamp(&from, codes->coder, vec3_unit(direction));
    relume_coder_weights(codes->coder, from, w->basis, constant);
    for (int c = 0; c < 3; c++)
        value[c] = share * rgb[c];
    add_basis(w, codes, unit, constant, value);
}

void weights_add_environment(struct weights *w, const struct relume_codes *codes, double unit,
                             const relume_weight_grid *grid, const struct relume_light *light)
{
    static const float one[3] = {1.0f, 1.0f, 1.0f};
    const size_t k = (size_t)relume_coder_info(codes->coder)->coefficients;
    float constant[3] = {0.0f, 0.0f, 0.0f};
    memset(w->basis, 0, 3 * k * sizeof *w->basis);
    relume_environment_weights(w->basis, constant, grid, light);
    add_basis(w, codes, unit, constant, one);
}
