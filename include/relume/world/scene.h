// scene.h - the virtual light stage: built-in scenes rendered under many lights
#ifndef RELUME_SCENE_H
#define RELUME_SCENE_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/material/btf.h>

#ifdef __cplusplus
extern "C" {
#endif

struct relume_scene_builder;  // what a scene puts its things into; private

// A built-in scene. Constant; a NULL-terminated list of all is relume_scenes.
struct relume_scene_kind {
    const char *name;
    const char *summary;                // one line for help texts
    enum relume_projection projection;  // how it is seen when nothing else is asked
    bool takes_mesh;                    // --mesh replaces its own model
    relume_status (*build)(struct relume_scene_builder *builder);  // adds meshes and materials
};
// All scenes; NULL ends the list.
extern RELUME_API const struct relume_scene_kind *const relume_scenes[];
// NULL when there is none of that name.
RELUME_API const struct relume_scene_kind *relume_scene_find(const char *name);

// Geometry and materials ready for tracing. Never changes. Thread-safety: safe.
typedef struct relume_scene relume_scene;

// What a scene is made of. Borrowed during the call.
struct relume_scene_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const char *mesh;  // OBJ or PLY for scenes that take one (`bust`); NULL: the procedural default
};
#define relume_scene_params(...)                                                                   \
    (&(const struct relume_scene_params){RELUME_SIZED(relume_scene_params), __VA_ARGS__})

// Returns an input status for a mesh that cannot be used, RELUME_EINVAL for a mesh where none is
// taken, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_scene_create(relume_scene **out,
                                                const struct relume_scene_kind *kind,
                                                const struct relume_scene_params *params);
RELUME_API void relume_scene_destroy(relume_scene **scene);

// Several slabs around the object, each looking at the origin from a distance of 3. Slab 0 is where
// one slab is, before +z; the others follow to the right as seen from there (towards +x).
enum relume_ring {
    RELUME_RING_NONE = 0,  // one slab
    RELUME_RING_4,
    RELUME_RING_6,
    RELUME_RING_8,
    RELUME_RING_CUBE,  // four, and one from above whose pictures have -z at their top
};

// What is photographed and how. All that is pointed at is borrowed during the call.
struct relume_synth_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    enum relume_projection projection;  // used only when `projection_set`
    bool projection_set;                // default: the scene's own projection
    int size;       // pixels: width of planar and slab images and of a cube face,
                    // height of other panoramas (cylindrical: 4:1, without
                    // its discs; spherical: 2:1);
                    // default 256
    bool discs;     // cylindrical: with end discs as fine as the cylinder, in further rows below it
    int grid[2];    // slab: cameras along u and v; default 5 x 5
    double spread;  // slab: the grid reaches from -spread to spread; default 0.5, of several
                    // slabs so far that neighbours overlap: 1.15 x 3 tan(180 degrees / slabs)
    enum relume_ring ring;           // slab: several of them, each with the grid
    const struct relume_vec3 *eyes;  // slab: cameras instead of the grid, all of one z;
                                     // panorama: its one centre; planar: (0, 0, z) perspective
    int eye_count;
    const struct relume_vec3 *lights;  // unit directions; light_count of them, at least 1
    int light_count;
    bool near;    // `lights` are places of lamps, not the world's origin, where each is as strong
                  // as a distant light; from there they fall off with the square of the distance
    int samples;  // camera rays per pixel (stratified); default 16
    int bounces;  // indirect bounces of light; default 0: direct light and mirrors only
    uint64_t seed;
    int threads;  // default: all cores
    bool force;   // replace an existing folder
};
#define relume_synth_params(...)                                                                   \
    (&(const struct relume_synth_params){RELUME_SIZED(relume_synth_params), __VA_ARGS__})

// Render every view under every light into the new folder `dir`: half-float EXR images, depth,
// capture.json. The folder appears whole or not at all. Same seed, same bytes for any number of
// threads; the geometry does not depend on the lights.
// Returns RELUME_EINVAL, RELUME_EIO, RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_scene_capture(const relume_scene *scene, const char *dir,
                                                 const struct relume_synth_params *params);

// ------------------------------------------------------------------ the virtual gonioreflectometer

// A built-in material: a periodic relief with colours and gloss. Constant; a NULL-terminated list
// of all is relume_btf_materials.
struct relume_btf_material;
// All built-in materials; NULL ends the list.
extern RELUME_API const struct relume_btf_material *const relume_btf_materials[];
// NULL when there is none of that name.
RELUME_API const struct relume_btf_material *relume_btf_material_find(const char *name);
// As people write it; constant.
RELUME_API const char *relume_btf_material_name(const struct relume_btf_material *material);

// What is wrong with the apparatus; all zero: nothing. Each photograph, that is each pair of view
// and light, has its own error of place and of brightness. Thread-safety: plain data.
struct relume_btf_faults {
    double blur;   // of lens and sensor seen from above, standard deviation in texels, [0, 100]; a
                   // tilted sample is blurred further in the direction of the tilt, as 1 / cosine
    double noise;  // of a white surface's photons, standard deviation in parts of its light, [0, 1]
    double shift;  // of the rectified photograph, along u and v, standard deviation in texels, [0,
                   // 100]
    double flicker;  // of the lamp from photograph to photograph, standard deviation, [0, 1]
};

// What a sample is measured by. All that is pointed at is borrowed during the call.
struct relume_btf_synth_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int size;    // texels a side, [1, 1024]; default 64
    int extent;  // [1, 16]; default 1: this many times as many stones, threads, ... along a side
    const struct relume_vec3 *view;  // with `views`; default: the 81 of the Bonn laboratory
    int views;
    const struct relume_vec3 *light;  // with `lights`; default: the same
    int lights;
    int samples;    // camera rays a texel and view; default 4; fewer: texels are not resampled
    int bounces;    // of light inside the relief, beside direct light; default 1, negative: none
    uint64_t seed;  // of the relief and of the sampling
    int threads;    // default: all cores
    const char *scratch;              // as in relume_btf_params
    struct relume_btf_faults faults;  // default: none
};
#define relume_btf_synth_params(...)                                                               \
    (&(const struct relume_btf_synth_params){RELUME_SIZED(relume_btf_synth_params), __VA_ARGS__})

// Measure one period of the relief under every light from every view: parallel light, orthographic
// views, rectified to the plane of the relief's mean height (whatever lies off it is shifted by
// parallax, as in photographs), and resampled to texels by a tent of one texel's reach: the sample
// is treated as periodic. Values include n.l. The relief's height and normals come along.
// Same seed, same bytes for any number of threads.
// Returns RELUME_EINVAL, RELUME_ENOMEM, RELUME_ESYSTEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_btf_synth(relume_btf **out,
                                             const struct relume_btf_material *material,
                                             const struct relume_btf_synth_params *params);

#ifdef __cplusplus
}
#endif
#endif
