// objects_find.c - which of the folders that were named are objects, and what their captures are
// called
#include "capture/objects/objects.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/tree.h"

#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

// ---------------------------------------------------------------- many or one

// Returns the number of photographs among files, and the first one's path.
static int count_photographs(char first[256], const char *const *files, int n)
{
    struct relume_photographs list = {0};
    // relume_photographs_list takes any file that is named alone.
    const char *one[] = {n ? files[0] : NULL, n ? files[0] : NULL};
    const relume_status status = relume_photographs_list(
        &list, n == 1 ? one : files, n == 1 ? 2 : n, relume_photographs_params(.quiet = true));
    const int count = status ? 0 : n == 1 ? list.count / 2 : list.count;
    snprintf(first, 256, "%s", count ? list.path[0] : "");
    relume_photographs_free(&list);
    return count;
}

relume_status relume_capture_find_objects(bool *many, const char *const *paths, int count,
                                          const struct relume_log *log)
{
    const char **file = mem_array((size_t)count, sizeof *file);
    int files = 0, folders = 0;
    const char *folder = NULL;
    bool all_there = true;
    char first[256];
    *many = false;
    if (!file)
        return RELUME_ENOMEM;
    for (int i = 0; i < count; i++) {
        const enum input_kind kind = input_kind(paths[i], log);
        all_there &= kind != INPUT_NONE;
        if (kind == INPUT_FOLDER) {
            folder = folder ? folder : paths[i];
            folders++;
        } else {
            file[files++] = paths[i];
        }
    }
    relume_status status = RELUME_OK;
    const int photographs = folders > 1 && all_there ? count_photographs(first, file, files) : 0;
    *many = folders > 1 && all_there && !photographs;
    if (photographs)
        status =
            log_fail(log, RELUME_EINVAL,
                     "%d folders and %d photograph%s (%s); expected folders alone (*/ in a shell), "
                     "each an object, or photographs of one object, as %s/*",
                     folders, photographs, relume_plural(photographs), first, folder);
    mem_free(file);
    return status;
}

// ---------------------------------------------------------------- which folders

static bool is_same(const char *a, const char *b)
{
    struct stat s, t;
    return a && b && !stat(a, &s) && !stat(b, &t) && s.st_dev == t.st_dev && s.st_ino == t.st_ino;
}

static bool is_among(const char *path, const char *const *list, int n)
{
    for (int i = 0; i < n; i++)
        if (is_same(path, list[i]))
            return true;
    return false;
}

static bool is_named_by(const struct relume_acquire_params *p, const char *path)
{
    return is_among(path, p->ball_photographs, p->ball_photograph_count) ||
           is_among(path, p->flats, p->flat_count) || is_same(path, p->lights);
}

static bool has_photographs(const char *folder)
{
    struct relume_photographs list;
    const relume_status status =
        relume_photographs_list(&list, &folder, 1, relume_photographs_params(.quiet = true));
    const bool some = !status && list.count > 0;
    relume_photographs_free(&list);
    return some;
}

static bool is_known(const struct relume_captured_objects *objects, const char *path)
{
    for (int i = 0; i < objects->count; i++)
        if (is_same(objects->object[i].photographs, path))
            return true;
    return false;
}

// Returns why no object is made of a folder; NULL: it is one.
static const char *why_none(const struct relume_captured_objects *out, const char *dir,
                            const char *path, const struct relume_acquire_params *each)
{
    return is_known(out, path)       ? "it is named twice"
           : is_same(path, dir)      ? "the captures are made in it"
           : is_named_by(each, path) ? "an option names it"
           : object_is_capture(path) ? "it is a capture already"
                                     : NULL;
}

static relume_status take_folder(struct relume_captured_objects *out, const char *path)
{
    if (!mem_grow(&out->object, (size_t)out->count, sizeof *out->object))
        return RELUME_ENOMEM;
    size_t n = strlen(path);
    while (n > 1 && path[n - 1] == '/')
        n--;
    struct relume_captured_object *o = &out->object[out->count++];
    *o = (struct relume_captured_object){.photographs = mem_format("%.*s", (int)n, path),
                                         .status = RELUME_ECANCEL};
    return o->photographs ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status sort_out(struct relume_captured_objects *out, const char *dir,
                              const char *const *inputs, int count,
                              const struct relume_acquire_params *each,
                              const struct relume_log *log)
{
    char names[160] = "";
    int files = 0;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < count; i++) {
        const size_t n = strlen(names);
        if (!tree_is_folder(inputs[i])) {
            if (files++ < 3)
                snprintf(names + n, sizeof names - n, "%s%.50s", n ? ", " : "",
                         path_name(inputs[i]));
            continue;
        }
        const char *why = why_none(out, dir, inputs[i], each);
        if (why)
            log_line(log, RELUME_NOTE, "%s: left out: %s", inputs[i], why);
        else
            status = take_folder(out, inputs[i]);
    }
    if (files > 3)
        log_line(log, RELUME_NOTE, "left out, no folders: %s and %d more", names, files - 3);
    else if (files)
        log_line(log, RELUME_NOTE, "left out, no folder%s: %s", relume_plural(files), names);
    return status;
}

