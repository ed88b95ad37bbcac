// coded.c - planes with loss: one quantiser for all views
//
// encode_coded is the whole of it, from the top down: views become groups (groups.c), all planes
// get steps (coded_rows.c), views get what they have beside planes (coding_extras.c), a quantiser
// is found that meets the quality or the bytes (rate.c), levels follow (coding_levels.c), and the
// file is written (coding_file.c). Coefficients are made where they are needed first.
//
// Where several machines do it together, each of these steps is shared (share.h): ranges, the bytes
// beside the planes, each quantiser that is tried, levels. Each machine then writes its own tiles.
#include "encode/encode/coded.h"

#include "core/base/memory.h"
#include "encode/encode/coding.h"
#include "encode/encode/rate.h"
#include "encode/levels/pyramid.h"
#include "format/pack/pack_write.h"

#include <math.h>

// Groups, the own tiles, and which view each is predicted from.
static relume_status make_groups(struct coding *c)
{
    const struct relume_pack_encode_params *p = c->f->p;
    struct view_groups *g = &c->groups;
    const relume_status status = groups_make(g, c->f->capture, c->f->coder);
    if (status)
        return status;
    c->own = groups_share(g, p->parts ? p->part - 1 : 0, p->parts ? p->parts : 1);
    for (int i = 0; i < g->count; i++)
        for (int k = g->begin[i]; k < g->begin[i + 1]; k++) {
            struct relume_pack_view *view = &c->f->view[g->view[k]];
            view->predicted = k > g->begin[i];
            view->anchor = g->view[g->begin[i]];
        }
    return RELUME_OK;
}

// What the levels of a view are expected to take, beside its own bytes.
static const double OF_LEVELS = 0.12;

// Words and the heads of their rows, against the words.
static const double PACKED = 1.003;

// Finds the bytes left for words when a file size is requested.
static relume_status find_allowed(double *allowed, struct coding *c)
{
    const struct contents *f = c->f;
    const double pixels =
        (double)f->views * relume_capture_width(f->capture) * relume_capture_height(f->capture);
    *allowed = 0.0;
    if (f->p->bytes_per_pixel == 0.0)
        return RELUME_OK;
    const relume_status status = coding_count_rest(&c->rest, c);
    *allowed = fmax((f->p->bytes_per_pixel * pixels - c->rest) / PACKED, 1.0);
    return status;
}

static relume_status load_tiles(void *user, int group, struct group_share tiles)
{
    struct coding *c = user;
    return coded_rows_load(&c->rows, group, tiles);
}

static relume_status find_words(struct coding *c, struct relume_fidelity *report)
{
    struct contents *f = c->f;
    const struct rate_team by = {c->team, load_tiles, c};
    struct rate_result result;
    double allowed = 0.0;
    relume_status status = find_allowed(&allowed, c);
    *report = fidelity_mean(f->report, f->views);
    const double fit = report->fit_rms;
    const struct rate_target target = {.psnr_db = f->p->psnr_db,
                                       .least_db = f->p->least_db,
                                       .bytes = allowed / (1.0 + (c->leveled ? OF_LEVELS : 0.0)),
                                       .effort = f->p->effort,
                                       .fit = fit * fit};
    if (!status)
        status = rate_encode(f->words, &result, f->coefficients, f->coder, &c->groups, f->capture,
                             &target, f->encode, c->team ? &by : NULL);
    if (status)
        return status;
    c->effort = result.effort;
    const double all = pow(10.0, -result.psnr_db / 20.0);
    report->psnr_db = result.psnr_db;
    report->store_rms = report->steps_rms = sqrt(fmax(all * all - fit * fit, 0.0));
    const double left = allowed > 0.0 ? allowed - result.bytes : (double)INFINITY;
    return c->leveled ? coding_find_levels(c, left) : RELUME_OK;
}

static bool has_levels(const struct contents *f)
{
    struct relume_pack_contents contents;
    contents_describe(&contents, f);
    return pyramid_is_wanted(f->p->pyramid, relume_capture_width(f->capture),
                             relume_capture_height(f->capture)) &&
           (f->p->pyramid || pyramid_is_possible(&contents));
}

relume_status encode_coded(struct contents *f, const char *path, struct relume_fidelity *report)
{
    struct coding c = {.f = f, .team = f->p->team, .leveled = has_levels(f)};
    c.levels_by = mem_zeroed((size_t)f->views, sizeof *c.levels_by);
    relume_status status = c.levels_by ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = make_groups(&c);
    if (!status)
        status = coded_rows_create(&c.rows, f, &c.groups, c.team);
    if (!status)
        status = coded_rows_find_steps(&c.rows);
    if (!status)
        status = coding_each_view(&c, c.own, coding_load_extras);
    if (!status)
        status = find_words(&c, report);
    if (!status && !f->p->learn_only)
        status = coding_write(&c, path, report);
    coded_rows_destroy(&c.rows);
    groups_destroy(&c.groups);
    mem_free(c.levels_by);
    return status;
}
