// coefficients.c - coefficient planes that wait in a scratch file until their ranges are known
#include "format/coder/coefficients.h"

#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/scratch.h"
#include "core/kernel/kernels.h"
#include "format/coder/codes.h"
#include "format/coder/coding.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

void relume_coefficients_destroy(relume_coefficients **coefficients)
{
    relume_coefficients *c = *coefficients;
    *coefficients = NULL;
    if (!c)
        return;
    if (c->fd >= 0)
        close(c->fd);
    mem_free(c->scale);
    mem_free(c->offset);
    mem_free(c->most);
    mem_free(c->band);
    mem_free(c->some.error);
    mem_free(c->some.shown_error);
    mem_free(c->some.lit);
    mem_free(c->some.stored);
    mem_free(c);
}

relume_status coefficients_create(relume_coefficients **out, const relume_coder *coder, int width,
                                  int height, const struct relume_project_params *p)
{
    const size_t planes = (size_t)relume_coder_info(coder)->planes;
    relume_coefficients *c = *out = mem_zeroed(1, sizeof *c);
    if (!c)
        return RELUME_ENOMEM;
    c->bands = (height + BAND_ROWS - 1) / BAND_ROWS;
    c->scale = mem_zeroed(planes, sizeof *c->scale);
    c->offset = mem_zeroed(planes, sizeof *c->offset);
    c->most = mem_zeroed(planes, sizeof *c->most);
    c->band = mem_zeroed((size_t)c->bands * planes, sizeof *c->band);
    c->fd = scratch_open(p->scratch);
    c->coarse = p->storage == RELUME_STORE_LOG;
    c->info = (struct relume_coefficients_info){
        .coder = coder,
        .width = width,
        .height = height,
        .planes = relume_coder_info(coder)->planes,
        .storage = p->storage == RELUME_STORE_LOG ? RELUME_STORE_HALF
                   : p->storage                   ? p->storage
                                                  : RELUME_STORE_8,
        .scale = c->scale,
        .offset = c->offset,
    };
    if (c->fd < 0 && errno == ENOMEM)
        return RELUME_ENOMEM;
    if (c->fd < 0)
        return log_fail(p->log, RELUME_EIO, "%s: no temporary file can be made in its folder; %s",
                        p->scratch ? p->scratch : "$TMPDIR", strerror(errno));
    return c->scale && c->offset && c->most && c->band ? RELUME_OK : RELUME_ENOMEM;
}

struct range range_join(struct range a, struct range b)
{
    return (struct range){b.min < a.min ? b.min : a.min, b.max > a.max ? b.max : a.max};
}

// No values yet.
static const struct range no_range = {FLT_MAX, -FLT_MAX};

// Of two zeros either may come first: the one without a sign is kept.
struct range range_of(const float *v, size_t n)
{
    struct range r = no_range;
    kernels_choose(0)->unpack->range(v, n, &r.min, &r.max);
    return (struct range){r.min + 0.0f, r.max + 0.0f};
}

struct range range_settle(struct range r)
{
    if (r.max - r.min < TINY_RANGE)
        r.min = r.max = fabsf(r.max) < TINY_RANGE ? 0.0f : r.max;
    return r;
}

off_t coefficients_offset(const relume_coefficients *c, int row)
{
    return (off_t)row * c->info.planes * c->info.width * (off_t)coefficients_waiting(c);
}

size_t coefficients_waiting(const relume_coefficients *c)
{
    return c->info.storage == RELUME_STORE_FLOAT ? sizeof(float) : sizeof(uint16_t);
}

float coefficients_half_scale(struct range r)
{
    const float most = fmaxf(fabsf(r.min), fabsf(r.max));
    float scale = 1.0f;
    while (most / scale > 65504.0f && r.min <= r.max)
        scale *= 2.0f;
    return scale;
}

// What a plane's codes must span. A mask makes it hold 0.
static struct range whole_range(struct range r, bool masked)
{
    if (!(r.min <= r.max))
        return (struct range){0.0f, 0.0f};  // everything is masked
    if (masked) {
        r.min = r.min < 0.0f ? r.min : 0.0f;
        r.max = r.max > 0.0f ? r.max : 0.0f;
    }
    return r;
}

// Where the range holds 0, 0 is a code of its own, so that black stays black whatever is added up.
static bool holds_zero(struct range r)
{
    return r.min <= 0.0f && r.max >= 0.0f;
}

