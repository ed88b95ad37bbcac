// model_painted.c - the reflectance of glTF 2.0 (Khronos 2021, appendix B) with a normal for each
// texel: what is diffuse, below microfacets
//     pi f = (1 - F) diffuse + pi D V F,   F = F0 + (1 - F0) (1 - v.h)^5
// by Trowbridge and Reitz's distribution D ("GGX"), Smith's masking V and Schlick's F, times the
// cosine to the texel's own normal. It is painted (painted.c), never fitted.
//
// An environment shows the highlight as its mean over the lobe about the mirrored eye (model_laf.c
// has the exponent), times what the microfacets send back of even light (the fit of Karis 2014,
// "Physically based shading on mobile"); the rest goes to the diffuse part, so that white is white.
#include "material/model/ambient.h"

#include "core/base/half.h"
#include "material/model/environment.h"

enum { DIFFUSE, SPECULAR, SHAPE };
static const double DIELECTRIC = 0.04;

static void layout(relume_btf_fitted *m)
{
    model_add(m, "diffuse", NPY_HALF, true, 0, MODEL_SHAPE(m->texels, 3));
    model_add(m, "specular", NPY_HALF, true, 0, MODEL_SHAPE(m->texels, 3));
    // the normal, and the square of glTF's roughness
    model_add(m, "shape", NPY_HALF, true, 0, MODEL_SHAPE(m->texels, 4));
}

struct texel {
    const uint16_t *diffuse, *specular;
    vec3 normal;
    double alpha;
};

static struct texel texel_of(const relume_btf_fitted *m, size_t texel)
{
    const uint16_t *shape = model_halfs(m, SHAPE) + 4 * texel;
    double value[4];
    for (int i = 0; i < 4; i++)
        value[i] = (double)float_from_half(shape[i]);
    return (struct texel){.diffuse = model_halfs(m, DIFFUSE) + 3 * texel,
                          .specular = model_halfs(m, SPECULAR) + 3 * texel,
                          .normal = vec3_unit(vec3_of(value[0], value[1], value[2])),
                          .alpha = value[3]};
}

// pi D V.
static double microfacets(double alpha, double nh, double nv, double nl)
{
    const double square = alpha * alpha, d = nh * nh * (square - 1.0) + 1.0;
    const double shadowed =
        nl * sqrt(square + (1.0 - square) * nv * nv) + nv * sqrt(square + (1.0 - square) * nl * nl);
    return 0.5 * square / (d * d * fmax(shadowed, 1e-9));
}

static void eval(const relume_btf_fitted *m, const struct model_at *at, float rgb[3])
{
    const struct texel t = texel_of(m, at->texel);
    const vec3 h = vec3_unit(vec3_add(at->v, at->l));
    const double nl = vec3_dot(t.normal, at->l), nv = fmax(vec3_dot(t.normal, at->v), 1e-3);
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (!(nl > 0.0))
        return;
    const double grazing = pow(fmax(1.0 - vec3_dot(at->v, h), 0.0), 5.0);
    const double lobe = microfacets(t.alpha, fmax(vec3_dot(t.normal, h), 0.0), nv, nl);
    const double below = (1.0 - DIELECTRIC) * (1.0 - grazing);
    for (int c = 0; c < 3; c++) {
        const double f0 = (double)float_from_half(t.specular[c]);
        const double diffuse = (double)float_from_half(t.diffuse[c]);
        rgb[c] = (float)(nl * (below * diffuse + lobe * (f0 + (1.0 - f0) * grazing)));
    }
}

// Of even light the microfacets send back F0 x + y.
static void sent_back(double xy[2], double roughness, double nv)
{
    const double r[4] = {1.0 - roughness, 0.0425 - 0.0275 * roughness, 1.04 - 0.572 * roughness,
                         0.022 * roughness - 0.04};
    const double a = fmin(r[0] * r[0], exp2(-9.28 * nv)) * r[0] + r[1];
    xy[0] = r[2] - 1.04 * a;
    xy[1] = r[3] + 1.04 * a;
}

// The mirrored eye, above the surface.
static vec3 mirrored(vec3 v, vec3 normal)
{
    const vec3 r = vec3_sub(vec3_scale(normal, 2.0 * vec3_dot(v, normal)), v);
    return vec3_unit(vec3_of(r.x, r.y, fmax(r.z, 1e-3)));
}

static void lit(const relume_btf_fitted *m, const struct model_at *at,
                const struct relume_btf_oriented_light *ambient, float rgb[3])
{
    const struct texel t = texel_of(m, at->texel);
    const float normal[3] = {(float)t.normal.x, (float)t.normal.y, (float)t.normal.z};
    const double exponent = fmax((2.0 / (t.alpha * t.alpha) - 2.0) / 4.0, 1.0);
    const vec3 r = mirrored(at->v, t.normal);
    const struct relume_btf_frame *f = &ambient->frame;
    const vec3 axis =
        vec3_add(vec3_scale(f->right, r.x), vec3_along(vec3_scale(f->up, r.y), f->normal, r.z));
    float even[3], shines[3];
    double part[2];
    sent_back(part, sqrt(t.alpha), fmax(vec3_dot(t.normal, at->v), 1e-3));
    ambient_lobe(ambient, normal, 1.0f, false, even);
    relume_prefiltered_maps_specular(shines, ambient->prefiltered, axis, (float)exponent);
    for (int c = 0; c < 3; c++) {
        const double f0 = (double)float_from_half(t.specular[c]);
        const double diffuse = (double)float_from_half(t.diffuse[c]);
        rgb[c] = (float)((1.0 - DIELECTRIC * part[0] - part[1]) * diffuse * (double)even[c] +
                         (f0 * part[0] + part[1]) * (double)shines[c]);
    }
}

// A scalar product, the half vector, D, V, F, two colours.
static struct relume_btf_cost cost(const relume_btf_fitted *m)
{
    (void)m;
    return (struct relume_btf_cost){.fetches = 3, .light_ops = 24};
}

const struct relume_btf_model model_painted = {
    .name = "painted",
    .summary = "glTF's metal and roughness, with normals",
    .layout = layout,
    .eval = eval,
    .cost = cost,
    .lit = lit,
};
