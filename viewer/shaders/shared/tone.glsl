// Linear light to linear light in [0, 1]. After luminance and transfer. Twin:
// src/relight/eye/tone.c.
const int TONE_REINHARD = 1;  // places in relume_tones
const int TONE_FILMIC = 2;
const int TONE_GAMMA = 3;

vec3 tone_linear(vec3 rgb, float white)
{
    return clamp(rgb, 0.0, 1.0);
}

vec3 tone_reinhard(vec3 rgb, float white)
{
    float l = max(luminance(rgb), 0.0);
    return clamp(rgb * ((1.0 + l / (white * white)) / (1.0 + l)), 0.0, 1.0);
}

vec3 tone_filmic(vec3 rgb, float white)
{
    vec3 x = clamp(rgb, 0.0, 65504.0);
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

vec3 tone_gamma(vec3 rgb, float white)
{
    return srgb_decode(pow(clamp(rgb, 0.0, 1.0), vec3(1.0 / 2.2)));
}

vec3 tone_apply(int tone, vec3 rgb, float white)
{
    if (tone == TONE_REINHARD)
        return tone_reinhard(rgb, white);
    if (tone == TONE_GAMMA)
        return tone_gamma(rgb, white);
    return tone == TONE_FILMIC ? tone_filmic(rgb, white) : tone_linear(rgb, white);
}
