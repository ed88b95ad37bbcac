// test_relight.c - weights, domains and point lights against closed forms
#include "test.h"

enum { SIDE = 8, K = 4 };

// SH of degree 1 without a transform, with the signs of Wong 1998, appendix A (P_11 = -sin theta):
// value = 0.2820948 c0 + 0.4886025 (-c1 y + c2 z - c3 x).
static const double Y0 = 0.28209479177387814, Y1 = 0.48860251190291992;

// Coefficients per colour, a luminance with colours, and components of all three colours.
enum form { SEPARATE, LUMINANCE, COMPONENTS, FORMS };
enum { LIGHTS = 6, PLANES = 3 * K };

static const struct relume_vec3 axes[LIGHTS] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                                {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};

struct setup {
    enum form form;
    relume_coder *coder;
    float transform[3 * K * LIGHTS], mean[3 * LIGHTS];  // of the components
    uint16_t words[PLANES][SIDE * SIDE];
    const void *plane[PLANES];
    float scale[PLANES], offset[PLANES];
    struct relume_codes codes;
};

static void make_coder(struct setup *s, uint32_t *state)
{
    struct relume_coder_params p = {.coefficients = K, .decode = true};
    if (s->form == COMPONENTS) {
        for (int i = 0; i < 3 * K * LIGHTS; i++)
            s->transform[i] = (float)test_uniform(state) - 0.3f;
        for (int i = 0; i < 3 * LIGHTS; i++)
            s->mean[i] = (float)test_uniform(state);
        p.transform = s->transform;
        p.mean = s->mean;
        p.interpolant = relume_interpolant_find("delaunay");
    }
    p.luminance = s->form == LUMINANCE;
    CHECK_OK(relume_coder_create(
        &s->coder, s->form == COMPONENTS ? &relume_basis_pca : &relume_basis_sh, axes, LIGHTS, &p));
}

static void make(struct setup *s, enum form form, enum relume_domain domain)
{
    uint32_t state = 7;
    s->form = form;
    make_coder(s, &state);
    for (int p = 0; p < PLANES; p++) {
        for (int i = 0; i < SIDE * SIDE; i++)
            s->words[p][i] = (uint16_t)(test_random(&state) & 0xffff);
        s->plane[p] = s->words[p];
        s->scale[p] = (p < 3 ? 2.0f : 0.2f) / 65535.0f;
        s->offset[p] = p < 3 ? 0.5f : -0.1f;
    }
    s->codes = (struct relume_codes){
        .coder = s->coder,
        .domain = domain,
        .display = {RELUME_CURVE_SRGB, 0.0f},
        .width = SIDE,
        .height = SIDE,
        .planes = relume_coder_info(s->coder)->planes,
        .storage = RELUME_STORE_16,
        .plane = s->plane,
        .scale = s->scale,
        .offset = s->offset,
    };
}

static double coefficient(const struct setup *s, int pixel, int plane)
{
    return (double)s->words[plane][pixel] * (double)s->scale[plane] + (double)s->offset[plane];
}

// The triangulation of the axes is the octahedron: weights |x|, |y|, |z| over their sum.
static double components(const struct setup *s, int pixel, int c, struct relume_vec3 l)
{
    const double sum = fabs(l.x) + fabs(l.y) + fabs(l.z);
    const double weight[LIGHTS] = {fmax(l.x, 0) / sum,  fmax(-l.x, 0) / sum, fmax(l.y, 0) / sum,
                                   fmax(-l.y, 0) / sum, fmax(l.z, 0) / sum,  fmax(-l.z, 0) / sum};
    double v = 0.0;
    for (int i = 0; i < LIGHTS; i++) {
        v += weight[i] * (double)s->mean[c * LIGHTS + i];
        for (int k = 0; k < K; k++)
            v += weight[i] * (double)s->transform[(c * K + k) * LIGHTS + i] *
                 coefficient(s, pixel, k);
    }
    return v;
}

static double harmonics(const struct setup *s, int pixel, int c, struct relume_vec3 l)
{
    const bool shared = s->form == LUMINANCE;
    double q[K];
    for (int k = 0; k < K; k++)
        q[k] = coefficient(s, pixel, shared ? k : 3 * k + c);
    const double v = Y0 * q[0] + Y1 * (-q[1] * l.y + q[2] * l.z - q[3] * l.x);
    return shared ? v * coefficient(s, pixel, K + c) : v;
}

static double closed_form(const struct setup *s, int pixel, int c, struct relume_vec3 l)
{
    const double v = s->form == COMPONENTS ? components(s, pixel, c, l) : harmonics(s, pixel, c, l);
    return s->codes.domain == RELUME_DOMAIN_DISPLAY
               ? (double)relume_transfer_decode(s->codes.display, (float)v)
               : v;
}

static struct relume_vec3 unit(double x, double y, double z)
{
    const double r = sqrt(x * x + y * y + z * z);
    return (struct relume_vec3){x / r, y / r, z / r};
}

// Single precision sums of a few values near 1: 1e-6.
static const double TOLERANCE = 2e-6;

