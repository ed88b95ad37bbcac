// coded_rows.c - coefficients of the rows that are needed, and the steps that all views share
//
// Where a row of tiles is split between members both of them encode it, but only the one that has
// its first tile says what is in it: so every row counts once.
#include "encode/encode/coded_rows.h"

#include "core/base/memory.h"
#include "format/team/gather.h"

#include <float.h>
#include <math.h>
#include <string.h>

static int rows_of(const struct lossy_cut *cut)
{
    return cut->count / cut->across;
}

relume_status coded_rows_create(struct coded_rows *out, struct material *m,
                                const struct view_groups *groups, const struct relume_team *team)
{
    const struct relume_manifest *manifest = relume_capture_manifest(m->capture);
    const size_t planes = (size_t)relume_coder_info(m->coder)->planes, views = (size_t)m->views;
    *out = (struct coded_rows){.m = m, .groups = groups, .team = team};
    out->masked = manifest->geometry.disc > 0;
    for (int i = 0; i < m->views; i++)
        out->masked |= manifest->view[i].mask != NULL;
    for (int g = 0; g < groups->count; g++)
        out->most = rows_of(&groups->cut[g]) > out->most ? rows_of(&groups->cut[g]) : out->most;
    out->there = mem_zeroed(views * (size_t)out->most, sizeof *out->there);
    out->sum = mem_zeroed(views, sizeof *out->sum);
    out->shone = mem_zeroed(views * (size_t)manifest->lights, sizeof *out->shone);
    out->total = mem_array(planes, sizeof *out->total);
    if (!out->there || !out->sum || !out->shone || !out->total)
        return RELUME_ENOMEM;
    for (size_t p = 0; p < planes; p++)
        out->total[p] = (struct range){FLT_MAX, -FLT_MAX};
    return RELUME_OK;
}

void coded_rows_destroy(struct coded_rows *r)
{
    mem_free(r->there);
    mem_free(r->sum);
    mem_free(r->shone);
    mem_free(r->total);
}

// ---------------------------------------------------------------- rows of tiles

// Rows of a view that some rows of tiles cover.
struct rows {
    int first, count;
};

static struct rows covered(const struct coded_rows *r, const struct lossy_cut *cut, int first,
                           int end)
{
    const int height = relume_capture_height(r->m->capture), below = end * cut->side;
    return (struct rows){first * cut->side, (below < height ? below : height) - first * cut->side};
}

// The rows of tiles `first` .. `end` of a view, whether they are there or not.
static relume_status encode_rows(struct coded_rows *r, const struct lossy_cut *cut, int view,
                                 int first, int end)
{
    struct material *m = r->m;
    relume_coefficients **c = &m->coefficients[view];
    const struct rows rows = covered(r, cut, first, end);
    const bool begun = *c != NULL;
    const relume_status status =
        begun ? encode_more_rows(*c, m->capture, view, rows.first, rows.count, m->encode)
              : encode_some_rows(c, m->coder, m->capture, view, rows.first, rows.count, m->encode);
    if (status)
        return status;
    if (!begun && r->settled)
        coefficients_choose_steps(*c, r->total, r->masked, m->encode->step);
    m->view[view].coefficients = *c;
    memset(r->there + (size_t)view * (size_t)r->most + first, true, (size_t)(end - first));
    return RELUME_OK;
}

static relume_status load_rows(struct coded_rows *r, const struct lossy_cut *cut, int view,
                               int first, int end)
{
    const bool *there = r->there + (size_t)view * (size_t)r->most;
    relume_status status = RELUME_OK;
    for (int i = first, n; !status && i < end; i += n) {
        for (n = 1; i + n < end && there[i + n] == there[i];)
            n++;
        status = there[i] ? RELUME_OK : encode_rows(r, cut, view, i, i + n);
    }
    return status;
}

static int upwards(int tile, const struct lossy_cut *cut)
{
    return (tile + cut->across - 1) / cut->across;
}

