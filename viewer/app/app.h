// app.h - the state of the viewer begins, ends, and is asked what it comes to
#ifndef VIEWER_APP_H
#define VIEWER_APP_H

#include "app/aim.h"

// A file seen as `start` says; a DEFAULT framing becomes what suits the file: the eye in the middle
// of a slab, a look ahead in a panorama when `look_ahead`, else view 0. Without lights there is one
// from the front. The frame is as large as `camera` says, else as the file implies. RELUME_EINVAL
// when the camera does not fit the file, with a sentence in `log`; RELUME_ENOMEM. `start` is
// copied.
relume_status app_start(struct app *app, const struct app_file *file, const struct app_state *start,
                        bool look_ahead, const struct relume_log *log);

void app_release(struct app *app);
// The window's width: the frame and what is beside it.
int app_window_width(const struct app *app);
// Share the window between frame and panel; the frame keeps most of it, else the panel lies over
// it.
void app_arrange(struct app *app);
// As it was at the start.
void app_reset(struct app *app);

// Let no glide go on.
void app_stand_still(struct app *app);

// Under the hand, or gliding on: pictures that take long may be rougher.
bool app_moves(const struct app *app);

// How many passes there are to choose from; the first is the colour.
int app_passes(const struct app *app);

// The exposure to draw with, EV.
double app_exposure_ev(const struct app *app);
// The frame drawn with that exposure would be as relume_tone_meter_for has it with `ev` more. The
// first frame of a file is followed at once, later ones as time passes.
void app_meter(struct app *app, double ev);

// The eye's distance from the st plane (several slabs: from the middle) times `factor`, within
// limits.
void app_dolly(struct app *app, double factor);
#endif
