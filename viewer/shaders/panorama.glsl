// A look into a panorama; twin of src/view/panorama.c, function by function. A projection's shader
// includes this and says where a direction lies in its image: one shader for all would make software
// renderers compute them all.
uniform sampler2D view;
uniform vec2 elevation;      // cylinder: v_min, v_max
uniform vec3 look;           // pan and tilt in radians, 1 / zoom
uniform bool stereographic;
uniform vec2 look_size;      // pixels of the frame
uniform float exposure;
out vec4 color;

const float PI = 3.14159265358979;

// False when the panorama does not show that direction. `face`: of a cube.
bool panorama_pixel(out vec2 xy, out int face, vec3 direction);
vec3 panorama_texel(int face, int x, int y);

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

vec3 panorama_sample(vec3 direction)
{
    vec2 xy;
    int face;
    if (!panorama_pixel(xy, face, direction))
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
