// folder.c - a BTF on disk: btf.json and values.npy
#include "core/base/outdir.h"
#include "core/base/params.h"
#include "core/base/json.h"
#include "core/base/json_write.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "material/btf/btf.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { VERSION = 1 };

// ---------------------------------------------------------------- reading

relume_status btf_read_directions(const jvalue *array, const char *path, const char *what,
                                  const struct relume_limits *limits, vec3 **out, int *count,
                                  const struct relume_log *log)
{
    const size_t n = jvalue_count(array);
    *out = NULL;
    if (n < 3 || n > (size_t)limits->max_lights)
        return log_fail(log, RELUME_EFORMAT, "%s: %s; expected 3 to %d directions [x, y, z]", path,
                        what, limits->max_lights);
    if (!(*out = mem_array(n, sizeof **out)))
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        double d[3];
        if (!jvalue_numbers(jvalue_item(array, i), d, 3) || !(d[2] > 0.0))
            return log_fail(log, RELUME_EFORMAT,
                            "%s: %s[%zu]; expected three numbers, the last above 0", path, what, i);
        (*out)[i] = vec3_unit(vec3_of(d[0], d[1], d[2]));
    }
    *count = (int)n;
    return RELUME_OK;
}

struct folder {
    const char *path;
    char *json;
    struct relume_limits limits;
    const struct relume_log *log;
};

static relume_status open_values(relume_btf *btf, const struct folder *f)
{
    char *path = mem_format("%s/values.npy", f->path);
    if (!path)
        return RELUME_ENOMEM;
    const struct npy *n = &btf->file.npy;
    relume_status status = npy_open(&btf->file, path, f->log);
    if (!status &&
        (n->kind != NPY_HALF || n->dims != 5 || n->shape[0] != (size_t)btf->info.views ||
         n->shape[1] != (size_t)btf->info.lights || n->shape[2] != (size_t)btf->info.height ||
         n->shape[3] != (size_t)btf->info.width || n->shape[4] != 3))
        status = log_fail(f->log, RELUME_EFORMAT,
                          "%s: expected halfs [%d][%d][%d][%d][3] as btf.json says", path,
                          btf->info.views, btf->info.lights, btf->info.height, btf->info.width);
    btf->values = btf->file.data;
    mem_free(path);
    return status;
}

// An optional picture of ground truth.
static relume_status open_truth(struct relume_image *out, const jvalue *root, const char *key,
                                int channels, const struct relume_btf_info *info,
                                const struct folder *f)
{
    const char *name = jvalue_text(jvalue_member(root, key));
    if (!name)
        return RELUME_OK;
    char *path = mem_format("%s/%s", f->path, name);
    if (!path)
        return RELUME_ENOMEM;
    relume_status status = relume_image_load(
        out, path,
        relume_image_params(.log = f->log, .channels = channels, .limits = &f->limits,
                            .transfer = {.curve = RELUME_CURVE_LINEAR}));
    if (!status && (out->width != info->width || out->height != info->height))
        status = log_fail(f->log, RELUME_EUNFIT, "%s: %d x %d pixels; expected %d x %d", path,
                          out->width, out->height, info->width, info->height);
    mem_free(path);
    return status;
}

static relume_status read_info(struct relume_btf_info *info, vec3 **view, vec3 **light,
                               const jvalue *root, const struct folder *f)
{
    long long side[2] = {0, 0};
    bool cosine = true;
    const jvalue *flag = jvalue_member(root, "includes_cosine");
    info->name = jvalue_text(jvalue_member(root, "name"));
    if (!jvalue_integer(jvalue_member(root, "width"), &side[0]) ||
        !jvalue_integer(jvalue_member(root, "height"), &side[1]) ||
        !limits_allow(&f->limits, side[0], side[1]))
        return log_fail(f->log, RELUME_ELIMIT,
                        "%s: width, height; expected texels within the limits", f->json);
    if (flag && !jvalue_truth(flag, &cosine))
        return log_fail(f->log, RELUME_EFORMAT, "%s: includes_cosine; expected true or false",
                        f->json);
    info->width = (int)side[0], info->height = (int)side[1];
    info->without_cosine = !cosine;
    relume_status status =
        btf_read_directions(jvalue_member(root, "view_directions"), f->json, "view_directions",
                            &f->limits, view, &info->views, f->log);
    if (!status)
        status = btf_read_directions(jvalue_member(root, "light_directions"), f->json,
                                     "light_directions", &f->limits, light, &info->lights, f->log);
    info->view = *view, info->light = *light;
    return status;
}

static relume_status open_json(relume_btf **out, const jvalue *root, const struct folder *f)
{
    struct relume_btf_info info = {0};
    vec3 *view = NULL, *light = NULL;
    relume_status status = jvalue_check_format(root, f->json, "relume-btf", VERSION, f->log);
    if (!status)
        status = read_info(&info, &view, &light, root, f);
    if (!status)
        status = open_truth(&info.relief, root, "relief", 1, &info, f);
    if (!status)
        status = open_truth(&info.normals, root, "normals", 3, &info, f);
    if (!status)
        status = btf_start(out, &info, f->path, f->log);
    if (!status)
        status = open_values(*out, f);
    relume_image_destroy(&info.relief);
    relume_image_destroy(&info.normals);
    mem_free(view);
    mem_free(light);
    return status;
}

