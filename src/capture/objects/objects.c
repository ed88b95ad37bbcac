// objects.c - one capture after the other, each of the photographs of one folder
#include "capture/objects/objects.h"

#include "core/base/infile.h"
#include "core/base/inventory.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/tree.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct run {
    struct relume_capture_objects_params p;
    struct relume_acquire_params each;
    char *dir;          // without slashes at its end
    const char **file;  // [files] names that may be added to an object's folder
    int files;
    struct relume_captured_objects *out, earlier;
    relume_making *scratch;
    struct objects_page page;
};

void relume_captured_objects_destroy(struct relume_captured_objects *objects)
{
    for (int i = 0; i < objects->count; i++) {
        struct relume_captured_object *o = &objects->object[i];
        mem_free(o->name);
        mem_free(o->photographs);
        mem_free(o->path);
        mem_free(o->reason);
        relume_acquisition_destroy(&o->capture);
    }
    mem_free(objects->object);
    *objects = (struct relume_captured_objects){0};
}

// ---------------------------------------------------------------- sentences

// The log of an object: its name begins sentences, and the first error is kept as the reason.
struct object_log {
    struct relume_log log;
    const struct relume_log *to;
    struct relume_captured_object *object;
};

static void on_message(void *user, enum relume_level level, const char *text)
{
    const struct object_log *own = user;
    struct relume_captured_object *o = own->object;
    if (level != RELUME_ERROR)
        log_line(own->to, level, "%s: %s", o->name, text);
    else if (!o->reason)
        o->reason = mem_text(text);
}

static bool on_progress(void *user, const char *what, double done)
{
    const struct object_log *own = user;
    return log_progress(own->to, what, done);
}

static const struct relume_log *object_log(struct object_log *own,
                                           struct relume_captured_object *object,
                                           const struct relume_log *to)
{
    *own = (struct object_log){.to = to, .object = object};
    own->log = to ? *to : (struct relume_log){0};
    own->log.message = on_message;
    own->log.progress = on_progress;
    own->log.user = own;
    return &own->log;
}

static void say_made(const struct run *r, const struct relume_captured_object *o)
{
    const struct relume_acquisition *a = &o->capture;
    char error[64] = "", left_out[64] = "", warnings[64] = "";
    if (a->direction_error_deg > 0.0)
        snprintf(error, sizeof error, ", directions to about %.2f degrees", a->direction_error_deg);
    if (a->left_out)
        snprintf(left_out, sizeof left_out, ", %d photograph%s left out", a->left_out,
                 relume_plural(a->left_out));
    if (a->warnings)
        snprintf(warnings, sizeof warnings, ", %d warning%s", a->warnings,
                 relume_plural(a->warnings));
    log_line(r->p.log, RELUME_NOTE, "%s (%d of %d): %d lights%s%s%s", o->name,
             (int)(o - r->out->object) + 1, r->out->count, a->lights, error, left_out, warnings);
}

static void say_object(const struct run *r, const struct relume_captured_object *o)
{
    const int number = (int)(o - r->out->object) + 1;
    if (o->status && o->status != RELUME_ECANCEL)
        log_line(r->p.log, RELUME_ERROR, "%s (%d of %d): %s: %s", o->name, number, r->out->count,
                 o->capture.lights ? "failed" : "not made", o->reason);
    else if (!o->status && o->kept)
        log_line(r->p.log, RELUME_NOTE, "%s (%d of %d): is there already; --force makes it again",
                 o->name, number, r->out->count);
    else if (!o->status)
        say_made(r, o);
}

// Names the objects that failed, as many as a line holds.
static void say_failed(const struct run *r, int failed)
{
    char names[400] = "";
    int named = 0;
    for (int i = 0; i < r->out->count; i++) {
        const struct relume_captured_object *o = &r->out->object[i];
        const size_t n = strlen(names);
        if (!o->status || o->status == RELUME_ECANCEL || n + strlen(o->name) + 3 > sizeof names)
            continue;
        snprintf(names + n, sizeof names - n, "%s%s", n ? ", " : "", o->name);
        named++;
    }
    log_line(r->p.log, RELUME_ERROR, "%s: %d of %d objects failed: %s%s; see report.html there",
             r->dir, failed, r->out->count, names, named < failed ? " and others" : "");
}

