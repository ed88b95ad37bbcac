// rate.h - how coarsely planes are coded for a wanted quality or size
#ifndef ENCODE_RATE_H
#define ENCODE_RATE_H

#include "encode/encode/rate_model.h"
#include "encode/encode/trial.h"

#include <relume/capture.h>
#include <relume/pack.h>

struct rate_target {
    double psnr_db;   // of the captured images, pooled; or 0
    double least_db;  // what more bits a sample are worth; 0: psnr_db
    double bytes;     // of the words of all views, where psnr_db is set at most; 0: any
    enum relume_effort effort;
    double fit;  // mean squared error of display values before coding
};
struct rate_result {
    double psnr_db;  // as the target's
    double bytes;    // likewise
    struct av1_effort effort;
};

// words[views] of the coefficients of all views by `coder`, of the coarsest quantiser that reaches
// the PSNR best or the finest that keeps the bytes. A model of the planes says where to begin
// (rate_model.h); one or two trials follow. Where the target is out of reach it is the finest or
// coarsest. Caller frees the words, also on failure. `by` is NULL where nobody shares the work; of
// a team words have the tiles of this member alone, and those of views without any are NULL.
// RELUME_ENOMEM, RELUME_EIO, RELUME_ESYSTEM, RELUME_ECANCEL, an input status.
relume_status rate_encode(struct lossy_words *words, struct rate_result *result,
                          relume_coefficients *const *coefficients, const relume_coder *coder,
                          const struct view_groups *groups, const relume_capture *capture,
                          const struct rate_target *target, const struct relume_project_params *p,
                          const struct rate_team *by);

#endif
