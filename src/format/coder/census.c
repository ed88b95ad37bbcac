// census.c - pixels and images that carry no information: black, or clipped
#include "format/coder/census.h"

#include "core/base/memory.h"

#include <math.h>
#include <string.h>

// Decoding and dividing round; the next code below white is farther away, even with 16 bits.
static const float NEARLY = 1.0f - 4e-6f;

relume_status census_create(struct census *c, const relume_capture *capture,
                            struct relume_transfer display, int workers)
{
    const int lights = relume_capture_manifest(capture)->lights;
    *c = (struct census){.lights = lights, .workers = workers};
    c->white = mem_array((size_t)lights, sizeof *c->white);
    c->count = mem_zeroed((size_t)workers, sizeof *c->count);
    c->lit = mem_zeroed((size_t)workers * (size_t)lights, sizeof *c->lit);
    if (!c->white || !c->count || !c->lit)
        return RELUME_ENOMEM;
    for (int i = 0; i < lights; i++) {
        float white[3];
        relume_capture_white(capture, i, white);
        for (int k = 0; k < 3; k++) {
            c->white[i][k] =
                isfinite(white[k]) ? relume_transfer_encode(display, white[k]) * NEARLY : INFINITY;
        }
    }
    return RELUME_OK;
}

void census_destroy(struct census *c)
{
    mem_free(c->white);
    mem_free(c->count);
    mem_free(c->lit);
    *c = (struct census){0};
}

// Pixels that are looked at together: what is gathered of them stays in the first-level cache.
enum { RUN = 256 };
struct gathered {
    int32_t bits[3][RUN];     // of all lights, or-ed: 0 where all of them are 0
    int32_t clipped[3][RUN];  // how many lights
};

// Without a branch, for the sake of vector instructions.
static void gather(int32_t *restrict bits, int32_t *restrict clipped, const float *samples,
                   float white, size_t n)
{
    for (size_t x = 0; x < n; x++) {
        int32_t sample;
        memcpy(&sample, samples + x, sizeof sample);
        bits[x] |= sample;
        clipped[x] += samples[x] >= white;
    }
}

static bool is_lit(const float *samples, size_t n)
{
    for (size_t x = 0; x < n; x++)
        if (samples[x] > 0.0f)
            return true;
    return false;
}

static void count_pixels(struct relume_census *count, const struct gathered *g, int lights,
                         size_t n, const float *mask)
{
    for (size_t x = 0; x < n; x++) {
        if (mask && mask[x] <= 0.5f)
            continue;
        const int32_t r = g->clipped[0][x], green = g->clipped[1][x], b = g->clipped[2][x];
        count->pixels++;
        count->black += !(g->bits[0][x] | g->bits[1][x] | g->bits[2][x]);
        count->clipped += r + green + b > 0;
        count->always_clipped += r == lights || green == lights || b == lights;
    }
}

void census_add(struct census *c, int worker, const float *planes, size_t n, const float *mask)
{
    const size_t lights = (size_t)c->lights;
    for (size_t first = 0; first < n; first += RUN) {
        const size_t run = n - first < RUN ? n - first : RUN;
        struct gathered g = {{{0}}, {{0}}};
        for (size_t i = 0; i < lights; i++)
            for (size_t k = 0; k < 3; k++) {
                const float *samples = planes + (k * lights + i) * n + first;
                bool *lit = &c->lit[(size_t)worker * lights + i];
                *lit = *lit || is_lit(samples, run);
                gather(g.bits[k], g.clipped[k], samples, c->white[i][k], run);
            }
        count_pixels(&c->count[worker], &g, c->lights, run, mask ? mask + first : NULL);
    }
}

bool census_is_lit(const struct census *c, int light)
{
    bool lit = false;
    for (int w = 0; w < c->workers; w++)
        lit |= c->lit[w * c->lights + light];
    return lit;
}

struct relume_census census_result(const struct census *c)
{
    struct relume_census sum = {0};
    for (int w = 0; w < c->workers; w++) {
        sum.pixels += c->count[w].pixels;
        sum.black += c->count[w].black;
        sum.clipped += c->count[w].clipped;
        sum.always_clipped += c->count[w].always_clipped;
    }
    for (int i = 0; i < c->lights; i++)
        sum.black_images += !census_is_lit(c, i);
    return sum;
}
