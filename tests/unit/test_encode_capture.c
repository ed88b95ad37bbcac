// test_encode_capture.c - one call makes a file with every decision, says how good it is, and
// refuses what cannot be before it begins
#include "test.h"

#include "capture_fixture.h"
#include "in_folder.h"

#define PARAMS(...) relume_encode_capture_params(__VA_ARGS__)
#define PIXELS      ((double)fixed.width * fixed.height)

static const struct fixture fixed = {
    .width = 24, .height = 32, .lights = 12, .views = 1, .hemisphere = true};
static relume_capture *capture;

struct bytes {
    unsigned char *data;
    size_t size;
};

static struct bytes bytes_of(const char *name)
{
    struct bytes out = {0};
    FILE *f = fopen(path_of(name), "rb");
    assert_non_null(f);
    assert_int_equal(fseek(f, 0, SEEK_END), 0);
    out.size = (size_t)ftell(f);
    rewind(f);
    out.data = malloc(out.size);
    assert_int_equal(fread(out.data, 1, out.size, f), out.size);
    fclose(f);
    return out;
}

static void check_same(const char *name, const struct relume_buffer *buffer)
{
    const struct bytes file = bytes_of(name);
    assert_int_equal(file.size, buffer->size);
    assert_memory_equal(file.data, buffer->data, file.size);
    free(file.data);
}

static void encode_to_memory(struct relume_buffer *out, struct relume_encode_result *result,
                             const struct relume_encode_capture_params *params)
{
    struct relume_encode_capture_params p = *params;
    const struct relume_writer writer = relume_buffer_writer(out);
    p.writer = &writer;
    CHECK_OK(relume_encode_capture(NULL, capture, result, &p));
    assert_true(out->whole);
}

// ---------------------------------------------------------------- what is made

static void test_defaults(void **state)
{
    (void)state;
    struct relume_encode_result r, in_memory;
    struct relume_buffer buffer = {0};
    relume_pack *pack;
    CHECK_OK(relume_encode_capture(path_of("usual.exr"), capture, &r, NULL));
    const struct bytes file = bytes_of("usual.exr");
    assert_int_equal(r.made, RELUME_ENCODED_FILE);
    assert_int_equal(r.lights, fixed.lights);
    assert_int_equal(r.views, 1);
    assert_false(r.lossy);
    assert_int_equal(r.reach, RELUME_REACHED);
    assert_int_equal(r.shadows.outcome, RELUME_MOVING_UNSUITED);
    assert_string_equal(r.shadows.expected, "depth in every view");
    assert_int_equal(r.highlights.outcome, RELUME_MOVING_UNTRIED);  // 24 pixels are no photograph
    assert_true(r.measured.psnr_db > RELUME_USUAL_DB);
    assert_true(r.unseen_db > 20.0 && r.unseen_db < r.measured.psnr_db);
    CHECK_NEAR(r.quality_db, RELUME_USUAL_DB, 0.0);
    CHECK_NEAR(r.file_bytes, (double)file.size, 0.0);
    CHECK_NEAR(r.bytes_per_pixel, (double)file.size / PIXELS, 1e-12);
    assert_true(r.photograph_bytes > 12.0 * PIXELS);
    free(file.data);
    CHECK_OK(relume_pack_open(&pack, path_of("usual.exr"), NULL));
    assert_int_equal(relume_pack_info(pack)->coefficients, r.coefficients);
    assert_int_equal(relume_pack_info(pack)->domain, r.domain);
    assert_int_equal(relume_pack_info(pack)->storage, r.storage);
    assert_ptr_equal(relume_coder_info(relume_pack_info(pack)->coder)->basis, r.basis);
    relume_pack_destroy(&pack);
    encode_to_memory(&buffer, &in_memory, PARAMS(.threads = 3));
    check_same("usual.exr", &buffer);
    CHECK_NEAR(in_memory.file_bytes, r.file_bytes, 0.0);
    relume_buffer_destroy(&buffer);
}

// The command takes these for `--basis sh --coefficients 4`.
static void test_a_basis_leaves_nothing_open(void **state)
{
    (void)state;
    struct relume_encode_result r;
    CHECK_OK(relume_encode_capture(path_of("sh.exr"), capture, &r,
                                   PARAMS(.basis = &relume_basis_sh, .coefficients = 4)));
    CHECK_OK(fixture_encode(folder, path_of("by-hand.exr"), &relume_basis_sh, 4, NULL));
    const struct bytes by_hand = bytes_of("by-hand.exr");
    check_same("sh.exr", &(struct relume_buffer){.data = by_hand.data, .size = by_hand.size});
    free(by_hand.data);
    assert_int_equal(r.coefficients, 4);
    assert_int_equal(r.storage, RELUME_STORE_8);
    assert_int_equal(r.shadows.outcome, RELUME_MOVING_UNTRIED);
    CHECK_NEAR(r.quality_db, 0.0, 0.0);
}

