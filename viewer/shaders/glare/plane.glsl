// A pattern of (size + 1)^2 texels with its middle at size / 2, looked up between them; false where
// it does not reach.
uniform int size;

bool plane_reaches(vec2 x)
{
    vec2 at = floor(float(size / 2) + x);
    return all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(size)));
}

float plane_lookup(vec2 x)
{
    vec2 at = float(size / 2) + x;
    ivec2 texel = ivec2(floor(at));
    vec2 part = at - vec2(texel);
    int i = texel.y * (size + 1) + texel.x;
    vec2 top = vec2(pattern[i], pattern[i + 1]);
    vec2 low = vec2(pattern[i + size + 1], pattern[i + size + 2]);
    vec2 mixed = mix(top, low, part.y);
    return mix(mixed.x, mixed.y, part.x);
}
