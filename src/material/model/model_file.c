// model_file.c - a fitted model on disk: model.json and one .npy file for each of its arrays
#include "core/base/infile.h"
#include "core/base/json.h"
#include "core/base/json_write.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outdir.h"
#include "core/base/params.h"
#include "material/model/edited.h"
#include "material/model/gbrdf_file.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { VERSION = 1, MOST_LEVELS = 17 };

// ---------------------------------------------------------------- writing

// Where a level of detail lies: in the folder itself, then in level1, level2, ...
static char *level_folder(const char *folder, int level)
{
    return level ? mem_format("%s/level%d", folder, level) : mem_text(folder);
}

static relume_status save_json(const relume_btf_fitted *m, const char *folder,
                               const struct relume_log *log)
{
    struct jwriter w = {0};
    jopen_object(&w, NULL);
    jgap(&w, " ");
    jput_text(&w, "format", "relume-btf-model");
    jput_integer(&w, "version", VERSION);
    jgap(&w, "\n  ");
    jput_text(&w, "model", m->model->name);
    jput_integer(&w, "width", m->width);
    jput_integer(&w, "height", m->height);
    jgap(&w, "\n  ");
    jput_integer(&w, "clusters", m->clusters);
    jput_integer(&w, "components", m->components);
    jput_integer(&w, "lobes", m->lobes);
    jput_integer(&w, "levels", m->info.levels);
    jgap(&w, "\n  ");
    jput_integer(&w, "texel_bytes", m->texel_bytes);
    jput_integer(&w, "pair_bytes", m->pair_bytes);
    jput_truth(&w, "includes_cosine", !m->without_cosine);
    btf_put_directions(&w, "view_directions", m->view, m->views);
    btf_put_directions(&w, "light_directions", m->light, m->lights);
    jgap(&w, " ");
    return jsave_in(&w, folder, "model.json", log);
}

static relume_status save_level(const relume_btf_fitted *m, const char *folder,
                                const struct relume_log *log)
{
    relume_status status = RELUME_OK;
    for (int i = 0; i < m->arrays && !status; i++) {
        char *file = mem_format("%s/%s.npy", folder, m->array[i].name);
        status = file ? npy_save(&m->array[i].npy, m->array[i].data, file, log) : RELUME_ENOMEM;
        mem_free(file);
    }
    return status ? status : save_json(m, folder, log);
}

relume_status model_save_into(const relume_btf_fitted *m, const char *folder,
                              const struct relume_log *log)
{
    relume_status status = RELUME_OK;
    for (int level = 0; m && !status; level++, m = m->half) {
        char *path = level_folder(folder, level);
        if (path && level && mkdir(path, 0777))
            status = log_fail(log, RELUME_EIO, "%s: cannot be created; %s", path, strerror(errno));
        if (!status)
            status = path ? save_level(m, path, log) : RELUME_ENOMEM;
        mem_free(path);
    }
    return status;
}

relume_status relume_btf_fitted_save(const relume_btf_fitted *m, const char *path,
                                     const struct relume_btf_params *params)
{
    const struct relume_log *log = params ? params->log : NULL;
    outdir *dir;
    if (gbrdf_file_named(path))
        return gbrdf_file_save(m, path, log);
    if (m->table)
        return log_fail(log, RELUME_EINVAL,
                        "%s: measured values cannot be saved as a model; fit one first", path);
    if (!m->model->fit)
        return log_fail(log, RELUME_EINVAL, "%s: a painted material is for drawing alone", path);
    relume_status status = outdir_open(&dir, path, params && params->force, log);
    if (status)
        return status;
    status = model_save_into(m, outdir_path(dir), log);
    return outdir_end(&dir, status);
}

// ---------------------------------------------------------------- reading

struct reader {
    const char *folder;
    char *json;
    struct relume_limits limits;
    const struct relume_log *log;
};

static relume_status read_model(relume_btf_fitted *m, const jvalue *root, const struct reader *r)
{
    const char *name = jvalue_text(jvalue_member(root, "model"));
    const relume_status status =
        jvalue_check_format(root, r->json, "relume-btf-model", VERSION, r->log);
    if (status)
        return status;
    m->model = name ? relume_btf_model_find(name) : NULL;
    return m->model ? RELUME_OK : log_wrong(r->log, r->json, "model", "the name of a model");
}

