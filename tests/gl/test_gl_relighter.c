// The GPU's relighting against the library's, for every storage and domain
//
// Compares: above_zero.glsl, shared/transfer.glsl, shared/transfer_encode.glsl with relight.c,
// transfer.c.
#include "format/coder/coding.h"

#include "fixture.h"

static const struct relume_light lights[] = {
    {.direction = {0.2, 0.3, 0.8}, .rgb = {1, 0.9f, 0.8f}},
    {.direction = {-2, 1, 0.5}, .rgb = {0.1f, 0.4f, 1.2f}},
    {.direction = {0, -1, -1}, .rgb = {0.5f, 0.5f, 0}},
};
enum { LIGHTS = sizeof lights / sizeof *lights, W = 37, H = 23 };

static double compare_view(struct gl_relighter *r, struct fixture_file *f, int view, int n)
{
    const struct target *target;
    struct relume_image got;
    assert_int_equal(gl_relighter_view(&target, r, view), RELUME_OK);
    assert_int_equal(target_read(&got, target, &fixture_gl), RELUME_OK);
    struct relume_image want = fixture_relight(f, view, lights, n);
    const double difference = fixture_difference(&got, &want);
    relume_image_destroy(&got);
    relume_image_destroy(&want);
    return difference;
}

static void compare_lights(struct gl_relighter *r, struct fixture_file *f, const char *what,
                           double bound)
{
    for (int n = 0; n <= LIGHTS; n++) {
        char text[64];
        snprintf(text, sizeof text, "%s, %d lights", what, n);
        assert_int_equal(gl_relighter_begin(r, lights, n), RELUME_OK);
        assert_below(text, compare_view(r, f, 0, n), bound);
    }
}

static void run(enum relume_storage storage, enum relume_domain domain, const char *what,
                double bound)
{
    struct fixture_file f = fixture_make(1, W, H, storage, domain, false);
    const struct code_source source = {fixture_fetch, NULL, &f, NULL, NULL};
    struct gl_relighter r;
    assert_int_equal(gl_relighter_create(&r, &fixture_gl, &source, 1, &fixture_log), RELUME_OK);
    compare_lights(&r, &f, what, bound);
    gl_relighter_destroy(&r);
    fixture_free(&f);
}

// Sums of 27 float products of size 1: 27 x 2^-24 = 1.6e-6 a light; twice that for the library's.
static const double linear_bound = 1e-5;
// The curve's slope is at most 3 here, and pow() on a GPU is good to about 16 ulp.
static const double display_bound = 5e-5;

static void linear_files(void **state)
{
    (void)state;
    run(RELUME_STORE_8, RELUME_DOMAIN_LINEAR, "8 bits, linear", linear_bound);
    run(RELUME_STORE_16, RELUME_DOMAIN_LINEAR, "16 bits, linear", linear_bound);
    run(RELUME_STORE_HALF, RELUME_DOMAIN_LINEAR, "half, linear", linear_bound);
    run(RELUME_STORE_FLOAT, RELUME_DOMAIN_LINEAR, "float, linear", linear_bound);
}

static void display_files(void **state)
{
    (void)state;
    run(RELUME_STORE_8, RELUME_DOMAIN_DISPLAY, "8 bits, display", display_bound);
    run(RELUME_STORE_16, RELUME_DOMAIN_DISPLAY, "16 bits, display", display_bound);
    run(RELUME_STORE_HALF, RELUME_DOMAIN_DISPLAY, "half, display", display_bound);
}

static void few_bits(void **state)
{
    (void)state;
    run(RELUME_STORE_10, RELUME_DOMAIN_LINEAR, "10 bits, linear", linear_bound);
    run(RELUME_STORE_12, RELUME_DOMAIN_DISPLAY, "12 bits, display", display_bound);
}

