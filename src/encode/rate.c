// rate.c - the quantiser for a quality or a size, by trying
#include "encode/rate.h"

#include "base/log.h"
#include "base/memory.h"
#include "base/thread.h"
#include "coder/codes.h"
#include "coder/coefficients.h"
#include "team/gather.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// At the same quantiser the slow coder is about a whole step better in quality, and in bytes two.
enum { SLOW_IS_FINER = AV1_STEPS };

// What a step of the quantiser is worth, before there are two trials, in quality or in bytes.
static const double USUAL_DB = 0.1, USUAL_BYTES = 0.15;

// What is tried first: of views that are alone three, else two groups; by the slow coder too where
// all of them are more than so many times that.
enum { MOST_ALONE = 3, MOST_GROUPS = 2, WORTH_TRYING = 2 };

// The most samples of all pictures that are coded slowly.
static const double MOST_SLOW = 64e6;

struct trial {
    struct lossy_words *words;  // [views], of the groups that are tried; NULL: not tried
    double *square;             // [views]: their mean squared differences
    double psnr_db, bytes;
};

struct rate {
    relume_coefficients *const *coefficients;  // [views]
    const struct view_groups *groups;
    int tried, speed;  // of the groups, evenly spread
    bool rough;        // a guess is enough
    int first;         // which view of the capture the coefficients begin with
    double done;       // 0 .. 1
    double step_db;    // what a step of the quantiser is worth
    const relume_capture *capture;
    const struct relume_encode_params *p;
    const struct rate_team *by;            // or NULL
    struct rate_target target;             // bytes of all views
    struct trial trial[AV1_COARSEST + 1];  // at that speed, some of them of fewer groups
};

static int views_of(const struct view_groups *g)
{
    return g->begin[g->count];
}

// ---------------------------------------------------------------- groups in parallel

struct job {
    const struct rate *rate;
    int quantiser, each;        // threads for each
    int first;                  // of the groups that are tried
    const struct trial *known;  // whose groups are not coded again
    struct trial *trial;
    relume_status *status;  // [groups that are coded]
};

// Which group is the i-th that is tried.
static int group_at(const struct rate *r, int i)
{
    return (int)((2LL * i + 1) * r->groups->count / (2LL * r->tried));
}

// Its views, *count of them.
static const int *views_at(const struct rate *r, int i, int *count)
{
    const struct view_groups *g = r->groups;
    const int group = group_at(r, i);
    *count = g->begin[group + 1] - g->begin[group];
    return g->view + g->begin[group];
}

// The same, none of a group that a trial of fewer groups has coded.
static const int *views_left(const struct trial *known, const struct rate *r, int i, int *count)
{
    const int *view = views_at(r, i, count);
    *count = known->words[*view].word ? 0 : *count;
    return view;
}

static void code_group(void *context, size_t item, int worker)
{
    struct job *j = context;
    const struct rate *r = j->rate;
    int n;
    const int *view = views_left(j->known, r, j->first + (int)item, &n);
    const struct av1_effort effort = {j->quantiser, r->speed};
    relume_coefficients *from[AV1_MOST_MEMBERS] = {0};
    struct lossy_words words[AV1_MOST_MEMBERS];
    (void)worker;
    if (!n)
        return;
    for (int i = 0; i < n; i++)
        from[i] = r->coefficients[view[i]];
    j->status[item] = lossy_encode(words, from, n, &effort, j->each, r->p->log);
    for (int i = 0; i < n; i++)
        j->trial->words[view[i]] = words[i];
}

// The groups `first` .. `end` of those that are tried.
static relume_status code_groups(struct trial *t, const struct trial *known, const struct rate *r,
                                 int first, int end, int quantiser)
{
    const int threads = thread_count(r->p->threads), n = end - first;
    int left = 0, views;
    for (int i = first; i < end; i++) {
        views_left(known, r, i, &views);
        left += views > 0;
    }
    struct job j = {r, quantiser, left && left < threads ? threads / left : 1, first, known,
                    t, NULL};
    j.status = mem_zeroed((size_t)n + 1, sizeof *j.status);
    if (!j.status)
        return RELUME_ENOMEM;
    thread_for(threads, (size_t)n, code_group, &j);
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < n; i++)
        status = j.status[i];
    mem_free(j.status);
    return status;
}

// ---------------------------------------------------------------- quality

