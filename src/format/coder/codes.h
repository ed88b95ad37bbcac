// codes.h - codes in memory as numbers
#ifndef CODER_CODES_H
#define CODER_CODES_H

#include "format/coder/coding.h"
#include "image/image/exr.h"

#include <relume/format/coder.h>

// What a file holds codes as: halves where these hold all of them.
enum exr_sample codes_sample(enum relume_storage storage);

// Numbers become the `n` codes from `first` on: whole ones in range, or any where the codes are
// halves or floats. False where a number is none that a file may hold.
bool codes_keep(void *codes, enum relume_storage storage, size_t first, const float *numbers,
                size_t n);
// `n` codes as samples of that kind; and back, false where a sample is no code.
void codes_to_samples(void *samples, enum relume_storage storage, const void *codes, size_t n);
bool codes_from_samples(void *codes, enum relume_storage storage, const void *samples, size_t n);

// A part of width x height pixels that is `like` other codes, to be filled: its planes (indices),
// one behind the other, begin at *data. RELUME_ENOMEM.
relume_status codes_part_create(struct relume_codes_part *out, void **data,
                                const struct relume_codes *like, int width, int height);

// code * scale + offset of the `n` codes from `first` on.
void codes_restore(float *out, enum relume_storage storage, const void *codes, size_t first,
                   size_t n, float scale, float offset);

#endif
