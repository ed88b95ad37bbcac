// ambient.c - a model under an environment, for one orientation
//
// Values between measured lights are interpolated, so that a value under an environment is a sum
// over the measured lights whose weights are integrals of the radiance: sum_i b_i(l) E(l) dw / pi.
// They are summed over cells of the environment, each at the direction where its energy comes from:
// a cell is far smaller than a triangle of lights, over which b_i are all but linear.
#include "btf/ambient.h"

#include "base/memory.h"

static vec3 to_sample(const struct relume_btf_frame *f, vec3 d)
{
    return vec3_of(vec3_dot(d, f->right), vec3_dot(d, f->up), vec3_dot(d, f->normal));
}

static void add_cell(relume_btf_ambient *a, const struct relume_environment_cell *cell)
{
    const vec3 l = to_sample(&a->frame, cell->direction);
    if (!(l.z > 0.0))
        return;
    const struct relume_dome_blend b = relume_dome_at(a->model->light_dome, l);
    const double scale = a->model->without_cosine ? l.z : b.rim;
    const vec3 d = b.direction;
    const double term[AMBIENT_TERMS] = {d.x * d.x, d.y * d.y, d.x * d.y, d.x, d.y, 1.0};
    for (int c = 0; c < 3; c++) {
        const double sent = scale * (double)cell->rgb[c];
        for (int i = 0; i < b.count; i++)
            a->weight[3 * b.index[i] + c] += (float)(sent * b.weight[i]);
        for (int t = 0; t < AMBIENT_TERMS; t++)
            a->term[t][c] += (float)(sent * term[t]);
    }
}

relume_status relume_btf_ambient_create(relume_btf_ambient **out, const relume_btf_fitted *model,
                                        const relume_prefilter *prefilter,
                                        const struct relume_btf_frame *frame)
{
    relume_btf_ambient *a = mem_zeroed(1, sizeof *a);
    *out = a;
    if (!a)
        return RELUME_ENOMEM;
    a->model = model;
    a->prefilter = prefilter;
    a->frame = *frame;
    a->weight = mem_zeroed(3 * (size_t)model->lights, sizeof *a->weight);
    if (!a->weight) {
        relume_btf_ambient_destroy(out);
        return RELUME_ENOMEM;
    }
    for (int i = 0; i < prefilter->cells; i++)
        add_cell(a, &prefilter->cell[i]);
    relume_prefilter_diffuse(a->even[0], prefilter, frame->normal);
    relume_prefilter_specular(a->even[1], prefilter, frame->normal, 1.0);
    return RELUME_OK;
}

void relume_btf_ambient_destroy(relume_btf_ambient **ambient)
{
    if (*ambient)
        free((*ambient)->weight);
    free(*ambient);
    *ambient = NULL;
}

const float *relume_btf_ambient_weights(const relume_btf_ambient *ambient)
{
    return ambient->weight;
}

void ambient_even(const relume_btf_ambient *a, bool cosine, float rgb[3])
{
    for (int c = 0; c < 3; c++)
        rgb[c] = a->even[cosine][c];
}

void ambient_lobe(const relume_btf_ambient *a, const float t[3], float exponent, bool cosine,
                  float rgb[3])
{
    const double length = sqrt((double)(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]));
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (!(length > 1e-9))
        return;
    const vec3 axis = vec3_add(vec3_scale(a->frame.right, t[0] / length),
                               vec3_add(vec3_scale(a->frame.up, t[1] / length),
                                        vec3_scale(a->frame.normal, t[2] / length)));
    relume_prefilter_lobe(rgb, a->prefilter, a->frame.normal, axis, exponent, cosine);
    const float height = (float)exp((double)exponent * log(length));
    for (int c = 0; c < 3; c++)
        rgb[c] *= height;
}

// All measured lights at once: what models do that say nothing better.
static void sum_lights(const relume_btf_ambient *a, const relume_btf_fitted *m, struct model_at *at,
                       float rgb[3])
{
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    for (int l = 0; l < m->lights; l++) {
        const float *w = a->weight + 3 * l;
        float value[3];
        if (w[0] == 0.0f && w[1] == 0.0f && w[2] == 0.0f)
            continue;
        at->light = l;
        at->l = m->light[l];
        m->model->eval(m, at, value);
        for (int c = 0; c < 3; c++)
            rgb[c] += w[c] * value[c];
    }
}

void ambient_blend(const relume_btf_ambient *a, const relume_btf_fitted *m, size_t texel,
                   const struct relume_dome_blend *view, float rgb[3])
{
    const int count = m->model->view_grid ? view->count : 1;
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    for (int i = 0; i < count; i++) {
        const float weight = m->model->view_grid ? (float)view->weight[i] : 1.0f;
        struct model_at at = {.texel = texel, .view = view->index[i], .v = view->direction};
        float value[3];
        if (m->model->lit)
            m->model->lit(m, &at, a, value);
        else
            sum_lights(a, m, &at, value);
        for (int c = 0; c < 3; c++)
            rgb[c] += weight * value[c];
    }
}

void relume_btf_ambient_evaluate(const relume_btf_ambient *ambient, int level, int x, int y,
                                 struct relume_vec3 view, float rgb[3])
{
    const relume_btf_fitted *m = relume_btf_fitted_level(ambient->model, level);
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (!(view.z > 0.0))
        return;
    const struct relume_dome_blend b = relume_dome_at(m->view_dome, view);
    ambient_blend(ambient, m, (size_t)y * (size_t)m->width + (size_t)x, &b, rgb);
}
