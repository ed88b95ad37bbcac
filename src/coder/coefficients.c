#include "coder/coefficients.h"

#include "base/log.h"
#include "base/memory.h"
#include "base/outfile.h"

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
    free(c->scale);
    free(c->offset);
    free(c->band);
    free(c);
}

relume_status coefficients_create(relume_coefficients **out, const relume_coder *coder,
                                  const relume_capture *capture,
                                  const struct relume_encode_params *p)
{
    const size_t planes = (size_t)relume_coder_info(coder)->planes;
    relume_coefficients *c = *out = mem_zeroed(1, sizeof *c);
    if (!c)
        return RELUME_ENOMEM;
    const int height = relume_capture_height(capture);
    c->bands = (height + BAND_ROWS - 1) / BAND_ROWS;
    c->scale = mem_zeroed(planes, sizeof *c->scale);
    c->offset = mem_zeroed(planes, sizeof *c->offset);
    c->band = mem_zeroed((size_t)c->bands * planes, sizeof *c->band);
    c->fd = scratch_open(p->scratch);
    c->info = (struct relume_coefficients_info){
        .coder = coder,
        .width = relume_capture_width(capture),
        .height = height,
        .planes = relume_coder_info(coder)->planes,
        .storage = p->storage ? p->storage : RELUME_STORE_8,
        .scale = c->scale,
        .offset = c->offset,
    };
    if (c->fd < 0 && errno == ENOMEM)
        return RELUME_ENOMEM;
    if (c->fd < 0)
        return log_fail(p->log, RELUME_EIO, "%s: no temporary file can be made in its folder; %s",
                        p->scratch ? p->scratch : "$TMPDIR", strerror(errno));
    return c->scale && c->offset && c->band ? RELUME_OK : RELUME_ENOMEM;
}

// Eight running extremes side by side: compilers keep them in vector registers.
struct range range_of(const float *v, size_t n)
{
    enum { LANES = 8 };
    float min[LANES], max[LANES];
    for (int i = 0; i < LANES; i++) {
        min[i] = FLT_MAX;
        max[i] = -FLT_MAX;
    }
    for (size_t x = 0; x < n; x++) {
        const float f = v[x];
        const size_t i = x % LANES;
        min[i] = f < min[i] ? f : min[i];
        max[i] = f > max[i] ? f : max[i];
    }
    struct range r = {FLT_MAX, -FLT_MAX};
    for (int i = 0; i < LANES; i++) {
        r.min = min[i] < r.min ? min[i] : r.min;
        r.max = max[i] > r.max ? max[i] : r.max;
    }
    if (r.max - r.min < TINY_RANGE)
        r.min = r.max = fabsf(r.max) < TINY_RANGE ? 0.0f : r.max;
    return r;
}

off_t coefficients_offset(const relume_coefficients *c, int row)
{
    return (off_t)row * c->info.planes * c->info.width * (off_t)sizeof(uint16_t);
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
    const int steps = holds_zero(r) ? top - 1 : top;  // room for moving the range
    return r.max - r.min > TINY_RANGE ? (r.max - r.min) / (float)steps : 0.0f;
}

void coefficients_choose_steps(relume_coefficients *c, const struct range *total, bool masked,
                               enum relume_step step)
{
    const struct relume_coder_info *coder = relume_coder_info(c->info.coder);
    const int top = relume_storage_top(c->info.storage);
    float common = 0.0f;
    for (int p = 0; p < c->info.planes; p++) {
        const bool colour = coder->luminance && p >= coder->coefficients;
        c->scale[p] = top ? least_step(whole_range(total[p], masked), top) : 1.0f;
        common = !colour && c->scale[p] > common ? c->scale[p] : common;
    }
    for (int p = 0; p < c->info.planes; p++) {
        const struct range r = whole_range(total[p], masked);
        const bool colour = coder->luminance && p >= coder->coefficients;
        if (step == RELUME_STEP_COMMON && !colour)
            c->scale[p] = common;
        c->scale[p] = c->scale[p] > 0.0f ? c->scale[p] : 1.0f;
        c->offset[p] = !top            ? 0.0f
                       : holds_zero(r) ? -ceilf(-r.min / c->scale[p]) * c->scale[p]
                                       : r.min;
    }
}

float coefficients_band_step(struct range r)
{
    return r.max > r.min ? (r.max - r.min) / 65535.0f : 0.0f;
}

static inline float clamp(float v, float top)
{
    return v < 0.0f ? 0.0f : v > top ? top : v;
}

void coefficients_quantise(const relume_coefficients *c, int plane, int row, const uint16_t *from,
                           void *to)
{
    const struct range r = c->band[(row / BAND_ROWS) * c->info.planes + plane];
    const float a = coefficients_band_step(r) / c->scale[plane];
    const float b = (r.min - c->offset[plane]) / c->scale[plane] + 0.5f;
    uint8_t *bytes = to;
    uint16_t *words = to;
    const float top = (float)relume_storage_top(c->info.storage);
    if (c->info.storage == RELUME_STORE_8)
        for (int x = 0; x < c->info.width; x++)
            bytes[x] = (uint8_t)(int)clamp((float)from[x] * a + b, 255.0f);
    else
        for (int x = 0; x < c->info.width; x++)
            words[x] = (uint16_t)(int)clamp((float)from[x] * a + b, top);
}

relume_status relume_coefficients_read(const relume_coefficients *coefficients, int row, int rows,
                                       void *out)
{
    const relume_coefficients *c = coefficients;
    const size_t width = (size_t)c->info.width, planes = (size_t)c->info.planes;
    const size_t n = (size_t)rows * planes * width;
    if (c->info.storage == RELUME_STORE_HALF)
        return scratch_read(c->fd, out, n * 2, coefficients_offset(c, row)) ? RELUME_OK
                                                                            : RELUME_EIO;
    uint16_t *packed = mem_array(n, sizeof *packed);
    if (!packed)
        return RELUME_ENOMEM;
    const bool good = scratch_read(c->fd, packed, n * sizeof *packed, coefficients_offset(c, row));
    const size_t bytes = c->info.storage == RELUME_STORE_8 ? 1 : 2;
    for (size_t i = 0; good && i < (size_t)rows * planes; i++)
        coefficients_quantise(c, (int)(i % planes), row + (int)(i / planes), packed + i * width,
                              (uint8_t *)out + i * width * bytes);
    free(packed);
    return good ? RELUME_OK : RELUME_EIO;
}

struct relume_encode_report relume_coefficients_report(const relume_coefficients *coefficients)
{
    return coefficients->report;
}

const struct relume_coefficients_info *relume_coefficients_info(
    const relume_coefficients *coefficients)
{
    return &coefficients->info;
}
