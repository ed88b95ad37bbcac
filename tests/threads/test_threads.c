// test_threads.c - the same bits for 1, 2 and 7 threads; run under tsan too
#include "test.h"

#include "capture_fixture.h"
#include "core/base/thread.h"
#include "format/coder/coding.h"

#include <stdatomic.h>

static char folder[64], near_folder[64];

static int setup(void **state)
{
    (void)state;
    test_folder(folder);
    fixture_write(
        &(struct fixture){
            .width = 67, .height = 50, .lights = 12, .views = 2, .depth = true, .mask = true},
        folder);
    test_folder(near_folder);
    fixture_write(
        &(struct fixture){.width = 67, .height = 50, .lights = 12, .views = 2, .near = true},
        near_folder);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    test_folder_remove(folder);
    test_folder_remove(near_folder);
    return 0;
}

static const int threads[] = {1, 2, 7};

static void test_encode(void **state)
{
    (void)state;
    static const struct {
        const struct relume_basis *basis;
        struct relume_coder_params coder;
        enum relume_storage storage;
        enum relume_compression compression;
        enum relume_step step;
        bool near;
    } kinds[] = {
        {.basis = &relume_basis_sh, {.coefficients = 9}, RELUME_STORE_8, RELUME_COMPRESS_PIZ, 0},
        {.basis = &relume_basis_sh, {.coefficients = 4}, RELUME_STORE_16, RELUME_COMPRESS_ZIP, 0},
        {.basis = &relume_basis_table, {0}, RELUME_STORE_HALF, RELUME_COMPRESS_NONE, 0},
        {.basis = &relume_basis_pca, {0}, RELUME_STORE_8, RELUME_COMPRESS_PIZ, RELUME_STEP_COMMON},
        {.basis = &relume_basis_pca, {.choose = true}, RELUME_STORE_12, RELUME_COMPRESS_ZIP, 0},
        {.basis = &relume_basis_dct, {.luminance = true}, RELUME_STORE_10, RELUME_COMPRESS_RLE, 0},
        {.basis = &relume_basis_dct_resampled, {0}, RELUME_STORE_8, RELUME_COMPRESS_PIZ, 0},
        {.basis = &relume_basis_sh,
         {.coefficients = 4},
         RELUME_STORE_8,
         RELUME_COMPRESS_PIZ,
         0,
         .near = true},
    };
    char path[96];
    snprintf(path, sizeof path, "%s/pack.exr", folder);
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        char *first = NULL;
        size_t first_size = 0;
        for (size_t t = 0; t < 3; t++) {
            size_t size;
            CHECK_OK(fixture_encode_with(
                kinds[k].near ? near_folder : folder, path, kinds[k].basis, &kinds[k].coder,
                relume_pack_encode_params(.threads = threads[t], .storage = kinds[k].storage,
                                          .compression = kinds[k].compression,
                                          .step = kinds[k].step)));
            char *bytes = test_read(path, &size);
            if (!first) {
                first = bytes;
                first_size = size;
                continue;
            }
            assert_int_equal(size, first_size);
            assert_memory_equal(bytes, first, size);
            free(bytes);
        }
        free(first);
    }
}

static void test_frames(void **state)
{
    (void)state;
    char path[96];
    snprintf(path, sizeof path, "%s/pack.exr", folder);
    const struct relume_light lights[2] = {{.direction = {0.1, 0.2, 0.9}, .rgb = {1, 1, 1}},
                                           {.direction = {0.8, 0.2, 0.1}, .rgb = {1, 2, 3}}};
    const struct relume_camera camera = {
        .framing = RELUME_FRAME_EYE, .eye = {0.4, 0.0, 3.0}, .width = 81, .height = 43};
    for (int domain = RELUME_DOMAIN_LINEAR; domain <= RELUME_DOMAIN_DISPLAY; domain++) {
        CHECK_OK(fixture_encode(folder, path, &relume_basis_sh, 9,
                                relume_pack_encode_params(.domain = (enum relume_domain)domain)));
        struct relume_image first = {0};
        for (size_t t = 0; t < 3; t++) {
            relume_pack *pack;
            struct relume_image frame;
            CHECK_OK(relume_pack_open(&pack, path, relume_pack_params(.threads = threads[t])));
            CHECK_OK(relume_frame(&frame, pack, &camera, lights, 2,
                                  relume_frame_params(.threads = threads[t])));
            relume_pack_destroy(&pack);
            if (t == 0) {
                first = frame;
                continue;
            }
            assert_memory_equal(frame.data, first.data, 81 * 43 * 3 * sizeof *frame.data);
            relume_image_destroy(&frame);
        }
        relume_image_destroy(&first);
    }
}

struct tally {
    atomic_int hits[1000];
    atomic_int worst_worker;
};

static void count(void *context, size_t item, int worker)
{
    struct tally *t = context;
    atomic_fetch_add(&t->hits[item], 1);
    int worst = atomic_load(&t->worst_worker);
    while (worker > worst && !atomic_compare_exchange_weak(&t->worst_worker, &worst, worker)) {
    }
}

static void test_every_item_once(void **state)
{
    (void)state;
    for (int n = 0; n <= 9; n++)
        for (size_t items = 0; items <= 1000; items += 250) {
            static struct tally t;
            memset(&t, 0, sizeof t);
            thread_for(n, items, count, &t);
            for (size_t i = 0; i < 1000; i++)
                assert_int_equal(atomic_load(&t.hits[i]), i < items);
            assert_true(atomic_load(&t.worst_worker) < thread_count(n));
        }
    assert_int_equal(thread_count(5), 5);
    assert_int_equal(thread_count(100000), 256);
    assert_int_equal(thread_count(0), relume_cpu_count());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_item_once),
        cmocka_unit_test(test_encode),
        cmocka_unit_test(test_frames),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