static void test_quality_that_is_out_of_reach(void **state)
{
    (void)state;
    struct relume_encode_result r;
    CHECK_OK(relume_encode_capture(path_of("a.exr"), capture, &r, PARAMS(.psnr_db = 10.0)));
    assert_true(r.lossy);
    assert_int_equal(r.reach, RELUME_REACH_PSNR_BELOW);
    CHECK_OK(relume_encode_capture(path_of("a.exr"), capture, &r,
                                   PARAMS(.psnr_db = 60.0, .coefficients = 2)));
    assert_int_equal(r.coefficients, 2);
    assert_int_equal(r.reach, RELUME_REACH_PSNR_ABOVE);
    CHECK_OK(relume_encode_capture(path_of("a.exr"), capture, &r, PARAMS(.bytes_per_pixel = 1e-3)));
    assert_int_equal(r.reach, RELUME_REACH_BYTES_BELOW);
    CHECK_OK(relume_encode_capture(path_of("a.exr"), capture, &r, PARAMS(.bytes_per_pixel = 100)));
    assert_int_equal(r.reach, RELUME_REACH_BYTES_ABOVE);
}

static void test_losses_that_are_not_seen(void **state)
{
    (void)state;
    const struct relume_encode_capture_params *params =
        PARAMS(.jnd = 20.0, .basis = &relume_basis_pca, .coefficients = 5);
    struct relume_encode_result r, in_memory;
    struct relume_buffer buffer = {0};
    CHECK_OK(relume_encode_capture(path_of("seen.exr"), capture, &r, params));
    assert_true(r.jnd > 0.0 && r.jnd <= 20.0);
    assert_int_equal(r.reach, RELUME_REACHED);
    encode_to_memory(&buffer, &in_memory, params);
    check_same("seen.exr", &buffer);
    CHECK_NEAR(in_memory.jnd, r.jnd, 0.0);
    relume_buffer_destroy(&buffer);
    // two coefficients cannot hide a kink
    CHECK_OK(
        relume_encode_capture(path_of("seen.exr"), capture, &r,
                              PARAMS(.jnd = 0.05, .basis = &relume_basis_pca, .coefficients = 2)));
    assert_true(r.jnd > 0.05);
    assert_int_equal(r.reach, RELUME_REACH_JND);
}

// A highlight of 1000 beside values below 1: nobody asked for 8 bits, and with them it is said.
static void test_steps_that_are_too_coarse(void **state)
{
    (void)state;
    enum { LIGHTS = 6, SIDE = 16 };
    static float pictures[LIGHTS][SIDE][SIDE];
    struct relume_vec3 lights[LIGHTS];
    struct relume_encode_result r;
    struct relume_buffer buffer = {0};
    const struct relume_writer writer = relume_buffer_writer(&buffer);
    relume_capture *bright;
    CHECK_OK(relume_directions_make(lights, LIGHTS, relume_pattern_find("hammersley"),
                                    relume_directions_params(.hemisphere = true)));
    for (int i = 0; i < LIGHTS; i++)
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++)
                pictures[i][y][x] = x == 5 && y == 5 ? 1000.0f : 0.01f * (float)(1 + x + i);
    CHECK_OK(relume_capture_create(
        &bright, &(const struct relume_manifest){.lights = LIGHTS, .directions = lights},
        &(const struct relume_pictures){
            .width = SIDE, .height = SIDE, .channels = 1, .data = pictures},
        NULL));
    CHECK_OK(relume_encode_capture(NULL, bright, &r,
                                   PARAMS(.basis = &relume_basis_table, .writer = &writer)));
    assert_int_equal(r.storage, RELUME_STORE_HALF);
    assert_false(r.is_coarse);
    CHECK_NEAR(r.file_bytes, (double)buffer.size, 0.0);
    CHECK_NEAR(r.photograph_bytes, 0.0, 0.0);
    CHECK_OK(relume_encode_capture(
        NULL, bright, &r,
        PARAMS(.basis = &relume_basis_table, .storage = RELUME_STORE_8, .writer = &writer)));
    assert_int_equal(r.storage, RELUME_STORE_8);
    assert_true(r.is_coarse);
    relume_buffer_destroy(&buffer);
    relume_capture_destroy(&bright);
}

