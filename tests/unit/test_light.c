// test_light.c - what near lights send to a point, against closed forms
#include "relight/light/environment.h"

#include "test.h"

static const struct relume_vec3 down = {0, 0, -1};

static double sent(const struct relume_light *light, double x, double y, double z, int c)
{
    struct relume_vec3 towards;
    float rgb[3];
    return relume_light_at(&towards, rgb, light, (struct relume_vec3){x, y, z}) ? (double)rgb[c]
                                                                                : 0.0;
}

static void test_point(void **state)
{
    (void)state;
    struct relume_light light = {
        .kind = RELUME_LIGHT_POINT, .position = {1, 2, 2}, .rgb = {1, 2, 9}};
    struct relume_vec3 towards;
    float rgb[3];
    assert_true(relume_light_at(&towards, rgb, &light, (struct relume_vec3){0, 0, 0}));
    CHECK_NEAR(towards.x, 1.0 / 3, 1e-15);  // S - P, from the point to the light
    CHECK_NEAR(towards.z, 2.0 / 3, 1e-15);
    CHECK_NEAR(rgb[2], 1.0, 1e-6);  // 9 / 3^2
    light.nofall = true;
    CHECK_NEAR(sent(&light, 0, 0, 0, 1), 2.0, 0);
    assert_false(relume_light_at(&towards, rgb, &light, light.position));
    assert_false(relume_light_at(&towards, rgb, &light, (struct relume_vec3){INFINITY, 0, 0}));
    assert_false(relume_light_at(&towards, rgb, &light, (struct relume_vec3){0, NAN, 0}));
}

static void test_spot(void **state)
{
    (void)state;
    const struct relume_light light = {.kind = RELUME_LIGHT_SPOT,
                                       .position = {0, 0, 2},
                                       .direction = {0, 0, -3},
                                       .half_angle_deg = 30,
                                       .nofall = true,
                                       .rgb = {1, 1, 1}};
    const double at[] = {0, 20, 26.99, 28.5, 29.25, 30.01, 60, 179};
    const double want[] = {1, 1, 1, 0.5, 0.15625, 0, 0, 0};  // 1 - 3 t^2 + 2 t^3, t = 0.5 and 0.75
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        const double a = at[i] * M_PI / 180;
        CHECK_NEAR(sent(&light, sin(a), 0, 2 - cos(a), 0), want[i], 1e-6);
        CHECK_NEAR(sent(&light, 0, -sin(a), 2 - cos(a), 0), want[i], 1e-6);
    }
}

// A picture of 4 x 2 pixels, whose value gives the place: red 0 .. 3 to the right, green 1 on top.
static float texels[4 * 2 * 3];
static const struct relume_image picture = {4, 2, 3, .data = texels};

static struct relume_light slide(struct relume_vec3 position, struct relume_vec3 direction)
{
    for (int i = 0; i < 8; i++) {
        texels[3 * i] = (float)(i % 4);
        texels[3 * i + 1] = i < 4;
        texels[3 * i + 2] = 1;
    }
    return (struct relume_light){.kind = RELUME_LIGHT_SLIDE,
                                 .position = position,
                                 .direction = direction,
                                 .half_angle_deg = 45,
                                 .nofall = true,
                                 .image = &picture,
                                 .rgb = {1, 1, 1}};
}

static void test_slide(void **state)
{
    (void)state;
    const struct relume_light l = slide((struct relume_vec3){0, 0, 1}, down);
    // On the plane z = 0 the picture covers x in [-1, 1] and y in [-0.5, 0.5].
    CHECK_NEAR(sent(&l, -0.75, 0.25, 0, 0), 0, 1e-6);
    CHECK_NEAR(sent(&l, 0.75, 0.25, 0, 0), 3, 1e-6);
    CHECK_NEAR(sent(&l, 0.5, 0.25, 0, 0), 2.5, 1e-6);
    CHECK_NEAR(sent(&l, 0, 0.25, 0, 1), 1, 1e-6);
    CHECK_NEAR(sent(&l, 0, -0.25, 0, 1), 0, 1e-6);
    CHECK_NEAR(sent(&l, 0, 0, 0, 1), 0.5, 1e-6);
    CHECK_NEAR(sent(&l, 0.99, 0.49, 0, 2), 1, 1e-6);
    CHECK_NEAR(sent(&l, 1.01, 0, 0, 2), 0, 0);
    CHECK_NEAR(sent(&l, 0, -0.51, 0, 2), 0, 0);
    CHECK_NEAR(sent(&l, 0, 0, 2, 2), 0, 0);  // behind it
    // Straight down in the world the picture's up is +z, its right then is -x: seen from above with
    // +z at the top, that is its mirror image seen from below.
    const struct relume_light v =
        slide((struct relume_vec3){0, 1, 0}, (struct relume_vec3){0, -1, 0});
    CHECK_NEAR(sent(&v, 0, 0, 0.25, 1), 1, 1e-6);
    CHECK_NEAR(sent(&v, -0.75, 0, 0.25, 0), 3, 1e-6);
}

