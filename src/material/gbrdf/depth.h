// depth.h - the relief of a sample from what its pictures have in common
#ifndef GBRDF_DEPTH_H
#define GBRDF_DEPTH_H

#include "material/gbrdf/flat.h"
#include "material/gbrdf/pairs.h"

// Samples with a shorter side are taken as planes: windows are 5 texels wide.
enum { DEPTH_LEAST_SIDE = 8 };

// Heights z[height][width] in texels: the surface through the volume of similarities of `pairs`.
// RELUME_ENOMEM, RELUME_ECANCEL.
relume_status depth_find(float *z, const relume_btf *btf, const struct picture_pair *pairs,
                         int count, int threads, const struct relume_log *log);

// Normals by which values that are drawn onto a relief are reciprocal; where too few are of use,
// the relief's. RELUME_ENOMEM, RELUME_ECANCEL.
relume_status depth_normals(vec3 *out, const struct flat *flat, const struct picture_pair *pairs,
                            int count, int threads, const struct relume_log *log);

// The heights near z whose slopes are near the normals', in place. RELUME_ENOMEM.
relume_status depth_fuse(float *z, const vec3 *normal, int width, int height);

#endif
