// faults.c - a library to preload that lets calls to the system fail, for tests/tools/faults.sh
//
//   RELUME_FAULT=CALL:N:ERROR     the N-th CALL fails with that number of errno
//   RELUME_FAULT=CALL:N+:ERROR    and all after it
//   RELUME_FAULT_HIT=FILE         made when a call failed
//
// CALL: open (for writing), read (opening for reading), write, sync, rename, exchange (of two
// names), link, unnamed (a file without a name), map, allocate, mkdir, flush (of a stream). Only
// names that do not begin with a slash count, and descriptors above 2: what libraries look up is
// left alone.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

static bool fails(const char *call)
{
    static atomic_long count;
    const char *fault = getenv("RELUME_FAULT"), *hit = getenv("RELUME_FAULT_HIT");
    const size_t n = strlen(call);
    if (!fault || strncmp(fault, call, n) || fault[n] != ':')
        return false;
    char *rest;
    const long at = strtol(fault + n + 1, &rest, 10), now = ++count;
    const bool on = *rest == '+';
    if (now < at || (now > at && !on))
        return false;
    if (hit)
        (void)syscall(SYS_close, (int)syscall(SYS_openat, AT_FDCWD, hit, O_CREAT | O_WRONLY, 0600));
    errno = atoi(rest + on + 1);
    return true;
}

static bool is_ours(const char *path)
{
    const char *under = getenv("RELUME_FAULT_UNDER");
    return *path != '/' || (under && !strncmp(path, under, strlen(under)));
}

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static const char *kind_of(int flags)
{
    if ((flags & O_TMPFILE) == O_TMPFILE)
        return "unnamed";
    return (flags & O_ACCMODE) == O_RDONLY ? "read" : "open";
}

static bool refuses(const char *path, int flags)
{
    return is_ours(path) && fails(kind_of(flags));
}

#define OPEN(name)                                                                                 \
    int name(const char *path, int flags, ...)                                                     \
    {                                                                                              \
        va_list list;                                                                              \
        va_start(list, flags);                                                                     \
        const mode_t mode = va_arg(list, mode_t);                                                  \
        va_end(list);                                                                              \
        return refuses(path, flags) ? -1 : NEXT(name)(path, flags, mode);                          \
    }
OPEN(open)
OPEN(open64)

FILE *fopen(const char *path, const char *how)
{
    const bool reads = *how == 'r' && !strchr(how, '+');
    return is_ours(path) && fails(reads ? "read" : "open") ? NULL : NEXT(fopen)(path, how);
}

FILE *fopen64(const char *path, const char *how)
{
    const bool reads = *how == 'r' && !strchr(how, '+');
    return is_ours(path) && fails(reads ? "read" : "open") ? NULL : NEXT(fopen64)(path, how);
}

ssize_t write(int fd, const void *bytes, size_t size)
{
    return fd > 2 && fails("write") ? -1 : NEXT(write)(fd, bytes, size);
}

ssize_t pwrite(int fd, const void *bytes, size_t size, off_t at)
{
    return fails("write") ? -1 : NEXT(pwrite)(fd, bytes, size, at);
}

ssize_t pwrite64(int fd, const void *bytes, size_t size, off64_t at)
{
    return fails("write") ? -1 : NEXT(pwrite64)(fd, bytes, size, at);
}

int fflush(FILE *file)
{
    return file && fileno(file) > 2 && fails("flush") ? EOF : NEXT(fflush)(file);
}

int fsync(int fd)
{
    return fails("sync") ? -1 : NEXT(fsync)(fd);
}

int rename(const char *from, const char *to)
{
    return fails("rename") ? -1 : NEXT(rename)(from, to);
}

int renameat2(int a, const char *from, int b, const char *to, unsigned flags)
{
    return fails("exchange") ? -1 : NEXT(renameat2)(a, from, b, to, flags);
}

int linkat(int a, const char *from, int b, const char *to, int flags)
{
    return fails("link") ? -1 : NEXT(linkat)(a, from, b, to, flags);
}

int mkdir(const char *path, mode_t mode)
{
    return is_ours(path) && fails("mkdir") ? -1 : NEXT(mkdir)(path, mode);
}

int posix_fallocate(int fd, off_t at, off_t size)
{
    return fails("allocate") ? errno : NEXT(posix_fallocate)(fd, at, size);
}

int posix_fallocate64(int fd, off64_t at, off64_t size)
{
    return fails("allocate") ? errno : NEXT(posix_fallocate64)(fd, at, size);
}

static bool maps(int fd, int flags)
{
    return fd > 2 && (flags & MAP_TYPE) == MAP_SHARED && fails("map");
}

void *mmap(void *at, size_t size, int protection, int flags, int fd, off_t offset)
{
    return maps(fd, flags) ? MAP_FAILED : NEXT(mmap)(at, size, protection, flags, fd, offset);
}

void *mmap64(void *at, size_t size, int protection, int flags, int fd, off64_t offset)
{
    return maps(fd, flags) ? MAP_FAILED : NEXT(mmap64)(at, size, protection, flags, fd, offset);
}
