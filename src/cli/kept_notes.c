// kept_notes.c - notes inside a relume file that another one replaces
#include "kept_notes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void kept_notes_read(struct kept_notes *out, const char *path)
{
    relume_pack *pack = NULL;
    *out = (struct kept_notes){.text = NULL};
    if (relume_pack_open(&pack, path, NULL))  // it may be anything, or nothing
        return;
    const struct relume_pack_info *info = relume_pack_info(pack);
    if (info->notes)
        *out = (struct kept_notes){strdup(info->notes), info->width, info->height, info->views};
    relume_pack_destroy(&pack);
}

static void print(const void *text, FILE *f)
{
    fputs(text, f);
}

static relume_status put(const struct kept_notes *kept, const char *path, const struct args *args)
{
    struct relume_log own = *args->log;
    relume_pack *pack = NULL;
    char *beside = NULL;
    own.context = NULL;  // which knows the file as an output that is done
    relume_status status = relume_pack_open(&pack, path, NULL);
    if (status)
        return RELUME_OK;  // a part of a file, which has no notes
    const struct relume_pack_info *info = relume_pack_info(pack);
    const bool same =
        info->width == kept->width && info->height == kept->height && info->views == kept->views;
    relume_pack_destroy(&pack);
    if (same)
        return relume_pack_keep_notes(path, kept->text, &own);
    if (asprintf(&beside, "%s.notes-before.json", path) < 0)
        return RELUME_ENOMEM;
    status = relume_file_print(beside, print, kept->text, args->log);
    if (!status)
        announce(
            args, RELUME_WARNING,
            "%s: the file that it replaces held notes on pictures of another size; they are in %s",
            path, beside);
    free(beside);
    return status;
}

relume_status kept_notes_write(struct kept_notes *kept, const char *path, relume_status status,
                               const struct args *args)
{
    if (!status && kept->text && !(args->team && args->team->member))
        status = put(kept, path, args);
    free(kept->text);
    *kept = (struct kept_notes){.text = NULL};
    return status;
}
