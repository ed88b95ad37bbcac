#version 330 core
// What a pass shows of a relit view. Twin: src/relight/normals/enhance.c.
#include "transfer.glsl"
#include "shared/luminance.glsl"
#include "shared/enhance.glsl"
uniform sampler2D view;
uniform sampler2D normals;
uniform sampler2D albedos;
uniform sampler2D details;
uniform sampler2D towards;    // unit vectors to the viewer
uniform sampler2D reference;
uniform int pass;             // enum relume_pass
uniform bool towards_given;   // else +z
uniform int lights;
uniform sampler2D light_rows;      // 512 lights in two rows: unit directions, values; then the next ones
uniform vec4 strength;        // gain, specular, exponent
uniform vec4 range;           // struct relume_pass_range
uniform int step_of;          // every so many pixels of the view are drawn
out vec4 color;

const int NORMALS = 1;
const int SPECULAR = 2;
const int DIFFUSE_GAIN = 3;
const int UNSHARP = 4;
const int LUMINANCE = 5;
const int FALSE_COLOUR = 6;
const int DIFFERENCE = 7;

vec3 vector_at(sampler2D image, ivec2 at)
{
    return texelFetch(image, at, 0).rgb;
}

vec3 direction(int light)
{
    return vector_at(light_rows, ivec2(light & 511, 2 * (light >> 9)));
}

vec3 value(int light)
{
    return vector_at(light_rows, ivec2(light & 511, 2 * (light >> 9) + 1));
}

// As codes (n + 1) / 2 once the screen's curve is applied; black where there is no normal.
vec3 show_normals(ivec2 at)
{
    vec3 normal = vector_at(normals, at);
    vec3 code = normal == vec3(0.0) ? vec3(0.0) : 0.5 * normal + 0.5;
    return transfer_decode(Transfer(CURVE_SRGB, 1.0), code);
}

vec3 show_specular(ivec2 at, vec3 rgb)
{
    vec3 normal = vector_at(normals, at);
    vec3 eye = towards_given ? vector_at(towards, at) : vec3(0.0, 0.0, 1.0);
    for (int i = 0; i < lights; i++) {
        float lobe = specular_lobe(normal, direction(i) + eye, strength.z);
        rgb += range.w * strength.y * lobe * value(i);
    }
    return rgb;
}

vec3 show_diffuse_gain(ivec2 at, vec3 rgb)
{
    vec3 light = vec3(0.0);
    for (int i = 0; i < lights; i++)
        light += value(i);
    return diffuse_gain(rgb, range.z * light * vector_at(albedos, at), strength.x, range.w);
}

vec3 show_unsharp(ivec2 at, vec3 rgb)
{
    vec3 detail = vector_at(details, at);
    vec3 change = vec3(0.0);
    for (int i = 0; i < lights; i++)
        change += strength.x * dot(detail, direction(i)) * value(i);
    return max(rgb + vector_at(albedos, at) * change, vec3(0.0));
}

void main()
{
    ivec2 at = step_of * ivec2(gl_FragCoord.xy);
    vec3 rgb = texelFetch(view, at, 0).rgb;
    if (pass == NORMALS)
        rgb = show_normals(at);
    else if (pass == SPECULAR)
        rgb = show_specular(at, rgb);
    else if (pass == DIFFUSE_GAIN)
        rgb = show_diffuse_gain(at, rgb);
    else if (pass == UNSHARP)
        rgb = show_unsharp(at, rgb);
    else if (pass == LUMINANCE)
        rgb = vec3(luminance(rgb));
    else if (pass == FALSE_COLOUR)
        rgb = false_colour(rgb, range.xy);
    else if (pass == DIFFERENCE)
        rgb = abs(rgb - vector_at(reference, at));
    color = vec4(rgb, 1.0);
}
