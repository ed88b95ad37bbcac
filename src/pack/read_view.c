// read_view.c - the samples of one view: its codes, depth and mask
#include "base/log.h"
#include "base/memory.h"
#include "coder/codes.h"
#include "lossy/lossy.h"
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

struct word_rows {
    uint32_t *word;
    size_t width;
};

static void load_words(void *context, int row, int rows, const void *samples)
{
    const struct word_rows *to = context;
    memcpy(to->word + (size_t)row * to->width, samples,
           (size_t)rows * to->width * sizeof *to->word);
}

// What is said of the tiles of a view that cannot be decoded.
struct losing {
    const relume_pack *pack;
    const char *part;
    const struct relume_codes *codes;
    uint16_t *data;
    int side;                // of a tile
    int count, column, row;  // how many, and which is the first
};

static uint16_t code_of_nothing(const struct relume_codes *codes, int plane)
{
    const float code = rintf(-codes->offset[plane] / codes->scale[plane]);
    return (uint16_t)fminf(fmaxf(code, 0.0f), (float)relume_storage_top(codes->storage));
}

static void lose_tile(void *context, int x, int y, int width, int height)
{
    struct losing *l = context;
    const struct relume_pack_check_params *check = l->pack->check;
    const struct relume_rect at = {x, y, width, height};
    const int column = x / l->side, row = y / l->side;
    if (l->count++ == 0) {
        l->column = column;
        l->row = row;
    }
    if (check && check->tile)
        check->tile(check->user, l->part, column, row, &at);
    for (int p = 0; p < l->pack->info.planes; p++) {
        const uint16_t nothing = code_of_nothing(l->codes, p);
        for (int j = 0; j < height; j++)
            for (int i = 0; i < width; i++)
                l->data[((size_t)p * (size_t)l->codes->height + (size_t)(y + j)) *
                            (size_t)l->codes->width +
                        (size_t)(x + i)] = nothing;
    }
}

static relume_status say_lost(const struct losing *l)
{
    const relume_pack *p = l->pack;
    char more[32] = "";
    if (l->count > 1)
        snprintf(more, sizeof more, " and %d more", l->count - 1);
    if (!p->keep_going)
        return log_fail(
            p->log, RELUME_EDAMAGED,
            "%s: damaged: the tile in column %d, row %d of part '%s'%s; expected sound AV1 "
            "data; --keep-going shows the rest",
            p->path, l->column, l->row, l->part, more);
    if (!p->check)
        log_line(p->log, RELUME_WARNING,
                 "%s: damaged: the tile in column %d, row %d of part '%s'%s; shown without it",
                 p->path, l->column, l->row, l->part, more);
    return RELUME_OK;
}

// Planes that were coded with loss, black again where the mask says so.
static relume_status load_coded(relume_pack *p, int view, const struct relume_codes *codes,
                                uint16_t *data)
{
    const int part = p->parts[view].codes;
    const struct exr_part_info info = exr_part_info(p->file, part);
    const size_t count = (size_t)info.width * (size_t)info.height;
    struct word_rows words = {mem_array(count, sizeof *words.word), (size_t)info.width};
    int *order = lossy_order(p->coder);
    const struct lossy_shape shape = {p->info.width, p->info.height, p->info.planes,
                                      lossy_in_colour(p->coder), order};
    struct losing losing = {p, info.name, codes, data, 1, 0, 0, 0};
    const struct lossy_lost lost = {lose_tile, &losing};
    relume_status status = words.word
                               ? exr_read(p->file, part, p->threads, load_words, &words, p->log)
                               : RELUME_ENOMEM;
    if (!status) {
        losing.side = count > 1 && words.word[1] ? (int)words.word[1] : 1;  // docs/format.md
        status = lossy_decode(data, &shape, words.word, count, p->threads, &lost);
    }
    if (status == RELUME_EDAMAGED)
        status = reader_bad(p, info.name, "tiles of sound AV1 data");
    if (!status && losing.count)
        status = say_lost(&losing);
    mem_free(words.word);
    mem_free(order);
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
    find_steps(steps, p, part, planes);
    stepped.scale = steps;
    stepped.offset = steps + planes;
    relume_status status = codes_part_create(to, &data, &stepped, rect->width, rect->height);
    mem_free(steps);
    if (!status)
        status = p->coded ? load_coded(p, view, &to->codes, data)
                          : reader_load(p, part, rect, data, p->info.planes, 0);
    if (!status && planes > stored)
        status =
            reader_mask_plane(p, view, rect,
                              (char *)data + stored * (size_t)rect->width * (size_t)rect->height *
                                                 relume_storage_bytes(like->storage));
    return !status && p->coded ? reader_mask_codes(p, view, &to->codes, data) : status;
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
