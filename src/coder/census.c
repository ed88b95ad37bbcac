#include "coder/census.h"

#include "base/memory.h"

#include <math.h>

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
            c->white[i][k] = relume_transfer_encode(display, white[k]) * NEARLY;
            c->clips |= isfinite(white[k]) != 0;
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

static bool find_brightest(float *brightest, const float *samples, size_t n)
{
    float most = 0.0f;
    for (size_t j = 0; j < 3 * n; j++) {
        const float v = samples[j];
        brightest[j] = v > brightest[j] ? v : brightest[j];
        most = v > most ? v : most;
    }
    return most > 0.0f;
}

static void count_clipped(uint16_t *clipped, const float *samples, const float white[3], size_t n)
{
    const float red = white[0], green = white[1], blue = white[2];
    for (size_t x = 0; x < n; x++, samples += 3)
        clipped[x] += samples[0] >= red || samples[1] >= green || samples[2] >= blue;
}

void census_add(struct census *c, int worker, const float *samples, size_t stride, size_t n,
                const float *mask)
{
    float brightest[3 * CODER_CHUNK] = {0.0f};
    uint16_t clipped[CODER_CHUNK] = {0};
    struct relume_encode_census *count = &c->count[worker];
    for (int i = 0; i < c->lights; i++) {
        const float *row = samples + (size_t)i * stride;
        c->lit[worker * c->lights + i] |= find_brightest(brightest, row, n);
        if (c->clips)
            count_clipped(clipped, row, c->white[i], n);
    }
    for (size_t x = 0; x < n; x++) {
        if (mask && mask[x] <= 0.5f)
            continue;
        const float *b = brightest + 3 * x;
        count->pixels++;
        count->black += b[0] <= 0.0f && b[1] <= 0.0f && b[2] <= 0.0f;
        count->clipped += clipped[x] > 0;
        count->always_clipped += clipped[x] == c->lights;
    }
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
