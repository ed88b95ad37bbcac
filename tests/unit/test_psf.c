// test_psf.c - tests of include/relume/relight/psf.h: what one point source leaves on the retina of
// an eye (Ritschel 2009, 8.3, 8.4)
#include "relight/eye/aperture.h"
#include "relight/eye/pattern.h"
#include "relight/eye/psf.h"
#include "relight/eye/pupil.h"
#include "test.h"

static const double nm575 = 575e-6;  // mm
static const double deg = M_PI / 180.0;

// A still eye of which nothing but the round pupil of that diameter is seen.
static struct relume_aperture round_pupil(double diameter)
{
    return (struct relume_aperture){
        .pupil_radius = (float)(0.5 * diameter), .upper = {100, -1e-3f}, .lower = {-100, 1e-3f}};
}

static relume_psf *make_psf(struct relume_psf_params params)
{
    relume_psf *psf;
    params.threads = params.threads ? params.threads : 2;
    CHECK_OK(relume_psf_create(&psf, &params));
    return psf;
}

static struct relume_image monochrome(relume_psf *psf, const struct relume_aperture *a, double dpt)
{
    struct relume_image image;
    CHECK_OK(psf_update_aperture(psf, a, dpt));
    CHECK_OK(relume_psf_monochrome(&image, psf));
    return image;
}

static double at(const struct relume_image *image, int x, int y)
{
    return (double)image->data[(size_t)y * (size_t)image->width + (size_t)x];
}

// J1 by its integral, 64 even steps: exact to rounding for the arguments used.
static double bessel_j1(double x)
{
    double sum = 0.0;
    for (int i = 0; i < 64; i++) {
        const double t = M_PI * (i + 0.5) / 64.0;
        sum += cos(t - x * sin(t));
    }
    return sum / 64.0;
}

// The pattern of an empty pupil is Airy's: its first dark ring stands at 1.22 lambda / D, and twice
// the pupil makes half the ring.
static void check_airy(void **state)
{
    (void)state;
    for (double diameter = 1.5; diameter < 3.5; diameter *= 2.0) {
        relume_psf *psf = make_psf((struct relume_psf_params){.size = 512, .wavelengths = 1});
        const struct relume_aperture pupil = round_pupil(diameter);
        struct relume_image image = monochrome(psf, &pupil, 0.0);
        const double middle = at(&image, 256, 256), step = relume_psf_shape(psf)->step;
        int dark = 1;
        while (at(&image, 256 + dark + 1, 256) < at(&image, 256 + dark, 256))
            dark++;
        // 1.22 lambda / D in texels; the least of a whole texel lies within one.
        CHECK_NEAR(dark, 1.2197 * nm575 / diameter / step, 1.0);
        for (int k = 1; k < 40; k++) {
            const double x = M_PI * diameter * k * step / nm575, j = 2.0 * bessel_j1(x) / x;
            // The disc's edge is covered in 16 scan lines a texel.
            CHECK_NEAR(at(&image, 256 + k, 256) / middle, j * j, 2e-4);
            CHECK_NEAR(at(&image, 256, 256 - k) / middle, j * j, 2e-4);
        }
        relume_image_destroy(&image);
        relume_psf_destroy(&psf);
    }
}

