// Maps of a surface whose reflectance is known in closed form: glTF 2.0, appendix B, written out as
// the specification has it, in double precision.
#include "material/maps/maps.h"

#include "test.h"

enum { SIDE = 36, LIGHTS = 48, MOST = SIDE * SIDE };

struct paint {
    double base[3], roughness, metallic, f0;
};

// Left to right: glossy paint, matte paper, a metal.
static struct paint paint_at(int x, int y)
{
    static const struct paint gloss = {{0.5, 0.2, 0.1}, 0.35, 0.0, 0.04},
                              paper = {{0.7, 0.7, 0.6}, 1.0, 0.0, 0.0},
                              metal = {{0.9, 0.6, 0.3}, 0.45, 1.0, 0.04};
    struct paint p = x < SIDE / 3 ? gloss : x < 2 * SIDE / 3 ? paper : metal;
    for (int c = 0; c < 3 && y % 16 < 8; c++)
        p.base[c] *= 0.8;
    return p;
}

static vec3 normal_at(int x, int y)
{
    const double u = 2.0 * (x + 0.5) / SIDE - 1.0, v = 1.0 - 2.0 * (y + 0.5) / SIDE;
    return vec3_unit(
        vec3_of(0.4 * sin(9.0 * u) * cos(7.0 * v), 0.4 * cos(9.0 * u) * sin(7.0 * v), 1.0));
}

static vec3 light_at(int i)
{
    const double z = 1.0 - 0.75 * (i + 0.5) / LIGHTS, a = 2.399963 * i, r = sqrt(1.0 - z * z);
    return vec3_of(r * cos(a), r * sin(a), z);
}

static double mix(double a, double b, double t)
{
    return a + (b - a) * t;
}

// pi times the reflectance times the cosine.
static void shade(double out[3], const struct paint *p, vec3 n, vec3 v, vec3 l)
{
    const vec3 h = vec3_unit(vec3_add(l, v));
    const double nl = vec3_dot(n, l), nv = vec3_dot(n, v), nh = vec3_dot(n, h);
    const double a2 = pow(p->roughness, 4.0), fifth = pow(1.0 - vec3_dot(v, h), 5.0);
    const double d = a2 / (M_PI * pow(nh * nh * (a2 - 1.0) + 1.0, 2.0));
    const double gl = 2.0 * nl / (nl + sqrt(a2 + (1.0 - a2) * nl * nl));
    const double gv = 2.0 * nv / (nv + sqrt(a2 + (1.0 - a2) * nv * nv));
    const double lobe = d * gl * gv / (4.0 * nl * nv);
    const double weight = p->f0 > 0.0 ? 1.0 : 0.0;  // of KHR_materials_specular
    for (int c = 0; c < 3; c++) {
        const double f = weight * mix(p->f0, 1.0, fifth);
        const double dielectric = mix(p->base[c] / M_PI, lobe, 0.0) * (1.0 - f) + f * lobe;
        const double metal = mix(p->base[c], 1.0, fifth) * lobe;
        out[c] = nl > 0.0 ? M_PI * nl * mix(dielectric, metal, p->metallic) : 0.0;
    }
}

struct stage {
    float *pictures;
    float mask[MOST];
    struct relume_vec3 light[LIGHTS];
    relume_capture *capture;
};

static void stage_open(struct stage *s, int lights, bool shadows, bool masked)
{
    const vec3 up = vec3_of(0.0, 0.0, 1.0);
    s->pictures = calloc((size_t)lights * MOST * 3, sizeof *s->pictures);
    assert_non_null(s->pictures);
    for (int i = 0; i < lights; i++) {
        s->light[i] = light_at(lights < 12 ? i * LIGHTS / lights : i);
        for (int k = 0; k < MOST; k++) {
            double rgb[3];
            const struct paint p = paint_at(k % SIDE, k / SIDE);
            shade(rgb, &p, normal_at(k % SIDE, k / SIDE), up, s->light[i]);
            const bool hidden = shadows && (k + 7 * i) % 5 == 0;
            for (int c = 0; c < 3; c++)
                s->pictures[3 * ((size_t)i * MOST + (size_t)k) + (size_t)c] =
                    hidden ? 0.0f : (float)rgb[c];
        }
    }
    for (int k = 0; k < MOST; k++)
        s->mask[k] = 0.0f;
    const struct relume_manifest m = {.lights = lights, .directions = s->light};
    const struct relume_pictures pictures = {.width = SIDE,
                                             .height = SIDE,
                                             .channels = 3,
                                             .data = s->pictures,
                                             .mask = masked ? s->mask : NULL};
    CHECK_OK(relume_capture_create(&s->capture, &m, &pictures, NULL));
}

