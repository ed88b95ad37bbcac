// open.c - volumes from files: which format a file is, and its samples
#include "shape/volume/readers.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

void volume_set_spacing(struct store *s, const double spacing[3],
                        const struct relume_volume_params *p)
{
    for (int c = 0; c < 3 && p->own_spacing; c++)
        if (spacing[c] > 1e-9 && spacing[c] < 1e9)
            s->volume->spacing[c] = spacing[c];
}

// ---------------------------------------------------------------- samples

static relume_status check_exact(const struct store *s, unpack *from, const int64_t size[3],
                                 uint64_t bytes)
{
    uint64_t left;
    if (unpack_left(from, &left))
        return left == bytes
                   ? RELUME_OK
                   : log_fail(s->log, RELUME_EUNFIT,
                              "%s: %llu bytes of samples; expected %llu for %d x %d x "
                              "%d of %s (--size, --type)",
                              s->path, (unsigned long long)left, (unsigned long long)bytes,
                              (int)size[0], (int)size[1], (int)size[2], s->type->name);
    return RELUME_OK;
}

// In pieces of rows: layers may be larger than the memory that there is.
static relume_status take_rows(struct store *s, unpack *from, const char *expected, bool exact)
{
    enum { PIECE = 1 << 22 };
    const size_t row = (size_t)s->volume->size[0] * (size_t)s->type->bytes;
    const size_t rows = (size_t)s->volume->size[1] * (size_t)s->volume->size[2];
    const size_t most = row < PIECE ? PIECE / row : 1, piece = most < rows ? most : rows;
    void *bytes = mem_array(piece, row);
    relume_status status = bytes ? RELUME_OK : RELUME_ENOMEM;
    char more;
    size_t got = 0;
    for (size_t y = 0, n; y < rows && !status; y += n) {
        n = rows - y < piece ? rows - y : piece;
        status = unpack_all(from, bytes, n * row, expected);
        if (!status)
            status = store_put(s, bytes, n * (size_t)s->volume->size[0]);
        if (!status && !log_progress(s->log, "reading", (double)(y + n) / (double)rows))
            status = RELUME_ECANCEL;
    }
    mem_free(bytes);
    if (!status && exact)
        status = unpack_read(from, &more, 1, &got);
    if (!status && exact && got)
        status = log_fail(s->log, RELUME_EUNFIT, "%s: has more bytes than %s (--size, --type)",
                          s->path, expected);
    return status;
}

relume_status volume_take(struct store *s, unpack *from, const int64_t size[3], bool exact,
                          const struct relume_volume_params *p)
{
    char expected[128];
    relume_status status = store_check(s, size);
    if (status)
        return status;
    const uint64_t bytes =
        (uint64_t)size[0] * (uint64_t)size[1] * (uint64_t)size[2] * (uint64_t)s->type->bytes;
    snprintf(expected, sizeof expected, "%llu, for %d x %d x %d samples of %s",
             (unsigned long long)bytes, (int)size[0], (int)size[1], (int)size[2], s->type->name);
    if (exact)
        status = check_exact(s, from, size, bytes);
    if (!status)
        status = unpack_expect(from, bytes, expected);  // before there is memory for them
    if (!status)
        status = store_begin(s, size, p);
    return status ? status : take_rows(s, from, expected, exact);
}

// ---------------------------------------------------------------- formats

static const struct format {
    const char *name;
    relume_status (*read)(struct store *s, const char *path,
                          const struct relume_volume_params *params);
} raw = {"raw", volume_read_raw}, nrrd = {"nrrd", volume_read_nrrd},
  nifti = {"nifti", volume_read_nifti}, slices = {"slices", volume_read_slices},
  pages = {"slices", volume_read_pages};

// Magic numbers of NIfTI-1 stand at the end of its header of 348 bytes.
enum { NIFTI_BYTES = 352, NIFTI_MAGIC = 344 };

// With places of 32 or 64 bits.
static bool is_tiff(const char *head)
{
    return !memcmp(head, "II*", 4) || !memcmp(head, "MM\0*", 4) || !memcmp(head, "II+", 4) ||
           !memcmp(head, "MM\0+", 4);
}

static relume_status find(const struct format **out, const char *path,
                          const struct relume_volume_params *p)
{
    char head[NIFTI_BYTES] = {0};
    size_t got = 0;
    unpack *from;
    *out = &raw;
    if (input_kind(path, p->log) == INPUT_FOLDER) {
        *out = &slices;
        return RELUME_OK;
    }
    relume_status status = unpack_open(&from, path, 0, NULL, p->log);
    if (status)
        return status;
    status = unpack_read(from, head, sizeof head, &got);
    unpack_close(&from);
    if (status)
        return status;
    if (!memcmp(head, "NRRD000", 7))
        *out = &nrrd;
    else if (is_tiff(head))
        *out = &pages;
    else if (!memcmp(head + NIFTI_MAGIC, "n+1", 4) || !memcmp(head + NIFTI_MAGIC, "ni1", 4))
        *out = &nifti;
    return RELUME_OK;
}

static relume_status check_spacing(const struct relume_volume_params *p)
{
    const double *s = p->spacing;
    const bool none = s[0] == 0.0 && s[1] == 0.0 && s[2] == 0.0;
    for (int c = 0; c < 3; c++)
        if (!none && !(s[c] > 1e-9 && s[c] < 1e9))
            return log_fail(p->log, RELUME_EINVAL,
                            "a spacing of %g,%g,%g; expected three numbers from 1e-9 to 1e9", s[0],
                            s[1], s[2]);
    return RELUME_OK;
}

relume_status relume_volume_open(relume_volume **out, const char *path,
                                 const struct relume_volume_params *params)
{
    const struct relume_volume_params p = PARAMS(relume_volume_params, params);
    struct store s = {.slope = 1.0, .path = path, .log = p.log};
    const struct format *format = &raw;
    relume_status status = check_spacing(&p);
    *out = NULL;
    if (!status)
        status = find(&format, path, &p);
    if (!status)
        status = format->read(&s, path, &p);
    if (!status)
        status = store_end(&s);
    if (status) {
        relume_volume_destroy(&s.volume);
        return status;
    }
    s.volume->format = format->name;
    *out = s.volume;
    return RELUME_OK;
}
