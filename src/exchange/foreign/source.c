// source.c - a view of a relume file as numbers that its sRGB-coded picture depends on linearly
#include "exchange/foreign/source.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/lsq.h"
#include "core/math/vec.h"
#include "format/coder/coding.h"

#include <relume/image/directions.h>
#include <relume/relight/relight.h>
#include <string.h>

// More numbers than these are replaced by pictures under so many directions.
enum { MOST_NUMBERS = 1200, STAND_INS = 96 };

static bool is_srgb(const struct relume_codes *codes)
{
    return codes->domain == RELUME_DOMAIN_DISPLAY &&
           (codes->display.curve == RELUME_CURVE_SRGB || codes->display.curve == RELUME_CURVE_AUTO);
}

struct relume_transfer source_coding(enum relume_domain domain, struct relume_transfer display)
{
    if (domain == RELUME_DOMAIN_LINEAR)
        return (struct relume_transfer){.curve = RELUME_CURVE_LINEAR};
    return display.curve == RELUME_CURVE_GAMMA
               ? display
               : (struct relume_transfer){.curve = RELUME_CURVE_SRGB};
}

static relume_status choose_lights(struct source *s, bool whole)
{
    const struct relume_coder_info *info = relume_coder_info(s->codes->coder);
    const bool stand_in = s->between == NULL && info->lights > STAND_INS;
    s->lights = stand_in ? STAND_INS : info->lights;
    s->light = mem_array((size_t)s->lights, sizeof *s->light);
    if (!s->light)
        return RELUME_ENOMEM;
    if (stand_in)
        return relume_directions_make(
            s->light, s->lights, relume_pattern_find("hammersley"),
            relume_directions_params(.hemisphere = !whole || info->hemispherical,
                                     .pole_y = whole && info->pole_y));
    memcpy(s->light, info->directions, (size_t)s->lights * sizeof *s->light);
    return RELUME_OK;
}

relume_status source_open(struct source *s, const struct relume_codes *codes, enum source_kind kind,
                          const struct relume_log *log)
{
    *s =
        (struct source){.codes = codes, .width = codes->width, .height = codes->height, .log = log};
    const struct relume_coder_info *info = relume_coder_info(codes->coder);
    s->numbers = info->basis->joint ? info->coefficients : 3 * info->coefficients;
    const bool whole = kind != SOURCE_UPPER;
    s->coding = kind == SOURCE_WHOLE ? source_coding(codes->domain, codes->display)
                                     : (struct relume_transfer){.curve = RELUME_CURVE_SRGB};
    const bool as_it_is = is_srgb(codes) || s->coding.curve != RELUME_CURVE_SRGB;
    const relume_status status = choose_lights(s, whole);
    if (status || (as_it_is && s->numbers <= MOST_NUMBERS))
        return status;
    s->coding = (struct relume_transfer){.curve = RELUME_CURVE_SRGB};
    s->numbers = 3 * s->lights;
    // the file's own way between its lights, where it has one
    const bool own = info->interpolant && s->lights == info->lights;
    struct relume_coder_params params = {.log = log,
                                         .hemispherical = !whole || info->hemispherical,
                                         .pole_y = whole && info->pole_y,
                                         .decode = true};
    params.interpolant = own ? info->interpolant : relume_interpolant_find("angular");
    if (own)
        memcpy(params.parameter, info->parameter, sizeof params.parameter);
    return relume_coder_create(&s->between, &relume_basis_table, s->light, s->lights, &params);
}

void source_close(struct source *s)
{
    relume_coder_destroy(&s->between);
    mem_free(s->light);
    *s = (struct source){0};
}

// ---------------------------------------------------------------- coefficients

// Coefficients times colours: number 3 k + c.
static relume_status read_products(const struct source *s, size_t first, size_t n, float *out)
{
    const int k = relume_coder_info(s->codes->coder)->coefficients;
    float *colour = mem_array(3 * n, sizeof *colour);
    if (!colour)
        return RELUME_ENOMEM;
    for (int c = 0; c < 3; c++)
        relume_codes_plane(s->codes, k + c, first, n, colour + (size_t)c * n);
    for (int i = 0; i < k; i++) {
        float *to = out + 3 * (size_t)i * n;
        relume_codes_plane(s->codes, i, first, n, to);
        for (size_t c = 3; c-- > 0;)
            for (size_t x = 0; x < n; x++)
                to[c * n + x] = to[x] * colour[c * n + x];
    }
    mem_free(colour);
    return RELUME_OK;
}

// ---------------------------------------------------------------- pictures

static relume_status picture_rows(const struct source *s, int row, int rows, float *out)
{
    const size_t n = (size_t)rows * (size_t)s->width;
    struct relume_image picture = {0};
    struct relume_codes_part band;
    relume_status status = relume_codes_pick(&band, s->codes, (size_t)row * (size_t)s->width, 1, n);
    for (int i = 0; !status && i < s->lights; i++) {
        const struct relume_light light = {.direction = s->light[i], .rgb = {1.0f, 1.0f, 1.0f}};
        status =
            relume_relight(&picture, &band.codes, &light, 1, relume_relight_params(.threads = 1));
        for (size_t c = 0; !status && c < 3; c++) {
            float *to = out + (3 * (size_t)i + c) * n;
            for (size_t x = 0; x < n; x++) {
                const float v = picture.data[3 * x + c];
                to[x] = relume_transfer_encode(s->coding, v < 0.0f ? 0.0f : v > 1.0f ? 1.0f : v);
            }
        }
    }
    relume_image_destroy(&picture);
    relume_codes_part_destroy(&band);
    return status;
}

