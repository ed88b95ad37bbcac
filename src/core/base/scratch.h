// scratch.h - temporary data on disk, in files without a name
#ifndef BASE_SCRATCH_H
#define BASE_SCRATCH_H

#include <relume/base.h>
#include <sys/types.h>

// A new file without a name for temporary data in the folder of `near` (NULL: $TMPDIR or /tmp).
// Returns the descriptor, or -1 with errno set. It vanishes when closed.
int scratch_open(const char *near);
// Whole reads and writes at an offset; false with errno set.
bool scratch_write(int fd, const void *bytes, size_t size, off_t offset);
bool scratch_read(int fd, void *bytes, size_t size, off_t offset);
// $TMPDIR or /tmp.
const char *scratch_folder(void);

// Zeroed scratch memory that lives in such a file beside `near`, so that the system may write it
// out; its space is taken at once. NULL with errno set. Ends with scratch_unmap.
void *scratch_map(const char *near, size_t size);
void scratch_unmap(void *memory, size_t size);
// Some bytes of it are not needed for now: they leave the memory of the process and stay in the
// file.
void scratch_forget(void *memory, size_t size, size_t first, size_t count);

#endif