static void stage_close(struct stage *s)
{
    relume_capture_destroy(&s->capture);
    free(s->pictures);
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// The median over a third of the picture, but for a border where neighbours are of another kind.
static double median(const struct relume_image *image, int channel, int third,
                     double (*of)(double value, const struct paint *p, int channel))
{
    static double value[MOST];
    size_t n = 0;
    for (int k = 0; k < MOST; k++) {
        const int x = k % SIDE - third * SIDE / 3;
        const struct paint p = paint_at(k % SIDE, k / SIDE);
        if (x >= 4 && x < SIDE / 3 - 4)
            value[n++] =
                of((double)image->data[(size_t)image->channels * (size_t)k + (size_t)channel], &p,
                   channel);
    }
    qsort(value, n, sizeof *value, by_size);
    return value[n / 2];
}

static double itself(double value, const struct paint *p, int channel)
{
    (void)p, (void)channel;
    return value;
}

static double over_base(double value, const struct paint *p, int channel)
{
    return value / p->base[channel];
}

static double angle_of(const struct relume_maps *maps)
{
    double sum = 0.0;
    for (int k = 0; k < MOST; k++) {
        const float *n = maps->normal.data + 3 * k;
        const vec3 found = vec3_of((double)n[0], (double)n[1], (double)n[2]);
        sum += acos(fmin(vec3_dot(found, normal_at(k % SIDE, k / SIDE)), 1.0)) * 180.0 / M_PI;
    }
    return sum / MOST;
}

// The table of candidates has steps of a fifth of the roughness; entries are moved in steps of
// 0.008.
static void check_known(const struct relume_maps *maps, double loose)
{
    CHECK_NEAR(angle_of(maps), 0.0, 0.25 * loose);  // Lambert alone is 10 degrees off on the metal
    CHECK_NEAR(median(&maps->roughness, 0, 0, itself), 0.35, 0.02 * loose);
    CHECK_NEAR(median(&maps->specular, 1, 0, itself), 0.04, 0.005 * loose);
    CHECK_NEAR(median(&maps->roughness, 0, 2, itself), 0.45, 0.02 * loose);
    CHECK_NEAR(median(&maps->metallic, 0, 2, itself), 1.0, 0.0);
    CHECK_NEAR(median(&maps->metallic, 0, 0, itself), 0.0, 0.0);
    CHECK_NEAR(median(&maps->specular, 0, 1, itself), 0.0, 0.005 * loose);
    for (int c = 0; c < 3; c++)
        for (int third = 0; third < 3; third++)
            CHECK_NEAR(median(&maps->base_color, c, third, over_base), 1.0, 0.03 * loose);
}

static void fit(struct relume_maps *maps, int lights, bool shadows)
{
    struct stage s;
    stage_open(&s, lights, shadows, false);
    CHECK_OK(relume_maps_fit(maps, s.capture, NULL));
    stage_close(&s);
}

// What is relit is the formula of the specification.
static void check_relit(const struct relume_maps *maps)
{
    struct relume_image image;
    const vec3 l = vec3_unit(vec3_of(0.3, -0.2, 0.8));
    CHECK_OK(relume_maps_relight(&image, maps, vec3_scale(l, 3.0), 1));
    for (int k = 0; k < MOST; k += 7) {
        const float *n = maps->normal.data + 3 * k, *base = maps->base_color.data + 3 * k;
        const struct paint p = {{(double)base[0], (double)base[1], (double)base[2]},
                                (double)maps->roughness.data[k],
                                (double)maps->metallic.data[k],
                                (double)maps->specular.data[3 * k]};
        double want[3];
        if (p.f0 > 0.0 && p.f0 < 0.04)
            continue;  // between glass and nothing the weight is not 0 or 1
        shade(want, &p, vec3_of((double)n[0], (double)n[1], (double)n[2]), vec3_of(0.0, 0.0, 1.0),
              l);
        for (int c = 0; c < 3; c++)  // single precision, of terms up to 10
            CHECK_NEAR((double)image.data[3 * k + c], want[c], 1e-4 * (1.0 + want[c]));
    }
    relume_image_destroy(&image);
    assert_int_equal(relume_maps_relight(&image, maps, vec3_of(0.0, 0.0, 0.0), 1), RELUME_EINVAL);
}

static void what_was_painted_comes_back(void **state)
{
    (void)state;
    struct relume_maps maps;
    fit(&maps, LIGHTS, false);
    check_known(&maps, 1.0);
    assert_int_equal(maps.held_out.lights, 6);
    // the model is exact: what is left is the codebook's steps of roughness
    assert_true(maps.held_out.psnr_db > 45.0);
    CHECK_NEAR(maps.held_out.off, 0.0, 0.0);
    check_relit(&maps);
    relume_maps_destroy(&maps);
}

// A fifth of all samples is black: each is an outlier of its own.
static void shadows_are_left_out(void **state)
{
    (void)state;
    if (TEST_SANITIZED)
        skip();
    struct relume_maps maps;
    fit(&maps, LIGHTS, true);
    check_known(&maps, 1.5);
    assert_true(maps.held_out.off > 0.3);  // and said
    CHECK_NEAR(maps.held_out.shadowed, 0.2, 0.05);
    CHECK_NEAR(maps.held_out.brighter, 0.0, 0.001);
    relume_maps_destroy(&maps);
}

static void few_lights(void **state)
{
    (void)state;
    struct relume_maps maps;
    struct test_log log;
    struct stage s;
    fit(&maps, 5, false);
    assert_true(maps.matte_only);
    assert_int_equal(maps.lights, 5);
    assert_int_equal(maps.held_out.lights, 0);
    assert_true(isnan(maps.held_out.psnr_db));
    CHECK_NEAR(median(&maps.roughness, 0, 1, itself), 1.0, 0.0);
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(median(&maps.base_color, c, 1, over_base), 1.0, 0.02);
    relume_maps_destroy(&maps);
    test_log_init(&log);
    stage_open(&s, 2, false, false);
    assert_int_equal(relume_maps_fit(&maps, s.capture, relume_maps_params(.log = &log.log)),
                     RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "at least 3 lights"));
    assert_null(maps.normal.data);
    stage_close(&s);
}

