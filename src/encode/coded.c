// coded.c - planes with loss: one quantiser for all views, which all parts of the work find
// together
//
// Ranges of planes, bytes beside the planes' own, and every step that is tried are pieces of a team
// (team.h). Coefficients are made where a piece needs them, so that who finds its pieces made only
// writes. Alone one is a team of one.
#include "encode/coded.h"

#include "base/log.h"
#include "base/memory.h"
#include "encode/groups.h"
#include "encode/pyramid.h"
#include "encode/rate.h"
#include "team/gather.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

struct coding {
    struct material *m;
    struct view_groups groups;
    const struct relume_team *team;  // or NULL
    int members;                     // of the team
    struct range *total;             // [planes]
    bool masked, settled;            // steps are known
    double rest;                     // bytes
    struct av1_effort effort;        // of the levels
    double level_bytes;
    int *levels_by;  // [views]: the quantiser that coded them, or 0
    bool leveled;
    relume_coefficients *empty;  // for the header
};

// The half of a step moves what the next camera of a slab sees by so many pixels; without one it is
// this part of the inverse of the usual depth. Twice as much where planes are coarse.
static const double MOST_PARALLAX = 0.25, OF_USUAL = 1.0 / 128.0, COARSE_DB = 36.0, FINE_DB = 40.0;

static double coarser(double psnr_db)
{
    return psnr_db > 0.0 ? fmin(fmax(exp2((FINE_DB - psnr_db) / (FINE_DB - COARSE_DB)), 1.0), 2.0)
                         : 1.0;
}

// How far apart the cameras of a slab stand; 0: there is one.
static double between_cameras(const struct relume_manifest *m, int slab)
{
    double extent = 0.0;
    int views = 0;
    for (int v = 0, first = 0; v < m->views; v++) {
        if (m->view[v].slab != slab)
            continue;
        first = views++ ? first : v;
        for (int i = 0; i < 2; i++)
            extent = fmax(extent, fabs(m->view[v].uv[i] - m->view[first].uv[i]));
    }
    return extent / fmax(sqrt(views) - 1.0, 1.0);
}

// The mean inverse of a depth map, of what is finite; 0 where nothing is.
static double usual_inverse(const struct relume_image *depth)
{
    const size_t n = (size_t)depth->width * (size_t)depth->height;
    double sum = 0.0, count = 0.0;
    for (size_t i = 0; i < n; i++)
        if (isfinite(depth->data[i])) {
            sum += 1.0 / (double)depth->data[i];
            count++;
        }
    return count > 0.0 ? sum / count : 0.0;
}

// The step of inverse depth; 0: depth is written as it is.
static double depth_step(const struct relume_manifest *m, const struct relume_image *depth,
                         int slab)
{
    const struct relume_geometry *g = m->slabs ? &m->slab[slab] : &m->geometry;
    const double between = g->projection == RELUME_SLAB ? between_cameras(m, slab) : 0.0;
    if (!(between > 0.0))
        return 2.0 * OF_USUAL * usual_inverse(depth);
    const double pixel = fmin((g->st_max[0] - g->st_min[0]) / depth->width,
                              (g->st_max[1] - g->st_min[1]) / depth->height);
    return 2.0 * MOST_PARALLAX * pixel / (between * fabs(g->uv_z - g->st_z));
}

// ---------------------------------------------------------------- coefficients

static relume_status load_view(void *user, int view)
{
    struct coding *c = user;
    struct material *m = c->m;
    if (m->coefficients[view])
        return RELUME_OK;
    const relume_status status = material_encode(m, view);
    if (!status && c->settled)
        coefficients_choose_steps(m->coefficients[view], c->total, c->masked, m->encode->step);
    return status;
}

// Calls `body` for the views of the groups of a member.
static relume_status each_view(struct coding *c, int member, int members,
                               relume_status (*body)(void *user, int view))
{
    const int *begin = c->groups.begin;
    relume_status status = RELUME_OK;
    for (int i = begin[groups_first(&c->groups, member, members)];
         !status && i < begin[groups_first(&c->groups, member + 1, members)]; i++)
        status = body(c, c->groups.view[i]);
    return status;
}

// Of this part.
static relume_status each_own_view(struct coding *c, relume_status (*body)(void *user, int view))
{
    const struct relume_pack_encode_params *p = c->m->p;
    return each_view(c, p->parts ? p->part - 1 : 0, p->parts ? p->parts : 1, body);
}

