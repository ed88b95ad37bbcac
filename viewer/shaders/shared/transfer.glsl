// Code values to linear light. Where CURVE_LOG is defined, so is log_decode.
struct Transfer {
    int curve;  // enum relume_curve
    float gamma;  // CURVE_LOG: its delta
};
const int CURVE_LINEAR = 1;
const int CURVE_SRGB = 2;
const int CURVE_GAMMA = 3;

// Codes from 0 on.
vec3 srgb_decode(vec3 code)
{
    return mix(pow((code + 0.055) / 1.055, vec3(2.4)), code / 12.92,
               lessThanEqual(code, vec3(0.04045)));
}

vec3 srgb_encode(vec3 linear)
{
    return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, 12.92 * linear,
               lessThanEqual(linear, vec3(0.0031308)));
}

// Twin: relume_transfer_decode.
vec3 transfer_decode(Transfer transfer, vec3 code)
{
    if (transfer.curve == CURVE_LINEAR)
        return code;
#ifdef CURVE_LOG
    if (transfer.curve == CURVE_LOG)
        return log_decode(transfer.gamma, code);
#endif
    vec3 v = abs(code);
    return sign(code) *
           (transfer.curve == CURVE_GAMMA ? pow(v, vec3(transfer.gamma)) : srgb_decode(v));
}
