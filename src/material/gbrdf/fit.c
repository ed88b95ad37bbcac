// fit.c - from a BTF to a g-BRDF (Menzel 2011, sections 6.3.1 to 6.3.3): the values are drawn onto
// the relief; each texel gets parameters of its own, whose distributions are clustered; then each
// material gets one distribution from many texels, and each texel what is left to it
#include "material/gbrdf/fit.h"

#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "material/btf/values.h"
#include "material/gbrdf/als.h"
#include "material/gbrdf/cluster.h"
#include "material/gbrdf/depth.h"

#include <stdatomic.h>
#include <string.h>

enum {
    COARSE_SIDE = 16,     // of the distribution of a single texel
    COARSE_PAIRS = 3500,  // that tell it: some 10 a cell
    COARSE_ROUNDS = 12,
    MATERIAL_TEXELS = 192,  // that a material's distribution is learned from
    MATERIAL_ROUNDS = 12,
    RELIEF_ROUNDS = 2,
};

relume_status gbrdf_maps_create(struct gbrdf_maps *out, int width, int height, int materials)
{
    const size_t texels = (size_t)width * (size_t)height;
    *out = (struct gbrdf_maps){
        .width = width,
        .height = height,
        .materials = materials,
        .depth = mem_zeroed(texels, sizeof *out->depth),
        .rotation = mem_zeroed(texels, sizeof *out->rotation),
        .diffuse = mem_zeroed(3 * texels, sizeof *out->diffuse),
        .r0 = mem_zeroed(texels, sizeof *out->r0),
        .label = mem_zeroed(texels, sizeof *out->label),
        .ndf = mem_zeroed((size_t)materials * NDF_VALUES, sizeof *out->ndf),
        .light = mem_zeroed(1, sizeof *out->light),
    };
    return out->depth && out->rotation && out->diffuse && out->r0 && out->label && out->ndf &&
                   out->light
               ? RELUME_OK
               : RELUME_ENOMEM;
}

void gbrdf_maps_free(struct gbrdf_maps *maps)
{
    mem_free(maps->depth);
    mem_free(maps->rotation);
    mem_free(maps->diffuse);
    mem_free(maps->r0);
    mem_free(maps->label);
    mem_free(maps->ndf);
    mem_free(maps->light);
    *maps = (struct gbrdf_maps){.width = 0};
}

static const double BRIGHTEST = 0.6;

struct gbrdf_fitting {
    struct flat flat;
    const struct gbrdf_fit_params *p;
    size_t texels, pairs;
    double light;
    struct als_texel *texel;
    float *polar;
    struct clusters clusters;
    float (*ndf)[NDF_VALUES];  // [materials]
    atomic_bool failed;
};

// ---------------------------------------------------------------- units

// The share of light from above that a texel sends back, by the views of the light nearest to the
// pole; values of cameras may be in any unit.
static double albedo_of(const relume_btf *btf, int light, size_t texel)
{
    const struct relume_btf_info *info = relume_btf_info(btf);
    double sum = 0.0, all = 0.0;
    for (int v = 0; v < info->views; v++) {
        const uint16_t *p = relume_btf_picture(btf, v, light) + 3 * texel;
        for (int c = 0; c < 3; c++)
            sum += info->view[v].z * (double)float_from_half(p[c]) / 3.0;
        all += info->view[v].z;
    }
    return sum / (all * (info->without_cosine ? 1.0 : info->light[light].z));
}

// What values are to be divided by: 1, or, where a texel seems to send back more than it gets, so
// much that the brightest sends back BRIGHTEST.
static double light_of(const relume_btf *btf)
{
    const struct relume_btf_info *info = relume_btf_info(btf);
    double most = 0.0;
    int top = 0;
    for (int l = 1; l < info->lights; l++)
        top = info->light[l].z > info->light[top].z ? l : top;
    for (size_t i = 0; i < btf_texels(btf); i++)
        most = fmax(most, albedo_of(btf, top, i));
    return most > 1.0 ? most / BRIGHTEST : 1.0;
}

