// btf_inputs.h - what `relume btf` is given: BTFs, models, names of materials
#ifndef CLI_BTF_INPUTS_H
#define CLI_BTF_INPUTS_H

#include "cli/frame_options.h"

struct btf_options {
    struct args args;
    const char *output, *mesh, *reflections, *map;
    double reflection_at[2];
    const struct relume_btf_set *directions;
    int model;  // its place in relume_btf_models, or -1
    struct ints models;
    struct relume_vec3 eye, camera, look_at, up;
    int clusters, components, ratio, lobes, levels, leave_out, pictures, samples, tiles, tile, size,
        seed, picture[2], matrix[2];
    double fov, repeat, crop[4];
    bool icc, unseen, no_shadows, fill, force, json, resample;
    struct light_options lighting;
};

// A built-in material; RELUME_EINVAL with a sentence that lists them.
relume_status btf_find_material(const struct relume_btf_material **out, const char *name,
                                const struct relume_log *log);

// Whether a name is that of an EXR file, which a g-BRDF may be.
bool btf_is_model_file(const char *path);
// Whether the folder holds a fitted model, or the name is that of a file with one.
bool btf_is_model(const char *path);

// A folder or file, or a built-in material when there is none of that name.
relume_status btf_open(relume_btf **out, const char *name, const struct btf_options *o);
// ... of which only relume_btf_info is asked.
relume_status btf_open_outline(relume_btf **out, const char *name, const struct btf_options *o);

// Whether the folder holds a surface.
bool btf_is_surface(const char *path);

// A BTF or a model: what takes models takes both.
struct btf_sample {
    relume_btf *btf;  // NULL where a model was given
    relume_btf_fitted *model;
};
relume_status btf_open_sample(struct btf_sample *out, const char *name,
                              const struct btf_options *o);
void btf_close_sample(struct btf_sample *sample);

// The model of --model, --clusters, ... fitted to the BTF, with `levels` where --levels is not
// given.
relume_status btf_fit(relume_btf_fitted **out, const relume_btf *btf, int levels,
                      const struct btf_options *o);

// What a surface is; `seams` may be NULL.
void btf_say_surface(const struct relume_btf_surface_info *info,
                     const struct relume_btf_seams *seams, bool json);

// The tasks that have files of their own.
relume_status btf_render(const struct args *args);
relume_status btf_tile(const struct args *args);
relume_status btf_plant(const struct args *args);
relume_status btf_expand(const struct args *args);
extern const struct command btf_task_edit, btf_task_make, btf_task_synth;

// What may be written as a model: a folder as relume_folder_check has it, or an .exr file.
relume_status btf_check_model_output(const struct btf_options *o);

// Whether `btf render` is asked for objects: --mesh, or a description in JSON.
bool btf_is_objects(const struct btf_options *o);
// These, ray traced.
relume_status btf_render_objects(const struct btf_options *o);
relume_status objects_open(relume_objects **out, const char *path, const char *reflections,
                           const struct args *args);
// What their mirrors reflect along a ray, as a constraint of a file of edits, to standard output.
relume_status objects_tell_reflection(const relume_objects *objects, struct relume_vec3 eye,
                                      struct relume_vec3 direction);

#endif