relume_status source_rows(const struct source *s, int row, int rows, float *out)
{
    const size_t n = (size_t)rows * (size_t)s->width, first = (size_t)row * (size_t)s->width;
    if (s->between)
        return picture_rows(s, row, rows, out);
    if (relume_coder_info(s->codes->coder)->luminance)
        return read_products(s, first, n, out);
    for (int p = 0; p < s->numbers; p++)
        relume_codes_plane(s->codes, p, first, n, out + (size_t)p * n);
    return RELUME_OK;
}

void source_weights(const struct source *s, struct relume_vec3 light, double *weights)
{
    float w[3 * RELUME_MOST_COEFFICIENTS], constant[3];
    const relume_coder *coder = s->between ? s->between : s->codes->coder;
    const struct relume_coder_info *info = relume_coder_info(coder);
    const int k = info->coefficients, p = s->numbers;
    memset(weights, 0, 3 * (size_t)(p + 1) * sizeof *weights);
    relume_coder_weights(coder, light, w, constant);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < k; i++)
            weights[c * (p + 1) + (info->basis->joint ? i : 3 * i + c)] = (double)w[c * k + i];
        weights[c * (p + 1) + p] = (double)constant[c];
    }
}

// ---------------------------------------------------------------- statistics

// Bands are shared out over a fixed number of sums, so that equal bits follow from any number of
// threads.
enum { SUMS = 16, BAND_PIXELS = 2048, SAMPLE_PIXELS = 1 << 19 };

struct survey {
    const struct source *s;
    int rows, every;        // rows of a band; every how many bands one is read
    double *sum, *product;  // [SUMS][P], [SUMS][P][P]
    relume_status status[SUMS];
};

static void add_band(double *sum, double *product, const float *x, size_t n, int p, float *turned,
                     float *gram)
{
    const size_t size = (size_t)p;
    for (size_t i = 0; i < size; i++)
        for (size_t j = 0; j < n; j++) {
            sum[i] += (double)x[i * n + j];
            turned[j * size + i] = x[i * n + j];
        }
    lsq_multiply(p, p, (int)n, x, (int)n, turned, p, gram, p);
    for (size_t i = 0; i < size * size; i++)
        product[i] += (double)gram[i];
}

static void survey_part(void *context, size_t item, int worker)
{
    (void)worker;
    struct survey *v = context;
    const struct source *s = v->s;
    const size_t p = (size_t)s->numbers, n = (size_t)v->rows * (size_t)s->width;
    float *x = mem_array(p * n, sizeof *x), *turned = mem_array(p * n, sizeof *turned);
    float *gram = mem_array(p * p, sizeof *gram);
    v->status[item] = x && turned && gram ? RELUME_OK : RELUME_ENOMEM;
    for (int band = (int)item * v->every; !v->status[item] && band * v->rows < s->height;
         band += SUMS * v->every) {
        const int row = band * v->rows;
        const int rows = s->height - row < v->rows ? s->height - row : v->rows;
        v->status[item] = source_rows(s, row, rows, x);
        if (!v->status[item])
            add_band(v->sum + item * p, v->product + item * p * p, x,
                     (size_t)rows * (size_t)s->width, s->numbers, turned, gram);
    }
    mem_free(x);
    mem_free(turned);
    mem_free(gram);
}

static size_t surveyed_pixels(const struct survey *v)
{
    size_t rows = 0;
    for (int row = 0; row < v->s->height; row += v->rows * v->every)
        rows += (size_t)(v->s->height - row < v->rows ? v->s->height - row : v->rows);
    return rows * (size_t)v->s->width;
}

relume_status source_statistics(const struct source *s, int threads, double *mean,
                                double *covariance)
{
    const size_t p = (size_t)s->numbers, pixels = (size_t)s->width * (size_t)s->height;
    struct survey v = {.s = s, .rows = BAND_PIXELS / s->width + 1};
    v.every = (int)(pixels / SAMPLE_PIXELS) + 1;
    v.sum = mem_zeroed(SUMS * p, sizeof *v.sum);
    v.product = mem_zeroed(SUMS * p * p, sizeof *v.product);
    relume_status status = v.sum && v.product ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        thread_for(threads, SUMS, survey_part, &v);
    for (int i = 0; !status && i < SUMS; i++)
        status = v.status[i];
    const double n = (double)surveyed_pixels(&v);
    for (size_t i = 0; !status && i < p; i++) {
        mean[i] = 0.0;
        for (size_t part = 0; part < SUMS; part++)
            mean[i] += v.sum[part * p + i] / n;
    }
    for (size_t i = 0; !status && i < p * p; i++) {
        covariance[i] = -mean[i / p] * mean[i % p];
        for (size_t part = 0; part < SUMS; part++)
            covariance[i] += v.product[part * p * p + i] / n;
    }
    mem_free(v.sum);
    mem_free(v.product);
    return status;
}
