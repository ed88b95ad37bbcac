#version 330 core
// What a pass shows of a relit view; twin of src/relight/normals/enhance.c, function by function.
#include "transfer.glsl"
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

float luminance(vec3 rgb)
{
    return dot(rgb, vec3(0.2126, 0.7152, 0.0722));
}

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
    Transfer srgb = Transfer(CURVE_SRGB, 1.0);
    return vec3(transfer_decode(srgb, code.r), transfer_decode(srgb, code.g),
                transfer_decode(srgb, code.b));
}

vec3 show_specular(ivec2 at, vec3 rgb)
{
    vec3 normal = vector_at(normals, at);
    vec3 eye = towards_given ? vector_at(towards, at) : vec3(0.0, 0.0, 1.0);
    for (int i = 0; i < lights; i++) {
        vec3 halfway = direction(i) + eye;
        float size = length(halfway);
        if (!(size > 1e-6))
            continue;
        float cosine = dot(normal, halfway) / size;
        float lobe = cosine > 0.0 ? range.w * strength.y * pow(cosine, strength.z) : 0.0;
        rgb += lobe * value(i);
    }
    return rgb;
}

vec3 show_diffuse_gain(ivec2 at, vec3 rgb)
{
    vec3 light = vec3(0.0);
    for (int i = 0; i < lights; i++)
        light += value(i);
    vec3 most = range.z * light * vector_at(albedos, at);
    return max(range.w * (most + strength.x * (rgb - most)), vec3(0.0));
}

vec3 show_unsharp(ivec2 at, vec3 rgb)
{
    vec3 detail = vector_at(details, at);
    vec3 change = vec3(0.0);
    for (int i = 0; i < lights; i++)
        change += strength.x * dot(detail, direction(i)) * value(i);
    return max(rgb + vector_at(albedos, at) * change, vec3(0.0));
}

vec3 show_false_colour(vec3 rgb)
{
    const vec3 steps[5] = vec3[5](vec3(0.00, 0.00, 0.10), vec3(0.15, 0.00, 0.35),
                                  vec3(0.65, 0.02, 0.10), vec3(0.95, 0.30, 0.00),
                                  vec3(1.00, 0.95, 0.30));
    if (!(luminance(rgb) > 1e-6))
        return vec3(0.0);
    float x = clamp(4.0 * (luminance(rgb) - range.x) / (range.y - range.x), 0.0, 4.0);
    int step = min(int(x), 3);
    return mix(steps[step], steps[step + 1], x - float(step));
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
        rgb = show_false_colour(rgb);
    else if (pass == DIFFERENCE)
        rgb = abs(rgb - vector_at(reference, at));
    color = vec4(rgb, 1.0);
}
