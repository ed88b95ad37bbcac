// Surfaces as points: areas, even spread in any run, sides, captured places and what they send.
#include "test.h"

#include "core/base/memory.h"
#include "relight/view/view.h"
#include "world/stage/shapes.h"
#include "world/transport/points.h"

#include <relume/relight/view.h>

enum { COUNT = 4096 };

static tracer *trace_mesh(const struct mesh *mesh)
{
    tracer *t;
    CHECK_OK(trace_create(&t, mesh, NULL));
    return t;
}

static void areas_add_up(void **state)
{
    (void)state;
    static const size_t counts[] = {1, 7, COUNT};
    struct mesh m = {0};
    shape_sphere(&m, vec3_of(1, 2, 3), 2.0, 96);
    tracer *t = trace_mesh(&m);
    for (size_t k = 0; k < 3; k++) {
        struct points p;
        double sum = 0.0;
        CHECK_OK(points_of_objects(&p, &m, t, counts[k], 1));
        assert_int_equal(p.count, counts[k]);
        for (size_t i = 0; i < p.count; i++) {
            const vec3 from = vec3_sub(p.at[i].place, vec3_of(1, 2, 3));
            sum += p.at[i].area;
            CHECK_NEAR(vec3_length(from), 2.0, 0.004);  // 96 corners around: 4 (1 - cos(pi / 96))
            CHECK_NEAR(vec3_dot(vec3_unit(from), p.at[i].normal), 1.0, 0.002);
            assert_false(p.at[i].both);
        }
        CHECK_NEAR(sum, 4.0 * M_PI * 4.0, 0.05);
        points_forget(&p);
    }
    trace_destroy(&t);
    mesh_free(&m);
}

// Of a box whose sides are of very different sizes, and of any run of its points: a cell holds what
// its area asks for. By chance 64 would differ by 8, and by three times that in one cell of 200.
static void runs_are_spread_evenly(void **state)
{
    (void)state;
    enum { CELLS = 8, RUN = 1024 };
    struct mesh m = {0};
    shape_box(&m, vec3_of(0, 0, 0), vec3_of(4, 2, 1));
    tracer *t = trace_mesh(&m);
    struct points p;
    CHECK_OK(points_of_objects(&p, &m, t, 8 * RUN, 1));
    for (size_t first = 0; first < p.count; first += 3 * RUN / 2) {
        int in_cell[CELLS][CELLS] = {{0}};
        const double want = RUN * 8.0 / 28.0 / (CELLS * CELLS);  // the front is 8 of 28
        for (size_t i = first; i < first + RUN && i < p.count; i++) {
            const vec3 at = p.at[i].place;
            if (p.at[i].normal.z > 0.5)
                in_cell[(int)(at.y / 2.0 * CELLS)][(int)(at.x / 4.0 * CELLS)]++;
        }
        for (int i = 0; i < CELLS * CELLS && first + RUN <= p.count; i++)
            CHECK_NEAR(in_cell[i / CELLS][i % CELLS], want, 4.0);
    }
    points_forget(&p);
    trace_destroy(&t);
    mesh_free(&m);
}

// A mesh that is turned inside out is open outwards all the same; a sheet is open on both sides.
static void light_gets_to_the_outer_side(void **state)
{
    (void)state;
    struct mesh m = {0}, sheet = {0};
    struct points p;
    shape_sphere(&m, vec3_of(0, 0, 0), 1.0, 32);
    for (size_t i = 0; i < m.triangle_count; i++) {
        const uint32_t first = m.triangles[i].vertex[0];
        m.triangles[i].vertex[0] = m.triangles[i].vertex[1];
        m.triangles[i].vertex[1] = first;
    }
    tracer *t = trace_mesh(&m);
    CHECK_OK(points_of_objects(&p, &m, t, 256, 2));
    for (size_t i = 0; i < p.count; i++)
        assert_true(vec3_dot(p.at[i].normal, p.at[i].place) > 0.9 && !p.at[i].both);
    points_forget(&p);
    trace_destroy(&t);
    mesh_free(&m);

    shape_quad(&sheet, vec3_of(0, 0, 0), vec3_of(1, 0, 0), vec3_of(0, 1, 0));
    t = trace_mesh(&sheet);
    CHECK_OK(points_of_objects(&p, &sheet, t, 16, 1));
    for (size_t i = 0; i < p.count; i++)
        assert_true(p.at[i].both);
    points_forget(&p);
    trace_destroy(&t);
    mesh_free(&sheet);
}

