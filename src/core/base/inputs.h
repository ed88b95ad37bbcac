// inputs.h - files that are read are noted, and kept from being replaced
#ifndef BASE_INPUTS_H
#define BASE_INPUTS_H

#include <relume/base.h>

// The files that a run reads, by device and number. Thread-safety: safe.
struct inputs;
struct inputs *inputs_create(void);  // NULL: out of memory
void inputs_destroy(struct inputs *inputs);
// What does not exist is passed over.
void inputs_add(struct inputs *inputs, const char *path);

// Note `path` in the inputs of the log's context, if it has any.
void input_note(const struct relume_log *log, const char *path);

// RELUME_EINVAL with a sentence when `path` is a file that is read, or a folder that is read or
// holds anything that is; `output` is what the sentence calls it.
relume_status input_refuse(const char *path, const char *output, const struct relume_log *log);

#endif
