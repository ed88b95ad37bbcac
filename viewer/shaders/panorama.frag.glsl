#version 330 core
// A look into a panorama; twin of src/view/panorama.c, function by function.
uniform sampler2D view;
uniform int projection;      // enum relume_projection
uniform vec2 elevation;      // cylinder: v_min, v_max
uniform vec3 look;           // pan and tilt in radians, 1 / zoom
uniform bool stereographic;
uniform vec2 look_size;      // pixels of the frame
uniform float exposure;
out vec4 color;

const int CYLINDRICAL = 2;
const int CUBE = 4;
const float PI = 3.14159265358979;

// The faces of a cube: ahead, right = ahead x up, up; +x -x +y -y +z -z.
const vec3 face_ahead[6] = vec3[6](vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0),
                                   vec3(0, 0, 1), vec3(0, 0, -1));
const vec3 face_right[6] = vec3[6](vec3(0, 0, 1), vec3(0, 0, -1), vec3(1, 0, 0), vec3(1, 0, 0),
                                   vec3(-1, 0, 0), vec3(1, 0, 0));
const vec3 face_up[6] = vec3[6](vec3(0, 1, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(0, 0, -1),
                                vec3(0, 1, 0), vec3(0, 1, 0));

vec3 look_ray(vec3 l, vec2 size, vec2 position)
{
    float a = (2.0 * position.x / size.x - 1.0) * l.z;
    float b = (size.y - 2.0 * position.y) / size.x * l.z;
    float depth = stereographic ? 0.5 * (1.0 - a * a - b * b) : 1.0;
    float up = b * cos(l.y) + depth * sin(l.y);
    float ahead = depth * cos(l.y) - b * sin(l.y);
    return vec3(a * cos(l.x) + ahead * sin(l.x), up, a * sin(l.x) - ahead * cos(l.x));
}

vec3 fetch(int x, int y)
{
    return texelFetch(view, ivec2(x, y), 0).rgb;
}

int wrap_index(int i, int n)
{
    return i < 0 ? i + n : i >= n ? i - n : i;
}

float azimuth_column(vec3 d)
{
    return (atan(d.x, -d.z) + PI) / (2.0 * PI) * float(textureSize(view, 0).x);
}

bool cylinder_pixel(out vec2 xy, vec3 d)
{
    float h = d.y / length(d.xz);
    if (!(h >= elevation.x && h <= elevation.y))
        return false;
    float down = (elevation.y - h) / (elevation.y - elevation.x);
    xy = vec2(azimuth_column(d), down * float(textureSize(view, 0).y));
    return true;
}

vec3 cylinder_texel(int x, int y)
{
    ivec2 size = textureSize(view, 0);
    return fetch(wrap_index(x, size.x), clamp(y, 0, size.y - 1));
}

bool sphere_pixel(out vec2 xy, vec3 d)
{
    float down = 0.5 - atan(d.y, length(d.xz)) / PI;
    xy = vec2(azimuth_column(d), down * float(textureSize(view, 0).y));
    return true;
}

vec3 sphere_texel(int x, int y)
{
    ivec2 size = textureSize(view, 0);
    int column = wrap_index(x, size.x);
    if (y >= 0 && y < size.y)
        return fetch(column, y);
    int row = clamp(y, 0, size.y - 1);
    return 0.5 * (fetch(wrap_index(column + size.x / 2, size.x), row) +
                  fetch(wrap_index(column + (size.x + 1) / 2, size.x), row));
}

int cube_face_of(vec3 d)
{
    vec3 a = abs(d);
    if (a.x >= a.y && a.x >= a.z)
        return d.x >= 0.0 ? 0 : 1;
    if (a.y >= a.z)
        return d.y >= 0.0 ? 2 : 3;
    return d.z >= 0.0 ? 4 : 5;
}

vec3 face_ray(int face, vec2 position)
{
    float side = float(textureSize(view, 0).y);
    vec2 ab = vec2(2.0 * position.x / side - 1.0, 1.0 - 2.0 * position.y / side);
    return face_ahead[face] + ab.x * face_right[face] + ab.y * face_up[face];
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

vec3 across_edge(int face, int x, int y)
{
    int side = textureSize(view, 0).y;
    vec2 xy;
    int other = cube_pixel(xy, face_ray(face, vec2(x, y) + 0.5));
    ivec2 at = clamp(ivec2(xy), ivec2(0), ivec2(side - 1));
    return fetch(other * side + at.x, at.y);
}

vec3 cube_texel(int face, int x, int y)
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

vec3 panorama_texel(int face, int x, int y)
{
    if (projection == CUBE)
        return cube_texel(face, x, y);
    return projection == CYLINDRICAL ? cylinder_texel(x, y) : sphere_texel(x, y);
}

vec3 panorama_sample(vec3 direction)
{
    vec2 xy;
    int face = 0;
    bool shown = true;
    if (projection == CUBE)
        face = cube_pixel(xy, direction);
    else if (projection == CYLINDRICAL)
        shown = cylinder_pixel(xy, direction);
    else
        shown = sphere_pixel(xy, direction);
    if (!shown)
        return vec3(0.0);
    ivec2 at = ivec2(floor(xy - 0.5));
    vec2 part = xy - 0.5 - vec2(at);
    vec3 top = mix(panorama_texel(face, at.x, at.y), panorama_texel(face, at.x + 1, at.y), part.x);
    vec3 bottom = mix(panorama_texel(face, at.x, at.y + 1),
                      panorama_texel(face, at.x + 1, at.y + 1), part.x);
    return mix(top, bottom, part.y);
}

void main()
{
    color = vec4(exposure * panorama_sample(look_ray(look, look_size, gl_FragCoord.xy)), 1.0);
}
