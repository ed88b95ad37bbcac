// A cylinder with end discs. After panorama. Twin: src/relight/view/panorama_discs.c.
uniform float disc;  // side of a disc's square in the rows below the cylinder

float panorama_rows()
{
    return float(textureSize(view, 0).y) - disc;
}

vec4 cylinder_texel(int x, int y)
{
    return fetch(wrap_index(x, textureSize(view, 0).x), clamp(y, 0, int(panorama_rows()) - 1));
}

vec4 cylinder_bilinear(vec2 position)
{
    ivec2 at = ivec2(floor(position));
    vec2 part = position - vec2(at);
    vec4 top = mix(cylinder_texel(at.x, at.y), cylinder_texel(at.x + 1, at.y), part.x);
    vec4 bottom = mix(cylinder_texel(at.x, at.y + 1), cylinder_texel(at.x + 1, at.y + 1), part.x);
    return mix(top, bottom, part.y);
}

float height_of(bool lower)
{
    return lower ? elevation.x : elevation.y;
}

vec3 square_ray(bool lower, vec2 position)
{
    float right = 2.0 * position.x / disc - 1.0;
    float up = 1.0 - 2.0 * position.y / disc;
    return vec3(right, height_of(lower), lower ? -up : up);
}

vec2 square_pixel(bool lower, vec3 d)
{
    vec2 ab = height_of(lower) / d.y * vec2(d.x, lower ? d.z : -d.z);
    return (0.5 + 0.5 * ab) * disc;
}

vec2 cylinder_position(vec3 d, float h)
{
    float down = (elevation.y - h) / (elevation.y - elevation.x);
    return vec2(azimuth_column(d), down * panorama_rows());
}

vec4 cylinder_value(vec3 d)
{
    return cylinder_bilinear(cylinder_position(d, d.y / length(d.xz)) - 0.5);
}

vec4 disc_texel(bool lower, int x, int y)
{
    vec3 d = square_ray(lower, vec2(x, y) + 0.5);
    if (dot(d.xz, d.xz) > 1.0)
        return cylinder_value(d);
    return fetch(lower ? int(disc) + x : x, int(panorama_rows()) + y);
}

vec4 disc_value(bool lower, vec2 position)
{
    ivec2 at = ivec2(floor(position - 0.5));
    vec2 part = position - 0.5 - vec2(at);
    vec4 top = mix(disc_texel(lower, at.x, at.y), disc_texel(lower, at.x + 1, at.y), part.x);
    vec4 bottom = mix(disc_texel(lower, at.x, at.y + 1), disc_texel(lower, at.x + 1, at.y + 1),
                      part.x);
    return mix(top, bottom, part.y);
}

float panorama_texels(vec3 d, vec3 move)
{
    float square = dot(d.xz, d.xz);
    float h = d.y / sqrt(square);
    if (!(h >= elevation.x && h <= elevation.y)) {
        float scale = 0.5 * disc * height_of(d.y < 0.0) / d.y;
        return length(scale * (move.xz - move.y / d.y * d.xz));
    }
    float turn = (d.x * move.z - d.z * move.x) / square;
    float rise = move.y / sqrt(square) - h * dot(d.xz, move.xz) / square;
    return length(vec2(turn * float(textureSize(view, 0).x) / (2.0 * PI),
                       rise * panorama_rows() / (elevation.y - elevation.x)));
}

// Of the cylinder's outermost half row, `part` of which lies between the rim and the position.
vec4 rim_sample(vec3 d, float x, bool lower, float part)
{
    vec3 at = vec3(d.xz / length(d.xz), height_of(lower)).xzy;
    vec4 rim = disc_value(lower, square_pixel(lower, at));
    vec4 row = cylinder_bilinear(vec2(x - 0.5, lower ? panorama_rows() - 1.0 : 0.0));
    return mix(rim, row, part);
}

vec4 panorama_sample(vec3 d)
{
    float h = d.y / length(d.xz);
    if (!(h >= elevation.x && h <= elevation.y)) {
        bool lower = d.y < 0.0;
        return disc_value(lower, square_pixel(lower, d));
    }
    vec2 xy = cylinder_position(d, h);
    float from_rim = min(xy.y, panorama_rows() - xy.y);
    if (from_rim < 0.5)
        return rim_sample(d, xy.x, h < 0.0, 2.0 * from_rim);
    return cylinder_bilinear(xy - 0.5);
}
