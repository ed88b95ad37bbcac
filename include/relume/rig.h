// rig.h - a named set of lights with what they need (pictures, maps, distributions), from and to
// words (SPEC) and JSON
//
// SPEC, words and numbers:
//     dir x y z                                        towards the light
//     point px py pz
//     spot px py pz dx dy dz half_angle_deg
//     slide px py pz dx dy dz half_angle_deg picture
//     area px py pz ux uy uz vx vy vz [disc]           centre and half edges, emits towards u x v
//     env map [rotate_deg]
//     ies px py pz dx dy dz file
//     gonio px py pz dx dy dz map                      intensity over direction, a picture
// each followed, in any order, by: rgb r g b (default 1 1 1); nofall (all near ones but area).
// File names with blanks stand in ' ' or " ".
#ifndef RELUME_RIG_H
#define RELUME_RIG_H

#include <relume/base.h>
#include <relume/light.h>

#ifdef __cplusplus
extern "C" {
#endif

// Owns what its lights point at, for as long as it lives, also after an entry was removed.
// Thread-safety: one thread at a time.
typedef struct relume_rig relume_rig;

// One light; pointers belong to the rig and hold until it changes.
struct relume_rig_entry {
    const char *name;           // for people; never NULL
    const char *spec;           // as relume_rig_add understands it, without rgb
    const char *file;           // of slide, env, ies, gonio, as it was opened; else NULL
    bool on, solo;              // whether it is lit; when one is solo, only those are lit
    double intensity;           // factor of rgb, >= 0
    struct relume_light light;  // rgb as written, without intensity
};

enum { RELUME_RIG_MOST = 65536 };  // lights

// An empty rig, which the caller destroys. RELUME_ENOMEM.
RELUME_RESULT relume_status relume_rig_create(relume_rig **out);
RELUME_API void relume_rig_destroy(relume_rig **rig);

// Append a light. File names are relative to `folder` (NULL: the working folder). RELUME_EINVAL for
// words that are no SPEC, an input status for its file, each with a sentence; RELUME_ENOMEM. The
// rig is unchanged on failure.
RELUME_RESULT relume_status relume_rig_add(relume_rig *rig, const char *spec, const char *folder,
                                           const struct relume_log *log);
// RELUME_EINVAL when there is no such entry.
RELUME_RESULT relume_status relume_rig_remove(relume_rig *rig, int index);
// How many lights it has.
RELUME_API int relume_rig_count(const relume_rig *rig);
// NULL when there is no such entry.
RELUME_API const struct relume_rig_entry *relume_rig_entry(const relume_rig *rig, int index);

// Replace name, switches, intensity, value and geometry of an entry; its kind and file stay (spec
// and file of `entry` are not read). RELUME_EINVAL with a sentence when a number is not allowed,
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_rig_set(relume_rig *rig, int index,
                                           const struct relume_rig_entry *entry,
                                           const struct relume_log *log);

// The lights that shine: those that are on (the solo ones alone when one is), times
// intensity. `*out` belongs to the rig and holds until it changes. RELUME_ENOMEM.
RELUME_RESULT relume_status relume_rig_lights(const struct relume_light **out, int *n,
                                              relume_rig *rig);

// JSON (docs/lights.md). Every field is checked; sentences name the line or the entry. Files inside
// are relative to the rig's own folder. An input status, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_rig_load(relume_rig **out, const char *path,
                                            const struct relume_log *log);
// The file appears whole or not at all. RELUME_EIO, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_rig_save(const relume_rig *rig, const char *path,
                                            const struct relume_log *log);

#ifdef __cplusplus
}
#endif
#endif
