// painted.c - materials of pictures in place of measurements, in the terms of glTF 2.0 (Khronos
// 2021, appendix B): a colour, how much of a metal it is, and how rough
//
// They become models that there are already: a lit texture where nothing shines, else one Lafortune
// lobe for each texel (model_laf.c) about the mirrored eye. Its exponent is a quarter of the one
// that gives Blinn's lobe the peak of GGX's distribution, 2 / a^2 - 2 (Walter et al. 2007), since
// the half vector turns by half; its height sends back F0 of even light. That the reflectance grows
// towards grazing angles is left out.
#include "base/memory.h"
#include "base/params.h"
#include "btf/btf.h"
#include "btf_model/model.h"

#include <relume/image.h>
#include <string.h>

static const float DIELECTRIC = 0.04f;  // F0 of all that is no metal
static const float MATTE = 0.9f;        // as rough as this it is a matte surface
static const float LEAST_ROUGHNESS = 0.1f;
enum { MOST_SIDE = 2048 };

// One level: what is diffuse, F0, and one channel of roughness.
struct layers {
    struct relume_image diffuse, specular, roughness;
};

static void layers_destroy(struct layers *l)
{
    relume_image_destroy(&l->diffuse);
    relume_image_destroy(&l->specular);
    relume_image_destroy(&l->roughness);
}

static float within(float x)
{
    return fminf(fmaxf(x, 0.0f), 1.0f);  // NaN: 0
}

static void fill_layers(struct layers *l, const struct relume_image *colour,
                        const struct relume_image *surface, const struct relume_btf_paint_params *p)
{
    const size_t texels = (size_t)l->diffuse.width * (size_t)l->diffuse.height;
    for (size_t i = 0; i < texels; i++) {
        const float green = surface->data ? surface->data[3 * i + 1] : 1.0f;
        const float blue = surface->data ? surface->data[3 * i + 2] : 1.0f;
        const float metal = within(p->metallic * blue);
        l->roughness.data[i] = fmaxf(within(p->roughness * green), LEAST_ROUGHNESS);
        for (size_t c = 0; c < 3; c++) {
            const float base =
                within(p->factor[c] * (colour->data ? colour->data[3 * i + c] : 1.0f));
            l->diffuse.data[3 * i + c] = base * (1.0f - metal);
            l->specular.data[3 * i + c] = DIELECTRIC + (base - DIELECTRIC) * metal;
        }
    }
}

// Both pictures of one size; what there is none of stays empty.
static relume_status make_layers(struct layers *l, const struct relume_btf_paint_params *p)
{
    const struct relume_image none = {0}, *const given[2] = {p->colour, p->surface};
    struct relume_image scaled[2] = {none, none};
    int side[2] = {1, 1};
    for (int i = 0; i < 2; i++) {
        side[0] = given[i] && given[i]->width > side[0] ? given[i]->width : side[0];
        side[1] = given[i] && given[i]->height > side[1] ? given[i]->height : side[1];
    }
    for (int a = 0; a < 2; a++)
        side[a] = side[a] < MOST_SIDE ? side[a] : MOST_SIDE;
    relume_status status = relume_image_create(&l->diffuse, side[0], side[1], 3);
    if (!status)
        status = relume_image_create(&l->specular, side[0], side[1], 3);
    if (!status)
        status = relume_image_create(&l->roughness, side[0], side[1], 1);
    for (int i = 0; i < 2 && !status; i++)
        if (given[i])
            status = relume_image_scale(&scaled[i], given[i], side[0], side[1],
                                        relume_scale_params(.threads = p->threads));
    if (!status)
        fill_layers(l, &scaled[0], &scaled[1], p);
    relume_image_destroy(&scaled[0]);
    relume_image_destroy(&scaled[1]);
    return status;
}

static bool is_matte(const struct layers *l, const struct relume_btf_paint_params *p)
{
    const size_t texels = (size_t)l->roughness.width * (size_t)l->roughness.height;
    for (size_t i = 0; i < texels; i++)
        if (l->roughness.data[i] < MATTE)
            return false;
    return p->metallic == 0.0f;
}

static relume_status halve(struct relume_image *image, int width, int height, int threads)
{
    struct relume_image half;
    const relume_status status =
        relume_image_scale(&half, image, width, height, relume_scale_params(.threads = threads));
    if (status)
        return status;
    relume_image_destroy(image);
    *image = half;
    return RELUME_OK;
}

