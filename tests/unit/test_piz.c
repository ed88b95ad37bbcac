// test_piz.c - tests of src/image/image/piz.h: blocks of every kind become the bytes that OpenEXR's
// own library makes of them, and come back from these
#include "test.h"

#include "image/image/piz.h"

#include <openexr.h>

struct reference {
    exr_encode_pipeline_t exr;  // first: the core hands back a pointer to it
    exr_result_t (*compress)(exr_encode_pipeline_t *pipeline);
    const uint16_t *words;
    uint8_t *bytes;
    size_t size;
};

static exr_result_t take_words(exr_encode_pipeline_t *pipeline)
{
    const struct reference *r = (const struct reference *)pipeline;
    memcpy(pipeline->packed_buffer, r->words, pipeline->chunk.unpacked_size);
    pipeline->packed_bytes = pipeline->chunk.unpacked_size;
    return EXR_ERR_SUCCESS;
}

static exr_result_t keep_bytes(exr_encode_pipeline_t *pipeline)
{
    struct reference *r = (struct reference *)pipeline;
    const exr_result_t result = r->compress(pipeline);
    r->size = pipeline->compressed_bytes;
    r->bytes = malloc(r->size + 1);
    memcpy(r->bytes, pipeline->compressed_buffer, r->size);
    return result;
}

static int64_t nowhere(exr_const_context_t context, void *user, const void *buffer, uint64_t size,
                       uint64_t offset, exr_stream_error_func_ptr_t error)
{
    (void)context, (void)user, (void)buffer, (void)offset, (void)error;
    return (int64_t)size;
}

// The library's block; `bytes` is the caller's to free.
static void compress_by_library(struct reference *r, const uint16_t *words, int width, int rows,
                                int channels, exr_pixel_type_t type)
{
    const int bytes = type == EXR_PIXEL_HALF ? 2 : 4;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    const exr_attr_box2i_t window = {.max.x = width - 1, .max.y = rows - 1};
    const exr_attr_v2f_t centre = {.x = 0.0f};
    exr_context_t exr;
    exr_chunk_info_t chunk;
    int part;
    char name[16];
    static uint16_t unused;
    *r = (struct reference){.words = words};
    init.write_fn = nowhere;
    assert_int_equal(exr_start_write(&exr, "x.exr", EXR_WRITE_FILE_DIRECTLY, &init), 0);
    assert_int_equal(exr_add_part(exr, "p", EXR_STORAGE_SCANLINE, &part), 0);
    assert_int_equal(exr_initialize_required_attr(exr, part, &window, &window, 1.0f, &centre, 1.0f,
                                                  EXR_LINEORDER_INCREASING_Y, EXR_COMPRESSION_PIZ),
                     0);
    for (int c = 0; c < channels; c++) {
        snprintf(name, sizeof name, "c%02d", c);
        assert_int_equal(exr_add_channel(exr, part, name, type, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1),
                         0);
    }
    assert_int_equal(exr_write_header(exr), 0);
    assert_int_equal(exr_write_scanline_chunk_info(exr, part, 0, &chunk), 0);
    assert_int_equal(exr_encoding_initialize(exr, part, &chunk, &r->exr), 0);
    for (int c = 0; c < channels; c++) {
        exr_coding_channel_info_t *of = &r->exr.channels[c];
        of->encode_from_ptr = (const uint8_t *)&unused;
        of->user_bytes_per_element = (int16_t)bytes;
        of->user_pixel_stride = bytes;
        of->user_data_type = (uint16_t)type;
        of->user_line_stride = bytes * width;
    }
    assert_int_equal(exr_encoding_choose_default_routines(exr, part, &r->exr), 0);
    r->compress = r->exr.compress_fn;
    r->exr.compress_fn = keep_bytes;
    r->exr.convert_and_pack_fn = take_words;
    r->exr.packed_buffer = malloc(chunk.unpacked_size);
    r->exr.packed_alloc_size = chunk.unpacked_size;
    assert_int_equal(exr_encoding_run(exr, part, &r->exr), 0);
    exr_encoding_destroy(exr, &r->exr);
    exr_finish(&exr);
}

static uint16_t smooth(size_t i, uint32_t *seed)
{
    return (uint16_t)(0x3c00 + i % 97 + test_random(seed) % 3);
}

