// acquire_inputs.c - the photographs, masks and lists of lights that are named or lie beside
#include "capture/acquire/acquire.h"

#include "capture/manifest/loaded_lights.h"
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/tree.h"
#include "image/image/pages.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

struct given {
    char *path;
    int index;
};

static int by_number(const void *a, const void *b)
{
    const struct given *one = a, *two = b;
    return strverscmp(one->path, two->path);
}

// Sorts photographs by the numbers in their names: img2 comes before img10, whatever the shell
// says. before[i] (or NULL) becomes the former index of photograph i.
static relume_status sort_photographs(struct relume_photographs *list, int *before)
{
    struct given *given = mem_array((size_t)list->count, sizeof *given);
    if (!given)
        return RELUME_ENOMEM;
    for (int i = 0; i < list->count; i++)
        given[i] = (struct given){list->path[i], i};
    qsort(given, (size_t)list->count, sizeof *given, by_number);
    for (int i = 0; i < list->count; i++) {
        list->path[i] = given[i].path;
        if (before)
            before[i] = given[i].index;
    }
    mem_free(given);
    return RELUME_OK;
}

static relume_status list(struct relume_photographs *out, const char *const *paths, int n,
                          int least, const struct relume_log *log)
{
    return relume_photographs_list(
        out, paths, n,
        relume_photographs_params(.log = log, .companions = true, .least = least,
                                  .command = least ? "try: relume capture" : NULL));
}

