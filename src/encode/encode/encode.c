// encode.c - from a capture to a file in one call
#include <relume/encode/pack_encode.h>

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "encode/encode/coded.h"
#include "encode/encode/contents.h"
#include "encode/levels/pyramid.h"
#include "format/codebook/books.h"
#include "format/codebook/drawing.h"
#include "format/coder/coding.h"
#include "format/pack/pack_write.h"
#include "format/team/array.h"

#include <math.h>
#include <string.h>

// Indices into the books of view `set`.
static relume_status assign_view(struct contents *f, int i, int set,
                                 const struct relume_books_params *p)
{
    const struct relume_coefficients_info *info = relume_coefficients_info(f->coefficients[i]);
    uint16_t **index = f->index + i * RELUME_MOST_BOOKS;
    for (int b = 0; b < relume_books_info(f->books[set])->books; b++)
        if (!(index[b] = mem_array((size_t)info->width * (size_t)info->height, sizeof **index)))
            return RELUME_ENOMEM;
    const relume_status status =
        relume_books_assign(index, &f->report[i].store_rms, f->books[set], f->coefficients[i], p);
    f->view[i].books = f->books[set];
    f->view[i].index = (const uint16_t *const *)index;
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
static relume_status judge_books(const struct contents *f)
{
    relume_status status = RELUME_OK;
    for (int i = f->first; !status && i < f->end; i++) {
        const struct shelf shelf = {f->view[i].books, f->index + i * RELUME_MOST_BOOKS,
                                    (size_t)relume_capture_width(f->capture)};
        status = encode_judge(&f->report[i].psnr_db, f->coefficients[i], f->capture, i,
                              &(const struct encode_values){shelf_row, &shelf, false}, f->encode);
    }
    return status;
}

// A view of another part, for what is learnt from it.
static relume_status encode_other(void *user, int view, relume_coefficients **out)
{
    const struct contents *f = user;
    return relume_project(out, f->coder, f->capture, view, f->encode);
}

static relume_status make_books(struct contents *f)
{
    const struct relume_pack_encode_params *p = f->p;
    struct relume_books_params books = *p->books;
    const struct books_team by = {p->team, encode_other, f};
    relume_status status = RELUME_OK;
    if (books.codes == 65536)
        books.codes = most_codes(relume_capture_manifest(f->capture));
    books.threads = p->threads;
    books.team = p->share ? p->team : NULL;
    for (int i = f->first; !status && i < f->end; i++) {
        const int set = p->share ? 0 : i;
        if (set == i || i == f->first)
            status = books_train(&f->books[set],
                                 (const relume_coefficients *const *)f->coefficients + set,
                                 p->share ? f->views : 1, &books, books.team ? &by : NULL);
        if (!status)
            status = assign_view(f, i, set, &books);
    }
    return status;
}

// Rows of others stay black.
static relume_status show_rows(void *contents, int row, int rows, float *rgb)
{
    const struct relume_pack_contents *c = contents;
    const struct project_rows *some = &c->view[c->views / 2].coefficients->some;
    return row < some->row || row >= some->row + some->rows
               ? RELUME_OK
               : relume_pack_preview(contents, row, rows, rgb);
}

static relume_status write_file(const struct contents *f, const struct relume_fidelity *report,
                                const char *path)
{
    struct relume_pack_contents contents;
    struct relume_pack_share share;
    char digest[RELUME_DIGEST];
    contents_describe(&contents, f);
    contents.report = *report;
    if (f->p->parts) {
        const relume_status status = contents_share(&share, digest, f);
        if (status)
            return status;
        contents.share = &share;
        contents.report = (struct relume_fidelity){0};
        const bool middle = f->first <= f->views / 2 && f->views / 2 < f->end;
        const bool waits = f->rows && !f->coefficients[f->first]->some.stored;
        contents.preview = !middle || waits ? NULL : f->rows ? show_rows : relume_pack_preview;
    }
    return contents_write(&contents, path, f->p);
}

// Which views, or rows of one, this part encodes. Of what is coded with loss the groups say it.
static relume_status find_share(struct encode_share *out, const relume_capture *capture,
                                const struct relume_pack_encode_params *p)
{
    const int views = relume_capture_manifest(capture)->views;
    *out = (struct encode_share){.views = views};
    if (p->parts && (p->part < 1 || p->part > p->parts || (p->books && p->share && !p->team)))
        return RELUME_EINVAL;
    if (!p->parts || encode_is_coded(p))
        return RELUME_OK;
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

// Whether parts tell each other their ranges, so that each packs its own rows: in whole blocks, and
// of views that are no pyramid, whose levels need all rows.
static bool may_settle(const struct contents *f)
{
    const struct relume_pack_encode_params *p = f->p;
    const int width = relume_capture_width(f->capture), height = relume_capture_height(f->capture);
    struct encode_share share = {0};
    bool whole = f->rows && p->team && !pyramid_is_wanted(p->pyramid, width, height);
    for (int i = 1; whole && i <= p->parts; i++) {
        encode_share_of(&share, i, p->parts, f->views, height);
        whole = share.row % ENCODE_BLOCK == 0;
    }
    return whole;
}

// The bands of rows that begin with `row`.
static struct range *bands_at(const relume_coefficients *c, int row)
{
    return c->band + (size_t)(row / BAND_ROWS) * (size_t)c->info.planes;
}

// The bands of the rows of a part, one part at a time.
struct part_bands {
    struct contents *f;
    struct encode_share share;
    int part;                // 1 .. parts
    struct range *band;      // [most rows of a part / BAND_ROWS][planes]
    struct team_array sent;  // `band` of the part
};

static relume_status begin_part(void *context, int member)
{
    struct part_bands *b = context;
    const struct contents *f = b->f;
    const size_t planes = (size_t)relume_coder_info(f->coder)->planes;
    b->part = member + 1;
    encode_share_of(&b->share, b->part, f->p->parts, f->views, relume_capture_height(f->capture));
    b->sent.size = (size_t)(b->share.rows + BAND_ROWS - 1) / BAND_ROWS * planes * sizeof *b->band;
    return RELUME_OK;
}

// Rows that are not encoded here, since their part has not come yet or writes nothing so far, are
// encoded for them.
static relume_status find_bands(void *context)
{
    struct part_bands *b = context;
    const struct contents *f = b->f;
    const struct encode_share *s = &b->share;
    const relume_coefficients *own = b->part == f->p->part ? f->coefficients[f->first] : NULL;
    relume_coefficients *made = NULL;
    relume_status status = RELUME_OK;
    if (!own)
        status =
            project_some_rows(&made, f->coder, f->capture, s->first, s->row, s->rows, f->encode);
    if (!status)
        memcpy(b->band, bands_at(own ? own : made, s->row), b->sent.size);
    relume_coefficients_destroy(&made);
    return status;
}

// Keeps the bands of the view that the own rows belong to.
static relume_status add_bands(void *context)
{
    const struct part_bands *b = context;
    const struct contents *f = b->f;
    relume_coefficients *own = f->coefficients[f->first];
    if (own && b->share.first == f->first)
        memcpy(bands_at(own, b->share.row), b->band, b->sent.size);
    return RELUME_OK;
}

static relume_status share_ranges(struct contents *f)
{
    struct part_bands b = {.f = f};
    static const struct team_work work = {begin_part, find_bands, add_bands};
    const size_t planes = (size_t)relume_coder_info(f->coder)->planes;
    const size_t bands = ((size_t)relume_capture_height(f->capture) + BAND_ROWS - 1) / BAND_ROWS;
    b.sent.items = b.band = mem_array(bands * planes, sizeof *b.band);
    const relume_status status =
        b.band ? team_share(f->p->team, "ranges", &work, &b, &team_array_bytes, &b.sent, f->p->log)
               : RELUME_ENOMEM;
    mem_free(b.band);
    return status;
}

static relume_status settle_rows(struct contents *f)
{
    struct relume_image *mask = &f->mask[f->first];
    relume_status status = share_ranges(f);
    if (!status && f->row)
        status = relume_capture_mask(mask, f->capture, f->first, f->p->log);
    f->view[f->first].mask = mask->data ? mask : NULL;
    return status ? status
                  : project_settle_rows(f->coefficients[f->first], mask,
                                        relume_encode_curve(f->capture, f->p->display), f->encode);
}

// What is said of the work on all views, as that of a part.
struct part_log {
    struct relume_log log;
    const struct relume_log *to;
    double first, extent;
};

static void forward_message(void *user, enum relume_level level, const char *text)
{
    const struct part_log *p = user;
    if (p->to->message)
        p->to->message(p->to->user, level, text);
}

static bool forward_progress(void *user, const char *what, double done)
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
    p->log.message = forward_message;
    p->log.progress = forward_progress;
    p->log.user = p;
    return &p->log;
}

static relume_status encode_views(struct contents *f)
{
    const struct relume_pack_encode_params *p = f->p;
    relume_status status = RELUME_OK;
    if (p->learn_only)
        return may_settle(f) ? share_ranges(f) : RELUME_OK;
    for (int i = f->first; !status && i < f->end; i++) {
        status = contents_encode(f, i);
        if (!status)
            status = contents_extras(f, i);
    }
    if (!status && may_settle(f))
        status = settle_rows(f);
    if (!status && p->books)
        status = make_books(f);
    for (int i = f->first; !status && !f->rows && i < f->end; i++)
        status = contents_reduce(f, i);
    return status;
}

relume_status relume_pack_encode(const relume_capture *capture, const relume_coder *coder,
                                 const char *path, struct relume_fidelity *report,
                                 const struct relume_pack_encode_params *params)
{
    const struct relume_pack_encode_params p = PARAMS_WORK(relume_pack_encode_params, params);
    struct relume_project_params encode = {
        .log = p.log,
        .domain = relume_capture_domain(capture, p.domain),
        .storage = encode_is_coded(&p) ? RELUME_STORE_12 : p.storage,
        .step = encode_is_coded(&p) ? RELUME_STEP_HALVED : p.step,
        .threads = p.threads,
        .scratch = p.writer ? NULL : path,
        .display = p.display,
    };
    if (!path && !p.writer)
        return RELUME_EINVAL;
    struct contents f = {.capture = capture, .coder = coder, .p = &p, .encode = &encode};
    struct relume_fidelity total = {0};
    struct encode_share share;
    struct part_log part;
    relume_status status = find_share(&share, capture, &p);
    if (!status && p.parts && !encode_is_coded(&p))
        encode.log = log_part(&part, p.log, &share, capture);
    if (!status)
        status = contents_create(&f, &share);
    if (!status && encode_is_coded(&p)) {
        status = encode_coded(&f, path, &total);
    } else if (!status) {
        status = encode_views(&f);
        if (!status && p.books && report)
            status = judge_books(&f);
        total = fidelity_mean(f.report + f.first, f.end - f.first);
        if (!status && !p.learn_only)
            status = write_file(&f, &total, path);
    }
    if (!status && report)
        *report = total;
    contents_destroy(&f);
    return status;
}
