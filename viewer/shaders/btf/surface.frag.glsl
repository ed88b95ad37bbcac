#version 330 core
// What lighting a surface needs: its place and frame, the place in its texture, and
// what that grows by from pixel to pixel.
// Rows run down, so that what faces the eye is wound the other way round here. Twin: objects_hit.
#include "btf/skin.glsl"
in vec3 at_position, at_normal, at_tint;
in vec4 at_tangent;
in vec2 at_texture;
uniform int part;
uniform bool sends;
uniform int first;  // of the part's triangles, where it is a mirror; else -1
layout(location = 0) out vec4 place;      // position; part + 1, its sign the handedness
layout(location = 1) out vec4 normal_s;   // normal, s
layout(location = 2) out vec4 tangent_t;  // tangent, t
layout(location = 3) out vec4 footprint;  // (s, t) to the right, and down; of a mirror the
                                          // triangle's number
layout(location = 4) out vec4 tint;       // what the material's values are multiplied by
layout(location = 5) out vec4 emitted;    // what it sends of its own

void main()
{
    vec3 own = sends ? texture(skin, at_texture).rgb : vec3(0.0);
    if (!is_there(at_texture, float(2 * part + int(gl_FrontFacing))))
        discard;
    emitted = vec4(own, 1.0);
    float side = gl_FrontFacing ? -1.0 : 1.0;
    vec3 normal = side * normalize(at_normal);
    vec3 tangent = at_tangent.xyz - dot(at_tangent.xyz, normal) * normal;
    place = vec4(at_position, side * sign(at_tangent.w) * float(part + 1));
    normal_s = vec4(normal, at_texture.x);
    tangent_t = vec4(normalize(tangent), at_texture.y);
    tint = vec4(at_tint, 1.0);
    footprint = first < 0 ? vec4(dFdx(at_texture), dFdy(at_texture))
                          : vec4(float(first + gl_PrimitiveID), 0.0, 0.0, 0.0);
}
