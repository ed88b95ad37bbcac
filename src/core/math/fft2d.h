// fft2d.h - two-dimensional transforms on the library's own threads, made of lines (fft.h)
//
// Rows first, then columns, FFT2D_BLOCK at a time. The halves are separate, so that rows and
// columns that are known to be zero or not wanted cost nothing, and so that what is done to a
// column is done while it is at hand. The same bits for any number of threads.
#ifndef MATH_FFT2D_H
#define MATH_FFT2D_H

#include "core/math/fft.h"

enum { FFT2D_BLOCK = 8 };  // columns: one cache line of complex numbers

// Thread-safety: one thread at a time.
typedef struct fft2d fft2d;

// `real`: of real pictures, width even; the spectrum has width / 2 + 1 columns, else width.
relume_status fft2d_create(fft2d **out, int width, int height, bool real, int threads);
void fft2d_destroy(fft2d **f);
int fft2d_columns(const fft2d *f);
// Floats of a spectrum, whose rows are equally long.
size_t fft2d_size(const fft2d *f);

// Rows [from, to) of the picture, made by `fill` (width floats, or pairs when not real), into
// `spectrum`. Calls of `fill` come from several threads.
void fft2d_rows(const fft2d *f, float *spectrum, int from, int to,
                void (*fill)(void *context, int row, float *line), void *context);

// The columns [first, end): rows outside [from, to) count as zero. Every column's coefficients are
// handed to `visit`, lines[count][height] pairs of the columns from `column` on, count at most
// FFT2D_BLOCK; where `back` they
// are transformed back afterwards and stored, else stored as they are. Without `visit` the
// coefficients are stored; with a visit that answers false nothing is.
struct fft2d_step {
    int from, to, first, end;
    bool (*visit)(void *context, int column, int count, float *lines);
    void *context;
    bool back;
};
void fft2d_step_columns(const fft2d *f, float *spectrum, const struct fft2d_step *step);
// Columns of a spectrum back, all of them, in place.
void fft2d_columns_back(const fft2d *f, float *spectrum);

// Rows [from, to) back, handed to `take` as they are done; spoils the spectrum. Not normalised: a
// picture comes back times width * height.
void fft2d_rows_back(const fft2d *f, float *spectrum, int from, int to,
                     void (*take)(void *context, int row, const float *line), void *context);

#endif
