// read_view.c - the samples of one view: its codes, depth and mask
#include "base/memory.h"
#include "coder/codes.h"
#include "pack/format.h"
#include "pack/reader.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

// A part of numbers on its way into memory.
struct loading {
    const relume_pack *pack;
    char *data;  // [planes] of the rectangle
    int first, planes;
    size_t width;  // of the part
    struct relume_rect rect;
    atomic_bool wrong;
};

static void load_rows(void *context, int row, int rows, const void *samples)
{
    struct loading *l = context;
    const enum relume_storage storage = l->pack->info.storage;
    const struct relume_coder_info *coder = relume_coder_info(l->pack->coder);
    const struct relume_rect *r = &l->rect;
    const size_t sample = exr_sample_bytes(codes_sample(storage)), from = l->width * sample;
    const size_t n = (size_t)r->width, to = n * relume_storage_bytes(storage);
    const char *left = (const char *)samples + (size_t)r->left * sample;
    for (int y = row; y < row + rows; y++)
        for (int c = 0; c < l->planes; c++, left += from) {
            const int plane = l->first < 0 ? c : format_plane(coder, l->first + c) - l->first;
            if (y < r->top || y >= r->top + r->height)
                continue;
            char *at = l->data + ((size_t)plane * (size_t)r->height + (size_t)(y - r->top)) * to;
            if (!codes_from_samples(at, storage, left, n))
                atomic_store(&l->wrong, true);
        }
}

relume_status reader_load(relume_pack *p, int part, const struct relume_rect *rect, void *data,
                          int planes, int first)
{
    struct loading l = {
        .pack = p,
        .data = data,
        .first = first,
        .planes = planes,
        .width = (size_t)exr_part_info(p->file, part).width,
        .rect = *rect,
    };
    const relume_status status =
        exr_read_rows(p->file, part, rect->top, rect->height, p->threads, load_rows, &l, p->log);
    if (!status && atomic_load(&l.wrong))
        return reader_bad(p, "stored codes", "finite codes of the stated type");
    return status;
}

// Scale and offset of the planes, and of the one of the mask, whose codes are 0 and 1.
static void find_steps(float *steps, const relume_pack *p, int part, size_t planes)
{
    const size_t stored = (size_t)p->info.planes;
    const float *scale = reader_floats(p, part, ATTR_SCALE, p->info.planes);
    const float *offset = reader_floats(p, part, ATTR_OFFSET, p->info.planes);
    for (size_t i = 0; i < planes; i++) {
        steps[i] = i < stored ? scale[i] : 1.0f;
        steps[planes + i] = i < stored ? offset[i] : 0.0f;
    }
}

relume_status reader_load_planes(struct relume_codes_part *to, relume_pack *p, int view,
                                 const struct relume_rect *rect, const struct relume_codes *like)
{
    const size_t planes = (size_t)like->planes, stored = (size_t)p->info.planes;
    const int part = p->parts[view].codes;
    float *steps = mem_array(2 * planes, sizeof *steps);
    struct relume_codes stepped = *like;
    void *data;
    if (!steps)
        return RELUME_ENOMEM;
    find_steps(steps, p, p->coded ? 0 : part, planes);
    stepped.scale = steps;
    stepped.offset = steps + planes;
    relume_status status = codes_part_create(to, &data, &stepped, rect->width, rect->height);
    mem_free(steps);
    if (!status)
        status = p->coded ? reader_load_coded(p, view, rect, &to->codes, data)
                          : reader_load(p, part, rect, data, p->info.planes, 0);
    if (!status && planes > stored)
        status =
            reader_mask_plane(p, view, rect,
                              (char *)data + stored * (size_t)rect->width * (size_t)rect->height *
                                                 relume_storage_bytes(like->storage));
    return !status && p->coded ? reader_mask_codes(p, view, rect, &to->codes, data) : status;
}

struct plane_sink {
    struct relume_image *image;
    enum exr_sample sample;
    struct relume_rect rect;
    size_t width;  // of the part
};

static void plane_rows(void *context, int row, int rows, const void *samples)
{
    const struct plane_sink *s = context;
    const struct relume_rect *r = &s->rect;
    const size_t sample = exr_sample_bytes(s->sample), n = (size_t)r->width;
    const char *from = (const char *)samples + (size_t)r->left * sample;
    for (int y = row; y < row + rows; y++, from += s->width * sample)
        if (y >= r->top && y < r->top + r->height)
            exr_to_floats(s->image->data + (size_t)(y - r->top) * n, s->sample, from, n);
}

relume_status reader_load_plane(struct relume_image *out, relume_pack *pack, int part,
                                const struct relume_rect *rect)
{
    *out = (struct relume_image){0};
    if (part < 0)
        return RELUME_OK;
    relume_status status = relume_image_create(out, rect->width, rect->height, 1);
    if (status)
        return status;
    struct plane_sink sink = {out, exr_part_info(pack->file, part).sample, *rect,
                              (size_t)pack->info.width};
    status = exr_read_rows(pack->file, part, rect->top, rect->height, pack->threads, plane_rows,
                           &sink, pack->log);
    const size_t n = (size_t)out->width * (size_t)out->height;
    for (size_t i = 0; !status && i < n; i++)
        if (!(out->data[i] >= 0.0f))
            status = reader_bad(pack, "depth or mask", "values of 0 or more");
    if (status)
        relume_image_destroy(out);
    return status;
}

relume_status relume_pack_depth(struct relume_image *out, relume_pack *pack, int view)
{
    *out = (struct relume_image){0};
    if (view < 0 || view >= pack->info.views)
        return RELUME_EINVAL;
    const struct relume_rect all = reader_whole(pack);
    if (pack->parts[view].depth_words.count)
        return reader_load_coded_depth(out, pack, view);
    return reader_load_plane(out, pack, pack->parts[view].depth, &all);
}

relume_status relume_pack_mask(struct relume_image *out, relume_pack *pack, int view)
{
    *out = (struct relume_image){0};
    if (view < 0 || view >= pack->info.views)
        return RELUME_EINVAL;
    const struct relume_rect all = reader_whole(pack);
    return reader_load_plane(out, pack, pack->parts[view].mask, &all);
}
