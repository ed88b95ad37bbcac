// bench_reflection.c - edited reflections of 1280 x 960 places with 1, 8 and 32 constraints, by
// each set of instructions, on one core and two
#include "world/reflect/reflection.h"

#include "bench.h"

#include <math.h>

enum { WIDE = 1280, HIGH = 960, PIXELS = WIDE * HIGH, MOST = 32, RUNS = 7 };

static struct relume_vec3 on_ball(double a, double b)
{
    return (struct relume_vec3){cos(b) * sin(a), sin(b), cos(b) * cos(a)};
}

static double seconds(const relume_reflection *f, const float *const place[3], float *const r[3],
                      unsigned cpu_off, int threads)
{
    const struct relume_reflection_places p = {place[0], place[1], place[2], r[0],
                                               r[1],     r[2],     PIXELS};
    struct times all = {.n = 0};
    for (int i = 0; i < RUNS; i++) {
        const double start = now_s();
        bench_check(relume_reflection_turn_all(f, &p, cpu_off, threads));
        times_add(&all, now_s() - start);
    }
    return times_median(&all);
}

int main(void)
{
    static const struct {
        const char *name;
        unsigned off;
    } sets[] = {{"plain C", ~0u}, {"AVX2", RELUME_CPU_AVX512}, {"AVX-512", 0}};
    float *place[3], *r[3];
    for (int k = 0; k < 3; k++) {
        place[k] = malloc(PIXELS * sizeof(float));
        r[k] = malloc(PIXELS * sizeof(float));
    }
    for (int i = 0; i < PIXELS; i++) {
        const struct relume_vec3 p =
            on_ball(6.28 * (i % WIDE) / WIDE, 3.0 * (i / WIDE) / HIGH - 1.5);
        const double at[3] = {p.x, p.y, p.z};
        for (int k = 0; k < 3; k++)
            place[k][i] = r[k][i] = (float)at[k];
    }
    printf("edited reflections, %d x %d places\n", WIDE, HIGH);
    for (int n = 1; n <= MOST; n *= n == 1 ? 8 : 4) {
        struct relume_reflection_constraint c[MOST];
        const struct relume_reflection_edit edit = {.constraint = c, .constraints = n};
        relume_reflection *f;
        for (int i = 0; i < n; i++)
            c[i] = (struct relume_reflection_constraint){on_ball(2.4 * i, 2.0 * i / n - 1.0),
                                                         on_ball(2.4 * i, 2.0 * i / n - 1.0),
                                                         on_ball(2.4 * i + 0.5, 1.8 * i / n - 0.8),
                                                         {0, 0, 9}};
        bench_check(relume_reflection_create(&f, &edit, NULL, NULL));
        for (size_t s = 0; s < sizeof sets / sizeof *sets; s++)
            for (int threads = 1; threads <= 2; threads++) {
                const double t = seconds(f, (const float *const *)place, r, sets[s].off, threads);
                printf("%2d constraints, %-8s %d core%s %6.1f ms %7.1f Mpixel/s\n", n, sets[s].name,
                       threads, threads > 1 ? "s" : " ", 1e3 * t, 1e-6 * PIXELS / t);
            }
        relume_reflection_destroy(&f);
    }
    for (int k = 0; k < 3; k++) {
        free(place[k]);
        free(r[k]);
    }
    return 0;
}
