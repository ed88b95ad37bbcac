// outfile.c - files that appear whole or not at all
#include "core/base/outfile.h"

#include "core/base/beside.h"
#include "core/base/infile.h"
#include "core/base/inputs.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/scratch.h"
#include "core/base/tree.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum kind {
    UNNAMED,  // a name comes with the commit
    BESIDE,   // in `beside`
    INSIDE,   // under its own name, in a folder that is not finished
    DEVICE,   // gathered in a scratch file
    GIVEN,    // no file: written by the caller's `writer`
};

struct outfile {
    enum kind kind;
    int fd;
    int device;      // where a device's bytes go; -1: to be opened
    char *path;      // as it was given
    char *target;    // where that leads
    char *dir;       // the folder of `target`
    beside *beside;  // NULL: not yet
    struct relume_writer writer;
    const struct relume_log *log;
};

static relume_status fail(const outfile *f, const char *what)
{
    if (errno == ENOMEM)
        return RELUME_ENOMEM;
    return log_fail(f->log, RELUME_EIO, "%s: %s; %s", f->path, what, strerror(errno ? errno : EIO));
}

// ---------------------------------------------------------------- devices

// The descriptor that such a name means, -1 for other names. What it leads to may be a file
// that somebody appends to: it is written, not replaced.
static int descriptor_of(const char *path)
{
    int fd = -1, end = 0;
    if (!strcmp(path, "/dev/stdout"))
        return STDOUT_FILENO;
    if (!strcmp(path, "/dev/stderr"))
        return STDERR_FILENO;
    if ((sscanf(path, "/dev/fd/%d%n", &fd, &end) == 1 ||
         sscanf(path, "/proc/self/fd/%d%n", &fd, &end) == 1) &&
        !path[end])
        return fd;
    return -1;
}

static relume_status open_device(outfile *f, int descriptor)
{
    f->kind = DEVICE;
    if (descriptor >= 0)
        f->device = fcntl(descriptor, F_DUPFD_CLOEXEC, 3);
    if (descriptor < 0 || f->device >= 0)
        f->fd = scratch_open(NULL);
    return f->fd < 0 ? fail(f, "cannot be written") : RELUME_OK;
}

static bool write_all(int to, const char *bytes, size_t size)
{
    while (size) {
        const ssize_t n = write(to, bytes, size);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return false;
        bytes += n;
        size -= (size_t)n;
    }
    return true;
}

static relume_status copy_to_device(outfile *f)
{
    enum { BLOCK = 1 << 20 };
    if (f->device < 0)
        f->device = open(f->target, O_WRONLY | O_CLOEXEC);
    char *block = mem_array(BLOCK, 1);
    const off_t size = lseek(f->fd, 0, SEEK_END);
    bool good = f->device >= 0 && block && size >= 0;
    for (off_t at = 0; good && at < size; at += BLOCK) {
        const size_t n = size - at < BLOCK ? (size_t)(size - at) : BLOCK;
        good = scratch_read(f->fd, block, n, at) && write_all(f->device, block, n);
    }
    relume_status status = good ? RELUME_OK : fail(f, "writing failed");
    if (f->device >= 0 && close(f->device) && good)
        status = fail(f, "writing failed");
    f->device = -1;
    mem_free(block);
    return status;
}

// ---------------------------------------------------------------- files

static relume_status enter_beside(outfile *f)
{
    char *name = tree_base(f->target);
    f->beside = name ? beside_open(f->dir, name, f->log) : NULL;
    mem_free(name);
    return f->beside ? RELUME_OK : fail(f, "cannot be written");
}

struct fd_name {
    char text[32];
};

static struct fd_name name_of_descriptor(int fd)
{
    struct fd_name name;
    snprintf(name.text, sizeof name.text, "/proc/self/fd/%d", fd);
    return name;
}

