// outdir.c - folders, and files that others write, that appear whole or not at all
#include "core/base/outdir.h"

#include "core/base/beside.h"
#include "core/base/called.h"
#include "core/base/inputs.h"
#include "core/base/inventory.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "core/base/scratch.h"
#include "core/base/tree.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct relume_making {
    char *path;    // as it was given
    char *target;  // where that leads
    char *dir;     // the folder of `target`
    beside *beside;
    struct called called;  // `beside`, by `path`
    enum relume_made kind;
    bool force;
    const char *otherwise;  // what may be done where a folder is there already
    const struct relume_log *log;
};

static relume_status fail(const relume_making *m, const char *what)
{
    if (errno == ENOMEM)
        return RELUME_ENOMEM;
    return log_fail(m->log, RELUME_EIO, "%s: %s; %s", m->path, what, strerror(errno));
}

// ---------------------------------------------------------------- what is there already

static const char or_force[] = ", or --force";

// Something that a new folder of that name would hide or replace.
static bool is_occupied(const char *path)
{
    struct stat s;
    if (lstat(path, &s))
        return false;
    DIR *dir = opendir(path);
    if (!dir)
        return true;
    bool found = false;
    for (struct dirent *e; !found && (e = readdir(dir));)
        found = strcmp(e->d_name, ".") && strcmp(e->d_name, "..") && !inventory_is(e->d_name);
    closedir(dir);
    return found;
}

static relume_status check_old_folder(const relume_making *m)
{
    const relume_status status = input_refuse(m->target, m->path, m->log);
    return status ? status : inventory_check(m->target, m->path, m->log);
}

static relume_status check_old(relume_making *m)
{
    if (m->kind == RELUME_MADE_FILE)
        return outfile_check(m->target, m->path, m->log);
    if (!is_occupied(m->target)) {
        m->force = m->force || !access(m->target, F_OK);  // empty but for its list perhaps
        return RELUME_OK;
    }
    if (!m->force)
        return log_fail(m->log, RELUME_EINVAL,
                        "%s: already exists; expected a new or empty folder%s", m->path,
                        m->otherwise);
    return check_old_folder(m);
}

// ---------------------------------------------------------------- opening

