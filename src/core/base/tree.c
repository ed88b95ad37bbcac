// tree.c - folders as wholes: walked, renamed, flushed, removed
#include "core/base/tree.h"

#include "core/base/memory.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

bool tree_rename(const char *from, const char *to, enum tree_rename how)
{
#ifdef RENAME_EXCHANGE
    if (how == TREE_EXCHANGE)
        return !renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_EXCHANGE);
#endif
    struct stat s, t;
    if (how == TREE_EXCHANGE) {
        errno = ENOSYS;
        return false;
    }
    // rename() replaces no folder that has anything in it, and no file by a folder.
    if (how == TREE_NEW && !lstat(to, &t) && !lstat(from, &s) && !S_ISDIR(s.st_mode)) {
        errno = EEXIST;
        return false;
    }
    return !rename(from, to);
}

// ---------------------------------------------------------------- names

static char *without_slashes(const char *path)
{
    char *copy = mem_text(path);
    for (size_t n = copy ? strlen(copy) : 0; n > 1 && copy[n - 1] == '/'; n--)
        copy[n - 1] = '\0';
    return copy;
}

char *tree_parent(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (!slash)
        return mem_text(".");
    return slash == path ? mem_text("/") : mem_format("%.*s", (int)(slash - path), path);
}

char *tree_base(const char *path)
{
    return mem_text(path_name(path));
}

// One step along a link; the old string is freed.
static char *follow(char *path)
{
    char to[PATH_MAX];
    const ssize_t n = readlink(path, to, sizeof to - 1);
    char *parent = n > 0 && *to != '/' ? tree_parent(path) : NULL;
    char *next = NULL;
    if (n > 0) {
        to[n] = '\0';
        next = *to == '/' ? without_slashes(to) : parent ? mem_format("%s/%s", parent, to) : NULL;
    }
    mem_free(parent);
    mem_free(path);
    return next;
}

char *tree_resolve(const char *path)
{
    enum { MOST = 40 };  // as the kernel's own bound
    struct stat s;
    char *at = without_slashes(path);
    for (int i = 0; at && !lstat(at, &s) && S_ISLNK(s.st_mode); i++) {
        if (i == MOST) {
            mem_free(at);
            errno = ELOOP;
            return NULL;
        }
        at = follow(at);
    }
    if (!at)
        errno = errno ? errno : ENOMEM;
    return at;
}

bool path_ends(const char *path, const char *ending)
{
    const size_t n = strlen(path), m = strlen(ending);
    return n >= m && !strcasecmp(path + n - m, ending);
}

const char *path_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

int path_folder(const char *path)
{
    return (int)(path_name(path) - path);
}

char *path_beside(const char *path, const char *name)
{
    return mem_format("%.*s%s", name[0] == '/' ? 0 : path_folder(path), path, name);
}

bool tree_is_folder(const char *path)
{
    struct stat s;
    return !stat(path, &s) && S_ISDIR(s.st_mode);
}

bool tree_is_device(const char *path)
{
    struct stat s;
    return !stat(path, &s) && !S_ISREG(s.st_mode) && !S_ISDIR(s.st_mode);
}

// ---------------------------------------------------------------- contents

// `within` is "" or ends in a slash.
static bool list_entry(struct tree_list *out, const char *root, const char *within,
                       const char *name)
{
    const bool allocated = mem_grow(&out->item, out->count, sizeof *out->item);
    struct tree_entry *e = allocated ? &out->item[out->count++] : NULL;
    if (!e)
        return false;
    *e = (struct tree_entry){.name = mem_format("%s%s", within, name)};
    char *path = e->name ? mem_format("%s/%s", root, e->name) : NULL;
    struct stat s;
    const bool good = path && !lstat(path, &s);
    mem_free(path);
    if (!good)
        return false;
    e->is_folder = S_ISDIR(s.st_mode);
    e->size = S_ISREG(s.st_mode) || S_ISLNK(s.st_mode) ? (int64_t)s.st_size : -1;
    return true;
}

static bool list_folder(struct tree_list *out, const char *root, const char *within)
{
    char *path = mem_format("%s/%s", root, within);
    DIR *dir = path ? opendir(path) : NULL;
    bool good = dir;
    for (struct dirent *e; good && (e = readdir(dir));)
        if (strcmp(e->d_name, ".") && strcmp(e->d_name, ".."))
            good = list_entry(out, root, within, e->d_name);
    const int error = errno;
    if (dir)
        closedir(dir);
    mem_free(path);
    errno = error;
    return good;
}

// Folders found are listed when their own folder is closed: one descriptor at any depth.
static bool list_all(struct tree_list *out, const char *root)
{
    bool good = list_folder(out, root, "");
    for (size_t i = 0; good && i < out->count; i++)
        if (out->item[i].is_folder) {
            char *inner = mem_format("%s/", out->item[i].name);
            good = inner && list_folder(out, root, inner);
            mem_free(inner);
        }
    return good;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(((const struct tree_entry *)a)->name, ((const struct tree_entry *)b)->name);
}

bool tree_list(struct tree_list *out, const char *path)
{
    *out = (struct tree_list){0};
    if (!list_all(out, path))
        return false;
    if (out->count)
        qsort(out->item, out->count, sizeof *out->item, by_name);
    return true;
}

void tree_list_free(struct tree_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        mem_free(list->item[i].name);
    mem_free(list->item);
    *list = (struct tree_list){0};
}

char *tree_only(const char *folder, const char *ending)
{
    char *found = NULL;
    int n = 0;
    DIR *dir = opendir(folder);
    for (const struct dirent *e; dir && (e = readdir(dir));)
        if (path_ends(e->d_name, ending) && n++ == 0)
            found = mem_format("%s/%s", folder, e->d_name);
    if (dir)
        closedir(dir);
    if (n == 1)
        return found;
    mem_free(found);
    return NULL;
}

char *tree_only_below(const char *folder, const char *ending)
{
    char *found = NULL;
    int n = 0;
    DIR *dir = opendir(folder);
    for (const struct dirent *e; dir && (e = readdir(dir));) {
        char *path = *e->d_name != '.' ? mem_format("%s/%s", folder, e->d_name) : NULL;
        char *only = path ? tree_only(path, ending) : NULL;
        mem_free(path);
        if (only && n++ == 0)
            found = only;
        else
            mem_free(only);
    }
    if (dir)
        closedir(dir);
    if (n == 1)
        return found;
    mem_free(found);
    return NULL;
}

// ---------------------------------------------------------------- disk

bool tree_sync(const char *path)
{
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    const bool good = fd >= 0 && (!fsync(fd) || errno == EINVAL);  // a file system without it
    const int error = errno;
    if (fd >= 0)
        close(fd);
    errno = error;
    return good;
}

static int remove_entry(const char *path, const struct stat *s, int type, struct FTW *walk)
{
    (void)s, (void)type, (void)walk;
    remove(path);
    return 0;
}

void tree_remove(const char *path)
{
    nftw(path, remove_entry, 1, FTW_DEPTH | FTW_PHYS | FTW_MOUNT);  // one descriptor
}
