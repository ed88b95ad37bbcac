// Environment light on measured materials, against brute force: every cell of the environment as a
// light of its own.
#include "made_btf.h"

#include "material/model/ambient.h"
#include "material/model/environment.h"
#include "material/surface/texels.h"
#include "relight/light/environment.h"

#include <relume/material/surface.h>

enum { SIDE = 3 };

// ---------------------------------------------------------------- what is lit

static double lambert_and_gloss(size_t texel, int c, vec3 v, vec3 l)
{
    const vec3 mirror = vec3_of(-v.x, -v.y, v.z);
    const double gloss = pow(fmax(vec3_dot(mirror, l), 0.0), 4.0 + 3.0 * (double)(texel % 3));
    return l.z * (0.2 + 0.05 * (double)texel + 0.1 * c + 0.4 * gloss);
}

static double white(size_t texel, int c, vec3 v, vec3 l)
{
    (void)texel, (void)c, (void)v;
    return l.z;
}

struct made {
    double (*value)(size_t texel, int c, vec3 v, vec3 l);
    bool without_cosine;
};

static void fill(const void *context, vec3 v, vec3 l, float *rgb)
{
    const struct made *m = context;
    for (size_t i = 0; i < 3 * SIDE * SIDE; i++)
        rgb[i] = (float)(m->value(i / 3, (int)(i % 3), v, l) / (m->without_cosine ? l.z : 1.0));
}

static relume_btf *make(double (*value)(size_t texel, int c, vec3 v, vec3 l), const char *set,
                        bool without_cosine)
{
    return made_btf(&(struct made_btf){.set = set,
                                       .width = SIDE,
                                       .height = SIDE,
                                       .without_cosine = without_cosine,
                                       .fill = fill,
                                       .context = &(struct made){value, without_cosine}});
}

static double even(vec3 d, int c)
{
    (void)d, (void)c;
    return 1.0;
}

// A gradient and a soft sun; black in pieces, so that brute force has less to do.
static double sky(vec3 d, int c)
{
    const vec3 to_sun = vec3_unit(vec3_of(0.4, 0.6, 0.7));
    const bool lit = (int)floor(6.0 * d.x) % 3 == 0 && (int)floor(6.0 * d.z) % 3 == 0;
    return lit ? 0.6 + 0.4 * d.y * (1.0 + 0.2 * c) + 8.0 * exp(-40.0 * (1.0 - vec3_dot(d, to_sun)))
               : 0.0;
}

static relume_environment *environment(double (*radiance)(vec3 d, int c))
{
    struct relume_image map;
    relume_environment *e;
    CHECK_OK(relume_image_create(&map, 128, 64, 3));
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 128; x++) {
            const double theta = (y + 0.5) / 64 * M_PI, phi = ((x + 0.5) / 64 - 1.0) * M_PI;
            const vec3 d = vec3_of(sin(theta) * sin(phi), cos(theta), -sin(theta) * cos(phi));
            for (int c = 0; c < 3; c++)
                map.data[3 * (y * 128 + x) + c] = (float)radiance(d, c);
        }
    CHECK_OK(relume_environment_create(&e, &map, NULL));
    relume_image_destroy(&map);
    return e;
}

static struct relume_btf_frame frame_of(vec3 normal)
{
    const vec3 n = vec3_unit(normal), right = vec3_unit(vec3_cross(vec3_of(0.1, 1.0, 0.0), n));
    return (struct relume_btf_frame){right, vec3_cross(n, right), n};
}

static vec3 inside(const struct relume_btf_frame *f, vec3 d)
{
    return vec3_of(vec3_dot(d, f->right), vec3_dot(d, f->up), vec3_dot(d, f->normal));
}

// ---------------------------------------------------------------- brute force

static void brute(const relume_btf_fitted *m, const struct relume_light *light,
                  const struct relume_btf_frame *f, int x, vec3 view, double rgb[3])
{
    int n;
    const struct relume_environment_cell *cell = relume_environment_cells(&n, light->environment);
    rgb[0] = rgb[1] = rgb[2] = 0.0;
    for (int i = 0; i < n; i++) {
        float value[3];
        const vec3 d = relume_environment_turn(cell[i].direction, light->rotate_deg);
        relume_btf_fitted_evaluate(m, x, 1, view, inside(f, d), value);
        for (int c = 0; c < 3; c++)
            rgb[c] += (double)(value[c] * cell[i].rgb[c] * light->rgb[c]);
    }
}

