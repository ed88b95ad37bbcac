// Twin: keep_above_zero of src/relight/light/relight.c. After luminance.
vec3 above_zero(vec3 rgb)
{
    float least = min(rgb.r, min(rgb.g, rgb.b)), grey = luminance(rgb);
    if (least >= 0.0)
        return rgb;
    return grey > 0.0 ? max(grey * (rgb - least) / (grey - least), 0.0) : vec3(0.0);
}
