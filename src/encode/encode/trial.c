// trial.c - planes coded at one quantiser, and judged by the photographs
//
// Tiles are coded by groups, in parallel, decoded again and relit under the captured lights. In a
// team each member does so with its own tiles, and gets bytes and errors of every other tile. It
// keeps the words of its own.
#include "encode/encode/trial.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "encode/parts/coded_tiles.h"
#include "format/coder/codes.h"
#include "format/coder/coding.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// A trial in progress: the share of a member.
struct attempt {
    struct trial *trial;
    const struct trial_plan *plan;
    int quantiser;
    struct coded_tiles tiles;  // [tried]
    bool own;                  // it is this member's
};

// Which group is the i-th that is tried.
static int group_at(const struct trial_plan *plan, int i)
{
    return (int)((2LL * i + 1) * plan->groups->count / (2LL * plan->tried));
}

// ---------------------------------------------------------------- groups in parallel

struct coding_run {
    const struct attempt *attempt;
    int each;  // threads for each group
    relume_status *status;
};

static void code_group(void *context, size_t item, int worker)
{
    const struct coding_run *c = context;
    const struct trial_plan *plan = c->attempt->plan;
    const struct group_tiles *t = &c->attempt->tiles.group[item];
    const struct av1_effort effort = {c->attempt->quantiser, plan->preset};
    relume_coefficients *from[AV1_MOST_MEMBERS] = {0};
    (void)worker;
    if (!tiles_in(t))
        return;
    for (int i = 0; i < t->views; i++)
        from[i] = plan->coefficients[t->view[i]];
    c->status[item] = lossy_encode_tiles(t->sequence, from, t->views, t->tiles.first, t->tiles.end,
                                         &effort, c->each, plan->p->log);
}

static relume_status code_groups(const struct attempt *a)
{
    const int threads = thread_count(a->plan->p->threads), groups = a->tiles.groups;
    int left = 0;
    for (int i = 0; i < groups; i++)
        left += tiles_in(&a->tiles.group[i]) > 0;
    struct coding_run c = {a, left && left < threads ? threads / left : 1, NULL};
    c.status = mem_zeroed((size_t)groups, sizeof *c.status);
    if (!c.status)
        return RELUME_ENOMEM;
    thread_for(threads, (size_t)groups, code_group, &c);
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < groups; i++)
        status = c.status[i];
    mem_free(c.status);
    return status;
}

// ---------------------------------------------------------------- quality

// A row of tiles as it was decoded.
struct decoded_row {
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
    struct decoded_row *now;
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

// The words of the `member`-th of the views of a group, with the tiles that were coded.
static relume_status tiles_words(struct lossy_words *out, const struct lossy_cut *cut,
                                 const struct group_tiles *t, int member)
{
    struct av1_bytes *all = mem_zeroed((size_t)cut->count, sizeof *all);
    *out = (struct lossy_words){0};
    for (size_t i = 0; all && i < tiles_in(t); i++)
        all[(size_t)t->tiles.first + i] = t->sequence[i * (size_t)t->views + (size_t)member];
    const relume_status status = all ? lossy_join(out, cut, all, 1) : RELUME_ENOMEM;
    mem_free(all);
    return status;
}

static relume_status judge_view(struct encode_square *square, const struct trial_plan *plan,
                                int view, const struct encode_tiles *tiles,
                                const struct lossy_words *words, const struct lossy_words *anchor)
{
    relume_coefficients *c = plan->coefficients[view];
    const struct relume_coefficients_info *info = relume_coefficients_info(c);
    int *order = lossy_order(info->coder);
    const struct lossy_shape shape = {
        info->width, info->height, info->planes, lossy_in_colour(info->coder), order, NULL};
    const size_t pixels = (size_t)info->width * (size_t)smaller_of(tiles->side, info->height);
    struct decoded_row now = {.row = -1,
                              .codes = mem_array((size_t)info->planes, pixels * sizeof *now.codes)};
    const struct shown shown = {info, &shape, words, anchor, tiles, plan->p->threads, &now};
    relume_status status = now.codes ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = encode_judge_tiles(square, c, plan->capture, plan->first + view, tiles,
                                    &(const struct encode_values){shown_row, &shown, plan->own},
                                    plan->p);
    mem_free(order);
    mem_free(now.codes);
    return status ? status : now.status;
}

static relume_status judge_group(struct group_tiles *t, const struct trial_plan *plan, int group)
{
    const struct lossy_cut *cut = &plan->groups->cut[group];
    const struct encode_tiles tiles = {cut->side, cut->across, t->tiles.first, t->tiles.end};
    struct lossy_words anchor = {0}, words = {0};
    relume_status status = RELUME_OK;
    for (int k = 0; !status && k < t->views; k++) {
        struct lossy_words *own = k ? &words : &anchor;
        status = tiles_words(own, cut, t, k);
        if (!status)
            status = judge_view(t->square + (size_t)k * tiles_in(t), plan, t->view[k], &tiles, own,
                                k ? &anchor : NULL);
        mem_free(words.word);
        words = (struct lossy_words){0};
    }
    mem_free(anchor.word);
    return status;
}

// ---------------------------------------------------------------- a share

// The tiles of a member, none of groups that a trial of fewer groups has coded.
static relume_status begin_share(void *context, int member)
{
    struct attempt *a = context;
    const struct trial_plan *plan = a->plan;
    const struct relume_team *team = plan->by ? plan->by->team : NULL;
    const struct group_share share = groups_share(plan->groups, member, team_members(team));
    const size_t tried = (size_t)plan->tried;
    int *group = mem_array(tried, sizeof *group);
    struct group_share *tiles = mem_zeroed(tried, sizeof *tiles);
    relume_status status = group && tiles ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < plan->tried; i++) {
        group[i] = group_at(plan, i);
        if (!a->trial->known[group[i]])
            tiles[i] = groups_tiles(plan->groups, group[i], share);
    }
    a->own = !team || member == team->member;
    coded_tiles_destroy(&a->tiles);
    if (!status)
        status = coded_tiles_create(&a->tiles, plan->groups, group, tiles, plan->tried);
    mem_free(group);
    mem_free(tiles);
    return status;
}

