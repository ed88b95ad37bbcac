// Edited reflections: rotations against singular values in another way, fields against what their
// header promises, distances along surfaces against closed forms.
#include "test.h"

#include "world/reflect/geodesic.h"
#include "world/reflect/rotation.h"

#include "core/math/lsq.h"
#include "core/math/vec.h"
#include "world/reflect/reflection.h"

static char last[512];
static int warnings;

static void hear(void *user, enum relume_level level, const char *text)
{
    (void)user;
    snprintf(last, sizeof last, "%s", text);
    warnings += level == RELUME_WARNING;
}
static const struct relume_log hearing = {.message = hear};

static vec3 any_direction(uint32_t *seed)
{
    vec3 v;
    do
        v = vec3_of(2 * test_uniform(seed) - 1, 2 * test_uniform(seed) - 1,
                    2 * test_uniform(seed) - 1);
    while (vec3_length(v) > 1.0 || vec3_length(v) < 0.1);
    return vec3_unit(v);
}

static void check_same(vec3 got, vec3 want, double tolerance)
{
    CHECK_NEAR(vec3_length(vec3_sub(got, want)), 0.0, tolerance);
}

static void check_rotation(const struct rotation *r)
{
    for (int i = 0; i < 3; i++) {
        CHECK_NEAR(vec3_length(r->row[i]), 1.0, 1e-12);
        CHECK_NEAR(vec3_dot(r->row[i], r->row[(i + 1) % 3]), 0.0, 1e-12);
    }
    CHECK_NEAR(vec3_dot(vec3_cross(r->row[0], r->row[1]), r->row[2]), 1.0, 1e-12);
}

// ---------------------------------------------------------------- one matrix

static double trace_with(const struct rotation *r, const struct rotation *m)
{
    return vec3_dot(r->row[0], m->row[0]) + vec3_dot(r->row[1], m->row[1]) +
           vec3_dot(r->row[2], m->row[2]);
}

// Horn (1987): the greatest trace(R^T m) is the largest eigenvalue of a symmetric 4 x 4 matrix, and
// its eigenvector the rotation as a quaternion.
static double by_quaternion(struct rotation *out, const struct rotation *m)
{
    const double s[3][3] = {{m->row[0].x, m->row[1].x, m->row[2].x},
                            {m->row[0].y, m->row[1].y, m->row[2].y},
                            {m->row[0].z, m->row[1].z, m->row[2].z}};
    double n[16] = {
        s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1],           s[2][0] - s[0][2],
        s[0][1] - s[1][0],           s[1][2] - s[2][1],           s[0][0] - s[1][1] - s[2][2],
        s[0][1] + s[1][0],           s[2][0] + s[0][2],           s[2][0] - s[0][2],
        s[0][1] + s[1][0],           s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1],
        s[0][1] - s[1][0],           s[2][0] + s[0][2],           s[1][2] + s[2][1],
        s[2][2] - s[0][0] - s[1][1]};
    double value, q[4];
    assert_true(lsq_eigenvectors(n, 4, 1, &value, q));
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    *out = (struct rotation){
        {vec3_of(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
         vec3_of(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
         vec3_of(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))}};
    return value;
}

static struct rotation sum_of(int n, const vec3 *e, const vec3 *r, const double *w)
{
    struct rotation m = {{vec3_of(0, 0, 0), vec3_of(0, 0, 0), vec3_of(0, 0, 0)}};
    for (int i = 0; i < n; i++)
        add_outer(&m, w ? w[i] : 1.0, e[i], r[i]);
    return m;
}

