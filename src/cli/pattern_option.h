// pattern_option.h - the --pattern option of synth and lights
#ifndef CLI_PATTERN_OPTION_H
#define CLI_PATTERN_OPTION_H

#include "cli.h"

#define PATTERN_OPTION                                                                             \
    {                                                                                              \
        "--pattern", OPTION_TEXT, "P",                                                             \
            "hammersley (default), grid, random, jittered, poisson, spiral", 0, 0                  \
    }

// The pattern asked for, or the default; RELUME_EINVAL and a sentence for an unknown one.
relume_status args_pattern(const struct relume_pattern **out, const struct args *args);

#endif