static void an_empty_mask(void **state)
{
    (void)state;
    struct relume_maps maps;
    struct test_log log;
    struct stage s;
    test_log_init(&log);
    stage_open(&s, 12, false, true);
    assert_int_equal(relume_maps_fit(&maps, s.capture, relume_maps_params(.log = &log.log)),
                     RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "the mask is empty"));
    stage_close(&s);
}

// Lamps three units away, whose light falls with the square of the distance, and an eye as near:
// each pixel has lights and an eye of its own.
static void near_lamps_and_a_near_eye(void **state)
{
    (void)state;
    if (TEST_SANITIZED)
        skip();
    struct stage s = {.pictures = calloc((size_t)LIGHTS * MOST * 3, sizeof *s.pictures)};
    const vec3 eye = vec3_of(0.0, 0.0, 4.0);
    struct relume_maps maps;
    assert_non_null(s.pictures);
    for (int i = 0; i < LIGHTS; i++) {
        s.light[i] = vec3_scale(light_at(i), 3.0);
        for (int k = 0; k < MOST; k++) {
            const vec3 at = vec3_of(2.0 * (k % SIDE + 0.5) / SIDE - 1.0,
                                    1.0 - 2.0 * (k / SIDE + 0.5) / SIDE, 0.0);
            const vec3 to = vec3_sub(s.light[i], at);
            const struct paint p = paint_at(k % SIDE, k / SIDE);
            double rgb[3];
            shade(rgb, &p, normal_at(k % SIDE, k / SIDE), vec3_unit(vec3_sub(eye, at)),
                  vec3_unit(to));
            for (int c = 0; c < 3; c++)
                s.pictures[3 * ((size_t)i * MOST + (size_t)k) + (size_t)c] =
                    (float)(rgb[c] * 9.0 / vec3_dot(to, to));
        }
    }
    struct relume_manifest m = {.lights = LIGHTS, .positions = s.light};
    m.geometry = relume_geometry_default(RELUME_PLANAR, SIDE, SIDE);
    m.geometry.perspective = true;
    m.geometry.camera_z = eye.z;
    const struct relume_pictures pictures = {
        .width = SIDE, .height = SIDE, .channels = 3, .data = s.pictures};
    CHECK_OK(relume_capture_create(&s.capture, &m, &pictures, NULL));
    CHECK_OK(relume_maps_fit(&maps, s.capture, NULL));
    check_known(&maps, 1.0);
    assert_true(maps.held_out.psnr_db > 45.0);
    relume_maps_destroy(&maps);
    stage_close(&s);
}