// ---------------------------------------------------------------- texels alone

static void fit_alone(void *context, size_t texel, const float *values)
{
    struct gbrdf_fitting *w = context;
    struct als_samples samples = {mem_array(als_blocks(w->pairs), sizeof *samples.block), 0, 0.0f};
    struct als_sums *sums = mem_array(1, sizeof *sums);
    float q[COARSE_SIDE * COARSE_SIDE];
    const struct als_form form = {COARSE_SIDE, 1, 1 + (int)w->pairs / COARSE_PAIRS, w->light};
    if (samples.block && sums) {
        als_gather(&samples, &w->flat, texel, 0.0, values, &form);
        als_fit_alone(&w->texel[texel], q, sums, &samples, &form, COARSE_ROUNDS);
        polar_from(w->polar + texel * POLAR_VALUES, q, COARSE_SIDE);
    } else
        w->failed = true;
    mem_free(samples.block);
    mem_free(sums);
}

// ---------------------------------------------------------------- materials

struct learner {
    size_t *texel;  // [count]
    int count;
    struct als_block *block;  // of all texels
    struct als_samples *samples;
    struct als_texel *t;
    struct als_sums *sums;
};

static struct als_form fine_form(const struct gbrdf_fitting *w)
{
    return (struct als_form){NDF_SIDE, 3, 1, w->light};
}

// Texels of a label, evenly over the sample.
static int choose_texels(size_t *out, const struct gbrdf_fitting *w, int label)
{
    size_t all = 0, seen = 0;
    int count = 0;
    for (size_t i = 0; i < w->texels; i++)
        all += w->clusters.label[i] == label;
    for (size_t i = 0; i < w->texels; i++)
        if (w->clusters.label[i] == label) {
            seen++;
            if (all <= MATERIAL_TEXELS ||
                seen * MATERIAL_TEXELS / all != (seen - 1) * MATERIAL_TEXELS / all)
                out[count++] = i;
        }
    return count;
}

static bool gather_texels(struct learner *l, const struct gbrdf_fitting *w)
{
    float *values = mem_array(3 * w->pairs, sizeof *values);
    const struct als_form form = fine_form(w);
    for (int i = 0; values && i < l->count; i++) {
        btf_gather(w->flat.btf, l->texel[i], 1, values);
        l->samples[i].block = l->block + (size_t)i * als_blocks(w->pairs);
        als_gather(&l->samples[i], &w->flat, l->texel[i], (double)w->clusters.rotation[l->texel[i]],
                   values, &form);
        l->t[i] = w->texel[l->texel[i]];
    }
    mem_free(values);
    return values != NULL;
}

// Texels beside q, q beside texels. The scale that a texel would like is a way for q to move that
// single cells take long to go.
static void learn_round(struct learner *l, const struct gbrdf_fitting *w, float *q)
{
    const struct als_form form = fine_form(w);
    double scale = 0.0, diffuse[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < l->count; i++) {
        als_look(&l->samples[i], q, &form);
        scale += als_fit_texel(&l->t[i], 1.0f, &form, &l->samples[i], false) / l->count;
    }
    for (int i = 0; i < NDF_VALUES; i++)
        q[i] *= (float)scale;
    memset(l->sums, 0, sizeof *l->sums);
    for (int i = 0; i < l->count; i++) {
        als_fit_texel(&l->t[i], (float)scale, &form, &l->samples[i], true);
        als_add(l->sums, &l->t[i], (float)scale, &form, &l->samples[i]);
        for (int c = 0; c < 3; c++)
            diffuse[c] += l->t[i].diffuse[c] / l->count;
    }
    als_solve(q, l->sums, &form, diffuse);
}

