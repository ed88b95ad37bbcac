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
