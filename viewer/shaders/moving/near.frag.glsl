#version 330 core
// A near light whose shadows move: every pixel has a direction of its own, and captured lights of
// its own around it. Twins: add_near_pixel and what it calls, of src/relight/shadow/shadows.c.
#include "moving/stage.glsl"
#include "moving/shown.glsl"
#include "texels.glsl"
#include "cube.glsl"
#include "light/light.glsl"
#include "light/light_patches.glsl"
#include "light/captured.glsl"
#include "light/triangles.glsl"

uniform sampler2D colours;    // of the view; black: nothing is known
uniform sampler2D matte;      // a, b
uniform sampler2D positions;  // where the pixel's surface is in the world; alpha 0: nowhere
uniform sampler2D lights;     // of captured lights: direction
uniform mat4 turn_back;       // a direction of the world in the view
const int SIDE = 4;           // of an area light's patches
const int ASKED = 16;         // captured lights that a pixel remembers

ivec2 at;
vec4 model;
int asked[ASKED], remembered;
float answer[ASKED];

float shadows_matte(vec3 light)
{
    return max(model.x + dot(model.yzw, light), 0.0);
}

float quarter_share(vec3 towards, float distance)
{
    return 0.25 * float(quarters_reached(at, mat3(turn_back) * towards, distance));
}

// What a captured light shows of the pixel. Patches ask for the same ones again.
float know(int light)
{
    for (int i = 0; i < remembered; i++)
        if (asked[i] == light)
            return answer[i];
    vec3 from = texelFetch(lights, ivec2(light, 0), 0).xyz;
    float known = quarter_share(from, BACKGROUND) * shadows_matte(from);
    if (remembered < ASKED) {
        asked[remembered] = light;
        answer[remembered++] = known;
    }
    return known;
}

float near_share(vec3 towards, float distance, int index)
{
    if (patches == 0)
        return quarter_share(towards, distance);
    int quarter = (index + index / SIDE) & 3;
    return quarter_reached(at, quarter, mat3(turn_back) * towards, distance) ? 1.0 : 0.0;
}

void add(inout vec3 lit, inout vec3 between, vec3 arriving, vec3 colour, vec3 towards,
         float distance, int index)
{
    float share;
    vec3 from = captured(towards, share), weight, codes = vec3(0.0);
    ivec3 node;
    triangles_find(node, weight, pole_from_world(from));
    for (int i = 0; i < 3; i++)
        if (weight[i] > 0.0)
            codes += weight[i] * encoded(colour * know(node[i]));
    lit += share * arriving * colour * near_share(towards, distance, index) * shadows_matte(from);
    between += share * arriving * decoded(display, codes);
}

void main()
{
    at = ivec2(gl_FragCoord.xy) + origin;
    vec4 point = texelFetch(positions, at, 0);
    vec3 colour = texelFetch(colours, at, 0).rgb, towards, arriving;
    vec3 lit = vec3(0.0), between = vec3(0.0), relit = relit_here();
    model = texelFetch(matte, at, 0);
    remembered = 0;
    if (point.a > 0.0 && colour != vec3(0.0)) {
        if (patches == 0 && light_at(towards, arriving, point.xyz))
            add(lit, between, arriving, colour, towards, length(light.position - point.xyz), 0);
        for (int i = 0; i < patches; i++)
            if (patch_at(towards, arriving, i, point.xyz)) {
                vec3 from = texelFetch(picture, ivec2(i, 0), 0).xyz;
                add(lit, between, arriving, colour, towards, length(from - point.xyz), i);
            }
    }
    vec3 rest = relit - rgb * between;
    show_in_place_of(relit, (RAYS >= CYLINDER ? max(rest, 0.0) : rest) + rgb * lit);
}
