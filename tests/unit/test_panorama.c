// test_panorama.c - tests of src/capture/multiview/panorama.h: the sources of panoramas
#include "core/math/vec.h"
#include "image/geometry/geometry.h"
#include "relight/view/view.h"

#include <relume/relight/view.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define PI 3.14159265358979323846

// One panorama of each layout, and how far a bilinear picture of the directions may be off.
struct panorama {
    struct relume_geometry geometry;
    int width, height;
    double bound;
};

// Linear interpolation of unit directions over a step h errs by at most h^2/8 for each axis (their
// second derivatives are at most 1). Over a cube's edge a texel shows a place up to half a
// texel (1 / side) beside it, with at most half the weight; over the rim of a disc up to half a row
// of the cylinder (2.75 / 128), of which a unit vector there turns by 0.39.
static const struct panorama panoramas[] = {
    {{.projection = RELUME_CYLINDRICAL, .v_min = -1.25, .v_max = 1.5}, 256, 128, 1.4e-4},
    {{.projection = RELUME_SPHERICAL}, 256, 128, 1.6e-4},
    {{.projection = RELUME_SPHERICAL}, 255, 128, 1.6e-4},
    {{.projection = RELUME_CUBE}, 6 * 64, 64, 0.5 / 64 + 2.5e-4},
    {{.projection = RELUME_CYLINDRICAL, .v_min = -1.25, .v_max = 1.5, .disc = 80},
     256,
     128 + 80,
     0.5 * 0.39 * 2.75 / 128 + 3e-4},
};
enum { PANORAMAS = sizeof panoramas / sizeof *panoramas };

static double uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

static vec3 random_direction(uint64_t *state)
{
    const double z = 2 * uniform(state) - 1;
    const double phi = 2 * PI * uniform(state);
    const double r = sqrt(1 - z * z);
    return (vec3){r * cos(phi), r * sin(phi), z};
}

static double distance(vec3 a, vec3 b)
{
    return sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
}

static vec3 unit(double x, double y, double z)
{
    return vec3_unit(vec3_of(x, y, z));
}

static void assert_vec3(vec3 got, double x, double y, double z)
{
    assert_float_equal(got.x, x, 1e-12);
    assert_float_equal(got.y, y, 1e-12);
    assert_float_equal(got.z, z, 1e-12);
}

static struct relume_image make_image(const struct panorama *p)
{
    struct relume_image image;
    assert_int_equal(relume_image_create(&image, p->width, p->height, 3), RELUME_OK);
    return image;
}

static struct relume_image direction_image(const struct panorama *p)
{
    struct relume_image image = make_image(p);
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            const vec3 d = relume_panorama_ray(&p->geometry, p->width, p->height, x + 0.5, y + 0.5);
            float *rgb = &image.data[3 * (y * p->width + x)];
            rgb[0] = (float)d.x;
            rgb[1] = (float)d.y;
            rgb[2] = (float)d.z;
        }
    return image;
}

static struct relume_image random_image(const struct panorama *p)
{
    struct relume_image image = make_image(p);
    uint64_t random = 4;
    for (int i = 0; i < 3 * p->width * p->height; i++)
        image.data[i] = (float)uniform(&random);
    return image;
}

// ---------------------------------------------------------------- mapping

static void directions_survive_the_round_trip(void **state)
{
    (void)state;
    uint64_t random = 1;
    for (int i = 0; i < PANORAMAS * 2000; i++) {
        const struct panorama *p = &panoramas[i % PANORAMAS];
        const vec3 d = random_direction(&random);
        double xy[2];
        const bool shown = relume_panorama_pixel(xy, &p->geometry, p->width, p->height, d);
        const double h = d.y / hypot(d.x, d.z);
        assert_true(shown == (p->geometry.projection != RELUME_CYLINDRICAL || p->geometry.disc ||
                              (h >= p->geometry.v_min && h <= p->geometry.v_max)));
        if (!shown)
            continue;
        assert_true(xy[0] >= 0 && xy[0] < p->width && xy[1] >= 0 && xy[1] <= p->height);
        const vec3 back = relume_panorama_ray(&p->geometry, p->width, p->height, xy[0], xy[1]);
        assert_true(distance(back, d) < 1e-12);
    }
}

