// codes.c - stored coefficients: the kinds of codes by name and bound, and codes as numbers. Nobody
// else needs to know how a code lies in memory.
#include <relume/format/coder.h>

#include "core/base/memory.h"
#include "format/coder/codes.h"
#include "core/base/half.h"
#include "format/coder/coding.h"

#include <math.h>
#include <string.h>

static const struct {
    const char *name;
    int top;
    enum exr_sample sample;
} kinds[] = {
    [RELUME_STORE_8] = {"8", 255, EXR_SAMPLE_HALF},
    [RELUME_STORE_10] = {"10", 1023, EXR_SAMPLE_HALF},
    [RELUME_STORE_12] = {"12", 4095, EXR_SAMPLE_UINT},
    [RELUME_STORE_16] = {"16", 65535, EXR_SAMPLE_UINT},
    [RELUME_STORE_HALF] = {"half", 0, EXR_SAMPLE_HALF},
    [RELUME_STORE_FLOAT] = {"float", 0, EXR_SAMPLE_FLOAT},
    [RELUME_STORE_LOG] = {"log", 0, EXR_SAMPLE_HALF},
};

const char *relume_storage_name(enum relume_storage storage)
{
    return kinds[storage].name;
}

int relume_storage_top(enum relume_storage storage)
{
    return kinds[storage].top;
}

relume_status relume_storage_parse(enum relume_storage *out, const char *name)
{
    for (size_t i = 1; i < sizeof kinds / sizeof *kinds; i++)
        if (!strcmp(kinds[i].name, name)) {
            *out = (enum relume_storage)i;
            return RELUME_OK;
        }
    return RELUME_EINVAL;
}

enum exr_sample codes_sample(enum relume_storage storage)
{
    return kinds[storage].sample;
}

// The code of a number, which it is when nothing is wrong. Without branches compilers vectorise it.
static inline int whole_code(float number, float top, unsigned *wrong)
{
    const float positive = number >= 0.0f ? number : 0.0f;
    const int code = (int)(positive <= top ? positive : 0.0f);
    *wrong |= (float)code != number;
    return code;
}

bool codes_keep(void *codes, enum relume_storage storage, size_t first, const float *numbers,
                size_t n)
{
    const float top = (float)relume_storage_top(storage);
    uint8_t *bytes = (uint8_t *)codes + first;
    uint16_t *words = (uint16_t *)codes + first;
    unsigned wrong = 0;
    switch (storage) {
    case RELUME_STORE_8:
        for (size_t i = 0; i < n; i++)
            bytes[i] = (uint8_t)whole_code(numbers[i], top, &wrong);
        break;
    case RELUME_STORE_HALF:
        for (size_t i = 0; i < n; i++) {
            words[i] = half_from_float(numbers[i]);
            wrong |= (words[i] & 0x7c00) == 0x7c00;
        }
        break;
    case RELUME_STORE_FLOAT:
        memcpy((float *)codes + first, numbers, n * sizeof *numbers);
        for (size_t i = 0; i < n; i++)
            wrong |= !isfinite(numbers[i]);
        break;
    default:
        for (size_t i = 0; i < n; i++)
            words[i] = (uint16_t)whole_code(numbers[i], top, &wrong);
    }
    return !wrong;
}

static void numbers_of(float *out, enum relume_storage storage, const void *codes, size_t first,
                       size_t n)
{
    const uint8_t *bytes = (const uint8_t *)codes + first;
    const uint16_t *words = (const uint16_t *)codes + first;
    switch (storage) {
    case RELUME_STORE_8:
        for (size_t i = 0; i < n; i++)
            out[i] = bytes[i];
        break;
    case RELUME_STORE_HALF: exr_to_floats(out, EXR_SAMPLE_HALF, words, n); break;
    case RELUME_STORE_FLOAT: memcpy(out, (const float *)codes + first, n * sizeof *out); break;
    default:
        for (size_t i = 0; i < n; i++)
            out[i] = words[i];
    }
}

void codes_restore(float *out, enum relume_storage storage, const void *codes, size_t first,
                   size_t n, float scale, float offset)
{
    numbers_of(out, storage, codes, first, n);
    for (size_t i = 0; i < n; i++)
        out[i] = out[i] * scale + offset;
}

enum { RUN = 1024 };  // numbers between codes and samples: they stay in the cache

// A float's exponent and mantissa are those of a half where no bit is lost.
static void halves_of_bytes(uint16_t *out, const uint8_t *bytes, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const uint32_t bits = bits_of_float((float)bytes[i]) - (112u << 23);
        out[i] = (uint16_t)(bytes[i] ? bits >> 13 : 0);
    }
}