static relume_status find_target(relume_making *m, const char *path)
{
    m->path = mem_text(path ? path : scratch_folder());
    if (!m->path)
        return RELUME_ENOMEM;
    m->target = path ? tree_resolve(path) : NULL;
    if (path && !m->target)
        return fail(m, "cannot be created");
    m->dir = path ? tree_parent(m->target) : mem_text(m->path);
    return m->dir ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status make_place(relume_making *m)
{
    char *name = m->target ? tree_base(m->target) : mem_text("");
    errno = ENOMEM;
    m->beside = name ? beside_open(m->dir, name, m->log) : NULL;
    mem_free(name);
    if (!m->beside || (m->kind == RELUME_MADE_FOLDER && mkdir(beside_new(m->beside), 0777)))
        return fail(m, "cannot be created");
    m->called = (struct called){.path = beside_new(m->beside), .name = m->path};
    if (m->target)
        called_enter(&m->called);
    return RELUME_OK;
}

static relume_status open_place(relume_making **out, const char *path, enum relume_made kind,
                                bool force, const char *otherwise, const struct relume_log *log)
{
    *out = NULL;
    relume_making *m = mem_zeroed(1, sizeof *m);
    if (!m)
        return RELUME_ENOMEM;
    *m = (relume_making){.kind = kind, .force = force, .otherwise = otherwise, .log = log};
    relume_status status = find_target(m, path);
    if (!status && path)
        status = check_old(m);
    if (!status)
        status = make_place(m);
    if (status)
        relume_making_abort(&m);
    *out = m;
    return status;
}

relume_status relume_folder_check(const char *path, bool force, const struct relume_log *log)
{
    relume_making *m = mem_zeroed(1, sizeof *m);
    if (!m)
        return RELUME_ENOMEM;
    *m = (relume_making){
        .kind = RELUME_MADE_FOLDER, .force = force, .otherwise = or_force, .log = log};
    relume_status status = find_target(m, path);
    if (!status)
        status = check_old(m);
    relume_making_abort(&m);
    return status;
}

relume_status relume_making_open(relume_making **out, const char *path, enum relume_made kind,
                                 bool force, const struct relume_log *log)
{
    return open_place(out, path, kind, force, "", log);
}

const char *relume_making_path(const relume_making *making)
{
    return beside_new(making->beside);
}

// ---------------------------------------------------------------- the final name

// Where names cannot be exchanged the old folder has none for a moment; a run that stops there
// leaves it to the next one, which puts it back (beside.c).
static bool exchange(const relume_making *m)
{
    const char *new = beside_new(m->beside), *old = beside_old(m->beside);
    struct stat s;
    if (!stat(m->target, &s))
        (void)chmod(new, s.st_mode & 0777);
    if (tree_rename(new, m->target, TREE_EXCHANGE))
        return true;
    if (errno != ENOSYS && errno != EINVAL && errno != ENOTSUP)
        return false;
    if (!tree_rename(m->target, old, TREE_NEW))
        return false;
    if (tree_rename(new, m->target, TREE_NEW))
        return true;
    const int error = errno;
    (void)tree_rename(old, m->target, TREE_NEW);
    errno = error;
    return false;
}

// Others may be making the same folder: the last one to be whole has the name.
static relume_status rename_folder(const relume_making *m)
{
    enum { TRIES = 100 };
    for (int i = 0; i < TRIES; i++) {
        if (tree_rename(beside_new(m->beside), m->target, TREE_NEW))
            return RELUME_OK;
        if (errno != EEXIST && errno != ENOTEMPTY && errno != ENOTDIR)
            return fail(m, "cannot be created");
        const relume_status status = check_old_folder(m);
        if (status)
            return status;
        if (exchange(m)) {
            if (!m->force)
                log_line(m->log, RELUME_WARNING,
                         "%s: another run made this folder meanwhile; this one replaced it",
                         m->path);
            return RELUME_OK;
        }
        if (errno != ENOENT && errno != EEXIST && errno != ENOTEMPTY)
            return fail(m, "cannot be replaced");
    }
    return fail(m, "cannot be replaced");
}

static relume_status rename_file(const relume_making *m)
{
    struct stat old;
    const char *new = beside_new(m->beside);
    const relume_status status = outfile_check(m->target, m->path, m->log);
    if (status)
        return status;
    if (!stat(m->target, &old))
        (void)chmod(new, old.st_mode & 0777);
    if (!tree_sync(new))
        return fail(m, "writing failed");
    return rename(new, m->target) ? fail(m, "cannot be written") : RELUME_OK;
}

static relume_status finish(const relume_making *m)
{
    if (m->kind == RELUME_MADE_FILE)
        return rename_file(m);
    return inventory_write(beside_new(m->beside)) ? rename_folder(m) : fail(m, "writing failed");
}

relume_status relume_making_commit(relume_making **making)
{
    relume_making *m = *making;
    relume_status status = finish(m);
    if (!status && !tree_sync(m->dir))
        status = fail(m, "cannot be flushed to disk");
    relume_making_abort(making);
    return status;
}

void relume_making_abort(relume_making **making)
{
    relume_making *m = *making;
    *making = NULL;
    if (!m)
        return;
    called_leave(&m->called);
    beside_close(&m->beside);
    mem_free(m->path);
    mem_free(m->target);
    mem_free(m->dir);
    mem_free(m);
}

// ---------------------------------------------------------------- as the library calls it

relume_status outdir_open(outdir **out, const char *path, bool force, const struct relume_log *log)
{
    return open_place(out, path, RELUME_MADE_FOLDER, force, or_force, log);
}

const char *outdir_path(const outdir *dir)
{
    return relume_making_path(dir);
}

relume_status outdir_commit(outdir **dir)
{
    return relume_making_commit(dir);
}

void outdir_abort(outdir **dir)
{
    relume_making_abort(dir);
}

relume_status outdir_end(outdir **dir, relume_status status)
{
    if (!status)
        return outdir_commit(dir);
    outdir_abort(dir);
    return status;
}
