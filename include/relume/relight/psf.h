// psf.h - what one point source leaves on the retina of an eye (Ritschel 2009, 8.3, 8.4)
//
// The aperture of an eye (eye.h) is drawn, its diffraction pattern (Eq. 8.3) is summed over
// wavelengths (8.4.3). Angles are of the visual field, in radians unless a name says otherwise.
#ifndef RELUME_PSF_H
#define RELUME_PSF_H

#include <relume/base.h>
#include <relume/image.h>
#include <relume/relight/eye.h>

#ifdef __cplusplus
extern "C" {
#endif

// The transform of an aperture texture of `size` x `size` texels and `width_mm` across: texel
// k of the pattern, counted from its middle, lies at the angle k lambda / width_mm.
struct relume_psf_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    unsigned cpu_off;  // RELUME_CPU_* features not to use
    int threads;       // default: all cores
    int size;          // texels, even, [64, 8192]; default 1024
    // How wide: given in mm, [0.2, 100], or by the half field at 400 nm, (0, 20] degrees: then
    // width_mm = size * 400 nm / 2 half_field. A pupil that is wider than that is folded, which
    // samples the same pattern more sparsely. Default: 9 mm.
    double width_mm, half_field_deg;
    int wavelengths;       // of the chromatic sum, [1, 256]; default 32. 1: 575 nm, grey
    double temperature_k;  // of the light, a black body, [1000, 40000]; default: equal energy
    bool literal;  // as the thesis prints the sum: even steps from 380 nm, no (575 / lambda)^2
    // Depths of the vitreous body between which the wave travels; 0 or 1: all in the pupil plane.
    int planes;            // [0, 16]
    unsigned parts_off;    // RELUME_EYE_* parts not to draw
    bool retina_distance;  // E of Eq. 8.3 with the printed d = 24 mm: a blur, for comparison
};
#define relume_psf_params(...)                                                                     \
    (&(const struct relume_psf_params){RELUME_SIZED(relume_psf_params), __VA_ARGS__})

// What a transform of these parameters covers.
struct relume_psf_geometry {
    int size;              // texels of the aperture
    double width_mm;       // of the aperture texture
    double texel_mm;       // width_mm / size
    double step;           // angle from texel to texel of the pattern: 575 nm / width_mm
    int field;             // texels of the chromatic pattern, odd, centred
    double radius;         // angle where its light has faded out: the half field at 400 nm
    double fade;           // angle where it begins to fade
    double defocus_phase;  // phase of E at 1 mm from the axis for 1 dioptre, radians per mm^2
};
// The geometry of these parameters. RELUME_EINVAL.
RELUME_RESULT relume_status relume_psf_geometry(struct relume_psf_geometry *out,
                                                const struct relume_psf_params *params);

// The pattern of an eye, with the working memory for the next. Thread-safety: one thread at a time.
typedef struct relume_psf relume_psf;
// RELUME_EINVAL with a sentence, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_psf_create(relume_psf **out,
                                              const struct relume_psf_params *params);
RELUME_API void relume_psf_destroy(relume_psf **psf);
// Draw, diffract and sum `eye` as it is now; cornea and fibres are kept for the next time. Lids
// that are shut leave the pattern as it was, with light 0. RELUME_ENOMEM.
RELUME_RESULT relume_status relume_psf_update(relume_psf *psf, const relume_eye *eye);

// Linear RGB, field x field, every channel summing to 1; row 0 is what lies above the source. Some
// values are negative: pure spectral colours lie outside sRGB. RELUME_ENOMEM.
RELUME_RESULT relume_status relume_psf_image(struct relume_image *out, const relume_psf *psf);
// The transmittance as drawn, one channel, size x size, row 0 at the top.
RELUME_RESULT relume_status relume_psf_aperture(struct relume_image *out, const relume_psf *psf);
// It belongs to the pattern.
RELUME_API const struct relume_psf_geometry *relume_psf_shape(const relume_psf *psf);

// Patterns of a while, computed once and shown in a loop: playback costs a copy instead of a
// transform. The loop has no seam: its beginning fades over from what the eye shows after its end.
// Patterns wait as halfs: 6 field^2 bytes each. Thread-safety: never changes; safe.
typedef struct relume_psf_cycle relume_psf_cycle;
struct relume_psf_cycle_params {  // zero in a field means its default
    size_t struct_size;           // filled by the macro (base.h)
    const struct relume_log *log;
    double seconds;    // how long the loop is; default 4
    double fps;        // patterns a second; default 30; at most 3600 in all
    double fade_s;     // of its beginning, at most all of it; default a quarter
    double luminance;  // that the eye adapts to meanwhile, cd/m^2; default: what it has adapted to
};
#define relume_psf_cycle_params(...)                                                               \
    (&(const struct relume_psf_cycle_params){RELUME_SIZED(relume_psf_cycle_params), __VA_ARGS__})

// `eye` lives on for the loop and its fade, and `psf` shows it meanwhile. RELUME_EINVAL with a
// sentence, RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_psf_cycle_create(relume_psf_cycle **out, relume_psf *psf,
                                                    relume_eye *eye,
                                                    const struct relume_psf_cycle_params *params);
RELUME_API void relume_psf_cycle_destroy(relume_psf_cycle **cycle);
// What `psf`, of the same size, shows becomes the loop at a time; between two patterns, a mix of
// both. RELUME_EINVAL for another size, or a time that is not finite.
RELUME_RESULT relume_status relume_psf_cycle_show(relume_psf *psf, const relume_psf_cycle *cycle,
                                                  double time_s);

// CIE 1999 standard observer (CIE 135/1, Vos and van den Berg): the share of a point source's light
// per steradian at an angle in degrees, for an age in years and a pigment of the iris in [0, 1.2].
RELUME_API double relume_cie_glare(double angle_deg, double age, double pigment);

#ifdef __cplusplus
}
#endif
#endif
