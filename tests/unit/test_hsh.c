// test_hsh.c - tests of src/core/math/hsh.h: hemispherical harmonics (Gautron et al. 2004)
#include "test.h"

#include "core/math/hsh.h"

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

// Nodes and weights of Gauss and Legendre on [0, 1], by Newton's method.
static void legendre_nodes(int n, double *node, double *weight)
{
    for (int i = 0; i < n; i++) {
        double x = cos(3.14159265358979324 * (i + 0.75) / (n + 0.5)), slope = 1.0;
        for (int step = 0; step < 20; step++) {
            double p0 = 1.0, p1 = x;
            for (int l = 2; l <= n; l++) {
                const double p2 = ((2 * l - 1) * x * p1 - (l - 1) * p0) / l;
                p0 = p1;
                p1 = p2;
            }
            slope = n * (x * p1 - p0) / (x * x - 1.0);
            x -= p1 / slope;
        }
        node[i] = (x + 1.0) / 2.0;
        weight[i] = 1.0 / ((1.0 - x * x) * slope * slope);
    }
}

// Over the hemisphere the measure is dz dphi. What azimuth leaves of a product is a polynomial of
// degree 8 in z, for which these nodes are exact; the lowest lies above the strip where one
// elevation counts.
static void test_orthonormal(void **state)
{
    (void)state;
    enum { Z = HSH_MAX_DEGREE + 1, PHI = 2 * HSH_MAX_DEGREE + 1 };
    double gram[COUNT][COUNT] = {{0}}, node[Z], weight[Z], v[COUNT];
    legendre_nodes(Z, node, weight);
    for (int i = 0; i < Z; i++)
        for (int j = 0; j < PHI; j++) {
            const double r = sqrt(1.0 - node[i] * node[i]), phi = 6.283185307179586 * j / PHI;
            assert_true(node[i] > sin(0.01));
            hsh_evaluate(HSH_MAX_DEGREE, (struct relume_vec3){r * cos(phi), r * sin(phi), node[i]},
                         v);
            for (int a = 0; a < COUNT; a++)
                for (int b = 0; b <= a; b++)
                    gram[a][b] += v[a] * v[b] * weight[i] * 6.283185307179586 / PHI;
        }
    for (int a = 0; a < COUNT; a++)
        for (int b = 0; b <= a; b++)
            CHECK_NEAR(gram[a][b], a == b, 1e-12);
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
