// btf_inputs.c - what `relume btf` is given: BTFs, models, names of materials
#include "cli/materials/btf_inputs.h"

#include <errno.h>
#include <math.h>
#include <relume/exchange.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

static bool exists(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0;
}

bool btf_is_model_file(const char *path)
{
    const size_t n = strlen(path);
    return n > 4 && !strcasecmp(path + n - 4, ".exr");
}

bool btf_is_model(const char *path)
{
    return btf_is_model_file(path) || relume_kind_of(path) == RELUME_KIND_FITTED;
}

bool btf_is_surface(const char *path)
{
    return relume_kind_of(path) == RELUME_KIND_SURFACE;
}

static void list_materials(const char *names[16])
{
    int n = 0;
    for (const struct relume_btf_material *const *m = relume_btf_materials; *m && n < 15; m++)
        names[n++] = relume_btf_material_name(*m);
    names[n] = NULL;
}

relume_status btf_find_material(const struct relume_btf_material **out, const char *name,
                                const struct relume_log *log)
{
    const char *names[16];
    list_materials(names);
    *out = relume_btf_material_find(name);
    return *out ? RELUME_OK : unknown_word(log, "material", name, names);
}

static relume_status nothing_there(const char *name)
{
    const char *names[16];
    char list[256] = "";
    list_materials(names);
    for (int i = 0; names[i]; i++)
        snprintf(list + strlen(list), sizeof list - strlen(list), " %s", names[i]);
    return data_error("%s: cannot be read; no such file or folder, and no built-in material, which "
                      "are:%s",
                      name, list);
}

static relume_status synth_material(relume_btf **out, const struct relume_btf_material *material,
                                    const struct btf_options *o)
{
    const struct relume_btf_set *set = o->directions ? o->directions : relume_btf_set_find("bonn");
    struct relume_vec3 *d = malloc((size_t)set->count * sizeof *d);
    if (!d)
        return RELUME_ENOMEM;
    relume_btf_set_directions(set, d);
    const relume_status status = relume_btf_synth(
        out, material,
        relume_btf_synth_params(.log = o->args.log, .size = o->size, .view = d, .views = set->count,
                                .light = d, .lights = set->count, .seed = (uint64_t)o->seed,
                                .threads = o->args.threads));
    free(d);
    return status;
}

// In whole texels, some of them.
static relume_status read_crop(int out[4], const struct btf_options *o)
{
    for (int i = 0; given(o, &o->crop) && i < 4; i++) {
        const double n = o->crop[i];
        if (n != floor(n) || n < (i > 1) || n > 65536)
            return usage_error("--crop: expected x,y,w,h in texels; found '%g,%g,%g,%g'",
                               o->crop[0], o->crop[1], o->crop[2], o->crop[3]);
        out[i] = (int)n;
    }
    return RELUME_OK;
}

static relume_status open_btf(relume_btf **out, const char *name, bool outline,
                              const struct btf_options *o)
{
    const struct relume_btf_material *material = relume_btf_material_find(name);
    struct relume_btf_params params = {
        .log = o->args.log, .threads = o->args.threads, .fill = o->fill, .outline = outline};
    *out = NULL;
    if (material && !exists(name))
        return given(o, &o->crop) ? usage_error("--crop: expected a .btf file; found '%s'", name)
                                  : synth_material(out, material, o);
    if (!exists(name) && errno == ENOENT)
        return nothing_there(name);
    const relume_status status = read_crop(params.crop, o);
    return status ? status : relume_btf_open(out, name, &params);
}

relume_status btf_open(relume_btf **out, const char *name, const struct btf_options *o)
{
    return open_btf(out, name, false, o);
}

relume_status btf_open_outline(relume_btf **out, const char *name, const struct btf_options *o)
{
    return open_btf(out, name, true, o);
}

relume_status btf_open_sample(struct btf_sample *out, const char *name, const struct btf_options *o)
{
    *out = (struct btf_sample){.btf = NULL};
    if (btf_is_model(name))
        return relume_btf_fitted_open(&out->model, name, relume_btf_params(.log = o->args.log));
    const relume_status status = btf_open(&out->btf, name, o);
    return status ? status : relume_btf_as_model(&out->model, out->btf, o->args.log);
}

void btf_close_sample(struct btf_sample *sample)
{
    relume_btf_fitted_destroy(&sample->model);
    relume_btf_destroy(&sample->btf);
}
