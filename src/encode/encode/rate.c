// rate.c - the quantiser for a quality or a size, by trying
#include "encode/encode/rate.h"

#include "core/base/log.h"
#include "core/math/target_search.h"
#include "format/coder/coding.h"

#include <math.h>
#include <string.h>

// What a step of the quantiser is worth, before there are two trials, in quality or in bytes.
static const double USUAL_DB = 0.1, USUAL_BYTES = 0.15;

// Groups that are tried first where there are more than twice as many: three of views that are
// alone, two of larger groups.
enum { MOST_ALONE = 3, MOST_GROUPS = 2, WORTH_TRYING = 2 };

// The most samples that the usual effort codes by its better presets, which take some seconds.
static const double MOST_THOROUGH = 1e6, MOST_UNHURRIED = 16e6;

struct rate {
    struct trial_plan plan;
    bool rough;                            // a guess is enough
    double done;                           // 0 .. 1
    int last, best;                        // quantisers of the search: tried last; nearest
    double step_db;                        // what a step of the quantiser is worth
    struct rate_target target;             // bytes of all views
    struct trial trial[AV1_COARSEST + 1];  // by the plan's preset, some of them of fewer groups
};

static int views_of(const struct view_groups *g)
{
    return g->begin[g->count];
}

// ---------------------------------------------------------------- search

static void forget(struct rate *r)
{
    for (int q = 0; q <= AV1_COARSEST; q++)
        trial_destroy(&r->trial[q], views_of(r->plan.groups));
}

// How much better than wanted, in dB: half the bytes are about so many. Of bytes not the last ones
// are wanted, since too many would not do.
static const double EACH_HALF = 5.0, SPARE = 0.2;

static double surplus(const struct rate *r, int quantiser)
{
    const struct trial *t = &r->trial[quantiser];
    return r->target.psnr_db > 0.0
               ? t->psnr_db - r->target.psnr_db
               : EACH_HALF * log2(fmax(t->bytes, 1.0) / r->target.bytes) + SPARE;
}

// Where the line through two trials meets the target, between them.
static int between(const struct rate *r, int fine, int coarse)
{
    const double a = surplus(r, fine), b = surplus(r, coarse);
    const int guess = fine + (int)lrint(a / fmax(a - b, 1e-9) * (coarse - fine));
    return guess <= fine ? fine + 1 : guess >= coarse ? coarse - 1 : guess;
}

// Beyond the last trial, by what a step was worth so far.
static int beyond(const struct rate *r, int from)
{
    const double d = surplus(r, from) / r->step_db;
    const int guess = from + (int)(d < 0.0 ? floor(d) : ceil(d));
    return guess == from ? from + 1 : guess;
}

static int within(int quantiser)
{
    return quantiser < AV1_FINEST     ? AV1_FINEST
           : quantiser > AV1_COARSEST ? AV1_COARSEST
                                      : quantiser;
}

// Returns true after trials on either side of the target.
static bool is_enclosed(const struct target_bracket *b)
{
    return b->low >= AV1_FINEST && b->high <= AV1_COARSEST;
}

static double guess_quantiser(void *context, const struct target_bracket *b)
{
    const struct rate *r = context;
    return within(is_enclosed(b) ? between(r, (int)b->low, (int)b->high) : beyond(r, r->last));
}

// So near that another trial is not worth its time, the less so the more there were and the longer
// it takes: bytes that are all but used are used. Roughly, both sides are enough.
static bool is_close(void *context, const struct target_bracket *b)
{
    const struct rate *r = context;
    const double s = surplus(r, r->last);
    const bool quick = av1_presets[r->plan.preset].bits == 8;
    if (r->rough)
        return fabs(s) < 0.5 || is_enclosed(b);
    if (r->target.psnr_db > 0.0)
        return fabs(s) < (quick ? 0.1 : 0.25);
    return s <= SPARE && s > (b->trials > 1 ? -0.8 : -0.4);
}

