// infile.c - an input that is open: a file, or what the caller gives in place of one
// (relume/context.h)
#include "core/base/infile.h"

#include "core/base/channel.h"
#include "core/base/context.h"
#include "core/base/inputs.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/scratch.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

const char *infile_name(const char *path)
{
    return path ? path : "memory";
}

// ---------------------------------------------------------------- descriptors of files

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t one_is_free = PTHREAD_COND_INITIALIZER;
static int held;  // descriptors that are being read
static struct infile *newest, *oldest;
static int open_files;

static void link_newest(struct infile *s)
{
    s->older = newest;
    s->newer = NULL;
    *(newest ? &newest->newer : &oldest) = s;
    newest = s;
    open_files++;
}

static void unlink_one(struct infile *s)
{
    *(s->newer ? &s->newer->older : &newest) = s->older;
    *(s->older ? &s->older->newer : &oldest) = s->newer;
    open_files--;
}

static void close_one(struct infile *s)
{
    unlink_one(s);
    close(s->file);
    s->file = -1;
}

// False where all are being read.
static bool close_oldest(void)
{
    struct infile *s = oldest;
    while (s && s->users)
        s = s->newer;
    if (s)
        close_one(s);
    return s;
}

// Some are left for outputs, libraries and the helper.
static int most_open(void)
{
    enum { OTHERS = 64, MOST = 1 << 20 };
    struct rlimit l;
    if (getrlimit(RLIMIT_NOFILE, &l) || l.rlim_cur > MOST)
        return MOST;
    return l.rlim_cur > 2 * OTHERS ? (int)l.rlim_cur - OTHERS : (int)l.rlim_cur / 2;
}

