// adjust.h - numbers that sliders change, by name: `set NAME VALUE` of scripts
#ifndef VIEWER_ADJUST_H
#define VIEWER_ADJUST_H

#include "app/state.h"

// Set what `words` say, as in "gain 3" or "range 0.01 0.2". False: `*expected` says what it should
// have been.
bool adjust_say(struct app_state *state, const char *words, const char **expected);

#endif