// Of one pair the rotation of least angle, about r x e.
static void one_pair_is_turned_least(void **state)
{
    (void)state;
    uint32_t seed = 7;
    for (int i = 0; i < 200; i++) {
        const vec3 r = any_direction(&seed), e = any_direction(&seed);
        const struct rotation m = sum_of(1, &e, &r, NULL), got = rotation_nearest(&m);
        check_rotation(&got);
        check_same(rotate(&got, r), e, 1e-9);
        // trace = 1 + 2 cos of the angle of a rotation
        const double trace = got.row[0].x + got.row[1].y + got.row[2].z;
        CHECK_NEAR(trace, 1.0 + 2.0 * vec3_dot(r, e), 1e-7);
        const vec3 axis = vec3_unit(vec3_cross(r, e));
        check_same(rotate(&got, axis), axis, 1e-4 / vec3_length(vec3_cross(r, e)));
    }
    // opposite ones: half a turn about some axis across
    const vec3 r = vec3_of(0.6, 0, 0.8), e = vec3_scale(r, -1.0);
    const struct rotation m = sum_of(1, &e, &r, NULL), half = rotation_nearest(&m);
    check_rotation(&half);
    check_same(rotate(&half, r), e, 1e-9);
}

// Two pairs that a rotation can meet are met; any two, three and more: as good as Horn's, and the
// same rotation where it is told by the matrix.
static void pairs_are_turned_as_well_as_can_be(void **state)
{
    (void)state;
    uint32_t seed = 11;
    for (int round = 0; round < 500; round++) {
        const int n = 2 + round % 4;
        vec3 r[5], e[5];
        double w[5];
        struct rotation turn, horn;
        const vec3 a = any_direction(&seed), b = any_direction(&seed);
        turn = rotation_least(a, b);
        for (int i = 0; i < n; i++) {
            r[i] = any_direction(&seed);
            e[i] = rotate(&turn, r[i]);
            w[i] = 0.05 + test_uniform(&seed);
        }
        struct rotation m = sum_of(n, e, r, w), got = rotation_nearest(&m);
        check_rotation(&got);
        if (vec3_length(vec3_cross(r[0], r[1])) > 0.1)
            for (int i = 0; i < n; i++)
                check_same(rotate(&got, r[i]), e[i], 1e-6);
        for (int i = 0; i < n; i++)
            e[i] = any_direction(&seed);
        m = sum_of(n, e, r, w);
        got = rotation_nearest(&m);
        check_rotation(&got);
        const double best = by_quaternion(&horn, &m);
        CHECK_NEAR(trace_with(&got, &m), best, 1e-9);
        CHECK_NEAR(trace_with(&horn, &m), best, 1e-9);
    }
}

static void nothing_is_left_as_it_is(void **state)
{
    (void)state;
    const struct rotation none = {{vec3_of(0, 0, 0), vec3_of(0, 0, 0), vec3_of(0, 0, 0)}};
    const struct rotation got = rotation_nearest(&none);
    check_rotation(&got);
    CHECK_NEAR(got.row[0].x + got.row[1].y + got.row[2].z, 3.0, 0.0);
    // a reflection has no rotation near: still one comes out
    const struct rotation mirrored = {{vec3_of(-1, 0, 0), vec3_of(0, -1, 0), vec3_of(0, 0, -1)}};
    const struct rotation some = rotation_nearest(&mirrored);
    check_rotation(&some);
    CHECK_NEAR(trace_with(&some, &mirrored), 1.0, 1e-12);
}

// ---------------------------------------------------------------- fields

static relume_reflection *create(const struct relume_reflection_edit *edit,
                                 const struct relume_reflection_surface *surface)
{
    relume_reflection *f;
    warnings = 0;
    assert_int_equal(
        relume_reflection_create(&f, edit, surface, relume_reflection_params(.log = &hearing)),
        RELUME_OK);
    return f;
}

static vec3 turn_at(const relume_reflection *f, vec3 place, vec3 r)
{
    return relume_reflection_turn(f, &(struct relume_reflection_place){.position = place}, r);
}

static void one_constraint_turns_everywhere(void **state)
{
    (void)state;
    uint32_t seed = 3;
    const struct relume_reflection_constraint c = {{1, 2, 3}, {0, 0, 2}, {0, 3, 3}, {0, 0, 9}};
    const struct relume_reflection_edit edit = {.constraint = &c, .constraints = 1};
    relume_reflection *f = create(&edit, NULL);
    const struct rotation want = rotation_least(vec3_of(0, 0, 1), vec3_unit(vec3_of(0, 1, 1)));
    assert_int_equal(warnings, 0);
    assert_true(relume_reflection_acts(f, 0));
    for (int i = 0; i < 20; i++) {
        const vec3 r = any_direction(&seed), q = vec3_scale(any_direction(&seed), 50.0);
        check_same(turn_at(f, q, r), rotate(&want, r), 1e-12);
    }
    check_same(turn_at(f, c.position, vec3_of(0, 0, 1)), vec3_unit(vec3_of(0, 1, 1)), 1e-12);
    relume_reflection_destroy(&f);
    const struct relume_reflection_edit none = {.constraints = 0};
    f = create(&none, NULL);
    check_same(turn_at(f, c.position, vec3_of(0, 0, 1)), vec3_of(0, 0, 1), 0.0);
    relume_reflection_destroy(&f);
}

