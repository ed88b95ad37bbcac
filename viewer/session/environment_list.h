// environment_list.h - environment maps that lie in one folder, for the panel to choose from
#ifndef VIEWER_ENVIRONMENT_LIST_H
#define VIEWER_ENVIRONMENT_LIST_H

#include <relume/base.h>

enum { ENVIRONMENT_LIST_MAX = 512 };

// All zero: none.
struct environment_list {
    char *folder;
    char **name;  // [count], then NULL; by the alphabet
    int count;
};

// The pictures of high range (.hdr, .exr, .pfm) in `folder`; none where it cannot be read.
// RELUME_ENOMEM.
relume_status environment_list_read(struct environment_list *maps, const char *folder);
void environment_list_destroy(struct environment_list *maps);

#endif
