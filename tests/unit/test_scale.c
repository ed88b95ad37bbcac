// What a pixel covers: means against sums over a hundred rays, closed forms, and no cost elsewhere
#include "test.h"

#include "core/math/vec.h"
#include "image/image/footprint.h"
#include "relight/view/view.h"

#include <relume/image.h>
#include <relume/relight/view.h>

static double uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

static struct relume_image make(int width, int height)
{
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, width, height, 3));
    return image;
}

static struct relume_image noise(int width, int height)
{
    struct relume_image image = make(width, height);
    uint64_t random = 5;
    for (int i = 0; i < 3 * width * height; i++)
        image.data[i] = (float)uniform(&random);
    return image;
}

static double psnr(const struct relume_image *a, const struct relume_image *b)
{
    const size_t n = 3 * (size_t)a->width * (size_t)a->height;
    double sum = 0.0;
    assert_true(a->width == b->width && a->height == b->height);
    for (size_t i = 0; i < n; i++)
        sum += pow((double)a->data[i] - (double)b->data[i], 2);
    return sum > 0.0 ? -10.0 * log10(sum / (double)n) : 200.0;
}

// ---------------------------------------------------------------- samples

static void samples_have_the_variance_of_the_texels(void **state)
{
    (void)state;
    double before = 0.0;
    for (double texels = 0.9; texels < 9.0; texels += 0.05) {
        const struct footprint f = footprint_of(texels, 64);
        double sum = 0.0, square = 0.0;
        for (int i = 0; i < f.count; i++) {
            const double at = footprint_place(f, i) * texels;
            sum += at / f.count;
            square += at * at / f.count;
        }
        CHECK_NEAR(sum, 0, 1e-12);
        assert_true(square >= before);                 // and so never jump
        assert_true(square - before < 0.02 * texels);  // 0.05 r / 6, twice that below 2
        before = square;
        if (texels >= 2) {
            assert_int_equal(f.count, (int)ceil(texels - 1e-6));
            CHECK_NEAR(square, (texels * texels - 1) / 12, 1e-12);
        }
        assert_true(f.step * texels <= 1 + 1e-12);  // no texel is stepped over
    }
    assert_int_equal(footprint_of(1.25, 64).count, 1);
    assert_int_equal(footprint_of(1.26, 64).count, 2);
    assert_int_equal(footprint_of(1e9, 64).count, 64);
    assert_int_equal(footprint_of(NAN, 64).count, 1);
}

// ---------------------------------------------------------------- pictures

static void a_whole_share_is_the_mean(void **state)
{
    (void)state;
    struct relume_image fine = noise(60, 35), got;
    CHECK_OK(relume_image_scale(&got, &fine, 12, 7, NULL));
    for (int y = 0; y < 7; y++)
        for (int x = 0; x < 12; x++)
            for (int c = 0; c < 3; c++) {
                double sum = 0.0;
                for (int k = 0; k < 25; k++)
                    sum += (double)fine.data[3 * ((5 * y + k / 5) * 60 + 5 * x + k % 5) + c];
                CHECK_NEAR(got.data[3 * (y * 12 + x) + c], sum / 25, 1e-6);  // floats are added
            }
    relume_image_destroy(&got);
    CHECK_OK(relume_image_scale(&got, &fine, 60, 35, NULL));
    assert_memory_equal(got.data, fine.data, 3 * 60 * 35 * sizeof *got.data);
    relume_image_destroy(&got);
    relume_image_destroy(&fine);
}

// Light is added, not codes: black and white squares become half the light.
static void a_chequer_becomes_its_mean(void **state)
{
    (void)state;
    static const int sizes[][2] = {{100, 100}, {77, 50}, {31, 99}, {10, 3}};
    struct relume_image chequer = make(200, 200), got;
    for (int i = 0; i < 3 * 200 * 200; i++)
        chequer.data[i] = (float)((i / 3 / 200 + i / 3) % 2);
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        CHECK_OK(relume_image_scale(&got, &chequer, sizes[k][0], sizes[k][1], NULL));
        // bilinear samples a texel and less apart leave at most 1 / n^2 of a square's contrast, n
        // to a side and 2 at least
        for (int i = 0; i < 3 * sizes[k][0] * sizes[k][1]; i++)
            CHECK_NEAR(got.data[i], 0.5, 0.5 / 4 + 1e-6);
        double sum = 0.0;
        for (int i = 0; i < 3 * sizes[k][0] * sizes[k][1]; i++)
            sum += (double)got.data[i] / (3 * sizes[k][0] * sizes[k][1]);
        CHECK_NEAR(sum, 0.5, 0.01);
        relume_image_destroy(&got);
    }
    relume_image_destroy(&chequer);
}

