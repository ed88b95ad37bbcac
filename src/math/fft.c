// fft.c - cosine transforms by FFTW (Frigo and Johnson 2005)
#include "math/fft.h"

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
