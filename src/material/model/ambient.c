// ambient.c - a model under an environment, for one orientation
//
// Values between measured lights are interpolated, so that a value under an environment is a sum
// over the measured lights whose weights are integrals of the radiance: sum_i b_i(l) E(l) dw / pi.
// They are summed over cells of the environment, each at the direction where its energy comes from:
// a cell is far smaller than a triangle of lights, over which b_i are all but linear.
#include "material/model/ambient.h"

#include "core/base/memory.h"
#include "material/btf/values.h"
#include "material/model/environment.h"
#include "relight/light/environment.h"

static vec3 to_sample(const struct relume_btf_frame *f, vec3 d)
{
    return vec3_of(vec3_dot(d, f->right), vec3_dot(d, f->up), vec3_dot(d, f->normal));
}

// What arrives from a cell: from the direction and at the strength that the model is asked for.
static bool arrives(const relume_btf_oriented_light *a, const struct relume_environment_cell *cell,
                    struct relume_direction_blend *blend, struct relume_environment_cell *out)
{
    const vec3 l = to_sample(&a->frame, cell->direction);
    if (!(l.z > 0.0))
        return false;
    *blend = relume_direction_mesh_at(a->model->light_mesh, l);
    const double scale = a->model->without_cosine ? l.z : blend->rim;
    out->direction = blend->direction;
    for (int c = 0; c < 3; c++)
        out->rgb[c] = (float)(scale * (double)cell->rgb[c]);
    return true;
}

static void add_cell(relume_btf_oriented_light *a, const struct relume_environment_cell *cell,
                     const struct relume_direction_blend *b)
{
    const bool bare = a->model->without_cosine;
    for (int c = 0; c < 3; c++) {
        const double sent = (double)cell->rgb[c], among = bare ? sent : sent / b->length;
        a->even[0][c] += (float)sent;
        a->even[1][c] += (float)(bare ? sent : sent * cell->direction.z);
        for (int i = 0; i < b->count; i++)
            a->weight[3 * b->index[i] + c] += (float)(among * b->weight[i]);
    }
}

// Cells as the lobes of the model see them.
static relume_status make_own_maps(relume_btf_oriented_light *a,
                                   struct relume_environment_cell *cell, int n, int threads)
{
    enum { HEIGHT = 48 };
    const bool cosine = a->model->model->lobes_times_cosine && !a->model->without_cosine;
    for (int i = 0; i < n && cosine; i++)
        for (int c = 0; c < 3; c++)
            cell[i].rgb[c] *= (float)cell[i].direction.z;
    return prefiltered_from_cells(&a->own, cell, n, HEIGHT, 0.0, threads);
}

static relume_status fill(relume_btf_oriented_light *a,
                          const struct relume_btf_oriented_light_params *p)
{
    const size_t most = (size_t)a->prefiltered->cells;
    struct relume_environment_cell *cell = mem_array(most, sizeof *cell);
    int n = 0;
    if (!cell)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < most; i++) {
        struct relume_direction_blend b;
        if (arrives(a, &a->prefiltered->cell[i], &b, &cell[n]))
            add_cell(a, &cell[n++], &b);
    }
    const relume_status status =
        p && p->own_maps && a->model->lobes > 0 ? make_own_maps(a, cell, n, p->threads) : RELUME_OK;
    mem_free(cell);
    return status;
}

relume_status relume_btf_oriented_light_create(
    relume_btf_oriented_light **out, const relume_btf_fitted *model,
    const relume_prefiltered_maps *prefiltered, const struct relume_btf_frame *frame,
    const struct relume_btf_oriented_light_params *params)
{
    relume_btf_oriented_light *a = mem_zeroed(1, sizeof *a);
    *out = NULL;
    if (!a)
        return RELUME_ENOMEM;
    a->model = model;
    a->prefiltered = prefiltered;
    a->frame = *frame;
    a->weight = mem_zeroed(3 * (size_t)model->lights, sizeof *a->weight);
    const relume_status status = a->weight ? fill(a, params) : RELUME_ENOMEM;
    if (status)
        relume_btf_oriented_light_destroy(&a);
    *out = a;
    return status;
}

