// rti.c - .rti: comment lines, text numbers, then little-endian binary; rows from the top
#include "exchange/formats/rti.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "exchange/formats/bytes.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { KIND_HSH = 3, COLOUR_RGB = 2, MOST_TERMS = 16 };

struct header {
    const char *path;
    const struct relume_limits *limits;
    const struct relume_log *log;
    long width, height;
    int terms;
    float scale[MOST_TERMS], offset[MOST_TERMS];  // of codes 0..255
};

static relume_status read_text(struct header *h, struct bytes *b)
{
    long kind, channels, terms, colour, size;
    bytes_skip_comments(b, '#');
    if (!bytes_integer(b, &kind))
        return log_wrong(h->log, h->path, "not a relightable image", "comments, then 3 for HSH");
    if (kind != KIND_HSH)
        return log_fail(h->log, RELUME_EUNSUPPORTED,
                        "%s: kind %ld is not supported; expected 3, hemispherical harmonics",
                        h->path, kind);
    if (!bytes_integer(b, &h->width) || !bytes_integer(b, &h->height) ||
        !bytes_integer(b, &channels))
        return log_wrong(h->log, h->path, "no size", "width, height, channels");
    if (!bytes_integer(b, &terms) || !bytes_integer(b, &colour) || !bytes_integer(b, &size))
        return log_wrong(h->log, h->path, "no layout", "terms, colour type, bytes of an element");
    if (channels != 3 || colour != COLOUR_RGB || size != 1)
        return log_fail(h->log, RELUME_EUNSUPPORTED,
                        "%s: layout; expected 3 channels, colour type 2, elements of 1 byte",
                        h->path);
    if (terms < 1 || terms > MOST_TERMS || !functions_has_count(FUNCTIONS_HSH, (int)terms))
        return log_fail(h->log, RELUME_EUNSUPPORTED, "%s: %ld terms; expected 1, 4, 9 or 16",
                        h->path, terms);
    h->terms = (int)terms;
    return bytes_line_end(b) ? RELUME_OK
                             : log_wrong(h->log, h->path, "layout", "the end of the line");
}

static relume_status read_ranges(struct header *h, struct bytes *b, bool old)
{
    float first[MOST_TERMS], second[MOST_TERMS];
    bool good = true;
    for (int k = 0; k < h->terms; k++)
        good = good && bytes_float(b, &first[k]);
    for (int k = 0; k < h->terms; k++)
        good = good && bytes_float(b, &second[k]);
    if (!good)
        return log_fail(h->log, RELUME_EDAMAGED,
                        "%s: truncated; expected two numbers for every term", h->path);
    for (int k = 0; k < h->terms; k++) {
        const float range = old ? second[k] - first[k] : first[k];
        h->scale[k] = range / 255.0f;
        h->offset[k] = old ? first[k] : second[k];
        if (!(fabsf(range) < 1e6f) || !(fabsf(h->offset[k]) < 1e6f))
            return log_fail(h->log, RELUME_EDAMAGED,
                            "%s: range of a term; expected finite numbers below 1e6", h->path);
    }
    return RELUME_OK;
}

static relume_status read_codes(struct foreign *f, const struct header *h, struct bytes *b)
{
    const relume_status allowed = limits_picture(h->limits, h->path, h->width, h->height, h->log);
    if (allowed)
        return allowed;
    const size_t terms = (size_t)h->terms;
    const size_t pixels = (size_t)h->width * (size_t)h->height, need = pixels * 3 * terms;
    const uint8_t *from = bytes_take(b, need);
    if (!from)
        return log_fail(h->log, RELUME_EDAMAGED,
                        "%s: truncated; expected %zu bytes of pixels, found %zu", h->path, need,
                        b->size - b->at);
    f->form = FOREIGN_CHANNELS;
    f->functions = (struct functions){.kind = FUNCTIONS_HSH, .count = h->terms};
    f->terms = h->terms;
    const relume_status status =
        foreign_create(f, h->path, h->width, h->height, 3 * h->terms, h->limits, h->log);
    if (status)
        return status;
    for (size_t p = 0; p < 3 * terms; p++) {
        f->scale[p] = h->scale[p / 3];
        f->offset[p] = h->offset[p / 3];
    }
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3; c++)
            for (size_t k = 0; k < terms; k++)
                f->codes[(3 * k + c) * pixels + i] = *from++;
    return RELUME_OK;
}

relume_status rti_read(struct foreign *out, const char *path, bool old,
                       const struct relume_limits *limits, const struct relume_log *log)
{
    struct header h = {.path = path, .limits = limits, .log = log};
    struct bytes b;
    *out = (struct foreign){0};
    relume_status status = bytes_load(&b, path, log);
    if (!status)
        status = read_text(&h, &b);
    if (!status)
        status = read_ranges(&h, &b, old);
    if (!status)
        status = read_codes(out, &h, &b);
    bytes_free(&b);
    if (status)
        foreign_free(out);
    return status;
}

// ---------------------------------------------------------------- writing

static void put_float(FILE *f, float v)
{
    uint32_t bits;
    memcpy(&bits, &v, sizeof bits);
    for (int i = 0; i < 4; i++)
        fputc((int)(bits >> 8 * i & 0xff), f);
}

relume_status rti_write(const struct foreign *f, const char *path,
                        const struct relume_writer *writer, const struct relume_log *log)
{
    const size_t pixels = foreign_pixels(f), terms = (size_t)f->terms;
    char *text = NULL;
    size_t text_size = 0;
    FILE *header = open_memstream(&text, &text_size);
    if (!header)
        return RELUME_ENOMEM;
    fprintf(header, "#HSH1.2\n3\n%d %d 3\n%d %d 1\n", f->width, f->height, f->terms, COLOUR_RGB);
    for (size_t k = 0; k < terms; k++)
        put_float(header, 255.0f * f->scale[3 * k]);
    for (size_t k = 0; k < terms; k++)
        put_float(header, f->offset[3 * k]);
    const bool failed = fclose(header) != 0;
    uint8_t *bytes = failed ? NULL : mem_array(text_size + pixels * 3 * terms, 1);
    relume_status status = RELUME_ENOMEM;
    if (bytes) {
        memcpy(bytes, text, text_size);
        uint8_t *to = bytes + text_size;
        for (size_t i = 0; i < pixels; i++)
            for (size_t c = 0; c < 3; c++)
                for (size_t k = 0; k < terms; k++)
                    *to++ = f->codes[(3 * k + c) * pixels + i];
        status = outfile_save_to(path, writer, bytes, text_size + pixels * 3 * terms, log);
    }
    mem_free_libc(text);
    mem_free(bytes);
    return status;
}
