// browse.c - a folder to choose a file from
#include "panel/browse.h"

#include <relume/exchange.h>

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

bool browse_opens(const char *name)
{
    static const char *const endings[] = {".exr",  ".ptm", ".rti", ".hsh",  ".hdr", ".pfm", ".lp",
                                          ".json", ".obj", ".ply", ".gltf", ".glb", NULL};
    const char *dot = strrchr(name, '.');
    for (int i = 0; dot && endings[i]; i++)
        if (!strcasecmp(dot, endings[i]))
            return true;
    return false;
}

bool browse_is_folder(const char *path)
{
    struct stat s;
    return !stat(path, &s) && S_ISDIR(s.st_mode);
}

bool browse_opens_folder(const char *path)
{
    const enum relume_kind kind = relume_kind_of(path);
    return kind == RELUME_KIND_FOREIGN || kind == RELUME_KIND_CAPTURE ||
           kind == RELUME_KIND_MATERIAL || kind == RELUME_KIND_FITTED ||
           kind == RELUME_KIND_SURFACE;
}

bool browse_path(char path[PATH_MAX], const struct browser *b, const char *name)
{
    const char *home = getenv("HOME");
    const bool at_home = home && name[0] == '~' && (name[1] == '/' || !name[1]);
    const char *from = at_home ? home : name[0] == '/' ? "" : b->folder;
    const char *rest = at_home ? name + 1 : name;
    if (!strcmp(name, "..")) {
        const char *slash = strrchr(b->folder, '/');
        const int length = slash && slash > b->folder ? (int)(slash - b->folder) : 1;
        return snprintf(path, PATH_MAX, "%.*s", length, b->folder) < PATH_MAX;
    }
    const bool parted = rest[0] == '/' || (from[0] && from[strlen(from) - 1] == '/');
    return snprintf(path, PATH_MAX, "%s%s%s", from, parted || !from[0] || !rest[0] ? "" : "/",
                    rest) < PATH_MAX;
}

void browse_destroy(struct browser *b)
{
    for (int i = 0; i < b->count; i++)
        free(b->entry[i].name);
    free(b->entry);
    *b = (struct browser){.count = 0};
}

static int by_kind_and_name(const void *a, const void *b)
{
    const struct browse_entry *x = a, *y = b;
    if (x->folder != y->folder)
        return x->folder ? -1 : 1;
    const int order = strcasecmp(x->name, y->name);
    return order ? order : strcmp(x->name, y->name);
}

// False when memory is short.
static bool add_entry(struct browser *b, const char *name)
{
    char path[PATH_MAX];
    if (name[0] == '.' || b->count == BROWSE_MOST || !browse_path(path, b, name))
        return true;
    const bool folder = browse_is_folder(path);
    if (!folder && !browse_opens(name))
        return true;
    b->entry[b->count] =
        (struct browse_entry){strdup(name), folder, folder && browse_opens_folder(path)};
    return b->entry[b->count++].name != NULL;
}

relume_status browse_list(struct browser *b, const char *folder)
{
    char whole[PATH_MAX];
    const bool found = realpath(folder, whole) != NULL;
    browse_destroy(b);
    snprintf(b->folder, sizeof b->folder, "%s", found ? whole : folder);
    DIR *dir = found ? opendir(whole) : NULL;
    if (!dir) {
        b->trouble = strerror(errno);
        return RELUME_OK;
    }
    b->entry = calloc(BROWSE_MOST, sizeof *b->entry);
    bool good = b->entry != NULL;
    for (struct dirent *e = readdir(dir); good && e; e = readdir(dir))
        good = add_entry(b, e->d_name);
    closedir(dir);
    if (!good) {
        browse_destroy(b);
        return RELUME_ENOMEM;
    }
    if (b->count)
        qsort(b->entry, (size_t)b->count, sizeof *b->entry, by_kind_and_name);
    return RELUME_OK;
}
