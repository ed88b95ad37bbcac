// test_relight.c - weights, domains and point lights against closed forms
#include "relight/light/refit.h"
#include "relight/view/view.h"

#include "relight_fixture.h"

static void test_directional_sum(void **state)
{
    (void)state;
    for (int round = 0; round < 2 * FORMS; round++) {
        struct setup s;
        make(&s, round / 2, round % 2 ? RELUME_DOMAIN_DISPLAY : RELUME_DOMAIN_LINEAR);
        const struct relume_light lights[] = {
            {.direction = {2, 0, 0}, .rgb = {1, 0.5f, 0.25f}},
            {.direction = {0.3, -0.5, 0.7}, .rgb = {0.2f, 0.3f, 2}},
        };
        struct relume_image out = {0};
        CHECK_OK(relume_relight(&out, &s.codes, lights, 2, NULL));
        for (int i = 0; i < SIDE * SIDE; i++)
            for (int c = 0; c < 3; c++) {
                const double want =
                    (double)lights[0].rgb[c] * closed_form(&s, i, c, unit(1, 0, 0)) +
                    (double)lights[1].rgb[c] * closed_form(&s, i, c, unit(0.3, -0.5, 0.7));
                CHECK_NEAR(out.data[3 * i + c], want, TOLERANCE);
            }
        for (int i = 0; i < SIDE * SIDE; i++) {  // the reference for one pixel says the same
            double rgb[3];
            relume_relight_pixel(rgb, &s.codes, i % SIDE, i / SIDE, lights, 2);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(rgb[c], (double)out.data[3 * i + c], TOLERANCE);
        }
        relume_image_destroy(&out);
        relume_coder_destroy(&s.coder);
    }
}

static void test_point_light(void **state)
{
    (void)state;
    for (int round = 0; round < 2 * FORMS; round++) {
        struct setup s;
        make(&s, round / 2, round % 2 ? RELUME_DOMAIN_DISPLAY : RELUME_DOMAIN_LINEAR);
        const struct relume_geometry g = relume_geometry_default(RELUME_PLANAR, SIDE, SIDE);
        struct relume_image surface, out = {0};
        CHECK_OK(relume_view_positions(&surface, &g, NULL, NULL, SIDE, SIDE));
        surface.data[0] = INFINITY;  // one background pixel
        const struct relume_light light = {.kind = RELUME_LIGHT_POINT,
                                           .nofall = true,
                                           .position = {0.4, -0.2, 0.6},
                                           .rgb = {1, 2, 3}};
        CHECK_OK(
            relume_relight(&out, &s.codes, &light, 1, relume_relight_params(.surface = &surface)));
        for (int i = 1; i < SIDE * SIDE; i++) {
            const double x = -1.0 + (i % SIDE + 0.5) * 2.0 / SIDE;
            const double y = 1.0 - (i / SIDE + 0.5) * 2.0 / SIDE;
            const struct relume_vec3 l = unit(0.4 - x, -0.2 - y, 0.6);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(out.data[3 * i + c], (c + 1) * closed_form(&s, i, c, l), 3 * GRID);
        }
        assert_true(out.data[0] == 0.0f && out.data[1] == 0.0f && out.data[2] == 0.0f);
        relume_image_destroy(&surface);
        relume_image_destroy(&out);
        relume_coder_destroy(&s.coder);
    }
}

static void test_point_light_needs_surface(void **state)
{
    (void)state;
    struct setup s;
    struct test_log log;
    struct relume_image out = {0};
    make(&s, SEPARATE, RELUME_DOMAIN_LINEAR);
    test_log_init(&log);
    const struct relume_light light = {.kind = RELUME_LIGHT_POINT, .rgb = {1, 1, 1}};
    assert_int_equal(
        relume_relight(&out, &s.codes, &light, 1, relume_relight_params(.log = &log.log)),
        RELUME_EINVAL);
    assert_null(out.data);
    assert_non_null(strstr(log.text, "depth"));
    relume_coder_destroy(&s.coder);
}

static void test_surface_of_depth(void **state)
{
    (void)state;
    struct relume_geometry g = relume_geometry_default(RELUME_SLAB, SIDE, SIDE);
    struct relume_image depth, surface;
    const double uv[2] = {0.5, -0.25};
    CHECK_OK(relume_image_create(&depth, SIDE, SIDE, 1));
    for (int i = 0; i < SIDE * SIDE; i++)
        depth.data[i] = 2.0f;
    depth.data[5] = INFINITY;
    CHECK_OK(relume_view_positions(&surface, &g, uv, &depth, SIDE, SIDE));
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float *p = surface.data + 3 * i;
        if (i == 5) {
            assert_false(isfinite(p[2]));
            continue;
        }
        const double dx = p[0] - 0.5, dy = p[1] + 0.25, dz = p[2] - 3.0;
        CHECK_NEAR(sqrt(dx * dx + dy * dy + dz * dz), 2.0, 1e-6);
        // the ray goes through the pixel's centre on the window z = 0
        CHECK_NEAR(0.5 + dx * 3.0 / -dz, -1.0 + (i % SIDE + 0.5) * 2.0 / SIDE, 1e-5);
        CHECK_NEAR(-0.25 + dy * 3.0 / -dz, 1.0 - (i / SIDE + 0.5) * 2.0 / SIDE, 1e-5);
    }
    relume_image_destroy(&surface);
    assert_int_equal(relume_view_positions(&surface, &g, uv, NULL, SIDE, SIDE), RELUME_EINVAL);
    relume_image_destroy(&depth);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_directional_sum),
        cmocka_unit_test(test_point_light),
        cmocka_unit_test(test_point_light_needs_surface),
        cmocka_unit_test(test_surface_of_depth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
