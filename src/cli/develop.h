// develop.h - how a linear frame becomes a picture to look at: exposure and tone
#ifndef CLI_DEVELOP_H
#define CLI_DEVELOP_H

#include "cli.h"

struct develop_options {
    double exposure, white;          // stops, NaN: by the picture; 0: the tone's own
    const struct relume_tone *tone;  // NULL: linear
    bool icc;                        // with a profile of sRGB
    enum { BITS_8, BITS_16 } bits;   // of integer formats
};
// Table rows for a command's options; `develop` in its struct.
#define DEVELOP_OPTIONS                                                                            \
    DEVELOP_ROWS("brighter by EV stops (times 2^EV), or auto, by the picture; default: 0",         \
                 "linear (clip, default), reinhard, filmic or gamma; .exr, .hdr and .pfm stay "    \
                 "linear")
#define DEVELOP_ROWS(exposure_help, tone_help)                                                     \
    {ROW("--exposure", OPTION_NUMBER, OPTION_AT(double, develop.exposure), "EV", exposure_help),   \
     .min = -100, .max = 100, .names = NAMES("auto")},                                             \
        ENTRY("--tone", develop.tone, "T", tone_help, relume_tones, NULL),                         \
        NUMBER("--white", develop.white, "L",                                                      \
               "reinhard: the luminance shown as white; default: 4", 1e-3, 1e6),                   \
        FLAG("--icc", develop.icc, "put an sRGB colour profile into the picture (.jpg, .tif)"),    \
        NAME("--bits", develop.bits, "B", "bits a sample of .png and .tif: 8 or 16; default: 8",   \
             BITS_8, "8", "16")

// In place, for a file of that name: linear formats stay linear.
relume_status develop(struct relume_image *frame, const struct develop_options *options,
                      const char *path);
// RELUME_EINVAL where a file of that name cannot have the bits.
relume_status check_bits(const struct develop_options *options, const char *path);
// Save it with the profile and the bits that are asked for.
relume_status save_developed(const struct relume_image *frame,
                             const struct develop_options *options, const char *path,
                             const struct args *args);

#endif
