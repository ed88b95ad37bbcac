// What a panorama shows when its image is one layout of texels, which a file behind this one
// defines.
#define PANORAMA_LAYOUT
// False when the panorama does not show that direction. `face`: of a cube.
bool panorama_pixel(out vec2 xy, out int face, vec3 direction);
vec4 panorama_texel(int face, int x, int y);

vec4 panorama_sample(vec3 direction)
{
    vec2 xy;
    int face;
    if (!panorama_pixel(xy, face, direction))
        return vec4(0.0);
    ivec2 at = ivec2(floor(xy - 0.5));
    vec2 part = xy - 0.5 - vec2(at);
    vec4 top = mix(panorama_texel(face, at.x, at.y), panorama_texel(face, at.x + 1, at.y), part.x);
    vec4 bottom = mix(panorama_texel(face, at.x, at.y + 1),
                      panorama_texel(face, at.x + 1, at.y + 1), part.x);
    return mix(top, bottom, part.y);
}
