// relight.c - superposition (Wong 1998, Eq. 7.6): the value of a pixel is the sum over lights of
// reflectance x radiance. In the linear domain the sum over lights moves inside the dot product:
//     sum_i E_i sum_k c_k b_k(L_i) = sum_k c_k w_k     with w_k = sum_i E_i b_k(L_i),
// so any number of lights costs one loop over the codes. In the display domain each light is
// decoded on its own, made linear, then added.
#include <relume/relight/relight.h>

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/kernel/kernels.h"
#include "core/math/luminance.h"
#include "core/math/vec.h"
#include "format/coder/coding.h"
#include "image/image/curve.h"
#include "image/image/rgba8.h"
#include "relight/light/books.h"
#include "relight/light/grid.h"
#include "relight/light/near_lights.h"
#include "relight/light/refit.h"

#include <stdio.h>
#include <string.h>

// Pixels a worker takes at once: each plane is then read in runs of 8 kB, long enough for the CPU
// to fetch ahead, and the sums still fit the first-level cache.
enum { CHUNK = 8192 };

// One dot product per channel: quantiser steps and constants folded in.
struct product {
    float *weights;  // [3][coefficients]
    float bias[3];
    float rgb[3];  // display domain: colour of the light, applied after linearising
    float **book;  // [books] -> [codes][3]: with codebooks, what their vectors add
};

// Scratch memory of one worker.
struct scratch {
    float sum[3][CHUNK];       // by channel, so that the kernels write in a row
    float shown[CHUNK];        // one light, before it is made linear
    float part[CHUNK];         // a group of planes, or a colour
    float distant[3 * CHUNK];  // environments of the display domain
    float rgb[3 * CHUNK];      // what becomes 8 bits
    float near[];              // near_lights_scratch
};

struct job {
    const struct relume_codes *codes;
    const struct kernels *kernels;
    float *out;           // [pixels][3], or
    uint32_t *out_rgba8;  // [pixels]
    struct byte_coder *coder;
    uint32_t *words;  // [codes]: of a single codebook, coded for the screen
    struct product *products;
    int count;
    bool display;
    bool linear;  // products give linear light; else they are made linear, then added
    bool guard;   // environments are among what the products sum
    struct curve curve;
    const relume_weight_grid *grid;  // borrowed, or made
    relume_weight_grid *made;
    struct near_lights near;
    char *scratch;  // [workers] of scratch_size
    size_t scratch_size;
    // Display domain: environments are relit from linear codes of their own, ...
    struct job *distant;
    struct relume_light *lights;  // or, without those, every environment by the captured lights
};

static void fold_quantiser(struct product *product, const struct relume_codes *codes)
{
    const struct relume_coder_info *info = relume_coder_info(codes->coder);
    for (int c = 0; c < 3; c++) {
        double bias = (double)product->bias[c];
        for (int k = 0; k < info->coefficients; k++) {
            float *w = &product->weights[c * info->coefficients + k];
            const int p = relume_coder_plane(info, k, c);
            bias += (double)*w * (double)codes->offset[p];
            *w *= codes->scale[p];
        }
        product->bias[c] = (float)bias;
    }
}

// Linear domain: all lights into one product. `one` holds one light's weights.
static void add_light(struct product *product, const relume_coder *coder,
                      const struct relume_light *light, float *one)
{
    const int k = relume_coder_info(coder)->coefficients;
    float constant[3];
    vec3 from;
    const float share = (float)relume_coder_clamp(&from, coder, vec3_unit(light->direction));
    relume_coder_weights(coder, from, one, constant);
    for (int c = 0; c < 3; c++) {
        const float value = share * light->rgb[c];
        for (int i = 0; i < k; i++)
            product->weights[c * k + i] += value * one[c * k + i];
        product->bias[c] += value * constant[c];
    }
}

static int count_kind(const struct relume_light *lights, int n, enum relume_light_kind kind)
{
    int count = 0;
    for (int i = 0; i < n; i++)
        count += lights[i].kind == kind;
    return count;
}

