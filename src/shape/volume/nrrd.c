// nrrd.c - nearly raw raster data (Kindlmann 1999): a text that says what the samples are
//
// Lines "field: value" end with an empty one; samples follow, or stand in a file that the text
// names. Read are three axes of plain numbers, raw or packed by gzip.
#include "shape/volume/readers.h"

#include "core/base/tree.h"
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { HEADER_MOST = 1 << 16 };

struct nrrd {
    int64_t size[3];
    int dimension, sizes;
    double spacing[3];
    bool packed, big, detached;
    uint64_t skip;
    char file[1024];
    const struct sample_type *type;
};

static relume_status bad(const struct store *s, const char *line, const char *expected)
{
    return log_fail(s->log, RELUME_EUNSUPPORTED, "%s: '%.80s'; expected %s", s->path, line,
                    expected);
}

static const struct sample_type *type_named(const char *name)
{
    static const struct {
        const char *type, *names[8];
    } table[] = {
        {"i8", {"signed char", "int8", "int8_t"}},
        {"u8", {"uchar", "unsigned char", "uint8", "uint8_t"}},
        {"i16", {"short", "short int", "signed short", "signed short int", "int16", "int16_t"}},
        {"u16", {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
        {"i32", {"int", "signed int", "int32", "int32_t"}},
        {"u32", {"uint", "unsigned int", "uint32", "uint32_t"}},
        {"f32", {"float"}},
        {"f64", {"double"}},
    };
    bool big;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        for (const char *const *n = table[i].names; *n; n++)
            if (!strcmp(name, *n))
                return sample_type_find(table[i].type, &big);
    return NULL;
}

static int read_numbers(double out[3], const char *text)
{
    int n = 0;
    char *end;
    for (; n < 3; n++, text = end) {
        out[n] = strtod(text, &end);
        if (end == text)
            break;
    }
    return n;
}

// "(a,b,c) (d,e,f) (g,h,i)": the lengths.
static void read_directions(double spacing[3], const char *text)
{
    for (int i = 0; i < 3; i++) {
        double x, y, z;
        text = strchr(text, '(');
        if (!text || sscanf(text, "(%lf,%lf,%lf)", &x, &y, &z) != 3)
            return;
        spacing[i] = sqrt(x * x + y * y + z * z);
        text++;
    }
}

static relume_status read_sizes(struct nrrd *n, const char *value)
{
    char *end;
    for (n->sizes = 0; n->sizes < 3; n->sizes++, value = end) {
        n->size[n->sizes] = strtoll(value, &end, 10);
        if (end == value)
            break;
    }
    return RELUME_OK;
}

static relume_status read_field(struct store *s, struct nrrd *n, const char *name,
                                const char *value)
{
    if (!strcmp(name, "type")) {
        n->type = type_named(value);
        return n->type ? RELUME_OK : bad(s, value, "samples of 8, 16 or 32 bits, or floats");
    }
    if (!strcmp(name, "dimension")) {
        n->dimension = atoi(value);
        return n->dimension == 3 ? RELUME_OK : bad(s, value, "a dimension of 3");
    }
    if (!strcmp(name, "sizes"))
        return read_sizes(n, value);
    if (!strcmp(name, "spacings"))
        (void)read_numbers(n->spacing, value);
    if (!strcmp(name, "space directions"))
        read_directions(n->spacing, value);
    if (!strcmp(name, "endian"))
        n->big = !strcmp(value, "big");
    if (!strcmp(name, "byte skip") || !strcmp(name, "byteskip"))
        n->skip = value[0] == '-' ? UINT64_MAX : strtoull(value, NULL, 10);
    if ((!strcmp(name, "line skip") || !strcmp(name, "lineskip")) && atoi(value))
        return bad(s, value, "no lines before the samples");
    if (!strcmp(name, "encoding")) {
        n->packed = !strcmp(value, "gzip") || !strcmp(value, "gz");
        return n->packed || !strcmp(value, "raw") ? RELUME_OK
                                                  : bad(s, value, "raw or gzip samples");
    }
    if (!strcmp(name, "data file") || !strcmp(name, "datafile")) {
        if (!strncmp(value, "LIST", 4) || strchr(value, '%') || strlen(value) >= sizeof n->file)
            return bad(s, value, "the samples in one file");
        n->detached = true;
        snprintf(n->file, sizeof n->file, "%s", value);
    }
    return RELUME_OK;
}

// The lines up to an empty one or the end of the text; `*length` is where the samples begin.
static relume_status read_header(struct store *s, struct nrrd *n, char *text, size_t *length)
{
    char *line = text + strcspn(text, "\n"), *end = line;
    relume_status status = RELUME_OK;
    while (*end && !status) {
        line = end + 1;
        end = line + strcspn(line, "\n");
        const bool last = !*end;
        *end = '\0';
        line[strcspn(line, "\r")] = '\0';
        if (!*line || last) {
            *length = (size_t)(end - text) + !last;
            return RELUME_OK;
        }
        char *value = strchr(line, ':');
        if (*line != '#' && value && value[1] != '=') {
            *value++ = '\0';
            for (char *c = line; *c; c++)
                *c = (char)(*c >= 'A' && *c <= 'Z' ? *c + 32 : *c);
            status = read_field(s, n, line, value + strspn(value, " \t"));
        }
        *end = '\n';
    }
    return status ? status
                  : log_fail(s->log, RELUME_EDAMAGED, "%s: its header does not end", s->path);
}

static relume_status load_header(struct store *s, struct nrrd *n, const char *path, size_t *length)
{
    char *text = mem_zeroed(HEADER_MOST + 1, 1);
    unpack *from = NULL;
    const bool packed = false;
    size_t got;
    relume_status status = text ? unpack_open(&from, path, 0, &packed, s->log) : RELUME_ENOMEM;
    if (!status)
        status = unpack_read(from, text, HEADER_MOST, &got);
    if (!status)
        status = read_header(s, n, text, length);
    unpack_close(&from);
    mem_free(text);
    return status;
}

static char *file_of(const struct nrrd *n, const char *path)
{
    return n->detached ? path_beside(path, n->file) : mem_text(path);
}

static relume_status take_file(struct store *s, const struct nrrd *n, const char *file,
                               uint64_t offset, const struct relume_volume_params *p)
{
    unpack *from;
    uint64_t left, bytes = (uint64_t)n->type->bytes;
    for (int c = 0; c < 3; c++)
        bytes *= n->size[c] > 0 && n->size[c] < 1 << 20 ? (uint64_t)n->size[c] : 1;
    relume_status status = unpack_open(&from, file, offset, &n->packed, s->log);
    if (status)
        return status;
    if (n->skip == UINT64_MAX && unpack_left(from, &left) && left > bytes)
        status = unpack_skip(from, left - bytes, "more");  // the samples end the file
    else if (n->skip && n->skip != UINT64_MAX)
        status = unpack_skip(from, n->skip, "more");
    if (!status)
        status = volume_take(s, from, n->size, false, p);
    unpack_close(&from);
    return status;
}

relume_status volume_read_nrrd(struct store *s, const char *path,
                               const struct relume_volume_params *p)
{
    struct nrrd n = {.dimension = 0};
    size_t length = 0;
    relume_status status = load_header(s, &n, path, &length);
    if (!status && (!n.type || n.dimension != 3 || n.sizes != 3))
        status = log_fail(s->log, RELUME_EFORMAT,
                          "%s: lacks the type, the dimension or the sizes of its samples", path);
    char *file = status ? NULL : file_of(&n, path);
    if (!status && !file)
        status = RELUME_ENOMEM;
    s->type = n.type;
    s->big = n.big;
    if (!status)
        status = take_file(s, &n, file, n.detached ? 0 : length, p);
    if (!status)
        volume_set_spacing(s, n.spacing, p);
    mem_free(file);
    return status;
}
