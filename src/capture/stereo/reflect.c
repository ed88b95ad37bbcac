// reflect.c - parts of a reflectance, all lights at once
#include "capture/stereo/reflect.h"

#include <string.h>

// Width of the lobes: the RMS slope of their facets. Steps of 1.5 leave 3 % of any wider lobe.
static const float roughness[REFLECT_LOBES] = {0.05f, 0.085f, 0.13f, 0.2f, 0.3f, 0.42f, 0.6f, 0.9f};
enum { BLOCK = 8, ROWS = 7 };

int reflect_stride(int lights)
{
    return (lights + BLOCK - 1) / BLOCK * BLOCK;
}

size_t reflect_floats(int lights)
{
    return ROWS * (size_t)reflect_stride(lights);
}

void reflect_lights_set(struct reflect_lights *to, const vec3 *direction, vec3 eye)
{
    const size_t stride = (size_t)to->stride;
    to->eye = eye;
    memset(to->at, 0, ROWS * stride * sizeof *to->at);
    for (int i = 0; i < to->n; i++) {
        const vec3 d = direction[i], both = vec3_add(d, eye);
        const vec3 h = vec3_length(both) > 1e-6 ? vec3_unit(both) : eye;
        const double row[ROWS] = {d.x, d.y, d.z, h.x, h.y, h.z, vec3_dot(d, eye)};
        for (size_t k = 0; k < ROWS; k++)
            to->at[k * stride + (size_t)i] = (float)row[k];
    }
}

// e^x for x <= 0 to 1e-6, without a branch: loops over it become SIMD.
static inline float exp_below(float x)
{
    const float wide = x * 1.44269504f, t = wide < -100.0f ? -100.0f : wide;
    const int whole = (int)(t - 0.5f);
    const float f = t - (float)whole;
    const float p =
        1.0f + f * (0.69314718f +
                    f * (0.24022651f + f * (0.05550411f + f * (0.00961813f + f * 0.00133336f))));
    const union {
        int bits;
        float value;
    } power = {(whole + 127) << 23};
    return p * power.value;
}

static void find_matte(float *parts, size_t stride, const float *restrict cosine,
                       const float *restrict to_eye, float eye)
{
    float *lambert = parts, *flat = parts + stride, *steep = flat + stride, *rough = steep + stride;
    for (size_t i = 0; i < stride; i++) {
        const float c = cosine[i], back = to_eye[i] - c * eye;
        lambert[i] = c;
        flat[i] = c / (c + eye);
        steep[i] = c * c;
        rough[i] = back > 0.0f ? c * back / (c > eye ? c : eye) : 0.0f;
    }
}

// Masking as Schlick (1994) simplifies Smith's: no root, so that the loop becomes SIMD.
static void find_lobe(float *restrict lobe, size_t stride, const float *restrict cosine,
                      const float *restrict half, float eye, float alpha)
{
    const float k = 0.5f * alpha, m = 1.0f - k, slope = 1.0f / (alpha * alpha);
    const float scale = 0.25f * slope / (eye * m + k);
    for (size_t i = 0; i < stride; i++) {
        const float c = cosine[i], h2 = half[i] * half[i] + 1e-6f;
        const float narrow = exp_below(slope - slope / h2);
        lobe[i] = scale * c * narrow / (h2 * h2 * (c * m + k));
    }
}

void reflect_parts(float *parts, unsigned which, const struct reflect_lights *lights, vec3 normal,
                   float *scratch)
{
    const size_t stride = (size_t)lights->stride;
    const float x = (float)normal.x, y = (float)normal.y, z = (float)normal.z;
    const float eye = fmaxf((float)vec3_dot(normal, lights->eye), 0.02f);
    const float *l = lights->at, *h = l + 3 * stride;
    float *cosine = scratch, *half = scratch + stride;
    for (size_t i = 0; i < stride; i++) {
        const float c = x * l[i] + y * l[stride + i] + z * l[2 * stride + i];
        cosine[i] = c > 0.0f ? c : 0.0f;
        half[i] = x * h[i] + y * h[stride + i] + z * h[2 * stride + i];
    }
    find_matte(parts, stride, cosine, l + 6 * stride, eye);
    for (int k = 0; k < REFLECT_LOBES; k++)
        if (which >> (REFLECT_MATTE + k) & 1)
            find_lobe(parts + (size_t)(REFLECT_MATTE + k) * stride, stride, cosine, half, eye,
                      roughness[k]);
}