// One directional light alone, its colour and share kept for later.
static void set_displayed(struct product *product, const relume_coder *coder,
                          const struct relume_light *light, float *one)
{
    struct relume_light white = {.rgb = {1.0f, 1.0f, 1.0f}};
    const float share =
        (float)relume_coder_clamp(&white.direction, coder, vec3_unit(light->direction));
    for (int c = 0; c < 3; c++)
        product->rgb[c] = share * light->rgb[c];
    add_light(product, coder, &white, one);
}

static void fill_products(struct job *job, const struct relume_light *lights, int n, float *one)
{
    const relume_coder *coder = job->codes->coder;
    for (int i = 0, next = 0; i < n; i++) {
        const enum relume_light_kind kind = lights[i].kind;
        struct product *product = job->products;
        if (kind == RELUME_LIGHT_ENVIRONMENT && !job->display)
            relume_environment_weights(product->weights, product->bias, job->grid, &lights[i]);
        if (kind != RELUME_LIGHT_DIRECTIONAL)
            continue;
        if (job->display)
            set_displayed(&product[next++], coder, &lights[i], one);
        else
            add_light(product, coder, &lights[i], one);
    }
}

// Display domain: a product for every directional light; a single codebook sums into the first.
static relume_status make_products(struct job *job, const struct relume_light *lights, int n)
{
    const size_t size = 3 * (size_t)relume_coder_info(job->codes->coder)->coefficients;
    const int directional = count_kind(lights, n, RELUME_LIGHT_DIRECTIONAL);
    const int least = job->display && job->codes->books != 1 ? 0 : 1;
    job->count = job->display && directional > least ? directional : least;
    job->products = mem_zeroed((size_t)job->count, sizeof *job->products);
    float *one = mem_array(size, sizeof *one);
    bool good = job->products && one;
    for (int i = 0; good && i < job->count; i++)
        good = (job->products[i].weights = mem_zeroed(size, sizeof(float))) != NULL;
    if (good)
        fill_products(job, lights, n, one);
    for (int i = 0; good && i < job->count; i++)
        if (!job->codes->books)
            fold_quantiser(&job->products[i], job->codes);
    mem_free(one);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

static bool relight_books(struct job *job, struct product *product)
{
    static const float nothing[3] = {0.0f, 0.0f, 0.0f};
    const struct relume_codes *codes = job->codes;
    product->book = mem_zeroed((size_t)codes->books, sizeof *product->book);
    for (int b = 0; product->book && b < codes->books; b++) {
        product->book[b] = mem_array((size_t)codes->book_codes[b], 3 * sizeof(float));
        if (!product->book[b])
            return false;
        book_relight(product->book[b], codes, b, product->weights, b ? nothing : product->bias);
    }
    return product->book != NULL;
}

// With one codebook all lights come together in its vectors, linear: one product is left.
static void sum_single_book(struct job *job)
{
    const size_t n = 3 * (size_t)job->codes->book_codes[0];
    for (int p = 0; p < job->count; p++) {
        const struct product *product = &job->products[p];
        for (size_t i = 0; i < n; i++) {
            const float v = product->rgb[i % 3] * curve_decode(&job->curve, product->book[0][i]);
            job->products[0].book[0][i] = v + (p ? job->products[0].book[0][i] : 0.0f);
        }
    }
    job->linear = true;
}

// What too few components leave below 0 under an environment gives up colour, then is black; its
// luminance stays.
static void keep_above_zero(float *rgb, size_t n)
{
    for (size_t i = 0; i < n; i++, rgb += 3) {
        const float least = fminf(rgb[0], fminf(rgb[1], rgb[2]));
        const float grey = luminance_709f(rgb);
        if (!(least < 0.0f))
            continue;
        for (int c = 0; c < 3; c++)
            rgb[c] = grey > 0.0f ? fmaxf(grey * (rgb[c] - least) / (grey - least), 0.0f) : 0.0f;
    }
}

static relume_status relight_vectors(struct job *job)
{
    for (int p = 0; p < job->count; p++)
        if (!relight_books(job, &job->products[p]))
            return RELUME_ENOMEM;
    if (job->guard && job->codes->books == 1)
        keep_above_zero(job->products[0].book[0], (size_t)job->codes->book_codes[0]);
    if (job->display && job->codes->books == 1)
        sum_single_book(job);
    return RELUME_OK;
}

enum { GROUP = 64 };  // planes handed to a kernel at once

static void dot_group(const struct job *job, float *out, size_t n, float bias,
                      const void *const *planes, const float *weights, int count)
{
    const void *p = planes;
    if (job->codes->storage == RELUME_STORE_8)
        job->kernels->dot->bytes(out, n, bias, p, weights, count);
    else if (job->codes->storage == RELUME_STORE_HALF)
        job->kernels->dot->halves(out, n, bias, p, weights, count);
    else if (job->codes->storage == RELUME_STORE_FLOAT)
        job->kernels->dot->floats(out, n, bias, p, weights, count);
    else
        job->kernels->dot->words(out, n, bias, p, weights, count);
}

// out *= the pixels' colour
static void multiply_colour(const struct job *job, int plane, size_t offset, size_t n, float *out,
                            float *colour)
{
    const void *from = (const char *)job->codes->plane[plane] + offset;
    dot_group(job, colour, n, job->codes->offset[plane], &from, &job->codes->scale[plane], 1);
    for (size_t i = 0; i < n; i++)
        out[i] *= colour[i];
}

static void dot_planes(const struct job *job, const struct product *product, int channel,
                       size_t first, size_t n, float *out, float *part)
{
    const struct relume_codes *codes = job->codes;
    const struct relume_coder_info *info = relume_coder_info(codes->coder);
    const size_t offset = first * relume_storage_bytes(codes->storage);
    const float *w = product->weights + channel * info->coefficients;
    const void *planes[GROUP];
    float weights[GROUP];
    int count = 0;
    bool begun = false;
    for (int k = 0; k < info->coefficients || !begun; k++) {
        const bool last = k + 1 >= info->coefficients;
        if (k < info->coefficients && w[k] != 0.0f) {  // interpolation leaves most lights out
            planes[count] =
                (const char *)codes->plane[relume_coder_plane(info, k, channel)] + offset;
            weights[count++] = w[k];
        }
        if (count < GROUP && !last)
            continue;
        dot_group(job, begun ? part : out, n, begun ? 0.0f : product->bias[channel], planes,
                  weights, count);
        for (size_t i = 0; begun && i < n; i++)
            out[i] += part[i];
        begun = true;
        count = 0;
    }
    if (info->luminance)
        multiply_colour(job, info->coefficients + channel, offset, n, out, part);
}

static void look_up_channel(const struct job *job, const struct product *product, size_t channel,
                            size_t first, size_t n, float *out)
{
    for (int b = 0; b < job->codes->books; b++) {
        const uint16_t *index = job->codes->index[b] + first;
        const float *add = product->book[b] + channel;
        for (size_t i = 0; i < n; i++)
            out[i] = (b ? out[i] : 0.0f) + add[3 * (size_t)index[i]];
    }
}

// What one pixel's coefficients say for a unit direction, in their own domain.
static void decode_pixel(double value[3], const struct relume_codes *codes, size_t pixel,
                         vec3 direction)
{
    const struct relume_coder_info *info = relume_coder_info(codes->coder);
    float weights[3 * RELUME_MOST_COEFFICIENTS], constant[3];
    relume_coder_weights(codes->coder, direction, weights, constant);
    for (int c = 0; c < 3; c++) {
        value[c] = (double)constant[c];
        for (int k = 0; k < info->coefficients; k++) {
            float coefficient;
            relume_codes_plane(codes, relume_coder_plane(info, k, c), pixel, 1, &coefficient);
            value[c] += (double)weights[c * info->coefficients + k] * (double)coefficient;
        }
        float colour = 1.0f;
        if (info->luminance)
            relume_codes_plane(codes, info->coefficients + c, pixel, 1, &colour);
        value[c] *= (double)colour;
    }
}

static void dot_channel(const struct job *job, const struct product *product, int channel,
                        size_t first, size_t n, float *out, float *part)
{
    if (job->codes->books)
        look_up_channel(job, product, (size_t)channel, first, n, out);
    else
        dot_planes(job, product, channel, first, n, out, part);
}

// Display domain: every light is decoded and made linear before it is added.
static void sum_displayed(const struct job *job, int channel, size_t first, size_t n,
                          struct scratch *scratch)
{
    float *sum = scratch->sum[channel], *codes = scratch->shown;
    memset(sum, 0, n * sizeof *sum);
    for (int p = 0; p < job->count; p++) {
        const struct product *product = &job->products[p];
        dot_channel(job, product, channel, first, n, codes, scratch->part);
        for (size_t i = 0; i < n; i++)
            sum[i] += product->rgb[channel] * curve_decode(&job->curve, codes[i]);
    }
}

static size_t chunk_size(const struct job *job, size_t first)
{
    const size_t pixels = (size_t)job->codes->width * (size_t)job->codes->height;
    return pixels - first < CHUNK ? pixels - first : CHUNK;
}

static void interleave(float *rgb, const struct scratch *scratch, size_t n)
{
    for (size_t i = 0; i < n; i++)
        for (size_t c = 0; c < 3; c++)
            rgb[3 * i + c] = scratch->sum[c][i];
}

static void relight_distant(const struct job *job, size_t first, size_t n, float *out,
                            struct scratch *scratch)
{
    for (int c = 0; c < 3; c++)
        dot_channel(job, &job->products[0], c, first, n, scratch->sum[c], scratch->part);
    interleave(scratch->distant, scratch, n);
    keep_above_zero(scratch->distant, n);
    for (size_t i = 0; i < 3 * n; i++)
        out[i] += scratch->distant[i];
}

// out[n][3]: linear values of the pixels from `first` on.
static void relight_pixels(const struct job *job, size_t first, size_t n, float *out,
                           struct scratch *scratch)
{
    for (int c = 0; c < 3; c++) {
        if (job->linear)
            dot_channel(job, &job->products[0], c, first, n, scratch->sum[c], scratch->part);
        else
            sum_displayed(job, c, first, n, scratch);
    }
    interleave(out, scratch, n);
    if (job->guard)
        keep_above_zero(out, n);
    if (job->near.count)
        near_lights_add(&job->near, first, n, out, scratch->near);
    if (job->distant)
        relight_distant(job->distant, first, n, out, scratch);
}

static struct scratch *scratch_of(const struct job *job, int worker)
{
    return (struct scratch *)(void *)(job->scratch + (size_t)worker * job->scratch_size);
}

static void relight_chunk(void *context, size_t item, int worker)
{
    const struct job *job = context;
    const size_t first = item * CHUNK;
    relight_pixels(job, first, chunk_size(job, first), job->out + first * 3,
                   scratch_of(job, worker));
}

static void relight_chunk_rgba8(void *context, size_t item, int worker)
{
    const struct job *job = context;
    const size_t first = item * CHUNK, n = chunk_size(job, first);
    struct scratch *scratch = scratch_of(job, worker);
    if (job->words) {
        job->kernels->look_up(job->out_rgba8 + first, n, job->codes->index[0] + first, job->words);
        return;
    }
    relight_pixels(job, first, n, scratch->rgb, scratch);
    byte_code(job->out_rgba8 + first, scratch->rgb, n, job->coder);
}

static bool is_below_horizon(const struct relume_coder_info *info, const struct relume_light *light)
{
    return info->hemispherical && light->kind == RELUME_LIGHT_DIRECTIONAL &&
           pole_from_world(vec3_unit(light->direction), info->pole_y).z < -1e-9;
}

static void warn_below_horizon(const struct relume_codes *codes, const struct relume_light *lights,
                               int n, const struct relume_log *log)
{
    const struct relume_coder_info *info = relume_coder_info(codes->coder);
    for (int i = 0; i < n; i++)
        if (is_below_horizon(info, &lights[i])) {
            log_line(log, RELUME_WARNING,
                     "light %d lies below the horizon, where nothing was photographed; light from "
                     "the horizon is shown instead",
                     i + 1);
            return;
        }
}

// Logged once for all lights, for the one that is farthest off; for one below the horizon, with
// that reason.
static void warn_beyond(const struct relume_codes *codes, const struct relume_light *lights, int n,
                        const struct relume_log *log)
{
    static const double little = 3.0;  // degrees that nobody sees
    double most = 0.0;
    int which = 0;
    for (int i = 0; i < n; i++) {
        if (lights[i].kind != RELUME_LIGHT_DIRECTIONAL ||
            is_below_horizon(relume_coder_info(codes->coder), &lights[i]))
            continue;
        vec3 d = vec3_unit(lights[i].direction), from;
        (void)relume_captured_region_clamp(&from, relume_coder_region(codes->coder), d);
        const double off = vec3_angle(from, d) * (180.0 / M_PI);
        which = off > most ? i : which;
        most = fmax(off, most);
    }
    if (most > little)
        log_line(log, RELUME_WARNING,
                 "light %d lies %.0f degrees outside the directions that were photographed; it is "
                 "shown from the nearest of them, dimmed",
                 which + 1, most);
}

static relume_status check_each(const struct relume_light *lights, int n,
                                const struct relume_log *log)
{
    for (int i = 0; i < n; i++) {
        char name[32];
        snprintf(name, sizeof name, "light %d", i + 1);
        const relume_status status = relume_light_check(&lights[i], name, log);
        if (status)
            return status;
    }
    return RELUME_OK;
}

// The first near light, -1 when there is none.
static int find_near(const struct relume_light *lights, int n)
{
    for (int i = 0; i < n; i++)
        if (relume_light_is_near(lights[i].kind))
            return i;
    return -1;
}

static relume_status check_lights(const struct relume_codes *codes,
                                  const struct relume_light *lights, int n,
                                  const struct relume_relight_params *p)
{
    const struct relume_image *s = p->surface;
    const relume_status status = check_each(lights, n, p->log);
    const int near = status ? -1 : find_near(lights, n);
    if (near < 0 ||
        (s && s->width == codes->width && s->height == codes->height && s->channels == 3))
        return status;
    return log_fail(
        p->log, RELUME_EINVAL,
        "light %d: a near light (%s) needs to know how far the surface is; expected depth",
        near + 1, relume_light_kind_name(lights[near].kind));
}

// ---------------------------------------------------------------- jobs

static relume_status find_grid(struct job *job, const struct relume_relight_params *p, bool sums)
{
    if (p->grid && relume_weight_grid_info(p->grid)->coder == job->codes->coder) {
        job->grid = p->grid;
        return RELUME_OK;
    }
    const relume_status status =
        relume_weight_grid_create(&job->made, job->codes->coder,
                                  relume_weight_grid_params(.sums = sums, .threads = p->threads));
    job->grid = job->made;
    return status;
}

static relume_status begin_near(struct job *job, const struct relume_light *lights, int n,
                                const struct relume_relight_params *p)
{
    job->near = (struct near_lights){.codes = job->codes,
                                     .grid = job->grid,
                                     .surface = p->surface,
                                     .display = job->display ? &job->curve : NULL,
                                     .log = p->log};
    return near_lights_create(&job->near, lights, n);
}

// Everything but environments of the display domain.
static relume_status begin_job(struct job *job, const struct relume_codes *codes,
                               const struct relume_light *lights, int n,
                               const struct relume_relight_params *p)
{
    *job = (struct job){
        .codes = codes,
        .kernels = kernels_choose(p->cpu_off),
        .display = codes->domain == RELUME_DOMAIN_DISPLAY,
        .linear = codes->domain != RELUME_DOMAIN_DISPLAY,
    };
    const bool near = p->surface && find_near(lights, n) >= 0;
    job->guard = job->linear && count_kind(lights, n, RELUME_LIGHT_ENVIRONMENT);
    relume_status status = near || job->guard ? find_grid(job, p, !near) : RELUME_OK;
    if (!status)
        status = make_products(job, lights, n);
    if (!status && job->display)
        curve_init(&job->curve, codes->display);
    if (!status && codes->books)
        status = relight_vectors(job);
    if (!status && near)
        status = begin_near(job, lights, n, p);
    return status;
}

static void end_products(struct job *job)
{
    for (int i = 0; job->products && i < job->count; i++) {
        for (int b = 0; job->products[i].book && b < job->codes->books; b++)
            mem_free(job->products[i].book[b]);
        mem_free(job->products[i].book);
        mem_free(job->products[i].weights);
    }
    mem_free(job->products);
}

static void end_distant(struct job *job)
{
    if (!job->distant)
        return;
    end_products(job->distant);
    relume_weight_grid_destroy(&job->distant->made);
    mem_free(job->distant);
    job->distant = NULL;
}

static void end_job(struct job *job)
{
    end_distant(job);
    end_products(job);
    near_lights_destroy(&job->near);
    relume_weight_grid_destroy(&job->made);
    mem_free(job->lights);
    mem_free(job->coder);
    mem_free(job->words);
    mem_free(job->scratch);
}

// What the vectors of a single codebook have of the environments joins their table.
static void join_single_book(struct job *job)
{
    const size_t n = 3 * (size_t)job->codes->book_codes[0];
    for (size_t i = 0; i < n; i++)
        job->products[0].book[0][i] += job->distant->products[0].book[0][i];
    end_distant(job);
}

static relume_status begin_distant(struct job *job, const struct relume_light *lights, int n,
                                   const struct relume_relight_params *p)
{
    const int count = job->display ? count_kind(lights, n, RELUME_LIGHT_ENVIRONMENT) : 0;
    if (!count)
        return RELUME_OK;
    struct relume_relight_params own = {.cpu_off = p->cpu_off, .threads = p->threads};
    struct relume_light *environments = mem_array((size_t)count, sizeof *environments);
    job->distant = mem_zeroed(1, sizeof *job->distant);
    relume_status status = environments && job->distant ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0, next = 0; !status && i < n; i++)
        if (lights[i].kind == RELUME_LIGHT_ENVIRONMENT)
            environments[next++] = lights[i];
    if (!status) {
        own.grid = refit_grid(p->refit);
        status = begin_job(job->distant, relume_refit_codes(p->refit), environments, count, &own);
    }
    mem_free(environments);
    if (!status && job->codes->books == 1)
        join_single_book(job);
    return status;
}

