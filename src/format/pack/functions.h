// functions.h - learned functions of light as text, where every byte counts: files whose planes are
// coded with loss
//
// The numbers of component k are whole steps of 2^-e, as fine as its coefficients are large: one
// digit for each e, then what the range coder makes of the steps, channel after channel. Green is
// foretold from red, and blue from green, by the ratio that the numbers so far had.
#ifndef PACK_FUNCTIONS_H
#define PACK_FUNCTIONS_H

#include <relume/base.h>

// numbers[3][components][each] as text, from malloc. most[components] is the largest size of what
// they multiply: products are off by less than half of `allowed` where numbers are below 32768
// steps. NULL: memory is short.
char *functions_text(const float *numbers, int components, int each, const float *most,
                     double allowed);
// Back. RELUME_EDAMAGED where there are not digits for `components` or something is none;
// RELUME_ENOMEM.
relume_status functions_of_text(float *numbers, const char *text, int components, int each);

// As earlier files have them: rows of numbers within -most .. most of their row, two digits of 64
// for each. False where one is no digit.
bool functions_of_digits(float *numbers, const char *text, const float *most, int rows, int each);

#endif
