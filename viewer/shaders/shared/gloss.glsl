// Highlights that move. After transfer and transfer_encode. Twin: src/relight/shadow/gloss.c.
const float LEAST_ROUGHNESS = 0.05;

// Twin: gloss_shown.
vec3 gloss_shown(vec4 colour, vec4 pixel, vec3 light)
{
    vec2 xy = vec2(colour.w, pixel.x);
    float z = sqrt(max(1.0 - dot(xy, xy), 1e-6)), cosine = dot(vec3(xy, z), light);
    if (!(cosine > 0.0))
        return vec3(0.0);
    float towards_half = max((cosine + z) / sqrt(max(2.0 + 2.0 * light.z, 1e-6)), 0.0);
    float r = max(pixel.y, LEAST_ROUGHNESS), a2 = r * r * r * r;
    float d = towards_half * towards_half * (a2 - 1.0) + 1.0;
    float lobe = a2 * cosine / (d * d * (cosine + sqrt(a2 + (1.0 - a2) * cosine * cosine)) *
                                (z + sqrt(a2 + (1.0 - a2) * z * z)));
    return min(pixel.z < 0.0 ? colour.rgb * lobe : colour.rgb * cosine + pixel.z * lobe, 1.0);
}

// What a light shows more than the captured lights around it, whose values are blended as codes;
// `lights` holds the direction and weight of each. Twin: gloss_wanders.
vec3 gloss_wanders(Transfer display, sampler2D lights, int around, vec4 colour, vec4 pixel,
                   vec3 light)
{
    vec3 codes = vec3(0.0);
    for (int i = 0; i < around; i++) {
        vec4 from = texelFetch(lights, ivec2(i, 0), 0);
        codes += from.w * transfer_encode(display, gloss_shown(colour, pixel, from.xyz));
    }
    return gloss_shown(colour, pixel, light) - transfer_decode(display, codes);
}
