#include "base/outfile.h"

#include "base/log.h"
#include "base/memory.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <libgen.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

struct outfile {
    int fd;
    char *path;
    char *beside;  // the temporary name; NULL for a device
    const struct relume_log *log;
};

struct outdir {
    char *path;
    char *part;
    bool force;
    const struct relume_log *log;
};

static relume_status fail(const char *path, const char *what, const struct relume_log *log)
{
    return log_fail(log, RELUME_EIO, "%s: %s; %s", path, what, strerror(errno));
}

bool scratch_write(int fd, const void *bytes, size_t size, off_t offset)
{
    const char *from = bytes;
    while (size) {
        const ssize_t n = pwrite(fd, from, size, offset);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return false;
        from += n;
        offset += n;
        size -= (size_t)n;
    }
    return true;
}

bool scratch_read(int fd, void *bytes, size_t size, off_t offset)
{
    char *to = bytes;
    while (size) {
        const ssize_t n = pread(fd, to, size, offset);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0) {
            errno = n ? errno : EIO;
            return false;
        }
        to += n;
        offset += n;
        size -= (size_t)n;
    }
    return true;
}

static bool is_device(const char *path)
{
    struct stat s;
    return !stat(path, &s) && !S_ISREG(s.st_mode) && !S_ISDIR(s.st_mode);
}

int scratch_open(const char *near)
{
    if (near && is_device(near))
        near = NULL;
    const char *temp = getenv("TMPDIR");
    char *copy = near ? mem_text(near) : NULL;
    const char *folder = copy ? dirname(copy) : temp && *temp ? temp : "/tmp";
    char *name = near && !copy ? NULL : mem_format("%s/.relume-XXXXXX", folder);
    int fd = -1;
    if (name) {
        fd = mkostemp(name, O_CLOEXEC);
        if (fd >= 0)
            unlink(name);
    } else {
        errno = ENOMEM;
    }
    free(name);
    free(copy);
    return fd;
}

void *scratch_map(const char *near, size_t size)
{
    const int fd = scratch_open(near);
    if (fd < 0)
        return NULL;
    errno = posix_fallocate(fd, 0, (off_t)size);
    void *memory = errno ? MAP_FAILED : mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    const int error = errno;
    close(fd);
    errno = error;
    return memory == MAP_FAILED ? NULL : memory;
}

void scratch_unmap(void *memory, size_t size)
{
    if (memory)
        munmap(memory, size);
}

// A new file with the permissions that the user's mask leaves; mkstemp would make it private.
static relume_status open_beside(outfile *file)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    unsigned tag = (unsigned)t.tv_nsec ^ ((unsigned)getpid() << 12);
    for (int tries = 0; tries < 100; tries++, tag = tag * 1664525u + 1013904223u) {
        free(file->beside);
        file->beside = mem_format("%s.part-%06x", file->path, tag & 0xffffff);
        if (!file->beside)
            return RELUME_ENOMEM;
        file->fd = open(file->beside, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file->fd >= 0 || errno != EEXIST)
            break;
    }
    return RELUME_OK;
}

relume_status outfile_open(outfile **out, const char *path, const struct relume_log *log)
{
    *out = NULL;
    outfile *file = mem_zeroed(1, sizeof *file);
    if (!file)
        return RELUME_ENOMEM;
    file->log = log;
    file->fd = -1;
    file->path = mem_text(path);
    relume_status status = RELUME_ENOMEM;
    if (!file->path)
        goto fail;

    struct stat s;
    if (!stat(path, &s) && S_ISDIR(s.st_mode)) {
        errno = EISDIR;
        status = fail(path, "cannot be written", log);
        goto fail;
    }
    if (is_device(path)) {
        file->fd = scratch_open(NULL);
    } else {
        status = open_beside(file);
        if (status)
            goto fail;
    }
    if (file->fd < 0) {
        free(file->beside);
        file->beside = NULL;
        status = fail(path, "cannot be written", log);
        goto fail;
    }
    *out = file;
    return RELUME_OK;
fail:
    outfile_abort(&file);
    return status;
}

relume_status outfile_write(outfile *file, const void *bytes, size_t size, off_t offset)
{
    if (scratch_write(file->fd, bytes, size, offset))
        return RELUME_OK;
    return fail(file->path, "writing failed", file->log);
}

static relume_status copy_to_device(outfile *file)
{
    enum { BLOCK = 1 << 20 };
    const int to = open(file->path, O_WRONLY | O_CLOEXEC);
    char *block = mem_array(BLOCK, 1);
    const off_t size = lseek(file->fd, 0, SEEK_END);
    bool good = to >= 0 && block && size >= 0;
    for (off_t at = 0; good && at < size;) {
        const size_t n = size - at < BLOCK ? (size_t)(size - at) : BLOCK;
        good = scratch_read(file->fd, block, n, at);
        for (size_t sent = 0; good && sent < n;) {
            const ssize_t m = write(to, block + sent, n - sent);
            if (m < 0 && errno == EINTR)
                continue;
            good = m > 0;
            sent += good ? (size_t)m : 0;
        }
        at += (off_t)n;
    }
    relume_status status = good ? RELUME_OK : fail(file->path, "writing failed", file->log);
    if (to >= 0 && close(to) && good)
        status = fail(file->path, "writing failed", file->log);
    free(block);
    return status;
}

