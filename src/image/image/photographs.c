// photographs.c - which of the files that somebody named are photographs
#include <relume/image/photograph.h>

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/tree.h"
#include "image/image/photograph.h"
#include "image/image/picture.h"
#include "image/image/picture_format.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

struct gathering {
    struct relume_photographs *list;
    const struct relume_photographs_params *p;
    int skipped, lp, tables[2];
    char *table[2];   // of lights: the first .txt, the first .csv
    char names[160];  // of the first that were left out
};

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
    const bool readable =
        kind && (kind->listed || (kind->reader && *kind->reader && log &&
                                  limits_or_default(limits_of(NULL, log)).any_format));
    if (readable)
        return picture_is_relume(path, NULL) ? relume_file : NULL;
    return has_picture_name(path) ? NULL : kind && kind->what ? kind->what : "";
}

static bool is_named(const char *path, const char *word)
{
    return strcasestr(path_name(path), word) != NULL;
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
    const size_t n = strlen(g->names), capacity = sizeof g->names - n;
    if (g->skipped++ < 3)
        snprintf(g->names + n, capacity, "%s%.60s%s%s%s", n ? ", " : "", path_name(path),
                 *why ? " (" : "", why, *why ? ")" : "");
}

// Of several masks the last, of several lists of lights none (choose_lights).
static void keep_beside(struct gathering *g, char *path, const char *why)
{
    const bool lp = picture_has_extension(path, ".lp"), mask = !lp && is_named(path, "mask");
    // A list of light directions by its name.
    const bool csv = picture_has_extension(path, ".csv");
    const bool table = !mask && ((csv || picture_has_extension(path, ".txt")) &&
                                 !is_named(path, "intens") && !is_named(path, "pos") &&
                                 (is_named(path, "light") || is_named(path, "direction")));
    const bool used = mask || (lp && g->lp++ == 0) || (table && g->tables[csv]++ == 0);
    char **const place = lp ? &g->list->lights : table ? &g->table[csv] : &g->list->mask;
    if (!g->p->companions || !used)
        leave_out(g, path, why);
    if (used) {
        mem_free(*place);
        *place = path;
    } else {
        mem_free(path);
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
    if (!path || !mem_grow(&list->path, (size_t)list->count, sizeof *list->path)) {
        mem_free(path);
        return RELUME_ENOMEM;
    }
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
        mem_free_libc(entry[i]);
        if (status)
            continue;
        if (!path || !tree_is_folder(path))
            status = add_file(g, path, false);
        else if (g->p->folders)
            status = add(g, path);
        else
            mem_free(path);
    }
    mem_free_libc(entry);
    return status;
}

relume_status photographs_refuse_tiles(const char *folder, const struct relume_log *log)
{
    char *path = mem_format("%s/info.xml", folder);
    struct infile in = {0};
    const bool tiles = path && infile_open(&in, path, NULL, NULL);
    infile_close(&in);
    const relume_status status = path ? RELUME_OK : RELUME_ENOMEM;
    mem_free(path);
    return !tiles ? status
                  : log_fail(log, RELUME_EUNSUPPORTED,
                             "%s: tiles of WebRTI (info.xml), which relume does not read; "
                             "expected the .ptm or .rti that they were made from, or photographs",
                             folder);
}

static relume_status add_named(struct gathering *g, const char *path, bool alone)
{
    struct stat s;
    if (stat(path, &s))
        return log_fail(g->p->log, RELUME_ENOTFOUND,
                        "%s: %s; expected a photograph, or a folder of them", path,
                        errno == ENOENT ? "no such file" : strerror(errno));
    if (S_ISDIR(s.st_mode) && (alone || !g->p->folders)) {
        const relume_status status = photographs_refuse_tiles(path, g->p->log);
        return status ? status : add_folder(g, path);
    }
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
        if (!what || tree_is_folder(path))
            list->path[n++] = path;
        else
            keep_beside(g, path, what);
    }
    list->count = n;
}

static void put_back(struct gathering *g, char **path)
{
    if (*path && g->p->companions)
        leave_out(g, *path, "");
    mem_free(*path);
    *path = NULL;
}

// Several lists of one kind leave the choice open. A .txt comes before a .csv.
static void choose_lights(struct gathering *g)
{
    char **lights = &g->list->lights;
    if (g->lp > 1)
        put_back(g, lights);
    for (int csv = 0; csv < 2; csv++) {
        if (g->lp == 0 && !*lights && g->tables[csv] == 1 && (!csv || !g->tables[0])) {
            *lights = g->table[csv];
            g->table[csv] = NULL;
        }
        put_back(g, &g->table[csv]);
    }
}

// ---------------------------------------------------------------- folders below

enum { FOLDERS_NAMED = 20 };

