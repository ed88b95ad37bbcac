// mesh_serve.h - models read in a process of their own: what it is asked, and what it answers
#ifndef MESH_MESH_SERVE_H
#define MESH_MESH_SERVE_H

#include "core/base/helper.h"
#include "shape/mesh/mesh_file.h"

// Messages to the process.
enum mesh_ask_what {
    MESH_OPEN,    // with the file: MESH_NEEDS, MESH_READ or MESH_FAILED answers
    MESH_BESIDE,  // with the file that was needed, or without: the same
    MESH_TAKE,    // with memory for what was read, which is put there: MESH_READ answers
};
struct mesh_ask {
    int what;
    uint64_t file_bytes, max_memory;  // MESH_OPEN
    char name[256];                   // of the file, without its folder
};
enum mesh_answer_what { MESH_NEEDS, MESH_READ, MESH_FAILED };
struct mesh_answer {
    int what;
    bool has_uv, made_normals, has_colours;
    int memory;  // MESH_FAILED without a text: enum helper_short
    // MESH_READ. In memory these follow each other: vertices, triangles, colours where there are,
    // the sizes of pictures (0: a file), the looks of parts, the names of parts and then of
    // pictures, each with a 0, and the pictures.
    uint64_t vertices, triangles, parts, pictures, names_bytes, picture_bytes;
    char text[1024];  // the file that is needed, or why it failed
};

// Bytes of that memory; 0 where the numbers make no sense.
size_t mesh_answer_bytes(const struct mesh_answer *answer);

// What it may take of a processor for a model.
double mesh_read_s(uint64_t file_bytes);

// What the process does until its channel is closed; `bridge` is the module's.
void mesh_serve(int channel, const void *bridge);

#endif
