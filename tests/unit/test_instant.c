// Virtual lights and imperfect shadow maps: sums and form factors in closed form, shadows against
// those by rays, holes, limits.
#include "test.h"

#include "core/base/memory.h"
#include "core/math/random.h"
#include "relight/view/view.h"
#include "world/stage/shapes.h"
#include "world/transport/instant.h"

#include <relume/relight/view.h>

enum { ROWS = 48, COLUMNS = 2 * ROWS };
static const double radius = 3.0;
static const struct relume_geometry sphere = {.projection = RELUME_SPHERICAL};

// Walls of a sphere around the origin, or else nothing near; all of it shows `shown`.
static struct scenery *make_scenery(bool near, float shown)
{
    struct relume_image places, relit;
    struct scenery *c;
    CHECK_OK(relume_image_create(&places, COLUMNS, ROWS, 3));
    CHECK_OK(relume_image_create(&relit, COLUMNS, ROWS, 3));
    for (int y = 0; y < ROWS; y++)
        for (int x = 0; x < COLUMNS; x++) {
            const vec3 d = relume_panorama_ray(&sphere, COLUMNS, ROWS, x + 0.5, y + 0.5);
            const vec3 at = vec3_scale(d, near ? radius : NAN);
            float *place = places.data + 3 * (y * COLUMNS + x);
            place[0] = (float)at.x, place[1] = (float)at.y, place[2] = (float)at.z;
            for (int k = 0; k < 3; k++)
                relit.data[3 * (y * COLUMNS + x) + k] = shown;
        }
    CHECK_OK(scenery_create(&c, &sphere, vec3_of(0, 0, 0), &places, NULL));
    CHECK_OK(scenery_light(c, &relit, vec3_of(0, 0, 0)));
    relume_image_destroy(&places);
    relume_image_destroy(&relit);
    return c;
}

// Objects are matte and of one reflectance, and no lamp lights them.
struct stage {
    struct world world;
    struct mesh mesh;
    struct scenery *scenery;
    tracer *tracer;
    float grey;
};

static void site_at(struct site *out, const void *context, const struct trace_hit *hit,
                    vec3 direction)
{
    const struct stage *s = context;
    const uint32_t *v = s->mesh.triangles[hit->triangle].vertex;
    const vec3 a = vertex_position(&s->mesh.vertices[v[0]]);
    const vec3 u = vec3_sub(vertex_position(&s->mesh.vertices[v[1]]), a);
    const vec3 w = vec3_sub(vertex_position(&s->mesh.vertices[v[2]]), a);
    const vec3 at = vec3_along(vec3_along(a, u, (double)hit->u), w, (double)hit->v);
    vec3 n = vec3_unit(vec3_cross(u, w));
    if (vec3_dot(n, direction) > 0.0)
        n = vec3_scale(n, -1.0);
    *out = (struct site){.position = at, .normal = n, .start = vec3_along(at, n, 1e-5)};
}

static void send_grey(float rgb[3], const void *context, const struct trace_hit *hit, vec3 origin,
                      vec3 direction, uint64_t key, const struct arrival *arrivals, int n)
{
    const struct stage *s = context;
    (void)hit, (void)origin, (void)direction, (void)key;
    for (int c = 0; c < 3; c++) {
        double sum = 0.0;
        for (int i = 0; i < n; i++)
            sum += arrivals[i].share * (double)arrivals[i].with[c];
        rgb[c] = s->grey * (float)sum;
    }
}

static double dim_nothing(const void *context, vec3 place, vec3 normal, uint64_t key)
{
    (void)context, (void)place, (void)normal, (void)key;
    return 1.0;
}

static void begin_stage(struct stage *s, bool near, float shown, vec3 middle, double size)
{
    *s = (struct stage){.grey = 0.5f};
    shape_sphere(&s->mesh, middle, size, 48);
    CHECK_OK(trace_create(&s->tracer, &s->mesh, NULL));
    s->scenery = make_scenery(near, shown);
    s->world = (struct world){.scenery = s->scenery,
                              .objects = s->tracer,
                              .mesh = &s->mesh,
                              .site = site_at,
                              .sent = send_grey,
                              .dimmed = dim_nothing,
                              .context = s,
                              .radius = size * sqrt(3.0),
                              .samples = 1024,
                              .threads = 2};
}

static void end_stage(struct stage *s)
{
    scenery_destroy(&s->scenery);
    trace_destroy(&s->tracer);
    mesh_free(&s->mesh);
}

struct sum {
    double without, with;
    int n;
};

static void add(void *context, const struct arrival *a)
{
    struct sum *s = context;
    s->without += a->share * (double)a->without[0];
    s->with += a->share * (double)a->with[0];
    s->n++;
}

