// ptm.c - .ptm: text lines, then bytes; rows from the bottom, terms x2 y2 xy x y 1
#include "exchange/formats/ptm.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "exchange/formats/ptm_parts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const int ptm_term_of_place[PTM_TERMS] = {3, 5, 4, 1, 2, 0};

static relume_status read_format(struct ptm_header *h, struct bytes *b)
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
        return log_wrong(h->log, h->path, "not a polynomial texture map",
                         "PTM_1.2 in the first line");
    if (!(h->version >= 1.0 && h->version < 2.0))
        return log_fail(h->log, RELUME_EUNSUPPORTED,
                        "%s: %s; expected a version from PTM_1.0 to PTM_1.2", h->path, word);
    if (!bytes_word(b, word, sizeof word))
        return log_wrong(h->log, h->path, "no format", "PTM_FORMAT_RGB or another");
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (!strcmp(word, formats[i].name)) {
            h->luminance = formats[i].luminance;
            h->jpeg = formats[i].jpeg;
            return RELUME_OK;
        }
    return log_fail(h->log, RELUME_EUNSUPPORTED,
                    "%s: format %.40s is not supported; expected PTM_FORMAT_RGB, LRGB, JPEG_RGB or "
                    "JPEG_LRGB",
                    h->path, word);
}

static relume_status read_header(struct ptm_header *h, struct bytes *b)
{
    const relume_status status = read_format(h, b);
    if (status)
        return status;
    if (!bytes_integer(b, &h->width) || !bytes_integer(b, &h->height))
        return log_wrong(h->log, h->path, "no size", "width and height");
    for (int i = 0; i < PTM_TERMS; i++)
        if (!bytes_number(b, &h->scale[i]) || fabs(h->scale[i]) > 1e6)
            return log_wrong(h->log, h->path, "scale", "six numbers, at most 1e6");
    for (int i = 0; i < PTM_TERMS; i++)
        if (!bytes_integer(b, &h->bias[i]) || h->bias[i] < -1000000 || h->bias[i] > 1000000)
            return log_wrong(h->log, h->path, "bias", "six whole numbers from 0 to 255");
    return RELUME_OK;
}

relume_status ptm_create(struct foreign *f, const struct ptm_header *h)
{
    f->form = h->luminance ? FOREIGN_LUMINANCE : FOREIGN_CHANNELS;
    f->functions = (struct functions){.kind = FUNCTIONS_PTM, .count = PTM_TERMS};
    f->terms = PTM_TERMS;
    const relume_status status =
        foreign_create(f, h->path, h->width, h->height,
                       h->luminance ? PTM_TERMS + 3 : 3 * PTM_TERMS, h->limits, h->log);
    for (int i = 0; !status && i < PTM_TERMS; i++) {
        const int k = ptm_term_of_place[i], copies = h->luminance ? 1 : 3;
        for (int c = 0; c < copies; c++) {
            f->scale[k * copies + c] = (float)(h->scale[i] / 255.0);
            f->offset[k * copies + c] = (float)(-(double)h->bias[i] * h->scale[i] / 255.0);
        }
    }
    for (int c = 0; !status && h->luminance && c < 3; c++)
        f->scale[PTM_TERMS + c] = 1.0f / 255.0f;
    return status;
}

// A row of interleaved bytes goes to `count` planes.
static void scatter(const struct foreign *f, int row, const uint8_t *from, size_t stride, int count,
                    const int *planes)
{
    for (int i = 0; i < count; i++) {
        uint8_t *to = ptm_row(f, planes[i], row);
        for (size_t x = 0; x < (size_t)f->width; x++)
            to[x] = from[x * stride + (size_t)i];
    }
}

static void read_raw_rgb(const struct foreign *f, const uint8_t *body)
{
    for (int c = 0; c < 3; c++) {
        int planes[PTM_TERMS];
        for (int i = 0; i < PTM_TERMS; i++)
            planes[i] = 3 * ptm_term_of_place[i] + c;
        for (int y = 0; y < f->height; y++, body += (size_t)f->width * PTM_TERMS)
            scatter(f, y, body, PTM_TERMS, PTM_TERMS, planes);
    }
}

// Version 1.2 keeps the luminance apart from the colour, versions before interleave them.
static void read_raw_lrgb(const struct foreign *f, const uint8_t *body, bool interleaved)
{
    static const int colours[3] = {PTM_TERMS, PTM_TERMS + 1, PTM_TERMS + 2};
    const size_t width = (size_t)f->width;
    const size_t stride = interleaved ? PTM_TERMS + 3 : PTM_TERMS,
                 colour_stride = interleaved ? stride : 3;
    const uint8_t *colour =
        interleaved ? body + PTM_TERMS : body + foreign_pixels(f) * (size_t)PTM_TERMS;
    for (int y = 0; y < f->height; y++) {
        scatter(f, y, body + (size_t)y * width * stride, stride, PTM_TERMS, ptm_term_of_place);
        scatter(f, y, colour + (size_t)y * width * colour_stride, colour_stride, 3, colours);
    }
}

static relume_status read_raw(struct foreign *f, const struct ptm_header *h, struct bytes *b)
{
    if (!bytes_line_end(b))
        return log_wrong(h->log, h->path, "bias", "six whole numbers and the end of the line");
    const relume_status allowed = limits_picture(h->limits, h->path, h->width, h->height, h->log);
    if (allowed)
        return allowed;
    const size_t need =
        (size_t)h->width * (size_t)h->height * (h->luminance ? PTM_TERMS + 3 : 3 * PTM_TERMS);
    if (b->size - b->at < need)
        return log_fail(h->log, RELUME_EDAMAGED,
                        "%s: truncated; expected %zu bytes of pixels, found %zu", h->path, need,
                        b->size - b->at);
    const relume_status status = ptm_create(f, h);
    if (status)
        return status;
    if (h->luminance)
        read_raw_lrgb(f, b->data + b->at, h->version < 1.15);
    else
        read_raw_rgb(f, b->data + b->at);
    return RELUME_OK;
}

relume_status ptm_read(struct foreign *out, const char *path, const struct relume_limits *limits,
                       const struct relume_log *log)
{
    struct ptm_header h = {.path = path, .limits = limits, .log = log};
    struct bytes b;
    *out = (struct foreign){0};
    relume_status status = bytes_load(&b, path, log);
    if (!status)
        status = read_header(&h, &b);
    if (!status)
        status = h.jpeg ? ptm_read_jpegs(out, &h, &b) : read_raw(out, &h, &b);
    bytes_free(&b);
    if (status)
        foreign_free(out);
    return status;
}
