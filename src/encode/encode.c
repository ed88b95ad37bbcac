// encode.c - from a capture to a file in one call
#include <relume/pack.h>

#include "base/log.h"
#include "base/memory.h"
#include "base/params.h"
#include "codebook/books.h"
#include "coder/coefficients.h"
#include "encode/pyramid.h"
#include "encode/rate.h"

#include <relume/team.h>
#include <math.h>
#include <string.h>

struct material {
    struct relume_pack_view *view;
    struct relume_pack_levels *levels;  // [views]
    relume_coefficients **coefficients;
    struct relume_image *depth, *mask;    // [views]
    relume_books **books;                 // [views], or the first for all
    uint16_t **index;                     // [views][RELUME_MOST_BOOKS]
    struct lossy_words *words;            // [views]
    struct relume_encode_report *report;  // [views]
    int views;
    int first, end;  // those that are encoded
    int row, rows;   // of one view alone; 0 rows: all
};

static void destroy(struct material *m)
{
    for (int i = 0; i < m->views; i++) {
        if (m->levels)
            relume_pack_levels_destroy(&m->levels[i]);
        if (m->coefficients)
            relume_coefficients_destroy(&m->coefficients[i]);
        if (m->depth)
            relume_image_destroy(&m->depth[i]);
        if (m->mask)
            relume_image_destroy(&m->mask[i]);
        if (m->books)
            relume_books_destroy(&m->books[i]);
        if (m->words)
            mem_free(m->words[i].word);
        for (int b = 0; m->index && b < RELUME_MOST_BOOKS; b++)
            mem_free(m->index[i * RELUME_MOST_BOOKS + b]);
    }
    mem_free(m->books);
    mem_free(m->words);
    mem_free(m->report);
    mem_free(m->index);
    mem_free(m->view);
    mem_free(m->levels);
    mem_free(m->coefficients);
    mem_free(m->depth);
    mem_free(m->mask);
}

// Where the views are is known of all of them.
static void place_views(struct material *m, const struct relume_manifest *manifest)
{
    for (int i = 0; i < m->views; i++) {
        m->view[i].uv[0] = manifest->view[i].uv[0];
        m->view[i].uv[1] = manifest->view[i].uv[1];
        m->view[i].slab = manifest->view[i].slab;
    }
}

static bool create(struct material *m, int views, const struct encode_share *share)
{
    const size_t n = (size_t)views;
    m->views = views;
    m->first = share->first;
    m->end = share->first + share->views;
    m->row = share->row;
    m->rows = share->rows;
    m->view = mem_zeroed(n, sizeof *m->view);
    m->levels = mem_zeroed(n, sizeof *m->levels);
    m->coefficients = mem_zeroed(n, sizeof *m->coefficients);
    m->depth = mem_zeroed(n, sizeof *m->depth);
    m->mask = mem_zeroed(n, sizeof *m->mask);
    m->books = mem_zeroed(n, sizeof *m->books);
    m->index = mem_zeroed(n * RELUME_MOST_BOOKS, sizeof *m->index);
    m->words = mem_zeroed(n, sizeof *m->words);
    m->report = mem_zeroed(n, sizeof *m->report);
    return m->report && m->words && m->view && m->levels && m->coefficients && m->depth &&
           m->mask && m->books && m->index;
}

static relume_status encode_view(struct material *m, int i, const relume_coder *coder,
                                 const relume_capture *capture, bool with_depth,
                                 const struct relume_encode_params *p)
{
    relume_status status =
        encode_some_rows(&m->coefficients[i], coder, capture, i, m->row, m->rows, p);
    if (!status)
        m->report[i] = relume_coefficients_report(m->coefficients[i]);
    if (!status && with_depth && m->row == 0)
        status = relume_capture_depth(&m->depth[i], capture, i, p->log);
    if (!status && m->row == 0)
        status = relume_capture_mask(&m->mask[i], capture, i, p->log);
    m->view[i].coefficients = m->coefficients[i];
    m->view[i].depth = m->depth[i].data ? &m->depth[i] : NULL;
    m->view[i].mask = m->mask[i].data ? &m->mask[i] : NULL;
    return status;
}

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

