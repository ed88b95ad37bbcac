// loops.c - the data of the hot loops, and one run of each
#include "cli/measure/loops.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/kernel/kernels.h"
#include "core/math/fft2d.h"
#include "core/math/random.h"
#include "image/image/trellis.h"

#include <relume/format/codebook.h>
#include <relume/image/directions.h>
#include <relume/relight/eye.h>
#include <relume/relight/glare.h>
#include <relume/relight/psf.h>
#include <relume/relight/relight.h>
#include <string.h>
#if defined(__x86_64__)
#include <cpuid.h>
#endif

enum {
    SIDE = 1024,
    PIXELS = SIDE * SIDE,
    K = 25,
    PLANES = 3 * K,
    LIGHTS = 49,
    COLUMNS = 3072,  // pixels that are encoded at once
    CHUNKS = 16,
    DIM = 27,
    CODES = 1024,
    VECTORS = 49152,
    WIDE = 2048,  // of the picture that is halved
    SPECTRUM = 1024,
    BLOCKS = 4096,  // of 8 x 8 coefficients
    READS = 75,     // pieces of what is read
    SUMS = 256,     // pieces of arithmetic
    DEEP = 64,
    TILES = 16,
    SCREEN = 2048,
    SHOWN = 4096,  // vectors that a screen is looked up from
    FRAME_WIDTH = 1280,
    FRAME_HEIGHT = 720,
};
static const double LUMINANCE = 10.0;
#define LOG2_OF_SPECTRUM 20.0

struct loops {
    int threads;
    relume_coder *coder;
    relume_codebook *book;
    fft2d *fft;
    struct relume_image relit, picture, small;
    uint8_t *bytes;
    float *samples, *coefficients, *vectors, *spectrum, *dct, *points;
    int16_t *words;
    uint16_t *index;
    uint64_t sum[READS];
    relume_status applied[CHUNKS];
    struct relume_codes codes;
    struct {
        uint8_t *out, *copy;
        uint16_t *index;
        float *vectors;
        const uint16_t *indices[1];
        const float *books[1];
        int count;
        struct relume_codes codes;
    } screen;
    relume_eye *eye;
    relume_psf *psf;
    relume_glare *glare;
    struct relume_image frame;
    bool rests;  // the frame is the one before
    const void *plane[PLANES];
    float scale[PLANES], offset[PLANES];
};

// ---------------------------------------------------------------- the roofs

static void read_piece(void *context, size_t item, int worker)
{
    (void)worker;
    loops *l = context;
    const uint64_t *w = (const uint64_t *)(const void *)(l->bytes + item * PIXELS);
    uint64_t sum[4] = {0, 0, 0, 0};
    for (size_t i = 0; i < PIXELS / 8; i += 4)
        for (size_t k = 0; k < 4; k++)
            sum[k] += w[i + k];
    l->sum[item] = sum[0] + sum[1] + sum[2] + sum[3];
}

static relume_status run_read(loops *l)
{
    thread_for(l->threads, READS, read_piece, l);
    return RELUME_OK;
}

// Twelve running sums over numbers that stay in the first-level cache.
static void sum_piece(void *context, size_t item, int worker)
{
    loops *l = context;
    float best[BLOCK], second[BLOCK];
    int32_t tile[BLOCK];
    (void)item;
    (void)worker;
    const float *codes = l->points + DEEP * BLOCK;
    for (int again = 0; again < 16; again++)
        kernels_choose(0)->nearest->scan(l->points, codes, codes + TILES * DEEP * TILE, TILES, DEEP,
                                         best, second, tile);
}

static relume_status run_arithmetic(loops *l)
{
    thread_for(l->threads, SUMS, sum_piece, l);
    return RELUME_OK;
}

// ---------------------------------------------------------------- the loops

static relume_status run_relight(loops *l)
{
    const struct relume_light light = {.direction = {0.3, 0.4, 0.8}, .rgb = {1, 1, 1}};
    return relume_relight(&l->relit, &l->codes, &light, 1,
                          relume_relight_params(.threads = l->threads));
}

static void apply_chunk(void *context, size_t item, int worker)
{
    loops *l = context;
    (void)worker;
    l->applied[item] =
        relume_coder_apply(l->coder, l->samples + item * LIGHTS * 3 * COLUMNS, 3 * COLUMNS, COLUMNS,
                           l->coefficients + item * PLANES * COLUMNS, COLUMNS);
}

