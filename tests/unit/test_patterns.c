// Light patterns, their discrepancy, and reading directions from files.
#include "core/math/vec.h"

#include <relume/image/directions.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static void check_near(double got, double want, double tolerance)
{
    if (!(fabs(got - want) <= tolerance))
        fail_msg("found %.9g; expected %.9g within %g", got, want, tolerance);
}

enum { MOST = 1024 };

static double discrepancy(const vec3 *v, int n, bool hemisphere)
{
    double d = -1.0;
    assert_int_equal(
        relume_directions_discrepancy(&d, v, n, relume_directions_params(.hemisphere = hemisphere)),
        RELUME_OK);
    return d;
}

static void make(vec3 *out, int n, const char *pattern, uint64_t seed, bool hemisphere, bool pole_y)
{
    const struct relume_pattern *p = relume_pattern_find(pattern);
    assert_non_null(p);
    assert_int_equal(
        relume_directions_make(
            out, n, p,
            relume_directions_params(.seed = seed, .hemisphere = hemisphere, .pole_y = pole_y)),
        RELUME_OK);
}

static void hammersley_follows_the_book(void **state)
{
    (void)state;
    // phi = 2 pi k / n, z = 2 Phi_2(k) - 1 (Wong 1998, 8.1.4)
    const double z[4] = {-1.0, 0.0, -0.5, 0.5};
    vec3 v[4];
    make(v, 4, "hammersley", 0, false, false);
    for (int k = 0; k < 4; k++) {
        const double r = sqrt(1.0 - z[k] * z[k]);
        check_near(v[k].z, z[k], 1e-12);
        check_near(v[k].x, r * cos(0.5 * M_PI * k), 1e-12);
        check_near(v[k].y, r * sin(0.5 * M_PI * k), 1e-12);
    }
}

static void every_pattern_gives_exactly_n_unit_vectors(void **state)
{
    (void)state;
    static const int counts[] = {1, 2, 3, 7, 64, 100};
    for (const struct relume_pattern *const *p = relume_patterns; *p; p++)
        for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
            for (int form = 0; form < 4; form++) {
                vec3 v[100];
                memset(v, 0, sizeof v);
                make(v, counts[i], (*p)->name, 5, form & 1, form & 2);
                for (int k = 0; k < counts[i]; k++) {
                    check_near(vec3_length(v[k]), 1.0, 1e-12);
                    if (form & 1)
                        assert_true((form & 2 ? v[k].y : v[k].z) > 0.0);
                }
            }
}

static void no_lights_are_refused(void **state)
{
    (void)state;
    vec3 v;
    double d;
    assert_int_equal(relume_directions_make(&v, 0, relume_patterns[0], NULL), RELUME_EINVAL);
    assert_int_equal(relume_directions_discrepancy(&d, &v, 0, NULL), RELUME_EINVAL);
}

static void seeds_count(void **state)
{
    (void)state;
    vec3 a[50], b[50], c[50];
    make(a, 50, "poisson", 1, false, false);
    make(b, 50, "poisson", 1, false, false);
    make(c, 50, "poisson", 2, false, false);
    assert_memory_equal(a, b, sizeof a);
    assert_memory_not_equal(a, c, sizeof a);
}

static void poisson_keeps_its_distance(void **state)
{
    (void)state;
    vec3 v[200];
    make(v, 200, "poisson", 3, false, false);
    double nearest = M_PI;
    for (int i = 0; i < 200; i++)
        for (int j = 0; j < i; j++)
            nearest = fmin(nearest, vec3_angle(v[i], v[j]));
    // The densest packing of 200 points is about 0.26 rad apart, random points about 0.01.
    assert_true(nearest > 0.12);
}

static void discrepancy_of_few_points_is_known(void **state)
{
    (void)state;
    const vec3 one = {0.6, 0.0, 0.8}, pole = {0, 0, 1};
    const vec3 two[2] = {{0, 1, 0}, {0, -1, 0}};
    check_near(discrepancy(&one, 1, false), 1.0, 1e-12);
    check_near(discrepancy(&pole, 1, true), 1.0, 1e-12);
    // Each half a share of 1/2 in a cap of no area; no cap does worse.
    check_near(discrepancy(two, 2, false), 0.5, 1e-9);
}