// Indices into the books of view `set`.
static relume_status assign_view(struct material *m, int i, int set,
                                 const struct relume_books_params *p)
{
    const struct relume_coefficients_info *info = relume_coefficients_info(m->coefficients[i]);
    uint16_t **index = m->index + i * RELUME_MOST_BOOKS;
    for (int b = 0; b < relume_books_info(m->books[set])->books; b++)
        if (!(index[b] = mem_array((size_t)info->width * (size_t)info->height, sizeof **index)))
            return RELUME_ENOMEM;
    const relume_status status =
        relume_books_assign(index, &m->report[i].store_rms, m->books[set], m->coefficients[i], p);
    m->view[i].books = m->books[set];
    m->view[i].index = (const uint16_t *const *)index;
    return status;
}

// A reader points masked pixels to one more vector, of nothing (read_mask.c), and indices have 16
// bits: one vector less is learnt.
static int most_codes(const struct relume_manifest *m)
{
    for (int i = 0; i < m->views; i++)
        if (m->view[i].mask)
            return 65535;
    return 65536;
}

struct shelf {
    const relume_books *books;
    uint16_t *const *index;
    size_t width;
};

static void shelf_row(const void *user, int row, float *planes, size_t stride)
{
    const struct shelf *s = user;
    books_row(planes, stride, s->books, s->index, s->width, (size_t)row);
}

// What relighting reproduces, which was measured before there were books.
static relume_status judge_books(const struct material *m, const relume_capture *capture,
                                 const struct relume_encode_params *p)
{
    relume_status status = RELUME_OK;
    for (int i = m->first; !status && i < m->end; i++) {
        struct encode_judgement judgement;
        const struct shelf shelf = {m->view[i].books, m->index + i * RELUME_MOST_BOOKS,
                                    (size_t)relume_capture_width(capture)};
        status = encode_judge(&judgement, m->coefficients[i], capture, i, false,
                              &(const struct encode_values){shelf_row, &shelf}, p);
        m->report[i].psnr_db = judgement.psnr_db;
    }
    return status;
}

// A view of another part, for what is learnt from it.
struct other_views {
    const relume_coder *coder;
    const relume_capture *capture;
    const struct relume_encode_params *encode;
};

static relume_status encode_other(void *user, int view, relume_coefficients **out)
{
    const struct other_views *o = user;
    return relume_encode(out, o->coder, o->capture, view, o->encode);
}

static relume_status make_books(struct material *m, const relume_capture *capture,
                                const relume_coder *coder,
                                const struct relume_pack_encode_params *p,
                                const struct relume_encode_params *encode)
{
    struct relume_books_params books = *p->books;
    struct other_views others = {coder, capture, encode};
    const struct books_team by = {p->team, encode_other, &others};
    relume_status status = RELUME_OK;
    if (books.codes == 65536)
        books.codes = most_codes(relume_capture_manifest(capture));
    books.threads = p->threads;
    books.team = p->share ? p->team : NULL;
    for (int i = m->first; !status && i < m->end; i++) {
        const int set = p->share ? 0 : i;
        if (set == i || i == m->first)
            status = books_train(&m->books[set],
                                 (const relume_coefficients *const *)m->coefficients + set,
                                 p->share ? m->views : 1, &books, books.team ? &by : NULL);
        if (!status)
            status = assign_view(m, i, set, &books);
    }
    return status;
}

// What all of a file has in common.
static struct relume_pack_contents contents_of(const struct material *m,
                                               const relume_capture *capture,
                                               const relume_coder *coder,
                                               const struct relume_pack_encode_params *p)
{
    const struct relume_manifest *manifest = relume_capture_manifest(capture);
    return (struct relume_pack_contents){
        .coder = coder,
        .domain = relume_encode_domain(capture, p->domain),
        .display = relume_encode_display(capture),
        .geometry = manifest->geometry,
        .slabs = manifest->slabs,
        .slab = manifest->slab,
        .views = manifest->views,
        .view = m->view,
        .preview = relume_pack_preview,
    };
}

static relume_status reduce_views(const struct material *m, const relume_capture *capture,
                                  const relume_coder *coder,
                                  const struct relume_pack_encode_params *p,
                                  const struct relume_encode_params *encode)
{
    const struct relume_pack_contents contents = contents_of(m, capture, coder, p);
    relume_status status = RELUME_OK;
    for (int i = m->first; !status && !m->rows && i < m->end; i++) {
        status = relume_pack_reduce(&m->levels[i], &contents, &m->view[i], p->pyramid, encode);
        m->view[i].levels = m->levels[i].levels ? &m->levels[i] : NULL;
    }
    return status;
}

