// web_step.c - the one number that decides size and quality of a folder
#include "exchange/formats/web_step.h"

#include "core/base/log.h"
#include "core/math/scalar.h"
#include "core/math/target_search.h"

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

// Trials of steps, by their logarithms. What a step gives falls with it, nearly along a line; the
// search wants what rises, and gets it with the other sign.
struct step_trials {
    const struct web_trials *t;
    bool psnr;  // the expected decibels; else the logarithm of the bytes per pixel
    double target, near;
    int done;
};

static relume_status try_step(void *context, double log_step, double *value)
{
    struct step_trials *s = context;
    const struct web_trials *t = s->t;
    struct web_folder w = {.plan = t->plan, .planes = t->planes};
    const relume_status status = web_encode(&w, exp(log_step), t->all, t->threads);
    const double pixels = (double)t->planes->width * t->planes->height;
    *value = -(s->psnr ? decibels(w.error / 3.0) : log((double)w.bytes / pixels));
    web_folder_free(&w);
    if (!status && !log_progress(t->log, "trials", (double)s->done++ / TRIALS))
        return RELUME_ECANCEL;
    return status;
}

// Near the target, on the side that is wanted.
static bool is_near(void *context, const struct target_bracket *b)
{
    const struct step_trials *s = context;
    return fabs(b->value - s->target) < s->near && (b->value < s->target) == s->psnr;
}

// The secant's step, or the middle where the secant hugs an end; outwards while an end is not
// known.
static double next_step(void *context, const struct target_bracket *b)
{
    const struct step_trials *s = context;
    if (isnan(b->low_value))
        return fmax(b->at - 1.4, (b->low + b->at) / 2.0);
    if (isnan(b->high_value))
        return fmin(b->at + 1.4, (b->high + b->at) / 2.0);
    const double share = (b->low_value - s->target) / (b->low_value - b->high_value);
    return b->low + (b->high - b->low) * (share > 0.02 && share < 0.98 ? share : 0.5);
}

// The step at which the value comes down to `target`: the largest that is still above (psnr), the
// smallest that is not (bytes).
static relume_status find_step(double *step, const struct web_trials *t, bool psnr, double target)
{
    struct step_trials s = {
        .t = t, .psnr = psnr, .target = -target, .near = (psnr ? 0.003 : 0.002)};
    struct target_bracket b = {
        .low = log(WEB_LEAST_STEP), .high = log(WEB_MOST_STEP), .at = log(FIRST_STEP)};
    s.near *= t->rough ? 30.0 : 1.0;
    const relume_status status =
        target_search(&b, &(const struct target_search){.target = s.target,
                                                        .narrow = 0.004,
                                                        .most_trials = TRIALS,
                                                        .measure = try_step,
                                                        .is_close = is_near,
                                                        .guess = next_step,
                                                        .context = &s});
    if (!status)
        *step = exp(psnr ? b.low : b.high);
    return status;
}

relume_status web_step_of_psnr(double *step, const struct web_trials *t, double psnr_db)
{
    return find_step(step, t, true, psnr_db);
}

relume_status web_step_of_bytes(double *step, const struct web_trials *t, double bytes_per_pixel)
{
    return find_step(step, t, false, log(bytes_per_pixel));
}

struct quality_trials {
    const struct web_trials *t;
    const struct target_bracket *b;
};

// Measures the visible error, which falls with the quality.
static relume_status try_quality(void *context, double quality, double *unseen)
{
    const struct quality_trials *q = context;
    const struct web_trials *t = q->t;
    struct web_folder w = {.plan = t->plan, .planes = t->planes, .blocks = true};
    double levels = 0.0;
    relume_status status = web_encode(&w, web_step_of_quality((int)quality), t->all, t->threads);
    if (!status)
        status = web_visible_error(&w, &levels);
    web_folder_free(&w);
    *unseen = -levels;
    const double left = (q->b->high - q->b->low - 1.0) / (MOST_QUALITY - LEAST_QUALITY + 1);
    return status || log_progress(t->log, "trials", 1.0 - left) ? status : RELUME_ECANCEL;
}

static double middle_quality(void *context, const struct target_bracket *b)
{
    (void)context;
    return ceil((b->low + b->high) / 2.0);
}

relume_status web_step_unseen(double *step, int *quality, const struct web_trials *t)
{
    struct target_bracket b = {.low = LEAST_QUALITY - 1, .high = MOST_QUALITY};
    struct quality_trials trials = {t, &b};
    b.at = middle_quality(NULL, &b);
    const relume_status status =
        target_search(&b, &(const struct target_search){.target = -SEEN_LEVELS,
                                                        .narrow = 1.0,
                                                        .measure = try_quality,
                                                        .guess = middle_quality,
                                                        .context = &trials});
    if (status)
        return status;
    *quality = (int)b.high;
    *step = web_step_of_quality(*quality);
    return RELUME_OK;
}