// Whether a trial is nearer to the target than another: in quality, or with as many bytes as are
// allowed.
static bool is_better(const struct rate *r, int quantiser, int than)
{
    const double a = surplus(r, quantiser), b = surplus(r, than);
    if (r->target.psnr_db > 0.0)
        return fabs(a) < fabs(b);
    return a <= SPARE ? b > SPARE || a > b : b > SPARE && a < b;
}

// What a step is worth, from two trials.
static void learn_step(struct rate *r, int a, int b)
{
    const double each = (surplus(r, a) - surplus(r, b)) / (b - a);
    r->step_db = fmin(fmax(each, 0.02), 0.5);
}

// Measures the decibels missing to the target, which grow with the quantiser.
static relume_status try_quantiser(void *context, double at, double *missing)
{
    struct rate *r = context;
    const int q = (int)at;
    const relume_status status = trial_add_groups(&r->trial[q], &r->plan, q);
    if (status || !log_progress(r->plan.p->log, "choosing the step", r->done))
        return status ? status : RELUME_ECANCEL;
    if (!r->last || is_better(r, q, r->best))
        r->best = q;
    if (r->last)
        learn_step(r, r->last, q);
    r->last = q;
    *missing = -surplus(r, q);
    return RELUME_OK;
}

// From *quantiser on to the one that meets the target best, on `tried` groups; or, roughly, to
// where it is to be sought. Groups that this preset has coded are not coded again.
static relume_status find_quantiser(struct rate *r, int tried, enum av1_preset_number preset,
                                    int *quantiser)
{
    const struct target_search search = {.may_equal = true,
                                         .narrow = 1.0,
                                         .measure = try_quantiser,
                                         .is_close = is_close,
                                         .guess = guess_quantiser,
                                         .context = r};
    struct target_bracket b = {
        .low = AV1_FINEST - 1, .high = AV1_COARSEST + 1, .at = *quantiser};  // not tried
    if (r->plan.preset != preset)
        forget(r);
    r->plan.tried = tried;
    r->plan.preset = preset;
    r->last = 0;
    const relume_status status = target_search(&b, &search);
    if (!status)
        *quantiser = r->rough && b.high - b.low > 1.0 ? (int)guess_quantiser(r, &b) : r->best;
    return status;
}

// ---------------------------------------------------------------- efforts

static double samples_of(const relume_coder *coder, const relume_capture *capture)
{
    return (double)relume_capture_width(capture) * relume_capture_height(capture) *
           relume_coder_info(coder)->planes * relume_capture_manifest(capture)->views;
}

static enum av1_preset_number preset_of(enum relume_effort effort, double samples)
{
    return effort == RELUME_EFFORT_FAST                                  ? AV1_REALTIME_9
           : effort == RELUME_EFFORT_SMALLEST || samples < MOST_THOROUGH ? AV1_GOOD_4
           : samples < MOST_UNHURRIED                                    ? AV1_REALTIME_6
                                                                         : AV1_REALTIME_7;
}

// A preset that finds the quantiser of a slower one roughly. The slower one is coarser at the same
// quality by so many quantisers, of pictures and of components (measured: make bench-lossy).
struct quick {
    enum av1_preset_number preset;
    int coarser[2];
};

static struct quick quick_for(enum av1_preset_number preset, double samples)
{
    static const struct quick for_good_4 = {AV1_REALTIME_6_12, {-9, -3}};
    static const struct quick for_realtime_6 = {AV1_REALTIME_9, {5, 2}};
    return samples < MOST_THOROUGH    ? (struct quick){preset, {0, 0}}
           : preset == AV1_GOOD_4     ? for_good_4
           : preset == AV1_REALTIME_6 ? for_realtime_6
                                      : (struct quick){preset, {0, 0}};
}

