#version 330 core
// What one lamp alone shows of a scene, where no object keeps it off.
#include "cube.glsl"
#include "shadow.glsl"
uniform sampler2D scene;  // positions
uniform sampler2D lone;
out vec4 color;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float seen = reached(texelFetch(scene, pixel, 0).xyz, vec3(0.0));
    color = vec4(seen * texelFetch(lone, pixel, 0).rgb, 1.0);
}