static relume_status read_counts(relume_btf_fitted *m, const jvalue *root, const struct reader *r)
{
    const struct relume_btf_model *k = m->model;
    bool cosine = true;
    if (!jvalue_whole(jvalue_member(root, "width"), 0, r->limits.max_side, &m->width) ||
        !jvalue_whole(jvalue_member(root, "height"), 0, r->limits.max_side, &m->height) ||
        !limits_allow(&r->limits, m->width, m->height))
        return log_wrong(r->log, r->json, "width, height", "texels within the limits");
    if (!jvalue_whole(jvalue_member(root, "clusters"), 0, 65536, &m->clusters) ||
        !jvalue_whole(jvalue_member(root, "components"), 0, 1024, &m->components) ||
        !jvalue_whole(jvalue_member(root, "lobes"), 0, MODEL_LOBES, &m->lobes) ||
        !m->clusters != !k->clusters || !m->components != !k->components || !m->lobes != !k->lobes)
        return log_wrong(r->log, r->json, "clusters, components, lobes",
                         "counts that fit the model");
    if (k->bit_rows &&
        (!jvalue_whole(jvalue_member(root, "texel_bytes"), 0, 1 << 16, &m->texel_bytes) ||
         !jvalue_whole(jvalue_member(root, "pair_bytes"), 0, 1 << 16, &m->pair_bytes) ||
         !m->texel_bytes || !m->pair_bytes))
        return log_wrong(r->log, r->json, "texel_bytes, pair_bytes", "counts of bytes");
    if (!jvalue_truth(jvalue_member(root, "includes_cosine"), &cosine))
        return log_wrong(r->log, r->json, "includes_cosine", "true or false");
    m->texels = (size_t)m->width * (size_t)m->height;
    m->without_cosine = !cosine;
    return RELUME_OK;
}

static relume_status read_directions(relume_btf_fitted *m, const jvalue *root,
                                     const struct reader *r)
{
    relume_status status =
        btf_read_directions(jvalue_member(root, "view_directions"), r->json, "view_directions",
                            &r->limits, &m->view, &m->views, r->log);
    if (!status)
        status = btf_read_directions(jvalue_member(root, "light_directions"), r->json,
                                     "light_directions", &r->limits, &m->light, &m->lights, r->log);
    if (!status)
        status = btf_make_mesh(&m->view_mesh, m->view, m->views, r->json, "view", r->log);
    return status ? status
                  : btf_make_mesh(&m->light_mesh, m->light, m->lights, r->json, "light", r->log);
}

static bool same_shape(const struct npy *a, const struct npy *b)
{
    if (a->kind != b->kind || a->dims != b->dims)
        return false;
    for (int i = 0; i < a->dims; i++)
        if (a->shape[i] != b->shape[i])
            return false;
    return true;
}

// Numbers of clusters must exist, floats must be finite.
static bool values_are_good(const struct model_array *a)
{
    const size_t n = npy_bytes(&a->npy) / npy_item(a->npy.kind);
    for (size_t i = 0; i < n; i++)
        switch (a->npy.kind) {
        case NPY_U8:
            if (((const uint8_t *)a->data)[i] >= a->below)
                return false;
            break;
        case NPY_U16:
            if (((const uint16_t *)a->data)[i] >= a->below)
                return false;
            break;
        case NPY_U32:
            if (((const uint32_t *)a->data)[i] >= a->below)
                return false;
            break;
        case NPY_HALF:
            if ((((const uint16_t *)a->data)[i] & 0x7c00u) == 0x7c00u)
                return false;
            break;
        case NPY_FLOAT:
            if (!isfinite(((const float *)a->data)[i]))
                return false;
            break;
        }
    return true;
}

