// maps.h - what a surface is made of, as maps that other programs read: colour, gloss, relief
//
// Of every pixel the reflectance model of glTF 2.0 (appendix B: Lambert under Cook and Torrance's
// microfacets with the GGX distribution, Smith's shadowing and Schlick's Fresnel term) is fitted to
// its values under the captured lights. How sharp highlights are is known of few pixels only, so
// pixels share a codebook of materials: a few kinds of gloss, learned from pixels all over the
// picture, of which each pixel takes one or lies between them; its colour is its own. Shadows and
// other light that the model has not are left out as samples that do not fit.
#ifndef RELUME_MAPS_H
#define RELUME_MAPS_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/image.h>
#include <relume/pack.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { RELUME_MAPS_MOST_MATERIALS = 16 };
// Fewer lights say nothing about gloss, and fewer than three nothing about the shape.
enum { RELUME_MAPS_LEAST_LIGHTS = 6 };

// A display value that differs by more than this from the photograph is off.
#define RELUME_MAPS_OFF 0.1

// One entry of the codebook.
struct relume_maps_material {
    bool metal;        // all colour is in the highlight, there is no diffuse light
    double f0;         // reflectance at normal incidence; of a metal it is the pixel's base colour
    double roughness;  // [0, 1]; GGX's alpha is its square
    double share;      // of the known pixels, which are nearest to it
};

// How near re-rendered maps come to the photographs of some lights. Display values: sRGB-coded and
// clipped to [0, 1]; NaN where nothing could be measured.
struct relume_maps_quality {
    int lights;
    double psnr_db, ssim, delta_e;  // means over lights, as relume/evaluate.h
    double off;       // share of pixels in the mask that are off by more than RELUME_MAPS_OFF, RMS
                      // over lights and colours: what such maps cannot show
    double shadowed;  // share of samples that much darker than the maps: cast shadows
    double brighter;  // ... and that much brighter: interreflection, missed highlights, glass
};

// All pictures have the size of the view; row 0 is the top. The caller destroys it. Thread-safety:
// plain data.
struct relume_maps {
    int width, height;
    struct relume_image normal;  // three channels: unit vectors, world; 0 where nothing is known
    struct relume_image base_color;  // three: linear, [0, 1]; glTF's
    struct relume_image roughness;   // one: glTF's, [0, 1]
    struct relume_image metallic;    // one: 0 or 1
    struct relume_image specular;    // three: reflectance at normal incidence, [0, 1]
    struct relume_image height_map;  // one: world units, towards the viewer, mean 0
    struct relume_image occlusion;   // one: share of the sky that is not hidden by the relief
    struct relume_image confidence;  // one: share of the fitted lights under which the re-rendering
                                     // is within RELUME_MAPS_OFF of the photograph
    struct relume_geometry geometry;  // of the view
    double uv[2];                     // where its camera stood; slabs
    double pixel;                     // width of a pixel, world units
    double gain;                      // photographs were multiplied by it
    bool matte_only;                  // too few lights for gloss: roughness 1, no highlight
    int lights;                       // that were fitted
    int materials;                    // of the codebook
    // The first `materials` of them count.
    struct relume_maps_material material[RELUME_MAPS_MOST_MATERIALS];
    struct relume_maps_quality fitted;    // over the lights that were fitted, at most 16 of them
    struct relume_maps_quality held_out;  // over those that were not
    double width_mm;  // of a folder that was opened: the width of the picture; 0: not known
    bool directx;     // ... and that its normal.png has its green pointing down
};
RELUME_API void relume_maps_destroy(struct relume_maps *maps);

// How maps are fitted. Borrowed during the call.
struct relume_maps_params {
    size_t struct_size;            // filled by the macro (base.h)
    const struct relume_log *log;  // progress, notes
    int threads;                   // default: all cores
    int view;                      // of a slab; default 0
    int held_out;   // lights that only judge; default every 8th, at least 2; -1: none
    int materials;  // most entries of the codebook, 1 to RELUME_MAPS_MOST_MATERIALS; default 8
    double gain;    // photographs are multiplied by it before all else; default 1, or what brings
                    // the brightest surface to 0.8 when most of it is above 1 or all below 0.03
    bool keep_normals;  // as photometric stereo finds them; default: improved by the highlights
    bool gloss_alone;   // a quarter of the time: normals begin with those of a matte surface, kinds
                        // of gloss are told apart by every fourth pixel, and no height, occlusion
                        // and quality are found
};
#define relume_maps_params(...)                                                                    \
    (&(const struct relume_maps_params){RELUME_SIZED(relume_maps_params), __VA_ARGS__})

// Maps of one view of a planar capture or of one slab. With 3 to 5 lights there is no gloss
// (matte_only) and nothing is held out. RELUME_EUNFIT with a sentence for fewer lights, lights in
// one plane and a mask that shows nothing; RELUME_EUNSUPPORTED for panoramas and several slabs;
// RELUME_EINVAL for a view, counts or a gain that cannot be; RELUME_ELIMIT, RELUME_ENOMEM,
// RELUME_ECANCEL, an input status. `*out` is empty on failure.
RELUME_RESULT relume_status relume_maps_fit(struct relume_maps *out, const relume_capture *capture,
                                            const struct relume_maps_params *params);
// The same from a file, relit under its own lights, at most 64 of them. Errors are against the
// file's own pictures. Also RELUME_EIO: the pictures wait in a temporary file.
RELUME_RESULT relume_status relume_maps_fit_pack(struct relume_maps *out, relume_pack *pack,
                                                 const struct relume_maps_params *params);

// What is written of maps.
struct relume_maps_write_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int threads;      // default: all cores
    bool force;       // replace a folder that relume made
    bool directx;     // normal.png has its green pointing down the picture, for programs that want
                      // it so; model.gltf has an upward one of its own, as glTF says
    int mesh;         // columns of a mesh displaced by the height, up to 1024; default: a plane
    double width_mm;  // width of the picture; default: that of the maps, else a world unit is taken
                      // as a metre
};
#define relume_maps_write_params(...)                                                              \
    (&(const struct relume_maps_write_params){RELUME_SIZED(relume_maps_write_params), __VA_ARGS__})

// Write the folder `path` (docs/maps.md), whole or not at all. RELUME_EINVAL, RELUME_EIO,
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_maps_write(const struct relume_maps *maps, const char *path,
                                              const struct relume_maps_write_params *params);

// The maps of such a folder again, from its .exr files and maps.json; edits that are kept with it
// are not applied (relume/material/edit.h). What is known of the view and how near the maps come to
// photographs is not read. `*out` is empty on failure. An input status with a sentence,
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_maps_open(struct relume_maps *out, const char *path,
                                             const struct relume_log *log);

#ifdef __cplusplus
}
#endif
#endif
