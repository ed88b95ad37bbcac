// browse.h - a folder to choose a file from
#ifndef VIEWER_BROWSE_H
#define VIEWER_BROWSE_H

#include <relume/base.h>

#include <limits.h>
#include <stdbool.h>

enum { BROWSE_MOST = 4096 };  // entries that are listed

struct browse_entry {
    char *name;
    bool folder;
    bool opens;  // a folder that is opened as a file is: a capture, a web export
};

// All zero: nothing was listed yet.
struct browser {
    char folder[PATH_MAX];       // absolute
    struct browse_entry *entry;  // [count]: folders, then files, each by the alphabet
    int count;
    const char *trouble;  // why the folder cannot be read, or NULL
};

// Whether the viewer may open a file of that name: by its ending.
bool browse_opens(const char *name);

// List `folder`: its folders and what the viewer may open, hidden ones left out. A folder that
// cannot be read has `trouble` and no entries. RELUME_ENOMEM.
relume_status browse_list(struct browser *browser, const char *folder);
// Where `name` leads from the folder that is listed: "..", a name, or a path of its own ("~/" is
// the home folder). False when it is too long.
bool browse_path(char path[PATH_MAX], const struct browser *browser, const char *name);
bool browse_is_folder(const char *path);
// Whether a folder is opened as a file is.
bool browse_opens_folder(const char *path);
void browse_destroy(struct browser *browser);

#endif
