#version 330 core
// A map of depths alone, of what is there.
#include "btf/skin.glsl"
in vec2 at_texture;
uniform int part;

void main()
{
    if (!is_there(at_texture, float(2 * part + int(gl_FrontFacing))))
        discard;
}