static uint16_t noise(size_t i, uint32_t *seed)
{
    (void)i;
    return (uint16_t)(test_random(seed) % 256);
}

static uint16_t wide(size_t i, uint32_t *seed)
{
    (void)i;
    return (uint16_t)((test_random(seed) >> 8) % (1 << 14) * 4);
}

static uint16_t black(size_t i, uint32_t *seed)
{
    (void)i, (void)seed;
    return 0;
}

static uint16_t grey(size_t i, uint32_t *seed)
{
    (void)i, (void)seed;
    return 0x1234;
}

// Runs of all lengths, also those about the longest that one code holds.
static uint16_t runs(size_t i, uint32_t *seed)
{
    static size_t until, value;
    if (i == 0 || i == until) {
        until = i + 1 + test_random(seed) % (test_random(seed) % 4 ? 5 : 600);
        value = test_random(seed) % 40;
    }
    return (uint16_t)value;
}

// Counts like Fibonacci's numbers: codes as long as they can be.
static uint16_t steep(size_t i, uint32_t *seed)
{
    size_t a = 1, b = 1, value = 0;
    (void)seed;
    for (; i >= b; value++) {
        const size_t next = a + b;
        i -= b;
        a = b;
        b = next;
    }
    return (uint16_t)(value * 3);
}

typedef uint16_t kind(size_t i, uint32_t *seed);
static kind *const kinds[] = {smooth, noise, wide, black, grey, runs, steep};

static void compare_block(piz *p, kind *word, int width, int rows, int channels, uint32_t *seed)
{
    const size_t n = (size_t)width * (size_t)rows * (size_t)channels, plain = 2 * n;
    uint16_t *words = malloc(plain);
    uint16_t *work = malloc(plain);
    uint8_t *out = malloc(piz_bound(plain));
    struct reference r;
    for (size_t i = 0; i < n; i++)
        words[i] = word(i, seed);
    compress_by_library(&r, words, width, rows, channels, EXR_PIXEL_HALF);
    const size_t size = piz_compress(p, out, work, words, width, rows, channels);
    assert_true(size > 0 && size <= piz_bound(plain));
    if (size < plain || r.size != plain) {  // otherwise the library stores the samples as they are
        assert_int_equal(size, r.size);
        assert_memory_equal(out, r.bytes, size);
    }
    free(words);
    free(work);
    free(out);
    free(r.bytes);
}

static void test_bytes(void **state)
{
    static const int sizes[][3] = {{1, 1, 1},    {2, 2, 1},   {3, 5, 2},   {1, 32, 3},
                                   {7, 32, 9},   {64, 1, 4},  {33, 17, 1}, {97, 31, 5},
                                   {256, 32, 3}, {600, 32, 2}};
    uint32_t seed = 7;
    (void)state;
    piz *p = piz_create();
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
            compare_block(p, kinds[k], sizes[s][0], sizes[s][1], sizes[s][2], &seed);
    piz_destroy(&p);
}

// More values than the wavelet of 14 bits can take are left to the library.
static void test_too_many_values(void **state)
{
    enum { WIDTH = 1024, ROWS = 32, N = WIDTH * ROWS };
    uint16_t *words = malloc(2 * N);
    uint16_t *work = malloc(2 * N);
    uint8_t *out = malloc(piz_bound(2 * N));
    (void)state;
    piz *p = piz_create();
    for (int i = 0; i < N; i++)
        words[i] = (uint16_t)(i % (1 << 14));
    assert_true(piz_compress(p, out, work, words, WIDTH, ROWS, 1) > 0);
    words[N - 1] = 1 << 14;
    assert_int_equal(piz_compress(p, out, work, words, WIDTH, ROWS, 1), 0);
    piz_destroy(&p);
    free(words);
    free(work);
    free(out);
}

// ---------------------------------------------------------------- decoding

