// test_sh.c - tests of src/core/math/sh.h: real spherical harmonics (Wong 1998, appendix A)
#include "test.h"

#include "core/math/sh.h"

enum { COUNT = (SH_MAX_DEGREE + 1) * (SH_MAX_DEGREE + 1) };

static void test_closed_forms(void **state)
{
    (void)state;
    uint32_t seed = 7;
    for (int i = 0; i < 200; i++) {
        const struct relume_vec3 d = test_direction(&seed);
        const double x = d.x, y = d.y, z = d.z, pi = 3.14159265358979324;
        double v[9];
        sh_evaluate(2, d, v);
        // signs as in the source: P_mm carries (-1)^m (Condon-Shortley)
        const double a = sqrt(3.0 / (4.0 * pi)), b = sqrt(15.0 / (4.0 * pi));
        const double want[9] = {0.5 / sqrt(pi),
                                -a * y,
                                a * z,
                                -a * x,
                                b * x * y,
                                -b * y * z,
                                sqrt(5.0 / (16.0 * pi)) * (3.0 * z * z - 1.0),
                                -b * x * z,
                                0.5 * b * (x * x - y * y)};
        for (int k = 0; k < 9; k++)
            CHECK_NEAR(v[k], want[k], 1e-13);
    }
}

// Gauss-Legendre would be exact; the midpoint rule in phi is for |m| < points, and Simpson-free
// midpoints in z converge as 1/n^2, so nodes and weights come from Newton on the Legendre
// polynomial.
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
        node[i] = x;
        weight[i] = 2.0 / ((1.0 - x * x) * slope * slope);
    }
}

static void test_orthonormal(void **state)
{
    (void)state;
    enum { Z = SH_MAX_DEGREE + 1, PHI = 2 * SH_MAX_DEGREE + 1 };  // exact for products
    static double gram[COUNT][COUNT];
    double node[Z], weight[Z], v[COUNT];
    legendre_nodes(Z, node, weight);
    for (int i = 0; i < Z; i++)
        for (int j = 0; j < PHI; j++) {
            const double r = sqrt(1.0 - node[i] * node[i]), phi = 6.283185307179586 * j / PHI;
            sh_evaluate(SH_MAX_DEGREE, (struct relume_vec3){r * cos(phi), r * sin(phi), node[i]},
                        v);
            for (int a = 0; a < COUNT; a++)
                for (int b = 0; b <= a; b++)
                    gram[a][b] += v[a] * v[b] * weight[i] * 6.283185307179586 / PHI;
        }
    for (int a = 0; a < COUNT; a++)
        for (int b = 0; b <= a; b++)
            CHECK_NEAR(gram[a][b], a == b, 1e-11);
}

// sum_m Y_lm(a) Y_lm(b) = (2l + 1) / (4 pi) P_l(a.b)
static void test_addition_theorem(void **state)
{
    (void)state;
    uint32_t seed = 3;
    for (int i = 0; i < 100; i++) {
        const struct relume_vec3 a = test_direction(&seed), b = test_direction(&seed);
        const double t = a.x * b.x + a.y * b.y + a.z * b.z;
        double va[COUNT], vb[COUNT], p0 = 1.0, p1 = t;
        sh_evaluate(SH_MAX_DEGREE, a, va);
        sh_evaluate(SH_MAX_DEGREE, b, vb);
        for (int l = 0; l <= SH_MAX_DEGREE; l++) {
            double sum = 0.0;
            for (int k = l * l; k < (l + 1) * (l + 1); k++)
                sum += va[k] * vb[k];
            CHECK_NEAR(sum, (2 * l + 1) / 12.566370614359172 * p0, 1e-11);
            const double next = ((2 * l + 3) * t * p1 - (l + 1) * p0) / (l + 2);
            p0 = p1;
            p1 = next;
        }
    }
}

static void test_poles(void **state)
{
    (void)state;
    double v[COUNT];
    for (int sign = -1; sign <= 1; sign += 2) {
        sh_evaluate(SH_MAX_DEGREE, (struct relume_vec3){0.0, 0.0, sign}, v);
        for (int l = 0; l <= SH_MAX_DEGREE; l++)
            for (int m = -l; m <= l; m++) {
                const double top = sqrt((2 * l + 1) / 12.566370614359172);
                CHECK_NEAR(v[l * (l + 1) + m],
                           m                        ? 0.0
                           : sign > 0 || l % 2 == 0 ? top
                                                    : -top,
                           1e-12);
            }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closed_forms),
        cmocka_unit_test(test_orthonormal),
        cmocka_unit_test(test_addition_theorem),
        cmocka_unit_test(test_poles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
