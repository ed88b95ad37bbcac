// sources.c - bright pixels as sources of their own, each drawn as one picture of the pattern
#include "core/math/bilinear.h"
#include "relight/eye/glare.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/luminance.h"

#include <math.h>
#include <string.h>

// ---------------------------------------------------------------- threshold

// Positive floats sort as their bits do: exponent and five bits after it are bins of at most 1/32.
enum { SHIFT = 18, BINS = 1 << (31 - SHIFT) };

static uint32_t bits_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

double sources_threshold(const float *in, size_t pixels, int most)
{
    size_t bin[BINS] = {0}, above = 0;
    for (size_t i = 0; i < pixels; i++) {
        const float y = luminance_709f(in + 3 * i);
        if (y > 0.0f)
            bin[bits_of(y) >> SHIFT]++;
    }
    for (int i = BINS - 1; i >= 0; i--) {
        above += bin[i];
        if (above <= (size_t)most)
            continue;
        const uint32_t bits = ((uint32_t)i + 1) << SHIFT;
        float edge;
        memcpy(&edge, &bits, sizeof edge);
        return (double)edge;
    }
    return 0.0;
}

// ---------------------------------------------------------------- finding

struct finding {
    struct sources *out;
    float *rest;
    int width, height;
    float threshold;
};

static bool add_source(struct sources *s, struct source source)
{
    if (!mem_grow(&s->source, (size_t)s->count, sizeof *s->source))
        return false;
    s->source[s->count++] = source;
    return true;
}

static bool shines(const struct finding *f, int x, int y)
{
    return luminance_709f(f->rest + 3 * ((size_t)y * (size_t)f->width + (size_t)x)) > f->threshold;
}

// The light of a pixel beyond the threshold, taken out of it; none when it is darker.
static bool take_pixel(struct finding *f, int x, int y, struct source *out)
{
    float *const rgb = f->rest + 3 * ((size_t)y * (size_t)f->width + (size_t)x);
    const float l = luminance_709f(rgb), share = l > f->threshold ? 1.0f - f->threshold / l : 0.0f;
    *out = (struct source){(float)x + 0.5f, (float)y + 0.5f, {0}};
    for (int c = 0; c < 3 && share > 0.0f; c++) {
        out->rgb[c] = share * rgb[c];
        rgb[c] -= out->rgb[c];
    }
    return share > 0.0f;
}

static bool take_pixels(struct finding *f)
{
    struct source source;
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++)
            if (shines(f, x, y) && take_pixel(f, x, y, &source) && !add_source(f->out, source))
                return false;
    return true;
}

// A spot in the making: its light, and pixels whose neighbours are still to be seen.
struct spot {
    double x, y, weight;
    float rgb[3];
    struct sources open;
};

// The pixel's light goes into the spot, and its neighbours are next. What was taken is not
// above the threshold any more, so each pixel comes once.
static bool grow_spot(struct finding *f, struct spot *spot, int x, int y)
{
    struct source one;
    if (!take_pixel(f, x, y, &one))
        return true;
    const double w = (double)luminance_709f(one.rgb);
    spot->x += w * (double)one.x;
    spot->y += w * (double)one.y;
    spot->weight += w;
    for (int c = 0; c < 3; c++)
        spot->rgb[c] += one.rgb[c];
    return add_source(&spot->open, one);
}

static bool take_spot(struct finding *f, struct spot *spot, int x, int y)
{
    spot->x = spot->y = spot->weight = 0.0;
    spot->rgb[0] = spot->rgb[1] = spot->rgb[2] = 0.0f;
    bool good = grow_spot(f, spot, x, y);
    while (good && spot->open.count) {
        const struct source at = spot->open.source[--spot->open.count];
        for (int k = 0; good && k < 9; k++) {
            const int nx = relume_whole(at.x) + k % 3 - 1, ny = relume_whole(at.y) + k / 3 - 1;
            if (nx >= 0 && nx < f->width && ny >= 0 && ny < f->height)
                good = grow_spot(f, spot, nx, ny);
        }
    }
    if (!good || !(spot->weight > 0.0))
        return good;
    const struct source source = {(float)(spot->x / spot->weight),
                                  (float)(spot->y / spot->weight),
                                  {spot->rgb[0], spot->rgb[1], spot->rgb[2]}};
    return add_source(f->out, source);
}

