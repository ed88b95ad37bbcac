// design.h - a coder's fit as a system for one pixel, whose rows may be weighed or stand elsewhere
//
// In stored functions Y (orthonormal with ridge and fill, fit.c) coefficients c of samples t solve
//     (Yt W Y / N + P) c = Yt W t / N + F t,     P = I - Yt Y / N,  F = map - Yt / N
// so that P and F carry what was assumed beyond the captured lights, for any weights W.
#ifndef CODER_DESIGN_H
#define CODER_DESIGN_H

#include "format/coder/basis.h"

// Rows: one per light; learned bases one per light and channel, [light][channel].
struct design {
    int lights, k, rows;
    double *y;         // [rows][k], at the captured directions
    double *constant;  // [rows]: learned bases, else 0
    double *prior;     // [k][k]
    double *fill;      // [k][lights], or NULL: learned bases
};
relume_status design_create(struct design *out, const relume_coder *coder);
void design_destroy(struct design *d);
// Rows and constants at other directions; `weights` holds 3 k.
void design_rows(double *y, double *constant, const struct design *d, const relume_coder *coder,
                 const struct relume_vec3 *direction, float *weights);

#endif
