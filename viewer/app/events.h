// events.h - events and time go in, the state changes
#ifndef VIEWER_EVENTS_H
#define VIEWER_EVENTS_H

#include "app/state.h"

// Returns whether the picture changed. Places of events are in pixels of the window.
bool app_handle(struct app *app, const struct app_event *event);

// Let time pass: a panorama let go of in motion glides to a stop, automatic exposure adapts.
// Returns whether the picture changed; false for good once all is at rest. What a span does, any
// way to split it does.
bool app_advance(struct app *app, double seconds);

// What is said over the picture fades; returns whether it looks different.
bool app_fade(struct app *app, double seconds);
// Seconds for which it will look the same; INFINITY when nothing is said.
double app_steady_s(const struct app *app);
// How much of a note with `left` seconds to go is still to be seen, 0 to 1.
double app_note_alpha(double left_s);

// The same for the living eye alone (struct observer), which never rests.
void app_live(struct app *app, double seconds);

#endif
