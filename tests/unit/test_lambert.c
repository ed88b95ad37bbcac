// Which way a surface faces, from its brightness
#include "math/lambert.h"
#include "test.h"

enum { LIGHTS = 12, STEPS = 400 };

// Twelve lamps within 55 degrees of the eye.
static void make_lights(vec3 light[LIGHTS])
{
    for (int i = 0; i < LIGHTS; i++) {
        const double z = 1.0 - 0.42 * (i + 0.5) / LIGHTS, r = sqrt(1.0 - z * z);
        light[i] = vec3_of(r * cos(2.399963 * i), r * sin(2.399963 * i), z);
    }
}

static double degrees(vec3 a, vec3 b)
{
    return acos(fmin(vec3_dot(vec3_unit(a), vec3_unit(b)), 1.0)) * 180.0 / M_PI;
}

// Glazed, as the surface turns by 60 degrees: the normal that is found turns as evenly. Which lamps
// are the brightest and which the darkest changes, and it jumped there.
static void a_surface_that_turns_does_not_jump(void **state)
{
    (void)state;
    const double even = 60.0 / STEPS;
    vec3 light[LIGHTS], before = {0, 0, 0};
    double most = 0.0;
    make_lights(light);
    for (int k = 0; k <= STEPS; k++) {
        struct lambert_sample s[LIGHTS];
        const double turn = (even * k - 30.0) * M_PI / 180.0;
        const vec3 normal = vec3_of(sin(turn), 0.0, cos(turn));
        vec3 g;
        int n = LIGHTS;
        for (int i = 0; i < LIGHTS; i++) {
            const vec3 h = vec3_unit(vec3_add(light[i], vec3_of(0, 0, 1)));
            const double lobe = 0.4 * pow(fmax(vec3_dot(normal, h), 0.0), 30.0);
            s[i] = (struct lambert_sample){
                (float)(0.6 * fmax(vec3_dot(normal, light[i]), 0.0) + lobe), 1.0f, i};
        }
        assert_non_null(lambert_fit(&g, light, s, &n, false));
        assert_true(degrees(g, normal) < 25.0);
        most = k ? fmax(most, degrees(g, before)) : most;
        before = g;
    }
    print_message("  at most %.2f degrees a step of %.2f\n", most, even);
    assert_true(most < 10.0 * even);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_surface_that_turns_does_not_jump),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
