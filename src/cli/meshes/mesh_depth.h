// mesh_depth.h - the part of `relume mesh` that is about depth
#ifndef MESHES_MESH_DEPTH_H
#define MESHES_MESH_DEPTH_H

#include "cli/meshes/mesh_tasks.h"
#include "cli/frame_options.h"

struct depth_options {
    struct light_options lighting;
    double voxel, farthest;
    bool no_colours;
    int texture;
};
// Rows of a table of options.
#define DEPTH_ROWS                                                                                 \
    GROUP("depth"),                                                                                \
        NUMBER("--voxel", depth.voxel, "SIZE",                                                     \
               "how fine, in world units; default: as fine as the pixels see, at most 512 along "  \
               "a side",                                                                           \
               1e-9, 1e9),                                                                         \
        NUMBER("--farthest", depth.farthest, "D",                                                  \
               "leave out what is farther from the eye, as a sky with depth", 1e-9, 1e9),          \
        FLAG("--no-colours", depth.no_colours, "without the colours of the photographs"),          \
        INT("--texture", depth.texture, "N",                                                       \
            "colours as a picture of N x N texels, OUT.png, in place of colours of vertices", 16,  \
            16384),                                                                                \
        TEXTS("--light", depth.lighting.light, "SPEC",                                             \
              "relight the photographs by it (docs/lights.md); repeats; default: a frontal one, "  \
              "in panoramas from all sides"),                                                      \
        TEXT("--rig", depth.lighting.rig, "FILE",                                                  \
             "lights of a rig (JSON), before those of "                                            \
             "--light")

relume_status mesh_of_depth(const struct args *args, const struct depth_options *o, int block,
                            const char *output, bool json);

#endif
