// glare_options.h - what `glare` and `relight --pass glare` share: an eye, its pattern, a frame
// seen
#ifndef CLI_GLARE_OPTIONS_H
#define CLI_GLARE_OPTIONS_H

#include "cli.h"

struct eye_options {
    const char *subject;
    enum relume_glare_mode mode;
    enum relume_glare_border border;
    double time, nits, magnify;
};
// Table rows for a command's options; `glare` in its struct, from GLARE_DEFAULTS.
// clang-format off
#define GLARE_OPTIONS                                                                              \
    TEXT("--subject", glare.subject, "FILE", "glare: the viewer's eye (JSON, docs/glare.md)"),     \
    NUMBER("--time", glare.time, "T", "glare: seconds since the eye opened; default: 1", 0, 1e6),  \
    NUMBER("--nits", glare.nits, "L", "glare: cd/m^2 of the value 1; sets the pupil; default: 100",\
           0, 1e9),                                                                                \
    NUMBER("--magnify", glare.magnify, "M", "glare: enlarge the halos; default: 1", 0.01, 1000),   \
    NAME("--mode", glare.mode, "M", "glare: fft (default), billboard or hybrid",                   \
         RELUME_GLARE_FFT, "fft", "billboard", "hybrid"),                                          \
    NAME("--border", glare.border, "B", "glare: zero (default), clamp or periodic",                \
         RELUME_GLARE_ZERO, "zero", "clamp", "periodic")
#define GLARE_DEFAULTS {.time = 1.0, .nits = 100.0}
// clang-format on

// An eye that looks at a picture, ready to see it.
struct viewer_eye {
    relume_eye *eye;
    relume_psf *psf;
    relume_glare *glare;
    struct relume_glare_params params;
    double luminance;  // of what it looks at, cd/m^2
};
// From a command's options; `field_deg` and `size` of the pattern.
relume_status open_viewer_eye(struct viewer_eye *out, const struct args *args,
                              const struct eye_options *options, double luminance,
                              const struct relume_psf_params *psf);
void close_viewer_eye(struct viewer_eye *e);
// `frame` becomes what the eye sees now; `same`: the frame has not changed since.
relume_status see(struct relume_image *out, struct viewer_eye *e, const struct relume_image *frame,
                  bool same);

// Half field and size of a pattern whose halo is whole.
#define GLARE_FIELD_DEG 4.0
enum { GLARE_SIZE = 1536 };

#endif
