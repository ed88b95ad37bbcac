// psf.h - what the steps to a point spread share
#ifndef POST_PSF_H
#define POST_PSF_H

#include "core/kernel/kernels.h"
#include "relight/eye/pattern.h"
#include "relight/eye/pupil.h"

#include <relume/relight/psf.h>

#define PSF_NM 575.0  // the wavelength that is computed; the others are scaled copies (8.4.3)

// `params` (NULL: all default) with defaults filled in. RELUME_EINVAL with a sentence.
relume_status psf_defaults(struct relume_psf_params *out, const struct relume_psf_params *params);

// A square picture of one channel for lookups between its texels; (middle, middle) is angle 0.
struct plane {
    int n, middle;  // texels that may be read: [0, n)
    size_t stride;
    float *v;
};

// The fine smear: out = sum_j in(fine_j x) fine_j^2 / fines, as far as `in` goes.
void chromatic_smear(struct plane *out, const struct plane *in,
                     const struct relume_psf_spectrum *spectrum, const struct psf_kernels *kernels,
                     int threads, float *work);
// The sum over wavelengths: three pictures out[c][field][field] with their middle in the middle,
// faded out from `fade` to `radius` texels, each summing to 1. `sums`[field] is scratch.
void chromatic_sum(float *const out[3], int field, const struct plane *in,
                   const struct relume_psf_spectrum *spectrum, double fade, double radius,
                   const struct psf_kernels *kernels, int threads, float *work, double (*sums)[3]);
// Floats of `work` for either, for pictures up to n texels.
size_t chromatic_work(int n, int threads);

// As relume_psf_update, of any aperture.
relume_status psf_update_aperture(relume_psf *psf, const struct relume_aperture *aperture,
                                  double dioptres);
// Three channels of the pattern as they lie in memory, each field x field and summing to 1.
const float *psf_channel(const relume_psf *psf, int channel);
// For whoever fills them otherwise, and then says of what.
float *psf_channel_to_fill(relume_psf *psf, int channel);
void psf_filled(relume_psf *psf, double light, double age, double pigment);
int psf_threads(const relume_psf *psf);
// Age and pigment of the subject that was seen last.
void psf_observer(const relume_psf *psf, double *age, double *pigment);

#endif
