#version 330 core
// One cell of a light slab between four cameras, each where it sees the surface of the ray.
#include "footprint.glsl"
#include "slab_depth.glsl"
uniform vec4 picture;  // left, top, right, bottom of the window in the frame
uniform vec3 eye;      // x, y, and how far towards the st plane the uv plane lies
uniform vec2 range;    // farthest and nearest disparity
uniform float exposure;
out vec4 color;

vec2 slab_uv(vec3 from, float s, float t)
{
    return from.xy + from.z * (vec2(s, t) - from.xy);
}

void main()
{
    vec2 texels = vec2(textureSize(view00, 0)) / (picture.zw - picture.xy);
    Footprint across = footprint_of(texels.x);
    Footprint down = footprint_of(texels.y);
    vec3 sum = vec3(0.0);
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++) {
            vec2 within = vec2(footprint_place(across, i), footprint_place(down, j));
            vec2 at = (gl_FragCoord.xy + within - picture.xy) / (picture.zw - picture.xy);
            vec2 uv = slab_uv(eye, mix(st.x, st.z, at.x), mix(st.w, st.y, at.y));
            find_cameras(uv, uv, at);
            sum += shade(range.y, range.x).rgb;
        }
    color = vec4(exposure * sum / float(across.count * down.count), 1.0);
}
