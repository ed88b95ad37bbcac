// notes.c - notes that a relume file holds itself: its header is written anew, its blocks are
// copied
#include "core/base/log.h"
#include "core/base/memory.h"
#include "format/pack/format.h"
#include "format/pack/views.h"
#include "image/image/exr.h"

#include <relume/pack.h>

#include <string.h>

// The first part's attributes with these notes in place of any.
static relume_status put(struct exr_part *part, const char *notes, struct arena *arena)
{
    struct exr_attribute *all = arena_array(arena, (size_t)part->attributes + 1, sizeof *all);
    int n = 0;
    if (!all)
        return RELUME_ENOMEM;
    for (int i = 0; i < part->attributes; i++)
        if (strcmp(part->attribute[i].name, ATTR_NOTES))
            all[n++] = part->attribute[i];
    if (notes)
        all[n++] = (struct exr_attribute){.name = ATTR_NOTES, .kind = EXR_TEXT, .text = notes};
    part->attribute = all;
    part->attributes = n;
    return RELUME_OK;
}

static relume_status rewrite(const exr_file *file, const char *path, const char *notes,
                             struct arena *arena, const struct relume_log *log)
{
    const int count = exr_part_count(file);
    struct exr_part *part = arena_array(arena, (size_t)count, sizeof *part);
    relume_status status = part ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < count; i++)
        status = exr_part_again(&part[i], file, i, arena);
    if (!status)
        status = put(part, notes, arena);
    if (status == RELUME_EDAMAGED)
        return log_fail(log, status, "%s: has parts that this relume cannot copy", path);
    return status ? status : exr_write(path, NULL, part, count, exr_has_sums(file), 1, log);
}

relume_status relume_pack_keep_notes(const char *path, const char *notes,
                                     const struct relume_log *log)
{
    struct relume_log own = log ? *log : (struct relume_log){0};
    struct arena arena = {0};
    exr_file *file = NULL;
    if (notes && strlen(notes) > RELUME_PACK_MOST_NOTES)
        return log_fail(log, RELUME_ELIMIT, "%s: the notes have %zu bytes; a file holds at most %d",
                        path, strlen(notes), RELUME_PACK_MOST_NOTES);
    own.leave_unnoted = true;  // it takes its own place
    relume_status status = exr_open(&file, path, NULL, NULL, &own);
    if (!status && !exr_get_text(file, 0, ATTR_FORMAT))
        status = log_fail(log, RELUME_EFORMAT,
                          "%s: notes go into relume files; this is another EXR", path);
    if (!status)
        status = rewrite(file, path, notes, &arena, &own);
    exr_close(&file);
    arena_free(&arena);
    return status;
}
