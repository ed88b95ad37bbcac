// btf_inputs.c - what `relume btf` is given: BTFs, models, names of materials
#include "commands/btf_inputs.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static bool exists(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0;
}

bool btf_is_model(const char *path)
{
    char file[4096];
    return snprintf(file, sizeof file, "%s/model.json", path) < (int)sizeof file && exists(file);
}

bool btf_is_surface(const char *path)
{
    char file[4096];
    return snprintf(file, sizeof file, "%s/surface.json", path) < (int)sizeof file && exists(file);
}

static void list_materials(const char *names[16])
{
    int n = 0;
    for (const struct relume_btf_material *const *m = relume_btf_materials; *m && n < 15; m++)
        names[n++] = relume_btf_material_name(*m);
    names[n] = NULL;
}

relume_status btf_find_material(const struct relume_btf_material **out, const char *name)
{
    const char *names[16];
    list_materials(names);
    *out = relume_btf_material_find(name);
    return *out ? RELUME_OK : unknown_name("material", name, names);
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
    const char *name = o->directions;
    const struct relume_btf_set *set = relume_btf_set_find(name);
    const char *const names[] = {"bonn", "dome", "coarse", NULL};
    if (!set)
        return unknown_name("set of directions", name, names);
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

static relume_status parse_crop(int out[4], const struct btf_options *o)
{
    const char *text = o->crop, *at = text;
    for (int i = 0; text && i < 4; i++) {
        char *end;
        const long n = strtol(at, &end, 10);
        if (end == at || *end != (i < 3 ? ',' : '\0') || n < (i > 1) || n > 65536)
            return usage_error("--crop: expected x,y,w,h in texels; found '%s'", text);
        out[i] = (int)n;
        at = end + 1;
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
        return o->crop ? usage_error("--crop: expected a .btf file; found '%s'", name)
                       : synth_material(out, material, o);
    if (!exists(name) && errno == ENOENT)
        return nothing_there(name);
    const relume_status status = parse_crop(params.crop, o);
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
