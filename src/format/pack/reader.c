// reader.c - a relume file, of which nothing is believed before it has been checked
#include <relume/pack.h>

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "format/coder/coding.h"
#include "format/pack/views.h"
#include "format/pack/reader.h"
#include "image/geometry/geometry.h"
#include "image/image/image.h"

#include <math.h>

relume_status reader_bad(const relume_pack *p, const char *what, const char *expected)
{
    return log_fail(p->log, RELUME_EDAMAGED, "%s: %s; expected %s", p->path, what, expected);
}

const float *reader_any_floats(const relume_pack *p, int part, const char *name, int *count)
{
    const float *v = exr_get_floats(p->file, part, name, count);
    for (int i = 0; v && i < *count; i++)
        if (!isfinite(v[i]))
            return NULL;
    return v;
}

const float *reader_floats(const relume_pack *p, int part, const char *name, int count)
{
    int found = 0;
    const float *v = reader_any_floats(p, part, name, &found);
    return found == count ? v : NULL;
}

relume_status relume_pack_open(relume_pack **out, const char *path,
                               const struct relume_pack_params *params)
{
    const struct relume_pack_params params_ = PARAMS_WORK(relume_pack_params, params);
    *out = NULL;
    if (!path && !params_.reader)
        return RELUME_EINVAL;
    relume_pack *p = mem_zeroed(1, sizeof *p);
    if (!p)
        return RELUME_ENOMEM;
    p->log = params_.log;
    p->threads = params_.threads;
    p->keep_going = params_.keep_going;
    p->limits = limits_or_default(limits_of(params_.limits, params_.log));
    p->path = mem_text(infile_name(path));
    relume_status status = p->path ? RELUME_OK : RELUME_ENOMEM;
    const enum input_kind kind = params_.reader ? INPUT_FILE : input_kind(path, p->log);
    if (!status && kind == INPUT_NONE)
        status =
            log_fail(p->log, RELUME_ENOTFOUND, "%s: no such file; expected a relume file", path);
    else if (!status && kind != INPUT_FILE)
        status = log_fail(p->log, RELUME_EFORMAT, "%s: not a file; expected a relume file", path);
    if (!status)
        status = exr_open(&p->file, path, params_.reader, &p->limits, p->log);
    if (!status) {
        p->info.file_bytes = exr_bytes(p->file);
        p->info.has_sums = exr_has_sums(p->file);
        status = reader_read_header(p);
    }
    p->width = p->info.width;
    p->height = p->info.height;
    p->shown = (struct relume_rect){0, 0, p->width, p->height};
    if (!status)
        status = reader_find_parts(p);
    if (!status && p->info.has_mask)
        status = relume_coder_append_mean(p->coder);
    if (status)
        relume_pack_destroy(&p);
    *out = p;
    return status;
}

void relume_pack_destroy(relume_pack **pack)
{
    relume_pack *p = *pack;
    *pack = NULL;
    if (!p)
        return;
    for (int v = 0; p->loaded && v < p->info.views; v++)
        relume_pack_drop(p, v);
    if (p->books && p->info.shared)
        reader_drop_books(&p->books[0]);
    relume_coder_destroy(&p->coder);
    exr_close(&p->file);
    arena_free(&p->arena);
    mem_free(p->path);
    mem_free(p);
}

bool relume_pack_keeps_going(const relume_pack *pack)
{
    return pack->keep_going;
}

const struct relume_pack_info *relume_pack_info(const relume_pack *pack)
{
    return &pack->info;
}

const struct relume_geometry *relume_pack_geometry(const relume_pack *pack, int view)
{
    const struct relume_pack_info *info = &pack->info;
    return info->slabs ? &info->slab[info->slab_of[view]] : &info->geometry;
}

// ---------------------------------------------------------------- parts of views

static void halve(int *width, int *height, int times)
{
    for (int i = 0; i < times; i++) {
        *width = (*width + 1) / 2;
        *height = (*height + 1) / 2;
    }
}

void reader_level_size(int *width, int *height, const relume_pack *p, int level)
{
    *width = p->width;
    *height = p->height;
    halve(width, height, level);
}

void relume_pack_level_size(int *width, int *height, const relume_pack *pack, int level)
{
    *width = pack->info.width;
    *height = pack->info.height;
    halve(width, height, level);
}

relume_status reader_crop(struct relume_image *image, const relume_pack *p)
{
    const bool all = p->shown.width == p->width && p->shown.height == p->height;
    return all ? RELUME_OK : image_crop(image, &p->shown);
}

