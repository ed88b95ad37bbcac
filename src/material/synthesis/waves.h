// waves.h - a texture's channel as a few waves whose periods need not fit into the sample
#ifndef SYNTHESIS_WAVES_H
#define SYNTHESIS_WAVES_H

#include <relume/material/synthesis.h>

// One channel, in steps of 1/255, its mean among the waves.
struct plane {
    int width, height;
    double *value;  // [height][width]
};

struct waves {
    struct relume_wave *wave;
    int count;
};

// The largest first, until they are smaller than `threshold` or `most`; the mean is wave 0 and does
// not count. Places are those of the maxima of the fractional Fourier transform, one after the
// other. RELUME_ENOMEM.
relume_status waves_find(struct waves *out, const struct plane *plane, double threshold, int most,
                         int threads);

// Fit the weights of all waves to the plane together (least squares), with `steps` above 0 also
// their places (Levenberg and Marquardt). `*rest` is the mean square of what is left; with
// `before`, not NULL, also of what was. Waves too near each other for a solution stay as they are.
// RELUME_ENOMEM.
relume_status waves_fit(struct waves *w, const struct plane *plane, int steps, double *rest,
                        double *before);

// cos and sin of 2 pi k j / m for j from 0 on.
void waves_turn(double *cosine, double *sine, int count, double k, int m);

#endif
