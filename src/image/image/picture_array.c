// picture_array.c - samples in memory, read as a picture file is
#include "core/base/half.h"
#include "core/base/memory.h"
#include "image/image/picture.h"
#include "image/image/picture_format.h"

#include <string.h>

struct array_picture {
    picture_reader reader;  // first
    struct picture_array array;
};

// Where a row begins, and how many samples some have.
static const char *find_rows(const picture_reader *reader, int row, int rows, size_t *samples)
{
    const struct picture_array *a = &((const struct array_picture *)reader)->array;
    const size_t width = (size_t)a->width * (size_t)a->channels;
    *samples = (size_t)rows * width;
    return (const char *)a->data + (size_t)row * width * a->bytes;
}

static relume_status read_bytes(picture_reader *reader, int row, int rows, uint8_t *out)
{
    size_t n;
    const char *from = find_rows(reader, row, rows, &n);
    memcpy(out, from, n);
    return RELUME_OK;
}

static relume_status read_floats(picture_reader *reader, int row, int rows, float *out)
{
    size_t n;
    const char *from = find_rows(reader, row, rows, &n);
    const bool halves = ((const struct array_picture *)reader)->array.halves;
    if (reader->info.floats && !halves) {
        memcpy(out, from, n * sizeof *out);
        return RELUME_OK;
    }
    for (size_t i = 0; i < n; i++) {
        uint16_t code;  // which a program may have put at any address
        memcpy(&code, from + i * sizeof code, sizeof code);
        out[i] = halves ? float_from_half(code) : (float)code / 65535.0f;
    }
    return RELUME_OK;
}

static const char *error(const picture_reader *reader)
{
    (void)reader;
    return "";
}

static void close(picture_reader *reader)
{
    mem_free(reader);
}

static const struct picture_format format = {
    .read_floats = read_floats, .read_bytes = read_bytes, .error = error, .close = close};

relume_status array_picture_open(picture_reader **out, const struct picture_array *array)
{
    const bool floats = array->halves || array->bytes == sizeof(float);
    const int last = array->channels >= 3 ? 2 : 0;
    struct array_picture *p = mem_zeroed(1, sizeof *p);
    *out = p ? &p->reader : NULL;
    if (!p)
        return RELUME_ENOMEM;
    p->array = *array;
    p->reader = (picture_reader){.format = &format,
                                 .info = {.width = array->width,
                                          .height = array->height,
                                          .channels = array->channels,
                                          .rgb = {0, last / 2, last},
                                          .bytes = array->bytes == 1,
                                          .floats = floats,
                                          .linear = floats,
                                          .jumps = true}};
    return RELUME_OK;
}
