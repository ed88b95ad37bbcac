// crop.c - a part of a capture
#include "capture/manifest/capture.h"
#include "capture/manifest/provenance.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "image/geometry/geometry.h"

relume_status capture_crop(relume_capture *c, const struct relume_rect *part,
                           const struct relume_log *log)
{
    struct relume_manifest *m = &c->draft.m;
    if (m->slabs || m->geometry.projection > RELUME_SLAB)
        return log_fail(log, RELUME_EUNFIT,
                        "%s: has no parts by themselves; --crop expects planar images or one slab",
                        c->path);
    if (part->left < 0 || part->top < 0 || part->width < 1 || part->height < 1 ||
        part->width > c->width - part->left || part->height > c->height - part->top)
        return log_fail(log, RELUME_EINVAL,
                        "--crop %d,%d,%d,%d: expected a part of the images of %d x %d pixels",
                        part->left, part->top, part->width, part->height, c->width, c->height);
    if (m->provenance) {
        char *text = provenance_crop(m->provenance, part);
        m->provenance = text ? arena_text(&c->draft.arena, text) : NULL;
        mem_free(text);
        if (!m->provenance)
            return RELUME_ENOMEM;
    }
    geometry_crop(&m->geometry, c->width, c->height, part);
    c->part = *part;
    c->whole[0] = c->width;
    c->whole[1] = c->height;
    c->width = part->width;
    c->height = part->height;
    return RELUME_OK;
}
