// Least squares of the differences between neighbours, against the dense normal equations
#include "test.h"

#include "core/math/grid.h"
#include "core/math/lsq.h"

enum { W = 11, H = 7, N = W * H };

static double one(int i)
{
    return 0.5 + 0.5 * sin(12.9898 * (i + 1) * (i % 5 + 1));
}

static void add_pair(double m[N * N], double b[N], int from, int to, double w, double wd)
{
    m[from * N + from] += w;
    m[to * N + to] += w;
    m[from * N + to] -= w;
    m[to * N + from] -= w;
    b[from] -= wd;
    b[to] += wd;
}

// Weights that differ by a factor of 1e4, and a column that hardly holds to the next.
static void as_the_dense_solution(void **state)
{
    (void)state;
    static double m[N * N], b[N];
    const float screen = 1e-3f;
    struct grid g;
    CHECK_OK(grid_create(&g, W, H, screen, 2));
    for (int at = 0; at < N; at++) {
        const int x = at % W, y = at / W;
        if (x + 1 < W)
            g.right[at] = x == 4 ? 1e-4f : (float)one(at) + 0.01f;
        if (y + 1 < H)
            g.down[at] = (float)one(at + N) + 0.01f;
        g.across[at] = g.right[at] * (float)(3.0 * one(at + 7) - 1.0);
        g.below[at] = g.down[at] * (float)(3.0 * one(at + 3) - 1.0);
        g.z[at] = (float)one(3 * at);  // a start like any other
        if (x + 1 < W)
            add_pair(m, b, at, at + 1, (double)g.right[at], (double)g.across[at]);
        if (y + 1 < H)
            add_pair(m, b, at, at + W, (double)g.down[at], (double)g.below[at]);
        m[at * N + at] += (double)screen;
    }
    assert_true(lsq_solve(m, N, b, 1));
    grid_solve(&g, 100, 1e-7);
    for (int at = 0; at < N; at++)  // single precision, values up to some ten
        CHECK_NEAR((double)g.z[at], b[at], 1e-3);
    grid_destroy(&g);
}

// Constants cost nothing but the screen, which is below what single precision sees beside weights
// of 1: a long search stays where it is.
static void constants_do_not_grow(void **state)
{
    (void)state;
    enum { SIDE = 200 };
    struct grid g;
    CHECK_OK(grid_create(&g, SIDE, SIDE, 1e-8f, 1));
    for (int round = 0; round < 5; round++) {
        for (int at = 0; at < SIDE * SIDE; at++) {
            g.right[at] = at % SIDE + 1 < SIDE;
            g.down[at] = at / SIDE + 1 < SIDE;
            g.across[at] = 0.3f;
            g.below[at] = -0.2f;
        }
        grid_solve(&g, 100, 1e-7);
    }
    for (int at = 0; at < SIDE * SIDE; at += 999)
        CHECK_NEAR((double)g.z[at],
                   0.3 * (at % SIDE - 0.5 * (SIDE - 1)) - 0.2 * (at / SIDE - 0.5 * (SIDE - 1)),
                   0.05);
    grid_destroy(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_the_dense_solution),
        cmocka_unit_test(constants_do_not_grow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
