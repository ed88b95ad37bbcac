// luminance.h - one number of three: luminance of linear light by Rec. 709, luma of display values
// by Rec. 601
#ifndef MATH_LUMINANCE_H
#define MATH_LUMINANCE_H

static inline float luminance_709f(const float rgb[3])
{
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

static inline double luminance_709(const float rgb[3])
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

static inline float luma_601f(const float rgb[3])
{
    return 0.299f * rgb[0] + 0.587f * rgb[1] + 0.114f * rgb[2];
}

#endif
