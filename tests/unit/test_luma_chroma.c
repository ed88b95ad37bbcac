// EXR pictures of luminance and coarser colour become red, green and blue.
#include "in_folder.h"
#include "made_exr.h"

#include "image/image/picture.h"

enum { MOST = 96 };
static float rgb[MOST * MOST * 3];
static const double bt709[3] = {0.2126390, 0.7151687, 0.0721923};

static char *path(void)
{
    static char text[128];
    snprintf(text, sizeof text, "%s/yc.exr", folder);
    return text;
}

// Rows in portions.
static relume_status read_back(const struct made_exr *m)
{
    picture_reader *r;
    made_exr_write(path(), m);
    relume_status status = picture_open(&r, path(), NULL, NULL, NULL);
    if (status)
        return status;
    const struct picture_info *i = picture_info_of(r);
    assert_true(i->width == m->width && i->height == m->height && i->x == m->x && i->y == m->y);
    assert_true(i->channels == 3 && i->floats && i->linear && !i->other[0]);
    for (int y = 0, n = 1; !status && y < m->height; y += n, n = n % 5 + 2) {
        n = y + n > m->height ? m->height - y : n;
        status = picture_read_floats(r, y, n, rgb + (size_t)y * (size_t)m->width * 3);
    }
    picture_close(&r);
    return status;
}

static float even(char channel, int x, int y)
{
    (void)x, (void)y;
    return channel == 'Y' ? 0.5f : channel == 'R' ? 0.25f : channel == 'B' ? -0.5f : 1;
}

static void one_colour_stays(void **state)
{
    static const int sizes[][2] = {{64, 34}, {2, 2}, {32, 18}, {96, 2}, {6, 96}};
    (void)state;
    for (int k = 0; k < 10; k++) {
        const struct made_exr m = {.x = 2 * (k - 4),
                                   .y = -2 * k,
                                   .width = sizes[k / 2][0],
                                   .height = sizes[k / 2][1],
                                   .alpha = k % 2,
                                   .at = even};
        CHECK_OK(read_back(&m));
        for (int i = 0; i < m.width * m.height; i++) {
            CHECK_NEAR(rgb[3 * i], 0.625, 1e-6);
            CHECK_NEAR(rgb[3 * i + 1], (0.5 - bt709[0] * 0.625 - bt709[2] * 0.25) / bt709[1], 1e-6);
            CHECK_NEAR(rgb[3 * i + 2], 0.25, 1e-6);
        }
    }
}

// Those of BT.2020: 0.2627, 0.6780, 0.0593 to four places.
static void primaries_of_the_file_count(void **state)
{
    static const float bt2020[8] = {0.708f, 0.292f, 0.170f,  0.797f,
                                    0.131f, 0.046f, 0.3127f, 0.329f};
    static const float nonsense[8] = {0.708f, 0, 0.170f, 0, 0.131f, 0, 0.3127f, 0};
    const struct made_exr m = {.width = 8, .height = 8, .chromaticities = bt2020, .at = even};
    const struct made_exr bad = {.width = 8, .height = 8, .chromaticities = nonsense, .at = even};
    (void)state;
    CHECK_OK(read_back(&m));
    CHECK_NEAR(rgb[1], (0.5 - 0.2627 * 0.625 - 0.0593 * 0.25) / 0.6780, 1e-4);
    CHECK_OK(read_back(&bad));
    CHECK_NEAR(rgb[1], (0.5 - bt709[0] * 0.625 - bt709[2] * 0.25) / bt709[1], 1e-6);
}

// Half a sample is the mean of a ramp's two neighbours, as far as the filter is from the edge.
static float ramp(char channel, int x, int y)
{
    return channel == 'Y'   ? 1
           : channel == 'R' ? (float)x / 512
           : channel == 'B' ? (float)y / 512
                            : 1;
}

static void ramps_are_ramps(void **state)
{
    const struct made_exr m = {.width = MOST, .height = MOST, .at = ramp};
    (void)state;
    CHECK_OK(read_back(&m));
    for (int y = 14; y < MOST - 14; y++)
        for (int x = 14; x < MOST - 14; x++) {
            CHECK_NEAR(rgb[3 * (y * MOST + x)], 1 + x / 512.0, 2e-6);
            CHECK_NEAR(rgb[3 * (y * MOST + x) + 2], 1 + y / 512.0, 2e-6);
        }
}