// In the rows of the discs, but not within one.
static bool beside_discs(const struct panorama *p, double x, double y)
{
    const double side = p->geometry.disc;
    const double down = y - (p->height - side);
    const double across = x < side ? x : x - side;
    return p->geometry.disc && down >= 0 &&
           hypot(across - 0.5 * side, down - 0.5 * side) >= 0.5 * side;
}

static void pixels_survive_the_round_trip(void **state)
{
    (void)state;
    uint64_t random = 2;
    for (int i = 0; i < PANORAMAS * 2000; i++) {
        const struct panorama *p = &panoramas[i % PANORAMAS];
        const double x = p->width * uniform(&random);
        const double y = p->height * uniform(&random);
        if (beside_discs(p, x, y))
            continue;
        const vec3 d = relume_panorama_ray(&p->geometry, p->width, p->height, x, y);
        double xy[2];
        assert_true(relume_panorama_pixel(xy, &p->geometry, p->width, p->height, d));
        // near a pole of the sphere a column is narrow: the error of x grows as 1 / sin(theta)
        const double slack = 1e-9 / fmax(hypot(d.x, d.z), 1e-3);
        assert_float_equal(xy[0], x, slack);
        assert_float_equal(xy[1], y, 1e-9);
    }
}

static void cylinder_columns_and_rows(void **state)
{
    (void)state;
    const struct panorama *p = &panoramas[0];
    for (int c = 0; c < p->width; c += 17)
        for (int r = 0; r < p->height; r += 13) {
            const double phi = ((c + .5) / p->width * 360 - 180) * PI / 180;
            const double h = 1.5 - (r + .5) / p->height * 2.75;
            const double n = sqrt(1 + h * h);
            assert_vec3(relume_panorama_ray(&p->geometry, p->width, p->height, c + .5, r + .5),
                        sin(phi) / n, h / n, -cos(phi) / n);
        }
}

// Centre, right and top of each disc: right = direction x up.
static void discs_of_a_cylinder(void **state)
{
    (void)state;
    const struct panorama *p = &panoramas[4];
    const struct relume_geometry *g = &p->geometry;
    const int top = p->height - g->disc;
    for (int lower = 0; lower < 2; lower++) {
        const double left = lower ? g->disc : 0, h = lower ? g->v_min : g->v_max;
        const double n = hypot(1, h), e = 1e-12;
        assert_vec3(relume_panorama_ray(g, p->width, p->height, left + 40, top + 40), 0,
                    lower ? -1 : 1, 0);
        assert_vec3(relume_panorama_ray(g, p->width, p->height, left + 80 - e, top + 40), 1 / n,
                    h / n, 0);
        assert_vec3(relume_panorama_ray(g, p->width, p->height, left + 40, top), 0, h / n,
                    (lower ? -1 : 1) / n);
    }
    const vec3 beside = relume_panorama_ray(g, p->width, p->height, 2 * g->disc + 1, top + 40);
    assert_true(beside.x == 0 && beside.y == 0 && beside.z == 0);
}

static void only_what_the_discs_show_counts(void **state)
{
    (void)state;
    const struct panorama *p = &panoramas[4];
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++)
            assert_true(relume_geometry_shows(&p->geometry, p->width, p->height, x, y) ==
                        !beside_discs(p, x + 0.5, y + 0.5));
    struct relume_geometry g = p->geometry;
    assert_true(relume_geometry_fits(&g, 160, 81));
    assert_false(relume_geometry_fits(&g, 159, 81));
    assert_false(relume_geometry_fits(&g, 160, 80));
    g.v_max = -1;
    assert_false(relume_geometry_fits(&g, 160, 81));
    g = (struct relume_geometry){.projection = RELUME_SPHERICAL, .disc = 2};
    assert_false(relume_geometry_fits(&g, 160, 81));
}

