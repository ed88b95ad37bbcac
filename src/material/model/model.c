// model.c - what a model of a BTF is: some arrays, a way to fill them, a way to read a value back
#include "material/model/model.h"

#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "material/btf/values.h"

#include <string.h>

const struct relume_btf_model *const relume_btf_models[] = {
    &model_lit, &model_bump, &model_laf,  &model_slaf, &model_rfp, &model_rfnl,  &model_rfnlc,
    &model_cmf, &model_vpca, &model_lpca, &model_fmf,  &model_qmf, &model_gbrdf, NULL,
};

const struct relume_btf_model *relume_btf_model_find(const char *name)
{
    for (const struct relume_btf_model *const *m = relume_btf_models; *m; m++)
        if (!strcmp((*m)->name, name))
            return *m;
    return NULL;
}

const char *relume_btf_model_name(const struct relume_btf_model *model)
{
    return model->name;
}

const char *relume_btf_model_summary(const struct relume_btf_model *model)
{
    return model->summary;
}

bool relume_btf_model_fits(const struct relume_btf_model *model, const relume_btf *btf)
{
    return !model->fits || model->fits(btf);
}

void model_add(relume_btf_fitted *m, const char *name, enum npy_kind kind, bool each, size_t below,
               const size_t shape[NPY_DIMS])
{
    struct model_array *a = &m->array[m->arrays++];
    *a = (struct model_array){.name = name, .npy = {.kind = kind}, .each = each, .below = below};
    while (a->npy.dims < NPY_DIMS && shape[a->npy.dims]) {
        a->npy.shape[a->npy.dims] = shape[a->npy.dims];
        a->npy.dims++;
    }
}

static void free_arrays(relume_btf_fitted *m)
{
    for (int i = 0; i < m->arrays; i++) {
        if (!m->array[i].file.map)
            mem_free(m->array[i].data);
        npy_close(&m->array[i].file);
    }
    m->arrays = 0;
}

void relume_btf_fitted_destroy(relume_btf_fitted **fitted)
{
    relume_btf_fitted *m = *fitted;
    *fitted = NULL;
    if (!m)
        return;
    free_arrays(m);
    mem_free(m->prepared);
    relume_btf_fitted_destroy(&m->half);
    relume_direction_mesh_destroy(&m->view_mesh);
    relume_direction_mesh_destroy(&m->light_mesh);
    mem_free(m->view);
    mem_free(m->light);
    mem_free(m);
}

// ---------------------------------------------------------------- fitting

// A count that was asked for, or the default; 0 when the model has no such thing.
static relume_status choose(int *out, const char *what, int asked, int usual, int most,
                            const struct fitting *f)
{
    *out = !usual ? 0 : asked ? asked : usual < most ? usual : most;
    if (!usual || (*out >= 1 && *out <= most))
        return RELUME_OK;
    return log_fail(f->log, RELUME_EINVAL, "%s: expected 1 to %d %s; found %d", f->out->model->name,
                    most, what, *out);
}

static int least(size_t a, size_t b)
{
    return (int)(a < b ? a : b);
}

// As many components as there are pictures.
static int most_components(const relume_btf_fitted *m)
{
    const int most = m->model->most_components ? m->model->most_components : 256;
    return least((size_t)most, m->model->of_views ? (size_t)m->lights : m->texels);
}

static relume_status choose_counts(struct fitting *f, const struct relume_btf_fit_params *p)
{
    relume_btf_fitted *m = f->out;
    const struct relume_btf_model *k = m->model;
    const size_t most_clusters = k->most_clusters ? (size_t)k->most_clusters : 65536;
    relume_status status = choose(&m->clusters, "clusters", p->clusters, k->clusters,
                                  least(most_clusters, m->texels), f);
    if (!status)
        status = choose(&m->components, "components", p->components, k->components,
                        most_components(m), f);
    if (!status)
        status = choose(&m->lobes, "lobes", p->lobes, k->lobes, MODEL_LOBES, f);
    return status;
}

