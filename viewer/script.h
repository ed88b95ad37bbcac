// script.h - a text file of events, played through the app as if a user made them
#ifndef VIEWER_SCRIPT_H
#define VIEWER_SCRIPT_H

#include "app.h"

// Called for `frame FILE`: draw what `app` describes and write it.
typedef relume_status script_frame(void *user, const struct app *app, const char *path);

// Play the file `path`; its words are in options_help(). RELUME_EDATA names the line that is wrong;
// else what `frame` returned. Ends early when an event quits the app.
relume_status script_play(struct app *app, const char *path, script_frame *frame, void *user,
                          const struct relume_log *log);

#endif
