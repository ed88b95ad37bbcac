// Normals from relit reflectance, and the passes that use them, against closed forms
#include "format/coder/coding.h"
#include "relight/normals/enhance.h"

#include "test.h"

enum { SIDE = 24, LIGHTS = 49 };

static const float albedo[3] = {0.8f, 0.5f, 0.3f};

// A file whose table basis holds exactly the samples that it is given: [light][pixel][rgb].
struct table_file {
    relume_coder *coder;
    struct relume_codes codes;
    uint16_t *memory;
    const void **plane;
    float *scale, *offset;
    struct relume_vec3 light[LIGHTS];
};

static void make_lights(struct relume_vec3 *light)
{
    for (int i = 0; i < LIGHTS; i++) {
        const double z = 0.15 + 0.84 * (i + 0.5) / LIGHTS;
        const double phi = 2.399963229728653 * i;
        light[i] = (struct relume_vec3){sqrt(1 - z * z) * cos(phi), sqrt(1 - z * z) * sin(phi), z};
    }
}

static void make_file(struct table_file *f, const float *samples)
{
    const size_t pixels = SIDE * SIDE;
    CHECK_OK(relume_coder_create(&f->coder, &relume_basis_table, f->light, LIGHTS,
                                 relume_coder_params(.hemispherical = true)));
    const struct relume_coder_info *info = relume_coder_info(f->coder);
    assert_int_equal(info->coefficients, LIGHTS);
    f->memory = calloc(3 * LIGHTS * pixels, sizeof *f->memory);
    f->plane = calloc(3 * LIGHTS, sizeof *f->plane);
    f->scale = calloc(3 * LIGHTS, sizeof *f->scale);
    f->offset = calloc(3 * LIGHTS, sizeof *f->offset);
    for (int k = 0; k < LIGHTS; k++)
        for (int c = 0; c < 3; c++) {
            const int p = relume_coder_plane(info, k, c);
            uint16_t *plane = f->memory + (size_t)p * pixels;
            f->plane[p] = plane;
            f->scale[p] = 4.0f / 65535;
            for (size_t i = 0; i < pixels; i++)
                plane[i] =
                    (uint16_t)lrintf(samples[3 * ((size_t)k * pixels + i) + (size_t)c] * 65535 / 4);
        }
    f->codes = (struct relume_codes){
        .coder = f->coder,
        .domain = RELUME_DOMAIN_LINEAR,
        .width = SIDE,
        .height = SIDE,
        .planes = 3 * LIGHTS,
        .storage = RELUME_STORE_16,
        .plane = f->plane,
        .scale = f->scale,
        .offset = f->offset,
    };
}

static void free_file(struct table_file *f)
{
    relume_coder_destroy(&f->coder);
    free(f->memory);
    free(f->plane);
    free(f->scale);
    free(f->offset);
}

// The front of a sphere, out to 60 degrees.
static struct relume_vec3 sphere_normal(int pixel)
{
    const double reach = sin(M_PI / 3) / sqrt(2);
    const double x = reach * (2 * (pixel % SIDE + 0.5) / SIDE - 1);
    const double y = reach * (1 - 2 * (pixel / SIDE + 0.5) / SIDE);
    return (struct relume_vec3){x, y, sqrt(1 - x * x - y * y)};
}

// Lambertian, with shadows thrown on every fifth sample and, where asked for, a narrow highlight.
static float *make_samples(const struct relume_vec3 *light, bool spoiled)
{
    const size_t pixels = SIDE * SIDE;
    float *samples = calloc(3 * LIGHTS * pixels, sizeof *samples);
    uint32_t random = 5;
    for (int k = 0; k < LIGHTS; k++)
        for (size_t i = 0; i < pixels; i++) {
            const struct relume_vec3 n = sphere_normal((int)i);
            const struct relume_vec3 h = {light[k].x, light[k].y, light[k].z + 1};
            const bool shadow = spoiled && test_random(&random) % 5 == 0;
            const double lobe =
                spoiled ? pow(fmax(vec3_dot(n, h) / sqrt(vec3_dot(h, h)), 0), 200) : 0;
            for (int c = 0; c < 3; c++)
                samples[3 * ((size_t)k * pixels + i) + (size_t)c] =
                    shadow ? 0.01f : (float)(albedo[c] * fmax(vec3_dot(n, light[k]), 0) + lobe);
        }
    return samples;
}

