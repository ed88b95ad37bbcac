// BC1, BC6H and BC7: blocks worked out by hand, and how far coded ones are from what went in
#include "test.h"

#include "image/block/dds.h"

#include "core/base/half.h"

static const struct block_format *const formats[] = {&block_bc1, &block_bc7};

static double error_of(const struct block_format *f, const uint8_t (*rgb)[3])
{
    uint8_t coded[BLOCK_MOST_BYTES], again[BLOCK_PIXELS][3];
    double sum = 0.0;
    f->encode(coded, rgb);
    f->decode(again, coded);
    for (int i = 0; i < BLOCK_PIXELS; i++)
        for (int c = 0; c < 3; c++)
            sum += pow((double)again[i][c] - rgb[i][c], 2.0) / (3.0 * BLOCK_PIXELS);
    return sqrt(sum);
}

// From the specifications: EXT_texture_compression_s3tc, and mode 6 of
// ARB_texture_compression_bptc.
static void test_blocks_by_hand(void **state)
{
    (void)state;
    uint8_t rgb[BLOCK_PIXELS][3];
    // red 31, then green 63 and blue 31 of the other; the first row takes 0, 1, 2, 3
    const uint8_t four[8] = {0x00, 0xf8, 0xff, 0x07, 0xe4, 0, 0, 0};
    block_bc1.decode(rgb, four);
    const int want[4][3] = {{255, 0, 0}, {0, 255, 255}, {170, 85, 85}, {85, 170, 170}};
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 3; c++)
            assert_int_equal(rgb[i][c], want[i][c]);
    // the lesser number first: three colours, their middle and black
    const uint8_t three[8] = {0xff, 0x07, 0x00, 0xf8, 0xe4, 0, 0, 0};
    block_bc1.decode(rgb, three);
    const int other[4][3] = {{0, 255, 255}, {255, 0, 0}, {127, 127, 127}, {0, 0, 0}};
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 3; c++)
            assert_int_equal(rgb[i][c], other[i][c]);
    // BC7: bits 0 1000000, red 1 and 127, green, blue and alpha 0 and 127, last bits 0 and 1, so
    // ends 2 0 0 and 255 255 255; indices 0, then 15 fifteen times
    uint8_t seven[16] = {0};
    const struct {
        int at, count, value;
    } field[] = {{6, 1, 1},    {7, 7, 1},    {14, 7, 127}, {28, 7, 127},
                 {42, 7, 127}, {56, 7, 127}, {64, 1, 1}};
    for (size_t k = 0; k < sizeof field / sizeof *field; k++)
        for (int i = 0; i < field[k].count; i++)
            seven[(field[k].at + i) / 8] |=
                (uint8_t)((field[k].value >> i & 1) << (field[k].at + i) % 8);
    for (int i = 68; i < 128; i++)
        seven[i / 8] |= (uint8_t)(1 << i % 8);
    block_bc7.decode(rgb, seven);
    assert_int_equal(rgb[0][0], 2);
    assert_int_equal(rgb[0][1], 0);
    assert_int_equal(rgb[0][2], 0);
    for (int i = 1; i < BLOCK_PIXELS; i++)
        for (int c = 0; c < 3; c++)
            assert_int_equal(rgb[i][c], 255);
}

static void put(uint8_t *block, int at, int value, int count)
{
    for (int i = 0; i < count; i++)
        block[(at + i) / 8] |= (uint8_t)((value >> i & 1) << (at + i) % 8);
}

