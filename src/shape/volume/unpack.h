// unpack.h - the bytes of a file from some place on, one after the other, unpacked where gzip has
// packed them; the only door to zlib's inflate of volumes
#ifndef VOLUME_UNPACK_H
#define VOLUME_UNPACK_H

#include <relume/base.h>
#include <sys/types.h>

typedef struct unpack unpack;

// `packed`: whether the bytes are packed; NULL: as the first two say. An input status with a
// sentence, RELUME_ENOMEM.
relume_status unpack_open(unpack **out, const char *path, uint64_t offset, const bool *packed,
                          const struct relume_log *log);
void unpack_close(unpack **u);
// How many bytes there are from here on: of files that are not packed.
bool unpack_left(const unpack *u, uint64_t *bytes);
// RELUME_EUNFIT with a sentence where so many bytes cannot come from here on, as far as the size of
// the file says.
relume_status unpack_expect(const unpack *u, uint64_t bytes, const char *expected);
// The next `size` bytes; `*got` is less at the end only. An input status with a sentence.
relume_status unpack_read(unpack *u, void *bytes, size_t size, size_t *got);
// All of them; else RELUME_EUNFIT with a sentence that `expected` was.
relume_status unpack_all(unpack *u, void *bytes, size_t size, const char *expected);
relume_status unpack_skip(unpack *u, uint64_t bytes, const char *expected);

#endif
