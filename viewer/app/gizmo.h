// gizmo.h - handles of the lights in the picture: where they are, and what dragging them does
#ifndef VIEWER_GIZMO_H
#define VIEWER_GIZMO_H

#include "app/state.h"

struct gizmo {
    double x, y;  // pixels of the frame
    bool behind;  // a direction from behind the picture
    bool near;    // stands where the light is; else on the disc of directions
};

// The disc of directions: its middle is light from the viewer, its rim light from the side.
struct gizmo_circle {
    double x, y, radius;
};
struct gizmo_circle gizmo_disc(const struct app *app);

// Step 0 to RELUME_CAPTURED_REGION_STEPS of the border of the captured light directions, on the
// disc; false where there is none.
bool gizmo_border(struct gizmo *out, const struct app *app, int step);

// The ball in the lower right corner that shows the light, while app.now.ball. A place on it is
// where the selected light shall come from.
struct gizmo_circle gizmo_ball(const struct app *app);
bool gizmo_on_ball(const struct app *app, double x, double y);
void gizmo_drag_ball(struct app *app, double x, double y);

// False when the light has no place in the frame.
bool gizmo_of(struct gizmo *out, const struct app *app, int light);

// Where a point of the scene lies in the frame, pixels; a look is taken as perspective.
bool gizmo_place(double xy[2], const struct app *app, struct relume_vec3 point);

// Of a long list the lights about the selected one have handles, GIZMOS from this one on.
enum { GIZMOS = 256 };
int gizmo_first(const struct app *app);

// The light whose handle is at (x, y), the nearest; -1 when there is none.
int gizmo_hit(const struct app *app, double x, double y);

// Move the handle of `light` to (x, y): a direction keeps its side, a near light its distance from
// the viewer.
void gizmo_drag(struct app *app, int light, double x, double y);

#endif
