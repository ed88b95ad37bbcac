// Depth fused to meshes, against the shapes that the depth was made of; places seen by cameras.
#include "image/geometry/geometry.h"
#include "shape/atlas/charts.h"
#include "shape/fusion/field.h"
#include "shape/fusion/seen.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// ---------------------------------------------------------------- projections

static struct relume_geometry geometry_of(enum relume_projection projection)
{
    struct relume_geometry g = relume_geometry_default(projection, 64, 64);
    g.center = vec3_of(0.3, -0.2, 0.1);
    if (projection == RELUME_SLAB)
        g.pose = (struct relume_pose){.origin = {0.4, 0.1, -0.3},
                                      .axis = {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}};
    return g;
}

// A place along the ray of a pixel is seen there, and lies as far as it does.
static void expect_round_trip(const struct camera *c)
{
    for (int y = 0; y < c->height; y++)
        for (int x = 0; x < c->width; x++) {
            const double a = c->geometry.disc ? 0.5 : 0.31, at[2] = {x + a, y + a},
                         far = 0.4 + 0.01 * ((7 * x + 3 * y) % 50);
            double xy[2], distance;
            if (!relume_geometry_shows(&c->geometry, c->width, c->height, x, y))
                continue;
            const struct camera_ray ray = camera_ray_at(c, at[0], at[1]);
            const vec3 place = vec3_along(ray.origin, ray.direction, far);
            const bool seen = camera_project(xy, &distance, c, place);
            assert_true(seen);
            assert_true(fabs(distance - far) < 1e-9);
            assert_true(fabs(xy[0] - at[0]) < 1e-6 && fabs(xy[1] - at[1]) < 1e-6);
        }
}

static void test_cameras_see_what_their_rays_meet(void **state)
{
    (void)state;
    for (int p = RELUME_PLANAR; p <= RELUME_CUBE; p++)
        for (int more = 0; more < 2; more++) {
            struct camera c = {.geometry = geometry_of((enum relume_projection)p),
                               .width = p == RELUME_CUBE ? 96 : 40,
                               .height = p == RELUME_CUBE ? 16 : 30,
                               .uv = {0.2, -0.1}};
            if (p == RELUME_PLANAR)
                c.geometry.perspective = more;
            if (p == RELUME_CYLINDRICAL && more) {
                c.geometry.disc = 20;
                c.height = 50;
            }
            expect_round_trip(&c);
        }
}

// ---------------------------------------------------------------- shapes

// A ball of radius 0.5 before a wall z = -0.8; or, seen from within, a ball of radius 2.
static const double BALL = 0.5, WALL = -0.8, ROOM = 2.0;

static double distance_to_ball(const struct camera_ray *r, double radius, bool within)
{
    const double b = vec3_dot(r->origin, r->direction);
    const double c = vec3_dot(r->origin, r->origin) - radius * radius, d = b * b - c;
    return d < 0.0 ? (double)INFINITY : -b + (within ? sqrt(d) : -sqrt(d));
}

static double scene_depth(const struct camera_ray *r, bool room)
{
    if (room)
        return distance_to_ball(r, ROOM, true);
    const double wall = (WALL - r->origin.z) / r->direction.z;
    return fmin(distance_to_ball(r, BALL, false), wall > 0.0 ? wall : (double)INFINITY);
}

// How far a place is from the nearest surface.
static double off(vec3 p, bool room)
{
    const double r = vec3_length(p);
    return room ? fabs(r - ROOM) : fmin(fabs(r - BALL), fabs(p.z - WALL));
}

static struct witness witness_of(const struct camera *c, bool room, int hole)
{
    struct relume_image depth;
    struct witness s;
    assert_int_equal(relume_image_create(&depth, c->width, c->height, 1), RELUME_OK);
    for (int y = 0; y < c->height; y++)
        for (int x = 0; x < c->width; x++) {
            const struct camera_ray ray = camera_ray_at(c, x + 0.5, y + 0.5);
            const bool gone = abs(x - c->width / 2) < hole && abs(y - c->height / 2) < hole;
            depth.data[y * c->width + x] = gone ? NAN : (float)scene_depth(&ray, room);
        }
    assert_int_equal(witness_create(&s, c, &depth, (double)INFINITY, 1), RELUME_OK);
    return s;
}

struct fused {
    struct relume_mesh mesh;
    size_t left_out;
    double voxel;
};

static struct fused fuse(const struct witness *witness, int witnesses, int block, int threads)
{
    struct field f = {.witness = witness, .witnesses = witnesses, .threads = threads};
    struct fused out = {.left_out = 0};
    assert_int_equal(field_plan(&f, 0.0, NULL), RELUME_OK);
    assert_int_equal(field_fuse(&f, relume_volume_params(.spacing = {f.voxel, f.voxel, f.voxel})),
                     RELUME_OK);
    assert_int_equal(
        relume_isosurface(&out.mesh, NULL, f.volume, FIELD_SURFACE,
                          relume_isosurface_params(.blocks = {block}, .threads = threads)),
        RELUME_OK);
    for (size_t i = 0; i < out.mesh.vertex_count; i++) {
        out.mesh.position[i][0] += (float)f.origin.x;
        out.mesh.position[i][1] += (float)f.origin.y;
        out.mesh.position[i][2] += (float)f.origin.z;
    }
    assert_int_equal(
        seen_keep(&out.mesh, &out.left_out, witness, witnesses, 1.5 * f.voxel, threads), RELUME_OK);
    out.voxel = f.voxel;
    relume_volume_destroy(&f.volume);
    return out;
}

