// codes.h - codes in memory as numbers
#ifndef CODER_CODES_H
#define CODER_CODES_H

#include <relume/coder.h>

// code * scale + offset of the `n` codes from `first` on.
void codes_restore(float *out, enum relume_storage storage, const void *codes, size_t first,
                   size_t n, float scale, float offset);

#endif
