// Rays against triangles: distances, both sides of thin plates, packets of any length.
#include "shape/mesh/trace.h"
#include "world/stage/shapes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void check_near(double got, double want, double tolerance)
{
    if (!(fabs(got - want) <= tolerance))
        fail_msg("found %.9g; expected %.9g within %g", got, want, tolerance);
}

static tracer *trace_mesh(const struct mesh *mesh)
{
    tracer *t;
    assert_int_equal(trace_create(&t, mesh, NULL), RELUME_OK);
    return t;
}

static void distances_are_exact(void **state)
{
    (void)state;
    struct mesh m = {0};
    shape_quad(&m, vec3_of(-1, -1, 0), vec3_of(2, 0, 0), vec3_of(0, 2, 0));
    tracer *t = trace_mesh(&m);
    const float down[3] = {0, 0, -1}, above[3] = {0.3f, -0.7f, 4}, beside[3] = {1.1f, 0, 4};
    struct trace_hit hit;
    assert_true(trace_closest(t, above, down, &hit));
    check_near(hit.distance, 4.0, 1e-6);
    assert_false(trace_closest(t, beside, down, &hit));
    trace_destroy(&t);
    assert_null(t);
    mesh_free(&m);
}

static void leaving_is_tiny_and_sidewise(void **state)
{
    (void)state;
    const float up[3] = {0, 0, 1}, down[3] = {0, 0, -1};
    static const float heights[] = {0.0f, 1e-3f, 0.5f, -0.5f, 10.0f, -1000.0f};
    for (size_t i = 0; i < sizeof heights / sizeof *heights; i++) {
        const float p[3] = {1.0f, 2.0f, heights[i]};
        float over[3], under[3];
        trace_leave(p, up, over);
        trace_leave(p, down, under);
        assert_true(over[2] > p[2] && under[2] < p[2]);
        assert_true(over[2] - under[2] < 1e-4 * (1.0 + fabs(heights[i])));
        assert_true(over[0] == p[0] && over[1] == p[1]);
    }
}

// A plate thinner than paper, far from the origin: its top is lit from above, its bottom is not.
static void thin_plates_keep_their_sides(void **state)
{
    (void)state;
    struct mesh m = {0};
    shape_box(&m, vec3_of(99, 99, 5), vec3_of(101, 101, 5.001));
    tracer *t = trace_mesh(&m);
    const float up[3] = {0, 0, 1}, down[3] = {0, 0, -1};
    const float top[3] = {100, 100, 5.001f}, bottom[3] = {100, 100, 5};
    float origin[2][3];
    bool seen[2];
    trace_leave(top, up, origin[0]);
    trace_leave(bottom, down, origin[1]);
    trace_unblocked(t, origin, 2, up, seen);
    assert_true(seen[0] && !seen[1]);
    trace_unblocked(t, origin, 2, down, seen);
    assert_true(!seen[0] && seen[1]);
    trace_destroy(&t);
    mesh_free(&m);
}

static void packets_of_any_length_agree(void **state)
{
    (void)state;
    enum { RAYS = 37 };
    struct mesh m = {0};
    shape_sphere(&m, vec3_of(0, 0, 0), 1.0, 64);
    tracer *t = trace_mesh(&m);
    const float up[3] = {0, 0, 1};
    float origins[RAYS][3];
    for (int i = 0; i < RAYS; i++) {
        const float row[3] = {-1.7f + 0.1f * (float)i, 0.05f, -2};
        memcpy(origins[i], row, sizeof row);
    }
    bool together[RAYS], alone[RAYS];
    trace_unblocked(t, origins, RAYS, up, together);
    for (int i = 0; i < RAYS; i++) {
        trace_unblocked(t, &origins[i], 1, up, &alone[i]);
        assert_int_equal(together[i], alone[i]);
        const float x = origins[i][0];
        if (fabsf(fabsf(x) - 1.0f) > 0.02f)
            assert_int_equal(together[i], fabsf(x) > 1.0f);
    }
    trace_destroy(&t);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distances_are_exact),
        cmocka_unit_test(leaving_is_tiny_and_sidewise),
        cmocka_unit_test(thin_plates_keep_their_sides),
        cmocka_unit_test(packets_of_any_length_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
