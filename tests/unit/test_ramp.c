// How far lamps stand away, by how brightness changes over a plane: closed forms of planes, domes
// and gloss
#include "in_folder.h"
#include "test.h"

#include "capture/acquire/ramp.h"

#include <relume/capture/acquire.h>

enum { WIDTH = 96, HEIGHT = 72, LAMPS = 14 };

struct surface {
    double distance;   // of the lamps, world units; 0: distant
    double slope;      // at the border, of a dome
    double gloss;      // of a lobe around the mirrored lamp, seen by an eye 3 units away
    double roughness;  // of random slopes
};

static vec3 lamp_at(int i)
{
    const double z = 0.3 + 0.65 * (i + 0.5) / LAMPS, a = 2.399963 * i, r = sqrt(1.0 - z * z);
    return vec3_of(r * cos(a), r * sin(a), z);
}

static double random_slope(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed / 2147483648.0 - 1.0;
}

static float shade(const struct surface *s, vec3 point, vec3 direction, uint32_t *seed)
{
    const vec3 lamp = ramp_place(vec3_of(0.0, 0.0, 0.0), direction, s->distance);
    const vec3 to = s->distance > 0.0 ? vec3_sub(lamp, point) : direction;
    const double fall = s->distance > 0.0 ? s->distance * s->distance / vec3_dot(to, to) : 1.0;
    const double x = s->slope * point.x + s->roughness * random_slope(seed);
    const double y = s->slope * point.y + s->roughness * random_slope(seed);
    const vec3 normal = vec3_unit(vec3_of(x, y, 1.0)), light = vec3_unit(to);
    const vec3 eye = vec3_unit(vec3_sub(vec3_of(0.0, 0.0, 3.0), point));
    const double lobe = pow(fmax(vec3_dot(normal, vec3_unit(vec3_add(light, eye))), 0.0), 12.0);
    const double albedo = 0.4 + 0.1 * sin(40.0 * point.x) * sin(33.0 * point.y);
    return (float)(fall * (albedo * fmax(vec3_dot(normal, light), 0.0) + s->gloss * lobe));
}

static void make(struct relume_image *image, const struct surface *s)
{
    for (int i = 0; i < LAMPS; i++) {
        CHECK_OK(relume_image_create(&image[i], WIDTH, HEIGHT, 3));
        uint32_t seed = 7;  // the same slopes in all photographs
        for (int p = 0; p < WIDTH * HEIGHT; p++) {
            const vec3 point = vec3_of(2.0 * (p % WIDTH + 0.5) / WIDTH - 1.0,
                                       (HEIGHT - 2.0 * (p / WIDTH + 0.5)) / WIDTH, 0.0);
            for (int c = 0; c < 3; c++)
                image[i].data[3 * p + c] = 0.0f;
            const float value = fminf(shade(s, point, lamp_at(i), &seed), 1.0f);
            for (int c = 0; c < 3; c++)
                image[i].data[3 * p + c] = value;
        }
    }
}

static double found(const struct surface *s)
{
    struct relume_image image[LAMPS];
    const struct relume_image *small[LAMPS];
    vec3 direction[LAMPS];
    double distance;
    make(image, s);
    for (int i = 0; i < LAMPS; i++) {
        small[i] = &image[i];
        direction[i] = lamp_at(i);
    }
    const struct ramp_search search = {
        .small = small, .direction = direction, .count = LAMPS, .step = 1.0};
    CHECK_OK(ramp_find(&distance, &search));
    for (int i = 0; i < LAMPS; i++)
        relume_image_destroy(&image[i]);
    return distance;
}

// Distances are tried in steps of 2 %.
static void planes_show_distances(void **state)
{
    (void)state;
    static const double distances[] = {2.2, 3.7, 6.0, 12.0};
    for (size_t i = 0; i < 4; i++) {
        const double distance = found(&(struct surface){.distance = distances[i]});
        assert_in_range(1000.0 * distance, 980.0 * distances[i], 1020.0 * distances[i]);
    }
    // Slopes of 2 degrees hide little of a ramp.
    const double rough = found(&(struct surface){.distance = 3.7, .roughness = 0.03});
    assert_in_range(1000.0 * rough, 3500.0, 3900.0);
}

static void nothing_else_is_near(void **state)
{
    (void)state;
    static const struct surface far[] = {
        {.distance = 0.0},   {.roughness = 0.3},
        {.slope = 0.5},      {.slope = 1.0},
        {.slope = -0.7},     {.gloss = 0.5},
        {.distance = 200.0}, {.distance = 2.2, .slope = 2} /* not a plane */,
    };
    for (size_t i = 0; i < sizeof far / sizeof *far; i++)
        CHECK_NEAR(found(&far[i]), 0.0, 0.0);
}

static void places_lie_at_the_distance(void **state)
{
    (void)state;
    const vec3 origin = vec3_of(-0.7, 0.4, 0.1), direction = vec3_unit(vec3_of(0.5, -0.2, 0.8));
    const vec3 lamp = ramp_place(origin, direction, 3.0);
    assert_true(fabs(vec3_length(lamp) - 3.0) < 1e-12);
    assert_true(vec3_length(vec3_cross(vec3_sub(lamp, origin), direction)) < 1e-12);
}

// ---------------------------------------------------------------- captures

static bool warns(const struct surface *s, bool distant)
{
    struct relume_image image[LAMPS];
    const char *photograph[LAMPS];
    char path[LAMPS][128], list[LAMPS * 64] = "";
    struct relume_acquisition report;
    make(image, s);
    for (int i = 0; i < LAMPS; i++) {
        const vec3 d = lamp_at(i);
        snprintf(path[i], sizeof path[i], "%s/l%02d.exr", folder, i);
        photograph[i] = path[i];
        CHECK_OK(relume_image_save(&image[i], path[i], NULL));
        snprintf(list + strlen(list), 64, "l%02d.exr %.9g %.9g %.9g\n", i, d.x, d.y, d.z);
        relume_image_destroy(&image[i]);
    }
    write_text("list.txt", list);
    CHECK_OK(relume_capture_photographs(
        path_of("out"), photograph, LAMPS,
        relume_acquire_params(.lights = path_of("list.txt"), .distant = distant, .force = true),
        &report));
    bool said = false;
    for (int i = 0; i < report.warnings; i++)
        said |= strstr(report.warning[i], "brightness falls across") != NULL;
    relume_acquisition_destroy(&report);
    return said;
}

static void captures_warn(void **state)
{
    (void)state;
    assert_true(warns(&(struct surface){.distance = 4.0}, false));
    assert_false(warns(&(struct surface){.distance = 4.0}, true));
    assert_false(warns(&(struct surface){.distance = 0.0}, false));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planes_show_distances),
        cmocka_unit_test(nothing_else_is_near),
        cmocka_unit_test(places_lie_at_the_distance),
        cmocka_unit_test(captures_warn),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
