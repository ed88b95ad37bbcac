// fill.c - a folder for several pictures: one that is not there appears whole or not at all, one
// that is there gets its pictures one by one
#include "fill.h"

#include <sys/stat.h>

relume_status fill_open(struct fill *out, const char *path, const struct relume_log *log)
{
    struct stat s;
    *out = (struct fill){.path = path};
    if (!stat(path, &s) && S_ISDIR(s.st_mode))
        return RELUME_OK;
    const relume_status status =
        relume_making_open(&out->making, path, RELUME_MADE_FOLDER, false, log);
    if (!status)
        out->path = relume_making_path(out->making);
    return status;
}

relume_status fill_end(struct fill *fill, relume_status status)
{
    if (fill->making && !status)
        return relume_making_commit(&fill->making);
    relume_making_abort(&fill->making);
    return status;
}
