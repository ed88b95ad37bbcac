// develop.h - how a linear frame becomes a picture to look at: exposure and tone
#ifndef CLI_DEVELOP_H
#define CLI_DEVELOP_H

#include "cli.h"

// Table rows for a command's options.
#define DEVELOP_OPTIONS                                                                            \
    {"--exposure",                                                                                 \
     OPTION_TEXT,                                                                                  \
     "EV",                                                                                         \
     "brighter by EV stops (times 2^EV), or auto: mid grey; default: 0",                           \
     0,                                                                                            \
     0},                                                                                           \
        {"--tone",                                                                                 \
         OPTION_TEXT,                                                                              \
         "T",                                                                                      \
         "linear (clip, default), reinhard, filmic or gamma; .exr, .hdr and .pfm stay linear",     \
         0,                                                                                        \
         0},                                                                                       \
    {                                                                                              \
        "--white", OPTION_NUMBER, "L", "reinhard: the luminance shown as white; default: 4", 1e-3, \
            1e6                                                                                    \
    }

struct developing {
    struct relume_tone_params tone;
    bool automatic;
};
// RELUME_EINVAL with a sentence.
relume_status parse_developing(const struct args *args, struct developing *d);
// The same with other defaults.
relume_status parse_developing_from(const struct args *args, const char *default_exposure,
                                    const char *default_tone, struct developing *d);
// In place, for a file of that name: linear formats stay linear.
relume_status develop(struct relume_image *frame, struct developing d, const char *path);

#endif
