// outfile.h - files that appear whole or not at all
#ifndef BASE_OUTFILE_H
#define BASE_OUTFILE_H

#include <relume/context.h>
#include <sys/types.h>

// A file being written: without a name as long as the file system allows, then beside its final one
// (beside.h) and renamed. A link is followed, a file that is replaced leaves its permissions to the
// new one, and one that may not be written is refused, as is one that is read (inputs.h).
// In an unfinished folder (outdir.h) it has its name at once. For a target that is not a regular
// file (a device or a pipe) the bytes are gathered in a scratch file and copied at the end.
typedef struct outfile outfile;

// With `writer` (NULL: a file) the bytes go there, and `path` is only a name, or NULL.
relume_status outfile_open(outfile **out, const char *path, const struct relume_writer *writer,
                           const struct relume_log *log);
// All of `bytes` at `offset`. RELUME_EIO; the log has heard why.
relume_status outfile_write(outfile *file, const void *bytes, size_t size, off_t offset);
// Flush to disk and give the file its final name. Frees `*file` in every case; on failure nothing
// is left behind.
relume_status outfile_commit(outfile **file);
// Drop what was written. NULL is fine.
void outfile_abort(outfile **file);

// What stands where a file will be written: RELUME_EIO with a sentence when it is a folder or may
// not be written, RELUME_EINVAL when it is read. `path` is what the sentence calls it.
relume_status outfile_check(const char *target, const char *path, const struct relume_log *log);

// A whole file in one call, or a whole output.
relume_status outfile_save(const char *path, const void *bytes, size_t size,
                           const struct relume_log *log);
relume_status outfile_save_to(const char *path, const struct relume_writer *writer,
                              const void *bytes, size_t size, const struct relume_log *log);

#endif