struct shown {
    const struct relume_coefficients_info *info;
    const uint16_t *codes;
};

static void shown_row(const void *user, int row, float *planes, size_t stride)
{
    const struct shown *s = user;
    const size_t width = (size_t)s->info->width, size = width * (size_t)s->info->height;
    for (int k = 0; k < s->info->planes; k++)
        codes_restore(planes + (size_t)k * stride, RELUME_STORE_12, s->codes,
                      (size_t)k * size + (size_t)row * width, width, s->info->scale[k],
                      s->info->offset[k]);
}

static relume_status judge_view(double *square, const struct rate *r, int view,
                                const struct lossy_words *words, const struct lossy_words *anchor)
{
    relume_coefficients *c = r->coefficients[view];
    const struct relume_coefficients_info *info = relume_coefficients_info(c);
    int *order = lossy_order(info->coder);
    const struct lossy_shape shape = {info->width, info->height, info->planes,
                                      lossy_in_colour(info->coder), order};
    uint16_t *codes =
        mem_array((size_t)info->planes, (size_t)info->width * (size_t)info->height * sizeof *codes);
    const struct relume_rect all = {0, 0, info->width, info->height};
    relume_status status =
        codes ? lossy_decode(codes, &shape, &all, words, anchor, r->p->threads, NULL)
              : RELUME_ENOMEM;
    const struct shown shown = {info, codes};
    struct encode_judgement judgement = {0};
    if (!status)
        status = encode_judge(&judgement, c, r->capture, r->first + view, true,
                              &(const struct encode_values){shown_row, &shown}, r->p);
    *square = judgement.square;
    mem_free(order);
    mem_free(codes);
    return status;
}

static relume_status judge_groups(struct trial *t, const struct trial *known, const struct rate *r,
                                  int first, int end)
{
    relume_status status = RELUME_OK;
    int n;
    for (int i = first; !status && i < end; i++) {
        const int *view = views_left(known, r, i, &n);
        for (int k = 0; !status && k < n; k++)
            status = judge_view(&t->square[view[k]], r, view[k], &t->words[view[k]],
                                k ? &t->words[view[0]] : NULL);
    }
    return status;
}

// The bytes and the quality of all that is tried.
static void sum_up(struct trial *t, const struct rate *r)
{
    double square = 0.0;
    int views = 0, n;
    t->bytes = 0.0;
    for (int i = 0; i < r->tried; i++) {
        const int *view = views_at(r, i, &n);
        for (int k = 0; k < n; k++, views++) {
            square += t->square[view[k]];
            t->bytes += 4.0 * (double)t->words[view[k]].count;
        }
    }
    t->bytes *= (double)views_of(r->groups) / views;
    t->psnr_db = -10.0 * log10(fmax(square / views, 1e-20));
}

// ---------------------------------------------------------------- by a team

static relume_status trial_create(struct trial *t, const struct rate *r)
{
    const size_t views = (size_t)views_of(r->groups);
    t->words = mem_zeroed(views, sizeof *t->words);
    t->square = mem_zeroed(views, sizeof *t->square);
    return t->words && t->square ? RELUME_OK : RELUME_ENOMEM;
}

static void trial_destroy(struct trial *t, int views)
{
    for (int i = 0; t->words && i < views; i++)
        mem_free(t->words[i].word);
    mem_free(t->words);
    mem_free(t->square);
    *t = (struct trial){0};
}

struct trying {
    struct rate *rate;
    struct trial *trial;
    int quantiser;
};

// The groups of a member, among those that are tried.
static void share_of(const struct rate *r, int member, int *first, int *end)
{
    const int members = r->by ? r->by->team->members : 1;
    for (*first = 0; *first < r->tried; ++*first)
        if (group_at(r, *first) >= groups_first(r->groups, member, members))
            break;
    for (*end = *first; *end < r->tried; ++*end)
        if (group_at(r, *end) >= groups_first(r->groups, member + 1, members))
            break;
}

// Of each view the difference, the number of its words, and they.
struct put_view {
    double square;
    uint64_t words;
};

