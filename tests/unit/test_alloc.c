// test_alloc.c - every allocation fails once: no crash, no leak (under ASan), no half-made output
#include "test.h"

#include "capture_fixture.h"
#include "capture/acquire/ball.h"
#include "capture/acquire/photometric.h"
#include "capture/manifest/reflectance_table.h"
#include "core/base/memory.h"
#include "format/coder/coding.h"

#include <dirent.h>
#include <sys/stat.h>

static char folder[64], part[80], part_path[112], capture_path[96], lp_path[96], pack_path[96],
    pca_path[96], out_path[96];

static int setup(void **state)
{
    (void)state;
    const struct fixture f = {.width = 9,
                              .height = 20,
                              .lights = 6,
                              .views = 2,
                              .hemisphere = true,
                              .depth = true,
                              .mask = true};
    // What only the coder changes is tried on one view.
    const struct fixture plain = {.width = 9, .height = 20, .lights = 6, .views = 1};
    test_folder(folder);
    fixture_write(&f, folder);
    snprintf(part, sizeof part, "%s/part", folder);
    snprintf(part_path, sizeof part_path, "%s/capture.json", part);
    assert_int_equal(mkdir(part, 0777), 0);
    fixture_write(&plain, part);
    snprintf(capture_path, sizeof capture_path, "%s/capture.json", folder);
    snprintf(lp_path, sizeof lp_path, "%s/dirs.lp", folder);
    snprintf(pack_path, sizeof pack_path, "%s/pack.exr", folder);
    snprintf(pca_path, sizeof pca_path, "%s/pca.exr", folder);
    snprintf(out_path, sizeof out_path, "%s/out.exr", folder);
    static const char lp[] = "3\nv0-0.exr 0 0 1\nV0-1.EXR 1 0 1\n\nC:\\x\\v0-2.exr 0 1 1\n";
    test_write(lp_path, lp, sizeof lp - 1);
    return fixture_encode(folder, pca_path, &relume_basis_pca, 4, NULL) ||
           fixture_encode(folder, pack_path, &relume_basis_sh, 4, NULL);
}