// BC6H of the same specification; indices 0, then 15 fifteen times.
static void test_halves_by_hand(void **state)
{
    (void)state;
    uint16_t rgb[BLOCK_PIXELS][3];
    // mode 00011: ends of 10 bits, 512 and 1023 of red: ((512 << 15) + 2^14 >> 9) * 31 >> 6, and
    // the largest
    uint8_t ten[16] = {3};
    put(ten, 5, 512, 10);
    put(ten, 35, 1023, 10);
    for (int i = 68; i < 128; i++)
        put(ten, i, 1, 1);
    block_bc6h.decode_halves(rgb, ten);
    assert_int_equal(rgb[0][0], (32768 + 32) * 31 / 64);
    assert_int_equal(rgb[1][0], 0x7bff);
    assert_int_equal(rgb[1][1], 0);
    // mode 01111: 16 bits, of which the upper six stand behind the difference, highest first:
    // 0x8c21 of green, and 3 less
    uint8_t sixteen[16] = {15};
    put(sixteen, 15, 0x21, 10);
    put(sixteen, 45, 13, 4);
    put(sixteen, 49, 1, 1);  // bit 15
    put(sixteen, 53, 1, 1);  // bit 11
    put(sixteen, 54, 1, 1);  // bit 10
    for (int i = 68; i < 128; i++)
        put(sixteen, i, 1, 1);
    block_bc6h.decode_halves(rgb, sixteen);
    assert_int_equal(rgb[0][1], 0x8c21 * 31 >> 6);
    assert_int_equal(rgb[1][1], (0x8c21 - 3) * 31 >> 6);
    assert_int_equal(rgb[1][0], 0);
}

static double halves_error(const float (*rgb)[3])
{
    uint8_t coded[BLOCK_MOST_BYTES];
    uint16_t half[BLOCK_PIXELS][3];
    double sum = 0.0;
    for (int i = 0; i < BLOCK_PIXELS; i++)
        for (int c = 0; c < 3; c++)
            half[i][c] = half_from_float(rgb[i][c]);
    block_bc6h.encode_halves(coded, (const uint16_t(*)[3])half);
    block_bc6h.decode_halves(half, coded);
    for (int i = 0; i < BLOCK_PIXELS; i++)
        for (int c = 0; c < 3; c++)
            sum += pow((double)(float_from_half(half[i][c]) - rgb[i][c]), 2.0) / 48.0;
    return sqrt(sum);
}

// Even blocks take ends of 16 bits: within steps of half floats. Ramps as those below, of less than
// two octaves: half a step of fifteen, which is up to 1.4 times as wide as the mean of them, and
// ends of 11 bits or more. Of very different sizes too: half a step in proportion.
static void test_halves(void **state)
{
    (void)state;
    float rgb[BLOCK_PIXELS][3];
    for (float v = 1e-3f; v < 6e4f; v *= 7.3f) {
        for (int i = 0; i < BLOCK_PIXELS; i++)
            rgb[i][0] = v, rgb[i][1] = 0.5f * v, rgb[i][2] = 0.3f * v;
        assert_true(halves_error((const float(*)[3])rgb) < (double)v * 0x1p-10);
        for (int i = 0; i < BLOCK_PIXELS; i++)
            for (int c = 0; c < 3; c++)
                rgb[i][c] *= 0.4f + 0.6f * (float)i / 15.0f;
        assert_true(halves_error((const float(*)[3])rgb) <
                    (double)v * (0.6 * 1.4 / 15.0 / sqrt(12.0) + 0x1p-7));
    }
}

static void test_even_blocks(void **state)
{
    (void)state;
    uint8_t rgb[BLOCK_PIXELS][3];
    for (int v = 0; v < 256; v += 5) {
        for (int i = 0; i < BLOCK_PIXELS; i++)
            rgb[i][0] = (uint8_t)v, rgb[i][1] = (uint8_t)(255 - v), rgb[i][2] = (uint8_t)(v / 2);
        // half a step of 31, of 63; of 7 bits and a shared last one
        assert_true(error_of(&block_bc1, (const uint8_t(*)[3])rgb) <= 4.2);
        assert_true(error_of(&block_bc7, (const uint8_t(*)[3])rgb) <= 1.0);
    }
}

