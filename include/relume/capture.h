// capture.h - one scene under many lights: the manifest, its images, the reflectance table
#ifndef RELUME_CAPTURE_H
#define RELUME_CAPTURE_H

#include <relume/base.h>
#include <relume/camera.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

// One view: its place and its files.
struct relume_manifest_view {
    double uv[2];         // slab: where the camera stands on the uv plane
    int slab;             // which of several slabs
    const char **images;  // [lights], relative to the manifest
    const char *depth;    // or NULL
    const char *mask;     // or NULL
};

// What capture.json says. Everything is borrowed. Thread-safety: plain data.
struct relume_manifest {
    struct relume_transfer transfer;
    struct relume_geometry geometry;
    int slabs;  // around an object, each with its own pose; 0: `geometry` is all there is
    const struct relume_geometry *slab;  // [slabs]; the first is `geometry`
    int lights;
    const struct relume_vec3 *directions;  // [lights], unit
    const struct relume_vec3 *positions;   // [lights], world units, or NULL: distant lights
    bool no_falloff;     // positions: light does not fall with the square of the distance
    bool display_coded;  // the images were made of photographs that hold display values, of which 1
                         // is white, though they may hold linear light by now
    // Brightness of lights; NULL: all 1. For positions with falloff it is the power of lamps; a
    // lamp at the root mean square of all distances from 0, 0, 0 shows its value there.
    const float (*intensities)[3];  // [lights]
    bool intensities_at_origin;     // positions: what each lamp shows at 0, 0, 0, not its power;
                                    // relume_capture_manifest states them so
    int views;
    const struct relume_manifest_view *view;  // [views]
    const char *provenance;  // where the photographs come from, a JSON object (docs/format.md), or
                             // NULL
};

// Write `path` (capture.json) whole or not at all. RELUME_EINVAL for the transfer of a response,
// RELUME_EIO, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_manifest_write(const struct relume_manifest *manifest,
                                                  const char *path, const struct relume_log *log);

// An opened capture. Never changes after opening. Thread-safety: safe.
typedef struct relume_capture relume_capture;

// How a capture is opened. Borrowed during the call, but for the log's context, which must outlive
// the capture.
struct relume_capture_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_limits *limits;
    struct relume_transfer transfer;  // overrides the manifest's; default: the manifest's
    bool skip_missing;                // drop lights whose image does not exist instead of failing
    bool allow_outside;               // files may lie outside the folder of capture.json or .lp:
                                      // names with "..", and absolute ones; default: refused
    bool repair;  // tables replace pixels that hold NaN or infinity instead of failing: by those
                  // of the same place under the three nearest lights where it is whole, weighted
                  // by 1 / angle; black where there is none
    double assume_depth;  // near lights: where a view has no depth its surface is so far from the
                          // eye, world units; default: it lies on the plane z = 0 (planar), on the
                          // st plane (slabs), or not near at all (panoramas)
    size_t keep_bytes;  // images of 8 bits that a table has read stay decoded in memory up to this
                        // many bytes, so that later tables of the view are cheap; default: none
    const char *scratch;  // depth and masks of more than 64 MB lie in temporary files beside this
                          // path (default: $TMPDIR), and where it is given images that do not fit
                          // into keep_bytes, up to half of limits.max_memory
};
#define relume_capture_params(...)                                                                 \
    (&(const struct relume_capture_params){RELUME_SIZED(relume_capture_params), __VA_ARGS__})

// Open capture.json, a folder that holds one, or a .lp file; every image's header is checked: it
// exists, can be read and has the common size. Returns an input status, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_capture_open(relume_capture **out, const char *path,
                                                const struct relume_capture_params *params);
RELUME_API void relume_capture_destroy(relume_capture **capture);
// The same capture with some of its lights, in the order of `light[lights]`. What it was opened
// with is borrowed: `capture` must outlive it. RELUME_EINVAL for a light that is not there,
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_capture_select(relume_capture **out,
                                                  const relume_capture *capture, const int *light,
                                                  int lights);

// How the samples of pictures in memory are stored.
enum relume_sample {
    RELUME_SAMPLE_FLOAT = 0,  // float, linear unless the manifest says otherwise
    RELUME_SAMPLE_8,          // uint8_t, 255 is white, sRGB unless the manifest says otherwise
    RELUME_SAMPLE_16,         // uint16_t, 65535 is white, likewise
};

// The pictures of a capture in memory, row 0 at the top. Borrowed.
struct relume_pictures {
    enum relume_sample sample;  // type of the numbers
    int width, height;
    int channels;        // 1: grey; 3: red, green, blue; 4: and something that is not looked at
    const void *data;    // [views][lights][height][width][channels]
    const float *depth;  // [views][height][width] or NULL, as the files of a capture.json
    const float *mask;   // likewise
};

// A capture of pictures in memory, which must stay as they are as long as it lives. `manifest` says
// what a capture.json would and is copied: at least `lights` and `directions` (of any length but 0)
// or `positions`. Its names of files are not looked at. `view` may be NULL and `views` 0: one view.
// `geometry`: begin with relume_geometry_default; all zero is a planar picture. Of `params`,
// skip_missing, allow_outside and keep_bytes do not count. Messages begin with "memory".
// An input status as for relume_capture_open, RELUME_EINVAL for samples, sizes or channels that
// cannot be, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_capture_create(relume_capture **out,
                                                  const struct relume_manifest *manifest,
                                                  const struct relume_pictures *pictures,
                                                  const struct relume_capture_params *params);

// The manifest as understood: defaults filled in, vectors normalised, paths made absolute or
// relative to the working folder.
RELUME_API const struct relume_manifest *relume_capture_manifest(const relume_capture *capture);
// Pixels of every image.
RELUME_API int relume_capture_width(const relume_capture *capture);
// Pixels of every image; a cylinder with its discs has more rows than the cylinder.
RELUME_API int relume_capture_height(const relume_capture *capture);
// The pole is y (panoramas, several slabs), not z (planar, one slab).
RELUME_API bool relume_capture_pole_y(const relume_capture *capture);
// No light lies below -0.1 along the pole.
RELUME_API bool relume_capture_hemispherical(const relume_capture *capture);

enum { RELUME_DIGEST = 17 };

// The largest value that images under `light` can hold, linear, intensity divided out: there they
// clip. Infinite for floating-point files, unless the manifest says `display_coded`.
RELUME_API void relume_capture_white(const relume_capture *capture, int light, float rgb[3]);

// One image, linear, light intensity divided out, three channels; so is the fall-off of near
// lights (positions): as if the light reached every pixel as strongly as the world's origin.
// NaN and infinity are RELUME_EDAMAGED.
RELUME_RESULT relume_status relume_capture_image(struct relume_image *out,
                                                 const relume_capture *capture, int view, int light,
                                                 const struct relume_log *log);
// Depth or mask of a view, one channel; `*out` is empty when the view has none.
RELUME_RESULT relume_status relume_capture_depth(struct relume_image *out,
                                                 const relume_capture *capture, int view,
                                                 const struct relume_log *log);
// The mask likewise: above 0.5 where the object is. An input status, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_capture_mask(struct relume_image *out,
                                                const relume_capture *capture, int view,
                                                const struct relume_log *log);

#ifdef __cplusplus
}
#endif
#endif
