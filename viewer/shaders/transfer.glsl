// Code values and linear light. Only the viewer has the logarithmic curve.
#define CURVE_LOG 5

vec3 log_decode(float delta, vec3 code)
{
    return delta * (exp(min(code * log(1.0 + 1.0 / delta), 80.0)) - 1.0);
}

vec3 log_encode(float delta, vec3 linear)
{
    return log(1.0 + max(linear, 0.0) / delta) / log(1.0 + 1.0 / delta);
}

#include "shared/transfer.glsl"
#include "shared/transfer_encode.glsl"
