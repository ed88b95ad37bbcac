// slices.c - volumes of pictures, in a folder or the pages of a TIFF: the first is the layer z = 0
#include "shape/volume/readers.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "image/image/pages.h"
#include "image/image/picture.h"

#include <errno.h>
#include <math.h>
#include <string.h>

// Code values of the one channel, or of the green one, which is nearest to brightness.
static relume_status take_row(struct store *s, picture_reader *reader, int y, uint8_t *bytes,
                              float *floats)
{
    const struct picture_info *info = picture_info_of(reader);
    const int width = info->width, channel = info->rgb[1];
    relume_status status = info->bytes ? picture_read_bytes(reader, y, 1, bytes)
                                       : picture_read_floats(reader, y, 1, floats);
    if (status)
        return log_fail(s->log, status, "%s: %s", s->path, picture_error(reader));
    if (info->bytes) {
        for (int x = 0; x < width; x++)
            bytes[x] = bytes[x * info->channels + channel];
        return store_put(s, bytes, (size_t)width);
    }
    const float scale = info->floats ? 1.0f : 65535.0f;
    for (int x = 0; x < width; x++)
        floats[x] = scale * floats[x * info->channels + channel];
    if (info->floats)
        return store_put(s, floats, (size_t)width);
    uint16_t *words = (uint16_t *)(void *)bytes;
    for (int x = 0; x < width; x++)
        words[x] = (uint16_t)relume_whole((double)floats[x] + 0.5);
    return store_put(s, words, (size_t)width);
}

static relume_status take_picture(struct store *s, picture_reader *reader)
{
    const struct picture_info *info = picture_info_of(reader);
    const size_t samples = (size_t)info->width * (size_t)info->channels;
    float *floats = mem_array(samples, sizeof *floats);
    uint8_t *bytes = mem_array(samples, sizeof(uint16_t));
    relume_status status = floats && bytes ? RELUME_OK : RELUME_ENOMEM;
    for (int y = 0; y < info->height && !status; y++)
        status = take_row(s, reader, y, bytes, floats);
    mem_free(floats);
    mem_free(bytes);
    return status;
}

static const char *type_of(const struct picture_info *info)
{
    return info->bytes ? "u8" : info->floats ? "f32" : "u16";
}

static relume_status begin(struct store *s, const struct picture_info *info, int count,
                           const struct relume_volume_params *p)
{
    const uint16_t one = 1;
    bool big;
    s->type = sample_type_find(type_of(info), &big);
    s->big = !*(const uint8_t *)&one;
    return store_begin(s, (const int64_t[3]){info->width, info->height, count}, p);
}

static relume_status check_like(const struct store *s, const struct picture_info *info)
{
    bool big;
    const relume_volume *v = s->volume;
    return info->width == v->size[0] && info->height == v->size[1] &&
                   sample_type_find(type_of(info), &big) == s->type
               ? RELUME_OK
               : log_fail(s->log, RELUME_EUNFIT,
                          "%s: %d x %d pixels of %s; expected %d x %d of %s, as the first slice is",
                          s->path, info->width, info->height, type_of(info), v->size[0], v->size[1],
                          s->type->name);
}

static relume_status take_slice(struct store *s, const char *path, int z, int count,
                                const struct relume_volume_params *p)
{
    picture_reader *reader;
    relume_status status = picture_open(&reader, path, NULL, p->limits, s->log);
    s->path = path;
    if (status)
        return status;
    const struct picture_info *info = picture_info_of(reader);
    status = z ? check_like(s, info) : begin(s, info, count, p);
    if (!status)
        status = take_picture(s, reader);
    picture_close(&reader);
    return status;
}

relume_status volume_read_slices(struct store *s, const char *path,
                                 const struct relume_volume_params *p)
{
    struct relume_photographs list;
    relume_status status = relume_photographs_list(
        &list, &path, 1,
        relume_photographs_params(.log = p->log, .by_products = true, .quiet = true));
    if (status)
        return status;
    for (int z = 0; z < list.count && !status; z++) {
        status = take_slice(s, list.path[z], z, list.count, p);
        if (!status && !log_progress(s->log, "reading", (z + 1.0) / list.count))
            status = RELUME_ECANCEL;
    }
    s->path = path;
    relume_photographs_free(&list);
    return status;
}

// ---------------------------------------------------------------- pages

static relume_status count_pages(int *count, const char *path, const struct relume_log *log)
{
    struct infile in;
    if (!infile_open(&in, path, NULL, log))
        return relume_input_fail(log, path, "cannot be opened", errno);
    *count = tiff_pages(&in);
    infile_close(&in);
    if (*count < 0)
        return log_fail(log, RELUME_EDAMAGED, "%s: truncated or damaged TIFF; a page is missing",
                        path);
    return *count > 1 ? RELUME_OK
                      : log_fail(log, RELUME_EUNFIT,
                                 "%s: a TIFF of one page; expected several, or a folder with a "
                                 "picture for each slice",
                                 path);
}

static relume_status turn_to(picture_reader *reader, int page, const char *path,
                             const struct relume_volume_params *p)
{
    const relume_status status = picture_turn(reader, page, limits_of(p->limits, p->log));
    return status && status != RELUME_ENOMEM ? log_fail(p->log, RELUME_EDAMAGED, "%s: page %d: %s",
                                                        path, page + 1, picture_error(reader))
                                             : status;
}

relume_status volume_read_pages(struct store *s, const char *path,
                                const struct relume_volume_params *p)
{
    picture_reader *reader;
    int count = 0;
    relume_status status = count_pages(&count, path, s->log);
    if (!status)
        status = picture_open(&reader, path, NULL, p->limits, s->log);
    if (status)
        return status;
    const struct picture_info *info = picture_info_of(reader);
    for (int z = 0; z < count && !status; z++) {
        status = turn_to(reader, z, path, p);
        if (!status)
            status = z ? check_like(s, info) : begin(s, info, count, p);
        if (!status)
            status = take_picture(s, reader);
        if (!status && !log_progress(s->log, "reading", (z + 1.0) / count))
            status = RELUME_ECANCEL;
    }
    picture_close(&reader);
    return status;
}