// Energy of the transform against that of the aperture. The transform is divided by that of a
// texel, which is 1 at the middle only: the check is of a low field of a smooth aperture.
static void check_parseval(void **state)
{
    relume_psf *psf = make_psf((struct relume_psf_params){.size = 256, .wavelengths = 1});
    const struct relume_aperture pupil = round_pupil(4.0);
    struct relume_image image = monochrome(psf, &pupil, 0.5), aperture;
    double area = 0.0, squares = 0.0, unscaled = 0.0;
    (void)state;
    CHECK_OK(relume_psf_aperture(&aperture, psf));
    for (size_t i = 0; i < 256 * 256; i++) {
        area += (double)aperture.data[i];
        squares += (double)aperture.data[i] * (double)aperture.data[i];
    }
    const double texel = 9.0 / 256;
    CHECK_NEAR(area * texel * texel, M_PI * 4.0, 1e-3);
    for (int y = 0; y < 256; y++)
        for (int x = 0; x < 256; x++) {
            const double u = M_PI * (x - 128) / 256, v = M_PI * (y - 128) / 256;
            const double s = (u != 0.0 ? sin(u) / u : 1.0) * (v != 0.0 ? sin(v) / v : 1.0);
            unscaled += at(&image, x, y) * s * s;
        }
    // The image sums to 1 with the texel's transform taken out; its value at the middle without
    // defocus is area^2 / (256^2 squares) of that without it.
    struct relume_image sharp = monochrome(psf, &pupil, 0.0);
    double sum = 0.0;
    for (int y = 0; y < 256; y++)
        for (int x = 0; x < 256; x++) {
            const double u = M_PI * (x - 128) / 256, v = M_PI * (y - 128) / 256;
            const double s = (u != 0.0 ? sin(u) / u : 1.0) * (v != 0.0 ? sin(v) / v : 1.0);
            sum += at(&sharp, x, y) * s * s;
        }
    CHECK_NEAR(at(&sharp, 128, 128) / sum, area * area / (256.0 * 256.0 * squares), 1e-6);
    assert_true(unscaled > 0.99 && unscaled < 1.0);
    relume_image_destroy(&image);
    relume_image_destroy(&sharp);
    relume_image_destroy(&aperture);
    relume_psf_destroy(&psf);
}

// Two slits: fringes lambda / distance apart.
static void check_slits(void **state)
{
    const struct relume_eye_stroke stroke[] = {
        {.x = {-4, -0.55f}, .width = {9, 9}, .opacity = 1},
        {.x = {-0.45f, 0.45f}, .width = {9, 9}, .opacity = 1},
        {.x = {0.55f, 4}, .width = {9, 9}, .opacity = 1},
    };
    relume_psf *psf = make_psf((struct relume_psf_params){.size = 512, .wavelengths = 1});
    struct relume_aperture slits = round_pupil(4.0);
    (void)state;
    slits.stroke = stroke;
    slits.lashes.count = 3;
    struct relume_image image = monochrome(psf, &slits, 0.0);
    const double middle = at(&image, 256, 256);
    for (int k = 1; k <= 30; k++) {
        // Slits of 0.1 mm at -0.5 and 0.5 mm: cos^2 under a sinc^2.
        const double f = k / 9.0, s = sin(M_PI * 0.1 * f) / (M_PI * 0.1 * f);
        CHECK_NEAR(at(&image, 256 + k, 256) / middle, pow(cos(M_PI * f) * s, 2.0), 0.02);
    }
    relume_image_destroy(&image);
    relume_psf_destroy(&psf);
}

static void fill_discs(struct relume_eye_disc *disc, int count, double turn)
{
    uint32_t random = 5;
    for (int i = 0; i < count; i++) {
        const double x = 3.0 * test_uniform(&random) - 1.5, y = 3.0 * test_uniform(&random) - 1.5;
        disc[i] = (struct relume_eye_disc){.x = (float)(cos(turn) * x - sin(turn) * y),
                                           .y = (float)(sin(turn) * x + cos(turn) * y),
                                           .radius = 0.1f,
                                           .opacity = 1};
    }
}

// Particles turned by a quarter turn the pattern by a quarter, and the same way.
static void check_rotation(void **state)
{
    enum { COUNT = 25 };
    struct relume_eye_disc disc[COUNT];
    struct relume_aperture a = round_pupil(4.0);
    struct relume_image image[2];
    (void)state;
    a.disc = disc;
    a.vitreous.count = COUNT;
    relume_psf *psf = make_psf((struct relume_psf_params){.size = 256, .wavelengths = 1});
    for (int k = 0; k < 2; k++) {
        fill_discs(disc, COUNT, k * M_PI / 2.0);
        image[k] = monochrome(psf, &a, 0.3);
    }
    double most = 0.0, outside = 0.0;
    for (size_t i = 0; i < 256 * 256; i++)
        most = fmax(most, (double)image[0].data[i]);
    for (int y = -100; y <= 100; y++)
        for (int x = -100; x <= 100; x++) {
            const double before = at(&image[0], 128 + x, 128 - y);
            // Scan lines treat x and y differently.
            CHECK_NEAR(at(&image[1], 128 - y, 128 - x) / most, before / most, 1e-3);
            if (abs(x) > 20)
                outside = fmax(outside, before / most);
        }
    assert_true(outside > 5e-3);
    for (int k = 0; k < 2; k++)
        relume_image_destroy(&image[k]);
    relume_psf_destroy(&psf);
}

