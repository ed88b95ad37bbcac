// test_interpolants.c - what must hold for every interpolant in the registry
#include "test.h"

#include "format/coder/basis.h"

enum { MOST = 64 };

#define FOR_EACH_INTERPOLANT(i)                                                                    \
    for (const struct relume_interpolant *const *i = relume_interpolants; *i; i++)

struct set {
    int n;
    struct relume_vec3 light[MOST];
};

static struct set make(int n, bool hemisphere)
{
    struct set s = {.n = n};
    CHECK_OK(relume_directions_make(s.light, n, relume_pattern_find("hammersley"),
                                    relume_directions_params(.hemisphere = hemisphere)));
    return s;
}

static bool is(const struct relume_interpolant *i, const char *names)
{
    char word[32];
    snprintf(word, sizeof word, " %s ", i->name);
    return strstr(names, word) != NULL;
}

// hsh knows one hemisphere only, octahedral nothing but its grid.
static bool takes(const struct relume_interpolant *i, bool hemisphere)
{
    return !is(i, " octahedral ") && (hemisphere || !is(i, " hsh "));
}

static void *prepare(const struct relume_interpolant *i, const struct set *s)
{
    const double parameter[4] = {0};
    void *data;
    CHECK_OK(i->prepare(&data, s->light, s->n, parameter, NULL));
    return data;
}

static struct relume_vec3 look(uint32_t *seed, bool hemisphere)
{
    struct relume_vec3 d = test_direction(seed);
    d.z = hemisphere ? fabs(d.z) : d.z;
    return d;
}

static const int sizes[] = {5, 12, 30, MOST};
#define FOR_EACH_SET(s, hemisphere)                                                                \
    for (int round_ = 0; round_ < 8; round_++)                                                     \
        for (bool hemisphere = round_ % 2, once_ = true; once_; once_ = false)                     \
            for (struct set s = make(sizes[round_ / 2], hemisphere); once_; once_ = false)

// Kernels keep a diagonal of 1e-5 at most against coinciding lights.
static const double SOLVED = 2e-3;

static void test_weights_sum_to_one(void **state)
{
    (void)state;
    uint32_t seed = 1;
    FOR_EACH_SET(s, hemisphere)
    FOR_EACH_INTERPOLANT(i)
    {
        if (!takes(*i, hemisphere))
            continue;
        void *data = prepare(*i, &s);
        for (int k = 0; k < 50; k++) {
            double w[MOST], sum = 0.0;
            (*i)->evaluate(data, look(&seed, hemisphere), w);
            for (int j = 0; j < s.n; j++)
                sum += w[j];
            CHECK_NEAR(sum, 1.0, 1e-6);
        }
        (*i)->release(data);
    }
}

static void test_captured_lights_are_met(void **state)
{
    (void)state;
    FOR_EACH_SET(s, hemisphere)
    FOR_EACH_INTERPOLANT(i)
    {
        if (!takes(*i, hemisphere) || is(*i, " rbf hsh "))
            continue;  // these smooth
        void *data = prepare(*i, &s);
        for (int k = 0; k < s.n; k++) {
            double w[MOST];
            (*i)->evaluate(data, s.light[k], w);
            for (int j = 0; j < s.n; j++)
                CHECK_NEAR(w[j], j == k, SOLVED);
        }
        (*i)->release(data);
    }
}

static void test_convex_ones_stay_in_range(void **state)
{
    (void)state;
    uint32_t seed = 2;
    FOR_EACH_SET(s, hemisphere)
    FOR_EACH_INTERPOLANT(i)
    {
        if (!is(*i, " rbf natural delaunay "))
            continue;
        void *data = prepare(*i, &s);
        for (int k = 0; k < 100; k++) {
            double w[MOST];
            (*i)->evaluate(data, look(&seed, false), w);
            for (int j = 0; j < s.n; j++)
                assert_true(w[j] >= 0.0 && w[j] <= 1.0 + 1e-12);
        }
        (*i)->release(data);
    }
}

// Of z only on the whole sphere, where it belongs to the trend.
static void test_linear_trend_is_exact(void **state)
{
    (void)state;
    uint32_t seed = 3;
    FOR_EACH_SET(s, hemisphere)
    FOR_EACH_INTERPOLANT(i)
    {
        if (!is(*i, " angular tps "))
            continue;
        void *data = prepare(*i, &s);
        for (int k = 0; k < 50; k++) {
            double w[MOST], x = 0.0, y = 0.0, z = 0.0;
            const struct relume_vec3 d = look(&seed, hemisphere);
            (*i)->evaluate(data, d, w);
            for (int j = 0; j < s.n; j++) {
                x += w[j] * s.light[j].x;
                y += w[j] * s.light[j].y;
                z += w[j] * s.light[j].z;
            }
            CHECK_NEAR(x, d.x, 1e-5);
            CHECK_NEAR(y, d.y, 1e-5);
            if (!hemisphere)
                CHECK_NEAR(z, d.z, 1e-5);
        }
        (*i)->release(data);
    }
}

