// btf_inputs.h - what `relume btf` is given: folders of BTFs and models, names of materials
#ifndef BTF_INPUTS_H
#define BTF_INPUTS_H

#include "cli.h"

// Whether the folder holds a fitted model.
bool btf_is_model(const char *path);

// A folder, or a built-in material when there is none of that name.
relume_status btf_open(relume_btf **out, const char *name, const struct args *args);

// The sample as it was photographed: every texel seen from --eye, under distant lights.
relume_status btf_render(const struct args *args);

// Whether `btf render` is asked for objects: --mesh, or a description in JSON.
bool btf_is_objects(const struct args *args);
// These, ray traced.
relume_status btf_render_objects(const struct args *args);
relume_status objects_open(relume_objects **out, const char *path, const struct args *args);

#endif