enum { SOME = 8 };
static void fill(struct relume_reflection_constraint c[SOME], uint32_t seed)
{
    for (int i = 0; i < SOME; i++) {
        const vec3 p = any_direction(&seed);
        const vec3 r = vec3_unit(vec3_along(p, any_direction(&seed), 0.5));
        c[i] = (struct relume_reflection_constraint){
            p, r, vec3_unit(vec3_along(r, any_direction(&seed), 0.4)), vec3_scale(p, 4.0)};
    }
}

// Every constraint is met at its place, and the field has no steps: over 1/2000 of the way around
// a ball nothing turns by more than a few times the mean.
static void constraints_are_met_and_between_is_smooth(void **state)
{
    (void)state;
    struct relume_reflection_constraint c[SOME];
    fill(c, 5);
    const struct relume_reflection_edit edit = {.constraint = c, .constraints = SOME};
    relume_reflection *f = create(&edit, NULL);
    for (int i = 0; i < SOME; i++)  // w of the others: (1e-3 of the size / distance)^2
        check_same(turn_at(f, c[i].position, c[i].original), c[i].edited, 2e-4);
    enum { STEPS = 2000 };
    double most = 0.0, sum = 0.0;
    vec3 before = {0, 0, 0};
    for (int i = 0; i <= STEPS; i++) {
        const double a = 2.0 * M_PI * i / STEPS;
        const vec3 q = vec3_of(cos(a), 0.3 * sin(a), sin(a)), r = vec3_unit(q);
        const vec3 e = turn_at(f, q, r);
        CHECK_NEAR(vec3_length(e), 1.0, 1e-12);
        const double step = i ? vec3_length(vec3_sub(e, before)) : 0.0;
        most = fmax(most, step);
        sum += step;
        before = e;
    }
    assert_true(most < 10.0 * sum / STEPS);
    relume_reflection_destroy(&f);
}

static void regions_bound_the_effect(void **state)
{
    (void)state;
    const struct relume_reflection_constraint c[2] = {{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 5}},
                                                      {{9, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 0, 5}}};
    const struct relume_reflection_region ball = {.radius = 1.0, .border = 2.0};
    const struct relume_reflection_edit edit = {
        .constraint = c, .constraints = 2, .region = &ball, .regions = 1};
    const vec3 r = vec3_of(0, 0, 1);
    relume_reflection *f = create(&edit, NULL);
    // the second one lies outside, and is said to
    assert_int_equal(warnings, 1);
    assert_non_null(strstr(last, "constraint 1 lies outside every region"));
    assert_true(relume_reflection_acts(f, 0));
    assert_false(relume_reflection_acts(f, 1));
    check_same(turn_at(f, vec3_of(0.9, 0, 0), r), c[0].edited, 1e-9);
    check_same(turn_at(f, vec3_of(3.001, 0, 0), r), r, 0.0);
    check_same(turn_at(f, c[1].position, r), r, 0.0);
    // in between r turns towards e, steadily: of a R + (1 - a) r r^T by an angle of tangent
    // 2 a sin / (2 a cos + 1 - a), sin and cos those of R's angle, here 1 and 0
    check_same(turn_at(f, vec3_of(2, 0, 0), r), vec3_unit(vec3_of(2, 0, 1)), 1e-6);
    double before = 0.0;
    for (int i = 0; i <= 40; i++) {
        const vec3 e = turn_at(f, vec3_of(3.0 - 0.05 * i, 0, 0), r);
        CHECK_NEAR(vec3_length(e), 1.0, 1e-12);
        assert_true(e.x >= before && e.x - before < 0.1);
        before = e.x;
    }
    relume_reflection_destroy(&f);
}

