// Passes over a relit view. After luminance. Twin: src/relight/normals/enhance.c.

// The highlight of a light, of which `halfway` is the unscaled half vector.
float specular_lobe(vec3 normal, vec3 halfway, float exponent)
{
    float size = length(halfway), cosine = dot(normal, halfway) / size;
    return size > 1e-6 && cosine > 0.0 ? pow(cosine, exponent) : 0.0;
}

// `most`: what the albedo shows where light falls straight.
vec3 diffuse_gain(vec3 rgb, vec3 most, float gain, float scale)
{
    return max(scale * (most + gain * (rgb - most)), 0.0);
}

// Twin: show_false_colour.
vec3 false_colour(vec3 rgb, vec2 range)
{
    const vec3 steps[5] = vec3[5](vec3(0.0, 0.0, 0.1), vec3(0.15, 0.0, 0.35), vec3(0.65, 0.02, 0.1),
                                  vec3(0.95, 0.3, 0.0), vec3(1.0, 0.95, 0.3));
    float y = luminance(rgb);
    if (!(y > 1e-6))
        return vec3(0.0);
    float x = clamp(4.0 * (y - range.x) / (range.y - range.x), 0.0, 4.0);
    int low = min(int(x), 3);
    return mix(steps[low], steps[low + 1], x - float(low));
}
