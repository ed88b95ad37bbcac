// test_join.c - parts that become one file: what each has counted of its rows is counted once
#include "format/team/folder.h"

#include "test.h"

#include "capture_fixture.h"
#include "in_folder.h"

enum { PARTS = 3, HEIGHT = 96 };
static const struct fixture rows = {.width = 8, .height = HEIGHT, .lights = 5, .views = 1};

// Image 0 is lit in the rows of the second part alone, image 1 nowhere.
static void darken(void)
{
    struct relume_image image;
    for (int i = 0; i < 2; i++) {
        const char *name = path_of(i ? "v0-1.exr" : "v0-0.exr");
        CHECK_OK(relume_image_load(&image, name, NULL));
        for (int y = 0; y < HEIGHT; y++)
            if (i || y < HEIGHT / PARTS || y >= 2 * HEIGHT / PARTS)
                memset(image.data + (size_t)y * 24, 0, 24 * sizeof *image.data);
        CHECK_OK(relume_image_save(&image, name, NULL));
        relume_image_destroy(&image);
    }
}

static void encode_part(const char *name, int part, bool together, struct relume_fidelity *report)
{
    relume_team_files *files = NULL;
    relume_capture *capture;
    relume_coder *coder;
    if (together)
        CHECK_OK(
            relume_team_folder(&files, path_of("learnt"), part - 1, PARTS, "rows", false, NULL));
    CHECK_OK(relume_capture_open(&capture, folder, relume_capture_params(.allow_outside = true)));
    CHECK_OK(relume_coder_learn(&coder, &relume_basis_table, capture, NULL, NULL));
    CHECK_OK(relume_pack_encode(
        capture, coder, path_of(name), report,
        relume_pack_encode_params(.part = part, .parts = part ? PARTS : 0, .threads = 1,
                                  .team = together ? relume_team_of_folder(files) : NULL)));
    relume_coder_destroy(&coder);
    relume_capture_destroy(&capture);
    relume_team_folder_destroy(&files);
}

// Rows that wait for the others', and such as are packed already.
static void check_census(bool together)
{
    static const char *const name[PARTS] = {"1.part", "2.part", "3.part"};
    struct relume_fidelity whole, joined, own;
    encode_part("whole.exr", 0, false, &whole);
    for (int i = 0; i < PARTS; i++)
        encode_part(name[i], i + 1, together, &own);
    const char *parts[PARTS] = {path_of(name[0]), path_of(name[1]), path_of(name[2])};
    CHECK_OK(relume_pack_join(parts, PARTS, path_of("joined.exr"), &joined, NULL));
    assert_int_equal(whole.census.black_images, 1);
    assert_int_equal(joined.census.black_images, whole.census.black_images);
    assert_int_equal(joined.census.pixels, whole.census.pixels);
    assert_int_equal(joined.census.black, whole.census.black);
    assert_int_equal(joined.census.clipped, whole.census.clipped);
    assert_int_equal(joined.census.always_clipped, whole.census.always_clipped);
}

static void test_rows_that_wait(void **state)
{
    (void)state;
    check_census(false);
}

static void test_rows_that_are_packed(void **state)
{
    (void)state;
    check_census(true);
}

static int make_capture(void **state)
{
    make_folder(state);
    fixture_write(&rows, folder);
    darken();
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_that_wait),
        cmocka_unit_test(test_rows_that_are_packed),
    };
    return cmocka_run_group_tests(tests, make_capture, remove_folder);
}