// Far-sighted, the upper half of the pupil is seen below the light (and the blur is as wide as
// geometry says: dioptres times diameter).
static void check_defocus(void **state)
{
    struct relume_aperture a = round_pupil(4.0);
    relume_psf *psf = make_psf((struct relume_psf_params){.size = 512, .wavelengths = 1});
    double above = 0.0, below = 0.0, out = 0.0;
    (void)state;
    a.lower[0] = 0.0f;  // the lower lid covers the lower half
    struct relume_image image = monochrome(psf, &a, 2.0);
    const double edge = 2e-3 * 2.0 / relume_psf_shape(psf)->step;  // D h / 2
    for (int y = 0; y < 512; y++)
        for (int x = 0; x < 512; x++) {
            *(y < 256 ? &above : &below) += at(&image, x, y);
            if (hypot(x - 256, y - 256) > 1.15 * edge)
                out += at(&image, x, y);
        }
    assert_true(below > 0.95 && above < 0.05 && out < 0.03);
    relume_image_destroy(&image);
    relume_psf_destroy(&psf);
}

// A narrower texture, folded, samples the same pattern at every second angle.
static void check_folding(void **state)
{
    enum { COUNT = 30 };
    struct relume_eye_disc disc[COUNT];
    struct relume_aperture a = round_pupil(4.0);
    (void)state;
    fill_discs(disc, COUNT, 0.3);
    a.disc = disc;
    a.lens.count = COUNT;
    relume_psf *wide =
        make_psf((struct relume_psf_params){.size = 512, .width_mm = 6.0, .wavelengths = 1});
    relume_psf *folded =
        make_psf((struct relume_psf_params){.size = 256, .width_mm = 3.0, .wavelengths = 1});
    struct relume_image whole = monochrome(wide, &a, 0.25), part = monochrome(folded, &a, 0.25);
    double sum = 0.0;
    for (int y = 0; y < 512; y += 2)
        for (int x = 0; x < 512; x += 2)
            sum += at(&whole, x, y);
    for (int y = 1; y < 256; y++)
        for (int x = 1; x < 256; x++)
            CHECK_NEAR(at(&part, x, y), at(&whole, 2 * x, 2 * y) / sum, 1e-7);
    relume_image_destroy(&whole);
    relume_image_destroy(&part);
    relume_psf_destroy(&wide);
    relume_psf_destroy(&folded);
}

// Spokes make their ring at lambda / spacing, and red lies outside blue.
static void check_halo(void **state)
{
    struct relume_subject s = relume_subject_default();
    relume_eye *eye;
    double radius[3] = {0.0};
    (void)state;
    s.lids.lashes = 0;
    s.optics.defocus_dpt = 0.0;
    s.fibres.opacity = 1.0;
    s.fibres.halo_deg = 1.0;
    s.fibres.width_mm = 0.015;
    CHECK_OK(relume_eye_create(&eye, &s, 0.1));
    relume_psf *psf = make_psf(
        (struct relume_psf_params){.size = 512,
                                   .half_field_deg = 1.8,
                                   .parts_off = RELUME_EYE_ALL & ~(unsigned)RELUME_EYE_FIBRES});
    struct relume_image image;
    CHECK_OK(relume_psf_update(psf, eye));
    CHECK_OK(relume_psf_image(&image, psf));
    const struct relume_psf_geometry *const g = relume_psf_shape(psf);
    for (int c = 0; c < 3; c++) {
        double mean[512] = {0.0}, most = 0.0;
        for (int y = 0; y < image.height; y++)
            for (int x = 0; x < image.width; x++) {
                const double r = hypot(x - image.width / 2, y - image.height / 2);
                const int bin = (int)(r * g->step / deg / 0.05);
                if (r > 0.0 && r * g->step / deg < 1.6)
                    mean[bin] += (double)image.data[3 * (y * image.width + x) + c] / r;
            }
        for (int bin = (int)(0.5 / 0.05); bin < (int)(1.6 / 0.05); bin++)
            if (mean[bin] > most) {
                most = mean[bin];
                radius[c] = (bin + 0.5) * 0.05;
            }
    }
    // Dominant wavelengths of the primaries, nm: 611, 549, 464.
    CHECK_NEAR(radius[0], 611.0 / 575.0, 0.08);
    CHECK_NEAR(radius[1], 549.0 / 575.0, 0.08);
    CHECK_NEAR(radius[2], 464.0 / 575.0, 0.08);
    relume_image_destroy(&image);
    relume_psf_destroy(&psf);
    relume_eye_destroy(&eye);
}

