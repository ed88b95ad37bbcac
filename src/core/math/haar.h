// haar.h - orthonormal Haar wavelets of a square (Haar 1910; the non-standard basis of Stollnitz,
// DeRose and Salesin 1995)
#ifndef MATH_HAAR_H
#define MATH_HAAR_H

#include <stdbool.h>
#include <stddef.h>

// data[side][side], values `step` floats apart, in place; `side` is a power of 2, at most 32. The
// sum of squares stays. At each level the means of 2 x 2 go to the upper left quarter, the
// differences to the others; `back` undoes it.
void haar_square(float *data, int side, size_t step, bool back);

#endif