// Display domain without a refit: the lights, each environment as the lights of the capture, which
// see it as they would a table of photographs.
static relume_status spread_environments(struct relume_light **out, int *count,
                                         const struct relume_codes *codes,
                                         const struct relume_light *lights, int n, int threads)
{
    const int captured = relume_coder_info(codes->coder)->lights;
    const int maps = count_kind(lights, n, RELUME_LIGHT_ENVIRONMENT);
    struct relume_light *all = mem_array((size_t)n + (size_t)maps * (size_t)captured, sizeof *all);
    relume_status status = all ? RELUME_OK : RELUME_ENOMEM;
    *out = all;
    *count = 0;
    for (int i = 0; !status && i < n; i++)
        if (lights[i].kind != RELUME_LIGHT_ENVIRONMENT)
            all[(*count)++] = lights[i];
        else
            status = environment_on_lights(all, count, codes->coder, &lights[i], threads);
    return status;
}

// Codes under one light may be below 0 already, and so may be their sum.
static void guard_spread(struct job *job)
{
    job->guard = true;
    if (job->codes->books == 1)
        keep_above_zero(job->products[0].book[0], (size_t)job->codes->book_codes[0]);
}

static relume_status begin_all(struct job *job, const struct relume_codes *codes,
                               const struct relume_light *lights, int n,
                               const struct relume_relight_params *p)
{
    struct relume_light *spread = NULL;
    relume_status status = RELUME_OK;
    if (codes->domain == RELUME_DOMAIN_DISPLAY && !p->refit &&
        count_kind(lights, n, RELUME_LIGHT_ENVIRONMENT)) {
        status = spread_environments(&spread, &n, codes, lights, n, p->threads);
        lights = spread;
    }
    if (!status)
        status = begin_job(job, codes, lights, n, p);
    job->lights = spread;  // near lights go on looking at them
    if (spread && !status)
        guard_spread(job);
    return status ? status : begin_distant(job, lights, n, p);
}

