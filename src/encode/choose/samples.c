// samples.c - pixels of a capture from which a learned basis learns
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/random.h"
#include "encode/choose/samples.h"
#include "format/coder/coefficients.h"
#include "image/image/image.h"

#include <relume/format/team.h>
#include <string.h>

enum { DEFAULT_PIXELS = 65536, LEAST_PIXELS = 4096, ONE_LIGHT = 1 << 20 };

// Of all pixels those that are looked at, by number over all views, ascending.
struct chosen {
    size_t *pixel;
    size_t count;
};

struct sampler {
    struct relume_samples *out;
    struct chosen chosen;  // in the share that is read
    size_t next;
    relume_table *table;  // of the view in progress
    size_t *place;        // [count]: where pixels lie in a band
    size_t taken;         // of them
};

// What all members know.
struct sampling {
    const relume_capture *capture;
    struct relume_encode_params p;
    struct relume_transfer display;
    struct chosen chosen;
};

// One pixel from each of `count` equal runs, at a place that no pattern of the image can follow.
static void choose(const struct chosen *c, size_t pixels)
{
    struct random random = random_stream(1, pixels, c->count);
    for (size_t i = 0; i < c->count; i++) {
        const double at = ((double)i + random_next(&random)) * (double)pixels / (double)c->count;
        c->pixel[i] = at < (double)pixels ? (size_t)at : pixels - 1;
    }
}

static void take_light(void *context, size_t item, int worker)
{
    (void)worker;
    const struct sampler *s = context;
    for (size_t k = 0; k < s->taken; k++)
        relume_table_planes(s->table, (int)item, s->place[k], 1,
                            s->out->data + (item * s->chosen.count + s->out->pixels + k) * 3, 1);
}

// Take the chosen pixels of a band whose first pixel has the number `first`.
static void take(struct sampler *s, const struct relume_image *mask, size_t n, size_t first,
                 size_t view_first, int threads)
{
    s->taken = 0;
    for (; s->next < s->chosen.count && s->chosen.pixel[s->next] < first + n; s->next++) {
        const size_t x = s->chosen.pixel[s->next] - first;
        if (!mask->data || mask->data[first - view_first + x] > 0.5f)
            s->place[s->taken++] = x;
    }
    thread_for(threads, s->taken ? (size_t)s->out->lights : 0, take_light, s);
    s->out->pixels += s->taken;
}

static relume_status sample_view(struct sampler *s, const struct sampling *g, int view, int row,
                                 int end)
{
    const struct relume_encode_params *p = &g->p;
    const size_t width = (size_t)relume_capture_width(g->capture);
    const int height = relume_capture_height(g->capture);
    const size_t view_first = (size_t)view * width * (size_t)height;
    struct relume_image mask;
    relume_status status = relume_capture_mask(&mask, g->capture, view, p->log);
    if (!status)
        status = relume_table_open(
            &s->table, g->capture, view,
            relume_table_params(.log = p->log, .display = g->display, .threads = p->threads));
    if (!status)
        status = relume_table_skip(s->table, row);
    for (; !status && row < end; row += BAND_ROWS) {
        const int rows = end - row < BAND_ROWS ? end - row : BAND_ROWS;
        status = relume_table_fetch(s->table, rows);
        if (status)
            break;
        take(s, &mask, (size_t)rows * width, view_first + (size_t)row * width, view_first,
             p->threads);
        image_forget(&mask, row, rows);
        const int views = relume_capture_manifest(g->capture)->views;
        if (!log_progress(p->log, "sampling", (view + (row + rows) / (double)height) / views))
            status = RELUME_ECANCEL;
    }
    relume_table_destroy(&s->table);
    relume_image_destroy(&mask);
    return status;
}

// Masked pixels left gaps at the end of every light's row.
static void close_gaps(struct relume_samples *s, size_t count)
{
    for (size_t i = 1; i < (size_t)s->lights; i++)
        memmove(s->data + i * s->pixels * 3, s->data + i * count * 3,
                s->pixels * 3 * sizeof *s->data);
}

// Those of the chosen pixels that lie in a share of the work.
static relume_status sample_share(struct relume_samples *out, const struct sampling *g,
                                  const struct encode_share *share)
{
    const size_t width = (size_t)relume_capture_width(g->capture);
    const size_t height = (size_t)relume_capture_height(g->capture);
    const size_t rows = (size_t)(share->rows ? share->rows : relume_capture_height(g->capture));
    const size_t first = ((size_t)share->first * height + (size_t)share->row) * width;
    const size_t end = first + ((size_t)(share->views - 1) * height + rows) * width;
    size_t from = 0, to = g->chosen.count;
    while (from < to && g->chosen.pixel[from] < first)
        from++;
    while (to > from && g->chosen.pixel[to - 1] >= end)
        to--;
    *out = (struct relume_samples){.lights = relume_capture_manifest(g->capture)->lights};
    struct sampler s = {.out = out, .chosen = {g->chosen.pixel + from, to - from}};
    s.place = mem_array(s.chosen.count, sizeof *s.place);
    out->data = mem_array((size_t)out->lights * s.chosen.count * 3, sizeof *out->data);
    relume_status status = s.place && out->data ? RELUME_OK : RELUME_ENOMEM;
    for (int v = share->first; !status && v < share->first + share->views; v++)
        status = sample_view(&s, g, v, share->row, share->row + (int)rows);
    mem_free(s.place);
    if (status)
        relume_samples_destroy(out);
    else
        close_gaps(out, s.chosen.count);
    return status;
}

// ---------------------------------------------------------------- of a team