static vec3 vertex(const struct relume_mesh *m, size_t i)
{
    return vec3_of((double)m->position[i][0], (double)m->position[i][1], (double)m->position[i][2]);
}

// On average and at most, in voxels: at the edges of what is seen one ends between two pixels.
static void expect_near(const struct fused *f, bool room, double mean, double most)
{
    double sum = 0.0, worst = 0.0;
    assert_true(f->mesh.triangle_count > 100);
    for (size_t i = 0; i < f->mesh.triangle_count; i++) {
        const uint32_t *v = f->mesh.triangle[i];
        const vec3 middle =
            vec3_scale(vec3_add(vec3_add(vertex(&f->mesh, v[0]), vertex(&f->mesh, v[1])),
                                vertex(&f->mesh, v[2])),
                       1.0 / 3.0);
        const double d = off(middle, room) / f->voxel;
        sum += d;
        worst = fmax(worst, d);
    }
    sum /= (double)f->mesh.triangle_count;
    if (!(sum < mean && worst < most))
        fail_msg("off by %.3f voxels on average and %.3f at most; expected %.3f and %.3f", sum,
                 worst, mean, most);
}

enum { VIEWS = 9 };

static void make_slab(struct witness witness[VIEWS], int hole)
{
    for (int i = 0; i < VIEWS; i++) {
        const struct camera c = {.geometry = relume_geometry_default(RELUME_SLAB, 72, 72),
                                 .width = 72,
                                 .height = 72,
                                 .uv = {0.5 * (i % 3 - 1), 0.5 * (i / 3 - 1)}};
        witness[i] = witness_of(&c, false, hole);
    }
}

static void free_slab(struct witness witness[VIEWS])
{
    for (int i = 0; i < VIEWS; i++)
        witness_destroy(&witness[i]);
}

static void test_a_slab_of_a_ball_and_a_wall(void **state)
{
    (void)state;
    struct witness witness[VIEWS];
    make_slab(witness, 0);
    for (int block = 1; block <= 4; block *= 4) {
        struct fused f = fuse(witness, VIEWS, block, 2);
        expect_near(&f, false, block == 1 ? 0.08 : 0.12, 3.0);
        assert_true(f.left_out > 0);  // where the wall lies in the ball's shadow
        relume_mesh_free(&f.mesh);
    }
    struct fused one = fuse(witness, VIEWS, 2, 1), other = fuse(witness, VIEWS, 2, 5);
    assert_int_equal(one.mesh.triangle_count, other.mesh.triangle_count);
    assert_memory_equal(one.mesh.position, other.mesh.position,
                        one.mesh.vertex_count * sizeof *one.mesh.position);
    relume_mesh_free(&one.mesh);
    relume_mesh_free(&other.mesh);
    free_slab(witness);
}

// Normals point to the eye: out of the ball's front, and from the wall to +z.
static void test_normals_point_to_the_eyes(void **state)
{
    (void)state;
    struct witness witness[VIEWS];
    make_slab(witness, 0);
    struct fused f = fuse(witness, VIEWS, 1, 2);
    double least = 1.0;
    for (size_t i = 0; i < f.mesh.vertex_count; i++) {
        const vec3 p = vertex(&f.mesh, i);
        const vec3 n = vec3_of((double)f.mesh.normal[i][0], (double)f.mesh.normal[i][1],
                               (double)f.mesh.normal[i][2]);
        if (vec3_length(p) < 0.52 && p.z > 0.3)
            least = fmin(least, vec3_dot(n, vec3_unit(p)));
        if (fabs(p.x) > 0.75 && fabs(p.x) < 0.9 && fabs(p.y) < 0.8)
            assert_true(n.z > 0.95);
    }
    if (!(least > 0.95))
        fail_msg("a normal is off by a cosine of %.3f", least);
    relume_mesh_free(&f.mesh);
    free_slab(witness);
}

// What one view does not know others see; what nobody knows is a hole, not a surface.
static void test_holes(void **state)
{
    (void)state;
    struct witness witness[VIEWS];
    make_slab(witness, 6);
    struct fused f = fuse(witness, VIEWS, 2, 2), alone = fuse(witness + 4, 1, 2, 2);
    int front = 0, alone_front = 0;
    for (size_t i = 0; i < f.mesh.vertex_count; i++)
        front += hypot(vertex(&f.mesh, i).x, vertex(&f.mesh, i).y) < 0.05;
    for (size_t i = 0; i < alone.mesh.vertex_count; i++)
        alone_front += hypot(vertex(&alone.mesh, i).x, vertex(&alone.mesh, i).y) < 0.05;
    assert_true(front > 0);
    assert_int_equal(alone_front, 0);
    expect_near(&f, false, 0.15, 3.0);
    relume_mesh_free(&f.mesh);
    relume_mesh_free(&alone.mesh);
    free_slab(witness);
}

