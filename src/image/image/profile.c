// profile.c - the one place that knows Little CMS (ICC.1:2010: three-component matrix profiles)
#include "image/image/profile.h"

#include "core/base/memory.h"

#include <lcms2.h>
#include <string.h>

// PCS XYZ (D50) -> linear sRGB: the inverse of the colorants of IEC 61966-2-1 adapted by Bradford.
static const double xyz_to_srgb[3][3] = {
    {3.1338561, -1.6168667, -0.4906146},
    {-0.9787684, 1.9161415, 0.0334540},
    {0.0719453, -0.2289914, 1.4052427},
};

static bool read_channel(struct profile *out, cmsHPROFILE h, int c)
{
    static const cmsTagSignature colorant[] = {cmsSigRedColorantTag, cmsSigGreenColorantTag,
                                               cmsSigBlueColorantTag};
    static const cmsTagSignature trc[] = {cmsSigRedTRCTag, cmsSigGreenTRCTag, cmsSigBlueTRCTag};
    const cmsCIEXYZ *xyz = cmsReadTag(h, colorant[c]);
    const cmsToneCurve *curve = cmsReadTag(h, trc[c]);
    if (!xyz || !curve)
        return false;
    for (int i = 0; i <= PROFILE_STEPS; i++)
        out->curve[c][i] = cmsEvalToneCurveFloat(curve, (float)i / PROFILE_STEPS);
    for (int row = 0; row < 3; row++)
        out->to_srgb[3 * row + c] =
            (float)(xyz_to_srgb[row][0] * xyz->X + xyz_to_srgb[row][1] * xyz->Y +
                    xyz_to_srgb[row][2] * xyz->Z);
    return true;
}

bool profile_read(struct profile *out, const void *icc, size_t size)
{
    if (size > 1 << 26)
        return false;
    cmsHPROFILE h = cmsOpenProfileFromMem(icc, (cmsUInt32Number)size);
    if (!h)
        return false;
    bool good = cmsGetColorSpace(h) == cmsSigRgbData && cmsGetPCS(h) == cmsSigXYZData;
    for (int c = 0; good && c < 3; c++)
        good = read_channel(out, h, c);
    cmsCloseProfile(h);
    return good;
}

void *profile_srgb(size_t *size)
{
    enum { DATE = 24, DATE_BYTES = 12 };  // ICC.1:2010, 7.2: when it was made
    static const uint8_t date[DATE_BYTES] = {0x07, 0xe8, 0, 1, 0, 1};
    cmsUInt32Number n = 0;
    uint8_t *bytes = NULL;
    cmsHPROFILE h = cmsCreate_sRGBProfile();
    if (h && cmsSaveProfileToMem(h, NULL, &n) && n > DATE + DATE_BYTES)
        bytes = mem_array(n, 1);
    if (bytes && cmsSaveProfileToMem(h, bytes, &n)) {
        memcpy(bytes + DATE, date, sizeof date);
    } else {
        mem_free(bytes);
        bytes = NULL;
    }
    if (h)
        cmsCloseProfile(h);
    *size = bytes ? n : 0;
    return bytes;
}

float profile_decode(const struct profile *profile, int channel, float code)
{
    const float *v = profile->curve[channel];
    if (!(code > 0.0f))
        return v[0];
    const float x = code * PROFILE_STEPS;
    if (!(x < PROFILE_STEPS))
        return v[PROFILE_STEPS];
    const int i = (int)x;
    return v[i] + (x - (float)i) * (v[i + 1] - v[i]);
}
