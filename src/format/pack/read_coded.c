// read_coded.c - views whose planes are coded with loss: where they lie in the parts of their
// groups, and what they hold
#include "core/base/log.h"
#include "core/base/memory.h"
#include "format/lossy/disparity.h"
#include "format/pack/format.h"
#include "format/pack/reader.h"
#include "format/pack/views.h"
#include "format/pack/words.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// ---------------------------------------------------------------- where they lie

// One member of a group: "VIEW WORDS DEPTH-WORDS", one blank between numbers.
static bool next_member(const char **text, unsigned long long n[3])
{
    for (int i = 0; i < 3; i++) {
        char *end;
        if (**text < '0' || **text > '9')
            return false;
        n[i] = strtoull(*text, &end, 10);
        *text = *end == ' ' ? end + 1 : end;
    }
    return true;
}

static relume_status find_members(relume_pack *p, int part)
{
    const struct exr_part_info info = exr_part_info(p->file, part);
    const unsigned long long words = (unsigned long long)info.width * (unsigned)info.height;
    const char *text = exr_get_text(p->file, part, ATTR_GROUP);
    int steps, anchor = -1, member = 0;
    const float *step = reader_any_floats(p, part, ATTR_STEP, &steps);
    unsigned long long at = 0, n[3];
    for (; text && step && *text; member++) {
        if (!next_member(&text, n) || n[0] >= (unsigned)p->info.views || n[1] > words - at ||
            n[2] > words - at - n[1] || member >= steps || !(step[member] >= 0.0f))
            return reader_bad(p, info.name, "views and their words, all of them in the part");
        struct view_parts *v = &p->parts[n[0]];
        if (v->codes >= 0)
            return reader_bad(p, info.name, "every view in one group");
        *v = (struct view_parts){.codes = part,
                                 .depth = n[2] ? part : -1,
                                 .mask = -1,
                                 .shadow = -1,
                                 .anchor = anchor,
                                 .words = {at, n[1]},
                                 .depth_words = {at + n[1], n[2]},
                                 .depth_step = step[member]};
        if (n[2] && !(step[member] > 0.0f))
            return reader_bad(p, info.name, "a step above 0 where there is depth");
        p->info.has_depth |= n[2] > 0;
        anchor = anchor < 0 ? (int)n[0] : anchor;
        at += n[1] + n[2];
    }
    return member ? RELUME_OK : reader_bad(p, info.name, "the views that it holds");
}

relume_status reader_find_groups(relume_pack *p, int *part)
{
    relume_status status = RELUME_OK;
    const int planes = relume_coder_info(p->coder)->planes;
    for (int v = 0; v < p->info.views; v++)
        p->parts[v] =
            (struct view_parts){.codes = -1, .depth = -1, .mask = -1, .shadow = -1, .anchor = -1};
    for (int g = 0; !status && *part < exr_part_count(p->file); g++, ++*part) {
        const struct exr_part_info i = exr_part_info(p->file, *part);
        char name[32];
        snprintf(name, sizeof name, "group%04d", g);
        if (strcmp(i.name, name))
            break;
        status = i.channels == 1 && i.uniform && i.sample == EXR_SAMPLE_UINT && !i.tile
                     ? find_members(p, *part)
                     : reader_bad(p, name, "rows of words");
    }
    for (int v = 0; !status && v < p->info.views; v++)
        if (p->parts[v].codes < 0)
            status = reader_bad(p, ATTR_GROUP, "every view in one group");
    if (!status &&
        (!reader_floats(p, 0, ATTR_SCALE, planes) || !reader_floats(p, 0, ATTR_OFFSET, planes)))
        status = reader_bad(p, "preview", "a finite scale and offset for every plane");
    return status;
}

// ---------------------------------------------------------------- words

// Words of a part into those from `range.first` on.
static relume_status read_range(uint32_t *to, const relume_pack *p, int part,
                                struct word_range range)
{
    return words_read(to, p->file, part, range.first, range.count, p->threads, p->log);
}

