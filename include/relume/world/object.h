// object.h - things covered with measured materials: meshes with texture coordinates and tangent
// frames, on each part a BTF or a model of one (btf.h), shown under the lights of a rig
//
// At each point the directions to the eye and the light are turned into the frame of the surface
// (x along growing s, z along the normal) and the material is asked; its values hold n.l already
// (Meseth 2008, chapter 9, Eq. 9.3 without its second cosine). Light reaches a point when nothing
// of the objects lies between: shadows are hard, there is no light from object to object. Pixels
// that cover many texels show means of them: levels of detail of the model, where it has such.
//
// Under an environment a material shows its values under all directions, times the share of the
// light that reaches the point, in each colour: of 64 light samples drawn from the environment,
// each times n.l, what nothing stands before over all (a ratio estimator; Heitz, Hill, McGuire
// 2018).
//
// A part may be a mirror instead: it shows its surroundings, which are the relit panorama that it
// stands in, or the environment lights of the rig where there is none; no objects, and of other
// lights no highlights. What it shows can be edited (reflection.h).
#ifndef RELUME_OBJECT_H
#define RELUME_OBJECT_H

#include <relume/base.h>
#include <relume/frame.h>
#include <relume/image.h>
#include <relume/light.h>
#include <relume/material/btf.h>
#include <relume/material/surface.h>
#include <relume/relight/slab_set.h>
#include <relume/renderer.h>
#include <relume/shape/mesh.h>
#include <relume/world/reflection.h>
#include <relume/world/transport.h>

#ifdef __cplusplus
extern "C" {
#endif

// Thread-safety: safe while nobody chooses.
typedef struct relume_objects relume_objects;
// An object with its light computed beforehand (bake.h).
typedef struct relume_baked relume_baked;

struct relume_objects_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_limits *limits;
    const char *scratch;  // as relume_btf_params
    int threads;          // default: all cores
};
#define relume_objects_params(...)                                                                 \
    (&(const struct relume_objects_params){RELUME_SIZED(relume_objects_params), __VA_ARGS__})

// Read a description (docs/objects.md). Meshes are OBJ, PLY or what Assimp reads, such as glTF;
// materials are folders of BTFs, of fitted models or of surfaces, .btf files of Bonn's data base,
// or g-BRDFs as .exr; parts without one show what their mesh's file says. What a mesh lacks is
// made, with a warning: normals, texture coordinates (from the three axes). An input status with a
// sentence, RELUME_ENOMEM, RELUME_ESYSTEM when Embree or the reader of a format is missing. A baked
// object (.exr) or a model is opened as the only one, as relume_objects_of_mesh does without
// materials.
RELUME_RESULT relume_status relume_objects_open(relume_objects **out, const char *path,
                                                const struct relume_objects_params *params);
// One mesh, all of it of the first of `count` materials (0: as its file says,
// what it says nothing of in matte grey, with a note), its texture
// repeated `repeat` times (0: 1) in each direction; `mesh` NULL: a cushion, which shows all of a
// sample from many sides. Likewise.
RELUME_RESULT relume_status relume_objects_of_mesh(relume_objects **out, const char *mesh,
                                                   const char *const *materials, int count,
                                                   double repeat,
                                                   const struct relume_objects_params *params);
RELUME_API void relume_objects_destroy(relume_objects **objects);

// What is there of a surface, and what it sends of its own.
enum relume_object_cover {
    RELUME_COVER_WHOLE,    // all of it
    RELUME_COVER_CUT,      // where its opacity is `cutoff` or more
    RELUME_COVER_BLENDED,  // by its opacity: the rest of the light passes
};
struct relume_object_skin {
    enum relume_object_cover cover;
    float cutoff;  // [0, 1]
    bool sends;    // not everywhere 0
    // Of four channels, each half as wide and high as the one before, to 1 x 1: what it sends,
    // linear; the opacity, [0, 1]. They repeat like the material; the first alone says what is
    // there.
    const struct relume_image *texels;  // [levels]
    int levels;
};

// One material of the objects; pointers belong to them.
struct relume_object_material {
    const char *name;                   // of its folder
    const char *model;                  // "measured", or what relume_btf_model_name says
    const relume_btf *btf;              // one of the two
    const relume_btf_fitted *fitted;    // or NULL
    const relume_btf_surface *surface;  // of either, with all levels of detail
    bool mapped;                        // the surface has a map; else it is the sample
    int width, height;                  // texels of one repeat
    uint64_t bytes;                     // of its arrays
    // A mirror has no arrays: of what it reflects it shows F + (1 - F) (1 - cos)^5, the angle from
    // its normal to the eye (Schlick 1994, "An inexpensive BRDF model for physically-based
    // rendering").
    bool mirror;
    // Light goes into it and leaves elsewhere, where ray tracing shows it. `fitted` is a matte
    // surface that is as bright in even light.
    bool translucent;
    float reflectance[3];       // F, of a mirror, or of a matte surface; in [0, 1]
    const relume_baked *baked;  // then it has nothing of the above but name, size and bytes; of
                                // all others NULL
    const struct relume_object_skin *skin;  // NULL: whole, and sends nothing
};

