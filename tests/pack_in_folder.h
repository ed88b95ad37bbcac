// pack_in_folder.h - for tests of one relume file: `path`, in a folder of its own (in_folder.h),
// from setup to teardown
#ifndef PACK_IN_FOLDER_H
#define PACK_IN_FOLDER_H

#include "in_folder.h"

static char path[96];

static int setup(void **state)
{
    make_folder(state);
    snprintf(path, sizeof path, "%s/pack.exr", folder);
    return 0;
}

static int teardown(void **state)
{
    return remove_folder(state);
}

#endif