// Some groups first, or all by a quicker preset; then all by `preset`, from where that got to.
static relume_status find_by_preset(struct rate *r, enum av1_preset_number preset, double samples,
                                    bool joint, struct av1_effort *effort)
{
    const struct view_groups *g = r->plan.groups;
    const int some = views_of(g) > g->count ? MOST_GROUPS : MOST_ALONE;
    const int tried = WORTH_TRYING * some < g->count ? some : g->count;
    const struct quick quick = quick_for(preset, samples);
    *effort = (struct av1_effort){RATE_FIRST_GUESS, preset};
    r->rough = quick.preset != preset;
    relume_status status = RELUME_OK;
    if (r->rough || tried < g->count)
        status = find_quantiser(r, tried, quick.preset, &effort->quantiser);
    effort->quantiser = within(effort->quantiser + quick.coarser[joint]);
    r->rough = false;
    r->done = 0.4;
    return status ? status : find_quantiser(r, g->count, preset, &effort->quantiser);
}

// 8 bits are too coarse for some qualities.
static bool wants_more_bits(const struct rate *r, const struct av1_effort *effort)
{
    return av1_presets[effort->preset].bits == 8 && effort->quantiser == AV1_FINEST &&
           surplus(r, AV1_FINEST) < 0.0;
}

relume_status rate_encode(struct lossy_words *words, struct rate_result *result,
                          relume_coefficients *const *coefficients, const relume_coder *coder,
                          const struct view_groups *groups, const relume_capture *capture,
                          const struct rate_target *target, const struct relume_project_params *p,
                          const struct rate_team *by)
{
    struct rate r = {.plan = {.coefficients = coefficients,
                              .groups = groups,
                              .capture = capture,
                              .p = p,
                              .by = by,
                              .own = target->own},
                     .step_db = target->psnr_db > 0.0 ? USUAL_DB : USUAL_BYTES,
                     .target = *target};
    const double samples = samples_of(coder, capture);
    struct av1_effort *effort = &result->effort;
    const bool joint = relume_coder_info(coder)->joint;
    relume_status status =
        find_by_preset(&r, preset_of(target->effort, samples), samples, joint, effort);
    if (!status && wants_more_bits(&r, effort))
        status = find_by_preset(&r, AV1_REALTIME_6_12, samples, joint, effort);
    struct trial *best = &r.trial[effort->quantiser];
    result->psnr_db = best->psnr_db;
    result->bytes = best->bytes;
    if (!status) {
        memcpy(words, best->words, (size_t)views_of(groups) * sizeof *words);
        memset(best->words, 0, (size_t)views_of(groups) * sizeof *words);
    }
    forget(&r);
    return status;
}

double rate_merit_of(double psnr_db, double bytes, const struct rate_target *target, double header)
{
    const double over = psnr_db - target->psnr_db;
    return target->psnr_db > 0.0
               ? -EACH_HALF * log2(bytes * exp2(-over / EACH_HALF) + header)
               : psnr_db - EACH_HALF * log2(bytes / fmax(target->bytes - header, 1.0));
}

relume_status rate_merit(double *merit, relume_coefficients *coefficients, int view,
                         const relume_capture *capture, const struct rate_target *target,
                         double header, const struct relume_project_params *p)
{
    const struct relume_coefficients_info *info = relume_coefficients_info(coefficients);
    struct view_groups group;
    struct rate r = {.plan = {.coefficients = &coefficients,
                              .first = view,
                              .groups = &group,
                              .capture = capture,
                              .p = p},
                     .rough = true,
                     .step_db = target->psnr_db > 0.0 ? USUAL_DB : USUAL_BYTES,
                     .target = *target};
    int quantiser = RATE_FIRST_GUESS, nearest = RATE_FIRST_GUESS;
    r.target.bytes = fmax(target->bytes - header, 1.0);
    relume_status status = groups_alone(&group, info->coder, info->width, info->height);
    if (!status)
        status = find_quantiser(&r, 1, RATE_QUICK, &quantiser);
    for (int q = AV1_FINEST; !status && q <= AV1_COARSEST; q++)
        if (r.trial[q].words && fabs(surplus(&r, q)) < fabs(surplus(&r, nearest)))
            nearest = q;
    const struct trial *t = &r.trial[nearest];
    *merit = rate_merit_of(t->psnr_db, t->bytes, target, header);
    if (group.count)
        forget(&r);
    groups_destroy(&group);
    return status;
}
