// depth_step.h - how coarsely depth is coded
#ifndef ENCODE_DEPTH_STEP_H
#define ENCODE_DEPTH_STEP_H

#include <relume/capture.h>

// The step of the inverse of depth of a view of `slab`, where planes are coded for that PSNR (0:
// for bytes). 0: depth is written as it is.
double depth_step(const struct relume_manifest *m, const struct relume_image *depth, int slab,
                  double psnr_db);

#endif
