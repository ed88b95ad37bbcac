// reduction.c - the coefficients of a view at half its size
//
// In linear light the mean of 2 x 2 pixels has the mean of their coefficients. In the display
// domain it has not, since means are of light: there the pixels are decoded under every captured
// light and made linear, and what their mean light, coded again, has beyond the mean of their codes
// joins the mean of their coefficients by least squares over the lights.
#include "encode/levels/reduction.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/scratch.h"
#include "core/base/thread.h"
#include "core/math/lsq.h"
#include "core/math/scalar.h"
#include "format/coder/basis.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"
#include "image/image/curve.h"
#include "image/image/encoder.h"
#include "image/image/image.h"

#include <errno.h>
#include <stdatomic.h>
#include <string.h>

// Beside the mean of the diagonal of the normal equations: what the lights hardly determine stays
// as in the mean.
static const double RIDGE = 1e-5;

struct reducing {
    const relume_coefficients *from;
    relume_coefficients *to;
    const struct relume_image *share;
    // Of the display domain
    bool coded;
    struct curve *curve;
    struct encoder *encoder;
    struct captured captured;
    float *map;  // [channel][k][light]: what light has too much, as coefficients
    atomic_int status;
};

// ---------------------------------------------------------------- least squares

// Of one channel, or of all three where these have the same coefficients.
static void add_equations(double *gram, const float *basis, size_t lights, size_t k)
{
    for (size_t i = 0; i < lights; i++, basis += k)
        for (size_t a = 0; a < k; a++)
            for (size_t b = 0; b < k; b++)
                gram[a * k + b] += (double)basis[a] * (double)basis[b];
}

static bool solve(float *map, double *gram, double *right, const float *basis, size_t lights,
                  size_t k)
{
    for (size_t i = 0; i < lights; i++)
        for (size_t a = 0; a < k; a++)
            right[i * k + a] = (double)basis[i * k + a];
    if (!lsq_solve(gram, (int)k, right, (int)lights))
        return false;
    for (size_t i = 0; i < lights; i++)
        for (size_t a = 0; a < k; a++)
            map[a * lights + i] = (float)right[i * k + a];
    return true;
}

static void add_ridge(double *gram, size_t k)
{
    double trace = 0.0;
    for (size_t a = 0; a < k; a++)
        trace += gram[a * k + a];
    for (size_t a = 0; a < k; a++)
        gram[a * k + a] += RIDGE * trace / (double)k + 1e-30;
}

