#version 330 core
// Letters and shapes of the panel (the texture says how much), or a picture in it.
uniform sampler2D texels;
uniform bool coloured;
in vec2 at;
in vec4 colour;
out vec4 color;

void main()
{
    vec4 texel = texture(texels, at);
    color = coloured ? vec4(texel.rgb, 1.0) * colour : vec4(colour.rgb, colour.a * texel.r);
}
