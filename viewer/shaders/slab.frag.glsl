#version 330 core
// One cell of a light slab between four cameras: bilinear in (u, v) and in (s, t), Gortler's
// quadralinear basis; twin of src/view/slab.c.
#include "footprint.glsl"
#include "texels.glsl"
uniform sampler2D view00;  // low u, low v
uniform sampler2D view10;  // high u, low v
uniform sampler2D view01;
uniform sampler2D view11;
uniform vec4 picture;   // left, top, right, bottom of the window in the frame
uniform vec4 st;        // st_min, st_max
uniform vec4 cell;      // low u, low v, high u, high v
uniform vec3 eye;       // x, y, and how far towards the st plane the uv plane lies
uniform bool nearest;   // the nearest camera instead
uniform float exposure;
out vec4 color;

vec2 slab_uv(vec3 from, float s, float t)
{
    return from.xy + from.z * (vec2(s, t) - from.xy);
}

// What the ray through a place of the frame sees; beside the cells at the border what they see.
vec3 slab_value(vec2 pixel)
{
    vec2 at = (pixel - picture.xy) / (picture.zw - picture.xy);
    vec2 uv = slab_uv(eye, mix(st.x, st.z, at.x), mix(st.w, st.y, at.y));
    vec2 size = max(cell.zw - cell.xy, vec2(1e-30));  // one row or column has cells of no width
    vec2 part = clamp((uv - cell.xy) / size, 0.0, 1.0);
    if (nearest)
        part = step(0.5, part);
    vec2 position = at * vec2(textureSize(view00, 0));
    vec3 low = mix(texels_bilinear(view00, position), texels_bilinear(view10, position), part.x);
    vec3 high = mix(texels_bilinear(view01, position), texels_bilinear(view11, position), part.x);
    return mix(low, high, part.y);
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
            sum += slab_value(gl_FragCoord.xy + within);
        }
    color = vec4(exposure * sum / float(across.count * down.count), 1.0);
}
