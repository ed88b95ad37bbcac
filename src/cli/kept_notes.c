// kept_notes.c - notes on a relume file that another one replaces
#include "kept_notes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Returns the list beside the file, or the one `inside`; NULL without one on this file.
static relume_notes *open_notes(const char *path, const relume_pack *pack, const char *inside)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const char *name = strrchr(path, '/');
    const struct relume_notes_file file = {.name = name ? name + 1 : path,
                                           .width = info->width,
                                           .height = info->height,
                                           .views = info->views,
                                           .inside = inside};
    relume_notes *notes;
    if (relume_notes_open(&notes, path, &file, NULL))
        return NULL;
    if (!relume_notes_count(notes))
        relume_notes_destroy(&notes);
    return notes;
}

static void forget(struct kept_notes *kept)
{
    relume_notes_destroy(&kept->notes);
    relume_pack_destroy(&kept->pack);
    free(kept->inside);
    *kept = (struct kept_notes){.pack = NULL};
}

void kept_notes_read(struct kept_notes *out, const char *path)
{
    *out = (struct kept_notes){.pack = NULL};
    if (relume_pack_open(&out->pack, path, NULL))  // it may be anything, or nothing
        return;
    const char *inside = relume_pack_info(out->pack)->notes;
    out->inside = inside ? strdup(inside) : NULL;
    out->notes = open_notes(path, out->pack, NULL);
    out->hidden = out->notes && inside;
    if (!out->notes && inside)
        out->notes = open_notes(path, out->pack, inside);
    if (!out->inside && !out->notes)
        forget(out);
}

static void print(const void *text, FILE *f)
{
    fputs(text, f);
}

// Writes a text to a file whose name begins as `path` does, and warns of it.
static relume_status put_beside(const char *text, const char *path, const char *end,
                                const char *why, const struct args *args)
{
    char *beside = NULL;
    if (asprintf(&beside, "%s%s", path, end) < 0)
        return RELUME_ENOMEM;
    const relume_status status = relume_file_print(beside, print, text, args->log);
    if (!status)
        announce(args, RELUME_WARNING, "%s: %s %s", path, why, beside);
    free(beside);
    return status;
}

static relume_status put_moved(const struct kept_notes *kept, const struct relume_rect *part,
                               const char *path, const struct args *args,
                               const struct relume_log *own)
{
    relume_notes *inside, *outside;
    char *text = NULL, *rest = NULL;
    relume_status status = relume_notes_crop(&inside, &outside, kept->notes, part);
    if (!status)
        status = relume_notes_text(&text, inside);
    if (!status)
        status = kept->inside && !kept->hidden ? relume_pack_keep_notes(path, text, own)
                                               : relume_notes_save(inside, path, own);
    if (!status && relume_notes_count(outside))
        status = relume_notes_text(&rest, outside);
    if (rest)
        status = put_beside(rest, path, ".notes-outside.json",
                            "notes beside the part that it shows now are in", args);
    relume_free(text);
    relume_free(rest);
    relume_notes_destroy(&inside);
    relume_notes_destroy(&outside);
    return status;
}

static relume_status put(const struct kept_notes *kept, const char *path, const struct args *args)
{
    struct relume_log own = *args->log;
    struct relume_rect part;
    relume_pack *pack = NULL;
    own.context = NULL;  // which knows the file as an output that is done
    if (relume_pack_open(&pack, path, NULL))
        return RELUME_OK;  // a part of a file, which has no notes
    const struct relume_pack_info *was = relume_pack_info(kept->pack), *is = relume_pack_info(pack);
    const bool known = kept->notes && relume_notes_part(&part, was, is);
    const bool same = was->width == is->width && was->height == is->height &&
                      was->views == is->views && (!known || (!part.left && !part.top));
    relume_status status = RELUME_OK;
    if (known && !same)
        status = put_moved(kept, &part, path, args, &own);
    if (!status && kept->inside && same)
        status = relume_pack_keep_notes(path, kept->inside, &own);
    else if (!status && kept->inside && (!known || kept->hidden))
        status = put_beside(
            kept->inside, path, ".notes-before.json",
            "the file that it replaces held notes on pictures of another size; they are in", args);
    relume_pack_destroy(&pack);
    return status;
}

relume_status kept_notes_write(struct kept_notes *kept, const char *path, relume_status status,
                               const struct args *args)
{
    if (!status && kept->pack && !(args->team && args->team->member))
        status = put(kept, path, args);
    forget(kept);
    return status;
}
