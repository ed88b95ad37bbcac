// painted.c - materials of pictures in place of measurements, in the terms of glTF 2.0 (Khronos
// 2021, appendix B): a colour, how much of a metal it is, how rough, and normals
//
// Where nothing shines and there are no normals they become a lit texture, else model_painted.c. On
// coarser levels of detail normals are means, and what a mean is shorter than 1 by widens the
// highlight: 1 - |n| is half the variance of slopes, and GGX's alpha^2 is like that variance
// (Toksvig 2005).
#include "core/base/memory.h"
#include "core/base/params.h"
#include "material/btf/btf.h"
#include "material/btf/values.h"
#include "material/model/model.h"

#include <relume/image.h>
#include <string.h>

static const float DIELECTRIC = 0.04f;  // F0 of all that is no metal
static const float MATTE = 0.9f;        // as rough as this it is a matte surface
static const float LEAST_ROUGHNESS = 0.1f;
enum { MOST_SIDE = 2048 };

// One level: what is diffuse, F0, one channel of roughness, and normals.
struct layers {
    struct relume_image diffuse, specular, roughness, normals;
};

static void layers_destroy(struct layers *l)
{
    relume_image_destroy(&l->diffuse);
    relume_image_destroy(&l->specular);
    relume_image_destroy(&l->roughness);
    relume_image_destroy(&l->normals);
}

static float within(float x)
{
    return fminf(fmaxf(x, 0.0f), 1.0f);  // NaN: 0
}

// Of a picture of normals, in the frame of the surface.
static vec3 normal_of(const float *rgb, double bump)
{
    const vec3 n = vec3_of(bump * (2.0 * (double)rgb[0] - 1.0), bump * (2.0 * (double)rgb[1] - 1.0),
                           2.0 * (double)rgb[2] - 1.0);
    const double LOWEST = 0.05;
    const double length = vec3_length(n);
    return length > 1e-6 ? vec3_unit(vec3_of(n.x, n.y, fmax(n.z, LOWEST * length)))
                         : vec3_of(0, 0, 1);
}

enum { COLOUR_PICTURE, SURFACE_PICTURE, NORMAL_PICTURE, PICTURES };

static void fill_normals(struct layers *l, const struct relume_image *picture, double bump)
{
    const size_t texels = (size_t)l->normals.width * (size_t)l->normals.height;
    for (size_t i = 0; i < texels; i++)
        vec3_store(l->normals.data + 3 * i,
                   picture->data ? normal_of(picture->data + 3 * i, bump) : vec3_of(0, 0, 1));
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

// All pictures of one size; what there is none of stays empty.
static relume_status make_layers(struct layers *l, const struct relume_btf_paint_params *p)
{
    const struct relume_image *const given[PICTURES] = {p->colour, p->surface, p->normals};
    struct relume_image scaled[PICTURES] = {{0}};
    int side[2] = {1, 1};
    for (int i = 0; i < PICTURES; i++) {
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
    if (!status)
        status = relume_image_create(&l->normals, side[0], side[1], 3);
    for (int i = 0; i < PICTURES && !status; i++)
        if (given[i])
            status = relume_image_scale(&scaled[i], given[i], side[0], side[1],
                                        relume_scale_params(.threads = p->threads));
    if (!status) {
        fill_layers(l, &scaled[COLOUR_PICTURE], &scaled[SURFACE_PICTURE], p);
        fill_normals(l, &scaled[NORMAL_PICTURE], (double)p->bump);
    }
    for (int i = 0; i < PICTURES; i++)
        relume_image_destroy(&scaled[i]);
    return status;
}

static bool is_matte(const struct layers *l, const struct relume_btf_paint_params *p)
{
    const size_t texels = (size_t)l->roughness.width * (size_t)l->roughness.height;
    for (size_t i = 0; i < texels; i++)
        if (l->roughness.data[i] < MATTE)
            return false;
    return p->metallic == 0.0f && !p->normals;
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
    if (!status)
        status = halve(&l->roughness, width, height, threads);
    return status ? status : halve(&l->normals, width, height, threads);
}

// ---------------------------------------------------------------- models

// They bound what is known, and nothing is interpolated between them: the pole, and rings down to
// all but the horizon, where reflectances grow.
enum { RING = 12, DIRECTIONS = 1 + 2 * RING };

static void fill_directions(vec3 out[DIRECTIONS])
{
    static const double height[2] = {0.7, 0.01};
    out[0] = vec3_of(0, 0, 1);
    for (int i = 1; i < DIRECTIONS; i++) {
        const double z = height[(i - 1) / RING], r = sqrt(1.0 - z * z);
        const double phi = 2.0 * M_PI * ((i - 1) % RING + 0.5 * ((i - 1) / RING)) / RING;
        out[i] = vec3_of(r * cos(phi), r * sin(phi), z);
    }
}

static relume_status set_directions(relume_btf_fitted *m, const struct relume_log *log)
{
    m->views = m->lights = DIRECTIONS;
    m->view = mem_array(DIRECTIONS, sizeof *m->view);
    m->light = mem_array(DIRECTIONS, sizeof *m->light);
    if (!m->view || !m->light)
        return RELUME_ENOMEM;
    fill_directions(m->view);
    fill_directions(m->light);
    const relume_status status =
        relume_direction_mesh_create(&m->view_mesh, m->view, m->views, log);
    return status ? status : relume_direction_mesh_create(&m->light_mesh, m->light, m->lights, log);
}

// As the layouts of model_lit.c and model_painted.c have it.
enum { COLOUR, HIGHLIGHT, SHAPE };

static void fill_matte(relume_btf_fitted *m, const struct layers *l)
{
    for (size_t i = 0; i < 3 * m->texels; i++)
        model_halfs(m, COLOUR)[i] = half_from_float(l->diffuse.data[i]);
}

static void fill_glossy(relume_btf_fitted *m, const struct layers *l)
{
    fill_matte(m, l);
    for (size_t i = 0; i < 3 * m->texels; i++)
        model_halfs(m, HIGHLIGHT)[i] = half_from_float(l->specular.data[i]);
    for (size_t i = 0; i < m->texels; i++) {
        const vec3 mean = vec3_floats(l->normals.data + 3 * i);
        const double length = vec3_length(mean), r = (double)l->roughness.data[i];
        const double wide = r * r * r * r + 2.0 * fmax(1.0 - length, 0.0);
        const vec3 n = length > 1e-6 ? vec3_unit(mean) : vec3_of(0, 0, 1);
        const double shape[4] = {n.x, n.y, n.z, sqrt(fmin(wide, 1.0))};
        for (size_t k = 0; k < 4; k++)
            model_halfs(m, SHAPE)[4 * i + k] = half_from_float((float)shape[k]);
    }
}

static relume_status make_level(relume_btf_fitted **out, const struct layers *l, bool matte,
                                const struct relume_log *log)
{
    relume_btf_fitted *m = *out = mem_zeroed(1, sizeof *m);
    if (!m)
        return RELUME_ENOMEM;
    m->model = matte ? &model_lit : &model_painted;
    m->width = l->diffuse.width, m->height = l->diffuse.height;
    m->texels = (size_t)m->width * (size_t)m->height;
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
    struct relume_btf_paint_params p = PARAMS_WORK(relume_btf_paint_params, params);
    p.bump = p.bump != 0.0f ? p.bump : 1.0f;
    struct layers l = {.diffuse = {0}};
    *out = NULL;
    if ((p.colour && p.colour->channels != 3) || (p.surface && p.surface->channels != 3) ||
        (p.normals && p.normals->channels != 3))
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
