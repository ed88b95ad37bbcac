// record.h - moving pictures: what moves in them, and the folder or film that they become
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

// Where the pictures go. Thread-safety: one thread at a time.
struct record;

// A name that ends in .mp4 or .mkv is a film made by ffmpeg, 25 pictures a second; every other one
// is a new folder of 0000.png, 0001.png, ... Nothing stands under its name before record_commit.
// RELUME_EINVAL: the folder is there and not empty. RELUME_EIO, RELUME_ENOMEM; RELUME_ESYSTEM: no
// ffmpeg.
relume_status record_open(struct record **out, const char *path, const struct relume_log *log);
// The next picture, linear light in [0, 1]; all have the size of the first. RELUME_EIO,
// RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status record_add(struct record *record, const struct relume_image *image);
// Both free `*record`; NULL is fine for abort.
relume_status record_commit(struct record **record);
void record_abort(struct record **record);

#endif
