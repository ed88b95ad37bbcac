// Captured lights that show relief: captures of which each light shows a known part, and the lowest
// light of a side
#include "test.h"

#include "capture_fixture.h"
#include "in_folder.h"

enum { SIDE = 40, RINGS = 4, AROUND = 12, LIGHTS = RINGS * AROUND };

static const double height_deg[RINGS] = {10, 20, 30, 45};

// A capture of SIDE x SIDE pixels. Under ring r the part shown[r] of the object is white; the rest
// has 2 % of it, times bright[r] where that is not 0. Pixels of the left half are background, which
// no light shows, where `half`.
struct dome {
    double shown[RINGS];
    double middle[RINGS];  // of the middle view of a slab
    double bright[RINGS];
    int views;
    bool half, mask, below;
    enum relume_projection projection;
    const struct relume_pack_encode_params *encode;
};

static struct relume_vec3 dome_light(const struct dome *d, int i)
{
    const double e = height_deg[i / AROUND] * M_PI / 180, a = i % AROUND * M_PI / 6;
    const double turn = d->below && i < AROUND ? -1 : 1;
    return vec3_of(cos(e) * cos(a), cos(e) * sin(a), turn * sin(e));
}

static bool is_background(const struct dome *d, int pixel)
{
    return (d->half || d->mask) && pixel % SIDE < SIDE / 2;
}

// 7 and the number of pixels have no common divisor.
static float dome_value(const struct dome *d, int view, int ring, int pixel)
{
    const double part = (d->views > 1 && view == d->views / 2 ? d->middle : d->shown)[ring];
    if (is_background(d, pixel))
        return d->mask ? 0.5f : 0.0f;
    const float white = d->bright[ring] > 0 ? (float)(0.5 * d->bright[ring]) : 0.5f;
    return 7 * pixel % (SIDE * SIDE) < part * SIDE * SIDE ? white : 0.02f * white;
}

static void save_view(const struct dome *d, int view, const char *names[LIGHTS])
{
    static char name[3][LIGHTS][32];
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, SIDE, SIDE, 3));
    for (int i = 0; i < LIGHTS; i++) {
        for (int k = 0; k < 3 * SIDE * SIDE; k++)
            image.data[k] = dome_value(d, view, i / AROUND, k / 3);
        char own[32];
        snprintf(own, sizeof own, "v%d-%d.exr", view, i);
        CHECK_OK(relume_image_save(&image, path_of(own), NULL));
        names[i] = strcpy(name[view][i], own);
    }
    relume_image_destroy(&image);
}

static void save_mask(const struct dome *d)
{
    struct relume_image mask;
    CHECK_OK(relume_image_create(&mask, SIDE, SIDE, 1));
    for (int k = 0; k < SIDE * SIDE; k++)
        mask.data[k] = !is_background(d, k);
    CHECK_OK(relume_image_save(&mask, path_of("mask.exr"), NULL));
    relume_image_destroy(&mask);
}

static relume_pack *make_pack(const struct dome *d)
{
    struct relume_vec3 direction[LIGHTS];
    struct relume_manifest_view view[3] = {{.images = NULL}};
    const char *names[3][LIGHTS];
    relume_pack *pack;
    for (int i = 0; i < LIGHTS; i++)
        direction[i] = dome_light(d, i);
    for (int v = 0; v < d->views; v++) {
        save_view(d, v, names[v]);
        view[v] = (struct relume_manifest_view){
            .uv = {v, 0}, .images = names[v], .mask = d->mask ? "mask.exr" : NULL};
    }
    save_mask(d);
    const struct relume_manifest m = {
        .geometry = relume_geometry_default(d->projection, SIDE, SIDE),
        .lights = LIGHTS,
        .directions = direction,
        .views = d->views,
        .view = view,
    };
    CHECK_OK(relume_manifest_write(&m, path_of("capture.json"), NULL));
    CHECK_OK(fixture_encode(folder, path_of("pack.exr"), &relume_basis_table, 0, d->encode));
    CHECK_OK(relume_pack_open(&pack, path_of("pack.exr"), NULL));
    return pack;
}

// The lights of rings from `first` on show relief; -1: none.
static void expect_rings(const struct dome *d, int first)
{
    relume_pack *pack = make_pack(d);
    struct relume_relief relief;
    CHECK_OK(relume_relief_find(&relief, pack, NULL));
    assert_int_equal(relief.count, first < 0 ? 0 : LIGHTS - first * AROUND);
    for (int i = 0; i < relief.count; i++) {
        const struct relume_vec3 want = dome_light(d, first * AROUND + i);
        assert_int_equal(relief.light[i], first * AROUND + i);
        // directions in files are single precision
        CHECK_NEAR(vec3_dot(relief.direction[i], want), 1.0, 1e-6);
    }
    relume_relief_destroy(&relief);
    assert_true(relief.count == 0 && !relief.light);
    relume_pack_destroy(&pack);
}

static void seven_tenths_of_the_object_are_bright(void **state)
{
    (void)state;
    const struct relume_pack_encode_params *display =
        relume_pack_encode_params(.domain = RELUME_DOMAIN_DISPLAY);
    expect_rings(&(struct dome){.shown = {.4, .65, .75, 1}, .views = 1}, 2);
    expect_rings(&(struct dome){.shown = {.4, .75, .8, 1}, .views = 1, .encode = display}, 1);
    expect_rings(&(struct dome){.shown = {.72, .8, .9, 1}, .views = 1}, 0);
}

