// Code values and linear light; twins of relume_transfer_decode and _encode in image.h.
struct Transfer {
    int curve;  // enum relume_curve
    float gamma;
};
const int CURVE_LINEAR = 1;
const int CURVE_SRGB = 2;
const int CURVE_GAMMA = 3;

float transfer_decode(Transfer transfer, float code)
{
    if (transfer.curve == CURVE_LINEAR)
        return code;
    float v = abs(code);
    float linear = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    if (transfer.curve == CURVE_GAMMA)
        linear = pow(v, transfer.gamma);
    return code < 0.0 ? -linear : linear;
}

float transfer_encode(Transfer transfer, float linear)
{
    if (transfer.curve == CURVE_LINEAR)
        return linear;
    float v = abs(linear);
    float code = v <= 0.0031308 ? v * 12.92 : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
    if (transfer.curve == CURVE_GAMMA)
        code = pow(v, 1.0 / transfer.gamma);
    return linear < 0.0 ? -code : code;
}
