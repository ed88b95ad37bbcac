// beside.c - a folder of ours next to an output, where it is made until it is whole
#include "core/base/beside.h"

#include "core/base/inventory.h"
#include "core/base/memory.h"
#include "core/base/tree.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

static const char PREFIX[] = ".relume-";
static const char HEADER[] = "relume, unfinished, 1\n";
enum { DIGITS = 12, TRIES = 100, NAME = 4096 };

struct beside {
    char *dir, *path, *lock, *new, *old;
    const struct relume_log *log;
    int fd;        // of the lock
    beside *next;  // of those that this process works in
};

// What a process must remove when it ends without waiting for its threads.
static pthread_mutex_t open_lock = PTHREAD_MUTEX_INITIALIZER;
static beside *open_ones;

const char *beside_new(const beside *b)
{
    return b->new;
}

const char *beside_old(const beside *b)
{
    return b->old;
}

static void drop(beside *b)
{
    if (b->fd >= 0)
        close(b->fd);
    mem_free(b->dir);
    mem_free(b->path);
    mem_free(b->lock);
    mem_free(b->new);
    mem_free(b->old);
    mem_free(b);
}

static beside *of_path(const char *dir, char *path, const struct relume_log *log)
{
    beside *b = path ? mem_zeroed(1, sizeof *b) : NULL;
    if (!b) {
        mem_free(path);
        errno = ENOMEM;
        return NULL;
    }
    *b = (beside){.path = path, .log = log, .fd = -1, .dir = mem_text(dir)};
    b->lock = mem_format("%s/lock", path);
    b->new = mem_format("%s/new", path);
    b->old = mem_format("%s/old", path);
    if (b->dir && b->lock && b->new && b->old)
        return b;
    drop(b);
    errno = ENOMEM;
    return NULL;
}

static bool is_name(const char *name)
{
    const size_t n = sizeof PREFIX - 1;
    return !strncmp(name, PREFIX, n) && strlen(name) == n + DIGITS &&
           strspn(name + n, "0123456789abcdef") == DIGITS;
}

bool beside_holds(const char *path)
{
    char name[sizeof PREFIX + DIGITS];
    for (const char *at = path; (at = strstr(at, PREFIX)); at++) {
        snprintf(name, sizeof name, "%.*s", (int)sizeof name - 1, at);
        if ((at == path || at[-1] == '/') && is_name(name) && at[sizeof name - 1] == '/')
            return true;
    }
    return false;
}

// ---------------------------------------------------------------- what stopped processes left

static bool was_written(int fd, char name[NAME])
{
    char text[sizeof HEADER + NAME] = "";
    const ssize_t n = pread(fd, text, sizeof text - 1, 0);
    snprintf(name, NAME, "%.*s", NAME - 1,
             n > (ssize_t)sizeof HEADER ? text + sizeof HEADER - 1 : "");
    return n == 0 || (n > 0 && !strncmp(text, HEADER, sizeof HEADER - 1));
}

