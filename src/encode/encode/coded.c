// coded.c - planes with loss: one quantiser for all views, which all parts of the work find
// together
//
// Ranges of planes, bytes beside the planes' own, and every step that is tried are pieces of a team
// (team.h), whose members have tiles of groups each (groups.h). Coefficients are made where a piece
// needs them, so that who finds its pieces made only writes. Alone one is a team of one.
#include "encode/encode/coded.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "encode/encode/coded_rows.h"
#include "encode/encode/pyramid.h"
#include "encode/encode/rate.h"
#include "format/team/gather.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct coding {
    struct material *m;
    struct view_groups groups;
    struct coded_rows rows;
    const struct relume_team *team;  // or NULL
    int members;                     // of the team
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

// ---------------------------------------------------------------- shares

static bool has_first_tile(const struct coding *c, int group, int member, int members)
{
    const struct group_share share = groups_share(&c->groups, member, members);
    const int tile = c->groups.tile[group];
    return share.first <= tile && tile < share.end;
}

// Calls `body` for the views whose first tile is a member's: what they have beside tiles is made by
// that one.
static relume_status each_view(struct coding *c, int member, int members,
                               relume_status (*body)(void *user, int view))
{
    const int *begin = c->groups.begin;
    relume_status status = RELUME_OK;
    for (int g = 0; !status && g < c->groups.count; g++)
        for (int i = begin[g]; !status && i < begin[g + 1]; i++)
            if (has_first_tile(c, g, member, members))
                status = body(c, c->groups.view[i]);
    return status;
}

static int own_of(const struct coding *c, int *members)
{
    const struct relume_pack_encode_params *p = c->m->p;
    *members = p->parts ? p->parts : 1;
    return p->parts ? p->part - 1 : 0;
}

// Of this part.
static relume_status each_own_view(struct coding *c, relume_status (*body)(void *user, int view))
{
    int members;
    const int own = own_of(c, &members);
    return each_view(c, own, members, body);
}

static relume_status load_view(void *user, int view)
{
    struct coding *c = user;
    return coded_rows_load_view(&c->rows, view);
}

