// tableau.h - several captured files and objects in one view, under one rig of lights: scene files
//
// A scene file (docs/scenes.md) names captures (what relume_open opens: slabs, panoramas, planar
// files) and objects (object.h), each where it stands in one world. Slabs are seen by their own
// cameras; panoramas and planar files, from wherever the eye is, as a mesh through the places that
// their pixels show. In a pixel the nearest is seen. Each light falls on all of them: of two
// captures, or a capture and an object, each throws its shadow on the other; shadows within a
// capture are those that were captured.
//
// A mesh that is so far away that its triangles are less than a pixel gives way to a capture that
// the file names instead of it (Wong 1998, chapter 10: images where geometry is too fine).
#ifndef RELUME_TABLEAU_H
#define RELUME_TABLEAU_H

#include <relume/base.h>
#include <relume/frame.h>
#include <relume/image.h>
#include <relume/light.h>
#include <relume/pack.h>
#include <relume/rig.h>
#include <relume/world/object.h>

#ifdef __cplusplus
extern "C" {
#endif

// Thread-safety: one thread at a time.
typedef struct relume_tableau relume_tableau;

struct relume_tableau_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_limits *limits;
    const char *scratch;  // as relume_btf_params
    int threads;          // default: all cores
    uint64_t memory;      // of what all captures keep, as relume_frame_params
    bool allow_outside;   // as relume_open_params
    bool keep_going;      // as relume_open_params
};
#define relume_tableau_params(...)                                                                 \
    (&(const struct relume_tableau_params){RELUME_SIZED(relume_tableau_params), __VA_ARGS__})

// Open a scene file and all that it names. An input status with a sentence, also for a scene within
// a scene; errors of relume_open and relume_objects_open.
RELUME_RESULT relume_status relume_tableau_open(relume_tableau **out, const char *path,
                                                const struct relume_tableau_params *params);
RELUME_API void relume_tableau_destroy(relume_tableau **tableau);

// One thing of the scene; pointers belong to it.
struct relume_tableau_entity {
    const char *name;         // of the scene file, else of its file
    const relume_pack *pack;  // of a capture; NULL: it is an object
    size_t triangles;         // of an object
    int instead_of;  // capture: the entity in whose place it is seen from afar; -1: of none
};

// Everything belongs to the tableau.
struct relume_tableau_info {
    const struct relume_tableau_entity *entity;  // captures first, in the order of the file
    int entities, captures;
    struct relume_camera camera;  // as the file says, else as its first entity is looked at
};
RELUME_API const struct relume_tableau_info *relume_tableau_info(const relume_tableau *tableau);
// The lights of the file, of an empty list none; of a file without that, "dir 0 0 1". The rig
// belongs to the tableau.
RELUME_API relume_rig *relume_tableau_rig(relume_tableau *tableau);

// What an eye sees: of the camera only `eye`, `look_at` and the size count, all zero being those of
// relume_tableau_info; of the default framing not `eye`, which is that one, too. `*out` is created.
// `params` as relume_renderer_set_objects; with a way of transport the first capture is what light
// goes between, and objects. RELUME_EINVAL (an eye that looks nowhere, lights, samples),
// RELUME_EUNFIT with a sentence (light that a turned capture cannot take; transport without a
// capture), errors of relume_frame.
RELUME_RESULT relume_status relume_tableau_frame(struct relume_image *out, relume_tableau *tableau,
                                                 const struct relume_camera *camera,
                                                 const struct relume_light *lights, int n,
                                                 const struct relume_render_params *params);

#ifdef __cplusplus
}
#endif
#endif
