// infile.h - an input that is open: a file, or what the caller gives in place of one (relume/io.h)
#ifndef BASE_INFILE_H
#define BASE_INFILE_H

#include <relume/io.h>

#include <pthread.h>
#include <stdio.h>
#include <sys/types.h>

// Files share descriptors: where there are more files than a process may have open, that which
// nobody has read for longest is closed, and opened again by its name when it is read.
struct infile {
    struct relume_reader from;  // `read` is NULL: a file
    bool regular;               // no folder, device or pipe
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

// What sentences call an input or output: its path, or what stands for one.
const char *infile_name(const char *path);

// The file `path`, noted in the log's inputs (pipes are not waited for), or `from`, where that is
// not NULL. False with errno set; closing is fine in every case.
bool infile_open(struct infile *out, const char *path, const struct relume_reader *from,
                 const struct relume_log *log);
// How many of `size` bytes there are from `offset` on, now in `bytes`; -1 with errno set.
// Thread-safety: safe.
ssize_t infile_read(struct infile *s, void *bytes, size_t size, uint64_t offset);
// A descriptor of the bytes, to be closed: the file's, or that of a copy in memory; -1 with errno.
int infile_descriptor(struct infile *s);
void infile_close(struct infile *s);

// The same opened as a stream, from its beginning; NULL with errno set. `*in` (or NULL) is what the
// stream reads: it belongs to the stream, which has no descriptor of its own.
FILE *infile_stream(struct infile **in, const char *path, const struct relume_reader *from,
                    const struct relume_log *log);

#endif
