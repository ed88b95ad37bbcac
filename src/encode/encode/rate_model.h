// rate_model.h - what coding planes costs about at each quantiser, from a look at some blocks
//
// Blocks of 8 x 8 samples, spread over a view, are transformed by a cosine transform and quantised.
// That takes milliseconds where coding takes seconds. It says where the search for a quantiser
// begins, and whether components or pictures need fewer bytes.
#ifndef ENCODE_RATE_MODEL_H
#define ENCODE_RATE_MODEL_H

#include "format/coder/coding.h"
#include "format/lossy/av1.h"

// Points of a curve, RATE_EACH quantisers apart, from the finest to the coarsest.
enum { RATE_EACH = 16, RATE_POINTS = (AV1_COARSEST - AV1_FINEST) / RATE_EACH + 1 };

// Mean squared errors of display values that coding adds, and the bytes of all planes.
struct rate_curve {
    double error[RATE_POINTS], bytes[RATE_POINTS];
};

// The curve of a view by `rows` of its rows from `row` on, coded with `bits` a sample. The
// steps are RELUME_STEP_HALVED or RELUME_STEP_COMMON; the error is of the captured lights.
// RELUME_ENOMEM, RELUME_EIO.
relume_status rate_model_curve(struct rate_curve *out, const relume_coefficients *coefficients,
                               int row, int rows, const relume_capture *capture, int bits,
                               int threads);

// The curve at a quantiser: logarithms are linear between its points.
double rate_curve_error(const struct rate_curve *curve, double quantiser);
double rate_curve_bytes(const struct rate_curve *curve, double quantiser);
// The quantiser at which the error is this, or the nearest that there is.
double rate_curve_find_error(const struct rate_curve *curve, double error);
// Likewise of the bytes.
double rate_curve_find_bytes(const struct rate_curve *curve, double bytes);

#endif
