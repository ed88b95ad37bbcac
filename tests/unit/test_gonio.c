// test_gonio.c - intensity over direction from pictures
#include "test.h"

#include "core/math/vec.h"
#include "relight/light/environment.h"

#include <stdlib.h>

static struct relume_image cube_of(int side)
{
    struct relume_image map;
    CHECK_OK(relume_image_create(&map, 6 * side, side, 3));
    return map;
}

// The direction that a texel of a cube shows, from the words of contract.md.
static vec3 texel_ray(int side, int column, int row)
{
    const double a = 2 * (column % side + 0.5) / side - 1, b = 1 - 2 * (row + 0.5) / side;
    switch (column / side) {
    case 0: return vec3_of(1, b, a);
    case 1: return vec3_of(-1, b, -a);
    case 2: return vec3_of(a, 1, b);
    case 3: return vec3_of(a, -1, -b);
    case 4: return vec3_of(-a, b, 1);
    default: return vec3_of(a, b, -1);
    }
}

static vec3 some_direction(int i)
{
    const double z = 1 - (2 * i + 1.0) / 500, phi = 2.399963229728653 * i, r = sqrt(1 - z * z);
    return vec3_of(r * cos(phi), r * sin(phi), z);
}

static relume_gonio *create(struct relume_image *map)
{
    relume_gonio *g;
    CHECK_OK(relume_gonio_create(&g, map, NULL));
    relume_image_destroy(map);
    return g;
}

static void test_constant_is_a_point_light(void **state)
{
    (void)state;
    for (int sphere = 0; sphere < 2; sphere++) {
        struct relume_image map;
        CHECK_OK(relume_image_create(&map, sphere ? 20 : 30, sphere ? 10 : 5, 3));
        for (int i = 0; i < map.width * map.height * 3; i++)
            map.data[i] = 0.5f;
        relume_gonio *g = create(&map);
        const struct relume_light point = {
            .kind = RELUME_LIGHT_POINT, .position = {1, 2, 3}, .rgb = {1, 2, 4}};
        struct relume_light light = point;
        light.kind = RELUME_LIGHT_GONIO;
        light.direction = (struct relume_vec3){0.3, -1, 0.2};
        light.gonio = g;
        CHECK_OK(relume_light_check(&light, "light", NULL));
        for (int i = 0; i < 500; i++) {
            const vec3 at = vec3_add(point.position, vec3_scale(some_direction(i), 0.5 + i));
            vec3 want, got;
            float want_rgb[3], got_rgb[3];
            assert_true(relume_light_at(&want, want_rgb, &point, at));
            assert_true(relume_light_at(&got, got_rgb, &light, at));
            CHECK_NEAR(vec3_length(vec3_sub(want, got)), 0, 1e-15);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(got_rgb[c], 0.5 * (double)want_rgb[c], 1e-6 * (double)want_rgb[c]);
        }
        relume_gonio_destroy(&g);
    }
}

// Each face another colour: the six axes, and the six ways from a light that shines along +x.
static void test_faces(void **state)
{
    (void)state;
    enum { SIDE = 4 };
    static const vec3 axes[] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    // seen along +x with up +y: ahead +x is -z of the map, right +z is +x of the map
    static const int seen[] = {5, 4, 2, 3, 0, 1};
    struct relume_image map = cube_of(SIDE);
    for (int i = 0; i < 6 * SIDE * SIDE; i++)
        for (int c = 0; c < 3; c++)
            map.data[3 * i + c] = (float)(1 + (i % (6 * SIDE)) / SIDE + 10 * c);
    relume_gonio *g = create(&map);
    const struct relume_light light = {
        .kind = RELUME_LIGHT_GONIO, .direction = {2, 0, 0}, .rgb = {1, 1, 1}, .gonio = g};
    for (int i = 0; i < 6; i++) {
        float rgb[3];
        vec3 towards;
        relume_gonio_value(rgb, g, axes[i]);
        CHECK_NEAR(rgb[0], 1 + i, 1e-6);
        CHECK_NEAR(rgb[2], 21 + i, 1e-5);
        assert_true(relume_light_at(&towards, rgb, &light, axes[i]));
        CHECK_NEAR(rgb[1], 11 + seen[i], 1e-5);
    }
    relume_gonio_destroy(&g);
}

// A smooth function of direction, and nothing jumps where faces meet.
static double smooth(vec3 d)
{
    const vec3 u = vec3_unit(d);
    return 2 + u.x - 0.5 * u.y + 0.3 * u.z + u.x * u.y;
}

