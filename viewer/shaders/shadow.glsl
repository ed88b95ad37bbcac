// Whether the light sample of the draw reaches a point: a map of the depths that it sees, one layer, or six
// faces of a cube for a light sample among the objects. After cube.
uniform sampler2DArrayShadow shadow;
uniform mat4 shadow_clip[6];
uniform int shadow_layers;   // 0: it reaches everything
uniform vec4 shadow_light;    // its place, 1; or the direction towards it, 0
uniform float shadow_texel;  // size of a texel of the map, of a near light sample at distance 1

// The surface is lifted by two texels along its normal. What it rises over its own slope towards
// the light sample, 2 texels / cos, is more than the slope falls over the texel and a half that four
// neighbours can be away, 1.5 texels * tan: no surface shades itself. A `normal` of zero is for
// points that the map does not hold.
float reached(vec3 point, vec3 normal)
{
    if (shadow_layers == 0)
        return 1.0;
    vec3 from = point - shadow_light.xyz;
    float texel = shadow_texel * (shadow_light.w > 0.0 ? length(from) : 1.0);
    int layer = shadow_layers == 1 ? 0 : cube_face_of(from);
    vec4 clip = shadow_clip[layer] * vec4(point + 2.0 * texel * normal, 1.0);
    vec3 at = 0.5 * clip.xyz / clip.w + 0.5;
    if (clip.w <= 0.0 || any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0))))
        return 1.0;
    return texture(shadow, vec4(at.xy, float(layer), clamp(at.z, 0.0, 1.0)));
}
