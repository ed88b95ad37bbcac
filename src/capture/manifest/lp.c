// lp.c - a list of lights that names its photographs (a .lp file of RTI) as a capture
#include "capture/manifest/light_list.h"
#include "capture/manifest/light_names.h"
#include "capture/manifest/manifest.h"
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/vec.h"

#include <dirent.h>
#include <errno.h>
#include <libgen.h>
#include <relume/image/photograph.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void draft_free(struct draft *draft)
{
    arena_free(&draft->arena);
    *draft = (struct draft){0};
}

bool direction_normalise(struct relume_vec3 *v)
{
    const double length = vec3_length(*v);
    if (!(length > 1e-4) || !isfinite(length))
        return false;
    *v = vec3_scale(*v, 1.0 / length);
    return true;
}

// A list, and the folder that it lies in.
struct listing {
    struct draft *d;
    struct light_list list;
    const char *path;
    char *folder;
    struct dirent **files;  // pictures in the folder, in the order of their names
    int file_count;
    bool project;
    const struct relume_capture_params *p;
};

// ---------------------------------------------------------------- files

static int is_image(const struct dirent *entry)
{
    return light_names_is_picture(entry->d_name);
}

static int by_name(const struct dirent **a, const struct dirent **b)
{
    return strverscmp((*a)->d_name, (*b)->d_name);
}

static bool is_separator(char c)
{
    return c == '/' || c == '\\';
}

// In a project of RTIBuilder the list and its photographs lie in two folders side by side:
// "C:\\...\\jpeg-exports\\a.jpg" is also "../jpeg-exports/a.jpg". NULL when it is not.
static char *find_beside(const struct listing *l, const char *listed)
{
    const char *name = light_names_base(listed), *end = name - 1, *start = end;
    if (name == listed)
        return NULL;
    while (start > listed && !is_separator(start[-1]))
        start--;
    if (start == end || *start == '.')
        return NULL;
    char *path =
        arena_format(&l->d->arena, "%s/../%.*s/%s", l->folder, (int)(end - start), start, name);
    return path && input_exists(path, l->p->log) ? path : NULL;
}

static char *in_folder(const struct listing *l, const char *name)
{
    return arena_format(&l->d->arena, "%s/%s", l->folder, name);
}

// Files of the folder take the lights of their names, whatever folder the list says: found[lights]
// becomes an index of a file. `found` is -1 for the names that are looked for.
static relume_status find_names(const struct listing *l, int *found)
{
    const int n = l->list.count;
    const char **name = mem_array((size_t)n, sizeof *name);
    const char **file = mem_array((size_t)l->file_count, sizeof *file);
    int *order = mem_array((size_t)l->file_count, sizeof *order);
    int *line = mem_array((size_t)n, sizeof *line), *light = mem_array((size_t)n, sizeof *light);
    struct light_names names = {
        .path = l->path, .name = name, .line = line, .numbered = l->list.numbered};
    relume_status status = name && file && order && line && light ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < n; i++)
        if (found[i] < 0) {
            name[names.count] = l->list.name[i];
            line[names.count] = l->list.line[i];
            light[names.count++] = i;
        }
    for (int i = 0; !status && i < l->file_count; i++)
        file[i] = l->files[i]->d_name;
    int matched = 0;
    if (!status && names.count)
        status = light_names_pair(order, &matched, &names, file, l->file_count, l->p->log);
    for (int i = 0; !status && matched && i < l->file_count; i++)
        if (order[i] >= 0)
            found[light[order[i]]] = i;
    mem_free(name);
    mem_free(file);
    mem_free(order);
    mem_free(line);
    mem_free(light);
    return status;
}

// found[lights] becomes the number of files where the listed path exists and is allowed, and -1
// elsewhere.
static relume_status find_paths(const struct listing *l, int *found)
{
    for (int i = 0; i < l->list.count; i++) {
        const char *listed = l->list.name[i];
        const char *path = *listed == '/' ? listed : in_folder(l, listed);
        if (!path)
            return RELUME_ENOMEM;
        l->d->view->images[i] = arena_text(&l->d->arena, path);
        if (!l->d->view->images[i])
            return RELUME_ENOMEM;
        const bool allowed = l->p->allow_outside || !leaves_folder(listed);
        found[i] = allowed && input_exists(path, l->p->log) ? l->file_count : -1;
    }
    return RELUME_OK;
}

