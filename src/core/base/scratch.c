// scratch.c - temporary data on disk, in files without a name
#include "core/base/scratch.h"

#include "core/base/memory.h"
#include "core/base/tree.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

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

const char *scratch_folder(void)
{
    const char *temp = getenv("TMPDIR");
    return temp && *temp ? temp : "/tmp";
}

// Where a file system knows no files without names, one has a name for a moment.
static int open_unnamed(const char *folder)
{
    int fd = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (fd >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL && errno != ENOENT))
        return fd;
    char *name = mem_format("%s/.relume-XXXXXX", folder);
    fd = name ? mkostemp(name, O_CLOEXEC) : -1;
    if (fd >= 0)
        unlink(name);
    else if (!name)
        errno = ENOMEM;
    mem_free(name);
    return fd;
}

// No folder of its own to put anything beside it: devices, and the names of descriptors.
static bool is_nowhere(const char *path)
{
    return !strncmp(path, "/dev/fd/", 8) || !strncmp(path, "/dev/std", 8) ||
           !strncmp(path, "/proc/", 6) || tree_is_device(path);
}

int scratch_open(const char *near)
{
    if (!near || is_nowhere(near))
        return open_unnamed(scratch_folder());
    char *target = tree_resolve(near);  // without slashes at its end
    char *folder = target ? tree_parent(target) : NULL;
    const int fd = folder ? open_unnamed(folder) : -1;
    if (target && !folder)
        errno = ENOMEM;
    mem_free(folder);
    mem_free(target);
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

// The system brings pages back in runs around each that is asked for, of up to 2 MB: these go.
void scratch_forget(void *memory, size_t size, size_t first, size_t count)
{
    enum { RUN = 1 << 21 };
    const uintptr_t from = (uintptr_t)memory + first, run = from / RUN * RUN;
    const uintptr_t at = run > (uintptr_t)memory ? run : (uintptr_t)memory;
    const size_t wanted = from - at + count + RUN, left = (uintptr_t)memory + size - at;
    madvise((void *)at, wanted < left ? wanted : left, MADV_DONTNEED);
}

void scratch_unmap(void *memory, size_t size)
{
    if (memory)
        munmap(memory, size);
}
