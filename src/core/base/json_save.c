// json_save.c - a JSON text as a file; apart from the writer, which web pages use without files
#include "core/base/json_write.h"

#include "core/base/memory.h"
#include "core/base/outfile.h"

relume_status jsave(struct jwriter *w, const char *path, const struct relume_log *log)
{
    const relume_status ended = jend(w);
    const relume_status status = ended ? ended : outfile_save(path, w->text, w->size, log);
    jdrop(w);
    return status;
}

relume_status jsave_in(struct jwriter *w, const char *folder, const char *name,
                       const struct relume_log *log)
{
    char *path = mem_format("%s/%s", folder, name);
    if (!path)
        jfail(w, RELUME_ENOMEM);
    const relume_status status = jsave(w, path, log);
    mem_free(path);
    return status;
}
