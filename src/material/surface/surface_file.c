// surface_file.c - a surface on disk: surface.json, texel.npy, matrix.npy and the folder of a model
#include "core/base/json.h"
#include "core/base/json_write.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outdir.h"
#include "material/surface/surface.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

enum { VERSION = 1 };
static const char MODEL_FOLDER[] = "model";

// ---------------------------------------------------------------- writing

static relume_status save_array(const struct npy *npy, const void *data, const char *folder,
                                const char *name, const struct relume_log *log)
{
    char *path = mem_format("%s/%s.npy", folder, name);
    const relume_status status = path ? npy_save(npy, data, path, log) : RELUME_ENOMEM;
    mem_free(path);
    return status;
}

// Numbers of 16 bits where the sample has no more texels.
static relume_status save_texels(const struct relume_btf_map_info *m, const char *folder,
                                 const struct relume_log *log)
{
    const bool small = (size_t)m->sample_width * (size_t)m->sample_height <= 65536;
    const struct npy npy = {
        small ? NPY_U16 : NPY_U32, 3, {(size_t)m->tiles, (size_t)m->height, (size_t)m->width}};
    if (!small)
        return save_array(&npy, m->texel, folder, "texel", log);
    uint16_t *texel = mem_array(map_texels(m), sizeof *texel);
    if (!texel)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < map_texels(m); i++)
        texel[i] = (uint16_t)m->texel[i];
    const relume_status status = save_array(&npy, texel, folder, "texel", log);
    mem_free(texel);
    return status;
}

static relume_status save_json(const struct relume_btf_map_info *m, const char *folder,
                               const struct relume_log *log)
{
    struct jwriter w = {0};
    jopen_object(&w, NULL);
    jgap(&w, " ");
    jput_text(&w, "format", "relume-btf-surface");
    jput_integer(&w, "version", VERSION);
    jgap(&w, "\n  ");
    jput_integer(&w, "tiles", m->tiles);
    jput_integer(&w, "tile_width", m->width);
    jput_integer(&w, "tile_height", m->height);
    jgap(&w, "\n  ");
    jput_integer(&w, "columns", m->columns);
    jput_integer(&w, "rows", m->rows);
    jgap(&w, " ");
    return jsave_in(&w, folder, "surface.json", log);
}

static relume_status save_model(const relume_btf_fitted *model, const char *folder,
                                const struct relume_log *log)
{
    char *path = mem_format("%s/%s", folder, MODEL_FOLDER);
    relume_status status = path ? RELUME_OK : RELUME_ENOMEM;
    if (!status && mkdir(path, 0777))
        status = log_fail(log, RELUME_EIO, "%s: cannot be created; %s", path, strerror(errno));
    if (!status)
        status = model_save_into(model, path, log);
    mem_free(path);
    return status;
}

relume_status relume_btf_surface_save(const relume_btf_surface *surface, const char *path,
                                      const struct relume_btf_params *params)
{
    const struct relume_log *log = params ? params->log : NULL;
    const struct relume_btf_map_info *m = &surface->level[0].map;
    const struct npy matrix = {NPY_U16, 2, {(size_t)m->rows, (size_t)m->columns}};
    outdir *dir;
    if (surface->level[0].model->table)
        return log_fail(log, RELUME_EINVAL,
                        "%s: measured values cannot be saved as a model; fit one first", path);
    relume_status status = outdir_open(&dir, path, params && params->force, log);
    if (status)
        return status;
    const char *folder = outdir_path(dir);
    status = save_texels(m, folder, log);
    if (!status)
        status = save_array(&matrix, m->matrix, folder, "matrix", log);
    if (!status)
        status = save_model(surface->level[0].model, folder, log);
    if (!status)
        status = save_json(m, folder, log);
    return outdir_end(&dir, status);
}

// ---------------------------------------------------------------- reading

struct reader {
    const char *folder;
    char *json;
    struct relume_limits limits;
    const struct relume_log *log;
};

