// notes.h - notes on the picture (relume/exchange/notes.h): the list, what is chosen of it, and
// what the mouse is drawing
//
// A press begins or goes on with a note of the tool's kind. A point is done at once; a line or a
// polygon by Enter, or by a press on its last place, of a polygon also on its first one. Backspace
// takes the last place away. What is drawn becomes a note by the session, which knows the lights.
#ifndef VIEWER_NOTES_H
#define VIEWER_NOTES_H

#include "app/state.h"

#include <relume/exchange/notes.h>

// Fields are read by whoever shows them. Thread-safety: main thread only.
struct notes {
    relume_notes *list;          // its own
    int chosen;                  // -1: none
    enum relume_note_kind tool;  // VIEW: presses do not draw
    int places;
    double (
        *place)[2];  // [places]: of what is being drawn, pixels of the picture; of an object x, y
    double *z;       // [places]: of an object
};

// Takes the list over, also on failure. RELUME_ENOMEM.
relume_status notes_create(struct notes **out, relume_notes *list);
void notes_destroy(struct notes **notes);

// Whether the frame shows the picture that notes have places on, or the object amid several slabs.
bool notes_have_places(const struct app *app);
// Between the frame and the picture, pixels of both, in a look into a panorama too; of an object in
// the world, `z` with it. False for what there is not there, and for a place behind the eye.
bool notes_to_picture(double place[2], double *z, const struct app *app, double x, double y);
bool notes_to_frame(double xy[2], const struct app *app, const double place[2], double z);

// A press at a place of the frame; whether notes take it.
bool notes_press(struct app *app, double x, double y);
// What is drawn is done; false when it cannot be yet.
bool notes_finish(struct app *app);
// False when nothing is being drawn.
bool notes_take_back(struct app *app);

// The note as it is being drawn; it has at least one place.
struct relume_note notes_drawn(const struct app *app);

// The length of a scale bar for a picture whose pixels are `pixels` wide on the screen: 1, 2 or 5
// times a power of ten, in millimetres, at most `most` pixels of the screen; 0: the scale is not
// known.
double notes_scale_bar(const struct notes *notes, double pixels, double most);

#endif