static double worst_degrees(const struct relume_normals *normals, double *median)
{
    double angle[SIDE * SIDE], most = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float *g = normals->normal.data + 3 * i;
        const struct relume_vec3 got = {(double)g[0], (double)g[1], (double)g[2]};
        CHECK_NEAR(vec3_dot(got, got), 1.0, 1e-5);
        angle[i] = acos(fmin(vec3_dot(got, sphere_normal(i)), 1.0)) * 180 / M_PI;
        most = fmax(most, angle[i]);
    }
    for (int i = 0; i < SIDE * SIDE; i++)  // a short sort
        for (int k = i + 1; k < SIDE * SIDE; k++)
            if (angle[k] < angle[i]) {
                const double keep = angle[i];
                angle[i] = angle[k];
                angle[k] = keep;
            }
    *median = angle[SIDE * SIDE / 2];
    return most;
}

static void fit(struct relume_normals *out, bool spoiled, bool plain, int threads)
{
    struct table_file f;
    make_lights(f.light);
    float *samples = make_samples(f.light, spoiled);
    make_file(&f, samples);
    CHECK_OK(relume_normals_fit(out, &f.codes,
                                relume_normals_params(.plain = plain, .threads = threads)));
    free_file(&f);
    free(samples);
}

// Attached shadows are weighed zero, so that the only error is that of 16-bit codes: 3e-5 of
// samples up to 0.8, some 0.01 degrees.
static void a_matt_sphere_is_exact(void **state)
{
    (void)state;
    struct relume_normals n;
    double median;
    fit(&n, false, false, 0);
    const double worst = worst_degrees(&n, &median);
    print_message("  worst %.4f, median %.4f degrees\n", worst, median);
    assert_true(worst < 0.05);
    for (int i = 0; i < SIDE * SIDE; i++)
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(n.albedo.data[3 * i + c], albedo[c], 1e-3);
    relume_normals_destroy(&n);
}

// A fifth of the samples in shadow and a highlight: the fit stays within a degree, where plain
// least squares is off by several.
static void shadows_and_highlights_are_outvoted(void **state)
{
    (void)state;
    struct relume_normals robust, plain;
    double median, plain_median;
    fit(&robust, true, false, 0);
    fit(&plain, true, true, 0);
    const double worst = worst_degrees(&robust, &median);
    (void)worst_degrees(&plain, &plain_median);
    print_message("  worst %.3f, median %.3f; plain median %.3f degrees\n", worst, median,
                  plain_median);
    assert_true(median < 0.2);
    assert_true(plain_median > 3);
    relume_normals_destroy(&robust);
    relume_normals_destroy(&plain);
}

// Glazed all over: a wide highlight that the matte fit takes for shape. Tiles one below the other
// make it large enough that not every pixel is solved.
static struct relume_normals fit_glazed(struct relume_vec3 eye, int tiles, int threads, int spoiled)
{
    const size_t pixels = SIDE * SIDE;
    struct table_file f;
    make_lights(f.light);
    float *samples = make_samples(f.light, false);
    for (int k = 0; k < LIGHTS; k++)
        for (size_t i = 0; i < pixels; i++) {
            const struct relume_vec3 n = sphere_normal((int)i);
            const struct relume_vec3 h =
                vec3_unit((struct relume_vec3){f.light[k].x, f.light[k].y, f.light[k].z + 1});
            const double lobe =
                vec3_dot(n, f.light[k]) > 0 ? 0.6 * pow(fmax(vec3_dot(n, h), 0), 12) : 0;
            for (size_t c = 0; c < 3; c++) {
                float *const to = samples + 3 * ((size_t)k * pixels + i) + c;
                *to = (int)i == spoiled && f.light[k].x > 0.3 ? 0.0f : *to + (float)lobe;
            }
        }
    make_file(&f, samples);
    uint16_t *tiled = calloc(3 * LIGHTS * pixels * (size_t)tiles, sizeof *tiled);
    for (size_t p = 0; p < 3 * LIGHTS; p++) {
        for (size_t t = 0; t < (size_t)tiles; t++)
            memcpy(tiled + (p * (size_t)tiles + t) * pixels, f.plane[p], pixels * sizeof *tiled);
        f.plane[p] = tiled + p * (size_t)tiles * pixels;
    }
    f.codes.height = SIDE * tiles;
    struct relume_normals n;
    CHECK_OK(
        relume_normals_fit(&n, &f.codes, relume_normals_params(.eye = eye, .threads = threads)));
    free_file(&f);
    free(samples);
    free(tiled);
    return n;
}