static relume_status run_apply(loops *l)
{
    relume_status status = RELUME_OK;
    thread_for(l->threads, CHUNKS, apply_chunk, l);
    for (int i = 0; !status && i < CHUNKS; i++)
        status = l->applied[i];
    return status;
}

static relume_status run_nearest(loops *l)
{
    return relume_codebook_assign(l->book, l->vectors, VECTORS, l->index, NULL,
                                  relume_codebook_assign_params(.threads = l->threads));
}

static relume_status run_resample(loops *l)
{
    relume_image_destroy(&l->small);
    return relume_image_scale(&l->small, &l->picture, WIDE / 2, WIDE / 2,
                              relume_scale_params(.threads = l->threads));
}

static void fill_row(void *context, int row, float *line)
{
    const loops *l = context;
    memcpy(line, l->samples + (size_t)row * SPECTRUM, SPECTRUM * sizeof *line);
}

static void take_row(void *context, int row, const float *line)
{
    loops *l = context;
    memcpy(l->coefficients + (size_t)row * SPECTRUM, line, SPECTRUM * sizeof *line);
}

// As one channel of a frame goes through the eye's pattern.
static relume_status run_fft(loops *l)
{
    const struct fft2d_step step = {.to = SPECTRUM, .end = fft2d_columns(l->fft)};
    fft2d_rows(l->fft, l->spectrum, 0, SPECTRUM, fill_row, l);
    fft2d_step_columns(l->fft, l->spectrum, &step);
    fft2d_columns_back(l->fft, l->spectrum);
    fft2d_rows_back(l->fft, l->spectrum, 0, SPECTRUM, take_row, l);
    return RELUME_OK;
}

static relume_status run_trellis(loops *l)
{
    (void)trellis_quantise(l->dct, BLOCKS, 0.02, 0.1, l->words);
    return RELUME_OK;
}

static relume_status run_copy(loops *l)
{
    memcpy(l->screen.copy, l->screen.out, (size_t)SCREEN * SCREEN * 4);
    return RELUME_OK;
}

static relume_status run_look_up(loops *l)
{
    const struct relume_light light = {.direction = {0.3, 0.4, 0.8}, .rgb = {1, 1, 1}};
    return relume_relight_rgba8(l->screen.out, &l->screen.codes, &light, 1,
                                relume_relight_params(.threads = l->threads));
}

static relume_status run_eye(loops *l)
{
    const relume_status status = relume_eye_advance(l->eye, 1.0 / 60.0, LUMINANCE);
    return status ? status : relume_psf_update(l->psf, l->eye);
}

static relume_status run_glare(loops *l)
{
    struct relume_image seen = {0};
    const relume_status status = relume_glare_apply(&seen, l->glare, &l->frame, l->rests, l->psf,
                                                    relume_glare_params(.threads = l->threads));
    relume_image_destroy(&seen);
    l->rests = true;
    return status;
}

#define FLOATS ((double)sizeof(float))
const struct hot_loop hot_loops[] = {
    {"read", "75 MB of bytes", (double)PLANES *PIXELS, 0.0, 0.0, run_read},
    {"multiply and add", "sums in registers, numbers in the cache", 0.0,
     2.0 * 16 * SUMS *(double)BLOCK *TILES *TILE *DEEP, 0.0, run_arithmetic},
    {"relight", "1 Mpixel from 25 coefficients of 8 bits",
     (double)PLANES *PIXELS + 3.0 * FLOATS *PIXELS, 2.0 * PLANES *PIXELS, 0.0, run_relight},
    {"copy", "16 MB by memcpy, one thread", 8.0 * SCREEN *SCREEN, 0.0, 3.07e-3, run_copy},
    {"look-up", "4 Mpixel for the screen from 4096 vectors", 6.0 * SCREEN *SCREEN, 0.0, 2.06e-3,
     run_look_up},
    {"apply", "49 lights to 25 coefficients, 49152 pixels",
     FLOATS *CHUNKS *COLUMNS * 3.0 * (LIGHTS + K), 2.0 * 3.0 * LIGHTS *K *CHUNKS *COLUMNS, 0.0,
     run_apply},
    {"nearest code", "of 1024, 49152 vectors of 27", (FLOATS * DIM + 2.0) * VECTORS,
     2.0 * CODES *DIM *(double)VECTORS, 0.0, run_nearest},
    {"resampling", "2048 x 2048 RGB to half the size", FLOATS * 3.0 * WIDE *WIDE * 1.25,
     2.0 * 3.0 * WIDE *WIDE *(1.0 + 0.5), 0.0, run_resample},
    {"glare FFT", "1024 x 1024, forth and back", FLOATS *SPECTRUM *SPECTRUM * 8.0,
     2.0 * 2.5 * LOG2_OF_SPECTRUM *SPECTRUM *SPECTRUM, 0.0, run_fft},
    {"web-plane trellis", "4096 blocks of 64, one thread", (FLOATS + 2.0) * 64.0 * BLOCKS,
     3.0 * 4.0 * 64.0 * BLOCKS, 0.0, run_trellis},
    {"eye's pattern", "1024 x 1024, 32 wavelengths", 0.0, 0.0, 10.7e-3, run_eye},
    {"glare", "1280 x 720 through that pattern, at rest", 0.0, 0.0, 23e-3, run_glare},
    {NULL, NULL, 0.0, 0.0, 0.0, NULL},
};