// The ranges of all planes, and of each view what its report says, as doubles.
enum { REPORT = 11 };

static void put_report(double *to, const struct relume_encode_report *r)
{
    const struct relume_encode_census *s = &r->census;
    const double numbers[REPORT] = {r->fit_rms,
                                    r->store_rms,
                                    r->steps_rms,
                                    r->psnr_db,
                                    r->typical,
                                    (double)s->pixels,
                                    (double)s->black,
                                    (double)s->clipped,
                                    (double)s->always_clipped,
                                    (double)s->repaired,
                                    (double)s->black_images};
    memcpy(to, numbers, sizeof numbers);
}

static bool take_report(struct relume_encode_report *r, const double *from)
{
    for (int i = 0; i < REPORT; i++)
        if (!(from[i] >= (i < 5 ? -DBL_MAX : 0.0) && from[i] < (i < 5 ? DBL_MAX : 0x1p53)))
            return false;
    if (!(from[10] < 0x1p31))
        return false;
    *r = (struct relume_encode_report){.fit_rms = from[0],
                                       .store_rms = from[1],
                                       .steps_rms = from[2],
                                       .psnr_db = from[3],
                                       .typical = from[4],
                                       .census = {.pixels = (size_t)from[5],
                                                  .black = (size_t)from[6],
                                                  .clipped = (size_t)from[7],
                                                  .always_clipped = (size_t)from[8],
                                                  .repaired = (size_t)from[9],
                                                  .black_images = (int)from[10]}};
    return true;
}

// How many views a member has, and the bytes of its ranges and reports.
static size_t size_of_ranges(const struct coding *c, int member, size_t *ranges)
{
    const int *begin = c->groups.begin;
    const size_t views = (size_t)(begin[groups_first(&c->groups, member + 1, c->members)] -
                                  begin[groups_first(&c->groups, member, c->members)]);
    *ranges = (size_t)relume_coder_info(c->m->coder)->planes * sizeof *c->total;
    return *ranges + views * REPORT * sizeof(double);
}

static relume_status make_ranges(void *context, int member, struct relume_buffer *out)
{
    struct coding *c = context;
    const size_t planes = (size_t)relume_coder_info(c->m->coder)->planes;
    size_t ranges;
    const size_t size = size_of_ranges(c, member, &ranges);
    relume_status status = each_view(c, member, c->members, load_view);
    if (status)
        return status;
    if (!(out->data = mem_zeroed(size, 1)))
        return RELUME_ENOMEM;
    out->size = size;
    struct range *total = mem_array(planes, sizeof *total);
    if (!total)
        return RELUME_ENOMEM;
    for (size_t p = 0; p < planes; p++)
        total[p] = (struct range){FLT_MAX, -FLT_MAX};
    unsigned char *to = out->data + ranges;
    for (int i = c->groups.begin[groups_first(&c->groups, member, c->members)];
         i < c->groups.begin[groups_first(&c->groups, member + 1, c->members)]; i++) {
        const relume_coefficients *one = c->m->coefficients[c->groups.view[i]];
        double report[REPORT];
        for (size_t b = 0; b < (size_t)one->bands * planes; b++)
            total[b % planes] = range_join(total[b % planes], one->band[b]);
        put_report(report, &c->m->report[c->groups.view[i]]);
        memcpy(to, report, sizeof report);
        to += sizeof report;
    }
    memcpy(out->data, total, ranges);
    mem_free(total);
    return RELUME_OK;
}

static relume_status take_ranges(void *context, int member, const struct relume_buffer *piece)
{
    struct coding *c = context;
    size_t ranges;
    if (piece->size != size_of_ranges(c, member, &ranges))
        return RELUME_EDAMAGED;
    for (size_t p = 0; p * sizeof *c->total < ranges; p++) {
        struct range r;
        memcpy(&r, piece->data + p * sizeof r, sizeof r);
        if (!(r.min >= -FLT_MAX && r.max <= FLT_MAX))
            return RELUME_EDAMAGED;
        c->total[p] = range_join(c->total[p], r);
    }
    const unsigned char *from = piece->data + ranges;
    for (int i = c->groups.begin[groups_first(&c->groups, member, c->members)];
         i < c->groups.begin[groups_first(&c->groups, member + 1, c->members)]; i++) {
        double report[REPORT];
        memcpy(report, from, sizeof report);
        from += sizeof report;
        if (!take_report(&c->m->report[c->groups.view[i]], report))
            return RELUME_EDAMAGED;
    }
    return RELUME_OK;
}

