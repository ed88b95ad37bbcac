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

static int remove_folder(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

#endif