static void discrepancy_falls_with_n_and_order(void **state)
{
    (void)state;
    static vec3 v[MOST];
    for (int hemisphere = 0; hemisphere < 2; hemisphere++) {
        double before = 1.0;
        for (int n = 16; n <= MOST; n *= 4) {
            make(v, n, "hammersley", 0, hemisphere, false);
            const double even = discrepancy(v, n, hemisphere);
            make(v, n, "random", 7, hemisphere, false);
            assert_true(even < before);
            assert_true(even < discrepancy(v, n, hemisphere));
            before = even;
        }
    }
}

// As when the directions around every centre were sorted.
static void discrepancy_is_that_of_all_caps(void **state)
{
    static const struct {
        const char *pattern;
        double sphere, hemisphere;
    } known[] = {{"hammersley", 0.0115882298, 0.0104588664},
                 {"grid", 0.113120009, 0.218223328},
                 {"random", 0.0349091355, 0.0358972453}};
    static vec3 v[MOST];
    (void)state;
    for (int i = 0; i < 3; i++)
        for (int hemisphere = 0; hemisphere < 2; hemisphere++) {
            make(v, MOST, known[i].pattern, 7, hemisphere, false);
            check_near(discrepancy(v, MOST, hemisphere),
                       hemisphere ? known[i].hemisphere : known[i].sphere, 1e-9);
        }
}

static void pole_crowding_of_the_grid_shows(void **state)
{
    (void)state;
    static vec3 grid[512], spiral[512];
    make(grid, 512, "grid", 0, false, false);
    make(spiral, 512, "spiral", 0, false, false);
    assert_true(discrepancy(grid, 512, false) > 2.0 * discrepancy(spiral, 512, false));
}

// ---------------------------------------------------------------- files

static relume_status read_text(const char *text, vec3 **v, int *n)
{
    char path[] = "/tmp/relume-lights-XXXXXX";
    const int fd = mkstemp(path);
    assert_true(fd >= 0 && write(fd, text, strlen(text)) == (ssize_t)strlen(text));
    close(fd);
    const relume_status status = relume_captured_lights_read(v, n, path, NULL);
    unlink(path);
    return status;
}

static void directions_are_read_and_normalised(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "# a comment\n\n0 0 2\n3 0 4 # another\n",
        "2\na b.png 0 0 1\nc.png 0.6 0 0.8\n",
        "{\"pattern\":\"x\",\"n\":2,\"directions\":[[0,0,1],[3,0,4]],\"discrepancy\":1}",
        "{\"format\":\"relume-capture\",\"version\":1,\"lights\":{\"directions\":[[0,0,1],[3,0,4]]}"
        "}",
        "2\n0 0 2\n3 0 4\n",
        "1.jpg 0 0 2\n2.jpg 3,0,4\n",
        "{\"lightConfiguration\":\"directional\",\"directions\":[{\"x\":0,\"y\":0,\"z\":1},"
        "{\"x\":3,\"y\":0,\"z\":4}]}",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        vec3 *v;
        int n;
        assert_int_equal(read_text(texts[i], &v, &n), RELUME_OK);
        assert_int_equal(n, 2);
        check_near(v[1].x, 0.6, 1e-6);
        check_near(v[1].z, 0.8, 1e-6);
        relume_free(v);
    }
}

static void broken_direction_files_are_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "",
        "\n\n",
        "# only words\n",
        "1 2\n",
        "0 0 0\n",
        "nan 0 1\n",
        "inf 0 1\n",
        "1 2 3 4\n",
        "x y z\n",
        "{",
        "{}",
        "{\"directions\":[[0,0,0]]}",
        "{\"directions\":[]}",
        "2\n1 0\n",
        "{\"lightConfiguration\":\"round\",\"directions\":[[0,0,1]]}",
        "{\"lightConfiguration\":\"spherical\",\"directions\":[[0,0,1]]}",
        "{\"lightConfiguration\":\"lights3d\",\"imageWidth\":-3,\"positions3d\":[[0,0,1]]}",
        "{\"lightConfiguration\":\"directional\",\"directions\":[{\"x\":0,\"y\":0}]}",
        "{\"lightConfiguration\":\"directional\",\"directions\":[[0,0,1]],\"ledAdjust\":[[0,1,1]]}",
        "{\"lightConfiguration\":\"directional\",\"directions\":[[0,0,1]],\"ledAdjust\":[[1,1,1],"
        "[1,1,1]]}",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        vec3 *v;
        int n;
        assert_int_equal(read_text(texts[i], &v, &n), RELUME_EFORMAT);
        assert_null(v);
        assert_int_equal(n, 0);
    }
    vec3 *v;
    int n;
    assert_int_equal(relume_captured_lights_read(&v, &n, "/nowhere/at/all", NULL),
                     RELUME_ENOTFOUND);
}