// ---------------------------------------------------------------- parts

static void test_parts(void **state)
{
    (void)state;
    struct relume_encode_result r;
    char part[2][128], learnt[128];
    snprintf(part[0], sizeof part[0], "%s", path_of("1.part"));
    snprintf(part[1], sizeof part[1], "%s", path_of("2.part"));
    snprintf(learnt, sizeof learnt, "%s", path_of("learnt"));
    struct relume_encode_capture_params p = {
        .basis = &relume_basis_pca, .parts = 2, .learnt = learnt, .options = "pca"};
    p.learn_only = true;
    p.part = 1;
    CHECK_OK(relume_encode_capture(part[0], capture, &r, &p));
    assert_int_equal(r.made, RELUME_LEARNT_STEP);
    p.part = 2;
    for (int i = 0; i < 8; i++, p.part = 3 - p.part) {
        CHECK_OK(relume_encode_capture(part[0], capture, &r, &p));
        assert_true(r.made == RELUME_LEARNT_STEP || r.made == RELUME_LEARNT_ALL);
    }
    assert_int_equal(r.made, RELUME_LEARNT_ALL);
    p.learn_only = false;
    for (int i = 0; i < 2; i++) {
        p.part = i + 1;
        CHECK_OK(relume_encode_capture(part[i], capture, &r, &p));
        assert_int_equal(r.made, RELUME_ENCODED_PART);
    }
    CHECK_OK(relume_pack_join((const char *const[]){part[0], part[1]}, 2, path_of("joined.exr"),
                              NULL, NULL));
    CHECK_OK(relume_encode_capture(path_of("whole.exr"), capture, &r,
                                   PARAMS(.basis = &relume_basis_pca)));
    const struct bytes whole = bytes_of("whole.exr");
    check_same("joined.exr", &(struct relume_buffer){.data = whole.data, .size = whole.size});
    free(whole.data);
    // harmonics learn nothing, and one view of one part has no steps to share
    p = (struct relume_encode_capture_params){.basis = &relume_basis_sh,
                                              .part = 1,
                                              .parts = 1,
                                              .learnt = path_of("nothing"),
                                              .learn_only = true};
    CHECK_OK(relume_encode_capture(part[0], capture, &r, &p));
    assert_int_equal(r.made, RELUME_LEARNT_NOTHING);
    assert_int_equal(access(path_of("nothing"), F_OK), -1);
}

// ---------------------------------------------------------------- what is refused

struct refusal {
    struct relume_encode_capture_params params;
    relume_status status;
    const char *says;
};

static void check_refusal(const struct refusal *r)
{
    struct test_log log;
    struct relume_encode_result result = {.coefficients = 7};
    struct relume_encode_capture_params p = r->params;
    test_log_init(&log);
    p.log = &log.log;
    p.name = "statue";
    assert_int_equal(relume_encode_capture(path_of("none.exr"), capture, &result, &p), r->status);
    if (!strstr(log.text, r->says))
        fail_msg("'%s'; expected '%s'", log.text, r->says);
    assert_int_equal(access(path_of("none.exr"), F_OK), -1);
    assert_int_equal(result.coefficients, 0);
    test_log_init(&log);
    assert_int_equal(relume_encode_check(&p),
                     r->status == RELUME_EINVAL ? RELUME_EINVAL : RELUME_OK);
    assert_int_equal(log.lines, r->status == RELUME_EINVAL);
}

