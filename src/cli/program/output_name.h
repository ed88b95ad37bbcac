// output_name.h - the ending of an output's name says its format: asked before any work is done
#ifndef PROGRAM_OUTPUT_NAME_H
#define PROGRAM_OUTPUT_NAME_H

#include "core/base/tree.h"

#include <relume/image.h>

// `path` as the value of `option`. RELUME_EINVAL with a sentence. A picture of any format, one of
// values below 0 as well, a relume file, a rig.
relume_status picture_name(const struct relume_log *log, const char *option, const char *path);
relume_status floats_name(const struct relume_log *log, const char *option, const char *path);
relume_status rig_name(const struct relume_log *log, const char *option, const char *path);
relume_status relume_name(const struct relume_log *log, const char *option, const char *path);

// Returns true for the formats that hold 16 bits a sample.
bool has_words(const char *path);
// The ending of the last part of `path` with its dot; "" where there is none.
const char *name_ending(const char *path);

#endif
