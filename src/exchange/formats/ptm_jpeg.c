// ptm_jpeg.c - reading the JPEG forms of .ptm: a table, then the planes, predicted from each other
#include "exchange/formats/ptm_parts.h"

#include "core/base/log.h"
#include "image/image/jpeg.h"

#include <stdio.h>
#include <string.h>

struct jpegs {
    int count;
    long field[PTM_FIELDS][PTM_MOST_PLANES];
    const uint8_t *bytes[PTM_MOST_PLANES], *side[PTM_MOST_PLANES];
    int at_turn[PTM_MOST_PLANES];  // which plane is decoded at each turn
};

static relume_status check_jpegs(const struct ptm_header *h, struct jpegs *j)
{
    for (int i = 0; i < j->count; i++)
        j->at_turn[i] = -1;
    for (int i = 0; i < j->count; i++) {
        const long turn = j->field[PTM_ORDER][i];
        if (j->field[PTM_TRANSFORM][i] < 0 || j->field[PTM_TRANSFORM][i] >= PTM_TRANSFORMS)
            return log_wrong(h->log, h->path, "transforms of the planes",
                             "0, 1 (inversion) or 2 (motion)");
        if (j->field[PTM_TRANSFORM][i] == PTM_MOVED &&
            (j->field[PTM_MOTION_X][i] || j->field[PTM_MOTION_Y][i]))
            return log_wrong(h->log, h->path, "planes predicted by motion are not supported",
                             "motion vectors 0");
        if (turn < 0 || turn >= j->count || j->at_turn[turn] >= 0)
            return log_wrong(h->log, h->path, "order of the planes", "every number once");
        j->at_turn[turn] = i;
        if (j->field[PTM_REFERENCE][i] < -1 || j->field[PTM_REFERENCE][i] >= j->count)
            return log_wrong(h->log, h->path, "reference planes", "-1 or the number of a plane");
        if (j->field[PTM_BYTES][i] < 1 || j->field[PTM_SIDE_BYTES][i] < 0 ||
            j->field[PTM_SIDE_BYTES][i] % PTM_RECORD)
            return log_wrong(h->log, h->path, "sizes of the planes",
                             "at least one byte, side information in fives");
    }
    for (int i = 0; i < j->count; i++) {
        const long r = j->field[PTM_REFERENCE][i];
        if (r >= 0 && j->field[PTM_ORDER][r] >= j->field[PTM_ORDER][i])
            return log_wrong(h->log, h->path, "reference planes", "planes that are decoded before");
    }
    return RELUME_OK;
}

static relume_status read_jpeg_table(const struct ptm_header *h, struct bytes *b, struct jpegs *j)
{
    long quality;
    j->count = h->luminance ? PTM_TERMS + 3 : 3 * PTM_TERMS;
    if (!bytes_integer(b, &quality))
        return log_wrong(h->log, h->path, "no JPEG quality", "a whole number");
    for (int field = 0; field < PTM_FIELDS; field++)
        for (int i = 0; i < j->count; i++)
            if (!bytes_integer(b, &j->field[field][i]))
                return log_wrong(h->log, h->path, "table of planes",
                                 "seven lines of a whole number for every plane");
    if (!bytes_line_end(b))
        return log_wrong(h->log, h->path, "table of planes", "the end of the line");
    const relume_status status = check_jpegs(h, j);
    if (status)
        return status;
    for (int i = 0; i < j->count; i++) {
        j->bytes[i] = bytes_take(b, (size_t)j->field[PTM_BYTES][i]);
        j->side[i] = j->bytes[i] ? bytes_take(b, (size_t)j->field[PTM_SIDE_BYTES][i]) : NULL;
        if (!j->side[i])
            return log_fail(h->log, RELUME_EDAMAGED, "%s: truncated in plane %d of %d", h->path,
                            i + 1, j->count);
    }
    return RELUME_OK;
}

int ptm_plane(bool luminance, int i)
{
    if (luminance)
        return i < PTM_TERMS ? ptm_term_of_place[i] : i;
    return 3 * ptm_term_of_place[i % PTM_TERMS] + i / PTM_TERMS;
}

static relume_status correct(const struct foreign *f, const struct ptm_header *h, int plane,
                             const uint8_t *side, size_t records)
{
    for (; records > 0; records--, side += PTM_RECORD) {
        const size_t pixel =
            (size_t)side[0] << 24 | (size_t)side[1] << 16 | (size_t)side[2] << 8 | (size_t)side[3];
        if (pixel >= foreign_pixels(f))
            return log_wrong(h->log, h->path, "side information", "pixels inside the picture");
        const size_t width = (size_t)f->width;
        ptm_row(f, plane, (int)(pixel / width))[pixel % width] = side[4];
    }
    return RELUME_OK;
}

// Modulo 256.
static void add_reference(uint8_t *to, const uint8_t *reference, int width, bool inverted)
{
    for (int x = 0; x < width; x++)
        to[x] = (uint8_t)(to[x] - 128 + (inverted ? 255 - reference[x] : reference[x]));
}

static relume_status read_jpeg_plane(const struct foreign *f, const struct ptm_header *h,
                                     const struct jpegs *j, int i)
{
    char name[512];
    struct jpeg_codes codes;
    snprintf(name, sizeof name, "%.480s: plane %d", h->path, i + 1);
    relume_status status =
        jpeg_decode(&codes, j->bytes[i], (size_t)j->field[PTM_BYTES][i], name, h->limits, h->log);
    if (status)
        return status;
    const int plane = ptm_plane(h->luminance, i);
    const long r = j->field[PTM_REFERENCE][i];
    if (codes.planes != 1 || codes.width != f->width || codes.height != f->height)
        status = log_fail(h->log, RELUME_EDAMAGED,
                          "%s: %d x %d pixels, %d components; expected %d x %d and 1", name,
                          codes.width, codes.height, codes.planes, f->width, f->height);
    for (int y = 0; !status && y < f->height; y++) {
        uint8_t *to = ptm_row(f, plane, y);
        memcpy(to, codes.data + (size_t)y * (size_t)f->width, (size_t)f->width);
        if (r >= 0)
            add_reference(to, ptm_row(f, ptm_plane(h->luminance, (int)r), y), f->width,
                          j->field[PTM_TRANSFORM][i] == PTM_INVERTED);
    }
    if (!status)
        status = correct(f, h, plane, j->side[i], (size_t)j->field[PTM_SIDE_BYTES][i] / PTM_RECORD);
    jpeg_codes_free(&codes);
    return status;
}

relume_status ptm_read_jpegs(struct foreign *f, const struct ptm_header *h, struct bytes *b)
{
    struct jpegs j;
    relume_status status = read_jpeg_table(h, b, &j);
    if (!status)
        status = ptm_create(f, h);
    for (int turn = 0; !status && turn < j.count; turn++)
        status = read_jpeg_plane(f, h, &j, j.at_turn[turn]);
    return status;
}
