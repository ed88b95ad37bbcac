// ptm.c - .ptm: text lines, then bytes; rows from the bottom, terms x2 y2 xy x y 1
#include "exchange/ptm.h"

#include "base/log.h"
#include "base/memory.h"
#include "base/outfile.h"
#include "exchange/bytes.h"
#include "image/jpeg.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TERMS = 6 };

// Our order of the terms (1 x y x2 xy y2) by the file's place of each.
static const int term_of_place[TERMS] = {3, 5, 4, 1, 2, 0};

struct header {
    const char *path;
    const struct relume_limits *limits;
    const struct relume_log *log;
    double version;
    bool luminance, jpeg;
    long width, height;
    double scale[TERMS];
    long bias[TERMS];
};

static relume_status wrong(const struct header *h, const char *what, const char *expected)
{
    return log_fail(h->log, RELUME_EDATA, "%s: %s; expected %s", h->path, what, expected);
}

static relume_status read_format(struct header *h, struct bytes *b)
{
    static const struct {
        const char *name;
        bool luminance, jpeg;
    } formats[] = {
        {"PTM_FORMAT_RGB", false, false},
        {"PTM_FORMAT_LRGB", true, false},
        {"PTM_FORMAT_JPEG_RGB", false, true},
        {"PTM_FORMAT_JPEG_LRGB", true, true},
    };
    char word[40];
    if (!bytes_word(b, word, sizeof word) || strncmp(word, "PTM_", 4) ||
        sscanf(word + 4, "%lf", &h->version) != 1)
        return wrong(h, "not a polynomial texture map", "PTM_1.2 in the first line");
    if (!(h->version >= 1.0 && h->version < 2.0))
        return wrong(h, word, "a version from PTM_1.0 to PTM_1.2");
    if (!bytes_word(b, word, sizeof word))
        return wrong(h, "no format", "PTM_FORMAT_RGB or another");
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (!strcmp(word, formats[i].name)) {
            h->luminance = formats[i].luminance;
            h->jpeg = formats[i].jpeg;
            return RELUME_OK;
        }
    return log_fail(h->log, RELUME_EDATA,
                    "%s: format %.40s is not supported; expected PTM_FORMAT_RGB, LRGB, JPEG_RGB or "
                    "JPEG_LRGB",
                    h->path, word);
}

static relume_status read_header(struct header *h, struct bytes *b)
{
    const relume_status status = read_format(h, b);
    if (status)
        return status;
    if (!bytes_integer(b, &h->width) || !bytes_integer(b, &h->height))
        return wrong(h, "no size", "width and height");
    for (int i = 0; i < TERMS; i++)
        if (!bytes_number(b, &h->scale[i]) || fabs(h->scale[i]) > 1e6)
            return wrong(h, "scale", "six numbers, at most 1e6");
    for (int i = 0; i < TERMS; i++)
        if (!bytes_integer(b, &h->bias[i]) || labs(h->bias[i]) > 1000000)
            return wrong(h, "bias", "six whole numbers from 0 to 255");
    return RELUME_OK;
}

static relume_status create(struct foreign *f, const struct header *h)
{
    f->form = h->luminance ? FOREIGN_LUMINANCE : FOREIGN_CHANNELS;
    f->functions = (struct functions){.kind = FUNCTIONS_PTM, .count = TERMS};
    f->terms = TERMS;
    const relume_status status = foreign_create(
        f, h->path, h->width, h->height, h->luminance ? TERMS + 3 : 3 * TERMS, h->limits, h->log);
    for (int i = 0; !status && i < TERMS; i++) {
        const int k = term_of_place[i], copies = h->luminance ? 1 : 3;
        for (int c = 0; c < copies; c++) {
            f->scale[k * copies + c] = (float)(h->scale[i] / 255.0);
            f->offset[k * copies + c] = (float)(-(double)h->bias[i] * h->scale[i] / 255.0);
        }
    }
    for (int c = 0; !status && h->luminance && c < 3; c++)
        f->scale[TERMS + c] = 1.0f / 255.0f;
    return status;
}

static uint8_t *plane_row(const struct foreign *f, int plane, int row_from_below)
{
    const size_t row = (size_t)(f->height - 1 - row_from_below);
    return f->codes + (size_t)plane * foreign_pixels(f) + row * (size_t)f->width;
}

// ---------------------------------------------------------------- raw bodies