double loop_bound_s(const struct hot_loop *loop, double bytes_a_second, double flops_a_second)
{
    const double memory = loop->bytes / bytes_a_second, sums = loop->flops / flops_a_second;
    return memory > sums ? memory : sums;
}

void loops_processor(char name[49])
{
    memset(name, 0, 49);
#if defined(__x86_64__)
    unsigned word[12] = {0};
    for (unsigned i = 0; i < 3; i++)
        if (!__get_cpuid(0x80000002u + i, &word[4 * i], &word[4 * i + 1], &word[4 * i + 2],
                         &word[4 * i + 3]))
            return;
    memcpy(name, word, sizeof word);
#endif
}

const char *loops_set(void)
{
    return kernels_choose(0)->name;
}

// ---------------------------------------------------------------- their data

static float *make_floats(size_t n)
{
    float *v = mem_array(n, sizeof *v);
    struct random random = random_stream(1, n, 0);
    for (size_t i = 0; v && i < n; i++)
        v[i] = (float)random_range(&random, -0.5, 0.5);
    return v;
}

static void fill_codes(loops *l)
{
    for (size_t i = 0; i < (size_t)PLANES * PIXELS; i++)
        l->bytes[i] = (uint8_t)(i * 2654435761u >> 13);
    for (int p = 0; p < PLANES; p++) {
        l->plane[p] = l->bytes + (size_t)p * PIXELS;
        l->scale[p] = 0.004f;
        l->offset[p] = -0.5f;
    }
    l->codes = (struct relume_codes){
        .coder = l->coder,
        .domain = RELUME_DOMAIN_LINEAR,
        .width = SIDE,
        .height = SIDE,
        .planes = PLANES,
        .storage = RELUME_STORE_8,
        .plane = l->plane,
        .scale = l->scale,
        .offset = l->offset,
    };
}

static void fill_screen(loops *l)
{
    for (size_t i = 0; i < (size_t)SCREEN * SCREEN; i++)  // neighbours mostly alike, as in pictures
        l->screen.index[i] =
            (uint16_t)((i / 9 % SCREEN + i / SCREEN / 7 * 31 + (i * 2654435761u >> 28)) % SHOWN);
    l->screen.indices[0] = l->screen.index;
    l->screen.books[0] = l->screen.vectors;
    l->screen.count = SHOWN;
    l->screen.codes = (struct relume_codes){
        .coder = l->coder,
        .domain = RELUME_DOMAIN_DISPLAY,
        .display = {.curve = RELUME_CURVE_SRGB},
        .width = SCREEN,
        .height = SCREEN,
        .planes = PLANES,
        .books = 1,
        .index = l->screen.indices,
        .vectors = l->screen.books,
        .book_codes = &l->screen.count,
    };
}

// A dark frame with some lamps, and the eye that sees it.
static relume_status make_eye(loops *l)
{
    relume_status status = relume_eye_create(&l->eye, NULL, LUMINANCE);
    if (!status)
        status = relume_psf_create(&l->psf, relume_psf_params(.threads = l->threads));
    if (!status)
        status = relume_psf_update(l->psf, l->eye);
    if (!status)
        status = relume_glare_create(&l->glare);
    if (!status)
        status = relume_image_create(&l->frame, FRAME_WIDTH, FRAME_HEIGHT, 3);
    for (size_t i = 0; !status && i < 3 * (size_t)FRAME_WIDTH * FRAME_HEIGHT; i++)
        l->frame.data[i] = i % 68999 == 0 ? 3000.0f : 0.05f + 0.01f * (float)(i % 7);
    return status;
}