// One wavelength leaves the pattern as it is; any number of them sums to one in each channel.
static void check_wavelengths(void **state)
{
    relume_eye *eye;
    (void)state;
    CHECK_OK(relume_eye_create(&eye, NULL, 10.0));
    relume_psf *one = make_psf((struct relume_psf_params){.size = 256, .wavelengths = 1});
    struct relume_image grey, mono;
    CHECK_OK(relume_psf_update(one, eye));
    CHECK_OK(relume_psf_image(&grey, one));
    CHECK_OK(relume_psf_monochrome(&mono, one));
    const int half = grey.width / 2;
    const double scale = at(&mono, 128, 128) / (double)grey.data[3 * (half * grey.width + half)];
    for (int y = -80; y <= 80; y++)
        for (int x = -80; x <= 80; x++)
            CHECK_NEAR((double)grey.data[3 * ((half + y) * grey.width + half + x)] * scale,
                       at(&mono, 128 + x, 128 + y), 1e-8);  // floats of up to 0.1
    static const struct relume_psf_params several[] = {
        {.size = 256, .wavelengths = 7},
        {.size = 256},
        {.size = 256, .literal = true},
        {.size = 256, .temperature_k = 1850.0},
    };
    for (size_t i = 0; i < sizeof several / sizeof *several; i++) {
        relume_psf *psf = make_psf(several[i]);
        struct relume_image image;
        double sum[3] = {0.0};
        CHECK_OK(relume_psf_update(psf, eye));
        CHECK_OK(relume_psf_image(&image, psf));
        for (size_t k = 0; k < 3 * (size_t)image.width * (size_t)image.height; k++)
            sum[k % 3] += (double)image.data[k];
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(sum[c], 1.0, 1e-5);
        relume_image_destroy(&image);
        relume_psf_destroy(&psf);
    }
    relume_image_destroy(&grey);
    relume_image_destroy(&mono);
    relume_psf_destroy(&one);
    relume_eye_destroy(&eye);
}

// Y of equal energy as the sum over CIE 1931: the white of illuminant E is x = y = 1/3.
static void check_spectrum(void **state)
{
    struct relume_psf_spectrum s;
    (void)state;
    CHECK_OK(relume_psf_spectrum(&s, relume_psf_params(.literal = true)));
    assert_int_equal(s.taps, 32);
    CHECK_NEAR((double)s.tap[16].scale, 1.0, 1e-6);
    CHECK_NEAR((double)s.tap[0].scale, 575.0 / 380.0, 1e-6);
    CHECK_NEAR((double)s.tap[31].scale, 575.0 / 757.8125, 1e-6);
    assert_int_equal(s.fines, 1);
    CHECK_OK(relume_psf_spectrum(&s, NULL));
    double sum[3] = {0.0};
    for (int i = 0; i < s.taps; i++)
        for (int c = 0; c < 3; c++)
            sum[c] += (double)s.tap[i].rgb[c] / pow((double)s.tap[i].scale, 2.0);
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(sum[c], 1.0, 1e-5);
    assert_int_equal(relume_psf_spectrum(&s, relume_psf_params(.wavelengths = 257)), RELUME_EINVAL);
}

