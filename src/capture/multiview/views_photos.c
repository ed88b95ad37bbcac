// views_photos.c - what was named on the command line becomes cameras and their photographs
#include "capture/multiview/views.h"

#include "capture/manifest/manifest.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outdir.h"
#include "core/base/tree.h"
#include "image/image/photograph.h"

#include <errno.h>
#include <libgen.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void photo_set_free(struct photo_set *set)
{
    arena_free(&set->arena);
    *set = (struct photo_set){0};
}

// What was named, in the arena.
static relume_status list_photographs(const char ***out, int *count, struct arena *arena,
                                      const char *const *paths, int n, bool cameras, bool quiet,
                                      const struct relume_log *log)
{
    struct relume_photographs list;
    const relume_status status = relume_photographs_list(
        &list, paths, n, relume_photographs_params(.log = log, .folders = cameras, .quiet = quiet));
    if (status)
        return status;
    *count = list.count;
    *out = arena_array(arena, (size_t)list.count, sizeof **out);
    for (int i = 0; *out && i < list.count; i++)
        if (!((*out)[i] = arena_text(arena, list.path[i])))
            *out = NULL;
    relume_photographs_free(&list);
    return *out ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status list_lights(struct photo_set *set, int index, const char *name,
                                 const struct relume_log *log)
{
    struct camera_photos *c = &set->camera[index];
    int n = 1;
    relume_status status = RELUME_OK;
    c->name = arena_text(&set->arena, name);
    if (tree_is_folder(name)) {
        status = list_photographs(&c->images, &n, &set->arena, &name, 1, false, index > 0, log);
    } else {
        c->images = arena_array(&set->arena, 1, sizeof *c->images);
        if (c->images)
            c->images[0] = c->name;
    }
    if (!status && (!c->name || !c->images))
        status = RELUME_ENOMEM;
    if (status)
        return status;
    if (index == 0)
        set->lights = n;
    if (n == set->lights)
        return RELUME_OK;
    return log_fail(log, RELUME_EUNFIT, "%s: %d photograph%s; expected %d, one a light, as in %s",
                    name, n, relume_plural(n), set->lights, set->camera[0].name);
}

static relume_status check_size(struct photo_set *set, const char *path,
                                const struct relume_ingest_params *p)
{
    struct relume_exif notes;
    const relume_status status = photograph_notes(&notes, path, p->limits, p->log);
    if (status)
        return status;
    set->turned |= notes.orientation > 1;
    if (!set->width) {
        set->width = notes.width;
        set->height = notes.height;
    }
    if (notes.width == set->width && notes.height == set->height)
        return RELUME_OK;
    return log_fail(p->log, RELUME_EUNFIT,
                    "%s: %d x %d pixels; expected %d x %d as in the other photographs", path,
                    notes.width, notes.height, set->width, set->height);
}

static relume_status check_sizes(struct photo_set *set, const struct relume_ingest_params *p)
{
    for (int i = 0; i < set->count; i++)
        for (int k = 0; k < set->lights; k++) {
            const relume_status status = check_size(set, set->camera[i].images[k], p);
            if (status)
                return status;
            if (!log_progress(p->log, "checking", (i + 1.0) / set->count))
                return RELUME_ECANCEL;
        }
    return RELUME_OK;
}

static relume_status check_lights(struct photo_set *set, const struct relume_ingest_params *p)
{
    static const struct relume_vec3 front = {0.0, 0.0, 1.0};
    set->directions = p->lights ? p->lights : &front;
    const int known = p->lights ? p->light_count : 1;
    if (known == set->lights)
        return RELUME_OK;
    return log_fail(p->log, p->lights ? RELUME_EUNFIT : RELUME_EINVAL,
                    "%s: %d photograph%s of this camera; expected %d, one for every known light%s",
                    set->camera[0].name, set->lights, relume_plural(set->lights), known,
                    p->lights ? "" : " (give the lights with --lights)");
}

relume_status photo_set_open(struct photo_set *out, const char *const *photos, int n,
                             const struct relume_ingest_params *p)
{
    *out = (struct photo_set){0};
    const char **listed;
    relume_status status =
        list_photographs(&listed, &n, &out->arena, photos, n, true, false, p->log);
    if (!status && !(out->camera = arena_array(&out->arena, (size_t)n, sizeof *out->camera)))
        status = RELUME_ENOMEM;
    out->count = n;
    for (int i = 0; !status && i < n; i++)
        status = list_lights(out, i, listed[i], p->log);
    if (!status)
        status = check_lights(out, p);
    if (!status)
        status = check_sizes(out, p);
    if (status)
        photo_set_free(out);
    return status;
}

relume_status photo_load(struct relume_image *out, const struct photo_set *set, int camera,
                         int light, const struct relume_ingest_params *p)
{
    return relume_photograph_load(
        out, NULL, set->camera[camera].images[light],
        relume_photograph_params(.log = p->log, .limits = p->limits, .transfer = p->transfer));
}

// ---------------------------------------------------------------- paths

// Absolute, without links; of a path that does not exist yet its folder must.
static char *resolve(const char *path)
{
    char *whole = mem_take(realpath(path, NULL));
    if (whole)
        return whole;
    char *copy = mem_text(path), *again = mem_text(path);
    char *folder = copy && again ? mem_take(realpath(dirname(copy), NULL)) : NULL;
    if (folder)
        whole = mem_format("%s/%s", strcmp(folder, "/") ? folder : "", basename(again));
    mem_free(folder);
    mem_free(copy);
    mem_free(again);
    return whole;
}

static const char *relative(struct arena *arena, const char *from, const char *to)
{
    size_t common = 0, i = 0;
    for (; from[i] && from[i] == to[i]; i++)
        if (from[i] == '/')
            common = i + 1;
    if (!from[i] && to[i] == '/')
        return arena_text(arena, to + i + 1);
    const char *out = to + common;
    int ups = 1;
    for (const char *c = from + common; *c; c++)
        ups += *c == '/';
    for (; ups && out; ups--)
        out = arena_format(arena, "../%s", out);
    return out;
}

// A link to `target` (as the folder sees it) in the folder's photos/; NULL where the disk has none.
static const char *link_photo(struct arena *arena, const outdir *folder, const char *target)
{
    char *photos = mem_format("%s/photos", outdir_path(folder)), seen[PATH_MAX];
    const char *to = arena_format(arena, "../%s", target), *name = path_name(target);
    const char *out = NULL;
    bool more = photos && to && (!mkdir(photos, 0777) || errno == EEXIST);
    for (int n = 0; more; n++) {
        const char *inside = n ? arena_format(arena, "photos/%d_%s", n, name)
                               : arena_format(arena, "photos/%s", name);
        char *path = inside ? mem_format("%s/%s", outdir_path(folder), inside) : NULL;
        const bool made = path && !symlink(to, path);
        more = path && !made && errno == EEXIST;
        const ssize_t length = more ? readlink(path, seen, sizeof seen) : -1;
        const bool same =
            length == (ssize_t)strlen(to) && !strncmp(seen, to, (size_t)length);  // linked before
        if (made || same)
            out = inside;
        more = more && !same;
        mem_free(path);
    }
    mem_free(photos);
    return out;
}

const char *path_from(struct arena *arena, const outdir *folder, const char *dir, const char *file)
{
    char *from = resolve(dir), *to = resolve(file);
    const char *out = from && to ? relative(arena, from, to) : NULL;
    const char *linked = out && leaves_folder(out) ? link_photo(arena, folder, out) : NULL;
    mem_free(from);
    mem_free(to);
    return linked ? linked : out;
}

// ---------------------------------------------------------------- the folder

relume_status save_manifest(const outdir *dir, const struct relume_manifest *m,
                            const struct relume_log *log)
{
    char *path = mem_format("%s/capture.json", outdir_path(dir));
    const relume_status status = path ? relume_manifest_write(m, path, log) : RELUME_ENOMEM;
    mem_free(path);
    return status;
}

relume_status save_inside(const outdir *dir, const char *name, const struct relume_image *image,
                          bool half, const struct relume_log *log)
{
    char *path = mem_format("%s/%s", outdir_path(dir), name);
    const relume_status status =
        path ? relume_image_save(image, path, relume_image_params(.log = log, .half = half))
             : RELUME_ENOMEM;
    mem_free(path);
    return status;
}
