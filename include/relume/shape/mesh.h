// mesh.h - surfaces as triangles: read from files, written to files
//
//     struct relume_mesh mesh;
//     relume_mesh_read(&mesh, "statue.obj", NULL);
//     relume_mesh_write(&mesh, "statue.glb", NULL);
//     relume_mesh_free(&mesh);
//
// Formats: Wavefront OBJ, PLY (Turk 1994) and glTF 2.0 (Khronos 2021; .glb is written, one file).
#ifndef RELUME_MESH_H
#define RELUME_MESH_H

#include <relume/base.h>

#ifdef __cplusplus
extern "C" {
#endif

// Arrays of `vertex_count` and `triangle_count` items; NULL is what there is none of. Zero-filled
// is empty. Who makes one fills arrays from malloc(), or from the application's own allocator
// (context.h). Thread-safety: plain data.
struct relume_mesh {
    size_t vertex_count, triangle_count;  // each at most 2^32 - 1
    float (*position)[3];                 // in the unit of the file
    float (*normal)[3];                   // unit length, outwards; NULL: none
    float (*texture)[2];      // (u, v), (0, 0) the lower left of the picture; NULL: none
    uint8_t (*colour)[4];     // sRGB red, green, blue, and opacity, of 255; NULL: none
    uint32_t (*triangle)[3];  // vertices, counter-clockwise seen from outside
    uint32_t *part;           // of each triangle, below `parts`; NULL: all are of one
    char **part_name;         // [parts]; NULL: none
    int parts;                // at most 1024
    char *picture;            // the file of the texture's picture; NULL: none
    bool cut_out;             // where the picture is more than half transparent there is nothing
};
RELUME_API void relume_mesh_free(struct relume_mesh *mesh);

// A corner of triangles with the frame in which its surface reflects.
struct relume_mesh_vertex {
    float position[3], normal[3];  // world; unit
    float tangent[4];  // unit, along growing s; the fourth is the handedness h: the other tangent,
                       // up in the picture, is h * cross(normal, tangent)
    float texture[2];  // (s, t) in repeats of the sample, t down from the upper edge
};

// How meshes are read and written.
struct relume_mesh_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
};
#define relume_mesh_params(...)                                                                    \
    (&(const struct relume_mesh_params){RELUME_SIZED(relume_mesh_params), __VA_ARGS__})

// OBJ, PLY or, in the helper, what Assimp reads; chosen by the extension. Polygons become
// triangles, missing normals are made smooth, vertices that are alike in everything are one.
// Colours of vertices are read, too. Positions are finite and below 1e18. An input
// status with a sentence, RELUME_ENOMEM, RELUME_ESYSTEM.
RELUME_RESULT relume_status relume_mesh_read(struct relume_mesh *out, const char *path,
                                             const struct relume_mesh_params *params);

// By the extension: .obj (parts as materials, colours behind the positions), .ply (binary, little
// endian) or .glb (with the picture, where that is PNG or JPEG and can be read). The file appears
// whole or not at all; what is written needs 1 MiB of memory whatever the mesh. An empty mesh is
// written too, which glTF has no word for: a file without meshes. PLY says the name of `picture`;
// of an OBJ without parts a second file says it, "cow.mtl" of "cow.obj". RELUME_EINVAL with a
// sentence (another extension, triangles of vertices that are not there, counts that are too large,
// .glb beyond 4 GiB), RELUME_EIO, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_mesh_write(const struct relume_mesh *mesh, const char *path,
                                              const struct relume_mesh_params *params);
// What relume_mesh_write would say of the name alone.
RELUME_RESULT relume_status relume_mesh_check(const char *path,
                                              const struct relume_mesh_params *params);

#ifdef __cplusplus
}
#endif
#endif