static bool put_views(const struct trial *t, const struct trial *known, const struct rate *r,
                      int first, int end, struct relume_buffer *out)
{
    const struct relume_writer writer = relume_buffer_writer(out);
    uint64_t at = 1;
    int n;
    bool good = writer.write(writer.user, "w", 1, 0);  // a piece is never empty
    for (int i = first; good && i < end; i++) {
        const int *view = views_left(known, r, i, &n);
        for (int k = 0; good && k < n; k++) {
            const struct lossy_words *w = &t->words[view[k]];
            const struct put_view head = {t->square[view[k]], w->count};
            good = writer.write(writer.user, &head, sizeof head, at) &&
                   writer.write(writer.user, w->word, 4 * w->count, at + sizeof head);
            at += sizeof head + 4 * w->count;
        }
    }
    return good;
}

static relume_status make_trial(void *context, int member, struct relume_buffer *out)
{
    const struct trying *try = context;
    struct rate *r = try->rate;
    const struct trial *known = try->trial;
    struct trial own = {0};
    int first, end;
    share_of(r, member, &first, &end);
    relume_status status = trial_create(&own, r);
    for (int i = first, n; !status && r->by && i < end; i++) {
        const int *view = views_left(known, r, i, &n);
        for (int k = 0; !status && k < n; k++)
            status = r->by->load(r->by->user, view[k]);
    }
    if (!status)
        status = code_groups(&own, known, r, first, end, try->quantiser);
    if (!status)
        status = judge_groups(&own, known, r, first, end);
    if (!status && !put_views(&own, known, r, first, end, out))
        status = RELUME_ENOMEM;
    trial_destroy(&own, views_of(r->groups));
    return status;
}

static relume_status take_view(struct trial *t, int view, const struct relume_buffer *piece,
                               size_t *at)
{
    struct put_view head;
    struct lossy_words *w = &t->words[view];
    if (piece->size - *at < sizeof head)
        return RELUME_EDAMAGED;
    memcpy(&head, piece->data + *at, sizeof head);
    *at += sizeof head;
    if (!head.words || head.words > (piece->size - *at) / 4 || !(head.square >= 0.0))
        return RELUME_EDAMAGED;
    *w = (struct lossy_words){mem_array((size_t)head.words, sizeof *w->word), (size_t)head.words};
    if (!w->word)
        return RELUME_ENOMEM;
    memcpy(w->word, piece->data + *at, 4 * w->count);
    *at += 4 * w->count;
    t->square[view] = head.square;
    return RELUME_OK;
}

static relume_status take_trial(void *context, int member, const struct relume_buffer *piece)
{
    const struct trying *try = context;
    size_t at = 1;
    int first, end, n;
    relume_status status = piece->size < at ? RELUME_EDAMAGED : RELUME_OK;
    share_of(try->rate, member, &first, &end);
    for (int i = first; !status && i < end; i++) {
        const int *view = views_left(try->trial, try->rate, i, &n);
        for (int k = 0; !status && k < n; k++)
            status = take_view(try->trial, view[k], piece, &at);
    }
    return status || at == piece->size ? status : RELUME_EDAMAGED;
}

// ---------------------------------------------------------------- search

static relume_status try_one(struct rate *r, int quantiser)
{
    struct trying try = {r, &r->trial[quantiser], quantiser};
    char what[32];
    snprintf(what, sizeof what, "words.%d.%d.%d", r->tried, r->speed, quantiser);
    relume_status status = try.trial->words ? RELUME_OK : trial_create(try.trial, r);
    if (!status)
        status =
            team_gather(r->by ? r->by->team : NULL, what, make_trial, take_trial, &try, r->p->log);
    if (!status)
        sum_up(try.trial, r);
    return status;
}

