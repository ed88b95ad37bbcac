// rate.c - the quantiser for a quality or a size, by trying
#include "encode/encode/rate.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "format/coder/codes.h"
#include "format/coder/coefficients.h"
#include "format/team/gather.h"

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
    struct lossy_words *words;     // [views], of the tiles of this member; NULL: not tried
    size_t *count;                 // [views]: words, with the tiles of all members
    struct encode_square *square;  // [views]
    bool *known;                   // [groups]
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

// What a member codes of a group.
struct piece {
    struct group_share tiles;
    struct av1_bytes *sequence;    // [tiles][views]
    struct encode_square *square;  // [views][tiles]
};

static size_t tiles_in(const struct piece *p)
{
    return (size_t)(p->tiles.end - p->tiles.first);
}

// Which group is the i-th that is tried.
static int group_at(const struct rate *r, int i)
{
    return (int)((2LL * i + 1) * r->groups->count / (2LL * r->tried));
}

// The views of a group, *count of them.
static const int *views_in(const struct rate *r, int group, int *count)
{
    const struct view_groups *g = r->groups;
    *count = g->begin[group + 1] - g->begin[group];
    return g->view + g->begin[group];
}

// The tiles of a member in a group, none where a trial of fewer groups has coded it.
static struct group_share tiles_left(const struct rate *r, const struct trial *known, int group,
                                     int member)
{
    const int members = r->by ? r->by->team->members : 1;
    return known->known[group]
               ? (struct group_share){0, 0}
               : groups_tiles(r->groups, group, groups_share(r->groups, member, members));
}

// ---------------------------------------------------------------- groups in parallel

struct job {
    const struct rate *rate;
    int quantiser, each;  // threads for each
    struct piece *piece;  // [tried]
    relume_status *status;
};

static void code_group(void *context, size_t item, int worker)
{
    struct job *j = context;
    const struct rate *r = j->rate;
    const struct piece *p = &j->piece[item];
    int n;
    const int *view = views_in(r, group_at(r, (int)item), &n);
    const struct av1_effort effort = {j->quantiser, r->speed};
    relume_coefficients *from[AV1_MOST_MEMBERS] = {0};
    (void)worker;
    if (!tiles_in(p))
        return;
    for (int i = 0; i < n; i++)
        from[i] = r->coefficients[view[i]];
    j->status[item] = lossy_encode_tiles(p->sequence, from, n, p->tiles.first, p->tiles.end,
                                         &effort, j->each, r->p->log);
}

static relume_status code_groups(struct piece *piece, const struct rate *r, int quantiser)
{
    const int threads = thread_count(r->p->threads);
    int left = 0;
    for (int i = 0; i < r->tried; i++)
        left += tiles_in(&piece[i]) > 0;
    struct job j = {r, quantiser, left && left < threads ? threads / left : 1, piece, NULL};
    j.status = mem_zeroed((size_t)r->tried, sizeof *j.status);
    if (!j.status)
        return RELUME_ENOMEM;
    thread_for(threads, (size_t)r->tried, code_group, &j);
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < r->tried; i++)
        status = j.status[i];
    mem_free(j.status);
    return status;
}

// ---------------------------------------------------------------- quality

// A row of tiles as it was decoded.
struct decoded {
    int row;  // of tiles; -1: none so far
    struct relume_rect rect;
    uint16_t *codes;
    relume_status status;
};

struct shown {
    const struct relume_coefficients_info *info;
    const struct lossy_shape *shape;
    const struct lossy_words *words, *anchor;
    const struct encode_tiles *tiles;
    int threads;
    struct decoded *now;
};

static void decode_tiles(const struct shown *s, int row)
{
    const struct encode_tiles *t = s->tiles;
    const int before = row * t->across, width = s->info->width, height = s->info->height;
    const int first = t->first > before ? t->first - before : 0;
    const int end = t->end < before + t->across ? t->end - before : t->across;
    const int left = first * t->side, top = row * t->side;
    s->now->row = row;
    s->now->rect = (struct relume_rect){left, top, smaller_of(end * t->side, width) - left,
                                        smaller_of(t->side, height - top)};
    s->now->status =
        lossy_decode(s->now->codes, s->shape, &s->now->rect, s->words, s->anchor, s->threads, NULL);
}

static void shown_row(const void *user, int row, float *planes, size_t stride)
{
    const struct shown *s = user;
    if (!s->now->status && row / s->tiles->side != s->now->row)
        decode_tiles(s, row / s->tiles->side);
    const struct relume_rect *at = &s->now->rect;
    const size_t width = (size_t)at->width, size = width * (size_t)at->height;
    for (int k = 0; !s->now->status && k < s->info->planes; k++)
        codes_restore(planes + (size_t)k * stride + at->left, RELUME_STORE_12, s->now->codes,
                      (size_t)k * size + (size_t)(row - at->top) * width, width, s->info->scale[k],
                      s->info->offset[k]);
}

