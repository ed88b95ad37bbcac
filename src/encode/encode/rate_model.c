// rate_model.c - blocks of planes, transformed and quantised
//
// AV1 chooses among transforms and predictions; a cosine transform of 8 x 8 samples with the same
// step errs as much within half a decibel. Its coefficients are counted by the entropy of which of
// them are zero, a sign and the logarithm of each other one: AV1 needs LESS of these bits, within a
// tenth, of components as of pictures (docs/measurements/compression.md).
#include "encode/encode/rate_model.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "encode/encode/dct_block.h"
#include "format/coder/basis.h"
#include "format/lossy/lossy.h"

#include <math.h>
#include <string.h>

enum { SIDE = DCT_SIDE, AREA = DCT_AREA };

// Blocks of a view: rows of them, each with blocks evenly spread; fewer where planes are many.
enum { MOST_ROWS = 16, MOST_ACROSS = 24, MOST_NUMBERS = 1 << 21 };

static const double LESS = 0.73;

// A coefficient is quantised to zero up to this share of a step below one.
static const float ROUNDING = 0.4f;

// ---------------------------------------------------------------- blocks

struct blocks {
    const struct relume_coefficients_info *info;
    int components;  // of a picture
    const int *order;
    float cosine[SIDE][SIDE];  // [frequency][sample], orthonormal
    int across, down;
    size_t count;
    float *block;  // [planes][count][AREA], in the order in which they are coded
    double *gain;  // [planes]: squared error of display values for that of a plane
    int bits;
    double most;  // the largest step
    struct rate_curve *out;
};

static float *block_at(const struct blocks *b, int plane, size_t i)
{
    return b->block + ((size_t)plane * b->count + i) * AREA;
}

// Red, green and blue become the luma and the chromas of Rec. 709.
static void to_luma(float *r, float *g, float *b)
{
    for (int i = 0; i < AREA; i++) {
        const float y = 0.2126f * r[i] + 0.7152f * g[i] + 0.0722f * b[i];
        g[i] = (b[i] - y) / 1.8556f;
        b[i] = (r[i] - y) / 1.5748f;
        r[i] = y;
    }
}

// The i-th block of a plane from codes[SIDE][planes][width], without what lies beyond the edge.
static void take_block(struct blocks *b, const uint16_t *codes, int p, size_t i, int left)
{
    const struct relume_coefficients_info *info = b->info;
    const int picture = p / b->components;
    const int plane = b->components * (b->order ? b->order[picture] : picture) + p % b->components;
    float *to = block_at(b, p, i);
    for (int y = 0; y < SIDE; y++) {
        const uint16_t *row = codes + (size_t)(y * info->planes + plane) * (size_t)info->width;
        for (int x = 0; x < SIDE; x++)
            to[y * SIDE + x] =
                info->scale[plane] * (float)row[smaller_of(left + x, info->width - 1)];
    }
}

// A row of blocks, from codes of as many rows as there are, at most SIDE.
static void take_blocks(struct blocks *b, uint16_t *codes, int rows, int row)
{
    const size_t each = (size_t)b->info->planes * (size_t)b->info->width;
    for (int y = rows; y < SIDE; y++)
        memcpy(codes + (size_t)y * each, codes + (size_t)(rows - 1) * each, each * sizeof *codes);
    for (int i = 0; i < b->across; i++) {
        const size_t at = (size_t)(row * b->across + i);
        const int left = (2 * i + 1) * b->info->width / (2 * b->across) / SIDE * SIDE;
        for (int p = 0; p < b->info->planes; p++)
            take_block(b, codes, p, at, left);
        for (int p = 0; b->components == 3 && p < b->info->planes; p += 3)
            to_luma(block_at(b, p, at), block_at(b, p + 1, at), block_at(b, p + 2, at));
        for (int p = 0; p < b->info->planes; p++)
            dct_transform(block_at(b, p, at), b->cosine);
    }
}

static float magnitude(const float *block)
{
    float sum = 0.0f;
    for (int i = 0; i < AREA; i++)
        sum += fabsf(block[i]);
    return sum;
}

// A mean is predicted by the mean of the block before. A block of a picture becomes its difference
// from the last picture where that is less.
static void predict(const struct blocks *b)
{
    for (int p = b->info->planes - 1; p >= 0; p--)
        for (size_t i = b->count; i-- > 0;) {
            float *own = block_at(b, p, i), rest[AREA];
            const float *last = p >= b->components ? block_at(b, p - b->components, i) : own;
            for (int k = 0; k < AREA; k++)
                rest[k] = own[k] - last[k];
            own[0] -= i ? block_at(b, p, i - 1)[0] : own[0];
            if (last != own && magnitude(rest) < magnitude(own))
                memcpy(own, rest, sizeof rest);
        }
}

// Errors of planes are independent of each other; a luma is in all three channels.
static relume_status find_gains(const struct blocks *b, const relume_capture *capture)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    const struct relume_coder_info *info = relume_coder_info(b->info->coder);
    struct captured captured;
    const relume_status status =
        captured_create(&captured, b->info->coder, m->directions, m->lights);
    memset(b->gain, 0, (size_t)b->info->planes * sizeof *b->gain);
    for (int c = 0; !status && c < 3; c++)
        for (int l = 0; l < m->lights; l++)
            for (int k = 0; k < info->coefficients; k++) {
                const size_t at =
                    (size_t)(c * m->lights + l) * (size_t)info->coefficients + (size_t)k;
                const double w = captured.basis[at];
                const int plane = smaller_of(relume_coder_plane(info, k, c), b->info->planes - 1);
                b->gain[plane] += w * w * b->components / (3.0 * m->lights);
            }
    if (!status)
        captured_destroy(&captured);
    return status;
}

