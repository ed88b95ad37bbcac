// refit.c - display-domain codes once more as linear ones
//
// An environment is a sum over thousands of directions, and in the display domain every one would
// have to be decoded and made linear on its own. So the file is decoded once at the directions that
// it was captured from, in linear light, and `pca` learns that.
#include <relume/relight/relight.h>

#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "format/coder/coding.h"
#include "relight/light/grid.h"
#include "relight/light/refit.h"

#include <math.h>
#include <string.h>

enum { SAMPLES = 16384, BAND = 4096 };

struct relume_refit {
    relume_coder *learned;  // or NULL: another refit's
    const relume_coder *coder;
    relume_weight_grid *made;        // or NULL: another refit's
    const relume_weight_grid *grid;  // of the coder
    struct relume_codes codes;
    void **plane;  // [planes], or with a codebook
    float *scale, *offset;
    float *vectors;
    const float *book[1];
    double loss;
};

struct refitting {
    const struct relume_codes *from;
    const struct relume_coder_info *info;
    struct relume_refit_params params;
    size_t pixels;  // or code vectors
};

void relume_refit_forget(relume_refit *refit)
{
    for (int p = 0; refit->plane && p < refit->codes.planes; p++)
        mem_free(refit->plane[p]);
    mem_free(refit->plane);
    mem_free(refit->scale);
    mem_free(refit->offset);
    mem_free(refit->vectors);
    refit->plane = NULL;
    refit->scale = refit->offset = refit->vectors = NULL;
    refit->codes = (struct relume_codes){.coder = refit->coder};
}

void relume_refit_destroy(relume_refit **refit)
{
    if (!*refit)
        return;
    relume_refit_forget(*refit);
    relume_weight_grid_destroy(&(*refit)->made);
    relume_coder_destroy(&(*refit)->learned);
    mem_free(*refit);
    *refit = NULL;
}

const struct relume_codes *relume_refit_codes(const relume_refit *refit)
{
    return &refit->codes;
}

double relume_refit_loss(const relume_refit *refit)
{
    return refit->loss;
}

// ---------------------------------------------------------------- decoding

static relume_status decode_light(const struct refitting *w, const struct relume_codes *codes,
                                  int light, size_t n, float *rgb)
{
    const struct relume_light lamp = {.direction = w->info->directions[light], .rgb = {1, 1, 1}};
    const struct relume_relight_params *p =
        relume_relight_params(.cpu_off = w->params.cpu_off, .threads = w->params.threads);
    struct relume_image row = {(int)n, 1, 3, .data = rgb};
    return relume_relight(&row, codes, &lamp, 1, p);
}

// Linear values of n pixels (code vectors) under all captured lights: out[lights][n][3].
static relume_status decode(const struct refitting *w, const struct relume_codes *codes,
                            size_t first, size_t step, size_t n, float *out)
{
    struct relume_codes_part part;
    relume_status status = relume_codes_pick(&part, codes, first, step, n);
    for (int i = 0; !status && i < w->info->lights; i++)
        status = decode_light(w, &part.codes, i, n, out + (size_t)i * n * 3);
    relume_codes_part_destroy(&part);
    return status;
}

