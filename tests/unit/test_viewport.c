// How frames show the world: places and rays, solid angles, lamps in view and what hides them
#include "relight/frame/viewport.h"

#include "test.h"

#include <relume/relight/viewport.h>

#include <string.h>

enum { WIDE = 40, HIGH = 20 };

static const struct relume_window window = {
    .eye = {1, 2, 3}, .corner = {-0.5, 3, 1}, .right = {2.5, 0, 0.2}, .down = {0, -1.25, 0.1}};
static const struct relume_geometry sphere = {.projection = RELUME_SPHERICAL, .center = {1, 2, 3}};

static const struct relume_viewport viewports[] = {
    {.kind = RELUME_VIEWPORT_PERSPECTIVE, .width = WIDE, .height = HIGH, .window = window},
    {.kind = RELUME_VIEWPORT_PERSPECTIVE,
     .width = WIDE,
     .height = HIGH,
     .left = -7,
     .top = 3,
     .wide = 60,
     .high = 15,
     .window = window},
    {.kind = RELUME_VIEWPORT_PARALLEL, .width = WIDE, .height = HIGH, .window = window},
    {.kind = RELUME_VIEWPORT_PANORAMA,
     .width = WIDE,
     .height = HIGH,
     .geometry = sphere,
     .look = {.pan_deg = 30, .tilt_deg = -20, .zoom = 1.5}},
    {.kind = RELUME_VIEWPORT_PANORAMA,
     .width = WIDE,
     .height = HIGH,
     .geometry = sphere,
     .look = {.pan_deg = 30, .tilt_deg = -90, .zoom = 0.5, .stereographic = true}},
    {.kind = RELUME_VIEWPORT_UNFOLDED, .width = WIDE, .height = HIGH, .geometry = sphere},
    {.kind = RELUME_VIEWPORT_UNFOLDED,
     .width = WIDE,
     .height = HIGH,
     .left = 5,
     .top = -2,
     .wide = 30,
     .high = 15,
     .geometry = sphere},
};
enum { VIEWPORTS = sizeof viewports / sizeof *viewports };

// A point on the ray of a place appears there.
static void check_places(void **state)
{
    (void)state;
    for (int i = 0; i < VIEWPORTS; i++)
        for (int k = 0; k < 60; k++) {
            const double x = 5.5 + k * 7 % 29 + 0.013 * k, y = 3.5 + k * 5 % 9 + 0.007 * k;
            struct relume_vec3 from, ray;
            double xy[2];
            relume_viewport_ray(&from, &ray, &viewports[i], x, y);
            CHECK_NEAR(ray.x * ray.x + ray.y * ray.y + ray.z * ray.z, 1.0, 1e-12);
            assert_true(relume_viewport_project(xy, &viewports[i], vec3_along(from, ray, 0.5 + k)));
            CHECK_NEAR(xy[0], x, 1e-8);
            CHECK_NEAR(xy[1], y, 1e-8);
        }
}

static void check_behind(void **state)
{
    double xy[2];
    (void)state;
    struct relume_vec3 from, ray;
    relume_viewport_ray(&from, &ray, &viewports[0], 20, 10);
    assert_false(relume_viewport_project(xy, &viewports[0], vec3_sub(from, ray)));
    assert_false(relume_viewport_project(xy, &viewports[0], from));
    relume_viewport_ray(&from, &ray, &viewports[3], 20, 10);
    assert_false(relume_viewport_project(xy, &viewports[3], vec3_sub(from, ray)));
}

// The area that a pixel's corners span on the unit sphere, to second order in its size.
static double spanned(const struct relume_viewport *s, double x, double y)
{
    const double h = 0.01;
    struct relume_vec3 o, a, b, c, d;
    relume_viewport_ray(&o, &a, s, x - h, y);
    relume_viewport_ray(&o, &b, s, x + h, y);
    relume_viewport_ray(&o, &c, s, x, y - h);
    relume_viewport_ray(&o, &d, s, x, y + h);
    const struct relume_vec3 u = vec3_sub(b, a), v = vec3_sub(d, c);
    const double n[3] = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    return sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / (4 * h * h);
}