// Triangles without area get no point; without any there are none.
static void what_has_no_area_has_no_points(void **state)
{
    (void)state;
    struct mesh m = {0};
    struct points p;
    for (int i = 0; i < 3; i++)
        (void)mesh_vertex(&m, vec3_of(i, 0, 0), vec3_of(0, 0, 1), vec3_of(0, 0, 0));
    mesh_triangle(&m, 0, 1, 2, 0);
    tracer *t = trace_mesh(&m);
    CHECK_OK(points_of_objects(&p, &m, t, 16, 1));
    assert_int_equal(p.count, 0);
    trace_destroy(&t);
    shape_quad(&m, vec3_of(0, 0, 0), vec3_of(1, 0, 0), vec3_of(0, 1, 0));
    t = trace_mesh(&m);
    CHECK_OK(points_of_objects(&p, &m, t, 16, 1));
    for (size_t i = 0; i < p.count; i++)
        assert_true(p.at[i].triangle > 0);
    points_forget(&p);
    CHECK_OK(points_of_objects(&p, &m, t, 0, 1));
    assert_int_equal(p.count, 0);
    mem_fail_after(1);
    assert_int_equal(points_of_objects(&p, &m, t, 16, 1), RELUME_ENOMEM);
    mem_fail_after(2);
    assert_int_equal(points_of_objects(&p, &m, t, 16, 1), RELUME_ENOMEM);
    mem_fail_after(0);
    trace_destroy(&t);
    mesh_free(&m);
}

// ---------------------------------------------------------------- a captured scene

enum { ROWS = 48, COLUMNS = 2 * ROWS };

// Walls 3 away all around `eye`, but for a hole that shows nothing; a pixel shows its direction.
static struct scenery *make_scenery(vec3 eye)
{
    const struct relume_geometry geometry = {.projection = RELUME_SPHERICAL};
    struct relume_image places, relit;
    struct scenery *c;
    CHECK_OK(relume_image_create(&places, COLUMNS, ROWS, 3));
    CHECK_OK(relume_image_create(&relit, COLUMNS, ROWS, 3));
    for (int y = 0; y < ROWS; y++)
        for (int x = 0; x < COLUMNS; x++) {
            const vec3 d = relume_panorama_ray(&geometry, COLUMNS, ROWS, x + 0.5, y + 0.5);
            const vec3 at = vec3_along(eye, d, d.x > 0.8 ? NAN : 3.0);
            float *place = places.data + 3 * (y * COLUMNS + x);
            float *shown = relit.data + 3 * (y * COLUMNS + x);
            place[0] = (float)at.x, place[1] = (float)at.y, place[2] = (float)at.z;
            shown[0] = (float)(2.0 + d.x), shown[1] = (float)(2.0 + d.y), shown[2] = NAN;
        }
    CHECK_OK(scenery_create(&c, &geometry, eye, &places, NULL));
    CHECK_OK(scenery_light(c, &relit, eye));
    relume_image_destroy(&places);
    relume_image_destroy(&relit);
    return c;
}

static void points_of_a_scene_lie_on_its_places(void **state)
{
    (void)state;
    const vec3 eye = vec3_of(0.5, -1.0, 2.0);
    struct scenery *c = make_scenery(eye);
    struct points p;
    double sum = 0.0;
    CHECK_OK(points_of_scene(&p, c, COUNT));
    assert_int_equal(p.count, COUNT);
    for (size_t i = 0; i < p.count; i++) {
        float rgb[3];
        const vec3 from = vec3_sub(p.at[i].place, eye), d = vec3_unit(from);
        sum += p.at[i].area;
        CHECK_NEAR(vec3_length(from), 3.0, 0.01);
        CHECK_NEAR(vec3_dot(p.at[i].normal, d), -1.0, 0.01);
        assert_true(d.x < 0.85);
        points_scene_sent(rgb, c, &p.at[i]);
        CHECK_NEAR(rgb[0], 2.0 + d.x, 0.01);
        CHECK_NEAR(rgb[1], 2.0 + d.y, 0.01);
        assert_true(rgb[2] == 0.0f);  // NaN is no light
    }
    // a sphere without a cap of height 0.2, whose rim is known to a pixel
    CHECK_NEAR(sum, 2.0 * M_PI * 9.0 * 1.8, 2.2);
    points_forget(&p);
    scenery_destroy(&c);
}

// ---------------------------------------------------------------- what objects send

static void send_z(float rgb[3], const void *context, const struct trace_hit *hit, vec3 origin,
                   vec3 direction, uint64_t key, const struct arrival *arrivals, int n)
{
    const struct mesh *m = context;
    const uint32_t *v = m->triangles[hit->triangle].vertex;
    vec3 at = vec3_of(0, 0, 0);
    const double weight[3] = {1.0 - (double)hit->u - (double)hit->v, (double)hit->u,
                              (double)hit->v};
    for (int k = 0; k < 3; k++)
        at = vec3_along(at, vertex_position(&m->vertices[v[k]]), weight[k]);
    const vec3 met = vec3_along(origin, direction, (double)hit->distance);
    CHECK_NEAR(vec3_length(vec3_sub(met, at)), 0.0, 1e-5);
    rgb[0] = (float)at.z, rgb[1] = (float)key, rgb[2] = n ? arrivals->with[0] : 0.0f;
}

