#version 330 core
// What stands nearest in each pixel, and the scene behind it: places and normals. Twin: find_layers
// of src/world/object/exchange.c.
#include "between/scene_normal.glsl"
uniform sampler2D objects, normals;  // of objects, `grid` times finer
uniform sampler2D back;              // depth of their backs; 0: not known
uniform int grid;
uniform vec4 eye;
layout(location = 0) out vec4 scene_facing;  // unit, towards the eye
layout(location = 1) out vec4 place;         // 0 nothing, 1 the scene, 2 objects
layout(location = 2) out vec4 facing;        // unit; depth of the back

const float NEVER = 1e30;

float depth_of(vec3 point)
{
    return eye.w > 0.0 ? distance(point, eye.xyz) : -dot(point, eye.xyz);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 behind = texelFetch(scene, pixel, 0);
    vec3 to_eye = normalize(eye.xyz - eye.w * behind.xyz), normal = scene_normal(pixel);
    if (normal == vec3(0.0))
        normal = to_eye;
    normal = dot(normal, to_eye) < 0.0 ? -normal : normal;
    scene_facing = vec4(normal, 1.0);
    place = behind.a > 0.0 ? vec4(behind.xyz, 1.0) : vec4(0.0);
    facing = vec4(normal, NEVER);
    float nearest = behind.a > 0.0 ? depth_of(behind.xyz) : NEVER;
    for (int i = 0; i < grid * grid; i++) {
        ivec2 at = pixel * grid + ivec2(i % grid, i / grid);
        vec4 point = texelFetch(objects, at, 0);
        float depth = depth_of(point.xyz);
        if (point.w == 0.0 || depth >= nearest)
            continue;
        float other_side = texelFetch(back, pixel, 0).x;
        place = vec4(point.xyz, 2.0);
        facing = vec4(normalize(texelFetch(normals, at, 0).xyz), max(other_side, depth));
        return;
    }
}
