// mesh_bridge.h - the module that knows Assimp (mesh_other.h), as the helper sees it
#ifndef MESH_MESH_BRIDGE_H
#define MESH_MESH_BRIDGE_H

#include "shape/mesh/mesh_file.h"

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