static void learn_material(void *context, size_t label, int worker)
{
    (void)worker;
    struct gbrdf_fitting *w = context;
    struct learner l = {
        .texel = mem_array(MATERIAL_TEXELS + 1, sizeof *l.texel),
        .samples = mem_array(MATERIAL_TEXELS, sizeof *l.samples),
        .t = mem_array(MATERIAL_TEXELS, sizeof *l.t),
        .sums = mem_array(1, sizeof *l.sums),
    };
    l.count = l.texel ? choose_texels(l.texel, w, (int)label) : 0;
    l.block = mem_array((size_t)l.count * als_blocks(w->pairs), sizeof *l.block);
    float *q = w->ndf[label];
    for (int i = 0; i < NDF_VALUES; i++)
        q[i] = 0.05f;
    if (l.texel && l.samples && l.t && l.sums && l.block && gather_texels(&l, w))
        for (int round = 0; l.count && round < MATERIAL_ROUNDS; round++)
            learn_round(&l, w, q);
    else
        w->failed = true;
    double r0 = 0.0;
    for (int i = 0; i < l.count && !w->failed; i++)
        r0 += l.t[i].r0 / l.count;
    ndf_limit(q, r0, 1.0);
    mem_free(l.texel);
    mem_free(l.block);
    mem_free(l.samples);
    mem_free(l.t);
    mem_free(l.sums);
}

// ---------------------------------------------------------------- texels beside their material

static void fit_beside(void *context, size_t texel, const float *values)
{
    struct gbrdf_fitting *w = context;
    struct als_samples samples = {mem_array(als_blocks(w->pairs), sizeof *samples.block), 0, 0.0f};
    const struct als_form form = fine_form(w);
    if (samples.block) {
        als_gather(&samples, &w->flat, texel, (double)w->clusters.rotation[texel], values, &form);
        als_look(&samples, w->ndf[w->clusters.label[texel]], &form);
        als_fit_texel(&w->texel[texel], 1.0f, &form, &samples, true);
    } else
        w->failed = true;
    mem_free(samples.block);
}

static relume_status for_texels(struct gbrdf_fitting *w, const char *what,
                                void (*body)(void *context, size_t texel, const float *values))
{
    const relume_status status =
        btf_for_texels(w->flat.btf, w->p->threads, w->p->log, what, w, body);
    return status ? status : w->failed ? RELUME_ENOMEM : RELUME_OK;
}

static void store(struct gbrdf_maps *out, const struct gbrdf_fitting *w)
{
    *out->light = (float)w->light;
    memcpy(out->label, w->clusters.label, w->texels);
    for (size_t i = 0; i < w->texels; i++) {
        out->rotation[i] = half_from_float(w->clusters.rotation[i]);
        out->r0[i] = half_from_float((float)w->texel[i].r0);
        for (size_t c = 0; c < 3; c++)
            out->diffuse[3 * i + c] = half_from_float((float)w->texel[i].diffuse[c]);
    }
    for (size_t k = 0; k < (size_t)out->materials; k++)
        for (size_t i = 0; i < NDF_VALUES; i++)
            out->ndf[k * NDF_VALUES + i] = half_from_float(w->ndf[k][i]);
    gbrdf_limit_energy(out);
}

static relume_status find_materials(struct gbrdf_fitting *w, const struct gbrdf_maps *out)
{
    relume_status status = for_texels(w, "fitting texels", fit_alone);
    if (!status)
        status = clusters_find(&w->clusters, w->polar, out->width, out->height, w->p->materials,
                               w->p->exact, w->p->seed, w->p->threads);
    if (status)
        return status;
    w->ndf = mem_zeroed((size_t)w->clusters.count, sizeof *w->ndf);
    if (!w->ndf)
        return RELUME_ENOMEM;
    thread_for(w->p->threads, (size_t)w->clusters.count, learn_material, w);
    return for_texels(w, "fitting materials", fit_beside);
}

// ---------------------------------------------------------------- the relief