// ---------------------------------------------------------------- quantising

// A plane with a step: adds its squared error and its bits.
static void quantise(const struct blocks *b, int plane, float step, double *square, double *bits)
{
    const double all = (double)b->count * AREA;
    double missed = 0.0, logs = 0.0, coded = 0.0;
    for (size_t i = 0; i < b->count; i++) {
        const float *v = block_at(b, plane, i);
        float missed_here = 0.0f;
        for (int k = 0; k < AREA; k++) {
            const float level = floorf(fabsf(v[k]) / step + ROUNDING);
            const float d = fabsf(v[k]) - step * level;
            missed_here += d * d;
            if (level > 0.0f) {
                coded++;
                logs += level > 1.0f ? (double)log2f(level) : 0.0;
            }
        }
        missed += (double)missed_here;
    }
    *square += missed / all;
    if (coded > 0.0)
        *bits += coded * log2(all / coded) + (all - coded) * log2(all / fmax(all - coded, 1.0)) +
                 coded + 2.0 * logs;
}

// Samples of fewer bits are rounded before they are coded.
static void find_point(void *context, size_t point, int worker)
{
    const struct blocks *b = context;
    const int quantiser = AV1_FINEST + (int)point * RATE_EACH;
    const float step = (float)(b->most * av1_step(quantiser, b->bits));
    const double pixels = (double)b->info->width * b->info->height;
    double error = 0.0, bits = 0.0;
    (void)worker;
    for (int p = 0; p < b->info->planes; p++) {
        const double rounding = (double)b->info->scale[p] * AV1_TOP / ((1 << b->bits) - 1);
        double square = rounding * rounding / 12.0;
        quantise(b, p, step, &square, &bits);
        error += b->gain[p] * square;
    }
    b->out->error[point] = error;
    b->out->bytes[point] = fmax(LESS * bits / 8.0 * pixels / ((double)b->count * AREA), 1.0);
}

relume_status rate_model_curve(struct rate_curve *out, const relume_coefficients *coefficients,
                               int row, int rows, const relume_capture *capture, int bits,
                               int threads)
{
    const struct relume_coefficients_info *info = relume_coefficients_info(coefficients);
    const size_t planes = (size_t)info->planes;
    struct blocks b = {.info = info,
                       .components = lossy_in_colour(info->coder) ? 3 : 1,
                       .order = lossy_order(info->coder),
                       .across = smaller_of(MOST_ACROSS, (info->width + SIDE - 1) / SIDE),
                       .down = smaller_of(MOST_ROWS, (rows + SIDE - 1) / SIDE),
                       .bits = bits,
                       .out = out};
    while (b.across > 1 && b.across * b.down * AREA > MOST_NUMBERS / info->planes)
        b.across--;
    b.count = (size_t)b.across * (size_t)b.down;
    b.block = mem_array(planes * b.count, AREA * sizeof *b.block);
    b.gain = mem_array(planes, sizeof *b.gain);
    uint16_t *codes = mem_array(SIDE * planes, (size_t)info->width * sizeof *codes);
    relume_status status = b.block && b.gain && codes ? RELUME_OK : RELUME_ENOMEM;
    dct_set_cosines(b.cosine);
    for (int i = 0; !status && i < b.down; i++) {
        const int top = (2 * i + 1) * rows / (2 * b.down) / SIDE * SIDE;
        const int some = smaller_of(SIDE, rows - top);
        status = relume_coefficients_read(coefficients, row + top, some, codes);
        if (!status)
            take_blocks(&b, codes, some, i);
    }
    if (!status)
        status = find_gains(&b, capture);
    for (int p = 0; p < info->planes; p++)
        b.most = fmax(b.most, (double)info->scale[p]);
    if (!status) {
        predict(&b);
        thread_for(threads, RATE_POINTS, find_point, &b);
    }
    mem_free(b.block);
    mem_free(b.gain);
    mem_free(codes);
    mem_free((int *)(uintptr_t)b.order);
    return status;
}

// ---------------------------------------------------------------- curves

// On the line through the logarithms of two points.
static double at(const double *value, double quantiser)
{
    const double x = fmin(fmax((quantiser - AV1_FINEST) / RATE_EACH, 0.0), RATE_POINTS - 1.0);
    const int i = smaller_of((int)x, RATE_POINTS - 2);
    const double a = log(fmax(value[i], 1e-30)), b = log(fmax(value[i + 1], 1e-30));
    return exp(a + (x - i) * (b - a));
}

double rate_curve_error(const struct rate_curve *c, double quantiser)
{
    return at(c->error, quantiser);
}

double rate_curve_bytes(const struct rate_curve *c, double quantiser)
{
    return at(c->bytes, quantiser);
}

// Errors grow and bytes shrink with the quantiser.
double rate_curve_find_error(const struct rate_curve *c, double error)
{
    double low = AV1_FINEST, high = AV1_COARSEST;
    while (high - low > 0.01) {
        const double middle = 0.5 * (low + high);
        *(at(c->error, middle) < error ? &low : &high) = middle;
    }
    return 0.5 * (low + high);
}

double rate_curve_find_bytes(const struct rate_curve *c, double bytes)
{
    double low = AV1_FINEST, high = AV1_COARSEST;
    while (high - low > 0.01) {
        const double middle = 0.5 * (low + high);
        *(at(c->bytes, middle) > bytes ? &low : &high) = middle;
    }
    return 0.5 * (low + high);
}