static relume_status read_array(struct model_array *a, const struct reader *r)
{
    char *path = mem_format("%s/%s.npy", r->folder, a->name);
    if (!path)
        return RELUME_ENOMEM;
    relume_status status = npy_open(&a->file, path, r->log);
    a->data = (void *)a->file.data;
    if (!status && !same_shape(&a->file.npy, &a->npy))
        status =
            log_fail(r->log, RELUME_EDAMAGED, "%s: not the array that model.json implies", path);
    if (!status && !values_are_good(a))
        status = log_fail(r->log, RELUME_EDAMAGED,
                          "%s: expected finite values, and clusters that exist", path);
    mem_free(path);
    return status;
}

static relume_status read_all(relume_btf_fitted *m, const jvalue *root, const struct reader *r)
{
    relume_status status = read_model(m, root, r);
    if (!status)
        status = read_counts(m, root, r);
    if (!status)
        status = read_directions(m, root, r);
    if (!status)
        m->model->layout(m);
    for (int i = 0; i < m->arrays && !status; i++)
        status = read_array(&m->array[i], r);
    const char *fault = status || !m->model->fault ? NULL : m->model->fault(m);
    if (fault)
        status = log_wrong(r->log, r->json, "arrays do not fit together", fault);
    return status || !m->model->prepare ? status : m->model->prepare(m);
}

// `levels` is left as it is where the file does not say.
static relume_status open_level(relume_btf_fitted **out, const char *folder, int *levels,
                                const struct relume_btf_params *params)
{
    struct reader r = {folder, mem_format("%s/model.json", folder),
                       limits_or_default(params ? limits_of(params->limits, params->log) : NULL),
                       params ? params->log : NULL};
    relume_btf_fitted *m = mem_zeroed(1, sizeof *m);
    jvalue *root = NULL;
    *out = NULL;
    relume_status status = r.json && m ? RELUME_OK : RELUME_ENOMEM;
    if (!status && !input_exists(r.json, r.log))
        status = log_fail(r.log, RELUME_ENOTFOUND,
                          "%s: no such file; expected a fitted model: a folder, or an .exr file",
                          r.json);
    if (!status)
        status = jvalue_load(&root, r.json, r.log);
    if (!status)
        status = read_all(m, root, &r);
    const jvalue *count = jvalue_member(root, "levels");
    if (!status && count &&
        (!jvalue_whole(jvalue_member(root, "levels"), 0, MOST_LEVELS, levels) || *levels < 1))
        status = log_wrong(r.log, r.json, "levels", "at least 1");
    if (status)
        relume_btf_fitted_destroy(&m);
    *out = m;
    jvalue_free(&root);
    mem_free(r.json);
    return status;
}

static bool is_half_of(const relume_btf_fitted *m, const relume_btf_fitted *half)
{
    return half->model == m->model && half->without_cosine == m->without_cosine &&
           half->width == btf_half_side(m->width) && half->height == btf_half_side(m->height) &&
           half->views == m->views && half->lights == m->lights;
}

static relume_status open_half(relume_btf_fitted *m, const char *folder, int level,
                               const struct relume_btf_params *params)
{
    int ignored = 1;
    char *path = level_folder(folder, level);
    relume_status status = path ? open_level(&m->half, path, &ignored, params) : RELUME_ENOMEM;
    if (!status && !is_half_of(m, m->half))
        status = log_fail(params ? params->log : NULL, RELUME_EUNFIT,
                          "%s: %s of %d x %d texels; expected %s of %d x %d and as many directions",
                          path, m->half->model->name, m->half->width, m->half->height,
                          m->model->name, btf_half_side(m->width), btf_half_side(m->height));
    mem_free(path);
    return status;
}

relume_status relume_btf_fitted_open(relume_btf_fitted **out, const char *path,
                                     const struct relume_btf_params *params)
{
    const struct relume_btf_params p = PARAMS(relume_btf_params, params);
    int levels = 1;
    relume_status status = gbrdf_file_named(path) ? gbrdf_file_open(out, path, &p)
                                                  : open_level(out, path, &levels, &p);
    relume_btf_fitted *m = *out;
    for (int level = 1; level < levels && !status; level++, m = m->half)
        status = open_half(m, path, level, &p);
    if (status) {
        relume_btf_fitted_destroy(out);
        return status;
    }
    model_settle(*out);
    return p.unedited ? RELUME_OK : model_apply_edits(out, path, p.log);
}
