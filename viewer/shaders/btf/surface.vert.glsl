#version 330 core
// Objects as the eye, or a light sample, sees them.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 texture_at;
layout(location = 4) in vec3 tint;
uniform mat4 clip;
out vec3 at_position, at_normal, at_tint;
out vec4 at_tangent;
out vec2 at_texture;

void main()
{
    at_position = position;
    at_normal = normal;
    at_tangent = tangent;
    at_texture = texture_at;
    at_tint = tint;
    gl_Position = clip * vec4(position, 1.0);
}
