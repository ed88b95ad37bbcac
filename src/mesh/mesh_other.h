// mesh_other.h - models of every format that Assimp reads, glTF among them
//
// Assimp is 10 MB of C++ that only these formats need, so what knows it is a module of its own,
// librelume-assimp.so. The helper (base/helper.h) opens it and reads every model in a process of
// its own: what is damaged, or made to do harm, does none here.
#ifndef MESH_MESH_OTHER_H
#define MESH_MESH_OTHER_H

#include "mesh/mesh_read.h"

// Triangles of all that the file shows, where it stands; parts are its materials. RELUME_EDATA with
// a sentence, RELUME_ENOMEM; RELUME_ESYSTEM when the module cannot be loaded. `log` says how much
// memory a model may take.
relume_status mesh_read_other(struct mesh_file *out, const char *path,
                              const struct relume_log *log);

enum { MESH_OTHER_WHY = 256 };

// Where the module has its files from.
struct mesh_source {
    const char *name;  // of the model, without its folder
    // Open this name, the model's or one that the model names: a descriptor, or -1.
    int (*open)(void *context, const char *name);
    void *context;
};

// What the module exports, as `relume_assimp_bridge`.
struct assimp_bridge {
    const char *version;  // RELUME_VERSION of its build; another one's is not used
    // False: `why` says what is wrong, or is empty for want of memory.
    bool (*read)(struct mesh_file *out, const struct mesh_source *source, char why[MESH_OTHER_WHY]);
};

#endif
