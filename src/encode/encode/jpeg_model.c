// jpeg_model.c - blocks of photographs, transformed, quantised and counted as a JPEG encoder does
//
// ITU-T T.81 has the symbols: runs of zeros with the length of the number behind them. Their
// entropy over all blocks is about the length of the Huffman codes.
#include "encode/encode/jpeg_model.h"

#include "capture/manifest/reflectance_table.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "encode/encode/dct_block.h"
#include "format/coder/coding.h"
#include "format/team/array.h"

#include <stdlib.h>
#include <string.h>

// Units of four blocks of luma and one of each chroma. RUN of them lie side by side, since a mean
// is coded as a difference from the last one.
enum { UNIT = 16, RUN = 4, LUMAS = 4, BLOCKS = LUMAS + 2 };

// Rows of units, runs in each, photographs.
enum { MOST_ROWS = 8, MOST_RUNS = 6, MOST_LIGHTS = 16 };

// Codes of libjpeg's tables against the entropy, and bytes of a head.
static const double OF_ENTROPY = 1.04, HEAD = 620.0;

// Tables K.1 and K.2 of T.81, in rows, and the order in which coefficients are coded.
static const uint8_t usual_step[2][DCT_AREA] = {
    {16, 11, 10, 16, 24,  40,  51,  61,  12, 12, 14, 19, 26,  58,  60,  55,
     14, 13, 16, 24, 40,  57,  69,  56,  14, 17, 22, 29, 51,  87,  80,  62,
     18, 22, 37, 56, 68,  109, 103, 77,  24, 35, 55, 64, 81,  104, 113, 92,
     49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99},
    {17, 18, 24, 47, 99, 99, 99, 99, 18, 21, 26, 66, 99, 99, 99, 99, 24, 26, 56, 99, 99, 99,
     99, 99, 47, 66, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99,
     99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99}};
static const uint8_t zigzag[DCT_AREA] = {
    0,  1,  8,  16, 9,  2,  3,  10, 17, 24, 32, 25, 18, 11, 4,  5,  12, 19, 26, 33, 40, 48,
    41, 34, 27, 20, 13, 6,  7,  14, 21, 28, 35, 42, 49, 56, 57, 50, 43, 36, 29, 22, 15, 23,
    30, 37, 44, 51, 58, 59, 52, 45, 38, 31, 39, 46, 53, 60, 61, 54, 47, 55, 62, 63};

// Symbols of luma and chroma, and the bits that follow them.
struct counted {
    uint32_t mean[2][16], other[2][256];
    uint64_t bits_of_means, bits_of_others;
    uint64_t units, means;  // means[2] are counted without the first of a run
};

struct looking {
    const relume_capture *capture;
    const relume_table *table;
    struct relume_transfer coded;
    float cosine[DCT_SIDE][DCT_SIDE];
    float step[2][DCT_AREA];  // in the order of coding
    int rows;                 // fetched
    int lights, runs;         // looked at
    struct counted *counted;  // [lights]
};

static int light_of(const struct looking *l, size_t item)
{
    return (int)((2 * item + 1) * (size_t)relume_capture_manifest(l->capture)->lights /
                 (2 * (size_t)l->lights));
}

static int bits_of(int value)
{
    int bits = 0;
    for (unsigned size = (unsigned)abs(value); size; size >>= 1)
        bits++;
    return bits;
}

// A row of a unit as codes, red, green and blue. Its last pixel is repeated beyond the edge.
static void take_row(float rgb[3][UNIT], const struct looking *l, int light, const float *white,
                     int y, int left)
{
    const int width = relume_capture_width(l->capture);
    const int from = smaller_of(left, width - 1), n = smaller_of(UNIT, width - from);
    const int row = smaller_of(y, l->rows - 1);
    relume_table_planes(l->table, light, (size_t)row * (size_t)width + (size_t)from, (size_t)n,
                        rgb[0], UNIT);
    for (int c = 0; c < 3; c++) {
        for (int x = 0; x < n; x++) {
            const float value = isinf(white[c]) ? rgb[c][x] : rgb[c][x] / white[c];
            rgb[c][x] =
                rintf(255.0f * relume_transfer_encode(l->coded, fminf(fmaxf(value, 0.0f), 1.0f)));
        }
        for (int x = n; x < UNIT; x++)
            rgb[c][x] = rgb[c][n - 1];
    }
}