// Says how many objects are there, and returns the first status of a failure.
static relume_status finish(const struct run *r, relume_status status)
{
    int made = 0, kept = 0, failed = 0;
    if (status && status != RELUME_ECANCEL)
        return status;
    for (int i = 0; i < r->out->count; i++) {
        const struct relume_captured_object *o = &r->out->object[i];
        made += !o->status;
        kept += !o->status && o->kept;
        failed += o->status && o->status != RELUME_ECANCEL;
        status = status ? status : o->status;
    }
    if (made + failed < r->out->count)
        log_line(r->p.log, RELUME_NOTE,
                 "%s: %d of %d objects are made; the same command makes the others", r->dir, made,
                 r->out->count);
    else if (failed)
        say_failed(r, failed);
    else if (kept)
        log_line(r->p.log, RELUME_NOTE,
                 "%s: %d object%s, %d of them there already; see report.html there", r->dir, made,
                 relume_plural(made), kept);
    else
        log_line(r->p.log, RELUME_NOTE, "%s: %d object%s; see report.html there", r->dir, made,
                 relume_plural(made));
    return status;
}

// ---------------------------------------------------------------- one object

static bool has_file(const struct relume_captured_object *o, const char *name)
{
    char *path = mem_format("%s/%s", o->path, name);
    const bool there = path && !access(path, F_OK);
    mem_free(path);
    return there;
}