// A book's own vectors are its pixels: the one at index v shows vector v.
static relume_status as_pixels(struct relume_codes *out, uint16_t **index, const uint16_t *list[1],
                               const struct relume_codes *codes)
{
    const int n = codes->book_codes[0];
    *index = mem_array((size_t)n, sizeof **index);
    for (int i = 0; *index && i < n; i++)
        (*index)[i] = (uint16_t)i;
    list[0] = *index;
    *out = *codes;
    out->width = n;
    out->height = 1;
    out->index = list;
    return *index ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- learning

static struct relume_coder_params coder_params(const struct refitting *w,
                                               const struct relume_samples *samples)
{
    const int want = w->params.coefficients ? w->params.coefficients : 2 * w->info->coefficients;
    struct relume_coder_params p = {
        .log = w->params.log,
        .coefficients = relume_basis_pca.fit_count(want, w->info->lights),
        .hemispherical = w->info->hemispherical,
        .pole_y = w->info->pole_y,
        .samples = samples,
        .interpolant = w->info->interpolant,
        .choose = !w->info->interpolant,
    };
    memcpy(p.parameter, w->info->parameter, sizeof p.parameter);
    return p;
}

static relume_status learn(relume_refit *refit, const struct refitting *w,
                           const struct relume_samples *samples)
{
    const struct relume_coder_params p = coder_params(w, samples);
    const relume_status status = relume_coder_create(&refit->learned, &relume_basis_pca,
                                                     w->info->directions, w->info->lights, &p);
    refit->coder = refit->learned;
    return status ? status : relume_coder_append_mean(refit->learned);
}

static relume_status create_planes(relume_refit *refit, const struct refitting *w)
{
    const size_t planes = (size_t)refit->codes.planes;
    refit->plane = mem_zeroed(planes, sizeof *refit->plane);
    refit->scale = mem_array(planes, sizeof *refit->scale);
    refit->offset = mem_zeroed(planes, sizeof *refit->offset);
    if (!refit->plane || !refit->scale || !refit->offset)
        return RELUME_ENOMEM;
    for (size_t p = 0; p < planes; p++) {
        refit->scale[p] = 1.0f;
        if (!(refit->plane[p] = mem_array(w->pixels, sizeof(uint16_t))))
            return RELUME_ENOMEM;
    }
    refit->codes.plane = (const void *const *)refit->plane;
    refit->codes.scale = refit->scale;
    refit->codes.offset = refit->offset;
    return RELUME_OK;
}

static relume_status create_book(relume_refit *refit, const struct refitting *w)
{
    refit->vectors = mem_array(w->pixels, (size_t)refit->codes.planes * sizeof(float));
    refit->book[0] = refit->vectors;
    refit->codes.vectors = refit->book;
    return refit->vectors ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status create_codes(relume_refit *refit, const struct refitting *w, bool book)
{
    const struct relume_codes *from = w->from;
    refit->codes = (struct relume_codes){
        .coder = refit->coder,
        .domain = RELUME_DOMAIN_LINEAR,
        .display = from->display,
        .width = from->width,
        .height = from->height,
        .planes = relume_coder_info(refit->coder)->planes,
        .storage = book ? 0 : RELUME_STORE_HALF,
        .books = book ? 1 : 0,
        .index = book ? from->index : NULL,
        .book_codes = book ? from->book_codes : NULL,
    };
    return (book ? create_book : create_planes)(refit, w);
}

static void store(relume_refit *refit, const float *planes, size_t first, size_t n)
{
    for (size_t p = 0; p < (size_t)refit->codes.planes; p++)
        for (size_t i = 0; i < n; i++) {
            const float v = planes[p * n + i];
            if (refit->vectors)
                refit->vectors[(first + i) * (size_t)refit->codes.planes + p] = v;
            else
                ((uint16_t *)refit->plane[p])[first + i] =
                    half_from_float(fminf(fmaxf(v, -65504.0f), 65504.0f));
        }
}

// What is black under every light stays so: its mean does not count either.
static void keep_black(const relume_refit *refit, const struct refitting *w, const float *samples,
                       float *planes, size_t n)
{
    static const float BLACK = 1e-5f;  // codes of 0 sum to 0 but for rounding
    for (size_t i = 0; i < n; i++) {
        float most = 0.0f;
        for (size_t s = 0; s < 3 * (size_t)w->info->lights; s++)
            most = fmaxf(most, fabsf(samples[(s / 3 * n + i) * 3 + s % 3]));
        for (size_t p = 0; most < BLACK && p < (size_t)refit->codes.planes; p++)
            planes[p * n + i] = 0.0f;
    }
}

// Bands of pixels (or of a book's vectors), each by one worker.
struct bands {
    relume_refit *refit;
    const struct refitting *work;
    const struct relume_codes *codes;
    _Atomic int status;  // of any that failed
};

static relume_status encode_band(const struct bands *b, size_t first, size_t n)
{
    const struct refitting *w = b->work;
    float *samples = mem_array(n * (size_t)w->info->lights, 3 * sizeof *samples);
    float *planes = mem_array(n, (size_t)b->refit->codes.planes * sizeof *planes);
    relume_status status = samples && planes ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = decode(w, b->codes, first, 1, n, samples);
    if (!status)
        status = relume_coder_apply(b->refit->coder, samples, 3 * n, n, planes, n);
    if (!status) {
        keep_black(b->refit, w, samples, planes, n);
        store(b->refit, planes, first, n);
    }
    mem_free(samples);
    mem_free(planes);
    return status;
}

static void encode_item(void *context, size_t item, int worker)
{
    struct bands *b = context;
    const size_t first = item * BAND, left = b->work->pixels - first;
    (void)worker;
    const relume_status status =
        b->status ? RELUME_OK : encode_band(b, first, left < BAND ? left : BAND);
    if (status)
        b->status = (int)status;
}

// `codes` being pixels or a book's vectors.
static relume_status encode(relume_refit *refit, const struct refitting *w,
                            const struct relume_codes *codes)
{
    struct refitting alone = *w;
    struct bands bands = {refit, &alone, codes, RELUME_OK};
    alone.params.threads = 1;
    thread_for(w->params.threads, (w->pixels + BAND - 1) / BAND, encode_item, &bands);
    return (relume_status)bands.status;
}

// Against the samples that were learned from: out of pixels that the book or the planes show.
static relume_status measure(relume_refit *refit, const struct refitting *w,
                             const struct relume_codes *shown, const struct relume_samples *samples,
                             size_t step)
{
    const size_t n = samples->pixels * (size_t)samples->lights * 3;
    float *again = mem_array(n, sizeof *again);
    relume_status status = again ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = decode(w, shown, 0, step, samples->pixels, again);
    double square = 0.0;
    for (size_t i = 0; !status && i < n; i++) {
        const double d = (double)again[i] - (double)samples->data[i];
        square += d * d;
    }
    refit->loss = sqrt(square / (double)n);
    mem_free(again);
    return status;
}

static relume_status refit_codes(relume_refit *refit, struct refitting *w,
                                 const struct relume_codes *codes, bool book)
{
    const size_t step = (w->pixels + SAMPLES - 1) / SAMPLES;
    struct relume_samples samples = {.lights = w->info->lights,
                                     .pixels = (w->pixels + step - 1) / step};
    samples.data = mem_array(samples.pixels * (size_t)samples.lights, 3 * sizeof *samples.data);
    relume_status status = samples.data ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = decode(w, codes, 0, step, samples.pixels, samples.data);
    if (!status && w->params.like)
        refit->coder = w->params.like->coder;
    else if (!status)
        status = learn(refit, w, &samples);
    if (!status)
        status = create_codes(refit, w, book);
    if (!status)
        status = encode(refit, w, codes);
    if (!status) {
        struct relume_codes shown = refit->codes;
        shown.width = codes->width;
        shown.height = codes->height;
        shown.index = codes->index;
        status = measure(refit, w, &shown, &samples, step);
    }
    mem_free(samples.data);
    return status;
}

// Of the coder that was learned, or of the one that learned it.
static relume_status take_grid(relume_refit *refit, const struct relume_refit_params *p)
{
    const relume_status status =
        p->like ? RELUME_OK
                : relume_weight_grid_create(
                      &refit->made, refit->coder,
                      relume_weight_grid_params(.sums = true, .threads = p->threads));
    refit->grid = p->like ? p->like->grid : refit->made;
    return status;
}

const relume_weight_grid *refit_grid(const relume_refit *refit)
{
    return refit->grid;
}

relume_status relume_refit_create(relume_refit **out, const struct relume_codes *codes,
                                  const struct relume_refit_params *params)
{
    struct refitting w = {
        .from = codes,
        .info = relume_coder_info(codes->coder),
        .params = PARAMS_WORK(relume_refit_params, params),
    };
    const bool book = codes->books == 1;
    struct relume_codes vectors = *codes;
    uint16_t *index = NULL;
    const uint16_t *list[1];
    *out = NULL;
    if (codes->domain != RELUME_DOMAIN_DISPLAY)
        return RELUME_EINVAL;
    relume_refit *refit = mem_zeroed(1, sizeof *refit);
    relume_status status = refit ? RELUME_OK : RELUME_ENOMEM;
    if (!status && book)
        status = as_pixels(&vectors, &index, list, codes);
    w.pixels = (size_t)vectors.width * (size_t)vectors.height;
    if (!status)
        status = refit_codes(refit, &w, &vectors, book);
    if (!status)
        status = take_grid(refit, &w.params);
    if (!status)
        log_line(w.params.log, RELUME_NOTE,
                 "converted to linear light for the environment; error %.2g %%", 100 * refit->loss);
    mem_free(index);
    if (status)
        relume_refit_destroy(&refit);
    *out = refit;
    return status;
}
