#version 430
// The pattern in pixels and the veil beyond it, around the first number of each plane and across the
// borders: red + i green, and blue.
layout(local_size_x = 16, local_size_y = 16) in;
layout(std430, binding = 0) writeonly buffer Planes { vec2 number[]; };
layout(std430, binding = 1) readonly buffer Pixels { vec4 pixel[]; };  // [2 reach + 1]^2
layout(std430, binding = 2) readonly buffer Sums { vec4 sum[]; };      // [0]: of all pixels
layout(std430, binding = 3) readonly buffer Veil { float veil[]; };
uniform ivec2 size;     // of a plane
uniform ivec2 most;     // pixels that matter to either side
uniform int reach;      // of `pixel`
uniform vec2 parts;     // of the light: of the pattern, and of the veil in a pixel per steradian
uniform float steps;    // of the veil's table in a pixel
uniform int veil_steps;

vec3 kernel(ivec2 d)
{
    vec3 rgb = vec3(0.0);
    if (all(lessThanEqual(abs(d), ivec2(reach)))) {
        int side = 2 * reach + 1;
        rgb = parts.x * pixel[(d.y + reach) * side + d.x + reach].rgb / sum[0].rgb;
    }
    float at = steps * length(vec2(d));
    if (parts.y > 0.0 && at < float(veil_steps)) {
        int i = int(at);
        rgb += parts.y * mix(veil[i], veil[i + 1], at - float(i));
    }
    return rgb;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, size)))
        return;
    ivec2 d = at - size * ivec2(greaterThan(at, most));
    bool matters = all(lessThanEqual(abs(d), most));
    vec3 rgb = matters ? kernel(d) : vec3(0.0);
    int i = at.y * size.x + at.x;
    number[i] = rgb.rg;
    number[size.x * size.y + i] = vec2(rgb.b, 0.0);
}