// Where both count whole, by halves; where one alone does, by it.
static void regions_overlap(void **state)
{
    (void)state;
    const struct relume_reflection_constraint c[2] = {{{-2, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 5}},
                                                      {{2, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 0, 5}}};
    const struct relume_reflection_region ball[2] = {{.centre = {-2, 0, 0}, .radius = 2.5},
                                                     {.centre = {2, 0, 0}, .radius = 2.5}};
    const struct relume_reflection_edit edit = {
        .constraint = c, .constraints = 2, .region = ball, .regions = 2};
    const vec3 r = vec3_of(0, 0, 1);
    relume_reflection *f = create(&edit, NULL);
    check_same(turn_at(f, vec3_of(-2, 0, 0), r), c[0].edited, 1e-12);
    check_same(turn_at(f, vec3_of(2, 0, 0), r), c[1].edited, 1e-12);
    const struct rotation one = rotation_least(r, c[0].edited),
                          two = rotation_least(r, c[1].edited);
    struct rotation mean = one, horn;
    for (int i = 0; i < 3; i++)
        mean.row[i] = vec3_add(one.row[i], two.row[i]);
    by_quaternion(&horn, &mean);
    check_same(turn_at(f, vec3_of(0, 0, 0), r), rotate(&horn, r), 1e-9);
    check_same(turn_at(f, vec3_of(0, 4, 0), r), r, 0.0);
    relume_reflection_destroy(&f);
}

static void strokes_reach_as_far_as_they_are_wide(void **state)
{
    (void)state;
    const vec3 line[3] = {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}};
    const struct relume_reflection_constraint c = {{4, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 5}};
    const struct relume_reflection_region stroke = {.shape = RELUME_REFLECTION_STROKES,
                                                    .radius = 0.5,
                                                    .border = 1,
                                                    .stroke = line,
                                                    .points = 3};
    const struct relume_reflection_edit edit = {
        .constraint = &c, .constraints = 1, .region = &stroke, .regions = 1};
    relume_reflection *f = create(&edit, NULL);
    const struct {
        vec3 at;
        double want;
    } place[] = {{{2, 0.4, 0}, 1},     {{2, -1, 0}, 0.5}, {{4.3, 2, 0}, 1},
                 {{4, 4.1, 0}, 0.352}, {{0, 3, 0}, 0},    {{-0.2, 0, 0.2}, 1}};
    for (size_t i = 0; i < sizeof place / sizeof *place; i++)  // 3 t^2 - 2 t^3 of 0.4: 0.352
        CHECK_NEAR(relume_reflection_weight(
                       f, 0, &(struct relume_reflection_place){.position = place[i].at}),
                   place[i].want, 1e-12);
    relume_reflection_destroy(&f);
}

static void frozen_edits_keep_their_eye(void **state)
{
    (void)state;
    const struct relume_reflection_edit edit = {.frozen = true, .eye = {0, 0, 5}};
    const vec3 n = vec3_unit(vec3_of(1, 0, 1)), eye = vec3_of(3, 3, 3);
    relume_reflection *f = create(&edit, NULL);
    check_same(relume_reflection_original(f, vec3_of(0, 0, 0), n, eye), vec3_of(1, 0, 0), 1e-12);
    check_same(relume_reflection_original(NULL, vec3_of(0, 0, 0), n, vec3_of(0, 0, 7)),
               vec3_of(1, 0, 0), 1e-12);
    const vec3 i = vec3_unit(vec3_of(-1, -1, -1)), r = vec3_along(i, n, -2 * vec3_dot(i, n));
    check_same(relume_reflection_original(NULL, vec3_of(0, 0, 0), n, eye), r, 1e-12);
    relume_reflection_destroy(&f);
}

static void edits_that_cannot_be(void **state)
{
    (void)state;
    const struct relume_reflection_constraint good = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 5}};
    struct relume_reflection_constraint c = good;
    struct relume_reflection_region g = {.radius = 1};
    struct relume_reflection_edit e = {
        .constraint = &c, .constraints = 1, .region = &g, .regions = 1};
    relume_reflection *f;