static void test_frames(void **state)
{
    (void)state;
    uint32_t seed = 3;
    for (int i = 0; i < 200; i++) {
        const struct relume_vec3 axis = i ? test_direction(&seed) : (struct relume_vec3){0, 1, 0};
        struct relume_vec3 r, u;
        relume_light_frame(&r, &u, axis);
        CHECK_NEAR(r.x * r.x + r.y * r.y + r.z * r.z, 1, 1e-12);
        CHECK_NEAR(u.x * u.x + u.y * u.y + u.z * u.z, 1, 1e-12);
        CHECK_NEAR(r.x * u.x + r.y * u.y + r.z * u.z, 0, 1e-12);
        CHECK_NEAR(u.x * axis.x + u.y * axis.y + u.z * axis.z, 0, 1e-12);
        CHECK_NEAR(r.y, 0, i ? 1e-12 : 1);  // right is level
        assert_true(i == 0 || u.y > 0);     // up is up
    }
}

// ---------------------------------------------------------------- area

// What a Lambertian point of normal +z at the origin reflects: the form factor for E = 1.
static double lambertian(const struct relume_light *area, int side)
{
    struct relume_light_patch patches[RELUME_LIGHT_PATCHES_MOST * RELUME_LIGHT_PATCHES_MOST];
    double sum = 0.0;
    relume_light_patches(patches, area, side);
    for (int i = 0; i < side * side; i++) {
        struct relume_vec3 towards;
        float rgb[3];
        if (relume_light_patch_at(&towards, rgb, &patches[i], (struct relume_vec3){0, 0, 0}))
            sum += (double)rgb[1] * fmax(towards.z, 0.0);
    }
    return sum;
}

static struct relume_light area(double h, double a, double b, bool disc)
{
    return (struct relume_light){.kind = RELUME_LIGHT_AREA,
                                 .position = {0, 0, h},
                                 .u = {0, a, 0},
                                 .v = {b, 0, 0},  // u x v = -z: it shines down
                                 .disc = disc,
                                 .rgb = {1, 1, 1}};
}

// A rectangle with a corner over the point (Howell, catalog of configuration factors, B-4).
static double corner(double a, double b, double c)
{
    const double x = a / c, y = b / c, p = sqrt(1 + x * x), q = sqrt(1 + y * y);
    return (x / p * atan(y / p) + y / q * atan(x / q)) / (2 * M_PI);
}

static void test_area_converges(void **state)
{
    (void)state;
    const double heights[] = {20, 3, 1, 0.4, 0.2};
    for (size_t i = 0; i < sizeof heights / sizeof *heights; i++) {
        const double h = heights[i];
        const struct relume_light disc = area(h, 1, 1, true), box = area(h, 0.7, 1, false);
        const int side = relume_light_patch_side(&disc, h);
        // The promise of relume_light_patch_side.
        CHECK_NEAR(lambertian(&disc, side) * (1 + h * h), 1, 0.01);
        CHECK_NEAR(lambertian(&box, side) / (4 * corner(0.7, 1, h)), 1, 0.01);
        if (h >= 0.4)  // and with all patches nearly the integral; values are floats
            CHECK_NEAR(lambertian(&disc, RELUME_LIGHT_PATCHES_MOST) * (1 + h * h), 1, 1e-5);
    }
    assert_int_equal(relume_light_patch_side(&(struct relume_light){.u = {1}, .v = {0, 1}}, 1e-9),
                     RELUME_LIGHT_PATCHES_MOST);
    assert_true(relume_light_patch_side(&(struct relume_light){.u = {1}, .v = {0, 1}}, 100) <= 2);
}