static relume_status find_map(struct reducing *r, const struct relume_coder_info *info)
{
    const size_t k = (size_t)info->coefficients, n = (size_t)info->lights;
    double *gram = mem_array(k * k, sizeof *gram), *copy = mem_array(k * k, sizeof *copy);
    double *right = mem_array(k * n, sizeof *right);
    r->map = mem_array(3 * k * n, sizeof *r->map);
    bool good = gram && copy && right && r->map;
    for (size_t c = 0; good && c < 3; c++) {
        if (c == 0 || !info->joint) {
            memset(gram, 0, k * k * sizeof *gram);
            add_equations(gram, r->captured.basis + c * n * k, info->joint ? 3 * n : n, k);
            add_ridge(gram, k);
        }
        memcpy(copy, gram, k * k * sizeof *copy);
        good = solve(r->map + c * k * n, copy, right, r->captured.basis + c * n * k, n, k);
    }
    mem_free(gram);
    mem_free(copy);
    mem_free(right);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status prepare_coded(struct reducing *r, struct relume_transfer display)
{
    const relume_coder *coder = r->from->info.coder;
    const struct relume_coder_info *info = relume_coder_info(coder);
    r->coded = true;
    r->curve = mem_array(1, sizeof *r->curve);
    r->encoder = mem_array(1, sizeof *r->encoder);
    if (!r->curve || !r->encoder)
        return RELUME_ENOMEM;
    curve_init(r->curve, display);
    encoder_init(r->encoder, display);
    const relume_status status =
        captured_create(&r->captured, coder, info->directions, info->lights);
    return status ? status : find_map(r, info);
}

// ---------------------------------------------------------------- means

// Of a row: the weight of each of the pixels of two rows that it covers.
struct row {
    const float *above, *below;  // [plane][x] of the larger view; below NULL: there is none
    const float *share[2];       // [x]; NULL: 1
    size_t from, width;          // pixels of a row of the larger, of the smaller view
};

static float weight_of(const struct row *w, int down, size_t x)
{
    if (x >= w->from || (down && !w->below))
        return 0.0f;
    return w->share[down] && !(w->share[down][x] > 0.0f) ? 0.0f : 1.0f;
}

// The mean over those within the mask, or over all with nothing beyond it.
static void mean_of(float *out, const struct row *w, const float *above, const float *below,
                    bool of_all)
{
    const bool plain = w->below && !w->share[0] && !w->share[1];
    const size_t whole = plain ? w->from / 2 : 0;
    for (size_t x = 0; x < whole; x++)
        out[x] = 0.25f * (above[2 * x] + above[2 * x + 1] + below[2 * x] + below[2 * x + 1]);
    for (size_t x = whole; x < w->width; x++) {
        const size_t left = 2 * x, right = left + 1 < w->from ? left + 1 : left;
        float sum = 0.0f, count = 0.0f, all = 0.0f;
        for (int i = 0; i < (w->below ? 4 : 2); i++) {
            const size_t at = i % 2 ? right : left;
            const float weight = weight_of(w, i / 2, left + (size_t)(i % 2));
            sum += weight > 0.0f ? (i / 2 ? below : above)[at] : 0.0f;
            count += weight;
            all += left + (size_t)(i % 2) < w->from ? 1.0f : 0.0f;
        }
        const float parts = of_all ? all : count;
        out[x] = parts > 0.0f ? sum / parts : 0.0f;
    }
}

// What the mean light has beyond the mean of the codes, one channel: out[light][x] of both rows.
static void light_beyond(const struct reducing *r, const struct row *w, int channel, float *above,
                         float *below, float *out)
{
    const relume_coder *coder = r->from->info.coder;
    const size_t lights = (size_t)r->captured.lights, n = w->from;
    captured_predict(&r->captured, coder, channel, w->above, n, n, above);
    if (w->below)
        captured_predict(&r->captured, coder, channel, w->below, n, n, below);
    for (size_t i = 0; i < lights; i++) {
        float *to = out + i * w->width, *a = above + i * n, *b = below + i * n;
        float *light = out + lights * w->width;
        mean_of(to, w, a, b, false);
        for (size_t x = 0; x < n; x++) {
            a[x] = curve_decode(r->curve, a[x]);
            b[x] = w->below ? curve_decode(r->curve, b[x]) : 0.0f;
        }
        mean_of(light, w, a, b, true);
        encoder_apply(r->encoder, light, light, (int)w->width);
        for (size_t x = 0; x < w->width; x++)
            to[x] = light[x] - to[x];
    }
}

// `add` holds the coefficients of one channel.
static void correct(const struct reducing *r, const struct row *w, int channel, const float *beyond,
                    float *add, float *values, size_t stride)
{
    const struct relume_coder_info *info = relume_coder_info(r->from->info.coder);
    const size_t k = (size_t)info->coefficients, lights = (size_t)info->lights;
    lsq_multiply((int)k, (int)w->width, (int)lights, r->map + (size_t)channel * k * lights,
                 (int)lights, beyond, (int)w->width, add, (int)w->width);
    for (size_t i = 0; i < k; i++) {
        float *to = values + (size_t)relume_coder_plane(info, (int)i, channel) * stride;
        for (size_t x = 0; x < w->width; x++)
            to[x] += add[i * w->width + x];
    }
}

// ---------------------------------------------------------------- bands

// Scratch memory of one worker, for a band.
struct scratch {
    float *memory;
    float *rows[2], *values, *predicted[2], *beyond, *add;
    void *waiting;
};

static bool allocate_scratch(struct scratch *m, const struct reducing *r)
{
    const struct relume_coefficients_info *from = &r->from->info, *to = &r->to->info;
    const struct relume_coder_info *coder = relume_coder_info(from->coder);
    const size_t planes = (size_t)from->planes, wide = (size_t)from->width,
                 width = (size_t)to->width;
    const size_t lights = r->coded ? (size_t)coder->lights : 0;
    const size_t sizes[] = {planes * wide,
                            planes * wide,
                            planes * BAND_ROWS * width,
                            lights * wide,
                            lights * wide,
                            r->coded ? (lights + 1) * width : 0,
                            r->coded ? (size_t)coder->coefficients * width : 0,
                            planes * (wide > BAND_ROWS * width ? wide : BAND_ROWS * width)};
    size_t all = 0;
    for (int i = 0; i < 8; i++)
        all += sizes[i];
    float *at = m->memory = mem_array(all, sizeof *at);
    float **const place[] = {&m->rows[0],      &m->rows[1], &m->values, &m->predicted[0],
                             &m->predicted[1], &m->beyond,  &m->add};
    for (int i = 0; at && i < 7; at += sizes[i++])
        *place[i] = at;
    m->waiting = at;
    return m->memory != NULL;
}

static relume_status reduce_row(const struct reducing *r, struct scratch *m, int row, float *values)
{
    const struct relume_coefficients_info *from = &r->from->info, *to = &r->to->info;
    const size_t wide = (size_t)from->width, width = (size_t)to->width;
    const size_t pixels = BAND_ROWS * width;
    const bool two = 2 * row + 1 < from->height;
    relume_status status = coefficients_values(r->from, 2 * row, m->waiting, m->rows[0]);
    if (!status && two)
        status = coefficients_values(r->from, 2 * row + 1, m->waiting, m->rows[1]);
    struct row w = {
        .above = m->rows[0], .below = two ? m->rows[1] : NULL, .from = wide, .width = width};
    for (int i = 0; r->share->data && i < 1 + two; i++)
        w.share[i] = r->share->data + (size_t)(2 * row + i) * wide;
    for (size_t p = 0; !status && p < (size_t)from->planes; p++)
        mean_of(values + p * pixels, &w, m->rows[0] + p * wide, m->rows[1] + p * wide, !r->coded);
    for (int c = 0; !status && r->coded && c < 3; c++) {
        light_beyond(r, &w, c, m->predicted[0], m->predicted[1], m->beyond);
        correct(r, &w, c, m->beyond, m->add, values, pixels);
    }
    return status;
}

static relume_status keep_band(const struct reducing *r, const struct scratch *m, int first,
                               int rows)
{
    relume_coefficients *to = r->to;
    const size_t planes = (size_t)to->info.planes, width = (size_t)to->info.width;
    const size_t pixels = BAND_ROWS * width, wait = coefficients_waiting(to);
    struct range *band = to->band + (size_t)(first / BAND_ROWS) * planes;
    for (size_t p = 0; p < planes; p++) {
        band[p] = range_settle(range_of(m->values + p * pixels, (size_t)rows * width));
        for (size_t y = 0; y < (size_t)rows; y++)
            coefficients_wait(to, (int)p, first, m->values + p * pixels + y * width, width,
                              (char *)m->waiting + (y * planes + p) * width * wait);
    }
    return scratch_write(to->fd, m->waiting, (size_t)rows * planes * width * wait,
                         coefficients_offset(to, first))
               ? RELUME_OK
               : RELUME_EIO;
}

static void reduce_band(void *context, size_t item, int worker)
{
    struct reducing *r = context;
    const int first = (int)item * BAND_ROWS, left = r->to->info.height - first;
    const int rows = left < BAND_ROWS ? left : BAND_ROWS;
    struct scratch m = {0};
    (void)worker;
    if (atomic_load(&r->status))
        return;
    relume_status status = allocate_scratch(&m, r) ? RELUME_OK : RELUME_ENOMEM;
    for (int y = 0; !status && y < rows; y++)
        status = reduce_row(r, &m, first + y, m.values + (size_t)y * (size_t)r->to->info.width);
    if (!status)
        status = keep_band(r, &m, first, rows);
    image_forget(r->share, 2 * first, smaller_of(2 * rows, r->share->height - 2 * first));
    mem_free(m.memory);
    if (status)
        atomic_store(&r->status, (int)status);
}

relume_status coefficients_reduce(relume_coefficients **out, const relume_coefficients *from,
                                  const struct relume_image *share, const struct reduction *p)
{
    struct reducing r = {.from = from, .share = share};
    struct relume_project_params encode = p->encode;
    const struct relume_coefficients_info *info = &from->info;
    *out = NULL;
    encode.storage = from->coarse ? RELUME_STORE_LOG : info->storage;
    relume_status status =
        coefficients_create(out, info->coder, reduced(info->width), reduced(info->height), &encode);
    r.to = *out;
    if (!status && p->domain == RELUME_DOMAIN_DISPLAY)
        status = prepare_coded(&r, p->display);
    if (!status) {
        thread_for(thread_count(encode.threads), (size_t)r.to->bands, reduce_band, &r);
        status = (relume_status)atomic_load(&r.status);
    }
    if (status == RELUME_EIO)
        status = log_fail(encode.log, RELUME_EIO, "%s: no room for temporary data; %s",
                          encode.scratch ? encode.scratch : "$TMPDIR", strerror(errno));
    if (!status)
        status = coefficients_share_steps(out, 1, share->data, encode.step);
    captured_destroy(&r.captured);
    mem_free(r.curve);
    mem_free(r.encoder);
    mem_free(r.map);
    if (status)
        relume_coefficients_destroy(out);
    return status;
}

relume_status share_create(struct relume_image *out, const struct relume_image *mask,
                           const struct relume_project_params *p)
{
    const size_t width = (size_t)mask->width;
    const relume_status status =
        image_create_large(out, mask->width, mask->height, 1, p->scratch, p->log);
    for (int y = 0; !status && y < mask->height; y++) {
        for (size_t x = 0, at = (size_t)y * width; x < width; x++, at++)
            out->data[at] = mask->data[at] > 0.5f;
        image_forget(mask, y, 1);
        image_forget(out, y, 1);
    }
    return status;
}

relume_status share_reduce(struct relume_image *out, const struct relume_image *share,
                           const struct relume_project_params *p)
{
    const size_t width = (size_t)share->width;
    const relume_status status = image_create_large(out, reduced(share->width),
                                                    reduced(share->height), 1, p->scratch, p->log);
    for (int y = 0; !status && y < out->height; y++) {
        const float *above = share->data + 2 * (size_t)y * width;
        const struct row w = {.above = above,
                              .below = 2 * y + 1 < share->height ? above + width : NULL,
                              .from = width,
                              .width = (size_t)out->width};
        mean_of(out->data + (size_t)y * w.width, &w, above, w.below, true);
        image_forget(share, 2 * y, 1 + (w.below != NULL));
        image_forget(out, y, 1);
    }
    return status;
}