static double degrees_off(const struct relume_normals *n, size_t pixel)
{
    const float *g = n->normal.data + 3 * pixel;
    const struct relume_vec3 got = {(double)g[0], (double)g[1], (double)g[2]};
    return acos(fmin(vec3_dot(got, sphere_normal((int)(pixel % (SIDE * SIDE)))), 1.0)) * 180 / M_PI;
}

static double glazed_error(struct relume_vec3 eye, int tiles, int threads)
{
    struct relume_normals n = fit_glazed(eye, tiles, threads, -1);
    const size_t pixels = SIDE * SIDE * (size_t)tiles;
    double sum = 0.0;
    for (size_t i = 0; i < pixels; i++)
        sum += degrees_off(&n, i);
    relume_normals_destroy(&n);
    return sum / (double)pixels;
}

// A pixel that is solved, half in shadow: the pixels between it and the next that are solved, which
// no shadow falls on, keep their normals. These are 0.5 to 1.2 degrees off without the shadow too.
static void a_pixel_solved_wrongly_dents_nothing(void **state)
{
    (void)state;
    enum { AT = 12 * SIDE + 12, TILES = 29 };  // every second pixel is solved
    static const int around[] = {AT - 1, AT + 1, AT - SIDE, AT + SIDE};
    struct relume_normals n = fit_glazed((struct relume_vec3){0, 0, 2}, TILES, 2, AT);
    for (int i = 0; i < 4; i++) {
        const size_t at = SIDE * SIDE * (TILES / 2) + (size_t)around[i];
        print_message("  %.2f degrees beside a shadow\n", degrees_off(&n, at));
        assert_true(degrees_off(&n, at) < 1.3);
    }
    relume_normals_destroy(&n);
}

static void a_known_eye_tells_gloss_from_shape(void **state)
{
    (void)state;
    const struct relume_vec3 above = {0, 0, 2}, unknown = {0, 0, 0};
    const double matte = glazed_error(unknown, 1, 0), known = glazed_error(above, 1, 1);
    const double large = TEST_SANITIZED ? known : glazed_error(above, 40, 2);
    print_message("  matte %.3f, with the eye known %.3f; large %.3f degrees\n", matte, known,
                  large);
    assert_true(matte > 2.0);
    assert_true(known < 0.5 * matte);
    assert_true(large < 0.5 * matte);
    assert_true(TEST_SANITIZED || known == glazed_error(above, 1, 3));
}

static void threads_make_no_difference(void **state)
{
    (void)state;
    struct relume_normals one, seven;
    fit(&one, true, false, 1);
    fit(&seven, true, false, 7);
    const size_t bytes = 3 * SIDE * SIDE * sizeof(float);
    assert_memory_equal(one.normal.data, seven.normal.data, bytes);
    assert_memory_equal(one.albedo.data, seven.albedo.data, bytes);
    relume_normals_destroy(&one);
    relume_normals_destroy(&seven);
}

static void black_pixels_have_no_normal(void **state)
{
    (void)state;
    struct table_file f;
    struct relume_normals n;
    make_lights(f.light);
    float *samples = calloc(3 * LIGHTS * SIDE * SIDE, sizeof *samples);
    make_file(&f, samples);
    CHECK_OK(relume_normals_fit(&n, &f.codes, NULL));
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        assert_true(n.normal.data[i] == 0 && n.albedo.data[i] == 0);
    relume_normals_destroy(&n);
    free_file(&f);
    free(samples);
}

// Lights in one plane say nothing of the slope across it.
static void lights_in_a_plane_are_refused(void **state)
{
    (void)state;
    struct test_log log;
    struct relume_vec3 light[8];
    relume_coder *coder;
    struct relume_normals n;
    test_log_init(&log);
    for (int i = 0; i < 8; i++)
        light[i] = (struct relume_vec3){sin(0.1 * i), 0, cos(0.1 * i)};
    CHECK_OK(relume_coder_create(&coder, &relume_basis_table, light, 8,
                                 relume_coder_params(.hemispherical = true)));
    const struct relume_codes codes = {.coder = coder, .width = 4, .height = 4};
    assert_int_equal(relume_normals_fit(&n, &codes, relume_normals_params(.log = &log.log)),
                     RELUME_EUNFIT);
    assert_int_equal(log.lines, 1);
    assert_null(n.normal.data);
    relume_coder_destroy(&coder);
}

// ---------------------------------------------------------------- passes

struct scene {
    struct relume_normals normals;
    struct relume_image image;
    struct relume_light light;
};