static relume_status find_steps(struct coding *c)
{
    struct material *m = c->m;
    const struct relume_manifest *manifest = relume_capture_manifest(m->capture);
    const size_t planes = (size_t)relume_coder_info(m->coder)->planes;
    c->masked = manifest->geometry.disc > 0;
    for (int i = 0; i < m->views; i++)
        c->masked |= manifest->view[i].mask != NULL;
    if (!(c->total = mem_array(planes, sizeof *c->total)))
        return RELUME_ENOMEM;
    for (size_t p = 0; p < planes; p++)
        c->total[p] = (struct range){FLT_MAX, -FLT_MAX};
    const relume_status status =
        team_gather(c->team, "ranges", make_ranges, take_ranges, c, m->p->log);
    for (int i = 0; !status && i < m->views; i++)
        if (m->coefficients[i])
            coefficients_choose_steps(m->coefficients[i], c->total, c->masked, m->encode->step);
    c->settled = !status;
    return status;
}

// ---------------------------------------------------------------- what is not planes

static relume_status load_extras(void *user, int view)
{
    const struct coding *c = user;
    struct material *m = c->m;
    const struct relume_manifest *manifest = relume_capture_manifest(m->capture);
    if (m->view[view].depth || m->view[view].mask)
        return RELUME_OK;
    const relume_status status = material_extras(m, view);
    if (!status && m->depth[view].data)
        m->view[view].depth_step =
            (float)(coarser(m->p->psnr_db) *
                    depth_step(manifest, &m->depth[view], manifest->view[view].slab));
    return status;
}

static relume_status load_levels(void *user, int view)
{
    struct coding *c = user;
    if (c->m->view[view].levels)
        return RELUME_OK;
    const relume_status status = load_view(c, view);
    return status ? status : material_reduce(c->m, view);
}

// Which view each is predicted from.
static void set_anchors(struct material *m, const struct view_groups *groups)
{
    for (int g = 0; g < groups->count; g++)
        for (int i = groups->begin[g]; i < groups->begin[g + 1]; i++) {
            struct relume_pack_view *view = &m->view[groups->view[i]];
            view->predicted = i > groups->begin[g];
            view->anchor = groups->view[groups->begin[g]];
        }
}

// ---------------------------------------------------------------- with loss

// Words and the heads of their rows, against the words.
static const double PACKED = 1.003;

// The bytes of a file of group `g` but for its words; `plain`: of its anchor, without depth and
// mask.
static relume_status weigh(double *bytes, const struct coding *c, int g, bool plain, bool preview)
{
    static const uint32_t nothing[1];
    struct relume_buffer file = {0};
    const struct relume_writer writer = relume_buffer_writer(&file);
    struct relume_pack_encode_params to_memory = *c->m->p;
    struct relume_pack_contents contents;
    struct relume_pack_view *view = mem_array((size_t)c->m->views, sizeof *view);
    if (!view)
        return RELUME_ENOMEM;
    for (int i = 0; i < c->m->views; i++) {
        view[i] = c->m->view[i];
        view[i].levels = NULL;
    }
    for (int i = c->groups.begin[g]; i < c->groups.begin[g + 1]; i++) {
        struct relume_pack_view *v = &view[c->groups.view[i]];
        v->levels = plain ? NULL : c->m->view[c->groups.view[i]].levels;
        v->depth = plain ? NULL : v->depth;
        v->mask = plain ? NULL : v->mask;
        if (!plain || !v->predicted) {
            v->coded = nothing;
            v->coded_words = 1;
        }
    }
    material_contents(&contents, c->m);
    contents.view = view;
    contents.preview = preview ? relume_pack_preview : NULL;
    to_memory.writer = &writer;
    const relume_status status = material_write(&contents, NULL, &to_memory);
    *bytes = (double)file.size;
    relume_buffer_destroy(&file);
    mem_free(view);
    return status;
}

static bool holds(const struct coding *c, int member, int members, int view)
{
    const int *begin = c->groups.begin;
    for (int i = begin[groups_first(&c->groups, member, members)];
         i < begin[groups_first(&c->groups, member + 1, members)]; i++)
        if (c->groups.view[i] == view)
            return true;
    return false;
}

