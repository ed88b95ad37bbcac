// pattern.h - the scattering pattern of an eye, by light and by spectrum
#ifndef EYE_PATTERN_H
#define EYE_PATTERN_H

#include <relume/relight/psf.h>

// One wavelength of the chromatic sum: F_s(x) = sum_i rgb_i F_575(scale_i x), x measured from the
// middle. The weights hold spectrum, colour matching functions (CIE 1931), the matrix to linear
// sRGB and the factor (575 / lambda)^2 that gives every wavelength the same energy; each channel's
// sum is such that the whole pattern of an unbounded field would sum to 1.
struct relume_psf_tap {
    float scale;   // 575 nm / lambda
    float rgb[3];  // what it adds, linear
};
// Between two neighbours the pattern is smeared by `fine` more scales first, evenly weighted, so
// that needles are lines and not beads: F_575(x) := sum_j F_575(fine[j] x) fine[j]^2 / fines.
enum { RELUME_PSF_MOST_TAPS = 256, RELUME_PSF_MOST_FINE = 8 };
// The wavelengths of a pattern and what each adds. Plain data.
struct relume_psf_spectrum {
    int taps, fines;
    struct relume_psf_tap tap[RELUME_PSF_MOST_TAPS];  // [taps]
    float fine[RELUME_PSF_MOST_FINE];                 // [fines]
};
// The spectrum of these parameters. RELUME_EINVAL.
relume_status relume_psf_spectrum(struct relume_psf_spectrum *out,
                                  const struct relume_psf_params *params);

// How long the last update's stages took, seconds (Table 8.2).
struct relume_psf_times {
    double aperture_s, diffraction_s, chromatic_s;  // of drawing, transforming, summing wavelengths
};
// Of the last pattern.
struct relume_psf_times relume_psf_times(const relume_psf *psf);

// The share of light that the lids let through, [0, 1].
double relume_psf_light(const relume_psf *psf);
// The pattern at 575 nm, one channel, size x size with angle 0 at (size / 2, size / 2), sum 1.
relume_status relume_psf_monochrome(struct relume_image *out, const relume_psf *psf);

#endif
