// record.h - moving pictures: what moves in them; what they become is cli/program/film.h
#ifndef VIEWER_RECORD_H
#define VIEWER_RECORD_H

#include "app/app.h"

enum { RECORD_FRAMES = 72, RECORD_RATE = 25 };  // where nobody says how many; a second

enum record_kind { RECORD_SWEEP, RECORD_TURNTABLE, RECORD_SCRIPT };
// "sweep", "turntable", "script". RELUME_EINVAL when `name` is none of them.
relume_status record_parse(enum record_kind *out, const char *name);

// Set the app to the moment `part` in [0, 1) of a closed round. Sweep: the selected light goes once
// around the pole, as high as it stands, between 20 and 60 degrees. Turntable: a slab's eye goes
// around the middle of the cameras, a panorama turns. RELUME_EINVAL: the framing has nothing to
// turn.
relume_status record_pose(struct app *app, enum record_kind kind, double part,
                          const struct relume_log *log);

#endif