// A row of interleaved bytes goes to `count` planes.
static void scatter(const struct foreign *f, int row, const uint8_t *from, size_t stride, int count,
                    const int *planes)
{
    for (int i = 0; i < count; i++) {
        uint8_t *to = plane_row(f, planes[i], row);
        for (size_t x = 0; x < (size_t)f->width; x++)
            to[x] = from[x * stride + (size_t)i];
    }
}

static void read_raw_rgb(const struct foreign *f, const uint8_t *body)
{
    for (int c = 0; c < 3; c++) {
        int planes[TERMS];
        for (int i = 0; i < TERMS; i++)
            planes[i] = 3 * term_of_place[i] + c;
        for (int y = 0; y < f->height; y++, body += (size_t)f->width * TERMS)
            scatter(f, y, body, TERMS, TERMS, planes);
    }
}

// Version 1.2 keeps the luminance apart from the colour, versions before interleave them.
static void read_raw_lrgb(const struct foreign *f, const uint8_t *body, bool interleaved)
{
    static const int colours[3] = {TERMS, TERMS + 1, TERMS + 2};
    const size_t width = (size_t)f->width;
    const size_t stride = interleaved ? TERMS + 3 : TERMS, colour_stride = interleaved ? stride : 3;
    const uint8_t *colour = interleaved ? body + TERMS : body + foreign_pixels(f) * (size_t)TERMS;
    for (int y = 0; y < f->height; y++) {
        scatter(f, y, body + (size_t)y * width * stride, stride, TERMS, term_of_place);
        scatter(f, y, colour + (size_t)y * width * colour_stride, colour_stride, 3, colours);
    }
}

static relume_status read_raw(struct foreign *f, const struct header *h, struct bytes *b)
{
    if (!bytes_line_end(b))
        return wrong(h, "bias", "six whole numbers and the end of the line");
    if (!limits_allow(h->limits, h->width, h->height))
        return log_fail(h->log, RELUME_EDATA,
                        "%s: claims %ld x %ld pixels; expected sizes from 1 within the limits",
                        h->path, h->width, h->height);
    const size_t need =
        (size_t)h->width * (size_t)h->height * (h->luminance ? TERMS + 3 : 3 * TERMS);
    if (b->size - b->at < need)
        return log_fail(h->log, RELUME_EDATA,
                        "%s: truncated; expected %zu bytes of pixels, found %zu", h->path, need,
                        b->size - b->at);
    const relume_status status = create(f, h);
    if (status)
        return status;
    if (h->luminance)
        read_raw_lrgb(f, b->data + b->at, h->version < 1.15);
    else
        read_raw_rgb(f, b->data + b->at);
    return RELUME_OK;
}

// ---------------------------------------------------------------- JPEG bodies

enum { MOST_JPEGS = 3 * TERMS };

enum field { TRANSFORM, MOTION_X, MOTION_Y, ORDER, REFERENCE, BYTES, SIDE_BYTES, FIELDS };

// How a plane's reference is changed before the plane is added to it. Which way a motion vector
// points, and what stands outside the picture, is nowhere written; no reader of the field knows.
enum transform { AS_IT_IS, INVERTED, MOVED, TRANSFORMS };

struct jpegs {
    int count;
    long field[FIELDS][MOST_JPEGS];
    const uint8_t *bytes[MOST_JPEGS], *side[MOST_JPEGS];
    int at_turn[MOST_JPEGS];  // which plane is decoded at each turn
};

static relume_status check_jpegs(const struct header *h, struct jpegs *j)
{
    for (int i = 0; i < j->count; i++)
        j->at_turn[i] = -1;
    for (int i = 0; i < j->count; i++) {
        const long turn = j->field[ORDER][i];
        if (j->field[TRANSFORM][i] < 0 || j->field[TRANSFORM][i] >= TRANSFORMS)
            return wrong(h, "transforms of the planes", "0, 1 (inversion) or 2 (motion)");
        if (j->field[TRANSFORM][i] == MOVED && (j->field[MOTION_X][i] || j->field[MOTION_Y][i]))
            return wrong(h, "planes predicted by motion are not supported", "motion vectors 0");
        if (turn < 0 || turn >= j->count || j->at_turn[turn] >= 0)
            return wrong(h, "order of the planes", "every number once");
        j->at_turn[turn] = i;
        if (j->field[REFERENCE][i] < -1 || j->field[REFERENCE][i] >= j->count)
            return wrong(h, "reference planes", "-1 or the number of a plane");
        if (j->field[BYTES][i] < 1 || j->field[SIDE_BYTES][i] < 0 || j->field[SIDE_BYTES][i] % 5)
            return wrong(h, "sizes of the planes", "at least one byte, side information in fives");
    }
    for (int i = 0; i < j->count; i++) {
        const long r = j->field[REFERENCE][i];
        if (r >= 0 && j->field[ORDER][r] >= j->field[ORDER][i])
            return wrong(h, "reference planes", "planes that are decoded before");
    }
    return RELUME_OK;
}

