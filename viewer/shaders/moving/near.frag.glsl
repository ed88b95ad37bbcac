#version 330 core
// A near light whose shadows move. Twin: add_near_pixel of src/relight/shadow/shadows.c.
#include "moving/stage.glsl"
#include "moving/shown.glsl"
#include "texels.glsl"
#include "shared/cube.glsl"
#include "light/light.glsl"
#include "light/light_patches.glsl"
#include "light/captured.glsl"
#include "light/triangles.glsl"

uniform sampler2D colours;    // of the view; black: nothing is known
uniform sampler2D matte;      // a, b
uniform sampler2D positions;  // where the pixel's surface is in the world; alpha 0: nowhere
uniform sampler2D lights;     // of captured lights: direction
uniform mat4 turn_back;       // a direction of the world in the view

#include "shared/moving.glsl"
#include "shared/near_shadow.glsl"

vec3 turned_back(vec3 towards)
{
    return mat3(turn_back) * towards;
}

void main()
{
    at = ivec2(gl_FragCoord.xy) + origin;
    vec4 point = texelFetch(positions, at, 0);
    vec3 colour = texelFetch(colours, at, 0).rgb, towards, arriving;
    vec3 lit = vec3(0.0), between = vec3(0.0), relit = relit_here();
    model = texelFetch(matte, at, 0);
    if (point.a > 0.0 && colour != vec3(0.0)) {
        if (patches == 0 && light_at(towards, arriving, point.xyz))
            add_near(lit, between, arriving, colour, towards, length(light.position - point.xyz),
                     -1);
        for (int i = 0; i < patches; i++)
            if (patch_at(towards, arriving, i, point.xyz)) {
                vec3 from = texelFetch(picture, ivec2(i, 0), 0).xyz;
                add_near(lit, between, arriving, colour, towards, length(from - point.xyz), i);
            }
    }
    vec3 rest = relit - rgb * between;
    show_in_place_of(relit, (RAYS >= CYLINDER ? max(rest, 0.0) : rest) + rgb * lit);
}
