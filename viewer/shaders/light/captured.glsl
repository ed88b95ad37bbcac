// Where light from a direction is taken from.
#include "shared/pole.glsl"
uniform bool zone_everywhere;  // struct relume_captured_region, in the world
uniform vec3 zone_right, zone_up, zone_facing;
uniform vec4 zone_axis;         // and the cosine within which all is inside
uniform sampler2D zone_border;  // a row by azimuth

// Below the horizon of a hemispherical capture: at the horizon of the same azimuth.
vec3 above_horizon(vec3 d)
{
    vec2 flat_part = pole_y ? d.xz : d.xy;
    if (is_captured(d))
        return d;
    vec2 straight_below = pole_y ? vec2(0.0, -1.0) : vec2(1.0, 0.0);
    vec2 at = length(flat_part) > 0.0 ? normalize(flat_part) : straight_below;
    return pole_y ? vec3(at.x, 0.0, at.y) : vec3(at, 0.0);
}

// Twin: border_at.
float zone_border_at(vec2 d)
{
    int steps = textureSize(zone_border, 0).x;
    float at = (atan(d.y, d.x) / (2.0 * PI) + 1.0) * float(steps), low = floor(at);
    int i = int(low) % steps;
    return mix(texelFetch(zone_border, ivec2(i, 0), 0).r,
               texelFetch(zone_border, ivec2((i + 1) % steps, 0), 0).r, at - low);
}

// Twin: relume_coder_clamp. Where the light is taken from, and the share of it.
vec3 captured(vec3 towards, out float share)
{
    vec3 d = above_horizon(towards);
    float height = dot(d, zone_axis.xyz);
    share = 1.0;
    if (zone_everywhere || height >= zone_axis.w)
        return d;
    vec2 across = vec2(dot(d, zone_right), dot(d, zone_up));
    float r = length(across), border = zone_border_at(across), beyond = atan(r, height) - border;
    if (beyond <= 0.0)
        return d;
    across = sin(border) * (r > 0.0 ? across / r : vec2(1.0, 0.0));
    vec3 from = cos(border) * zone_axis.xyz + across.x * zone_right + across.y * zone_up;
    float facing = dot(from, zone_facing);
    share = facing > 0.0 ? clamp((dot(d, zone_facing) + 0.05) / (facing + 0.05), 0.0, 1.0)
                         : max(cos(beyond), 0.0);
    return from;
}