// Its lock, taken; -1 when it is not ours or somebody works there. On a file system without
// locks nobody knows: then nobody's work is touched.
static int take_lock(const beside *b, char name[NAME])
{
    struct stat s;
    const int fd = open(b->lock, O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (fd < 0)
        return -1;
    if (!fstat(fd, &s) && S_ISREG(s.st_mode) && s.st_uid == geteuid() &&
        !flock(fd, LOCK_EX | LOCK_NB) && was_written(fd, name))
        return fd;
    close(fd);
    return -1;
}

// The lock goes last: what is half removed is still known as ours.
static void remove_all(const beside *b, const struct relume_log *log)
{
    inventory_remove(b->new, b->dir, log);
    inventory_remove(b->old, b->dir, log);
    unlink(b->lock);
    rmdir(b->path);
}

static void sweep_one(const char *dir, const char *entry, const struct relume_log *log)
{
    char name[NAME];
    beside *b = of_path(dir, mem_format("%s/%s", dir, entry), log);
    struct stat s;
    if (!b)
        return;
    if (!lstat(b->path, &s) && S_ISDIR(s.st_mode) && s.st_uid == geteuid() && rmdir(b->path)) {
        b->fd = take_lock(b, name);
        if (b->fd >= 0) {
            // Stopped between giving away the old name and taking it.
            char *target = *name ? mem_format("%s/%s", b->dir, name) : NULL;
            if (target && access(target, F_OK))
                (void)tree_rename(b->old, target, TREE_NEW);
            mem_free(target);
            remove_all(b, log);
        }
    }
    drop(b);
}

void beside_sweep(const char *dir, const struct relume_log *log)
{
    DIR *d = opendir(dir);
    for (struct dirent *e; d && (e = readdir(d));)
        if (is_name(e->d_name))
            sweep_one(dir, e->d_name, log);
    if (d)
        closedir(d);
}

// ---------------------------------------------------------------- a new one

static void random_name(char out[sizeof PREFIX + DIGITS])
{
    unsigned char bytes[DIGITS / 2] = {0};
    size_t n = sizeof PREFIX - 1;
    memcpy(out, PREFIX, n);
    if (getrandom(bytes, sizeof bytes, GRND_NONBLOCK) < 0) {
        const long long pid = getpid();
        memcpy(bytes, &pid, sizeof bytes);
    }
    for (size_t i = 0; i < sizeof bytes; i++)
        n += (size_t)snprintf(out + n, 3, "%02x", bytes[i]);
}

// Until it is locked, another process may take it for what somebody left: 1 made, 0 it did, -1
// errno.
static int try_lock(beside *b, const char *name)
{
    struct stat s;
    char *text = mem_format("%s%s", HEADER, name);
    b->fd = text ? open(b->lock, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600) : -1;
    const bool gone = text && b->fd < 0 && errno == ENOENT;
    bool good = b->fd >= 0;
    if (good)
        (void)flock(b->fd, LOCK_EX);  // without locks: nobody will remove it
    const bool taken = good && !fstat(b->fd, &s) && !s.st_nlink;
    good = good && !taken && write(b->fd, text, strlen(text)) == (ssize_t)strlen(text);
    if (!text)
        errno = ENOMEM;
    mem_free(text);
    return good ? 1 : gone || taken ? 0 : -1;
}

static void leave(const beside *b)
{
    pthread_mutex_lock(&open_lock);
    for (beside **at = &open_ones; *at; at = &(*at)->next)
        if (*at == b) {
            *at = b->next;
            break;
        }
    pthread_mutex_unlock(&open_lock);
}

// Others may still write there: a folder that was not empty in the end is tried again. Their logs
// may be gone.
void relume_files_abandon(void)
{
    pthread_mutex_lock(&open_lock);
    for (const beside *b = open_ones; b; b = b->next)
        for (int i = 0; i < TRIES && !access(b->path, F_OK); i++)
            remove_all(b, NULL);
}

beside *beside_open(const char *dir, const char *name, const struct relume_log *log)
{
    beside_sweep(dir, log);
    for (int i = 0; i < TRIES; i++) {
        char own[sizeof PREFIX + DIGITS];
        random_name(own);
        beside *b = of_path(dir, mem_format("%s/%s", dir, own), log);
        if (!b)
            return NULL;
        const bool made = !mkdir(b->path, 0700);
        const int locked = made ? try_lock(b, name) : errno == EEXIST ? 0 : -1;
        if (locked > 0) {
            pthread_mutex_lock(&open_lock);
            b->next = open_ones;
            open_ones = b;
            pthread_mutex_unlock(&open_lock);
            return b;
        }
        const int error = errno;
        if (made && locked < 0)
            remove_all(b, log);
        drop(b);
        errno = error;
        if (locked < 0)
            return NULL;
    }
    errno = EEXIST;
    return NULL;
}

void beside_close(beside **b)
{
    if (*b) {
        leave(*b);
        remove_all(*b, (*b)->log);
        drop(*b);
    }
    *b = NULL;
}
