// Twin: relume_object_light_at. A patch's place and normal are those of the light.
bool sample_at(out vec3 towards, out vec3 rgb, vec3 point)
{
    if (light.kind == DIRECTIONAL) {
        towards = light.axis;
        rgb = light.rgb;
        return true;
    }
    if (light.kind != AREA)
        return light_at(towards, rgb, point);
    float distance;
    bool arrives = ray_to(towards, distance, light.position, point);
    float cosine = -dot(towards, light.axis);
    rgb = light.rgb * cosine / (distance * distance);
    return arrives && cosine > 0.0;
}