// Triangles of one mesh that show one material.
struct relume_object_part {
    const char *name;     // in its mesh
    int material;         // that it is shown in
    bool bilinear;        // between texels; else the nearest
    size_t first, count;  // triangles
    int object;           // of the description that it belongs to, from 0
};

// Everything belongs to the objects.
struct relume_objects_info {
    const struct relume_mesh_vertex *vertices;
    size_t vertex_count;
    // Linear, what the material's values are multiplied by: colours of vertices, where a mesh shows
    // its own look; 1 elsewhere. [vertex_count], or NULL: 1 everywhere.
    const float (*tint)[3];
    const uint32_t (*triangles)[3];  // counter-clockwise as seen from where the normals point
    size_t triangle_count;
    const struct relume_object_part *part;  // [parts]
    int parts;
    const struct relume_object_material *material;  // [materials]
    int materials;
    struct relume_vec3 min, max;  // of the vertices
    int objects;                  // of the description
    unsigned reflections_set;     // how often: another number, other edits
};
// It belongs to the objects.
RELUME_API const struct relume_objects_info *relume_objects_info(const relume_objects *objects);

// Reads the edits of a file (docs/reflections.md). They replace those of the objects that it names.
// Where reading fails, with an input status and a message, no edit is replaced.
RELUME_RESULT relume_status relume_objects_load_reflections(
    relume_objects *objects, const char *path, const struct relume_reflection_params *params);

// What a mirror of the objects shows of their reflections at a place that a ray from `eye` hits.
struct relume_object_reflection {
    struct relume_reflection_place place;  // vertices are those of relume_objects_info
    int object;                            // which one of the description, from 0
    int part;                              // ... and which of its parts
    struct relume_vec3 normal;             // unit, towards the eye
    struct relume_vec3 original, edited;   // unit
};
// False where the ray (of any length but 0) hits nothing; any part reflects here, also if it is no
// mirror.
RELUME_API bool relume_objects_reflect(struct relume_object_reflection *out,
                                       const relume_objects *objects, struct relume_vec3 eye,
                                       struct relume_vec3 direction);

// How objects are ray traced. Borrowed during the call; a renderer copies it
// (relume_renderer_set_objects) and goes on using `log`.
struct relume_render_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int samples;      // rays along each side of a pixel, [1, 16]; default 1, through its middle
    bool no_shadows;  // all light samples reach all points; no light goes between
    int threads;      // default: all cores
    // In a renderer's scene: how light goes between it and the objects. NULL or "none": not.
    const struct relume_transport *transport;
    int transport_samples;  // directions at each pixel, [1, 65536]; default: the way's own
    int bounces;  // of light off objects, at most 16; default 2; below 0: objects only hide light
    // Light is gathered at every so many pixels each way, [1, 16], and between them where what the
    // pixels around show is no one surface or differs; default: the way's own. Ways whose
    // directions are shared by neighbours gather at each.
    int transport_spacing;
    // Cameras that look at the objects from other sides than the frame's, at most 16, for ways that
    // go by what is on the screen; default: the way's own; below 0: none.
    int transport_cameras;
};
#define relume_render_params(...)                                                                  \
    (&(const struct relume_render_params){RELUME_SIZED(relume_render_params), __VA_ARGS__})

// The window through which `eye` sees all of the objects (`look_at`: all zero is their middle, +y
// up and the least square view that holds them). False where there is none.
RELUME_API bool relume_objects_window(struct relume_window *out, const relume_objects *objects,
                                      struct relume_vec3 eye, const struct relume_look_at *look_at,
                                      int width, int height);

// Ray trace the objects as seen through the window before black, linear: the reference of all other
// ways to draw them. `out` has three channels and the wanted size already. RELUME_EINVAL (lights,
// samples), RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_objects_render(struct relume_image *out,
                                                  const relume_objects *objects,
                                                  const struct relume_window *window,
                                                  const struct relume_light *lights, int n,
                                                  const struct relume_render_params *params);

// The objects that stand in a renderer's scene from now on, borrowed until others are set or the
// renderer is destroyed; NULL: none. relume_renderer_frame and _draw show them where they stand
// before what the file's depth says, under the renderer's lights, and with their shadows on the
// scene: each light sample is relit alone and reaches a point of the scene when no object lies
// between. Scenes throw no shadows on objects, unless light goes between them (`transport`). A pass
// shows the scene alone: leave it at colour. Rays, single pixels and places are those of the scene.
// `params` are copied. RELUME_ENOMEM, RELUME_EINVAL (of transport); then all is as before. Frames
// also fail with RELUME_EINVAL (samples) and RELUME_EUNFIT (a file without depth).
RELUME_RESULT relume_status relume_renderer_set_objects(relume_renderer *renderer,
                                                        const relume_objects *objects,
                                                        const struct relume_render_params *params);

#ifdef __cplusplus
}
#endif
#endif
