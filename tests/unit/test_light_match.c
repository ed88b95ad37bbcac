// A list of lights against what a ball shows: other axes, another order, single lights, other units
#include "capture/acquire/light_match.h"
#include "test.h"

enum { LIGHTS = 24 };

struct pairs {
    vec3 list[LIGHTS], seen[LIGHTS];
    double angle[LIGHTS];
    int partner[LIGHTS];
    struct light_match match;
};

static vec3 lamp_at(int i)
{
    const double z = 0.25 + 0.7 * (i + 0.5) / LIGHTS, r = sqrt(1.0 - z * z), a = 2.4 * i;
    return vec3_of(r * cos(a), r * sin(a), z);
}

// The ball stands aside by a tenth of the lamps' distance, which turns lights by up to 6 degrees.
static void fill(struct pairs *p)
{
    for (int i = 0; i < LIGHTS; i++) {
        p->list[i] = lamp_at(i);
        p->seen[i] = vec3_unit(vec3_sub(lamp_at(i), vec3_of(0.1, -0.04, 0.0)));
    }
}

static void compare(struct pairs *p, const vec3 *ball)
{
    light_match(&p->match, p->angle, p->partner, p->list, p->seen, LIGHTS, 0.5, ball);
}

static void a_right_list(void **state)
{
    (void)state;
    struct pairs p;
    fill(&p);
    compare(&p, NULL);
    assert_int_equal(p.match.kind, LIGHT_MATCH_SAME);
    CHECK_NEAR(p.match.left, 0.0, 0.5);  // the offset is pulled towards 0
    for (int i = 0; i < LIGHTS; i++)
        assert_int_equal(p.partner[i], i);
}

static vec3 axes(vec3 v, int k)
{
    const vec3 turned[] = {vec3_of(v.x, -v.y, v.z), vec3_of(v.x, v.y, -v.z),
                           vec3_of(-v.x, -v.y, v.z), vec3_of(v.x, v.z, -v.y),
                           vec3_of(v.y, v.x, v.z)};
    return turned[k];
}

static void other_axes(void **state)
{
    static const char *const mend[] = {"y is negated", "z is negated", "x and y are negated",
                                       "x, y, z are read as its x, -z, y",
                                       "x, y, z are read as its y, x, z"};
    (void)state;
    for (int k = 0; k < 5; k++) {
        struct pairs p;
        fill(&p);
        for (int i = 0; i < LIGHTS; i++)
            p.list[i] = axes(p.list[i], k);
        compare(&p, NULL);
        assert_int_equal(p.match.kind, LIGHT_MATCH_TURNED);
        assert_string_equal(p.match.mend, mend[k]);
        assert_int_equal(p.match.half_turn, k == 2);
        assert_true(p.match.off > 20.0 && p.match.left < 0.5);
    }
}

static void turned_in_the_plane(void **state)
{
    (void)state;
    struct pairs p;
    fill(&p);
    for (int i = 0; i < LIGHTS; i++)
        p.list[i] = vec3_of(0.8 * p.list[i].x - 0.6 * p.list[i].y,
                            0.6 * p.list[i].x + 0.8 * p.list[i].y, p.list[i].z);
    compare(&p, NULL);
    assert_int_equal(p.match.kind, LIGHT_MATCH_TURNED);
    assert_string_equal(p.match.mend,
                        "it is turned by 37 degrees clockwise in the plane of the picture");
}

static void another_order(void **state)
{
    (void)state;
    struct pairs p;
    fill(&p);
    for (int i = 0; i < LIGHTS; i++)
        p.list[i] = lamp_at((7 * i + 3) % LIGHTS);
    compare(&p, NULL);
    assert_int_equal(p.match.kind, LIGHT_MATCH_ORDER);
    for (int i = 0; i < LIGHTS; i++)
        assert_int_equal((7 * p.partner[i] + 3) % LIGHTS, i);
}

static void single_lights(void **state)
{
    (void)state;
    struct pairs p;
    fill(&p);
    p.list[4] = lamp_at(11);
    p.list[11] = lamp_at(4);
    p.seen[20] = vec3_of(0, 0, 0);
    compare(&p, NULL);
    assert_int_equal(p.match.kind, LIGHT_MATCH_SAME);
    assert_int_equal(p.partner[4], 11);
    assert_int_equal(p.partner[20], -1);
    assert_true(isnan(p.angle[20]));
    for (int i = 0; i < LIGHTS; i++)
        assert_int_equal(p.angle[i] > 10.0, i == 4 || i == 11);
}

// A round thing that is no mirror shows something else: it proves nothing.
static void something_else(void **state)
{
    (void)state;
    struct pairs p;
    fill(&p);
    for (int i = 0; i < LIGHTS; i++)
        p.seen[i] = vec3_unit(vec3_of(sin(1.7 * i * i), cos(2.9 * i * i), 0.4 + sin(5.1 * i)));
    compare(&p, NULL);
    assert_int_equal(p.match.kind, LIGHT_MATCH_NONE);
}

static void positions(void **state)
{
    (void)state;
    const vec3 ball = vec3_of(-0.7, 0.4, 0.0);
    for (int k = 0; k < 2; k++) {
        struct pairs p;
        for (int i = 0; i < LIGHTS; i++) {
            p.list[i] = vec3_scale(lamp_at(i), k ? 500.0 : 2.0);
            p.seen[i] = vec3_unit(vec3_sub(vec3_scale(lamp_at(i), 2.0), ball));
        }
        compare(&p, &ball);
        assert_int_equal(p.match.kind, k ? LIGHT_MATCH_UNIT : LIGHT_MATCH_SAME);
        CHECK_NEAR(p.match.left, 0.0, 1.5);
        if (k)
            CHECK_NEAR(p.match.unit, 0.004, 0.0005);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_right_list),        cmocka_unit_test(other_axes),
        cmocka_unit_test(turned_in_the_plane), cmocka_unit_test(another_order),
        cmocka_unit_test(single_lights),       cmocka_unit_test(something_else),
        cmocka_unit_test(positions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