static relume_status code_share(void *context)
{
    struct attempt *a = context;
    const struct trial_plan *plan = a->plan;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && plan->by && i < plan->tried; i++)
        if (tiles_in(&a->tiles.group[i]))
            status = plan->by->load(plan->by->user, group_at(plan, i), a->tiles.group[i].tiles);
    if (!status)
        status = code_groups(a);
    for (int i = 0; !status && i < plan->tried; i++)
        if (tiles_in(&a->tiles.group[i]))
            status = judge_group(&a->tiles.group[i], plan, group_at(plan, i));
    return status;
}

static void add_tiles(struct trial *t, const struct group_tiles *from, const struct lossy_cut *cut)
{
    for (size_t k = 0; k < (size_t)from->views; k++)
        for (size_t i = 0; i < tiles_in(from); i++) {
            const int view = from->view[k];
            const struct encode_square *square = &from->square[k * tiles_in(from) + i];
            t->square[view].sum += square->sum;
            t->square[view].count += square->count;
            t->count[view] += (t->count[view] ? 0 : lossy_words_of(cut)) +
                              lossy_words_for(from->sequence[i * (size_t)from->views + k].size);
        }
}

static relume_status add_share(void *context)
{
    const struct attempt *a = context;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < a->plan->tried; i++) {
        const struct lossy_cut *cut = &a->plan->groups->cut[group_at(a->plan, i)];
        const struct group_tiles *tiles = &a->tiles.group[i];
        add_tiles(a->trial, tiles, cut);
        for (int k = 0; !status && a->own && tiles_in(tiles) && k < tiles->views; k++)
            status = tiles_words(&a->trial->words[tiles->view[k]], cut, tiles, k);
    }
    return status;
}

// ---------------------------------------------------------------- a trial

static relume_status create_trial(struct trial *t, const struct view_groups *groups)
{
    const size_t views = (size_t)groups->begin[groups->count];
    t->words = mem_zeroed(views, sizeof *t->words);
    t->count = mem_zeroed(views, sizeof *t->count);
    t->square = mem_zeroed(views, sizeof *t->square);
    t->known = mem_zeroed((size_t)groups->count, sizeof *t->known);
    return t->words && t->count && t->square && t->known ? RELUME_OK : RELUME_ENOMEM;
}

void trial_destroy(struct trial *t, int views)
{
    for (int i = 0; t->words && i < views; i++)
        mem_free(t->words[i].word);
    mem_free(t->words);
    mem_free(t->count);
    mem_free(t->square);
    mem_free(t->known);
    *t = (struct trial){0};
}

// The bytes and the quality of all that is tried.
static void sum_up(struct trial *t, const struct trial_plan *plan)
{
    const struct view_groups *g = plan->groups;
    double square = 0.0;
    int views = 0;
    t->bytes = 0.0;
    for (int i = 0; i < plan->tried; i++) {
        const int group = group_at(plan, i);
        for (int k = g->begin[group]; k < g->begin[group + 1]; k++, views++) {
            const struct encode_square *s = &t->square[g->view[k]];
            square += s->count ? s->sum / (double)s->count : 0.0;
            t->bytes += 4.0 * (double)t->count[g->view[k]];
        }
    }
    t->bytes *= (double)g->begin[g->count] / views;
    t->psnr_db = -10.0 * log10(fmax(square / views, 1e-20));
}

relume_status trial_add_groups(struct trial *t, const struct trial_plan *plan, int quantiser)
{
    struct attempt a = {.trial = t, .plan = plan, .quantiser = quantiser};
    static const struct team_work work = {begin_share, code_share, add_share};
    char what[32];
    snprintf(what, sizeof what, "words.%d.%d.%d", plan->tried, (int)plan->preset, quantiser);
    relume_status status = t->words ? RELUME_OK : create_trial(t, plan->groups);
    if (!status)
        status = team_share(plan->by ? plan->by->team : NULL, what, &work, &a, &coded_tiles_bytes,
                            &a.tiles, plan->p->log);
    for (int i = 0; !status && i < plan->tried; i++)
        t->known[group_at(plan, i)] = true;
    if (!status)
        sum_up(t, plan);
    coded_tiles_destroy(&a.tiles);
    return status;
}
