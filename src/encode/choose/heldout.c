// heldout.c - cross-validation over lights: N / k folds, each one coder and its k unseen lights
//
// Coefficients of a fold are computed once for all pixels in memory; predictions of the lights left
// out follow chunk by chunk, as they are and as they come back from each way of storing them.
#include "encode/choose/heldout.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "format/coder/basis.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"
#include "image/compare/ssim.h"
#include "image/image/encoder.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SSIM_ROWS = 64 };

// What is summed over one image: coded and unrounded squared error, structure.
struct sums {
    double coded, shown;
    size_t samples;
    struct ssim_sum ssim;
};

// A view that is stored: its pixels begin at `first` in memory.
struct kept {
    relume_coefficients as;
    size_t first;
};

struct request {
    const struct relume_basis *basis;
    struct relume_coder_params coder;
    const struct relume_heldout_store *store;
    int stores;
    struct total *total;  // [1 + stores]
    struct encoder *display;
};

// A sentence of a coder that is made by another thread.
struct said {
    enum relume_level level;
    char text[400];
};

// What one fold learns. Coders of some folds are made side by side.
struct lesson {
    int *light;  // [all]: those to learn from, then those to be judged
    int judged;
    relume_coder *coder;
    struct captured unseen;
    float *share;  // [judged]: of light from outside the captured zone
    relume_status status;
    struct said said[4];
    int sentences;
};

struct fold {
    relume_heldout *h;
    relume_coder *coder;
    struct captured unseen;
    float *share;         // as the lesson's
    int learned, judged;  // lights; the judged ones lie in the places behind the learned ones
    size_t planes;
    size_t most_planes, most_judged;  // that the arrays below hold
    float *value;                     // [planes][pixels]
    struct range *band;               // [bands of all views][planes]
    float *scale, *offset;            // [views][planes]
    struct kept *kept;                // [views]
    float *work;                      // [workers][work_size]
    size_t work_size;
    const struct relume_heldout_store *store;  // NULL: as they are
    struct fold_books books;
    struct encoder *display;
    float *luma;        // [judged][pixels], predicted
    struct sums *part;  // [chunks][judged]
    double *scratch;    // [workers][ssim_scratch]
};

// ---------------------------------------------------------------- lights change places

static void swap_places(relume_heldout *h, int a, int b)
{
    const size_t n = 3 * h->pixels;
    float *x = h->samples + (size_t)a * n, *y = h->samples + (size_t)b * n;
    const int light = h->light_at[a];
    h->light_at[a] = h->light_at[b];
    h->light_at[b] = light;
    for (size_t i = 0; i < n; i++) {
        const float v = x[i];
        x[i] = y[i];
        y[i] = v;
    }
}

static void bring(relume_heldout *h, int place, int light)
{
    int at = place;
    while (h->light_at[at] != light)
        at++;
    if (at != place)
        swap_places(h, place, at);
}

// The lights of a fold in the order of their places: first those to learn from, in the order of the
// capture, then `fold`, `fold` + folds, ... Returns how many are left out.
static int order_lights(const relume_heldout *h, int fold, int *light)
{
    const int folds = h->info.folds;
    int place = 0;
    for (int i = 0; i < h->all; i++)
        if (h->params.test || i % folds != fold)
            light[place++] = i;
    for (int i = fold; !h->params.test && i < h->lights; i += folds)
        light[place++] = i;
    return h->params.test ? h->all - h->lights : (h->lights - fold + folds - 1) / folds;
}

// ---------------------------------------------------------------- coders

// The functions at the lights left out, as relighting takes them: from the zone that was captured.
static relume_status find_unseen(struct lesson *l, struct relume_vec3 *direction)
{
    l->share = mem_array((size_t)l->judged, sizeof *l->share);
    for (int i = 0; l->share && i < l->judged; i++) {
        struct relume_vec3 from;
        l->share[i] = (float)relume_coder_clamp(&from, l->coder, direction[i]);
        direction[i] = from;
    }
    return l->share ? captured_create(&l->unseen, l->coder, direction, l->judged) : RELUME_ENOMEM;
}

