// rate.h - how coarsely planes are coded for a wanted quality or size
#ifndef ENCODE_RATE_H
#define ENCODE_RATE_H

#include "encode/encode/trial.h"
#include "format/coder/coding.h"

#include <relume/capture.h>
#include <relume/pack.h>

// Where the search begins, which is about what a usual quality takes; and the preset by which
// coders are compared.
enum { RATE_FIRST_GUESS = 26 * AV1_STEPS };
static const enum av1_preset_number RATE_QUICK = AV1_REALTIME_9;

struct rate_target {
    double psnr_db;  // of the captured images, pooled; or 0
    double bytes;    // of the words of all views
    enum relume_effort effort;
    bool own;  // judged by what the coefficients themselves show: there are no photographs
};
struct rate_result {
    double psnr_db;  // as the target's
    double bytes;    // likewise
    struct av1_effort effort;
};

// words[views] of the coefficients of all views by `coder`, of the coarsest quantiser that reaches
// the PSNR best or the finest that keeps the bytes. It is found on some of the groups, by a quicker
// preset where that of the effort takes long, and corrected on all. Where the target is out of
// reach it is the finest or coarsest. Caller frees the words, also on failure. `by` is NULL where
// nobody shares the work; of a team words have the tiles of this member alone, and those of views
// without any are NULL. RELUME_ENOMEM, RELUME_EIO, RELUME_ESYSTEM, RELUME_ECANCEL, an input status.
relume_status rate_encode(struct lossy_words *words, struct rate_result *result,
                          relume_coefficients *const *coefficients, const relume_coder *coder,
                          const struct view_groups *groups, const relume_capture *capture,
                          const struct rate_target *target, const struct relume_project_params *p,
                          const struct rate_team *by);

// How good planes of that PSNR and so many bytes are about, to compare them with others: in dB, the
// PSNR at the target's bytes, `header` of which are not planes'; or, at the target's PSNR, as if
// half of all bytes were worth 5 dB.
double rate_merit_of(double psnr_db, double bytes, const struct rate_target *target, double header);
// The same of a coder of one `view` of the capture. Errors as above.
relume_status rate_merit(double *merit, relume_coefficients *coefficients, int view,
                         const relume_capture *capture, const struct rate_target *target,
                         double header, const struct relume_project_params *p);

#endif
