// read_parts.c - which parts of a relume file belong to which view
#include "format/coder/codes.h"
#include "format/pack/format.h"
#include "format/pack/learnt.h"
#include "format/pack/reader.h"
#include "format/pack/views.h"

#include <stdio.h>
#include <string.h>

static relume_status check_view_part(relume_pack *p, int part, int view, int level)
{
    const struct exr_part_info i = exr_part_info(p->file, part);
    const int planes = relume_coder_info(p->coder)->planes;
    char where[32];
    int width, height;
    snprintf(where, sizeof where, level ? "view %d, level %d" : "view %d", view, level);
    relume_pack_level_size(&width, &height, p, level);
    const bool steps =
        reader_floats(p, part, ATTR_SCALE, planes) && reader_floats(p, part, ATTR_OFFSET, planes);
    if (p->coded)
        return i.channels == 1 && i.uniform && i.sample == EXR_SAMPLE_UINT && !i.tile && steps
                   ? RELUME_OK
                   : reader_bad(p, where, "rows of words, and a scale and offset for every plane");
    if (i.width != width || i.height != height)
        return reader_bad(p, where, "the size of the other parts");
    if (p->info.books && !level) {
        if (i.channels != p->info.books || !i.uniform || i.sample != EXR_SAMPLE_UINT)
            return reader_bad(p, where, "one channel of whole numbers for every codebook");
        return RELUME_OK;
    }
    if (i.channels != planes || !i.uniform || i.sample != codes_sample(p->info.storage))
        return reader_bad(p, where, "one channel of the stored type for every plane");
    if (!steps)
        return reader_bad(p, where, "a finite scale and offset for every plane");
    return RELUME_OK;
}

static bool is_plane(const relume_pack *p, int part, int level, enum exr_sample sample)
{
    const struct exr_part_info i = exr_part_info(p->file, part);
    int width, height;
    relume_pack_level_size(&width, &height, p, level);
    return i.width == width && i.height == height && i.channels == 1 && i.uniform &&
           i.sample == sample;
}

// Whether the next part is that one, as "view0000" with `what` behind it.
static bool is_next(const relume_pack *p, int part, char name[48], int view, const char *what)
{
    snprintf(name, 48, "view%04d%s", view, what);
    return part < exr_part_count(p->file) && !strcmp(exr_part_info(p->file, part).name, name);
}

static relume_status find_codes(relume_pack *p, int view, int *part)
{
    char name[48];
    p->parts[view] =
        (struct view_parts){.codes = *part, .depth = -1, .mask = -1, .shadow = -1, .anchor = -1};
    if (!is_next(p, *part, name, view, ""))
        return reader_bad(p, name, "a part of that name");
    const relume_status status = check_view_part(p, (*part)++, view, 0);
    return status || p->info.shared ? status : reader_find_books(p, view, part);
}

// The reduced levels of a view, from *part on. Each is followed by its mask where the view has one,
// which the last part of the view says.
static relume_status find_levels(relume_pack *p, int view, int *part)
{
    struct view_parts *parts = &p->parts[view];
    char name[48], what[32];
    int levels = p->coded;  // of coded planes the first is not kept
    relume_status status = RELUME_OK;
    parts->level[0] = parts->share[0] = -1;
    for (; !status && levels < RELUME_MOST_LEVELS; levels++) {
        snprintf(what, sizeof what, ".level%d", levels + 1);
        if (!is_next(p, *part, name, view, what))
            break;
        parts->level[levels] = *part;
        parts->share[levels] = -1;
        status = check_view_part(p, (*part)++, view, levels + 1);
        snprintf(what, sizeof what, ".level%d.mask", levels + 1);
        if (status || !is_next(p, *part, name, view, what))
            continue;
        if (!is_plane(p, *part, levels + 1, EXR_SAMPLE_HALF))
            return reader_bad(p, name, "one half channel of the level's size");
        parts->share[levels] = (*part)++;
    }
    levels = levels > p->coded ? levels : 0;
    if (!status && view && levels != p->info.levels)
        return reader_bad(p, name, "as many levels as the first view has");
    p->info.levels = levels;
    return status;
}

