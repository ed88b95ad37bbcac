// fft.c - transforms by FFTW (Frigo and Johnson 2005)
#include "core/math/fft.h"

#include "core/base/memory.h"

#include <fftw3.h>
#include <pthread.h>

// Plans are made by one thread at a time, and without measuring, so that they do not differ.
static pthread_mutex_t planning = PTHREAD_MUTEX_INITIALIZER;

relume_status fft_cosine(float *data, int width, int height, bool inverse)
{
    const fftwf_r2r_kind kind = inverse ? FFTW_REDFT01 : FFTW_REDFT10;
    pthread_mutex_lock(&planning);
    const fftwf_plan plan = fftwf_plan_r2r_2d(height, width, data, data, kind, kind, FFTW_ESTIMATE);
    pthread_mutex_unlock(&planning);
    if (!plan)
        return RELUME_ENOMEM;
    fftwf_execute(plan);
    pthread_mutex_lock(&planning);
    fftwf_destroy_plan(plan);
    pthread_mutex_unlock(&planning);
    const float scale = 1.0f / (4.0f * (float)width * (float)height);
    for (size_t i = 0; inverse && i < (size_t)width * (size_t)height; i++)
        data[i] *= scale;
    return RELUME_OK;
}

// ---------------------------------------------------------------- lines

struct fft_line {
    enum fft_kind kind;
    fftwf_plan plan;
};

static fftwf_plan plan_line(int n, enum fft_kind kind, float *in, float *out)
{
    fftwf_complex *const complex_in = (fftwf_complex *)in, *const complex_out =
                                                               (fftwf_complex *)out;
    // lines of an odd length follow each other at places that SIMD would not expect
    const unsigned flags = FFTW_ESTIMATE | FFTW_DESTROY_INPUT | (n % 2 ? FFTW_UNALIGNED : 0);
    switch (kind) {
    case FFT_REAL: return fftwf_plan_dft_r2c_1d(n, in, complex_out, flags);
    case FFT_REAL_INVERSE: return fftwf_plan_dft_c2r_1d(n, complex_in, out, flags);
    default:
        return fftwf_plan_dft_1d(n, complex_in, complex_out,
                                 kind == FFT_FORWARD ? FFTW_FORWARD : FFTW_BACKWARD, flags);
    }
}

relume_status fft_line_create(fft_line **out, int n, enum fft_kind kind)
{
    // Two lines of n + 2 complex numbers, the second again on 16 bytes.
    const size_t half = 2 * (size_t)n + 4;
    float *const lines = mem_array(2 * half, sizeof *lines);
    fft_line *const line = mem_zeroed(1, sizeof *line);
    if (line && lines) {
        line->kind = kind;
        pthread_mutex_lock(&planning);
        line->plan = plan_line(n, kind, lines, lines + half);
        pthread_mutex_unlock(&planning);
    }
    mem_free(lines);
    *out = line && line->plan ? line : NULL;
    if (!*out)
        mem_free(line);
    return *out ? RELUME_OK : RELUME_ENOMEM;
}

void fft_line_destroy(fft_line **line)
{
    if (*line) {
        pthread_mutex_lock(&planning);
        fftwf_destroy_plan((*line)->plan);
        pthread_mutex_unlock(&planning);
    }
    mem_free(*line);
    *line = NULL;
}

void fft_line_run(const fft_line *line, float *in, float *out, float *scratch)
{
    (void)scratch;
    if (line->kind == FFT_REAL)
        fftwf_execute_dft_r2c(line->plan, in, (fftwf_complex *)out);
    else if (line->kind == FFT_REAL_INVERSE)
        fftwf_execute_dft_c2r(line->plan, (fftwf_complex *)in, out);
    else
        fftwf_execute_dft(line->plan, (fftwf_complex *)in, (fftwf_complex *)out);
}