// The greatest error over two orientations and views, relative to the green that is right.
static double worst(const relume_btf_fitted *m, const relume_prefiltered_maps *prefiltered,
                    const struct relume_light *light, bool own_maps)
{
    static const vec3 normals[] = {{0.0, 0.0, 1.0}, {0.3, 0.9, -0.2}};
    static const vec3 views[] = {{0.6, -0.3, 0.7}, {-0.1, 0.1, 1.0}};
    double most = 0.0;
    for (int k = 0; k < 2; k++) {
        const struct relume_btf_frame f = frame_of(normals[k]);
        const vec3 view = vec3_unit(views[k]);
        relume_btf_oriented_light *a;
        float got[3];
        double want[3];
        CHECK_OK(relume_btf_oriented_light_create(
            &a, m, prefiltered, &f, relume_btf_oriented_light_params(.own_maps = own_maps)));
        relume_btf_oriented_light_evaluate(a, 0, 2, 1, view, got);
        brute(m, light, &f, 2, view, want);
        for (int c = 0; c < 3; c++)
            most = fmax(most, fabs((double)got[c] - want[c]) / want[1]);
        relume_btf_oriented_light_destroy(&a);
    }
    return most;
}

// The same of a sky in any orientation.
static double worst_sky(const relume_btf_fitted *m, const relume_prefiltered_maps *prefiltered,
                        const struct relume_light *light)
{
    static const vec3 normals[] = {
        {0.0, 0.0, 1.0}, {0.3, 0.9, -0.2}, {-0.8, 0.1, 0.2}, {0.1, -0.9, 0.4}};
    relume_btf_surface *surface;
    relume_btf_environment *sky;
    double most = 0.0;
    CHECK_OK(relume_btf_surface_create(&surface, m, NULL, NULL));
    CHECK_OK(relume_btf_environment_create(&sky, m, prefiltered));
    for (int k = 0; k < 4; k++) {
        const struct relume_btf_ray ray = {
            .view = vec3_unit(vec3_of(0.6, -0.3, 0.7)), .sky = sky, .frame = frame_of(normals[k])};
        float got[3];
        double want[3];
        relume_btf_surface_evaluate(surface, 2.5, 1.5, 0.0, &ray, got);
        brute(m, light, &ray.frame, 2, ray.view, want);
        for (int c = 0; c < 3; c++)
            most = fmax(most, fabs((double)got[c] - want[c]) / want[1]);
    }
    relume_btf_environment_destroy(&sky);
    relume_btf_surface_destroy(&surface);
    return most;
}

static relume_btf_fitted *fit(const relume_btf *btf, const char *name)
{
    relume_btf_fitted *m;
    CHECK_OK(relume_btf_fit(&m, btf, relume_btf_model_find(name),
                            relume_btf_fit_params(.clusters = 4, .components = 4, .ratio = 1.0)));
    return m;
}

static bool has_lobes(const char *name)
{
    return strstr(name, "laf") || strstr(name, "rfnl");
}

// Models that know more between two lights than to interpolate: the table of bump is turned, the
// maps of cmf are looked up at the light itself, the polynomials of rfp as well, and gbrdf knows a
// reflectance.
static bool between_lights(const char *name)
{
    return !strcmp(name, "bump") || !strcmp(name, "cmf") || !strcmp(name, "rfp") ||
           !strcmp(name, "gbrdf");
}

static void test_brute_force(void **state)
{
    (void)state;
    relume_environment *e = environment(sky);
    const struct relume_light light = {.kind = RELUME_LIGHT_ENVIRONMENT,
                                       .environment = e,
                                       .rotate_deg = 25.0,
                                       .rgb = {1.0f, 0.9f, 1.2f}};
    relume_prefiltered_maps *p;
    // cosine of the lowest lights, 70 degrees from the pole; their ring of 12 is a polygon
    CHECK_OK(
        relume_prefiltered_maps_create(&p, &light, relume_prefiltered_maps_params(.rim = 0.347)));
    for (int bare = 0; bare < 2; bare++) {
        relume_btf *btf = make(lambert_and_gloss, "coarse", bare);
        for (const struct relume_btf_model *const *k = relume_btf_models; *k; k++) {
            const char *name = relume_btf_model_name(*k);
            if (between_lights(name))
                continue;
            relume_btf_fitted *m = fit(btf, name);
            CHECK_NEAR(relume_btf_fitted_info(m)->rim, 0.347, 0.002);
            // Linear models: cells of 3.75 degrees for those of 1.4. Lobes: the part of them above
            // the horizon is that under a uniform sky, and below the lowest lights they are
            // followed down, where the model stays with the rim and falls.
            const double most = has_lobes(name) ? 0.05 : 0.005;
            const double error = worst(m, p, &light, false);
            if (error >= most)
                print_error("%s, cosine %s: %g\n", name, bare ? "left out" : "in values", error);
            assert_true(error < most);
            // with maps of the orientation only their pixels and exponents are left
            const bool try_own = !strcmp(name, "rfnl") || (!bare && !strcmp(name, "laf"));
            assert_true(!try_own || worst(m, p, &light, true) < 0.005);
            relume_btf_fitted_destroy(&m);
        }
        relume_btf_destroy(&btf);
    }
    relume_prefiltered_maps_destroy(&p);
    relume_environment_destroy(&e);
}