static void test_a_panorama_of_a_round_room(void **state)
{
    (void)state;
    for (int p = RELUME_CYLINDRICAL; p <= RELUME_CUBE; p++) {
        const struct camera c = {.geometry = geometry_of((enum relume_projection)p),
                                 .width = p == RELUME_CUBE ? 240 : 160,
                                 .height = p == RELUME_CUBE ? 40 : 80};
        struct witness s = witness_of(&c, true, 0);
        struct fused f = fuse(&s, 1, 2, 2);
        expect_near(&f, true, 0.1, 3.0);
        // -1 on average: all normals point to the middle; at the edges of what is seen some do not
        double inwards = 0.0;
        for (size_t i = 0; i < f.mesh.vertex_count; i++)
            inwards += vec3_dot(vec3_unit(vertex(&f.mesh, i)),
                                vec3_of((double)f.mesh.normal[i][0], (double)f.mesh.normal[i][1],
                                        (double)f.mesh.normal[i][2]));
        if (!(inwards < -0.93 * (double)f.mesh.vertex_count))
            fail_msg("%s: normals are off by a cosine of %.4f on average",
                     relume_projection_name((enum relume_projection)p),
                     inwards / (double)f.mesh.vertex_count);
        relume_mesh_free(&f.mesh);
        witness_destroy(&s);
    }
}

static void test_depth_without_a_surface(void **state)
{
    (void)state;
    const struct camera c = {
        .geometry = relume_geometry_default(RELUME_SLAB, 8, 8), .width = 8, .height = 8};
    struct relume_image depth;
    struct witness s;
    assert_int_equal(relume_image_create(&depth, 8, 8, 1), RELUME_OK);
    for (int i = 0; i < 64; i++)
        depth.data[i] = i % 3 == 0 ? INFINITY : i % 3 == 1 ? NAN : -1.0f;
    assert_int_equal(witness_create(&s, &c, &depth, (double)INFINITY, 1), RELUME_OK);
    struct field f = {.witness = &s, .witnesses = 1, .threads = 1};
    assert_int_equal(field_plan(&f, 0.0, NULL), RELUME_EUNFIT);
    s.depth.data[9] = 2.0f;
    assert_int_equal(field_plan(&f, 0.1, NULL), RELUME_OK);
    assert_int_equal(field_plan(&f, 0.0, NULL), RELUME_EUNFIT);  // a point has no size
    s.depth.data[10] = 2.0f;
    assert_int_equal(field_plan(&f, 1e-9, NULL), RELUME_EINVAL);
    witness_destroy(&s);
}

// A sheet with bumps in it, of which each has sides that face six ways; and a step that faces
// nobody's way, which stays a chart of its own.
static void test_small_charts(void **state)
{
    (void)state;
    enum { ACROSS = 24, TRIANGLES = 2 * ACROSS * ACROSS };
    static struct atlas_corner triangle[TRIANGLES][3];
    static const int corner[2][3][2] = {{{0, 0}, {1, 0}, {0, 1}}, {{1, 0}, {1, 1}, {0, 1}}};
    struct charts as_they_are, merged;
    for (int i = 0; i < TRIANGLES; i++)
        for (int k = 0; k < 3; k++) {
            const int x = i / 2 % ACROSS + corner[i % 2][k][0];
            const int y = i / 2 / ACROSS + corner[i % 2][k][1];
            const bool bump = x % 6 == 3 && y % 6 == 3;
            const float height = x >= ACROSS / 2 ? 40.0f : 0.0f;
            memcpy(triangle[i][k].position, (float[]){(float)x, (float)y, height + 1.3f * bump},
                   sizeof triangle[i][k].position);
        }
    assert_int_equal(charts_make(&as_they_are, triangle, TRIANGLES, NULL, 0.0), RELUME_OK);
    assert_int_equal(charts_make(&merged, triangle, TRIANGLES, NULL, 8.0), RELUME_OK);
    assert_true(as_they_are.count > 20);
    assert_int_equal(merged.count, 3);
    for (int i = 0; i < TRIANGLES; i++)
        assert_true(merged.of[i] < merged.count && merged.face[i] < 6);
    charts_free(&as_they_are);
    charts_free(&merged);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cameras_see_what_their_rays_meet),
        cmocka_unit_test(test_a_slab_of_a_ball_and_a_wall),
        cmocka_unit_test(test_normals_point_to_the_eyes),
        cmocka_unit_test(test_holes),
        cmocka_unit_test(test_a_panorama_of_a_round_room),
        cmocka_unit_test(test_depth_without_a_surface),
        cmocka_unit_test(test_small_charts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
