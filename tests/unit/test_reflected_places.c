// Where curved mirrors reflect a place to an eye: Fermat's principle on Bezier patches, and the
// cubic of triangles against places that it is made of.
#include "core/math/random.h"
#include "test.h"
#include "cli/measure/bezier.h"
#include "cli/measure/triangle.h"

// A bulge over the square from (-1, -1) to (1, 1).
static void make_bulge(struct bezier *out, double height)
{
    vec3 control[4][4];
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++) {
            const double x = (2 * i - 3) / 3.0, y = (2 * k - 3) / 3.0;
            const bool inner = i % 3 && k % 3, corner = !(i % 3) && !(k % 3);
            control[i][k] = vec3_of(x, y, height * (inner ? 1.0 : corner ? 0.0 : 0.5));
        }
    bezier_make(out, (const vec3(*)[4])control);
}

// De Casteljau's evaluation.
static vec3 between(vec3 a, vec3 b, double t)
{
    return vec3_along(vec3_scale(a, 1.0 - t), b, t);
}

static void patches_are_beziers(void **state)
{
    (void)state;
    struct random r = random_stream(4, 5, 6);
    vec3 control[4][4];
    struct bezier b;
    for (int i = 0; i < 16; i++)
        control[i / 4][i % 4] = vec3_of(random_next(&r), random_next(&r), random_next(&r));
    bezier_make(&b, (const vec3(*)[4])control);
    for (int n = 0; n < 50; n++) {
        const double u = random_next(&r), v = random_next(&r), h = 1e-5;
        struct bezier_point p, beside;
        vec3 row[4];
        for (int i = 0; i < 4; i++) {
            vec3 c[4];
            memcpy(c, control[i], sizeof c);
            for (int k = 3; k > 0; k--)
                for (int j = 0; j < k; j++)
                    c[j] = between(c[j], c[j + 1], v);
            row[i] = c[0];
        }
        for (int k = 3; k > 0; k--)
            for (int j = 0; j < k; j++)
                row[j] = between(row[j], row[j + 1], u);
        bezier_at(&p, &b, u, v);
        CHECK_NEAR(vec3_length(vec3_sub(p.s, row[0])), 0.0, 1e-13);
        bezier_at(&beside, &b, u + h, v);
        CHECK_NEAR(vec3_length(vec3_sub(vec3_scale(vec3_sub(beside.s, p.s), 1 / h), p.u)), 0, 1e-3);
        CHECK_NEAR(vec3_length(vec3_sub(vec3_scale(vec3_sub(beside.v, p.v), 1 / h), p.uv)), 0,
                   1e-3);
    }
}

// The angle between what leaves the mirror and what the law of reflection says.
static double off_law(vec3 eye, vec3 at, vec3 normal, vec3 place)
{
    const vec3 n = vec3_unit(normal), in = vec3_unit(vec3_sub(eye, at));
    const vec3 out = vec3_sub(vec3_scale(n, 2.0 * vec3_dot(n, in)), in);
    return vec3_length(vec3_sub(out, vec3_unit(vec3_sub(place, at))));
}

static void light_takes_the_shortest_way(void **state)
{
    (void)state;
    struct random r = random_stream(7, 8, 9);
    struct bezier b;
    int iterations = 0, most = 0, inside = 0;
    enum { PLACES = 2000 };
    make_bulge(&b, 0.25);
    const vec3 eye = vec3_of(0.4, -0.3, 3.0);
    for (int i = 0; i < PLACES; i++) {
        const vec3 place = vec3_of(random_range(&r, -1.5, 1.5), random_range(&r, -1.5, 1.5),
                                   random_range(&r, 1, 4));
        struct bezier_reflection f;
        struct bezier_point p;
        if (!bezier_reflect(&f, &b, eye, place) || fabs(f.u - 0.5) > 0.5 || fabs(f.v - 0.5) > 0.5)
            continue;
        inside++;
        bezier_at(&p, &b, f.u, f.v);
        CHECK_NEAR(off_law(eye, f.place, vec3_cross(p.u, p.v), place), 0.0, 1e-5);
        for (int k = 0; k < 8; k++) {  // and it is the shortest near by
            bezier_at(&p, &b, f.u + 0.01 * cos(k), f.v + 0.01 * sin(k));
            assert_true(vec3_length(vec3_sub(p.s, eye)) + vec3_length(vec3_sub(p.s, place)) >=
                        f.length);
        }
        iterations += f.iterations;
        most = f.iterations > most ? f.iterations : most;
    }
    printf("%d of %d within the patch, %.1f iterations, at most %d\n", inside, PLACES,
           (double)iterations / inside, most);
    assert_true(inside > 0.9 * PLACES && iterations < 8 * inside);
}

