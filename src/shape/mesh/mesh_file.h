// mesh_file.h - what is read from the file of a model, and what its readers share
#ifndef MESH_MESH_FILE_H
#define MESH_MESH_FILE_H

#include "shape/mesh/mesh.h"

// A picture that a model names: a file, or what the model holds itself.
struct mesh_picture {
    char *name;   // of the file; of one within the model only what messages call it
    void *bytes;  // NULL: it is a file
    size_t size;
};

// What the file of a model says of a part's material, in the terms of glTF 2.0 (Khronos 2021,
// 3.9.2): linear colour, what it has of a metal, and the root of GGX's roughness, all in [0, 1].
struct mesh_look {
    bool given;  // false: it says nothing, and the rest counts as little
    float colour[3], metallic, roughness;
    int picture;  // that multiplies the colour, of `pictures`; -1: none
    int surface;  // its green multiplies the roughness, its blue the metal; -1: none
    enum mesh_cover {
        MESH_WHOLE,    // nothing shines through
        MESH_CUT,      // what is less opaque than `cutoff` is not there
        MESH_BLENDED,  // the opacity is the part that is there
    } cover;
    float opacity, cutoff;  // in [0, 1]; the alpha of `picture` multiplies the opacity
    int normal;             // tangent space, times `bump` along the surface; -1: none
    float bump;             // in [-16, 16]
    float emission[3];      // linear, in [0, 65504]
    int emitted;            // that multiplies it; -1: none
};
static const struct mesh_look mesh_look_none = {.picture = -1,
                                                .surface = -1,
                                                .opacity = 1,
                                                .cutoff = 0.5f,
                                                .normal = -1,
                                                .bump = 1,
                                                .emitted = -1};
// One that is said: white and rough.
static inline struct mesh_look mesh_look_white(void)
{
    struct mesh_look look = mesh_look_none;
    look.given = true;
    look.roughness = look.colour[0] = look.colour[1] = look.colour[2] = 1.0f;
    return look;
}
static inline bool mesh_look_has_picture(const struct mesh_look *l)
{
    return l->picture >= 0 || l->surface >= 0 || l->normal >= 0 || l->emitted >= 0;
}

struct mesh_file {
    struct mesh mesh;
    uint8_t (*colour)[4];  // of each vertex, as relume_mesh; NULL: none
    bool has_uv;
    bool made_normals;       // the file has none, or not everywhere
    char *picture;           // the file of its texture, or NULL
    char **part;             // [parts]: names; a triangle's material is the number of its part
    int parts;               // at least 1 once read
    struct mesh_look *look;  // [parts]
    struct mesh_picture *pictures;  // [picture_count]
    int picture_count;
};
void mesh_file_free(struct mesh_file *file);

// The number of the part called `name`, which is added when it is new; -1 when memory is short or
// there are too many.
int mesh_file_part(struct mesh_file *file, const char *name);
// A new one, whatever it is called; likewise.
int mesh_file_new_part(struct mesh_file *file, const char *name);
// The number of a picture of a file; -1 likewise.
int mesh_file_picture(struct mesh_file *file, const char *name);
// The same of `size` bytes, which are copied.
int mesh_file_picture_of(struct mesh_file *file, const char *name, const void *bytes, size_t size);

// The two formats; `text` is the whole file of `size` bytes and a 0 behind it.
relume_status mesh_read_obj(struct mesh_file *out, const char *text, size_t size, const char *path,
                            const struct relume_log *log);
relume_status mesh_read_ply(struct mesh_file *out, const char *text, size_t size, const char *path,
                            const struct relume_log *log);
// What a library says of the materials that it names.
struct mesh_library {
    struct mesh_library_look {
        char *name;
        struct mesh_look look;
    } * material;
    size_t count;
};
void mesh_library_free(struct mesh_library *library);
// Add those of the file `path`; pictures are added to `out`, and the first diffuse one (map_Kd)
// becomes its `picture` where there is none yet. A file that cannot be read says nothing.
// RELUME_ENOMEM.
relume_status mesh_read_mtl(struct mesh_library *library, struct mesh_file *out, const char *path,
                            const struct relume_log *log);
// NULL: it says nothing of a material of that name.
const struct mesh_look *mesh_library_find(const struct mesh_library *library, const char *name);

#endif
