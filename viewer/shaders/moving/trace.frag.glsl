#version 330 core
// How many quarters of a pixel a distant light reaches, of a rectangle of a view and a border of
// one pixel around it. Twin: trace_row of src/shadow/shadows.c.
#include "moving/stage.glsl"

uniform vec3 direction;  // of the view
uniform ivec2 origin;    // of the rectangle in the view
out vec4 color;

void main()
{
    ivec2 size = textureSize(surface, 0), at = ivec2(gl_FragCoord.xy) + origin - 1;
    at.x = RAYS >= CYLINDER ? (at.x + size.x) % size.x : clamp(at.x, 0, size.x - 1);
    at.y = clamp(at.y, 0, size.y - 1);
    int arrives = 0;
    for (int i = 0; i < 4; i++) {
        vec3 point;
        if (!stage_point(point, vec2(at) + vec2((i & 1) != 0 ? 0.75 : 0.25,
                                                (i & 2) != 0 ? 0.75 : 0.25)) ||
            stage_reaches(point, direction))
            arrives++;
    }
    color = vec4(float(arrives) / 255.0);
}