static relume_status run_job(struct job *job, int threads, void (*chunk)(void *, size_t, int))
{
    const size_t pixels = (size_t)job->codes->width * (size_t)job->codes->height;
    const size_t chunks = (pixels + CHUNK - 1) / CHUNK, most = (size_t)thread_count(threads);
    job->scratch_size = sizeof(struct scratch) + near_lights_scratch(&job->near) * sizeof(float);
    job->scratch = mem_array(most < chunks ? most : chunks, job->scratch_size);
    if (!job->scratch)
        return RELUME_ENOMEM;
    thread_for(threads, chunks, chunk, job);
    return RELUME_OK;
}

// As begin_all, for what is shown: lights are checked, those without reflectance warned about.
static relume_status start_job(struct job *job, const struct relume_codes *codes,
                               const struct relume_light *lights, int n,
                               const struct relume_relight_params *p)
{
    *job = (struct job){.codes = codes};
    const relume_status status = n < 0 ? RELUME_EINVAL : check_lights(codes, lights, n, p);
    if (status)
        return status;
    warn_below_horizon(codes, lights, n, p->log);
    warn_beyond(codes, lights, n, p->log);
    return begin_all(job, codes, lights, n, p);
}

static relume_status open_output(struct relume_image *out, const struct relume_codes *codes)
{
    if (!out->data)
        return relume_image_create(out, codes->width, codes->height, 3);
    const bool fits =
        out->width == codes->width && out->height == codes->height && out->channels == 3;
    return fits ? RELUME_OK : RELUME_EINVAL;
}

