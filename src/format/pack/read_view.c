// read_view.c - the samples of one view: its codes, depth and mask
#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "format/coder/codes.h"
#include "format/coder/coding.h"
#include "format/pack/format.h"
#include "format/pack/reader.h"
#include "format/pack/views.h"
#include "image/image/piz.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// A part of numbers on its way into memory.
struct loading {
    const relume_pack *pack;
    char *data;  // [planes] of the rectangle
    int first, planes;
    struct relume_rect rect;
};

static bool convert(void *context, void *codes, const void *samples, size_t n)
{
    const struct loading *l = context;
    return codes_from_samples(codes, l->pack->info.storage, samples, n);
}

static void load_block(void *context, const struct relume_rect *at, const void *codes)
{
    const struct loading *l = context;
    const enum relume_storage storage = l->pack->info.storage;
    const struct relume_coder_info *coder = relume_coder_info(l->pack->coder);
    const struct relume_rect *r = &l->rect, some = exr_overlap(at, r);
    const size_t code = relume_storage_bytes(storage);
    for (int y = some.top; y < some.top + some.height; y++)
        for (int c = 0; c < l->planes; c++) {
            const int plane = l->first < 0 ? c : format_plane(coder, l->first + c) - l->first;
            const void *from = exr_samples(codes, at, &some, y, l->planes, c, code);
            const size_t row = (size_t)plane * (size_t)r->height + (size_t)(y - r->top);
            char *to = l->data + (row * (size_t)r->width + (size_t)(some.left - r->left)) * code;
            memcpy(to, from, (size_t)some.width * code);
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
        .rect = *rect,
    };
    const struct piz_conversion to = {convert, &l, relume_storage_bytes(p->info.storage)};
    bool wrong;
    const relume_status status =
        exr_read_codes(p->file, part, rect, p->threads, &to, &wrong, load_block, &l, p->log);
    if (!status && wrong)
        return reader_bad(p, "stored codes", "finite codes of the stated type");
    return status;
}

// Scale and offset of the planes, and of the one of the mask, whose codes are 0 and 1, or parts of
// the largest code.
static void find_steps(float *steps, const relume_pack *p, int part, int level, size_t planes)
{
    const size_t stored = (size_t)p->info.planes;
    const int top = level ? relume_storage_top(p->info.storage) : 0;
    const float *scale = reader_floats(p, part, ATTR_SCALE, p->info.planes);
    const float *offset = reader_floats(p, part, ATTR_OFFSET, p->info.planes);
    for (size_t i = 0; i < planes; i++) {
        steps[i] = i < stored ? scale[i] : top ? 1.0f / (float)top : 1.0f;
        steps[planes + i] = i < stored ? offset[i] : 0.0f;
    }
}

relume_status reader_load_planes(struct relume_codes_part *to, relume_pack *p, int view, int level,
                                 const struct relume_rect *rect, const struct relume_codes *like)
{
    const size_t planes = (size_t)like->planes, stored = (size_t)p->info.planes;
    const int part = level ? p->parts[view].level[level - 1] : p->parts[view].codes;
    float *steps = mem_array(2 * planes, sizeof *steps);
    struct relume_codes stepped = *like;
    void *data;
    if (!steps)
        return RELUME_ENOMEM;
    find_steps(steps, p, p->coded && level < 2 ? 0 : part, level, planes);
    stepped.scale = steps;
    stepped.offset = steps + planes;
    relume_status status = codes_part_create(to, &data, &stepped, rect->width, rect->height);
    mem_free(steps);
    if (!status && p->coded && level == 1)
        return reader_load_halved(p, view, rect, like, data);
    if (!status)
        status = p->coded ? reader_load_coded(p, view, level, rect, &to->codes, data)
                          : reader_load(p, part, rect, data, p->info.planes, 0);
    if (!status && planes > stored)
        status =
            reader_mask_plane(p, view, level, rect,
                              (char *)data + stored * (size_t)rect->width * (size_t)rect->height *
                                                 relume_storage_bytes(like->storage));
    return !status && p->coded ? reader_mask_codes(p, view, level, rect, &to->codes, data) : status;
}

