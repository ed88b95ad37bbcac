// test_hull.c - tests of src/core/math/hull.h: triangulation of directions on the sphere: the
// convex hull of unit vectors is their spherical Delaunay triangulation (Brown 1979)
#include "test.h"

#include "core/base/memory.h"
#include "core/math/hull.h"
#include "core/math/vec.h"

// Every direction meets exactly one triangle (edges may belong to two), weights give it back.
static void check_cover(const vec3 *points, const struct hull_triangle *t, int count)
{
    uint32_t seed = 11;
    for (int i = 0; i < 2000; i++) {
        const vec3 d = test_direction(&seed);
        int hits = 0, inner = 0;
        for (int k = 0; k < count; k++) {
            double w[3];
            if (!hull_weights(points, t[k], d, w))
                continue;
            const double least = fmin(w[0], fmin(w[1], w[2]));
            hits += least >= -1e-6;  // points of common planes are shifted by up to 1e-7
            inner += least > 1e-6;
            if (least < 0.0)
                continue;
            vec3 sum = {0.0, 0.0, 0.0};
            for (int c = 0; c < 3; c++)
                sum = vec3_add(sum, vec3_scale(points[t[k].corner[c]], w[c]));
            CHECK_NEAR(vec3_length(vec3_cross(vec3_unit(sum), d)), 0.0, 1e-9);
        }
        assert_true(hits >= 1);
        assert_true(inner <= 1);
    }
}

static double volume(const vec3 *p, const struct hull_triangle *t, int count)
{
    double v = 0.0;
    for (int i = 0; i < count; i++)
        v += vec3_dot(p[t[i].corner[0]], vec3_cross(p[t[i].corner[1]], p[t[i].corner[2]])) / 6.0;
    return v;
}

static void test_octahedron(void **state)
{
    (void)state;
    const vec3 p[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    struct hull_triangle *t;
    int count;
    CHECK_OK(hull_build(p, 6, &t, &count));
    assert_int_equal(count, 8);
    CHECK_NEAR(volume(p, t, count), 4.0 / 3.0, 1e-12);
    check_cover(p, t, count);
    relume_free(t);
}

static void test_cube(void **state)
{
    (void)state;
    vec3 p[9];
    for (int i = 0; i < 8; i++)
        p[i] = vec3_unit(vec3_of(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    p[8] = p[3];  // repeated
    struct hull_triangle *t;
    int count;
    CHECK_OK(hull_build(p, 9, &t, &count));
    assert_int_equal(count, 12);  // two for every square
    CHECK_NEAR(volume(p, t, count), 8.0 / pow(3.0, 1.5), 1e-12);
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            assert_int_not_equal(t[i].corner[c], 8);
    check_cover(p, t, count);
    relume_free(t);
}

static void test_grids(void **state)
{
    (void)state;
    enum { RINGS = 9, SPOKES = 16, N = RINGS * SPOKES + 2 };
    vec3 p[N];
    int n = 0;
    p[n++] = vec3_of(0, 0, 1);
    for (int r = 1; r <= RINGS; r++)
        for (int s = 0; s < SPOKES; s++) {
            const double theta = M_PI * r / (RINGS + 1), phi = 2.0 * M_PI * s / SPOKES;
            p[n++] = vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
        }
    p[n++] = vec3_of(0, 0, -1);
    struct hull_triangle *t;
    int count;
    CHECK_OK(hull_build(p, n, &t, &count));
    assert_int_equal(count, 2 * n - 4);  // Euler
    check_cover(p, t, count);
    relume_free(t);
}

static void test_random_points(void **state)
{
    (void)state;
    uint32_t seed = 2;
    vec3 p[200];
    for (int i = 0; i < 200; i++)
        p[i] = test_direction(&seed);
    struct hull_triangle *t, *again;
    int count, second;
    CHECK_OK(hull_build(p, 200, &t, &count));
    assert_int_equal(count, 396);
    check_cover(p, t, count);
    CHECK_OK(hull_build(p, 200, &again, &second));
    assert_memory_equal(t, again, (size_t)count * sizeof *t);
    relume_free(t);
    relume_free(again);
}

static void test_flat(void **state)
{
    (void)state;
    struct hull_triangle *t;
    int count;
    vec3 ring[12], one[5];
    for (int i = 0; i < 12; i++)
        ring[i] = vec3_of(cos(i * M_PI / 6), sin(i * M_PI / 6), 0.0);
    for (int i = 0; i < 5; i++)
        one[i] = vec3_of(0, 0, 1);
    assert_int_equal(hull_build(ring, 12, &t, &count), RELUME_EUNFIT);
    assert_null(t);
    assert_int_equal(hull_build(one, 5, &t, &count), RELUME_EUNFIT);
    assert_int_equal(hull_build(one, 1, &t, &count), RELUME_EUNFIT);
    assert_int_equal(count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_octahedron), cmocka_unit_test(test_cube),
        cmocka_unit_test(test_grids),      cmocka_unit_test(test_random_points),
        cmocka_unit_test(test_flat),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