static vec3 any_direction(int i, int n)
{
    const double z = 1.0 - (2.0 * i + 1.0) / n, r = sqrt(1.0 - z * z);
    return vec3_of(r * cos(2.399963 * i), z, r * sin(2.399963 * i));
}

// ---------------------------------------------------------------- lights

// What they stand for is all that sends: walls, or the whole sky.
static void sizes_add_up(void **state)
{
    (void)state;
    enum { COUNT = 4096 };
    struct virtual_light *light = malloc(COUNT * sizeof *light);
    for (int near = 0; near < 2; near++) {
        struct stage s;
        size_t found;
        double sum = 0.0;
        begin_stage(&s, near, 2.0f, vec3_of(0, 0, 0), 0.2);
        CHECK_OK(virtual_of_scene(light, &found, &s.world, COUNT));
        assert_int_equal(found, COUNT);
        for (size_t i = 0; i < found; i++) {
            sum += light[i].size / (near ? radius * radius : 1.0);
            assert_true(light[i].far == !near);
            CHECK_NEAR(light[i].with[0], 2.0, 1e-5);
            if (near)
                CHECK_NEAR(vec3_dot(light[i].normal, light[i].place), -radius, 0.05);
        }
        CHECK_NEAR(sum / (4.0 * M_PI), 1.0, 0.01);
        end_stage(&s);
    }
    free(light);
}

static void darkness_has_no_lights(void **state)
{
    (void)state;
    struct virtual_light light[8];
    for (int shown = 0; shown < 2; shown++) {
        struct stage s;
        struct sum sum = {0.0, 0.0, 0};
        size_t found = 1;
        begin_stage(&s, true, shown ? NAN : 0.0f, vec3_of(0, 0, 0), 0.2);
        CHECK_OK(virtual_of_scene(light, &found, &s.world, 8));
        assert_int_equal(found, 0);
        s.world.samples = 1, s.world.bounces = 2;
        CHECK_OK(instant_begin(&s.world, &(struct instant_params){.pattern = 2}, NULL));
        const struct site site = {.position = {0, 1, 0}, .normal = {0, 1, 0}, .start = {0, 1, 0}};
        instant_gather(&s.world, &site, add, &sum);
        assert_int_equal(sum.n, 0);
        instant_end(&s.world);
        end_stage(&s);
    }
}

// However near it is, no light is more than the whole sky; far away its share is its form factor.
static void shares_have_a_bound(void **state)
{
    (void)state;
    const struct site site = {.normal = {0, 0, 1}};
    struct virtual_light light = {.normal = {0, 0, -1}, .size = 0.01};
    struct sight sight;
    for (double d = 1e-6; d < 100.0; d *= 2.0) {
        light.place = vec3_of(0, 0, d);
        assert_true(virtual_sight(&sight, &light, &site) && sight.share <= 1.0);
        if (d > 0.1)
            CHECK_NEAR(sight.share, 0.01 / (M_PI * d * d), 1e-12);
    }
    light.place = vec3_of(0, 0, -1);
    assert_false(virtual_sight(&sight, &light, &site));
    light.place = vec3_of(0, 0, 0);
    assert_false(virtual_sight(&sight, &light, &site));
}

// Walls or a sky of 1 show 1 on white, whichever way it faces, and shadows are in nobody's way:
// 4096 lights in strata are off by about 1 / sqrt(4096).
static void even_light_is_even(void **state)
{
    (void)state;
    for (int way = 0; way < 4; way++) {
        struct stage s;
        begin_stage(&s, way & 1, 1.0f, vec3_of(0, -1.5, 0), 0.2);
        s.world.samples = 4096;
        CHECK_OK(instant_begin(
            &s.world,
            &(struct instant_params){.pattern = 1, .rays = way & 2, .size = 32, .points = 128},
            NULL));
        for (int i = 0; i < 20; i++) {
            struct sum sum = {0.0, 0.0, 0};
            const vec3 normal = any_direction(i, 20), at = vec3_of(0.4, 1.0, -0.3);
            const struct site site = {.position = at, .normal = normal, .start = at};
            instant_gather(&s.world, &site, add, &sum);
            CHECK_NEAR(sum.without, 1.0, 0.02);
            assert_true(sum.with <= sum.without && sum.with > 0.9 * sum.without);
        }
        instant_end(&s.world);
        end_stage(&s);
    }
}