// All of them, which the caller frees.
static relume_status read_words(struct lossy_words *out, const relume_pack *p, int part,
                                struct word_range range)
{
    *out = (struct lossy_words){mem_array(range.count, sizeof *out->word), range.count};
    return out->word ? read_range(out->word, p, part, range) : RELUME_ENOMEM;
}

// Words of which only some are there.
struct sparse {
    struct lossy_words *words;
    const relume_pack *pack;
    int part;
    size_t first;  // where the words begin in the part
};

static relume_status read_some(void *user, size_t first, size_t count)
{
    const struct sparse *s = user;
    return read_range(s->words->word + first, s->pack, s->part,
                      (struct word_range){s->first + first, count});
}

// Those alone that a rectangle needs: memory that nobody writes takes no space.
static relume_status read_needed(struct lossy_words *out, const relume_pack *p, int part,
                                 struct word_range range, const struct lossy_shape *shape,
                                 const struct relume_rect *rect)
{
    struct sparse s = {out, p, part, range.first};
    *out = (struct lossy_words){mem_array(range.count, sizeof *out->word), range.count};
    if (!out->word)
        return RELUME_ENOMEM;
    if (range.count < LOSSY_HEAD)
        return RELUME_EDAMAGED;
    relume_status status = read_some(&s, 0, LOSSY_HEAD);
    if (!status && !(lossy_head(out->word) <= range.count))
        return RELUME_EDAMAGED;
    if (!status)
        status = read_some(&s, 0, lossy_head(out->word));
    return status ? status : lossy_needs(shape, rect, out, read_some, &s);
}

// ---------------------------------------------------------------- planes

// What is said of the tiles of a view that cannot be decoded.
struct losing {
    const relume_pack *pack;
    char view[32];
    const struct relume_rect *rect;  // of which the codes are
    const struct relume_codes *codes;
    uint16_t *data;
    const struct lossy_words *words;
    int count, column, row;  // how many, and which is the first
};

static uint16_t code_of_nothing(const struct relume_codes *codes, int plane)
{
    const float code = rintf(-codes->offset[plane] / codes->scale[plane]);
    return (uint16_t)fminf(fmaxf(code, 0.0f), (float)relume_storage_top(codes->storage));
}

static void lose_tile(void *context, const struct relume_rect *at)
{
    struct losing *l = context;
    const struct relume_pack_check_params *check = l->pack->check;
    const int side = lossy_side(l->words), column = at->left / side, row = at->top / side;
    if (l->count++ == 0) {
        l->column = column;
        l->row = row;
    }
    if (check && check->tile)
        check->tile(check->user, l->view, column, row, at);
    for (int p = 0; p < l->pack->info.planes; p++) {
        const uint16_t nothing = code_of_nothing(l->codes, p);
        for (int y = at->top - l->rect->top, i = 0; i < at->height; i++, y++) {
            uint16_t *to =
                l->data +
                ((size_t)p * (size_t)l->rect->height + (size_t)y) * (size_t)l->rect->width +
                (at->left - l->rect->left);
            for (int x = 0; x < at->width; x++)
                to[x] = nothing;
        }
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
            p->path, l->column, l->row, l->view, more);
    if (!p->check)
        log_line(p->log, RELUME_WARNING,
                 "%s: damaged: the tile in column %d, row %d of part '%s'%s; shown without it",
                 p->path, l->column, l->row, l->view, more);
    return RELUME_OK;
}

// The words of a view, or of a reduced level of it, which has a part of its own.
static int words_of(struct word_range *range, const relume_pack *p, int view, int level)
{
    const struct view_parts *v = &p->parts[view];
    const int part = level ? v->level[level - 1] : v->codes;
    const struct exr_part_info info = exr_part_info(p->file, part);
    *range = level ? (struct word_range){0, (size_t)info.width * (size_t)info.height} : v->words;
    return part;
}

