// coded_rows.c - coefficients of the rows that are needed, and the steps that all views share
//
// Where a row of tiles is split between members both of them encode it, but only the one that has
// its first tile says what is in it: so every row counts once.
#include "encode/encode/coded_rows.h"

#include "core/base/memory.h"
#include "format/coder/coding.h"

#include <float.h>
#include <math.h>
#include <string.h>

static int rows_of(const struct lossy_cut *cut)
{
    return cut->count / cut->across;
}

relume_status coded_rows_create(struct coded_rows *out, struct contents *f,
                                const struct view_groups *groups, const struct relume_team *team)
{
    const struct relume_manifest *manifest = relume_capture_manifest(f->capture);
    const size_t planes = (size_t)relume_coder_info(f->coder)->planes, views = (size_t)f->views;
    *out = (struct coded_rows){.f = f, .groups = groups, .team = team};
    out->masked = manifest->geometry.disc > 0;
    for (int i = 0; i < f->views; i++)
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
    return row_counts_create(&out->counts, f->capture, f->coder, groups->view);
}

void coded_rows_destroy(struct coded_rows *r)
{
    mem_free(r->there);
    mem_free(r->sum);
    mem_free(r->shone);
    mem_free(r->total);
    relume_coefficients_destroy(&r->empty);
    row_counts_destroy(&r->counts);
}

// ---------------------------------------------------------------- rows of tiles

// Rows of a view that some rows of tiles cover.
struct rows {
    int first, count;
};

static struct rows covered(const struct coded_rows *r, const struct lossy_cut *cut, int first,
                           int end)
{
    const int height = relume_capture_height(r->f->capture), below = end * cut->side;
    return (struct rows){first * cut->side, (below < height ? below : height) - first * cut->side};
}

// The rows of tiles `first` .. `end` of a view, whether they are there or not.
static relume_status project_rows(struct coded_rows *r, const struct lossy_cut *cut, int view,
                                  int first, int end)
{
    struct contents *f = r->f;
    relume_coefficients **c = &f->coefficients[view];
    const struct rows rows = covered(r, cut, first, end);
    const bool begun = *c != NULL;
    const relume_status status =
        begun ? project_more_rows(*c, f->capture, view, rows.first, rows.count, f->encode)
              : project_some_rows(c, f->coder, f->capture, view, rows.first, rows.count, f->encode);
    if (status)
        return status;
    if (!begun && r->settled)
        coefficients_choose_steps(*c, r->total, r->masked, f->encode->step);
    f->view[view].coefficients = *c;
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
        status = there[i] ? RELUME_OK : project_rows(r, cut, view, i, i + n);
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

// Which rows of tiles of a group a member counts.
static struct rows counted(const struct coded_rows *r, int group, int member)
{
    const struct lossy_cut *cut = &r->groups->cut[group];
    const struct group_share tiles =
        groups_tiles(r->groups, group, groups_share(r->groups, member, team_members(r->team)));
    const int first = upwards(tiles.first, cut);
    return (struct rows){first, upwards(tiles.end, cut) - first};
}

static relume_status begin_share(void *context, int member)
{
    struct coded_rows *r = context;
    const struct view_groups *g = r->groups;
    struct row_counts *c = &r->counts;
    memset(c->view, 0, (size_t)c->views * sizeof *c->view);
    memset(c->lit, 0, (size_t)c->views * (size_t)c->lights * sizeof *c->lit);
    for (int p = 0; p < c->planes; p++)
        c->range[p] = (struct range){FLT_MAX, -FLT_MAX};
    for (int i = 0; i < g->count; i++) {
        const struct rows tiles = counted(r, i, member);
        const struct rows rows = covered(r, &g->cut[i], tiles.first, tiles.first + tiles.count);
        for (int k = g->begin[i]; tiles.count > 0 && k < g->begin[i + 1]; k++)
            r->counts.view[g->view[k]] =
                (struct view_counts){.row = rows.first, .rows = rows.count};
    }
    return RELUME_OK;
}

// Copies the sums of a view's rows, which were encoded last.
static void count_view(struct coded_rows *r, int view)
{
    const relume_coefficients *c = r->f->coefficients[view];
    const struct relume_census *s = &c->report.census;
    struct row_counts *to = &r->counts;
    struct view_counts *v = &to->view[view];
    const size_t lights = (size_t)to->lights, planes = (size_t)to->planes, at = (size_t)view;
    const size_t bands = ((size_t)v->rows + BAND_ROWS - 1) / BAND_ROWS;
    const struct range *band = c->band + (size_t)v->row / BAND_ROWS * planes;
    v->sums =
        (struct row_sums){c->some.root_sum, c->some.error_count, c->some.lit_count, s->pixels,
                          s->black,         s->clipped,          s->always_clipped, s->repaired};
    memcpy(to->lit + at * lights, c->some.lit, lights * sizeof *to->lit);
    memcpy(to->error + at * (size_t)to->height + v->row, c->some.error + v->row,
           (size_t)v->rows * sizeof *to->error);
    for (size_t i = 0; i < bands * planes; i++)
        to->range[i % planes] = range_join(to->range[i % planes], band[i]);
}

static relume_status count_share(void *context)
{
    struct coded_rows *r = context;
    const struct view_groups *g = r->groups;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < g->count; i++)
        for (int k = g->begin[i]; !status && k < g->begin[i + 1]; k++) {
            const struct view_counts *v = &r->counts.view[g->view[k]];
            const int first = v->row / g->cut[i].side;
            if (!v->rows)
                continue;
            status = project_rows(r, &g->cut[i], g->view[k], first,
                                  first + (v->rows + g->cut[i].side - 1) / g->cut[i].side);
            if (!status)
                count_view(r, g->view[k]);
        }
    return status;
}

