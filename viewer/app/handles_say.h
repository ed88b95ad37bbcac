// handles_say.h - edited reflections in words: of scripts, and of the panel's buttons
#ifndef VIEWER_HANDLES_SAY_H
#define VIEWER_HANDLES_SAY_H

#include "app/state.h"

// Show the handles or not, making what holds them when it is first asked for. False where no object
// is a mirror, or memory is short.
bool handles_turn_on(struct app *app, bool on);

// "on", "off", "tool move|ball|along|brush", "choose constraint|region NUMBER [OBJECT]", "delete",
// "undo", "redo", "freeze", "unfreeze", "view", "distance straight|geodesic", "radius R",
// "border PART". RELUME_EINVAL with a sentence, RELUME_EUNFIT where no object is a mirror.
relume_status handles_say(struct app *app, const char *words, const struct relume_log *log);

#endif