static bool comes_back(piz_decoder *d, const uint16_t *words, const uint8_t *bytes, size_t size,
                       int width, int rows, int channels, int each)
{
    const size_t plain = 2 * (size_t)width * (size_t)rows * (size_t)channels * (size_t)each;
    uint8_t *copy = malloc(size + 1);  // nothing behind it is looked at
    uint16_t *out = malloc(plain);
    memcpy(copy, bytes, size);
    assert_true(piz_decoder_reserve(d, (size_t)(width * rows), each));
    const bool decoded = piz_decompress(d, out, copy, size, width, rows, channels, each, NULL);
    const bool same = decoded && !memcmp(out, words, plain);
    free(copy);
    free(out);
    return same;
}

static const int decoded_sizes[][3] = {{1, 1, 1},  {2, 2, 1},   {3, 5, 2},   {1, 32, 3},
                                       {7, 32, 9}, {33, 17, 1}, {97, 31, 5}, {600, 32, 2}};
enum { DECODED_SIZES = sizeof decoded_sizes / sizeof *decoded_sizes };

static void test_halves_come_back(void **state)
{
    uint32_t seed = 11;
    (void)state;
    piz *p = piz_create();
    piz_decoder *d = piz_decoder_create();
    for (size_t s = 0; s < DECODED_SIZES; s++)
        for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
            const int *size = decoded_sizes[s];
            const size_t n = (size_t)(size[0] * size[1] * size[2]);
            uint16_t *words = malloc(2 * n);
            uint16_t *work = malloc(2 * n);
            uint8_t *out = malloc(piz_bound(2 * n));
            for (size_t i = 0; i < n; i++)
                words[i] = kinds[k](i, &seed);
            const size_t bytes = piz_compress(p, out, work, words, size[0], size[1], size[2]);
            assert_true(comes_back(d, words, out, bytes, size[0], size[1], size[2], 1));
            assert_false(comes_back(d, words, out, bytes - 1, size[0], size[1], size[2], 1));
            free(words);
            free(work);
            free(out);
        }
    piz_decoder_destroy(&d);
    piz_destroy(&p);
}

// Samples of 32 bits, which the library packs: whole numbers of 12 bits, and of all.
static void test_words_come_back(void **state)
{
    uint32_t seed = 13;
    struct reference r;
    (void)state;
    piz_decoder *d = piz_decoder_create();
    for (size_t s = 0; s < DECODED_SIZES; s++)
        for (int wide = 0; wide < 2; wide++) {
            const int *size = decoded_sizes[s];
            const size_t n = 2 * (size_t)(size[0] * size[1] * size[2]);
            uint16_t *words = malloc(2 * n);
            for (size_t i = 0; i < n; i++)
                words[i] = i % 2 && !wide ? 0 : (uint16_t)(test_random(&seed) % (wide ? 500 : 40));
            compress_by_library(&r, words, size[0], size[1], size[2], EXR_PIXEL_UINT);
            if (r.size < 2 * n)
                assert_true(comes_back(d, words, r.bytes, r.size, size[0], size[1], size[2], 2));
            free(words);
            free(r.bytes);
        }
    piz_decoder_destroy(&d);
}

// Damage is refused or gives other samples, and touches no memory beside them.
static void test_damage(void **state)
{
    enum { WIDTH = 97, ROWS = 31, CHANNELS = 2, N = WIDTH * ROWS * CHANNELS };
    static uint16_t words[N], work[N], out[N];
    uint32_t seed = 17;
    (void)state;
    piz *p = piz_create();
    piz_decoder *d = piz_decoder_create();
    uint8_t *bytes = malloc(piz_bound(sizeof words));
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (int i = 0; i < 400; i++) {
            for (size_t j = 0; j < N; j++)
                words[j] = kinds[k](j, &seed);
            const size_t size = piz_compress(p, bytes, work, words, WIDTH, ROWS, CHANNELS);
            const size_t head = size < 64 || i % 2 ? size : 64;
            bytes[test_random(&seed) % head] ^= (uint8_t)(1u << test_random(&seed) % 8);
            assert_true(piz_decoder_reserve(d, WIDTH * ROWS, 1));
            (void)piz_decompress(d, out, bytes, size, WIDTH, ROWS, CHANNELS, 1, NULL);
        }
    free(bytes);
    piz_decoder_destroy(&d);
    piz_destroy(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bytes),
        cmocka_unit_test(test_too_many_values),
        cmocka_unit_test(test_halves_come_back),
        cmocka_unit_test(test_words_come_back),
        cmocka_unit_test(test_damage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