// Along a line in colour space, where both forms are at home: at most half a step of the line (255
// / 3 and 255 / 15), and that of the ends.
static void test_ramps(void **state)
{
    (void)state;
    for (int steep = 1; steep <= 17; steep += 4) {
        uint8_t rgb[BLOCK_PIXELS][3];
        for (int i = 0; i < BLOCK_PIXELS; i++) {
            rgb[i][0] = (uint8_t)(i * steep);
            rgb[i][1] = (uint8_t)(255 - i * steep);
            rgb[i][2] = (uint8_t)(i * steep / 2);
        }
        const double step = 15.0 * steep;
        assert_true(error_of(&block_bc1, (const uint8_t(*)[3])rgb) < step / 3.0 / sqrt(12.0) + 3.0);
        assert_true(error_of(&block_bc7, (const uint8_t(*)[3])rgb) <
                    step / 15.0 / sqrt(12.0) + 1.0);
    }
}

// A choice of ends and indices at random never does better than the encoder, whatever the block.
static void test_no_guess_is_better(void **state)
{
    (void)state;
    uint32_t seed = 21;
    for (int round = 0; round < 60; round++) {
        uint8_t rgb[BLOCK_PIXELS][3], guess[BLOCK_MOST_BYTES], seen[BLOCK_PIXELS][3];
        for (int i = 0; i < BLOCK_PIXELS; i++)
            for (int c = 0; c < 3; c++)
                rgb[i][c] = (uint8_t)(10.0 + 6.0 * i * (round % 3) + 60.0 * test_uniform(&seed));
        for (size_t f = 0; f < 2; f++) {
            const double ours = error_of(formats[f], (const uint8_t(*)[3])rgb);
            for (int k = 0; k < 200; k++) {
                for (size_t i = 0; i < formats[f]->bytes; i++)
                    guess[i] = (uint8_t)(256.0 * test_uniform(&seed));
                if (formats[f] == &block_bc7)
                    guess[0] = (uint8_t)(guess[0] & 0x80) | 0x40;
                formats[f]->decode(seen, guess);
                double sum = 0.0;
                for (int i = 0; i < BLOCK_PIXELS; i++)
                    for (int c = 0; c < 3; c++)
                        sum += pow((double)seen[i][c] - rgb[i][c], 2.0) / (3.0 * BLOCK_PIXELS);
                assert_true(sqrt(sum) >= ours);
            }
        }
    }
}

static void test_sizes(void **state)
{
    (void)state;
    uint8_t head[DDS_HEAD];
    // 6 MiB of half floats become half a MiB: 12 : 1, and 253 pictures beside 16 of them 190 : 1
    const size_t each = block_bytes(1024, 1024, &block_bc1);
    assert_int_equal(each, 512 * 1024);
    assert_int_equal(1024 * 1024 * 6 / each, 12);
    CHECK_NEAR(253.0 * 1024 * 1024 * 6 / (16.0 * (double)each), 189.75, 1e-12);
    assert_int_equal(block_bytes(1024, 1024, &block_bc7), 1024 * 1024);
    assert_int_equal(block_bytes(1024, 1024, &block_bc6h), 1024 * 1024);
    assert_int_equal(block_bytes(5, 9, &block_bc1), 2 * 3 * 8);
    dds_head(head, 5, 9, &block_bc1);
    assert_memory_equal(head, "DDS ", 4);
    assert_int_equal(head[4], 124);
    assert_int_equal(head[12], 9);
    assert_int_equal(head[16], 5);
    assert_int_equal(head[128], 71);
    dds_cube_head(head, 32);
    assert_int_equal(head[113], 0xfe);
    assert_int_equal(head[136], 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_blocks_by_hand), cmocka_unit_test(test_halves_by_hand),
        cmocka_unit_test(test_halves),         cmocka_unit_test(test_even_blocks),
        cmocka_unit_test(test_ramps),          cmocka_unit_test(test_no_guess_is_better),
        cmocka_unit_test(test_sizes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