static relume_status load_tiles(void *user, int group, struct group_share tiles)
{
    struct coding *c = user;
    return coded_rows_load(&c->rows, group, tiles);
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
    relume_status status = load_view(c, view);
    if (!status)
        status = load_extras(c, view);
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

// What is weighed beside the header and a word for each view of a group: the heads of all groups,
// nothing, depth, mask and levels of its views, the preview, or what shadows and highlights of all
// views move by.
enum weighed { HEADS, BARE, EXTRAS, PREVIEW, MODELS };

// The bytes of a file of group `g` but for its words.
static relume_status weigh(double *bytes, const struct coding *c, int g, enum weighed what)
{
    static const uint32_t nothing[1];
    struct relume_buffer file = {0};
    const struct relume_writer writer = relume_buffer_writer(&file);
    struct relume_pack_encode_params to_memory = *c->m->p;
    struct relume_pack_contents contents;
    struct relume_pack_view *view = mem_array((size_t)c->m->views, sizeof *view);
    const bool plain = what != EXTRAS;
    if (!view)
        return RELUME_ENOMEM;
    for (int i = 0; i < c->m->views; i++) {
        view[i] = c->m->view[i];
        view[i].levels = NULL;
        view[i].shadow = what == MODELS ? view[i].shadow : NULL;
        view[i].gloss = what == MODELS ? view[i].gloss : NULL;
    }
    const int end = what == HEADS ? c->groups.count : g + 1;
    for (int i = c->groups.begin[g]; i < c->groups.begin[end]; i++) {
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
    contents.preview = what == PREVIEW ? relume_pack_preview : NULL;
    to_memory.writer = &writer;
    const relume_status status = material_write(&contents, NULL, &to_memory);
    *bytes = (double)file.size;
    relume_buffer_destroy(&file);
    mem_free(view);
    return status;
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

// Of what moves with the light, which all views are asked for once.
static bool has_models(const struct material *m)
{
    for (int i = 0; i < m->views; i++)
        if (m->view[i].shadow || m->view[i].gloss)
            return true;
    return false;
}

static relume_status make_rest(void *context, int member, struct relume_buffer *out)
{
    struct coding *c = context;
    const int middle = c->m->views / 2;
    double header = 0.0, one = 0.0, bytes = 0.0;
    relume_status status = member ? RELUME_OK : weigh(&bytes, c, 0, HEADS);
    if (!status)
        status = weigh(&header, c, 0, BARE);
    if (!status)
        status = each_view(c, member, c->members, load_extras);
    if (!status && c->leveled)
        status = each_view(c, member, c->members, load_levels);
    for (int g = 0; !status && g < c->groups.count; g++)
        if (has_first_tile(c, g, member, c->members)) {
            status = weigh(&one, c, g, EXTRAS);
            bytes += one - header;
        }
    if (!status && has_first_tile(c, groups_with(&c->groups, middle), member, c->members)) {
        status = load_view(c, middle);
        if (!status)
            status = weigh(&one, c, 0, PREVIEW);
        bytes += one - header;
    }
    if (!status && !member && has_models(c->m)) {
        status = weigh(&one, c, 0, MODELS);
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
            coefficients_choose_steps(c->empty, c->rows.total, c->rows.masked, m->encode->step);
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
    const struct rate_team by = {c->team, load_tiles, c};
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
    c->effort = result.effort;
    *report = encode_report_mean(m->report, m->views);
    const double all = pow(10.0, -result.psnr_db / 20.0), fit = report->fit_rms;
    report->psnr_db = result.psnr_db;
    report->store_rms = report->steps_rms = sqrt(fmax(all * all - fit * fit, 0.0));
    return c->leveled ? find_levels(c, quality ? (double)INFINITY : allowed - result.bytes)
                      : RELUME_OK;
}

// Of the tiles of a part, with all that belongs to the view beside them where the first is among
// them.
static relume_status take_words(struct coding *c, int view, struct group_share tiles)
{
    struct relume_pack_view *v = &c->m->view[view];
    struct lossy_words *own = &c->m->words[view];
    const struct lossy_words all = *own;
    relume_status status = RELUME_OK;
    if (c->m->p->parts) {
        *own = (struct lossy_words){0};
        status = lossy_keep_tiles(own, &all, tiles.first, tiles.end);
        mem_free(all.word);
    }
    v->coded = own->word;
    v->coded_words = own->count;
    if (tiles.first > 0) {
        v->depth = v->mask = NULL;
        v->levels = NULL;
    }
    return status;
}

static relume_status take_own(struct coding *c)
{
    int members;
    const int own = own_of(c, &members);
    const struct group_share share = groups_share(&c->groups, own, members);
    relume_status status = RELUME_OK;
    for (int g = 0; !status && g < c->groups.count; g++) {
        const struct group_share tiles = groups_tiles(&c->groups, g, share);
        for (int i = c->groups.begin[g]; !status && tiles.end && i < c->groups.begin[g + 1]; i++)
            status = take_words(c, c->groups.view[i], tiles);
    }
    return status;
}

// Where people count the parts themselves.
static void say_empty(const struct coding *c)
{
    const struct relume_pack_encode_params *p = c->m->p;
    const int tiles = c->groups.tile[c->groups.count];
    int members;
    const int own = own_of(c, &members);
    const struct group_share share = groups_share(&c->groups, own, members);
    if (share.first == share.end && !(c->team && c->team->close))
        log_line(p->log, RELUME_NOTE,
                 "part %d of %d holds nothing: planes with loss are coded in %d tile%s here; "
                 "expected no more than %d part%s",
                 p->part, p->parts, tiles, relume_plural(tiles), tiles, relume_plural(tiles));
}

static relume_status write_own(struct coding *c, const char *path,
                               const struct relume_encode_report *report)
{
    const struct relume_pack_encode_params *p = c->m->p;
    const int middle = c->m->views / 2;
    int members;
    const int own = own_of(c, &members);
    struct relume_pack_contents contents;
    struct relume_pack_share share;
    char digest[RELUME_DIGEST];
    relume_status status = take_own(c);
    material_contents(&contents, c->m);
    contents.report = *report;
    if (!has_first_tile(c, groups_with(&c->groups, middle), own, members))
        contents.preview = NULL;
    else if (!status)
        status = load_view(c, middle);
    if (!status && p->parts) {
        status = material_share(&share, digest, c->m);
        share.coded = true;
        share.group = groups_of_tile(&c->groups, groups_share(&c->groups, own, members).first);
        share.measured = report;
        contents.share = &share;
    }
    say_empty(c);
    return status ? status : material_write(&contents, path, p);
}

relume_status encode_coded(struct material *m, const char *path,
                           struct relume_encode_report *report)
{
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
        status = groups_make(&c.groups, m->capture, m->coder);
    if (!status)
        status = coded_rows_create(&c.rows, m, &c.groups, c.team);
    if (!status) {
        set_anchors(m, &c.groups);
        status = coded_rows_find_steps(&c.rows);
    }
    if (!status)
        status = place_header(&c);
    if (!status)
        status = each_own_view(&c, load_extras);
    if (!status)
        status = find_words(&c, report);
    if (!status && !m->p->learn_only)
        status = write_own(&c, path, report);
    relume_coefficients_destroy(&c.empty);
    coded_rows_destroy(&c.rows);
    groups_destroy(&c.groups);
    mem_free(c.levels_by);
    return status;
}
