// Twin: keep_above_zero (src/relight/light/relight.c).
vec3 above_zero(vec3 rgb)
{
    float least = min(rgb.r, min(rgb.g, rgb.b)), grey = dot(rgb, vec3(0.2126, 0.7152, 0.0722));
    if (least >= 0.0)
        return rgb;
    return grey > 0.0 ? max(grey * (rgb - least) / (grey - least), 0.0) : vec3(0.0);
}