// What a ball keeps from a place that faces it: (r / d)^2.
static void a_ball_hides_its_form_factor(void **state)
{
    (void)state;
    const double r = 0.5, d = 1.5;
    for (int way = 0; way < 4; way++) {
        struct stage s;
        struct sum sum = {0.0, 0.0, 0};
        begin_stage(&s, way & 1, 1.0f, vec3_of(0, 0.5, 0), r);
        s.world.samples = 4096;
        CHECK_OK(instant_begin(
            &s.world,
            &(struct instant_params){.pattern = 1, .rays = way & 2, .size = 64, .points = 1024},
            NULL));
        const vec3 at = vec3_of(0, 0.5 - d, 0);
        const struct site site = {.position = at, .normal = {0, 1, 0}, .start = at};
        instant_gather(&s.world, &site, add, &sum);
        CHECK_NEAR((sum.without - sum.with) / sum.without, r * r / (d * d), 0.012);
        instant_end(&s.world);
        end_stage(&s);
    }
}

// A grey ball in a furnace of 1 sends g / (1 - g (1 - F)) where ... it is convex: g of what
// arrives, and its form factor of that comes back to a place that faces it.
static void objects_send_light(void **state)
{
    (void)state;
    const double r = 0.5, d = 1.5;
    for (int rays = 0; rays < 2; rays++) {
        struct stage s;
        struct sum sum = {0.0, 0.0, 0};
        begin_stage(&s, true, 1.0f, vec3_of(0, 0.5, 0), r);
        s.world.samples = 4096, s.world.bounces = 3;
        CHECK_OK(instant_begin(
            &s.world,
            &(struct instant_params){.pattern = 1, .rays = rays, .size = 64, .points = 1024},
            NULL));
        const vec3 at = vec3_of(0, 0.5 - d, 0);
        const struct site site = {.position = at, .normal = {0, 1, 0}, .start = at};
        instant_gather(&s.world, &site, add, &sum);
        CHECK_NEAR(sum.with / sum.without, 1.0 - 0.5 * r * r / (d * d), 0.012);
        instant_end(&s.world);
        end_stage(&s);
    }
}

// Where objects change nothing, both numbers are the same.
static void hidden_objects_change_nothing(void **state)
{
    (void)state;
    for (int rays = 0; rays < 2; rays++) {
        struct stage s;
        begin_stage(&s, true, 1.0f, vec3_of(9, 0, 0), 1.0);
        s.world.samples = 256, s.world.bounces = rays ? 2 : 0;  // maps leak some of it
        CHECK_OK(
            instant_begin(&s.world, &(struct instant_params){.pattern = 2, .rays = rays}, NULL));
        for (int i = 0; i < 100; i++) {
            struct sum sum = {0.0, 0.0, 0};
            const vec3 out = any_direction(i, 100), normal = vec3_scale(out, -1.0);
            const vec3 at = vec3_scale(out, 2.9);
            const struct site site = {
                .position = at, .normal = normal, .start = at, .key = (uint64_t)i};
            instant_gather(&s.world, &site, add, &sum);
            assert_true(sum.with == sum.without && sum.with > 0.5);
        }
        instant_end(&s.world);
        end_stage(&s);
    }
}

// ---------------------------------------------------------------- maps

// How often a map is wrong about whether a ball hides it from places of a plane behind the ball,
// in all three kinds.
static double part_wrong(size_t points, bool unfilled, enum map_kind kind)
{
    enum { MAPS = 16, PLACES = 1000, SIZE = 64 };
    struct mesh mesh = {0};
    struct map_look look[MAPS];
    struct points p;
    struct maps m = {look, malloc(MAPS * SIZE * SIZE * sizeof(float)), MAPS, SIZE, 0.0};
    tracer *t;
    int wrong = 0;
    shape_sphere(&mesh, vec3_of(0, 0, 0), 0.5, 64);
    CHECK_OK(trace_create(&t, &mesh, NULL));
    CHECK_OK(points_of_objects(&p, &mesh, t, 1 << 14, 2));
    for (int i = 0; i < MAPS; i++) {
        const vec3 from = vec3_unit(vec3_of(0.05 * (i % 4), 1.0, 0.05 * (i / 4)));
        const vec3 place = vec3_scale(from, 1.5), down = vec3_scale(from, -1.0);
        look[i] = kind == MAP_FAR    ? map_of_far(from, vec3_of(0, 0, 0), 0.5)
                  : kind == MAP_CONE ? map_of_ball(place, down, vec3_of(0, 0, 0), 0.5)
                                     : map_of_hemisphere(place, down);
        assert_int_equal(look[i].kind, kind);
    }
    CHECK_OK(maps_draw(
        &m, &p, &(struct maps_params){.points = points, .unfilled = unfilled, .threads = 2}));
    for (int i = 0; i < MAPS; i++)
        for (int k = 0; k < PLACES; k++) {
            struct random r = random_stream(1, (uint64_t)k, (uint64_t)i);
            const vec3 at = vec3_of(random_range(&r, -2, 2), -1.0, random_range(&r, -2, 2));
            const vec3 to = kind == MAP_FAR ? vec3_scale(look[i].z, -1.0)
                                            : vec3_unit(vec3_sub(look[i].place, at));
            const float from[3] = {(float)at.x, (float)at.y, (float)at.z},
                        along[3] = {(float)to.x, (float)to.y, (float)to.z};
            struct trace_hit hit;
            wrong += maps_open(&m, (size_t)i, at, vec3_of(0, 1, 0)) ==
                     trace_closest(t, from, along, &hit);
        }
    free(m.depth);
    points_forget(&p);
    trace_destroy(&t);
    mesh_free(&mesh);
    return (double)wrong / (MAPS * PLACES);
}