relume_status relume_relight(struct relume_image *out, const struct relume_codes *codes,
                             const struct relume_light *lights, int n,
                             const struct relume_relight_params *params)
{
    const struct relume_relight_params p = PARAMS_WORK(relume_relight_params, params);
    struct job job;
    relume_status status = start_job(&job, codes, lights, n, &p);
    if (!status)
        status = open_output(out, codes);
    job.out = out->data;
    if (!status)
        status = run_job(&job, p.threads, relight_chunk);
    end_job(&job);
    return status;
}

// Everything that a pixel of a single codebook can become, ready to be copied.
static relume_status code_vectors(struct job *job)
{
    const size_t n = (size_t)job->codes->book_codes[0];
    job->words = mem_array(n, sizeof *job->words);
    if (!job->words)
        return RELUME_ENOMEM;
    byte_code(job->words, job->products[0].book[0], n, job->coder);
    return RELUME_OK;
}

relume_status relume_relight_rgba8(uint8_t *out, const struct relume_codes *codes,
                                   const struct relume_light *lights, int n,
                                   const struct relume_relight_params *params)
{
    const struct relume_relight_params p = PARAMS_WORK(relume_relight_params, params);
    struct job job;
    relume_status status = start_job(&job, codes, lights, n, &p);
    job.out_rgba8 = (uint32_t *)(void *)out;
    if (!status && !(job.coder = mem_array(1, sizeof *job.coder)))
        status = RELUME_ENOMEM;
    if (!status) {
        byte_coder_init(job.coder, exp2f(p.exposure_ev));
        if (codes->books == 1 && job.linear && !job.near.count)
            status = code_vectors(&job);
    }
    if (!status)
        status = run_job(&job, p.threads, relight_chunk_rgba8);
    end_job(&job);
    return status;
}

