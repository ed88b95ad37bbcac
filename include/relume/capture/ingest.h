// ingest.h - photographs from several places, or all around one, become a capture
//
// A camera's photographs are one file (fixed lighting: a capture of one light), or a folder that
// holds one file for each light, in the order of their names. Photographs are not copied: the
// capture names them by relative paths, unless their pixels have to move.
#ifndef RELUME_INGEST_H
#define RELUME_INGEST_H

#include <relume/base.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

struct relume_ingest_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_limits *limits;
    struct relume_transfer transfer;   // of the photographs; default: by file
    const struct relume_vec3 *lights;  // [light_count], unit; default: one, (0, 0, 1)
    int light_count;
    bool force;   // replace an existing folder
    int threads;  // default: all cores
};
#define relume_ingest_params(...)                                                                  \
    (&(const struct relume_ingest_params){RELUME_SIZED(relume_ingest_params), __VA_ARGS__})

// ------------------------------------------------------------------ light slab
struct relume_slab_ingest_params {
    size_t struct_size;  // filled by the macro (base.h)
    // Where a file's name gives its place, as in "cam_{row}_{column}" with {row}, {column}, or {n}
    // (row by row), or {u}, {v}, and * for anything; default: found (relume_slab_ingest).
    const char *names;
    double baseline;         // world units from the leftmost to the rightmost camera; default 1
    double baseline_v;       // from the highest to the lowest; default: where names hold positions
                             // by these, else measured in the photographs
    double distance;         // from the st plane to the cameras; default 3
    double st_z;             // height of the st plane; default 0
    double window;           // width of the st window; default 2
    double focus_disparity;  // pixels that the plane to be st moves from a camera to the next one
                             // (left, for one to its right): the pictures are shifted and cropped
    bool fill;               // a missing camera gets the photographs of the nearest one
    bool turn;               // columns and rows run the other way: to the left, upwards
    bool keep_order;         // believe the names; default: where the photographs say that one of
                             // the two runs the other way, rows are turned round
};
#define relume_slab_ingest_params(...)                                                             \
    (&(const struct relume_slab_ingest_params){RELUME_SIZED(relume_slab_ingest_params),            \
                                               __VA_ARGS__})

// Make the folder `dir` with a capture.json of the `n` cameras whose photographs are named. Their
// places are read from the names: out_RR_CC_V_U (Stanford archive: row, column and position), any
// name in which two numbers vary (row and column), or one (row by row of a square grid: Lytro,
// HCI). Rows count downwards, columns to the right as the cameras see it; u grows to the right, v
// upwards. Cameras of a grid agree on depth only if rows and columns run as they should or both the
// other way: the first is checked and logged; the second, a world turned inside out (what
// is near, below, to the left of a camera moves up and right where it should hide what is behind),
// shows by what hides what, which is looked at and mentioned, no more.
// Where neither names nor `baseline_v` say how far apart rows are, it is measured in the
// photographs; the log has the result, or that rows are assumed to be as far apart as columns.
// The scale of depth follows from baseline and distance, which no photograph shows.
// RELUME_EINVAL (params), an input status (names that do not match, a camera missing, two for one
// place, sizes that differ), RELUME_EIO, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_slab_ingest(const char *dir, const char *const *photos, int n,
                                               const struct relume_slab_ingest_params *slab,
                                               const struct relume_ingest_params *params);

// How views of posed photographs become a slab. Borrowed during the call; lengths in units of the
// model.
struct relume_posed_params {
    size_t struct_size;  // filled by the macro (base.h)
    int grid[2];         // cameras across and down; default 5 x 5
    int width;           // pixels of a view; default: that of the photographs, at most 1024
    double distance;  // from the cameras to the st plane, units of the model; default: the median
                      // of its points, or of where the cameras look at
    int neighbours;   // photographs that a ray is blended from, 1 to 8; default 4
};
#define relume_posed_params(...)                                                                   \
    (&(const struct relume_posed_params){RELUME_SIZED(relume_posed_params), __VA_ARGS__})

// A slab of photographs whose poses COLMAP found: `model` holds cameras.txt and images.txt (and
// points3D.txt), `photos` the photographs under the names written there. The uv plane goes through
// the middle of the cameras across their mean direction; the grid covers the rectangle that they
// span. Every ray of a view takes the mean of the photographs whose cameras stand nearest to it,
// weighted by nearness, where they see its point of the st plane (Gortler et al. 1996; Buehler et
// al. 2001 with a plane for geometry): what lies off that plane is blurred by the spacing of the
// photographs, and what none of them saw is black. Camera models: SIMPLE_PINHOLE, PINHOLE,
// SIMPLE_RADIAL, RADIAL, OPENCV. World units are those of the model, scaled so that the distance is
// 3. An input status names what is not understood.
RELUME_RESULT relume_status relume_posed_ingest(const char *dir, const char *model,
                                                const char *photos,
                                                const struct relume_posed_params *posed,
                                                const struct relume_ingest_params *params);

// ------------------------------------------------------------------ panorama
// How photographs around one point come.
enum relume_panorama_source {
    RELUME_PANORAMA_SPHERE = 0,  // one picture, longitude and latitude
    RELUME_PANORAMA_CYLINDER,    // one picture
    RELUME_PANORAMA_CUBE,        // six faces
    RELUME_PANORAMA_STITCH,      // overlapping perspective photographs -> sphere
};

// How photographs become a panorama. Borrowed during the call.
struct relume_panorama_params {
    size_t struct_size;     // filled by the macro (base.h)
    double v_min, v_max;    // cylinder: tangents of the lowest and highest elevation; default:
                            // square pixels, the horizon in the middle
    const char *depth;      // sphere, cylinder: a picture of depth: an EXR of distances, else grey
    double depth_range[2];  // grey: distance of white and of black
    int width;              // stitch: columns of the sphere; default: the photographs' own scale
    int bands;              // stitch: of blending, [1, 10], each twice as coarse as the one before;
                            // 1: hard seams; default: up to a sixteenth of a photograph
};
#define relume_panorama_params(...)                                                                \
    (&(const struct relume_panorama_params){RELUME_SIZED(relume_panorama_params), __VA_ARGS__})

// Make the folder `dir` with a panorama's capture.json. A cube's six cameras are recognised by
// their names (px nx py ny pz nz, posx ..., right left top bottom back front up down); where no
// name says so they come in the order +x -x +y -y +z -z. Each face as conventions.md states it.
// Stitched photographs turn about one point; poses, seams and gains are found in the mean over
// lights, and every light is warped and blended by bands alike (Burt, Adelson 1983). Needs the
// module librelume-stitch (OpenCV); without it RELUME_EIO says so. An input status names a
// photograph that overlaps none.
RELUME_RESULT relume_status relume_panorama_ingest(const char *dir, const char *const *photos,
                                                   int n, enum relume_panorama_source source,
                                                   const struct relume_panorama_params *panorama,
                                                   const struct relume_ingest_params *params);

#ifdef __cplusplus
}
#endif
#endif
