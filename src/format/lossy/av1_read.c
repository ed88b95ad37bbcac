// av1_read.c - the one place that knows dav1d
#include "format/lossy/av1.h"

#include <dav1d/dav1d.h>
#include <errno.h>
#include <string.h>

enum { MOST_BITS = 12 };

static void keep(const uint8_t *data, void *nobody)
{
    (void)data, (void)nobody;
}

static bool fits(const Dav1dPicture *p, const struct av1_shape *shape)
{
    const bool grey =
        p->p.layout == DAV1D_PIXEL_LAYOUT_I400 || p->p.layout == DAV1D_PIXEL_LAYOUT_I420;
    return p->p.w == shape->width && p->p.h == shape->height &&
           (shape->components == 1 ? grey : p->p.layout == DAV1D_PIXEL_LAYOUT_I444);
}

// A sample in 12 bits, to the nearest; `chroma` keeps its middle.
static uint16_t widen(int sample, int bits, bool chroma)
{
    const int top = (1 << bits) - 1, from = chroma ? 1 << (bits - 1) : 0,
              to = chroma ? AV1_MIDDLE : 0;
    const int scaled = (sample - from) * AV1_TOP;
    const int v = to + (scaled + (scaled < 0 ? -top : top) / 2) / top;
    return (uint16_t)(v < 0 ? 0 : v > AV1_TOP ? AV1_TOP : v);
}

// table[1 << bits]: every sample in 12 bits.
static void fill_table(uint16_t *table, int bits, bool chroma)
{
    for (int v = 0; v < 1 << bits; v++)
        table[v] = widen(v, bits, chroma);
}

static void copy(uint16_t *samples, const Dav1dPicture *p, const struct av1_shape *shape)
{
    const size_t width = (size_t)shape->width, height = (size_t)shape->height;
    uint16_t table[1 << MOST_BITS];
    for (int c = 0; c < shape->components; c++) {
        fill_table(table, p->p.bpc, c > 0);
        for (size_t y = 0; y < height; y++, samples += width) {
            const void *row = (const char *)p->data[c] + (ptrdiff_t)y * p->stride[c > 0];
            const uint8_t *narrow = row;
            const uint16_t *wide = row;
            for (size_t x = 0; x < width; x++)
                samples[x] = p->p.bpc > 8 ? table[wide[x]] : table[narrow[x]];
        }
    }
}

// The pictures that are ready, of which those of another sequence (`to` NULL) are left out; 0 when
// more data is wanted, else the library's error.
static int take_picture(const struct av1_pictures *to, const struct av1_shape *shape,
                        Dav1dContext *context, int *taken)
{
    int error;
    Dav1dPicture p = {0};
    while (!(error = dav1d_get_picture(context, &p))) {
        const bool right = *taken < shape->pictures && fits(&p, shape);
        if (right && to) {
            copy(to->samples, &p, shape);
            to->take(to->user, *taken);
        }
        dav1d_picture_unref(&p);
        if (!right)
            return DAV1D_ERR(EINVAL);
        ++*taken;
    }
    return error == DAV1D_ERR(EAGAIN) ? 0 : error;
}

static int send(const struct av1_pictures *to, const struct av1_shape *shape, Dav1dContext *context,
                int *taken, const unsigned char *byte, size_t size)
{
    Dav1dData data = {0};
    int error = size ? dav1d_data_wrap(&data, byte, size, keep, NULL) : DAV1D_ERR(EINVAL);
    while (!error && data.sz) {
        const int sent = dav1d_send_data(context, &data);
        error = sent && sent != DAV1D_ERR(EAGAIN) ? sent : take_picture(to, shape, context, taken);
    }
    if (!error)
        error = take_picture(to, shape, context, taken);
    dav1d_data_unref(&data);
    return error;
}

// ---------------------------------------------------------------- temporal units

enum { OBU_DELIMITER = 2 };

// Where the unit (OBU) that begins at `at` ends, `size` when it does not say so rightly.
static size_t unit_end(const unsigned char *byte, size_t size, size_t at)
{
    const bool extended = byte[at] & 4, sized = byte[at] & 2;
    size_t length = 0;
    at += extended ? 2 : 1;
    for (int shift = 0; sized && at < size && shift < 56; shift += 7) {
        length |= (size_t)(byte[at] & 127) << shift;
        if (!(byte[at++] & 128))
            return length < size - at ? at + length : size;
    }
    return size;
}

// Where the picture that begins at `at` ends: before the next delimiter.
static size_t picture_end(const struct av1_bytes *b, size_t at)
{
    at = unit_end(b->byte, b->size, at);
    while (at < b->size && (b->byte[at] >> 3 & 15) != OBU_DELIMITER)
        at = unit_end(b->byte, b->size, at);
    return at;
}

// One picture of the group's first sequence and one of this in turn.
static int send_both(const struct av1_pictures *to, const struct av1_shape *shape,
                     Dav1dContext *context, const struct av1_bytes *bytes,
                     const struct av1_bytes *first, int *taken)
{
    size_t at = 0, at_first = 0;
    int error = 0, taken_first = 0;
    while (!error && at < bytes->size && at_first < first->size) {
        const size_t end = picture_end(bytes, at), end_first = picture_end(first, at_first);
        error =
            send(NULL, shape, context, &taken_first, first->byte + at_first, end_first - at_first);
        if (!error)
            error = send(to, shape, context, taken, bytes->byte + at, end - at);
        at = end;
        at_first = end_first;
    }
    return error;
}

relume_status av1_decode_each(const struct av1_pictures *to, const struct av1_shape *shape,
                              const struct av1_bytes *bytes, const struct av1_bytes *first)
{
    Dav1dSettings settings;
    Dav1dContext *context;
    int taken = 0;
    dav1d_default_settings(&settings);
    settings.n_threads = 1;
    settings.frame_size_limit = (unsigned)shape->width * (unsigned)shape->height;
    settings.logger.callback = NULL;
    if (dav1d_open(&context, &settings))
        return RELUME_ENOMEM;
    const int error = first ? send_both(to, shape, context, bytes, first, &taken)
                            : send(to, shape, context, &taken, bytes->byte, bytes->size);
    dav1d_close(&context);
    if (error == DAV1D_ERR(ENOMEM))
        return RELUME_ENOMEM;
    return !error && taken == shape->pictures ? RELUME_OK : RELUME_EDAMAGED;
}

struct keeping {
    struct av1_pictures to;
    size_t size;  // of a picture
};

static void keep_picture(void *user, int number)
{
    struct keeping *k = user;
    (void)number;
    k->to.samples += k->size;
}

relume_status av1_decode(uint16_t *samples, const struct av1_shape *shape,
                         const struct av1_bytes *bytes, const struct av1_bytes *first)
{
    struct keeping k = {.to = {samples, keep_picture, &k},
                        .size = (size_t)shape->components * (size_t)shape->width *
                                (size_t)shape->height};
    return av1_decode_each(&k.to, shape, bytes, first);
}
