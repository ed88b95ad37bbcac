// gl_fft.h - Fourier transforms of lines in a buffer, by compute shaders
#ifndef VIEWER_GL_FFT_H
#define VIEWER_GL_FFT_H

#include "gl/program.h"

enum { GL_FFT_LENGTHS = 4 };

// Programs for the lengths that were used last. All zero: none yet.
struct gl_fft {
    struct gl_fft_length {
        int length;
        uint64_t used;
        struct program program;
        GLuint turns;  // buffer of exp(-2 pi i k / length)
    } of[GL_FFT_LENGTHS];
    uint64_t uses;
};

// The least length of at least n that can be transformed, at least 64: 4, 5, 6 or 8 times a power
// of two. 0 when the card's groups have no memory for such a line.
int gl_fft_length(const struct gl *gl, int n);

// Lines of complex numbers (two floats) in buffer binding 0: `lines` of them from `first` on, in
// each of `planes`. Distances in numbers: from number to number, line to line, plane to plane.
struct gl_fft_lines {
    int length, first, lines, planes;
    int stride[3];
    bool inverse;
};
// In place, not normalised. Later shaders see the result. RELUME_ESYSTEM.
relume_status gl_fft_run(struct gl_fft *fft, const struct gl *gl, const struct gl_fft_lines *lines,
                         const struct relume_log *log);
void gl_fft_destroy(struct gl_fft *fft, const struct gl *gl);

#endif
