#include "coder/census.h"

#include "base/memory.h"

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
    free(c->white);
    free(c->count);
    free(c->lit);
    *c = (struct census){0};
}

// Samples that are looked at together: what is gathered of them stays in the first-level cache.
enum { RUN = 256 };
struct gathered {
    int32_t bits[3 * RUN];     // of all lights, or-ed: 0 where all of them are 0
    int32_t clipped[3 * RUN];  // how many lights
};

// Without a branch, for the sake of vector instructions.
static void gather(struct gathered *g, const float *samples, const float *white, size_t n)
{
    for (size_t j = 0; j < 3 * n; j++) {
        int32_t bits;
        memcpy(&bits, samples + j, sizeof bits);
        g->bits[j] |= bits;
        g->clipped[j] += samples[j] >= white[j];
    }
}

static bool is_lit(const float *samples, size_t n)
{
    for (size_t j = 0; j < 3 * n; j++)
        if (samples[j] > 0.0f)
            return true;
    return false;
}

static void count_run(struct census *c, int worker, const float *samples, size_t stride, size_t n,
                      const float *mask)
{
    struct gathered g = {{0}, {0}};
    float white[3 * RUN];
    struct relume_encode_census *count = &c->count[worker];
    for (int i = 0; i < c->lights; i++) {
        const float *row = samples + (size_t)i * stride, *w = c->white[i];
        bool *lit = &c->lit[worker * c->lights + i];
        *lit = *lit || is_lit(row, n);
        if (i == 0 || memcmp(w, c->white[i - 1], sizeof *c->white))
            for (size_t j = 0; j < 3 * n; j++)
                white[j] = w[j % 3];
        gather(&g, row, white, n);
    }
    for (size_t x = 0; x < n; x++) {
        if (mask && mask[x] <= 0.5f)
            continue;
        const int32_t *b = g.bits + 3 * x, *h = g.clipped + 3 * x;
        count->pixels++;
        count->black += !(b[0] | b[1] | b[2]);
        count->clipped += h[0] + h[1] + h[2] > 0;
        count->always_clipped += h[0] == c->lights || h[1] == c->lights || h[2] == c->lights;
    }
}

void census_add(struct census *c, int worker, const float *samples, size_t stride, size_t n,
                const float *mask)
{
    for (size_t x = 0; x < n; x += RUN)
        count_run(c, worker, samples + 3 * x, stride, n - x < RUN ? n - x : RUN,
                  mask ? mask + x : NULL);
}

struct relume_encode_census census_result(const struct census *c)
{
    struct relume_encode_census sum = {0};
    for (int w = 0; w < c->workers; w++) {
        sum.pixels += c->count[w].pixels;
        sum.black += c->count[w].black;
        sum.clipped += c->count[w].clipped;
        sum.always_clipped += c->count[w].always_clipped;
    }
    for (int i = 0; i < c->lights; i++) {
        bool lit = false;
        for (int w = 0; w < c->workers; w++)
            lit |= c->lit[w * c->lights + i];
        sum.black_images += !lit;
    }
    return sum;
}
