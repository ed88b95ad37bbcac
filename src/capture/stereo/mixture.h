// mixture.h - the sum of parts with positive weights that is nearest to samples
#ifndef STEREO_MIXTURE_H
#define STEREO_MIXTURE_H

#include "capture/stereo/reflect.h"

// Normal equations of weighted least squares.
struct mixture {
    unsigned which;  // parts that may be used
    double gram[REFLECT_PARTS][REFLECT_PARTS], b[REFLECT_PARTS], energy;
};

// Add the samples of one pixel, of which `scale` x parts are expected; `scratch` has `stride`
// floats.
void mixture_add(struct mixture *to, const float *parts, size_t stride, float scale,
                 const float *value, const float *weight, float *scratch);
// By coordinate descent from what `part` holds; returns what is missed.
double mixture_solve(const struct mixture *mixture, float part[REFLECT_PARTS], int sweeps);

#endif
