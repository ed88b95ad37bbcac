// inventory.c - what relume made in a folder
#include "core/base/inventory.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/tree.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char FILE_NAME[] = ".relume";
static const char HEADER[] = "relume made this folder, 1\n";

struct inventory {
    char *text;
    struct tree_list list;
};

static char *path_of(const char *folder)
{
    return mem_format("%s/%s", folder, FILE_NAME);
}

bool inventory_is(const char *name)
{
    return !strcmp(name, FILE_NAME);
}

// ---------------------------------------------------------------- writing

static bool write_lines(FILE *to, const struct tree_list *list)
{
    fputs(HEADER, to);
    for (size_t i = 0; i < list->count; i++) {
        const struct tree_entry *e = &list->item[i];
        if (inventory_is(e->name))
            continue;
        if (e->is_folder)
            fprintf(to, "- %s\n", e->name);
        else
            fprintf(to, "%" PRId64 " %s\n", e->size, e->name);
    }
    return !fflush(to) && !ferror(to) && !fsync(fileno(to));
}

// A new file; `path` is freed.
static bool write_list(char *path, const struct tree_list *list)
{
    FILE *to = path ? fopen(path, "wxe") : NULL;
    bool good = to && write_lines(to, list);
    const int error = errno;
    if (to)
        good = !fclose(to) && good;
    else if (!path)
        errno = ENOMEM;
    else
        errno = error;
    mem_free(path);
    return good;
}

// What a link leads to is not ours to flush, and may not be there yet; the link is in its folder.
static bool sync_entry(const char *path)
{
    struct stat s;
    return (!lstat(path, &s) && S_ISLNK(s.st_mode)) || tree_sync(path);
}

static bool sync_all(const char *folder, const struct tree_list *list)
{
    bool good = true;
    for (size_t i = 0; good && i < list->count; i++) {
        char *path = mem_format("%s/%s", folder, list->item[i].name);
        good = path && sync_entry(path);
        mem_free(path);
    }
    return good && tree_sync(folder);
}

bool inventory_write(const char *folder)
{
    struct tree_list list;
    const bool good =
        tree_list(&list, folder) && write_list(path_of(folder), &list) && sync_all(folder, &list);
    const int error = errno;
    tree_list_free(&list);
    errno = error;
    return good;
}

// ---------------------------------------------------------------- reading

static char *read_text(const char *path)
{
    struct stat s;
    const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    char *text = NULL;
    if (fd < 0)
        return NULL;
    errno = 0;
    if (!fstat(fd, &s) && S_ISREG(s.st_mode))
        text = mem_zeroed((size_t)s.st_size + 1, 1);
    if (text && read(fd, text, (size_t)s.st_size) != (ssize_t)s.st_size) {
        mem_free(text);
        text = NULL;
    }
    const int error = errno;
    close(fd);
    errno = error;
    return text;
}

// False when there is none, or none that relume wrote; errno then says what else went wrong, 0
// nothing. Lines that are not understood list nothing.
static bool read_inventory(struct tree_list *list, const char *folder)
{
    *list = (struct tree_list){0};
    char *path = path_of(folder), *text = path ? read_text(path) : NULL;
    const bool good = text && !strncmp(text, HEADER, sizeof HEADER - 1);
    const int error = text || errno == ENOENT || errno == ELOOP ? 0 : errno;
    char *rest = good ? text + sizeof HEADER - 1 : NULL;
    size_t lines = 0;
    for (const char *c = rest; c && *c; c++)
        lines += *c == '\n';
    list->item = good ? mem_zeroed(lines, sizeof *list->item) : NULL;
    for (char *end; list->item && rest && (end = strchr(rest, '\n')); rest = end + 1) {
        struct tree_entry e = {.is_folder = *rest == '-'};
        char *name = rest + 1;
        *end = '\0';
        if (!e.is_folder)
            e.size = strtoll(rest, &name, 10);
        e.name = *name == ' ' ? mem_text(name + 1) : NULL;
        if (e.name)
            list->item[list->count++] = e;
    }
    mem_free(text);
    mem_free(path);
    errno = good ? ENOMEM : error;
    return good && list->item;
}

static int by_name(const void *name, const void *entry)
{
    return strcmp(name, ((const struct tree_entry *)entry)->name);
}

static const struct tree_entry *find(const struct tree_list *list, const char *name)
{
    return list->count ? bsearch(name, list->item, list->count, sizeof *list->item, by_name) : NULL;
}

static relume_status check_entry(const struct tree_list *made, const struct tree_entry *e,
                                 const char *output, const struct relume_log *log)
{
    const struct tree_entry *known = find(made, e->name);
    if (!known || known->is_folder != e->is_folder)
        return log_fail(log, RELUME_EINVAL,
                        "%s: holds %s, which was not made with it; move that away, or choose "
                        "another folder",
                        output, e->name);
    if (known->size != e->size && !e->is_folder)
        return log_fail(log, RELUME_EINVAL,
                        "%s: its %s was changed since it was made; move the folder away, or choose "
                        "another",
                        output, e->name);
    return RELUME_OK;
}

