// web_step.c - the one number that decides size and quality of a folder
#include "exchange/formats/web_step.h"

#include "core/base/log.h"
#include "core/math/scalar.h"

#include <math.h>

enum { TRIALS = 24 };

// Without a wish: the error of 19 in 20 blocks of 8 x 8 pixels is at most so many levels of 255, as
// far as texture does not hide it (web_visible_error). Found by looking at stills of RealRTI,
// psmImages and made objects, enlarged three times: blocks are plain to see at 1.4 and gone at 1.0.
// Smooth shading shows blocks down to 0.4, which nothing but LEAST_QUALITY sees to.
#define SEEN_LEVELS 1.0
enum { FIRST_QUALITY = 80, LEAST_QUALITY = 95, MOST_QUALITY = 100 };

#define FIRST_STEP 0.045

double web_step_of_quality(int quality)
{
    return FIRST_STEP * exp2((FIRST_QUALITY - quality) / 10.0);
}

// What a step gives: the logarithm of the bytes per pixel, or with `psnr` the expected decibels.
// Both fall with the step, nearly along lines.
static relume_status try_step(const struct web_trials *t, double log_step, bool psnr, double *value)
{
    struct web_folder w = {.plan = t->plan, .planes = t->planes};
    const relume_status status = web_encode(&w, exp(log_step), t->all, t->threads);
    const double pixels = (double)t->planes->width * t->planes->height;
    *value = psnr ? decibels(w.error / 3.0) : log((double)w.bytes / pixels);
    web_folder_free(&w);
    return status;
}

struct bracket {
    double low, high;              // logarithms of steps
    double low_value, high_value;  // NaN while not tried
};

// The secant's step, or the middle where an end is not known or the secant hugs an end.
static double next_step(const struct bracket *b, double target)
{
    const double share = (b->low_value - target) / (b->low_value - b->high_value);
    return b->low + (b->high - b->low) * (share > 0.02 && share < 0.98 ? share : 0.5);
}

// The step at which the value comes down to `target`: the largest that is still above (psnr), the
// smallest that is not (bytes).
static relume_status search(double *step, const struct web_trials *t, bool psnr, double target)
{
    struct bracket b = {log(WEB_LEAST_STEP), log(WEB_MOST_STEP), (double)NAN, (double)NAN};
    const double near = (psnr ? 0.003 : 0.002) * (t->rough ? 30.0 : 1.0);
    double at = log(FIRST_STEP);
    for (int i = 0; i < TRIALS && b.high - b.low > 0.004; i++) {
        double value;
        const relume_status status = try_step(t, at, psnr, &value);
        if (status)
            return status;
        if (!log_progress(t->log, "trials", (double)i / TRIALS))
            return RELUME_ECANCEL;
        if (value > target) {
            b.low = at;
            b.low_value = value;
        } else {
            b.high = at;
            b.high_value = value;
        }
        if (fabs(value - target) < near && (value > target) == psnr)
            break;
        at = isnan(b.low_value)    ? fmax(at - 1.4, (b.low + at) / 2.0)
             : isnan(b.high_value) ? fmin(at + 1.4, (b.high + at) / 2.0)
                                   : next_step(&b, target);
    }
    *step = exp(psnr ? b.low : b.high);
    return RELUME_OK;
}

relume_status web_step_of_psnr(double *step, const struct web_trials *t, double psnr_db)
{
    return search(step, t, true, psnr_db);
}

relume_status web_step_of_bytes(double *step, const struct web_trials *t, double bytes_per_pixel)
{
    return search(step, t, false, log(bytes_per_pixel));
}

static relume_status try_quality(const struct web_trials *t, int quality, double *levels)
{
    struct web_folder w = {.plan = t->plan, .planes = t->planes, .blocks = true};
    relume_status status = web_encode(&w, web_step_of_quality(quality), t->all, t->threads);
    if (!status)
        status = web_visible_error(&w, levels);
    web_folder_free(&w);
    return status;
}

relume_status web_step_unseen(double *step, int *quality, const struct web_trials *t)
{
    int low = LEAST_QUALITY, high = MOST_QUALITY;
    while (low < high) {
        const int middle = (low + high) / 2;
        double levels = 0.0;
        const relume_status status = try_quality(t, middle, &levels);
        if (status)
            return status;
        if (!log_progress(t->log, "trials",
                          1.0 - (double)(high - low) / (MOST_QUALITY - LEAST_QUALITY + 1)))
            return RELUME_ECANCEL;
        if (levels <= SEEN_LEVELS)
            high = middle;
        else
            low = middle + 1;
    }
    *quality = low;
    *step = web_step_of_quality(low);
    return RELUME_OK;
}
