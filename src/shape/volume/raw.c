// raw.c - samples without a header; how many they are may stand in the name of their file
#include "shape/volume/readers.h"

#include "core/base/tree.h"
#include "core/base/log.h"

#include <stdio.h>
#include <string.h>

// ---------------------------------------------------------------- names

// "bucky_32x32x32_uint8.raw": the last three numbers with an x between them.
static bool size_in_name(int64_t size[3], const char *name)
{
    bool found = false;
    for (const char *c = name; *c; c++) {
        int side[3];
        const bool digit = *c >= '0' && *c <= '9';
        const bool begins = digit && (c == name || c[-1] < '0' || c[-1] > '9');
        if (!begins || sscanf(c, "%5dx%5dx%5d", &side[0], &side[1], &side[2]) != 3)
            continue;
        found = true;
        for (int i = 0; i < 3; i++)
            size[i] = side[i];
    }
    return found;
}

// The words that collections of volumes have in names; NULL: none of them. Later ones contain
// earlier ones.
static const char *type_in_name(const char *name)
{
    static const char *const words[][2] = {
        {"int8", "i8"},     {"int16", "i16"},     {"int32", "i32"},  {"float", "f32"},
        {"uint8", "u8"},    {"uint16", "u16"},    {"uint32", "u32"}, {"float32", "f32"},
        {"_u8.", "u8"},     {"_u16.", "u16"},     {"_f32.", "f32"},  {"float64", "f64"},
        {"_u16le.", "u16"}, {"_u16be.", "u16be"},
    };
    const char *type = NULL;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strstr(name, words[i][0]))
            type = words[i][1];
    return type;
}

static bool fits(const struct store *s, unpack *from, const int64_t size[3], const char *type,
                 uint64_t skip)
{
    bool big;
    uint64_t left;
    const struct sample_type *t = sample_type_find(type, &big);
    if (!t || store_check(s, size))
        return false;
    const uint64_t samples = (uint64_t)size[0] * (uint64_t)size[1] * (uint64_t)size[2];
    return !unpack_left(from, &left) || left == skip + samples * (uint64_t)t->bytes;
}

// What the name says, where as many bytes are in the file. Of packed files nobody knows how many
// before they are read: their type must be known.
static bool guess(int64_t size[3], const char **type, unpack *from, const char *path,
                  const struct relume_volume_params *p)
{
    const char *name = path_name(path);
    const char *one = *type ? *type : type_in_name(name);
    const struct store quiet = {.path = path};
    uint64_t left;
    if (!size_in_name(size, name) || (!one && !unpack_left(from, &left)))
        return false;
    *type = one ? one : fits(&quiet, from, size, "u8", p->skip) ? "u8" : "u16le";
    if (!fits(&quiet, from, size, *type, p->skip))
        return false;
    log_line(p->log, RELUME_NOTE, "%s: taken as %d x %d x %d samples of %s, as its name says", path,
             (int)size[0], (int)size[1], (int)size[2], *type);
    return true;
}

// ---------------------------------------------------------------- reading

relume_status volume_read_raw(struct store *s, const char *path,
                              const struct relume_volume_params *p)
{
    int64_t size[3] = {p->size[0], p->size[1], p->size[2]};
    const char *type = p->type;
    unpack *from;
    if (type && !sample_type_find(type, &s->big))
        return log_fail(p->log, RELUME_EINVAL,
                        "samples of type '%s'; expected one of u8, i8, u16le, u16be and so on",
                        type);
    relume_status status = unpack_open(&from, path, 0, NULL, p->log);
    if (status)
        return status;
    if (!size[0] && !guess(size, &type, from, path, p))
        status = log_fail(p->log, RELUME_EINVAL,
                          "%s: raw samples do not say how many they are; give --size XxYxZ, and "
                          "--type where they are not u8",
                          path);
    s->type = sample_type_find(type ? type : "u8", &s->big);
    if (!status && p->skip)
        status = unpack_skip(from, p->skip, "more");
    if (!status)
        status = volume_take(s, from, size, true, p);
    unpack_close(&from);
    return status;
}