// Only where it can be given a name later: that needs /proc.
static bool open_unnamed(outfile *f)
{
    f->kind = UNNAMED;
    f->fd = open(f->dir, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    const bool good = f->fd >= 0 && !access(name_of_descriptor(f->fd).text, F_OK);
    if (f->fd >= 0 && !good) {
        close(f->fd);
        f->fd = -1;
    }
    return good;
}

static relume_status open_new(outfile *f)
{
    beside_sweep(f->dir, f->log);
    if (open_unnamed(f))
        return RELUME_OK;
    f->kind = BESIDE;
    const relume_status status = enter_beside(f);
    if (status)
        return status;
    f->fd = open(beside_new(f->beside), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    return f->fd < 0 ? fail(f, "cannot be written") : RELUME_OK;
}

relume_status outfile_check(const char *target, const char *path, const struct relume_log *log)
{
    struct stat s;
    if (stat(target, &s))
        return RELUME_OK;
    if (S_ISDIR(s.st_mode))
        return log_fail(log, RELUME_EIO,
                        "%s: cannot be written; a folder has this name; expected a file", path);
    if (access(target, W_OK))
        return log_fail(log, RELUME_EIO, "%s: cannot be written; %s", path, strerror(errno));
    return input_refuse(target, path, log);
}

static relume_status open_file(outfile *f, const char *path)
{
    f->target = tree_resolve(path);
    if (!f->target)
        return fail(f, "cannot be written");
    f->dir = tree_parent(f->target);
    if (!f->dir)
        return RELUME_ENOMEM;
    errno = EISDIR;
    if (path_ends(path, "/"))
        return fail(f, "cannot be written");
    const int descriptor = descriptor_of(path);
    if (descriptor >= 0 || tree_is_device(path))
        return open_device(f, descriptor);
    if (beside_holds(f->target)) {
        f->kind = INSIDE;
        unlink(f->target);
        f->fd = open(f->target, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        return f->fd < 0 ? fail(f, "cannot be written") : RELUME_OK;
    }
    const relume_status status = outfile_check(f->target, f->path, f->log);
    return status ? status : open_new(f);
}

relume_status outfile_open(outfile **out, const char *path, const struct relume_writer *writer,
                           const struct relume_log *log)
{
    *out = NULL;
    outfile *f = mem_zeroed(1, sizeof *f);
    if (!f)
        return RELUME_ENOMEM;
    *f = (outfile){.log = log, .fd = -1, .device = -1, .path = mem_text(infile_name(path))};
    relume_status status = f->path ? RELUME_OK : RELUME_ENOMEM;
    if (writer) {
        f->kind = GIVEN;
        f->writer = *writer;
    } else if (!status) {
        status = open_file(f, path);
    }
    if (status)
        outfile_abort(&f);
    *out = f;
    return status;
}

// From so many bytes on the disk begins at once, so that little is left to wait for at the end.
enum { LARGE = 1 << 16 };

relume_status outfile_write(outfile *f, const void *bytes, size_t size, off_t offset)
{
    errno = 0;
    const bool good = f->kind == GIVEN
                          ? f->writer.write(f->writer.user, bytes, size, (uint64_t)offset)
                          : scratch_write(f->fd, bytes, size, offset);
    if (good && f->kind != GIVEN && size >= LARGE)
        (void)sync_file_range(f->fd, offset, (off_t)size, SYNC_FILE_RANGE_WRITE);
    return good ? RELUME_OK : fail(f, "writing failed");
}

// ---------------------------------------------------------------- the final name

static bool give_name(int fd, const char *name)
{
    const struct fd_name from = name_of_descriptor(fd);
    return !linkat(AT_FDCWD, from.text, AT_FDCWD, name, AT_SYMLINK_FOLLOW);
}

// A link replaces nothing: where there is a file already, the new one is renamed onto it.
static relume_status name_unnamed(outfile *f)
{
    if (give_name(f->fd, f->target))
        return RELUME_OK;
    if (errno != EEXIST)
        return fail(f, "cannot be written");
    const relume_status status = enter_beside(f);
    if (status)
        return status;
    return give_name(f->fd, beside_new(f->beside)) ? RELUME_OK : fail(f, "cannot be written");
}

static relume_status publish(outfile *f)
{
    struct stat old;
    relume_status status = outfile_check(f->target, f->path, f->log);
    if (!status && !stat(f->target, &old))
        (void)fchmod(f->fd, old.st_mode & 0777);
    if (!status && fsync(f->fd))
        status = fail(f, "writing failed");
    if (!status && f->kind == UNNAMED)
        status = name_unnamed(f);
    const int fd = f->fd;
    f->fd = -1;
    if (close(fd) && !status)
        status = fail(f, "writing failed");
    if (!status && f->beside && rename(beside_new(f->beside), f->target))
        status = fail(f, "cannot be written");
    if (!status && !tree_sync(f->dir))
        status = fail(f, "cannot be flushed to disk");
    return status;
}

// Flushed with its folder.
static relume_status leave_inside(outfile *f)
{
    const int fd = f->fd;
    f->fd = -1;
    if (close(fd)) {
        const relume_status status = fail(f, "writing failed");
        unlink(f->target);
        return status;
    }
    return RELUME_OK;
}

static bool finish_given(outfile *f, bool whole)
{
    bool (*const finish)(void *, bool) = f->writer.finish;
    f->writer.finish = NULL;
    errno = 0;
    return !finish || finish(f->writer.user, whole);
}

static relume_status commit_given(outfile *f)
{
    return finish_given(f, true) ? RELUME_OK : fail(f, "writing failed");
}

relume_status outfile_commit(outfile **file)
{
    outfile *f = *file;
    const relume_status status = f->kind == DEVICE   ? copy_to_device(f)
                                 : f->kind == INSIDE ? leave_inside(f)
                                 : f->kind == GIVEN  ? commit_given(f)
                                                     : publish(f);
    outfile_abort(file);
    return status;
}

void outfile_abort(outfile **file)
{
    outfile *f = *file;
    *file = NULL;
    if (!f)
        return;
    (void)finish_given(f, false);
    if (f->fd >= 0) {
        close(f->fd);
        if (f->kind == INSIDE)
            unlink(f->target);
    }
    if (f->device >= 0)
        close(f->device);
    beside_close(&f->beside);
    mem_free(f->path);
    mem_free(f->target);
    mem_free(f->dir);
    mem_free(f);
}

relume_status outfile_save_to(const char *path, const struct relume_writer *writer,
                              const void *bytes, size_t size, const struct relume_log *log)
{
    outfile *file;
    relume_status status = outfile_open(&file, path, writer, log);
    if (!status)
        status = outfile_write(file, bytes, size, 0);
    if (!status)
        return outfile_commit(&file);
    outfile_abort(&file);
    return status;
}

relume_status outfile_save(const char *path, const void *bytes, size_t size,
                           const struct relume_log *log)
{
    return outfile_save_to(path, NULL, bytes, size, log);
}

// A folder of the path is missing, or nothing can be made in it.
static relume_status check_parent(const char *path, const struct relume_log *log)
{
    struct stat s;
    char *target = tree_resolve(path);  // without slashes at its end
    char *parent = target ? tree_parent(target) : NULL;
    relume_status status = parent ? RELUME_OK : RELUME_ENOMEM;
    if (!target && errno == ELOOP)
        status = log_fail(log, RELUME_EIO, "%s: cannot be created; %s", path, strerror(errno));
    if (parent && stat(parent, &s) && errno == ENOENT)
        status =
            log_fail(log, RELUME_EIO, "%s: cannot be created; there is no folder %s: make it first",
                     path, parent);
    else if (parent && access(parent, W_OK))
        status = log_fail(log, RELUME_EIO, "%s: cannot be created; %s", path, strerror(errno));
    mem_free(parent);
    mem_free(target);
    return status;
}

relume_status relume_file_check(const char *path, const struct relume_log *log)
{
    struct stat s;
    if (lstat(path, &s))
        return check_parent(path, log);
    const bool plain = !stat(path, &s) && (S_ISREG(s.st_mode) || S_ISDIR(s.st_mode));
    char *target = plain ? tree_resolve(path) : NULL;
    const relume_status status = target ? outfile_check(target, path, log) : RELUME_OK;
    mem_free(target);
    return status;
}

relume_status relume_file_save(const char *path, const void *bytes, size_t size,
                               const struct relume_log *log)
{
    return outfile_save(path, bytes, size, log);
}

relume_status relume_file_print(const char *path, void (*print)(const void *context, FILE *to),
                                const void *context, const struct relume_log *log)
{
    char *bytes = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&bytes, &size);
    if (!memory)
        return RELUME_ENOMEM;
    print(context, memory);
    const bool short_of_memory = ferror(memory);
    const relume_status status =
        fclose(memory) || short_of_memory ? RELUME_ENOMEM : outfile_save(path, bytes, size, log);
    mem_free_libc(bytes);
    return status;
}