static bool take_spots(struct finding *f)
{
    struct spot spot = {0};
    bool good = true;
    for (int y = 0; good && y < f->height; y++)
        for (int x = 0; good && x < f->width; x++)
            good = take_spot(f, &spot, x, y);
    sources_destroy(&spot.open);
    return good;
}

relume_status sources_find(struct sources *out, float *rest, int width, int height,
                           double threshold, bool spots)
{
    struct finding f = {out, rest, width, height, (float)threshold};
    *out = (struct sources){0};
    if (spots ? take_spots(&f) : take_pixels(&f))
        return RELUME_OK;
    sources_destroy(out);
    return RELUME_ENOMEM;
}

void sources_destroy(struct sources *sources)
{
    mem_free(sources->source);
    *sources = (struct sources){0};
}

// ---------------------------------------------------------------- drawing

struct splat {
    float *out;
    int width;
    const struct sources *sources;
    const struct kernel *kernel;
    float *work;  // [threads][3][width]
};

// row += w * one row of the kernel, whose middle falls on pixel `middle`.
static void add_row(float *row, int width, const float *kernel, int reach, int middle, float w)
{
    const int from = middle - reach > 0 ? middle - reach : 0;
    const int to = middle + reach < width - 1 ? middle + reach : width - 1;
    const float *const k = kernel + reach - middle;
    for (int x = from; x <= to; x++)
        row[x] += w * k[x];
}

// Between four pixels a source is shared out, so that it glides.
static void add_source_row(float *const row[3], const struct splat *s, const struct source *source,
                           int y)
{
    const struct kernel *const kernel = s->kernel;
    const float fx = source->x - 0.5f, fy = source->y - 0.5f;
    const int ix = relume_whole(floorf(fx)), iy = relume_whole(floorf(fy));
    const struct bilinear b = {.across = (double)(fx - (float)ix),
                               .down = (double)(fy - (float)iy)};
    const size_t side = 2 * (size_t)kernel->reach + 1;
    for (int k = 0; k < 4; k++) {
        const float w = bilinear_sharef(&b, k, 1.0f);
        const int line = y - (iy + k / 2) + kernel->reach;
        if (w == 0.0f || line < 0 || line >= (int)side)
            continue;
        for (int c = 0; c < 3; c++)
            add_row(row[c], s->width, kernel->v[c] + (size_t)line * side, kernel->reach, ix + k % 2,
                    w * source->rgb[c]);
    }
}

static void splat_row(void *context, size_t item, int worker)
{
    const struct splat *s = context;
    const size_t width = (size_t)s->width;
    float *const work = s->work + 3 * (size_t)worker * width;
    float *const row[3] = {work, work + width, work + 2 * width};
    float *const out = s->out + 3 * item * width;
    memset(work, 0, 3 * width * sizeof *work);
    for (int i = 0; i < s->sources->count; i++)
        add_source_row(row, s, &s->sources->source[i], (int)item);
    for (size_t x = 0; x < width; x++)
        for (size_t c = 0; c < 3; c++)
            out[3 * x + c] += row[c][x];
}

relume_status sources_splat(float *out, int width, int height, const struct sources *sources,
                            const struct kernel *kernel, int threads)
{
    struct splat s = {out, width, sources, kernel, NULL};
    if (!sources->count)
        return RELUME_OK;
    s.work = mem_array(3 * (size_t)thread_count(threads) * (size_t)width, sizeof *s.work);
    if (!s.work)
        return RELUME_ENOMEM;
    thread_for(threads, (size_t)height, splat_row, &s);
    mem_free(s.work);
    return RELUME_OK;
}
