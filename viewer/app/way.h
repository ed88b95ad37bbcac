// way.h - ways of light between objects and scene, as people choose them
#ifndef VIEWER_WAY_H
#define VIEWER_WAY_H

#include "app/state.h"

// Of relume_transports.
int way_count(void);
const char *way_name(int way);
// Whether light goes between at all.
bool way_gathers(int way);
// Whether there is a scene with objects in it, so that there is something to choose.
bool way_matters(const struct app *app);
// Whether frames are rough while something moves.
bool way_is_slow(const struct app *app);

// Show that many ways; the second is not the first when it begins. Materials are then shown alone.
void way_compare(struct app *app, enum app_split ways);
// Before a material is chosen.
void way_let_go(struct app *app);

// What a script says: "NAME", "beside NAME", "difference NAME", "alone". False: `expected` says
// what it should have been.
enum { WAY_WORDS = 256 };
bool way_say(struct app *app, const char *words, char expected[WAY_WORDS]);

#endif
