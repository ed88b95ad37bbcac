// gbrdf.c - rendering a g-BRDF: the eye's ray is followed into the relief, a shadow ray to the
// light, and the reflectance is that of the four texels around, in their frame
#include "material/gbrdf/gbrdf.h"

#include "core/base/half.h"
#include "core/base/memory.h"
#include "material/gbrdf/brdf.h"

#include <string.h>

const char *gbrdf_fault(const struct gbrdf_maps *m)
{
    const size_t texels = (size_t)m->width * (size_t)m->height;
    for (size_t i = 0; i < texels; i++) {
        if (!(fabsf(m->depth[i]) <= 1.0f))
            return "depth: at most one width of the sample";
        // false for NaN too
        if (!(fabsf(float_from_half(m->rotation[i])) <= 65504.0f))
            return "rotation: finite angles";
        if (!(float_from_half(m->r0[i]) >= 0.0f && float_from_half(m->r0[i]) <= 1.0f))
            return "r0: 0 to 1";
        if (m->label[i] >= m->materials)
            return "label: materials that have an NDF";
    }
    if (!(*m->light > 0.0f && *m->light < 1e30f))
        return "light: above 0";
    for (size_t i = 0; i < 3 * texels; i++)
        if (!(float_from_half(m->diffuse[i]) >= 0.0f && float_from_half(m->diffuse[i]) <= 1.0f))
            return "diffuse: 0 to 1";
    for (size_t i = 0; i < (size_t)m->materials * NDF_VALUES; i++)
        if (!(float_from_half(m->ndf[i]) >= 0.0f && float_from_half(m->ndf[i]) <= 65504.0f))
            return "ndf: finite values of at least 0";
    return NULL;
}

// ---------------------------------------------------------------- preparing

static void fill_texel(struct gbrdf_texel *t, const struct gbrdf_maps *maps, size_t i, vec3 n)
{
    const float angle = float_from_half(maps->rotation[i]);
    *t = (struct gbrdf_texel){.normal = {(float)n.x, (float)n.y, (float)n.z},
                              .turn = {cosf(angle), sinf(angle)},
                              .r0 = float_from_half(maps->r0[i]),
                              .label = maps->label[i]};
    for (int c = 0; c < 3; c++)
        t->diffuse[c] = float_from_half(maps->diffuse[3 * i + (size_t)c]);
}

relume_status gbrdf_prepare(struct gbrdf **out, const struct gbrdf_maps *maps)
{
    const size_t texels = (size_t)maps->width * (size_t)maps->height;
    const size_t values = (size_t)maps->materials * NDF_VALUES;
    struct gbrdf *g = mem_array(1, sizeof *g + texels * sizeof(struct gbrdf_texel) +
                                       (texels + values) * sizeof(float));
    *out = g;
    if (!g)
        return RELUME_ENOMEM;
    struct gbrdf_texel *texel = (struct gbrdf_texel *)(g + 1);
    float *z = (float *)(texel + texels), *ndf = z + texels;
    for (size_t i = 0; i < texels; i++)
        z[i] = maps->depth[i] * (float)maps->width;
    for (size_t i = 0; i < values; i++)
        ndf[i] = float_from_half(maps->ndf[i]);
    *g = (struct gbrdf){
        {maps->width, maps->height, z, 0.0f, 0.0f}, texel, ndf, (double)*maps->light};
    meso_settle(&g->meso);
    for (size_t i = 0; i < texels; i++)
        fill_texel(
            &texel[i], maps, i,
            meso_normal(&g->meso, (int)(i % (size_t)maps->width), (int)(i / (size_t)maps->width)));
    return RELUME_OK;
}

// ---------------------------------------------------------------- evaluating

vec3 gbrdf_local(const struct gbrdf_texel *t, vec3 d)
{
    const vec3 n = vec3_of((double)t->normal[0], (double)t->normal[1], (double)t->normal[2]);
    const vec3 u = vec3_upright(d, n);
    const double c = (double)t->turn[0], s = (double)t->turn[1];
    return vec3_of(c * u.x + s * u.y, c * u.y - s * u.x, u.z);
}

static void unit(float *v, int n)
{
    float sum = 0.0f;
    for (int i = 0; i < n; i++)
        sum += v[i] * v[i];
    const float scale = sum > 1e-12f ? 1.0f / sqrtf(sum) : 0.0f;
    for (int i = 0; i < n; i++)
        v[i] *= scale;
    v[n == 3 ? 2 : 0] += sum > 1e-12f ? 0.0f : 1.0f;
}

// All but the label, which has no mean.
static struct gbrdf_texel between(const struct gbrdf *g, const struct bilinear *b)
{
    struct gbrdf_texel t = {.label = 0};
    for (int k = 0; k < 4; k++) {
        const struct gbrdf_texel *from = &g->texel[b->at[k]];
        const float share = bilinear_sharef(b, k, 1.0f);
        for (int c = 0; c < 3; c++) {
            t.normal[c] += share * from->normal[c];
            t.diffuse[c] += share * from->diffuse[c];
        }
        t.turn[0] += share * from->turn[0];
        t.turn[1] += share * from->turn[1];
        t.r0 += share * from->r0;
    }
    unit(t.normal, 3);
    unit(t.turn, 2);
    return t;
}