relume_status inventory_check(const char *folder, const char *output, const struct relume_log *log)
{
    struct tree_list made, found;
    struct stat s;
    if (!lstat(folder, &s) && !S_ISDIR(s.st_mode))
        return log_fail(log, RELUME_EINVAL,
                        "%s: is a file, which a folder cannot replace; choose another name",
                        output);
    relume_status status = RELUME_OK;
    if (!read_inventory(&made, folder) && errno == ENOMEM)
        status = RELUME_ENOMEM;
    else if (!made.item && errno)
        status = log_fail(log, RELUME_EIO, "%s: its list .relume cannot be read; %s", output,
                          strerror(errno));
    else if (!made.item)
        status =
            log_fail(log, RELUME_EINVAL,
                     "%s: not made by relume, or by a version that kept no list in it (.relume); "
                     "--force replaces only what it made: move the folder away",
                     output);
    if (!tree_list(&found, folder) && !status)
        status = log_fail(log, RELUME_EIO, "%s: cannot be replaced; %s", output, strerror(errno));
    for (size_t i = 0; !status && i < found.count; i++)
        if (!inventory_is(found.item[i].name))
            status = check_entry(&made, &found.item[i], output, log);
    tree_list_free(&made);
    tree_list_free(&found);
    return status;
}

// ---------------------------------------------------------------- adding

static int by_names(const void *a, const void *b)
{
    return strcmp(((const struct tree_entry *)a)->name, ((const struct tree_entry *)b)->name);
}

// Enters a file as it is now.
static bool enter(struct tree_list *list, const char *folder, const char *name)
{
    char *path = mem_format("%s/%s", folder, name);
    struct stat s;
    const bool there = path && !lstat(path, &s);
    mem_free(path);
    for (size_t i = 0; there && i < list->count; i++)
        if (!strcmp(list->item[i].name, name)) {
            list->item[i].size = s.st_size;
            return true;
        }
    if (!there)
        return false;
    struct tree_entry *more = mem_resize(list->item, list->count + 1, sizeof *more);
    if (!more)
        return false;
    list->item = more;
    more[list->count] = (struct tree_entry){.name = mem_text(name), .size = s.st_size};
    if (!more[list->count].name)
        return false;
    qsort(more, ++list->count, sizeof *more, by_names);
    return true;
}

static bool replace_list(const char *folder, const struct tree_list *list)
{
    char *path = path_of(folder), *new = mem_format("%s/%s-new", folder, FILE_NAME);
    if (new)
        unlink(new);  // of a run that was stopped
    const bool good = path && new &&write_list(mem_text(new), list) && !rename(new, path);
    const int error = errno;
    mem_free(path);
    mem_free(new);
    errno = error;
    return good;
}

bool inventory_add(const char *folder, const char *name)
{
    struct tree_list list;
    const bool good =
        read_inventory(&list, folder) && enter(&list, folder, name) && replace_list(folder, &list);
    const int error = errno;
    tree_list_free(&list);
    errno = error;
    return good;
}

// ---------------------------------------------------------------- removing

// What is there is walked, not what the list names: no link leads out of the folder. From the last
// to the first, since a folder's name is before those of what is in it.
static void remove_listed(const char *folder, const struct tree_list *made)
{
    struct tree_list found;
    (void)tree_list(&found, folder);
    for (size_t i = found.count; i-- > 0;) {
        const struct tree_entry *e = &found.item[i];
        char *path = find(made, e->name) ? mem_format("%s/%s", folder, e->name) : NULL;
        if (path)
            remove(path);
        mem_free(path);
    }
    tree_list_free(&found);
    char *own = path_of(folder);
    if (own)
        unlink(own);
    mem_free(own);
    rmdir(folder);
}

static void set_apart(const char *path, const char *beside, const char *why,
                      const struct relume_log *log)
{
    char *to = mem_format("%s/kept-by-relume-XXXXXX", beside);
    const bool made = to && mkdtemp(to), moved = made && !rename(path, to);
    if (made && !moved)
        rmdir(to);
    log_line(log, RELUME_WARNING,
             "%s: this old folder could not be removed: %s; look at it, then remove it yourself",
             moved ? to : path, why);
    mem_free(to);
}

void inventory_remove(const char *path, const char *beside, const struct relume_log *log)
{
    struct tree_list made;
    struct stat s;
    if (lstat(path, &s))
        return;
    const bool finished = S_ISDIR(s.st_mode) && read_inventory(&made, path);
    if (!finished) {
        if (S_ISDIR(s.st_mode) && errno)
            set_apart(path, beside, strerror(errno), log);  // it may have a list
        else
            tree_remove(path);
        return;
    }
    remove_listed(path, &made);
    tree_list_free(&made);
    if (!lstat(path, &s))
        set_apart(path, beside, "it holds what was not made with it", log);
}
