// veil.h - single pixels of glare
#ifndef EYE_VEIL_H
#define EYE_VEIL_H

#include <relume/relight/glare.h>

// The angle of one pixel in the middle of a frame of that width.
double relume_glare_pixel(double fov_deg, int width);

// The pattern at the frame's scale, odd size, every channel summing to 1: that of `psf` resampled
// from psf->step to `pixel` radians over `magnify`, and the CIE veil beyond it, which
// is the observer's up to 7.5 degrees and fades out until 12.5. The subject that
// was seen last gives the veil's age and pigment. RELUME_EINVAL, RELUME_ENOMEM.
relume_status relume_glare_kernel(struct relume_image *out, const relume_psf *psf, double pixel,
                                  const struct relume_glare_params *params);

// That veil from where a pattern fades out to RELUME_VEIL_DEG, for kernels made elsewhere: pattern
// (1 - share) + light * a pixel's solid angle, and all of it divided by its sum.
#define RELUME_VEIL_DEG 12.5
enum { RELUME_VEIL_STEPS = 2048 };
// Light that is scattered farther than the pattern reaches, by angle. Plain data.
struct relume_veil {
    double step;                         // radians from number to number
    float light[RELUME_VEIL_STEPS + 2];  // per steradian at that angle, linear between; the last
                                         // two are 0
    double share;                        // of all light; 0: the pattern reaches as far itself
};
// The veil around that pattern: age in years, pigment of the iris as in struct relume_subject.
void relume_veil(struct relume_veil *out, const struct relume_psf_geometry *pattern, double age,
                 double pigment);

#endif