static relume_status publish(outfile *file)
{
    if (fsync(file->fd))
        return fail(file->path, "writing failed", file->log);
    const int fd = file->fd;
    file->fd = -1;
    if (close(fd))
        return fail(file->path, "writing failed", file->log);
    if (rename(file->beside, file->path))
        return fail(file->path, "cannot be written", file->log);
    free(file->beside);
    file->beside = NULL;
    return RELUME_OK;
}

relume_status outfile_commit(outfile **file)
{
    const relume_status status = (*file)->beside ? publish(*file) : copy_to_device(*file);
    outfile_abort(file);
    return status;
}

void outfile_abort(outfile **file)
{
    outfile *f = *file;
    *file = NULL;
    if (!f)
        return;
    if (f->fd >= 0)
        close(f->fd);
    if (f->beside)
        unlink(f->beside);
    free(f->beside);
    free(f->path);
    free(f);
}

relume_status relume_file_save(const char *path, const void *bytes, size_t size,
                               const struct relume_log *log)
{
    return outfile_save(path, bytes, size, log);
}

relume_status outfile_save(const char *path, const void *bytes, size_t size,
                           const struct relume_log *log)
{
    outfile *file;
    relume_status status = outfile_open(&file, path, log);
    if (!status)
        status = outfile_write(file, bytes, size, 0);
    if (!status)
        return outfile_commit(&file);
    outfile_abort(&file);
    return status;
}

static int remove_entry(const char *path, const struct stat *s, int type, struct FTW *walk)
{
    (void)s, (void)type, (void)walk;
    return remove(path);
}

static void remove_tree(const char *path)
{
    nftw(path, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

// Something that a new folder of that name would hide or replace.
static bool is_occupied(const char *path)
{
    struct stat s;
    if (lstat(path, &s))
        return false;
    DIR *dir = opendir(path);
    if (!dir)
        return true;
    int entries = 0;
    while (entries < 3 && readdir(dir))
        entries++;
    closedir(dir);
    return entries > 2;
}

relume_status outdir_open(outdir **out, const char *path, bool force, const struct relume_log *log)
{
    *out = NULL;
    outdir *dir = mem_zeroed(1, sizeof *dir);
    if (!dir)
        return RELUME_ENOMEM;
    dir->log = log;
    dir->force = force;
    dir->path = mem_text(path);
    relume_status status = RELUME_ENOMEM;
    if (!dir->path)
        goto fail;
    for (size_t n = strlen(dir->path); n > 1 && dir->path[n - 1] == '/'; n--)
        dir->path[n - 1] = '\0';

    if (!force && is_occupied(dir->path)) {
        status = log_fail(log, RELUME_EINVAL,
                          "%s: already exists; expected a new or empty folder, or --force", path);
        goto fail;
    }
    char *part = mem_format("%s.part", dir->path);
    if (!part)
        goto fail;
    remove_tree(part);
    if (mkdir(part, 0777)) {
        status = fail(path, "cannot be created", log);
        free(part);
        goto fail;
    }
    dir->part = part;
    *out = dir;
    return RELUME_OK;
fail:
    outdir_abort(&dir);
    return status;
}

const char *outdir_path(const outdir *dir)
{
    return dir->part;
}

relume_status outdir_commit(outdir **dir)
{
    outdir *d = *dir;
    relume_status status = RELUME_OK;
    char *old = d->force && is_occupied(d->path) ? mem_format("%s.old", d->path) : NULL;
    if (old) {
        remove_tree(old);
        if (rename(d->path, old))
            status = fail(d->path, "cannot be replaced", d->log);
    }
    if (!status && rename(d->part, d->path)) {
        status = fail(d->path, "cannot be created", d->log);
        if (old && rename(old, d->path))
            status = fail(old, "cannot be moved back", d->log);
    } else if (!status) {
        free(d->part);
        d->part = NULL;
        if (old)
            remove_tree(old);
    }
    free(old);
    outdir_abort(dir);
    return status;
}

void outdir_abort(outdir **dir)
{
    outdir *d = *dir;
    *dir = NULL;
    if (!d)
        return;
    if (d->part)
        remove_tree(d->part);
    free(d->part);
    free(d->path);
    free(d);
}

relume_status outdir_end(outdir **dir, relume_status status)
{
    if (!status)
        return outdir_commit(dir);
    outdir_abort(dir);
    return status;
}