static struct scene make_scene(void)
{
    struct scene s = {.light = {.direction = {0, 0, 2}, .rgb = {1, 2, 0.5f}}};
    CHECK_OK(relume_image_create(&s.normals.normal, 8, 4, 3));
    CHECK_OK(relume_image_create(&s.normals.albedo, 8, 4, 3));
    CHECK_OK(relume_image_create(&s.image, 8, 4, 3));
    for (int i = 0; i < 32; i++) {
        s.normals.normal.data[3 * i] = i % 8 < 4 ? 0.6f : -0.6f;
        s.normals.normal.data[3 * i + 2] = 0.8f;
        for (int c = 0; c < 3; c++) {
            s.normals.albedo.data[3 * i + c] = 0.5f;
            s.image.data[3 * i + c] = 0.5f * 0.8f * s.light.rgb[c];
        }
    }
    return s;
}

static void free_scene(struct scene *s)
{
    relume_normals_destroy(&s->normals);
    relume_image_destroy(&s->image);
}

static void apply(struct scene *s, enum relume_pass pass, const struct relume_pass_params *params)
{
    CHECK_OK(relume_pass_apply(&s->image, pass, &s->normals, &s->light, 1, params));
}

// The half vector is +z itself: cosine 0.8.
static void a_highlight_is_added(void **state)
{
    (void)state;
    struct scene s = make_scene();
    apply(&s, RELUME_PASS_SPECULAR,
          relume_pass_params(.fixed = true, .specular = 0.25f, .exponent = 10));
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(s.image.data[c], s.light.rgb[c] * (0.4 + 0.25 * pow(0.8, 10)), 1e-6);
    free_scene(&s);
}

// f + (g - 1)(f - albedo): 0.4 is 0.1 below the albedo of 0.5, three times that is 0.3.
static void diffuse_gain_keeps_the_maximum(void **state)
{
    (void)state;
    struct scene s = make_scene();
    apply(&s, RELUME_PASS_DIFFUSE_GAIN, relume_pass_params(.fixed = true, .gain = 3));
    CHECK_NEAR(s.image.data[0], 0.2, 1e-6);
    CHECK_NEAR(s.image.data[1], 0.4, 1e-6);
    for (int i = 0; i < 96; i++)  // where the surface faces the light nothing changes
        s.image.data[i] = s.normals.albedo.data[i] * s.light.rgb[i % 3];
    apply(&s, RELUME_PASS_DIFFUSE_GAIN, relume_pass_params(.fixed = true, .gain = 3));
    CHECK_NEAR(s.image.data[1], 1.0, 1e-6);
    free_scene(&s);
}

// A step from +0.6 to -0.6 in the middle of eight columns; the mean over three rows and columns.
static void unsharp_exaggerates_detail(void **state)
{
    (void)state;
    struct scene s = make_scene();
    struct relume_image detail;
    CHECK_OK(relume_normals_detail(&detail, &s.normals.normal, 1, 2));
    CHECK_NEAR(detail.data[3 * 1], 0, 1e-6);
    CHECK_NEAR(detail.data[3 * 3], 0.4, 1e-6);
    CHECK_NEAR(detail.data[3 * 4], -0.4, 1e-6);
    CHECK_NEAR(detail.data[3 * 3 + 2], 0, 1e-6);
    relume_image_destroy(&detail);
    s.light.direction = (struct relume_vec3){1, 0, 0};
    apply(&s, RELUME_PASS_UNSHARP, relume_pass_params(.gain = 0.5f, .radius = 1));
    CHECK_NEAR(s.image.data[3 * 3], 0.4 + 0.5 * 0.5 * 0.4, 1e-6);
    CHECK_NEAR(s.image.data[3 * 4 + 1], 0.8 - 2 * 0.5 * 0.5 * 0.4, 1e-6);
    free_scene(&s);
}

static void luminance_and_false_colour(void **state)
{
    (void)state;
    struct scene s = make_scene();
    const double y = 0.4 * (0.2126 * 1 + 0.7152 * 2 + 0.0722 * 0.5);
    apply(&s, RELUME_PASS_LUMINANCE, NULL);
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(s.image.data[c], y, 1e-6);
    double before = -1;
    for (int i = 0; i <= 20; i++) {  // lighter and lighter
        for (int c = 0; c < 3; c++)
            s.image.data[c] = (float)(i / 20.0);
        apply(&s, RELUME_PASS_FALSE_COLOUR, relume_pass_params(.fixed = true));
        const double lightness = 0.2126 * (double)s.image.data[0] +
                                 0.7152 * (double)s.image.data[1] +
                                 0.0722 * (double)s.image.data[2];
        assert_true(lightness > before);
        before = lightness;
    }
    CHECK_NEAR(s.image.data[0], 1.0, 1e-6);
    free_scene(&s);
}

