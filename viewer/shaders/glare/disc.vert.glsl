#version 330 core
// A disc of the eye's aperture (relume_eye_disc) in the square texture, with a texel around it.
layout(location = 0) in vec4 disc;  // x, y, radius in mm, opacity
uniform vec2 texture_size;          // texels, and of one millimetre
flat out vec4 shape;                // middle and radius in texels, opacity

void main()
{
    float middle = 0.5 * texture_size.x + 0.5;
    shape = vec4(middle + texture_size.y * disc.x, middle - texture_size.y * disc.y,
                 texture_size.y * disc.z, disc.w);
    vec2 corner = 2.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0;
    vec2 at = shape.xy + corner * (shape.z + 1.0);
    gl_Position = vec4(2.0 * at / texture_size.x - 1.0, 0.0, 1.0);
}