static relume_status load_text(struct relume_captured_lights *out, const char *text, bool positions)
{
    char path[] = "/tmp/relume-lights-XXXXXX";
    const int fd = mkstemp(path);
    assert_true(fd >= 0 && write(fd, text, strlen(text)) == (ssize_t)strlen(text));
    close(fd);
    const relume_status status = relume_captured_lights_load(out, path, positions, NULL);
    unlink(path);
    return status;
}

// A dome of 300 mm over a picture that shows 200 mm: 100 mm are one world unit.
static void a_dome_tells_positions_and_leds(void **state)
{
    (void)state;
    static const char text[] =
        "{\"label\":\"d\",\"imageWidth\":200,\"domeDiameter\":300,\"verticalOffset\":0,"
        "\"lightConfiguration\":\"spherical\",\"directions\":[],"
        "\"positionsSphere\":[{\"x\":0,\"y\":0,\"z\":150},{\"x\":90,\"y\":0,\"z\":120}],"
        "\"ledAdjust\":[{\"r\":1,\"g\":1,\"b\":1},{\"r\":2,\"g\":1,\"b\":0.5}]}";
    for (int positions = 0; positions < 2; positions++) {
        struct relume_captured_lights list;
        assert_int_equal(load_text(&list, text, positions), RELUME_OK);
        assert_int_equal(list.count, 2);
        check_near(list.direction[1].x, 0.6, 1e-12);
        check_near(list.position[1].x, 0.9, 1e-12);
        check_near(list.position[1].z, 1.2, 1e-12);
        check_near(list.intensity[1][0], 0.5, 1e-6);
        check_near(list.intensity[1][2], 2.0, 1e-6);
        relume_captured_lights_destroy(&list);
    }
}

static void vectors_are_positions_when_asked(void **state)
{
    (void)state;
    static const char *const texts[] = {"0 0 2\n3 0 4\n", "2\na.png 0 0 2\nb.png 3 0 4\n",
                                        "{\"positions\":[[0,0,2],[3,0,4]]}"};
    struct relume_captured_lights list;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        assert_int_equal(load_text(&list, texts[i], true), RELUME_OK);
        check_near(list.position[1].z, 4.0, 1e-12);
        check_near(list.direction[1].z, 0.8, 1e-12);
        relume_captured_lights_destroy(&list);
    }
    assert_int_equal(load_text(&list, texts[0], false), RELUME_OK);
    assert_null(list.position);
    relume_captured_lights_destroy(&list);
    assert_int_equal(load_text(&list, "{\"directions\":[[0,0,1]]}", true), RELUME_EUNFIT);
    assert_null(list.direction);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_dome_tells_positions_and_leds),
        cmocka_unit_test(vectors_are_positions_when_asked),
        cmocka_unit_test(hammersley_follows_the_book),
        cmocka_unit_test(every_pattern_gives_exactly_n_unit_vectors),
        cmocka_unit_test(no_lights_are_refused),
        cmocka_unit_test(seeds_count),
        cmocka_unit_test(poisson_keeps_its_distance),
        cmocka_unit_test(discrepancy_of_few_points_is_known),
        cmocka_unit_test(discrepancy_falls_with_n_and_order),
        cmocka_unit_test(discrepancy_is_that_of_all_caps),
        cmocka_unit_test(pole_crowding_of_the_grid_shows),
        cmocka_unit_test(directions_are_read_and_normalised),
        cmocka_unit_test(broken_direction_files_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