// The blocks of a unit: four of luma, and the chromas at half resolution (JFIF).
static void take_unit(float block[BLOCKS][DCT_AREA], const struct looking *l, int light,
                      const float *white, int left)
{
    memset(block[LUMAS], 0, 2 * sizeof block[0]);
    for (int y = 0; y < UNIT; y++) {
        float rgb[3][UNIT];
        take_row(rgb, l, light, white, y, left);
        for (int x = 0; x < UNIT; x++) {
            const float luma = 0.299f * rgb[0][x] + 0.587f * rgb[1][x] + 0.114f * rgb[2][x];
            const int at = y / 2 * DCT_SIDE + x / 2;
            block[y / DCT_SIDE * 2 + x / DCT_SIDE][y % DCT_SIDE * DCT_SIDE + x % DCT_SIDE] =
                luma - 128.0f;
            block[LUMAS][at] += (rgb[2][x] - luma) / 1.772f / 4.0f;
            block[LUMAS + 1][at] += (rgb[0][x] - luma) / 1.402f / 4.0f;
        }
    }
}

// Counts a block's numbers but its mean, which is returned.
static int count_block(struct counted *to, float block[DCT_AREA], struct looking *l, int kind)
{
    int run = 0, mean = 0;
    dct_transform(block, l->cosine);
    for (int i = 0; i < DCT_AREA; i++) {
        const int value = (int)lrintf(block[zigzag[i]] / l->step[kind][i]);
        if (i == 0) {
            mean = value;
        } else if (!value) {
            run++;
        } else {
            for (; run > 15; run -= 16)
                to->other[kind][0xf0]++;
            to->other[kind][run << 4 | bits_of(value)]++;
            to->bits_of_others += (unsigned)bits_of(value);
            run = 0;
        }
    }
    if (run)
        to->other[kind][0]++;  // the block ends
    return mean;
}

static void count_mean(struct counted *to, int kind, int difference)
{
    to->mean[kind][bits_of(difference)]++;
    to->bits_of_means += (unsigned)bits_of(difference);
    to->means++;
}

static void count_run(struct counted *to, struct looking *l, int light, const float *white,
                      int left)
{
    int last[3] = {0, 0, 0};
    for (int unit = 0; unit < RUN && left + unit * UNIT < relume_capture_width(l->capture);
         unit++) {
        float block[BLOCKS][DCT_AREA];
        take_unit(block, l, light, white, left + unit * UNIT);
        for (int b = 0; b < BLOCKS; b++) {
            const int component = b < LUMAS ? 0 : b - LUMAS + 1;
            const int mean = count_block(to, block[b], l, component > 0);
            if (unit > 0 || (b > 0 && b < LUMAS))
                count_mean(to, component > 0, mean - last[component]);
            last[component] = mean;
        }
        to->units++;
    }
}

static void count_light(void *context, size_t item, int worker)
{
    struct looking *l = context;
    (void)worker;
    const int light = light_of(l, item), width = relume_capture_width(l->capture);
    float white[3];
    relume_capture_white(l->capture, light, white);
    for (int i = 0; i < l->runs; i++)
        count_run(&l->counted[item], l, light, white,
                  (int)((2 * (int64_t)i + 1) * width / (2 * l->runs)) / UNIT * UNIT);
}

// ---------------------------------------------------------------- bytes

static double entropy(const uint32_t *count, size_t n)
{
    double all = 0.0, bits = 0.0;
    for (size_t i = 0; i < n; i++)
        all += count[i];
    for (size_t i = 0; i < n; i++)
        if (count[i])
            bits -= count[i] * log2(count[i] / all);
    return bits;
}