static relume_status check_values(const relume_btf *btf, const struct relume_log *log)
{
    const size_t n = btf_texels(btf) * 3;
    for (int v = 0; v < btf->info.views; v++)
        for (int l = 0; l < btf->info.lights; l++) {
            const uint16_t *p = relume_btf_picture(btf, v, l);
            bool broken = false;
            for (size_t i = 0; i < n; i++)
                broken |= (p[i] & 0x7c00u) == 0x7c00u;
            if (broken)
                return log_fail(log, RELUME_EDAMAGED,
                                "%s: view %d, light %d: NaN or infinity; expected finite values",
                                btf_name(btf), v, l);
        }
    return RELUME_OK;
}

static relume_status copy_directions(relume_btf_fitted *m, const relume_btf *btf,
                                     const struct relume_log *log)
{
    m->views = btf->info.views, m->lights = btf->info.lights;
    m->view = mem_copy(btf->view, (size_t)m->views, sizeof *m->view);
    m->light = mem_copy(btf->light, (size_t)m->lights, sizeof *m->light);
    if (!m->view || !m->light)
        return RELUME_ENOMEM;
    const relume_status status =
        relume_direction_mesh_create(&m->view_mesh, m->view, m->views, log);
    return status ? status : relume_direction_mesh_create(&m->light_mesh, m->light, m->lights, log);
}

relume_status model_make_arrays(relume_btf_fitted *m)
{
    free_arrays(m);
    m->model->layout(m);
    for (int i = 0; i < m->arrays; i++) {
        m->array[i].data = mem_zeroed(1, npy_bytes(&m->array[i].npy));
        if (!m->array[i].data)
            return RELUME_ENOMEM;
    }
    return RELUME_OK;
}

// One level of detail; `before` is the level before it, or NULL.
static relume_status fit_level(relume_btf_fitted **out, const relume_btf *btf,
                               const struct relume_btf_model *model,
                               const struct relume_btf_fit_params *p,
                               const relume_btf_fitted *before)
{
    *out = NULL;
    relume_btf_fitted *m = mem_zeroed(1, sizeof *m);
    if (!m)
        return RELUME_ENOMEM;
    m->model = model;
    m->width = btf->info.width, m->height = btf->info.height;
    m->texels = btf_texels(btf);
    m->without_cosine = btf->info.without_cosine;
    struct fitting f = {.btf = btf,
                        .out = m,
                        .log = p->log,
                        .seed = p->seed,
                        .threads = p->threads,
                        .ratio = p->ratio,
                        .counts_given = p->clusters != 0,
                        .resample = p->resample};
    relume_status status = copy_directions(m, btf, p->log);
    if (!status && before) {
        // Those of the level before, where texels are left for them: a cluster keeps its share of
        // texels.
        m->clusters = before->clusters > 4 ? before->clusters / 4 : before->clusters > 0;
        m->components = least((size_t)before->components, (size_t)most_components(m));
        m->lobes = before->lobes;
    } else if (!status)
        status = choose_counts(&f, p);
    if (!status && p->ratio != 0.0 && !(p->ratio >= 1.0 && p->ratio <= 1e6))
        status =
            log_fail(p->log, RELUME_EINVAL, "ratio: expected 1 to 1000000; found %g", p->ratio);
    if (!status)
        status = model_make_arrays(m);
    if (!status)
        status = model->fit(&f);
    if (!status && model->prepare)
        status = model->prepare(m);
    if (status)
        relume_btf_fitted_destroy(&m);
    *out = m;
    return status;
}

static relume_status fit_levels(relume_btf_fitted *m, const relume_btf *btf,
                                const struct relume_btf_fit_params *p)
{
    const struct relume_btf_params halving = {.log = p->log, .threads = p->threads};
    relume_btf *half = NULL;
    relume_status status = RELUME_OK;
    for (int i = 1; !status && (p->levels < 0 || i < p->levels) && m->texels > 1; i++) {
        relume_btf *next;
        status = relume_btf_halve(&next, half ? half : btf, &halving);
        relume_btf_destroy(&half);
        half = next;
        if (!status)
            status = fit_level(&m->half, half, m->model, p, m);
        m = m->half;
    }
    relume_btf_destroy(&half);
    return status;
}

relume_status relume_btf_fit(relume_btf_fitted **out, const relume_btf *btf,
                             const struct relume_btf_model *model,
                             const struct relume_btf_fit_params *params)
{
    const struct relume_btf_fit_params p = PARAMS_WORK(relume_btf_fit_params, params);
    *out = NULL;
    relume_status status = check_values(btf, p.log);
    if (!status)
        status = fit_level(out, btf, model, &p, NULL);
    if (!status)
        status = fit_levels(*out, btf, &p);
    if (status)
        relume_btf_fitted_destroy(out);
    else
        model_settle(*out);
    return status;
}

