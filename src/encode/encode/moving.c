// moving.c - whether shadows and highlights move with the light, or fade
//
// Photographs that are left out decide: they are predicted both ways, and what moves must be better
// by enough to be worth its bytes.
#include "encode/encode/moving.h"

#include "relight/shadow/moving.h"

static const double MIN_SHADOWS_DB = 0.5, MIN_HIGHLIGHTS_DB = 0.3;
enum {
    MIN_SHADOW_LIGHTS = 8,
    MIN_HIGHLIGHT_LIGHTS = 16,  // four of them are left out
    MIN_HIGHLIGHT_SIDE = 64,    // unasked: less is no photograph
};
// Half a microsecond to two a sample is a minute or two on two cores; what takes longer waits until
// it is asked for.
static const double MAX_SAMPLES = 100e6;
static const double MAX_PIXELS = 16e6;  // of a view without reduced levels

static double pixels_of(const relume_capture *capture)
{
    return (double)relume_capture_width(capture) * relume_capture_height(capture);
}

static double samples_of(const relume_capture *capture)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    return pixels_of(capture) * m->lights * m->views;
}

// Returns what the capture lacks for anything to move, or NULL.
static const char *forbids_moving(const struct encode_request *r)
{
    if (relume_capture_manifest(r->capture)->positions)
        return "distant lights";
    if (!r->decides && !r->basis->learned && r->basis != &relume_basis_table)
        return "basis pca, eigen or table";
    if (r->pack.parts)
        return "no parts";
    return r->pack.pyramid == RELUME_PYRAMID_YES || pixels_of(r->capture) > MAX_PIXELS
               ? "views without reduced levels"
               : NULL;
}

static const char *forbids_shadows(const struct encode_request *r)
{
    const struct relume_manifest *m = relume_capture_manifest(r->capture);
    for (int i = 0; i < m->views; i++)
        if (!m->view[i].depth || r->pack.no_depth)
            return "depth in every view";
    if (!relume_shadows_suit(&m->geometry))
        return "views that are no cube and no cylinder with discs";
    return forbids_moving(r);
}

static const char *forbids_highlights(const struct encode_request *r)
{
    const struct relume_manifest *m = relume_capture_manifest(r->capture);
    if (r->pack.shadows)
        return "--shadows no";
    if (m->views != 1 || m->slabs || m->geometry.projection != RELUME_PLANAR ||
        m->geometry.perspective)
        return "one planar orthographic view";
    if (m->lights < MIN_HIGHLIGHT_LIGHTS)
        return "at least 16 lights";
    return forbids_moving(r);
}

static bool is_better(relume_status status, const struct relume_shadows_gain *gain, double least_db)
{
    return !status && gain->traced_db - gain->faded_db >= least_db;
}

// A log without sentences: encoding itself says more about a photograph that is at fault.
static struct relume_log without_sentences(const struct relume_log *log)
{
    struct relume_log quiet = log ? *log : (struct relume_log){0};
    quiet.message = NULL;
    return quiet;
}

static bool ends_all(relume_status status)
{
    return status == RELUME_ECANCEL || status == RELUME_ENOMEM;
}

// Report of a trial: `moves` and `is_slow` are decisions, `status` and `gain` its measurement.
static struct relume_moving_report report_gain(relume_status status,
                                               const struct relume_shadows_gain *gain, bool moves,
                                               bool is_slow)
{
    struct relume_moving_report out = {.status = status};
    out.outcome = moves                     ? RELUME_MOVING_MOVES
                  : is_slow                 ? RELUME_MOVING_SLOW
                  : status == RELUME_ELIMIT ? RELUME_MOVING_LARGE
                  : status                  ? RELUME_MOVING_FAILED
                                            : RELUME_MOVING_FADES;
    if (!status) {
        out.lights = gain->lights;
        out.faded_db = gain->faded_db;
        out.moved_db = gain->traced_db;
    }
    return out;
}

// ---------------------------------------------------------------- shadows