// A piece is the number of pixels, and then the samples of its share.
static relume_status make_piece(void *context, int member, struct relume_buffer *piece)
{
    const struct sampling *g = context;
    struct encode_share share;
    struct relume_samples own = {0};
    relume_status status =
        encode_share_find(&share, member + 1, g->p.team->members, g->capture, g->p.log);
    if (!status)
        status = sample_share(&own, g, &share);
    if (status)
        return status;
    const uint64_t pixels = own.pixels;
    const size_t bytes = own.pixels * (size_t)own.lights * 3 * sizeof *own.data;
    if ((piece->data = mem_array(sizeof pixels + bytes, 1))) {
        piece->size = sizeof pixels + bytes;
        memcpy(piece->data, &pixels, sizeof pixels);
        memcpy(piece->data + sizeof pixels, own.data, bytes);
    }
    relume_samples_destroy(&own);
    return piece->data ? RELUME_OK : RELUME_ENOMEM;
}

// The pixels of a piece; more than there can be where it is none.
static size_t piece_pixels(const struct relume_buffer *piece, size_t lights)
{
    uint64_t pixels = 0;
    if (piece->size >= sizeof pixels)
        memcpy(&pixels, piece->data, sizeof pixels);
    return piece->size >= sizeof pixels && pixels <= piece->size &&
                   piece->size == sizeof pixels + pixels * lights * 3 * sizeof(float)
               ? (size_t)pixels
               : SIZE_MAX;
}

static relume_status join_pieces(struct relume_samples *out, const struct sampling *g,
                                 const struct relume_buffer *piece)
{
    const size_t lights = (size_t)relume_capture_manifest(g->capture)->lights;
    size_t all = 0, before = 0;
    for (int i = 0; i < g->p.team->members; i++) {
        const size_t pixels = piece_pixels(&piece[i], lights);
        if (pixels > g->chosen.count - all)
            return log_fail(g->p.log, RELUME_EDAMAGED,
                            "the samples of part %d are not of this capture; run it again", i + 1);
        all += pixels;
    }
    *out = (struct relume_samples){.lights = (int)lights, .pixels = all};
    out->data = mem_array(lights * all * 3, sizeof *out->data);
    for (int i = 0; out->data && i < g->p.team->members; i++) {
        const size_t pixels = piece_pixels(&piece[i], lights), row = pixels * 3 * sizeof(float);
        for (size_t l = 0; l < lights; l++)
            memcpy(out->data + (l * all + before) * 3, piece[i].data + sizeof(uint64_t) + l * row,
                   row);
        before += pixels;
    }
    return out->data ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status sample_together(struct relume_samples *out, struct sampling *g)
{
    const struct relume_team *team = g->p.team;
    struct relume_buffer *piece = mem_zeroed((size_t)team->members, sizeof *piece);
    relume_status status =
        piece ? team->share(team->user, "samples", make_piece, g, piece) : RELUME_ENOMEM;
    if (!status)
        status = join_pieces(out, g, piece);
    for (int i = 0; piece && i < team->members; i++)
        relume_buffer_destroy(&piece[i]);
    mem_free(piece);
    return status;
}

relume_status relume_samples_read(struct relume_samples *out, const relume_capture *capture,
                                  size_t pixels, const struct relume_encode_params *params)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    const size_t all = (size_t)m->views * (size_t)relume_capture_width(capture) *
                       (size_t)relume_capture_height(capture);
    const size_t want = pixels ? pixels : DEFAULT_PIXELS;
    struct sampling g = {.capture = capture,
                         .p = PARAMS_WORK(relume_encode_params, params),
                         .display = {.curve = RELUME_CURVE_LINEAR},
                         .chosen = {.count = want < all ? want : all}};
    *out = (struct relume_samples){.lights = m->lights};
    if (relume_encode_domain(capture, g.p.domain) == RELUME_DOMAIN_DISPLAY)
        g.display = relume_encode_curve(capture, g.p.display);
    g.chosen.pixel = mem_array(g.chosen.count, sizeof *g.chosen.pixel);
    if (!g.chosen.pixel)
        return RELUME_ENOMEM;
    choose(&g.chosen, all);
    const relume_status status =
        g.p.team ? sample_together(out, &g)
                 : sample_share(out, &g, &(const struct encode_share){.views = m->views});
    mem_free(g.chosen.pixel);
    return status;
}

void relume_samples_destroy(struct relume_samples *samples)
{
    mem_free(samples->data);
    *samples = (struct relume_samples){0};
}

size_t samples_enough(int lights)
{
    const double values = 3.0 * lights, most = 1e11 / (values * values);
    if (lights == 1)
        return ONE_LIGHT;
    return most < LEAST_PIXELS     ? LEAST_PIXELS
           : most < DEFAULT_PIXELS ? (size_t)most
                                   : DEFAULT_PIXELS;
}

relume_status relume_coder_learn(relume_coder **out, const struct relume_basis *basis,
                                 const relume_capture *capture,
                                 const struct relume_coder_params *coder,
                                 const struct relume_encode_params *encode)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    struct relume_coder_params p = PARAMS_WORK(relume_coder_params, coder);
    struct relume_samples samples = {0};
    p.hemispherical = relume_capture_hemispherical(capture);
    p.pole_y = relume_capture_pole_y(capture);
    p.threads = encode ? encode->threads : 0;
    relume_status status = RELUME_OK;
    *out = NULL;
    if (basis->learned || p.choose) {
        status = relume_samples_read(&samples, capture, samples_enough(m->lights), encode);
        p.samples = &samples;
    }
    if (!status)
        status = relume_coder_create(out, basis, m->directions, m->lights, &p);
    relume_samples_destroy(&samples);
    return status;
}
