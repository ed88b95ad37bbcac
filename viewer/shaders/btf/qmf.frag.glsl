#version 330 core
// Full matrix factorisation in few bits. Twins: model_qmf.c, material/model/scalar.h.
#define OWN_BLEND
const bool view_grid = true, light_grid = true;
#include "btf/btf.glsl"

uniform usamplerBuffer array0;  // score [texels][bytes]
uniform usamplerBuffer array1;  // pattern [views][lights][bytes]
uniform usamplerBuffer array2;  // width [components][4]
uniform samplerBuffer array3;   // levels [components][4][3]
uniform samplerBuffer array4;   // color [3][3]

// The number of `bits` at a bit of the row that begins at a byte.
float number_at(usamplerBuffer bytes, int row, int at, int bits)
{
    int byte = row + (at >> 3);
    uint word = texelFetch(bytes, byte).r | texelFetch(bytes, byte + 1).r << 8 |
                texelFetch(bytes, byte + 2).r << 16;
    return float(word >> uint(at & 7) & ((1u << uint(bits)) - 1u));
}

// From -1 to 1. Twin: levels_value.
float step_at(usamplerBuffer bytes, int row, int at, int bits)
{
    return 2.0 * number_at(bytes, row, at, bits) / float((1 << bits) - 1) - 1.0;
}

// Middle, linear, cubic.
vec3 levels_of(int plane)
{
    return vec3(texelFetch(array3, 3 * plane).r, texelFetch(array3, 3 * plane + 1).r,
                texelFetch(array3, 3 * plane + 2).r);
}

float value_of(vec3 curve, float t)
{
    return curve.x + t * (curve.y + curve.z * t * t);
}

// Of the lights around, under one view. Written out, as in btf_pairs.glsl.
float of_view(vec3 curve, ivec3 row, int at, int bits, Blend l)
{
#ifdef SKY
    return value_of(curve, step_at(array1, row.x, at, bits));
#else
    return l.weight.x * value_of(curve, step_at(array1, row.x, at, bits)) +
           l.weight.y * value_of(curve, step_at(array1, row.y, at, bits)) +
           l.weight.z * value_of(curve, step_at(array1, row.z, at, bits));
#endif
}

// One colour of a pattern; `at` moves on to the next.
float pattern(int plane, inout int at, Blend v, Blend l)
{
    vec3 curve = levels_of(plane);
    int bits = int(texelFetch(array2, plane).r), from = at;
    at += bits;
    if (bits == 0)
        return curve.x;
    int row_bytes = textureSize(array1) / (counts.x * counts.y), view = counts.y * row_bytes;
    ivec3 row = l.index * row_bytes;
    return v.weight.x * of_view(curve, row + v.index.x * view, from, bits, l) +
           v.weight.y * of_view(curve, row + v.index.y * view, from, bits, l) +
           v.weight.z * of_view(curve, row + v.index.z * view, from, bits, l);
}

vec3 model_blend(int texel, Blend v, Blend l)
{
    int row = texel * (textureSize(array0) / area), score_at = 0, pattern_at = 0;
    vec3 sum = vec3(0.0);
    for (int plane = 0; plane < 4 * counts.z; plane += 4) {
        int bits = int(texelFetch(array2, plane).r);
        float score = levels_of(plane).x;
        if (bits > 0)
            score = value_of(levels_of(plane), step_at(array0, row, score_at, bits));
        score_at += bits;
        sum.x += score * pattern(plane + 1, pattern_at, v, l);
        sum.y += score * pattern(plane + 2, pattern_at, v, l);
        sum.z += score * pattern(plane + 3, pattern_at, v, l);
    }
    vec3 rgb = vec3(0.0);
    for (int c = 0; c < 9; c++)
        rgb[c % 3] += texelFetch(array4, c).r * sum[c / 3];
    return rgb;
}
