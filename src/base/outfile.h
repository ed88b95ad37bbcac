// outfile.h - outputs that appear whole or not at all, and scratch space on disk
#ifndef BASE_OUTFILE_H
#define BASE_OUTFILE_H

#include <relume/base.h>
#include <sys/types.h>

// A file being written beside its final name; for a target that is not a regular file (a device or
// a pipe) the bytes are gathered in a scratch file and copied at the end.
typedef struct outfile outfile;

relume_status outfile_open(outfile **out, const char *path, const struct relume_log *log);
// All of `bytes` at `offset`. RELUME_EIO; the log has heard why.
relume_status outfile_write(outfile *file, const void *bytes, size_t size, off_t offset);
// Flush to disk and give the file its final name. Frees `*file` in every case; on failure nothing
// is left behind.
relume_status outfile_commit(outfile **file);
// Drop what was written. NULL is fine.
void outfile_abort(outfile **file);

// A whole file in one call.
relume_status outfile_save(const char *path, const void *bytes, size_t size,
                           const struct relume_log *log);

// A folder built as DIR.part. An existing non-empty `path` is RELUME_EINVAL unless `force`.
typedef struct outdir outdir;
relume_status outdir_open(outdir **out, const char *path, bool force, const struct relume_log *log);
// The folder to write into until the commit.
const char *outdir_path(const outdir *dir);
relume_status outdir_commit(outdir **dir);
void outdir_abort(outdir **dir);
// Commit what a `status` of RELUME_OK says is whole, or abort; `*dir` may be NULL then.
relume_status outdir_end(outdir **dir, relume_status status);

// A new unlinked file for temporary data in the folder of `near` (NULL: $TMPDIR or /tmp).
// Returns the descriptor, or -1 with errno set. It vanishes when closed.
int scratch_open(const char *near);
// Whole reads and writes at an offset; false with errno set.
bool scratch_write(int fd, const void *bytes, size_t size, off_t offset);
bool scratch_read(int fd, void *bytes, size_t size, off_t offset);

// Zeroed scratch memory that lives in an unlinked file beside `near`, so that the system may write
// it out; its space is taken at once. NULL with errno set. Ends with scratch_unmap.
void *scratch_map(const char *near, size_t size);
void scratch_unmap(void *memory, size_t size);

#endif