void relume_btf_oriented_light_destroy(relume_btf_oriented_light **ambient)
{
    if (*ambient) {
        relume_prefiltered_maps_destroy(&(*ambient)->own);
        mem_free((*ambient)->weight);
    }
    mem_free(*ambient);
    *ambient = NULL;
}

const float *relume_btf_oriented_light_weights(const relume_btf_oriented_light *ambient)
{
    return ambient->weight;
}

void ambient_even(const relume_btf_oriented_light *a, bool cosine, float rgb[3])
{
    for (int c = 0; c < 3; c++)
        rgb[c] = a->even[cosine][c];
}

void ambient_lobe(const relume_btf_oriented_light *a, const float t[3], float exponent, bool cosine,
                  float rgb[3])
{
    const double length = sqrt((double)(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]));
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (!(length > 1e-9))
        return;
    const vec3 u = vec3_of(t[0] / length, t[1] / length, t[2] / length);
    const struct relume_btf_frame *f = &a->frame;
    double height = exp((double)exponent * log(length));
    if (a->own) {
        relume_prefiltered_maps_specular(rgb, a->own, u, exponent);
        height *= 2.0 / ((double)exponent + 1.0);
    } else {
        const vec3 axis =
            vec3_add(vec3_scale(f->right, u.x), vec3_along(vec3_scale(f->up, u.y), f->normal, u.z));
        relume_prefiltered_maps_lobe(rgb, a->prefiltered, f->normal, axis, exponent, cosine);
    }
    for (int c = 0; c < 3; c++)
        rgb[c] *= (float)height;
}

// What models that know lobes of the light make of it.
static void look_up(const relume_btf_oriented_light *a, const relume_btf_fitted *m, size_t texel,
                    const struct relume_direction_blend *view, float rgb[3])
{
    const int count = m->model->view_grid ? view->count : 1;
    for (int i = 0; i < count; i++) {
        const float weight = m->model->view_grid ? (float)view->weight[i] : 1.0f;
        const struct model_at at = {.texel = texel, .view = view->index[i], .v = view->direction};
        float value[3];
        m->model->lit(m, &at, a, value);
        for (int c = 0; c < 3; c++)
            rgb[c] += weight * value[c];
    }
}

// All measured lights at once: what models do that say nothing better.
static void sum_lights(const relume_btf_oriented_light *a, const relume_btf_fitted *m, size_t texel,
                       const struct relume_direction_blend *view, float rgb[3])
{
    struct model_blend at = {.view = *view, .v = view->direction, .l = {0.0, 0.0, 1.0}};
    for (int i = 0; i < m->lights; i++) {
        const float *w = a->weight + 3 * i;
        float value[3];
        if (w[0] == 0.0f && w[1] == 0.0f && w[2] == 0.0f)
            continue;
        at.light = model_measured_light(m, i);
        model_blend(m, texel, &at, value);
        for (int c = 0; c < 3; c++)
            rgb[c] += w[c] * value[c];
    }
}

void ambient_blend(const relume_btf_oriented_light *a, const relume_btf_fitted *m, size_t texel,
                   const struct relume_direction_blend *view, float rgb[3])
{
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    (m->model->lit ? look_up : sum_lights)(a, m, texel, view, rgb);
}

void relume_btf_oriented_light_evaluate(const relume_btf_oriented_light *ambient, int level, int x,
                                        int y, struct relume_vec3 view, float rgb[3])
{
    const relume_btf_fitted *m = relume_btf_fitted_level(ambient->model, level);
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (!(view.z > 0.0))
        return;
    const struct relume_direction_blend b = relume_direction_mesh_at(m->view_mesh, view);
    ambient_blend(ambient, m, (size_t)y * (size_t)m->width + (size_t)x, &b, rgb);
}
