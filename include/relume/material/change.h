// change.h - two captures of one object at two dates: what of its shape and colour has changed
//
// Each capture becomes a surface by itself (Woodham 1980, robustly): normals and albedo do not
// depend on lamps, exposure and, but for their place, on the camera. The second one is laid upon
// the first by a homography (enhanced correlation, Evangelidis and Psarakis 2008) and a smooth
// flow. What two captures of an unchanged object differ in all over the picture is then taken away:
// a linear map of the normals and a smooth bend (lights not known quite rightly), a smooth gain of
// each colour (exposure, lamps). How uncertain each pixel is comes from the captures themselves:
// the surface is found twice more, each time by half of the lights, and the halves differ as two
// captures would; what a wrong place of a fraction of a pixel would make is added. So a difference
// becomes a probability, its scale set so that the bulk of the picture is as chance has it (the
// empirical null of Efron 2004), and of the pixels that are marked at most a given share is marked
// by chance (Benjamini, Hochberg 1995).
#ifndef RELUME_CHANGE_H
#define RELUME_CHANGE_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/capture/align.h>
#include <relume/image.h>
#include <relume/pack.h>

#ifdef __cplusplus
extern "C" {
#endif

// One of the two: a capture, or a file, which is relit under its own lights (at most 64 of them).
struct relume_change_input {
    const relume_capture *capture;  // or NULL
    relume_pack *pack;              // or NULL
    int view;                       // of a slab
};

// How captures are compared. Borrowed during the call.
struct relume_change_params {
    size_t struct_size;            // filled by the macro (base.h)
    const struct relume_log *log;  // progress, warnings
    int threads;                   // default: all cores
    double least_deg;              // smaller turns of the normal are no change, degrees; default 2
    double least_de;               // smaller differences of colour are none, CIEDE2000; default 2
    double false_share;   // of the marked pixels, at most marked by chance, (0, 0.5]; default 0.01
    int least_area;       // pixels of the smallest place; default 16
    double max_roll_deg;  // how far the second may be turned in its plane, up to 180; default 12
    bool keep_bend;       // a smooth bend of the whole surface counts as change
    double least_gloss;   // smaller differences of gloss are none, [0, 1] of white; default 0.03
};
#define relume_change_params(...)                                                                  \
    (&(const struct relume_change_params){RELUME_SIZED(relume_change_params), __VA_ARGS__})

// One place that has changed.
struct relume_change_place {
    struct relume_rect box;  // pixels of the first capture
    int area;                // pixels
    int shape, colour;       // of them: the normal has changed, the colour
    double deg;              // mean turn of the normal, degrees
    double delta_e;          // mean difference of colour, CIEDE2000
    double significance;     // -log10 of the least probability in it, at most 300
    int gloss;               // pixels whose gloss alone has changed
    double gloss_by;         // mean difference of gloss, the second's less the first's, of white
};

// What was found. Pictures have the size of the first capture. Thread-safety: plain data.
struct relume_change {
    int width, height;
    struct relume_image
        normal[2];  // three channels: unit vectors; 0 where one of both is not known
    struct relume_image
        albedo[2];                // three: linear, the first's bright parts at 0.8; both registered
    struct relume_image degrees;  // one: between the normals
    struct relume_image delta_e;  // one: between the colours, CIEDE2000
    struct relume_image significance;  // three: -log10 of the probability that chance makes this
                                       // of the shape, of the colour, of the gloss
    struct relume_image changed;  // three: 1 where the shape has changed, the colour, anything; the
                                  // third alone: the gloss
    struct relume_homography registered;  // pixels of the first -> of the second
    double flow;                          // pixels, the longest step of the smooth flow
    double misplaced;                     // pixels, how far places are off afterwards (estimated)
    double bend_deg;                      // largest smooth bend that was taken away, degrees
    double gain[3];                       // of the second's colours, mean over the picture
    double noise_deg, noise_de;  // medians of the uncertainty of a pixel, one standard deviation
    size_t known;                // pixels that both captures show
    size_t area, shape, colour;  // pixels that have changed; by shape, by colour
    struct relume_change_place *place;  // [places], largest first
    int places;
    // One channel: how much brighter highlights are in the second capture, of white, where a lobe
    // of cos^16 around the mirror direction is seen by enough lamps of both; else 0.
    struct relume_image gloss;
    double noise_gloss;              // median of its uncertainty, one standard deviation
    size_t gloss_known, gloss_area;  // pixels where both captures tell gloss; where it alone has
                                     // changed
};

// Compare two captures of one object: planar ones, or views of a slab. RELUME_EUNFIT with a
// sentence when they do not show the same object, when lights do not span space or are fewer than
// four, or share no pixels; RELUME_EUNSUPPORTED for panoramas; RELUME_EINVAL for params out of
// their range and views that are not there; an input status, RELUME_EIO, RELUME_ENOMEM,
// RELUME_ECANCEL.
// `*out` is empty on failure.
RELUME_RESULT relume_status relume_change_find(struct relume_change *out,
                                               const struct relume_change_input *before,
                                               const struct relume_change_input *after,
                                               const struct relume_change_params *params);
RELUME_API void relume_change_destroy(struct relume_change *change);

// What is written of it.
struct relume_change_write_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int threads;          // default: all cores
    bool force;           // replace a folder that relume made
    const char *name[2];  // how the report calls the captures; default: "before", "after"
    int places;           // listed in the report, at most; default 20
};
#define relume_change_write_params(...)                                                            \
    (&(const struct relume_change_write_params){RELUME_SIZED(relume_change_write_params),          \
                                                __VA_ARGS__})

// Write the folder `path` (docs/change.md), whole or not at all: report.html, pictures, EXR files
// of what was measured. RELUME_EINVAL, RELUME_EIO, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_change_write(const struct relume_change *change,
                                                const char *path,
                                                const struct relume_change_write_params *params);

#ifdef __cplusplus
}
#endif
#endif