static relume_status read_sizes(struct relume_btf_map_info *s, const jvalue *root,
                                const struct reader *r)
{
    const relume_status status =
        jvalue_check_format(root, r->json, "relume-btf-surface", VERSION, r->log);
    if (status)
        return status;
    if (!jvalue_whole(jvalue_member(root, "tiles"), 1, 65536, &s->tiles) ||
        !jvalue_whole(jvalue_member(root, "tile_width"), 1, r->limits.max_side, &s->width) ||
        !jvalue_whole(jvalue_member(root, "tile_height"), 1, r->limits.max_side, &s->height) ||
        !jvalue_whole(jvalue_member(root, "columns"), 1, r->limits.max_side, &s->columns) ||
        !jvalue_whole(jvalue_member(root, "rows"), 1, r->limits.max_side, &s->rows))
        return log_fail(r->log, RELUME_ELIMIT,
                        "%s: tiles, tile_width, tile_height, columns, rows; expected counts within "
                        "the limits",
                        r->json);
    return RELUME_OK;
}

// An array of whole numbers of a shape, as 32 or 16 bits.
static relume_status read_array(const char *name, const struct npy *want, void *out,
                                const struct reader *r)
{
    struct npy_file file;
    char *path = mem_format("%s/%s.npy", r->folder, name);
    if (!path)
        return RELUME_ENOMEM;
    relume_status status = npy_open(&file, path, r->log);
    bool same = !status && file.npy.dims == want->dims &&
                (file.npy.kind == NPY_U16 || file.npy.kind == want->kind);
    size_t count = 1;
    for (int i = 0; same && i < want->dims; i++) {
        same = file.npy.shape[i] == want->shape[i];
        count *= want->shape[i];
    }
    if (!status && !same)
        status =
            log_fail(r->log, RELUME_EDAMAGED, "%s: not the array that surface.json implies", path);
    if (!status && file.npy.kind == want->kind)
        memcpy(out, file.data, count * npy_item(want->kind));
    for (size_t i = 0; !status && file.npy.kind != want->kind && i < count; i++)
        ((uint32_t *)out)[i] = ((const uint16_t *)file.data)[i];
    npy_close(&file);
    mem_free(path);
    return status;
}

static relume_status read_map(relume_btf_map **out, const relume_btf_fitted *model,
                              const jvalue *root, const struct reader *r)
{
    struct relume_btf_map_info s = {.sample_width = model->width, .sample_height = model->height};
    relume_status status = read_sizes(&s, root, r);
    if (!status)
        status = map_start(out, &s, r->log);
    if (status)
        return status;
    const struct npy texel = {NPY_U32, 3, {(size_t)s.tiles, (size_t)s.height, (size_t)s.width}};
    const struct npy matrix = {NPY_U16, 2, {(size_t)s.rows, (size_t)s.columns}};
    status = read_array("texel", &texel, (*out)->texel, r);
    if (!status)
        status = read_array("matrix", &matrix, (*out)->matrix, r);
    if (!status)
        status = map_check(&(*out)->info, r->folder, r->log);
    return status;
}

static relume_status open_model(relume_btf_fitted **out, const char *folder,
                                const struct relume_btf_params *params)
{
    char *path = mem_format("%s/%s", folder, MODEL_FOLDER);
    const relume_status status = path ? relume_btf_fitted_open(out, path, params) : RELUME_ENOMEM;
    mem_free(path);
    return status;
}

relume_status relume_btf_surface_open(relume_btf_surface **out, const char *path,
                                      const struct relume_btf_params *params)
{
    struct reader r = {path, mem_format("%s/surface.json", path),
                       limits_or_default(params ? limits_of(params->limits, params->log) : NULL),
                       params ? params->log : NULL};
    relume_btf_fitted *model = NULL;
    relume_btf_map *map = NULL;
    jvalue *root = NULL;
    *out = NULL;
    relume_status status = r.json ? jvalue_load(&root, r.json, r.log) : RELUME_ENOMEM;
    if (!status)
        status = open_model(&model, path, params);
    if (!status)
        status = read_map(&map, model, root, &r);
    if (!status) {
        status = surface_start(out, model, map);
        map = NULL;
    }
    if (status) {
        relume_btf_map_destroy(&map);
        relume_btf_fitted_destroy(&model);
    } else {
        (*out)->own = model;
    }
    jvalue_free(&root);
    mem_free(r.json);
    return status;
}
