// moving.h - whether shadows and highlights move with the light, or fade
#ifndef ENCODE_MOVING_H
#define ENCODE_MOVING_H

#include "encode/encode/request.h"

// Sets pack.shadows and result.shadows; the middle view decides. RELUME_EUNFIT with a sentence
// where shadows are asked for and cannot be traced, RELUME_ENOMEM, RELUME_ECANCEL.
relume_status moving_decide_shadows(struct encode_request *r);

// Refuses highlights that are asked for and cannot move: RELUME_EUNFIT with a sentence.
relume_status moving_refuse_highlights(const struct encode_request *r);
// Sets pack.gloss to `model`, which the caller destroys, and result.highlights. Shadows and the
// domain are decided before. Errors of relume_gloss_learn.
relume_status moving_decide_highlights(struct encode_request *r, struct relume_image *model);

#endif