static void test_directional_sum(void **state)
{
    (void)state;
    for (int round = 0; round < 2 * FORMS; round++) {
        struct setup s;
        make(&s, round / 2, round % 2 ? RELUME_DOMAIN_DISPLAY : RELUME_DOMAIN_LINEAR);
        const struct relume_light lights[] = {
            {.direction = {2, 0, 0}, .rgb = {1, 0.5f, 0.25f}},
            {.direction = {0.3, -0.5, 0.7}, .rgb = {0.2f, 0.3f, 2}},
        };
        struct relume_image out = {0};
        CHECK_OK(relume_relight(&out, &s.codes, lights, 2, NULL));
        for (int i = 0; i < SIDE * SIDE; i++)
            for (int c = 0; c < 3; c++) {
                const double want =
                    (double)lights[0].rgb[c] * closed_form(&s, i, c, unit(1, 0, 0)) +
                    (double)lights[1].rgb[c] * closed_form(&s, i, c, unit(0.3, -0.5, 0.7));
                CHECK_NEAR(out.data[3 * i + c], want, TOLERANCE);
            }
        for (int i = 0; i < SIDE * SIDE; i++) {  // the reference for one pixel says the same
            double rgb[3];
            relume_relight_pixel(rgb, &s.codes, i % SIDE, i / SIDE, lights, 2);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(rgb[c], (double)out.data[3 * i + c], TOLERANCE);
        }
        relume_image_destroy(&out);
        relume_coder_destroy(&s.coder);
    }
}

static void test_point_light(void **state)
{
    (void)state;
    for (int round = 0; round < 2 * FORMS; round++) {
        struct setup s;
        make(&s, round / 2, round % 2 ? RELUME_DOMAIN_DISPLAY : RELUME_DOMAIN_LINEAR);
        const struct relume_geometry g = relume_geometry_default(RELUME_PLANAR, SIDE, SIDE);
        struct relume_image surface, out = {0};
        CHECK_OK(relume_surface(&surface, &g, NULL, NULL, SIDE, SIDE));
        surface.data[0] = INFINITY;  // one background pixel
        const struct relume_light light = {
            .kind = RELUME_LIGHT_POINT, .position = {0.4, -0.2, 0.6}, .rgb = {1, 2, 3}};
        CHECK_OK(
            relume_relight(&out, &s.codes, &light, 1, relume_relight_params(.surface = &surface)));
        for (int i = 1; i < SIDE * SIDE; i++) {
            const double x = -1.0 + (i % SIDE + 0.5) * 2.0 / SIDE;
            const double y = 1.0 - (i / SIDE + 0.5) * 2.0 / SIDE;
            const struct relume_vec3 l = unit(0.4 - x, -0.2 - y, 0.6);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(out.data[3 * i + c], (c + 1) * closed_form(&s, i, c, l), 3 * TOLERANCE);
        }
        assert_true(out.data[0] == 0.0f && out.data[1] == 0.0f && out.data[2] == 0.0f);
        relume_image_destroy(&surface);
        relume_image_destroy(&out);
        relume_coder_destroy(&s.coder);
    }
}

static void test_point_light_needs_surface(void **state)
{
    (void)state;
    struct setup s;
    struct test_log log;
    struct relume_image out = {0};
    make(&s, SEPARATE, RELUME_DOMAIN_LINEAR);
    test_log_init(&log);
    const struct relume_light light = {.kind = RELUME_LIGHT_POINT, .rgb = {1, 1, 1}};
    assert_int_equal(
        relume_relight(&out, &s.codes, &light, 1, relume_relight_params(.log = &log.log)),
        RELUME_EINVAL);
    assert_null(out.data);
    assert_non_null(strstr(log.text, "depth"));
    relume_coder_destroy(&s.coder);
}

static void test_surface_of_depth(void **state)
{
    (void)state;
    struct relume_geometry g = relume_geometry_default(RELUME_SLAB, SIDE, SIDE);
    struct relume_image depth, surface;
    const double uv[2] = {0.5, -0.25};
    CHECK_OK(relume_image_create(&depth, SIDE, SIDE, 1));
    for (int i = 0; i < SIDE * SIDE; i++)
        depth.data[i] = 2.0f;
    depth.data[5] = INFINITY;
    CHECK_OK(relume_surface(&surface, &g, uv, &depth, SIDE, SIDE));
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float *p = surface.data + 3 * i;
        if (i == 5) {
            assert_false(isfinite(p[2]));
            continue;
        }
        const double dx = p[0] - 0.5, dy = p[1] + 0.25, dz = p[2] - 3.0;
        CHECK_NEAR(sqrt(dx * dx + dy * dy + dz * dz), 2.0, 1e-6);
        // the ray goes through the pixel's centre on the window z = 0
        CHECK_NEAR(0.5 + dx * 3.0 / -dz, -1.0 + (i % SIDE + 0.5) * 2.0 / SIDE, 1e-5);
        CHECK_NEAR(-0.25 + dy * 3.0 / -dz, 1.0 - (i / SIDE + 0.5) * 2.0 / SIDE, 1e-5);
    }
    relume_image_destroy(&surface);
    assert_int_equal(relume_surface(&surface, &g, uv, NULL, SIDE, SIDE), RELUME_EINVAL);
    relume_image_destroy(&depth);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_directional_sum),
        cmocka_unit_test(test_point_light),
        cmocka_unit_test(test_point_light_needs_surface),
        cmocka_unit_test(test_surface_of_depth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
