// drawing.c - drawings and masks: as files keep them, and laid on a sample
#include "material/gbrdf/drawing.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/base64.h"
#include "core/math/bilinear.h"
#include "core/math/scalar.h"
#include "material/gbrdf/edit_table.h"

#include <string.h>

static size_t pixels_of(const struct relume_image *image)
{
    return (size_t)image->width * (size_t)image->height;
}

static int level_of(float value)
{
    return (int)lrintf(255.0f * fminf(fmaxf(value, 0.0f), 1.0f));
}

relume_status drawing_keep(struct relume_image *out, const struct relume_image *picture)
{
    *out = (struct relume_image){.width = 0};
    if (!picture->data)
        return RELUME_OK;
    const double most = larger_of(picture->width, picture->height);
    const double scale = fmin(RELUME_EDIT_MOST_SIDE / most, 1.0);
    const relume_status status =
        relume_image_scale(out, picture, larger_of((int)lrint(scale * picture->width), 1),
                           larger_of((int)lrint(scale * picture->height), 1), NULL);
    for (size_t i = 0; !status && i < pixels_of(out); i++)
        out->data[i] = (float)level_of(out->data[i]) / 255.0f;
    return status;
}

// ---------------------------------------------------------------- as text

// How many bytes from `at` on are alike, up to 128.
static size_t run_length(const uint8_t *byte, size_t at, size_t n)
{
    size_t run = 1;
    while (run < 128 && at + run < n && byte[at + run] == byte[at])
        run++;
    return run;
}

// PackBits: a count n < 128 and n + 1 bytes, or n > 128 and one byte that comes 257 - n times.
// `out` holds 2 n bytes.
static size_t pack(uint8_t *out, const uint8_t *byte, size_t n)
{
    size_t size = 0;
    for (size_t at = 0; at < n;) {
        size_t run = run_length(byte, at, n), own = 0;
        if (run > 1) {
            out[size++] = (uint8_t)(257 - run);
            out[size++] = byte[at];
            at += run;
            continue;
        }
        while (own < 128 && at + own < n && run_length(byte, at + own, n) < 3)
            own++;
        out[size++] = (uint8_t)(own - 1);
        memcpy(out + size, byte + at, own);
        size += own;
        at += own;
    }
    return size;
}

static bool unpack(uint8_t *out, size_t n, const uint8_t *packed, size_t size)
{
    size_t at = 0;
    for (size_t i = 0; i < size;) {
        const int count = packed[i++];
        const size_t own = count < 128 ? (size_t)count + 1 : 1;
        const size_t times = count < 128 ? 1 : (size_t)(257 - count);
        if (count == 128 || own > size - i || own * times > n - at)
            return false;
        if (times > 1)
            memset(out + at, packed[i], times);
        else
            memcpy(out + at, packed + i, own);
        at += own * times;
        i += own;
    }
    return at == n;
}

static char *text_of(const uint8_t *bytes, size_t n)
{
    char *text = mem_zeroed(base64_length(n) + 1, 1);
    if (text)
        base64_text(text, bytes, n);
    return text;
}

char *drawing_text(const struct relume_image *picture)
{
    const size_t n = pixels_of(picture);
    uint8_t *level = mem_array(n, 1), *packed = mem_array(n, 2);
    char *text = NULL;
    for (size_t i = 0; level && i < n; i++)
        level[i] = (uint8_t)level_of(picture->data[i]);
    if (level && packed)
        text = text_of(packed, pack(packed, level, n));
    mem_free(level);
    mem_free(packed);
    return text;
}

bool drawing_from_text(struct relume_image *out, int width, int height, const char *text,
                       relume_status *status)
{
    *status = relume_image_create(out, width, height, 1);
    if (*status)
        return true;
    const size_t n = pixels_of(out);
    uint8_t *packed = mem_array(strlen(text) + 1, 1), *level = mem_array(n, 1);
    bool good = true;
    if (packed && level) {
        const ptrdiff_t size = base64_bytes(packed, text);
        good = size >= 0 && unpack(level, n, packed, (size_t)size);
        for (size_t i = 0; good && i < n; i++)
            out->data[i] = (float)level[i] / 255.0f;
    } else
        *status = RELUME_ENOMEM;
    mem_free(packed);
    mem_free(level);
    if (!good || *status)
        relume_image_destroy(out);
    return good;
}

// ---------------------------------------------------------------- on a sample

relume_status drawing_lay(struct relume_image *out, const struct relume_edit *edit, int width,
                          int height, bool wraps, const struct relume_log *log)
{
    const struct relume_image *d = &edit->drawing;
    const int w = larger_of((int)lrint(edit->size * width), 1);
    const double high = fmax(rint((double)w * d->height / d->width), 1.0);
    struct relume_image scaled = {.width = 0};
    *out = scaled;
    if (high > height)
        return log_fail(log, RELUME_EUNFIT,
                        "the drawing is %.0f texels high at this size; expected at most %d: make "
                        "its size smaller",
                        high, height);
    const int h = (int)high;
    const int left = (int)lrint(edit->at[0] * width - 0.5 * w),
              top = (int)lrint(edit->at[1] * height - 0.5 * h);
    relume_status status = relume_image_create(out, width, height, 1);
    if (!status)
        status = relume_image_scale(&scaled, d, w, h, NULL);
    for (int y = 0; !status && y < h; y++)
        for (int x = 0; x < w; x++) {
            const int i = index_wrapped(left + x, width), j = index_wrapped(top + y, height);
            if (wraps || (i == left + x && j == top + y))
                out->data[(size_t)j * (size_t)width + (size_t)i] =
                    scaled.data[(size_t)y * (size_t)w + (size_t)x];
        }
    relume_image_destroy(&scaled);
    if (status)
        relume_image_destroy(out);
    return status;
}

relume_status mask_lay(struct relume_image *out, const struct relume_edit *edit, int width,
                       int height)
{
    if (edit->mask.data)
        return relume_image_scale(out, &edit->mask, width, height, NULL);
    const relume_status status = relume_image_create(out, width, height, 1);
    for (size_t i = 0; !status && i < pixels_of(out); i++)
        out->data[i] = 1.0f;
    return status;
}
