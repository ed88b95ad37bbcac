// transfer.c - code values and linear light (IEC 61966-2-1 for sRGB)
#include "image/image/merge_weight.h"

#include <relume/image.h>
#include <relume/image/response.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

relume_status relume_transfer_parse(struct relume_transfer *out, const char *text)
{
    *out = (struct relume_transfer){.curve = RELUME_CURVE_AUTO};
    if (!strcmp(text, "linear")) {
        out->curve = RELUME_CURVE_LINEAR;
    } else if (!strcmp(text, "srgb")) {
        out->curve = RELUME_CURVE_SRGB;
    } else if (!strncmp(text, "gamma:", 6)) {
        char *end;
        const float gamma = strtof(text + 6, &end);
        if (end == text + 6 || *end || !(gamma > 0.1f && gamma <= 10.0f))
            return RELUME_EINVAL;
        *out = (struct relume_transfer){.curve = RELUME_CURVE_GAMMA, .gamma = gamma};
    } else if (!strncmp(text, "log:", 4)) {
        char *end;
        const float delta = strtof(text + 4, &end);
        if (end == text + 4 || *end || !(delta >= 1e-6f && delta <= 1.0f))
            return RELUME_EINVAL;
        *out = (struct relume_transfer){.curve = RELUME_CURVE_LOG, .gamma = delta};
    } else {
        return RELUME_EINVAL;
    }
    return RELUME_OK;
}

void relume_transfer_text(struct relume_transfer transfer, char *text, size_t size)
{
    if (transfer.curve == RELUME_CURVE_GAMMA || transfer.curve == RELUME_CURVE_LOG)
        snprintf(text, size, "%s:%.7g", transfer.curve == RELUME_CURVE_LOG ? "log" : "gamma",
                 (double)transfer.gamma);
    else
        snprintf(text, size, "%s",
                 transfer.curve == RELUME_CURVE_LINEAR     ? "linear"
                 : transfer.curve == RELUME_CURVE_RESPONSE ? "response"
                                                           : "srgb");
}

static float srgb_decode(float v)
{
    return v <= 0.04045f ? v / 12.92f : powf((v + 0.055f) / 1.055f, 2.4f);
}

static float srgb_encode(float v)
{
    return v <= 0.0031308f ? v * 12.92f : 1.055f * powf(v, 1.0f / 2.4f) - 0.055f;
}

// What a sum of components may say at most is bright enough, and finite.
static const float MOST_EXPONENT = 80.0f;

// ln(delta + v) of the light, turned and scaled so that black is 0 and white 1: to components the
// same but for the constant. Codes below 0 are not mirrored, which keeps light above -delta.
static float log_decode(float delta, float code)
{
    return delta * (expf(fminf(code * logf(1.0f + 1.0f / delta), MOST_EXPONENT)) - 1.0f);
}

static float log_encode(float delta, float linear)
{
    return logf(1.0f + fmaxf(linear, 0.0f) / delta) / logf(1.0f + 1.0f / delta);
}

// Negative values are mirrored, so that ringing of a basis stays odd and continuous; but for the
// logarithm, which has no light below 0.
float relume_transfer_decode(struct relume_transfer transfer, float code)
{
    if (transfer.curve == RELUME_CURVE_LINEAR)
        return code;
    if (transfer.curve == RELUME_CURVE_RESPONSE)
        return relume_response_decode(transfer.response, 1, code);
    if (transfer.curve == RELUME_CURVE_LOG)
        return log_decode(transfer.gamma, code);
    const float v = fabsf(code);
    const float linear =
        transfer.curve == RELUME_CURVE_GAMMA ? powf(v, transfer.gamma) : srgb_decode(v);
    return copysignf(linear, code);
}

float relume_transfer_encode(struct relume_transfer transfer, float linear)
{
    if (transfer.curve == RELUME_CURVE_LINEAR)
        return linear;
    if (transfer.curve == RELUME_CURVE_RESPONSE)
        return relume_response_encode(transfer.response, 1, linear);
    if (transfer.curve == RELUME_CURVE_LOG)
        return log_encode(transfer.gamma, linear);
    const float v = fabsf(linear);
    const float code =
        transfer.curve == RELUME_CURVE_GAMMA ? powf(v, 1.0f / transfer.gamma) : srgb_encode(v);
    return copysignf(code, linear);
}