// The same codes under a coder that needs fewer planes.
static void run_coder(const struct relume_basis *basis, const struct relume_coder_params *p,
                      enum relume_storage storage, const char *what)
{
    for (int d = 0; d < 2; d++) {
        const enum relume_domain domain = d ? RELUME_DOMAIN_DISPLAY : RELUME_DOMAIN_LINEAR;
        struct fixture_file f = fixture_make(1, W, H, storage, domain, false);
        const struct code_source source = {fixture_fetch, NULL, &f, NULL, NULL};
        relume_coder *sh = f.coder;
        struct gl_relighter r;
        assert_int_equal(relume_coder_create(&f.coder, basis, relume_coder_info(sh)->directions,
                                             FIXTURE_LIGHTS, p),
                         RELUME_OK);
        relume_coder_destroy(&sh);
        f.codes[0].coder = f.coder;
        f.codes[0].planes = relume_coder_info(f.coder)->planes;
        assert_true(f.codes[0].planes < FIXTURE_PLANES);
        assert_int_equal(gl_relighter_create(&r, &fixture_gl, &source, 1, &fixture_log), RELUME_OK);
        compare_lights(&r, &f, what, d ? display_bound : linear_bound);
        gl_relighter_destroy(&r);
        fixture_free(&f);
    }
}

static void luminance_files(void **state)
{
    (void)state;
    static const enum relume_storage storages[] = {RELUME_STORE_8, RELUME_STORE_12,
                                                   RELUME_STORE_HALF};
    for (int i = 0; i < 3; i++) {
        run_coder(&relume_basis_sh,
                  relume_coder_params(.coefficients = 9, .luminance = true, .decode = true),
                  storages[i], "luminance, 9 + 3 planes");
        run_coder(&relume_basis_dct,
                  relume_coder_params(.coefficients = 10, .luminance = true, .decode = true),
                  storages[i], "luminance, 10 + 3 planes");
    }
}

static void component_files(void **state)
{
    (void)state;
    static float transform[3 * 26 * FIXTURE_LIGHTS], mean[3 * FIXTURE_LIGHTS];
    uint64_t random = 3;
    for (size_t i = 0; i < sizeof transform / sizeof *transform; i++)
        transform[i] = (float)(0.4 * uniform(&random) - 0.2);
    for (int i = 0; i < 3 * FIXTURE_LIGHTS; i++)
        mean[i] = (float)uniform(&random);
    for (int k = 1; k <= 26; k += 5) {
        char text[64];
        snprintf(text, sizeof text, "%d components", k);
        run_coder(&relume_basis_pca,
                  relume_coder_params(.coefficients = k, .decode = true, .transform = transform,
                                      .mean = mean,
                                      .interpolant = relume_interpolant_find("delaunay")),
                  k % 2 ? RELUME_STORE_8 : RELUME_STORE_16, text);
    }
}

static void run_curve(struct relume_transfer curve, const char *what, double bound)
{
    struct fixture_file f = fixture_make(1, W, H, RELUME_STORE_8, RELUME_DOMAIN_DISPLAY, false);
    f.codes[0].display = curve;
    const struct code_source source = {fixture_fetch, NULL, &f, NULL, NULL};
    struct gl_relighter r;
    assert_int_equal(gl_relighter_create(&r, &fixture_gl, &source, 1, &fixture_log), RELUME_OK);
    compare_lights(&r, &f, what, bound);
    gl_relighter_destroy(&r);
    fixture_free(&f);
}

static void files_of_other_curves(void **state)
{
    (void)state;
    run_curve((struct relume_transfer){.curve = RELUME_CURVE_GAMMA, .gamma = 1.8f}, "gamma 1.8",
              display_bound);
    run_curve((struct relume_transfer){.curve = RELUME_CURVE_LOG, .gamma = 0.5f}, "log 0.5",
              display_bound);
}

// A machine with few array layers spreads a view over several arrays.
static void many_arrays(void **state)
{
    (void)state;
    struct gl narrow = fixture_gl;
    narrow.max_layers = 2;
    for (int d = 0; d < 2; d++) {
        const enum relume_domain domain = d ? RELUME_DOMAIN_DISPLAY : RELUME_DOMAIN_LINEAR;
        struct fixture_file f = fixture_make(1, W, H, RELUME_STORE_8, domain, false);
        const struct code_source source = {fixture_fetch, NULL, &f, NULL, NULL};
        struct gl_relighter r;
        assert_int_equal(gl_relighter_create(&r, &narrow, &source, 1, &fixture_log), RELUME_OK);
        compare_lights(&r, &f, "two layers an array", d ? display_bound : linear_bound);
        assert_int_equal(r.view[0].arrays, 4);
        gl_relighter_destroy(&r);
        fixture_free(&f);
    }
}

