// outdir.h - folders, and files that others write, that appear whole or not at all
#ifndef BASE_OUTDIR_H
#define BASE_OUTDIR_H

#include <relume/base.h>

// A folder built beside its name (beside.h) and given it when it is whole, with a list of what is
// in it (inventory.h). An existing folder that is not empty is RELUME_EINVAL unless `force`; then
// it has to be one that relume made, with nothing else in it, and nothing of it may be read
// (inputs.h). Of several that are built at once the last to be whole has the name.
typedef struct relume_making outdir;
relume_status outdir_open(outdir **out, const char *path, bool force, const struct relume_log *log);
// The folder to write into until the commit.
const char *outdir_path(const outdir *dir);
relume_status outdir_commit(outdir **dir);
void outdir_abort(outdir **dir);
// Commit what a `status` of RELUME_OK says is whole, or abort; `*dir` may be NULL then.
relume_status outdir_end(outdir **dir, relume_status status);

#endif
