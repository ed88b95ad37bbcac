// state.h - the state of the viewer: file, camera, lights, drags
//
// Nothing in this room knows OpenGL or windows, so that all interaction can be tested alone.
// Positions are in pixels of the frame, y down.
#ifndef VIEWER_STATE_H
#define VIEWER_STATE_H

#include "app/observer.h"
#include "format/coder/coding.h"

#include <relume/frame.h>
#include <relume/relight/enhance.h>
#include <relume/relight/relight.h>
#include <relume/relight/relief.h>
#include <relume/relight/slab_set.h>
#include <relume/world/object.h>

enum { APP_LIGHTS = 65536 };  // lights at once, as RELUME_RIG_MOST

enum app_event_kind {
    APP_PRESS,
    APP_RELEASE,
    APP_MOVE,
    APP_WHEEL,
    APP_KEY_DOWN,
    APP_KEY_UP,
    APP_TEXT,  // a character that was typed, after its key
    APP_SIZE
};
enum app_button { APP_LEFT, APP_RIGHT };
// Keys that print nothing; all others are what is printed on them.
enum {
    APP_KEY_BACKSPACE = 8,
    APP_KEY_TAB = 9,
    APP_KEY_ENTER = 13,
    APP_KEY_ESCAPE = 27,
    APP_KEY_DELETE = 127,
    APP_KEY_LEFT = 256,
    APP_KEY_RIGHT,
    APP_KEY_UP_ARROW,
    APP_KEY_DOWN_ARROW,
    APP_KEY_PAGE_UP,
    APP_KEY_PAGE_DOWN,
    APP_KEY_HOME,
    APP_KEY_END,
    APP_KEY_F11,
    APP_KEYS  // all are below
};
enum { APP_CONTROL = 1 << 10 };  // added to a letter or an arrow: Ctrl is held

enum { APP_HINT_S = 8, APP_TOAST_S = 4 };  // seconds that a note is shown

struct app_event {
    enum app_event_kind kind;
    enum app_button button;  // PRESS, RELEASE
    double x, y;             // PRESS, RELEASE, MOVE, WHEEL
    double wheel;            // WHEEL: steps, > 0 away from the user
    bool repeat;             // KEY_DOWN: the key was down already
    bool unasked;            // KEY_DOWN: of a script, which nobody can ask whether it means it
    int key;  // KEY_*: a lower-case letter, a sign, or APP_KEY_*, with APP_CONTROL; TEXT: Unicode
    int width, height;  // SIZE
};

// What the app must know of the file it shows.
struct app_file {
    struct relume_geometry geometry;
    int width, height;  // of a view
    int views;
    double uv_min[2], uv_max[2];    // slab: where cameras stand
    const relume_slab_set *around;  // several slabs, about whose middle the eye goes; NULL: none
    relume_objects *objects;        // in the scene, or all that there is; NULL: none
    const struct relume_captured_region *zone;  // where its light was captured; NULL: not known
    const struct relume_relief *relief;         // captured lights that show relief; NULL: not known
    bool between;                               // light may go between objects and a scene
    bool scene;                                 // a scene file: the library draws it
    bool empty;                                 // no file is open yet
    bool only_colour;                           // nothing else can be shown of it
};

// What the viewer adds to a light. All zero is a light that shines as it says.
struct app_light_state {
    bool off, solo;
    double stops;  // its value is multiplied by 2^stops
    int entry;     // of the rig that it came from; -1: none
};

// Where the panel is: over the picture, or beside it.
enum app_dock { APP_DOCK_OVER = 0, APP_DOCK_LEFT, APP_DOCK_RIGHT, APP_DOCKS };

extern const char *const app_dock_names[APP_DOCKS + 1];  // "over", "left", "right", NULL

// How two are shown at once: materials of objects, or ways of light between them and the scene.
enum app_split {
    APP_SPLIT_NONE = 0,
    APP_SPLIT_SIDES,       // the other one in the right half
    APP_SPLIT_DIFFERENCE,  // absolute
    APP_SPLITS
};

// What can be reset. A copy by value shares its lights: see light_list_copy.
struct app_state {
    struct relume_camera camera;              // framing is never DEFAULT
    double zoom;                              // of the picture; 1 fits the frame
    double shift[2];                          // of the picture's middle from the frame's, pixels
    enum relume_interpolation interpolation;  // slab
    double aperture;                          // slab: diameter, world units
    double focus_z;  // slab: the plane in focus; of a free eye how far before what it looks at ...
    bool focused;    // ... at the start; else the st plane
    double exposure_ev;
    bool auto_exposure;                   // on top of exposure_ev
    int tone;                             // place in relume_tones
    double white;                         // as relume_tone_params
    struct relume_light *light;           // [lights] of [capacity]
    struct app_light_state *light_state;  // by light
    int lights, capacity;
    struct relume_vec3 raked_from, raked_to;  // side of the last raking light, and what it became
    int selected;                             // light that drags and keys change
    bool ball;                                // show the light's direction on a ball in the corner
    enum relume_pass pass;
    struct relume_pass_params
        enhance;               // of it: gain, specular, exponent, radius, low, top; 0: usual
    enum app_split split;      // objects ...
    int other;                 // ... in this of their materials as well
    int way;                   // of light between objects and scene: place in relume_transports ...
    enum app_split ways;       // ... shown ...
    int other_way;             // ... with this one as well
    int way_samples, bounces;  // of them, as relume_render_params
    struct observer observer;  // how an eye sees the frame
};

