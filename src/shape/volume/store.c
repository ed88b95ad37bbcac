// store.c - samples of every type of file on their way into memory
#include "shape/volume/store.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/scratch.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <string.h>

static const struct sample_type types[] = {
    {"u8", 1, 'u'},  {"i8", 1, 'i'},  {"u16", 2, 'u'}, {"i16", 2, 'i'},
    {"u32", 4, 'u'}, {"i32", 4, 'i'}, {"f32", 4, 'f'}, {"f64", 8, 'f'},
};

const char *const relume_volume_types[] = {"u8",    "i8",    "u16le", "u16be", "i16le",
                                           "i16be", "u32le", "u32be", "i32le", "i32be",
                                           "f32le", "f32be", "f64le", "f64be", NULL};

const struct sample_type *sample_type_find(const char *name, bool *big)
{
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        const size_t length = strlen(types[i].name);
        if (strncmp(name, types[i].name, length))
            continue;
        const char *end = name + length;
        if (!strcmp(end, "be") || !strcmp(end, "le"))
            *big = *end == 'b';
        else if (*end)
            continue;
        return &types[i];
    }
    return NULL;
}

// Whole numbers of up to 16 bits stay as they are, unless they are scaled.
static enum volume_type kept_type(const struct store *s)
{
    const bool scaled = s->slope != 1.0 || s->intercept != 0.0;
    if (scaled || s->type->kind == 'f' || s->type->bytes > 2)
        return VOLUME_F32;
    if (s->type->kind == 'u')
        return s->type->bytes == 1 ? VOLUME_U8 : VOLUME_U16;
    return VOLUME_I16;
}

static size_t bytes_of(enum volume_type type)
{
    static const size_t bytes[VOLUME_TYPES] = {1, 2, 2, 4};
    return bytes[type];
}

static size_t samples_of(const relume_volume *v)
{
    return (size_t)v->size[0] * (size_t)v->size[1] * (size_t)v->size[2];
}

relume_status store_check(const struct store *s, const int64_t size[3])
{
    const int64_t most = 65536;
    for (int c = 0; c < 3; c++)
        if (size[c] < 2 || size[c] > most)
            return log_fail(s->log, size[c] < 2 ? RELUME_EUNFIT : RELUME_ELIMIT,
                            "%s: %lld x %lld x %lld samples; expected 2 to %lld along each axis",
                            s->path, (long long)size[0], (long long)size[1], (long long)size[2],
                            (long long)most);
    return RELUME_OK;
}

// Memory up to 1 GiB, a file without a name beyond, which is not held against --max-memory.
static relume_status map_samples(struct store *s, const struct relume_volume_params *p)
{
    relume_volume *v = s->volume;
    const size_t bytes = samples_of(v) * bytes_of(v->type), most = (size_t)1 << 30;
    const struct relume_limits *given = limits_of(p->limits, s->log);
    const struct relume_limits limits = limits_or_default(given);
    if (bytes <= most && bytes <= limits.max_memory) {
        v->data = mem_large(bytes);
        return v->data ? RELUME_OK : RELUME_ENOMEM;
    }
    v->data = scratch_map(p->scratch, bytes);
    v->mapped = v->data ? bytes : 0;
    return v->data ? RELUME_OK
                   : log_fail(s->log, RELUME_EIO, "%s: no room for %zu MB of samples in %s; %s",
                              s->path, bytes >> 20, p->scratch ? p->scratch : scratch_folder(),
                              strerror(errno));
}

relume_status store_begin(struct store *s, const int64_t size[3],
                          const struct relume_volume_params *p)
{
    relume_status status = store_check(s, size);
    if (status)
        return status;
    relume_volume *v = s->volume = mem_zeroed(1, sizeof *v);
    if (!v)
        return RELUME_ENOMEM;
    v->type = kept_type(s);
    v->min = INFINITY;
    v->max = -INFINITY;
    for (int c = 0; c < 3; c++) {
        v->size[c] = (int)size[c];
        v->spacing[c] = p->spacing[c] > 0.0 ? p->spacing[c] : 1.0;
    }
    s->filled = 0;
    return map_samples(s, p);
}