static int teardown(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

// Let the 1st, 2nd, ... allocation of `work` fail until it succeeds; returns how many there were.
static int sweep(relume_status (*work)(void))
{
    enum { MOST = 20000 };
    for (int n = 1; n < MOST; n++) {
        mem_fail_after(n);
        const relume_status status = work();
        const bool all_done = mem_fail_pending();
        mem_fail_after(0);
        if (all_done) {  // fewer than n allocations: none has failed
            CHECK_OK(status);
            return n - 1;
        }
        assert_int_equal(status, RELUME_ENOMEM);
    }
    fail_msg("never succeeds");
    return 0;
}

static relume_status open_capture(void)
{
    relume_capture *c = (void *)1;
    const relume_status status = relume_capture_open(&c, capture_path, NULL);
    assert_true(status ? c == NULL : c != NULL);
    relume_capture_destroy(&c);
    return status;
}

static relume_status open_lp(void)
{
    relume_capture *c = (void *)1;
    const relume_status status =
        relume_capture_open(&c, lp_path, relume_capture_params(.skip_missing = true));
    assert_true(status ? c == NULL : c != NULL);
    relume_capture_destroy(&c);
    return status;
}

static relume_status read_table(void)
{
    static float rows[6 * 20 * 9 * 3];
    relume_capture *c;
    relume_table *table = NULL;
    relume_status status = relume_capture_open(&c, capture_path, NULL);
    if (!status)
        status = relume_table_open(&table, c, 1, relume_table_params(.threads = 1));
    if (!status)
        status = relume_table_read(table, 20, rows);
    relume_table_destroy(&table);
    relume_capture_destroy(&c);
    return status;
}

static relume_status encode_pack(void)
{
    unlink(out_path);
    const relume_status status = fixture_encode(folder, out_path, &relume_basis_sh, 4,
                                                relume_pack_encode_params(.threads = 1));
    assert_true((access(out_path, F_OK) == 0) == (status == RELUME_OK));
    return status;
}

static relume_status encode_table(void)
{
    return fixture_encode(part, out_path, &relume_basis_table, 0,
                          relume_pack_encode_params(.threads = 1, .storage = RELUME_STORE_HALF));
}

static relume_status encode_chosen(void)
{
    unlink(out_path);
    const relume_status status = fixture_encode_with(
        part, out_path, &relume_basis_pca, relume_coder_params(.coefficients = 5, .choose = true),
        relume_pack_encode_params(.threads = 1));
    assert_true((access(out_path, F_OK) == 0) == (status == RELUME_OK));
    return status;
}

static relume_status encode_luminance(void)
{
    return fixture_encode_with(part, out_path, &relume_basis_dct,
                               relume_coder_params(.coefficients = 3, .luminance = true),
                               relume_pack_encode_params(.threads = 1));
}

static relume_status encode_resampled(void)
{
    return fixture_encode(part, out_path, &relume_basis_dct_resampled, 3,
                          relume_pack_encode_params(.threads = 1));
}

// Every interpolant once: what it prepares is all that differs.
static relume_status prepare_interpolants(void)
{
    relume_capture *c;
    relume_status status = relume_capture_open(&c, capture_path, NULL);
    for (int i = 0; !status && relume_interpolants[i]; i++) {
        if (!strcmp(relume_interpolants[i]->name, "octahedral"))
            continue;  // whose lights are a grid
        const struct relume_manifest *m = relume_capture_manifest(c);
        relume_coder *coder = (void *)1;
        status = relume_coder_create(&coder, &relume_basis_table, m->directions, m->lights,
                                     relume_coder_params(.interpolant = relume_interpolants[i]));
        assert_true(status ? coder == NULL : coder != NULL);
        relume_coder_destroy(&coder);
    }
    relume_capture_destroy(&c);
    return status;
}

static relume_status read_components(void)
{
    relume_pack *pack = (void *)1;
    relume_status status = relume_pack_open(&pack, pca_path, relume_pack_params(.threads = 1));
    const struct relume_light light = {.direction = {0, 1, 1}, .rgb = {1, 1, 1}};
    struct relume_image frame = {0};
    assert_true(status ? pack == NULL : pack != NULL);
    if (!status)
        status = relume_frame(&frame, pack, &(struct relume_camera){.framing = RELUME_FRAME_VIEW},
                              &light, 1, relume_frame_params(.threads = 1));
    relume_image_destroy(&frame);
    relume_pack_destroy(&pack);
    return status;
}

static relume_status read_pack(void)
{
    relume_pack *pack = (void *)1;
    const struct relume_codes *codes;
    struct relume_image depth = {0}, mask = {0}, frame = {0};
    relume_status status = relume_pack_open(&pack, pack_path, relume_pack_params(.threads = 1));
    assert_true(status ? pack == NULL : pack != NULL);
    if (!status)
        status = relume_pack_codes(&codes, pack, 0);
    if (!status)
        status = relume_pack_depth(&depth, pack, 0);
    if (!status)
        status = relume_pack_mask(&mask, pack, 1);
    const struct relume_light light = {.direction = {0, 1, 1}, .rgb = {1, 1, 1}};
    const struct relume_camera camera = {.framing = RELUME_FRAME_EYE, .eye = {0.5, 0, 3}};
    if (!status)
        status = relume_frame(&frame, pack, &camera, &light, 1, relume_frame_params(.threads = 1));
    assert_true((frame.data != NULL) == (status == RELUME_OK));
    relume_image_destroy(&frame);
    relume_image_destroy(&depth);
    relume_image_destroy(&mask);
    relume_pack_destroy(&pack);
    return status;
}

static relume_status pack_in_memory(void)
{
    struct relume_buffer buffer = {0};
    const struct relume_writer writer = relume_buffer_writer(&buffer);
    relume_pack *pack = NULL;
    const struct relume_codes *codes;
    relume_status status =
        fixture_encode(part, NULL, &relume_basis_sh, 4,
                       relume_pack_encode_params(.threads = 1, .writer = &writer));
    assert_true((buffer.data != NULL) == (status == RELUME_OK));
    const struct relume_reader reader = relume_memory_reader(buffer.data, buffer.size);
    if (!status)
        status = relume_pack_open(&pack, NULL, relume_pack_params(.threads = 1, .reader = &reader));
    if (!status)
        status = relume_pack_codes(&codes, pack, 0);
    relume_pack_destroy(&pack);
    relume_buffer_destroy(&buffer);
    return status;
}

static relume_status images_in_memory(void)
{
    static const char *const names[] = {"a.png", "a.jpg"};
    struct relume_image image, got = {0};
    relume_status status = relume_image_create(&image, 6, 5, 3);
    for (int i = 0; !status && i < 2; i++) {
        struct relume_buffer buffer = {0};
        const struct relume_writer writer = relume_buffer_writer(&buffer);
        status = relume_image_save(&image, names[i], relume_image_params(.writer = &writer));
        const struct relume_reader reader = relume_memory_reader(buffer.data, buffer.size);
        if (!status)
            status = relume_image_load(&got, NULL, relume_image_params(.reader = &reader));
        relume_image_destroy(&got);
        relume_buffer_destroy(&buffer);
    }
    relume_image_destroy(&image);
    return status;
}

static relume_status compare_images(void)
{
    struct relume_image a = {0};
    struct relume_difference d;
    char path[96];
    snprintf(path, sizeof path, "%s/v0-0.exr", folder);
    relume_status status = relume_image_load(&a, path, NULL);
    assert_true((a.data != NULL) == (status == RELUME_OK));
    if (!status)
        status = relume_image_compare(&d, &a, &a, relume_compare_params(.threads = 1));
    relume_image_destroy(&a);
    return status;
}

static relume_status save_png(void)
{
    struct relume_image a = {0};
    char path[96];
    snprintf(path, sizeof path, "%s/v0-0.exr", folder);
    relume_status status = relume_image_load(&a, path, NULL);
    snprintf(path, sizeof path, "%s/saved.png", folder);
    if (!status)
        status = relume_image_save(&a, path, NULL);
    relume_image_destroy(&a);
    return status;
}

static relume_status evaluate(void)
{
    relume_pack *pack = NULL;
    relume_capture *capture = NULL;
    struct relume_evaluation e = {0};
    relume_status status = relume_pack_open(&pack, pack_path, relume_pack_params(.threads = 1));
    if (!status)
        status = relume_capture_open(&capture, capture_path, NULL);
    if (!status)
        status = relume_evaluate(&e, pack, capture, relume_evaluate_params(.threads = 1));
    assert_true((e.light != NULL) == (status == RELUME_OK && pack && capture));
    relume_evaluation_destroy(&e);
    relume_capture_destroy(&capture);
    relume_pack_destroy(&pack);
    return status;
}

static relume_status judge(void)
{
    const struct relume_books_params books = {.codes = 3};
    const struct relume_heldout_store store[2] = {{.storage = RELUME_STORE_8}, {.books = &books}};
    struct relume_heldout_quality before, after[2];
    relume_capture *capture = NULL;
    relume_heldout *h = (void *)1;
    relume_status status = relume_capture_open(&capture, part_path, NULL);
    if (!status) {
        status =
            relume_heldout_open(&h, capture, relume_heldout_params(.leave_out = 3, .threads = 1));
        assert_true(status ? h == NULL : h != NULL);
    }
    if (!status)
        status = relume_heldout_measure(h, &relume_basis_sh, relume_coder_params(.coefficients = 1),
                                        store, 2, &before, after);
    if (capture)
        relume_heldout_destroy(&h);
    relume_capture_destroy(&capture);
    return status;
}

#define SWEEP(name, least)                                                                         \
    static void test_##name(void **state)                                                          \
    {                                                                                              \
        (void)state;                                                                               \
        assert_true(sweep(name) >= (least));                                                       \
    }
SWEEP(open_capture, 20)
SWEEP(open_lp, 10)
SWEEP(read_table, 20)
SWEEP(encode_pack, 60)
SWEEP(encode_table, 60)
SWEEP(encode_chosen, 100)
SWEEP(encode_luminance, 60)
SWEEP(encode_resampled, 60)
SWEEP(prepare_interpolants, 30)
SWEEP(read_components, 20)
SWEEP(read_pack, 30)
SWEEP(pack_in_memory, 80)
SWEEP(images_in_memory, 10)
SWEEP(compare_images, 5)
SWEEP(save_png, 4)
SWEEP(evaluate, 60)
SWEEP(judge, 60)

static relume_status fit_normals(void)
{
    relume_capture *capture;
    struct relume_photometric p = {0};
    struct relume_image height = {0};
    relume_status status = relume_capture_open(&capture, capture_path, NULL);
    if (!status)
        status = relume_photometric_fit(&p, capture, 0, relume_photometric_params(.threads = 1));
    if (!status)
        status = relume_height_integrate(&height, &p.normal, NULL);
    relume_image_destroy(&height);
    relume_photometric_destroy(&p);
    relume_capture_destroy(&capture);
    return status;
}

static void test_fit_normals(void **state)
{
    (void)state;
    assert_true(sweep(fit_normals) > 10);
}

// A dark disc on a bright ground, small enough for one level and a half.
static relume_status find_ball(void)
{
    enum { SIDE = 48 };
    const struct relume_ball_camera camera = {SIDE, SIDE, 0.0};
    struct relume_image image;
    struct relume_ball ball;
    relume_status status = relume_image_create(&image, SIDE, SIDE, 1);
    for (int i = 0; !status && i < SIDE * SIDE; i++)
        image.data[i] = hypot(i % SIDE - 23.0, i / SIDE - 24.0) < 11.0 ? 0.02f : 0.5f;
    if (!status)
        status = relume_ball_find(&ball, 1, &image, &camera, NULL);
    relume_image_destroy(&image);
    return status;
}

static void test_find_ball(void **state)
{
    (void)state;
    assert_true(sweep(find_ball) > 10);
}

static void test_nothing_is_left(void **state)
{
    (void)state;
    DIR *dir = opendir(folder);
    for (struct dirent *e; (e = readdir(dir));)
        assert_true(!strstr(e->d_name, ".part") && strncmp(e->d_name, ".relume", 7));
    closedir(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_open_capture),     cmocka_unit_test(test_open_lp),
        cmocka_unit_test(test_read_table),       cmocka_unit_test(test_encode_pack),
        cmocka_unit_test(test_encode_table),     cmocka_unit_test(test_read_pack),
        cmocka_unit_test(test_compare_images),   cmocka_unit_test(test_save_png),
        cmocka_unit_test(test_evaluate),         cmocka_unit_test(test_judge),
        cmocka_unit_test(test_encode_chosen),    cmocka_unit_test(test_encode_luminance),
        cmocka_unit_test(test_encode_resampled), cmocka_unit_test(test_prepare_interpolants),
        cmocka_unit_test(test_read_components),  cmocka_unit_test(test_fit_normals),
        cmocka_unit_test(test_find_ball),        cmocka_unit_test(test_pack_in_memory),
        cmocka_unit_test(test_images_in_memory), cmocka_unit_test(test_nothing_is_left),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