static void check_solid_angles(void **state)
{
    (void)state;
    const int exact[] = {0, 1, 3, 4};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 9; k++) {
            const struct relume_viewport *s = &viewports[exact[i]];
            const double x = 4 + 4 * k, y = 3 + 1.5 * k;
            CHECK_NEAR(relume_viewport_solid_angle(s, x, y) / spanned(s, x, y), 1.0, 1e-4);
        }
    // on the horizon of a sphere; a screen's pixels are all as its middle's
    CHECK_NEAR(relume_viewport_solid_angle(&viewports[5], 7, 10), pow(2.0 * M_PI / WIDE, 2.0),
               1e-12);
    CHECK_NEAR(relume_viewport_solid_angle(&viewports[2], 0, 0),
               relume_viewport_solid_angle(&viewports[2], 30, 15), 1e-15);
    const struct relume_viewport screen = {
        .kind = RELUME_VIEWPORT_PARALLEL,
        .width = WIDE,
        .height = HIGH,
        .window = {.corner = {-2, 1, 0}, .right = {4, 0, 0}, .down = {0, -2, 0}}};
    CHECK_NEAR(relume_viewport_solid_angle(&screen, 20, 10), pow(2.0 * tan(M_PI / 8.0) / WIDE, 2.0),
               1e-12);
}

// ---------------------------------------------------------------- lamps

static const struct relume_viewport ahead = {.kind = RELUME_VIEWPORT_PANORAMA,
                                             .width = WIDE,
                                             .height = HIGH,
                                             .geometry = {.center = {1, 2, 3}},
                                             .look = {.zoom = 1}};

// The light of the columns [from, to), where it is, and what of it the eye gets.
struct patch {
    double sum, x, y, flux;
};

static struct patch measure(const struct relume_image *frame, int from, int to)
{
    struct patch p = {0};
    for (int y = 0; y < frame->height; y++)
        for (int x = from; x < to; x++) {
            const double v = (double)frame->data[3 * (y * frame->width + x) + 1];
            p.sum += v;
            p.x += v * (x + 0.5);
            p.y += v * (y + 0.5);
        }
    p.x /= p.sum;
    p.y /= p.sum;
    p.flux = p.sum * relume_viewport_solid_angle(&ahead, p.x, p.y);
    return p;
}

// What a lamp sends to the eye is what its pixels send: pi times its value there.
static void check_lamps(void **state)
{
    const struct relume_light lights[] = {
        {.kind = RELUME_LIGHT_POINT, .position = {2, 2.5, 1}, .rgb = {4, 8, 12}},
        {.kind = RELUME_LIGHT_POINT, .position = {2, 2.5, 5}, .rgb = {4, 8, 12}},  // behind
        {.kind = RELUME_LIGHT_POINT, .position = {9, 2.5, 1}, .rgb = {4, 8, 12}},  // beside
        {.kind = RELUME_LIGHT_DIRECTIONAL, .direction = {-1, 0, -2}, .rgb = {1, 1, 1}},
        {.kind = RELUME_LIGHT_SPOT,  // shines away from the eye
         .position = {1, 2, 1},
         .direction = {0, 0, -1},
         .half_angle_deg = 30,
         .rgb = {1, 1, 1}},
    };
    struct relume_visible_light *seen = malloc(RELUME_VISIBLE_LIGHTS_MOST * sizeof *seen);
    struct relume_image frame;
    (void)state;
    CHECK_OK(relume_image_create(&frame, WIDE, HIGH, 3));
    assert_int_equal(relume_viewport_lights(seen, &ahead, lights, 5, NULL, NULL), 2);
    relume_visible_lights_draw(&frame, seen, 2);
    // (1, 0.5, -2) from the eye: x = 20 + 20 / 2, y = 10 - 20 / 4; 5.25 units squared away.
    const struct patch lamp = measure(&frame, 20, 40), sun = measure(&frame, 0, 20);
    CHECK_NEAR(lamp.x, 30.0, 1e-5);
    CHECK_NEAR(lamp.y, 5.0, 1e-5);
    CHECK_NEAR(lamp.flux, M_PI * 8.0 / 5.25, 1e-4);
    CHECK_NEAR(sun.flux, M_PI, 1e-4);
    relume_image_destroy(&frame);
    free(seen);
}