// ---------------------------------------------------------------- names

// Returns the folder's own name, also of "." and "..".
static char *own_name(const char *folder)
{
    const char *name = path_name(folder);
    if (*name && strcmp(name, ".") && strcmp(name, ".."))
        return mem_text(name);
    char *whole = realpath(folder, NULL);
    char *own = mem_text(whole && *path_name(whole) ? path_name(whole) : "object");
    mem_free_libc(whole);
    return own;
}

// File systems of cameras and of Windows take names of either case for one.
static bool is_taken(const struct relume_captured_objects *objects, int count, const char *name)
{
    bool taken = !strcasecmp(name, "report.html");
    for (int i = 0; !taken && i < count; i++)
        taken = !strcasecmp(objects->object[i].name, name);
    return taken;
}

// Numbers the second folder of a name, by a number that no folder has by itself.
static relume_status make_name_single(struct relume_captured_objects *out, int i,
                                      const struct relume_log *log)
{
    struct relume_captured_object *o = &out->object[i];
    char *own = o->name, *name = own;
    for (int k = 2; name && is_taken(out, name == own ? i : out->count, name); k++) {
        if (name != own)
            mem_free(name);
        name = mem_format("%s-%d", own, k);
    }
    o->name = name ? name : own;
    if (!name)
        return RELUME_ENOMEM;
    if (name != own) {
        log_line(log, RELUME_NOTE, "%s: another folder has this name; its capture is called %s",
                 o->photographs, name);
        mem_free(own);
    }
    return RELUME_OK;
}

static relume_status name_objects(struct relume_captured_objects *out, const char *dir,
                                  const struct relume_log *log)
{
    relume_status status = RELUME_OK;
    for (int i = 0; i < out->count; i++)
        if (!(out->object[i].name = own_name(out->object[i].photographs)))
            status = RELUME_ENOMEM;
    for (int i = 0; !status && i < out->count; i++)
        status = make_name_single(out, i, log);
    for (int i = 0; !status && i < out->count; i++)
        if (!(out->object[i].path = mem_format("%s/%s", dir, out->object[i].name)))
            status = RELUME_ENOMEM;
    return status;
}

// ---------------------------------------------------------------- all

// Refuses outputs among the photographs.
static relume_status check_places(const struct relume_captured_objects *out, const char *dir,
                                  const char *const *inputs, int count,
                                  const struct relume_log *log)
{
    if (is_among(dir, inputs, count) && has_photographs(dir))
        return log_fail(log, RELUME_EINVAL,
                        "%s: holds photographs itself; expected another folder for the captures",
                        dir);
    for (int i = 0; i < out->count; i++)
        if (is_known(out, out->object[i].path))
            return log_fail(log, RELUME_EINVAL,
                            "%s: holds photographs, and the capture %s would take its place; "
                            "expected another folder than %s",
                            out->object[i].path, out->object[i].name, dir);
    if (!out->count)
        return log_fail(log, RELUME_ENOTFOUND,
                        "%s: no folder of photographs is left; expected some", inputs[0]);
    return RELUME_OK;
}

relume_status objects_find(struct relume_captured_objects *out, const char *dir,
                           const char *const *inputs, int count,
                           const struct relume_acquire_params *each, const struct relume_log *log)
{
    relume_status status = sort_out(out, dir, inputs, count, each, log);
    if (!status)
        status = name_objects(out, dir, log);
    return status ? status : check_places(out, dir, inputs, count, log);
}

static bool is_path_of(const struct relume_captured_objects *known, const char *path)
{
    for (int i = 0; i < known->count; i++)
        if (is_same(known->object[i].path, path))
            return true;
    return false;
}

// One that cannot be read is passed over.
static relume_status add_earlier(struct relume_captured_objects *out, const char *dir,
                                 const char *name)
{
    relume_status status = take_folder(out, "");
    if (status)
        return status;
    struct relume_captured_object *o = &out->object[out->count - 1];
    o->name = mem_text(name);
    o->path = mem_format("%s/%s", dir, name);
    o->kept = true;
    o->status = o->name && o->path ? object_recall(o, NULL) : RELUME_ENOMEM;
    if (o->status && o->status != RELUME_ENOMEM) {
        mem_free(o->name);
        mem_free(o->path);
        mem_free(o->photographs);
        out->count--;
        return RELUME_OK;
    }
    return o->status;
}

relume_status objects_find_earlier(struct relume_captured_objects *out, const char *dir,
                                   const struct relume_captured_objects *known)
{
    struct dirent **entry;
    const int n = scandir(dir, &entry, NULL, alphasort);
    relume_status status = RELUME_OK;
    for (int i = 0; i < n; i++) {
        const char *name = entry[i]->d_name;
        char *path = mem_format("%s/%s", dir, name);
        if (!path)
            status = RELUME_ENOMEM;
        if (!status && *name != '.' && object_is_capture(path) && !is_path_of(known, path))
            status = add_earlier(out, dir, name);
        mem_free(path);
        mem_free_libc(entry[i]);
    }
    if (n >= 0)
        mem_free_libc(entry);
    return status;
}