static void test_refusals(void **state)
{
    (void)state;
    const struct relume_books_params books = {.codes = 4};
    const struct relume_team team = {.members = 2};
    const struct refusal refusals[] = {
        {{.quality_db = 30, .basis = &relume_basis_sh}, RELUME_EINVAL, "--quality chooses"},
        {{.quality_db = 30, .coefficients = 9}, RELUME_EINVAL, "--quality chooses"},
        {{.quality_db = 30, .robust = true}, RELUME_EINVAL, "--quality chooses"},
        {{.quality_db = 30, .books = &books}, RELUME_EINVAL, "--quality chooses"},
        {{.psnr_db = 30, .bytes_per_pixel = 1}, RELUME_EINVAL, "expected one of the first two"},
        {{.psnr_db = 30, .storage = RELUME_STORE_8}, RELUME_EINVAL, "choose bits"},
        {{.psnr_db = 30, .step = RELUME_STEP_PLANE}, RELUME_EINVAL, "choose bits"},
        {{.psnr_db = 30, .compression = RELUME_COMPRESS_ZIP}, RELUME_EINVAL, "choose bits"},
        {{.psnr_db = 30, .quality_db = 30}, RELUME_EINVAL, "choose bits"},
        {{.bytes_per_pixel = 1, .books = &books}, RELUME_EINVAL, "choose bits"},
        {{.psnr_db = 30, .display = {.curve = RELUME_CURVE_LOG}}, RELUME_EINVAL, "domain log"},
        {{.jnd = 1, .psnr_db = 30}, RELUME_EINVAL, "--jnd encodes several times"},
        {{.jnd = 1, .part = 1, .parts = 2}, RELUME_EINVAL, "--jnd encodes several times"},
        {{.jnd = 1, .team = &team}, RELUME_EINVAL, "of one process"},
        {{.team = &team, .part = 1, .parts = 2}, RELUME_EINVAL, "relume-mpi makes the parts"},
        {{.learn_only = true, .part = 1, .parts = 2}, RELUME_EINVAL, "expected --learnt FOLDER"},
        {{.learnt = "learnt"}, RELUME_EINVAL, "--learnt is what parts share"},
        {{.part = 3, .parts = 2}, RELUME_EINVAL, "expected part 1 to 2 of 2; found 3"},
        {{.part = 1, .parts = 2, .learnt = "learnt", .options = "a\nb"}, RELUME_EINVAL, "one line"},
        {{.part = 1, .parts = 2, .books = &books, .share = true}, RELUME_EINVAL, "--share learns"},
        {{.psnr_db = 9}, RELUME_EINVAL, "--psnr: expected 10 to 60; found 9"},
        {{.jnd = -1}, RELUME_EINVAL, "--jnd: expected 0.05 to 100; found -1"},
        {{.bytes_per_pixel = (double)NAN}, RELUME_EINVAL, "--bytes-per-pixel: expected"},
        {{.coefficients = 5000}, RELUME_EINVAL, "--coefficients: expected 1 to 4096"},
        {{.ridge = 1.5}, RELUME_EINVAL, "--ridge: expected 0 to 1"},
        // what this capture cannot have
        {{.shadows = RELUME_MOVING_YES},
         RELUME_EUNFIT,
         "statue: shadows cannot be traced; expected depth in every view"},
        {{.highlights = RELUME_MOVING_YES},
         RELUME_EUNFIT,
         "statue: highlights cannot move; expected at least 16 lights"},
        {{.basis = &relume_basis_sh, .coefficients = 16}, RELUME_EUNFIT, "statue: "},
    };
    for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++)
        check_refusal(&refusals[i]);
}

static void test_no_output(void **state)
{
    (void)state;
    struct relume_buffer buffer = {0};
    const struct relume_writer writer = relume_buffer_writer(&buffer);
    const struct relume_team team = {.members = 2};
    assert_int_equal(relume_encode_capture(NULL, capture, NULL, NULL), RELUME_EINVAL);
    assert_int_equal(
        relume_encode_capture(NULL, capture, NULL, PARAMS(.team = &team, .writer = &writer)),
        RELUME_EINVAL);
    assert_null(buffer.data);
}

static void test_rereads(void **state)
{
    (void)state;
    assert_true(relume_encode_rereads(NULL));
    assert_true(relume_encode_rereads(PARAMS(.basis = &relume_basis_pca)));
    assert_true(relume_encode_rereads(PARAMS(.basis = &relume_basis_table, .psnr_db = 30)));
    assert_true(relume_encode_rereads(PARAMS(.basis = &relume_basis_sh, .jnd = 1)));
    assert_false(relume_encode_rereads(PARAMS(.basis = &relume_basis_table)));
    assert_false(relume_encode_rereads(PARAMS(.basis = &relume_basis_sh, .psnr_db = 30)));
}

static int open_capture(void **state)
{
    make_folder(state);
    fixture_write(&fixed, folder);
    return relume_capture_open(&capture, folder, relume_capture_params(.allow_outside = true));
}

static int close_capture(void **state)
{
    relume_capture_destroy(&capture);
    return remove_folder(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_a_basis_leaves_nothing_open),
        cmocka_unit_test(test_quality_that_is_out_of_reach),
        cmocka_unit_test(test_losses_that_are_not_seen),
        cmocka_unit_test(test_steps_that_are_too_coarse),
        cmocka_unit_test(test_parts),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_no_output),
        cmocka_unit_test(test_rereads),
    };
    return cmocka_run_group_tests(tests, open_capture, close_capture);
}
