// develop.h - how a linear frame becomes a picture to look at: exposure and tone
#ifndef CLI_DEVELOP_H
#define CLI_DEVELOP_H

#include "cli.h"

struct develop_options {
    const char *exposure, *tone;
    double white;
};
// Table rows for a command's options; `develop` in its struct.
#define DEVELOP_OPTIONS                                                                            \
    TEXT("--exposure", develop.exposure, "picture", "EV",                                          \
         "brighter by EV stops (times 2^EV), or auto: mid grey; default: 0"),                      \
        TEXT(                                                                                      \
            "--tone", develop.tone, "picture", "T",                                                \
            "linear (clip, default), reinhard, filmic or gamma; .exr, .hdr and .pfm stay linear"), \
        NUMBER("--white", develop.white, "picture", "L",                                           \
               "reinhard: the luminance shown as white; default: 4", 1e-3, 1e6)

struct developing {
    struct relume_tone_params tone;
    bool automatic;
};
// RELUME_EINVAL with a sentence.
relume_status parse_developing(const struct develop_options *options, struct developing *d);
// In place, for a file of that name: linear formats stay linear.
relume_status develop(struct relume_image *frame, struct developing d, const char *path);

#endif