#define REFUSED(words)                                                                             \
    assert_int_equal(                                                                              \
        relume_reflection_create(&f, &e, NULL, relume_reflection_params(.log = &hearing)),         \
        RELUME_EINVAL);                                                                            \
    assert_null(f);                                                                                \
    assert_non_null(strstr(last, words))
    c.position.x = NAN;
    REFUSED("constraint 0: position");
    c = good, c.edited = vec3_of(0, 0, 0);
    REFUSED("constraint 0: original and edited");
    c = good, c.original.y = INFINITY;
    REFUSED("constraint 0: original and edited");
    c = good, g.radius = 0;
    REFUSED("region 0: radius: expected a number above 0, up to 1e+15; found 0");
    g.radius = 1e308;  // infinite on a graphics card
    REFUSED("region 0: radius: expected a number above 0, up to 1e+15; found 1e+308");
    g.radius = 1, g.border = -1;
    REFUSED("region 0: border");
    g.border = 1e16;
    REFUSED("region 0: border: expected 0 to 1e+15; found 1e+16");
    g.border = 0, g.centre.z = -2e15;
    REFUSED("region 0: centre: expected numbers up to 1e+15");
    g.centre.z = 0, c.eye.x = 1e200;
    REFUSED("constraint 0: position and eye: expected numbers up to 1e+15");
    c = good;
    g.border = 0, g.shape = RELUME_REFLECTION_GEODESIC;
    REFUSED("need a mesh");
    g.shape = RELUME_REFLECTION_STROKES;
    REFUSED("at least one point");
    e.constraints = 10000;
    REFUSED("expected at most 256 constraints; found 10000");
    e.constraints = 0, e.regions = 33;
    REFUSED("expected at most 32 regions; found 33");
    // in one place, of two minds: said, and the mean is shown
    struct relume_reflection_constraint two[2] = {good, good};
    two[1].edited = vec3_of(0, 1, 0);
    const struct relume_reflection_edit twice = {.constraint = two, .constraints = 2};
    f = create(&twice, NULL);
    assert_int_equal(warnings, 1);
    assert_non_null(strstr(last, "constraints 0 and 1 are in one place"));
    check_same(turn_at(f, good.position, good.original), vec3_unit(vec3_of(1, 1, 0)), 1e-6);
    relume_reflection_destroy(&f);
}

// ---------------------------------------------------------------- many at once

enum { MANY = 6000 };
struct many {
    float at[3][MANY], r[3][MANY];
};

static void turn_many(struct many *m, const relume_reflection *f, unsigned cpu_off, int threads,
                      size_t n)
{
    const struct relume_reflection_places places = {m->at[0], m->at[1], m->at[2], m->r[0],
                                                    m->r[1],  m->r[2],  n};
    assert_int_equal(relume_reflection_turn_all(f, &places, cpu_off, threads), RELUME_OK);
}

