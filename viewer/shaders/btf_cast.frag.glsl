#version 330 core
// What one lamp alone shows of a scene, where no object keeps it off.
#include "cube.glsl"
#include "shadow.glsl"
uniform sampler2D scene;  // positions
uniform sampler2D lone;
uniform float weight;  // of the lamp among those of its light
out vec4 color;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 point = texelFetch(scene, pixel, 0);
    float seen = point.a > 0.0 ? reached(point.xyz, vec3(0.0)) : 1.0;
    color = vec4(weight * seen * texelFetch(lone, pixel, 0).rgb, 1.0);
}
