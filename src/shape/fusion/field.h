// field.h - views with depth fused in a volume of signed distances (Curless, Levoy 1996)
#ifndef FUSION_FIELD_H
#define FUSION_FIELD_H

#include "shape/fusion/witness.h"
#include "shape/volume/volume.h"

// Inside is at least this, as samples of 16 bits say it: between -1 and 1 times the band.
#define FIELD_SURFACE 32767.5

// The band beside the surface in which distances are told apart, in voxels.
enum { FIELD_BAND = 3 };

struct field {
    const struct witness *witness;
    int witnesses;
    double voxel;
    vec3 origin;  // of the first sample
    int size[3];
    int threads;
    relume_volume *volume;
};

// Where the volume lies that holds all that is seen; `voxel` 0: chosen. RELUME_EUNFIT,
// RELUME_EINVAL with a sentence.
relume_status field_plan(struct field *f, double voxel, const struct relume_log *log);
// Fuse: `f->volume` is the caller's to destroy. RELUME_ENOMEM, RELUME_ELIMIT, RELUME_EIO,
// RELUME_ECANCEL.
relume_status field_fuse(struct field *f, const struct relume_volume_params *params);

#endif