static void sphere_landmarks(void **state)
{
    (void)state;
    const struct panorama *p = &panoramas[1];
    const struct relume_geometry *g = &p->geometry;
    assert_vec3(relume_panorama_ray(g, p->width, p->height, p->width / 2.0, p->height / 2.0), 0, 0,
                -1);
    assert_vec3(relume_panorama_ray(g, p->width, p->height, p->width * 0.75, p->height / 2.0), 1, 0,
                0);
    assert_vec3(relume_panorama_ray(g, p->width, p->height, 0, p->height / 2.0), 0, 0, 1);
    assert_vec3(relume_panorama_ray(g, p->width, p->height, 3, 0), 0, 1, 0);
    double xy[2];
    assert_true(relume_panorama_pixel(xy, g, p->width, p->height, (vec3){0, 0, 5}));
    assert_float_equal(xy[0], 0, 1e-12);
    assert_true(relume_panorama_pixel(xy, g, p->width, p->height, (vec3){0, -2, 0}));
    assert_float_equal(xy[1], p->height, 1e-12);
}

// Centre, right and top of each face, from the contract: right = dir x up.
static void cube_faces(void **state)
{
    (void)state;
    static const vec3 ahead[] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                 {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    static const vec3 up[] = {{0, 1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {0, 1, 0}, {0, 1, 0}};
    const struct panorama *p = &panoramas[3];
    const int side = p->height;
    for (int f = 0; f < 6; f++) {
        const vec3 a = ahead[f];
        const vec3 u = up[f];
        const vec3 r = {a.y * u.z - a.z * u.y, a.z * u.x - a.x * u.z, a.x * u.y - a.y * u.x};
        const double middle = (f + 0.5) * side;
        const struct relume_geometry *g = &p->geometry;
        assert_vec3(relume_panorama_ray(g, p->width, side, middle, side / 2.0), a.x, a.y, a.z);
        const double half = sqrt(0.5);
        assert_vec3(relume_panorama_ray(g, p->width, side, (f + 1) * side - 1e-11, side / 2.0),
                    half * (a.x + r.x), half * (a.y + r.y), half * (a.z + r.z));
        assert_vec3(relume_panorama_ray(g, p->width, side, middle, 0), half * (a.x + u.x),
                    half * (a.y + u.y), half * (a.z + u.z));
    }
}

static void no_direction_no_pixel(void **state)
{
    (void)state;
    double xy[2];
    for (int i = 0; i < PANORAMAS; i++) {
        const struct panorama *p = &panoramas[i];
        assert_false(relume_panorama_pixel(xy, &p->geometry, p->width, p->height, (vec3){0, 0, 0}));
        assert_false(
            relume_panorama_pixel(xy, &p->geometry, p->width, p->height, (vec3){NAN, 0, 1}));
    }
    const struct relume_geometry planar = {.projection = RELUME_PLANAR};
    assert_false(relume_panorama_pixel(xy, &planar, 8, 8, (vec3){0, 0, 1}));
    const struct panorama *cylinder = &panoramas[0];
    assert_false(relume_panorama_pixel(xy, &cylinder->geometry, 8, 8, (vec3){0, 1, 0}));
}

// ---------------------------------------------------------------- looking

static void look_turns_as_the_contract_says(void **state)
{
    (void)state;
    const struct relume_pan_tilt front = {0, 0, 1, false};
    assert_vec3(relume_pan_tilt_ray(front, 200, 100, 100, 50), 0, 0, -1);
    // zoom 1 sees 90 degrees across, zoom 2 half the tangent; pixels are square
    assert_vec3(relume_pan_tilt_ray(front, 200, 100, 200, 50), sqrt(.5), 0, -sqrt(.5));
    assert_vec3(relume_pan_tilt_ray((struct relume_pan_tilt){0, 0, 2, false}, 200, 100, 0, 50),
                -sqrt(.2), 0, -sqrt(.8));
    assert_vec3(relume_pan_tilt_ray(front, 200, 100, 100, 0), 0, sqrt(.2), -sqrt(.8));
    assert_vec3(relume_pan_tilt_ray((struct relume_pan_tilt){90, 0, 1, false}, 200, 100, 100, 50),
                1, 0, 0);
    assert_vec3(relume_pan_tilt_ray((struct relume_pan_tilt){0, 30, 0, false}, 200, 100, 100, 50),
                0, 0.5, -sqrt(.75));
    // tilt first, then pan: no roll, the right edge stays level
    assert_vec3(relume_pan_tilt_ray((struct relume_pan_tilt){90, 30, 1, false}, 200, 100, 100, 50),
                sqrt(.75), 0.5, 0);
    const vec3 centre =
        relume_pan_tilt_ray((struct relume_pan_tilt){20, 0, 1, false}, 200, 100, 100, 50);
    const vec3 right =
        relume_pan_tilt_ray((struct relume_pan_tilt){20, 0, 1, false}, 200, 100, 200, 50);
    assert_float_equal(centre.y, right.y, 1e-15);
}

// Snyder 1987, "Map projections", 21: seen from the far pole, the angle c from the middle is drawn
// at tan(c / 2); all angles between lines stay.
static void stereographic_looks(void **state)
{
    (void)state;
    const struct relume_pan_tilt front = {0, 0, 1, true};
    assert_vec3(relume_pan_tilt_ray(front, 200, 100, 100, 50), 0, 0, -1);
    assert_vec3(relume_pan_tilt_ray(front, 200, 100, 200, 50), 1, 0, 0);
    const struct relume_pan_tilt planet = {0, -90, 0.5, true};
    assert_vec3(relume_pan_tilt_ray(planet, 200, 200, 100, 100), 0, -1, 0);
    assert_vec3(relume_pan_tilt_ray(planet, 200, 200, 150, 100), 1, 0, 0);  // the horizon
    assert_vec3(relume_pan_tilt_ray(planet, 200, 200, 100, 50), 0, 0, -1);  // ahead is up
    const struct relume_pan_tilt looks[] = {{30, -90, 0.4, true}, {-100, 20, 1.3, true}};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 50; k++) {
            const double x = 13.0 + 3.7 * k, y = 90.0 - 1.6 * k, step = 1e-4;
            const vec3 middle = relume_pan_tilt_ray(looks[i], 200, 100, 100, 50);
            const vec3 at = relume_pan_tilt_ray(looks[i], 200, 100, x, y);
            const double r = hypot(x - 100, y - 50) / 100 / looks[i].zoom;
            assert_float_equal(vec3_angle(middle, at), 2 * atan(r), 1e-9);
            const vec3 across = vec3_sub(relume_pan_tilt_ray(looks[i], 200, 100, x + step, y), at);
            const vec3 down = vec3_sub(relume_pan_tilt_ray(looks[i], 200, 100, x, y + step), at);
            const double scale = vec3_length(across);
            // one-sided differences over 1e-6 of the frame
            assert_float_equal(vec3_length(down) / scale, 1, 1e-5);
            assert_float_equal(vec3_dot(across, down) / scale / scale, 0, 1e-5);
        }
}

static void frames_show_the_directions_they_look_at(void **state)
{
    (void)state;
    enum { W = 96, H = 48 };
    static const struct relume_pan_tilt looks[] = {
        {0, 0, 1, false},   {180, 10, 1, false}, {-179, -5, 2, false}, {45, 20, 1.5, false},
        {30, 90, 1, false}, {0, -75, 1, false},  {135, 35, 1, false},  {10, -90, 0.6, true},
    };
    struct relume_image out;
    assert_int_equal(relume_image_create(&out, W, H, 3), RELUME_OK);
    for (int i = 0; i < PANORAMAS; i++) {
        const struct panorama *p = &panoramas[i];
        struct relume_image image = direction_image(p);
        const bool cylinder = p->geometry.projection == RELUME_CYLINDRICAL && !p->geometry.disc;
        for (int k = 0; k < (cylinder ? 4 : 8); k++) {
            assert_int_equal(relume_panorama_frame(&out, &p->geometry, &image, looks[k],
                                                   relume_view_params(.one = true)),
                             RELUME_OK);
            for (int y = 0; y < H; y++)
                for (int x = 0; x < W; x++) {
                    const vec3 want = relume_pan_tilt_ray(looks[k], W, H, x + 0.5, y + 0.5);
                    const float *rgb = &out.data[3 * (y * W + x)];
                    assert_true(distance((vec3){rgb[0], rgb[1], rgb[2]}, want) < p->bound);
                }
        }
        relume_image_destroy(&image);
    }
    relume_image_destroy(&out);
}

static void texel_centres_are_exact(void **state)
{
    (void)state;
    uint64_t random = 8;
    for (int i = 0; i < PANORAMAS; i++) {
        const struct panorama *p = &panoramas[i];
        struct relume_image image = random_image(p);
        for (int k = 0; k < 500; k++) {
            const int x = (int)(p->width * uniform(&random));
            const int y = (int)(p->height * uniform(&random));
            float rgb[3];
            if (beside_discs(p, x + 0.5, y + 0.5))
                continue;
            assert_true(relume_panorama_sample(
                rgb, &p->geometry, &image,
                relume_panorama_ray(&p->geometry, p->width, p->height, x + 0.5, y + 0.5), NULL));
            for (int c = 0; c < 3; c++)
                assert_float_equal(rgb[c], image.data[3 * (y * p->width + x) + c], 1e-6);
        }
        relume_image_destroy(&image);
    }
}

static void sample_black_outside(void **state)
{
    (void)state;
    const struct panorama *p = &panoramas[0];
    struct relume_image image = random_image(p);
    float rgb[3] = {1, 1, 1};
    assert_false(relume_panorama_sample(rgb, &p->geometry, &image, unit(0, 3, -1), NULL));
    assert_true(rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0);
    relume_image_destroy(&image);
}

// ---------------------------------------------------------------- continuity

// Texels differ by at most 1, so two directions 1e-9 apart see values far closer than this.
static void assert_continuous(const struct panorama *p, const struct relume_image *image, vec3 a,
                              vec3 b)
{
    float at_a[3], at_b[3];
    assert_true(distance(a, b) < 1e-8);
    assert_true(relume_panorama_sample(at_a, &p->geometry, image, a, NULL));
    assert_true(relume_panorama_sample(at_b, &p->geometry, image, b, NULL));
    for (int c = 0; c < 3; c++)
        assert_float_equal(at_a[c], at_b[c], 2e-6);
}

static void no_seam_at_the_wrap_or_the_poles(void **state)
{
    (void)state;
    const double e = 1e-9;
    uint64_t random = 6;
    for (int i = 0; i < 3; i++) {
        const struct panorama *p = &panoramas[i];
        struct relume_image image = random_image(p);
        for (int k = 0; k < 300; k++) {
            const double h = 2 * uniform(&random) - 1;
            assert_continuous(p, &image, unit(-e, h, 1), unit(e, h, 1));
            const double phi = 2 * PI * uniform(&random);
            const double up = k & 1 ? 1 : -1;
            if (p->geometry.projection == RELUME_SPHERICAL && p->width % 2 == 0)
                assert_continuous(p, &image, unit(e * sin(phi), up, -e * cos(phi)),
                                  unit(-e * sin(phi), up, e * cos(phi)));
        }
        relume_image_destroy(&image);
    }
}

// On all twelve edges and around the eight corners.
static void no_seam_at_the_edges_of_a_cube(void **state)
{
    (void)state;
    const struct panorama *p = &panoramas[3];
    struct relume_image image = random_image(p);
    const double e = 1e-9;
    uint64_t random = 12;
    for (int k = 0; k < 4000; k++) {
        const double s = k & 1 ? 1 : -1;
        const double t = k & 2 ? 1 : -1;
        double along = 2 * uniform(&random) - 1;
        if (k & 4)  // most trouble is at the corners
            along = (along < 0 ? -1 : 1) * (1 - 1e-3 * fabs(along));
        const vec3 near[3] = {unit(s, t * (1 - e), along), unit(s, along, t * (1 - e)),
                              unit(along, s, t * (1 - e))};
        const vec3 far[3] = {unit(s * (1 - e), t, along), unit(s * (1 - e), along, t),
                             unit(along, s * (1 - e), t)};
        assert_continuous(p, &image, near[k % 3], far[k % 3]);
    }
    relume_image_destroy(&image);
}

// At both rims all around, over the wrap beyond them and in the middle; pixels beside the discs are
// not read.
static void no_seam_at_the_rims_of_discs(void **state)
{
    (void)state;
    const struct panorama *p = &panoramas[4];
    const struct relume_geometry *g = &p->geometry;
    struct relume_image image = random_image(p);
    for (int i = 0; i < p->width * p->height; i++)
        if (!relume_geometry_shows(g, p->width, p->height, i % p->width, i / p->width))
            image.data[3 * i] = image.data[3 * i + 1] = image.data[3 * i + 2] = NAN;
    const double e = 1e-9;
    uint64_t random = 14;
    for (int k = 0; k < 4000; k++) {
        const double h = k & 1 ? g->v_min : g->v_max;
        double phi = 2 * PI * uniform(&random);
        if (k & 2)  // where the cylinder wraps, and where a rim touches its square
            phi = 0.5 * PI * floor(4 * uniform(&random)) + 1e-3 * (uniform(&random) - 0.5);
        const double x = sin(phi), z = -cos(phi);
        assert_continuous(p, &image, unit(x, h * (1 - e), z), unit(x, h * (1 + e), z));
        const double r = 0.1 + 1.2 * uniform(&random);
        assert_continuous(p, &image, unit(-e, h, r), unit(e, h, r));
        assert_continuous(p, &image, unit(e * x, h, e * z), unit(-e * x, h, -e * z));
    }
    relume_image_destroy(&image);
}

// ---------------------------------------------------------------- edges of the API

static void frames_do_not_depend_on_threads(void **state)
{
    (void)state;
    enum { W = 33, H = 21 };
    const struct panorama *p = &panoramas[1];
    const struct relume_pan_tilt look = {170, 60, 1, true};
    struct relume_image image = random_image(p), one, many;
    assert_int_equal(relume_image_create(&one, W, H, 3), RELUME_OK);
    assert_int_equal(relume_image_create(&many, W, H, 3), RELUME_OK);
    assert_int_equal(
        relume_panorama_frame(&one, &p->geometry, &image, look, relume_view_params(.threads = 1)),
        RELUME_OK);
    assert_int_equal(
        relume_panorama_frame(&many, &p->geometry, &image, look, relume_view_params(.threads = 7)),
        RELUME_OK);
    assert_memory_equal(one.data, many.data, W * H * 3 * sizeof(float));
    relume_image_destroy(&one);
    relume_image_destroy(&many);
    relume_image_destroy(&image);
}

static void frames_refuse_what_is_no_panorama(void **state)
{
    (void)state;
    const struct relume_geometry planar = {.projection = RELUME_PLANAR};
    const struct relume_geometry cube = {.projection = RELUME_CUBE};
    const struct relume_geometry sphere = {.projection = RELUME_SPHERICAL};
    const struct relume_pan_tilt front = {0}, broken = {.pan_deg = NAN};
    struct relume_image image = make_image(&panoramas[1]), out = make_image(&panoramas[1]);
    assert_int_equal(relume_panorama_frame(&out, &planar, &image, front, NULL), RELUME_EINVAL);
    assert_int_equal(relume_panorama_frame(&out, &cube, &image, front, NULL), RELUME_EINVAL);
    assert_int_equal(relume_panorama_frame(&out, &sphere, &image, broken, NULL), RELUME_EINVAL);
    assert_int_equal(relume_panorama_frame(&out, &sphere, &image, front, NULL), RELUME_OK);
    relume_image_destroy(&image);
    relume_image_destroy(&out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_survive_the_round_trip),
        cmocka_unit_test(pixels_survive_the_round_trip),
        cmocka_unit_test(cylinder_columns_and_rows),
        cmocka_unit_test(discs_of_a_cylinder),
        cmocka_unit_test(only_what_the_discs_show_counts),
        cmocka_unit_test(sphere_landmarks),
        cmocka_unit_test(cube_faces),
        cmocka_unit_test(no_direction_no_pixel),
        cmocka_unit_test(look_turns_as_the_contract_says),
        cmocka_unit_test(stereographic_looks),
        cmocka_unit_test(frames_show_the_directions_they_look_at),
        cmocka_unit_test(texel_centres_are_exact),
        cmocka_unit_test(sample_black_outside),
        cmocka_unit_test(no_seam_at_the_wrap_or_the_poles),
        cmocka_unit_test(no_seam_at_the_edges_of_a_cube),
        cmocka_unit_test(no_seam_at_the_rims_of_discs),
        cmocka_unit_test(frames_do_not_depend_on_threads),
        cmocka_unit_test(frames_refuse_what_is_no_panorama),
    };
    return cmocka_run_group_tests_name("panorama", tests, NULL, NULL);
}
