// around.c - the captured lights around a direction, and what is kept of a view, for other tracers
#include "relight/shadow/shadows.h"

#include "core/base/memory.h"
#include "relight/shadow/moving.h"

#include <math.h>

// Of a captured light that counts: of highlights, which are smooth in it, and of shadows.
static const float LEAST_WEIGHT = 1e-4f, PHOTOGRAPH = 0.9999f;

// A table of the same lights, asked for their weights. Highlights move in what the codes are
// interpolated by; in a sum of lights that is what environments are, whose weights are never
// negative.
relume_status shadows_need_between(relume_shadows *s, const struct relume_coder_info *info,
                                   bool summed)
{
    relume_coder **between = s->gloss.data && summed ? &s->summed : &s->between;
    struct relume_coder_params p = *relume_coder_params(.hemispherical = info->hemispherical,
                                                        .pole_y = info->pole_y, .decode = true);
    if (*between)
        return RELUME_OK;
    s->lights = info->lights;
    if (s->gloss.data)
        p.interpolant = summed ? relume_interpolant_find("delaunay") : info->interpolant;
    for (int i = 0; s->gloss.data && !summed && i < 4; i++)
        p.parameter[i] = info->parameter[i];
    return relume_coder_create(between, relume_basis_find("table"), info->directions, info->lights,
                               &p);
}

relume_status relume_shadows_between(const relume_coder **out, relume_shadows *s,
                                     const relume_coder *coder)
{
    *out = NULL;
    if (s->gloss.data)
        return RELUME_EINVAL;
    const relume_status status = shadows_need_between(s, relume_coder_info(coder), false);
    *out = s->between;
    return status;
}

static int gather(int *light, float *weight, const relume_shadows *s, const float *weights)
{
    const bool highlights = s->gloss.data != NULL;
    const float least = highlights ? LEAST_WEIGHT : 0.0f;
    int n = 0;
    for (int i = 0; i < s->lights && (highlights || n < SHADOWS_AROUND); i++)
        if (fabsf(weights[i]) > least) {
            light[n] = i;
            weight[n++] = weights[i];
        }
    return !highlights && n && weight[0] > PHOTOGRAPH ? 0 : n;
}

relume_status relume_shadows_around(int *light, float *weight, int *count, relume_shadows *s,
                                    const relume_coder *coder, vec3 direction, bool summed)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    float *weights = mem_array(3 * (size_t)info->lights, sizeof *weights), constant[3];
    relume_status status = weights ? shadows_need_between(s, info, summed) : RELUME_ENOMEM;
    *count = 0;
    if (!status) {
        relume_coder_weights(s->gloss.data && summed ? s->summed : s->between, direction, weights,
                             constant);
        *count = gather(light, weight, s, weights);
    }
    mem_free(weights);
    return status;
}

void relume_shadows_look(struct relume_shadows_stage *out, const relume_shadows *s)
{
    const struct stage *t = &s->stage;
    if (s->gloss.data) {
        *out = (struct relume_shadows_stage){
            .width = s->gloss.width, .height = s->gloss.height, .gloss = s->gloss.data};
        return;
    }
    *out = (struct relume_shadows_stage){
        .width = t->width,
        .height = t->height,
        .matte = s->matte,
        .rays = (enum relume_shadows_rays)t->kind,
        .pose = t->pose,
        .scale = {t->scale[0], t->scale[1]},
        .shift = {t->shift[0], t->shift[1]},
        .axis = t->axis,
        .pixel = t->pixel,
        .least_side = t->least_side,
        .low = t->low,
        .high = t->high,
        .far = t->far,
        .thick = t->thick,
        .front = t->front,
        .span = &t->cell->least,
    };
}