// As one at a time, in single precision: a turn that the constraints leave open but for 1e-5 is
// taken as open, which near a constraint shows in what is far from its direction. The same bits for
// every set of instructions and any number of threads; nothing behind the last place.
static void many_turn_as_one(void **state)
{
    (void)state;
    static struct many start, got, again;
    struct relume_reflection_constraint c[SOME];
    const vec3 line[2] = {{0, 0, 1}, {0, 1, 0}};
    const struct relume_reflection_region region[3] = {
        {.centre = {1, 0, 0}, .radius = 0.7, .border = 0.5},
        {.centre = {0, 0, 1}, .radius = 1.1},
        {.shape = RELUME_REFLECTION_STROKES,
         .radius = 0.2,
         .border = 0.3,
         .stroke = line,
         .points = 2}};
    uint32_t seed = 17;
    fill(c, 5);
    for (int i = 0; i < MANY; i++) {
        const vec3 p = any_direction(&seed), r = any_direction(&seed);
        const double at[3] = {p.x, p.y, p.z}, d[3] = {r.x, r.y, r.z};
        for (int k = 0; k < 3; k++)
            start.at[k][i] = (float)at[k], start.r[k][i] = (float)d[k];
    }
    for (int kind = 0; kind < 4; kind++) {
        const struct relume_reflection_edit edit = {.constraint = c,
                                                    .constraints = kind == 0 ? 1 : SOME,
                                                    .region = region,
                                                    .regions = kind < 2 ? 0 : 2 * kind - 3};
        relume_reflection *f = create(&edit, NULL);
        double sum = 0.0;
        got = start;
        turn_many(&got, f, ~0u, 1, MANY - 1);
        for (int i = 0; i < MANY - 1; i++) {
            const vec3 at =
                vec3_of((double)start.at[0][i], (double)start.at[1][i], (double)start.at[2][i]);
            const vec3 r =
                vec3_of((double)start.r[0][i], (double)start.r[1][i], (double)start.r[2][i]);
            const vec3 e = vec3_of((double)got.r[0][i], (double)got.r[1][i], (double)got.r[2][i]);
            const double off = vec3_length(vec3_sub(e, turn_at(f, at, r)));
            CHECK_NEAR(vec3_length(e), 1.0, 1e-5);
            sum += off;
        }
        CHECK_NEAR(sum / MANY, 0.0, kind == 0 ? 1e-6 : 5e-4);
        for (int k = 0; k < 3; k++)
            assert_true(got.r[k][MANY - 1] == start.r[k][MANY - 1]);
        const unsigned off[] = {RELUME_CPU_AVX512, 0};
        for (int i = 0; i < 4; i++) {
            again = start;
            turn_many(&again, f, off[i % 2], 1 + 2 * (i / 2), MANY - 1);
            assert_memory_equal(&again, &got, sizeof got);
        }
        relume_reflection_destroy(&f);
    }
}