static void forget(struct rate *r)
{
    for (int q = 0; q <= AV1_COARSEST; q++)
        trial_destroy(&r->trial[q], views_of(r->groups));
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

// So near that another trial is not worth its time, the less so the more there were: qualities are
// wanted within 0.3 dB, and bytes that are all but used are used.
static bool is_close(const struct rate *r, int quantiser, int trials)
{
    const double s = surplus(r, quantiser);
    if (r->rough)
        return fabs(s) < 0.5;
    if (r->target.psnr_db > 0.0)
        return fabs(s) < (trials > 1 ? 0.29 : 0.25);
    return s <= SPARE && s > (trials > 1 ? -0.8 : -0.4);
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

// From *quantiser on to the one that meets the target best, on `tried` groups; or, roughly, to
// where it is to be sought. What was coded at that speed is not coded again.
static relume_status search(struct rate *r, int tried, int speed, int *quantiser)
{
    int fine = AV1_FINEST - 1, coarse = AV1_COARSEST + 1;  // not tried
    if (r->speed != speed)
        forget(r);
    r->tried = tried;
    r->speed = speed;
    for (int q = *quantiser, last = 0, trials = 1;; trials++) {
        const relume_status status = try_one(r, q);
        if (status || !log_progress(r->p->log, "choosing the step", r->done))
            return status ? status : RELUME_ECANCEL;
        *quantiser = !last || is_better(r, q, *quantiser) ? q : *quantiser;
        if (last)
            learn_step(r, last, q);
        last = q;
        *(surplus(r, q) >= 0.0 ? &fine : &coarse) = q;
        const bool found = is_close(r, q, trials),
                   enclosed = fine >= AV1_FINEST && coarse <= AV1_COARSEST;
        if (coarse - fine <= 1 || (found && !r->rough))
            return RELUME_OK;
        q = within(enclosed ? between(r, fine, coarse) : beyond(r, q));
        if (r->rough && (found || enclosed)) {
            *quantiser = q;
            return RELUME_OK;
        }
    }
}

// The slow coder where it takes no more than some minutes and much is to be gained: the pictures
// themselves for a quality.
static int speed_for(const relume_coder *coder, const relume_capture *capture,
                     const struct rate_target *target)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    const double samples = (double)relume_capture_width(capture) * relume_capture_height(capture) *
                           info->planes * relume_capture_manifest(capture)->views;
    return target->psnr_db > 0.0 && !info->basis->learned && samples <= MOST_SLOW ? AV1_SLOW
                                                                                  : AV1_USUAL;
}

// The fast coder finds about where, a slower one the step itself, then that of all groups.
relume_status rate_encode(struct lossy_words *words, struct rate_result *result,
                          relume_coefficients *const *coefficients, const relume_coder *coder,
                          const struct view_groups *groups, const relume_capture *capture,
                          const struct rate_target *target, const struct relume_encode_params *p,
                          const struct rate_team *by)
{
    const int some = views_of(groups) > groups->count ? MOST_GROUPS : MOST_ALONE;
    const int tried = groups->count < some ? groups->count : some;
    struct rate r = {.coefficients = coefficients,
                     .groups = groups,
                     .rough = true,
                     .capture = capture,
                     .p = p,
                     .by = by,
                     .step_db = target->psnr_db > 0.0 ? USUAL_DB : USUAL_BYTES,
                     .target = *target};
    const int speed = speed_for(coder, capture, target);
    int *quantiser = &result->effort.quantiser;
    result->effort.speed = speed;
    *quantiser = RATE_FIRST_GUESS;
    relume_status status = search(&r, tried, AV1_FAST, quantiser);
    r.rough = false;
    r.done = 0.2;
    *quantiser = within(*quantiser + (target->psnr_db > 0.0 ? 1 : -2) * SLOW_IS_FINER);
    if (!status && WORTH_TRYING * tried < groups->count)
        status = search(&r, tried, speed, quantiser);
    r.done = 0.5;
    if (!status)
        status = search(&r, groups->count, speed, quantiser);
    struct trial *best = &r.trial[*quantiser];
    result->psnr_db = best->psnr_db;
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
                         double header, const struct relume_encode_params *p)
{
    int begin[] = {0, 1}, alone[] = {0};
    const struct view_groups group = {1, begin, alone};
    struct rate r = {.coefficients = &coefficients,
                     .groups = &group,
                     .rough = true,
                     .first = view,
                     .capture = capture,
                     .p = p,
                     .step_db = target->psnr_db > 0.0 ? USUAL_DB : USUAL_BYTES,
                     .target = *target};
    int quantiser = RATE_FIRST_GUESS, nearest = RATE_FIRST_GUESS;
    r.target.bytes = fmax(target->bytes - header, 1.0);
    const relume_status status = search(&r, 1, AV1_FAST, &quantiser);
    for (int q = AV1_FINEST; !status && q <= AV1_COARSEST; q++)
        if (r.trial[q].words && fabs(surplus(&r, q)) < fabs(surplus(&r, nearest)))
            nearest = q;
    const struct trial *t = &r.trial[nearest];
    *merit = rate_merit_of(t->psnr_db, t->bytes, target, header);
    forget(&r);
    return status;
}