// A panel of radiance E that the eye sees under the solid angle w sends it E w.
static void check_panel(void **state)
{
    const struct relume_light panel = {.kind = RELUME_LIGHT_AREA,
                                       .position = {1.3, 2.1, 1},
                                       .u = {0.1, 0, 0},
                                       .v = {0, 0.1, 0},
                                       .rgb = {0, 5, 0}};
    struct relume_visible_light *seen = malloc(RELUME_VISIBLE_LIGHTS_MOST * sizeof *seen);
    (void)state;
    const int n = relume_viewport_lights(seen, &ahead, &panel, 1, NULL, NULL);
    double flux = 0.0;
    assert_int_equal(n, 64);
    for (int i = 0; i < n; i++) {
        flux += (double)seen[i].rgb[1] * relume_viewport_solid_angle(&ahead, seen[i].x, seen[i].y);
        assert_true(seen[i].x > 21.9 && seen[i].x < 24.1 && seen[i].y > 7.9 && seen[i].y < 10.1);
    }
    // r = (0.3, 0.1, -2) away, facing +z: 2 / r^3, and its mean over the square to second order in
    // the half edge h: h^2 / 6 of (15 (0.3^2 + 0.1^2) / r^2 - 6) / r^2
    const double mean = 1.0 + 0.01 / 6.0 * (15.0 * 0.1 / 4.1 - 6.0) / 4.1;
    CHECK_NEAR(flux / (5.0 * 0.04 * 2.0 / pow(4.1, 1.5)), mean, 1e-5);
    free(seen);
}

static bool left_of(void *user, const double xy[2], struct relume_vec3 point)
{
    (void)point;
    return xy[0] < *(const double *)user;
}

static void check_hiding(void **state)
{
    const struct relume_light lights[] = {
        {.kind = RELUME_LIGHT_POINT, .position = {2, 2, 1}, .rgb = {1, 1, 1}},
        {.kind = RELUME_LIGHT_POINT, .position = {0, 2, 1}, .rgb = {1, 1, 1}}};
    struct relume_visible_light *seen = malloc(RELUME_VISIBLE_LIGHTS_MOST * sizeof *seen);
    double edge = 20.0;
    (void)state;
    assert_int_equal(relume_viewport_lights(seen, &ahead, lights, 2, left_of, &edge), 1);
    CHECK_NEAR(seen->x, 30.0, 1e-9);
    free(seen);
    // 4 units ahead of (1, 2, 3); a surface there, just before it, well before it, nowhere
    const struct relume_vec3 lamp = {1, 2, -1};
    assert_false(relume_viewport_hides(&ahead, lamp, lamp));
    assert_false(relume_viewport_hides(&ahead, (struct relume_vec3){1, 2, -0.95}, lamp));
    assert_true(relume_viewport_hides(&ahead, (struct relume_vec3){1, 2, -0.9}, lamp));
    assert_false(relume_viewport_hides(&ahead, (struct relume_vec3){1, 2, -1e30}, lamp));
    assert_false(relume_viewport_hides(&ahead, (struct relume_vec3){NAN, 2, 0}, lamp));
    const struct relume_vec3 below = {0, 2, -1}, above = {0, 2, 5}, level = {0, 2, 0.3};
    assert_true(relume_viewport_hides(&viewports[2], level, below));
    assert_false(relume_viewport_hides(&viewports[2], level, above));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(check_places),       cmocka_unit_test(check_behind),
        cmocka_unit_test(check_solid_angles), cmocka_unit_test(check_lamps),
        cmocka_unit_test(check_panel),        cmocka_unit_test(check_hiding),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
