// fixture.h - an offscreen context and made-up coefficients for the tests of the viewer
#ifndef TESTS_GL_FIXTURE_H
#define TESTS_GL_FIXTURE_H

#include "draw/gl_renderer.h"
#include "owned.h"
#include "window/context.h"

#include <relume/extensions.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { FIXTURE_K = 9, FIXTURE_PLANES = 3 * FIXTURE_K, FIXTURE_LIGHTS = 40 };

static void *fixture_context;
static struct gl fixture_gl;

static void fixture_message(void *user, enum relume_level level, const char *text)
{
    (void)user, (void)level;
    print_message("%s\n", text);
}
static const struct relume_log fixture_log = {.message = fixture_message};

static int fixture_open(void **state)
{
    (void)state;
    if (context_osmesa.open(&fixture_context, 1, 1, "test", &fixture_log))
        return -1;
    return gl_load(&fixture_gl, context_osmesa.get_proc, &fixture_log) ? -1 : 0;
}

static int fixture_close(void **state)
{
    (void)state;
    context_osmesa.close(fixture_context);
    return 0;
}

static double uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

// Nine spherical harmonics on an even spiral of lights over the whole sphere.
static relume_coder *fixture_coder(bool pole_y)
{
    struct relume_vec3 lights[FIXTURE_LIGHTS];
    for (int i = 0; i < FIXTURE_LIGHTS; i++) {
        const double z = 1 - (2 * i + 1.0) / FIXTURE_LIGHTS;
        const double phi = 2.399963229728653 * i;
        lights[i] = (struct relume_vec3){sqrt(1 - z * z) * cos(phi), sqrt(1 - z * z) * sin(phi), z};
    }
    relume_coder *coder;
    assert_int_equal(
        relume_coder_create(&coder, &relume_basis_sh, lights, FIXTURE_LIGHTS,
                            relume_coder_params(.coefficients = FIXTURE_K, .pole_y = pole_y)),
        RELUME_OK);
    return coder;
}

// Views of made-up codes. `codes[i]` are lent by fixture_source.
struct fixture_file {
    relume_coder *coder;
    struct relume_codes *codes;
    int views;
    int asked;  // how often codes were fetched
    void **memory;
    const void **plane;
    float scale[FIXTURE_PLANES], offset[FIXTURE_PLANES];
};

static size_t fixture_bytes(enum relume_storage storage)
{
    return relume_storage_bytes(storage);
}

// A half of [-1, 1] with full precision: random sign, exponent in 2^-7 .. 1, random fraction.
static uint16_t random_half(uint64_t *random)
{
    const unsigned exponent = 8 + (unsigned)(7 * uniform(random));
    return (uint16_t)((uniform(random) < 0.5 ? 0x8000u : 0) | exponent << 10 |
                      (unsigned)(1024 * uniform(random)));
}

static void fill_codes(void *memory, size_t n, enum relume_storage storage, uint64_t *random)
{
    for (size_t i = 0; i < n; i++) {
        if (storage == RELUME_STORE_8)
            ((uint8_t *)memory)[i] = (uint8_t)(256 * uniform(random));
        else if (storage == RELUME_STORE_FLOAT)
            ((float *)memory)[i] = (float)(2.0 * uniform(random) - 1.0);
        else if (storage == RELUME_STORE_HALF)
            ((uint16_t *)memory)[i] = random_half(random);
        else
            ((uint16_t *)memory)[i] =
                (uint16_t)((relume_storage_top(storage) + 1) * uniform(random));
    }
}

// Values under a light of 1 lie around [-0.5, 2]: the first harmonic lifts them, the rest vary.
static inline struct fixture_file fixture_make(int views, int width, int height,
                                               enum relume_storage storage,
                                               enum relume_domain domain, bool pole_y)
{
    struct fixture_file f = {.coder = fixture_coder(pole_y), .views = views};
    const size_t pixels = (size_t)width * (size_t)height;
    const bool half = !relume_storage_top(storage);
    const float range = half ? 1 : (float)relume_storage_top(storage);
    uint64_t random = 11;
    for (int p = 0; p < FIXTURE_PLANES; p++) {
        const float spread = p < 3 ? 1.5f : 0.4f;
        f.scale[p] = spread / range * (half ? 0.5f : 1.0f);
        f.offset[p] = p < 3 ? 0.8f : half ? 0.0f : -0.5f * spread;
    }
    f.codes = calloc((size_t)views, sizeof *f.codes);
    f.memory = calloc((size_t)views, sizeof *f.memory);
    f.plane = calloc((size_t)views * FIXTURE_PLANES, sizeof *f.plane);
    for (int i = 0; i < views; i++) {
        f.memory[i] = malloc(pixels * FIXTURE_PLANES * fixture_bytes(storage));
        fill_codes(f.memory[i], pixels * FIXTURE_PLANES, storage, &random);
        for (int p = 0; p < FIXTURE_PLANES; p++)
            f.plane[i * FIXTURE_PLANES + p] =
                (char *)f.memory[i] + (size_t)p * pixels * fixture_bytes(storage);
        f.codes[i] = (struct relume_codes){
            .coder = f.coder,
            .domain = domain,
            .display = {.curve = RELUME_CURVE_SRGB},
            .width = width,
            .height = height,
            .planes = FIXTURE_PLANES,
            .storage = storage,
            .plane = &f.plane[i * FIXTURE_PLANES],
        };
    }
    return f;
}

// The file must not move any more: codes point at its scales.
static relume_status fixture_fetch(const struct relume_codes **out, void *user, int view)
{
    struct fixture_file *f = user;
    f->asked++;
    f->codes[view].scale = f->scale;
    f->codes[view].offset = f->offset;
    *out = &f->codes[view];
    return RELUME_OK;
}

static inline void fixture_free(struct fixture_file *f)
{
    for (int i = 0; i < f->views; i++)
        free(f->memory[i]);
    free(f->memory);
    free(f->plane);
    free(f->codes);
    relume_coder_destroy(&f->coder);
}

static inline struct relume_image fixture_relight(struct fixture_file *f, int view,
                                                  const struct relume_light *lights, int n)
{
    struct relume_image image = {0};
    const struct relume_codes *codes;
    assert_int_equal(fixture_fetch(&codes, f, view), RELUME_OK);
    assert_int_equal(relume_relight(&image, codes, lights, n, NULL), RELUME_OK);
    return image;
}

static inline double fixture_difference(const struct relume_image *a, const struct relume_image *b)
{
    double most = 0;
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    for (int i = 0; i < 3 * a->width * a->height; i++) {
        const double d = fabs((double)a->data[i] - b->data[i]);
        most = d > most || isnan(d) ? d : most;
    }
    return most;
}

// Prints both sides, so that a failure and a slackening bound are seen.
static inline void assert_below(const char *what, double got, double bound)
{
    print_message("  %s: %.3g, bound %.3g\n", what, got, bound);
    assert_true(got <= bound);
}

#endif
