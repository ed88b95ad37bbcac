// encode_seen.c - encode --jnd: the smallest file whose losses are not seen
//
// What is seen of a coder's noise halves about with every 6 dB, as its amplitude does: each trial
// says where the next one may lie, between the best that is seen and the worst that is not.
#include "encode_seen.h"

#include <math.h>

static const double LEAST_DB = 20.0, FIRST_DB = 38.0, MOST_DB = 60.0;
// Near enough: the share of what is allowed, or dB between a trial that is seen and one that is
// not.
static const double NEAR = 0.93, NEAR_DB = 0.3;

enum { MOST_TRIALS = 7, MOST_IMAGES = 48 };

struct search {
    const struct args *args;
    const struct encode_seen *what;
    relume_capture *capture;
    relume_making *best;        // the file
    double seen_db, unseen_db;  // the best that is seen, the worst that is not
    double seen_jnd;            // of the first of these
    double jnd, reached_db;     // of `best`
    bool found;
};

// What the first trial has said is not said again.
static void say_faults(void *user, enum relume_level level, const char *text)
{
    const struct relume_log *to = user;
    if (level == RELUME_ERROR)
        to->message(to->user, level, text);
}

static bool pass_progress(void *user, const char *what, double done)
{
    const struct relume_log *to = user;
    return to->progress(to->user, what, done);
}

static struct relume_log faults_only(const struct relume_log *to)
{
    return (struct relume_log){say_faults, pass_progress, (void *)to, to->context,
                               to->leave_unnoted};
}

static relume_status judge(double *jnd, double *psnr_db, const struct search *s, const char *path)
{
    struct relume_log log = *s->args->log;
    const struct relume_manifest *m = relume_capture_manifest(s->capture);
    relume_pack *pack;
    struct relume_evaluation e = {0};
    log.leave_unnoted = true;  // the next trial takes its place
    relume_status status =
        relume_pack_open(&pack, path, relume_pack_params(.log = &log, .threads = s->args->threads));
    if (!status)
        status = relume_evaluate(
            &e, pack, s->capture,
            relume_evaluate_params(.log = &log, .threads = s->args->threads, .jnd = true,
                                   .no_ssim = true, .no_delta_e = true,
                                   .every =
                                       (m->views * m->lights + MOST_IMAGES - 1) / MOST_IMAGES));
    *jnd = e.jnd_worst;
    *psnr_db = e.psnr_pooled_db;
    relume_evaluation_destroy(&e);
    relume_pack_destroy(&pack);
    return status;
}

// One trial; the best so far is kept: the one that is not seen at the lowest PSNR, before there is
// any the least seen.
static relume_status try_one(struct search *s, double db, const struct args *args)
{
    double jnd, reached;
    relume_making *trial;
    relume_status status =
        relume_making_open(&trial, s->what->output, RELUME_MADE_FILE, true, args->log);
    if (status)
        return status;
    status = s->what->trial(s->what->context, args, db, relume_making_path(trial));
    if (!status)
        status = judge(&jnd, &reached, s, relume_making_path(trial));
    if (status) {
        relume_making_abort(&trial);
        return status;
    }
    const bool good = jnd <= s->what->jnd;
    const bool better = good ? !s->found || db < s->unseen_db : !s->found && jnd < s->jnd;
    if (good)
        s->unseen_db = fmin(s->unseen_db, db);
    else if (db > s->seen_db)
        s->seen_db = db, s->seen_jnd = jnd;
    s->found |= good;
    if (better) {
        s->jnd = jnd;
        s->reached_db = reached;
        relume_making_abort(&s->best);
        s->best = trial;
        trial = NULL;
    }
    relume_making_abort(&trial);
    return RELUME_OK;
}

static double next_db(const struct search *s)
{
    const double LEAST_STEP = 3.0, EDGE = 0.2;
    const double want = 0.97 * s->what->jnd;
    double db = s->unseen_db + 20.0 * log10(fmax(s->jnd, 1e-3) / want);
    if (s->found && s->seen_db > 0.0) {
        const double share = log(s->seen_jnd / want) / log(s->seen_jnd / fmax(s->jnd, 1e-3));
        db = s->seen_db + fmin(fmax(share, EDGE), 1.0 - EDGE) * (s->unseen_db - s->seen_db);
    } else if (!s->found) {
        db = s->seen_db + fmax(20.0 * log10(s->seen_jnd / want), LEAST_STEP);
    }
    return fmin(fmax(db, LEAST_DB), MOST_DB);
}

static relume_status search(struct search *s)
{
    struct relume_log silent = faults_only(s->args->log);
    struct args quiet = *s->args;
    double db = FIRST_DB;
    relume_status status = RELUME_OK;
    quiet.log = &silent;
    for (int i = 0; i < MOST_TRIALS && !status; i++) {
        status = try_one(s, db, i ? &quiet : s->args);
        const bool near = s->found && s->jnd >= NEAR * s->what->jnd;
        const bool out = s->found ? db <= LEAST_DB : db >= MOST_DB;
        if (near || out || s->unseen_db - s->seen_db < NEAR_DB)
            break;
        db = next_db(s);
    }
    return status;
}

relume_status encode_seen(const struct args *args, const struct encode_seen *what)
{
    const struct relume_log silent = faults_only(args->log);
    struct search s = {
        .args = args, .what = what, .unseen_db = (double)INFINITY, .jnd = (double)INFINITY};
    struct relume_capture_params open = what->open;
    open.log = &silent;
    relume_status status = relume_capture_open(&s.capture, what->input, &open);
    if (!status)
        status = search(&s);
    if (!status)
        status = relume_making_commit(&s.best);
    if (!status)
        announce(args, s.found ? RELUME_NOTE : RELUME_WARNING,
                 "%s: 99 %% of the pixels of every photograph differ by less than %.2g JND%s, at "
                 "%.1f dB PSNR",
                 what->output, s.jnd, s.found ? "" : ", which is the least that it reaches",
                 s.reached_db);
    relume_making_abort(&s.best);
    relume_capture_destroy(&s.capture);
    return status;
}