static relume_status make_coders(loops *l)
{
    struct relume_vec3 lights[LIGHTS];
    relume_status status = relume_directions_make(lights, LIGHTS, relume_pattern_find("hammersley"),
                                                  relume_directions_params(.hemisphere = true));
    if (!status)
        status = relume_coder_create(&l->coder, &relume_basis_sh, lights, LIGHTS,
                                     relume_coder_params(.coefficients = K));
    if (!status)
        status =
            relume_codebook_train(&l->book, l->vectors, VECTORS, DIM,
                                  relume_codebook_params(.codes = CODES, .initial = l->vectors,
                                                         .max_rounds = 1, .threads = l->threads));
    if (!status)
        status = fft2d_create(&l->fft, SPECTRUM, SPECTRUM, true, l->threads);
    if (!status)
        status = relume_image_create(&l->picture, WIDE, WIDE, 3);
    if (!status)
        status = make_eye(l);
    return status;
}

relume_status loops_create(loops **out, int threads)
{
    loops *l = *out = mem_zeroed(1, sizeof *l);
    if (!l)
        return RELUME_ENOMEM;
    l->threads = threads;
    l->bytes = mem_large((size_t)PLANES * PIXELS);
    l->samples = make_floats((size_t)CHUNKS * LIGHTS * 3 * COLUMNS);
    l->coefficients = make_floats((size_t)CHUNKS * PLANES * COLUMNS);
    l->vectors = make_floats((size_t)VECTORS * DIM);
    l->dct = make_floats(64 * (size_t)BLOCKS);
    l->points = make_floats(DEEP * BLOCK + TILES * TILE * (DEEP + 1));
    l->words = mem_array(64 * (size_t)BLOCKS, sizeof *l->words);
    l->index = mem_array(VECTORS, sizeof *l->index);
    l->screen.out = mem_zeroed((size_t)SCREEN * SCREEN, 4);
    l->screen.copy = mem_zeroed((size_t)SCREEN * SCREEN, 4);
    l->screen.index = mem_array((size_t)SCREEN * SCREEN, sizeof *l->screen.index);
    l->screen.vectors = make_floats((size_t)SHOWN * PLANES);
    const bool good = l->bytes && l->samples && l->coefficients && l->vectors && l->dct &&
                      l->points && l->words && l->index && l->screen.out && l->screen.copy &&
                      l->screen.index && l->screen.vectors;
    relume_status status = good ? make_coders(l) : RELUME_ENOMEM;
    if (!status && !(l->spectrum = mem_array(fft2d_size(l->fft), sizeof *l->spectrum)))
        status = RELUME_ENOMEM;
    if (status) {
        loops_destroy(out);
        return status;
    }
    for (size_t i = 0; i < 3 * (size_t)WIDE * WIDE; i++)
        l->picture.data[i] = l->samples[i % ((size_t)CHUNKS * LIGHTS * 3 * COLUMNS)];
    fill_codes(l);
    // Coefficients of a picture: large ones first.
    for (size_t i = 0; i < 64 * (size_t)BLOCKS; i++)
        l->dct[i] /= (1.0f + 0.5f * (float)(i % 64));
    fill_screen(l);
    return RELUME_OK;
}

void loops_destroy(loops **out)
{
    loops *l = *out;
    if (!l)
        return;
    relume_coder_destroy(&l->coder);
    relume_codebook_destroy(&l->book);
    fft2d_destroy(&l->fft);
    relume_image_destroy(&l->relit);
    relume_image_destroy(&l->picture);
    relume_image_destroy(&l->small);
    relume_eye_destroy(&l->eye);
    relume_psf_destroy(&l->psf);
    relume_glare_destroy(&l->glare);
    relume_image_destroy(&l->frame);
    mem_free(l->screen.out);
    mem_free(l->screen.copy);
    mem_free(l->screen.index);
    mem_free(l->screen.vectors);
    mem_free(l->bytes);
    mem_free(l->samples);
    mem_free(l->coefficients);
    mem_free(l->vectors);
    mem_free(l->spectrum);
    mem_free(l->dct);
    mem_free(l->points);
    mem_free(l->words);
    mem_free(l->index);
    mem_free(l);
    *out = NULL;
}
