// Cells of an octree against the ray tracer, and against all of its cells one by one.
#include "core/base/memory.h"
#include "core/math/random.h"
#include "cli/measure/octree.h"
#include "shape/mesh/trace.h"
#include "test.h"
#include "world/stage/shapes.h"

static vec3 random_direction(struct random *r)
{
    const double z = random_range(r, -1, 1), a = random_range(r, 0, 2 * M_PI);
    return vec3_of(sqrt(1 - z * z) * cos(a), sqrt(1 - z * z) * sin(a), z);
}

// Whatever the tracer hits lies in a cell: the octree's ray ends there or before, and by no more
// than it takes to pass beside the surface.
static void cells_hold_what_rays_hit(void **state)
{
    (void)state;
    struct mesh m = {0};
    octree *o;
    tracer *t;
    shape_teapot(&m, 8);
    CHECK_OK(octree_create(&o, &m, 7));
    CHECK_OK(trace_create(&t, &m, NULL));
    struct random r = random_stream(1, 2, 3);
    int hits = 0, near = 0, misses = 0, other = 0;
    double turned = 0.0;
    for (int i = 0; i < 20000; i++) {
        const vec3 from = vec3_along(vec3_of(0, 1.5, 0), random_direction(&r), 6.0);
        const vec3 aim = vec3_of(random_range(&r, -2, 2), random_range(&r, 0, 3), 0);
        const vec3 d = vec3_unit(vec3_sub(aim, from));
        const float origin[3] = {(float)from.x, (float)from.y, (float)from.z};
        const float along[3] = {(float)d.x, (float)d.y, (float)d.z};
        struct trace_hit exact;
        struct octree_hit cell;
        const bool hit = trace_closest(t, origin, along, &exact);
        const bool found = octree_trace(&cell, o, from, d, 0.0);
        if (hit) {
            assert_true(found);
            const double before = (double)exact.distance - cell.distance;
            assert_true(before > -1e-3);
            hits++;
            if (before <= 4.0 * octree_cell(o)) {
                near++;
                const uint32_t *v = m.triangles[exact.triangle].vertex;
                const vec3 p = vertex_position(&m.vertices[v[0]]);
                const vec3 n = vec3_cross(vec3_sub(vertex_position(&m.vertices[v[1]]), p),
                                          vec3_sub(vertex_position(&m.vertices[v[2]]), p));
                turned += vec3_angle(vec3_unit(n), cell.normal);
            }
        } else {
            misses++;
            other += found;
        }
    }
    printf("%d hits, %d within four cells; %d misses, %d meet a cell; normals off by %.3f\n", hits,
           near, misses, other, turned / near);
    assert_true(near > 0.9 * hits && other < 0.3 * misses && turned < 0.1 * near);
    octree_destroy(&o);
    trace_destroy(&t);
    mesh_free(&m);
}

// One wall in two materials: normals are the wall's, the larger part names a cell, and what the
// cone does not resolve is one cell.
static void cells_know_their_wall(void **state)
{
    (void)state;
    struct mesh m = {0};
    struct octree_hit hit;
    octree *o;
    shape_quad(&m, vec3_of(0, 0, 0), vec3_of(1, 0, 0), vec3_of(0, 1, 0));
    shape_quad(&m, vec3_of(1, 0, 0), vec3_of(3, 0, 0), vec3_of(0, 1, 0));
    m.triangles[2].material = m.triangles[3].material = 7;
    CHECK_OK(octree_create(&o, &m, 5));
    assert_true(octree_trace(&hit, o, vec3_of(0.5, 0.5, 2), vec3_of(0, 0, -1), 0.0));
    CHECK_NEAR(hit.distance, 2.0, 1.01 * octree_cell(o));
    CHECK_NEAR(hit.normal.z, 1.0, 1e-6);
    CHECK_NEAR(hit.side, 4.0 / 32, 1e-5);
    assert_int_equal(hit.material, 0);
    assert_true(octree_trace(&hit, o, vec3_of(2.5, 0.5, 2), vec3_of(0, 0, -1), 0.0));
    assert_int_equal(hit.material, 7);
    assert_true(octree_trace(&hit, o, vec3_of(0.5, 0.5, 2), vec3_of(0, 0, -1), 1.0));
    CHECK_NEAR(hit.side, 1.0, 1e-4);  // the next finer one than the cone is wide there
    assert_true(hit.material == 7 || hit.material == 0);
    assert_false(octree_trace(&hit, o, vec3_of(0.5, 0.5, 2), vec3_of(0, 0, 1), 0.0));
    assert_false(octree_trace(&hit, o, vec3_of(0.5, 3.5, 2), vec3_of(0, 0, -1), 0.0));
    octree_destroy(&o);
    mesh_free(&m);
}

static void memory_may_end(void **state)
{
    (void)state;
    struct mesh m = {0};
    octree *o;
    shape_box(&m, vec3_of(0, 0, 0), vec3_of(1, 1, 1));
    for (long n = 1; n < 5; n++) {
        mem_fail_after(n);
        const relume_status status = octree_create(&o, &m, 4);
        const bool pending = mem_fail_pending();
        mem_fail_after(0);
        assert_true(status == RELUME_ENOMEM || (pending && status == RELUME_OK));
        octree_destroy(&o);
    }
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_hold_what_rays_hit),
        cmocka_unit_test(cells_know_their_wall),
        cmocka_unit_test(memory_may_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
