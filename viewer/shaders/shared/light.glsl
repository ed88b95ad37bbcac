// What lights that stand near send.
const float PI = 3.14159265358979;

bool ray_to(out vec3 towards, out float distance, vec3 from, vec3 point)
{
    towards = from - point;
    distance = length(towards);
    towards /= distance;
    return distance >= 1e-6;
}

// From the axis. Drivers are coarse at acos: Mesa is off by a ten thousandth.
float off_axis(vec3 ray, vec3 axis)
{
    return atan(length(cross(ray, axis)), dot(ray, axis));
}

float spot_factor(vec3 ray, vec3 axis, float half_angle)
{
    return 1.0 - smoothstep(0.9 * half_angle, half_angle, off_axis(ray, axis));
}
