// measure.h - how far an exported picture is from the file that it was made from
#ifndef FOREIGN_MEASURE_H
#define FOREIGN_MEASURE_H

#include "foreign/foreign.h"
#include "foreign/source.h"

// Mean over at most 16 of the source's lights of the PSNR between both pictures, as 8-bit sRGB
// codes; large pictures are sampled.
relume_status measure_psnr(double *psnr_db, const struct foreign *f, const struct source *s,
                           int threads);

#endif
