// learned_fixture.h - a coder of any basis, taught by Lambertian pixels with highlights
#ifndef TESTS_LEARNED_FIXTURE_H
#define TESTS_LEARNED_FIXTURE_H

#include "format/coder/coding.h"

#include "test.h"

enum { LEARNED_LIGHTS = 64, LEARNED_PIXELS = 300, LEARNED_PLANES = 3 * LEARNED_LIGHTS };

struct learned {
    struct relume_vec3 lights[LEARNED_LIGHTS];
    struct relume_vec3 normal[LEARNED_PIXELS];
    relume_coder *coder;
    float *samples;  // [LEARNED_LIGHTS][LEARNED_PIXELS][3]
    float *planes;   // [planes][LEARNED_PIXELS]
};

// White Lambertian in green; red has a highlight on top, blue is half as bright.
static inline void learned_value(float rgb[3], struct relume_vec3 normal, struct relume_vec3 light)
{
    const double c = fmax(vec3_dot(normal, light), 0.0);
    rgb[0] = (float)(c + 0.3 * pow(c, 20.0));
    rgb[1] = (float)c;
    rgb[2] = (float)(0.5 * c);
}

// `coefficients` 0: the basis's own choice.
static inline void learned_create(struct learned *l, const struct relume_basis *basis,
                                  bool hemispherical, bool pole_y, int coefficients)
{
    uint32_t seed = 5;
    CHECK_OK(relume_directions_make(
        l->lights, LEARNED_LIGHTS, relume_pattern_find("hammersley"),
        relume_directions_params(.hemisphere = hemispherical, .pole_y = pole_y)));
    l->samples = malloc(sizeof(float) * 3 * LEARNED_LIGHTS * LEARNED_PIXELS);
    for (int x = 0; x < LEARNED_PIXELS; x++) {
        l->normal[x] = test_direction(&seed);
        double *up = pole_y ? &l->normal[x].y : &l->normal[x].z;
        *up = hemispherical ? fabs(*up) : *up;
        for (int i = 0; i < LEARNED_LIGHTS; i++)
            learned_value(l->samples + 3 * (i * LEARNED_PIXELS + x), l->normal[x], l->lights[i]);
    }
    const struct relume_samples samples = {
        .lights = LEARNED_LIGHTS, .pixels = LEARNED_PIXELS, .data = l->samples};
    CHECK_OK(relume_coder_create(&l->coder, basis, l->lights, LEARNED_LIGHTS,
                                 relume_coder_params(.hemispherical = hemispherical,
                                                     .pole_y = pole_y, .coefficients = coefficients,
                                                     .samples = &samples)));
    l->planes = malloc(sizeof(float) * LEARNED_PLANES * LEARNED_PIXELS);
    CHECK_OK(relume_coder_apply(l->coder, l->samples, 3 * LEARNED_PIXELS, LEARNED_PIXELS, l->planes,
                                LEARNED_PIXELS));
}

static inline void learned_destroy(struct learned *l)
{
    relume_coder_destroy(&l->coder);
    free(l->samples);
    free(l->planes);
}

// A channel of a pixel under a weight vector.
static inline double learned_show(const struct learned *l, int pixel, int c, const float *weights,
                                  const float constant[3])
{
    const struct relume_coder_info *info = relume_coder_info(l->coder);
    double sum = (double)constant[c];
    for (int k = 0; k < info->coefficients; k++)
        sum += (double)weights[c * info->coefficients + k] *
               (double)l->planes[relume_coder_plane(info, k, c) * LEARNED_PIXELS + pixel];
    return sum;
}

#endif