enum app_drag {
    APP_DRAG_NONE,
    APP_DRAG_CAMERA,
    APP_DRAG_LIGHT,
    APP_DRAG_GIZMO,
    APP_DRAG_BALL,
    APP_DRAG_HANDLE
};

// What the app cannot do itself; whoever runs it does, and sets this back to NONE.
enum app_action {
    APP_ACTION_NONE = 0,
    APP_ACTION_PNG,  // a picture of the frame
    APP_ACTION_EXR,
    APP_ACTION_SAVE_RIG,
    APP_ACTION_SWEEP,        // a recording
    APP_ACTION_TURNTABLE,    // a recording
    APP_ACTION_COPY,         // how the file is seen, as a line
    APP_ACTION_NOTES,        // on the picture: show them, or no longer
    APP_ACTION_NOTE,         // what is drawn becomes one, or this view
    APP_ACTION_NOTE_SAVE,    // they were changed
    APP_ACTION_NOTE_BACK,    // to the light of the chosen one
    APP_ACTION_ADD_LIGHT,    // of the SPEC app.spec
    APP_ACTION_MAP,          // the environment map of the file app.spec
    APP_ACTION_FULL_SCREEN,  // or back from it
    APP_ACTION_FOLDER,       // a list of the folder app.spec; "": of the one that was listed last
    APP_ACTION_FOCUS,        // on what the frame shows at app.cursor
    APP_ACTION_EDIT,         // of the g-BRDF that is shown, in the words app.spec
    APP_ACTION_REFLECTION,   // an edit of what mirrors reflect, in the words app.spec
    APP_ACTION_OPEN          // the file app.spec in place of this one
};
enum { APP_SPEC = 4096 };

// What only drawing knows of the scene around objects. NULL: nothing.
struct app_scene {
    void *user;
    // The place of the scene that the frame shows at (x, y); false where none is known.
    bool (*surface)(void *user, struct relume_vec3 *out, double x, double y);
    // Where a ray from a mirror ends in it (relume_objects_reflected_place); false: far away.
    bool (*reflected)(void *user, struct relume_vec3 *out, struct relume_vec3 from,
                      struct relume_vec3 direction);
};
struct handles;
struct notes;

// Who looks at the objects from other threads lets go of them before they change. NULL: nobody.
struct app_lookers {
    void *user;
    void (*let_go)(void *user);
};

// Owns its lists of lights, handles and notes. Thread-safety: plain data.
struct app {
    struct app_file file;
    struct app_state start, now;
    int width, height;  // of the frame
    int beside[2];      // pixels of the window to the left and right of the frame, for the panel
    enum app_dock dock;
    int dock_width;  // pixels that a panel beside the frame takes; 0: there is none
    enum app_drag drag;
    double cursor[2];
    bool light_key;                     // L is held
    bool panel, help, inspect, gizmos;  // shown
    bool asks;                          // whether to quit
    bool browse;                        // for a file to open
    bool keep_lights;                   // for the next file
    bool picks_focus;                   // the next press does
    bool reflects;                      // handles of edited reflections are shown ...
    struct handles *handles;            // ... and kept; NULL: not asked for yet
    bool noting;                        // notes are shown ...
    struct notes *notes;                // ... and kept; NULL: not asked for yet
    struct app_scene scene;
    struct app_lookers lookers;
    bool recording;  // every frame becomes a picture
    double toast_s,
        hint_s;           // how long what was last said, and what the mouse does, stay to be seen
    double inspect_zoom;  // of the inspector's disc; 0 and 1: all of it
    bool compared;        // there is a capture to compare with
    bool near_lights;     // it is known where the surface is, so that near lights can shine on it
    enum app_action action;
    char spec[APP_SPEC];
    bool quit;
    double turned_deg[2];   // by the mouse since time last passed: pan and tilt, or the eye's way
                            // around the object, to the right and up
    double speed_deg_s[2];  // of these: of the hand, then of what it let go
    double adapted_ev, metered_ev;  // automatic exposure: in force, and aimed at
    bool metered;
    double eye_s;  // that the eye has lived: only while it looks, and not while it is paused
    struct relume_pan_tilt before_planet;
};

#endif
