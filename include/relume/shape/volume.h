// volume.h - regular grids of samples, and the surfaces where they take a value
//
// A sample is inside where it is at least the threshold. Surfaces come from adaptive skeleton
// climbing (Poston, Wong, Heng 1998; Wong 1998, Part I): lines of samples, then rectangles between
// them, then boxes, each as large as every line through it is crossed at most once, and no larger
// than a block. Neighbours share the lines on their faces, so that there are no cracks.
//
//     relume_volume *volume;
//     relume_volume_open(&volume, "head.nii.gz", NULL);
//     struct relume_mesh mesh[2];
//     relume_isosurface(mesh, NULL, volume, 80.0,
//                       relume_isosurface_params(.blocks = {1, 4}));  // fine and coarse
#ifndef RELUME_VOLUME_H
#define RELUME_VOLUME_H

#include <relume/base.h>
#include <relume/shape/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

// Never changes once it is open, but for its index. Thread-safety: safe while nobody makes an
// index.
typedef struct relume_volume relume_volume;

// How a volume is read. Borrowed during the call.
struct relume_volume_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_limits *limits;
    int size[3];          // of raw samples along x, y, z; x runs fastest; default: as the file's
                          // name says, "..._256x256x178_uint8.raw", with a note
    const char *type;     // of raw samples, as relume_volume_types says; default "u8"
    uint64_t skip;        // bytes of a raw file before its samples; of what is unpacked
    double spacing[3];    // from sample to sample; default: 1, positions are counted in samples
    bool own_spacing;     // that which the file names instead, where it names one
    const char *scratch;  // folder for volumes beyond 1 GiB; default $TMPDIR or /tmp
};
#define relume_volume_params(...)                                                                  \
    (&(const struct relume_volume_params){RELUME_SIZED(relume_volume_params), __VA_ARGS__})

// NULL-terminated names: "u8", "i8", "u16le", "u16be", ..., "f64be"; without an end it is little.
RELUME_API extern const char *const relume_volume_types[];

// Open NRRD (.nrrd, .nhdr), NIfTI-1 (.nii, and .hdr with .img), a folder of slices, a TIFF of
// several pages or else raw samples; what gzip has packed is unpacked. Slices are pictures in the
// order of their names, as code values: of 8 bits 0 to 255, of 16 bits 0 to 65535, else as they
// are. At least 2 samples along each axis. An input status with a sentence (sizes that do not fit,
// samples that are not finite, all alike), RELUME_EINVAL (no size of raw samples, nor one in their
// name), RELUME_ENOMEM, RELUME_EIO (no scratch space).
RELUME_RESULT relume_status relume_volume_open(relume_volume **out, const char *path,
                                               const struct relume_volume_params *params);
// A copy of samples in memory: `size` and `type` of params say what they are. As above.
RELUME_RESULT relume_status relume_volume_from(relume_volume **out, const void *samples,
                                               const struct relume_volume_params *params);
// `*volume` becomes NULL, and may have been NULL.
RELUME_API void relume_volume_destroy(relume_volume **volume);

// What is in it. Plain data.
struct relume_volume_info {
    int size[3];         // samples
    float min, max;      // of all samples
    double spacing[3];   // as it was opened
    const char *format;  // "raw", "nrrd", "nifti", "slices", "memory"
};
RELUME_API struct relume_volume_info relume_volume_info(const relume_volume *volume);

// The threshold that parts its samples into two kinds whose means are far apart and that vary
// little in themselves, as air and body (Otsu 1979); by a histogram of at most 1024 values. Above
// `min`, below `max`, and between two samples where they are whole numbers.
RELUME_API double relume_volume_threshold(const relume_volume *volume);

// Find which part of the volume has which values, once, for many thresholds: surfaces then look at
// the samples near them alone (span space: Livnat, Shen, Johnson 1996). RELUME_ENOMEM.
RELUME_RESULT relume_status relume_volume_index(relume_volume *volume, int threads);

enum { RELUME_ISOSURFACE_LEVELS = 5 };
// How surfaces are made.
struct relume_isosurface_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int threads;  // default: all cores; the mesh is the same for any number
    // The largest boxes along a side, in samples: 1, 2, 4, 8 or 16; larger ones give fewer
    // triangles where the surface is smooth. One mesh for each, until a 0. Default: one, of 1.
    int blocks[RELUME_ISOSURFACE_LEVELS];
};
#define relume_isosurface_params(...)                                                              \
    (&(const struct relume_isosurface_params){RELUME_SIZED(relume_isosurface_params), __VA_ARGS__})

// What became of one mesh.
struct relume_isosurface_report {
    size_t ambiguous;  // faces of boxes whose corners leave open what is connected; the mean of the
                       // samples in the middle decided
    size_t boxes;      // that the surface goes through
    double seconds;    // of this mesh; of the first with what all have in common
};

// The surfaces of `threshold`, one for each of the blocks: `out` and `report` (or NULL) are arrays.
// Vertices lie on the lines between neighbouring samples; normals point from inside to outside and
// come from the gradient; triangles have no cracks, and end at the border of the volume. A
// threshold that no sample, or every sample, reaches gives an empty mesh and a note. RELUME_EINVAL
// with a sentence (another block, a threshold that is no number), RELUME_ELIMIT (2^32 vertices or
// triangles), RELUME_ENOMEM, RELUME_ECANCEL; then all of `out` is empty.
RELUME_RESULT relume_status relume_isosurface(struct relume_mesh *out,
                                              struct relume_isosurface_report *report,
                                              const relume_volume *volume, double threshold,
                                              const struct relume_isosurface_params *params);

#ifdef __cplusplus
}
#endif
#endif