// (Fig. 5.8 of the thesis.) What is left are outlines: texels of 64, of which the ball takes up 11
// in a hemisphere, 64 in a cone and 23 from far away, and more of the plane.
static void errors_fall_with_points(void **state)
{
    (void)state;
    static const enum map_kind kinds[] = {MAP_HEMISPHERE, MAP_CONE, MAP_FAR};
    static const double most[] = {0.04, 0.012, 0.008};
    for (int k = 0; k < 3; k++) {
        double before = 1.0;
        for (size_t points = 16; points <= 4096; points *= 16) {
            const double found = part_wrong(points, false, kinds[k]);
            assert_true(found < before);
            before = found;
        }
        assert_true(before < most[k]);
    }
    assert_true(part_wrong(512, false, MAP_CONE) < part_wrong(512, true, MAP_CONE));
}

// A surface with holes that show another behind it, and nothing; its outline stays where it is, and
// something thin before it too.
static void holes_are_filled(void **state)
{
    (void)state;
    enum { N = 16 };
    float depth[N * N];
    struct map_level levels[N * N / 2];
    for (int y = 0; y < N; y++)
        for (int x = 0; x < N; x++)
            depth[y * N + x] = x < 8 ? 1.0f : INFINITY;
    depth[3 * N + 3] = INFINITY;
    depth[6 * N + 5] = 2.0f;
    depth[9 * N + 2] = 0.5f;
    for (int y = 12; y < 14; y++)
        for (int x = 4; x < 6; x++)
            depth[y * N + x] = INFINITY;
    maps_fill(depth, N, 0.1, levels);
    for (int y = 0; y < N; y++)
        for (int x = 0; x < N; x++)
            assert_true(depth[y * N + x] == (y == 9 && x == 2 ? 0.5f : x < 8 ? 1.0f : INFINITY));
}

// ---------------------------------------------------------------- limits

static void too_many_lights_are_refused(void **state)
{
    (void)state;
    struct stage s;
    struct test_log log;
    test_log_init(&log);
    begin_stage(&s, true, 1.0f, vec3_of(0, 0, 0), 0.2);
    s.world.samples = 4097;
    assert_int_equal(
        instant_begin(&s.world, &(struct instant_params){.pattern = INSTANT_PATTERN}, &log.log),
        RELUME_ELIMIT);
    assert_int_equal(log.lines, 1);
    assert_non_null(strstr(log.text, "at most 4096 samples"));
    instant_end(&s.world);
    end_stage(&s);
}

static void memory_may_run_out_anywhere(void **state)
{
    (void)state;
    struct stage s;
    relume_status status = RELUME_ENOMEM;
    begin_stage(&s, true, 1.0f, vec3_of(0, 0, 0), 0.2);
    s.world.samples = 4, s.world.bounces = 1;
    for (long n = 1; status == RELUME_ENOMEM; n++) {
        mem_fail_after(n);
        status = instant_begin(&s.world, &(struct instant_params){.pattern = 1, .size = 8}, NULL);
        instant_end(&s.world);
        assert_true(n < 100);
    }
    mem_fail_after(0);
    CHECK_OK(status);
    end_stage(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_add_up),
        cmocka_unit_test(darkness_has_no_lights),
        cmocka_unit_test(shares_have_a_bound),
        cmocka_unit_test(even_light_is_even),
        cmocka_unit_test(a_ball_hides_its_form_factor),
        cmocka_unit_test(objects_send_light),
        cmocka_unit_test(hidden_objects_change_nothing),
        cmocka_unit_test(errors_fall_with_points),
        cmocka_unit_test(holes_are_filled),
        cmocka_unit_test(too_many_lights_are_refused),
        cmocka_unit_test(memory_may_run_out_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
