#version 330 core
// glTF's reflectance, with a normal for each texel. Twin: model_painted.c.
#define LOBES
const bool view_grid = false, light_grid = false;
#include "btf/btf.glsl"

uniform samplerBuffer array0;  // diffuse [texels]
uniform samplerBuffer array1;  // F0 [texels]
uniform samplerBuffer array2;  // normal; alpha [texels]
const float DIELECTRIC = 0.04;

// pi D V. Twin: microfacets of model_painted.c.
float microfacets(float alpha, float nh, float nv, float nl)
{
    float square = alpha * alpha, d = nh * nh * (square - 1.0) + 1.0;
    float shadowed =
        nl * sqrt(square + (1.0 - square) * nv * nv) + nv * sqrt(square + (1.0 - square) * nl * nl);
    return 0.5 * square / (d * d * max(shadowed, 1e-9));
}

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    vec4 shape = texelFetch(array2, texel);
    vec3 n = normalize(shape.xyz), h = normalize(v + l);
    vec3 diffuse = texelFetch(array0, texel).rgb, f0 = texelFetch(array1, texel).rgb;
    float nl = dot(n, l);
    if (nl <= 0.0)
        return vec3(0.0);
    float grazing = pow(max(1.0 - dot(v, h), 0.0), 5.0);
    float lobe = microfacets(shape.w, max(dot(n, h), 0.0), max(dot(n, v), 1e-3), nl);
    return nl * ((1.0 - DIELECTRIC) * (1.0 - grazing) * diffuse +
                 lobe * (f0 + (1.0 - f0) * grazing));
}

#ifdef SKY
// Of even light the microfacets send back F0 x + y. Twin: sent_back of model_painted.c.
vec2 sent_back(float roughness, float nv)
{
    vec4 r = vec4(1.0 - roughness, 0.0425 - 0.0275 * roughness, 1.04 - 0.572 * roughness,
                  0.022 * roughness - 0.04);
    float a = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
    return vec2(-1.04, 1.04) * a + r.zw;
}

// Twin: lit of model_painted.c.
vec3 model_lit(int texel, int view, vec3 v, mat3 frame)
{
    vec4 shape = texelFetch(array2, texel);
    vec3 n = normalize(shape.xyz);
    vec3 diffuse = texelFetch(array0, texel).rgb, f0 = texelFetch(array1, texel).rgb;
    vec3 r = reflect(-v, n);
    r = normalize(vec3(r.xy, max(r.z, 1e-3)));
    vec2 part = sent_back(sqrt(shape.w), max(dot(n, v), 1e-3));
    float exponent = max((2.0 / (shape.w * shape.w) - 2.0) / 4.0, 1.0);
    return (1.0 - DIELECTRIC * part.x - part.y) * diffuse * sky_lobe(frame, n, 1.0, false) +
           (f0 * part.x + part.y) * sky_specular(frame * r, exponent);
}
#endif
