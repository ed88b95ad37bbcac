// turn_blocks.h - rotations between constraints, a block of places at a time; included by the files
// of the sets
//
// Every loop over a block is the same arithmetic for each place without a branch, which compilers
// turn into lanes. Nothing is fused, and roots and quotients are rounded as IEEE says: equal bits
// in every set. In single precision; src/world/reflect/rotation.c has it in double.
#include "core/kernel/kernels.h"

#include <math.h>

#define PLACE_INLINE static inline __attribute__((always_inline))

static void turn_sum(float m[9][TURN_BLOCK], const float place[3][TURN_BLOCK],
                     const float (*constraint)[12], int n, float least)
{
    float total[TURN_BLOCK] = {0.0f};
    const float floor_of = least * least;
    for (int k = 0; k < 9; k++)
        for (int i = 0; i < TURN_BLOCK; i++)
            m[k][i] = 0.0f;
    for (int j = 0; j < n; j++) {
        const float *c = constraint[j];
        float weight[TURN_BLOCK];
        for (int i = 0; i < TURN_BLOCK; i++) {
            const float x = place[0][i] - c[0], y = place[1][i] - c[1], z = place[2][i] - c[2];
            const float square = x * x + y * y + z * z;
            weight[i] = floor_of / (square > floor_of ? square : floor_of);
            total[i] += weight[i];
        }
        for (int k = 0; k < 9; k++)
            for (int i = 0; i < TURN_BLOCK; i++)
                m[k][i] += weight[i] * c[3 + k];
    }
    for (int k = 0; k < 9; k++)
        for (int i = 0; i < TURN_BLOCK; i++)
            m[k][i] /= total[i];
}

// One rotation of Jacobi's method over axes p and q of a symmetric matrix, r being the third.
PLACE_INLINE void turn_annihilate(float *pp, float *qq, float *pq, float *rp, float *rq,
                                  float vp[3], float vq[3])
{
    const float apart = *qq - *pp, twice = 2.0f * *pq;
    const float size = fabsf(apart) + sqrtf(apart * apart + twice * twice) + 1e-30f;
    const float t = (apart < 0.0f ? -twice : twice) / size;
    const float c = 1.0f / sqrtf(1.0f + t * t), s = t * c;
    const float p = *rp, q = *rq;
    *pp -= t * *pq;
    *qq += t * *pq;
    *pq = 0.0f;
    *rp = c * p - s * q;
    *rq = s * p + c * q;
    for (int k = 0; k < 3; k++) {
        const float a = vp[k], b = vq[k];
        vp[k] = c * a - s * b;
        vq[k] = s * a + c * b;
    }
}

PLACE_INLINE void turn_cross(float out[3], const float a[3], const float b[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

PLACE_INLINE float turn_dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The unit eigenvector of the largest eigenvalue of m^T m.
PLACE_INLINE void turn_first_axis(float v[3], const float m[9])
{
    enum { SWEEPS = 4 };  // single precision is there after three
    float x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
    float a = m[0] * m[0] + m[3] * m[3] + m[6] * m[6], b = m[1] * m[1] + m[4] * m[4] + m[7] * m[7];
    float c = m[2] * m[2] + m[5] * m[5] + m[8] * m[8], ab = m[0] * m[1] + m[3] * m[4] + m[6] * m[7];
    float ac = m[0] * m[2] + m[3] * m[5] + m[6] * m[8],
          bc = m[1] * m[2] + m[4] * m[5] + m[7] * m[8];
#pragma GCC unroll 4
    for (int i = 0; i < SWEEPS; i++) {
        turn_annihilate(&a, &b, &ab, &ac, &bc, x, y);
        turn_annihilate(&a, &c, &ac, &ab, &bc, x, z);
        turn_annihilate(&b, &c, &bc, &ab, &ac, y, z);
    }
    for (int k = 0; k < 3; k++) {
        const float two = b > a ? y[k] : x[k];
        v[k] = c > (b > a ? b : a) ? z[k] : two;
    }
    const float size = 1.0f / sqrtf(turn_dot(v, v));
    for (int k = 0; k < 3; k++)
        v[k] *= size;
}

// What the least rotation from v to u makes of w, which is across v; opposite ones: half a turn
// about x.
PLACE_INLINE void turn_least(float out[3], const float v[3], const float u[3], const float w[3],
                             const float x[3])
{
    float axis[3], moved[3];
    const float cosine = turn_dot(v, u), along_x = 2.0f * turn_dot(x, w);
    turn_cross(axis, v, u);
    turn_cross(moved, axis, w);
    const bool opposite = !(cosine > -1.0f + 1e-6f);
    const float along = turn_dot(axis, w) / (opposite ? 1.0f : 1.0f + cosine);
    for (int k = 0; k < 3; k++) {
        const float turned = cosine * w[k] + moved[k] + along * axis[k];
        out[k] = opposite ? along_x * x[k] - w[k] : turned;
    }
}

PLACE_INLINE void turn_nearest(float m[9])
{
    const float OPEN = 1e-5f;  // turns of this part of the first singular value are rounding
    float v[3], u[3], x[3], y[3], mx[3], my[3], ux[3], uy[3];
    turn_first_axis(v, m);
    for (int k = 0; k < 3; k++)
        u[k] = turn_dot(m + 3 * k, v);
    const float largest = sqrtf(turn_dot(u, u));
    const bool nothing = !(largest > 1e-18f);
    const float upright = fabsf(v[0]) < 0.7f ? 1.0f : 0.0f;
    // v x (1, 0, 0) or v x (0, 1, 0)
    x[0] = upright > 0.0f ? 0.0f : -v[2];
    x[1] = upright > 0.0f ? v[2] : 0.0f;
    x[2] = upright > 0.0f ? -v[1] : v[0];
    const float size = 1.0f / sqrtf(turn_dot(x, x));
    for (int k = 0; k < 3; k++) {
        x[k] *= size;
        u[k] = nothing ? v[k] : u[k] / largest;
    }
    turn_cross(y, v, x);
    for (int k = 0; k < 3; k++) {
        mx[k] = turn_dot(m + 3 * k, x);
        my[k] = turn_dot(m + 3 * k, y);
    }
    turn_least(ux, v, u, x, x);
    turn_least(uy, v, u, y, x);
    const float across = turn_dot(ux, mx) + turn_dot(uy, my) + OPEN * largest + 1e-30f;
    const float along = turn_dot(uy, mx) - turn_dot(ux, my);
    const float length = sqrtf(across * across + along * along) + 1e-30f;
    const float c = nothing ? 1.0f : across / length, s = nothing ? 0.0f : along / length;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            m[3 * i + k] =
                u[i] * v[k] + (c * ux[i] + s * uy[i]) * x[k] + (c * uy[i] - s * ux[i]) * y[k];
}

static void turn_rotation(float m[9][TURN_BLOCK])
{
    for (int i = 0; i < TURN_BLOCK; i++) {
        float one[9];
        for (int k = 0; k < 9; k++)
            one[k] = m[k][i];
        turn_nearest(one);
        for (int k = 0; k < 9; k++)
            m[k][i] = one[k];
    }
}
