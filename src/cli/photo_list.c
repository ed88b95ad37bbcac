// photo_list.c - the photographs that a command line names: files, and folders of them
#include "photo_list.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static bool is_picture(const char *name)
{
    static const char *const extensions[] = {
        ".jpg", ".jpeg", ".png", ".tif", ".tiff", ".exr", ".hdr", ".ppm", ".dng", ".cr2",
        ".cr3", ".nef",  ".arw", ".orf", ".raf",  ".rw2", ".pef", ".srw", NULL};
    const char *dot = strrchr(name, '.');
    for (int i = 0; dot && dot != name && extensions[i]; i++)
        if (!strcasecmp(dot, extensions[i]))
            return true;
    return false;
}

static relume_status add(struct photo_list *list, const char *folder, const char *name)
{
    const size_t size = strlen(folder) + strlen(name) + 2;
    char **grown = realloc(list->path, ((size_t)list->count + 1) * sizeof *grown);
    char *path = malloc(size);
    if (grown)
        list->path = grown;
    if (!grown || !path) {
        free(path);
        return RELUME_ENOMEM;
    }
    snprintf(path, size, "%s%s%s", folder, *folder ? "/" : "", name);
    list->path[list->count++] = path;
    return RELUME_OK;
}

static int only_pictures(const struct dirent *entry)
{
    return is_picture(entry->d_name);
}

static relume_status add_folder(struct photo_list *list, const char *folder,
                                const struct relume_log *log)
{
    struct dirent **entry;
    const int n = scandir(folder, &entry, only_pictures, alphasort);
    if (n < 0)
        return relume_input_fail(log, folder, "cannot be read", errno);
    relume_status status =
        n > 0 ? RELUME_OK : data_error("%s: no pictures in this folder; expected some", folder);
    for (int i = 0; i < n; i++) {
        if (!status)
            status = add(list, folder, entry[i]->d_name);
        free(entry[i]);
    }
    free(entry);
    return status;
}

void photo_list_free(struct photo_list *list)
{
    for (int i = 0; i < list->count; i++)
        free(list->path[i]);
    free(list->path);
    *list = (struct photo_list){0};
}

relume_status photo_list_add(struct photo_list *list, const char *path,
                             const struct relume_log *log)
{
    struct stat s;
    if (stat(path, &s))
        return data_error("%s: %s; expected a photograph, or a folder of them", path,
                          errno == ENOENT ? "no such file" : strerror(errno));
    return S_ISDIR(s.st_mode) ? add_folder(list, path, log) : add(list, "", path);
}

relume_status photo_list_make(struct photo_list *out, const struct args *args)
{
    relume_status status = RELUME_OK;
    *out = (struct photo_list){0};
    for (int i = 0; !status && i < args->inputs; i++)
        status = photo_list_add(out, args->input[i], args->log);
    if (status)
        photo_list_free(out);
    return status;
}
