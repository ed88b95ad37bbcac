// ggx.c - the reflectance of glTF 2.0 for one pixel under many lights
#include "material/maps/ggx.h"

#include <stddef.h>

static const float LEAST_EYE = 1e-3f;  // cosine; normals from noise may look away

static int padded(int lights)
{
    return (lights + LOOK_LANES - 1) / LOOK_LANES * LOOK_LANES;
}

size_t look_size(int lights)
{
    return LOOK_ARRAYS * (size_t)padded(lights);
}

void look_place(struct look *k, float *memory, int lights)
{
    float **const array[LOOK_ARRAYS] = {
        &k->towards[0], &k->towards[1], &k->towards[2], &k->half[0],  &k->half[1],  &k->half[2],
        &k->fifth,      &k->value[0],   &k->value[1],   &k->value[2], &k->coded[0], &k->coded[1],
        &k->coded[2],   &k->clipped,    &k->cosine,     &k->lobe,     &k->base,     &k->slope,
        &k->aside[0],   &k->aside[1],   &k->aside[2],   &k->aside[3], &k->aside[4], &k->aside[5],
        &k->aside[6],   &k->aside[7],
    };
    k->known = lights;
    k->lights = padded(lights);
    for (int i = 0; i < LOOK_ARRAYS; i++) {
        *array[i] = memory + (size_t)i * (size_t)k->lights;
        for (int l = lights; l < k->lights; l++)
            (*array[i])[l] = 0.0f;
    }
}

void look_halve(const struct look *k)
{
    for (int i = 0; i < k->lights; i++) {
        const float h[3] = {k->towards[0][i] + k->view[0], k->towards[1][i] + k->view[1],
                            k->towards[2][i] + k->view[2]};
        const float length = sqrtf(h[0] * h[0] + h[1] * h[1] + h[2] * h[2] + 1e-20f);
        const float eye = (h[0] * k->view[0] + h[1] * k->view[1] + h[2] * k->view[2]) / length;
        const float x = eye < 1.0f ? 1.0f - eye : 0.0f, square = x * x;
        for (int c = 0; c < 3; c++)
            k->half[c][i] = h[c] / length;
        k->fifth[i] = square * square * x;
    }
}

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void look_turn(const struct look *k, const float n[3], float roughness)
{
    const float rough = roughness > GGX_LEAST_ROUGHNESS ? roughness : GGX_LEAST_ROUGHNESS;
    const float alpha = rough * rough, a2 = alpha * alpha, rest = 1.0f - a2;
    const float eye = dot(n, k->view), nv = eye > LEAST_EYE ? eye : LEAST_EYE;
    const float seen = 1.0f / (nv + sqrtf(a2 + rest * nv * nv));
    const float *const *l = (const float *const *)k->towards, *const *h =
                                                                  (const float *const *)k->half;
    float *restrict cosine = k->cosine, *restrict lobe = k->lobe;
    for (int i = 0; i < k->lights; i++) {
        const float to = n[0] * l[0][i] + n[1] * l[1][i] + n[2] * l[2][i];
        const float nl = to > 0.0f ? to : 0.0f;
        const float nh = n[0] * h[0][i] + n[1] * h[1][i] + n[2] * h[2][i];
        const float d = 1.0f - nh * nh * rest;
        cosine[i] = nl;
        lobe[i] = nl * a2 * seen / (d * d * (nl + sqrtf(a2 + rest * nl * nl) + 1e-12f));
    }
}

void look_gloss(const struct look *k, const struct gloss *g)
{
    const float f90 = gloss_f90(g->f0), f0 = g->f0, rest = f90 - f0;
    const float *restrict fifth = k->fifth, *restrict lobe = k->lobe, *restrict cosine = k->cosine;
    float *restrict base = k->base, *restrict slope = k->slope;
    for (int i = 0; g->metal && i < k->lights; i++) {
        base[i] = fifth[i] * lobe[i];
        slope[i] = (1.0f - fifth[i]) * lobe[i];
    }
    for (int i = 0; !g->metal && i < k->lights; i++) {
        const float f = f0 + rest * fifth[i];
        base[i] = f * lobe[i];
        slope[i] = (1.0f - f) * cosine[i];
    }
}
