// output_name.h - the ending of an output's name says its format: asked before any work is done
#ifndef CLI_OUTPUT_NAME_H
#define CLI_OUTPUT_NAME_H

#include "cli.h"

// `path` as the value of `option`. RELUME_EINVAL with a sentence.
relume_status picture_name(const char *option, const char *path);  // any format of pictures
relume_status floats_name(const char *option, const char *path);   // values below 0 as well
relume_status relume_name(const char *option, const char *path);   // a relume file: .exr

// The last part of `path`.
const char *base_name(const char *path);
// The ending of the last part of `path` with its dot; "" where there is none.
const char *name_ending(const char *path);

#endif
