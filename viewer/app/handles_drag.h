// handles_drag.h - handles of edited reflections in the picture: where they are, and what the mouse
// does with them
//
// A constraint has a red handle where what it shows is seen unedited, and a green one where it is
// seen now. A press on a mirror makes both there, and the green one follows the pointer. A region
// has a blue handle in its middle (a stroke has none) and one on its rim.
#ifndef VIEWER_HANDLES_DRAG_H
#define VIEWER_HANDLES_DRAG_H

#include "app/handles.h"
#include "app/state.h"

struct handle {
    enum handles_grip grip;
    struct handles_choice of;
    double x, y;  // pixels of the frame
    bool hidden;  // by the objects
};
// The handles of the frame, at most HANDLES_MOST; returns how many. None while the frame shows no
// objects.
enum { HANDLES_MOST = 1024 };
int handles_of(struct handle out[HANDLES_MOST], const struct app *app);
// Step `step` of the outline of a region, or of its stroke; false behind the last step, and where
// nothing is to be drawn.
bool handles_outline(double xy[2], const struct app *app, int object, int region, int step);

// The mouse, at a place of the frame. Whether the handles take the press; else whether the picture
// changed.
bool handles_press(struct app *app, double x, double y);
bool handles_move(struct app *app, double x, double y);
// Also of whoever takes a handle from the mouse; false when it holds none.
bool handles_release(struct app *app);

#endif
