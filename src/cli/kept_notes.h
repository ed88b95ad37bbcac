// kept_notes.h - notes inside a relume file that another one replaces
#ifndef CLI_KEPT_NOTES_H
#define CLI_KEPT_NOTES_H

#include "cli.h"

// What the file `path` holds now; nothing where there is no such file, or no notes in it.
struct kept_notes {
    char *text;
    int width, height, views;
};
void kept_notes_read(struct kept_notes *out, const char *path);
// Where `status` is RELUME_OK they go into the new file of that name, or, where its pictures have
// another size, beside it as PATH.notes-before.json with a warning. Frees them; returns `status`,
// RELUME_EIO, RELUME_ENOMEM.
relume_status kept_notes_write(struct kept_notes *kept, const char *path, relume_status status,
                               const struct args *args);

#endif
