// One cell of a slab between four cameras: bilinear in (u, v) and in (s, t), Gortler's quadralinear
// basis. Twin: src/relight/view/slab.c. Beside the cells at the border it is what they see.
#include "texels.glsl"
uniform sampler2D view00;  // low u, low v
uniform sampler2D view10;  // high u, low v
uniform sampler2D view01;
uniform sampler2D view11;
#include "slab_parts.glsl"
uniform vec4 st;       // st_min, st_max
uniform vec4 cell;     // low u, low v, high u, high v
uniform bool nearest;  // the nearest camera instead

// `at` is 0 to 1 in the window.
vec3 cell_value(vec2 uv, vec2 at)
{
    vec2 size = max(cell.zw - cell.xy, vec2(1e-30));  // one row or column has cells of no width
    vec2 part = clamp((uv - cell.xy) / size, 0.0, 1.0);
    if (nearest)
        part = step(0.5, part);
    vec2 position = at * view_size();
    vec3 low = mix(texels_bilinear(view00, position - first_low.xy),
                   texels_bilinear(view10, position - first_low.zw), part.x);
    vec3 high = mix(texels_bilinear(view01, position - first_high.xy),
                    texels_bilinear(view11, position - first_high.zw), part.x);
    return mix(low, high, part.y);
}