// The smallest step with which codes 0..top span the range.
static float least_step(struct range r, int top)
{
    const int steps = holds_zero(r) ? top - 1 : top;  // one code left to move the range
    return r.max - r.min > TINY_RANGE ? (r.max - r.min) / (float)steps : 0.0f;
}

// 8 bits reach from the finest quantiser to the coarsest one for that many.
enum { MOST_HALVINGS = 3 };

void coefficients_choose_steps(relume_coefficients *c, const struct range *total, bool masked,
                               enum relume_step step)
{
    const struct relume_coder_info *coder = relume_coder_info(c->info.coder);
    const int top = relume_storage_top(c->info.storage);
    float common = 0.0f;
    for (int p = 0; p < c->info.planes; p++) {
        const bool colour = coder->luminance && p >= coder->coefficients;
        const struct range r = whole_range(total[p], masked);
        c->scale[p] = top                                     ? least_step(r, top)
                      : c->info.storage == RELUME_STORE_FLOAT ? 1.0f
                                                              : coefficients_half_scale(r);
        common = top && !colour && c->scale[p] > common ? c->scale[p] : common;
    }
    for (int p = 0; p < c->info.planes; p++) {
        const struct range r = whole_range(total[p], masked);
        const bool colour = coder->luminance && p >= coder->coefficients;
        if (step >= RELUME_STEP_COMMON && top && !colour) {
            const float least = c->scale[p];
            c->scale[p] = common;
            for (int i = 0; step == RELUME_STEP_HALVED && i < MOST_HALVINGS; i++)
                c->scale[p] *= least > 0.0f && least <= 0.5f * c->scale[p] ? 0.5f : 1.0f;
        }
        c->scale[p] = c->scale[p] > 0.0f ? c->scale[p] : 1.0f;
        if (c->most)
            c->most[p] = fmaxf(fabsf(r.min), fabsf(r.max));
        c->offset[p] = !top            ? 0.0f
                       : holds_zero(r) ? -ceilf(-r.min / c->scale[p]) * c->scale[p]
                                       : r.min;
    }
}

relume_status coefficients_share_steps(relume_coefficients *const *c, int count, bool masked,
                                       enum relume_step step)
{
    const size_t planes = (size_t)c[0]->info.planes;
    struct range *total = mem_array(planes, sizeof *total);
    if (!total)
        return RELUME_ENOMEM;
    for (size_t p = 0; p < planes; p++)
        total[p] = no_range;
    for (int i = 0; i < count; i++)
        for (size_t b = 0; b < (size_t)c[i]->bands * planes; b++)
            total[b % planes] = range_join(total[b % planes], c[i]->band[b]);
    for (int i = 0; i < count; i++)
        coefficients_choose_steps(c[i], total, masked, step);
    mem_free(total);
    return RELUME_OK;
}

float coefficients_band_step(struct range r)
{
    return r.max > r.min ? (r.max - r.min) / 65535.0f : 0.0f;
}

static inline float clamp(float v, float top)
{
    return v > 0.0f ? v < top ? v : top : 0.0f;
}

// Halves over one power of two become halves over another.
static void rescale_halves(const uint16_t *from, size_t n, float factor, uint16_t *to)
{
    if (factor == 1.0f)
        memcpy(to, from, n * sizeof *to);
    else
        for (size_t x = 0; x < n; x++)
            to[x] = half_from_float(float_from_half(from[x]) * factor);
}

static struct range band_of(const relume_coefficients *c, int plane, int row)
{
    return c->band[(size_t)(row / BAND_ROWS) * (size_t)c->info.planes + (size_t)plane];
}

void coefficients_wait(const relume_coefficients *c, int plane, int row, const float *values,
                       size_t n, void *to)
{
    const struct range r = band_of(c, plane, row);
    const float scale = r.max > r.min ? 65535.0f / (r.max - r.min) : 0.0f;
    const float over = coefficients_half_scale(r);
    uint16_t *words = to;
    if (c->info.storage == RELUME_STORE_FLOAT)
        memcpy(to, values, n * sizeof *values);
    else if (c->info.storage != RELUME_STORE_HALF)
        kernels_choose(0)->unpack->words(values, n, r.min, scale, words);
    else if (c->coarse)
        for (size_t x = 0; x < n; x++)
            words[x] = half_coarse(values[x] / over);
    else
        for (size_t x = 0; x < n; x++)
            words[x] = half_from_float(values[x] / over);
}