int reader_coded_tile(const relume_pack *p)
{
    uint32_t head[LOSSY_HEAD] = {0};
    struct word_range range;
    const int part = words_of(&range, p, 0, 0);
    const struct lossy_words words = {head, LOSSY_HEAD};
    const bool there = range.count >= LOSSY_HEAD;
    range.count = LOSSY_HEAD;
    return there && !read_range(head, p, part, range) ? lossy_side(&words) : 0;
}

relume_status reader_load_coded(relume_pack *p, int view, int level, const struct relume_rect *rect,
                                const struct relume_codes *codes, uint16_t *data)
{
    const struct view_parts *v = &p->parts[view];
    struct lossy_words words = {0}, anchor = {0};
    struct word_range range;
    const int part = words_of(&range, p, view, level);
    int *order = lossy_order(p->coder);
    struct lossy_shape shape = {
        .planes = p->info.planes, .colour = lossy_in_colour(p->coder), .order = order};
    reader_level_size(&shape.width, &shape.height, p, level);
    struct losing losing = {.pack = p, .rect = rect, .codes = codes, .data = data, .words = &words};
    const struct lossy_lost lost = {lose_tile, &losing};
    snprintf(losing.view, sizeof losing.view, level ? "view%04d.level%d" : "view%04d", view, level);
    relume_status status = read_needed(&words, p, part, range, &shape, rect);
    if (!status && v->anchor >= 0)
        status = read_needed(&anchor, p, part, p->parts[v->anchor].words, &shape, rect);
    if (!status)
        status = lossy_decode(data, &shape, rect, &words, v->anchor >= 0 ? &anchor : NULL,
                              p->threads, &lost);
    if (status == RELUME_EDAMAGED)
        status = reader_bad(p, losing.view, "tiles of sound AV1 data");
    if (!status && losing.count)
        status = say_lost(&losing);
    mem_free(words.word);
    mem_free(anchor.word);
    mem_free(order);
    return status;
}

// ---------------------------------------------------------------- depth

relume_status reader_load_coded_depth(struct relume_image *out, relume_pack *p, int view)
{
    const struct view_parts *v = &p->parts[view];
    struct lossy_words words = {0};
    char name[32];
    snprintf(name, sizeof name, "view%04d.depth", view);
    relume_status status = relume_image_create(out, p->width, p->height, 1);
    if (!status)
        status = read_words(&words, p, v->depth, v->depth_words);
    if (!status)
        status = disparity_decode(out, &words, v->depth_step);
    if (status == RELUME_EDAMAGED)
        status = reader_bad(p, name, "a sound depth map");
    if (!status)
        status = reader_crop(out, p);
    if (!status)
        format_turn_depth(out, relume_pack_geometry(p, view), p->info.uv[view], false);
    mem_free(words.word);
    if (status)
        relume_image_destroy(out);
    return status;
}

// ---------------------------------------------------------------- what was learnt

relume_status reader_load_learnt(struct relume_image *out, relume_pack *p, int part,
                                 enum learnt_kind kind)
{
    const struct exr_part_info info = exr_part_info(p->file, part);
    const struct word_range all = {0, (size_t)info.width * (size_t)info.height};
    struct lossy_words words = {0};
    struct learnt_steps steps;
    memcpy(steps.scale, reader_floats(p, part, ATTR_SCALE, LEARNT), sizeof steps.scale);
    memcpy(steps.offset, reader_floats(p, part, ATTR_OFFSET, LEARNT), sizeof steps.offset);
    relume_status status = relume_image_create(out, p->width, p->height, LEARNT);
    if (!status)
        status = read_words(&words, p, part, all);
    if (!status)
        status = learnt_decode(out, &words, &steps, kind, p->threads);
    if (status == RELUME_EDAMAGED)
        status = reader_bad(p, info.name,
                            p->keep_going ? "tiles of sound AV1 data"
                                          : "tiles of sound AV1 data; --keep-going shows the rest");
    if (!status)
        status = reader_crop(out, p);
    mem_free(words.word);
    return status;
}