struct below {
    int folders, most;  // that have photographs; in the one that has the most
    char *folder, names[1000];
};

static int photographs_in(const char *folder, const struct relume_log *log)
{
    struct dirent **entry;
    const int n = scandir(folder, &entry, is_seen, NULL);
    int count = 0;
    for (int i = 0; i < n; i++) {
        char *path = mem_format("%s/%s", folder, entry[i]->d_name);
        count += path && !tree_is_folder(path) && !by_product(path) && !why_none(path, log);
        mem_free(path);
        mem_free_libc(entry[i]);
    }
    if (n >= 0)
        mem_free_libc(entry);
    return count;
}

static void look_below(struct below *b, const char *folder, const struct relume_log *log)
{
    struct dirent **entry;
    const int n = scandir(folder, &entry, is_seen, alphasort);
    for (int i = 0; i < n; i++) {
        char *path = mem_format("%s/%s", folder, entry[i]->d_name);
        const int count = path && tree_is_folder(path) ? photographs_in(path, log) : 0;
        const size_t used = strlen(b->names);
        if (count && b->folders++ < FOLDERS_NAMED)
            snprintf(b->names + used, sizeof b->names - used, "%s%.40s (%d)", used ? ", " : "",
                     entry[i]->d_name, count);
        mem_free_libc(entry[i]);
        if (count > b->most) {
            b->most = count;
            mem_free(b->folder);
            b->folder = path;
        } else {
            mem_free(path);
        }
    }
    if (n >= 0)
        mem_free_libc(entry);
}

static void name_more(char more[32], const struct below *b)
{
    *more = '\0';
    if (b->folders > FOLDERS_NAMED)
        snprintf(more, 32, " and %d more", b->folders - FOLDERS_NAMED);
}

static relume_status refuse_for_below(const struct gathering *g, const char *folder, int count,
                                      const struct below *b)
{
    const struct relume_photographs_params *p = g->p;
    const bool each = p->command && b->folders > 1;
    const char *q = relume_name_quotes(each ? folder : b->folder),
               *one = relume_name_quotes(b->folder),
               *lights = p->command && g->list->lights ? g->list->lights : "";
    char here[32] = "no photographs", more[32], instead[1100] = "";
    size_t length = strlen(folder);
    if (count)
        snprintf(here, sizeof here, "%d photograph%s", count, relume_plural(count));
    name_more(more, b);
    while (length > 1 && folder[length - 1] == '/')
        length--;
    if (each)
        snprintf(instead, sizeof instead, " for an object of each folder, or %s%.1024s%s alone",
                 one, b->folder, one);
    return log_fail(p->log, RELUME_ENOTFOUND,
                    "%s: %s; folders below have %s: %s%s; %s %s%.*s%s%s%s%s%s%s", folder, here,
                    count ? "more" : "some", b->names, more, p->command ? p->command : "give", q,
                    each ? (int)length : INT_MAX, each ? folder : b->folder, q, each ? "/*/" : "",
                    *lights ? " --lights " : "", lights, p->command ? " -o DIR" : "", instead);
}

// Some that only have names of masks and normals are none here either.
static relume_status check_below(const struct gathering *g, const char *folder)
{
    const struct relume_photographs *list = g->list;
    const struct relume_photographs_params *p = g->p;
    struct below b = {0};
    char more[32];
    int count = 0;
    for (int i = 0; i < list->count; i++)
        count += tree_is_folder(list->path[i]) || !by_product(list->path[i]);
    const bool enough = count >= (p->least ? p->least : 1);
    if (!tree_is_folder(folder) || (enough && (p->folders || p->quiet)))
        return RELUME_OK;
    look_below(&b, folder, p->log);
    name_more(more, &b);
    relume_status status = RELUME_OK;
    if (!enough && b.most > count)
        status = refuse_for_below(g, folder, count, &b);
    else if (enough && b.folders)
        log_line(p->log, RELUME_NOTE, "%s: folders below are left out, with photographs: %s%s",
                 folder, b.names, more);
    mem_free(b.folder);
    return status;
}

void relume_photographs_free(struct relume_photographs *list)
{
    for (int i = 0; i < list->count; i++)
        mem_free(list->path[i]);
    mem_free(list->path);
    mem_free(list->mask);
    mem_free(list->lights);
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
    choose_lights(&g);
    if (!status && n == 1)
        status = check_below(&g, paths[0]);
    if (!status && n && !out->count)
        status = log_fail(g.p->log, RELUME_ENOTFOUND, "%s: no photographs%s%s; expected some",
                          paths[0], g.skipped ? "; found " : "", g.names);
    else if (!status && n)
        say_left_out(&g, paths[0]);
    if (status)
        relume_photographs_free(out);
    return status;
}