relume_status relume_btf_as_model(relume_btf_fitted **out, const relume_btf *btf,
                                  const struct relume_log *log)
{
    *out = NULL;
    relume_status status = check_values(btf, log);
    if (!status)
        status = fit_level(out, btf, &model_table, relume_btf_fit_params(.log = log), NULL);
    if (!status)
        model_settle(*out);
    return status;
}

// ---------------------------------------------------------------- reading back

// All around, a hair above the horizon.
static double mean_rim(const relume_direction_mesh *lights)
{
    enum { AROUND = 48 };
    double sum = 0.0;
    for (int i = 0; i < AROUND; i++) {
        const double phi = 2.0 * M_PI * i / AROUND;
        sum += relume_direction_mesh_at(lights, vec3_of(cos(phi), sin(phi), 1e-9)).direction.z;
    }
    return sum / AROUND;
}

void model_settle(relume_btf_fitted *m)
{
    m->info = (struct relume_btf_fitted_info){
        .model = m->model,
        .width = m->width,
        .height = m->height,
        .views = m->views,
        .lights = m->lights,
        .clusters = m->clusters,
        .components = m->components,
        .lobes = m->lobes,
        .levels = 1,
        // layouts alone have no directions
        .rim = m->light_mesh ? mean_rim(m->light_mesh) : 0.0,
    };
    for (int i = 0; i < m->arrays; i++) {
        const uint64_t bytes = npy_bytes(&m->array[i].npy);
        m->info.bytes += bytes;
        m->info.bytes_each += m->array[i].each ? bytes / m->texels : 0;
    }
    m->info.bytes_levels = m->info.bytes;
    if (m->half) {
        model_settle(m->half);
        m->info.levels += m->half->info.levels;
        m->info.bytes_levels += m->half->info.bytes_levels;
    }
}

const struct relume_btf_fitted_info *relume_btf_fitted_info(const relume_btf_fitted *m)
{
    return &m->info;
}

struct relume_btf_cost relume_btf_fitted_cost(const relume_btf_fitted *m)
{
    return m->model->cost(m);
}

const relume_btf_fitted *relume_btf_fitted_level(const relume_btf_fitted *m, int level)
{
    for (; level > 0 && m->half; level--)
        m = m->half;
    return m;
}

// The blend of a model without a grid: the direction itself.
static struct relume_direction_blend alone(const struct relume_direction_blend *b)
{
    return (struct relume_direction_blend){
        .count = 1, .weight = {1.0}, .direction = b->direction, .rim = b->rim, .length = 1.0};
}

void model_blend(const relume_btf_fitted *m, size_t texel, const struct model_blend *at,
                 float rgb[3])
{
    const struct relume_direction_blend v = m->model->view_grid ? at->view : alone(&at->view);
    const struct relume_direction_blend l = m->model->light_grid ? at->light : alone(&at->light);
    double sum[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < v.count; i++)
        for (int j = 0; j < l.count; j++) {
            const struct model_at one = {texel,      at->place,   v.index[i],
                                         l.index[j], v.direction, l.direction};
            float value[3];
            m->model->eval(m, &one, value);
            for (int c = 0; c < 3; c++)
                sum[c] += v.weight[i] * l.weight[j] * (double)value[c];
        }
    const double scale = m->without_cosine ? at->l.z : l.rim / l.length;
    // what truncated sums and polynomials leave below 0 is no light
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)fmax(scale * sum[c], 0.0);
}

void relume_btf_fitted_evaluate(const relume_btf_fitted *fitted, int x, int y,
                                struct relume_vec3 view, struct relume_vec3 light, float rgb[3])
{
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (!(view.z > 0.0) || !(light.z > 0.0))
        return;
    const struct model_blend at = {relume_direction_mesh_at(fitted->view_mesh, view),
                                   relume_direction_mesh_at(fitted->light_mesh, light), view, light,
                                   NULL};
    model_blend(fitted, (size_t)y * (size_t)fitted->width + (size_t)x, &at, rgb);
}