static relume_status halve_all(struct layers *l, int threads)
{
    const int width = btf_half_side(l->diffuse.width), height = btf_half_side(l->diffuse.height);
    relume_status status = halve(&l->diffuse, width, height, threads);
    if (!status)
        status = halve(&l->specular, width, height, threads);
    return status ? status : halve(&l->roughness, width, height, threads);
}

// ---------------------------------------------------------------- models

// Those of a coarse set: they bound what is known, and nothing is interpolated between them.
static relume_status set_directions(relume_btf_fitted *m, const struct relume_log *log)
{
    const struct relume_btf_set *set = relume_btf_set_find("coarse");
    const size_t n = (size_t)set->count;
    m->views = m->lights = set->count;
    m->view = mem_array(n, sizeof *m->view);
    m->light = mem_array(n, sizeof *m->light);
    if (!m->view || !m->light)
        return RELUME_ENOMEM;
    relume_btf_set_directions(set, m->view);
    relume_btf_set_directions(set, m->light);
    const relume_status status =
        relume_direction_mesh_create(&m->view_mesh, m->view, m->views, log);
    return status ? status : relume_direction_mesh_create(&m->light_mesh, m->light, m->lights, log);
}

// As the layouts of model_lit.c and model_laf.c have it.
enum { COLOUR, HIGHLIGHT, LOBE };

static void fill_matte(relume_btf_fitted *m, const struct layers *l)
{
    for (size_t i = 0; i < 3 * m->texels; i++)
        model_halfs(m, COLOUR)[i] = half_from_float(l->diffuse.data[i]);
}

static void fill_glossy(relume_btf_fitted *m, const struct layers *l)
{
    for (size_t i = 0; i < m->texels; i++) {
        const float a = l->roughness.data[i] * l->roughness.data[i];
        const float n = fmaxf((2.0f / (a * a) - 2.0f) / 4.0f, 1.0f);
        const float lobe[4] = {-1.0f, -1.0f, 1.0f, n};
        for (size_t c = 0; c < 3; c++) {
            const float f0 = l->specular.data[3 * i + c];
            model_halfs(m, COLOUR)[3 * i + c] =
                half_from_float(l->diffuse.data[3 * i + c] * (1.0f - DIELECTRIC));
            model_halfs(m, HIGHLIGHT)[3 * i + c] = half_from_float(f0 * 0.5f * (n + 2.0f));
        }
        for (size_t k = 0; k < 4; k++)
            model_halfs(m, LOBE)[4 * i + k] = half_from_float(lobe[k]);
    }
}

static relume_status make_level(relume_btf_fitted **out, const struct layers *l, bool matte,
                                const struct relume_log *log)
{
    relume_btf_fitted *m = *out = mem_zeroed(1, sizeof *m);
    if (!m)
        return RELUME_ENOMEM;
    m->model = matte ? &model_lit : &model_laf;
    m->width = l->diffuse.width, m->height = l->diffuse.height;
    m->texels = (size_t)m->width * (size_t)m->height;
    m->lobes = !matte;
    relume_status status = set_directions(m, log);
    if (!status)
        status = model_make_arrays(m);
    if (!status)
        (matte ? fill_matte : fill_glossy)(m, l);
    return status;
}

static relume_status make_levels(relume_btf_fitted **out, struct layers *l,
                                 const struct relume_btf_paint_params *p)
{
    const bool matte = is_matte(l, p);
    relume_btf_fitted **next = out;
    relume_status status = make_level(next, l, matte, p->log);
    while (!status && (*next)->texels > 1) {
        next = &(*next)->half;
        status = halve_all(l, p->threads);
        if (!status)
            status = make_level(next, l, matte, p->log);
    }
    return status;
}

relume_status relume_btf_paint(relume_btf_fitted **out,
                               const struct relume_btf_paint_params *params)
{
    const struct relume_btf_paint_params p = PARAMS_WORK(relume_btf_paint_params, params);
    struct layers l = {.diffuse = {0}};
    *out = NULL;
    if ((p.colour && p.colour->channels != 3) || (p.surface && p.surface->channels != 3))
        return RELUME_EINVAL;
    relume_status status = make_layers(&l, &p);
    if (!status)
        status = make_levels(out, &l, &p);
    layers_destroy(&l);
    if (status)
        relume_btf_fitted_destroy(out);
    else
        model_settle(*out);
    return status;
}