// Catmull-Rom reproduces quadratics, bilinear does not; neither leaves the range of the texels.
static void enlarging_is_smooth_and_stays_in_range(void **state)
{
    (void)state;
    struct relume_image parabola = make(16, 16), step = make(16, 16), got;
    for (int i = 0; i < 16 * 16; i++)
        for (int c = 0; c < 3; c++) {
            const double x = i % 16 + 0.5, y = i / 16 + 0.5;
            parabola.data[3 * i + c] = (float)(0.1 * x * x + 0.05 * x * y - 0.2 * y);
            step.data[3 * i + c] = i % 16 < 8 ? 0 : 100;
        }
    for (int k = 0; k < 2; k++) {
        const enum relume_filter filter = k ? RELUME_FILTER_CUBIC : RELUME_FILTER_LINEAR;
        double worst = 0.0;
        CHECK_OK(
            relume_image_scale(&got, &parabola, 64, 64, relume_scale_params(.filter = filter)));
        for (int i = 0; i < 64 * 64; i++) {
            const double x = (i % 64 + 0.5) / 4, y = (i / 64 + 0.5) / 4;
            if (x < 3 || y < 3 || x > 13 || y > 13)  // the border repeats, the vertex is held
                continue;
            worst =
                fmax(worst, fabs((double)got.data[3 * i] - (0.1 * x * x + 0.05 * x * y - 0.2 * y)));
        }
        if (k)
            CHECK_NEAR(worst, 0, 1e-5);
        else
            assert_true(worst > 0.01);  // a parabola's sagitta, 0.1 / 4 at most
        relume_image_destroy(&got);
        CHECK_OK(relume_image_scale(&got, &step, 61, 40, relume_scale_params(.filter = filter)));
        for (int i = 0; i < 3 * 61 * 40; i++)  // weights are rounded to floats
            assert_true(got.data[i] >= 0 && got.data[i] <= 100.0001f);
        relume_image_destroy(&got);
    }
    CHECK_OK(relume_image_scale(&got, &step, 61, 40,
                                relume_scale_params(.filter = RELUME_FILTER_NEAREST)));
    for (int i = 0; i < 3 * 61 * 40; i++)
        assert_true(got.data[i] == 0 || got.data[i] == 100);
    relume_image_destroy(&got);
    relume_image_destroy(&step);
    relume_image_destroy(&parabola);
}

static void borders_wrap_or_keep_to_their_tile(void **state)
{
    (void)state;
    struct relume_image image = make(12, 2), got;
    for (int i = 0; i < 12 * 2; i++)
        image.data[3 * i] = (float)(i % 12 / 2);  // six tiles of two texels
    CHECK_OK(relume_image_scale(&got, &image, 60, 2, relume_scale_params(.tiles = 6)));
    for (int x = 0; x < 60; x++)
        CHECK_NEAR(got.data[3 * x], x / 10, 0);
    relume_image_destroy(&got);
    CHECK_OK(relume_image_scale(&got, &image, 24, 2, relume_scale_params(.wrap = true)));
    CHECK_NEAR(got.data[0], 0.25 * 5, 1e-6);  // a quarter of a texel before the first centre
    relume_image_destroy(&got);
    assert_int_equal(relume_image_scale(&got, &image, 0, 2, NULL), RELUME_EINVAL);
    assert_int_equal(relume_image_scale(&got, &image, 6, 2, relume_scale_params(.tiles = 13)),
                     RELUME_EINVAL);
    relume_image_destroy(&image);
}

// ---------------------------------------------------------------- panoramas

enum { SPHERE_W = 512, SPHERE_H = 256, RAYS = 24 };
static const struct relume_geometry sphere = {.projection = RELUME_SPHERICAL};

// The mean over RAYS x RAYS rays of every pixel: of the picture between its texels.
static struct relume_image panorama_reference(const struct relume_geometry *g,
                                              const struct relume_image *image,
                                              struct relume_pan_tilt look, int width, int height)
{
    struct relume_image out = make(width, height);
    for (int i = 0; i < width * height; i++)
        for (int k = 0; k < RAYS * RAYS; k++) {
            float rgb[3];
            const double x = i % width + (k % RAYS + 0.5) / RAYS;
            const double y = i / width + (k / RAYS + 0.5) / RAYS;
            (void)relume_panorama_sample(rgb, g, image,
                                         relume_pan_tilt_ray(look, width, height, x, y), NULL);
            for (int c = 0; c < 3; c++)
                out.data[3 * i + c] += rgb[c] / (RAYS * RAYS);
        }
    return out;
}

