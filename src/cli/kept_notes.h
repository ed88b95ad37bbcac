// kept_notes.h - notes on a relume file that another one replaces
#ifndef CLI_KEPT_NOTES_H
#define CLI_KEPT_NOTES_H

#include "cli.h"

#include <relume/exchange/notes.h>

// The file `path` as it is now, and the notes on it, beside or inside. All members are NULL without
// notes.
struct kept_notes {
    relume_pack *pack;
    relume_notes *notes;
    char *inside;  // the list that the file itself holds, or NULL; ...
    bool hidden;   // ... `notes` hide it, being beside the file
};
void kept_notes_read(struct kept_notes *out, const char *path);
// Keeps the notes with the new file of that name, if `status` is RELUME_OK. They move if it shows
// another part of the same photographs. Notes beside that part go into PATH.notes-outside.json,
// with a warning. Notes inside a file of another size go into PATH.notes-before.json. Frees the
// notes; returns `status`, RELUME_EIO, RELUME_ENOMEM.
relume_status kept_notes_write(struct kept_notes *kept, const char *path, relume_status status,
                               const struct args *args);

#endif