static void hear(void *user, enum relume_level level, const char *text)
{
    struct lesson *l = user;
    if (l->sentences == (int)(sizeof l->said / sizeof *l->said))
        return;
    struct said *s = &l->said[l->sentences++];
    s->level = level;
    snprintf(s->text, sizeof s->text, "%s", text);
}

static relume_status learn_fold(struct lesson *l, const relume_heldout *h, const struct request *r)
{
    const int learned = h->all - l->judged;
    const struct relume_log log = {hear, NULL, l, r->coder.log ? r->coder.log->context : NULL,
                                   false};
    const bool learns = r->basis->learned || r->coder.choose;
    struct relume_sample_sums sums = {0};
    const struct relume_samples samples = {
        .lights = learned, .pixels = h->learning.pixels, .sums = &sums};
    struct relume_vec3 *directions = mem_array((size_t)h->all, sizeof *directions);
    relume_status status = directions ? RELUME_OK : RELUME_ENOMEM;
    if (!status && learns)
        status = sample_sums_pick(&sums, &h->sums, l->light, learned);
    if (!status) {
        struct relume_coder_params p = r->coder;
        for (int i = 0; i < h->all; i++)
            directions[i] = h->directions[l->light[i]];
        p.log = &log;
        p.hemispherical = h->hemispherical;
        p.pole_y = h->pole_y;
        p.threads = 1;
        p.samples = learns ? &samples : NULL;
        status = relume_coder_create(&l->coder, r->basis, directions, learned, &p);
    }
    if (!status)
        status = find_unseen(l, directions + learned);
    sample_sums_free(&sums);
    mem_free(directions);
    return status;
}

struct lessons {
    relume_heldout *h;
    const struct request *r;
    int first;  // fold
    struct lesson *lesson;
};

static void take_lesson(void *context, size_t item, int worker)
{
    (void)worker;
    const struct lessons *s = context;
    struct lesson *l = &s->lesson[item];
    l->light = mem_array((size_t)s->h->all, sizeof *l->light);
    l->status = RELUME_ENOMEM;
    if (!l->light)
        return;
    l->judged = order_lights(s->h, s->first + (int)item, l->light);
    l->status = learn_fold(l, s->h, s->r);
}

static relume_status say_lesson(const struct lesson *l, const struct relume_log *log)
{
    for (int i = 0; log && log->message && i < l->sentences; i++)
        log->message(log->user, l->said[i].level, l->said[i].text);
    return l->status;
}

static void drop_lesson(struct lesson *l)
{
    relume_coder_destroy(&l->coder);
    captured_destroy(&l->unseen);
    mem_free(l->share);
    mem_free(l->light);
}

static void free_arrays(struct fold *f)
{
    mem_free(f->value);
    mem_free(f->band);
    mem_free(f->kept);
    mem_free(f->scale);
    mem_free(f->offset);
    mem_free(f->work);
    mem_free(f->luma);
    mem_free(f->part);
    mem_free(f->scratch);
}

static size_t count_bands(const relume_heldout *h)
{
    size_t bands = 0, first;
    for (int v = 0; v < h->views; v++)
        bands += (size_t)(heldout_rows(h, v, &first) + BAND_ROWS - 1) / BAND_ROWS;
    return bands;
}