// Rows of others stay black.
static relume_status show_rows(void *contents, int row, int rows, float *rgb)
{
    const struct relume_pack_contents *c = contents;
    const struct encode_rows *some = &c->view[c->views / 2].coefficients->some;
    return row < some->row || row >= some->row + some->rows
               ? RELUME_OK
               : relume_pack_preview(contents, row, rows, rgb);
}

static relume_status write_material(const struct material *m, const relume_capture *capture,
                                    const relume_coder *coder,
                                    const struct relume_encode_report *report, const char *path,
                                    const struct relume_pack_encode_params *p)
{
    struct relume_pack_contents contents = contents_of(m, capture, coder, p);
    contents.report = *report;
    contents.preview_user = &contents;
    char digest[RELUME_DIGEST];
    const struct relume_pack_share share = {
        .part = p->part,
        .parts = p->parts,
        .first = m->first,
        .views = m->end - m->first,
        .capture = digest,
        .options = p->options ? p->options : "",
        .free_storage = p->free_storage,
        .step = p->step,
        .pyramid = p->pyramid,
        .shared_books = p->books && p->share,
        .measured = m->report + m->first,
    };
    if (p->parts) {
        const relume_status status = relume_capture_digest(digest, capture, p->log);
        if (status)
            return status;
        contents.share = &share;
        contents.report = (struct relume_encode_report){0};
        const bool middle = m->first <= m->views / 2 && m->views / 2 < m->end;
        const bool waits = m->rows && !m->coefficients[m->first]->some.stored;
        contents.preview = !middle || waits ? NULL : m->rows ? show_rows : relume_pack_preview;
    }
    return relume_pack_write(&contents, path,
                             relume_pack_params(.log = p->log, .compression = p->compression,
                                                .threads = p->threads, .writer = p->writer));
}

// ---------------------------------------------------------------- with loss

// Words and the heads of their rows, against the words.
static const double PACKED = 1.003;