static relume_status refuse_outside(const struct listing *l, int light)
{
    return log_fail(l->p->log, RELUME_ELIMIT,
                    "%s: names '%.200s', outside its folder; expected the image beside the "
                    ".lp file; if you trust it, --allow-outside",
                    l->path, l->list.name[light]);
}

// Tries the path itself, its base name in the folder, and the same in the folder beside. A path
// that leaves the folder, and the project that holds it, is refused where only that exists.
static relume_status find_files(const struct listing *l, int *missing)
{
    const char **images = l->d->view->images;
    int *found = mem_array((size_t)l->list.count, sizeof *found);
    relume_status status = found ? find_paths(l, found) : RELUME_ENOMEM;
    if (!status)
        status = find_names(l, found);
    *missing = 0;
    for (int i = 0; !status && i < l->list.count; i++) {
        if (found[i] >= 0) {
            if (found[i] < l->file_count && !(images[i] = in_folder(l, l->files[found[i]]->d_name)))
                status = RELUME_ENOMEM;
            continue;
        }
        const char *beside = find_beside(l, l->list.name[i]);
        if (beside ? !l->p->allow_outside && !l->project
                   : !l->p->allow_outside && input_exists(images[i], l->p->log))
            status = refuse_outside(l, i);
        images[i] = beside ? beside : images[i];
        *missing += !beside;
    }
    mem_free(found);
    return status;
}

// ---------------------------------------------------------------- what does not match

struct image {
    const char *path;
    int light;
};

static int by_path(const void *a, const void *b)
{
    const struct image *one = a, *two = b;
    const int order = strcmp(one->path, two->path);
    return order ? order : one->light - two->light;
}

// The lights' images sorted by their paths; NULL without memory.
static struct image *sort_images(const struct listing *l)
{
    struct image *sorted = mem_array((size_t)l->list.count, sizeof *sorted);
    for (int i = 0; sorted && i < l->list.count; i++)
        sorted[i] = (struct image){l->d->view->images[i], i};
    if (sorted)
        qsort(sorted, (size_t)l->list.count, sizeof *sorted, by_path);
    return sorted;
}

