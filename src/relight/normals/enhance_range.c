// enhance_range.c - what a pass scales to the picture, so that gold coins and black paintings are
// seen as well as plaster: percentiles of a grid of pixels
#include <relume/relight/enhance.h>

#include "core/base/memory.h"
#include "core/math/luminance.h"
#include "core/math/sort.h"
#include "relight/normals/enhance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Percentiles of so many pixels are within about a hundredth of those of all.
enum { SIDE = 128 };
static const double black_share = 0.05;  // of the picture that diffuse gain may turn black
static const double low_share = 0.01, high_share = 0.99;
static const float least = 1e-4f;  // of the brightest: what is darker is background

int relume_pass_step(int width, int height)
{
    const int most = width > height ? width : height;
    return (most + SIDE - 1) / SIDE;
}

// ---------------------------------------------------------------- percentiles

// Sorts.
static float percentile(float *values, size_t n, double share)
{
    sort_floats(values, n);
    return values[(size_t)(share * (double)(n - 1) + 0.5)];
}

// ---------------------------------------------------------------- pixels

struct grid {
    const struct relume_image *image, *albedo;
    float light[3];  // the sum of the directional ones
    int step;
    float floor;
    float *value;
    size_t n;
};

static void brightest(struct grid *g, const float *rgb, const float *albedo)
{
    (void)albedo;
    g->floor = fmaxf(g->floor, least * luminance_709f(rgb));
}

static void keep_luminance(struct grid *g, const float *rgb, const float *albedo)
{
    const float y = luminance_709f(rgb);
    (void)albedo;
    if (y > g->floor)
        g->value[g->n++] = y;
}

static float most_of(const struct grid *g, const float *albedo)
{
    const float most[3] = {g->light[0] * albedo[0], g->light[1] * albedo[1],
                           g->light[2] * albedo[2]};
    return luminance_709f(most);
}

static void keep_ratio(struct grid *g, const float *rgb, const float *albedo)
{
    const float y = luminance_709f(rgb), most = most_of(g, albedo);
    if (y > g->floor && most > g->floor)
        g->value[g->n++] = y / most;
}

// Calls `see` for every pixel of the grid.
static void walk(struct grid *g, void (*see)(struct grid *, const float *, const float *))
{
    g->n = 0;
    for (int y = 0; y < g->image->height; y += g->step)
        for (int x = 0; x < g->image->width; x += g->step) {
            const size_t at = 3 * ((size_t)y * (size_t)g->image->width + (size_t)x);
            see(g, g->image->data + at, g->albedo ? g->albedo->data + at : NULL);
        }
}

// ---------------------------------------------------------------- diffuse gain

// f' = m + g (f - m) is black where f / m is below 1 - 1 / g. With m a share a of what a surface
// facing the light would show, that bound becomes a (1 - 1 / g); `a` is the largest, up to 1, that
// turns no more than black_share of the picture black with the usual gain. A larger one turns more
// of it black: with an `a` for every gain, all of them would give the same picture.
static float find_pivot(struct grid *g)
{
    static const float usual = (float)RELUME_PASS_GAIN;
    walk(g, keep_ratio);
    if (!g->n)
        return 1.0f;
    return fminf(percentile(g->value, g->n, black_share) * usual / (usual - 1.0f), 1.0f);
}

// What is brightest stays as bright.
static float find_scale(struct grid *g, float gain, float pivot, float high)
{
    size_t n = 0;
    for (int y = 0; y < g->image->height; y += g->step)
        for (int x = 0; x < g->image->width; x += g->step) {
            const size_t at = 3 * ((size_t)y * (size_t)g->image->width + (size_t)x);
            const float f = luminance_709f(g->image->data + at);
            const float m = pivot * most_of(g, g->albedo->data + at);
            if (f > g->floor)
                g->value[n++] = fmaxf(m + gain * (f - m), 0.0f);
        }
    const float now = n ? percentile(g->value, n, high_share) : 0.0f;
    return now > 0.0f ? high / now : 1.0f;
}

// ---------------------------------------------------------------- interface

static struct grid grid_of(const struct relume_image *image, const struct relume_image *albedo,
                           const struct relume_light *lights, int n)
{
    struct grid g = {
        .image = image, .albedo = albedo, .step = relume_pass_step(image->width, image->height)};
    for (int i = 0; i < n; i++)
        for (int c = 0; c < 3 && lights[i].kind == RELUME_LIGHT_DIRECTIONAL; c++)
            g.light[c] += lights[i].rgb[c];
    return g;
}

relume_status relume_pass_measure(struct relume_pass_range *out, const struct relume_image *image,
                                  enum relume_pass pass, const struct relume_image *albedo,
                                  const struct relume_light *lights, int n, float gain)
{
    struct grid g = grid_of(image, albedo, lights, n);
    *out = (struct relume_pass_range){.low = 0.0f, .high = 1.0f, .pivot = 1.0f, .scale = 1.0f};
    g.value = mem_array((size_t)SIDE * SIDE, sizeof *g.value);
    if (!g.value)
        return RELUME_ENOMEM;
    walk(&g, brightest);
    walk(&g, keep_luminance);
    if (g.n) {
        out->high = percentile(g.value, g.n, high_share);
        out->low = percentile(g.value, g.n, low_share);
    }
    if (g.n && pass == RELUME_PASS_SPECULAR)
        out->scale = out->high;
    if (g.n && pass == RELUME_PASS_DIFFUSE_GAIN && albedo) {
        gain = gain != 0.0f ? gain : RELUME_PASS_GAIN;
        const float high = out->high;
        out->pivot = find_pivot(&g);
        out->scale = find_scale(&g, gain, out->pivot, high);
    }
    // one value alone is in the middle
    if (!(out->high > out->low))
        out->low = 0.0f, out->high = 2.0f * fmaxf(out->high, 1e-6f);
    mem_free(g.value);
    return RELUME_OK;
}
