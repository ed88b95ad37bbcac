// acquire.h - from photographs of one scene, each under one light, to a capture with known lights
//
// Reads photographs, finds the lights, checks what can be checked, and writes a capture folder:
// linear half-float images, capture.json, lights.lp, lights.svg and report.html. `relume capture`
// makes the same call.
#ifndef RELUME_ACQUIRE_H
#define RELUME_ACQUIRE_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/capture/ball.h>
#include <relume/capture/chart.h>
#include <relume/capture/photometric.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

// Parameters of a capture of photographs. Paths name files and folders, as relume_photographs_list
// takes them. Zero or NULL in a field means its default. Borrowed during the call.
struct relume_acquire_params {
    size_t struct_size;            // filled by the macro (base.h)
    const struct relume_log *log;  // warnings, progress
    const struct relume_limits *limits;
    struct relume_transfer transfer;  // overrides what the files say
    const char *mask;  // white where the object is; default: the mask among the photographs
    bool skip_bad;     // leave photographs out that cannot be read or show another scene; default:
                       // an error or a warning that names them
    bool force;        // replace an existing folder
    int threads;       // default: all cores

    // Finding the lights. The lights are known: a file as relume_captured_lights_load reads it,
    // positions with `near`; or a folder of COLMAP's text files that pose a camera tied to the
    // lamp, one photograph for every light in the order of their names, and one of the
    // photographs. Default: balls where a member below describes them, else the list that lies
    // with the photographs, else one mirror ball.
    const char *lights;
    bool near;                // positions: from balls, or from `lights`
    const double (*ball)[3];  // [balls]: x, y, radius of the outlines, pixels; default: found
    int balls;                // at most 16; default: all mirror balls, one matte ball
    bool distant;             // directions, even where two balls show that lamps are near; default:
                              // positions there
    bool matte;               // matte white balls; default mirrors
    const char *ball_mask;    // white where the ball is
    // Separate photographs of the balls, one under the light of each photograph, both in the order
    // of their names; default: the balls stand in the photographs themselves.
    const char *const *ball_photographs;  // [ball_photograph_count]
    int ball_photograph_count;
    struct relume_transfer ball_transfer;  // of these; default: `transfer`
    double ball_z;                         // height of the balls' middles, world units
    double fov_deg;                        // horizontal field of view; default: orthographic
    double focal_mm;                       // the same as a focal length, for a sensor 36 mm wide
    bool refine_lights;                    // directions and brightness, by the photographs
    bool refine_brightness;                // the brightness alone, by the photographs
    bool integrable;                       // refine_lights with its `integrable`

    // Corrections
    int white[4];  // x, y, width, height of a grey region, which gives the lamps' colour;
                   // width 0: none
    // A photograph of a ColorChecker 24 whose colours are made right; "auto": the target stands in
    // the photographs. Not with `white`.
    const char *target;
    const double (*target_corner)[2];  // [4] pixels of its corners, in order; default: found
    const char *target_values;         // a file of its measured patches (docs/colour-target.md)
    // Photographs of an even surface, which the others are divided by: one against vignetting, or
    // one under each light.
    const char *const *flats;  // [flat_count]
    int flat_count;
    bool radial;  // by an even polynomial of the distance from the middle that is fitted to
                  // `flats`; default: pixel by pixel
    bool align;   // bring photographs on top of the first one by homographies
    bool no_registration;  // leave photographs as they are where the camera was moved; default:
                           // shifts of half a pixel and more are found and taken out

    // The part of the photographs that the capture holds, once the lights are known: x, y, width,
    // height in pixels; width 0: all. The window keeps its coordinates, so that near lights, masks
    // and scales stay right.
    int crop[4];
    bool crop_auto;  // the object, by its relief, without balls and table; all where it fills them

    // By-products: pictures that are written beside the capture. Default: none.
    const char *normals, *albedo, *height;
    double width_mm;  // of the photographs, not cropped: `height` in millimetres; default: world
                      // units
    bool surface;     // the report's `photometric` at full size, as it is fitted for by-products;
                      // default: of at most 168 pixels a side, to see whether photographs fit
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
    double shift[2];                 // pixels to the right and down by which the scene lay beside
                                     // where most photographs have it; taken out
    struct relume_ball_light light;  // by the first ball
    double sigma_deg;                // estimated error of the direction, degrees; 0: not known
    bool outlier;                    // contradicts its light and the others
};

enum { RELUME_ACQUIRE_SUGGESTIONS = 12 };

// Report of a capture that was made. Thread-safety: plain data.
struct relume_acquisition {
    int width, height, lights;
    int crop[4];  // x, y, width, height of the part that was kept; width 0: all. Balls and shifts
                  // are in pixels of the whole photographs
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
    int left_out;                            // photographs that are of no use; warnings name them
    char **warning;                          // [warnings]: sentences, also sent to the log
    int warnings;
    double direction_error_deg;  // root mean square over the lights of sigma_deg
    char *target;                // the photograph that shows the colour target, or NULL
    struct relume_chart chart;   // the colour target, with `target`
};

// Makes the capture folder `dir` from `count` paths of photographs, in the order of the numbers in
// their names: whole or not at all. By-products follow once the folder is there. `report` (may be
// NULL) is empty on failure, else to be destroyed. RELUME_EINVAL (members that exclude each other;
// the folder exists), an input status, RELUME_EUNFIT (counts that do not match, no lights found, no
// target, normals that the lights do not allow), RELUME_EIO, RELUME_ENOMEM, RELUME_ECANCEL. Output
// bytes do not depend on `threads`. Thread-safe.
RELUME_RESULT relume_status relume_capture_photographs(const char *dir,
                                                       const char *const *photographs, int count,
                                                       const struct relume_acquire_params *params,
                                                       struct relume_acquisition *report);

// Opens a capture as relume_capture_open does. acquire->crop keeps a part of planar captures and
// slabs. The photographs of a list, a .lp file with three or more or its folder, pass the steps
// above on the way, and stay in their files. The capture equals the folder that
// relume_capture_photographs makes with the list as `lights`: encoded, they have the same bytes.
// Turned and moved photographs, and those of another colour space, are kept in memory up to
// params->keep_bytes, then in temporary files beside params->scratch. `acquire` may be NULL; its
// log, limits, transfer and output are ignored. `report` may be NULL; for other captures it has
// only `crop`, and it may lack `photometric`. Fails as relume_capture_photographs does.
RELUME_RESULT relume_status relume_capture_open_photographs(
    relume_capture **out, const char *path, const struct relume_capture_params *params,
    const struct relume_acquire_params *acquire, struct relume_acquisition *report);
RELUME_API void relume_acquisition_destroy(struct relume_acquisition *acquisition);

#ifdef __cplusplus
}
#endif
#endif