relume_status coded_rows_load(struct coded_rows *r, int group, struct group_share tiles)
{
    const struct lossy_cut *cut = &r->groups->cut[group];
    relume_status status = RELUME_OK;
    for (int i = r->groups->begin[group]; !status && i < r->groups->begin[group + 1]; i++)
        status = load_rows(r, cut, r->groups->view[i], tiles.first / cut->across,
                           upwards(tiles.end, cut));
    return status;
}

relume_status coded_rows_load_view(struct coded_rows *r, int view)
{
    const struct lossy_cut *cut = &r->groups->cut[groups_with(r->groups, view)];
    return load_rows(r, cut, view, 0, rows_of(cut));
}

// ---------------------------------------------------------------- ranges and reports

// Calls `body` for the views of which a member counts rows of tiles, from `first` on.
static relume_status each_counted(struct coded_rows *r, int member,
                                  relume_status (*body)(void *user, const struct lossy_cut *cut,
                                                        int view, int first, int end),
                                  void *user)
{
    const struct view_groups *g = r->groups;
    const struct group_share share = groups_share(g, member, r->team ? r->team->members : 1);
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < g->count; i++) {
        const struct group_share tiles = groups_tiles(g, i, share);
        const int first = upwards(tiles.first, &g->cut[i]), end = upwards(tiles.end, &g->cut[i]);
        for (int k = g->begin[i]; !status && first < end && k < g->begin[i + 1]; k++)
            status = body(user, &g->cut[i], g->view[k], first, end);
    }
    return status;
}

// Of the counted rows of a view; a byte for each light and the error of each row follow.
struct put_sums {
    double root;
    uint64_t measured, lit, pixels, black, clipped, always_clipped, repaired;
};

struct putting {
    struct coded_rows *r;
    struct relume_buffer *out;
    struct range *total;
};

static relume_status put_view(void *user, const struct lossy_cut *cut, int view, int first, int end)
{
    const struct putting *p = user;
    struct coded_rows *r = p->r;
    const relume_status status = encode_rows(r, cut, view, first, end);
    if (status)
        return status;
    const relume_coefficients *c = r->m->coefficients[view];
    const struct relume_encode_census *s = &c->report.census;
    const struct put_sums sums = {
        c->some.root_sum, c->some.error_count, c->some.lit_count, s->pixels,
        s->black,         s->clipped,          s->always_clipped, s->repaired};
    const size_t lights = (size_t)relume_coder_info(c->info.coder)->lights;
    const size_t planes = (size_t)c->info.planes;
    const struct rows rows = covered(r, cut, first, end);
    const struct relume_writer w = relume_buffer_writer(p->out);
    const size_t bands = ((size_t)rows.count + BAND_ROWS - 1) / BAND_ROWS;
    const struct range *band = c->band + (size_t)rows.first / BAND_ROWS * planes;
    for (size_t i = 0; i < bands * planes; i++)
        p->total[i % planes] = range_join(p->total[i % planes], band[i]);
    return w.write(w.user, &sums, sizeof sums, p->out->size) &&
                   w.write(w.user, c->some.lit, lights, p->out->size) &&
                   w.write(w.user, c->some.error + rows.first,
                           (size_t)rows.count * sizeof *c->some.error, p->out->size)
               ? RELUME_OK
               : RELUME_ENOMEM;
}

static relume_status make_ranges(void *context, int member, struct relume_buffer *out)
{
    struct coded_rows *r = context;
    const size_t planes = (size_t)relume_coder_info(r->m->coder)->planes;
    struct putting p = {r, out, mem_array(planes, sizeof *p.total)};
    const struct relume_writer w = relume_buffer_writer(out);
    if (!p.total)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < planes; i++)
        p.total[i] = (struct range){FLT_MAX, -FLT_MAX};
    relume_status status = each_counted(r, member, put_view, &p);
    if (!status && !w.write(w.user, p.total, planes * sizeof *p.total, out->size))
        status = RELUME_ENOMEM;
    mem_free(p.total);
    return status;
}

