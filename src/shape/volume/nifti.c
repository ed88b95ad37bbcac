// nifti.c - NIfTI-1 (Cox et al. 2004): a header of 348 bytes, and samples behind it or beside it
#include "shape/volume/readers.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"

#include <math.h>
#include <string.h>
#include <strings.h>

// Where fields stand in the header.
enum {
    HEADER_BYTES = 348,
    AT_DIM = 40,
    AT_DATATYPE = 70,
    AT_PIXDIM = 76,
    AT_VOX_OFFSET = 108,
    AT_SLOPE = 112,
    AT_INTERCEPT = 116,
    AT_MAGIC = 344,
};

struct header {
    uint8_t bytes[HEADER_BYTES];
    bool big;
};

static int16_t short_at(const struct header *h, int at)
{
    const uint8_t *b = h->bytes + at;
    return (int16_t)(h->big ? b[0] << 8 | b[1] : b[1] << 8 | b[0]);
}

static float float_at(const struct header *h, int at)
{
    uint32_t bits = 0;
    float value;
    for (int i = 0; i < 4; i++)
        bits |= (uint32_t)h->bytes[at + i] << 8 * (h->big ? 3 - i : i);
    memcpy(&value, &bits, sizeof value);
    return value;
}

static const struct sample_type *type_of(const struct header *h)
{
    static const struct {
        int code;
        const char *type;
    } table[] = {{2, "u8"},   {4, "i16"},  {8, "i32"},   {16, "f32"},
                 {64, "f64"}, {256, "i8"}, {512, "u16"}, {768, "u32"}};
    bool big;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (short_at(h, AT_DATATYPE) == table[i].code)
            return sample_type_find(table[i].type, &big);
    return NULL;
}

static relume_status understand(struct store *s, struct header *h, int64_t size[3],
                                double spacing[3])
{
    h->big = h->bytes[0] == 0 && h->bytes[1] == 0;  // 348 begins with its low byte, or two zeros
    const int dimensions = short_at(h, AT_DIM);
    s->type = type_of(h);
    s->big = h->big;
    if (!s->type)
        return log_fail(s->log, RELUME_EUNSUPPORTED,
                        "%s: samples of NIfTI's type %d; expected numbers of 8, 16 or 32 bits, or "
                        "floats",
                        s->path, short_at(h, AT_DATATYPE));
    for (int c = 0; c < 3; c++) {
        size[c] = short_at(h, AT_DIM + 2 * (c + 1));
        spacing[c] = fabs((double)float_at(h, AT_PIXDIM + 4 * (c + 1)));
    }
    for (int c = 4; c <= dimensions && c < 8; c++)
        if (short_at(h, AT_DIM + 2 * c) > 1)
            return log_fail(s->log, RELUME_EUNSUPPORTED,
                            "%s: several volumes in one file; expected one", s->path);
    if (dimensions < 3 || dimensions > 7)
        return log_fail(s->log, RELUME_EFORMAT, "%s: %d dimensions; expected 3", s->path,
                        dimensions);
    const double slope = (double)float_at(h, AT_SLOPE);
    const double intercept = (double)float_at(h, AT_INTERCEPT);
    if (isfinite(slope) && isfinite(intercept) && slope != 0.0) {
        s->slope = slope;
        s->intercept = intercept;
    }
    return RELUME_OK;
}

// Samples of a .hdr are in the .img of the same name, or that packed.
static relume_status open_image(unpack **out, const char *path, const struct relume_log *log)
{
    const char *dot = strrchr(path, '.');
    const int length = dot ? (int)(dot - path) : (int)strlen(path);
    char *name = mem_format("%.*s.img", length, path);
    char *packed = mem_format("%.*s.img.gz", length, path);
    relume_status status = name && packed ? RELUME_OK : RELUME_ENOMEM;
    if (!status && input_exists(name, log))
        status = unpack_open(out, name, 0, NULL, log);
    else if (!status && input_exists(packed, log))
        status = unpack_open(out, packed, 0, NULL, log);
    else if (!status)
        status = log_fail(log, RELUME_ENOTFOUND, "%s: a header; its samples, %s, are missing", path,
                          name);
    mem_free(name);
    mem_free(packed);
    return status;
}

relume_status volume_read_nifti(struct store *s, const char *path,
                                const struct relume_volume_params *p)
{
    struct header h = {0};
    int64_t size[3];
    double spacing[3];
    unpack *from;
    relume_status status = unpack_open(&from, path, 0, NULL, p->log);
    if (status)
        return status;
    status = unpack_all(from, h.bytes, sizeof h.bytes, "a header of 348 bytes");
    if (!status)
        status = understand(s, &h, size, spacing);
    const bool pair = !memcmp(h.bytes + AT_MAGIC, "ni1", 4);
    const float offset = float_at(&h, AT_VOX_OFFSET), first = pair ? 0.0f : (float)HEADER_BYTES;
    if (!status && !(offset >= first && offset < 1e9f))
        status = log_fail(p->log, RELUME_EDAMAGED, "%s: samples at byte %g; expected %g", path,
                          (double)offset, pair ? 0.0 : 352.0);
    if (!status && pair) {
        unpack_close(&from);
        status = open_image(&from, path, p->log);
    }
    if (!status)
        status = unpack_skip(from, (uint64_t)(offset - first), "more");
    if (!status)
        status = volume_take(s, from, size, false, p);
    if (!status)
        volume_set_spacing(s, spacing, p);
    unpack_close(&from);
    return status;
}
