#include "btf_inputs.h"

#include <stdlib.h>
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

static relume_status synth_material(relume_btf **out, const struct relume_btf_material *material,
                                    const struct args *args)
{
    const char *name = args_text(args, "--directions", "bonn");
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
        relume_btf_synth_params(.log = args_log(args), .size = args_int(args, "--size", 64),
                                .view = d, .views = set->count, .light = d, .lights = set->count,
                                .seed = (uint64_t)args_int(args, "--seed", 0),
                                .threads = args_threads(args)));
    free(d);
    return status;
}

relume_status btf_open(relume_btf **out, const char *name, const struct args *args)
{
    const struct relume_btf_material *material = relume_btf_material_find(name);
    if (material && !exists(name))
        return synth_material(out, material, args);
    return relume_btf_open(out, name,
                           relume_btf_params(.log = args_log(args), .threads = args_threads(args),
                                             .fill = args_has(args, "--fill")));
}

relume_status btf_open_sample(struct btf_sample *out, const char *name, const struct args *args)
{
    *out = (struct btf_sample){.btf = NULL};
    if (btf_is_model(name))
        return relume_btf_fitted_open(&out->model, name, relume_btf_params(.log = args_log(args)));
    const relume_status status = btf_open(&out->btf, name, args);
    return status ? status : relume_btf_as_model(&out->model, out->btf, args_log(args));
}

void btf_close_sample(struct btf_sample *sample)
{
    relume_btf_fitted_destroy(&sample->model);
    relume_btf_destroy(&sample->btf);
}
