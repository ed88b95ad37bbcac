// inputs.h - files that are read: opened here, noted, and kept from being replaced
#ifndef BASE_INPUTS_H
#define BASE_INPUTS_H

#include <relume/base.h>
#include <stdio.h>

// What a log that passes sentences on has to pass on too; `log` may be NULL.
static inline relume_inputs *inputs_of(const struct relume_log *log)
{
    return log ? log->inputs : NULL;
}

// Note `path` in the log's inputs, if it has any.
void input_note(const struct relume_log *log, const char *path);
// Noted and opened for reading; NULL and -1 with errno.
FILE *input_open(const char *path, const struct relume_log *log);
int input_descriptor(const char *path, const struct relume_log *log);

// RELUME_EINVAL with a sentence when `path` is a file that is read, or a folder that is read or
// holds anything that is; `output` is what the sentence calls it.
relume_status input_refuse(const char *path, const char *output, const struct relume_log *log);

#endif
