// manifest.h - reading what describes a capture into one form; images are not touched here
#ifndef CAPTURE_MANIFEST_H
#define CAPTURE_MANIFEST_H

#include "core/base/arena.h"
#include "core/base/json.h"

#include <relume/capture.h>
#include <relume/image/directions.h>

enum { MANIFEST_VERSION = 1 };

// A manifest whose arrays live in `arena` and may still be changed.
struct draft {
    struct arena arena;
    struct relume_manifest m;
    struct relume_vec3 *directions, *positions;
    float (*intensities)[3];
    struct relume_manifest_view *view;
    struct relume_geometry *slab;
    bool has_window;  // the manifest states it, else it follows from the image size
    bool listed;      // by a list of lights beside photographs, which nothing has looked at
    bool turns;       // such a list's lights belong to the pictures as they lie in their files
};
void draft_free(struct draft *draft);

// A list of lights as a capture of the photographs that it names, or, where it has no names, of
// those in its folder in the order of theirs. Names decide (docs/capture.md, "Lists of lights");
// missing files stay as they are with `skip_missing`. Names that leave the folder mean their base
// name in it, unless `allow_outside`; in a `project`, also a file of a folder beside it.
relume_status lp_open(struct draft *out, const char *path, bool project,
                      const struct relume_capture_params *params);

// A capture.json; paths are made relative to the working folder.
relume_status manifest_read(struct draft *out, const char *path,
                            const struct relume_capture_params *params);

// Returns the text of a capture.json, to be freed with mem_free(), or NULL without memory.
char *manifest_text(const struct relume_manifest *manifest);
// Reads such a text, whose images lie in `folder`; sentences name `path`. An input status,
// RELUME_ENOMEM.
relume_status manifest_parse(struct draft *out, const char *text, const char *path,
                             const char *folder, const struct relume_capture_params *params);

// What a draft says, whoever wrote it, is in range; vectors become what the manifest promises, and
// directions follow from positions where there are none. An input status with a sentence,
// RELUME_ENOMEM (manifest_check.c).
relume_status draft_check_lights(struct draft *d, const char *path, const struct relume_log *log);
relume_status draft_check_geometry(struct draft *d, const char *path, const struct relume_log *log);
relume_status draft_check_views(const struct draft *d, const char *path,
                                const struct relume_log *log);
// Restates the intensities of near lights, which may be their power or what they show at 0, 0, 0
// (relume_manifest.intensities_at_origin). RELUME_ENOMEM.
relume_status draft_state_power(struct draft *d);
relume_status draft_state_at_origin(struct draft *d);
// The draft's arrays are those of its manifest from now on.
void draft_publish(struct draft *d);

#define MANIFEST_INTENSITIES "three numbers from 1e-30 to 1e30 for every light"

// Whether a name is absolute, here or on Windows, or climbs out of the folder that it begins in.
bool leaves_folder(const char *name);

// Only the lights of the tree of a capture.json or of `relume lights --json`.
relume_status manifest_lights(struct relume_captured_lights *out, const jvalue *root,
                              const char *path, const struct relume_log *log);
// Those of a .dome file; the vectors that it says are in use.
bool is_dome(const jvalue *root);
relume_status dome_lights(struct relume_captured_lights *out, const jvalue *root, const char *path,
                          const struct relume_log *log);

// Normalise; false for a vector that is zero, infinite or NaN.
bool direction_normalise(struct relume_vec3 *v);

#endif
