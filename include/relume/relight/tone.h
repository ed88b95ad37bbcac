// tone.h - linear light becomes what a screen can show: exposure, then a tone operator
//
// An operator takes linear light of any size to linear light in [0, 1]; the sRGB curve comes after
// it, when a picture is saved or presented. Sources stand at each operator in
// src/relight/eye/tone.c.
#ifndef RELUME_TONE_H
#define RELUME_TONE_H

#include <relume/base.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

// Thread-safety: constant data.
struct relume_tone {
    const char *name;   // "filmic"
    const char *about;  // half a line for people
    // `white` is the luminance that becomes 1, where the operator knows one; > 0.
    void (*apply)(float out[3], const float rgb[3], float white);
};
extern RELUME_API const struct relume_tone relume_tone_linear;    // clipped
extern RELUME_API const struct relume_tone relume_tone_reinhard;  // of the luminance
extern RELUME_API const struct relume_tone relume_tone_filmic;    // of each channel
extern RELUME_API const struct relume_tone relume_tone_gamma;     // 2.2 in place of the sRGB curve
// All of them, ending with NULL; the place in the list is what a viewer may keep.
extern RELUME_API const struct relume_tone *const relume_tones[];

// How linear light becomes what a screen shows. Borrowed during the call.
struct relume_tone_params {
    size_t struct_size;              // filled by the macro (base.h)
    const struct relume_tone *tone;  // default: linear
    double exposure_ev;              // multiply by 2^EV first
    double white;                    // default: RELUME_TONE_WHITE
};
// The default of `white`.
#define RELUME_TONE_WHITE 4.0
#define relume_tone_params(...)                                                                    \
    (&(const struct relume_tone_params){RELUME_SIZED(relume_tone_params), __VA_ARGS__})

// Apply to every pixel of `image`, three channels, in place. RELUME_EINVAL.
RELUME_RESULT relume_status relume_tone_apply(struct relume_image *image,
                                              const struct relume_tone_params *params);

// The exposure in EV that takes the log-average luminance of `image` to 0.18, a mid grey (Reinhard
// 2002, Eq. 1), in [-16, 16]. The darkest tenth and the brightest fiftieth of the luminances are
// left out, and so is what is black: 2^-20 of the brightest and below, and what would be 0 in 8
// bits if that fiftieth began at white. 0 for a black image.
RELUME_API double relume_tone_meter(const struct relume_image *image);
// The exposure in EV that takes the bright parts of `image` to 0.9, in [-16, 16]. These are the
// 99th percentile of the pixels' largest channels; black pixels do not count. 0 for a black image.
RELUME_API double relume_tone_meter_bright(const struct relume_image *image);
// Returns the second for the linear curve, the first for curves that bend highlights.
RELUME_API double relume_tone_meter_for(const struct relume_image *image,
                                        const struct relume_tone *tone);

#ifdef __cplusplus
}
#endif
#endif
