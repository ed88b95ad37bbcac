// view_geometry.h - where what the file shows lies in the frame
#ifndef VIEWER_VIEW_GEOMETRY_H
#define VIEWER_VIEW_GEOMETRY_H

#include "app/state.h"

bool app_is_panorama(const struct app_file *file);

// The rectangle of the frame that shows the whole picture: left, top, right, bottom in pixels.
// A perspective look fills the frame.
struct app_rectangle {
    double left, top, right, bottom;
};
struct app_rectangle app_picture(const struct app *app);

// What app_picture shows of several slabs; false where the eye sees nothing.
bool app_window(const struct app *app, struct relume_window *window);

// The middle of what the file shows; of a panorama its eye.
struct relume_vec3 app_middle(const struct app *app);
// Half the extent of what the file shows; of a panorama 1.
double app_reach(const struct app *app);
// Whether elevations are measured from +y, as in panoramas, not +z.
bool app_pole_y(const struct app *app);

// Directions of the frame in the world: right, up, and towards the viewer.
struct app_axes {
    struct relume_vec3 right, up, back;
};

#endif