void coefficients_quantise(const relume_coefficients *c, int plane, int row, const void *from,
                           size_t n, void *to)
{
    const struct range r = band_of(c, plane, row);
    const float a = coefficients_band_step(r) / c->scale[plane];
    const float b = (r.min - c->offset[plane]) / c->scale[plane] + 0.5f;
    const uint16_t *waiting = from;
    uint16_t *words = to;
    const float top = (float)relume_storage_top(c->info.storage);
    if (c->info.storage == RELUME_STORE_FLOAT)
        memcpy(to, from, n * sizeof(float));
    else if (c->info.storage == RELUME_STORE_HALF)
        rescale_halves(from, n, coefficients_half_scale(r) / c->scale[plane], to);
    else if (c->info.storage == RELUME_STORE_8)
        kernels_choose(0)->unpack->codes(from, n, a, b, to);
    else
        for (size_t x = 0; x < n; x++)
            words[x] = (uint16_t)(int)clamp((float)waiting[x] * a + b, top);
}

void coefficients_restore(const relume_coefficients *c, int plane, int row, const float *values,
                          size_t n, float *out)
{
    enum { RUN = 1024 };
    float waiting[RUN], codes[RUN];  // of any kind
    for (size_t at = 0, count; at < n; at += count) {
        count = n - at < RUN ? n - at : RUN;
        coefficients_wait(c, plane, row, values + at, count, waiting);
        coefficients_quantise(c, plane, row, waiting, count, codes);
        codes_restore(out + at, c->info.storage, codes, 0, count, c->scale[plane],
                      c->offset[plane]);
    }
}

static void values_of(const relume_coefficients *c, struct range r, const uint16_t *waiting,
                      float *out)
{
    const float step = coefficients_band_step(r), scale = coefficients_half_scale(r);
    const size_t width = (size_t)c->info.width;
    if (c->info.storage == RELUME_STORE_HALF)
        for (size_t x = 0; x < width; x++)
            out[x] = float_from_half(waiting[x]) * scale;
    else
        for (size_t x = 0; x < width; x++)
            out[x] = r.min + step * (float)waiting[x];
}

relume_status coefficients_values(const relume_coefficients *c, int row, void *waiting, float *out)
{
    const size_t width = (size_t)c->info.width, planes = (size_t)c->info.planes;
    const bool whole = c->info.storage == RELUME_STORE_FLOAT;
    if (!scratch_read(c->fd, whole ? (void *)out : waiting,
                      planes * width * coefficients_waiting(c), coefficients_offset(c, row)))
        return RELUME_EIO;
    for (size_t p = 0; !whole && p < planes; p++)
        values_of(c, c->band[(size_t)(row / BAND_ROWS) * planes + p],
                  (const uint16_t *)waiting + p * width, out + p * width);
    return RELUME_OK;
}

relume_status relume_coefficients_read(const relume_coefficients *coefficients, int row, int rows,
                                       void *out)
{
    const relume_coefficients *c = coefficients;
    const size_t width = (size_t)c->info.width, planes = (size_t)c->info.planes;
    const size_t n = planes * width, wait = coefficients_waiting(c);
    char *packed = mem_array(n, wait);  // a row stays in the cache
    if (!packed)
        return RELUME_ENOMEM;
    const size_t bytes = relume_storage_bytes(c->info.storage);
    char *to = out;
    bool good = true;
    for (int y = row; good && y < row + rows; y++) {
        good = scratch_read(c->fd, packed, n * wait, coefficients_offset(c, y));
        for (size_t p = 0; good && p < planes; p++, to += width * bytes)
            coefficients_quantise(c, (int)p, y, packed + p * width * wait, width, to);
    }
    mem_free(packed);
    return good ? RELUME_OK : RELUME_EIO;
}

// Codes wait as numbers whose bands have the codes' own step: quantising gives them back. Floats
// wait as they are.
static struct range band_of_codes(const struct relume_codes *codes, int plane)
{
    const float scale = codes->scale[plane], offset = codes->offset[plane];
    return relume_storage_top(codes->storage)
               ? (struct range){offset, (float)((double)offset + 65535.0 * (double)scale)}
               : (struct range){0.0f, 65504.0f * scale};
}

