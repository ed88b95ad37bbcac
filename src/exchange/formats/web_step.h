// web_step.h - the one number that decides size and quality of a folder: the common quantiser step,
// in units of the picture's error
#ifndef EXCHANGE_WEB_STEP_H
#define EXCHANGE_WEB_STEP_H

#include "exchange/formats/web.h"

#define WEB_LEAST_STEP 1e-4
#define WEB_MOST_STEP  8.0

// Quality 80 is 0.045, about 11 codes; ten less doubles it.
double web_step_of_quality(int quality);

// What is tried: the planes, or some rows of them.
struct web_trials {
    const struct plan *plan;
    const struct planes *planes;
    bool all;    // sheets that are not worth their bytes are kept
    bool rough;  // a tenth of a decibel, or a few hundredths of the bytes, is near enough
    int threads;
    const struct relume_log *log;
};
// Rows of at most so many pixels do for trials.
enum { WEB_TRIAL_PIXELS = 1 << 19 };

// The largest step that is expected to reach that PSNR; the smallest that does not exceed these
// bytes per pixel. RELUME_ENOMEM, RELUME_ECANCEL.
relume_status web_step_of_psnr(double *step, const struct web_trials *t, double psnr_db);
relume_status web_step_of_bytes(double *step, const struct web_trials *t, double bytes_per_pixel);
// That of the lowest quality, 95 or more, whose error is not to be seen.
relume_status web_step_unseen(double *step, int *quality, const struct web_trials *t);

#endif
