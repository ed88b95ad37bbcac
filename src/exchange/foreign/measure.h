// measure.h - how far an exported picture is from the file that it was made from
#ifndef FOREIGN_MEASURE_H
#define FOREIGN_MEASURE_H

#include "exchange/foreign/foreign.h"
#include "exchange/foreign/source.h"

// What the light makes of the planes: as foreign_weights, of a picture without functions of its
// own.
struct measure_weights {
    void (*at)(const void *user, struct relume_vec3 light, double *weights, double constant[3]);
    const void *user;
};

// Mean over at most 16 of the source's lights of the PSNR between both pictures, as 8-bit sRGB
// codes; large pictures are sampled. With `weights`, which NULL leaves to the picture's own
// functions, that of the mean square over all of them: black pictures say nothing then.
relume_status measure_psnr(double *psnr_db, const struct foreign *f, const struct source *s,
                           const struct measure_weights *weights, int threads);

#endif
