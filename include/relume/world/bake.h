// bake.h - objects whose light is computed beforehand: shadows, light from surface to surface and
// materials become one linear map, at each texel of an atlas, from lights to what is seen
//
// A texel x shows in its own frame, from the direction v, under a distant light from l,
//     T(x, v, l) = sum_k y[x, v, k] b_k(l)
// so that all lights and skies are one vector of weights w_k (a coder is a basis, coder.h). v lies
// on a parabolic map (Heidrich and Seidel 1998). All numbers y[x, ., .] of a texel are one vector,
// compressed by local principal components (Meseth 2008, 10.1.2 and Eq. 10.3):
//     y[x] ~ mean[c(x)] + sum_i a_i(x) e_i[c(x)]
// Under lights mean and e_i become colours for each direction v; drawing adds them up (10.1.3).
//
// Values are those of objects (object.h): a white matte surface shows n.l under a light of 1, and 1
// where an environment of 1 comes from everywhere.
#ifndef RELUME_BAKE_H
#define RELUME_BAKE_H

#include <relume/base.h>
#include <relume/format/coder.h>
#include <relume/light.h>
#include <relume/world/object.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    RELUME_BAKED_MOST_SIDE = 32,  // of the map of views
    RELUME_BAKED_MOST_CUBE = 32,  // of a face of the cube of lights
    RELUME_BAKED_MOST_CLUSTERS = 1024,
    RELUME_BAKED_MOST_COMPONENTS = 256,
};

// How objects are baked. Borrowed during the call.
struct relume_bake_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int threads;                       // default: all cores
    const struct relume_light *fixed;  // one light for ever, the sum of these; NULL: any lights
    int fixed_count;
    const struct relume_basis *basis;  // of any light; default sh. Not learned ones, nor such as
                                       // know the upper hemisphere only
    int coefficients;                  // of the basis; default 36, `table`: 256
    int cube;  // any light is a cube of faces of so many texels a side, in Haar wavelets, in place
               // of the basis: 2, 4, 8, 16 or 32; default: it is not
    int kept;  // wavelets of a face that are kept of each component, [1, cube^2]; default 20
    int width, height;  // of the atlas, texels; default 256
    int side;           // of the map of views; default: 1 where all materials look alike from
                        // everywhere, else 16 of fixed light, 8 of any
    int clusters;       // default 128; fewer where there are few texels
    int components;     // of each cluster; default 4 of fixed light, 8 of any
    bool per_view;      // clusters and components for each view of their own
    int bounces;        // of light from surface to surface, at most 64; default 2; below 0: none
    int rays;           // from each texel, for light from surfaces, at most 65536; default 64
    int lights;         // directions that any light is sampled from; default: 12 times the
                        // coefficients, 1024 at most. A cube has its own
    // Fixed light on materials that are not matte goes through spherical harmonics of degree 5
    // where the atlas has more texels than the material, which is many times faster (Meseth 2008,
    // 10.1.1) and blurs sharp highlights; or not.
    bool light_by_light;
};
#define relume_bake_params(...)                                                                    \
    (&(const struct relume_bake_params){RELUME_SIZED(relume_bake_params), __VA_ARGS__})

// Bake all objects as they stand and are covered now. Translucent ones are matte. RELUME_EUNFIT
// with a sentence (mirrors; an atlas that is too small), RELUME_EINVAL with a sentence (params),
// RELUME_ELIMIT with a sentence (memory; what no file can hold), RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_bake(relume_baked **out, const relume_objects *objects,
                                        const struct relume_bake_params *params);
RELUME_API void relume_baked_destroy(relume_baked **baked);

// Write an OpenEXR file (docs/baking.md). RELUME_ELIMIT (it cannot hold as much), RELUME_EIO,
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_baked_save(const relume_baked *baked, const char *path,
                                              const struct relume_log *log);
// Read one. An input status with a sentence, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_baked_open(relume_baked **out, const char *path,
                                              const struct relume_limits *limits,
                                              const struct relume_log *log);

// The least and the largest coordinates of its surface.
RELUME_API void relume_baked_box(float box[2][3], const relume_baked *baked);

// What a baked object is; pointers belong to it.
struct relume_baked_info {
    bool fixed;                        // it shows one light
    const struct relume_basis *basis;  // of any light; NULL: fixed, or a cube
    int coefficients;                  // of light: 1, those of the basis, or 6 cube^2
    int cube, kept;                    // 0: it is no cube
    int width, height;                 // of the atlas
    size_t texels;                     // of these that hold something
    int side;                          // of the map of views, 1: the same from everywhere
    int clusters, components;
    bool per_view;
    int bounces;
    size_t triangles;
    uint64_t bytes;  // as it is kept: texels, components, mesh
    double error;    // of the compression: RMS over RMS of the data (not over the mesh)
};
// It belongs to the baked object.
RELUME_API const struct relume_baked_info *relume_baked_info(const relume_baked *baked);

#ifdef __cplusplus
}
#endif
#endif
