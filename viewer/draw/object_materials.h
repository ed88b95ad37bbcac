// object_materials.h - materials of objects on the GPU, and the programs of their models
#ifndef VIEWER_OBJECT_MATERIALS_H
#define VIEWER_OBJECT_MATERIALS_H

#include "draw/btf_upload.h"
#include "draw/draw.h"

struct model_program {
    struct program program;
    const struct btf_shader *shader;
    bool sky;  // for environments
};

struct object_materials {
    const struct gl *gl;
    const struct relume_log *log;
    const relume_objects *objects;
    struct btf_material *material;  // [materials]; without a shader until it is shown
    struct model_program *program;  // [programs], one for each model in use
    int programs;
};

// RELUME_ENOMEM.
relume_status object_materials_create(struct object_materials *m, const struct gl *gl,
                                      const relume_objects *objects, const struct relume_log *log);
void object_materials_destroy(struct object_materials *m);
// Uploads a material when it is first shown. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status object_materials_need(struct object_materials *m, int material);
// The program of a material's model, compiled when it is first shown; `sky`: for environments. The
// material must be there. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status object_materials_program(const struct program **out, struct object_materials *m,
                                       int material, bool sky);
// Draws with the program in use, which has its other uniforms, a material's levels of detail one
// after the other; `sums`: each sums over the measured lights.
void object_materials_draw(const struct object_materials *m, const struct program *program,
                           const struct target *target, int material, bool sums);

#endif
