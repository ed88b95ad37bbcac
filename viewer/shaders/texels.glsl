// Bilinear value at a position in texels (centres at +0.5); the border repeats.
vec3 texels_fetch(sampler2D view, ivec2 at)
{
    return texelFetch(view, clamp(at, ivec2(0), textureSize(view, 0) - 1), 0).rgb;
}

vec3 texels_bilinear(sampler2D view, vec2 position)
{
    vec2 p = position - 0.5;
    ivec2 at = ivec2(floor(p));
    vec2 part = p - vec2(at);
    vec3 top = mix(texels_fetch(view, at), texels_fetch(view, at + ivec2(1, 0)), part.x);
    vec3 bottom = mix(texels_fetch(view, at + ivec2(0, 1)), texels_fetch(view, at + ivec2(1, 1)),
                      part.x);
    return mix(top, bottom, part.y);
}
