// test_table.c - images kept in memory: what a table reads, whether from a file or not
#include "capture/manifest/reflectance_table.h"

#include "in_folder.h"

enum { LIGHTS = 3, WIDTH = 20, HEIGHT = 40, BYTES = 3 * WIDTH * HEIGHT };

// Every image flat, its value encodes light and version.
static float value_of(int version, int light)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    return relume_transfer_decode(srgb, (float)(40 + 60 * version + 10 * light) / 255.0f);
}

static void write_images(int version)
{
    struct relume_image image;
    char path[128];
    CHECK_OK(relume_image_create(&image, WIDTH, HEIGHT, 3));
    for (int i = 0; i < LIGHTS; i++) {
        for (int k = 0; k < BYTES; k++)
            image.data[k] = value_of(version, i);
        snprintf(path, sizeof path, "%s/%d.png", folder, i);
        CHECK_OK(relume_image_save(&image, path, NULL));
    }
    relume_image_destroy(&image);
}

static relume_capture *open_with(const struct relume_capture_params *params)
{
    char path[128];
    relume_capture *capture;
    snprintf(path, sizeof path, "%s/dirs.lp", folder);
    FILE *lp = fopen(path, "w");
    fprintf(lp, "%d\n0.png 0 0 1\n1.png 0.6 0 0.8\n2.png 0 0.6 0.8\n", LIGHTS);
    fclose(lp);
    CHECK_OK(relume_capture_open(&capture, path, params));
    return capture;
}

static relume_capture *open_capture(size_t keep_bytes)
{
    return open_with(relume_capture_params(.keep_bytes = keep_bytes));
}

// Reads `rows` rows, all of which must show versions[light].
static void check_table(const relume_capture *capture, int rows, const int versions[LIGHTS])
{
    static float out[LIGHTS * BYTES];
    relume_table *table;
    CHECK_OK(relume_table_open(&table, capture, 0, NULL));
    for (int row = 0; row < rows; row += 8) {  // bands that are not those of the stream
        CHECK_OK(relume_table_read(table, 8, out));
        for (int i = 0; i < LIGHTS; i++)
            for (int k = 0; k < 3 * 8 * WIDTH; k++)
                CHECK_NEAR(out[i * 3 * 8 * WIDTH + k], value_of(versions[i], i), 1e-6);
    }
    relume_table_destroy(&table);
}

// Files that change after the first table show where the second one has its rows from.
static void check_kept_with(const struct relume_capture_params *params, int first_rows,
                            const int second[LIGHTS])
{
    static const int old[LIGHTS] = {0};
    write_images(0);
    relume_capture *capture = open_with(params);
    check_table(capture, first_rows, old);
    write_images(1);
    check_table(capture, HEIGHT, second);
    check_table(capture, HEIGHT, second);
    relume_capture_destroy(&capture);
}

static void check_kept(size_t keep_bytes, int first_rows, const int second[LIGHTS])
{
    check_kept_with(relume_capture_params(.keep_bytes = keep_bytes), first_rows, second);
}

static void test_nothing_is_kept(void **state)
{
    (void)state;
    check_kept(0, HEIGHT, (const int[]){1, 1, 1});
}

static void test_all_are_kept(void **state)
{
    (void)state;
    check_kept(LIGHTS * BYTES, HEIGHT, (const int[]){0, 0, 0});
}

static void test_budget(void **state)
{
    (void)state;
    check_kept(3 * BYTES - 1, HEIGHT, (const int[]){0, 0, 1});
}

// What memory does not hold is in files beside a path, up to half of what one picture may take.
static void test_the_rest_is_on_disk(void **state)
{
    (void)state;
    char out[128];
    snprintf(out, sizeof out, "%s/out.exr", folder);
    const struct relume_limits limits = {.max_memory = 2 * 2 * BYTES};
    check_kept_with(relume_capture_params(.keep_bytes = BYTES, .scratch = out), HEIGHT,
                    (const int[]){0, 0, 0});
    check_kept_with(relume_capture_params(.keep_bytes = 1, .scratch = out, .limits = &limits),
                    HEIGHT, (const int[]){0, 0, 1});
    check_kept_with(relume_capture_params(.keep_bytes = BYTES, .scratch = out), HEIGHT - 8,
                    (const int[]){1, 1, 1});
}

