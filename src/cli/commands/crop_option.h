// crop_option.h - which part of the pictures is kept
#ifndef CLI_CROP_OPTION_H
#define CLI_CROP_OPTION_H

#include "cli/cli.h"

struct crop {
    bool automatic;
    int part[4];  // x, y, width, height; width 0: all
};
#define CROP_OPTION                                                                                \
    OWN("--crop", crop, "x,y,w,h",                                                                 \
        "keep this part of the pictures, or auto: the object without ball and table", take_crop)
relume_status take_crop(void *crop, const struct option *option, const char *text,
                        const struct relume_log *log);

#endif