static bool has_manifest(const char *folder)
{
    struct stat info;
    char *path = mem_format("%s/capture.json", folder);
    const bool has = path && !stat(path, &info);
    mem_free(path);
    return has;
}

static bool is_file(const char *path)
{
    struct stat info;
    return !stat(path, &info) && S_ISREG(info.st_mode);
}

static bool is_cropped(const struct relume_btf_params *p)
{
    return p && (p->crop[0] | p->crop[1] | p->crop[2] | p->crop[3]);
}

relume_status relume_btf_open(relume_btf **out, const char *path,
                              const struct relume_btf_params *params)
{
    const struct relume_btf_params own = PARAMS_WORK(relume_btf_params, params);
    params = &own;
    *out = NULL;
    if (is_file(path))
        return btf_open_ubo(out, path, params);
    if (is_cropped(params))
        return log_fail(params->log, RELUME_EINVAL, "%s: expected a .btf file to take a part of",
                        path);
    struct folder f = {path, mem_format("%s/btf.json", path),
                       limits_or_default(limits_of(own.limits, own.log)), own.log};
    if (!f.json)
        return RELUME_ENOMEM;
    struct stat info;
    if (stat(f.json, &info)) {
        mem_free(f.json);
        return has_manifest(path) ? btf_open_capture(out, path, params)
                                  : btf_open_pictures(out, path, params);
    }
    jvalue *root;
    relume_status status = jvalue_load(&root, f.json, f.log);
    if (!status)
        status = open_json(out, root, &f);
    if (status)
        relume_btf_destroy(out);
    jvalue_free(&root);
    mem_free(f.json);
    return status;
}

// ---------------------------------------------------------------- writing

void btf_put_directions(struct jwriter *w, const char *key, const vec3 *d, int n)
{
    jgap(w, "\n  ");
    jopen_array(w, key);
    for (int i = 0; i < n; i++) {
        jgap(w, i ? "\n  " : "");
        jput_vector(w, NULL, d[i], 17);
    }
    jclose(w);
}

static relume_status save_json(const relume_btf *b, const char *folder,
                               const struct relume_log *log)
{
    const struct relume_btf_info *i = &b->info;
    struct jwriter w = {0};
    jopen_object(&w, NULL);
    jgap(&w, " ");
    jput_text(&w, "format", "relume-btf");
    jput_integer(&w, "version", VERSION);
    jgap(&w, "\n  ");
    jput_text(&w, "name", i->name);
    jgap(&w, "\n  ");
    jput_integer(&w, "width", i->width);
    jput_integer(&w, "height", i->height);
    jput_truth(&w, "includes_cosine", !i->without_cosine);
    if (i->relief.data) {
        jgap(&w, "\n  ");
        jput_text(&w, "relief", "relief.exr");
    }
    if (i->normals.data)
        jput_text(&w, "normals", "normals.exr");
    btf_put_directions(&w, "view_directions", b->view, i->views);
    btf_put_directions(&w, "light_directions", b->light, i->lights);
    jgap(&w, " ");
    return jsave_in(&w, folder, "btf.json", log);
}

static relume_status save_truth(const struct relume_image *image, const char *folder,
                                const char *name, const struct relume_log *log)
{
    if (!image->data)
        return RELUME_OK;
    char *path = mem_format("%s/%s", folder, name);
    const relume_status status =
        path ? relume_image_save(image, path, relume_image_params(.log = log)) : RELUME_ENOMEM;
    mem_free(path);
    return status;
}

static relume_status save_values(const relume_btf *b, const char *folder,
                                 const struct relume_log *log)
{
    const struct npy npy = {NPY_HALF,
                            5,
                            {(size_t)b->info.views, (size_t)b->info.lights, (size_t)b->info.height,
                             (size_t)b->info.width, 3}};
    char *path = mem_format("%s/values.npy", folder);
    const relume_status status = path ? npy_save(&npy, b->values, path, log) : RELUME_ENOMEM;
    mem_free(path);
    return status;
}

relume_status relume_btf_save(const relume_btf *btf, const char *path,
                              const struct relume_btf_params *params)
{
    const struct relume_log *log = params ? params->log : NULL;
    outdir *dir;
    if (!btf->own && !btf->file.data)
        return log_fail(log, RELUME_EINVAL, "%s: a part of a BTF cannot be saved", path);
    relume_status status = outdir_open(&dir, path, params && params->force, log);
    if (status)
        return status;
    status = save_values(btf, outdir_path(dir), log);
    if (!status)
        status = save_truth(&btf->info.relief, outdir_path(dir), "relief.exr", log);
    if (!status)
        status = save_truth(&btf->info.normals, outdir_path(dir), "normals.exr", log);
    if (!status)
        status = save_json(btf, outdir_path(dir), log);
    return outdir_end(&dir, status);
}
