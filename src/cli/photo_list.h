// photo_list.h - the photographs that a command line names: files, and folders of them
#ifndef CLI_PHOTO_LIST_H
#define CLI_PHOTO_LIST_H

#include "cli.h"

struct photo_list {
    int count;
    char **path;  // [count]
};

// Every input of the command line: a file as it is, a folder as its pictures in the order of their
// names. RELUME_EDATA with a sentence for a folder that cannot be read or holds none.
relume_status photo_list_make(struct photo_list *out, const struct args *args);
// One path more, likewise.
relume_status photo_list_add(struct photo_list *list, const char *path,
                             const struct relume_log *log);
void photo_list_free(struct photo_list *list);
const char *base_name(const char *path);

#endif
