// test_exr.c - tests of src/image/image/exr.h: multi-part scanline OpenEXR files: the container
// under relume files and EXR images
#include "test.h"

#include "core/base/thread.h"
#include "image/image/exr.h"

#include <sys/stat.h>

static char folder[64], path[96];

static int setup(void **state)
{
    (void)state;
    test_folder(folder);
    snprintf(path, sizeof path, "%s/x.exr", folder);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

struct block {
    const uint8_t *in;
    uint8_t *out;
    size_t row_bytes, sample_bytes;
    int channels;
};

static relume_status source(void *context, int row, int rows, void *samples)
{
    const struct block *b = context;
    memcpy(samples, b->in + (size_t)row * b->row_bytes, (size_t)rows * b->row_bytes);
    return RELUME_OK;
}

static void sink(void *context, const struct relume_rect *at, const void *samples)
{
    const struct block *b = context;
    const size_t sample = b->sample_bytes, width = b->row_bytes / (size_t)b->channels;
    for (int y = at->top; y < at->top + at->height; y++)
        for (int c = 0; c < b->channels; c++)
            memcpy(b->out + (size_t)y * b->row_bytes + (size_t)c * width +
                       (size_t)at->left * sample,
                   exr_samples(samples, at, at, y, b->channels, c, sample),
                   (size_t)at->width * sample);
}

// Bytes whose entropy runs from none to full, so that some blocks shrink and some do not.
static void fill(uint8_t *bytes, size_t n, size_t block, uint32_t *seed, size_t sample)
{
    for (size_t i = 0; i < n; i++) {
        const uint32_t bits = (uint32_t)(i / block % 64) * 4;
        bytes[i] = (uint8_t)(test_random(seed) % 256 < bits ? test_random(seed) : 0);
        if (i % sample == sample - 1)
            bytes[i] &= 0x3f;  // no infinities, as in our files
    }
}

static const char *const names[] = {"A", "B", "C", "D"};

static void round_trip(enum exr_codec codec, enum exr_sample sample, int width, int height,
                       int channels, uint32_t *seed, int threads)
{
    static const int block_rows[] = {1, 1, 16, 32};
    const size_t row = (size_t)width * (size_t)channels * exr_sample_bytes(sample);
    const size_t size = row * (size_t)height;
    struct block b = {.in = malloc(size),
                      .out = calloc(size, 1),
                      .row_bytes = row,
                      .sample_bytes = exr_sample_bytes(sample),
                      .channels = channels};
    fill((uint8_t *)(uintptr_t)b.in, size, row * (size_t)block_rows[codec], seed,
         exr_sample_bytes(sample));
    const float floats[2] = {1.5f, -2.0f};
    const struct exr_attribute attributes[] = {
        {.name = "relume.number", .kind = EXR_INT, .integer = -7},
        {.name = "relume.words", .kind = EXR_TEXT, .text = "a b"},
        {.name = "relume.list", .kind = EXR_FLOATS, .floats = floats, .count = 2},
    };
    struct exr_part parts[2];
    for (int i = 0; i < 2; i++)
        parts[i] = (struct exr_part){.name = i ? "second" : "first",
                                     .width = width,
                                     .height = height,
                                     .sample = sample,
                                     .codec = codec,
                                     .tile = i ? 16 : 0,
                                     .channels = channels,
                                     .channel = names,
                                     .attributes = i ? 3 : 0,
                                     .attribute = attributes,
                                     .rows = source,
                                     .context = &b};
    exr_file *file;
    CHECK_OK(exr_write(path, NULL, parts, 2, true, threads, NULL));
    uint64_t expected;
    struct stat written;
    CHECK_OK(exr_size(&expected, parts, 2, threads, NULL));
    assert_int_equal(stat(path, &written), 0);
    assert_int_equal(expected, written.st_size);
    CHECK_OK(exr_open(&file, path, NULL, NULL, NULL));
    assert_int_equal(exr_part_count(file), 2);
    for (int i = 0; i < 2; i++) {
        const struct exr_part_info info = exr_part_info(file, i);
        assert_string_equal(info.name, parts[i].name);
        assert_int_equal(info.width, width);
        assert_int_equal(info.height, height);
        assert_int_equal(info.channels, channels);
        assert_int_equal(info.sample, sample);
        assert_true(info.uniform);
        assert_int_equal(info.tile, i ? 16 : 0);
        memset(b.out, 0, size);
        CHECK_OK(exr_read(file, i, NULL, threads, sink, &b, NULL));
        assert_memory_equal(b.in, b.out, size);
    }
    int number = 0, count = 0;
    assert_true(exr_get_int(file, 1, "relume.number", &number) && number == -7);
    assert_string_equal(exr_get_text(file, 1, "relume.words"), "a b");
    assert_memory_equal(exr_get_floats(file, 1, "relume.list", &count), floats, sizeof floats);
    assert_int_equal(count, 2);
    assert_false(exr_get_int(file, 0, "relume.number", &number));
    assert_false(exr_get_int(file, 1, "relume.words", &number));  // of another type
    assert_null(exr_get_text(file, 1, "relume.number"));
    exr_close(&file);
    free((void *)(uintptr_t)b.in);
    free(b.out);
}

static void test_round_trips(void **state)
{
    (void)state;
    uint32_t seed = 1;
    static const int heights[] = {1, 15, 16, 17, 33, 64};
    for (int codec = EXR_CODEC_NONE; codec <= EXR_CODEC_PIZ; codec++)
        for (int sample = EXR_SAMPLE_UINT; sample <= EXR_SAMPLE_FLOAT; sample++)
            for (size_t h = 0; h < sizeof heights / sizeof *heights; h++)
                round_trip((enum exr_codec)codec, (enum exr_sample)sample, 1 + (int)h * 7,
                           heights[h], 1 + (int)h % 4, &seed, 1 + (int)h % 3);
}

// OpenEXR 3.1 stored a block wrongly when its compressed size equalled the plain one: about one in
// a hundred ZIP blocks of such data (30 of these 3200), none of other codecs.
static void test_blocks_that_do_not_shrink(void **state)
{
    (void)state;
    uint32_t seed = 2;
    static const int heights[] = {
        [EXR_CODEC_RLE] = 64, [EXR_CODEC_ZIP] = 640 * 16, [EXR_CODEC_PIZ] = 64 * 32};
    for (int codec = EXR_CODEC_RLE; codec <= EXR_CODEC_PIZ; codec++)
        for (int width = 1; width <= 13; width += 3)
            round_trip((enum exr_codec)codec, EXR_SAMPLE_HALF, width, heights[codec], 1, &seed, 2);
}

static relume_status refuse(void *context, int row, int rows, void *samples)
{
    (void)context, (void)samples, (void)rows;
    memset(samples, 0, 4 * (size_t)rows);
    return row >= 32 ? RELUME_EDAMAGED : RELUME_OK;
}

static void test_failing_source(void **state)
{
    (void)state;
    const struct exr_part part = {.name = "p",
                                  .width = 1,
                                  .height = 200,
                                  .sample = EXR_SAMPLE_FLOAT,
                                  .codec = EXR_CODEC_ZIP,
                                  .channels = 1,
                                  .channel = names,
                                  .rows = refuse};
    unlink(path);
    for (int threads = 1; threads <= 4; threads += 3) {
        assert_int_equal(exr_write(path, NULL, &part, 1, false, threads, NULL), RELUME_EDAMAGED);
        assert_int_not_equal(access(path, F_OK), 0);
    }
}

static void test_every_cut_is_noticed(void **state)
{
    (void)state;
    uint32_t seed = 3;
    round_trip(EXR_CODEC_ZIP, EXR_SAMPLE_HALF, 5, 40, 2, &seed, 1);
    FILE *f = fopen(path, "rb");
    uint8_t bytes[8192];
    const size_t size = fread(bytes, 1, sizeof bytes, f);
    fclose(f);
    for (size_t n = 0; n < size; n += n < 700 ? 7 : 61) {
        exr_file *file;
        struct test_log log;
        test_log_init(&log);
        test_write(path, bytes, n);
        assert_true(relume_status_is_input(exr_open(&file, path, NULL, NULL, &log.log)));
        assert_null(file);
        assert_int_equal(log.lines, 1);
        assert_non_null(strstr(log.text, path));
    }
    test_write(path, bytes, size);
    exr_file *file;
    CHECK_OK(exr_open(&file, path, NULL, NULL, NULL));
    exr_close(&file);
    const struct relume_limits small = {.max_side = 39};
    assert_int_equal(exr_open(&file, path, NULL, &small, NULL), RELUME_ELIMIT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trips),
        cmocka_unit_test(test_blocks_that_do_not_shrink),
        cmocka_unit_test(test_failing_source),
        cmocka_unit_test(test_every_cut_is_noticed),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
