// mesh_other.h - models of every format that Assimp reads, glTF among them
//
// Assimp is 10 MB of C++ that only these formats need, so what knows it is a module of its own,
// librelume-assimp.so, which mesh_other.c opens when the first such model is read.
#ifndef SCENE_MESH_OTHER_H
#define SCENE_MESH_OTHER_H

#include "scene/mesh_read.h"

// Triangles of all that the file shows, where it stands; parts are its materials. RELUME_EDATA with
// a sentence, RELUME_ENOMEM; RELUME_ESYSTEM when the module cannot be loaded.
relume_status mesh_read_other(struct mesh_file *out, const char *path,
                              const struct relume_log *log);

enum { MESH_OTHER_WHY = 256 };

// What the module exports, as `relume_assimp_bridge`.
struct assimp_bridge {
    const char *version;  // RELUME_VERSION of its build; another one's is not used
    // False: `why` says what is wrong, or is empty for want of memory.
    bool (*read)(struct mesh_file *out, const char *path, char why[MESH_OTHER_WHY]);
};

#endif