static relume_status keep_row(relume_coefficients *c, const struct relume_codes *codes, int row,
                              void *buffer)
{
    const size_t width = (size_t)codes->width, first = (size_t)row * width;
    const size_t bytes = relume_storage_bytes(codes->storage), wait = coefficients_waiting(c);
    for (int p = 0; p < codes->planes; p++) {
        const char *from = (const char *)codes->plane[p] + first * bytes;
        char *to = (char *)buffer + (size_t)p * width * wait;
        if (bytes == wait)
            memcpy(to, from, width * wait);
        else
            for (size_t x = 0; x < width; x++)
                ((uint16_t *)(void *)to)[x] = (uint8_t)from[x];
        c->band[row / BAND_ROWS * codes->planes + p] = band_of_codes(codes, p);
    }
    return scratch_write(c->fd, buffer, width * (size_t)codes->planes * wait,
                         coefficients_offset(c, row))
               ? RELUME_OK
               : RELUME_EIO;
}

relume_status relume_coefficients_keep(relume_coefficients **out, const struct relume_codes *codes,
                                       const struct relume_project_params *params)
{
    struct relume_project_params p = PARAMS_WORK(relume_project_params, params);
    p.storage = codes->storage;
    void *buffer = mem_array((size_t)codes->width * (size_t)codes->planes, sizeof(float));
    relume_status status = coefficients_create(out, codes->coder, codes->width, codes->height, &p);
    if (!status && !buffer)
        status = RELUME_ENOMEM;
    for (int i = 0; !status && i < codes->planes; i++) {
        (*out)->scale[i] = codes->scale[i];
        (*out)->offset[i] = codes->offset[i];
    }
    for (int row = 0; !status && row < codes->height; row++)
        status = keep_row(*out, codes, row, buffer);
    if (status == RELUME_EIO)
        status = log_fail(p.log, RELUME_EIO, "%s: no room for temporary data; %s",
                          p.scratch ? p.scratch : "$TMPDIR", strerror(errno));
    mem_free(buffer);
    if (status)
        relume_coefficients_destroy(out);
    return status;
}

// A band of rows: values[planes][rows][x], as many numbers that wait.
static relume_status take_band(relume_coefficients *c, const struct relume_codes *codes, int row,
                               float *values, char *waiting)
{
    const int rows = c->info.height - row < BAND_ROWS ? c->info.height - row : BAND_ROWS;
    const size_t width = (size_t)c->info.width, n = width * (size_t)rows;
    const size_t planes = (size_t)c->info.planes, wait = coefficients_waiting(c);
    for (size_t p = 0; p < planes; p++) {
        relume_codes_plane(codes, (int)p, (size_t)row * width, n, values);
        c->band[(size_t)(row / BAND_ROWS) * planes + p] = range_settle(range_of(values, n));
        for (size_t y = 0; y < (size_t)rows; y++)
            coefficients_wait(c, (int)p, row, values + y * width, width,
                              waiting + (y * planes + p) * width * wait);
    }
    return scratch_write(c->fd, waiting, planes * n * wait, coefficients_offset(c, row))
               ? RELUME_OK
               : RELUME_EIO;
}

relume_status coefficients_take(relume_coefficients **out, const relume_coder *coder,
                                const struct relume_codes *codes,
                                const struct relume_project_params *p)
{
    const size_t n = (size_t)BAND_ROWS * (size_t)codes->width;
    const size_t planes = (size_t)relume_coder_info(coder)->planes;
    float *values = mem_array(n, sizeof *values);
    char *waiting = mem_array(planes * n, sizeof(float));
    relume_status status = coefficients_create(out, coder, codes->width, codes->height, p);
    if (!status && (!values || !waiting))
        status = RELUME_ENOMEM;
    for (int row = 0; !status && row < codes->height; row += BAND_ROWS)
        status = take_band(*out, codes, row, values, waiting);
    if (status == RELUME_EIO)
        status = log_fail(p->log, RELUME_EIO, "%s: no room for temporary data; %s",
                          p->scratch ? p->scratch : "$TMPDIR", strerror(errno));
    mem_free(values);
    mem_free(waiting);
    if (status)
        relume_coefficients_destroy(out);
    return status;
}

struct relume_fidelity relume_coefficients_report(const relume_coefficients *coefficients)
{
    return coefficients->report;
}

const struct relume_coefficients_info *relume_coefficients_info(
    const relume_coefficients *coefficients)
{
    return &coefficients->info;
}