// The words of the `member`-th of the views of a group, with what a piece has of its tiles.
static relume_status piece_words(struct lossy_words *out, const struct lossy_cut *cut,
                                 const struct piece *p, size_t views, size_t member)
{
    struct av1_bytes *all = mem_zeroed((size_t)cut->count, sizeof *all);
    *out = (struct lossy_words){0};
    for (size_t i = 0; all && i < tiles_in(p); i++)
        all[(size_t)p->tiles.first + i] = p->sequence[i * views + member];
    const relume_status status = all ? lossy_join(out, cut, all, 1) : RELUME_ENOMEM;
    mem_free(all);
    return status;
}

static relume_status judge_view(struct encode_square *square, const struct rate *r, int view,
                                const struct encode_tiles *tiles, const struct lossy_words *words,
                                const struct lossy_words *anchor)
{
    relume_coefficients *c = r->coefficients[view];
    const struct relume_coefficients_info *info = relume_coefficients_info(c);
    int *order = lossy_order(info->coder);
    const struct lossy_shape shape = {info->width, info->height, info->planes,
                                      lossy_in_colour(info->coder), order};
    const size_t pixels = (size_t)info->width * (size_t)smaller_of(tiles->side, info->height);
    struct decoded now = {.row = -1,
                          .codes = mem_array((size_t)info->planes, pixels * sizeof *now.codes)};
    const struct shown shown = {info, &shape, words, anchor, tiles, r->p->threads, &now};
    relume_status status = now.codes ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = encode_judge_tiles(square, c, r->capture, r->first + view, tiles,
                                    &(const struct encode_values){shown_row, &shown}, r->p);
    mem_free(order);
    mem_free(now.codes);
    return status ? status : now.status;
}

static relume_status judge_group(struct piece *p, const struct rate *r, int group)
{
    const struct lossy_cut *cut = &r->groups->cut[group];
    const struct encode_tiles tiles = {cut->side, cut->across, p->tiles.first, p->tiles.end};
    struct lossy_words anchor = {0}, words = {0};
    relume_status status = RELUME_OK;
    int n;
    const int *view = views_in(r, group, &n);
    for (int k = 0; !status && k < n; k++) {
        struct lossy_words *own = k ? &words : &anchor;
        status = piece_words(own, cut, p, (size_t)n, (size_t)k);
        if (!status)
            status = judge_view(p->square + (size_t)k * tiles_in(p), r, view[k], &tiles, own,
                                k ? &anchor : NULL);
        mem_free(words.word);
        words = (struct lossy_words){0};
    }
    mem_free(anchor.word);
    return status;
}