// Photographs of dim lamps.
static void a_gain_is_found(void **state)
{
    (void)state;
    if (TEST_SANITIZED)
        skip();
    struct stage s;
    struct relume_maps maps;
    stage_open(&s, LIGHTS, false, false);
    for (size_t i = 0; i < (size_t)LIGHTS * MOST * 3; i++)
        s.pictures[i] *= 0.02f;
    CHECK_OK(relume_maps_fit(&maps, s.capture, NULL));
    assert_true(maps.gain > 15.0 && maps.gain < 80.0);
    relume_maps_destroy(&maps);
    stage_close(&s);
}

static void some_lights_of_a_capture(void **state)
{
    (void)state;
    struct stage s;
    relume_capture *some, *fewer;
    struct relume_image image, want;
    const int three[3] = {7, 2, 5}, one = 1, none = 12;
    stage_open(&s, 12, false, false);
    CHECK_OK(relume_capture_select(&some, s.capture, three, 3));
    CHECK_OK(relume_capture_select(&fewer, some, &one, 1));
    assert_int_equal(relume_capture_manifest(fewer)->lights, 1);
    CHECK_NEAR(relume_capture_manifest(fewer)->directions[0].x, s.light[2].x, 1e-12);
    CHECK_OK(relume_capture_image(&image, fewer, 0, 0, NULL));
    CHECK_OK(relume_capture_image(&want, s.capture, 0, 2, NULL));
    assert_memory_equal(image.data, want.data, MOST * 3 * sizeof(float));
    relume_image_destroy(&image);
    relume_image_destroy(&want);
    relume_capture_destroy(&fewer);
    relume_capture_destroy(&some);
    assert_int_equal(relume_capture_select(&some, s.capture, &none, 1), RELUME_EINVAL);
    assert_int_equal(relume_capture_select(&some, s.capture, three, 0), RELUME_EINVAL);
    stage_close(&s);
}

// ---------------------------------------------------------------- occlusion

enum { RELIEF = 192 };

static double free_at(double (*height)(double x, double y), double x, double y)
{
    struct relume_image image, out;
    CHECK_OK(relume_image_create(&image, RELIEF, RELIEF, 1));
    for (int k = 0; k < RELIEF * RELIEF; k++)
        image.data[k] = (float)height(k % RELIEF - RELIEF / 2, k / RELIEF - RELIEF / 2);
    CHECK_OK(relume_height_occlusion(&out, &image, 1.0, 1));
    const double found = (double)out.data[((int)y + RELIEF / 2) * RELIEF + (int)x + RELIEF / 2];
    relume_image_destroy(&image);
    relume_image_destroy(&out);
    return found;
}

static double level(double x, double y)
{
    (void)x, (void)y;
    return 3.0;
}

static double slope(double x, double y)
{
    return 0.7 * x - 0.2 * y;
}

static double wall(double x, double y)
{
    (void)y;
    return x > 0.0 ? 4.0 : 0.0;
}

static double pit(double x, double y)
{
    return hypot(x, y) > 16.0 ? 16.0 : 0.0;
}

// View factors: a plane hides nothing of its own sky; an endless wall of height H at the distance d
// hides (1 - cos atan(H / d)) / 2; a round pit of radius r and depth h leaves r^2 / (r^2 + h^2).
static void occlusion_of_known_reliefs(void **state)
{
    (void)state;
    CHECK_NEAR(free_at(level, 0.0, 0.0), 1.0, 1e-6);
    CHECK_NEAR(free_at(slope, 0.0, 0.0), 1.0, 1e-4);
    // the wall is hidden where it is further than an eighth of the picture: its ends; edges are a
    // pixel soft
    CHECK_NEAR(free_at(wall, -3.0, 0.0), 0.5 + 0.5 * cos(atan(4.0 / 4.0)), 0.02);
    // the rim stands between two pixels, and steps miss it by up to a tenth
    CHECK_NEAR(free_at(pit, 0.0, 0.0), 16.5 * 16.5 / (16.5 * 16.5 + 16.0 * 16.0), 0.04);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_painted_comes_back),
        cmocka_unit_test(shadows_are_left_out),
        cmocka_unit_test(few_lights),
        cmocka_unit_test(an_empty_mask),
        cmocka_unit_test(near_lamps_and_a_near_eye),
        cmocka_unit_test(a_gain_is_found),
        cmocka_unit_test(some_lights_of_a_capture),
        cmocka_unit_test(occlusion_of_known_reliefs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