// A particle that drifts by twentieths of a texel changes the pattern evenly: no step is much
// larger than the mean one.
static void check_drift(void **state)
{
    enum { STEPS = 20 };
    relume_psf *psf = make_psf((struct relume_psf_params){.size = 256, .wavelengths = 1});
    struct relume_eye_disc disc = {.radius = 0.05f, .opacity = 1};
    struct relume_aperture a = round_pupil(2.0);
    (void)state;
    a.disc = &disc;
    a.lens.count = 1;
    for (int along = 0; along < 2; along++) {
        struct relume_image before = {0};
        double most = 0.0, sum = 0.0;
        for (int i = 0; i <= STEPS; i++) {
            const float way = 0.3f + (float)i * (9.0f / 256.0f) / STEPS;
            disc.x = along ? 0.2f : way;
            disc.y = along ? way : 0.2f;
            struct relume_image now = monochrome(psf, &a, 0.0);
            double change = 0.0;
            for (size_t k = 0; i && k < 256 * 256; k++)
                change += fabs((double)now.data[k] - (double)before.data[k]);
            most = fmax(most, change);
            sum += change;
            relume_image_destroy(&before);
            before = now;
        }
        assert_true(sum > 0.0);
        CHECK_NEAR(most / (sum / STEPS), 1.0, 0.5);
        relume_image_destroy(&before);
    }
    relume_psf_destroy(&psf);
}

// Areas of what is drawn, also far below a texel.
static void check_coverage(void **state)
{
    static const double radii[] = {0.2, 0.7, 3.0, 20.0};  // texels
    (void)state;
    for (size_t i = 0; i < sizeof radii / sizeof *radii; i++) {
        struct canvas canvas = {0};
        struct relume_eye_disc disc = {
            .x = 3.3f, .y = -7.9f, .radius = (float)radii[i], .opacity = 1};
        struct relume_aperture a = round_pupil(120.0);
        a.disc = &disc;
        a.lens.count = 1;
        CHECK_OK(canvas_resize(&canvas, 128, 1.0));
        double sum[2] = {0.0};
        for (int k = 0; k < 2; k++) {
            CHECK_OK(canvas_draw(&canvas, &a, k ? RELUME_EYE_LENS : 0, 3));
            for (size_t j = 0; j < 128 * 128; j++)
                sum[k] += (double)canvas.t[j];
        }
        // Midpoints of scan lines: within 4 % of small discs, better of large ones.
        CHECK_NEAR((sum[1] - sum[0]) / (M_PI * radii[i] * radii[i]), 1.0, 0.04);
        CHECK_NEAR(sum[1] / (M_PI * 3600.0), 1.0, 1e-4);
        canvas_destroy(&canvas);
    }
}

// The half-open eye lets through what geometry says, and shut lids keep the last pattern.
static void check_lids(void **state)
{
    struct relume_aperture a = round_pupil(3.0);
    relume_psf *psf = make_psf((struct relume_psf_params){.size = 128});
    struct relume_image before, after;
    (void)state;
    a.upper[0] = 0.0f;
    a.upper[1] = -1e-9f;
    CHECK_OK(psf_update_aperture(psf, &a, 0.0));
    CHECK_NEAR(relume_psf_light(psf), 0.5, 1e-3);
    CHECK_OK(relume_psf_image(&before, psf));
    a.upper[0] = -5.0f;
    CHECK_OK(psf_update_aperture(psf, &a, 0.0));
    CHECK_NEAR(relume_psf_light(psf), 0.0, 0.0);
    CHECK_OK(relume_psf_image(&after, psf));
    assert_memory_equal(before.data, after.data,
                        3 * (size_t)before.width * (size_t)before.width * sizeof *before.data);
    relume_image_destroy(&before);
    relume_image_destroy(&after);
    relume_psf_destroy(&psf);
}