struct plane_sink {
    struct relume_image *image;
    enum exr_sample sample;
    struct relume_rect rect;
};

static void plane_block(void *context, const struct relume_rect *at, const void *samples)
{
    const struct plane_sink *s = context;
    const struct relume_rect *r = &s->rect, some = exr_overlap(at, r);
    for (int y = some.top; y < some.top + some.height; y++)
        exr_to_floats(
            s->image->data + (size_t)(y - r->top) * (size_t)r->width + some.left - r->left,
            s->sample, exr_samples(samples, at, &some, y, 1, 0, exr_sample_bytes(s->sample)),
            (size_t)some.width);
}

// What was read of depth or of a mask, when it is such values.
static relume_status end_plane(struct relume_image *out, const relume_pack *pack,
                               relume_status status)
{
    const size_t n = (size_t)out->width * (size_t)out->height;
    for (size_t i = 0; !status && i < n; i++)
        if (!(out->data[i] >= 0.0f))
            status = reader_bad(pack, "depth or mask", "values of 0 or more");
    if (status)
        relume_image_destroy(out);
    return status;
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
    struct plane_sink sink = {out, exr_part_info(pack->file, part).sample, *rect};
    status = exr_read(pack->file, part, rect, pack->threads, plane_block, &sink, pack->log);
    return end_plane(out, pack, status);
}

relume_status relume_pack_depth(struct relume_image *out, relume_pack *pack, int view)
{
    *out = (struct relume_image){0};
    if (view < 0 || view >= pack->info.views)
        return RELUME_EINVAL;
    if (pack->parts[view].depth_words.count)
        return reader_load_coded_depth(out, pack, view);
    return reader_load_plane(out, pack, pack->parts[view].depth, &pack->shown);
}

// Colours and thicknesses of 0 or more, the rest finite.
static bool is_sound_shadow(const struct relume_image *image)
{
    const size_t n = (size_t)image->width * (size_t)image->height;
    bool sound = true;
    for (size_t i = 0; i < n * RELUME_SHADOW_CHANNELS; i++) {
        const size_t channel = i % RELUME_SHADOW_CHANNELS;
        const float value = image->data[i];
        sound &= channel >= RELUME_SHADOW_MATTE   ? isfinite(value) != 0
                 : channel == RELUME_SHADOW_THICK ? value >= 0.0f
                                                  : value >= 0.0f && isfinite(value);
    }
    return sound;
}

// Finite, and but for normals and reflectances 0 or more.
static bool is_sound_gloss(const struct relume_image *image)
{
    const size_t n = (size_t)image->width * (size_t)image->height;
    bool sound = true;
    for (size_t i = 0; i < n; i++) {
        const float *p = image->data + RELUME_GLOSS_CHANNELS * i;
        for (int c = 0; c < RELUME_GLOSS_CHANNELS; c++)
            sound &= isfinite(p[c]) && (p[c] >= 0.0f || c == RELUME_GLOSS_NORMAL ||
                                        c == RELUME_GLOSS_NORMAL + 1 || c == RELUME_GLOSS_SHINE);
    }
    return sound;
}

relume_status relume_pack_shadow(struct relume_image *out, relume_pack *pack, int view)
{
    *out = (struct relume_image){0};
    if (view < 0 || view >= pack->info.views)
        return RELUME_EINVAL;
    if (pack->parts[view].shadow < 0)
        return RELUME_OK;
    relume_status status = reader_load_learnt(out, pack, pack->parts[view].shadow, LEARNT_SHADOW);
    if (!status && !is_sound_shadow(out))
        status = reader_bad(pack, "shadow", "finite colours and a thickness, of 0 or more");
    if (status)
        relume_image_destroy(out);
    return status;
}

