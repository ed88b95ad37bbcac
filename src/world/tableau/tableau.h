// tableau.h - the inside of relume_tableau
#ifndef TABLEAU_TABLEAU_H
#define TABLEAU_TABLEAU_H

#include "core/base/json.h"
#include "world/object/object.h"
#include "world/tableau/exhibit.h"

// A mesh as the choice between it and a capture goes by it.
struct extent {
    vec3 middle;
    double radius;
    double triangle;  // mean area
};

struct relume_tableau {
    struct relume_tableau_info info;       // points to what is below
    struct relume_tableau_entity *entity;  // [entities]: captures, then objects
    struct exhibit *capture;               // [captures]
    struct extent *extent;                 // [objects]
    bool *left_out;                        // [objects]: of `objects`
    relume_objects *objects;               // never NULL
    relume_objects *shown;                 // as the eye of the last frame saw them; NULL: in full
    struct bodies *bodies;                 // of them; NULL: not needed yet
    relume_rig *rig;
    jvalue *root;
    char *path;
    struct relume_tableau_params params;
    bool said_black;   // that mirrors are black
    bool said_within;  // that the eye is in an object
};

static inline int tableau_objects(const relume_tableau *t)
{
    return t->info.entities - t->info.captures;
}

// Show captures in place of the objects that are too small in a frame, and those alone that are
// shown (`shown`: [captures]). Errors of relume_objects_open.
relume_status tableau_choose(bool *shown, relume_tableau *t, const struct relume_window *window,
                             int width, int height);

#endif