relume_status volume_create(relume_volume **out, const int size[3], const char *type,
                            const struct relume_volume_params *p)
{
    struct store s = {.slope = 1.0, .path = "volume", .log = p->log};
    s.type = sample_type_find(type, &s.big);
    const relume_status status = store_begin(&s, (const int64_t[3]){size[0], size[1], size[2]}, p);
    if (status)
        relume_volume_destroy(&s.volume);
    *out = s.volume;
    return status;
}

size_t store_layer_bytes(const struct store *s)
{
    return (size_t)s->volume->size[0] * (size_t)s->volume->size[1] * (size_t)s->type->bytes;
}

// ---------------------------------------------------------------- samples

static uint64_t bits_of(const uint8_t *from, int bytes, bool big)
{
    uint64_t bits = 0;
    for (int i = 0; i < bytes; i++)
        bits |= (uint64_t)from[i] << 8 * (big ? bytes - 1 - i : i);
    return bits;
}

static double value_of(uint64_t bits, const struct sample_type *type)
{
    const uint32_t low = (uint32_t)bits;
    float f;
    double d;
    if (type->kind == 'f') {
        memcpy(&f, &low, sizeof f);
        memcpy(&d, &bits, sizeof d);
        return type->bytes == 4 ? (double)f : d;
    }
    if (type->kind == 'i')
        return type->bytes == 1 ? (int8_t)bits : type->bytes == 2 ? (int16_t)bits : (int32_t)bits;
    return (double)bits;
}

static relume_status put_floats(struct store *s, const uint8_t *from, size_t count)
{
    float *to = (float *)s->volume->data + s->filled;
    for (size_t i = 0; i < count; i++, from += s->type->bytes) {
        const double value =
            value_of(bits_of(from, s->type->bytes, s->big), s->type) * s->slope + s->intercept;
        if (!(fabs(value) <= (double)FLT_MAX)) {
            const size_t at = s->filled + i, width = (size_t)s->volume->size[0];
            const size_t height = (size_t)s->volume->size[1];
            return log_fail(s->log, RELUME_EDAMAGED,
                            "%s: the sample at %zu,%zu,%zu is no finite number; wrong --type or "
                            "byte order?",
                            s->path, at % width, at / width % height, at / width / height);
        }
        to[i] = (float)value;
    }
    return RELUME_OK;
}

static void put_whole(struct store *s, const uint8_t *from, size_t count)
{
    if (s->type->bytes == 2) {
        uint16_t *to = (uint16_t *)s->volume->data + s->filled;
        for (size_t i = 0; i < count; i++)
            to[i] = (uint16_t)(s->big ? from[2 * i] << 8 | from[2 * i + 1]
                                      : from[2 * i + 1] << 8 | from[2 * i]);
    } else if (s->type->kind == 'u') {
        memcpy((uint8_t *)s->volume->data + s->filled, from, count);
    } else {
        int16_t *to = (int16_t *)s->volume->data + s->filled;
        for (size_t i = 0; i < count; i++)
            to[i] = (int8_t)from[i];
    }
}

// Of the samples that are in memory already.
static void extend_range(relume_volume *v, size_t first, size_t count)
{
    float min = v->min, max = v->max;
    for (size_t i = first; i < first + count; i++) {
        const float value = volume_sample(v, i);
        min = value < min ? value : min;
        max = value > max ? value : max;
    }
    v->min = min;
    v->max = max;
}

relume_status store_put(struct store *s, const void *samples, size_t count)
{
    relume_status status = RELUME_OK;
    if (s->volume->type == VOLUME_F32)
        status = put_floats(s, samples, count);
    else
        put_whole(s, samples, count);
    if (status)
        return status;
    extend_range(s->volume, s->filled, count);
    s->filled += count;
    return RELUME_OK;
}

relume_status store_end(struct store *s)
{
    const relume_volume *v = s->volume;
    return v->min < v->max ? RELUME_OK
                           : log_fail(s->log, RELUME_EUNFIT,
                                      "%s: all samples are %g, so that there is no surface; wrong "
                                      "--type, --size or file?",
                                      s->path, (double)v->min);
}
