// model_lit.c - a lit texture, the plainest of the papers' comparisons (2003 paper, Figs. 5 and 6):
//     BTF(x, v, l) ~ texture(x) n.l
// The texture is the least squares of all pairs.
#include "core/base/half.h"
#include "material/model/ambient.h"
#include "material/model/environment.h"

enum { TEXTURE };

static void layout(relume_btf_fitted *m)
{
    model_add(m, "texture", NPY_HALF, true, 0, MODEL_SHAPE(m->texels, 3));
}

static double cosine(const relume_btf_fitted *m, vec3 light)
{
    return m->without_cosine ? 1.0 : light.z;
}

static void fit_texel(void *context, size_t texel, const float *values)
{
    const relume_btf_fitted *m = context;
    double both[3] = {0.0, 0.0, 0.0}, own = 0.0;
    for (int v = 0; v < m->views; v++)
        for (int l = 0; l < m->lights; l++, values += 3) {
            const double lit = cosine(m, m->light[l]);
            own += lit * lit;
            for (int c = 0; c < 3; c++)
                both[c] += lit * (double)values[c];
        }
    for (int c = 0; c < 3; c++)
        model_halfs(m, TEXTURE)[3 * texel + (size_t)c] = half_from_float((float)(both[c] / own));
}

static relume_status fit(struct fitting *f)
{
    return btf_for_texels(f->btf, f->threads, f->log, "fitting", f->out, fit_texel);
}

static void eval(const relume_btf_fitted *m, const struct model_at *at, float rgb[3])
{
    const uint16_t *texture = model_halfs(m, TEXTURE) + 3 * at->texel;
    for (int c = 0; c < 3; c++)
        rgb[c] = float_from_half(texture[c]) * (float)cosine(m, at->l);
}

// A colour; n.l.
static struct relume_btf_cost cost(const relume_btf_fitted *m)
{
    (void)m;
    return (struct relume_btf_cost){.fetches = 1, .light_ops = 2};
}

static void under(const relume_btf_fitted *m, const struct model_at *at,
                  const struct relume_btf_oriented_light *ambient, float rgb[3])
{
    const uint16_t *texture = model_halfs(m, TEXTURE) + 3 * at->texel;
    ambient_even(ambient, true, rgb);
    for (int c = 0; c < 3; c++)
        rgb[c] *= float_from_half(texture[c]);
}

const struct relume_btf_model model_lit = {
    .name = "lit",
    .summary = "a lit texture: a colour for each texel times n.l",
    .layout = layout,
    .fit = fit,
    .eval = eval,
    .cost = cost,
    .lit = under,
};
