// annotations.c - notes that lie beside a file, or inside it, go into the site
#include "site/publish/annotations.h"

#include "core/base/tree.h"
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "site/publish/iiif.h"
#include "site/publish/names.h"

#include <errno.h>
#include <string.h>

relume_status annotations_open(relume_notes **out, const struct site *site, const char *path,
                               relume_pack *pack)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const struct relume_notes_file file = {.name = path_name(path),
                                           .width = info->width,
                                           .height = info->height,
                                           .views = info->views,
                                           .inside = info->notes};
    return relume_notes_open(out, path, &file, site->params->log);
}

// The list as its program wrote it, which the page reads; `inside`: the file's own, or NULL.
static relume_status copy(const struct site *site, const char *path, const char *inside,
                          const char *name)
{
    const size_t n = strlen(path);
    const bool exr = n > 4 && !strcmp(path + n - 4, ".exr");
    char *from = mem_format("%.*s.notes.json", (int)(exr ? n - 4 : n), path);
    char *to = mem_format("%s/notes.json", name);
    struct infile file;
    uint8_t *bytes = NULL;
    if (!from || !to) {
        mem_free(from);
        mem_free(to);
        return RELUME_ENOMEM;
    }
    relume_status status = RELUME_OK;
    if (inside && !input_exists(from, site->params->log)) {
        status = site_save_data(site, to, inside, strlen(inside));
    } else if (infile_open(&file, from, NULL, site->params->log)) {
        bytes = mem_array(file.size + 1, 1);
        const ssize_t got = bytes ? infile_read(&file, bytes, file.size, 0) : 0;
        status = !bytes ? RELUME_ENOMEM
                 : got != (ssize_t)file.size
                     ? log_fail(site->params->log, RELUME_EDAMAGED, "%s: cannot be read", from)
                     : site_save_data(site, to, bytes, file.size);
        infile_close(&file);
    } else {
        status = relume_input_fail(site->params->log, from, "cannot be opened", errno);
    }
    mem_free(bytes);
    mem_free(from);
    mem_free(to);
    return status;
}

static relume_status write_moved(const struct site *site, const relume_notes *notes,
                                 const char *name)
{
    char *to = mem_format("%s/notes.json", name), *text = NULL;
    relume_status status = to ? relume_notes_text(&text, notes) : RELUME_ENOMEM;
    if (!status)
        status = site_save_data(site, to, text, strlen(text));
    mem_free(text);
    mem_free(to);
    return status;
}

relume_status annotations_write(const struct site *site, const relume_notes *notes,
                                const char *path, const char *inside, const struct page *page,
                                bool moved)
{
    char *canvas = iiif_target(site, page);
    char *list = mem_format("%s/%s/iiif/notes.json", site->path, page->name);
    relume_status status = !canvas || !list ? RELUME_ENOMEM
                           : moved          ? write_moved(site, notes, page->name)
                                            : copy(site, path, inside, page->name);
    if (!status)
        status = relume_notes_write(notes, list, RELUME_NOTES_IIIF, canvas, site->log);
    mem_free(canvas);
    mem_free(list);
    return status;
}
