// tree.h - folders as wholes: walked, renamed, flushed, removed
#ifndef BASE_TREE_H
#define BASE_TREE_H

#include <relume/base.h>

enum tree_rename {
    TREE_NEW,      // nothing there may be replaced; an empty folder may
    TREE_REPLACE,  // as rename() does
    TREE_EXCHANGE  // the two change places, at once
};
// False with errno: EEXIST or ENOTEMPTY when something is there, ENOSYS or EINVAL when the file
// system cannot exchange.
bool tree_rename(const char *from, const char *to, enum tree_rename how);

// The folder that `path` lies in, and the last part of it: new strings.
char *tree_parent(const char *path);
char *tree_base(const char *path);
// Where `path` leads when it is a symbolic link, there or not, and without slashes at the end: a
// new string. NULL with errno, ELOOP among others.
char *tree_resolve(const char *path);

// Whether `path` ends so, upper and lower case alike.
bool path_ends(const char *path, const char *ending);
// The file's name, behind the last slash of `path`; the number of bytes before it.
const char *path_name(const char *path);
int path_folder(const char *path);
// `name` in the folder of the file `path`: a new string. Absolute names stay.
char *path_beside(const char *path, const char *name);

// What is there, followed through links: a folder; neither a file nor a folder.
bool tree_is_folder(const char *path);
bool tree_is_device(const char *path);

// One entry of a folder: `name` is relative to it.
struct tree_entry {
    char *name;
    bool is_folder;
    int64_t size;  // of a file
};
struct tree_list {
    struct tree_entry *item;
    size_t count;
};
// All that is in `path`, sorted by name. False with errno; to be freed in either case.
bool tree_list(struct tree_list *out, const char *path);
void tree_list_free(struct tree_list *list);

// The only entry of a folder whose name ends in `ending`, upper and lower case alike: a new string,
// the folder's path before it. NULL when there is none, or more than one.
char *tree_only(const char *folder, const char *ending);
// The same of all folders in it together.
char *tree_only_below(const char *folder, const char *ending);

// To disk. False with errno.
bool tree_sync(const char *path);
// Remove a file, or a folder with all that is in it; links are removed, never followed.
void tree_remove(const char *path);

#endif