// Lights 15 degrees apart, as they are measured. Summed over them, models that interpolate between
// lights are right, and those of between_lights err by what these know better: bump 0.1 %, cmf and
// rfp 1.2 %; with lights 45 degrees apart it is 18 % and 2.5 %. In any orientation, pyramids that
// are exchanged for lobes: 3 % under a sky that is cut into black pieces of 10 degrees.
static void test_measured_lights(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double ambient, sky;
    } list[] = {{"bump", 0.005, 0.04}, {"cmf", 0.02, 0.04}, {"lit", 0.001, 0.002},
                {"rfnl", 0.02, 0.03},  {"rfp", 0.02, 0.04}, {"vpca", 0.001, 0.04}};
    relume_environment *e = environment(sky);
    const struct relume_light light = {.kind = RELUME_LIGHT_ENVIRONMENT,
                                       .environment = e,
                                       .rotate_deg = 25.0,
                                       .rgb = {1.0f, 0.9f, 1.2f}};
    relume_prefiltered_maps *p;  // the lowest lights stand 75 degrees from the pole
    CHECK_OK(
        relume_prefiltered_maps_create(&p, &light, relume_prefiltered_maps_params(.rim = 0.257)));
    for (int bare = 0; bare < 2; bare++) {
        relume_btf *btf = make(lambert_and_gloss, "bonn", bare);
        for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
            relume_btf_fitted *m = fit(btf, list[i].name);
            const double one = worst(m, p, &light, false), any = worst_sky(m, p, &light);
            if (one >= list[i].ambient || any >= list[i].sky)
                fail_msg("%s: %g in one orientation, %g in any", list[i].name, one, any);
            relume_btf_fitted_destroy(&m);
        }
        relume_btf_destroy(&btf);
    }
    relume_prefiltered_maps_destroy(&p);
    relume_environment_destroy(&e);
}

// A white Lambertian surface under radiance 1 shows 1, whatever the model and the orientation, with
// n.l in its values or without, in maps of the model's own rim as a renderer makes them.
static void check_furnace(const relume_btf *btf, const struct relume_light *light, double rim)
{
    const struct relume_btf_frame f = frame_of(vec3_of(0.5, -0.7, 0.3));
    const vec3 view = vec3_unit(vec3_of(0.2, 0.1, 0.9));
    relume_prefiltered_maps *p;
    CHECK_OK(relume_prefiltered_maps_create(
        &p, light, relume_prefiltered_maps_params(.height = 12, .rim = rim)));
    for (const struct relume_btf_model *const *k = relume_btf_models; *k; k++) {
        relume_btf_fitted *m = fit(btf, relume_btf_model_name(*k));
        relume_btf_oriented_light *a;
        float got[3];
        CHECK_OK(relume_btf_oriented_light_create(&a, m, p, &f, NULL));
        relume_btf_oriented_light_evaluate(a, 0, 1, 1, view, got);
        // cells that the horizon cuts through count whole or not; fits are halfs
        // (the polynomials of rfp hold n.l to 0.3 %)
        const double most = 0.005;
        CHECK_NEAR(got[0], 1.0, most);
        relume_btf_surface *surface;
        relume_btf_environment *any;
        CHECK_OK(relume_btf_surface_create(&surface, m, NULL, NULL));
        CHECK_OK(relume_btf_environment_create(&any, m, p));
        relume_btf_surface_evaluate(surface, 1.5, 1.5, 0.0,
                                    &(struct relume_btf_ray){.view = view, .sky = any, .frame = f},
                                    got);
        CHECK_NEAR(got[0], 1.0, most);
        relume_btf_environment_destroy(&any);
        relume_btf_surface_destroy(&surface);
        relume_btf_oriented_light_destroy(&a);
        relume_btf_fitted_destroy(&m);
    }
    relume_prefiltered_maps_destroy(&p);
}

static void test_furnace(void **state)
{
    (void)state;
    relume_environment *e = environment(even);
    const struct relume_light light = {
        .kind = RELUME_LIGHT_ENVIRONMENT, .environment = e, .rgb = {1.0f, 1.0f, 1.0f}};
    for (int bare = 0; bare < 2; bare++) {
        relume_btf *btf = make(white, "coarse", bare);
        check_furnace(btf, &light, 0.347);
        relume_btf_destroy(&btf);
    }
    relume_environment_destroy(&e);
}

// ---------------------------------------------------------------- maps

