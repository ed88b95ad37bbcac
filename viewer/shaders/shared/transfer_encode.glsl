// Twin: relume_transfer_encode. After transfer; where CURVE_LOG is defined, so is log_encode.
vec3 transfer_encode(Transfer transfer, vec3 linear)
{
    if (transfer.curve == CURVE_LINEAR)
        return linear;
#ifdef CURVE_LOG
    if (transfer.curve == CURVE_LOG)
        return log_encode(transfer.gamma, linear);
#endif
    vec3 v = abs(linear);
    return sign(linear) *
           (transfer.curve == CURVE_GAMMA ? pow(v, vec3(1.0 / transfer.gamma)) : srgb_encode(v));
}
