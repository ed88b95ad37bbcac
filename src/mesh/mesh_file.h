// mesh_file.h - what is read from the file of a model, and what its readers share
#ifndef MESH_MESH_FILE_H
#define MESH_MESH_FILE_H

#include "mesh/mesh.h"

struct mesh_file {
    struct mesh mesh;
    uint8_t (*colour)[4];  // of each vertex, as relume_mesh; NULL: none
    bool has_uv;
    bool made_normals;  // the file has none, or not everywhere
    char *picture;      // the file of its texture, or NULL
    char **part;        // [parts]: names; a triangle's material is the number of its part
    int parts;          // at least 1 once read
};
void mesh_file_free(struct mesh_file *file);

// The number of the part called `name`, which is added when it is new; -1 when memory is short or
// there are too many.
int mesh_file_part(struct mesh_file *file, const char *name);

// The two formats; `text` is the whole file of `size` bytes and a 0 behind it.
relume_status mesh_read_obj(struct mesh_file *out, const char *text, size_t size, const char *path,
                            const struct relume_log *log);
relume_status mesh_read_ply(struct mesh_file *out, const char *text, size_t size, const char *path,
                            const struct relume_log *log);
// The diffuse picture (map_Kd) that a material library names, or NULL.
char *mesh_mtl_picture(const char *path, const struct relume_log *log);
// `name` in the folder of `path`; NULL when memory is short.
char *mesh_beside(const char *path, const char *name);

#endif