static void codes_are_fetched_once(void **state)
{
    (void)state;
    struct fixture_file f = fixture_make(3, 8, 8, RELUME_STORE_8, RELUME_DOMAIN_LINEAR, false);
    const struct code_source source = {fixture_fetch, NULL, &f, NULL, NULL};
    struct gl_relighter r;
    const struct target *target;
    assert_int_equal(gl_relighter_create(&r, &fixture_gl, &source, 3, &fixture_log), RELUME_OK);
    for (int frame = 0; frame < 4; frame++) {
        assert_int_equal(gl_relighter_begin(&r, lights, 1 + frame / 2), RELUME_OK);
        assert_true(r.view[1].fresh == (frame == 1 || frame == 3));
        assert_int_equal(gl_relighter_view(&target, &r, 1), RELUME_OK);
    }
    assert_int_equal(f.asked, 1);
    assert_null(r.view[0].array);
    gl_relighter_destroy(&r);
    fixture_free(&f);
}

// Graphics memory for one view and a half: each frame drives out the view of the one before.
static void old_views_leave_a_full_memory(void **state)
{
    (void)state;
    struct fixture_file f = fixture_make(3, 8, 8, RELUME_STORE_8, RELUME_DOMAIN_LINEAR, false);
    const struct code_source source = {fixture_fetch, NULL, &f, NULL, NULL};
    struct gl_relighter r;
    assert_int_equal(gl_relighter_create(&r, &fixture_gl, &source, 3, &fixture_log), RELUME_OK);
    r.memory.most = 8 * 8 * (7 * 4 + 16) * 3 / 2;
    for (int frame = 0; frame < 6; frame++) {
        assert_int_equal(gl_relighter_begin(&r, lights, LIGHTS), RELUME_OK);
        assert_true(compare_view(&r, &f, frame % 3, LIGHTS) < linear_bound);
        assert_true(r.memory.bytes <= r.memory.most);
    }
    // One frame that needs them all gets them all.
    assert_int_equal(gl_relighter_begin(&r, lights, LIGHTS), RELUME_OK);
    for (int i = 0; i < 3; i++)
        assert_true(compare_view(&r, &f, i, LIGHTS) < linear_bound);
    assert_non_null(r.view[0].array);
    assert_non_null(r.view[1].array);
    gl_relighter_destroy(&r);
    fixture_free(&f);
}

static relume_status refuse(const struct relume_codes **out, void *user, int view)
{
    (void)user, (void)view;
    *out = NULL;
    return RELUME_EDAMAGED;
}

static void a_broken_source_is_passed_on(void **state)
{
    (void)state;
    const struct code_source source = {refuse, NULL, NULL, NULL, NULL};
    struct gl_relighter r;
    const struct target *target;
    assert_int_equal(gl_relighter_create(&r, &fixture_gl, &source, 1, &fixture_log), RELUME_OK);
    assert_int_equal(gl_relighter_begin(&r, lights, 1), RELUME_OK);
    assert_int_equal(gl_relighter_view(&target, &r, 0), RELUME_EDAMAGED);
    assert_null(target);
    gl_relighter_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_files),
        cmocka_unit_test(display_files),
        cmocka_unit_test(few_bits),
        cmocka_unit_test(luminance_files),
        cmocka_unit_test(component_files),
        cmocka_unit_test(files_of_other_curves),
        cmocka_unit_test(many_arrays),
        cmocka_unit_test(codes_are_fetched_once),
        cmocka_unit_test(old_views_leave_a_full_memory),
        cmocka_unit_test(a_broken_source_is_passed_on),
    };
    return cmocka_run_group_tests_name("relighter", tests, fixture_open, fixture_close);
}