static void test_edges(void **state)
{
    (void)state;
    enum { SIDE = 64 };
    struct relume_image map = cube_of(SIDE);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < 6 * SIDE; x++)
            for (int c = 0; c < 3; c++)
                map.data[3 * (y * 6 * SIDE + x) + c] = (float)smooth(texel_ray(SIDE, x, y));
    relume_gonio *g = create(&map);
    // half a texel at the border, which repeats its neighbour's: 1/64 of slopes up to 2
    for (int i = 0; i < 500; i++) {
        float rgb[3];
        relume_gonio_value(rgb, g, some_direction(i));
        CHECK_NEAR(rgb[0], smooth(some_direction(i)), 2.0 / SIDE);
    }
    for (int i = 0; i < 100; i++) {  // across the edges beside +x, corners included
        const double t = i / 49.5 - 1, h = 1e-7;
        const vec3 edges[] = {{1, 1, t}, {1, -1, t}, {1, t, 1}, {1, t, -1}};
        for (int e = 0; e < 4; e++) {
            float in[3], out[3];
            vec3 d = edges[e];
            d.x += h;
            relume_gonio_value(in, g, d);
            d.x -= 2 * h;
            relume_gonio_value(out, g, d);
            CHECK_NEAR(in[1], out[1], 1e-4);
        }
    }
    relume_gonio_destroy(&g);
}

static const char table[] = "TILT=NONE\n1 1000 1 4 4 1 2 0 0 0\n1 1 10\n0 30 60 90\n0 30 60 90\n"
                            "100 80 40 0\n100 90 20 0\n100 60 50 0\n100 80 10 0\n";

static float ies_along(const relume_ies *ies, vec3 d)
{
    const double vertical = vec3_angle(vec3_unit(d), vec3_of(0, 0, -1)) * 180 / M_PI;
    return (float)relume_ies_value(ies, vertical, atan2(d.y, d.x) * 180 / M_PI);
}

static void test_baked_table(void **state)
{
    (void)state;
    enum { SIDE = 256 };
    relume_ies *ies;
    CHECK_OK(relume_ies_parse(&ies, table, sizeof table - 1, "table", NULL));
    for (int sphere = 0; sphere < 2; sphere++) {
        struct relume_image map;
        const int width = sphere ? 4 * SIDE : 6 * SIDE, height = sphere ? 2 * SIDE : SIDE;
        CHECK_OK(relume_image_create(&map, width, height, 3));
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                const double phi = 2 * M_PI * (x + 0.5) / width - M_PI;
                const double up = M_PI / 2 - M_PI * (y + 0.5) / height;
                const vec3 d = sphere ? vec3_of(cos(up) * sin(phi), sin(up), -cos(up) * cos(phi))
                                      : texel_ray(SIDE, x, y);
                for (int c = 0; c < 3; c++)
                    map.data[3 * (y * width + x) + c] = ies_along(ies, d);
            }
        relume_gonio *g = create(&map);
        struct relume_light light = {.kind = RELUME_LIGHT_IES,
                                     .position = {0.1, 0.2, 0.3},
                                     .direction = {0.5, -1, 0.25},
                                     .nofall = true,
                                     .rgb = {1, 1, 1},
                                     .ies = ies,
                                     .gonio = g};
        for (int i = 0; i < 500; i++) {
            const vec3 at = vec3_add(light.position, some_direction(i));
            float want[3] = {0}, got[3] = {0};
            vec3 towards;
            light.kind = RELUME_LIGHT_IES;
            (void)relume_light_at(&towards, want, &light, at);
            light.kind = RELUME_LIGHT_GONIO;
            (void)relume_light_at(&towards, got, &light, at);
            // slopes of up to 3 a radian turn within a texel of 1/128
            CHECK_NEAR(got[0], want[0], sphere ? 1e-2 : 6e-3);
        }
        relume_gonio_destroy(&g);
    }
    relume_ies_destroy(&ies);
}

static void test_bad_maps(void **state)
{
    (void)state;
    static const int sizes[][2] = {{5, 1}, {8, 8}, {12, 4}, {1, 1}};
    struct test_log heard;
    struct relume_image map;
    relume_gonio *g;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        test_log_init(&heard);
        CHECK_OK(relume_image_create(&map, sizes[i][0], sizes[i][1], 3));
        assert_int_equal(relume_gonio_create(&g, &map, relume_gonio_params(.log = &heard.log)),
                         RELUME_EINVAL);
        assert_non_null(strstr(heard.text, "expected six square faces"));
        assert_null(g);
        relume_image_destroy(&map);
    }
    test_log_init(&heard);
    map = cube_of(2);
    map.data[0] = NAN;
    map.data[7] = -1;
    CHECK_OK(
        relume_gonio_create(&g, &map, relume_gonio_params(.log = &heard.log, .name = "faces.exr")));
    assert_non_null(strstr(heard.text, "faces.exr: some values are negative, not finite"));
    const struct relume_image *atlas = relume_gonio_map(g);
    assert_int_equal(atlas->width, 24);
    assert_int_equal(atlas->height, 4);
    for (int i = 0; i < 24 * 4 * 3; i++)
        assert_true(atlas->data[i] == 0);
    relume_image_destroy(&map);
    relume_gonio_destroy(&g);
    relume_gonio_destroy(&g);
    assert_int_equal(relume_gonio_load(&g, "/nowhere/faces.exr", NULL), RELUME_ENOTFOUND);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_constant_is_a_point_light),
        cmocka_unit_test(test_faces),
        cmocka_unit_test(test_edges),
        cmocka_unit_test(test_baked_table),
        cmocka_unit_test(test_bad_maps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