static relume_status relief_by(struct meso *relief, float *z, const relume_btf *btf,
                               const struct picture_pair *pairs, int count,
                               const struct gbrdf_fit_params *p)
{
    struct flat flat = {.btf = NULL};
    vec3 *normal = mem_array(btf_texels(btf), sizeof *normal);
    relume_status status =
        normal ? depth_find(z, btf, pairs, count, p->threads, p->log) : RELUME_ENOMEM;
    meso_settle(relief);
    // normals need a relief to draw values onto, and improve it
    for (int round = 0; round < RELIEF_ROUNDS && !status; round++) {
        status = flat_make(&flat, btf, relief, p->threads, p->log);
        if (!status)
            status = depth_normals(normal, &flat, pairs, count, p->threads, p->log);
        if (!status)
            status = depth_fuse(z, normal, relief->width, relief->height);
        meso_settle(relief);
        flat_free(&flat);
    }
    mem_free(normal);
    return status;
}

static bool is_small(const relume_btf *btf)
{
    const struct relume_btf_info *info = relume_btf_info(btf);
    return info->width < DEPTH_LEAST_SIDE || info->height < DEPTH_LEAST_SIDE;
}

bool gbrdf_fits(const relume_btf *btf)
{
    struct picture_pair *pairs;
    int count = 0;
    const relume_status status = pairs_reciprocal(&pairs, &count, btf);
    mem_free(pairs);
    // without memory the fit itself says so
    return is_small(btf) || count || status;
}

static relume_status find_relief(struct meso *relief, float *z, const relume_btf *btf,
                                 const struct gbrdf_fit_params *p)
{
    struct picture_pair *pairs = NULL;
    relume_btf *resampled = NULL;
    int count = 0;
    if (is_small(btf))
        return RELUME_OK;
    relume_status status = pairs_reciprocal(&pairs, &count, btf);
    if (!status && !count && p->resample) {
        mem_free(pairs);
        pairs = NULL;
        status = pairs_resample(&resampled, btf, p->threads, p->log);
        if (!status)
            status = pairs_reciprocal(&pairs, &count, resampled);
    }
    if (!status && !count)
        status = log_fail(p->log, RELUME_EUNFIT,
                          "%s: gbrdf finds the relief by pairs of pictures in which light and eye "
                          "change places, and no light stands where a view is; --resample "
                          "interpolates such lights",
                          btf_name(btf));
    if (!status)
        status = relief_by(relief, z, resampled ? resampled : btf, pairs, count, p);
    relume_btf_destroy(&resampled);
    mem_free(pairs);
    return status;
}

relume_status gbrdf_fit(struct gbrdf_maps *out, const relume_btf *btf,
                        const struct gbrdf_fit_params *p)
{
    const struct relume_btf_info *info = relume_btf_info(btf);
    struct gbrdf_fitting w = {
        .p = p, .texels = btf_texels(btf), .pairs = (size_t)info->views * (size_t)info->lights};
    float *z = mem_zeroed(w.texels, sizeof *z);
    w.light = light_of(btf);
    struct meso relief = {info->width, info->height, z, 0.0f, 0.0f};
    w.texel = mem_zeroed(w.texels, sizeof *w.texel);
    w.polar = mem_array(w.texels * POLAR_VALUES, sizeof *w.polar);
    *out = (struct gbrdf_maps){.width = info->width, .height = info->height};
    relume_status status = z && w.texel && w.polar ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = find_relief(&relief, z, btf, p);
    if (!status)
        status = flat_make(&w.flat, btf, &relief, p->threads, p->log);
    if (!status)
        status = find_materials(&w, out);
    if (!status)
        status = gbrdf_maps_create(out, info->width, info->height, w.clusters.count);
    if (!status) {
        for (size_t i = 0; i < w.texels; i++)
            out->depth[i] = z[i] / (float)info->width;
        store(out, &w);
    }
    flat_free(&w.flat);
    clusters_free(&w.clusters);
    mem_free(w.texel);
    mem_free(w.polar);
    mem_free(w.ndf);
    mem_free(z);
    return status;
}