static relume_status try_shadows(struct encode_request *r)
{
    const struct relume_log quiet = without_sentences(r->log);
    const int middle = relume_capture_manifest(r->capture)->views / 2;
    struct relume_shadows_gain gain;
    const relume_status status =
        relume_shadows_judge(&gain, r->capture, middle, request_is_display(r),
                             relume_shadows_params(.log = &quiet, .threads = r->pack.threads));
    r->pack.shadows = is_better(status, &gain, MIN_SHADOWS_DB);
    r->result.unseen_db = r->pack.shadows ? gain.traced_db : 0.0;
    r->result.shadows = report_gain(status, &gain, r->pack.shadows, false);
    return ends_all(status) ? status : RELUME_OK;
}

relume_status moving_decide_shadows(struct encode_request *r)
{
    const char *why = forbids_shadows(r);
    struct relume_moving_report *report = &r->result.shadows;
    if (r->shadows == RELUME_MOVING_YES && why)
        return log_fail(r->log, RELUME_EUNFIT, "%sshadows cannot be traced; expected %s",
                        r->about.place, why);
    r->pack.shadows = r->shadows == RELUME_MOVING_YES;
    if (r->pack.shadows)
        report->outcome = RELUME_MOVING_MOVES;
    if (r->shadows != RELUME_MOVING_AUTO)
        return RELUME_OK;
    if (!why && relume_capture_manifest(r->capture)->lights < MIN_SHADOW_LIGHTS)
        why = "at least 8 lights";
    if (!why && samples_of(r->capture) <= MAX_SAMPLES)
        return try_shadows(r);
    report->outcome = why ? RELUME_MOVING_UNSUITED : RELUME_MOVING_SLOW;
    report->expected = why;
    return RELUME_OK;
}

// ---------------------------------------------------------------- highlights

static relume_status learn_highlights(struct encode_request *r, struct relume_image *model,
                                      const struct relume_log *log)
{
    const relume_status status =
        relume_gloss_learn(model, r->capture, request_is_display(r),
                           relume_shadows_params(.log = log, .threads = r->pack.threads));
    r->pack.gloss = status ? NULL : model;
    return status;
}

static relume_status try_highlights(struct encode_request *r, struct relume_image *model)
{
    const struct relume_log quiet = without_sentences(r->log);
    const bool is_slow = samples_of(r->capture) > MAX_SAMPLES;
    struct relume_shadows_gain gain;
    relume_status status =
        relume_gloss_judge(&gain, r->capture, request_is_display(r),
                           relume_shadows_params(.log = &quiet, .threads = r->pack.threads));
    const bool helps = is_better(status, &gain, MIN_HIGHLIGHTS_DB);
    if (helps && !is_slow)
        status = learn_highlights(r, model, &quiet);
    if (ends_all(status))
        return status;
    if (r->pack.gloss)
        r->result.unseen_db = gain.traced_db;
    r->result.highlights = report_gain(status, &gain, r->pack.gloss, helps && is_slow);
    return RELUME_OK;
}

relume_status moving_refuse_highlights(const struct encode_request *r)
{
    const char *why = r->highlights == RELUME_MOVING_YES ? forbids_highlights(r) : NULL;
    return why ? log_fail(r->log, RELUME_EUNFIT, "%shighlights cannot move; expected %s",
                          r->about.place, why)
               : RELUME_OK;
}

// Highlights that nobody asked for are moved where they matter.
static bool is_left_alone(const struct encode_request *r)
{
    return r->highlights == RELUME_MOVING_DEFAULT &&
           (!r->decides || relume_capture_width(r->capture) < MIN_HIGHLIGHT_SIDE ||
            relume_capture_height(r->capture) < MIN_HIGHLIGHT_SIDE);
}

relume_status moving_decide_highlights(struct encode_request *r, struct relume_image *model)
{
    if (r->highlights == RELUME_MOVING_NO || is_left_alone(r))
        return RELUME_OK;
    const relume_status refused = moving_refuse_highlights(r);
    const char *why = refused ? NULL : forbids_highlights(r);
    if (refused)
        return refused;
    if (why) {
        r->result.highlights.outcome = RELUME_MOVING_UNSUITED;
        r->result.highlights.expected = why;
        return RELUME_OK;
    }
    if (r->highlights != RELUME_MOVING_YES)
        return try_highlights(r, model);
    r->result.highlights.outcome = RELUME_MOVING_MOVES;
    return learn_highlights(r, model, r->log);
}
