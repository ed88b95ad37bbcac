// btf_upload.h - a measured material on the GPU: the arrays of its model and the directions around
// any direction, as buffer textures
#ifndef VIEWER_BTF_UPLOAD_H
#define VIEWER_BTF_UPLOAD_H

#include "gl/program.h"
#include "material/model/environment.h"
#include "relit/light_uniforms.h"

#include <relume/world/object.h>

enum { BTF_ARRAYS = 5, BTF_MESHES = 4, BTF_BUFFERS = BTF_ARRAYS + BTF_MESHES + 1, BTF_LEVELS = 17 };

// Three numbers of an array and, as the fourth, one of the array after it.
enum { BTF_PAIR = 31 };

// How a model is drawn.
struct btf_shader {
    const char *model;        // NULL ends the list
    const char *source;       // a file of viewer/shaders/btf
    int numbers[BTF_ARRAYS];  // of a texel of each array: 1, 3 or 4; BTF_PAIR; 0: there is none
    bool lobes;   // which an environment is looked up for, rather than summed over the lights
    bool relief;  // which rays are followed into: level.relief
};
extern const struct btf_shader btf_shaders[];
// NULL when a model cannot be drawn.
const struct btf_shader *btf_shader_find(const char *model);

// Texture units of its programs.
enum {
    BTF_UNIT_MESHES = BTF_ARRAYS,
    BTF_UNIT_MAP = BTF_UNIT_MESHES + BTF_MESHES,
    BTF_UNIT_PLACE,
    BTF_UNIT_NORMAL,
    BTF_UNIT_TANGENT,
    BTF_UNIT_FOOTPRINT,
    BTF_UNIT_SHADOW,
    BTF_UNIT_PICTURE,
    BTF_UNIT_SKY = BTF_UNIT_SHADOW,  // of programs that know no light sample
    BTF_UNIT_TABLE = BTF_UNIT_PICTURE,
};

// A level of detail; those after the first have no meshes of their own.
struct btf_level {
    GLuint texture[BTF_BUFFERS], buffer[BTF_BUFFERS];
    int width, height, area, counts[4], map[4];  // as btf.glsl
    float relief[3];                             // as gbrdf.frag.glsl
    int side[2], ray_steps;                      // of the sample; of both rays, at most
};
struct btf_material {
    const struct btf_shader *shader;
    struct btf_level level[BTF_LEVELS];
    int levels;
    GLuint table, table_buffer;  // what an environment needs (btf_need_table), or 0
    bool without_cosine;
    double rim;    // relume_btf_fitted_info
    size_t bytes;  // of graphics memory
};
// RELUME_ESYSTEM with a sentence when it does not fit or cannot be drawn, RELUME_ENOMEM.
relume_status btf_upload(struct btf_material *out, const struct gl *gl,
                         const struct relume_object_material *material,
                         const struct relume_log *log);
void btf_release(struct btf_material *material, const struct gl *gl);
// The textures of a level for the program in use.
void btf_use(const struct btf_material *material, const struct gl *gl, int level);
// For models of lobes the parts of lobes, for others the part of the sky that each light
// represents, as sky.glsl. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status btf_need_table(struct btf_material *material, const struct gl *gl,
                             const struct relume_object_material *from,
                             const relume_prefiltered_maps *prefiltered,
                             const struct relume_log *log);

#endif