// A TIFF of several pages that is named alone holds a photograph on each.
static relume_status list_pages(struct relume_photographs *list, const struct relume_log *log)
{
    const int pages = list->count == 1 ? picture_pages(list->path[0], log) : 1;
    if (pages == 1)
        return RELUME_OK;
    char *file = list->path[0];
    char **path = mem_zeroed((size_t)pages, sizeof *path);
    if (!path)
        return RELUME_ENOMEM;
    mem_free(list->path);
    *list = (struct relume_photographs){
        .path = path, .count = pages, .mask = list->mask, .lights = list->lights};
    bool good = true;
    for (int i = 0; i < pages; i++) {
        path[i] = mem_format("%s#%d", file, i + 1);
        good &= path[i] != NULL;
    }
    mem_free(file);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status list_sorted(struct relume_photographs *out, const char *const *paths, int n,
                                 const struct relume_log *log)
{
    relume_status status = list(out, paths, n, 0, log);
    if (!status)
        status = list_pages(out, log);
    return status ? status : sort_photographs(out, NULL);
}

// Paths in the order in which a shell or a folder lists them.
static bool are_sorted(const struct relume_photographs *list,
                       int (*compare)(const char *, const char *))
{
    for (int i = 1; i < list->count; i++)
        if (compare(list->path[i - 1], list->path[i]) > 0)
            return false;
    return true;
}

// A list names photographs, whatever their names say, in the order that is wanted.
static relume_status take_listed(struct relume_photographs *out, const char *const *paths, int n)
{
    out->path = mem_zeroed((size_t)n, sizeof *out->path);
    out->count = out->path ? n : 0;
    bool good = out->path;
    for (int i = 0; good && i < n; i++)
        good = (out->path[i] = mem_text(paths[i])) != NULL;
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// Lists the photographs of the object. Photographs that were named one by one keep this order for a
// list of lights without names, unless it is the order in which a shell sorts them.
static relume_status list_object(struct acquisition *s, const char *const *paths, int n)
{
    struct relume_photographs *photos = &s->photographs;
    if (s->listed)
        return take_listed(photos, paths, n);
    relume_status status = list(photos, paths, n, 3, s->p.log);
    if (!status)
        status = list_pages(photos, s->p.log);
    if (status)
        return status;
    s->named_singly = n > 1;
    for (int i = 0; i < n; i++)
        s->named_singly &= input_kind(paths[i], s->p.log) != INPUT_FOLDER;
    if (s->named_singly && !are_sorted(photos, strcmp) && !are_sorted(photos, strcasecmp) &&
        !are_sorted(photos, strverscmp)) {
        s->given_index = mem_array((size_t)photos->count, sizeof *s->given_index);
        if (!s->given_index)
            return RELUME_ENOMEM;
    }
    return sort_photographs(photos, s->given_index);
}

static bool is_lp(const char *path)
{
    return strlen(path) > 3 && path_ends(path, ".lp");
}

// A list of lights that names its photographs is a capture already.
static relume_status refuse_list(const struct relume_log *log, const char *const *paths, int count)
{
    if (count != 1 || !is_lp(paths[0]))
        return RELUME_OK;
    const char *path = paths[0];
    const int folder = path_folder(path);
    return log_fail(log, RELUME_EUNFIT,
                    "%s: this lists lights and photographs, which encode and maps take as it is; "
                    "for capture give the photographs: relume capture %.*s --lights %s -o DIR",
                    path, folder ? folder - 1 : 1, folder ? path : ".", path);
}

// A list that no option names counts if it names one of the photographs, or has a light for each.
static relume_status fits(bool *out, const struct acquisition *s, const char *path)
{
    const int n = s->photographs.count;
    struct loaded_lights list;
    int matched = 0, *order = mem_array((size_t)n, sizeof *order);
    relume_status status = order ? loaded_lights_load(&list, path, false, NULL) : RELUME_ENOMEM;
    *out = false;
    if (!status) {
        const struct light_names names = loaded_lights_names(&list, path);
        const relume_status paired = light_names_pair(
            order, &matched, &names, (const char *const *)s->photographs.path, n, NULL);
        *out = matched || paired == RELUME_EUNFIT || list.lights.count == n;
        status = paired;
        loaded_lights_free(&list);
    }
    mem_free(order);
    return status == RELUME_ENOMEM ? status : RELUME_OK;
}

// A list of lights in the folder whose name has `length` bytes.
static relume_status find_lights_in(struct acquisition *s, const char *folder, int length)
{
    static const char *const names[] = {"light_directions.txt", "lights.txt", "lights.lp",
                                        "dirs.lp"};
    bool found = false;
    relume_status status = RELUME_OK;
    for (size_t i = 0; !status && !found && i < sizeof names / sizeof *names; i++) {
        snprintf(s->likely_lights, sizeof s->likely_lights, "%.*s%s", length, folder, names[i]);
        status = fits(&found, s, s->likely_lights);
    }
    if (!found)
        *s->likely_lights = '\0';
    return status;
}

// Beside photographs that are named one by one; data sets of several objects keep one list above
// their folders.
static relume_status find_likely_lights(struct acquisition *s)
{
    const char *const first = s->photographs.path[0];
    int length = path_folder(first);
    const relume_status status = find_lights_in(s, first, length);
    if (status || *s->likely_lights || !length)
        return status;
    do
        length--;
    while (length > 0 && first[length - 1] != '/');
    return find_lights_in(s, first, length);
}

// The option that describes balls, or NULL.
static const char *ball_option(const struct relume_acquire_params *p)
{
    return p->ball                    ? "--ball"
           : p->ball_photograph_count ? "--ball-photos"
           : p->ball_mask             ? "--ball-mask"
           : p->balls                 ? "--balls"
           : p->matte                 ? "--matte"
                                      : NULL;
}

static bool is_table(const char *path)
{
    return path_ends(path, ".txt") || path_ends(path, ".csv");
}

// The file of lights that lies with the photographs, if it has a light for them.
static relume_status take_lights_beside(struct acquisition *s)
{
    const char *beside = s->photographs.lights;
    bool good = true;
    if (!beside)
        return RELUME_OK;
    const relume_status status = is_table(beside) ? fits(&good, s, beside) : RELUME_OK;
    if (status)
        return status;
    if (good)
        s->p.lights = beside;
    log_line(s->p.log, RELUME_NOTE,
             good ? "%s: light directions are taken from this file; --ball or --ball-photos take "
                    "them from a mirror ball instead"
                  : "%s: is not read; as light directions it would have a line x y z for each of "
                    "the %d photographs",
             beside, s->photographs.count);
    return RELUME_OK;
}

static relume_status choose_lights(struct acquisition *s)
{
    const char *ball = ball_option(&s->p);
    if (s->p.lights && ball)
        return acquire_warn(s, "--lights is given, so %s is not used", ball);
    const relume_status status = s->p.lights || ball ? RELUME_OK : take_lights_beside(s);
    return status || s->p.lights ? status : find_likely_lights(s);
}

relume_status acquire_find_inputs(struct acquisition *s, const char *const *paths, int count)
{
    struct relume_acquire_params *p = &s->p;
    relume_status status = refuse_list(p->log, paths, count);
    if (!status)
        status = list_object(s, paths, count);
    if (!status && p->ball_photograph_count)
        status = list_sorted(&s->balls, p->ball_photographs, p->ball_photograph_count, p->log);
    if (!status && p->flat_count)
        status = list_sorted(&s->flats, p->flats, p->flat_count, p->log);
    if (!status)
        status = choose_lights(s);
    if (status)
        return status;
    p->mask = p->mask ? p->mask : s->photographs.mask;
    p->ball_mask = p->ball_mask ? p->ball_mask : s->balls.mask;
    return RELUME_OK;
}