// Puts a by-product into the object's folder; one that is there is left as it is.
static relume_status place(char **path, const struct relume_captured_object *o, const char *name)
{
    if (!name || (o->kept && has_file(o, name)))
        return RELUME_OK;
    *path = mem_format("%s/%s", o->path, name);
    return *path ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status capture_object(struct relume_captured_object *o,
                                    const struct relume_acquire_params *p)
{
    relume_status status = RELUME_OK;
    if (o->kept) {
        status = object_recall(o, p->log);
        return status ? status : acquire_write_products_of(o->path, p);
    }
    status = relume_capture_photographs(o->path, (const char *const *)&o->photographs, 1, p,
                                        &o->capture);
    // By-products may fail where the capture is there.
    if (status && object_is_capture(o->path))
        (void)object_recall(o, NULL);
    return status;
}

static relume_status make_capture(const struct run *r, struct relume_captured_object *o,
                                  const struct relume_log *log)
{
    struct relume_acquire_params p = r->each;
    char *normals = NULL, *albedo = NULL, *height = NULL;
    relume_status status = place(&normals, o, r->each.normals);
    if (!status)
        status = place(&albedo, o, r->each.albedo);
    if (!status)
        status = place(&height, o, r->each.height);
    p.log = log;
    p.normals = normals;
    p.albedo = albedo;
    p.height = height;
    p.width_mm = height ? p.width_mm : 0.0;
    if (!status)
        status = capture_object(o, &p);
    mem_free(normals);
    mem_free(albedo);
    mem_free(height);
    return status;
}

// Fills had[files] by what is in an object's folder. Returns the folder's number, 0: not there.
static ino_t look_before(const struct run *r, const struct relume_captured_object *o, bool *had)
{
    struct stat s;
    for (int i = 0; i < r->files; i++)
        had[i] = has_file(o, r->file[i]);
    return stat(o->path, &s) ? 0 : s.st_ino;
}

// Enters files that were added to the folder: `old` with the files `had`, or a new one.
static relume_status list_files(const struct run *r, const struct relume_captured_object *o,
                                ino_t old, const bool *had, const struct relume_log *log)
{
    struct stat s;
    const bool is_old = !stat(o->path, &s) && s.st_ino == old;
    for (int i = 0; i < r->files; i++)
        if (!(is_old && had[i]) && has_file(o, r->file[i]) && !inventory_add(o->path, r->file[i]))
            return log_fail(log, RELUME_EIO, "%s: its list .relume cannot be written; %s", o->path,
                            strerror(errno));
    return RELUME_OK;
}

// A reason belongs to an object that failed.
static relume_status give_reason(const struct run *r, struct relume_captured_object *o)
{
    const bool failed = o->status && o->status != RELUME_ECANCEL;
    if (failed && !o->reason)
        o->reason = mem_text(relume_status_text(o->status));
    if (!failed && o->reason) {
        log_line(r->p.log, RELUME_ERROR, "%s: %s", o->name, o->reason);
        mem_free(o->reason);
        o->reason = NULL;
    }
    return failed && !o->reason ? RELUME_ENOMEM : RELUME_OK;
}

static relume_status make_object(const struct run *r, struct relume_captured_object *o)
{
    struct object_log own;
    const struct relume_log *log = object_log(&own, o, r->p.log);
    bool *had = mem_array((size_t)r->files, sizeof *had);
    if (!had)
        return RELUME_ENOMEM;
    o->kept = !r->each.force && object_is_capture(o->path);
    const ino_t old = look_before(r, o, had);
    o->status = make_capture(r, o, log);
    if (!o->status && r->p.follow)
        o->status = r->p.follow(r->p.user, o, log);
    if (o->capture.lights) {
        const relume_status listed = list_files(r, o, old, had, log);
        o->status = o->status ? o->status : listed;
    }
    mem_free(had);
    return give_reason(r, o);
}

// ---------------------------------------------------------------- the page

static relume_status make_entry(struct run *r, int i, const struct relume_captured_object *o)
{
    r->page.entry[i] = object_entry(o, relume_making_path(r->scratch), r->p.log);
    return r->page.entry[i] ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status open_page(struct run *r)
{
    relume_status status = objects_find_earlier(&r->earlier, r->dir, r->out);
    const int count = r->out->count + r->earlier.count;
    r->page = (struct objects_page){.dir = r->dir,
                                    .objects = r->out,
                                    .earlier = &r->earlier,
                                    .entry = mem_zeroed((size_t)count, sizeof *r->page.entry)};
    if (!status && !r->page.entry)
        status = RELUME_ENOMEM;
    if (!status)
        status = relume_making_open(&r->scratch, NULL, RELUME_MADE_FOLDER, false, r->p.log);
    for (int i = 0; !status && i < r->earlier.count; i++)
        status = make_entry(r, r->out->count + i, &r->earlier.object[i]);
    return status;
}

static void close_page(struct run *r)
{
    for (int i = 0; r->page.entry && i < r->out->count + r->earlier.count; i++)
        mem_free(r->page.entry[i]);
    mem_free(r->page.entry);
    relume_making_abort(&r->scratch);
    relume_captured_objects_destroy(&r->earlier);
}

static relume_status make_all(struct run *r)
{
    relume_status status = open_page(r);
    for (int i = 0; !status && i < r->out->count; i++) {
        struct relume_captured_object *o = &r->out->object[i];
        status = make_object(r, o);
        say_object(r, o);
        if (!status && o->status != RELUME_ECANCEL)
            status = make_entry(r, i, o);
        if (!status)
            status = objects_page_write(&r->page, r->p.log);
        if (!status && o->status == RELUME_ECANCEL)
            status = RELUME_ECANCEL;
    }
    close_page(r);
    return finish(r, status);
}

// ---------------------------------------------------------------- before the first

static relume_status check_name(const char *name, const struct relume_log *log)
{
    static const char *const own[] = {"capture.json", "report.html", "lights.lp", "lights.svg",
                                      "mask.exr",     ".relume",     ".",         ".."};
    bool taken = !strncmp(name, "light", 5) && name[5] >= '0' && name[5] <= '9';
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        taken = taken || !strcmp(name, own[i]);
    if (strchr(name, '/'))
        return log_fail(log, RELUME_EINVAL,
                        "%s: of many objects each has this file in its own folder; expected a name "
                        "without folder, as %s",
                        name, path_name(name));
    if (taken || !*name)
        return log_fail(log, RELUME_EINVAL,
                        "%s: is a name of the capture itself; expected another name", name);
    return RELUME_OK;
}

static relume_status list_names(struct run *r)
{
    const char *const product[] = {r->each.normals, r->each.albedo, r->each.height};
    relume_status status = RELUME_OK;
    r->file = mem_array((size_t)r->p.file_count + 3, sizeof *r->file);
    if (!r->file)
        return RELUME_ENOMEM;
    for (int i = 0; i < 3; i++)
        if (product[i])
            r->file[r->files++] = product[i];
    for (int i = 0; i < r->p.file_count; i++)
        r->file[r->files++] = r->p.files[i];
    for (int i = 0; !status && i < r->files; i++)
        status = check_name(r->file[i], r->p.log);
    return status;
}

static relume_status check_there(const char *path, const struct relume_log *log)
{
    if (!path || input_kind(path, log) != INPUT_NONE)
        return RELUME_OK;
    return relume_input_fail(log, path, "cannot be opened", ENOENT);
}

// Checks once what holds for every object.
static relume_status check_each(const struct run *r)
{
    const struct relume_acquire_params *p = &r->each;
    const struct relume_log *log = r->p.log;
    const bool in_photographs = p->target && !strcmp(p->target, "auto");
    const char *const single[] = {p->lights, p->mask, p->ball_mask,
                                  in_photographs ? NULL : p->target, p->target_values};
    relume_status status = acquire_check_params(p);
    for (size_t i = 0; !status && i < sizeof single / sizeof *single; i++)
        status = check_there(single[i], log);
    for (int i = 0; !status && i < p->ball_photograph_count; i++)
        status = check_there(p->ball_photographs[i], log);
    for (int i = 0; !status && i < p->flat_count; i++)
        status = check_there(p->flats[i], log);
    return status;
}

// A folder that is there holds the captures of an earlier run, or has other things in it.
static relume_status check_folder(const struct run *r)
{
    struct stat s;
    if (stat(r->dir, &s))
        return RELUME_OK;
    if (!S_ISDIR(s.st_mode))
        return log_fail(r->p.log, RELUME_EINVAL, "%s: is a file; expected a folder, new or not",
                        r->dir);
    char *list = mem_format("%s/.relume", r->dir);
    if (!list)
        return RELUME_ENOMEM;
    const bool whole = !access(list, F_OK);
    mem_free(list);
    return whole ? log_fail(r->p.log, RELUME_EINVAL,
                            "%s: is a capture, or another folder that relume made as a whole; "
                            "expected another folder for many objects",
                            r->dir)
                 : objects_page_check(r->dir, r->p.log);
}

static relume_status make_folder(const struct run *r)
{
    if (!mkdir(r->dir, 0777) || errno == EEXIST)
        return RELUME_OK;
    return log_fail(r->p.log, RELUME_EIO, "%s: cannot be created; %s", r->dir, strerror(errno));
}

static relume_status begin(struct run *r, const char *dir, const char *const *folders, int count)
{
    size_t n = strlen(dir);
    while (n > 1 && dir[n - 1] == '/')
        n--;
    r->dir = mem_format("%.*s", (int)n, dir);
    relume_status status = r->dir ? check_each(r) : RELUME_ENOMEM;
    if (!status)
        status = list_names(r);
    if (!status)
        status = check_folder(r);
    if (!status)
        status = objects_find(r->out, r->dir, folders, count, &r->each, r->p.log);
    if (!status)
        status = make_folder(r);
    if (!status)
        log_line(
            r->p.log, RELUME_NOTE,
            "%d folder%s, an object each; photographs of one object that lie in several folders "
            "are named as %s/*",
            r->out->count, relume_plural(r->out->count), r->out->object[0].photographs);
    return status;
}

relume_status relume_capture_objects(const char *dir, const char *const *folders, int count,
                                     const struct relume_capture_objects_params *params,
                                     struct relume_captured_objects *out)
{
    struct relume_captured_objects unread = {0};
    struct run r = {.p = PARAMS(relume_capture_objects_params, params), .out = out ? out : &unread};
    r.each = PARAMS_WORK(relume_acquire_params, r.p.each);
    r.each.log = r.p.log;
    *r.out = (struct relume_captured_objects){0};
    relume_status status = begin(&r, dir, folders, count);
    if (status)
        relume_captured_objects_destroy(r.out);
    else
        status = make_all(&r);
    if (!out)
        relume_captured_objects_destroy(&unread);
    mem_free(r.file);
    mem_free(r.dir);
    return status;
}