// The bytes and the quality of all that is tried.
static void sum_up(struct trial *t, const struct rate *r)
{
    double square = 0.0;
    int views = 0, n;
    t->bytes = 0.0;
    for (int i = 0; i < r->tried; i++) {
        const int *view = views_in(r, group_at(r, i), &n);
        for (int k = 0; k < n; k++, views++) {
            const struct encode_square *s = &t->square[view[k]];
            square += s->count ? s->sum / (double)s->count : 0.0;
            t->bytes += 4.0 * (double)t->count[view[k]];
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
    t->count = mem_zeroed(views, sizeof *t->count);
    t->square = mem_zeroed(views, sizeof *t->square);
    t->known = mem_zeroed((size_t)r->groups->count, sizeof *t->known);
    return t->words && t->count && t->square && t->known ? RELUME_OK : RELUME_ENOMEM;
}

static void trial_destroy(struct trial *t, int views)
{
    for (int i = 0; t->words && i < views; i++)
        mem_free(t->words[i].word);
    mem_free(t->words);
    mem_free(t->count);
    mem_free(t->square);
    mem_free(t->known);
    *t = (struct trial){0};
}

struct trying {
    struct rate *rate;
    struct trial *trial;
    int quantiser;
};

// The pieces of the groups that are tried, each with room for what is coded.
static relume_status create_pieces(struct piece **out, const struct trying *try, int member)
{
    const struct rate *r = try->rate;
    struct piece *piece = *out = mem_zeroed((size_t)r->tried, sizeof *piece);
    bool good = piece != NULL;
    for (int i = 0, n; good && i < r->tried; i++) {
        struct piece *p = &piece[i];
        views_in(r, group_at(r, i), &n);
        p->tiles = tiles_left(r, try->trial, group_at(r, i), member);
        p->sequence = mem_zeroed(tiles_in(p) * (size_t)n + 1, sizeof *p->sequence);
        p->square = mem_zeroed(tiles_in(p) * (size_t)n + 1, sizeof *p->square);
        good = p->sequence && p->square;
    }
    return good ? RELUME_OK : RELUME_ENOMEM;
}

static void destroy_pieces(struct piece *piece, const struct rate *r)
{
    for (int i = 0, n; piece && i < r->tried; i++) {
        views_in(r, group_at(r, i), &n);
        for (size_t k = 0; piece[i].sequence && k < tiles_in(&piece[i]) * (size_t)n; k++)
            mem_free(piece[i].sequence[k].byte);
        mem_free(piece[i].sequence);
        mem_free(piece[i].square);
    }
    mem_free(piece);
}

// Of each tile and view of a group its difference, and the bytes that follow.
struct put_tile {
    struct encode_square square;
    uint64_t bytes;
};

static bool put_piece(const struct piece *p, size_t views, struct relume_buffer *out)
{
    const struct relume_writer writer = relume_buffer_writer(out);
    bool good = true;
    for (size_t i = 0; good && i < tiles_in(p) * views; i++) {
        const struct av1_bytes *b = &p->sequence[i];
        const struct put_tile head = {p->square[i % views * tiles_in(p) + i / views], b->size};
        good = writer.write(writer.user, &head, sizeof head, out->size) &&
               writer.write(writer.user, b->byte, b->size, out->size);
    }
    return good;
}

static relume_status put_pieces(const struct piece *piece, const struct rate *r,
                                struct relume_buffer *out)
{
    const struct relume_writer writer = relume_buffer_writer(out);
    bool good = writer.write(writer.user, "w", 1, 0);  // a piece is never empty
    for (int i = 0, n; good && i < r->tried; i++) {
        views_in(r, group_at(r, i), &n);
        good = put_piece(&piece[i], (size_t)n, out);
    }
    return good ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status make_trial(void *context, int member, struct relume_buffer *out)
{
    const struct trying *try = context;
    struct rate *r = try->rate;
    struct piece *piece;
    relume_status status = create_pieces(&piece, try, member);
    for (int i = 0; !status && r->by && i < r->tried; i++)
        if (tiles_in(&piece[i]))
            status = r->by->load(r->by->user, group_at(r, i), piece[i].tiles);
    if (!status)
        status = code_groups(piece, r, try->quantiser);
    for (int i = 0; !status && i < r->tried; i++)
        if (tiles_in(&piece[i]))
            status = judge_group(&piece[i], r, group_at(r, i));
    if (!status)
        status = put_pieces(piece, r, out);
    destroy_pieces(piece, r);
    return status;
}

// The tiles of a member in a group, as they were put; `p` has their bytes afterwards, which are the
// buffer's.
static relume_status take_piece(struct trial *t, struct piece *p, const struct rate *r, int group,
                                const struct relume_buffer *from, size_t *at)
{
    int n;
    const int *view = views_in(r, group, &n);
    for (size_t i = 0; i < tiles_in(p) * (size_t)n; i++) {
        const int own = view[i % (size_t)n];
        struct put_tile head;
        if (from->size - *at < sizeof head)
            return RELUME_EDAMAGED;
        memcpy(&head, from->data + *at, sizeof head);
        *at += sizeof head;
        if (!head.bytes || head.bytes > from->size - *at ||
            !(head.square.sum >= 0.0 && head.square.sum < 0x1p60))
            return RELUME_EDAMAGED;
        p->sequence[i] = (struct av1_bytes){.byte = from->data + *at, .size = (size_t)head.bytes};
        *at += (size_t)head.bytes;
        t->square[own].sum += head.square.sum;
        t->square[own].count += head.square.count;
        t->count[own] += (t->count[own] ? 0 : lossy_words_of(&r->groups->cut[group])) +
                         lossy_words_for((size_t)head.bytes);
    }
    return RELUME_OK;
}

static relume_status keep_words(struct trial *t, const struct piece *p, const struct rate *r,
                                int group)
{
    relume_status status = RELUME_OK;
    int n;
    const int *view = views_in(r, group, &n);
    for (int k = 0; !status && k < n; k++)
        status = piece_words(&t->words[view[k]], &r->groups->cut[group], p, (size_t)n, (size_t)k);
    return status;
}

static relume_status take_trial(void *context, int member, const struct relume_buffer *from)
{
    const struct trying *try = context;
    const struct rate *r = try->rate;
    const bool is_own = !r->by || member == r->by->team->member;
    struct piece *piece;
    size_t at = 1;
    relume_status status = create_pieces(&piece, try, member);
    if (!status && from->size < at)
        status = RELUME_EDAMAGED;
    for (int i = 0; !status && i < r->tried; i++) {
        status = take_piece(try->trial, &piece[i], r, group_at(r, i), from, &at);
        if (!status && is_own && tiles_in(&piece[i]))
            status = keep_words(try->trial, &piece[i], r, group_at(r, i));
    }
    for (int i = 0, n; piece && i < r->tried; i++) {  // the bytes are not theirs
        views_in(r, group_at(r, i), &n);
        if (piece[i].sequence)
            memset(piece[i].sequence, 0, tiles_in(&piece[i]) * (size_t)n * sizeof *piece->sequence);
    }
    destroy_pieces(piece, r);
    return status || at == from->size ? status : RELUME_EDAMAGED;
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
    for (int i = 0; !status && i < r->tried; i++)
        try.trial->known[group_at(r, i)] = true;
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
                         double header, const struct relume_encode_params *p)
{
    const struct relume_coefficients_info *info = relume_coefficients_info(coefficients);
    struct view_groups group;
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
    relume_status status = groups_alone(&group, info->coder, info->width, info->height);
    if (!status)
        status = search(&r, 1, AV1_FAST, &quantiser);
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
