// glare.h - the frame as a living eye would see it: convolved with the eye's pattern (psf.h)
#ifndef RELUME_GLARE_H
#define RELUME_GLARE_H

#include <relume/base.h>
#include <relume/image.h>
#include <relume/relight/psf.h>

#ifdef __cplusplus
extern "C" {
#endif

// How the pattern comes onto the frame.
enum relume_glare_mode {
    RELUME_GLARE_FFT = 0,    // every pixel is a source
    RELUME_GLARE_BILLBOARD,  // bright spots only, each one picture of the pattern at its centroid
    RELUME_GLARE_HYBRID,     // the brightest pixels by the pattern, the rest by a coarse veil
};
// What is around the frame.
enum relume_glare_border {
    RELUME_GLARE_ZERO = 0,  // black around the frame: some light leaves it
    RELUME_GLARE_CLAMP,     // the border's pixels go on
    RELUME_GLARE_PERIODIC,  // the frame repeats
};
// RELUME_EINVAL when `name` is none of relume_glare_mode_names.
RELUME_RESULT relume_status relume_glare_mode_parse(enum relume_glare_mode *out, const char *name);
// RELUME_EINVAL when `name` is none of relume_glare_border_names.
RELUME_RESULT relume_status relume_glare_border_parse(enum relume_glare_border *out,
                                                      const char *name);
RELUME_API const char *const *relume_glare_mode_names(void);  // by number, then NULL
// All names; NULL ends the list.
RELUME_API const char *const *relume_glare_border_names(void);

// How a glare pattern is laid over a frame. Borrowed during the call.
struct relume_glare_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int threads;     // default: all cores
    double fov_deg;  // horizontal field of view of the frame, perspective, [0.01, 170]; default 45
    double magnify;  // of the pattern against the frame, [0.01, 1000]; default 1
    enum relume_glare_mode mode;      // default: FFT
    enum relume_glare_border border;  // default: ZERO
    // BILLBOARD, HYBRID: pixels of at least this luminance are sources; default: chosen so that
    // there are at most `sources`.
    double threshold;
    int sources;      // [1, 1048576]; default 256
    bool no_veil;     // leave out the analytic veil beyond the pattern
    bool keep_light;  // closing lids do not darken the frame
};
#define relume_glare_params(...)                                                                   \
    (&(const struct relume_glare_params){RELUME_SIZED(relume_glare_params), __VA_ARGS__})

// The angle of one pixel in the middle of a frame of that width.
RELUME_API double relume_glare_pixel(double fov_deg, int width);

// The pattern at the frame's scale, odd size, every channel summing to 1: that of `psf` resampled
// from psf->step to `pixel` radians over `magnify`, and the CIE veil beyond it, which
// is the observer's up to 7.5 degrees and fades out until 12.5. The subject that
// was seen last gives the veil's age and pigment. RELUME_EINVAL, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_glare_kernel(struct relume_image *out, const relume_psf *psf,
                                                double pixel,
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
RELUME_API void relume_veil(struct relume_veil *out, const struct relume_psf_geometry *pattern,
                            double age, double pigment);

// Work on frames of one size keeps what does not change: plans, and the spectrum of a frame that
// rests. Thread-safety: one thread at a time.
typedef struct relume_glare relume_glare;
// Empty; the caller destroys it. RELUME_ENOMEM.
RELUME_RESULT relume_status relume_glare_create(relume_glare **out);
RELUME_API void relume_glare_destroy(relume_glare **glare);
// `frame`, three channels, as an eye with the pattern `psf` sees it; `out` is created with the same
// size. Pixels that are not numbers count as black, infinite ones as the brightest finite one;
// negative ones are kept. Same bits for any number of threads. `same_frame` promises that `frame`
// has not changed since the last call. RELUME_EINVAL with a sentence, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_glare_apply(struct relume_image *out, relume_glare *glare,
                                               const struct relume_image *frame, bool same_frame,
                                               const relume_psf *psf,
                                               const struct relume_glare_params *params);

// Mean BT.709 luminance of a frame, never negative; times cd/m^2 per unit it is what an eye adapts
// to.
RELUME_API double relume_glare_luminance(const struct relume_image *frame);

#ifdef __cplusplus
}
#endif
#endif