static void add(struct counted *to, const struct counted *from)
{
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 16; i++)
            to->mean[k][i] += from->mean[k][i];
        for (int i = 0; i < 256; i++)
            to->other[k][i] += from->other[k][i];
    }
    to->bits_of_means += from->bits_of_means;
    to->bits_of_others += from->bits_of_others;
    to->units += from->units;
    to->means += from->means;
}

static double bytes_of_unit(const struct counted *c)
{
    double means = (double)c->bits_of_means, others = (double)c->bits_of_others;
    for (int k = 0; k < 2; k++) {
        means += entropy(c->mean[k], 16);
        others += entropy(c->other[k], 256);
    }
    return OF_ENTROPY *
           (means * BLOCKS / fmax((double)c->means, 1.0) + others / fmax((double)c->units, 1.0)) /
           8.0;
}

static double units_of(const relume_capture *capture)
{
    return ((relume_capture_width(capture) + UNIT - 1) / UNIT) *
           (double)((relume_capture_height(capture) + UNIT - 1) / UNIT);
}

static relume_status look(struct looking *l, relume_table *table, int threads)
{
    const int height = relume_capture_height(l->capture);
    const int rows = smaller_of((height + UNIT - 1) / UNIT, MOST_ROWS);
    relume_status status = RELUME_OK;
    for (int i = 0, at = 0; !status && i < rows; i++) {
        const int row = (int)((2 * (int64_t)i + 1) * height / (2 * rows)) / UNIT * UNIT;
        l->rows = smaller_of(UNIT, height - row);
        status = relume_table_skip(table, row - at);
        if (!status)
            status = relume_table_fetch(table, l->rows);
        if (!status)
            thread_for(threads, (size_t)l->lights, count_light, l);
        at = row + l->rows;
    }
    return status;
}

static relume_status find_bytes(double *out, const relume_capture *capture, int threads,
                                const struct relume_log *log)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    const int across = (relume_capture_width(capture) + UNIT * RUN - 1) / (UNIT * RUN);
    struct looking l = {.capture = capture,
                        .coded = relume_encode_display(capture),
                        .lights = smaller_of(m->lights, MOST_LIGHTS),
                        .runs = smaller_of(across, MOST_RUNS)};
    struct counted all = {0};
    relume_table *table = NULL;
    dct_set_cosines(l.cosine);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < DCT_AREA; i++)  // quality 90: a fifth of the tables
            l.step[k][i] = (float)((20 * usual_step[k][zigzag[i]] + 50) / 100);
    l.counted = mem_zeroed((size_t)l.lights, sizeof *l.counted);
    relume_status status = l.counted ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = relume_table_open(&table, capture, m->views / 2,
                                   relume_table_params(.log = log, .threads = threads));
    l.table = table;
    if (!status)
        status = look(&l, table, threads);
    for (int i = 0; !status && i < l.lights; i++)
        add(&all, &l.counted[i]);
    *out = status ? 0.0 : m->views * m->lights * (HEAD + units_of(capture) * bytes_of_unit(&all));
    relume_table_destroy(&table);
    mem_free(l.counted);
    return status;
}

// ---------------------------------------------------------------- a team

struct share {
    const relume_capture *capture;
    int threads, member;
    const struct relume_log *log;
    double made, bytes;
};

static relume_status begin_share(void *context, int member)
{
    struct share *s = context;
    s->member = member;
    s->made = 0.0;
    return RELUME_OK;
}

static relume_status make_share(void *context)
{
    struct share *s = context;
    return s->member > 0 ? RELUME_OK : find_bytes(&s->made, s->capture, s->threads, s->log);
}

static relume_status keep_share(void *context)
{
    struct share *s = context;
    s->bytes += s->made;
    return RELUME_OK;
}

relume_status jpeg_model_bytes(double *out, const relume_capture *capture,
                               const struct relume_team *team, int threads,
                               const struct relume_log *log)
{
    static const struct team_work work = {begin_share, make_share, keep_share};
    struct share s = {.capture = capture, .threads = threads, .log = log};
    struct team_array made = {&s.made, sizeof s.made};
    const relume_status status =
        team_share(team, "photographs", &work, &s, &team_array_bytes, &made, log);
    *out = s.bytes;
    return status;
}