// A flat patch is a plane mirror: the place is met where the mirrored eye sees it (Eq. 11.1).
static void flat_patches_mirror_the_eye(void **state)
{
    (void)state;
    struct random r = random_stream(10, 11, 12);
    struct bezier b;
    make_bulge(&b, 0.0);
    for (int i = 0; i < 200; i++) {
        const vec3 eye = vec3_of(random_range(&r, -1, 1), random_range(&r, -1, 1), 2.0);
        const vec3 place =
            vec3_of(random_range(&r, -1, 1), random_range(&r, -1, 1), random_range(&r, 0.3, 3));
        struct bezier_reflection f;
        assert_true(bezier_reflect(&f, &b, eye, place));
        const vec3 behind = vec3_of(eye.x, eye.y, -eye.z);
        const vec3 want = between(behind, place, eye.z / (eye.z + place.z));
        CHECK_NEAR(vec3_length(vec3_sub(f.place, want)), 0.0, 1e-9);
        CHECK_NEAR(f.length, vec3_length(vec3_sub(place, behind)), 1e-9);
    }
}

static vec3 place_of(const struct mirror_triangle *m, double a, double b, double k)
{
    const double weight[3] = {1.0 - a - b, a, b};
    vec3 p = {0, 0, 0};
    for (int i = 0; i < 3; i++)
        p = vec3_along(p, vec3_along(m->t[i], m->d[i], k), weight[i]);
    return p;
}

// Parallel rays leave no cubic, and a flat mirror with the eye far away nearly none.
static void cubics_find_what_they_are_made_of(void **state)
{
    (void)state;
    struct random r = random_stream(13, 14, 15);
    int same = 0;
    enum { PLACES = 3000 };
    for (int i = 0; i < PLACES; i++) {
        vec3 corner[3], normal[3];
        const double bent = i % 3 == 0 ? 0.0 : i % 3 == 1 ? 0.02 : 0.3;
        const vec3 eye =
            vec3_of(random_range(&r, -1, 1), random_range(&r, -1, 1), i % 2 ? 3.0 : 1e6);
        for (int k = 0; k < 3; k++) {
            corner[k] = vec3_of(random_next(&r) + (k == 1), random_next(&r) + (k == 2), 0);
            normal[k] =
                vec3_unit(vec3_of(random_range(&r, -bent, bent), random_range(&r, -bent, bent), 1));
        }
        struct mirror_triangle m;
        struct triangle_reflection f;
        mirror_triangle_make(&m, corner, normal, eye);
        const double a = random_range(&r, 0, 0.5), b = random_range(&r, 0, 0.5);
        const double k = random_range(&r, 0.1, 4.0);
        const vec3 p = place_of(&m, a, b, k);
        assert_true(mirror_triangle_reflect(&f, &m, p));
        // whichever of the roots it is, it leads to the place
        CHECK_NEAR(vec3_length(vec3_sub(place_of(&m, f.a, f.b, f.k), p)), 0.0, 1e-7);
        same += fabs(f.a - a) < 1e-6 && fabs(f.b - b) < 1e-6 && fabs(f.k - k) < 1e-6;
    }
    printf("%d of %d by the same root\n", same, PLACES);
    assert_true(same > 0.9 * PLACES);
}

// On a ball in finer triangles what they find comes near to the law of reflection, as the square of
// their size; it is met to 1e-5 with triangles of a 500th.
static void triangles_come_near_the_law(void **state)
{
    (void)state;
    const vec3 eye = vec3_of(0.3, 0.2, 4.0), place = vec3_of(1.5, 1.0, 2.5);
    double before = 1.0;
    for (double side = 0.2; side > 0.0015; side *= 0.5) {
        const double at[3][2] = {{0.2, 0.12}, {0.2 + side, 0.12}, {0.2, 0.12 + side}};
        vec3 corner[3];
        struct mirror_triangle m;
        struct triangle_reflection f;
        // a triangle about the true place of reflection, which is found by search
        double u = 0.2, v = 0.15;
        for (double step = 0.1; step > 1e-9; step *= 0.7)
            for (int k = 0; k < 8; k++) {
                const double x = u + step * cos(k * M_PI / 4), y = v + step * sin(k * M_PI / 4);
                const vec3 s = vec3_of(x, y, sqrt(1 - x * x - y * y));
                const vec3 t = vec3_of(u, v, sqrt(1 - u * u - v * v));
                if (vec3_length(vec3_sub(s, eye)) + vec3_length(vec3_sub(s, place)) <
                    vec3_length(vec3_sub(t, eye)) + vec3_length(vec3_sub(t, place)))
                    u = x, v = y;
            }
        for (int i = 0; i < 3; i++) {
            const double x = u + at[i][0] - 0.2 - 0.3 * side, y = v + at[i][1] - 0.12 - 0.3 * side;
            corner[i] = vec3_of(x, y, sqrt(1 - x * x - y * y));
        }
        mirror_triangle_make(&m, corner, corner, eye);
        assert_true(mirror_triangle_reflect(&f, &m, place));
        const vec3 s = place_of(&m, f.a, f.b, 0.0);
        const double off = off_law(eye, s, s, place);
        printf("side %.4f: off by %.2e\n", side, off);
        assert_true(off < 0.5 * before);
        before = off;
    }
    assert_true(before < 1e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(patches_are_beziers),
        cmocka_unit_test(light_takes_the_shortest_way),
        cmocka_unit_test(flat_patches_mirror_the_eye),
        cmocka_unit_test(cubics_find_what_they_are_made_of),
        cmocka_unit_test(triangles_come_near_the_law),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
