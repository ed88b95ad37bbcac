// jnd_search.c - the smallest file whose losses are not seen
//
// What is seen of a coder's noise halves about with every 6 dB, as its amplitude does: each trial
// says where the next one may lie, between the best that is seen and the worst that is not.
#include "encode/encode/jnd_search.h"

#include "core/base/log.h"
#include "core/base/outfile.h"

#include <math.h>
#include <relume/evaluate.h>

static const double MIN_DB = 20.0, FIRST_DB = 38.0, MAX_DB = 60.0;
// Near enough: the share of what is allowed, or dB between a trial that is seen and one that is
// not.
static const double NEAR = 0.93, NEAR_DB = 0.3;

enum { MAX_TRIALS = 7, MAX_IMAGES = 48 };

// A file beside the output, or one in memory.
struct trial_file {
    relume_making *making;
    struct relume_buffer buffer;
    struct relume_encode_result result;
};

struct jnd_search {
    const char *path;
    const relume_capture *capture;
    const struct relume_encode_capture_params *p;
    encode_trial *encode;
    struct trial_file best;
    double seen_db, unseen_db;  // the best that is seen, the worst that is not
    double seen_jnd;            // of the first of these
    double jnd, reached_db;     // of `best`
    bool found;
};

static void trial_destroy(struct trial_file *t)
{
    relume_making_abort(&t->making);
    relume_buffer_destroy(&t->buffer);
}

// ---------------------------------------------------------------- a log that hears errors alone

static void forward_errors(void *user, enum relume_level level, const char *text)
{
    if (level == RELUME_ERROR)
        log_line(user, level, "%s", text);
}

static bool forward_progress(void *user, const char *what, double done)
{
    return log_progress(user, what, done);
}

static struct relume_log errors_only(const struct relume_log *to)
{
    struct relume_log out = to ? *to : (struct relume_log){0};
    out.message = forward_errors;
    out.progress = forward_progress;
    out.user = (void *)to;
    return out;
}

// ---------------------------------------------------------------- one trial

static relume_status encode_at(struct trial_file *out, const struct jnd_search *s, double db,
                               const struct relume_log *log)
{
    struct relume_encode_capture_params p = *s->p;
    const struct relume_writer to_memory = relume_buffer_writer(&out->buffer);
    p.log = log;
    if (p.writer) {
        p.writer = &to_memory;
        return s->encode(NULL, s->capture, db, &out->result, &p);
    }
    const relume_status status =
        relume_making_open(&out->making, s->path, RELUME_MADE_FILE, true, s->p->log);
    return status ? status
                  : s->encode(relume_making_path(out->making), s->capture, db, &out->result, &p);
}

static relume_status judge(double *jnd, double *psnr_db, const struct jnd_search *s,
                           const struct trial_file *file)
{
    struct relume_log log = s->p->log ? *s->p->log : (struct relume_log){0};
    const struct relume_manifest *m = relume_capture_manifest(s->capture);
    const struct relume_reader reader = relume_memory_reader(file->buffer.data, file->buffer.size);
    relume_pack *pack;
    struct relume_evaluation e = {0};
    log.leave_unnoted = true;  // the next trial takes its place
    relume_status status =
        relume_pack_open(&pack, file->making ? relume_making_path(file->making) : NULL,
                         relume_pack_params(.log = &log, .threads = s->p->threads,
                                            .reader = file->making ? NULL : &reader));
    if (!status)
        status = relume_evaluate(
            &e, pack, s->capture,
            relume_evaluate_params(.log = &log, .threads = s->p->threads, .jnd = true,
                                   .no_ssim = true, .no_delta_e = true,
                                   .every = (m->views * m->lights + MAX_IMAGES - 1) / MAX_IMAGES));
    *jnd = e.jnd_worst;
    *psnr_db = e.psnr_pooled_db;
    relume_evaluation_destroy(&e);
    relume_pack_destroy(&pack);
    return status;
}

// The best so far is kept: the one that is not seen at the lowest PSNR, before there is any the
// least seen.
static relume_status try_at(struct jnd_search *s, double db, const struct relume_log *log)
{
    double jnd = 0.0, reached = 0.0;
    struct trial_file trial = {0};
    relume_status status = encode_at(&trial, s, db, log);
    if (!status)
        status = judge(&jnd, &reached, s, &trial);
    const bool good = !status && jnd <= s->p->jnd;
    const bool better =
        !status && (good ? !s->found || db < s->unseen_db : !s->found && jnd < s->jnd);
    if (good)
        s->unseen_db = fmin(s->unseen_db, db);
    else if (!status && db > s->seen_db)
        s->seen_db = db, s->seen_jnd = jnd;
    s->found |= good;
    if (better) {
        const struct trial_file worse = s->best;
        s->jnd = jnd;
        s->reached_db = reached;
        s->best = trial;
        trial = worse;
    }
    trial_destroy(&trial);
    return status;
}

// ---------------------------------------------------------------- the search

static double next_db(const struct jnd_search *s)
{
    const double MIN_STEP = 3.0, EDGE = 0.2;
    const double want = 0.97 * s->p->jnd;
    double db = s->unseen_db + 20.0 * log10(fmax(s->jnd, 1e-3) / want);
    if (s->found && s->seen_db > 0.0) {
        const double share = log(s->seen_jnd / want) / log(s->seen_jnd / fmax(s->jnd, 1e-3));
        db = s->seen_db + fmin(fmax(share, EDGE), 1.0 - EDGE) * (s->unseen_db - s->seen_db);
    } else if (!s->found) {
        db = s->seen_db + fmax(20.0 * log10(s->seen_jnd / want), MIN_STEP);
    }
    return fmin(fmax(db, MIN_DB), MAX_DB);
}

static relume_status find_best(struct jnd_search *s)
{
    const struct relume_log silent = errors_only(s->p->log);
    double db = FIRST_DB;
    relume_status status = RELUME_OK;
    for (int i = 0; i < MAX_TRIALS && !status; i++) {
        status = try_at(s, db, i ? &silent : s->p->log);
        const bool near = s->found && s->jnd >= NEAR * s->p->jnd;
        const bool out = s->found ? db <= MIN_DB : db >= MAX_DB;
        if (near || out || s->unseen_db - s->seen_db < NEAR_DB)
            break;
        db = next_db(s);
    }
    return status;
}

relume_status jnd_search(const char *path, const relume_capture *capture,
                         struct relume_encode_result *result,
                         const struct relume_encode_capture_params *p, encode_trial *trial)
{
    struct jnd_search s = {.path = path,
                           .capture = capture,
                           .p = p,
                           .encode = trial,
                           .unseen_db = (double)INFINITY,
                           .jnd = (double)INFINITY};
    relume_status status = find_best(&s);
    if (!status && s.best.making)
        status = relume_making_commit(&s.best.making);
    else if (!status)
        status = outfile_save_to(NULL, p->writer, s.best.buffer.data, s.best.buffer.size, p->log);
    *result = s.best.result;
    result->jnd = s.jnd;
    result->measured.psnr_db = s.reached_db;
    result->reach = s.found ? RELUME_REACHED : RELUME_REACH_JND;
    trial_destroy(&s.best);
    return status;
}