// The bytes of a file but for its words.
static relume_status weigh_rest(double *bytes, const struct material *m,
                                const relume_capture *capture, const relume_coder *coder,
                                const struct relume_pack_encode_params *p)
{
    static const uint32_t nothing[1];
    struct relume_buffer file = {0};
    const struct relume_writer writer = relume_buffer_writer(&file);
    struct relume_pack_encode_params to_memory = *p;
    to_memory.writer = &writer;
    for (int i = 0; i < m->views; i++) {
        m->view[i].coded = nothing;
        m->view[i].coded_words = 1;
    }
    const relume_status status = write_material(
        m, capture, coder, &(const struct relume_encode_report){0}, NULL, &to_memory);
    *bytes = (double)file.size;
    relume_buffer_destroy(&file);
    return status;
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

// What the levels of a view are expected to take, beside its own bytes.
static const double OF_LEVELS = 0.12;

// All but the first, which is most of them and which a reader makes of the view. By the effort of
// the views; where that takes more bytes than are left, more coarsely.
static relume_status code_levels(struct material *m, struct av1_effort effort, double left,
                                 const struct relume_encode_params *p)
{
    enum { COARSER = 4 * AV1_STEPS };
    relume_status status = RELUME_OK;
    double bytes = 0.0;
    for (int i = 0; !status && i < m->views; i++)
        for (int k = 1; !status && k < m->levels[i].levels; k++) {
            struct relume_pack_levels *l = &m->levels[i];
            struct lossy_words words;
            status = lossy_encode(&words, &l->level[k], 1, &effort, p->threads, p->log);
            mem_free(l->coded[k]);
            l->coded[k] = words.word;
            l->coded_words[k] = words.count;
            bytes += 4.0 * (double)words.count;
        }
    if (status || bytes <= left || effort.quantiser + COARSER > AV1_COARSEST)
        return status;
    effort.quantiser += COARSER;
    return code_levels(m, effort, left, p);
}

static relume_status code_planes(struct material *m, const relume_capture *capture,
                                 const relume_coder *coder,
                                 const struct relume_pack_encode_params *p,
                                 struct relume_encode_report *report,
                                 const struct relume_encode_params *encode)
{
    const double pixels =
        (double)m->views * relume_capture_width(capture) * relume_capture_height(capture);
    const struct relume_manifest *manifest = relume_capture_manifest(capture);
    struct rate_target target = {p->psnr_db, 0.0};
    struct rate_result result;
    double rest = 0.0;
    bool masked = false;
    struct view_groups groups = {0};
    for (int i = 0; i < m->views; i++) {
        masked |= m->mask[i].data != NULL;
        if (m->depth[i].data)
            m->view[i].depth_step =
                (float)(coarser(p->psnr_db) *
                        depth_step(manifest, &m->depth[i], manifest->view[i].slab));
    }
    relume_status status =
        coefficients_share_steps(m->coefficients, m->views, masked, encode->step);
    if (!status)
        status = groups_make(&groups, manifest, lossy_most_views(coder));
    if (!status)
        set_anchors(m, &groups);
    if (!status)
        status = reduce_views(m, capture, coder, p, encode);
    if (!status && !(p->psnr_db > 0.0))
        status = weigh_rest(&rest, m, capture, coder, p);
    const double allowed = fmax((p->bytes_per_pixel * pixels - rest) / PACKED, 1.0);
    target.bytes = allowed / (1.0 + (m->levels[0].levels ? OF_LEVELS : 0.0));
    if (!status)
        status = rate_encode(m->words, &result, m->coefficients, &groups, capture, &target, encode);
    double words = 0.0;
    for (int i = 0; !status && i < m->views; i++) {
        m->view[i].coded = m->words[i].word;
        m->view[i].coded_words = m->words[i].count;
        words += 4.0 * (double)m->words[i].count;
    }
    if (!status)
        status = code_levels(m, result.effort,
                             p->psnr_db > 0.0 ? (double)INFINITY : allowed - words, encode);
    groups_destroy(&groups);
    if (status)
        return status;
    const double all = pow(10.0, -result.psnr_db / 20.0), fit = report->fit_rms;
    report->psnr_db = result.psnr_db;
    report->store_rms = report->steps_rms = sqrt(fmax(all * all - fit * fit, 0.0));
    return RELUME_OK;
}

// Which views, or rows of one, this part encodes.
static relume_status find_share(struct encode_share *out, const relume_capture *capture,
                                const struct relume_pack_encode_params *p)
{
    const int views = relume_capture_manifest(capture)->views;
    const bool coded = p->psnr_db > 0.0 || p->bytes_per_pixel > 0.0;
    *out = (struct encode_share){.views = views};
    if (!p->parts)
        return RELUME_OK;
    if (p->part < 1 || p->part > p->parts || coded || (p->books && p->share && !p->team))
        return RELUME_EINVAL;
    const relume_status status = encode_share_find(out, p->part, p->parts, capture, p->log);
    if (status)
        return status;
    if (out->rows && p->books)
        return log_fail(p->log, RELUME_EUNFIT,
                        "a codebook is learnt from a whole view; expected at most %d part%s for %d "
                        "view%s",
                        views, relume_plural(views), views, relume_plural(views));
    return RELUME_OK;
}

// ---------------------------------------------------------------- rows whose view others have too

// Whether parts that run at the same time tell each other their ranges, so that each packs its own
// rows: in whole blocks, and of views that are no pyramid, whose levels need all rows.
static bool may_settle(const struct material *m, const relume_capture *capture,
                       const struct relume_pack_encode_params *p)
{
    const int width = relume_capture_width(capture), height = relume_capture_height(capture);
    struct encode_share share = {0};
    bool whole =
        m->rows && p->team && p->team->close && !pyramid_is_wanted(p->pyramid, width, height);
    for (int i = 1; whole && i <= p->parts; i++) {
        encode_share_of(&share, i, p->parts, m->views, height);
        whole = share.first != m->first || share.row % ENCODE_BLOCK == 0;
    }
    return whole;
}

// The bands of a part's rows.
static struct range *bands_of(relume_coefficients *c, const struct encode_share *share,
                              size_t *size)
{
    const size_t planes = (size_t)c->info.planes;
    const size_t bands = (size_t)(share->rows + BAND_ROWS - 1) / BAND_ROWS;
    *size = bands * planes * sizeof *c->band;
    return c->band + (size_t)(share->row / BAND_ROWS) * planes;
}

static relume_status own_ranges(void *context, int member, struct relume_buffer *out)
{
    struct material *m = context;
    const struct encode_share own = {.row = m->row, .rows = m->rows};
    const struct relume_writer writer = relume_buffer_writer(out);
    size_t size;
    const struct range *bands = bands_of(m->coefficients[m->first], &own, &size);
    (void)member;
    return writer.write(writer.user, bands, size, 0) ? RELUME_OK : RELUME_ENOMEM;
}

static void take_ranges(struct material *m, int height, int parts,
                        const struct relume_buffer *piece)
{
    struct encode_share share = {0};
    for (int i = 0; i < parts; i++) {
        size_t size;
        encode_share_of(&share, i + 1, parts, m->views, height);
        if (share.first != m->first)
            continue;
        struct range *to = bands_of(m->coefficients[m->first], &share, &size);
        memcpy(to, piece[i].data, size < piece[i].size ? size : piece[i].size);
    }
}

static relume_status settle_rows(struct material *m, const relume_capture *capture,
                                 const struct relume_pack_encode_params *p,
                                 const struct relume_encode_params *encode)
{
    struct relume_buffer *piece = mem_zeroed((size_t)p->parts, sizeof *piece);
    struct relume_image *mask = &m->mask[m->first];
    relume_status status =
        piece ? p->team->share(p->team->user, "ranges", own_ranges, m, piece) : RELUME_ENOMEM;
    if (!status)
        take_ranges(m, relume_capture_height(capture), p->parts, piece);
    for (int i = 0; piece && i < p->parts; i++)
        relume_buffer_destroy(&piece[i]);
    mem_free(piece);
    if (!status && m->row)
        status = relume_capture_mask(mask, capture, m->first, p->log);
    m->view[m->first].mask = mask->data ? mask : NULL;
    return status ? status
                  : encode_settle_rows(m->coefficients[m->first], mask,
                                       relume_encode_display(capture), encode);
}

// What is said of the work on all views, as that of a part.
struct part_log {
    struct relume_log log;
    const struct relume_log *to;
    double first, extent;
};

static void pass_message(void *user, enum relume_level level, const char *text)
{
    const struct part_log *p = user;
    if (p->to->message)
        p->to->message(p->to->user, level, text);
}

static bool pass_progress(void *user, const char *what, double done)
{
    const struct part_log *p = user;
    return log_progress(p->to, what, fmin(fmax((done - p->first) / p->extent, 0.0), 1.0));
}

// NULL for no log.
static const struct relume_log *log_part(struct part_log *p, const struct relume_log *to,
                                         const struct encode_share *share,
                                         const relume_capture *capture)
{
    const double views = relume_capture_manifest(capture)->views;
    const double rows = relume_capture_height(capture);
    if (!to)
        return NULL;
    *p = (struct part_log){.log = *to,
                           .to = to,
                           .first = (share->first + share->row / rows) / views,
                           .extent = (share->rows ? share->rows / rows : share->views) / views};
    p->log.message = pass_message;
    p->log.progress = pass_progress;
    p->log.user = p;
    return &p->log;
}

relume_status relume_pack_encode(const relume_capture *capture, const relume_coder *coder,
                                 const char *path, struct relume_encode_report *report,
                                 const struct relume_pack_encode_params *params)
{
    const struct relume_pack_encode_params p = PARAMS_WORK(relume_pack_encode_params, params);
    const bool coded = p.psnr_db > 0.0 || p.bytes_per_pixel > 0.0;
    struct relume_encode_params encode = {
        .log = p.log,
        .domain = relume_encode_domain(capture, p.domain),
        .storage = coded ? RELUME_STORE_12 : p.storage,
        .step = coded ? RELUME_STEP_COMMON : p.step,
        .threads = p.threads,
        .scratch = p.writer ? NULL : path,
    };
    if (!path && !p.writer)
        return RELUME_EINVAL;
    const struct relume_manifest *manifest = relume_capture_manifest(capture);
    struct material m = {0};
    struct encode_share share;
    struct part_log part;
    relume_status status = find_share(&share, capture, &p);
    if (!status && p.parts)
        encode.log = log_part(&part, p.log, &share, capture);
    if (!status && !create(&m, manifest->views, &share))
        status = RELUME_ENOMEM;
    if (!status)
        place_views(&m, manifest);
    for (int i = m.first; !status && i < m.end; i++)
        status = encode_view(&m, i, coder, capture, !p.no_depth, &encode);
    if (!status && may_settle(&m, capture, &p))
        status = settle_rows(&m, capture, &p, &encode);
    if (!status && !coded && p.books)
        status = make_books(&m, capture, coder, &p, &encode);
    if (!status && !coded && p.books && report)
        status = judge_books(&m, capture, &encode);
    struct relume_encode_report total = {0};
    if (!status)
        total = encode_report_mean(m.report + m.first, m.end - m.first);
    if (!status && !coded)
        status = reduce_views(&m, capture, coder, &p, &encode);
    if (!status && coded)
        status = code_planes(&m, capture, coder, &p, &total, &encode);
    if (!status && report)
        *report = total;
    if (!status)
        status = write_material(&m, capture, coder, &total, path, &p);
    destroy(&m);
    return status;
}