// Between planes no light is lost but what discs take, and a wave that meets nothing in the
// vitreous body arrives as from one plane.
static void check_planes(void **state)
{
    struct relume_eye_disc disc[40];
    struct relume_aperture a = round_pupil(3.0);
    struct relume_image image[2];
    (void)state;
    fill_discs(disc, 40, 0.0);
    a.disc = disc;
    a.lens.count = 20;
    for (int k = 0; k < 2; k++) {
        relume_psf *psf = make_psf(
            (struct relume_psf_params){.size = 256, .wavelengths = 1, .planes = k ? 4 : 0});
        image[k] = monochrome(psf, &a, 0.25);
        relume_psf_destroy(&psf);
    }
    for (size_t i = 0; i < 256 * 256; i++)
        CHECK_NEAR((double)image[1].data[i], (double)image[0].data[i], 1e-7);
    relume_image_destroy(&image[0]);
    relume_image_destroy(&image[1]);
    // A disc in the middle of the second of four planes, at 8.25 mm, has the pattern of one that is
    // larger by d / (d - z): the middle is darker by as much as it blocks.
    a.lens.count = 0;
    a.vitreous = (struct relume_eye_range){0, 1};
    disc[0] = (struct relume_eye_disc){.radius = 0.2f, .opacity = 1, .depth = 8.25f};
    relume_psf *psf =
        make_psf((struct relume_psf_params){.size = 512, .wavelengths = 1, .planes = 4});
    struct relume_image deep = monochrome(psf, &a, 0.0);
    relume_psf_destroy(&psf);
    const double r = 0.2 * 24.0 / (24.0 - 8.25) / 1.5;
    // Energy in the middle texel: the square of the open share, of a total that is the open share.
    relume_psf *none = make_psf(
        (struct relume_psf_params){.size = 512, .wavelengths = 1, .parts_off = RELUME_EYE_ALL});
    struct relume_image empty = monochrome(none, &a, 0.0);
    CHECK_NEAR(at(&deep, 256, 256) / at(&empty, 256, 256), 1.0 - r * r, 5e-3);
    relume_psf_destroy(&none);
    relume_image_destroy(&deep);
    relume_image_destroy(&empty);
}

// The printed d = 24 mm leaves nothing of a pattern: a blur as wide as the texture.
static void check_literal_distance(void **state)
{
    relume_psf *psf = make_psf(
        (struct relume_psf_params){.size = 256, .wavelengths = 1, .retina_distance = true});
    const struct relume_aperture pupil = round_pupil(6.0);
    struct relume_image image = monochrome(psf, &pupil, 0.0);
    double most = 0.0;
    (void)state;
    for (size_t i = 0; i < 256 * 256; i++)
        most = fmax(most, (double)image.data[i]);
    assert_true(most < 1e-3);  // Fraunhofer: 0.3
    relume_image_destroy(&image);
    relume_psf_destroy(&psf);
}

// Light of the default eye in rings, against the CIE's standard observer from 0.1 degrees to the
// pattern's edge: within a factor of 2, which two seeds of an eye differ by as well.
static void check_observer(void **state)
{
    enum { RINGS = 8 };
    struct relume_subject s = relume_subject_default();
    const double from = 0.1, to = 1.6;
    double light[RINGS] = {0.0};
    relume_eye *eye;
    (void)state;
    s.lids.blink_interval_s = 0.0;
    CHECK_OK(relume_eye_create(&eye, &s, 10.0));
    relume_psf *psf = make_psf((struct relume_psf_params){
        .size = 512, .half_field_deg = 1.8, .parts_off = RELUME_EYE_FIBRES});
    struct relume_image image;
    CHECK_OK(relume_psf_update(psf, eye));
    CHECK_OK(relume_psf_image(&image, psf));
    const int half = image.width / 2;
    for (int y = -half; y <= half; y++)
        for (int x = -half; x <= half; x++) {
            const double t = hypot(x, y) * relume_psf_shape(psf)->step / deg;
            const float *const rgb = image.data + 3 * ((y + half) * image.width + x + half);
            if (t >= from && t < to)
                light[(int)(RINGS * log(t / from) / log(to / from))] +=
                    0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
        }
    for (int i = 0; i < RINGS; i++) {
        double cie = 0.0;
        for (int k = 0; k < 100; k++) {
            const double step = log(to / from) / RINGS / 100.0;
            const double t = from * exp((100 * i + k + 0.5) * step);
            cie += relume_cie_glare(t, 35.0, 0.5) * 2.0 * M_PI * t * t * step * deg * deg;
        }
        CHECK_NEAR(log(light[i] / cie), 0.0, log(2.0));
    }
    relume_image_destroy(&image);
    relume_psf_destroy(&psf);
    relume_eye_destroy(&eye);
}

// ---------------------------------------------------------------- machine