static bool is_listed(const struct image *sorted, int n, const char *path)
{
    int low = 0, high = n;
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (strcmp(sorted[middle].path, path) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low < n && !strcmp(sorted[low].path, path);
}

// The first photograph in the folder of `path` that no line lists: its name, or NULL.
static const char *find_unlisted(const struct listing *l, const struct image *sorted,
                                 const char *path)
{
    struct relume_photographs photos;
    char *copy = mem_text(path);
    const char *folder = copy ? dirname(copy) : NULL, *out = NULL;
    if (folder &&
        !relume_photographs_list(&photos, &folder, 1,
                                 relume_photographs_params(.quiet = true, .companions = true))) {
        for (int i = 0; !out && i < photos.count; i++)
            if (!is_listed(sorted, l->list.count, photos.path[i]))
                out = arena_text(&l->d->arena, light_names_base(photos.path[i]));
        relume_photographs_free(&photos);
    }
    mem_free(copy);
    return out;
}

static relume_status refuse_missing(const struct listing *l, int missing)
{
    const char **images = l->d->view->images;
    struct image *sorted = sort_images(l);
    int first = 0;
    if (!sorted)
        return RELUME_ENOMEM;
    while (first < l->list.count - 1 && input_exists(images[first], l->p->log))
        first++;
    const char *unlisted = find_unlisted(l, sorted, images[first]);
    mem_free(sorted);
    const bool one = missing == 1;
    return log_fail(l->p->log, RELUME_ENOTFOUND,
                    "%s: image '%.200s' does not exist; %d of %d images %s missing; "
                    "--skip-missing continues without %s%s%s%s",
                    l->path, l->list.name[first], missing, l->list.count, one ? "is" : "are",
                    one ? "it" : "them", unlisted ? "; no line lists '" : "",
                    unlisted ? unlisted : "", unlisted ? "'" : "");
}

// A photograph under two lights replaces one that is not listed.
static relume_status check_twice(const struct listing *l)
{
    struct image *sorted = sort_images(l);
    int k = 1;
    if (!sorted)
        return RELUME_ENOMEM;
    while (k < l->list.count && strcmp(sorted[k].path, sorted[k - 1].path))
        k++;
    relume_status status = RELUME_OK;
    if (k < l->list.count) {
        const char *path = sorted[k].path, *unlisted = find_unlisted(l, sorted, path);
        const int a = l->list.line[sorted[k - 1].light], b = l->list.line[sorted[k].light];
        if (unlisted)
            status = log_fail(l->p->log, RELUME_EUNFIT,
                              "%s: '%s' is listed in lines %d and %d; '%s' is never listed",
                              l->path, light_names_base(path), a, b, unlisted);
        else
            log_line(l->p->log, RELUME_WARNING,
                     "%s: '%s' is listed in lines %d and %d; it counts as one photograph under "
                     "each of these lights",
                     l->path, light_names_base(path), a, b);
    }
    mem_free(sorted);
    return status;
}

// ---------------------------------------------------------------- pairing

static relume_status take_in_order(const struct listing *l)
{
    const bool named = l->list.name && !l->list.numbered;
    if (l->file_count != l->list.count)
        return log_fail(l->p->log, RELUME_EUNFIT,
                        "%s: names no photographs, and has %d lights; expected %d, as photographs "
                        "in its folder",
                        l->path, l->list.count, l->file_count);
    log_line(l->p->log, named ? RELUME_WARNING : RELUME_NOTE,
             "%s: %s; the %d images of the folder are taken in the order of their names", l->path,
             named ? "none of the listed images exists" : "names no photographs", l->file_count);
    for (int i = 0; i < l->file_count; i++)
        if (!(l->d->view->images[i] = in_folder(l, l->files[i]->d_name)))
            return RELUME_ENOMEM;
    return RELUME_OK;
}

static relume_status find_images(const struct listing *l)
{
    int missing = l->list.count;
    relume_status status = l->list.name ? find_files(l, &missing) : RELUME_OK;
    if (status)
        return status;
    const bool index = !l->list.name || l->list.numbered;
    if (missing == l->list.count && (index || l->file_count == missing))
        return take_in_order(l);
    l->d->turns = true;
    return missing && !l->p->skip_missing ? refuse_missing(l, missing) : check_twice(l);
}

static relume_status make_draft(const struct listing *l)
{
    struct draft *d = l->d;
    const size_t n = (size_t)l->list.count;
    d->directions = arena_array(&d->arena, n, sizeof *d->directions);
    d->view = arena_array(&d->arena, 1, sizeof *d->view);
    if (!d->directions || !d->view ||
        !(d->view->images = arena_array(&d->arena, n, sizeof(char *))))
        return RELUME_ENOMEM;
    memcpy(d->directions, l->list.direction, n * sizeof *d->directions);
    d->m = (struct relume_manifest){
        .geometry = relume_geometry_default(RELUME_PLANAR, 1, 1),
        .lights = l->list.count,
        .directions = d->directions,
        .views = 1,
        .view = d->view,
    };
    return RELUME_OK;
}

static relume_status list_folder(struct listing *l)
{
    const int found = scandir(l->folder, &l->files, is_image, by_name);
    l->file_count = found > 0 ? found : 0;
    return found < 0 && errno != ENOENT
               ? relume_input_fail(l->p->log, l->folder, "cannot be listed", errno)
               : RELUME_OK;
}

relume_status lp_open(struct draft *out, const char *path, bool project,
                      const struct relume_capture_params *params)
{
    struct listing l = {.d = out, .path = path, .project = project, .p = params};
    char *copy = mem_text(path);
    *out = (struct draft){0};
    relume_status status =
        copy ? light_list_read(&l.list, path, params->limits, params->log) : RELUME_ENOMEM;
    if (!status) {
        l.folder = dirname(copy);
        status = make_draft(&l);
    }
    if (!status)
        status = list_folder(&l);
    if (!status)
        status = find_images(&l);
    out->listed = true;
    if (status)
        draft_free(out);
    for (int i = 0; i < l.file_count; i++)
        mem_free_libc(l.files[i]);
    mem_free_libc(l.files);
    light_list_free(&l.list);
    mem_free(copy);
    return status;
}
