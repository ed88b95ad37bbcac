// check.c - what of a relume file is damaged, and where: first every block of the container, then
// what the blocks say
#include "core/base/infile.h"
#include "core/base/log.h"
#include "format/coder/coding.h"
#include "format/pack/format.h"
#include "format/pack/part.h"
#include "format/pack/reader.h"
#include "format/pack/views.h"
#include "image/image/exr_sums.h"

#include <string.h>

struct check {
    const struct relume_pack_check_params *p;
    const char *part;
    int tile;  // side of its tiles, 0: scanlines
    bool damaged, one_of_several, coded;
    bool header;  // is not the one that was written
};

static void note(void *context, const struct relume_rect *at)
{
    struct check *c = context;
    c->damaged = true;
    if (c->tile && c->p->tile)
        c->p->tile(c->p->user, c->part, at->left / c->tile, at->top / c->tile, at);
    else if (!c->tile && c->p->found)
        c->p->found(c->p->user, c->part, at->top, at->height);
}

// Headers at once, and blocks from now on, where the file has check sums.
static relume_status use_sums(struct check *c, exr_file *file)
{
    enum exr_sums_found found;
    const relume_status status = exr_use_sums(file, &found);
    if (c->p->has_sums)
        *c->p->has_sums = found != EXR_SUMS_NONE;
    if (!status && found == EXR_SUMS_DAMAGED) {
        c->damaged = true;
        if (c->p->found)
            c->p->found(c->p->user, EXR_SUMS_PART, 0,
                        exr_part_info(file, exr_part_count(file)).height);
    }
    c->header = found == EXR_SUMS_HEAD_CHANGED ||
                (found == EXR_SUMS_NONE && exr_get_text(file, 0, ATTR_SUMS));
    return status;
}

static relume_status check_blocks(struct check *c, const char *path)
{
    exr_file *file;
    relume_status status = exr_open_damaged(&file, path, c->p->reader, c->p->limits, c->p->log);
    const char *format = status ? NULL : exr_get_text(file, 0, ATTR_FORMAT);
    c->one_of_several = format && !strcmp(format, FORMAT_PART);
    c->coded = format && exr_get_text(file, 0, ATTR_CODING);
    if (!status)
        status = use_sums(c, file);
    for (int i = 0; !status && i < exr_part_count(file); i++) {
        c->part = exr_part_info(file, i).name;
        c->tile = exr_part_info(file, i).tile;
        status = exr_find_damage(file, i, c->p->threads, note, c, c->p->log);
    }
    exr_close(&file);
    return status;
}

static relume_status check_depth(relume_pack *pack, int view)
{
    struct relume_image image;
    const relume_status status = relume_pack_depth(&image, pack, view);
    relume_image_destroy(&image);
    return status;
}

static relume_status check_shadow(relume_pack *pack, int view)
{
    struct relume_image image;
    relume_status status = relume_pack_shadow(&image, pack, view);
    relume_image_destroy(&image);
    if (!status)
        status = relume_pack_gloss(&image, pack, view);
    relume_image_destroy(&image);
    return status;
}

static relume_status check_whole(relume_pack *pack, int view)
{
    struct relume_image image;
    const struct relume_codes *codes;
    relume_status status = relume_pack_codes(&codes, pack, view);
    relume_pack_drop(pack, view);
    if (!status)
        status = check_depth(pack, view);
    if (!status) {
        status = relume_pack_mask(&image, pack, view);
        relume_image_destroy(&image);
    }
    return status;
}

static relume_status check_plane(relume_pack *pack, int part, const struct relume_rect *rect)
{
    struct relume_image image;
    const relume_status status = reader_load_plane(&image, pack, part, rect);
    relume_image_destroy(&image);
    return status;
}

// A band of a view, or of a reduced level of it.
static relume_status check_band(relume_pack *pack, int view, int level,
                                const struct relume_rect *rect)
{
    const struct view_parts *parts = &pack->parts[view];
    struct relume_codes_part codes;
    relume_status status = relume_pack_codes_level(&codes, pack, view, level, rect);
    relume_codes_part_destroy(&codes);
    if (!status)
        status = check_plane(pack, level ? parts->share[level - 1] : parts->mask, rect);
    return status || level || parts->depth_words.count ? status
                                                       : check_plane(pack, parts->depth, rect);
}

// Large views are in tiles: no more than some rows of these are there at once.
static relume_status check_view(relume_pack *pack, int view)
{
    enum { ROWS = 1024 };
    const struct relume_pack_info *info = relume_pack_info(pack);
    const bool coded_depth = pack->parts[view].depth_words.count > 0;
    relume_status status = !info->levels ? check_whole(pack, view)
                           : coded_depth ? check_depth(pack, view)
                                         : RELUME_OK;
    for (int level = 0; !status && info->levels && level <= info->levels; level++) {
        struct relume_rect band = {0};
        int height;
        relume_pack_level_size(&band.width, &height, pack, level);
        for (; !status && band.top < height; band.top += ROWS) {
            band.height = height - band.top < ROWS ? height - band.top : ROWS;
            status = check_band(pack, view, level, &band);
        }
    }
    return status ? status : check_shadow(pack, view);
}

struct tiles {
    const struct relume_pack_check_params *p;
    int count;
};

static void note_tile(void *user, const char *part, int column, int row,
                      const struct relume_rect *at)
{
    struct tiles *t = user;
    t->count++;
    if (t->p->tile)
        t->p->tile(t->p->user, part, column, row, at);
}

static relume_status check_values(const struct relume_pack_check_params *p, const char *path)
{
    relume_pack *pack;
    struct tiles tiles = {p, 0};
    const struct relume_pack_check_params noting = {.tile = note_tile, .user = &tiles};
    relume_status status = relume_pack_open(
        &pack, path,
        relume_pack_params(.log = p->log, .limits = p->limits, .threads = p->threads,
                           .reader = p->reader, .keep_going = true));
    if (!status)
        pack->check = &noting;
    for (int i = 0; !status && i < relume_pack_info(pack)->views; i++)
        status = check_view(pack, i);
    relume_pack_destroy(&pack);
    return !status && tiles.count ? RELUME_EDAMAGED : status;
}

// Which tiles are lost with the blocks that are damaged.
static relume_status find_tiles(const struct relume_pack_check_params *p, const char *path)
{
    struct relume_log quiet = p->log ? *p->log : (struct relume_log){0};
    struct relume_pack_check_params tiles = *p;
    quiet.message = NULL;
    tiles.log = &quiet;
    const relume_status status = check_values(&tiles, path);
    return !status || relume_status_is_input(status) ? RELUME_EDAMAGED : status;
}

static relume_status check_part(const struct relume_pack_check_params *p, const char *path)
{
    struct part_file part;
    const relume_status status = part_open(&part, path, p->reader, p->limits, false, p->log);
    part_close(&part);
    return status;
}

relume_status relume_pack_check(const char *path, const struct relume_pack_check_params *params)
{
    const struct relume_pack_check_params none = {0};
    struct check c = {.p = params ? params : &none};
    if (!path && !c.p->reader)
        return RELUME_EINVAL;
    const relume_status status = check_blocks(&c, path);
    if (status)
        return status;
    if (c.header)
        return log_fail(c.p->log, RELUME_EDAMAGED,
                        "%s: damaged header: sizes, lights, steps or the places of blocks have "
                        "changed; encode it again or take it from a copy",
                        infile_name(path));
    if (c.damaged)
        return c.coded && !c.one_of_several ? find_tiles(c.p, path) : RELUME_EDAMAGED;
    return (c.one_of_several ? check_part : check_values)(c.p, path);
}
