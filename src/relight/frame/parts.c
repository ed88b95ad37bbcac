// parts.c - rectangles of views that are kept, where a frame reads little of each
#include "relight/frame/parts.h"

#include "core/base/memory.h"
#include "format/coder/coding.h"
#include "image/image/image.h"

uint64_t parts_codes_bytes(const struct relume_codes *codes)
{
    const size_t size = codes->books ? 2 : relume_storage_bytes(codes->storage);
    return (uint64_t)codes->width * (uint64_t)codes->height * size *
           (uint64_t)(codes->books ? codes->books : codes->planes);
}

uint64_t parts_bytes(const struct parts *p, int view)
{
    if (!p)
        return 0;
    const struct part *part = &p->part[view];
    return image_bytes(&p->image[view]) + image_bytes(&p->disparity[view]) +
           image_bytes(&part->surface) +
           (part->codes.memory ? parts_codes_bytes(&part->codes.codes) : 0);
}

void parts_drop_codes(struct parts *p, int view)
{
    if (p)
        relume_codes_part_destroy(&p->part[view].codes);
}

void parts_forget(struct parts *p, int view)
{
    if (!p)
        return;
    parts_drop_codes(p, view);
    relume_image_destroy(&p->part[view].surface);
    relume_image_destroy(&p->image[view]);
    relume_image_destroy(&p->disparity[view]);
    p->part[view].lit = 0;
    p->at[view] = (struct relume_rect){0};
}

relume_status parts_create(struct parts **out, int views)
{
    const size_t n = (size_t)views;
    struct parts *p = *out = mem_zeroed(1, sizeof *p);
    if (!p)
        return RELUME_ENOMEM;
    p->part = mem_zeroed(n, sizeof *p->part);
    p->at = mem_zeroed(n, sizeof *p->at);
    p->image = mem_zeroed(n, sizeof *p->image);
    p->disparity = mem_zeroed(n, sizeof *p->disparity);
    if (p->part && p->at && p->image && p->disparity) {
        p->views = views;
        return RELUME_OK;
    }
    parts_destroy(out);
    return RELUME_ENOMEM;
}

void parts_destroy(struct parts **parts)
{
    struct parts *p = *parts;
    *parts = NULL;
    if (!p)
        return;
    for (int i = 0; i < p->views; i++)
        parts_forget(p, i);
    mem_free(p->part);
    mem_free(p->at);
    mem_free(p->image);
    mem_free(p->disparity);
    mem_free(p);
}
