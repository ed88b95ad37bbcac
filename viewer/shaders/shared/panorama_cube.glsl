// A cube: its faces side by side. After cube and panorama_layout.
vec3 face_ray(int face, vec2 position)
{
    float side = float(textureSize(view, 0).y);
    return cube_face_ray(face, vec2(2.0 * position.x / side - 1.0, 1.0 - 2.0 * position.y / side));
}

// Position within the face, which is handed back beside it: exact on the rims.
int cube_pixel(out vec2 xy, vec3 d)
{
    int face = cube_face_of(d);
    float ahead = dot(d, face_ahead[face]);
    vec2 ab = vec2(dot(d, face_right[face]), -dot(d, face_up[face])) / ahead;
    xy = (0.5 + 0.5 * ab) * float(textureSize(view, 0).y);
    return face;
}

vec4 across_edge(int face, int x, int y)
{
    int side = textureSize(view, 0).y;
    vec2 xy;
    int other = cube_pixel(xy, face_ray(face, vec2(x, y) + 0.5));
    ivec2 at = clamp(ivec2(xy), ivec2(0), ivec2(side - 1));
    return fetch(other * side + at.x, at.y);
}

vec4 panorama_texel(int face, int x, int y)
{
    int side = textureSize(view, 0).y;
    ivec2 at = ivec2(x, y);
    ivec2 inner = clamp(at, ivec2(0), ivec2(side - 1));
    if (at == inner)
        return fetch(face * side + x, y);
    if (x == inner.x || y == inner.y)
        return across_edge(face, x, y);
    return (fetch(face * side + inner.x, inner.y) + across_edge(face, x, inner.y) +
            across_edge(face, inner.x, y)) / 3.0;
}

float panorama_texels(vec3 d, vec3 move)
{
    int face = cube_face_of(d);
    float ahead = dot(d, face_ahead[face]);
    vec3 beside = move - dot(move, face_ahead[face]) / ahead * d;
    vec2 ab = vec2(dot(beside, face_right[face]), dot(beside, face_up[face]));
    return 0.5 * float(textureSize(view, 0).y) * length(ab) / ahead;
}

bool panorama_pixel(out vec2 xy, out int face, vec3 d)
{
    face = cube_pixel(xy, d);
    return true;
}
