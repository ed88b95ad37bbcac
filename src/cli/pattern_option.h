// pattern_option.h - the --pattern option of synth and lights
#ifndef CLI_PATTERN_OPTION_H
#define CLI_PATTERN_OPTION_H

#include "cli.h"

// A table row for a command's option.
#define PATTERN_OPTION                                                                             \
    TEXT("--pattern", pattern, "lights", "P",                                                      \
         "hammersley (default), grid, random, jittered, poisson, spiral")

// The pattern asked for, "hammersley" for NULL; RELUME_EINVAL and a sentence for an unknown one.
relume_status choose_pattern(const struct relume_pattern **out, const char *name);

#endif