static void add_sums(struct rows_total *to, const struct row_sums *s)
{
    to->root += s->root;
    to->measured += (size_t)s->measured;
    to->lit += (size_t)s->lit;
    to->census.pixels += (size_t)s->pixels;
    to->census.black += (size_t)s->black;
    to->census.clipped += (size_t)s->clipped;
    to->census.always_clipped += (size_t)s->always_clipped;
    to->census.repaired += (size_t)s->repaired;
}

static relume_status add_share(void *context)
{
    struct coded_rows *r = context;
    const struct row_counts *c = &r->counts;
    for (int i = 0; i < c->views; i++)
        add_sums(&r->sum[i], &c->view[i].sums);
    for (size_t i = 0; i < (size_t)c->views * (size_t)c->lights; i++)
        r->shone[i] |= c->lit[i];
    for (int p = 0; p < c->planes; p++)
        r->total[p] = range_join(r->total[p], c->range[p]);
    return RELUME_OK;
}

static struct relume_fidelity report_of(const struct coded_rows *r, int view)
{
    const struct rows_total *s = &r->sum[view];
    const int lights = r->counts.lights, height = r->counts.height;
    const double root = s->lit ? s->root / (double)s->lit : 0.0;
    double error = 0.0;
    for (int y = 0; y < height; y++)
        error += r->counts.error[(size_t)view * (size_t)height + (size_t)y];
    struct relume_fidelity report = {
        .fit_rms = s->measured ? sqrt(error / (double)s->measured) : 0.0,
        .typical = root * root,
        .census = s->census,
    };
    for (int i = 0; i < lights; i++)
        report.census.black_images += !r->shone[view * lights + i];
    return report;
}

static relume_status set_header_view(struct coded_rows *r)
{
    struct contents *f = r->f;
    relume_status status = RELUME_OK;
    if (!f->coefficients[0]) {
        status = coefficients_create(&r->empty, f->coder, relume_capture_width(f->capture),
                                     relume_capture_height(f->capture), f->encode);
        if (!status)
            coefficients_choose_steps(r->empty, r->total, r->masked, f->encode->step);
        f->view[0].coefficients = r->empty;
    }
    return status;
}

relume_status coded_rows_find_steps(struct coded_rows *r)
{
    struct contents *f = r->f;
    static const struct team_work work = {begin_share, count_share, add_share};
    const relume_status status =
        team_share(r->team, "ranges", &work, r, &row_counts_bytes, &r->counts, f->p->log);
    for (int i = 0; !status && i < f->views; i++) {
        f->report[i] = report_of(r, i);
        if (f->coefficients[i])
            coefficients_choose_steps(f->coefficients[i], r->total, r->masked, f->encode->step);
    }
    r->settled = !status;
    return status ? status : set_header_view(r);
}

void coded_rows_settle(struct coded_rows *r)
{
    struct contents *f = r->f;
    const size_t planes = (size_t)relume_coder_info(f->coder)->planes;
    for (int i = 0; i < f->views; i++)
        for (size_t b = 0; b < (size_t)f->coefficients[i]->bands * planes; b++)
            r->total[b % planes] = range_join(r->total[b % planes], f->coefficients[i]->band[b]);
    for (int i = 0; i < f->views; i++)
        coefficients_choose_steps(f->coefficients[i], r->total, r->masked, f->encode->step);
    memset(r->there, true, (size_t)f->views * (size_t)r->most);
    r->settled = true;
}