// Folds are about equally large: what one has used serves the next.
static relume_status grow_arrays(struct fold *f)
{
    const relume_heldout *h = f->h;
    const size_t workers = (size_t)thread_count(h->params.threads), chunks = (size_t)h->chunks;
    f->planes = (size_t)relume_coder_info(f->coder)->planes;
    if (f->planes <= f->most_planes && (size_t)f->judged <= f->most_judged)
        return RELUME_OK;
    const size_t planes = f->planes > f->most_planes ? f->planes : f->most_planes;
    const size_t judged = (size_t)f->judged > f->most_judged ? (size_t)f->judged : f->most_judged;
    const size_t predict = (planes + judged) * CODER_CHUNK;
    const size_t apply = 3 * (size_t)h->all * CODER_CHUNK;
    free_arrays(f);
    f->work_size = predict > apply ? predict : apply;
    f->value = mem_array(planes, h->pixels * sizeof *f->value);
    f->band = mem_array(count_bands(h) * planes, sizeof *f->band);
    f->kept = mem_zeroed((size_t)h->views, sizeof *f->kept);
    f->scale = mem_array((size_t)h->views * planes, sizeof *f->scale);
    f->offset = mem_array((size_t)h->views * planes, sizeof *f->offset);
    f->work = mem_array(workers * f->work_size, sizeof *f->work);
    f->luma = mem_array(judged, h->pixels * sizeof *f->luma);
    f->part = mem_array(chunks * judged, sizeof *f->part);
    f->scratch = mem_array(workers * ssim_scratch(h->width), sizeof *f->scratch);
    f->most_planes = planes;
    f->most_judged = judged;
    return f->value && f->band && f->kept && f->scale && f->offset && f->work && f->luma &&
                   f->part && f->scratch
               ? RELUME_OK
               : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- coefficients and their codes

static void find_coefficients(void *context, size_t item, int worker)
{
    struct fold *f = context;
    const relume_heldout *h = f->h;
    const struct chunk c = h->chunk[item];
    coder_apply(f->coder, h->samples + 3 * c.first, 3 * h->pixels, c.n, f->value + c.first,
                h->pixels, f->work + (size_t)worker * f->work_size);
    for (size_t p = 0; p < f->planes; p++) {
        float *v = f->value + p * h->pixels + c.first;
        for (size_t i = 0; h->mask && i < c.n; i++)
            v[i] = h->mask[c.first + i] > 0.5f ? v[i] : 0.0f;
    }
}

// The ranges of the bands of a view, and of all of it.
static void find_ranges(struct fold *f, struct kept *k, struct range *total)
{
    const size_t width = (size_t)f->h->width;
    for (size_t p = 0; p < f->planes; p++) {
        const float *v = f->value + p * f->h->pixels + k->first;
        total[p] = (struct range){FLT_MAX, -FLT_MAX};
        for (int row = 0; row < k->as.info.height; row += BAND_ROWS) {
            const int left = k->as.info.height - row;
            const size_t rows = (size_t)(left < BAND_ROWS ? left : BAND_ROWS);
            const struct range r = range_settle(range_of(v + (size_t)row * width, rows * width));
            k->as.band[(size_t)(row / BAND_ROWS) * f->planes + p] = r;
            total[p] = range_join(total[p], r);
        }
    }
}

// Views as an encoder would keep them.
static relume_status choose_steps(struct fold *f)
{
    const relume_heldout *h = f->h;
    const enum relume_storage storage = f->store->storage;
    struct range *total = mem_array(f->planes, sizeof *total), *band = f->band;
    for (int view = 0; total && view < h->views; view++) {
        struct kept *k = &f->kept[view];
        k->as = (relume_coefficients){
            .info = {.coder = f->coder,
                     .width = h->width,
                     .height = heldout_rows(h, view, &k->first),
                     .planes = (int)f->planes,
                     .storage = storage == RELUME_STORE_LOG ? RELUME_STORE_HALF : storage},
            .scale = f->scale + (size_t)view * f->planes,
            .offset = f->offset + (size_t)view * f->planes,
            .band = band,
            .coarse = storage == RELUME_STORE_LOG,
        };
        band += (size_t)((k->as.info.height + BAND_ROWS - 1) / BAND_ROWS) * f->planes;
        find_ranges(f, k, total);
        coefficients_choose_steps(&k->as, total, h->masked[view], f->store->step);
    }
    mem_free(total);
    return total ? RELUME_OK : RELUME_ENOMEM;
}

// Coefficients as a reader of the file finds them.
static void store_and_restore(const struct fold *f, struct chunk c, float *to)
{
    const struct kept *k = &f->kept[c.view];
    const size_t width = (size_t)f->h->width, band = BAND_ROWS * width, from = c.first - k->first;
    for (size_t at = 0, n; at < c.n; at += n) {
        const size_t left = band - (from + at) % band;
        const int row = (int)((from + at) / width);
        n = left < c.n - at ? left : c.n - at;
        for (size_t p = 0; p < f->planes; p++)
            coefficients_restore(&k->as, (int)p, row, f->value + p * f->h->pixels + c.first + at, n,
                                 to + p * c.n + at);
    }
}

// ---------------------------------------------------------------- predictions

static void dim_row(const relume_heldout *h, float *row, size_t n, float share)
{
    for (size_t i = 0; share < 1.0f && i < n; i++)
        row[i] = relume_transfer_encode(h->curve, share * relume_transfer_decode(h->curve, row[i]));
}

static void compare_row(const struct fold *f, struct chunk c, int place, int channel, float *row,
                        struct sums *s)
{
    const relume_heldout *h = f->h;
    const size_t light = (size_t)h->light_at[place];
    const uint8_t *code = h->codes + (light * h->pixels + c.first) * 3 + channel;
    const float *sample = h->samples + ((size_t)place * h->pixels + c.first) * 3 + channel;
    const float *mask = h->mask ? h->mask + c.first : NULL;
    float shown[CODER_CHUNK];
    for (size_t i = 0; i < c.n; i++)
        shown[i] = sample[3 * i];
    heldout_show(h, f->display, light, row, row, c.n);
    heldout_show(h, f->display, light, shown, shown, c.n);
    double coded = 0.0, unrounded = 0.0;
    for (size_t i = 0; i < c.n; i++) {
        const bool inside = !mask || mask[i] > 0.5f;
        row[i] = inside ? encoder_clip(row[i]) : 0.0f;
        const int d = encoder_code(row[i]) - code[3 * i];
        const double e = (double)row[i] - (double)encoder_clip(shown[i]);
        coded += inside ? (double)(d * d) : 0.0;
        unrounded += inside ? e * e : 0.0;
        s->samples += inside;
    }
    s->coded += coded;
    s->shown += unrounded;
}

static void judge_chunk(void *context, size_t item, int worker)
{
    static const float luma[3] = {0.299f, 0.587f, 0.114f};
    struct fold *f = context;
    const relume_heldout *h = f->h;
    const struct chunk c = h->chunk[item];
    float *work = f->work + (size_t)worker * f->work_size;
    float *predicted = work + f->planes * c.n;
    const float *planes = f->value + c.first;
    size_t stride = h->pixels;
    if (f->store) {
        if (f->store->books)
            fold_books_restore(&f->books, c.view, c.first, c.n, work);
        else
            store_and_restore(f, c, work);
        planes = work;
        stride = c.n;
    }
    struct sums *part = f->part + item * (size_t)f->judged;
    memset(part, 0, (size_t)f->judged * sizeof *part);
    for (int channel = 0; channel < 3; channel++) {
        captured_predict(&f->unseen, f->coder, channel, planes, stride, c.n, predicted);
        for (int i = 0; i < f->judged; i++) {
            float *row = predicted + (size_t)i * c.n;
            float *grey = f->luma + (size_t)i * h->pixels + c.first;
            dim_row(h, row, c.n, f->share[i]);
            compare_row(f, c, f->learned + i, channel, row, &part[i]);
            for (size_t x = 0; x < c.n; x++)
                grey[x] = (channel ? grey[x] : 0.0f) + luma[channel] * row[x];
        }
    }
}

// ---------------------------------------------------------------- structure

struct structure {
    const struct fold *f;
    int parts;             // of SSIM_ROWS rows, in every strip
    struct ssim_sum *sum;  // [judged][strips][parts]
};

static void compare_structure(void *context, size_t item, int worker)
{
    struct structure *t = context;
    const struct fold *f = t->f;
    const relume_heldout *h = f->h;
    const int part = (int)(item % (size_t)t->parts);
    const size_t rest = item / (size_t)t->parts;
    const struct strip *s = &h->strip[rest % (size_t)h->strips];
    const size_t judged = rest / (size_t)h->strips;
    const size_t light = (size_t)h->light_at[(size_t)f->learned + judged];
    t->sum[item] =
        ssim_rows(f->luma + judged * h->pixels + s->first, h->luma + light * h->pixels + s->first,
                  h->mask ? h->mask + s->first : NULL, h->width, s->rows, part * SSIM_ROWS,
                  (part + 1) * SSIM_ROWS, f->scratch + (size_t)worker * ssim_scratch(h->width));
}

static relume_status add_structure(const struct fold *f, struct sums *image)
{
    const relume_heldout *h = f->h;
    struct structure t = {.f = f, .parts = (h->height + SSIM_ROWS - 1) / SSIM_ROWS};
    const size_t items = (size_t)f->judged * (size_t)h->strips * (size_t)t.parts;
    t.sum = mem_array(items, sizeof *t.sum);
    if (!t.sum)
        return RELUME_ENOMEM;
    thread_for(h->params.threads, items, compare_structure, &t);
    for (size_t i = 0; i < items; i++) {
        const size_t strip = i / (size_t)t.parts % (size_t)h->strips;
        const size_t judged = i / (size_t)t.parts / (size_t)h->strips;
        struct sums *s = &image[(size_t)h->strip[strip].view * (size_t)f->judged + judged];
        s->ssim.sum += t.sum[i].sum;
        s->ssim.windows += t.sum[i].windows;
    }
    mem_free(t.sum);
    return RELUME_OK;
}

// ---------------------------------------------------------------- the whole

// Sums over all images of all folds, for one way of storing.
struct total {
    double psnr, shown, ssim;
    size_t images, samples, structured;
};

static void add_image(struct total *t, const struct sums *s)
{
    if (s->samples == 0)
        return;
    t->psnr += decibels(s->coded / (255.0 * 255.0) / (double)s->samples);
    t->shown += s->shown;
    t->samples += s->samples;
    t->images++;
    if (s->ssim.windows) {
        t->ssim += s->ssim.sum / (double)s->ssim.windows;
        t->structured++;
    }
}

static relume_status judge(struct fold *f, struct total *total)
{
    const relume_heldout *h = f->h;
    const size_t judged = (size_t)f->judged, images = (size_t)h->views * judged;
    struct sums *image = mem_zeroed(images, sizeof *image);
    if (!image)
        return RELUME_ENOMEM;
    relume_status status = RELUME_OK;
    if (f->store && f->store->books)
        status = fold_books_make(&f->books, h, f->coder, f->value, f->store);
    else if (f->store)
        status = choose_steps(f);
    if (!status) {
        thread_for(h->params.threads, (size_t)h->chunks, judge_chunk, f);
        for (size_t i = 0; i < (size_t)h->chunks * judged; i++) {
            struct sums *s = &image[(size_t)h->chunk[i / judged].view * judged + i % judged];
            s->coded += f->part[i].coded;
            s->shown += f->part[i].shown;
            s->samples += f->part[i].samples;
        }
        status = add_structure(f, image);
    }
    for (size_t i = 0; !status && i < images; i++)
        add_image(total, &image[i]);
    fold_books_drop(&f->books);
    mem_free(image);
    return status;
}

// Samples of the lights to learn from must lie side by side. From fold to fold few change places.
static relume_status measure_fold(struct fold *f, const struct lesson *l, const struct request *r)
{
    relume_heldout *h = f->h;
    relume_status status = say_lesson(l, r->coder.log);
    if (status)
        return status;
    for (int place = 0; place < h->all; place++)
        bring(h, place, l->light[place]);
    f->judged = l->judged;
    f->learned = h->all - l->judged;
    f->coder = l->coder;
    f->unseen = l->unseen;
    f->share = l->share;
    status = grow_arrays(f);
    if (!status)
        thread_for(h->params.threads, (size_t)h->chunks, find_coefficients, f);
    for (int i = -1; !status && i < r->stores; i++) {
        f->store = i < 0 ? NULL : &r->store[i];
        status = judge(f, &r->total[i + 1]);
    }
    return status;
}

// As many coders are made at once as there are threads.
static relume_status measure_folds(relume_heldout *h, const struct request *r)
{
    const int together = thread_count(h->params.threads), folds = h->info.folds;
    struct fold f = {.h = h, .display = r->display};
    relume_status status = RELUME_OK;
    for (int first = 0, n; !status && first < folds; first += n) {
        n = folds - first < together ? folds - first : together;
        struct lessons all = {h, r, first, mem_zeroed((size_t)n, sizeof *all.lesson)};
        if (!all.lesson)
            status = RELUME_ENOMEM;
        else
            thread_for(h->params.threads, (size_t)n, take_lesson, &all);
        for (int i = 0; !status && i < n; i++) {
            status = measure_fold(&f, &all.lesson[i], r);
            if (!status && !log_progress(r->coder.log, "judging", (first + i + 1.0) / folds))
                status = RELUME_ECANCEL;
        }
        for (int i = 0; all.lesson && i < n; i++)
            drop_lesson(&all.lesson[i]);
        mem_free(all.lesson);
    }
    free_arrays(&f);
    return status;
}

// Samples are read once, and what is learnt from them is added up once, for all coders.
static relume_status learn(relume_heldout *h, bool learned)
{
    relume_status status = RELUME_OK;
    struct relume_log quiet = h->params.log ? *h->params.log : (struct relume_log){0};
    quiet.progress = NULL;  // the caller's is that of all coders
    if (!h->learning.data)
        status = relume_samples_read(
            &h->learning, h->capture, 0,
            relume_project_params(.log = h->params.log ? &quiet : NULL, .domain = h->info.domain,
                                  .display = h->params.display, .threads = h->params.threads));
    return status ? status : sample_sums_make(&h->sums, &h->learning, learned, h->params.threads);
}

static struct relume_heldout_quality quality_of(const struct total *t)
{
    const double none = (double)NAN;
    return (struct relume_heldout_quality){
        .psnr_db = t->images ? t->psnr / (double)t->images : none,
        .psnr_pooled_db = t->samples ? decibels(t->shown / (double)t->samples) : none,
        .ssim = t->structured ? t->ssim / (double)t->structured : none,
    };
}

static struct relume_heldout_store *copy_stores(const struct relume_heldout_store *store, int n)
{
    struct relume_heldout_store *s = mem_array((size_t)n, sizeof *s);
    for (int i = 0; s && i < n; i++) {
        s[i] = store[i];
        if (s[i].storage == RELUME_STORE_DEFAULT)
            s[i].storage = RELUME_STORE_8;
    }
    return s;
}

relume_status relume_heldout_measure(relume_heldout *heldout, const struct relume_basis *basis,
                                     const struct relume_coder_params *coder,
                                     const struct relume_heldout_store *store, int n,
                                     struct relume_heldout_quality *before,
                                     struct relume_heldout_quality *after)
{
    struct request r = {.basis = basis, .stores = n};
    if (coder)
        r.coder = *coder;
    struct relume_heldout_store *stores = copy_stores(store, n);
    r.store = stores;
    r.total = mem_zeroed((size_t)n + 1, sizeof *r.total);
    r.display = mem_array(1, sizeof *r.display);
    relume_status status = stores && r.total && r.display ? RELUME_OK : RELUME_ENOMEM;
    if (!status && (basis->learned || r.coder.choose))
        status = learn(heldout, basis->joint);
    if (!status) {
        heldout_encoder(r.display, heldout);
        status = measure_folds(heldout, &r);
    }
    if (!status)
        *before = quality_of(&r.total[0]);
    for (int i = 0; !status && i < n; i++)
        after[i] = quality_of(&r.total[i + 1]);
    mem_free(stores);
    mem_free(r.total);
    mem_free(r.display);
    return status;
}

// ---------------------------------------------------------------- opening

void relume_heldout_destroy(relume_heldout **heldout)
{
    relume_heldout *h = *heldout;
    *heldout = NULL;
    if (!h)
        return;
    relume_samples_destroy(&h->learning);
    sample_sums_free(&h->sums);
    mem_free(h->directions);
    mem_free(h->light_at);
    mem_free(h->samples);
    mem_free(h->codes);
    mem_free(h->gain);
    mem_free(h->luma);
    mem_free(h->mask);
    mem_free(h->masked);
    mem_free(h->strip);
    mem_free(h->chunk);
    mem_free(h);
}

static relume_status check_test(const relume_heldout *h)
{
    const relume_capture *t = h->params.test;
    const struct relume_manifest *ours = relume_capture_manifest(h->capture);
    const struct relume_manifest *theirs = relume_capture_manifest(t);
    if (relume_capture_width(t) != h->width || relume_capture_height(t) != h->height)
        return log_fail(h->params.log, RELUME_EUNFIT,
                        "the second capture has %d x %d pixels; expected %d x %d as the first",
                        relume_capture_width(t), relume_capture_height(t), h->width, h->height);
    if (theirs->views != h->views || theirs->geometry.projection != ours->geometry.projection)
        return log_fail(h->params.log, RELUME_EUNFIT,
                        "the second capture has %d %s views; expected %d %s ones as the first",
                        theirs->views, relume_projection_name(theirs->geometry.projection),
                        h->views, relume_projection_name(ours->geometry.projection));
    return RELUME_OK;
}

static relume_status describe(relume_heldout *h)
{
    const struct relume_manifest *m = relume_capture_manifest(h->capture);
    const int k = h->params.leave_out > 0 ? h->params.leave_out : 1;
    const struct relume_manifest *t = NULL;
    h->lights = m->lights;
    h->width = relume_capture_width(h->capture);
    h->height = relume_capture_height(h->capture);
    h->views = m->views;
    h->hemispherical = relume_capture_hemispherical(h->capture);
    h->pole_y = relume_capture_pole_y(h->capture);
    h->screen = relume_encode_display(h->capture);
    h->info.domain = relume_capture_domain(h->capture, h->params.domain);
    h->curve = (struct relume_transfer){.curve = RELUME_CURVE_LINEAR};
    if (h->info.domain != RELUME_DOMAIN_LINEAR)
        h->curve = relume_encode_curve(h->capture, h->params.display);
    if (h->params.tone_mapped)
        h->screen = (struct relume_transfer){.curve = RELUME_CURVE_GAMMA, .gamma = 2.2f};
    h->shown = !h->params.tone_mapped && h->curve.curve != RELUME_CURVE_LINEAR &&
               h->curve.curve != RELUME_CURVE_LOG;
    h->info.lights = m->lights;
    h->info.all_pixels = (size_t)h->views * (size_t)h->width * (size_t)h->height;
    if (h->params.test) {
        const relume_status status = check_test(h);
        if (status)
            return status;
        t = relume_capture_manifest(h->params.test);
        h->info.folds = 1;
        h->info.fewest = m->lights;
        h->info.judged = t->lights;
    } else {
        if (k >= m->lights)
            return log_fail(
                h->params.log, RELUME_EINVAL,
                "leaving out %d light%s leaves none; expected fewer than the %d photographed", k,
                relume_plural(k), m->lights);
        h->info.folds = (m->lights + k - 1) / k;
        h->info.fewest = m->lights - (m->lights + h->info.folds - 1) / h->info.folds;
        h->info.judged = m->lights;
    }
    h->all = m->lights + (t ? t->lights : 0);
    h->directions = mem_array((size_t)h->all, sizeof *h->directions);
    h->light_at = mem_array((size_t)h->all, sizeof *h->light_at);
    if (!h->directions || !h->light_at)
        return RELUME_ENOMEM;
    for (int i = 0; i < h->all; i++) {
        h->directions[i] = i < m->lights ? m->directions[i] : t->directions[i - m->lights];
        h->light_at[i] = i;
    }
    return RELUME_OK;
}

relume_status relume_heldout_open(relume_heldout **out, const relume_capture *capture,
                                  const struct relume_heldout_params *params)
{
    *out = NULL;
    relume_heldout *h = mem_zeroed(1, sizeof *h);
    if (!h)
        return RELUME_ENOMEM;
    h->params = PARAMS_WORK(relume_heldout_params, params);
    h->capture = capture;
    relume_status status = describe(h);
    if (!status)
        status = heldout_load(h);
    if (status)
        relume_heldout_destroy(&h);
    *out = h;
    return status;
}

const struct relume_heldout_info *relume_heldout_info(const relume_heldout *heldout)
{
    return &heldout->info;
}