static void points_of_objects_send_what_rays_meet(void **state)
{
    (void)state;
    const struct arrival arrival = {.with = {5, 6, 7}};
    struct mesh m = {0};
    struct points p;
    shape_sphere(&m, vec3_of(0, 0, 0), 1.0, 32);
    tracer *t = trace_mesh(&m);
    const struct world w = {.objects = t, .mesh = &m, .sent = send_z, .context = &m};
    CHECK_OK(points_of_objects(&p, &m, t, 64, 1));
    for (size_t i = 0; i < p.count; i++) {
        float rgb[3];
        points_object_sent(rgb, &w, &p.at[i], 9, &arrival, 1);
        CHECK_NEAR(rgb[0], p.at[i].place.z, 1e-5);
        assert_true(rgb[1] == 9.0f && rgb[2] == 5.0f);
    }
    points_forget(&p);
    trace_destroy(&t);
    mesh_free(&m);
}

// ---------------------------------------------------------------- what shines

static const vec3 highlight = {0.6, 0.0, 0.8};
static const double exponent = 10.0;

static void send_highlight(float rgb[3], const void *context, const struct trace_hit *hit,
                           vec3 origin, vec3 direction, uint64_t key,
                           const struct arrival *arrivals, int n)
{
    (void)context, (void)hit, (void)origin, (void)key, (void)arrivals, (void)n;
    rgb[0] = rgb[1] = rgb[2] = (float)pow(fmax(-vec3_dot(direction, highlight), 0.0), exponent);
}

static void send_all(float rgb[3], const void *context, const struct trace_hit *hit, vec3 origin,
                     vec3 direction, uint64_t key, const struct arrival *arrivals, int n)
{
    (void)context, (void)hit, (void)origin, (void)direction, (void)key;
    for (int c = 0; c < 3; c++) {
        rgb[c] = 0.0f;
        for (int i = 0; i < n; i++)
            rgb[c] += (float)arrivals[i].share * arrivals[i].with[c];
    }
}

static const struct point upwards = {.normal = {0, 0, 1}, .area = 1.0};

// Of a highlight over the half space, each direction by its cosine; from a fine grid of the disc.
static void means_are_those_of_all_directions(void **state)
{
    (void)state;
    enum { FINE = 400, POINTS = 200 };
    const struct world w = {.sent = send_highlight};
    double want = 0.0, found = 0.0;
    int n = 0;
    for (int i = 0; i < FINE * FINE; i++) {
        const double u = 2.0 * (i % FINE + 0.5) / FINE - 1.0,
                     v = 2.0 * (i / FINE + 0.5) / FINE - 1.0;
        if (u * u + v * v < 1.0) {
            const vec3 d = vec3_of(u, v, sqrt(1.0 - u * u - v * v));
            want += pow(fmax(vec3_dot(d, highlight), 0.0), exponent);
            n++;
        }
    }
    for (uint64_t key = 0; key < POINTS; key++) {
        float mean[3];
        points_object_mean(mean, &w, &upwards, key, NULL, 0);
        found += (double)mean[0] / POINTS;
    }
    CHECK_NEAR(found, want / n, 0.01 * want / n);
}

static void arrivals_are_kept(void **state)
{
    (void)state;
    enum { N = 200 };
    const struct world w = {.sent = send_all};
    struct arrival arrivals[N];
    double want = 0.0;
    for (int i = 0; i < N; i++) {
        arrivals[i] =
            (struct arrival){.towards = points_direction(&upwards, (i + 0.5) / N, 0.6180339887 * i),
                             .share = 1.0 / N,
                             .with = {(float)(i % 7), 1.0f, 0.0f}};
        want += i % 7 / (double)N;
    }
    float mean[3];
    points_object_mean(mean, &w, &upwards, 1, arrivals, N);
    CHECK_NEAR(mean[0], want, 1e-4);
    CHECK_NEAR(mean[1], 1.0, 1e-4);
    CHECK_NEAR(mean[2], 0.0, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(areas_add_up),
        cmocka_unit_test(runs_are_spread_evenly),
        cmocka_unit_test(light_gets_to_the_outer_side),
        cmocka_unit_test(what_has_no_area_has_no_points),
        cmocka_unit_test(points_of_a_scene_lie_on_its_places),
        cmocka_unit_test(points_of_objects_send_what_rays_meet),
        cmocka_unit_test(means_are_those_of_all_directions),
        cmocka_unit_test(arrivals_are_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
