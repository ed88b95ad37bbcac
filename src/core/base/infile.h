// infile.h - an input that is open: a file, or what the caller gives in place of one
// (relume/context.h)
#ifndef BASE_INFILE_H
#define BASE_INFILE_H

#include "core/base/context.h"

#include <pthread.h>
#include <stdio.h>
#include <sys/types.h>

// Files share descriptors: where there are more files than a process may have open, that which
// nobody has read for longest is closed, and opened again by its name when it is read.
struct infile {
    struct relume_reader from;         // `read` is NULL: a file
    const struct relume_files *files;  // that `from` is of, or NULL
    bool regular;                      // no folder, device or pipe
    uint64_t size;
    pthread_mutex_t lock;  // one call of `from.read` at a time
    // a file; under the lock of all
    char *path;
    int file;  // -1: closed for others' sake
    int users;
    dev_t device;
    ino_t number;
    struct infile *newer, *older;  // among those that have a descriptor, by their last use
};

// What sentences call an input or output: its path, or the name given in place of one.
const char *infile_name(const char *path);

// The input `path` of the log's context (context.h), or `from`, where that is not NULL. A file is
// noted (inputs.h), and pipes are not waited for. False with errno set; closing is fine in every
// case.
bool infile_open(struct infile *out, const char *path, const struct relume_reader *from,
                 const struct relume_log *log);
// How many of `size` bytes there are from `offset` on, now in `bytes`; -1 with errno set.
// Thread-safety: safe.
ssize_t infile_read(struct infile *s, void *bytes, size_t size, uint64_t offset);
// A descriptor of the bytes, to be closed: the file's, or that of a copy in memory; -1 with errno.
int infile_descriptor(struct infile *s);
void infile_close(struct infile *s);

// `path` alone: what it is (a name of the log's context is a file, whatever the file system has of
// that name); whether there is such an input; a stream of it, and a descriptor to be closed, NULL
// and -1 with errno.
enum input_kind { INPUT_NONE, INPUT_FILE, INPUT_FOLDER, INPUT_OTHER };
enum input_kind input_kind(const char *path, const struct relume_log *log);
bool input_exists(const char *path, const struct relume_log *log);
FILE *input_open(const char *path, const struct relume_log *log);
int input_descriptor(const char *path, const struct relume_log *log);

// A log in whose context `path` is what `from` reads, and all else as in `log`; `log` itself where
// `from` is NULL. `one` must live as long.
struct one_input {
    struct relume_log log;
    struct relume_context context;
    const struct relume_files *others;
    const char *path;
    const struct relume_reader *from;
};
const struct relume_log *one_input(struct one_input *one, const char *path,
                                   const struct relume_reader *from, const struct relume_log *log);

// All bytes of the input `path`, a regular file of at most `most`, and a zero behind them; else a
// sentence says that `expected` was expected.
relume_status input_load(char **out, size_t *size, const char *path, uint64_t most,
                         const char *expected, const struct relume_log *log);

// An input opened as a stream, from its beginning; NULL with errno set. `*in` (or NULL) is what the
// stream reads: it belongs to the stream, which has no descriptor of its own.
FILE *infile_stream(struct infile **in, const char *path, const struct relume_reader *from,
                    const struct relume_log *log);

#endif
