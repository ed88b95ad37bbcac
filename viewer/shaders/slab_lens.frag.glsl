#version 330 core
// What one camera adds to a frame through an aperture, and its weight; twin of src/view/slab_lens.c.
#include "footprint.glsl"
#include "texels.glsl"
uniform sampler2D view;
uniform vec4 picture;  // left, top, right, bottom of the window in the frame
uniform vec4 st;       // st_min, st_max
uniform vec3 eye;      // x, y, and how far towards the st plane the uv plane lies
uniform vec2 place;    // u, v of the camera
uniform vec4 steps;    // to the next lines of the grid: u below, u above, v below, v above
uniform vec4 grid;     // first and last lines of the cameras: low u, low v, high u, high v
uniform vec2 lens;     // radius, disparity of the plane in focus
out vec4 color;

vec2 slab_uv(vec3 from, float s, float t)
{
    return from.xy + from.z * (vec2(s, t) - from.xy);
}

float hat(float away, vec2 step)
{
    return max(1.0 - abs(away) / (away > 0.0 ? step.y : step.x), 0.0);
}

float slab_lens_weight(vec2 uv, float radius)
{
    vec2 away = uv - place;
    float distance = length(away);
    float left = distance > radius ? 1.0 - radius / distance : 0.0;
    return hat(left * away.x, steps.xy) * hat(left * away.y, steps.zw);
}

// And the weight; rays beside the grid are those of its border.
vec4 lens_value(vec2 pixel)
{
    vec2 at = (pixel - picture.xy) / (picture.zw - picture.xy);
    vec2 uv = slab_uv(eye, mix(st.x, st.z, at.x), mix(st.w, st.y, at.y));
    vec2 size = vec2(textureSize(view, 0));
    vec2 shift = (uv - place) / (st.zw - st.xy) * size * vec2(1.0, -1.0);
    vec2 position = at * size + lens.y * shift;
    bool within = all(greaterThanEqual(position, vec2(0.0))) && all(lessThanEqual(position, size));
    float weight = within ? slab_lens_weight(clamp(uv, grid.xy, grid.zw), lens.x) : 0.0;
    return weight * vec4(texels_bilinear(view, position), 1.0);
}

void main()
{
    vec2 texels = vec2(textureSize(view, 0)) / (picture.zw - picture.xy);
    Footprint across = footprint_of(texels.x);
    Footprint down = footprint_of(texels.y);
    vec4 sum = vec4(0.0);
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++) {
            vec2 within = vec2(footprint_place(across, i), footprint_place(down, j));
            sum += lens_value(gl_FragCoord.xy + within);
        }
    color = sum / float(across.count * down.count);
}
