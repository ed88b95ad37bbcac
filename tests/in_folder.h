// in_folder.h - for tests that write files: `folder`, made before the first of a group (setup) and
// removed after the last (teardown)
#ifndef IN_FOLDER_H
#define IN_FOLDER_H

#include "test.h"

static char folder[64];

static int make_folder(void **state)
{
    (void)state;
    test_folder(folder);
    return 0;
}

// A file there; good until the fourth next call.
static inline const char *path_of(const char *name)
{
    static char path[4][128];
    static int next;
    char *p = path[next++ % 4];
    snprintf(p, sizeof path[0], "%s/%s", folder, name);
    return p;
}

static inline void write_text(const char *name, const char *text)
{
    test_write(path_of(name), text, strlen(text));
}

static int remove_folder(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

#endif
