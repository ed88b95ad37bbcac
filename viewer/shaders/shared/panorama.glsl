// A look into a panorama. Twin: src/relight/view/panorama.c. A layout's file, behind this one, says
// what the image shows in a direction: one shader for all would make software renderers compute
// them all. Values are zero where the panorama shows nothing. After footprint.
uniform sampler2D view;
uniform vec2 elevation;      // cylinder: v_min, v_max
uniform vec3 look;           // pan and tilt in radians, 1 / zoom
uniform bool stereographic;
uniform vec2 look_size;      // pixels of the frame

const float PI = 3.14159265358979;

vec4 panorama_sample(vec3 direction);
// How many texels further a direction comes to lie that moves by `move`.
float panorama_texels(vec3 d, vec3 move);

// Through a position in the frame, rows counted down. Twin: camera_ray.
vec3 look_ray(vec3 l, vec2 size, vec2 position)
{
    float a = (2.0 * position.x / size.x - 1.0) * l.z;
    float b = (size.y - 2.0 * position.y) / size.x * l.z;
    float depth = stereographic ? 0.5 * (1.0 - a * a - b * b) : 1.0;
    float up = b * cos(l.y) + depth * sin(l.y);
    float ahead = depth * cos(l.y) - b * sin(l.y);
    return vec3(a * cos(l.x) + ahead * sin(l.x), up, a * sin(l.x) - ahead * cos(l.x));
}

// How a ray goes on over a pixel, to the right and down. Twin: camera_steps.
void look_steps(out vec3 across, out vec3 down, vec3 l, vec2 size, vec2 position)
{
    float pixel = 2.0 / size.x * l.z;
    vec2 ab = stereographic ? (position - 0.5 * size) * pixel * vec2(1.0, -1.0) : vec2(0.0);
    vec3 right = vec3(cos(l.x), 0.0, sin(l.x));
    vec3 up = vec3(-sin(l.y) * sin(l.x), cos(l.y), sin(l.y) * cos(l.x));
    vec3 ahead = vec3(cos(l.y) * sin(l.x), sin(l.y), -cos(l.y) * cos(l.x));
    across = pixel * (right - ab.x * ahead);
    down = pixel * (ab.y * ahead - up);
}

vec4 fetch(int x, int y)
{
    return texelFetch(view, ivec2(x, y), 0);
}

int wrap_index(int i, int n)
{
    return i < 0 ? i + n : i >= n ? i - n : i;
}

float azimuth_column(vec3 d)
{
    return (atan(d.x, -d.z) + PI) / (2.0 * PI) * float(textureSize(view, 0).x);
}

// The mean over a pixel of the frame.
vec4 panorama_mean(vec2 position)
{
    vec3 ray = look_ray(look, look_size, position);
    vec3 to_right, below;
    look_steps(to_right, below, look, look_size, position);
    Footprint across = footprint_of(panorama_texels(ray, to_right));
    Footprint down = footprint_of(panorama_texels(ray, below));
    vec4 sum = vec4(0.0);
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++) {
            vec2 within = vec2(footprint_place(across, i), footprint_place(down, j));
            sum += panorama_sample(look_ray(look, look_size, position + within));
        }
    return sum / float(across.count * down.count);
}
