#version 330 core
// Triangles of the panel, in pixels from the frame's top left corner; the screen's first row is
// the lowest.
uniform vec2 frame_size;
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 texture_position;
layout(location = 2) in vec4 tint;
out vec2 at;
out vec4 colour;

void main()
{
    at = texture_position;
    colour = tint;
    gl_Position = vec4(2.0 * position.x / frame_size.x - 1.0,
                       1.0 - 2.0 * position.y / frame_size.y, 0.0, 1.0);
}
