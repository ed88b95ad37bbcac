// edits.h - a list of edits, and who speaks of them
#ifndef EDIT_EDITS_H
#define EDIT_EDITS_H

#include "core/base/log.h"

#include <relume/material/edit.h>

struct relume_edits {
    uint64_t fingerprint;
    int count, undone;
    struct relume_edit *edit;  // [count]
    char *file;                // that it was read from, or NULL
};

// The name of the list of `path`, to be freed; NULL: no memory.
char *edits_name(const char *path);

// RELUME_EUNFIT with a sentence unless the list is for values of that fingerprint; `path` may be
// NULL.
relume_status edits_check(const relume_edits *edits, uint64_t fingerprint, const char *path,
                          const struct relume_log *log);

// A log whose sentences begin with the file, the number and the name of an edit.
const struct relume_log *edit_log(struct log_place *out, const relume_edits *edits, int number,
                                  const struct relume_log *to);

#endif