// Smooth reflectance between 30 lights: nobody is far off, and the nearest light alone is worse.
static void test_a_lambertian_is_followed(void **state)
{
    (void)state;
    uint32_t seed = 4;
    const struct set s = make(30, true);
    FOR_EACH_INTERPOLANT(i)
    {
        if (!takes(*i, true))
            continue;
        void *data = prepare(*i, &s);
        double error = 0.0, nearest_error = 0.0;
        for (int k = 0; k < 400; k++) {
            const struct relume_vec3 n = look(&seed, true);
            struct relume_vec3 d = look(&seed, true);
            double w[MOST], sum = 0.0, at_nearest = 0.0, nearest = -1.0;
            (*i)->evaluate(data, d, w);
            for (int j = 0; j < s.n; j++) {
                const struct relume_vec3 l = s.light[j];
                const double value = fmax(n.x * l.x + n.y * l.y + n.z * l.z, 0.0);
                const double cosine = d.x * l.x + d.y * l.y + d.z * l.z;
                at_nearest = cosine > nearest ? value : at_nearest;
                nearest = fmax(nearest, cosine);
                sum += w[j] * value;
            }
            const double want = fmax(n.x * d.x + n.y * d.y + n.z * d.z, 0.0);
            error += (sum - want) * (sum - want) / 400;
            nearest_error += (at_nearest - want) * (at_nearest - want) / 400;
        }
        if (!(sqrt(error) < 0.08 && error < 0.7 * nearest_error))
            fail_msg("%s: RMS %.4f, nearest light %.4f", (*i)->name, sqrt(error),
                     sqrt(nearest_error));
        (*i)->release(data);
    }
}

static void test_continuous(void **state)
{
    (void)state;
    uint32_t seed = 5;
    const struct set s = make(30, true);
    FOR_EACH_INTERPOLANT(i)
    {
        if (!takes(*i, true))
            continue;
        void *data = prepare(*i, &s);
        for (int k = 0; k < 300; k++) {
            double a[MOST], b[MOST];
            const struct relume_vec3 near = k < 30 ? s.light[k] : look(&seed, true);
            struct relume_vec3 d = {near.x + 1e-5, near.y - 1e-5, near.z};
            d = vec3_unit(d);
            (*i)->evaluate(data, near, a);
            (*i)->evaluate(data, d, b);
            for (int j = 0; j < s.n; j++)
                if (!(fabs(a[j] - b[j]) < 2e-2))
                    fail_msg("%s jumps from %.4f to %.4f", (*i)->name, a[j], b[j]);
        }
        (*i)->release(data);
    }
}

// One light, two, three in a row, the same twice, all on a ring: numbers, and they sum to 1.
static void test_poor_light_sets(void **state)
{
    (void)state;
    struct set sets[5] = {
        {1, {{0, 0, 1}}},
        {2, {{0, 0, 1}, {0.6, 0, 0.8}}},
        {3, {{0, 0, 1}, {0.6, 0, 0.8}, {0.8, 0, 0.6}}},
        {6, {{0, 0, 1}, {0, 0, 1}, {0.6, 0, 0.8}, {0.6, 0, 0.8}, {0, 0.6, 0.8}, {0, -0.6, 0.8}}},
        {.n = 12},
    };
    for (int k = 0; k < 12; k++)
        sets[4].light[k] = vec3_of(0.8 * cos(k * 0.5235988), 0.8 * sin(k * 0.5235988), 0.6);
    uint32_t seed = 6;
    for (int set = 0; set < 5; set++)
        FOR_EACH_INTERPOLANT(i)
        {
            if (!takes(*i, true))
                continue;
            void *data = prepare(*i, &sets[set]);
            for (int k = 0; k < 50; k++) {
                double w[MOST], sum = 0.0;
                const struct relume_vec3 d = look(&seed, true);
                (*i)->evaluate(data, d, w);
                for (int j = 0; j < sets[set].n; j++) {
                    if (!(fabs(w[j]) < 100.0))
                        fail_msg("%s, set %d: weight %g", (*i)->name, set, w[j]);
                    sum += w[j];
                }
                if (!(fabs(sum - 1.0) < 1e-3))
                    fail_msg("%s, set %d: sum %.6f", (*i)->name, set, sum);
            }
            (*i)->release(data);
        }
}