// A picture of shading f from 0.02 to 0.2 of its albedo of 0.5: as dark as a coin under a raking
// light.
static struct scene make_dark_scene(void)
{
    struct scene s = {.light = {.direction = {0, 0, 1}, .rgb = {1, 1, 1}}};
    CHECK_OK(relume_image_create(&s.normals.normal, 50, 20, 3));
    CHECK_OK(relume_image_create(&s.normals.albedo, 50, 20, 3));
    CHECK_OK(relume_image_create(&s.image, 50, 20, 3));
    for (int i = 0; i < 1000; i++)
        for (int c = 0; c < 3; c++) {
            s.normals.albedo.data[3 * i + c] = 0.5f;
            s.image.data[3 * i + c] = 0.5f * (0.02f + 0.18f * (float)i / 999);
        }
    return s;
}

// By the maximum alone all of it would be black: 2 f - 0.5 < 0.
static void diffuse_gain_suits_the_picture(void **state)
{
    (void)state;
    struct scene s = make_dark_scene();
    apply(&s, RELUME_PASS_DIFFUSE_GAIN, NULL);
    int black = 0;
    for (int i = 0; i < 1000; i++)
        black += s.image.data[3 * i] <= 0;
    assert_true(black > 20 && black < 60);  // a twentieth
    CHECK_NEAR(s.image.data[3 * 989], 0.5 * (0.02 + 0.18 * 989 / 999),
               1e-4);  // as bright as it was
    double before = -1;
    for (int i = 100; i < 1000; i += 50) {
        assert_true((double)s.image.data[3 * i] > before);
        before = (double)s.image.data[3 * i];
    }
    free_scene(&s);
}

// A twentieth is darker than 0.029, so what stays as it is is 0.058 of the full shading; black is
// what is below 0.058 (1 - 1 / gain).
static void a_larger_gain_shows_more(void **state)
{
    (void)state;
    static const float gain[] = {1.5f, 5, 20};
    for (int g = 0; g < 3; g++) {
        struct scene s = make_dark_scene();
        apply(&s, RELUME_PASS_DIFFUSE_GAIN, relume_pass_params(.gain = gain[g]));
        int black = 0;
        for (int i = 0; i < 1000; i++)
            black += s.image.data[3 * i] <= 0;
        const double share = (0.058 * (1 - 1 / (double)gain[g]) - 0.02) / 0.18;
        CHECK_NEAR(black, 1000 * fmax(share, 0), 2);  // percentiles are those of pixels
        free_scene(&s);
    }
}

static void false_colour_suits_the_picture(void **state)
{
    (void)state;
    struct scene s = make_dark_scene();
    struct relume_pass_range r;
    for (int i = 0; i < 500; i++)  // a background does not count
        memset(s.image.data + 3 * i, 0, 3 * sizeof(float));
    CHECK_OK(relume_pass_measure(&r, &s.image, RELUME_PASS_FALSE_COLOUR, NULL, &s.light, 1, 0));
    CHECK_NEAR(r.low, 0.5 * (0.02 + 0.18 * 505 / 999), 1e-3);
    CHECK_NEAR(r.high, 0.5 * (0.02 + 0.18 * 994 / 999), 1e-3);
    assert_true(r.pivot == 1 && r.scale == 1);
    struct relume_image fixed = {0};
    CHECK_OK(relume_image_create(&fixed, 50, 20, 3));
    memcpy(fixed.data, s.image.data, 3000 * sizeof(float));
    apply(&s, RELUME_PASS_FALSE_COLOUR, NULL);
    CHECK_NEAR(s.image.data[3 * 999], 1.0, 1e-6);       // yellow
    CHECK_NEAR(s.image.data[3 * 500 + 2], 0.10, 0.02);  // dark blue
    for (int i = 0; i < 3 * 500; i++)                   // the background
        CHECK_NEAR(s.image.data[i], 0.0, 0.0);
    CHECK_OK(relume_pass_apply(&fixed, RELUME_PASS_FALSE_COLOUR, NULL, NULL, 0,
                               relume_pass_params(.low = r.low, .top = r.high)));
    for (int i = 0; i < 3000; i++)
        CHECK_NEAR(fixed.data[i], s.image.data[i], 1e-6);
    relume_image_destroy(&fixed);
    // nothing, or one value: no division by zero
    for (int i = 0; i < 3000; i++)
        s.image.data[i] = 0;
    CHECK_OK(relume_pass_measure(&r, &s.image, RELUME_PASS_DIFFUSE_GAIN, &s.normals.albedo,
                                 &s.light, 1, 0));
    assert_true(r.high > r.low && r.pivot == 1 && r.scale == 1);
    for (int i = 0; i < 3000; i++)
        s.image.data[i] = 0.25f;
    CHECK_OK(relume_pass_measure(&r, &s.image, RELUME_PASS_FALSE_COLOUR, NULL, &s.light, 1, 0));
    CHECK_NEAR(0.5 * (double)(r.low + r.high), 0.25, 1e-6);
    free_scene(&s);
}

