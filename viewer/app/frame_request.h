// frame_request.h - what a frame shall show: all that drawing needs to know of the app's state
#ifndef VIEWER_FRAME_REQUEST_H
#define VIEWER_FRAME_REQUEST_H

#include "app/gizmo.h"
#include "app/view_geometry.h"

#include <relume/relight/view.h>

struct frame_request {
    const struct app_file *file;  // borrowed from the app
    int width, height;            // of the frame
    struct app_rectangle picture;
    float exposure;  // factor
    struct relume_camera camera;
    bool has_window;                 // an eye on several slabs, whose picture ...
    struct relume_window window;     // ... shows this
    struct relume_vec3 middle;       // of what the file shows
    struct relume_view_params view;  // interpolation, aperture, focus as the library takes it
    bool moves;                      // under the hand: may be rougher
    enum relume_pass pass;
    struct relume_pass_params enhance;  // of it
    struct relume_light *light;         // [lights]: those that shine
    int lights, capacity;
    struct observer observer;
    double eye_s;    // that the eye has lived
    double fov_deg;  // of the frame, as app_fov_deg
    enum app_split split;
    int other;  // material, of a split
    int way;    // of light between objects and scene, as app_state ...
    enum app_split ways;
    int other_way, way_samples, bounces;
    bool timed;  // somebody looks at how long objects take
    // the ball that shows where the selected light comes from
    bool ball;
    struct gizmo_circle ball_place;
    struct relume_vec3 ball_light;  // as the viewer sees it
    float ball_rgb[3];
};

// All of the frame that `app` describes now but its lights.
void frame_request_look(struct frame_request *request, const struct app *app);
// The frame that `app` describes now; `request` is empty or was made before, and keeps its memory.
// It holds until the app changes. RELUME_ENOMEM.
relume_status frame_request_make(struct frame_request *request, const struct app *app);
void frame_request_free(struct frame_request *request);

#endif
