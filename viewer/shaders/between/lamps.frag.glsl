#version 330 core
// What a light sample shows a white matte surface where the scene is: those let through by what is
// captured, and all, without the objects and with them. Twin:
// exchange_lamps_at of src/world/object/exchange_lamps.c.
#include "texels.glsl"
#include "shared/cube.glsl"
#include "light/light.glsl"
#include "light_sample.glsl"
#include "shadow.glsl"
uniform sampler2D scene, scene_facing;  // alpha 0: nothing is there
uniform vec3 centre;                    // the eye that captured it
uniform sampler2DArrayShadow captured;  // as shadow.glsl has it of the objects
uniform mat4 captured_clip[6];
uniform int captured_layers;
uniform vec4 captured_light;
uniform float captured_texel;
layout(location = 0) out vec4 let_without;
layout(location = 1) out vec4 let_with;
layout(location = 2) out vec4 all_without;
layout(location = 3) out vec4 all_with;

const float OFF = 0.005;  // of the distance from the eye: depth may be wrong by so much

// Twin: scenery_reached.
float let_through(vec3 point, vec3 normal)
{
    if (captured_layers == 0)
        return 1.0;
    vec3 from = point - captured_light.xyz;
    float texel = captured_texel * (captured_light.w > 0.0 ? length(from) : 1.0);
    int layer = captured_layers == 1 ? 0 : cube_face_of(from);
    vec4 clip = captured_clip[layer] *
                vec4(point + (OFF * distance(point, centre) + 2.0 * texel) * normal, 1.0);
    vec3 at = 0.5 * clip.xyz / clip.w + 0.5;
    if (clip.w <= 0.0 || any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0))))
        return 1.0;
    return texture(captured, vec4(at.xy, float(layer), clamp(at.z, 0.0, 1.0)));
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 point = texelFetch(scene, pixel, 0);
    vec3 normal = texelFetch(scene_facing, pixel, 0).xyz, towards, rgb;
    if (point.a == 0.0 || !sample_at(towards, rgb, point.xyz))
        discard;
    float cosine = dot(towards, normal);
    if (cosine <= 0.0)
        discard;
    bool held = point.a > 1.5;  // a place of the objects themselves
    float let_share = let_through(point.xyz, normal), seen = reached(point.xyz, held ? normal : vec3(0.0));
    all_without = vec4(cosine * rgb, 1.0);
    all_with = seen * all_without;
    let_without = let_share * all_without;
    let_with = let_share * all_with;
}
