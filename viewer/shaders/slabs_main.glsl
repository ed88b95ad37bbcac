// A pixel of one of several slabs: the mean of ray_value, which the shader defines, over it; places
// are 0 to 1 in the picture. After view00, st and cell.
#include "shared/footprint.glsl"
#include "shared/footprint_mean.glsl"
#include "slabs_ray.glsl"
out vec4 color;
vec4 ray_value(vec2 at);

vec4 value_at(vec2 within)
{
    return ray_value((gl_FragCoord.xy + within - picture.xy) / (picture.zw - picture.xy));
}

void main()
{
    vec2 at = (gl_FragCoord.xy - picture.xy) / (picture.zw - picture.xy);
    vec2 uv, hit;
    if (!slabs_begin(uv, hit, at, st, cell))
        discard;
    color = UNSEEN;
    if (beside || slab_weight(uv, hit, st) > 0.0)
        color = footprint_mean(slabs_texels(hit, at, vec2(textureSize(view00, 0)) / (st.zw - st.xy)));
}
