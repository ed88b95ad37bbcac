// encode_seen.h - encode --jnd: the smallest file whose losses are not seen
#ifndef ENCODE_SEEN_H
#define ENCODE_SEEN_H

#include "cli/cli.h"

// Encodes with that PSNR into `output`; its remarks and warnings go to the log of `args`.
typedef relume_status encode_trial(void *context, const struct args *args, double psnr_db,
                                   const char *output);

struct encode_seen {
    double jnd;  // what 1 % of the pixels of no photograph may exceed
    const char *input, *output;
    struct relume_capture_params open;  // of the photographs that it is held against
    encode_trial *trial;
    void *context;
};
// Files are encoded beside `output` until the PSNR is found; the best becomes `output`. Errors of
// the trials and of relume_evaluate.
relume_status encode_seen(const struct args *args, const struct encode_seen *what);

#endif