static relume_status put_number(struct relume_buffer *out, double number)
{
    const struct relume_writer writer = relume_buffer_writer(out);
    return writer.write(writer.user, &number, sizeof number, 0) ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status take_number(double *sum, const struct relume_buffer *piece)
{
    double number;
    if (piece->size != sizeof number)
        return RELUME_EDAMAGED;
    memcpy(&number, piece->data, sizeof number);
    if (!(fabs(number) < 0x1p53))
        return RELUME_EDAMAGED;
    *sum += number;
    return RELUME_OK;
}

static relume_status make_rest(void *context, int member, struct relume_buffer *out)
{
    struct coding *c = context;
    const int middle = c->m->views / 2;
    double header = 0.0, one = 0.0, bytes;
    relume_status status = weigh(&header, c, 0, true, false);
    bytes = member ? 0.0 : header;
    if (!status)
        status = each_view(c, member, c->members, load_extras);
    if (!status && c->leveled)
        status = each_view(c, member, c->members, load_levels);
    for (int g = groups_first(&c->groups, member, c->members);
         !status && g < groups_first(&c->groups, member + 1, c->members); g++) {
        status = weigh(&one, c, g, false, false);
        bytes += one - header;
    }
    if (!status && holds(c, member, c->members, middle)) {
        status = load_view(c, middle);
        if (!status)
            status = weigh(&one, c, 0, true, true);
        bytes += one - header;
    }
    return status ? status : put_number(out, bytes);
}

static relume_status take_rest(void *context, int member, const struct relume_buffer *piece)
{
    struct coding *c = context;
    (void)member;
    return take_number(&c->rest, piece);
}

// What the levels of a view are expected to take, beside its own bytes.
static const double OF_LEVELS = 0.12;

// All but the first, which is most of them and which a reader makes of the view.
static relume_status code_levels(void *user, int view)
{
    struct coding *c = user;
    struct relume_pack_levels *l = &c->m->levels[view];
    relume_status status = load_levels(c, view);
    for (int k = 1; !status && k < l->levels; k++) {
        struct lossy_words words = {l->coded[k], l->coded_words[k]};
        if (c->levels_by[view] != c->effort.quantiser) {
            mem_free(l->coded[k]);
            status =
                lossy_encode(&words, &l->level[k], 1, &c->effort, c->m->p->threads, c->m->p->log);
            l->coded[k] = words.word;
            l->coded_words[k] = words.count;
        }
        c->level_bytes += 4.0 * (double)words.count;
    }
    c->levels_by[view] = c->effort.quantiser;
    return status;
}

static relume_status make_levels(void *context, int member, struct relume_buffer *out)
{
    struct coding *c = context;
    c->level_bytes = 0.0;
    const relume_status status = each_view(c, member, c->members, code_levels);
    return status ? status : put_number(out, c->level_bytes);
}

static relume_status take_levels(void *context, int member, const struct relume_buffer *piece)
{
    struct coding *c = context;
    c->level_bytes = member ? c->level_bytes : 0.0;
    return take_number(&c->level_bytes, piece);
}

// By the effort of the views; where that takes more bytes than are left, more coarsely.
static relume_status find_levels(struct coding *c, double left)
{
    enum { COARSER = 4 * AV1_STEPS };
    char what[32];
    snprintf(what, sizeof what, "levels.%d", c->effort.quantiser);
    const relume_status status =
        team_gather(c->team, what, make_levels, take_levels, c, c->m->p->log);
    if (status || c->level_bytes <= left || c->effort.quantiser + COARSER > AV1_COARSEST)
        return status ? status : each_own_view(c, code_levels);
    c->effort.quantiser += COARSER;
    return find_levels(c, left);
}

// ---------------------------------------------------------------- all of it

// A header says what the planes are like, and looks at the first view for that.
static relume_status place_header(struct coding *c)
{
    struct material *m = c->m;
    relume_status status = RELUME_OK;
    if (!m->coefficients[0]) {
        status = coefficients_create(&c->empty, m->coder, relume_capture_width(m->capture),
                                     relume_capture_height(m->capture), m->encode);
        if (!status)
            coefficients_choose_steps(c->empty, c->total, c->masked, m->encode->step);
        m->view[0].coefficients = c->empty;
    }
    return status;
}

static relume_status find_words(struct coding *c, struct relume_encode_report *report)
{
    struct material *m = c->m;
    const struct relume_pack_encode_params *p = m->p;
    const int width = relume_capture_width(m->capture), height = relume_capture_height(m->capture);
    const double pixels = (double)m->views * width * height;
    const bool quality = p->psnr_db > 0.0;
    const struct rate_team by = {c->team, load_view, c};
    struct rate_result result;
    relume_status status =
        quality ? RELUME_OK : team_gather(c->team, "rest", make_rest, take_rest, c, p->log);
    const double allowed = fmax((p->bytes_per_pixel * pixels - c->rest) / PACKED, 1.0);
    const struct rate_target target = {p->psnr_db,
                                       allowed / (1.0 + (c->leveled ? OF_LEVELS : 0.0))};
    if (!status)
        status = rate_encode(m->words, &result, m->coefficients, m->coder, &c->groups, m->capture,
                             &target, m->encode, c->team ? &by : NULL);
    if (status)
        return status;
    double words = 0.0;
    for (int i = 0; i < m->views; i++)
        words += 4.0 * (double)m->words[i].count;
    c->effort = result.effort;
    *report = encode_report_mean(m->report, m->views);
    const double all = pow(10.0, -result.psnr_db / 20.0), fit = report->fit_rms;
    report->psnr_db = result.psnr_db;
    report->store_rms = report->steps_rms = sqrt(fmax(all * all - fit * fit, 0.0));
    return c->leveled ? find_levels(c, quality ? (double)INFINITY : allowed - words) : RELUME_OK;
}

static relume_status take_words(void *user, int view)
{
    const struct coding *c = user;
    c->m->view[view].coded = c->m->words[view].word;
    c->m->view[view].coded_words = c->m->words[view].count;
    return RELUME_OK;
}

static bool share_is_empty(const struct coding *c, int part)
{
    const struct relume_pack_encode_params *p = c->m->p;
    return p->parts && !(c->team && c->team->close) &&
           groups_first(&c->groups, part, p->parts) == groups_first(&c->groups, part + 1, p->parts);
}

static relume_status write_own(struct coding *c, const char *path,
                               const struct relume_encode_report *report)
{
    const struct relume_pack_encode_params *p = c->m->p;
    const int middle = c->m->views / 2, own = p->parts ? p->part - 1 : 0;
    struct relume_pack_contents contents;
    struct relume_pack_share share;
    char digest[RELUME_DIGEST];
    relume_status status = each_own_view(c, take_words);
    material_contents(&contents, c->m);
    contents.report = *report;
    if (!holds(c, own, p->parts ? p->parts : 1, middle))
        contents.preview = NULL;
    else
        status = load_view(c, middle);
    if (!status && p->parts) {
        status = material_share(&share, digest, c->m);
        share.coded = true;
        share.group = groups_first(&c->groups, own, p->parts);
        share.measured = report;
        contents.share = &share;
    }
    if (!status && share_is_empty(c, own))
        log_line(p->log, RELUME_NOTE,
                 "part %d of %d holds no views: planes with loss are coded in %d group%s of "
                 "neighbours here; expected no more than %d part%s",
                 p->part, p->parts, c->groups.count, relume_plural(c->groups.count),
                 c->groups.count, relume_plural(c->groups.count));
    return status ? status : material_write(&contents, path, p);
}

relume_status encode_coded(struct material *m, const char *path,
                           struct relume_encode_report *report)
{
    const struct relume_manifest *manifest = relume_capture_manifest(m->capture);
    struct coding c = {.m = m, .team = m->p->team};
    struct relume_pack_contents contents;
    material_contents(&contents, m);
    c.members = c.team ? c.team->members : 1;
    c.leveled = pyramid_is_wanted(m->p->pyramid, relume_capture_width(m->capture),
                                  relume_capture_height(m->capture)) &&
                (m->p->pyramid || pyramid_is_possible(&contents));
    c.levels_by = mem_zeroed((size_t)m->views, sizeof *c.levels_by);
    relume_status status = c.levels_by ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = groups_make(&c.groups, manifest, lossy_most_views(m->coder));
    if (!status) {
        set_anchors(m, &c.groups);
        status = find_steps(&c);
    }
    if (!status)
        status = place_header(&c);
    if (!status)
        status = each_own_view(&c, load_extras);
    if (!status && c.leveled)
        status = each_own_view(&c, load_levels);
    if (!status)
        status = find_words(&c, report);
    if (!status && !m->p->learn_only)
        status = write_own(&c, path, report);
    relume_coefficients_destroy(&c.empty);
    groups_destroy(&c.groups);
    mem_free(c.total);
    mem_free(c.levels_by);
    return status;
}
