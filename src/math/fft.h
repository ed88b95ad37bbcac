// fft.h - cosine transforms; the folder's door to FFTW (`make FFT=kiss`: to kissfft)
#ifndef MATH_FFT_H
#define MATH_FFT_H

#include <relume/base.h>

// The cosine transform of data[height][width] in place, DCT-II along both axes:
//     X_k = 2 sum_n x_n cos(pi (n + 1/2) k / N);
// `inverse` undoes it. RELUME_ENOMEM.
relume_status fft_cosine(float *data, int width, int height, bool inverse);

#endif
