// Levels of detail of BTFs and of their models: means of values, fitted again.
#include "made_btf.h"

#include "core/base/half.h"
#include "material/btf/values.h"
#include "material/model/model.h"

enum { WIDTH = 7, HEIGHT = 4 };

static double value(int x, int y, int c, vec3 v, vec3 l)
{
    return l.z * (0.2 + 0.08 * x + 0.05 * ((x * 5 + y * 3) % 4) + 0.1 * c * v.z) +
           0.1 * pow(fmax(0.3 * l.x + 0.9 * l.z, 0.0), 6.0 + y);
}

static relume_btf *make(int width, int height,
                        void (*fill)(const void *context, vec3 v, vec3 l, float *rgb))
{
    return made_btf(&(struct made_btf){.width = width, .height = height, .fill = fill});
}

static void whole(const void *context, vec3 v, vec3 l, float *rgb)
{
    (void)context;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        for (int c = 0; c < 3; c++)
            rgb[3 * i + c] = (float)value(i % WIDTH, i / WIDTH, c, v, l);
}

// 7 x 4 -> 3 x 2: columns 0 1, 2 3, 4 5 6, written out.
static void averaged(const void *context, vec3 v, vec3 l, float *rgb)
{
    (void)context;
    static const int first[4] = {0, 2, 4, 7};
    for (int y = 0; y < 2; y++)
        for (int x = 0; x < 3; x++)
            for (int c = 0; c < 3; c++) {
                double sum = 0.0;
                for (int i = first[x]; i < first[x + 1]; i++)
                    for (int j = 2 * y; j < 2 * y + 2; j++)
                        // the values that are averaged are halfs
                        sum +=
                            (double)float_from_half(half_from_float((float)value(i, j, c, v, l)));
                rgb[3 * (y * 3 + x) + c] = (float)(sum / (2.0 * (first[x + 1] - first[x])));
            }
}

static void test_means(void **state)
{
    (void)state;
    relume_btf *btf = make(WIDTH, HEIGHT, whole), *want = make(3, 2, averaged), *half, *quarter;
    CHECK_OK(relume_btf_halve(&half, btf, NULL));
    assert_int_equal(relume_btf_info(half)->width, 3);
    assert_int_equal(relume_btf_info(half)->height, 2);
    for (int v = 0; v < MADE_DIRECTIONS; v++)
        for (int l = 0; l < MADE_DIRECTIONS; l++)
            for (int i = 0; i < 18; i++)
                // one rounding to halfs of values up to 2, either way
                CHECK_NEAR(float_from_half(relume_btf_picture(half, v, l)[i]),
                           float_from_half(relume_btf_picture(want, v, l)[i]), 1e-3);
    CHECK_OK(relume_btf_halve(&quarter, half, NULL));
    assert_int_equal(relume_btf_info(quarter)->width, 1);
    assert_int_equal(relume_btf_info(quarter)->height, 1);
    relume_btf_destroy(&quarter);
    relume_btf_destroy(&half);
    relume_btf_destroy(&want);
    relume_btf_destroy(&btf);
}

static void check_same(const relume_btf_fitted *a, const relume_btf_fitted *b)
{
    assert_int_equal(a->arrays, b->arrays);
    for (int i = 0; i < a->arrays; i++) {
        assert_int_equal(npy_bytes(&a->array[i].npy), npy_bytes(&b->array[i].npy));
        assert_memory_equal(a->array[i].data, b->array[i].data, npy_bytes(&a->array[i].npy));
    }
}

// A level of a model is the model of the level.
static void check_model(const struct relume_btf_model *model, const relume_btf *btf,
                        const relume_btf *half, const char *folder)
{
    char path[160];
    relume_btf_fitted *all, *alone, *back;
    CHECK_OK(relume_btf_fit(
        &all, btf, model,
        relume_btf_fit_params(.clusters = 4, .components = 3, .levels = -1, .threads = 2)));
    CHECK_OK(
        relume_btf_fit(&alone, half, model, relume_btf_fit_params(.clusters = 1, .components = 3)));
    check_same(relume_btf_fitted_level(all, 1), alone);
    const struct relume_btf_fitted_info *info = relume_btf_fitted_info(all);
    assert_int_equal(info->levels, 3);
    assert_int_equal(relume_btf_fitted_info(relume_btf_fitted_level(all, 9))->width, 1);
    assert_true(info->bytes_levels > info->bytes);
    snprintf(path, sizeof path, "%s/%s", folder, relume_btf_model_name(model));
    CHECK_OK(relume_btf_fitted_save(all, path, NULL));
    CHECK_OK(relume_btf_fitted_open(&back, path, NULL));
    for (int i = 0; i < 3; i++)
        check_same(relume_btf_fitted_level(all, i), relume_btf_fitted_level(back, i));
    relume_btf_fitted_destroy(&back);
    relume_btf_fitted_destroy(&alone);
    relume_btf_fitted_destroy(&all);
}

static void test_models(void **state)
{
    (void)state;
    char folder[64];
    test_folder(folder);
    relume_btf *btf = make(WIDTH, HEIGHT, whole), *half;
    CHECK_OK(relume_btf_halve(&half, btf, NULL));
    for (const struct relume_btf_model *const *m = relume_btf_models; *m; m++)
        check_model(*m, btf, half, folder);
    relume_btf_destroy(&half);
    relume_btf_destroy(&btf);
    test_folder_remove(folder);
}

static void test_broken(void **state)
{
    (void)state;
    char folder[64], path[100];
    struct test_log log;
    test_folder(folder);
    test_log_init(&log);
    relume_btf *btf = make(WIDTH, HEIGHT, whole);
    relume_btf_fitted *m;
    snprintf(path, sizeof path, "%s/m", folder);
    CHECK_OK(
        relume_btf_fit(&m, btf, relume_btf_model_find("rfp"), relume_btf_fit_params(.levels = 2)));
    CHECK_OK(relume_btf_fitted_save(m, path, NULL));
    relume_btf_fitted_destroy(&m);
    // a level of another model, then none at all
    CHECK_OK(relume_btf_fit(&m, btf, relume_btf_model_find("rfp"), NULL));
    snprintf(path, sizeof path, "%s/m/level1", folder);
    test_folder_remove(path);
    CHECK_OK(relume_btf_fitted_save(m, path, NULL));
    relume_btf_fitted_destroy(&m);
    snprintf(path, sizeof path, "%s/m", folder);
    assert_int_equal(relume_btf_fitted_open(&m, path, relume_btf_params(.log = &log.log)),
                     RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "level1: rfp of 7 x 4 texels; expected rfp of 3 x 2"));
    assert_null(m);
    snprintf(path, sizeof path, "%s/m/level1/model.json", folder);
    assert_int_equal(unlink(path), 0);
    snprintf(path, sizeof path, "%s/m", folder);
    assert_int_equal(relume_btf_fitted_open(&m, path, relume_btf_params(.log = &log.log)),
                     RELUME_ENOTFOUND);
    assert_non_null(strstr(log.text, "level1/model.json"));
    relume_btf_destroy(&btf);
    test_folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_means),
        cmocka_unit_test(test_models),
        cmocka_unit_test(test_broken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
