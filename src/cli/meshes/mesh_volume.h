// mesh_volume.h - the part of `relume mesh` that is about volumes
#ifndef MESHES_MESH_VOLUME_H
#define MESHES_MESH_VOLUME_H

#include "cli/meshes/mesh_tasks.h"

// "XxYxZ".
struct volume_size {
    int side[3];
};
// "X,Y,Z", or "file".
struct volume_spacing {
    double step[3];
    bool own;
};
// "T,...".
enum { MOST_THRESHOLDS = 64 };
struct volume_thresholds {
    int count;
    double value[MOST_THRESHOLDS];
};
struct volume_options {
    struct volume_thresholds thresholds;
    struct volume_size size;
    const char *type;
    struct volume_spacing spacing;
    uint64_t skip;
};
// Rows of a table of options.
#define VOLUME_ROWS                                                                                \
    GROUP("volumes"),                                                                              \
        OWN("--threshold", volume.thresholds, "T,...",                                             \
            "the surface of all samples that are at least T; of several in OUT.T.ply each; "       \
            "default: where samples fall into two kinds (Otsu)",                                   \
            take_volume_thresholds),                                                               \
        OWN("--size", volume.size, "XxYxZ",                                                        \
            "samples of a raw file, x running fastest; default: as its name says",                 \
            take_volume_size),                                                                     \
        TEXT("--type", volume.type, "TYPE",                                                        \
             "of raw samples: u8 (default), i8, u16le, u16be, i16le, ..., f32le, f64be; without "  \
             "an end little-endian"),                                                              \
        BYTES("--skip", volume.skip, "BYTES", "of a raw file before its samples"),                 \
        OWN("--spacing", volume.spacing, "X,Y,Z",                                                  \
            "from sample to sample, or 'file': as NRRD and NIfTI say; default: 1,1,1",             \
            take_volume_spacing)

relume_status take_volume_thresholds(void *thresholds, const struct option *o, const char *text,
                                     const struct relume_log *log);
relume_status take_volume_size(void *size, const struct option *o, const char *text,
                               const struct relume_log *log);
relume_status take_volume_spacing(void *spacing, const struct option *o, const char *text,
                                  const struct relume_log *log);

relume_status mesh_of_volume(const struct args *args, const struct volume_options *o,
                             const struct ints *blocks, const char *output, bool json);

#endif
