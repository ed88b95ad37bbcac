// memory.h - allocation with checked sizes, and the limits of sizes read from files
#ifndef BASE_MEMORY_H
#define BASE_MEMORY_H

#include <relume/base.h>
#include <stdlib.h>

// count * size bytes, NULL when that overflows or memory is short. Free with mem_free().
// Never returns NULL for a count of 0.
void *mem_array(size_t count, size_t size);
void *mem_zeroed(size_t count, size_t size);
// `old` (which may be NULL) for more or fewer items; on NULL it stays as it was.
void *mem_resize(void *old, size_t count, size_t size);
// Memory for one more item behind `count` in the array that *array points to, which only this has
// grown since it was NULL: it holds 16, or the next power of two. False when memory is
// short; then nothing has changed.
bool mem_grow(void *array, size_t count, size_t size);
void *mem_copy(const void *from, size_t count, size_t size);
char *mem_text(const char *text);
// Memory of its own pages, large ones where the system has them: far fewer faults.
void *mem_large(size_t bytes);
// For a library that takes an allocator and may go on without: no test lets this fail.
void *mem_lend(size_t bytes);
// All memory of the above, and NULL.
void mem_free(void *memory);
// What the C library or a library of others allocated: getline, open_memstream, scandir, realpath.
void mem_free_libc(void *memory);
// A copy of such a text, which is freed; NULL of NULL.
char *mem_take(char *text);
// A new string like printf's, NULL when memory is short.
__attribute__((format(printf, 1, 2))) char *mem_format(const char *format, ...);

// For tests: let the n-th allocation from now on fail (0 switches that off).
void mem_fail_after(long n);
// Whether that failure is still to come.
bool mem_fail_pending(void);

// What counts where a call has limits of its own, or NULL, and a log, or NULL.
const struct relume_limits *limits_of(const struct relume_limits *own,
                                      const struct relume_log *log);
// `limits` with defaults filled in; NULL gives all defaults.
struct relume_limits limits_or_default(const struct relume_limits *limits);
// Whether an image of that size is allowed.
bool limits_allow(const struct relume_limits *limits, int64_t width, int64_t height);
// The same of the picture in `path`: RELUME_ELIMIT with a sentence.
relume_status limits_picture(const struct relume_limits *limits, const char *path, int64_t width,
                             int64_t height, const struct relume_log *log);
// RELUME_ELIMIT with a sentence when `what` takes more bytes than one picture, view or model may by
// these limits, or where they are NULL by those of the log's context.
relume_status limits_memory(const struct relume_limits *limits, uint64_t bytes, const char *what,
                            const struct relume_log *log);
// For people, in MB of 2^20 bytes, rounded up, unless `beside` would look the same: "12 MB".
struct memory_size {
    char text[32];
};
struct memory_size memory_text(uint64_t bytes, uint64_t beside);

#endif