// The 99th percentile of a ring is compared with the median of all lights.
static void dim_lights_do_not_count(void **state)
{
    (void)state;
    expect_rings(&(struct dome){.shown = {1, 1, 1, 1}, .bright = {.2, .3, 1, 1}, .views = 1}, 1);
    expect_rings(&(struct dome){.shown = {1, 1, 1, 1}, .bright = {.1, .2, .4, 2}, .views = 1}, 0);
    expect_rings(&(struct dome){.shown = {1, .3, .4, .4}, .bright = {.1, .3, 1, 1}, .views = 1}, 2);
}

// Half of the picture is black or bright background.
static void background_does_not_count(void **state)
{
    (void)state;
    expect_rings(&(struct dome){.shown = {.4, .65, .75, 1}, .views = 1, .half = true}, 2);
    expect_rings(&(struct dome){.shown = {.4, .65, .75, 1}, .views = 1, .mask = true}, 2);
}

static void without_such_a_light_the_best_ones_are_taken(void **state)
{
    (void)state;
    expect_rings(&(struct dome){.shown = {.2, .3, .48, .5}, .views = 1}, 2);
}

static void the_middle_view_of_a_slab_counts(void **state)
{
    (void)state;
    expect_rings(&(struct dome){.shown = {1, 1, 1, 1},
                                .middle = {.1, .3, .5, .9},
                                .views = 3,
                                .projection = RELUME_SLAB},
                 3);
}

static void other_files_have_none(void **state)
{
    (void)state;
    expect_rings(&(struct dome){.shown = {1, 1, 1, 1}, .views = 1, .below = true}, -1);
    expect_rings(
        &(struct dome){.shown = {1, 1, 1, 1}, .views = 1, .projection = RELUME_CYLINDRICAL}, -1);
}

// ---------------------------------------------------------------- a side

static struct relume_vec3 at(double azimuth_deg, double height)
{
    const double a = azimuth_deg * M_PI / 180, e = height * M_PI / 180;
    return vec3_of(cos(e) * cos(a), cos(e) * sin(a), sin(e));
}

static void the_lowest_light_of_the_side_is_taken(void **state)
{
    (void)state;
    struct relume_vec3 d[] = {at(135, 40), at(190, 20), at(80, 21),  at(0, 10),
                              at(40, 35),  at(135, 60), at(-90, 30), at(0, 90)};
    int numbers[8] = {0};
    const struct relume_relief relief = {8, numbers, d};
    const struct {
        double x, y, z;
        int except, want;
    } rows[] = {
        {-1, 1, 0, -1, 1},    // 55 degrees to the left of it as to the right: 80 has 21
        {-1, 1, 5, -1, 1},    // how high the side is does not matter, ...
        {-1, 1, 1e3, -1, 1},  // ... overhead means the upper left
        {0, 0, 1, -1, 1},     // likewise
        {-1, 1, 0, 1, 2},     // the next one
        {0, 1, 0, -1, 2},     //
        {1, 0.1, 0, -1, 3},   //
        {1, 0.1, 0, 3, 4},    //
        {0, -1, 0, -1, 6},    // its neighbour at 0 is 90 degrees away
        {-1, -2, 0, -1, 1},   // 53 degrees to its left, lower than 6
        {1, -1, 0, -1, 3},    // 45 degrees
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const struct relume_vec3 side = {rows[i].x, rows[i].y, rows[i].z};
        const int found = relume_relief_lowest(&relief, side, rows[i].except);
        if (found != rows[i].want)
            fail_msg("row %zu: found %d, expected %d", i, found, rows[i].want);
    }
}

// Within two degrees the azimuth decides.
static void a_ring_is_taken_on_the_side_itself(void **state)
{
    (void)state;
    struct relume_vec3 d[12];
    int numbers[12] = {0};
    const struct relume_relief relief = {12, numbers, d};
    for (int i = 0; i < 12; i++)
        d[i] = at(30 * i, 20 + (i % 3) * 0.9);
    for (int i = 0; i < 12; i++)
        assert_int_equal(relume_relief_lowest(&relief, d[i], -1), i);
}

// A half ring at the right, asked for the left: the nearest azimuth.
static void without_a_light_there_the_nearest_azimuth_is_taken(void **state)
{
    (void)state;
    struct relume_vec3 d[] = {at(-80, 10), at(-30, 8), at(20, 12), at(70, 15), at(70, 30)};
    int numbers[5] = {0};
    const struct relume_relief relief = {5, numbers, d}, none = {0};
    assert_int_equal(relume_relief_lowest(&relief, at(170, 0), -1), 3);
    assert_int_equal(relume_relief_lowest(&relief, at(170, 0), 3), 4);
    assert_int_equal(relume_relief_lowest(&relief, at(-170, 0), -1), 0);
    assert_int_equal(relume_relief_lowest(&none, at(0, 0), -1), -1);
    const struct relume_relief one = {1, numbers, d};
    assert_int_equal(relume_relief_lowest(&one, at(100, 0), -1), 0);
    assert_int_equal(relume_relief_lowest(&one, at(100, 0), 0), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(seven_tenths_of_the_object_are_bright),
        cmocka_unit_test(dim_lights_do_not_count),
        cmocka_unit_test(background_does_not_count),
        cmocka_unit_test(without_such_a_light_the_best_ones_are_taken),
        cmocka_unit_test(the_middle_view_of_a_slab_counts),
        cmocka_unit_test(other_files_have_none),
        cmocka_unit_test(the_lowest_light_of_the_side_is_taken),
        cmocka_unit_test(a_ring_is_taken_on_the_side_itself),
        cmocka_unit_test(without_a_light_there_the_nearest_azimuth_is_taken),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
