#version 330 core
// How many quarters of a pixel a distant light reaches, of a rectangle of a view and a border of
// one pixel around it. Twin: trace_row of src/relight/shadow/shadows.c.
#include "moving/stage.glsl"

uniform vec3 direction;  // of the view
uniform ivec2 origin;    // of the rectangle in the view
out vec4 color;

void main()
{
    ivec2 size = textureSize(surface, 0), at = ivec2(gl_FragCoord.xy) + origin - 1;
    at.x = RAYS >= CYLINDER ? (at.x + size.x) % size.x : clamp(at.x, 0, size.x - 1);
    at.y = clamp(at.y, 0, size.y - 1);
    color = vec4(float(quarters_reached(at, direction, BACKGROUND)) / 255.0);
}