// Four samples a period: the sinc's window leaves 1e-3 of the wave, halves of 0.25 1e-4.
static float wave(char channel, int x, int y)
{
    return channel == 'Y'   ? 1
           : channel == 'R' ? 0.25f * (float)cos(M_PI * x / 4)
           : channel == 'B' ? 0.25f * (float)cos(M_PI * y / 4)
                            : 1;
}

static void waves_are_waves(void **state)
{
    const struct made_exr m = {.width = MOST, .height = MOST, .at = wave};
    (void)state;
    CHECK_OK(read_back(&m));
    for (int y = 14; y < MOST - 14; y++)
        for (int x = 14; x < MOST - 14; x++) {
            CHECK_NEAR(rgb[3 * (y * MOST + x)], 1 + 0.25 * cos(M_PI * x / 4), 4e-4);
            CHECK_NEAR(rgb[3 * (y * MOST + x) + 2], 1 + 0.25 * cos(M_PI * y / 4), 4e-4);
        }
}

// A lit red column on black ground: colour is interpolated over the edge, light is not.
static float column(char channel, int x, int y)
{
    (void)y;
    const bool lit = x == 40;
    return channel == 'Y' ? (lit ? 0.2f : 0.01f) : channel == 'R' ? (lit ? 3.5f : 0) : lit ? -1 : 0;
}

static double saturation(const float *c)
{
    return 1 - fmin(c[0], fmin(c[1], c[2])) / fmax(c[0], fmax(c[1], c[2]));
}

// Limited to that of the corners: pixels beside the column would be purely red, as luminance is
// kept their green would be below 0.
static void colour_does_not_leak(void **state)
{
    const struct made_exr m = {.width = MOST, .height = 16, .at = column};
    (void)state;
    CHECK_OK(read_back(&m));
    for (int i = 0; i < m.width * m.height; i++) {
        const float *c = rgb + 3 * i;
        const int x = i % MOST;
        assert_true(c[0] >= 0 && c[1] >= 0 && c[2] >= 0);
        CHECK_NEAR(bt709[0] * c[0] + bt709[1] * c[1] + bt709[2] * c[2], column('Y', x, 0), 2e-6);
        if (x < 25 || x > 55)
            CHECK_NEAR(c[0], c[1], 1e-6);
    }
    assert_true(saturation(rgb + 3 * 40) > 0.75 && saturation(rgb + 3 * 38) < 0.8);
}

// A row without compression that claims the bytes of a longer one: nothing unset is shown.
static void rows_that_claim_more_are_damaged(void **state)
{
    const struct made_exr m = {.width = 32, .height = 32, .at = even};
    const int claimed = made_row_bytes(&m, 0);
    long rows = 0;
    picture_reader *r;
    (void)state;
    made_exr_write(path(), &m);
    for (int row = 1; row < m.height; row++)
        rows += 8 + made_row_bytes(&m, row);
    FILE *f = fopen(path(), "r+b");
    assert_non_null(f);
    assert_int_equal(fseek(f, 4 - rows, SEEK_END), 0);  // of the second row
    made_words(f, &claimed, 1);
    fclose(f);
    CHECK_OK(picture_open(&r, path(), NULL, NULL, NULL));
    assert_int_equal(picture_read_floats(r, 0, m.height, rgb), RELUME_EDAMAGED);
    picture_close(&r);
}

static void what_is_none_is_refused(void **state)
{
    const struct made_exr odd = {.x = 1, .width = 8, .height = 8, .at = even};
    const struct made_exr m = {.width = 32, .height = 32, .at = even};
    (void)state;
    assert_true(relume_status_is_input(read_back(&odd)));
    CHECK_OK(read_back(&m));
    FILE *f = fopen(path(), "r+b");
    assert_non_null(f);
    assert_int_equal(fseek(f, -400, SEEK_END), 0);
    assert_int_equal(ftruncate(fileno(f), ftell(f)), 0);
    fclose(f);
    picture_reader *r;
    assert_true(relume_status_is_input(picture_open(&r, path(), NULL, NULL, NULL)));
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_colour_stays),
        cmocka_unit_test(primaries_of_the_file_count),
        cmocka_unit_test(ramps_are_ramps),
        cmocka_unit_test(waves_are_waves),
        cmocka_unit_test(colour_does_not_leak),
        cmocka_unit_test(what_is_none_is_refused),
        cmocka_unit_test(rows_that_claim_more_are_damaged),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
