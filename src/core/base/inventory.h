// inventory.h - what relume made in a folder
//
// A finished folder holds a file ".relume": a first line that says what it is, then one line for
// each file and folder in it, sorted: its size in bytes ("-" for a folder) and its name. relume
// removes a folder only by this list, so what somebody added to it, or changed, is never removed
// with it.
#ifndef BASE_INVENTORY_H
#define BASE_INVENTORY_H

#include <relume/base.h>

// Whether an entry of a folder is its list.
bool inventory_is(const char *name);

// Write the list and flush the whole folder to disk. False with errno.
bool inventory_write(const char *folder);
// Enter a file that was added to a folder with a list. False with errno, 0: there is no list.
bool inventory_add(const char *folder, const char *name);

// RELUME_EINVAL with a sentence unless all that is in `folder` is listed there as it is; `output`
// is what the sentence calls the folder. RELUME_EIO, RELUME_ENOMEM.
relume_status inventory_check(const char *folder, const char *output, const struct relume_log *log);

// Remove what is listed, or everything in a folder that has no list yet: one that is being made.
// What is not listed moves to a new name in the folder `beside`, which a warning names.
void inventory_remove(const char *path, const char *beside, const struct relume_log *log);

#endif
