// test_disc.c - tests of src/format/coder/disc.h: cosines on the stereographic discs of the sphere
// (Wong 1998, 9.1.2)
#include "test.h"

#include "format/coder/coding.h"
#include "format/coder/disc.h"

static void test_round_trip(void **state)
{
    (void)state;
    uint32_t seed = 4;
    for (int i = 0; i < 2000; i++) {
        const vec3 d = test_direction(&seed);
        const struct disc_point p = disc_from_direction(d);
        const vec3 again = disc_to_direction(p);
        assert_int_equal(p.lower, d.z < 0.0);
        assert_true(hypot(p.x - 0.5, p.y - 0.5) <= 0.5 + 1e-12);
        CHECK_NEAR(again.x, d.x, 1e-12);
        CHECK_NEAR(again.y, d.y, 1e-12);
        CHECK_NEAR(again.z, d.z, 1e-12);
    }
}

// Wong 1998, Eq. 9.3: the radius is tan(theta / 2), the centre is the pole; y runs down.
static void test_known_places(void **state)
{
    (void)state;
    const double theta = 0.7, radius = tan(theta / 2.0);
    const struct disc_point right = disc_from_direction(vec3_of(sin(theta), 0.0, cos(theta)));
    CHECK_NEAR(right.x, 0.5 + 0.5 * radius, 1e-15);
    CHECK_NEAR(right.y, 0.5, 1e-15);
    const struct disc_point up = disc_from_direction(vec3_of(0.0, sin(theta), -cos(theta)));
    CHECK_NEAR(up.x, 0.5, 1e-15);
    CHECK_NEAR(up.y, 0.5 - 0.5 * radius, 1e-15);
    assert_true(up.lower);
    // a corner of the square repeats the border at its azimuth
    const vec3 corner = disc_to_direction((struct disc_point){1.0, 0.0, false});
    CHECK_NEAR(corner.x, sqrt(0.5), 1e-12);
    CHECK_NEAR(corner.y, sqrt(0.5), 1e-12);
    CHECK_NEAR(corner.z, 0.0, 1e-12);
}

static void test_zones(void **state)
{
    (void)state;
    static const int want[][2] = {{0, 0}, {0, 1}, {1, 0}, {0, 2}, {1, 1},
                                  {2, 0}, {0, 3}, {1, 2}, {2, 1}, {3, 0}};
    for (int k = 0; k < 10; k++) {
        const struct disc_wave w = disc_wave_of(k);
        assert_int_equal(w.u, want[k][0]);
        assert_int_equal(w.v, want[k][1]);
    }
}

// Midpoints sum products of cosines exactly.
static void test_orthonormal_on_the_square(void **state)
{
    (void)state;
    enum { COUNT = 28, GRID = 20 };
    for (int a = 0; a < COUNT; a++)
        for (int b = 0; b <= a; b++) {
            double sum = 0.0;
            for (int i = 0; i < GRID * GRID; i++) {
                const struct disc_point p = {(i % GRID + 0.5) / GRID, (i / GRID + 0.5) / GRID,
                                             false};
                sum += disc_cosine(disc_wave_of(a), p) * disc_cosine(disc_wave_of(b), p);
            }
            CHECK_NEAR(sum / (GRID * GRID), a == b, 1e-12);
        }
}

// Each hemisphere has functions of its own.
static void test_two_discs(void **state)
{
    (void)state;
    enum { K = 7, UPPER = 4, LIGHTS = 40 };
    struct relume_vec3 lights[LIGHTS];
    relume_coder *c;
    CHECK_OK(relume_directions_make(lights, LIGHTS, relume_pattern_find("hammersley"), NULL));
    CHECK_OK(relume_coder_create(&c, &relume_basis_dct, lights, LIGHTS,
                                 relume_coder_params(.coefficients = K, .decode = true)));
    float w[3 * K], constant[3];
    uint32_t seed = 8;
    for (int i = 0; i < 100; i++) {
        const vec3 d = test_direction(&seed);
        relume_coder_weights(c, d, w, constant);
        for (int k = 0; k < K; k++) {
            const bool own = (k < UPPER) == (d.z >= 0.0);
            const int wave = k < UPPER ? k : k - UPPER;
            const double want = disc_cosine(disc_wave_of(wave), disc_from_direction(d));
            CHECK_NEAR((double)w[k], own ? want : 0.0, 1e-6);
        }
    }
    relume_coder_destroy(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip), cmocka_unit_test(test_known_places),
        cmocka_unit_test(test_zones),      cmocka_unit_test(test_orthonormal_on_the_square),
        cmocka_unit_test(test_two_discs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