// A rectangle perpendicular to the surface, its edge on it: half of it would be seen edge-on.
static void test_area_beside(void **state)
{
    (void)state;
    // Rectangle in the plane x = c, y in [0, b], z in [0, a], normal -x; twice for y in [-b, b].
    const double a = 1.2, b = 0.8, c = 1;
    const struct relume_light wall = {.kind = RELUME_LIGHT_AREA,
                                      .position = {c, 0, a / 2},
                                      .u = {0, 0, a / 2},
                                      .v = {0, b, 0},
                                      .rgb = {1, 1, 1}};
    // Howell B-3, corner of a perpendicular rectangle.
    const double x = a / b, y = c / b, r = sqrt(x * x + y * y);
    const double want = 2 * (atan(1 / y) - y / r * atan(1 / r)) / (2 * M_PI);
    CHECK_NEAR(lambertian(&wall, relume_light_patch_side(&wall, c)), want, 0.01 * want);
    struct relume_light away = wall;
    away.v.y = -b;  // turned round it gives nothing
    CHECK_NEAR(lambertian(&away, 4), 0, 0);
}

static void test_area_distance(void **state)
{
    (void)state;
    float points[4 * 3] = {0, 0, 0, 5, 0, 1, NAN, 0, 0, 0, 0, 9};
    const struct relume_image surface = {2, 2, 3, .data = points};
    const struct relume_light l = area(2, 1, 1, false);
    CHECK_NEAR(relume_area_distance(&l, &surface), 2, 1e-12);  // the one at z = 9 is behind it
    points[5] = 1.9f;  // beside: 4 to the edge in x, 0.1 below
    points[3] = 1.5f;
    CHECK_NEAR(relume_area_distance(&l, &surface), hypot(0.5, 0.1), 1e-6);
    points[2] = points[5] = points[11] = INFINITY;
    assert_true(isinf(relume_area_distance(&l, &surface)));
}

// ---------------------------------------------------------------- checks

static void refuse(struct relume_light light, const char *why)
{
    struct test_log log;
    test_log_init(&log);
    light.rgb[0] = light.rgb[0] == 0 ? 1 : light.rgb[0];
    assert_int_equal(relume_light_check(&light, "lamp", &log.log), RELUME_EINVAL);
    if (!strstr(log.text, why) || strncmp(log.text, "lamp: ", 6))
        fail_msg("%s", log.text);
}

static void test_checks(void **state)
{
    (void)state;
    refuse((struct relume_light){0}, "direction");
    refuse((struct relume_light){.direction = {NAN, 0, 0}}, "direction");
    refuse((struct relume_light){.direction = {1}, .rgb = {NAN, 1, 1}}, "values");
    refuse((struct relume_light){.direction = {1}, .rgb = {1e20f, 1, 1}}, "values");
    refuse((struct relume_light){.kind = RELUME_LIGHT_POINT, .position = {INFINITY}}, "position");
    const double angles[] = {0, -5, 90, 400, NAN};
    for (int i = 0; i < 5; i++)
        refuse((struct relume_light){.kind = RELUME_LIGHT_SPOT,
                                     .direction = {1},
                                     .half_angle_deg = angles[i]},
               "half angle");
    refuse((struct relume_light){.kind = RELUME_LIGHT_SLIDE, .direction = {1}, .half_angle_deg = 9},
           "picture");
    refuse((struct relume_light){.kind = RELUME_LIGHT_AREA, .u = {1}, .v = {-2}}, "area");
    refuse((struct relume_light){.kind = RELUME_LIGHT_AREA, .u = {1e83}, .v = {0, 1}}, "1e6");
    refuse((struct relume_light){.kind = RELUME_LIGHT_ENVIRONMENT}, "map");
    refuse((struct relume_light){.kind = RELUME_LIGHT_IES, .direction = {1}}, "distribution");
    refuse((struct relume_light){.kind = (enum relume_light_kind)99}, "unknown kind");
    CHECK_OK(relume_light_check(&(struct relume_light){.direction = {0, 0, 1e-3}}, "", NULL));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_point),          cmocka_unit_test(test_spot),
        cmocka_unit_test(test_slide),          cmocka_unit_test(test_frames),
        cmocka_unit_test(test_area_converges), cmocka_unit_test(test_area_beside),
        cmocka_unit_test(test_area_distance),  cmocka_unit_test(test_checks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
