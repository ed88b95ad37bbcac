// A look into a panorama; twin of src/view/panorama.c, function by function. A projection's shader
// includes this and says what its image shows in a direction: one shader for all would make software
// renderers compute them all.
uniform sampler2D view;
uniform vec2 elevation;      // cylinder: v_min, v_max
uniform vec3 look;           // pan and tilt in radians, 1 / zoom
uniform bool stereographic;
uniform vec2 look_size;      // pixels of the frame
uniform float exposure;
out vec4 color;

const float PI = 3.14159265358979;

vec3 panorama_sample(vec3 direction);
// Texels per radian in a unit direction, at most.
float panorama_density(vec3 unit);

vec3 look_ray(vec3 l, vec2 size, vec2 position)
{
    float a = (2.0 * position.x / size.x - 1.0) * l.z;
    float b = (size.y - 2.0 * position.y) / size.x * l.z;
    float depth = stereographic ? 0.5 * (1.0 - a * a - b * b) : 1.0;
    float up = b * cos(l.y) + depth * sin(l.y);
    float ahead = depth * cos(l.y) - b * sin(l.y);
    return vec3(a * cos(l.x) + ahead * sin(l.x), up, a * sin(l.x) - ahead * cos(l.x));
}

// Of a pixel, radians: across and down.
vec2 look_extent(float zoom, vec2 size, vec2 position)
{
    float pixel = 2.0 / size.x * zoom;
    vec2 ab = (position - 0.5 * size) * pixel;
    float away = 1.0 + dot(ab, ab);
    return pixel * (stereographic ? vec2(2.0) : sqrt(1.0 + ab.yx * ab.yx)) / away;
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

void main()
{
    vec3 ray = look_ray(look, look_size, gl_FragCoord.xy);
    vec2 texels = panorama_density(normalize(ray)) * look_extent(look.z, look_size, gl_FragCoord.xy);
    Footprint across = footprint_of(texels.x);
    Footprint down = footprint_of(texels.y);
    vec3 sum = vec3(0.0);
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++) {
            vec2 within = vec2(footprint_place(across, i), footprint_place(down, j));
            sum += panorama_sample(look_ray(look, look_size, gl_FragCoord.xy + within));
        }
    color = vec4(exposure * sum / float(across.count * down.count), 1.0);
}
