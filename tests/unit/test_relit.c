// Views relit again and again: the pictures of relume_relight, and no more work than what moved
#include "relight/frame/relighter.h"
#include "relight/light/environment.h"

#include "relight_fixture.h"

enum { SLIDE = 4, GROUPS = RELUME_RELIGHTER_GROUPS };

static struct relume_image slide, surface;

static int setup(void **state)
{
    (void)state;
    if (relume_image_create(&slide, SLIDE, SLIDE, 3) ||
        relume_image_create(&surface, SIDE, SIDE, 3))
        return -1;
    for (int i = 0; i < SIDE * SIDE; i++) {
        surface.data[3 * i] = (float)((i % SIDE + 0.5) * 2.0 / SIDE - 1.0);
        surface.data[3 * i + 1] = (float)(1.0 - (i / SIDE + 0.5) * 2.0 / SIDE);
    }
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    relume_image_destroy(&slide);
    relume_image_destroy(&surface);
    return 0;
}

static void fill_slide(float value)
{
    for (int i = 0; i < 3 * SLIDE * SLIDE; i++)
        slide.data[i] = value;
}

static struct relume_image wanted(const struct setup *s, const struct relume_light *lights, int n)
{
    struct relume_image out = {0};
    CHECK_OK(
        relume_relight(&out, &s->codes, lights, n, relume_relight_params(.surface = &surface)));
    return out;
}

static void expect(relume_relighter *r, const struct relume_relit *relit,
                   const struct relume_image *want, double tolerance)
{
    const struct relume_image *got;
    CHECK_OK(relume_relighter_picture(&got, r, relit));
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        CHECK_NEAR(got->data[i], want->data[i], tolerance);
}

// A slide is the mark: what it shows is changed behind the relighter's back, so that a light that
// rests goes on showing the old one. The sum of groups is rounded otherwise than that of lights:
// 2^-22 of values below 4 in each of three sums.
static void only_what_moves_is_relit(void **state)
{
    (void)state;
    struct setup s;
    make(&s, SEPARATE, RELUME_DOMAIN_LINEAR);
    struct relume_light lights[] = {
        {.direction = {0.2, 0.1, 1}, .rgb = {1, 1, 1}},
        {.kind = RELUME_LIGHT_SLIDE,
         .position = {0, 0, 2},
         .direction = {0, 0, -1},
         .half_angle_deg = 60,
         .image = &slide,
         .rgb = {1, 1, 1}},
        {.kind = RELUME_LIGHT_POINT, .position = {1, 0, 2}, .rgb = {1, 1, 1}},
    };
    for (int groups = 1; groups <= GROUPS; groups += GROUPS - 1) {
        relume_relighter *r;
        const struct relume_relit relit = {
            .codes = &s.codes, .surface = &surface, .lights = lights, .count = 3};
        CHECK_OK(relume_relighter_create(&r, 1, relume_relighter_params(.groups = groups)));
        fill_slide(1.0f);
        struct relume_image old = wanted(&s, lights, 3);
        expect(r, &relit, &old, 1e-6);
        assert_true(relume_relighter_bytes(r, 0) >= 3 * SIDE * SIDE * sizeof(float));
        fill_slide(0.25f);
        expect(r, &relit, &old, 1e-6);
        lights[2].rgb[1] = 2.0f;
        struct relume_image new = wanted(&s, lights, 3);
        fill_slide(1.0f);
        struct relume_image half = wanted(&s, lights, 3);
        fill_slide(0.25f);
        expect(r, &relit, groups == 1 ? &new : &half, 2e-6);
        relume_relighter_forget(r);
        assert_int_equal(relume_relighter_bytes(r, 0), 0);
        expect(r, &relit, &new, 2e-6);
        lights[2].rgb[1] = 1.0f;
        relume_image_destroy(&old);
        relume_image_destroy(&new);
        relume_image_destroy(&half);
        relume_relighter_destroy(&r);
    }
    relume_coder_destroy(&s.coder);
}

// An environment on the display domain: what the first view taught stays when that view leaves.
static void a_view_that_leaves_has_taught(void **state)
{
    (void)state;
    struct setup s;
    struct relume_image map;
    relume_environment *sky;
    relume_relighter *r;
    make(&s, SEPARATE, RELUME_DOMAIN_DISPLAY);
    CHECK_OK(relume_image_create(&map, 16, 8, 3));
    for (int i = 0; i < 3 * 16 * 8; i++)
        map.data[i] = 0.25f * (float)(i % 5);
    CHECK_OK(relume_environment_create(&sky, &map, NULL));
    const struct relume_light light = {
        .kind = RELUME_LIGHT_ENVIRONMENT, .environment = sky, .rgb = {1, 1, 1}};
    const struct relume_image *first;
    CHECK_OK(relume_relighter_create(&r, 1, NULL));
    CHECK_OK(relume_relighter_picture(
        &first, r, &(struct relume_relit){.codes = &s.codes, .lights = &light, .count = 1}));
    struct relume_image want;
    CHECK_OK(relume_image_create(&want, SIDE, SIDE, 3));
    memcpy(want.data, first->data, 3 * SIDE * SIDE * sizeof *want.data);
    relume_relighter_destroy(&r);
    CHECK_OK(relume_relighter_create(&r, 2, NULL));
    for (int view = 0; view < 2; view++) {
        expect(
            r,
            &(struct relume_relit){.view = view, .codes = &s.codes, .lights = &light, .count = 1},
            &want, 0.0);
        relume_relighter_drop(r, view);
        assert_int_equal(relume_relighter_bytes(r, view), 0);
    }
    expect(r, &(struct relume_relit){.codes = &s.codes, .lights = &light, .count = 1}, &want, 0.0);
    relume_relighter_destroy(&r);
    relume_image_destroy(&want);
    relume_environment_destroy(&sky);
    relume_image_destroy(&map);
    relume_coder_destroy(&s.coder);
}

static void refusals(void **state)
{
    (void)state;
    relume_relighter *r = (void *)1;
    assert_int_equal(relume_relighter_create(&r, 0, NULL), RELUME_EINVAL);
    assert_null(r);
    assert_int_equal(relume_relighter_create(&r, 1, relume_relighter_params(.groups = GROUPS + 1)),
                     RELUME_EINVAL);
    relume_relighter_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_what_moves_is_relit),
        cmocka_unit_test(a_view_that_leaves_has_taught),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
