// photographs.c - which of the files that somebody named are photographs
#include <relume/photograph.h>

#include "base/log.h"
#include "base/memory.h"
#include "base/params.h"
#include "base/tree.h"
#include "image/photograph.h"
#include "image/picture.h"
#include "image/picture_format.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

struct gathering {
    struct relume_photographs *list;
    const struct relume_photographs_params *p;
    int skipped, lp;
    char names[160];  // of the first that were left out
};

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static bool is_folder(const char *path)
{
    struct stat s;
    return !stat(path, &s) && S_ISDIR(s.st_mode);
}

// ---------------------------------------------------------------- what is left out

static const char relume_file[] = "a relume file";

static bool has_picture_name(const char *path)
{
    static const char *const endings[] = {".jpg",  ".jpeg", ".png",  ".tif", ".tiff", ".exr",
                                          ".hdr",  ".ppm",  ".pgm",  ".pfm", ".bmp",  ".tga",
                                          ".webp", ".jp2",  ".avif", ".heic"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (picture_has_extension(path, endings[i]))
            return true;
    return false;
}

// NULL: a photograph, or what calls itself one and is refused when it is read.
static const char *why_none(const char *path, const struct relume_log *log)
{
    const struct picture_kind *kind = picture_kind_at(path);
    const bool readable = kind && (kind->listed || (kind->reader && *kind->reader && log &&
                                                    log->limits && log->limits->any_format));
    if (readable)
        return picture_is_relume(path) ? relume_file : NULL;
    return has_picture_name(path) ? NULL : kind && kind->what ? kind->what : "";
}

static bool is_named(const char *path, const char *word)
{
    return strcasestr(base_name(path), word) != NULL;
}

static const char *by_product(const char *path)
{
    static const char *const words[] = {"mask", "depth", "normal", "disparity", "albedo"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (is_named(path, words[i]))
            return words[i];
    return NULL;
}

static void leave_out(struct gathering *g, const char *path, const char *why)
{
    const size_t n = strlen(g->names), room = sizeof g->names - n;
    if (g->skipped++ < 3)
        snprintf(g->names + n, room, "%s%.60s%s%s%s", n ? ", " : "", base_name(path),
                 *why ? " (" : "", why, *why ? ")" : "");
}

// Of several masks the last, of several .lp files none.
static void keep_beside(struct gathering *g, char *path, const char *why)
{
    const bool lp = picture_has_extension(path, ".lp"), mask = is_named(path, "mask");
    if (!g->p->companions || (!lp && !mask))
        leave_out(g, path, why);
    if (mask && !lp) {
        free(g->list->mask);
        g->list->mask = path;
    } else if (lp && g->lp++ == 0) {
        g->list->lights = path;
    } else {
        free(path);
    }
}

static void say_left_out(const struct gathering *g, const char *first)
{
    const int more = g->skipped - 3;
    if (!g->skipped || g->p->quiet)
        return;
    if (more > 0)
        log_line(g->p->log, RELUME_NOTE, "%s: left out, no photographs: %s and %d more", first,
                 g->names, more);
    else
        log_line(g->p->log, RELUME_NOTE, "%s: left out, no photograph%s: %s", first,
                 relume_plural(g->skipped), g->names);
}

// ---------------------------------------------------------------- gathering

static relume_status add(struct gathering *g, char *path)
{
    struct relume_photographs *list = g->list;
    char **grown = path ? mem_resize(list->path, (size_t)list->count + 1, sizeof *grown) : NULL;
    if (!grown) {
        free(path);
        return RELUME_ENOMEM;
    }
    list->path = grown;
    list->path[list->count++] = path;
    return RELUME_OK;
}

// What was named alone is read, and refused with what it is.
static relume_status add_file(struct gathering *g, char *path, bool alone)
{
    const char *why = path ? why_none(path, g->p->log) : NULL;
    if (!why || (alone && why != relume_file))
        return add(g, path);
    keep_beside(g, path, why);
    return RELUME_OK;
}

static int is_seen(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

static relume_status add_folder(struct gathering *g, const char *folder)
{
    struct dirent **entry;
    const int n = scandir(folder, &entry, is_seen, alphasort);
    if (n < 0)
        return relume_input_fail(g->p->log, folder, "cannot be listed", errno);
    relume_status status = RELUME_OK;
    for (int i = 0; i < n; i++) {
        char *path = status ? NULL : mem_format("%s/%s", folder, entry[i]->d_name);
        free(entry[i]);
        if (status)
            continue;
        if (!path || !is_folder(path))
            status = add_file(g, path, false);
        else if (g->p->folders)
            status = add(g, path);
        else
            free(path);
    }
    free(entry);
    return status;
}

static relume_status add_named(struct gathering *g, const char *path, bool alone)
{
    struct stat s;
    if (stat(path, &s))
        return log_fail(g->p->log, RELUME_ENOTFOUND,
                        "%s: %s; expected a photograph, or a folder of them", path,
                        errno == ENOENT ? "no such file" : strerror(errno));
    if (S_ISDIR(s.st_mode) && (alone || !g->p->folders))
        return add_folder(g, path);
    char *copy = mem_text(path);
    return S_ISDIR(s.st_mode) ? add(g, copy) : add_file(g, copy, alone);
}

// Pictures that belong to others; where all have such names they are what was photographed.
static void set_aside(struct gathering *g)
{
    struct relume_photographs *list = g->list;
    int n = 0, kept = 0;
    for (int i = 0; i < list->count; i++)
        kept += !by_product(list->path[i]);
    if (!kept)
        return;
    for (int i = 0; i < list->count; i++) {
        char *path = list->path[i];
        const char *what = by_product(path);
        if (!what || is_folder(path))
            list->path[n++] = path;
        else
            keep_beside(g, path, what);
    }
    list->count = n;
}

void relume_photographs_free(struct relume_photographs *list)
{
    for (int i = 0; i < list->count; i++)
        free(list->path[i]);
    free(list->path);
    free(list->mask);
    free(list->lights);
    *list = (struct relume_photographs){0};
}

relume_status relume_photographs_list(struct relume_photographs *out, const char *const *paths,
                                      int n, const struct relume_photographs_params *params)
{
    const struct relume_photographs_params p = PARAMS(relume_photographs_params, params);
    struct gathering g = {.list = out, .p = &p};
    relume_status status = RELUME_OK;
    *out = (struct relume_photographs){0};
    for (int i = 0; i < n && !status; i++)
        status = add_named(&g, paths[i], n == 1);
    if (!status && !g.p->by_products)
        set_aside(&g);
    if (g.lp > 1) {
        free(out->lights);
        out->lights = NULL;
    }
    if (!status && n && !out->count)
        status = log_fail(g.p->log, RELUME_ENOTFOUND, "%s: no photographs%s%s; expected some",
                          paths[0], g.skipped ? "; found " : "", g.names);
    else if (!status && n)
        say_left_out(&g, paths[0]);
    if (status)
        relume_photographs_free(out);
    return status;
}
