// model_gbrdf.c - the g-BRDF: a relief, a few distributions of micro-normals, and for each texel a
// colour, a reflectance, a rotation and a label, all of which people can edit (src/material/gbrdf)
#include "core/base/memory.h"
#include "material/gbrdf/fit.h"
#include "material/model/model.h"
#include "material/model/model_gbrdf.h"

#include <string.h>

enum { DEPTH, ROTATION, DIFFUSE, R0, LABEL, NDF, LIGHT };

static void layout(relume_btf_fitted *m)
{
    const size_t h = (size_t)m->height, w = (size_t)m->width, n = (size_t)m->clusters;
    model_add(m, "depth", NPY_FLOAT, true, 0, MODEL_SHAPE(h, w));
    model_add(m, "rotation", NPY_HALF, true, 0, MODEL_SHAPE(h, w));
    model_add(m, "diffuse", NPY_HALF, true, 0, MODEL_SHAPE(h, w, 3));
    model_add(m, "r0", NPY_HALF, true, 0, MODEL_SHAPE(h, w));
    model_add(m, "label", NPY_U8, true, n, MODEL_SHAPE(h, w));
    model_add(m, "ndf", NPY_HALF, false, 0, MODEL_SHAPE(n, NDF_SIDE, NDF_SIDE, 3));
    model_add(m, "light", NPY_FLOAT, false, 0, MODEL_SHAPE(1));
}

struct gbrdf_maps gbrdf_maps_of(const relume_btf_fitted *m)
{
    return (struct gbrdf_maps){
        .width = m->width,
        .height = m->height,
        .materials = m->clusters,
        .depth = m->array[DEPTH].data,
        .rotation = m->array[ROTATION].data,
        .diffuse = m->array[DIFFUSE].data,
        .r0 = m->array[R0].data,
        .label = m->array[LABEL].data,
        .ndf = m->array[NDF].data,
        .light = m->array[LIGHT].data,
    };
}

relume_status gbrdf_maps_store(relume_btf_fitted *m, const struct gbrdf_maps *maps)
{
    const void *from[] = {maps->depth, maps->rotation, maps->diffuse, maps->r0,
                          maps->label, maps->ndf,      maps->light};
    m->clusters = maps->materials;
    const relume_status status = model_make_arrays(m);
    for (int i = 0; !status && i < m->arrays; i++)
        memcpy(m->array[i].data, from[i], npy_bytes(&m->array[i].npy));
    return status;
}

// As many materials as were found, in place of as many as there may be.
static relume_status fit(struct fitting *f)
{
    relume_btf_fitted *m = f->out;
    struct gbrdf_maps found;
    relume_status status = gbrdf_fit(&found, f->btf,
                                     &(struct gbrdf_fit_params){.log = f->log,
                                                                .materials = m->clusters,
                                                                .exact = f->counts_given,
                                                                .resample = f->resample,
                                                                .seed = f->seed,
                                                                .threads = f->threads});
    if (!status)
        status = gbrdf_maps_store(m, &found);
    gbrdf_maps_free(&found);
    return status;
}

static const char *fault(const relume_btf_fitted *m)
{
    const struct gbrdf_maps maps = gbrdf_maps_of(m);
    return gbrdf_fault(&maps);
}

static relume_status prepare(relume_btf_fitted *m)
{
    const struct gbrdf_maps maps = gbrdf_maps_of(m);
    struct gbrdf *g;
    const relume_status status = gbrdf_prepare(&g, &maps);
    m->prepared = g;
    return status;
}

// Light from below this is taken for light from it where n.l is divided out again.
static const double LEAST_COSINE = 1e-6;

static void eval(const relume_btf_fitted *m, const struct model_at *at, float rgb[3])
{
    const size_t width = (size_t)m->width;
    const double middle[2] = {(double)(at->texel % width) + 0.5, (double)(at->texel / width) + 0.5};
    const double *place = at->place ? at->place : middle;
    gbrdf_evaluate(m->prepared, place[0], place[1], at->v, at->l, rgb);
    for (int c = 0; c < 3 && m->without_cosine; c++)
        rgb[c] /= (float)fmax(at->l.z, LEAST_COSINE);
}

static relume_status truth(const relume_btf_fitted *m, struct relume_image *relief,
                           struct relume_image *normals)
{
    const struct gbrdf *g = m->prepared;
    relume_status status = relume_image_create(relief, m->width, m->height, 1);
    if (!status)
        status = relume_image_create(normals, m->width, m->height, 3);
    for (size_t i = 0; !status && i < m->texels; i++) {
        relief->data[i] = model_floats(m, DEPTH)[i];
        memcpy(normals->data + 3 * i, g->texel[i].normal, sizeof g->texel[i].normal);
    }
    return status;
}

// The steps of both rays are what it costs; these are of a relief as high as a tenth of its width,
// of 256 texels, seen and lit at 45 degrees: 51 steps, each of a place and a height.
static struct relume_btf_cost cost(const relume_btf_fitted *m)
{
    (void)m;
    return (struct relume_btf_cost){
        .ops = 51 + 4, .fetches = 51 + 3, .light_ops = 51 + 14, .light_fetches = 51 + 4};
}

const struct relume_btf_model model_gbrdf = {
    .name = "gbrdf",
    .summary = "relief, a few NDFs, and maps of colour, reflectance, rotation and label to edit",
    .continuous = true,
    .clusters = 8,
    .most_clusters = 64,
    .layout = layout,
    .fit = fit,
    .fits = gbrdf_fits,
    .eval = eval,
    .prepare = prepare,
    .cost = cost,
    .fault = fault,
    .truth = truth,
};
