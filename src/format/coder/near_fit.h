// near_fit.h - near lights: every pixel is fitted at the directions from which it was lit
//
// The coefficients c of a pixel whose samples t stand at directions of its own (rows Y_p of the
// stored functions) minimise
//     |Y_p c - t|^2 / N  +  guess |Y c - u|^2 / N  +  what design.h assumes,
// u being the samples carried over to the distant directions (rows Y): they decide where the
// pixel's own directions leave the sky open, as they do beside a near lamp. The map from t and u to
// c changes slowly over the picture: it is found at nodes and interpolated between them.
#ifndef CODER_NEAR_FIT_H
#define CODER_NEAR_FIT_H

#include "capture/manifest/reflectance_table.h"
#include "format/coder/design.h"

// Thread-safety: one thread at a time.
struct near_fit;

// Whether a coder is fitted this way: smooth functions, by plain least squares.
bool near_fit_suits(const relume_coder *coder);
// `table` is of a view with near lights, `width` x `height`, and is asked for directions until
// `fit` is destroyed. RELUME_ENOMEM.
relume_status near_fit_create(struct near_fit **out, const relume_coder *coder,
                              const relume_table *table, int width, int height, int threads);
void near_fit_destroy(struct near_fit **fit);

// Coefficients of rows `row` to `row + rows` of the view: planes[plane][rows][x] of the samples
// that relume_table_read_near gives: `own` as fit, `guess` carried over. RELUME_ENOMEM.
relume_status near_fit_apply(struct near_fit *fit, int row, int rows, const float *own,
                             const float *guess, float *planes);
// What the coefficients of one pixel say of its own samples: out[light][rgb]. `worker` is the
// caller's among the threads of `fit`; each has working memory of its own.
void near_fit_predict(struct near_fit *fit, int worker, int x, int y, const float *planes,
                      size_t plane_stride, float *out);

#endif
