// glare.h - what the steps from pattern to picture share
#ifndef PASS_GLARE_H
#define PASS_GLARE_H

#include <relume/glare.h>

// `params` (NULL: all default) with defaults filled in. RELUME_EINVAL with a sentence.
relume_status glare_defaults(struct relume_glare_params *out,
                             const struct relume_glare_params *params);

// The pattern in pixels: three planes of (2 reach + 1)^2, each summing to 1.
struct kernel {
    int reach;
    float *v[3];
};
relume_status kernel_create(struct kernel *out, const relume_psf *psf, double pixel,
                            const struct relume_glare_params *params);
void kernel_destroy(struct kernel *kernel);

// Convolution of pictures of one size, in tiles where they are large. Keeps the spectrum of the
// last picture. Thread-safety: one thread at a time.
typedef struct convolver convolver;
relume_status convolver_create(convolver **out, int width, int height, int reach,
                               enum relume_glare_border border, int threads);
void convolver_destroy(convolver **c);
// Whether it is for such pictures.
bool convolver_fits(const convolver *c, int width, int height, int reach,
                    enum relume_glare_border border, int threads);
// out[height][width][3] = in * kernel; `same` promises that `in` is as it was. RELUME_ENOMEM.
relume_status convolver_run(convolver *c, float *out, const float *in, bool same,
                            const struct kernel *kernel);

#endif
