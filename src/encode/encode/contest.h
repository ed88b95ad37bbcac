// contest.h - components against pictures, both lossy
#ifndef ENCODE_CONTEST_H
#define ENCODE_CONTEST_H

#include <relume/encode/pack_encode.h>

// Keeps in *out the better of the components that are there and `pictures`, at the quality or bytes
// of `p`. A model of both decides (rate_model.h). The other is destroyed, on failure both.
// Components miss photographs by `fit` before coding: mean squared error of display values. Shared
// by the members of p->team. Errors as relume_project and rate_model_curve, and of sharing.
relume_status contest_keep_better(relume_coder **out, relume_coder *pictures, double fit,
                                  const relume_capture *capture,
                                  const struct relume_pack_encode_params *p,
                                  const struct relume_project_params *encode);

// The bytes of all views at the PSNR of `p` by the same model, likewise shared. The coder misses
// photographs by `fit`. Where 8 bits do not reach it, the finest quantiser counts.
relume_status contest_foretell(double *bytes, const relume_coder *coder, double fit,
                               const relume_capture *capture,
                               const struct relume_pack_encode_params *p,
                               const struct relume_project_params *encode);

#endif