// A picture as photographs are: large shapes, fine texture, sharp edges, a small bright lamp.
static struct relume_image scene(const struct relume_geometry *g, int width, int height)
{
    struct relume_image image = make(width, height);
    uint64_t random = 9;
    for (int i = 0; i < width * height; i++) {
        const vec3 d = relume_panorama_ray(g, width, height, i % width + 0.5, i / width + 0.5);
        const bool dark = sin(9 * d.x) * sin(11 * d.y + 1) * sin(10 * d.z) > 0;
        const double lamp = vec3_length(vec3_sub(d, vec3_of(0, 0.3, -0.954))) < 0.05 ? 3 : 0;
        for (int c = 0; c < 3; c++)
            image.data[3 * i + c] =
                (float)((dark ? 0.1 : 0.5 + 0.1 * c) + 0.3 * uniform(&random) + lamp);
    }
    return image;
}

static void compare_look(const char *name, const struct relume_geometry *g,
                         const struct relume_image *image, struct relume_pan_tilt look, int width,
                         double least)
{
    const int height = width / 2;
    struct relume_image got = make(width, height), one = make(width, height);
    struct relume_image want = panorama_reference(g, image, look, width, height);
    CHECK_OK(relume_panorama_frame(&got, g, image, look, NULL));
    CHECK_OK(relume_panorama_frame(&one, g, image, look, relume_view_params(.one = true)));
    const double with = psnr(&got, &want), without = psnr(&one, &want);
    print_message("%s: %.1f dB of the mean, one ray %.1f dB\n", name, with, without);
    assert_true(with > least);
    assert_true(with > without + 6);
    relume_image_destroy(&got);
    relume_image_destroy(&one);
    relume_image_destroy(&want);
}

// A box of r texels through r samples a texel apart differs from the mean over all of the pixel by
// the samples' tents: some percent of a texel's contrast over r.
static void reduced_looks_are_means(void **state)
{
    (void)state;
    static const struct relume_geometry cube = {.projection = RELUME_CUBE},
                                        cylinder = {.projection = RELUME_CYLINDRICAL,
                                                    .v_min = -1.2,
                                                    .v_max = 1.2},
                                        discs = {.projection = RELUME_CYLINDRICAL,
                                                 .v_min = -1,
                                                 .v_max = 1,
                                                 .disc = 160};
    const struct relume_pan_tilt ahead = {.pan_deg = 20, .tilt_deg = 5, .zoom = 1};
    const struct relume_pan_tilt up = {.pan_deg = 40, .tilt_deg = 60, .zoom = 0.8};
    const struct relume_pan_tilt wide = {.pan_deg = 20, .zoom = 0.35};
    const struct relume_pan_tilt planet = {.tilt_deg = -90, .zoom = 0.5, .stereographic = true};
    struct relume_image image = scene(&sphere, SPHERE_W, SPHERE_H);
    compare_look("sphere, a quarter", &sphere, &image, ahead, 32, 38);
    compare_look("sphere, half", &sphere, &image, ahead, 64, 34);
    compare_look("sphere, wide", &sphere, &image, wide, 64, 34);
    compare_look("sphere, planet", &sphere, &image, planet, 64, 30);
    relume_image_destroy(&image);
    image = scene(&cube, 6 * 128, 128);
    compare_look("cube", &cube, &image, up, 32, 36);
    relume_image_destroy(&image);
    image = scene(&cylinder, 512, 200);
    compare_look("cylinder", &cylinder, &image, ahead, 32, 36);
    relume_image_destroy(&image);
    image = scene(&discs, 512, 160 + 160);
    compare_look("cylinder with discs", &discs, &image, up, 32, 36);
    relume_image_destroy(&image);
}

// Enlarged, each pixel is one ray, bit by bit.
static void enlarged_looks_are_single_rays(void **state)
{
    (void)state;
    struct relume_image image = scene(&sphere, 128, 64);
    struct relume_image a = make(80, 40), b = make(80, 40);
    const struct relume_pan_tilt look = {.pan_deg = -100, .tilt_deg = -20, .zoom = 4};
    CHECK_OK(relume_panorama_frame(&a, &sphere, &image, look, NULL));
    CHECK_OK(relume_panorama_frame(&b, &sphere, &image, look, relume_view_params(.one = true)));
    assert_memory_equal(a.data, b.data, 3 * 80 * 40 * sizeof *a.data);
    CHECK_OK(relume_panorama_frame(&b, &sphere, &image, look,
                                   relume_view_params(.filter = RELUME_FILTER_NEAREST)));
    for (int i = 0; i < 3 * 80 * 40; i += 3) {
        bool found = false;  // some texel's
        for (int k = 0; !found && k < 3 * 128 * 64; k += 3)
            found = !memcmp(&image.data[k], &b.data[i], 3 * sizeof *b.data);
        assert_true(found);
    }
    relume_image_destroy(&image);
    relume_image_destroy(&a);
    relume_image_destroy(&b);
}

