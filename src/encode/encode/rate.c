// rate.c - the quantiser for a quality or a size: begun by a model, corrected by trials
#include "encode/encode/rate.h"

#include "core/base/log.h"
#include "core/math/scalar.h"
#include "core/math/target_search.h"
#include "format/coder/coding.h"
#include "format/team/array.h"

#include <math.h>
#include <string.h>

// Groups that are tried first where there are more than twice as many: three of views that are
// alone, two of larger groups.
enum { MOST_ALONE = 3, MOST_GROUPS = 2, WORTH_TRYING = 2 };

// The most samples that the usual effort codes by a slower preset.
static const double MOST_UNHURRIED = 1e6;

struct rate {
    struct trial_plan plan;
    double done;              // 0 .. 1
    int last, best;           // quantisers of the search: tried last; nearest
    struct rate_curve curve;  // of the middle view, for all of them
    struct rate_target target;
    bool by_bytes;
    struct trial trial[AV1_COARSEST + 1];  // by the plan's preset, some of them of fewer groups
};

static int views_of(const struct view_groups *g)
{
    return g->begin[g->count];
}

static void forget(struct rate *r)
{
    for (int q = 0; q <= AV1_COARSEST; q++)
        trial_destroy(&r->trial[q], views_of(r->plan.groups));
}

// ---------------------------------------------------------------- the model

struct modelling {
    struct rate *rate;
    int bits, member;
    struct rate_curve made;  // by the first member, for all
};

static relume_status begin_model(void *context, int member)
{
    struct modelling *m = context;
    m->member = member;
    m->made = (struct rate_curve){{0.0}, {0.0}};
    return RELUME_OK;
}

// The middle view, whose rows may be missing so far.
static relume_status make_model(void *context)
{
    struct modelling *m = context;
    const struct trial_plan *plan = &m->rate->plan;
    const int view = views_of(plan->groups) / 2, group = groups_with(plan->groups, view);
    relume_status status = RELUME_OK;
    if (m->member > 0)
        return RELUME_OK;
    if (plan->by)
        status = plan->by->load(plan->by->user, group,
                                (struct group_share){0, plan->groups->cut[group].count});
    return status ? status
                  : rate_model_curve(&m->made, plan->coefficients[view], 0,
                                     relume_capture_height(plan->capture), plan->capture, m->bits,
                                     plan->p->threads);
}

static relume_status keep_model(void *context)
{
    struct modelling *m = context;
    if (m->member == 0)
        m->rate->curve = m->made;
    return RELUME_OK;
}

static relume_status find_model(struct rate *r, int bits)
{
    static const struct team_work work = {begin_model, make_model, keep_model};
    struct modelling m = {.rate = r, .bits = bits};
    struct team_array made = {&m.made, sizeof m.made};
    const relume_status status =
        team_share(r->plan.by ? r->plan.by->team : NULL, bits == 8 ? "model.8" : "model.12", &work,
                   &m, &team_array_bytes, &made, r->plan.p->log);
    for (int i = 0; i < RATE_POINTS; i++)
        r->curve.bytes[i] *= views_of(r->plan.groups);
    return status;
}

// ---------------------------------------------------------------- search

// How much better than wanted, in dB: half the bytes are about so many. Of bytes not the last ones
// are wanted, since too many would not do.
static const double EACH_HALF = 5.0, SPARE = 0.2;

static double surplus_of(const struct rate *r, double psnr_db, double bytes)
{
    return r->by_bytes ? EACH_HALF * log2(fmax(bytes, 1.0) / r->target.bytes) + SPARE
                       : psnr_db - r->target.psnr_db;
}

static double surplus(const struct rate *r, int quantiser)
{
    const struct trial *t = &r->trial[quantiser];
    return surplus_of(r, t->psnr_db, t->bytes);
}

// The same by the model.
static double foretold(const struct rate *r, int quantiser)
{
    const double error = r->target.fit + rate_curve_error(&r->curve, quantiser);
    return surplus_of(r, decibels(error), rate_curve_bytes(&r->curve, quantiser));
}

// Where the line through two trials meets the target, between them.
static int between(const struct rate *r, int fine, int coarse)
{
    const double a = surplus(r, fine), b = surplus(r, coarse);
    const int guess = fine + (int)lrint(a / fmax(a - b, 1e-9) * (coarse - fine));
    return guess <= fine ? fine + 1 : guess >= coarse ? coarse - 1 : guess;
}

// The coarsest quantiser that is good enough by the model, which errs as it did at the last trial.
static int by_model(const struct rate *r)
{
    const double off = r->last ? surplus(r, r->last) - foretold(r, r->last) : 0.0;
    int q = AV1_FINEST;
    while (q < AV1_COARSEST && foretold(r, q + 1) + off >= 0.0)
        q++;
    return q;
}