static struct relume_image pattern(struct relume_psf_params params)
{
    relume_psf *psf;
    relume_eye *eye;
    struct relume_image image;
    CHECK_OK(relume_eye_create(&eye, NULL, 1.0));
    CHECK_OK(relume_psf_create(&psf, &params));
    CHECK_OK(relume_psf_update(psf, eye));
    CHECK_OK(relume_psf_image(&image, psf));
    relume_psf_destroy(&psf);
    relume_eye_destroy(&eye);
    return image;
}

static void check_set(const struct relume_image *one, unsigned off)
{
    struct relume_image other =
        pattern((struct relume_psf_params){.size = 192, .threads = 2, .cpu_off = off});
    const size_t n = 3 * (size_t)one->width * (size_t)one->height;
    double most = 0.0;
    for (size_t i = 0; i < n; i++)
        most = fmax(most, fabs((double)one->data[i]));
    for (size_t i = 0; i < n; i++)  // 36 taps of rounded products
        CHECK_NEAR((double)one->data[i], (double)other.data[i], 2e-6 * most);
    relume_image_destroy(&other);
}

static void check_threads_and_kernels(void **state)
{
    struct relume_image one = pattern((struct relume_psf_params){.size = 192, .threads = 1});
    struct relume_image five = pattern((struct relume_psf_params){.size = 192, .threads = 5});
    const size_t n = 3 * (size_t)one.width * (size_t)one.height;
    (void)state;
    assert_memory_equal(one.data, five.data, n * sizeof *one.data);
    check_set(&one, ~0u);
    check_set(&one, RELUME_CPU_AVX512);
    relume_image_destroy(&one);
    relume_image_destroy(&five);
}

// A pattern that has seen one eye sees the next as if it were its first.
static void check_other_eye(void **state)
{
    struct relume_subject subject = relume_subject_default();
    struct relume_image image[2];
    (void)state;
    for (int fresh = 0; fresh < 2; fresh++) {
        relume_psf *psf = make_psf((struct relume_psf_params){.size = 128, .wavelengths = 2});
        for (uint64_t seed = fresh ? 2 : 1; seed <= 2; seed++) {
            relume_eye *eye;
            subject.seed = seed;
            CHECK_OK(relume_eye_create(&eye, &subject, 0.1));
            CHECK_OK(relume_psf_update(psf, eye));
            relume_eye_destroy(&eye);
        }
        CHECK_OK(relume_psf_image(&image[fresh], psf));
        relume_psf_destroy(&psf);
    }
    assert_memory_equal(image[0].data, image[1].data,
                        3 * (size_t)image[0].width * (size_t)image[0].height * sizeof(float));
    relume_image_destroy(&image[0]);
    relume_image_destroy(&image[1]);
}

static void check_parameters(void **state)
{
    static const struct relume_psf_params bad[] = {
        {.size = 63},           {.size = 101},           {.size = 8194},
        {.size = -2},           {.wavelengths = -1},     {.planes = 17},
        {.temperature_k = 999}, {.temperature_k = NAN},  {.half_field_deg = 21},
        {.half_field_deg = -1}, {.half_field_deg = NAN}, {.width_mm = 101},
        {.width_mm = NAN},      {.width_mm = -1},        {.size = 64, .half_field_deg = 10},
    };
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct test_log log;
        struct relume_psf_params p = bad[i];
        relume_psf *psf;
        test_log_init(&log);
        p.log = &log.log;
        assert_int_equal(relume_psf_create(&psf, &p), RELUME_EINVAL);
        assert_null(psf);
        assert_int_equal(log.lines, 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(check_airy),
        cmocka_unit_test(check_parseval),
        cmocka_unit_test(check_slits),
        cmocka_unit_test(check_rotation),
        cmocka_unit_test(check_defocus),
        cmocka_unit_test(check_folding),
        cmocka_unit_test(check_halo),
        cmocka_unit_test(check_wavelengths),
        cmocka_unit_test(check_spectrum),
        cmocka_unit_test(check_drift),
        cmocka_unit_test(check_coverage),
        cmocka_unit_test(check_observer),
        cmocka_unit_test(check_other_eye),
        cmocka_unit_test(check_lids),
        cmocka_unit_test(check_planes),
        cmocka_unit_test(check_literal_distance),
        cmocka_unit_test(check_threads_and_kernels),
        cmocka_unit_test(check_parameters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
