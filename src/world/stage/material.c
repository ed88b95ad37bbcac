// material.c - how a surface answers light: Lambert, a glossy microfacet coat, a mirror
#include "world/stage/material.h"

static const float PI_F = 3.14159265358979f;

// fminf and fmaxf are calls in this build; these are one instruction.
static inline float smaller(float a, float b)
{
    return a < b ? a : b;
}

static inline float larger(float a, float b)
{
    return a > b ? a : b;
}

// Grazing eyes on smooth normals may look slightly from behind; the formulas stay finite.
static float eye_cosine(const struct surface *s)
{
    return larger(dot3(s->n, s->wo), 1e-3f);
}

static float fifth_power(float x)
{
    const float x2 = x * x;
    return x2 * x2 * x;
}

static bool has_coat(const struct surface *s)
{
    return s->f0[0] > 0.0f || s->f0[1] > 0.0f || s->f0[2] > 0.0f;
}

static float distribution(float alpha, float nh)
{
    const float a2 = alpha * alpha;
    const float d = nh * nh * (a2 - 1.0f) + 1.0f;
    return a2 / (PI_F * d * d);
}

// Smith's masking and shadowing over 4 nl nv (Heitz 2014, Eq. 99).
static float visibility(float alpha, float nl, float nv)
{
    const float a2 = alpha * alpha;
    return 0.5f / (nl * sqrtf(nv * nv * (1.0f - a2) + a2) + nv * sqrtf(nl * nl * (1.0f - a2) + a2));
}

static float halfway(const float a[3], const float b[3], float h[3])
{
    for (int c = 0; c < 3; c++)
        h[c] = a[c] + b[c];
    const float length = sqrtf(larger(dot3(h, h), 1e-20f));
    for (int c = 0; c < 3; c++)
        h[c] /= length;
    return length;
}

bool surface_lit(const struct surface *s, const float wi[3], float out[3])
{
    const float nl = dot3(s->n, wi);
    if (nl <= 0.0f || dot3(s->ng, wi) <= 0.0f)
        return false;
    if (!has_coat(s)) {
        for (int c = 0; c < 3; c++)
            out[c] = s->diffuse[c] * nl;
        return true;
    }
    const float nv = eye_cosine(s);
    float h[3];
    halfway(wi, s->wo, h);
    const float at_half = fifth_power(1.0f - smaller(dot3(wi, h), 1.0f));
    const float into = fifth_power(1.0f - smaller(nl, 1.0f)),
                leave = fifth_power(1.0f - smaller(nv, 1.0f));
    const float lobe = PI_F * nl * s->gloss * distribution(s->alpha, smaller(dot3(s->n, h), 1.0f)) *
                       visibility(s->alpha, nl, nv);
    for (int c = 0; c < 3; c++) {
        const float rest = 1.0f - s->f0[c];  // 1 - F = (1 - f0) (1 - fifth power)
        out[c] = s->diffuse[c] * nl * rest * (1.0f - into) * rest * (1.0f - leave) +
                 lobe * (s->f0[c] + rest * at_half);
    }
    return true;
}

void surface_mirror(const struct surface *s, float out[3])
{
    const float grazing = has_coat(s) ? fifth_power(1.0f - smaller(eye_cosine(s), 1.0f)) : 0.0f;
    for (int c = 0; c < 3; c++)
        out[c] = (1.0f - s->gloss) * (s->f0[c] + (1.0f - s->f0[c]) * grazing);
}

// Two unit vectors that complete `n` to a frame (Duff et al. 2017).
static void tangents(const float n[3], float t[3], float b[3])
{
    const float sign = copysignf(1.0f, n[2]);
    const float p = -1.0f / (sign + n[2]);
    const float q = n[0] * n[1] * p;
    t[0] = 1.0f + sign * n[0] * n[0] * p, t[1] = sign * q, t[2] = -sign * n[0];
    b[0] = q, b[1] = sign + n[1] * n[1] * p, b[2] = -n[1];
}

// The direction at height `z` and azimuth 2 pi u over `n`.
static void around(const float n[3], float z, float u, float out[3])
{
    float t[3], b[3];
    tangents(n, t, b);
    const float r = sqrtf(larger(0.0f, 1.0f - z * z));
    const float x = r * cosf(2.0f * PI_F * u), y = r * sinf(2.0f * PI_F * u);
    for (int c = 0; c < 3; c++)
        out[c] = x * t[c] + y * b[c] + z * n[c];
}

static void sample_lobe(const struct surface *s, float u1, float u2, float wi[3])
{
    const float z = sqrtf((1.0f - u1) / (1.0f + (s->alpha * s->alpha - 1.0f) * u1));
    float h[3];
    around(s->n, z, u2, h);
    const float along = 2.0f * dot3(s->wo, h);
    for (int c = 0; c < 3; c++)
        wi[c] = along * h[c] - s->wo[c];
}

static float lobe_density(const struct surface *s, const float wi[3])
{
    float h[3];
    halfway(wi, s->wo, h);
    const float nh = larger(dot3(s->n, h), 0.0f);
    return distribution(s->alpha, nh) * nh / (4.0f * larger(dot3(s->wo, h), 1e-4f));
}

bool surface_sample(const struct surface *s, float pick, const float u[2], float wi[3],
                    float out[3])
{
    // How often the lobe rather than the base is asked, by their rough shares of the light.
    const float base = s->diffuse[0] + s->diffuse[1] + s->diffuse[2];
    const float lobe = s->gloss * (s->f0[0] + s->f0[1] + s->f0[2]);
    const float chance = lobe > 0.0f ? lobe / (lobe + base) : 0.0f;
    if (pick < chance)
        sample_lobe(s, u[0], u[1], wi);
    else
        around(s->n, sqrtf(1.0f - u[0]), u[1], wi);
    if (!surface_lit(s, wi, out))
        return false;
    const float density = (1.0f - chance) * dot3(s->n, wi) / PI_F +
                          (chance > 0.0f ? chance * lobe_density(s, wi) : 0.0f);
    if (!(density > 0.0f))
        return false;
    for (int c = 0; c < 3; c++)
        out[c] /= PI_F * density;
    return true;
}