static relume_status read_jpeg_table(const struct header *h, struct bytes *b, struct jpegs *j)
{
    long quality;
    j->count = h->luminance ? TERMS + 3 : 3 * TERMS;
    if (!bytes_integer(b, &quality))
        return wrong(h, "no JPEG quality", "a whole number");
    for (int field = 0; field < FIELDS; field++)
        for (int i = 0; i < j->count; i++)
            if (!bytes_integer(b, &j->field[field][i]))
                return wrong(h, "table of planes", "seven lines of a whole number for every plane");
    if (!bytes_line_end(b))
        return wrong(h, "table of planes", "the end of the line");
    const relume_status status = check_jpegs(h, j);
    if (status)
        return status;
    for (int i = 0; i < j->count; i++) {
        j->bytes[i] = bytes_take(b, (size_t)j->field[BYTES][i]);
        j->side[i] = j->bytes[i] ? bytes_take(b, (size_t)j->field[SIDE_BYTES][i]) : NULL;
        if (!j->side[i])
            return log_fail(h->log, RELUME_EDATA, "%s: truncated in plane %d of %d", h->path, i + 1,
                            j->count);
    }
    return RELUME_OK;
}

// The number of our plane for the file's plane `i`.
static int plane_of(const struct header *h, int i)
{
    if (h->luminance)
        return i < TERMS ? term_of_place[i] : i;
    return 3 * term_of_place[i % TERMS] + i / TERMS;
}

static relume_status correct(const struct foreign *f, const struct header *h, int plane,
                             const uint8_t *side, size_t records)
{
    for (; records > 0; records--, side += 5) {
        const size_t pixel =
            (size_t)side[0] << 24 | (size_t)side[1] << 16 | (size_t)side[2] << 8 | (size_t)side[3];
        if (pixel >= foreign_pixels(f))
            return wrong(h, "side information", "pixels inside the picture");
        const size_t width = (size_t)f->width;
        plane_row(f, plane, (int)(pixel / width))[pixel % width] = side[4];
    }
    return RELUME_OK;
}

// Modulo 256.
static void add_reference(uint8_t *to, const uint8_t *reference, int width, bool inverted)
{
    for (int x = 0; x < width; x++)
        to[x] = (uint8_t)(to[x] - 128 + (inverted ? 255 - reference[x] : reference[x]));
}

static relume_status read_jpeg_plane(const struct foreign *f, const struct header *h,
                                     const struct jpegs *j, int i)
{
    char name[512];
    struct jpeg_codes codes;
    snprintf(name, sizeof name, "%.480s: plane %d", h->path, i + 1);
    relume_status status =
        jpeg_decode(&codes, j->bytes[i], (size_t)j->field[BYTES][i], name, h->limits, h->log);
    if (status)
        return status;
    const int plane = plane_of(h, i);
    const long r = j->field[REFERENCE][i];
    if (codes.planes != 1 || codes.width != f->width || codes.height != f->height)
        status = log_fail(h->log, RELUME_EDATA,
                          "%s: %d x %d pixels, %d components; expected %d x %d and 1", name,
                          codes.width, codes.height, codes.planes, f->width, f->height);
    for (int y = 0; !status && y < f->height; y++) {
        uint8_t *to = plane_row(f, plane, y);
        memcpy(to, codes.data + (size_t)y * (size_t)f->width, (size_t)f->width);
        if (r >= 0)
            add_reference(to, plane_row(f, plane_of(h, (int)r), y), f->width,
                          j->field[TRANSFORM][i] == INVERTED);
    }
    if (!status)
        status = correct(f, h, plane, j->side[i], (size_t)j->field[SIDE_BYTES][i] / 5);
    jpeg_codes_free(&codes);
    return status;
}