// Closed forms under radiance 1: the mean is 1, a lobe sends 2 / (e + 1), and times n.l along the
// normal 2 / (e + 2).
static void test_even_sky(void **state)
{
    (void)state;
    relume_environment *e = environment(even);
    const struct relume_light light = {
        .kind = RELUME_LIGHT_ENVIRONMENT, .environment = e, .rgb = {1.0f, 2.0f, 1.0f}};
    const vec3 n = vec3_unit(vec3_of(0.3, 0.2, -0.8));
    relume_prefiltered_maps *p;
    float rgb[3];
    CHECK_OK(relume_prefiltered_maps_create(
        &p, &light, relume_prefiltered_maps_params(.height = 16, .threads = 2)));
    relume_prefiltered_maps_diffuse(rgb, p, n);
    CHECK_NEAR(rgb[0], 2.0, 0.01);  // cells at the horizon
    CHECK_NEAR(rgb[1], 4.0, 0.02);
    for (double exponent = 1.0; exponent < 33.0; exponent *= 1.7) {
        relume_prefiltered_maps_specular(rgb, p, n, exponent);
        CHECK_NEAR(rgb[0], 1.0, 0.005);  // lobes of 24 degrees over cells of 3.75
        relume_prefiltered_maps_lobe(rgb, p, n, n, exponent, false);
        CHECK_NEAR(rgb[0] * (exponent + 1.0) / 2.0, 1.0, 0.005);
        relume_prefiltered_maps_lobe(rgb, p, n, n, exponent, true);
        // between exponents the factor (e + 1) / (e + 2) is taken as linear in log2 e
        CHECK_NEAR(rgb[0] * (exponent + 2.0) / 2.0, 1.0, 0.01);
    }
    // a lobe along the horizon: one half arrives
    const vec3 across = vec3_unit(vec3_cross(n, vec3_of(0.0, 1.0, 0.0)));
    relume_prefiltered_maps_lobe(rgb, p, n, across, 4.0, false);
    CHECK_NEAR(rgb[0], 0.5 * 2.0 / 5.0, 0.002);
    relume_prefiltered_maps_destroy(&p);
    assert_int_equal(
        relume_prefiltered_maps_create(&p, &light, relume_prefiltered_maps_params(.height = 2)),
        RELUME_EINVAL);
    const struct relume_light other = {.kind = RELUME_LIGHT_DIRECTIONAL};
    assert_int_equal(relume_prefiltered_maps_create(&p, &other, NULL), RELUME_EINVAL);
    relume_environment_destroy(&e);
}

static double one_spot(vec3 d, int c)
{
    (void)c;
    return vec3_dot(d, vec3_unit(vec3_of(1.0, 0.5, -0.4))) > 0.999 ? 100.0 : 0.0;
}

// A small source: lobes are seen as they are, turned with the environment.
static void test_spot(void **state)
{
    (void)state;
    relume_environment *e = environment(one_spot);
    const struct relume_light light = {.kind = RELUME_LIGHT_ENVIRONMENT,
                                       .environment = e,
                                       .rotate_deg = 70.0,
                                       .rgb = {1.0f, 1.0f, 1.0f}};
    int n;
    const struct relume_environment_cell *cell = relume_environment_cells(&n, e);
    double sent = 0.0;
    for (int i = 0; i < n; i++)
        sent += (double)cell[i].rgb[0];
    const vec3 to = relume_environment_turn(vec3_unit(vec3_of(1.0, 0.5, -0.4)), 70.0);
    const vec3 side = vec3_unit(vec3_cross(to, vec3_of(0.0, 0.0, 1.0)));
    relume_prefiltered_maps *p;
    CHECK_OK(relume_prefiltered_maps_create(&p, &light, NULL));
    for (int i = 0; i < RELUME_PREFILTERED_EXPONENTS; i++)
        for (double angle = 0.0; angle < 1.0; angle += 0.3) {
            const double exponent = pow(2.0, 0.5 * i);
            const vec3 axis = vec3_add(vec3_scale(to, cos(angle)), vec3_scale(side, sin(angle)));
            float rgb[3];
            relume_prefiltered_maps_specular(rgb, p, axis, exponent);
            // bilinear between pixels h = 3.75 degrees apart: h^2 e / 8 along rows and columns
            CHECK_NEAR(rgb[0] * 2.0 / (exponent + 1.0), sent * pow(cos(angle), exponent),
                       (0.003 + 0.0011 * exponent) * sent);
        }
    relume_prefiltered_maps_destroy(&p);
    relume_environment_destroy(&e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_brute_force), cmocka_unit_test(test_measured_lights),
        cmocka_unit_test(test_furnace),     cmocka_unit_test(test_even_sky),
        cmocka_unit_test(test_spot),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