void codes_to_samples(void *samples, enum relume_storage storage, const void *codes, size_t n)
{
    if (storage == RELUME_STORE_8) {
        halves_of_bytes(samples, codes, n);
        return;
    }
    float numbers[RUN];
    const enum exr_sample sample = codes_sample(storage);
    for (size_t at = 0; at < n; at += RUN) {
        const size_t count = n - at < RUN ? n - at : RUN;
        numbers_of(numbers, storage, codes, at, count);
        exr_from_floats((char *)samples + at * exr_sample_bytes(sample), sample, numbers, count);
    }
}

bool codes_from_samples(void *codes, enum relume_storage storage, const void *samples, size_t n)
{
    float numbers[RUN];
    bool good = true;
    const enum exr_sample sample = codes_sample(storage);
    for (size_t at = 0; at < n; at += RUN) {
        const size_t count = n - at < RUN ? n - at : RUN;
        exr_to_floats(numbers, sample, (const char *)samples + at * exr_sample_bytes(sample),
                      count);
        good &= codes_keep(codes, storage, at, numbers, count);
    }
    return good;
}

void relume_codes_plane(const struct relume_codes *codes, int plane, size_t first, size_t n,
                        float *out)
{
    if (!codes->books) {
        codes_restore(out, codes->storage, codes->plane[plane], first, n, codes->scale[plane],
                      codes->offset[plane]);
        return;
    }
    memset(out, 0, n * sizeof *out);
    for (int b = 0; b < codes->books; b++) {
        const uint16_t *index = codes->index[b] + first;
        const float *vectors = codes->vectors[b] + plane;
        for (size_t i = 0; i < n; i++)
            out[i] += vectors[(size_t)index[i] * (size_t)codes->planes];
    }
}

// ---------------------------------------------------------------- some of the pixels

void relume_codes_part_destroy(struct relume_codes_part *part)
{
    mem_free(part->memory);
    *part = (struct relume_codes_part){.memory = NULL};
}

static size_t code_bytes(const struct relume_codes *codes)
{
    return codes->books ? sizeof(uint16_t) : relume_storage_bytes(codes->storage);
}

relume_status codes_part_create(struct relume_codes_part *out, void **data,
                                const struct relume_codes *like, int width, int height)
{
    const size_t arrays = (size_t)(like->books ? like->books : like->planes);
    const size_t bytes = (size_t)width * (size_t)height * code_bytes(like);
    char *memory = mem_array(arrays, sizeof(void *) + 2 * sizeof(float) + bytes);
    *out = (struct relume_codes_part){.memory = NULL};
    if (!memory)
        return RELUME_ENOMEM;
    const void **plane = (const void **)(void *)memory;
    float *steps = (float *)(void *)(memory + arrays * sizeof *plane);
    *data = steps + 2 * arrays;
    for (size_t i = 0; i < arrays; i++)
        plane[i] = (const char *)*data + i * bytes;
    *out = (struct relume_codes_part){*like, memory};
    out->codes.width = width;
    out->codes.height = height;
    if (like->books) {
        out->codes.index = (const uint16_t *const *)(void *)memory;
        return RELUME_OK;
    }
    if (like->scale) {
        memcpy(steps, like->scale, arrays * sizeof *steps);
        memcpy(steps + arrays, like->offset, arrays * sizeof *steps);
    }
    out->codes.plane = plane;
    out->codes.scale = steps;
    out->codes.offset = steps + arrays;
    return RELUME_OK;
}

static const char *array_of(const struct relume_codes *codes, size_t i)
{
    return codes->books ? (const char *)codes->index[i] : codes->plane[i];
}

relume_status relume_codes_crop(struct relume_codes_part *out, const struct relume_codes *codes,
                                const struct relume_rect *rect)
{
    const size_t size = code_bytes(codes),
                 arrays = (size_t)(codes->books ? codes->books : codes->planes);
    const size_t row = size * (size_t)rect->width, stride = size * (size_t)codes->width;
    void *data;
    const relume_status status = codes_part_create(out, &data, codes, rect->width, rect->height);
    char *to = status ? NULL : data;
    for (size_t i = 0; to && i < arrays; i++)
        for (size_t y = 0; y < (size_t)rect->height; y++, to += row)
            memcpy(to,
                   array_of(codes, i) + ((size_t)rect->top + y) * stride +
                       (size_t)rect->left * size,
                   row);
    return status;
}

relume_status relume_codes_pick(struct relume_codes_part *out, const struct relume_codes *codes,
                                size_t first, size_t step, size_t n)
{
    const size_t size = code_bytes(codes),
                 arrays = (size_t)(codes->books ? codes->books : codes->planes);
    void *data;
    const relume_status status = codes_part_create(out, &data, codes, (int)n, 1);
    char *to = status ? NULL : data;
    for (size_t r = 0; to && r < arrays; r++, to += n * size) {
        const char *from = array_of(codes, r) + first * size;
        if (step == 1)
            memcpy(to, from, n * size);
        for (size_t i = 0; step != 1 && i < n; i++)
            memcpy(to + i * size, from + i * step * size, size);
    }
    return status;
}
