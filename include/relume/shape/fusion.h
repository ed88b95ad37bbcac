// fusion.h - the depth of a captured file as one mesh, in the colours of its relit photographs
//
//     relume_fusion(&mesh, &report, pack, relume_fusion_params(.texture = 1024, .judge = true));
//     relume_image_save(&report.picture, "statue.png", NULL);
//
// The depth of all views is fused in a volume of signed distances (Curless, Levoy 1996): each view
// says of a place how far it lies before or behind what the view sees there, as far as the place is
// near; the mean of what the views say changes its sign at the surface, which relume_isosurface
// (volume.h) finds. What no view sees has no surface: holes stay holes.
#ifndef RELUME_FUSION_H
#define RELUME_FUSION_H

#include <relume/base.h>
#include <relume/image.h>
#include <relume/light.h>
#include <relume/pack.h>
#include <relume/shape/mesh.h>
#include <relume/shape/volume.h>

#ifdef __cplusplus
extern "C" {
#endif

// How depth becomes a mesh. Borrowed during the call.
struct relume_fusion_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_limits *limits;
    int threads;  // default: all cores; the mesh is the same for any number
    // Side of a voxel, world units; default: the median distance of what neighbouring pixels see,
    // but at most 512 voxels along the longest side.
    double voxel;
    double farthest;  // what is farther from its eye is left out; default: nothing is
    int block;        // as relume_isosurface_params; default 2
    bool no_colours;  // without the colours of the photographs
    // Side of a picture of the colours that lies on the mesh, texels, at most 16384; default: none,
    // only vertices have colours. Not with `no_colours`.
    int texture;
    bool judge;           // measure how near the coloured mesh is to the relit views
    const char *scratch;  // as relume_volume_params
    // Lights that the photographs are relit by. `lights` NULL: one from before, of panoramas one
    // from each side.
    const struct relume_light *lights;
    int light_count;
};
#define relume_fusion_params(...)                                                                  \
    (&(const struct relume_fusion_params){RELUME_SIZED(relume_fusion_params), __VA_ARGS__})

// What came of it.
struct relume_fusion_report {
    int size[3];                           // of the volume, voxels
    double voxel;                          // its side, world units
    double seconds;                        // of fusing; colours are not counted
    struct relume_isosurface_report mesh;  // of the surface, before what nobody sees was left out
    size_t unseen;                         // triangles left out because no view sees them
    // With `texture`: the picture, linear, which is the caller's to destroy. Texels that no view
    // sees have the colour of those around. (0, 0) of the mesh's coordinates is its lower left.
    struct relume_image picture;
    // With `judge`, where there are colours: the mesh against the relit views, coded in sRGB, over
    // the pixels that show it; and the share of the pixels with depth that these are.
    double psnr_db, shown;
};

// The surfaces that the file's depth shows, in world units, with normals towards the eyes and
// colours (unless `no_colours`). Depth that is infinite or no number is a hole. RELUME_EUNFIT with
// a sentence (no depth, none of it finite, a texture too small for the mesh's charts),
// RELUME_EINVAL (a voxel, block or texture that cannot be; `texture` or `judge` without a report),
// RELUME_ELIMIT, errors of relume_isosurface and relume_frame; then `*out` is empty.
RELUME_RESULT relume_status relume_fusion(struct relume_mesh *out,
                                          struct relume_fusion_report *report, relume_pack *pack,
                                          const struct relume_fusion_params *params);

#ifdef __cplusplus
}
#endif
#endif
