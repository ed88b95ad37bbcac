// environment_list.h - environment maps that lie in one folder, for the panel to choose from
#ifndef VIEWER_ENVIRONMENT_LIST_H
#define VIEWER_ENVIRONMENT_LIST_H

#include <relume/base.h>

enum { MAPS_MOST = 512 };

// All zero: none.
struct maps {
    char *folder;
    char **name;  // [count], then NULL; by the alphabet
    int count;
};

// The pictures of high range (.hdr, .exr, .pfm) in `folder`; none where it cannot be read.
// RELUME_ENOMEM.
relume_status maps_list(struct maps *maps, const char *folder);
void maps_destroy(struct maps *maps);

#endif