relume_status relume_relight_book(float *rgb, const struct relume_codes *codes, int book,
                                  const struct relume_light *lights, int n,
                                  const struct relume_relight_params *params)
{
    struct relume_relight_params p = PARAMS_WORK(relume_relight_params, params);
    struct job job;
    if (n < 0 || book < 0 || book >= codes->books || check_each(lights, n, p.log))
        return RELUME_EINVAL;
    if (codes->books > 1 && codes->domain == RELUME_DOMAIN_DISPLAY &&
        (n != 1 || lights[0].kind != RELUME_LIGHT_DIRECTIONAL))
        return RELUME_EINVAL;
    p.surface = NULL;
    const relume_status status = begin_all(&job, codes, lights, n, &p);
    if (!status)
        memcpy(rgb, job.products[0].book[book], 3 * (size_t)codes->book_codes[book] * sizeof *rgb);
    end_job(&job);
    return status;
}

void relume_relight_pixel(double rgb[3], const struct relume_codes *codes, int x, int y,
                          const struct relume_light *lights, int n)
{
    const size_t pixel = (size_t)y * (size_t)codes->width + (size_t)x;
    const bool display = codes->domain == RELUME_DOMAIN_DISPLAY;
    rgb[0] = rgb[1] = rgb[2] = 0.0;
    for (int i = 0; i < n; i++) {
        double value[3];
        vec3 from;
        const double share =
            relume_coder_clamp(&from, codes->coder, vec3_unit(lights[i].direction));
        decode_pixel(value, codes, pixel, from);
        for (int c = 0; c < 3; c++)
            rgb[c] += share * (double)lights[i].rgb[c] *
                      (display ? (double)relume_transfer_decode(codes->display, (float)value[c])
                               : value[c]);
    }
}
