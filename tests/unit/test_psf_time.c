// Patterns in time: what changes from frame to frame is the eye's and nothing else
#include "test.h"

#include <relume/relight/psf.h>

#include <string.h>

static const double luminance = 10.0, clock_hz = 600.0;

static relume_eye *open_eye(uint64_t seed, double seconds)
{
    struct relume_subject subject = relume_subject_default();
    relume_eye *eye;
    subject.seed = seed ? seed : subject.seed;
    CHECK_OK(relume_eye_create(&eye, &subject, luminance));
    CHECK_OK(relume_eye_advance(eye, seconds, luminance));
    return eye;
}

static struct relume_image pattern(relume_psf *psf, const relume_eye *eye)
{
    struct relume_image image;
    CHECK_OK(relume_psf_update(psf, eye));
    CHECK_OK(relume_psf_image(&image, psf));
    return image;
}

// ---------------------------------------------------------------- flicker

static double apart(const struct relume_image *a, const struct relume_image *b)
{
    double sum = 0.0;
    for (size_t i = 1; i < 3 * (size_t)a->width * (size_t)a->height; i += 3)
        sum += fabs((double)a->data[i] - (double)b->data[i]);
    return sum;
}

// Things move with finite speed, so in a twentieth of a time the pattern changes by a twentieth:
// drawing that snaps to texels, or chance, would leave a rest. Within 1/30 s speeds change: what is
// left of a saccade, the pupil's turning points.
static void check_no_flicker(void **state)
{
    static const int ticks[] = {1, 5, 10, 20};
    double sum[4] = {0};
    relume_psf *psf;
    (void)state;
    CHECK_OK(
        relume_psf_create(&psf, relume_psf_params(.size = 128, .width_mm = 4.0, .wavelengths = 8)));
    for (int k = 0; k < 10; k++) {
        relume_eye *eye = open_eye(0, 0.87 + 0.29 * k);
        struct relume_image first = pattern(psf, eye), again = pattern(psf, eye);
        assert_memory_equal(first.data, again.data,
                            3 * (size_t)first.width * (size_t)first.height * sizeof *first.data);
        relume_image_destroy(&again);
        for (int i = 0, now = 0; i < 4; now = ticks[i], i++) {
            CHECK_OK(relume_eye_advance(eye, (ticks[i] - now) / clock_hz, luminance));
            struct relume_image later = pattern(psf, eye);
            const double moved = apart(&first, &later);
            assert_true(moved < 0.04);  // of a pattern's light, in 1/30 s or less
            sum[i] += moved;
            relume_image_destroy(&later);
        }
        relume_image_destroy(&first);
        relume_eye_destroy(&eye);
    }
    CHECK_NEAR(sum[1] / sum[0], 5.0, 0.25);
    CHECK_NEAR(sum[2] / sum[0], 10.0, 1.0);
    CHECK_NEAR(sum[3] / sum[0], 20.0, 3.0);
    relume_psf_destroy(&psf);
}

// ---------------------------------------------------------------- needles

enum { DIRECTIONS = 180 };

// The light of a ring by direction, as a part of its mean, less 1.
static void by_direction(double out[DIRECTIONS], relume_psf *psf, const relume_eye *eye)
{
    struct relume_image image = pattern(psf, eye);
    const int half = image.width / 2;
    double count[DIRECTIONS] = {0}, mean = 0.0;
    memset(out, 0, DIRECTIONS * sizeof *out);
    for (int y = -half; y <= half; y++)
        for (int x = -half; x <= half; x++) {
            const double r = hypot(x, y);
            if (r < 0.4 * half || r > 0.8 * half)
                continue;
            const int k = (int)((atan2(y, x) / M_PI + 1.0) * 0.5 * DIRECTIONS) % DIRECTIONS;
            const float *rgb = image.data + 3 * ((y + half) * image.width + x + half);
            out[k] += (double)rgb[1] * r * r * r;  // needles fall about so
            count[k]++;
        }
    for (int k = 0; k < DIRECTIONS; k++)
        mean += (out[k] /= count[k]) / DIRECTIONS;
    for (int k = 0; k < DIRECTIONS; k++)
        out[k] = out[k] / mean - 1.0;
    relume_image_destroy(&image);
}

static double correlation(const double *a, const double *b, int turned)
{
    double ab = 0.0, aa = 0.0, bb = 0.0;
    for (int k = 0; k < DIRECTIONS; k++) {
        const double other = b[(k + turned + DIRECTIONS) % DIRECTIONS];
        ab += a[k] * other;
        aa += a[k] * a[k];
        bb += other * other;
    }
    return ab / sqrt(aa * bb);
}

// From frame to frame needles stay in their directions, to 2 degrees, and are nearly as bright; in
// another eye they stand elsewhere.
static void check_needles_stay(void **state)
{
    double now[DIRECTIONS], before[DIRECTIONS];
    relume_psf *psf;
    relume_eye *eye = open_eye(0, 2.4), *other = open_eye(99, 2.4);
    (void)state;
    CHECK_OK(relume_psf_create(
        &psf, relume_psf_params(.size = 256, .half_field_deg = 1.0, .wavelengths = 8)));
    by_direction(before, psf, eye);
    for (int frame = 1; frame < 18; frame++) {
        CHECK_OK(relume_eye_advance(eye, 1.0 / 30.0, luminance));
        by_direction(now, psf, eye);
        const double here = correlation(before, now, 0);
        assert_true(here > 0.85);
        for (int turned = 1; turned < DIRECTIONS; turned++)
            assert_true(correlation(before, now, turned) < here);
        memcpy(before, now, sizeof now);
    }
    by_direction(now, psf, other);
    assert_true(fabs(correlation(before, now, 0)) < 0.3);
    relume_psf_destroy(&psf);
    relume_eye_destroy(&other);
    relume_eye_destroy(&eye);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(check_no_flicker),
        cmocka_unit_test(check_needles_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