static relume_status read_jpegs(struct foreign *f, const struct header *h, struct bytes *b)
{
    struct jpegs j;
    relume_status status = read_jpeg_table(h, b, &j);
    if (!status)
        status = create(f, h);
    for (int turn = 0; !status && turn < j.count; turn++)
        status = read_jpeg_plane(f, h, &j, j.at_turn[turn]);
    return status;
}

relume_status ptm_read(struct foreign *out, const char *path, const struct relume_limits *limits,
                       const struct relume_log *log)
{
    struct header h = {.path = path, .limits = limits, .log = log};
    struct bytes b;
    *out = (struct foreign){0};
    relume_status status = bytes_load(&b, path, log);
    if (!status)
        status = read_header(&h, &b);
    if (!status)
        status = h.jpeg ? read_jpegs(out, &h, &b) : read_raw(out, &h, &b);
    bytes_free(&b);
    if (status)
        foreign_free(out);
    return status;
}

// ---------------------------------------------------------------- writing

struct ptm_quantiser ptm_quantiser(double min, double max)
{
    min = fmin(min, 0.0);
    max = fmax(max, 0.0);
    if (!(max - min > 1e-6))
        return (struct ptm_quantiser){1.0, 0};
    // one code of room, since the bias is whole
    struct ptm_quantiser q = {(max - min) / 254.0, 0};
    q.bias = (int)ceil(-min / q.scale - 1e-9);
    return q;
}

// As few digits as are read back as the same number.
static void print_scale(FILE *f, float scale)
{
    char text[32];
    for (int digits = 6; digits <= 12; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, 255.0 * (double)scale);
        if ((float)(strtod(text, NULL) / 255.0) == scale)
            break;
    }
    fprintf(f, "%s ", text);
}

static void print_header(const struct foreign *f, FILE *out)
{
    const int copies = f->form == FOREIGN_LUMINANCE ? 1 : 3;
    fprintf(out, "PTM_1.2\nPTM_FORMAT_%s\n%d\n%d\n", copies == 1 ? "LRGB" : "RGB", f->width,
            f->height);
    for (int i = 0; i < TERMS; i++)
        print_scale(out, f->scale[term_of_place[i] * copies]);
    fputs("\n", out);
    for (int i = 0; i < TERMS; i++) {
        const int p = term_of_place[i] * copies;
        fprintf(out, "%ld ", lround(-(double)f->offset[p] / (double)f->scale[p]));
    }
    fputs("\n", out);
}

static void gather(const struct foreign *f, int row, uint8_t *to, int count, const int *planes)
{
    for (int i = 0; i < count; i++) {
        const uint8_t *from = plane_row(f, planes[i], row);
        for (size_t x = 0; x < (size_t)f->width; x++)
            to[x * (size_t)count + (size_t)i] = from[x];
    }
}

static void gather_all(const struct foreign *f, uint8_t *to)
{
    static const int colours[3] = {TERMS, TERMS + 1, TERMS + 2};
    const size_t width = (size_t)f->width;
    const bool luminance = f->form == FOREIGN_LUMINANCE;
    for (int c = 0; c < (luminance ? 1 : 3); c++) {
        int planes[TERMS];
        for (int i = 0; i < TERMS; i++)
            planes[i] = luminance ? term_of_place[i] : 3 * term_of_place[i] + c;
        for (int y = 0; y < f->height; y++, to += width * TERMS)
            gather(f, y, to, TERMS, planes);
    }
    for (int y = 0; luminance && y < f->height; y++, to += width * 3)
        gather(f, y, to, 3, colours);
}

relume_status ptm_write(const struct foreign *f, const char *path, const struct relume_log *log)
{
    char *text = NULL;
    size_t text_size = 0;
    const size_t body = foreign_pixels(f) * (size_t)f->planes;
    FILE *header = open_memstream(&text, &text_size);
    if (!header)
        return RELUME_ENOMEM;
    print_header(f, header);
    const bool failed = fclose(header) != 0;
    uint8_t *bytes = failed ? NULL : mem_array(text_size + body, 1);
    relume_status status = RELUME_ENOMEM;
    if (bytes) {
        memcpy(bytes, text, text_size);
        gather_all(f, bytes + text_size);
        status = outfile_save(path, bytes, text_size + body, log);
    }
    free(text);
    free(bytes);
    return status;
}
