#include "test.h"

#include "math/hsh.h"

enum { COUNT = (HSH_MAX_DEGREE + 1) * (HSH_MAX_DEGREE + 1) };

// The nine functions as files and viewers of the field write them.
static void test_closed_forms(void **state)
{
    (void)state;
    const double pi = 3.14159265358979324;
    uint32_t seed = 7;
    for (int i = 0; i < 200; i++) {
        struct relume_vec3 d = test_direction(&seed);
        d.z = fabs(d.z);
        const double theta = fmin(acos(d.z), pi / 2.0 - 0.01), phi = atan2(d.y, d.x);
        const double c = cos(theta), q = sqrt(c - c * c);
        const double want[9] = {
            1.0 / sqrt(2.0 * pi),
            sqrt(6.0 / pi) * q * cos(phi),
            sqrt(3.0 / (2.0 * pi)) * (2.0 * c - 1.0),
            sqrt(6.0 / pi) * q * sin(phi),
            sqrt(30.0 / pi) * (c * c - c) * cos(2.0 * phi),
            sqrt(30.0 / pi) * (2.0 * c - 1.0) * q * cos(phi),
            sqrt(5.0 / (2.0 * pi)) * (1.0 - 6.0 * c + 6.0 * c * c),
            sqrt(30.0 / pi) * (2.0 * c - 1.0) * q * sin(phi),
            sqrt(30.0 / pi) * (c * c - c) * sin(2.0 * phi),
        };
        for (int degree = 0; degree <= 2; degree++) {
            double v[9];
            hsh_evaluate(degree, d, v);
            for (int k = 0; k < (degree + 1) * (degree + 1); k++)
                CHECK_NEAR(v[k], want[k], 1e-12);
        }
    }
}

// Over the hemisphere the measure is dz dphi. Products are polynomials in z: midpoints converge as
// 1/n^2. The strip below sin 0.01, where one elevation counts, is left to the tolerance: its area
// is 0.01 x 2 pi, products there are below 1, and what differs from the limit is a part of them.
static void test_orthonormal(void **state)
{
    (void)state;
    enum { Z = 4000, PHI = 2 * HSH_MAX_DEGREE + 1 };
    static double gram[COUNT][COUNT];
    double v[COUNT];
    for (int i = 0; i < Z; i++)
        for (int j = 0; j < PHI; j++) {
            const double z = (i + 0.5) / Z, r = sqrt(1.0 - z * z),
                         phi = 6.283185307179586 * j / PHI;
            hsh_evaluate(HSH_MAX_DEGREE, (struct relume_vec3){r * cos(phi), r * sin(phi), z}, v);
            for (int a = 0; a < COUNT; a++)
                for (int b = 0; b <= a; b++)
                    gram[a][b] += v[a] * v[b] * 6.283185307179586 / PHI / Z;
        }
    for (int a = 0; a < COUNT; a++)
        for (int b = 0; b <= a; b++)
            CHECK_NEAR(gram[a][b], a == b, 8e-3);
}

static void test_below_the_horizon_is_the_horizon(void **state)
{
    (void)state;
    double low[COUNT], lower[COUNT];
    hsh_evaluate(HSH_MAX_DEGREE, (struct relume_vec3){0.6, 0.8, 0.0}, low);
    hsh_evaluate(HSH_MAX_DEGREE, (struct relume_vec3){0.48, 0.64, -0.6}, lower);
    for (int k = 0; k < COUNT; k++)
        CHECK_NEAR(lower[k], low[k], 1e-14);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closed_forms),
        cmocka_unit_test(test_orthonormal),
        cmocka_unit_test(test_below_the_horizon_is_the_horizon),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
