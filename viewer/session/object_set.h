// object_set.h - objects that a session shows: in the scene of a file, or alone on a stage
#ifndef VIEWER_OBJECT_SET_H
#define VIEWER_OBJECT_SET_H

#include "app/state.h"

#include <relume/world/object.h>

// Objects of the command line: a description, or materials on a mesh (NULL: on a cushion).
enum { OBJECT_MATERIALS = 32 };
struct object_options {
    const char *description, *mesh, *reflections;  // NULL: none
    const char *material[OBJECT_MATERIALS];
    int materials;
    double repeat;  // 0: 1
};

// Zeroed it holds no objects.
struct object_set {
    relume_objects *objects;       // or NULL
    struct object_options wanted;  // of the command line; other materials are shown on its mesh
    char material[APP_SPEC];       // file of the only material; "": a description, or several
    char described[APP_SPEC];      // file that describes the objects; "": none
    char reflections[APP_SPEC];    // file of their edited reflections; "": none yet
};

// Opens the objects of a command line; none where it asks for none. Errors of relume_objects_open
// and relume_objects_load_reflections.
relume_status object_set_open(struct object_set *set, const struct object_options *wanted,
                              int threads, const struct relume_log *log);
// Whether a file is a material (relume_kind_of), and whether it describes objects: a model, or by
// its name a .json that is nothing else.
bool object_file_is_material(const char *path);
bool object_file_is_description(const char *path);
// Opens the objects of a file instead of those of the set, which the caller destroys. Errors of
// relume_objects_open, which leave the set unchanged.
relume_status object_set_replace(struct object_set *set, const char *path, int threads,
                                 const struct relume_log *log);

#endif