// The distributions of the materials around, by their shares.
static void blended_ndf(const struct gbrdf *g, const struct bilinear *b, vec3 h, float rgb[3])
{
    float share[4];
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    for (int k = 0; k < 4; k++)
        share[k] = bilinear_sharef(b, k, 1.0f);
    for (int k = 0; k < 4; k++) {
        const int label = g->texel[b->at[k]].label;
        for (int j = k + 1; j < 4; j++)
            if (g->texel[b->at[j]].label == label) {
                share[k] += share[j];
                share[j] = 0.0f;
            }
        if (share[k] == 0.0f)
            continue;
        float value[3];
        ndf_at(g->ndf + (size_t)label * NDF_VALUES, h, value);
        for (int c = 0; c < 3; c++)
            rgb[c] += share[k] * value[c];
    }
}

void gbrdf_evaluate(const struct gbrdf *g, double x, double y, vec3 v, vec3 l, float rgb[3])
{
    const vec3 at = meso_seen(&g->meso, x, y, v);
    const struct bilinear b = bilinear_tiled(at.x - 0.5, at.y - 0.5, g->meso.width, g->meso.height);
    const struct gbrdf_texel t = between(g, &b);
    const vec3 k1 = gbrdf_local(&t, l), k2 = gbrdf_local(&t, v);
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (k1.z <= 0.0 || !meso_open(&g->meso, at, l))
        return;
    const vec3 h = vec3_unit(vec3_add(k1, k2));
    float ndf[3];
    blended_ndf(g, &b, h, ndf);
    const double grazing = brdf_grazing(fmax(vec3_dot(k1, h), 0.0));
    const double fresnel = (double)t.r0 + (1.0 - (double)t.r0) * grazing;
    const double scale = M_PI * fresnel / brdf_masking(k1.z, fmax(k2.z, 0.0));
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(g->light * k1.z * ((double)t.diffuse[c] + scale * (double)ndf[c]));
}

// ---------------------------------------------------------------- energy

// What is limited stays a little below all, for what halfs round up; so it is not limited again.
static const double MOST = 0.999, ALLOWED = 0.9998;

static bool keeps_to_it(const struct gbrdf_maps *maps, size_t i, const struct ndf_albedo *albedo)
{
    const float r0 = float_from_half(maps->r0[i]);
    bool good = r0 >= 0.0f && r0 <= 1.0f;
    for (size_t c = 0; good && c < 3; c++) {
        const float cd = float_from_half(maps->diffuse[3 * i + c]);
        good = cd >= 0.0f && (double)cd + ndf_reflects(albedo, (int)c, (double)r0) <= ALLOWED;
    }
    return good;
}

static void limit_texel(struct gbrdf_maps *maps, size_t i, const struct ndf_albedo *albedo)
{
    const double r0 =
        fmin(fmax((double)float_from_half(maps->r0[i]), 0.0), ndf_most_r0(albedo, MOST));
    maps->r0[i] = half_from_float((float)r0);
    for (int c = 0; c < 3; c++) {
        const double rest = MOST - ndf_reflects(albedo, c, r0);
        uint16_t *cd = &maps->diffuse[3 * i + (size_t)c];
        *cd = half_from_float(fminf(fmaxf(float_from_half(*cd), 0.0f), (float)fmax(rest, 0.0)));
    }
}

void gbrdf_limit_material(struct gbrdf_maps *maps, int label)
{
    uint16_t *ndf = maps->ndf + (size_t)label * NDF_VALUES;
    float value[NDF_VALUES];
    struct ndf_albedo albedo;
    double share = 0.0;
    for (int i = 0; i < NDF_VALUES; i++)
        value[i] = fmaxf(float_from_half(ndf[i]), 0.0f);
    ndf_albedo(&albedo, value);
    for (int c = 0; c < 3; c++)
        share = fmax(share, ndf_reflects(&albedo, c, 0.0));
    if (share > ALLOWED) {
        ndf_limit(value, 0.0, MOST);
        ndf_albedo(&albedo, value);
    }
    for (int i = 0; i < NDF_VALUES; i++)
        ndf[i] = half_from_float(value[i]);
    for (size_t i = 0; i < (size_t)maps->width * (size_t)maps->height; i++)
        if (maps->label[i] == label && !keeps_to_it(maps, i, &albedo))
            limit_texel(maps, i, &albedo);
}

void gbrdf_limit_energy(struct gbrdf_maps *maps)
{
    for (int label = 0; label < maps->materials; label++)
        gbrdf_limit_material(maps, label);
}
