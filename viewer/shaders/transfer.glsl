// Code values and linear light; twins of relume_transfer_decode and _encode in image.h.
struct Transfer {
    int curve;  // enum relume_curve
    float gamma;  // CURVE_LOG: its delta
};
const int CURVE_LINEAR = 1;
const int CURVE_SRGB = 2;
const int CURVE_GAMMA = 3;
const int CURVE_LOG = 5;

float log_decode(float delta, float code)
{
    return delta * (exp(min(code * log(1.0 + 1.0 / delta), 80.0)) - 1.0);
}

float log_encode(float delta, float linear)
{
    return log(1.0 + max(linear, 0.0) / delta) / log(1.0 + 1.0 / delta);
}

float transfer_decode(Transfer transfer, float code)
{
    if (transfer.curve == CURVE_LINEAR)
        return code;
    if (transfer.curve == CURVE_LOG)
        return log_decode(transfer.gamma, code);
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
    if (transfer.curve == CURVE_LOG)
        return log_encode(transfer.gamma, linear);
    float v = abs(linear);
    float code = v <= 0.0031308 ? v * 12.92 : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
    if (transfer.curve == CURVE_GAMMA)
        code = pow(v, 1.0 / transfer.gamma);
    return linear < 0.0 ? -code : code;
}