// What is no case one by one is none here: no rank, opposite directions, distances of 0.
static void many_survive_what_is_degenerate(void **state)
{
    (void)state;
    static struct many m;
    struct relume_reflection_constraint c[3] = {{{0, 0, 0}, {0, 0, 1}, {0, 0, -1}, {0, 0, 5}},
                                                {{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, {0, 0, 5}},
                                                {{0, 0, 0}, {0, 0, -1}, {0, 0, 1}, {0, 0, 5}}};
    for (int n = 1; n <= 3; n++) {
        const struct relume_reflection_edit edit = {.constraint = c, .constraints = n};
        relume_reflection *f = create(&edit, NULL);
        m = (struct many){.r = {{0, 0.6f, 1}, {0, 0, 0}, {1, 0.8f, 0}}};
        m.at[0][1] = 1e18f;
        turn_many(&m, f, 0, 1, 3);
        for (int i = 0; i < 3; i++)
            CHECK_NEAR(
                vec3_length(vec3_of((double)m.r[0][i], (double)m.r[1][i], (double)m.r[2][i])), 1.0,
                1e-5);
        relume_reflection_destroy(&f);
    }
    const struct relume_reflection_edit along = {.geodesic = true};
    const float at[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const uint32_t triangle[1][3] = {{0, 1, 2}};
    const struct relume_reflection_surface surface = {at[0], sizeof at[0], 3, triangle, 1};
    relume_reflection *f = create(&along, &surface);
    const struct relume_reflection_places none = {.n = 0};
    assert_int_equal(relume_reflection_turn_all(f, &none, 0, 1), RELUME_EUNFIT);
    relume_reflection_destroy(&f);
}

// ---------------------------------------------------------------- along surfaces

enum { SIDE = 21, SHEET = SIDE * SIDE, HALVES = 2 * (SIDE - 1) * (SIDE - 1) };
struct sheet {
    float at[SHEET][3];
    uint32_t triangle[HALVES][3];
};

static struct relume_reflection_surface surface_of(const struct sheet *s)
{
    return (struct relume_reflection_surface){s->at[0], sizeof s->at[0], SHEET, s->triangle,
                                              HALVES};
}

// [0, 1]^2, x bent to a roll of radius 1 / `bend` (0: flat).
static void make_sheet(struct sheet *s, double bend)
{
    for (int i = 0; i < SHEET; i++) {
        const double u = (i % SIDE) / (SIDE - 1.0), v = (i / SIDE) / (SIDE - 1.0);
        s->at[i][0] = (float)(bend > 0 ? sin(bend * u) / bend : u);
        s->at[i][1] = (float)v;
        s->at[i][2] = (float)(bend > 0 ? cos(bend * u) / bend : 0);
    }
    int n = 0;
    for (int y = 0; y + 1 < SIDE; y++)
        for (int x = 0; x + 1 < SIDE; x++)
            for (int k = 0; k < 2; k++, n++) {
                const uint32_t a = (uint32_t)(y * SIDE + x), b = a + 1, c = a + SIDE, d = c + 1;
                const uint32_t t[2][3] = {{a, b, d}, {a, d, c}};
                memcpy(s->triangle[n], t[k], sizeof t[k]);
            }
}

// On a plane they are straight, whatever the edges; on a roll those of the sheet before rolling.
static void distances_go_along_the_surface(void **state)
{
    (void)state;
    static struct sheet s;
    for (int bent = 0; bent < 2; bent++) {
        const double bend = bent ? 4.0 : 0.0;
        make_sheet(&s, bend);
        const struct relume_reflection_surface surface = surface_of(&s);
        struct geodesic_mesh mesh;
        static float distance[SHEET];
        const double u = 0.32, v = 0.41;
        assert_int_equal(geodesic_mesh_create(&mesh, &surface), RELUME_OK);
        const vec3 from =
            bent ? vec3_of(sin(bend * u) / bend, v, cos(bend * u) / bend) : vec3_of(u, v, 0.3);
        assert_int_equal(geodesic_distances(distance, &mesh, from), RELUME_OK);
        for (int i = 0; i < SHEET; i++) {
            const double want = hypot((i % SIDE) / (SIDE - 1.0) - u, (i / SIDE) / (SIDE - 1.0) - v);
            // where the wave has come to one end of an edge only, it goes a little round, and
            // facets of 1/20 cut the roll's arcs by (1/5)^2 / 24
            CHECK_NEAR((double)distance[i], want, 5e-3);
        }
        geodesic_mesh_free(&mesh);
    }
}

// The two ends of a roll come near each other, but are far along it.
static void regions_go_along_the_surface(void **state)
{
    (void)state;
    static struct sheet s;
    make_sheet(&s, 5.5);
    const struct relume_reflection_surface surface = surface_of(&s);
    const vec3 first = vec3_of((double)s.at[0][0], 0.5, (double)s.at[0][2]);
    const struct relume_reflection_constraint c = {first, {0, 0, 1}, {1, 0, 0}, {0, 0, 5}};
    struct relume_reflection_region g = {.centre = first, .radius = 0.3};
    const struct relume_reflection_edit edit = {
        .constraint = &c, .constraints = 1, .region = &g, .regions = 1, .geodesic = true};
    for (int along = 0; along < 2; along++) {
        g.shape = along ? RELUME_REFLECTION_GEODESIC : RELUME_REFLECTION_BALL;
        relume_reflection *f = create(&edit, &surface);
        for (int x = 0; x < SIDE; x++) {
            const uint32_t vertex = (uint32_t)(10 * SIDE + x);
            const float *p = s.at[vertex];
            const struct relume_reflection_place place = {
                {(double)p[0], (double)p[1], (double)p[2]}, {vertex, vertex, vertex}, {1, 0, 0}};
            const vec3 e = relume_reflection_turn(f, &place, vec3_of(0, 0, 1));
            const bool near = vec3_length(vec3_sub(place.position, first)) < 0.3;
            check_same(e, (along ? x <= 6 : near) ? vec3_of(1, 0, 0) : vec3_of(0, 0, 1), 1e-9);
            if (x == SIDE - 1)
                assert_true(near);
        }
        relume_reflection_destroy(&f);
    }
}

// What another edit of the surface has measured is taken over, and nothing else.
static void measured_distances_are_taken_over(void **state)
{
    (void)state;
    static struct sheet s;
    make_sheet(&s, 5.5);
    const struct relume_reflection_surface surface = surface_of(&s);
    struct relume_reflection_constraint c[3];
    for (int i = 0; i < 3; i++) {
        const float *p = s.at[7 * SIDE + 3 + 5 * i];
        c[i] = (struct relume_reflection_constraint){
            vec3_of((double)p[0], (double)p[1], (double)p[2]), {0, 0, 1}, {1, 0, 0}, {0, 0, 5}};
    }
    const struct relume_reflection_region g = {
        .shape = RELUME_REFLECTION_GEODESIC, .centre = c[1].position, .radius = 9};
    const struct relume_reflection_edit before = {
        .constraint = c + 1, .constraints = 2, .region = &g, .regions = 1, .geodesic = true};
    const struct relume_reflection_edit after = {
        .constraint = c, .constraints = 3, .geodesic = true};
    relume_reflection *like = create(&before, &surface), *alone = create(&after, &surface), *made;
    assert_int_equal(
        relume_reflection_create(&made, &after, &surface,
                                 relume_reflection_params(.log = &hearing, .like = like)),
        RELUME_OK);
    const size_t bytes = surface.vertices * sizeof(float);
    for (int i = 0; i < 3; i++)
        assert_memory_equal(relume_reflection_from_constraint(made, i),
                            relume_reflection_from_constraint(alone, i), bytes);
    assert_memory_not_equal(relume_reflection_from_constraint(made, 0),
                            relume_reflection_from_constraint(made, 1), bytes);
    assert_memory_equal(relume_reflection_from_region(like, 0),
                        relume_reflection_from_constraint(like, 0), bytes);
    relume_reflection_destroy(&made);
    relume_reflection_destroy(&alone);
    relume_reflection_destroy(&like);
}

// Pieces that do not hang together: infinitely far along the surface.
static void other_pieces_are_out_of_reach(void **state)
{
    (void)state;
    const float at[7][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                            {1, 0, 1}, {0, 1, 1}, {1, 0, 0}};
    const uint32_t triangle[3][3] = {{0, 1, 2}, {3, 4, 5}, {6, 2, 2}};
    const struct relume_reflection_surface surface = {at[0], sizeof at[0], 7, triangle, 3};
    struct geodesic_mesh mesh;
    float distance[7];
    assert_int_equal(geodesic_mesh_create(&mesh, &surface), RELUME_OK);
    assert_int_equal(mesh.vertices, 6);  // two are in one place
    assert_int_equal(geodesic_distances(distance, &mesh, vec3_of(0, 0, -1)), RELUME_OK);
    CHECK_NEAR((double)distance[0], 0.0, 0.0);
    CHECK_NEAR((double)distance[6], 1.0, 1e-6);
    assert_true(isinf(distance[3]) && isinf(distance[5]));
    geodesic_mesh_free(&mesh);
    const uint32_t wild[1][3] = {{0, 1, 7}};
    const struct relume_reflection_surface broken = {at[0], sizeof at[0], 7, wild, 1};
    const struct relume_reflection_edit edit = {.geodesic = true};
    relume_reflection *f;
    assert_int_equal(
        relume_reflection_create(&f, &edit, &broken, relume_reflection_params(.log = &hearing)),
        RELUME_EINVAL);
    assert_non_null(strstr(last, "names vertex 7 of 7"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_pair_is_turned_least),
        cmocka_unit_test(pairs_are_turned_as_well_as_can_be),
        cmocka_unit_test(nothing_is_left_as_it_is),
        cmocka_unit_test(one_constraint_turns_everywhere),
        cmocka_unit_test(constraints_are_met_and_between_is_smooth),
        cmocka_unit_test(regions_bound_the_effect),
        cmocka_unit_test(regions_overlap),
        cmocka_unit_test(strokes_reach_as_far_as_they_are_wide),
        cmocka_unit_test(frozen_edits_keep_their_eye),
        cmocka_unit_test(edits_that_cannot_be),
        cmocka_unit_test(many_turn_as_one),
        cmocka_unit_test(many_survive_what_is_degenerate),
        cmocka_unit_test(distances_go_along_the_surface),
        cmocka_unit_test(regions_go_along_the_surface),
        cmocka_unit_test(measured_distances_are_taken_over),
        cmocka_unit_test(other_pieces_are_out_of_reach),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