relume_status relume_pack_crop(relume_pack *pack, const struct relume_rect *part)
{
    struct relume_pack_info *info = &pack->info;
    if (info->slabs || info->geometry.projection > RELUME_SLAB)
        return log_fail(pack->log, RELUME_EUNFIT,
                        "%s: has no parts by themselves; --crop expects a planar file or one slab",
                        pack->path);
    if (part->left < 0 || part->top < 0 || part->width < 1 || part->height < 1 ||
        part->width > info->width - part->left || part->height > info->height - part->top)
        return log_fail(pack->log, RELUME_EINVAL,
                        "%s: --crop %d,%d,%d,%d: expected a part of its %d x %d pixels", pack->path,
                        part->left, part->top, part->width, part->height, info->width,
                        info->height);
    geometry_crop(&info->geometry, info->width, info->height, part);
    for (int v = 0; v < info->views; v++)
        relume_pack_drop(pack, v);
    pack->shown = (struct relume_rect){pack->shown.left + part->left, pack->shown.top + part->top,
                                       part->width, part->height};
    info->width = part->width;
    info->height = part->height;
    info->levels = 0;
    return RELUME_OK;
}

// ---------------------------------------------------------------- codes

static relume_status check_bytes(const relume_pack *p, const struct relume_rect *rect,
                                 const struct relume_codes *like)
{
    const uint64_t planes = (uint64_t)(like->books ? like->books : like->planes);
    const uint64_t each = like->books ? sizeof(uint16_t) : relume_storage_bytes(like->storage);
    const uint64_t bytes = (uint64_t)rect->width * (uint64_t)rect->height * planes * each;
    if (bytes <= p->limits.max_memory)
        return RELUME_OK;
    return log_fail(p->log, RELUME_ELIMIT,
                    "%s: %d x %d pixels of %d planes take %s; expected at most %s "
                    "(--max-memory): ask for less of it (--size, --crop)",
                    p->path, rect->width, rect->height, (int)planes,
                    memory_text(bytes, p->limits.max_memory).text,
                    memory_text(p->limits.max_memory, bytes).text);
}

// From the file.
static relume_status load(struct relume_codes_part *to, relume_pack *p, int view, int level,
                          const struct relume_rect *rect)
{
    const int books = level ? 0 : p->info.books;
    const struct relume_codes like = {
        .coder = p->coder,
        .domain = p->info.domain,
        .display = p->info.display,
        .planes = relume_coder_info(p->coder)->planes,
        .books = books,
        .storage = books ? 0 : p->info.storage,
    };
    relume_status status = check_bytes(p, rect, &like);
    if (!status)
        status = books ? reader_load_indices(to, p, view, rect, &like)
                       : reader_load_planes(to, p, view, level, rect, &like);
    if (status)
        relume_codes_part_destroy(to);
    return status;
}

relume_status relume_pack_codes(const struct relume_codes **out, relume_pack *pack, int view)
{
    *out = NULL;
    if (view < 0 || view >= pack->info.views)
        return RELUME_EINVAL;
    struct relume_codes_part *to = &pack->loaded[view];
    const relume_status status = to->memory ? RELUME_OK : load(to, pack, view, 0, &pack->shown);
    if (status) {
        relume_pack_drop(pack, view);
        return status;
    }
    *out = &to->codes;
    return RELUME_OK;
}

relume_status relume_pack_codes_level(struct relume_codes_part *out, relume_pack *pack, int view,
                                      int level, const struct relume_rect *rect)
{
    int width, height;
    *out = (struct relume_codes_part){.memory = NULL};
    if (view < 0 || view >= pack->info.views || level < 0 || level > pack->info.levels)
        return RELUME_EINVAL;
    relume_pack_level_size(&width, &height, pack, level);
    if (rect->left < 0 || rect->top < 0 || rect->width < 1 || rect->height < 1 ||
        rect->width > width - rect->left || rect->height > height - rect->top)
        return RELUME_EINVAL;
    const struct relume_codes_part *whole = &pack->loaded[view];
    const struct relume_rect at = {pack->shown.left + rect->left, pack->shown.top + rect->top,
                                   rect->width, rect->height};
    return whole->memory && !level ? relume_codes_crop(out, &whole->codes, rect)
                                   : load(out, pack, view, level, &at);
}

relume_status relume_pack_codes_part(struct relume_codes_part *out, relume_pack *pack, int view,
                                     const struct relume_rect *rect)
{
    return relume_pack_codes_level(out, pack, view, 0, rect);
}

void relume_pack_drop(relume_pack *pack, int view)
{
    relume_codes_part_destroy(&pack->loaded[view]);
    if (pack->books && !pack->info.shared)
        reader_drop_books(&pack->books[view]);
}