// Beyond the last trial.
static int beyond(const struct rate *r, int from)
{
    const int guess = by_model(r), next = surplus(r, from) < 0.0 ? from - 1 : from + 1;
    return (guess < from) == (next < from) && guess != from ? guess : next;
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
// it takes: bytes that are all but used are used.
static bool is_close(void *context, const struct target_bracket *b)
{
    const struct rate *r = context;
    const double s = surplus(r, r->last);
    const double near = r->target.effort == RELUME_EFFORT_FAST         ? 0.3
                        : av1_presets[r->plan.preset].bits == AV1_BITS ? 0.25
                                                                       : 0.1;
    if (!r->by_bytes)
        return fabs(s) < near;
    return s <= SPARE && s > (b->trials > 1 ? -0.8 : -0.4);
}

// Whether a trial is nearer to the target than another: in quality, or with as many bytes as are
// allowed.
static bool is_better(const struct rate *r, int quantiser, int than)
{
    const double a = surplus(r, quantiser), b = surplus(r, than);
    if (!r->by_bytes)
        return fabs(a) < fabs(b);
    return a <= SPARE ? b > SPARE || a > b : b > SPARE && a < b;
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
    r->last = q;
    *missing = -surplus(r, q);
    return RELUME_OK;
}

// From *quantiser on to the one that meets the target best, on `tried` groups. Groups that were
// coded are not coded again.
static relume_status find_quantiser(struct rate *r, int tried, int *quantiser)
{
    const struct target_search search = {.may_equal = true,
                                         .narrow = 1.0,
                                         .measure = try_quantiser,
                                         .is_close = is_close,
                                         .guess = guess_quantiser,
                                         .context = r};
    struct target_bracket b = {
        .low = AV1_FINEST - 1, .high = AV1_COARSEST + 1, .at = *quantiser};  // not tried
    r->plan.tried = tried;
    r->last = 0;
    const relume_status status = target_search(&b, &search);
    if (!status)
        *quantiser = r->best;
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
    const bool slow = effort == RELUME_EFFORT_SMALLEST || samples < MOST_UNHURRIED;
    return slow && effort != RELUME_EFFORT_FAST ? AV1_GOOD_4 : AV1_REALTIME_9;
}

// Some groups first, then all, by the PSNR or by the bytes.
static relume_status find_for(struct rate *r, bool by_bytes, int *quantiser)
{
    const struct view_groups *g = r->plan.groups;
    const int some = views_of(g) > g->count ? MOST_GROUPS : MOST_ALONE;
    relume_status status = RELUME_OK;
    r->by_bytes = by_bytes;
    r->last = 0;
    *quantiser = by_model(r);
    if (g->count > WORTH_TRYING * some)
        status = find_quantiser(r, some, quantiser);
    r->done = 0.4;
    return status ? status : find_quantiser(r, g->count, quantiser);
}

// The bytes at most are far from enough for the PSNR, by the model.
static bool is_too_large(struct rate *r)
{
    static const double FAR = 1.3;
    r->by_bytes = false;
    r->last = 0;
    return r->target.bytes > 0.0 &&
           rate_curve_bytes(&r->curve, by_model(r)) > FAR * r->target.bytes;
}

static relume_status find_by_preset(struct rate *r, enum av1_preset_number preset,
                                    struct av1_effort *effort)
{
    const bool by_psnr = r->target.psnr_db > 0.0;
    *effort = (struct av1_effort){.preset = preset};
    forget(r);
    r->plan.preset = preset;
    relume_status status = find_model(r, av1_presets[preset].bits);
    const bool by_bytes = !by_psnr || is_too_large(r);
    if (!status)
        status = find_for(r, by_bytes, &effort->quantiser);
    if (!status && !by_bytes && r->target.bytes > 0.0 &&
        r->trial[effort->quantiser].bytes > r->target.bytes)
        status = find_for(r, true, &effort->quantiser);
    return status;
}

// 8 bits are too coarse for some qualities.
static bool wants_more_bits(const struct rate *r, const struct av1_effort *effort)
{
    const double least = r->target.least_db > 0.0 ? r->target.least_db : r->target.psnr_db;
    return av1_presets[effort->preset].bits == 8 && effort->quantiser == AV1_FINEST &&
           (r->by_bytes ? surplus(r, AV1_FINEST) < 0.0 : r->trial[AV1_FINEST].psnr_db < least);
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
                     .target = *target};
    const double samples = samples_of(coder, capture);
    struct av1_effort *effort = &result->effort;
    relume_status status = find_by_preset(&r, preset_of(target->effort, samples), effort);
    if (!status && wants_more_bits(&r, effort))
        status = find_by_preset(&r, AV1_REALTIME_6_12, effort);
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