// A table that was closed early leaves nothing, and gives its memory back.
static void test_part_is_not_kept(void **state)
{
    (void)state;
    check_kept(LIGHTS * BYTES, HEIGHT - 8, (const int[]){1, 1, 1});
}

// Two at once: the first to end is kept, the other's copies go.
static void test_two_tables(void **state)
{
    (void)state;
    static float out[LIGHTS * BYTES];
    relume_table *tables[2];
    write_images(0);
    relume_capture *capture = open_capture(2 * LIGHTS * BYTES);
    for (int t = 0; t < 2; t++)
        CHECK_OK(relume_table_open(&tables[t], capture, 0, NULL));
    for (int t = 0; t < 2; t++)
        CHECK_OK(relume_table_read(tables[t], HEIGHT, out));
    for (int t = 0; t < 2; t++)
        relume_table_destroy(&tables[t]);
    write_images(1);
    check_table(capture, HEIGHT, (const int[]){0, 0, 0});
    relume_capture_destroy(&capture);
}

// Fetched rows are what read ones are, for bytes in the file's own curve and in another, for pieces
// of a band, and for floating-point files.
static void check_fetched(const char *name, struct relume_transfer display)
{
    static float want[LIGHTS * BYTES], got[3 * WIDTH * 8];
    char path[128];
    relume_capture *capture;
    relume_table *table;
    struct relume_image image;
    write_images(0);
    CHECK_OK(relume_image_create(&image, WIDTH, HEIGHT, 3));
    for (int k = 0; k < BYTES; k++)
        image.data[k] = 0.01f * (float)(k % 97);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    CHECK_OK(relume_image_save(&image, path, NULL));
    relume_image_destroy(&image);
    snprintf(path, sizeof path, "%s/fetch.lp", folder);
    FILE *lp = fopen(path, "w");
    fprintf(lp, "3\n%s 0 0 1\n1.png 0.6 0 0.8\n2.png 0 0.6 0.8\n", name);
    fclose(lp);
    CHECK_OK(relume_capture_open(&capture, path, NULL));
    CHECK_OK(relume_table_open(&table, capture, 0, relume_table_params(.display = display)));
    CHECK_OK(relume_table_read(table, HEIGHT, want));
    relume_table_destroy(&table);
    CHECK_OK(relume_table_open(&table, capture, 0, relume_table_params(.display = display)));
    for (int row = 0; row < HEIGHT; row += 8) {
        CHECK_OK(relume_table_fetch(table, 8));
        for (int i = 0; i < LIGHTS; i++) {
            const int first = 3 * i, n = WIDTH * 8 - first;
            relume_table_planes(table, i, (size_t)first, (size_t)n, got, WIDTH * 8);
            for (int x = 0; x < n; x++)
                for (int c = 0; c < 3; c++)
                    assert_true(got[c * WIDTH * 8 + x] ==
                                want[i * BYTES + (row * WIDTH + first + x) * 3 + c]);
        }
    }
    assert_int_equal(relume_table_fetch(table, 1), RELUME_EINVAL);
    relume_table_destroy(&table);
    relume_capture_destroy(&capture);
}

static void test_fetched_rows(void **state)
{
    (void)state;
    check_fetched("0.png", (struct relume_transfer){.curve = RELUME_CURVE_SRGB});
    check_fetched("0.png", (struct relume_transfer){.curve = RELUME_CURVE_LINEAR});
    check_fetched("0.exr", (struct relume_transfer){.curve = RELUME_CURVE_SRGB});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_nothing_is_kept, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_fetched_rows, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_all_are_kept, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_budget, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_the_rest_is_on_disk, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_part_is_not_kept, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_two_tables, make_folder, remove_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
