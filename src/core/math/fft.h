// fft.h - Fourier and cosine transforms; the folder's door to FFTW (`make FFT=kiss`: to kissfft)
#ifndef MATH_FFT_H
#define MATH_FFT_H

#include <relume/base.h>

// The cosine transform of data[height][width] in place, DCT-II along both axes:
//     X_k = 2 sum_n x_n cos(pi (n + 1/2) k / N);
// `inverse` undoes it. RELUME_ENOMEM.
relume_status fft_cosine(float *data, int width, int height, bool inverse);

// Transforms of lines, not normalised: sum_n x_n exp(-2 pi i n k / N), inverse with + . Complex
// numbers are pairs of floats. A real line of n floats has the n / 2 + 1 coefficients 0 .. n / 2.
// Thread-safety: running is safe.
typedef struct fft_line fft_line;
enum fft_kind { FFT_FORWARD, FFT_INVERSE, FFT_REAL, FFT_REAL_INVERSE };
// RELUME_ENOMEM.
relume_status fft_line_create(fft_line **out, int n, enum fft_kind kind);
void fft_line_destroy(fft_line **line);
// `in`, `out` and `scratch` differ and start on 16 bytes; `in` is spoilt. `scratch` holds 4 n
// floats.
void fft_line_run(const fft_line *line, float *in, float *out, float *scratch);

// The least even size of at least n whose prime factors are 2, 3 and 5.
int fft_good_size(int n);

#endif