static bool open_now(struct infile *s)
{
    while (open_files >= most_open() && close_oldest())
        ;
    do
        s->file = open(s->path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    while (s->file < 0 && (errno == EMFILE || errno == ENFILE) && close_oldest());
    if (s->file >= 0)
        link_newest(s);
    return s->file >= 0;
}

// Not another file that has its name by now.
static bool open_again(struct infile *s)
{
    struct stat st;
    if (!open_now(s))
        return false;
    if (!fstat(s->file, &st) && st.st_dev == s->device && st.st_ino == s->number)
        return true;
    close_one(s);
    errno = ESTALE;
    return false;
}

// A descriptor that stays until it is let go; -1 with errno.
static int hold(struct infile *s)
{
    pthread_mutex_lock(&lock);
    if (s->file >= 0 && s != newest) {
        unlink_one(s);
        link_newest(s);
    }
    bool good = s->file >= 0 || open_again(s);
    while (!good && held && (errno == EMFILE || errno == ENFILE)) {  // another thread is soon done
        pthread_cond_wait(&one_is_free, &lock);
        good = s->file >= 0 || open_again(s);
    }
    s->users += good;
    held += good;
    pthread_mutex_unlock(&lock);
    return good ? s->file : -1;
}

static void let_go(struct infile *s)
{
    pthread_mutex_lock(&lock);
    s->users--;
    held--;
    pthread_cond_broadcast(&one_is_free);
    pthread_mutex_unlock(&lock);
}

static bool open_file(struct infile *s, const char *path, const struct relume_log *log)
{
    struct stat st;
    input_note(log, path);
    s->path = mem_text(path);
    pthread_mutex_lock(&lock);
    const bool good = s->path && open_now(s) && !fstat(s->file, &st);
    pthread_mutex_unlock(&lock);
    if (!s->path)
        errno = ENOMEM;
    if (!good)
        return false;
    s->regular = S_ISREG(st.st_mode);
    s->size = (uint64_t)st.st_size;
    s->device = st.st_dev;
    s->number = st.st_ino;
    return true;
}

// ---------------------------------------------------------------- what is no file

static pthread_mutex_t asking = PTHREAD_MUTEX_INITIALIZER;

// Files that nothing has a name of are our own.
static const struct relume_files *files_for(const char *path, const struct relume_log *log)
{
    const relume_context *c = context_of(log);
    return c && c->files.open && strncmp(path, "/proc/self/fd/", 14) ? &c->files : NULL;
}

static bool ask(const struct relume_files *files, const char *path, struct relume_reader *out)
{
    pthread_mutex_lock(&asking);
    errno = 0;
    const bool found = files->open(files->user, path, out);
    const int error = errno;
    pthread_mutex_unlock(&asking);
    errno = error;
    return found;
}

static void give_back(const struct relume_files *files, struct relume_reader *reader)
{
    pthread_mutex_lock(&asking);
    if (files->close)
        files->close(files->user, reader);
    pthread_mutex_unlock(&asking);
}

bool infile_open(struct infile *out, const char *path, const struct relume_reader *from,
                 const struct relume_log *log)
{
    *out = (struct infile){.file = -1};
    pthread_mutex_init(&out->lock, NULL);
    out->files = from ? NULL : files_for(path, log);
    if (out->files && ask(out->files, path, &out->from)) {
        from = &out->from;
    } else if (out->files) {
        out->files = NULL;
        out->from = (struct relume_reader){0};
        if (errno)
            return false;
    }
    if (!from)
        return open_file(out, path, log);
    out->from = *from;
    out->regular = true;
    out->size = from->size;
    return true;
}

void infile_close(struct infile *s)
{
    pthread_mutex_lock(&lock);
    if (s->file >= 0)
        close_one(s);
    pthread_mutex_unlock(&lock);
    if (s->files)
        give_back(s->files, &s->from);
    s->files = NULL;
    pthread_mutex_destroy(&s->lock);
    mem_free(s->path);
    s->path = NULL;
}

// ---------------------------------------------------------------- reading

static ssize_t read_file(int file, char *to, size_t size, uint64_t offset)
{
    size_t done = 0;
    while (done < size) {
        const ssize_t n = pread(file, to + done, size - done, (off_t)(offset + done));
        if (n < 0 && errno != EINTR)
            return -1;
        if (n == 0)
            break;
        done += n > 0 ? (size_t)n : 0;
    }
    return (ssize_t)done;
}

ssize_t infile_read(struct infile *s, void *bytes, size_t size, uint64_t offset)
{
    if (!s->from.read) {
        const int file = hold(s);
        const ssize_t n = file < 0 ? -1 : read_file(file, bytes, size, offset);
        if (file >= 0)
            let_go(s);
        return n;
    }
    const uint64_t left = offset < s->size ? s->size - offset : 0;
    const size_t n = size < left ? size : (size_t)left;
    if (n == 0)
        return 0;
    pthread_mutex_lock(&s->lock);
    errno = 0;
    const bool good = s->from.read(s->from.user, bytes, n, offset);
    const int error = errno ? errno : EIO;
    pthread_mutex_unlock(&s->lock);
    errno = error;
    return good ? (ssize_t)n : -1;
}

// In blocks, so that what is not in memory need not be there twice.
static bool copy(struct infile *s, int to)
{
    enum { BLOCK = 1 << 16 };
    char block[BLOCK];
    ssize_t n = 1;
    bool good = true;
    for (uint64_t at = 0; good && at < s->size; at += (uint64_t)n) {
        n = infile_read(s, block, BLOCK, at);
        good = n > 0 && scratch_write(to, block, (size_t)n, (off_t)at);
    }
    return good;
}

int infile_descriptor(struct infile *s)
{
    if (!s->from.read) {
        const int file = hold(s), copy = file < 0 ? -1 : fcntl(file, F_DUPFD_CLOEXEC, 3);
        if (file >= 0)
            let_go(s);
        return copy;
    }
    const int memory = channel_memory((size_t)s->size);
    if (memory >= 0 && !copy(s, memory)) {
        const int error = errno;
        close(memory);
        errno = error;
        return -1;
    }
    return memory;
}

// ---------------------------------------------------------------- streams

struct stream {
    struct infile in;
    uint64_t at;
};

static ssize_t stream_read(void *cookie, char *bytes, size_t size)
{
    struct stream *s = cookie;
    const ssize_t n = infile_read(&s->in, bytes, size, s->at);
    s->at += n > 0 ? (uint64_t)n : 0;
    return n;
}

static int stream_seek(void *cookie, off64_t *offset, int whence)
{
    struct stream *s = cookie;
    const uint64_t from = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? s->at : s->in.size;
    const int64_t to = (int64_t)from + *offset;
    if (to < 0) {
        errno = EINVAL;
        return -1;
    }
    s->at = (uint64_t)to;
    *offset = to;
    return 0;
}

static int stream_close(void *cookie)
{
    struct stream *s = cookie;
    infile_close(&s->in);
    mem_free(s);
    return 0;
}

FILE *infile_stream(struct infile **in, const char *path, const struct relume_reader *from,
                    const struct relume_log *log)
{
    static const cookie_io_functions_t functions = {stream_read, NULL, stream_seek, stream_close};
    struct stream *s = mem_zeroed(1, sizeof *s);
    FILE *f = NULL;
    errno = ENOMEM;
    if (s && infile_open(&s->in, path, from, log))
        f = fopencookie(s, "rb", functions);
    if (s && !f) {
        const int error = errno;
        infile_close(&s->in);
        mem_free(s);
        errno = error;
    }
    if (f && in)
        *in = &s->in;
    return f;
}

// ---------------------------------------------------------------- by name

enum input_kind input_kind(const char *path, const struct relume_log *log)
{
    const struct relume_files *files = files_for(path, log);
    struct relume_reader reader;
    struct stat s;
    if (files && ask(files, path, &reader)) {
        give_back(files, &reader);
        return INPUT_FILE;
    }
    if ((files && errno) || stat(path, &s))
        return INPUT_NONE;
    return S_ISREG(s.st_mode) ? INPUT_FILE : S_ISDIR(s.st_mode) ? INPUT_FOLDER : INPUT_OTHER;
}

bool input_exists(const char *path, const struct relume_log *log)
{
    return input_kind(path, log) != INPUT_NONE;
}

FILE *input_open(const char *path, const struct relume_log *log)
{
    if (files_for(path, log))
        return infile_stream(NULL, path, NULL, log);
    input_note(log, path);
    return fopen(path, "rbe");
}

static bool open_one(void *user, const char *path, struct relume_reader *out)
{
    const struct one_input *one = user;
    if (strcmp(path, one->path))
        return one->others && one->others->open(one->others->user, path, out);
    *out = *one->from;
    return true;
}

static void close_one_input(void *user, struct relume_reader *reader)
{
    const struct one_input *one = user;
    if (one->others && one->others->close && reader->user != one->from->user)
        one->others->close(one->others->user, reader);
}

const struct relume_log *one_input(struct one_input *one, const char *path,
                                   const struct relume_reader *from, const struct relume_log *log)
{
    if (!from)
        return log;
    *one = (struct one_input){log ? *log : (struct relume_log){0}, context_like(log),
                              files_for(path, log), path, from};
    one->context.files = (struct relume_files){open_one, close_one_input, one};
    one->log.context = &one->context;
    return &one->log;
}

relume_status input_load(char **out, size_t *size, const char *path, uint64_t most,
                         const char *expected, const struct relume_log *log)
{
    struct infile in;
    relume_status status = RELUME_OK;
    *out = NULL;
    *size = 0;
    if (!infile_open(&in, path, NULL, log))
        status = relume_input_fail(log, path, "cannot be opened", errno);
    else if (!in.regular || in.size > most)
        status = log_fail(log, in.regular ? RELUME_ELIMIT : RELUME_EFORMAT, "%s: %s; expected %s",
                          path, in.regular ? "too long" : "not a file", expected);
    else if (!(*out = mem_array((size_t)in.size + 1, 1)))
        status = RELUME_ENOMEM;
    errno = EIO;  // where a file has become shorter
    if (!status && infile_read(&in, *out, (size_t)in.size, 0) != (ssize_t)in.size)
        status = relume_input_fail(log, path, "cannot be read", errno);
    if (!status)
        (*out)[ *size = (size_t)in.size] = '\0';
    else
        mem_free(*out), *out = NULL;
    infile_close(&in);
    return status;
}

int input_descriptor(const char *path, const struct relume_log *log)
{
    struct infile in;
    if (!files_for(path, log)) {
        input_note(log, path);
        return open(path, O_RDONLY | O_CLOEXEC);
    }
    const int file = infile_open(&in, path, NULL, log) ? infile_descriptor(&in) : -1;
    const int error = errno;
    infile_close(&in);
    errno = error;
    return file;
}

// ---------------------------------------------------------------- memory

static bool read_memory(void *user, void *bytes, size_t size, uint64_t offset)
{
    memcpy(bytes, (const char *)user + offset, size);
    return true;
}

struct relume_reader relume_memory_reader(const void *bytes, size_t size)
{
    return (struct relume_reader){read_memory, (void *)(size_t)bytes, size};
}

static bool grow(struct relume_buffer *b, size_t size)
{
    if (size <= b->room)
        return true;
    const size_t capacity = size > SIZE_MAX / 2 ? size : 2 * size;
    unsigned char *data = mem_resize(b->data, capacity, 1);
    if (!data) {
        errno = ENOMEM;
        return false;
    }
    b->data = data;
    b->room = capacity;
    return true;
}

static bool write_buffer(void *user, const void *bytes, size_t size, uint64_t offset)
{
    struct relume_buffer *b = user;
    uint64_t end;
    if (b->whole)
        relume_buffer_destroy(b);
    if (__builtin_add_overflow(offset, size, &end) || end > SIZE_MAX) {
        errno = ENOMEM;
        return false;
    }
    if (!grow(b, (size_t)end))
        return false;
    if (offset > b->size)
        memset(b->data + b->size, 0, (size_t)offset - b->size);
    memcpy(b->data + offset, bytes, size);
    b->size = end > b->size ? (size_t)end : b->size;
    return true;
}

static bool finish_buffer(void *user, bool whole)
{
    struct relume_buffer *b = user;
    b->whole = whole;
    if (!whole)
        relume_buffer_destroy(b);
    return true;
}

struct relume_writer relume_buffer_writer(struct relume_buffer *buffer)
{
    return (struct relume_writer){write_buffer, finish_buffer, buffer};
}

void relume_buffer_destroy(struct relume_buffer *buffer)
{
    mem_free(buffer->data);
    *buffer = (struct relume_buffer){0};
}