static relume_status check_shares(const relume_pack *p, int view)
{
    const struct view_parts *parts = &p->parts[view];
    char name[48];
    for (int i = p->coded; i < p->info.levels; i++)
        if ((parts->share[i] < 0) != (parts->mask < 0)) {
            snprintf(name, sizeof name, "view%04d.level%d", view, i + 1);
            return reader_bad(p, name, "a mask where the view has one");
        }
    return RELUME_OK;
}

static relume_status find_view(relume_pack *p, int view, int *part)
{
    char name[48];
    struct view_parts *parts = &p->parts[view];
    relume_status status = p->coded ? RELUME_OK : find_codes(p, view, part);
    if (!status && is_next(p, *part, name, view, ".depth")) {
        if (!is_plane(p, *part, 0, EXR_SAMPLE_FLOAT))
            return reader_bad(p, name, "one float channel of the views' size");
        parts->depth = (*part)++;
        p->info.has_depth = true;
    }
    if (!status && !p->coded)
        status = find_levels(p, view, part);
    if (!status && is_next(p, *part, name, view, ".mask")) {
        if (!is_plane(p, *part, 0, EXR_SAMPLE_HALF))
            return reader_bad(p, name, "one half channel of the views' size");
        parts->mask = (*part)++;
        p->info.has_mask = true;
    }
    return status || p->coded ? status : check_shares(p, view);
}

// Words of a model of eight channels (learnt.h).
static bool is_learnt(const relume_pack *p, int part)
{
    const struct exr_part_info i = exr_part_info(p->file, part);
    return i.channels == 1 && i.uniform && i.sample == EXR_SAMPLE_UINT && !i.tile &&
           !p->info.levels && reader_floats(p, part, ATTR_SCALE, LEARNT) &&
           reader_floats(p, part, ATTR_OFFSET, LEARNT);
}

// Behind all else: programs that do not know them do not see them.
static relume_status find_shadow(relume_pack *p, int view, int *part)
{
    char name[48];
    if (!is_next(p, *part, name, view, ".shadows"))
        return RELUME_OK;
    if (p->parts[view].depth < 0 || !is_learnt(p, *part))
        return reader_bad(p, name,
                          "rows of words, eight finite scales and offsets, depth and no reduced "
                          "levels");
    p->parts[view].shadow = (*part)++;
    p->info.has_shadow = true;
    return RELUME_OK;
}

static relume_status find_gloss(relume_pack *p, int *part)
{
    char name[48];
    if (p->info.has_shadow || !is_next(p, *part, name, 0, ".highlights"))
        return RELUME_OK;
    if (p->info.views != 1 || p->info.geometry.projection != RELUME_PLANAR ||
        p->info.geometry.perspective || !is_learnt(p, *part))
        return reader_bad(p, name,
                          "rows of words, eight finite scales and offsets, one planar "
                          "orthographic view and no reduced levels");
    p->gloss = (*part)++;
    p->info.has_gloss = true;
    return RELUME_OK;
}

relume_status reader_find_parts(relume_pack *p)
{
    const size_t views = (size_t)p->info.views;
    p->parts = arena_array(&p->arena, views, sizeof *p->parts);
    p->loaded = arena_array(&p->arena, views, sizeof *p->loaded);
    p->books = arena_array(&p->arena, views, sizeof *p->books);
    if (!p->parts || !p->loaded || !p->books)
        return RELUME_ENOMEM;
    int part = 1;
    relume_status status =
        p->coded ? reader_find_groups(p, &part) : reader_find_books(p, -1, &part);
    for (int v = 0; !status && v < p->info.views; v++)
        status = find_view(p, v, &part);
    for (int v = 0; !status && p->coded && v < p->info.views; v++)
        if (!(status = find_levels(p, v, &part)))
            status = check_shares(p, v);
    for (int v = 0; !status && v < p->info.views; v++)
        status = find_shadow(p, v, &part);
    if (!status)
        status = find_gloss(p, &part);
    if (status)
        return status;
    p->info.tile = p->coded ? reader_coded_tile(p) : exr_part_info(p->file, p->parts[0].codes).tile;
    p->info.compression = p->coded ? CODING_AV1 : exr_part_info(p->file, p->parts[0].codes).codec;
    return reader_read_members(p);
}
