// handles.h - reflections of mirrors edited by hand (relume/world/reflection.h): constraints and
// regions of all objects, what is chosen of them, and the way back and forth
#ifndef VIEWER_HANDLES_H
#define VIEWER_HANDLES_H

#include "world/reflect/reflection.h"

#include <relume/world/object.h>

// What a press on a mirror begins.
enum handles_tool {
    HANDLES_MOVE = 0,  // a constraint: what is seen there follows the pointer
    HANDLES_BALL,      // a region
    HANDLES_ALONG,     // a region along the surface
    HANDLES_BRUSH,     // a region painted on the surface
    HANDLES_TOOLS
};
extern const char *const handles_tool_names[HANDLES_TOOLS + 1];  // "move", ..., NULL

enum handles_kind { HANDLES_NOTHING = 0, HANDLES_CONSTRAINT, HANDLES_REGION };
struct handles_choice {
    enum handles_kind kind;
    int object, number;
};

// Of a constraint, beside what the library knows.
struct handles_mark {
    struct relume_vec3 red;     // the place where what it shows is seen unedited, ...
    bool has_red;               // ... if any is known
    struct relume_vec3 target;  // the place that it shows, ...
    bool has_target;            // ... else it is far
};

// Handles of one object; lists can hold one more after handles_begin.
struct handles_edit {
    bool edited;  // false: reflections are as they are
    struct relume_reflection_edit edit;
    struct relume_reflection_constraint *constraint;  // [edit.constraints], as edit.constraint
    struct handles_mark *mark;                        // [edit.constraints]
    struct relume_reflection_region *region;          // [edit.regions], as edit.region; own strokes
};

struct handles_step {
    int object;
    struct handles_edit before, after;
    const char *merges;  // the kind of change, constant, that the next one of this kind joins; NULL
};

// What the mouse holds.
enum handles_grip {
    HANDLES_RED,     // another thing is shown by a constraint
    HANDLES_GREEN,   // its place moves
    HANDLES_CENTRE,  // of a region
    HANDLES_RIM,     // its radius
    HANDLES_PAINT,   // its stroke
};

// Fields are read by whoever shows them. Thread-safety: main thread only.
struct handles {
    relume_objects *objects;   // borrowed
    int count;                 // of them
    double size;               // of all
    struct handles_edit *now;  // [count]
    struct handles_step *step;
    int steps, undone;
    struct handles_choice chosen;
    enum handles_grip grip;  // on what is chosen
    enum handles_tool tool;
    double radius, border;       // of the next region: world units; a part of the radius
    bool changes;                // between handles_begin and handles_end
    bool shown;                  // since then
    struct handles_edit before;  // it
    bool unsaved;
    char said[256];  // what went wrong or has no effect, for whoever shows it; "": nothing
};

// Whether one of their materials is a mirror.
bool handles_mirror(const relume_objects *objects);

// Begins with the edits that the objects have. RELUME_EUNFIT when none of them is a mirror,
// RELUME_ENOMEM.
relume_status handles_create(struct handles **out, relume_objects *objects);
void handles_destroy(struct handles **handles);

// Before `object` is changed: its edit, to be changed by the functions below or in place; the same
// as long as the change has not ended. NULL when memory is short, which is said.
struct handles_edit *handles_begin(struct handles *h, int object);
// Show it as it is now. False when the library does not take it, which is said; then the change is
// over, and all is as before.
bool handles_show(struct handles *h);
// What there was to be said is said, and the change can be undone; `merges` as handles_step. False
// when the library does not take it: all is as before.
bool handles_end(struct handles *h, const char *merges);

// The change is over, and all is as before it.
void handles_drop(struct handles *h);

// Append and choose; false when there is no room for more, which is said. A stroke begins with one
// point.
bool handles_add_constraint(struct handles *h, struct handles_edit *e,
                            const struct relume_reflection_constraint *constraint);
bool handles_add_region(struct handles *h, struct handles_edit *e,
                        const struct relume_reflection_region *region);
bool handles_add_point(struct handles *h, struct relume_reflection_region *region,
                       struct relume_vec3 point);
// Remove what is chosen, as a change of its own. False when there is nothing.
bool handles_remove(struct handles *h);

// False when there is nothing left to undo, or redo.
bool handles_undo(struct handles *h);
bool handles_redo(struct handles *h);

// The chosen constraint or region, else NULL.
const struct relume_reflection_constraint *handles_constraint(const struct handles *h);
const struct relume_reflection_region *handles_region(const struct handles *h);

void handles_tell(struct handles *h, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