// The highlight is as much brighter than a dark picture as than a bright one.
static void a_highlight_suits_the_picture(void **state)
{
    (void)state;
    struct scene s = make_scene();
    const double high = 0.4 * (0.2126 * 1 + 0.7152 * 2 + 0.0722 * 0.5);
    apply(&s, RELUME_PASS_SPECULAR, relume_pass_params(.specular = 0.25f, .exponent = 10));
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(s.image.data[c], s.light.rgb[c] * (0.4 + high * 0.25 * pow(0.8, 10)), 1e-6);
    free_scene(&s);
}

static void differences_and_wrong_sizes(void **state)
{
    (void)state;
    struct scene s = make_scene();
    struct relume_image other, small;
    CHECK_OK(relume_image_create(&other, 8, 4, 3));
    CHECK_OK(relume_image_create(&small, 4, 4, 3));
    other.data[1] = 1.0f;
    apply(&s, RELUME_PASS_DIFFERENCE, relume_pass_params(.reference = &other));
    CHECK_NEAR(s.image.data[0], 0.4, 1e-6);
    CHECK_NEAR(s.image.data[1], 0.2, 1e-6);
    assert_int_equal(relume_pass_apply(&s.image, RELUME_PASS_DIFFERENCE, NULL, NULL, 0,
                                       relume_pass_params(.reference = &small)),
                     RELUME_EINVAL);
    assert_int_equal(relume_pass_apply(&s.image, RELUME_PASS_DIFFERENCE, NULL, NULL, 0, NULL),
                     RELUME_EINVAL);
    assert_int_equal(relume_pass_apply(&small, RELUME_PASS_NORMALS, &s.normals, NULL, 0, NULL),
                     RELUME_EINVAL);
    assert_int_equal(relume_pass_apply(&s.image, RELUME_PASS_UNSHARP, NULL, NULL, 0, NULL),
                     RELUME_EINVAL);
    relume_image_destroy(&other);
    relume_image_destroy(&small);
    free_scene(&s);
}

static void passes_have_names(void **state)
{
    (void)state;
    for (int i = 0; i < RELUME_PASSES; i++) {
        enum relume_pass pass;
        CHECK_OK(relume_pass_parse(&pass, relume_pass_name((enum relume_pass)i)));
        assert_int_equal(pass, i);
    }
    enum relume_pass ignored;
    assert_int_equal(relume_pass_parse(&ignored, "normal"), RELUME_EINVAL);
    assert_null(relume_pass_name(RELUME_PASSES));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_matt_sphere_is_exact),
        cmocka_unit_test(shadows_and_highlights_are_outvoted),
        cmocka_unit_test(a_known_eye_tells_gloss_from_shape),
        cmocka_unit_test(a_pixel_solved_wrongly_dents_nothing),
        cmocka_unit_test(threads_make_no_difference),
        cmocka_unit_test(black_pixels_have_no_normal),
        cmocka_unit_test(lights_in_a_plane_are_refused),
        cmocka_unit_test(a_highlight_is_added),
        cmocka_unit_test(diffuse_gain_keeps_the_maximum),
        cmocka_unit_test(unsharp_exaggerates_detail),
        cmocka_unit_test(luminance_and_false_colour),
        cmocka_unit_test(diffuse_gain_suits_the_picture),
        cmocka_unit_test(a_larger_gain_shows_more),
        cmocka_unit_test(false_colour_suits_the_picture),
        cmocka_unit_test(a_highlight_suits_the_picture),
        cmocka_unit_test(differences_and_wrong_sizes),
        cmocka_unit_test(passes_have_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
