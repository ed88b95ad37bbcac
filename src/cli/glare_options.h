// glare_options.h - what `glare` and `relight --pass glare` share: an eye, its pattern, a frame
// seen
#ifndef CLI_GLARE_OPTIONS_H
#define CLI_GLARE_OPTIONS_H

#include "cli.h"

// Table rows for a command's options.
#define GLARE_OPTIONS                                                                              \
    {"--subject", OPTION_TEXT, "FILE", "glare: the viewer's eye (JSON, docs/glare.md)", 0, 0},     \
        {"--time", OPTION_NUMBER, "T", "glare: seconds since the eye opened; default: 1", 0, 1e6}, \
        {"--nits", OPTION_NUMBER,                                                                  \
         "L",      "glare: cd/m^2 of the value 1, sets the pupil; default: 100",                   \
         0,        1e9},                                                                           \
        {"--magnify", OPTION_NUMBER, "M", "glare: enlarge the halos; default: 1", 0.01, 1000},     \
        {"--mode", OPTION_TEXT, "M", "glare: fft (default), billboard or hybrid", 0, 0},           \
    {                                                                                              \
        "--border", OPTION_TEXT, "B", "glare: zero (default), clamp or periodic", 0, 0             \
    }

// An eye that looks at a picture, ready to see it.
struct viewer_eye {
    relume_eye *eye;
    relume_psf *psf;
    relume_glare *glare;
    struct relume_glare_params params;
    double luminance;  // of what it looks at, cd/m^2
};
// From a command's options; `field_deg` and `size` of the pattern.
relume_status open_viewer_eye(struct viewer_eye *out, const struct args *args, double luminance,
                              const struct relume_psf_params *psf);
void close_viewer_eye(struct viewer_eye *e);
// `frame` becomes what the eye sees now; `same`: the frame has not changed since.
relume_status see(struct relume_image *out, struct viewer_eye *e, const struct relume_image *frame,
                  bool same);

// Half field and size of a pattern whose halo is whole.
#define GLARE_FIELD_DEG 4.0
enum { GLARE_SIZE = 1536 };

#endif
