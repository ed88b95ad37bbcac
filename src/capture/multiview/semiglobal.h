// semiglobal.h - one plane for every pixel: costs against smoothness (Hirschmueller 2008)
#ifndef MULTIVIEW_SEMIGLOBAL_H
#define MULTIVIEW_SEMIGLOBAL_H

#include <relume/base.h>

struct semiglobal {
    int width, height, planes;
    const uint8_t *cost;   // [height][width][planes]
    const uint8_t *guide;  // [height][width]: steps between planes are cheaper where it steps
    uint16_t *sum;         // [height][width][planes], zeroed: sums over eight directions
    int threads;
};
// RELUME_ENOMEM.
relume_status semiglobal_sum(const struct semiglobal *s);

// Best plane of a pixel's sums, to a fraction of a plane by a parabola.
float semiglobal_best(const uint16_t *sum, int planes);

#endif