struct taking {
    struct coded_rows *r;
    const struct relume_buffer *piece;
    size_t at;
};

static bool take(struct taking *t, void *to, size_t size)
{
    if (size > t->piece->size - t->at)
        return false;
    memcpy(to, t->piece->data + t->at, size);
    t->at += size;
    return true;
}

static bool is_count(uint64_t n)
{
    return n < (uint64_t)1 << 53;
}

static bool add_sums(struct rows_sum *to, const struct put_sums *s)
{
    to->root += s->root;
    to->measured += (size_t)s->measured;
    to->lit += (size_t)s->lit;
    to->census.pixels += (size_t)s->pixels;
    to->census.black += (size_t)s->black;
    to->census.clipped += (size_t)s->clipped;
    to->census.always_clipped += (size_t)s->always_clipped;
    to->census.repaired += (size_t)s->repaired;
    return s->root >= 0.0 && s->root < DBL_MAX && is_count(s->measured) && is_count(s->lit) &&
           is_count(s->pixels) && is_count(s->black) && is_count(s->clipped) &&
           is_count(s->always_clipped) && is_count(s->repaired);
}

static relume_status take_view(void *user, const struct lossy_cut *cut, int view, int first,
                               int end)
{
    struct taking *t = user;
    struct rows_sum *to = &t->r->sum[view];
    const size_t lights = (size_t)relume_capture_manifest(t->r->m->capture)->lights;
    bool *shone = t->r->shone + (size_t)view * lights;
    struct put_sums sums;
    if (!take(t, &sums, sizeof sums) || !add_sums(to, &sums))
        return RELUME_EDAMAGED;
    for (size_t i = 0; i < lights; i++) {
        unsigned char lit;
        if (!take(t, &lit, 1) || lit > 1)
            return RELUME_EDAMAGED;
        shone[i] |= lit != 0;
    }
    for (int y = covered(t->r, cut, first, end).count; y > 0; y--) {
        double error;
        if (!take(t, &error, sizeof error) || !(error >= 0.0 && error < DBL_MAX))
            return RELUME_EDAMAGED;
        to->error += error;
    }
    return RELUME_OK;
}

static relume_status take_ranges(void *context, int member, const struct relume_buffer *piece)
{
    struct coded_rows *r = context;
    struct taking t = {r, piece, 0};
    relume_status status = each_counted(r, member, take_view, &t);
    for (int p = 0; !status && p < relume_coder_info(r->m->coder)->planes; p++) {
        struct range range;
        if (!take(&t, &range, sizeof range) || !(range.min >= -FLT_MAX && range.max <= FLT_MAX))
            status = RELUME_EDAMAGED;
        else
            r->total[p] = range_join(r->total[p], range);
    }
    return status || t.at == piece->size ? status : RELUME_EDAMAGED;
}

static struct relume_encode_report report_of(const struct coded_rows *r, int view)
{
    const struct rows_sum *s = &r->sum[view];
    const int lights = relume_capture_manifest(r->m->capture)->lights;
    const double root = s->lit ? s->root / (double)s->lit : 0.0;
    struct relume_encode_report report = {
        .fit_rms = s->measured ? sqrt(s->error / (double)s->measured) : 0.0,
        .typical = root * root,
        .census = s->census,
    };
    for (int i = 0; i < lights; i++)
        report.census.black_images += !r->shone[view * lights + i];
    return report;
}

relume_status coded_rows_find_steps(struct coded_rows *r)
{
    struct material *m = r->m;
    const relume_status status =
        team_gather(r->team, "ranges", make_ranges, take_ranges, r, m->p->log);
    for (int i = 0; !status && i < m->views; i++) {
        m->report[i] = report_of(r, i);
        if (m->coefficients[i])
            coefficients_choose_steps(m->coefficients[i], r->total, r->masked, m->encode->step);
    }
    r->settled = !status;
    return status;
}
