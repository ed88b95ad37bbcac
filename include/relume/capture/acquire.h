// acquire.h - from photographs of one scene, each under one light, to a capture with known lights
//
// Reads photographs, finds the lights, checks what can be checked, and writes a capture folder:
// linear half-float images, capture.json, lights.lp, lights.svg and report.html.
#ifndef RELUME_ACQUIRE_H
#define RELUME_ACQUIRE_H

#include <relume/base.h>
#include <relume/capture/ball.h>
#include <relume/capture/chart.h>
#include <relume/capture/photometric.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

struct relume_acquire_params {
    size_t struct_size;            // filled by the macro (base.h)
    const struct relume_log *log;  // warnings, progress
    const struct relume_limits *limits;
    const char *const *photographs;  // [photograph_count]
    int photograph_count;
    // The balls stand in photographs of their own: ball_photographs[i] under the light of
    // photographs[i], both in the order given. NULL: the balls stand in the photographs themselves.
    const char *const *ball_photographs;
    int ball_photograph_count;
    const char *mask;         // of the object, or NULL
    const char *ball_mask;    // of the ball, or NULL
    const double (*ball)[3];  // [balls]: x, y, radius of the outlines, pixels; NULL: to be found
    int balls;                // default 1
    bool matte;               // matte white balls; default mirrors
    double fov_deg;           // horizontal field of view; default: orthographic
    double ball_z;            // height of the balls' middles, world units (window: width 2)
    // The lights are known: a file as relume_captured_lights_load reads it, positions with `near`;
    // or a folder of COLMAP's text files that pose a camera tied to the lamp, one photograph for
    // every light in the order of their names, and one of `photographs`. NULL: balls.
    const char *lights;
    bool near;        // positions: from two balls or more, or from `lights`
    bool refine;      // relume_acquire_refine afterwards
    bool brightness;  // the same with its `brightness`
    bool integrable;  // the same with its `integrable`
    bool align;       // bring photographs on top of the first one by homographies
    bool skip_bad;    // leave photographs out that cannot be read, show another scene, or
                      // no highlight; default: an error that names them
    bool force;       // replace an existing folder
    struct relume_transfer transfer;       // overrides what the files say
    struct relume_transfer ball_transfer;  // the same of the balls' own photographs; default: too
    int threads;                           // default: all cores
    // Photographs of an even surface, which the others are divided by: one against vignetting, or
    // one under each light; `radial`: by an even polynomial of the distance from the middle that is
    // fitted to them, else pixel by pixel.
    const char *const *flats;  // [flat_count]
    int flat_count;
    bool radial;   // `flats` as a polynomial
    int white[4];  // x, y, width, height of a region that is grey, which gives the lamps' colour;
                   // width 0: none
    // Colours of the photographs, and of the balls' own, are made right by this matrix; NULL: they
    // are left as they are. Not with `white`.
    const struct relume_chart *chart;
    const char *chart_path;     // of the photograph that shows it; for the report
    const char *likely_lights;  // a file that may be meant as `lights`: where no ball is found the
                                // sentence names it; or NULL
    bool quick;  // the surface is not wanted: `photometric` is fitted to small photographs, of at
                 // most 168 pixels a side, to see whether they fit their lights
};
#define relume_acquire_params(...)                                                                 \
    (&(const struct relume_acquire_params){RELUME_SIZED(relume_acquire_params), __VA_ARGS__})

// One photograph that was used.
struct relume_acquired_photo {
    char *path;                      // as it was given
    float saturated, black;          // shares of the pixels
    float similarity;                // median to others, relume_edge_correlation; NaN: not measured
    float sharpness;                 // fine detail of what it shows, relative to the median of the
                                     // photographs; NaN: not measured
    struct relume_ball_light light;  // by the first ball
    double sigma_deg;                // estimated error of the direction, degrees; 0: not known
    bool outlier;                    // contradicts its light and the others
};

enum { RELUME_ACQUIRE_SUGGESTIONS = 12 };

// What came out. Thread-safety: plain data.
struct relume_acquisition {
    int width, height, lights;
    struct relume_acquired_photo *photo;  // [lights]: those that were used
    struct relume_vec3 *direction;        // [lights], unit
    struct relume_vec3 *position;         // [lights], world units, or NULL
    float (*intensity)[3];                // [lights], or NULL: all 1
    double position_error;     // mean standard error / distance, of triangulated positions
    struct relume_ball *ball;  // [balls] as they were found
    int balls;
    double gap_deg;          // of the upper hemisphere: how far the emptiest direction is
    struct relume_vec3 gap;  // from its nearest light, and which that is
    struct relume_vec3
        wanted[RELUME_ACQUIRE_SUGGESTIONS];  // where lights should be added, widest gap
    int wanted_count;                        // first; until none is wider than 40 degrees
    struct relume_photometric photometric;   // normals, albedo; empty where lights do not allow it
    char **warning;                          // [warnings]: sentences, also sent to the log
    int warnings;
};

// Make the folder `dir`, whole or not at all. On failure `out` is empty. An input status,
// RELUME_EINVAL (the folder exists; counts do not match), RELUME_EIO, RELUME_ENOMEM,
// RELUME_ECANCEL.
RELUME_RESULT relume_status relume_acquire(struct relume_acquisition *out, const char *dir,
                                           const struct relume_acquire_params *params);
RELUME_API void relume_acquisition_destroy(struct relume_acquisition *acquisition);

// How lights are refined. Borrowed while relume_acquire_refine runs; `curl` is filled.
struct relume_acquire_refine_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int threads;
    bool brightness;  // of the lights alone; their directions stay
    // Of the linear map that the images leave open, what makes the surface one of heights (its
    // slopes have no curl; Yuille, Snow 1997) counts more than nearness to the lights given, within
    // some degrees.
    bool integrable;
    double *curl;  // [2], or NULL: RMS of the curl before and after, relative to the surface's
                   // curvature
};
#define relume_acquire_refine_params(...)                                                          \
    (&(const struct relume_acquire_refine_params){RELUME_SIZED(relume_acquire_refine_params),      \
                                                  __VA_ARGS__})
// Better directions and intensities from the images of a planar capture with distant lights:
// surface vectors and lights in turn minimise what Lambert's law misses, shadows and highlights
// left out; the linear map that the images leave open (it contains the bas-relief ambiguity,
// Belhumeur, Kriegman, Yuille 1999) is the one that brings the lights nearest to those given.
// direction[lights] are replaced; intensity[lights] gets relative brightness, mean 1; *residual the
// median miss / albedo before and after. Where the surface does not determine lights better than
// they are (it faces one way, or gloss passes for light: halves of it disagree), they stay,
// intensities are 1, both residuals are equal and curl is 0, with a warning. RELUME_EUNFIT where
// the lights do not span space or there are fewer than 6, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_acquire_refine(
    struct relume_vec3 *direction, double *intensity, double residual[2],
    const relume_capture *capture, const struct relume_acquire_refine_params *params);

#ifdef __cplusplus
}
#endif
#endif
