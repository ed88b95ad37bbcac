// What a patch of an area light sends to a point. Twin: relume_light_patch_at. After light.
uniform int patches;  // `picture` has a column for each: position, normal, radiance

bool patch_at(out vec3 towards, out vec3 rgb, int index, vec3 point)
{
    vec3 normal = texelFetch(picture, ivec2(index, 1), 0).xyz;
    float distance;
    bool arrives = ray_to(towards, distance, texelFetch(picture, ivec2(index, 0), 0).xyz, point);
    float cosine = -dot(towards, normal);
    rgb = texelFetch(picture, ivec2(index, 2), 0).rgb * cosine / (distance * distance);
    return arrives && cosine > 0.0;
}
