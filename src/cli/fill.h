// fill.h - a folder for several pictures: one that is not there appears whole or not at all, one
// that is there gets its pictures one by one
#ifndef CLI_FILL_H
#define CLI_FILL_H

#include <relume/extensions.h>

struct fill {
    const char *path;       // where to write
    relume_making *making;  // NULL: the folder was there
};

// RELUME_EIO with a sentence, RELUME_ENOMEM.
relume_status fill_open(struct fill *out, const char *path, const struct relume_log *log);
// Commit what a `status` of RELUME_OK says is whole, or drop it; gives the status of all.
relume_status fill_end(struct fill *fill, relume_status status);

#endif