// Directions are smooth: between texels h apart a cubic errs by h^3 and less, bilinear by h^2 / 8.
static void cubic_looks_are_smoother(void **state)
{
    (void)state;
    struct relume_image image = make(64, 32), out = make(120, 60);
    for (int i = 0; i < 64 * 32; i++) {
        const vec3 d = relume_panorama_ray(&sphere, 64, 32, i % 64 + 0.5, i / 64 + 0.5);
        image.data[3 * i] = (float)d.x;
        image.data[3 * i + 1] = (float)d.y;
        image.data[3 * i + 2] = (float)d.z;
    }
    const struct relume_pan_tilt look = {.pan_deg = 130, .tilt_deg = 30, .zoom = 2};
    double worst[2] = {0, 0};
    for (int k = 0; k < 2; k++) {
        const enum relume_filter filter = k ? RELUME_FILTER_CUBIC : RELUME_FILTER_LINEAR;
        CHECK_OK(relume_panorama_frame(&out, &sphere, &image, look,
                                       relume_view_params(.filter = filter)));
        for (int i = 0; i < 120 * 60; i++) {
            const vec3 d = relume_pan_tilt_ray(look, 120, 60, i % 120 + 0.5, i / 120 + 0.5);
            const float *v = &out.data[3 * i];
            worst[k] =
                fmax(worst[k],
                     vec3_length(vec3_sub(vec3_of((double)v[0], (double)v[1], (double)v[2]), d)));
        }
    }
    assert_true(worst[0] > 1e-3 && worst[0] < 0.0031);  // two steps of pi / 32, h^2 / 8 each
    assert_true(worst[1] < 0.3 * worst[0]);
    relume_image_destroy(&image);
    relume_image_destroy(&out);
}

// ---------------------------------------------------------------- slabs

enum { VIEW = 256, SMALL = 64 };

// Four cameras' noise between them, 256 -> 64: against the frame of full size, averaged.
static void reduced_slabs_are_means(void **state)
{
    (void)state;
    static const double uv[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {-0.5, 0.5}, {0.5, 0.5}};
    const struct relume_geometry g = {
        .projection = RELUME_SLAB, .uv_z = 3, .st_min = {-1, -1}, .st_max = {1, 1}};
    struct relume_image views[4], disparity[4];
    relume_slab *slab;
    CHECK_OK(relume_slab_create(&slab, &g, uv, 4));
    for (int i = 0; i < 4; i++) {
        struct relume_image depth;
        views[i] = noise(VIEW, VIEW);
        CHECK_OK(relume_image_create(&depth, VIEW, VIEW, 1));
        for (int k = 0; k < VIEW * VIEW; k++)  // the st plane
            depth.data[k] = (float)hypot(hypot((k % VIEW + 0.5) / VIEW * 2 - 1 - uv[i][0],
                                               1 - (k / VIEW + 0.5) / VIEW * 2 - uv[i][1]),
                                         3);
        CHECK_OK(relume_slab_disparity(&disparity[i], slab, uv[i], &depth));
        relume_image_destroy(&depth);
    }
    const struct relume_view_params ways[] = {
        {.interpolation = RELUME_INTERPOLATE_LINEAR},
        {.disparity = disparity},
        {.aperture = 0.8},
    };
    const struct relume_vec3 eye = {0.1, -0.2, 3};
    for (size_t w = 0; w < sizeof ways / sizeof *ways; w++) {
        struct relume_image full = make(VIEW, VIEW), want, got = make(SMALL, SMALL);
        struct relume_view_params one = ways[w];
        one.one = true;
        CHECK_OK(relume_slab_frame(&full, slab, eye, views, &ways[w]));
        CHECK_OK(relume_image_scale(&want, &full, SMALL, SMALL, NULL));
        CHECK_OK(relume_slab_frame(&got, slab, eye, views, &ways[w]));
        const double with = psnr(&got, &want);
        CHECK_OK(relume_slab_frame(&got, slab, eye, views, &one));
        print_message("slab, way %zu: %.1f dB, one ray %.1f dB\n", w, with, psnr(&got, &want));
        assert_true(with > 100);  // the same rays: rounding of float sums
        assert_true(psnr(&got, &want) < 25);
        relume_image_destroy(&full);
        relume_image_destroy(&want);
        relume_image_destroy(&got);
    }
    for (int i = 0; i < 4; i++) {
        relume_image_destroy(&views[i]);
        relume_image_destroy(&disparity[i]);
    }
    relume_slab_destroy(&slab);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_have_the_variance_of_the_texels),
        cmocka_unit_test(a_whole_share_is_the_mean),
        cmocka_unit_test(a_chequer_becomes_its_mean),
        cmocka_unit_test(enlarging_is_smooth_and_stays_in_range),
        cmocka_unit_test(borders_wrap_or_keep_to_their_tile),
        cmocka_unit_test(reduced_looks_are_means),
        cmocka_unit_test(enlarged_looks_are_single_rays),
        cmocka_unit_test(cubic_looks_are_smoother),
        cmocka_unit_test(reduced_slabs_are_means),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
