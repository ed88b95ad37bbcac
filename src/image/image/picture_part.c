// picture_part.c - a part of a picture, read as a picture of its own
#include "core/base/memory.h"
#include "image/image/picture.h"
#include "image/image/picture_format.h"

#include <string.h>

struct part_picture {
    picture_reader reader;  // first
    picture_reader *whole;
    struct relume_rect part;
    int next;  // row of the whole that comes next where rows do not jump
    void *rows;
    size_t bytes;  // of `rows`
};

// Room for rows of the whole.
static void *room_for(struct part_picture *p, int rows, size_t sample)
{
    const struct picture_info *info = picture_info_of(p->whole);
    const size_t row = (size_t)info->width * (size_t)info->channels * sample;
    const size_t bytes = row * (size_t)rows;
    if (bytes > p->bytes) {
        mem_free(p->rows);
        p->rows = mem_array((size_t)rows, row);
        p->bytes = p->rows ? bytes : 0;
    }
    return p->rows;
}

static relume_status read_whole(struct part_picture *p, int row, int rows)
{
    p->next = row + rows;
    return p->reader.info.bytes ? picture_read_bytes(p->whole, row, rows, p->rows)
                                : picture_read_floats(p->whole, row, rows, p->rows);
}

// Reads the rows above the part, which come first in files whose rows do not jump.
static relume_status pass(struct part_picture *p, size_t sample)
{
    enum { AT_ONCE = 16 };
    relume_status status = RELUME_OK;
    while (!status && !p->reader.info.jumps && p->next < p->part.top) {
        const int left = p->part.top - p->next, rows = left < AT_ONCE ? left : AT_ONCE;
        status = room_for(p, rows, sample) ? read_whole(p, p->next, rows) : RELUME_ENOMEM;
    }
    return status;
}

static relume_status read_rows(picture_reader *reader, int row, int rows, void *out)
{
    struct part_picture *p = (struct part_picture *)reader;
    const struct picture_info *whole = picture_info_of(p->whole);
    const size_t sample = whole->bytes ? 1 : sizeof(float);
    const size_t pixel = (size_t)whole->channels * sample;
    relume_status status = pass(p, sample);
    if (!status)
        status = room_for(p, rows, sample) ? read_whole(p, p->part.top + row, rows) : RELUME_ENOMEM;
    for (int y = 0; !status && y < rows; y++) {
        const size_t at = (size_t)y * (size_t)whole->width + (size_t)p->part.left;
        memcpy((char *)out + (size_t)y * (size_t)p->part.width * pixel,
               (const char *)p->rows + at * pixel, (size_t)p->part.width * pixel);
    }
    return status;
}

static relume_status read_floats(picture_reader *reader, int row, int rows, float *out)
{
    return read_rows(reader, row, rows, out);
}

static relume_status read_bytes(picture_reader *reader, int row, int rows, uint8_t *out)
{
    return read_rows(reader, row, rows, out);
}

static const char *error(const picture_reader *reader)
{
    return picture_error(((const struct part_picture *)reader)->whole);
}

static void close(picture_reader *reader)
{
    struct part_picture *p = (struct part_picture *)reader;
    picture_close(&p->whole);
    mem_free(p->rows);
    mem_free(p);
}

static const struct picture_format format = {
    .read_floats = read_floats, .read_bytes = read_bytes, .error = error, .close = close};

relume_status picture_crop(picture_reader **reader, const struct relume_rect *part)
{
    const struct picture_info info = (*reader)->info;
    if (part->left < 0 || part->top < 0 || part->width < 1 || part->height < 1 ||
        part->width > info.width - part->left || part->height > info.height - part->top)
        return RELUME_EINVAL;
    struct part_picture *p = mem_zeroed(1, sizeof *p);
    if (!p)
        return RELUME_ENOMEM;
    p->whole = *reader;
    p->part = *part;
    p->reader = (picture_reader){.format = &format, .info = info};
    p->reader.info.width = part->width;
    p->reader.info.height = part->height;
    *reader = &p->reader;
    return RELUME_OK;
}