// Takes highlights away where the mask leaves pixels out.
static relume_status mask_gloss(struct relume_image *gloss, relume_pack *pack, int view)
{
    struct relume_image mask;
    const relume_status status = relume_pack_mask(&mask, pack, view);
    const size_t pixels = (size_t)gloss->width * (size_t)gloss->height;
    for (size_t i = 0; !status && mask.data && i < pixels; i++)
        if (!(mask.data[i] > 0.5f)) {
            float *p = gloss->data + RELUME_GLOSS_CHANNELS * i;
            p[RELUME_GLOSS_SHINE] = 0.0f;
            for (int c = 0; c < 3; c++)
                p[RELUME_GLOSS_COLOUR + c] = 0.0f;
        }
    relume_image_destroy(&mask);
    return status;
}

relume_status relume_pack_gloss(struct relume_image *out, relume_pack *pack, int view)
{
    *out = (struct relume_image){0};
    if (view < 0 || view >= pack->info.views)
        return RELUME_EINVAL;
    if (!pack->info.has_gloss)
        return RELUME_OK;
    relume_status status = reader_load_learnt(out, pack, pack->gloss, LEARNT_GLOSS);
    if (!status && !is_sound_gloss(out))
        status =
            reader_bad(pack, "gloss", "finite numbers; colours, roughness and share 0 or more");
    if (!status)
        status = mask_gloss(out, pack, view);
    if (status)
        relume_image_destroy(out);
    return status;
}

struct picking {
    struct relume_image *image;
    struct relume_rect whole;
    int level;
};

// The pixel of the view beside the middle of pixel `i` of a level; at the end the last.
static int middle(int i, int level, int side)
{
    const int at = (i << level) + (1 << level >> 1);
    return at < side ? at : side - 1;
}

static void pick_block(void *context, const struct relume_rect *at, const void *samples)
{
    const struct picking *p = context;
    const struct relume_image *to = p->image;
    const int l = p->level, right = at->left + at->width, bottom = at->top + at->height;
    const float *from = samples;
    for (int y = (at->top >> l) - (at->top > 0); y < to->height && y << l < bottom; y++) {
        const int row = middle(y, l, p->whole.height);
        if (row < at->top || row >= bottom)
            continue;
        for (int x = (at->left >> l) - (at->left > 0); x < to->width && x << l < right; x++) {
            const int column = middle(x, l, p->whole.width);
            if (column >= at->left && column < right)
                to->data[(size_t)y * (size_t)to->width + (size_t)x] =
                    from[(size_t)(row - at->top) * (size_t)at->width + (size_t)(column - at->left)];
        }
    }
}

static relume_status pick_coded(struct picking *p, relume_pack *pack, int view)
{
    struct relume_image whole;
    const relume_status status = reader_load_coded_depth(&whole, pack, view);
    if (!status)
        pick_block(p, &p->whole, whole.data);
    relume_image_destroy(&whole);
    return status;
}

relume_status relume_pack_depth_level(struct relume_image *out, relume_pack *pack, int view,
                                      int level)
{
    struct picking picking = {out, pack->shown, level};
    int width, height;
    *out = (struct relume_image){0};
    if (!level)
        return relume_pack_depth(out, pack, view);
    if (view < 0 || view >= pack->info.views || level < 0 || level > pack->info.levels)
        return RELUME_EINVAL;
    const int part = pack->parts[view].depth;
    if (part < 0)
        return RELUME_OK;
    relume_pack_level_size(&width, &height, pack, level);
    relume_status status = relume_image_create(out, width, height, 1);
    if (!status)
        status =
            pack->parts[view].depth_words.count
                ? pick_coded(&picking, pack, view)
                : exr_read(pack->file, part, NULL, pack->threads, pick_block, &picking, pack->log);
    return end_plane(out, pack, status);
}

relume_status relume_pack_mask(struct relume_image *out, relume_pack *pack, int view)
{
    *out = (struct relume_image){0};
    if (view < 0 || view >= pack->info.views)
        return RELUME_EINVAL;
    return reader_load_plane(out, pack, pack->parts[view].mask, &pack->shown);
}