// Two lights: the ratio of the weights is that of the Gaussians.
static void test_rbf_closed_form(void **state)
{
    (void)state;
    const struct set s = {2, {{0, 0, 1}, {0.6, 0, 0.8}}};
    const double sigma = 0.5, parameter[4] = {sigma};
    const struct relume_interpolant *rbf = relume_interpolant_find("rbf");
    const vec3 d = vec3_of(0.28, 0, 0.96);
    const double a = vec3_length(vec3_sub(d, s.light[0])), b = vec3_length(vec3_sub(d, s.light[1]));
    const double e = exp((a * a - b * b) / (sigma * sigma));
    void *data;
    double w[2];
    CHECK_OK(rbf->prepare(&data, s.light, 2, parameter, NULL));
    rbf->evaluate(data, d, w);
    CHECK_NEAR(w[1] / w[0], e, 1e-12);
    CHECK_NEAR(w[0] + w[1], 1.0, 1e-15);
    rbf->release(data);
}

// Two lights and a place between: by hand, a Gaussian each and a constant.
static void test_gaussian_closed_form(void **state)
{
    (void)state;
    const struct set s = {2, {{0, 0, 1}, {0.6, 0, 0.8}}};
    const double sigma = 0.5, parameter[4] = {sigma};
    const struct relume_interpolant *gaussian = relume_interpolant_find("gaussian");
    const vec3 d = vec3_of(0.28, 0, 0.96), ends = vec3_sub(s.light[0], s.light[1]);
    const vec3 to[2] = {vec3_sub(d, s.light[0]), vec3_sub(d, s.light[1])};
    const double across = exp(-vec3_dot(ends, ends) / (sigma * sigma));
    const double a = exp(-vec3_dot(to[0], to[0]) / (sigma * sigma));
    const double b = exp(-vec3_dot(to[1], to[1]) / (sigma * sigma));
    void *data;
    double w[2];
    CHECK_OK(gaussian->prepare(&data, s.light, 2, parameter, NULL));
    gaussian->evaluate(data, d, w);
    CHECK_NEAR(w[0], 0.5 + 0.5 * (a - b) / (1.0 - across), 1e-5);
    CHECK_NEAR(w[0] + w[1], 1.0, 1e-8);
    gaussian->release(data);
}

// The nodes are reproduced, the middle of four weighs them alike, other lights are refused.
static void test_octahedral_grid(void **state)
{
    (void)state;
    enum { SIDE = 6 };
    const struct relume_interpolant *o = relume_interpolant_find("octahedral");
    struct set s = {.n = SIDE * SIDE};
    for (int i = 0; i < s.n; i++) {
        const double u = 2.0 * (i % SIDE) / (SIDE - 1) - 1.0,
                     v = 2.0 * (i / SIDE) / (SIDE - 1) - 1.0;
        const double x = (u - v) / 2.0, y = (u + v) / 2.0;
        s.light[i] = vec3_unit(vec3_of(x, y, 1.0 - fabs(x) - fabs(y)));
    }
    void *data = prepare(o, &s);
    double w[MOST];
    for (int k = 0; k < s.n; k++) {
        o->evaluate(data, s.light[k], w);
        for (int j = 0; j < s.n; j++)
            CHECK_NEAR(w[j], j == k, 1e-12);
    }
    o->evaluate(data, vec3_of(0.0, 0.0, 1.0), w);
    for (int j = 0; j < s.n; j++)
        CHECK_NEAR(
            w[j], (j % SIDE == 2 || j % SIDE == 3) && (j / SIDE == 2 || j / SIDE == 3) ? 0.25 : 0.0,
            1e-12);
    o->release(data);
    const double parameter[4] = {0};
    s.light[7] = vec3_of(0.0, 0.0, 1.0);
    assert_int_equal(o->prepare(&data, s.light, s.n, parameter, NULL), RELUME_EUNFIT);
    assert_null(data);
}

// A file may say anything: parameters that would give NaN or nonsense are refused.
static void test_parameters_are_bounded(void **state)
{
    (void)state;
    static const double bad[][4] = {
        {2.0},      {1e30},       {-1.0},           {NAN},
        {INFINITY}, {1.5, 101.0}, {1.5, 1.5, -0.1}, {1.5, 1.5, 0.0, INFINITY}};
    const struct set s = make(20, true);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct relume_coder_params p = {.hemispherical = true};
        memcpy(p.parameter, bad[i], sizeof p.parameter);
        p.interpolant = relume_interpolant_find("chord");
        relume_coder *coder;
        assert_int_equal(relume_coder_create(&coder, &relume_basis_table, s.light, s.n, &p),
                         RELUME_EUNFIT);
        assert_null(coder);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_weights_sum_to_one),
        cmocka_unit_test(test_captured_lights_are_met),
        cmocka_unit_test(test_convex_ones_stay_in_range),
        cmocka_unit_test(test_linear_trend_is_exact),
        cmocka_unit_test(test_a_lambertian_is_followed),
        cmocka_unit_test(test_continuous),
        cmocka_unit_test(test_poor_light_sets),
        cmocka_unit_test(test_rbf_closed_form),
        cmocka_unit_test(test_gaussian_closed_form),
        cmocka_unit_test(test_octahedral_grid),
        cmocka_unit_test(test_parameters_are_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
