// open.c - the shadows or highlights that a file keeps for a view
#include "core/base/log.h"
#include "format/pack/reader.h"
#include "relight/shadow/moving.h"

static relume_status open_shadow(relume_shadows **out, relume_pack *pack, int view)
{
    struct relume_image depth = {0}, model;
    relume_status status = relume_pack_shadow(&model, pack, view);
    if (!status && model.data)
        status = relume_pack_depth(&depth, pack, view);
    if (!status && model.data)
        status = relume_shadows_create(out, relume_pack_geometry(pack, view), pack->info.uv[view],
                                       &depth, &model);
    if (status == RELUME_EINVAL)
        status = reader_bad(pack, "shadow", "none in views of this projection");
    relume_image_destroy(&depth);
    relume_image_destroy(&model);
    return status;
}

static relume_status open_gloss(relume_shadows **out, relume_pack *pack)
{
    struct relume_image model;
    relume_status status = relume_pack_gloss(&model, pack, 0);
    if (!status)
        status = relume_gloss_create(out, &model);
    relume_image_destroy(&model);
    return status;
}

// Opens a model; with `keep_going` a damaged one is a warning, and the file then counts as one
// without it.
static relume_status open_or_lose(relume_shadows **out, relume_pack *pack, int view, int *part)
{
    const struct relume_log *const log = pack->log;
    if (pack->keep_going)
        pack->log = NULL;
    const relume_status status =
        part == &pack->gloss ? open_gloss(out, pack) : open_shadow(out, pack, view);
    pack->log = log;
    if (status != RELUME_EDAMAGED || !pack->keep_going)
        return status;
    log_line(log, RELUME_WARNING, "%s: damaged part '%s'; shown without it", pack->path,
             exr_part_info(pack->file, *part).name);
    *part = -1;
    return RELUME_OK;
}

relume_status relume_shadows_open(relume_shadows **out, relume_pack *pack, int view)
{
    *out = NULL;
    if (view < 0 || view >= pack->info.views)
        return RELUME_EINVAL;
    int *part = pack->info.has_gloss ? &pack->gloss : &pack->parts[view].shadow;
    return *part < 0 ? RELUME_OK : open_or_lose(out, pack, view, part);
}
