// test_eye.c - tests of include/relume/relight/eye.h: a living eye in time, and what stands in the
// way of light in it (Ritschel 2009, 8.2)
#include "relight/eye/eye.h"
#include "relight/eye/pupil.h"
#include "test.h"

// Eq. 8.2 as printed and as measured, from the table in the notes to the thesis, computed apart.
static void check_pupil(void **state)
{
    static const double table[][3] = {{1e-3, 6.892, 7.401},
                                      {1e-1, 4.900, 6.040},
                                      {1e0, 3.760, 4.900},
                                      {1e2, 2.399, 2.908},
                                      {1e4, 2.008, 2.135}};
    (void)state;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        CHECK_NEAR(relume_pupil_mm(table[i][0], false), table[i][1], 5e-4);
        // The offset of 0.003 in log L that millilamberts leave moves p by up to 0.004 mm.
        CHECK_NEAR(relume_pupil_mm(table[i][0], true), table[i][2], 5e-3);
    }
    CHECK_NEAR(relume_pupil_mm(0.0, false), 7.9, 1e-12);
}

static relume_eye *open_eye(const struct relume_subject *subject, double luminance)
{
    relume_eye *eye;
    CHECK_OK(relume_eye_create(&eye, subject, luminance));
    return eye;
}

// Bright eyes swing more (Fig 8.3) and faster, and none leaves [1.5, 9] mm, whatever the gain.
static void check_hippus(void **state)
{
    static const double levels[] = {1e-3, 1.0, 1e3};
    double swing[3];
    (void)state;
    for (int k = 0; k < 3; k++) {
        relume_eye *eye = open_eye(NULL, levels[k]);
        double least = 9.0, most = 0.0;
        for (int i = 0; i < 600; i++) {
            CHECK_OK(relume_eye_advance(eye, 0.05, levels[k]));
            const double h = relume_eye_state(eye)->pupil_mm;
            least = fmin(least, h);
            most = fmax(most, h);
        }
        swing[k] = most - least;
        relume_eye_destroy(&eye);
    }
    assert_true(swing[0] < swing[1] && swing[1] < swing[2]);
    struct relume_subject nervous = relume_subject_default();
    nervous.pupil.hippus = 1.0;
    relume_eye *eye = open_eye(&nervous, 1e4);
    for (int i = 0; i < 300; i++) {
        CHECK_OK(relume_eye_advance(eye, 0.05, 1e4));
        assert_in_range((int)(1e3 * relume_eye_state(eye)->pupil_mm), 1500, 9000);
    }
    relume_eye_destroy(&eye);
}

// The field luminance follows with one time constant: after one of them 1 / e is missing.
static void check_adaptation(void **state)
{
    struct relume_subject subject = relume_subject_default();
    (void)state;
    subject.pupil.adaptation_s = 0.5;
    relume_eye *eye = open_eye(&subject, 0.0);
    CHECK_OK(relume_eye_advance(eye, 0.5, 100.0));
    CHECK_NEAR(relume_eye_state(eye)->luminance, 100.0 * (1.0 - exp(-1.0)), 1e-6);
    relume_eye_destroy(&eye);
}

static void assert_same(const relume_eye *a, const relume_eye *b)
{
    const struct relume_aperture *const p = relume_eye_aperture(a), *const q =
                                                                        relume_eye_aperture(b);
    assert_memory_equal(relume_eye_state(a)->vitreous_rad, relume_eye_state(b)->vitreous_rad,
                        sizeof relume_eye_state(a)->vitreous_rad);
    assert_memory_equal(&p->pupil_radius, &q->pupil_radius, sizeof p->pupil_radius);
    assert_memory_equal(p->disc, q->disc,
                        (size_t)(p->vitreous.first + p->vitreous.count) * sizeof *p->disc);
    assert_memory_equal(p->stroke, q->stroke,
                        (size_t)(p->lashes.first + p->lashes.count) * sizeof *p->stroke);
}

// One second at once, in frames of a film, and with frames dropped: the same eye.
static void check_division(void **state)
{
    relume_eye *once = open_eye(NULL, 1.0), *film = open_eye(NULL, 1.0),
               *gaps = open_eye(NULL, 1.0);
    (void)state;
    CHECK_OK(relume_eye_advance(once, 1.0, 5.0));
    for (int i = 0; i < 24; i++)
        CHECK_OK(relume_eye_advance(film, 1.0 / 24.0, 5.0));
    CHECK_OK(relume_eye_advance(gaps, 0.25, 5.0));
    CHECK_OK(relume_eye_advance(gaps, 0.0, 5.0));
    CHECK_OK(relume_eye_advance(gaps, 0.75, 5.0));
    assert_same(once, film);
    assert_same(once, gaps);
    relume_eye_destroy(&film);
    struct relume_subject other = relume_subject_default();
    other.seed = 2;
    film = open_eye(&other, 1.0);
    CHECK_OK(relume_eye_advance(film, 1.0, 5.0));
    assert_true(relume_eye_state(film)->vitreous_rad[0] != relume_eye_state(once)->vitreous_rad[0]);
    relume_eye_destroy(&once);
    relume_eye_destroy(&film);
    relume_eye_destroy(&gaps);
}

// A day is as quick as ten seconds, and the eye has adapted.
static void check_long(void **state)
{
    relume_eye *eye = open_eye(NULL, 0.01);
    (void)state;
    CHECK_OK(relume_eye_advance(eye, 86400.0, 50.0));
    CHECK_NEAR(relume_eye_state(eye)->luminance, 50.0, 1e-9);
    CHECK_NEAR(relume_eye_state(eye)->time_s, 86400.0, 1e-9);
    assert_int_equal(relume_eye_advance(eye, -1.0, 1.0), RELUME_EINVAL);
    assert_int_equal(relume_eye_advance(eye, NAN, 1.0), RELUME_EINVAL);
    assert_int_equal(relume_eye_advance(eye, 1.0, INFINITY), RELUME_EINVAL);
    assert_int_equal(relume_eye_advance(eye, 1.0, -1.0), RELUME_EINVAL);
    relume_eye_destroy(&eye);
}

// The muscle moves the equator as far as is set, the axis not at all, and points between less.
static void check_lens(void **state)
{
    struct relume_subject subject = relume_subject_default();
    struct lens lens;
    struct relume_eye_disc discs[20000];
    (void)state;
    CHECK_OK(lens_create(&lens, &subject, discs));
    const int middle = LENS_NODES / 2;
    CHECK_NEAR(lens.response[middle][LENS_NODES - 1], 1.0, 1e-9);
    for (int i = 0; i + 1 < LENS_NODES; i++)
        assert_true(lens.response[middle][i] < lens.response[middle][i + 1]);
    for (int j = 0; j < LENS_NODES; j++) {
        CHECK_NEAR(lens.response[j][0], 0.0, 1e-12);
        for (int i = 0; i < LENS_NODES; i++)  // the lens has a plane of symmetry
            CHECK_NEAR(lens.response[j][i], lens.response[LENS_NODES - 1 - j][i], 1e-6);
    }
    // Particles move along their radius.
    struct relume_eye_disc rest[20000];
    lens_place(&lens, &subject, 0.0, rest);
    lens_place(&lens, &subject, 0.1, discs);
    for (int i = 0; i < lens.count; i++) {
        const double a = hypot((double)rest[i].x, (double)rest[i].y);
        const double b = hypot((double)discs[i].x, (double)discs[i].y);
        assert_true(a <= subject.lens.radius_mm && b >= a - 1e-6 && b - a <= 0.1);
        CHECK_NEAR((double)rest[i].x * (double)discs[i].y - (double)rest[i].y * (double)discs[i].x,
                   0.0, 1e-5);
    }
    lens_destroy(&lens);
}

// A kick dies away as exp(-c t) as long as the suspension has not pulled yet.
static void check_vitreous(void **state)
{
    struct relume_subject subject = relume_subject_default();
    struct relume_eye_disc discs[20000];
    struct vitreous body;
    (void)state;
    subject.vitreous.saccades_per_s = 0.0;
    CHECK_OK(vitreous_create(&body, &subject, discs));
    body.rate[0] = 1.0;
    for (int i = 0; i < 60; i++)
        vitreous_step(&body, &subject, i, 1.0 / 600.0);
    // 0.1 s: the suspension of 1 / s^2 takes at most 0.1 * 0.1 of it.
    CHECK_NEAR(body.rate[0], exp(-0.3), 0.01);
    CHECK_NEAR(body.angle[0], (1.0 - exp(-0.3)) / 3.0, 0.003);
    for (int i = 0; i < 60 * 600; i++)
        vitreous_step(&body, &subject, i, 1.0 / 600.0);
    CHECK_NEAR(body.angle[0], 0.0, 1e-4);
    // Turned by torsion, every particle keeps its distance from the axis.
    body.angle[0] = 0.0;
    vitreous_place(&body, &subject, discs);
    const struct relume_eye_disc first = discs[0];
    body.angle[2] = 0.5;
    vitreous_place(&body, &subject, discs);
    CHECK_NEAR((double)discs[0].x, cos(0.5) * (double)first.x - sin(0.5) * (double)first.y, 1e-5);
    CHECK_NEAR((double)discs[0].y, sin(0.5) * (double)first.x + cos(0.5) * (double)first.y, 1e-5);
    vitreous_destroy(&body);
}

// Blinks come about as often and take about as long as the subject says.
static void check_blinks(void **state)
{
    struct relume_subject subject = relume_subject_default();
    int shut = 0, blinks = 0;
    bool was = false;
    (void)state;
    for (int i = 0; i < 45 * 600; i++) {
        const double open = lids_openness(&subject, i / 600.0);
        assert_true(open >= 0.0 && open <= 1.0);
        blinks += open < 0.5 && !was;
        was = open < 0.5;
        shut += open < 0.01;
    }
    assert_int_equal(blinks, 10);
    assert_in_range(shut, 10 * 0.08 * 0.28 * 600, 10 * 0.3 * 0.28 * 600);
    subject.lids.blink_interval_s = 0.0;
    CHECK_NEAR(lids_openness(&subject, 3.0), 1.0, 0.0);
}

// ---------------------------------------------------------------- subjects

static relume_status load(struct relume_subject *s, const char *text, struct test_log *log)
{
    char folder[64], path[96];
    test_folder(folder);
    snprintf(path, sizeof path, "%s/s.json", folder);
    test_write(path, text, strlen(text));
    test_log_init(log);
    const relume_status status = relume_subject_load(s, path, &log->log);
    test_folder_remove(folder);
    return status;
}

#define HEAD "{\"format\": \"relume-subject\", \"version\": 1,\n"

static void check_subjects(void **state)
{
    static const struct {
        const char *text, *says;
    } bad[] = {
        {"{}", "no subject"},
        {"{\"format\": \"relume-subject\", \"version\": 2}", "version"},
        {HEAD "\"lens\": {\n\"count\": 1e9}}", "line 3; lens.count; expected a whole number"},
        {HEAD "\"lens\": {\n\"count\": 30000}}",
         "line 3; lens.count; expected 0 to 20000; found 30000"},
        {HEAD "\"lens\": {\"cuont\": 3}}", "line 2; lens.cuont; unknown; did you mean \"count\""},
        {HEAD "\"lense\": {}}", "did you mean \"lens\""},
        {HEAD "\"lens\": 3}", "lens; expected an object"},
        {HEAD "\"pupil\": {\"hippus\": \"much\"}}", "pupil.hippus; expected a number"},
        {HEAD "\"pupil\": {\"moon_spencer\": 1}}", "expected true or false"},
        {HEAD "\"lids\": {\"squint\": 1}}", "lids.squint; expected 0 to 0.99; found 1"},
        {HEAD "\"seed\": -1}", "seed; expected 0 to"},
        {HEAD "\"fibres\": {\"inner_mm\": 3,\n \"outer_mm\": 2}}",
         "fibres.inner_mm; expected at most"},
        {"[1, 2", "expected JSON"},
    };
    struct test_log log;
    struct relume_subject s;
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_true(relume_status_is_input(load(&s, bad[i].text, &log)));
        if (!strstr(log.text, bad[i].says))
            fail_msg("'%s' does not say '%s'", log.text, bad[i].says);
        assert_int_equal(log.lines, 1);
    }
    CHECK_OK(
        load(&s, HEAD "\"seed\": 7, \"optics\": {\"age\": 70}, \"cornea\": {\"count\": 3}}", &log));
    assert_int_equal(s.seed, 7);
    CHECK_NEAR(s.optics.age, 70.0, 0.0);
    assert_int_equal(s.cornea.count, 3);
    assert_int_equal(s.lens.particles.count, relume_subject_default().lens.particles.count);
    assert_int_equal(relume_subject_load(&s, "/nonexistent/s.json", &log.log), RELUME_ENOTFOUND);
}

// ---------------------------------------------------------------- lashes of a picture

// A picture of one bar, 10 pixels of 0.1 mm wide, that leans by `slant` pixels a row; 1: white.
static void write_bar(const char *path, float background, double slant)
{
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, 140, 60, 3));
    for (int y = 0; y < 60; y++)
        for (int x = 0; x < 140; x++) {
            const bool inside = y < 50 && fabs(x + 0.5 - 70.0 - slant * y) < 5.0;
            for (int c = 0; c < 3; c++)
                image.data[3 * (y * 140 + x) + c] = inside ? 0.0f : background;
        }
    CHECK_OK(relume_image_save(&image, path, NULL));
    relume_image_destroy(&image);
}

// The bar's strokes stand on both lids' edges and lead to where it ends, 49 rows below; the lower
// lid's are 0.45 times as long and point upwards.
static void check_lash_picture(void **state)
{
    char folder[64], path[96], picture[96];
    struct relume_subject s;
    relume_eye *eye;
    struct test_log log;
    const char *const text = HEAD "\"lids\": {\"lash_image\": \"bar.exr\"}}";
    (void)state;
    test_folder(folder);
    snprintf(path, sizeof path, "%s/s.json", folder);
    snprintf(picture, sizeof picture, "%s/bar.exr", folder);
    test_write(path, text, strlen(text));
    test_log_init(&log);
    assert_int_equal(relume_subject_load(&s, path, &log.log), RELUME_ENOTFOUND);  // no picture
    write_bar(picture, 0.0f, 0.0);                                                // one dark block
    CHECK_OK(relume_subject_load(&s, path, &log.log));
    write_bar(picture, 1.0f, 0.4);
    CHECK_OK(relume_subject_load(&s, path, &log.log));
    CHECK_OK(relume_eye_create(&eye, &s, 10.0));
    const struct relume_aperture *const a = relume_eye_aperture(eye);
    const int half = a->lashes.count / 2;
    const struct relume_eye_stroke *const upper = a->stroke + a->lashes.first;
    const double end = 0.1 * 0.4 * 49.0;  // mm beside the middle
    assert_int_equal(a->lashes.count, 2 * 49);
    CHECK_NEAR((double)upper[0].x[0], 0.0, 1e-5);
    CHECK_NEAR((double)upper[0].y[0], (double)a->upper[0], 1e-5);
    // half a pixel is how well a row's run gives its middle; the last piece goes on by a quarter of
    // up to one
    CHECK_NEAR((double)upper[48].x[1], end, 0.05 + 0.25 * 0.1);
    CHECK_NEAR((double)upper[48].y[1],
               (double)a->upper[0] + (double)a->upper[1] * end * end - 4.925, 0.01);
    CHECK_NEAR((double)upper[half].y[0], (double)a->lower[0], 1e-5);
    CHECK_NEAR((double)upper[half + 48].y[1],
               (double)a->lower[0] + (double)a->lower[1] * end * end + 0.45 * 4.925, 0.01);
    double width = 0.0;
    for (int i = 0; i < half; i++)
        width += (double)upper[i].width[0] / half;
    CHECK_NEAR(width, 0.6 + 0.4 / sqrt(2.0), 0.02);  // rows lean by 0 or 1 pixel, 0.4 in the mean
    relume_eye_destroy(&eye);
    write_bar(picture, 1.0f, 1e9);  // nothing but a dot
    assert_int_equal(relume_subject_load(&s, path, &log.log), RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "no lashes"));
    assert_int_equal(relume_eye_create(&eye, &s, 10.0), RELUME_EUNFIT);
    assert_null(eye);
    test_folder_remove(folder);
}

static void check_limits(void **state)
{
    struct relume_subject s = relume_subject_default();
    relume_eye *eye;
    (void)state;
    s.lens.particles.count = 20001;
    assert_int_equal(relume_eye_create(&eye, &s, 1.0), RELUME_EINVAL);
    assert_null(eye);
    s.lens.particles.count = 0;
    s.cornea.count = s.vitreous.particles.count = s.lids.lashes = s.fibres.spokes = 0;
    s.fibres.halo_deg = 0.0;
    CHECK_OK(relume_eye_create(&eye, &s, 1.0));
    CHECK_OK(relume_eye_advance(eye, 1.0, 1.0));
    relume_eye_destroy(&eye);
    s.optics.age = NAN;
    assert_int_equal(relume_eye_create(&eye, &s, 1.0), RELUME_EINVAL);
    assert_int_equal(relume_eye_create(&eye, NULL, -1.0), RELUME_EINVAL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(check_pupil),      cmocka_unit_test(check_hippus),
        cmocka_unit_test(check_adaptation), cmocka_unit_test(check_division),
        cmocka_unit_test(check_long),       cmocka_unit_test(check_lens),
        cmocka_unit_test(check_vitreous),   cmocka_unit_test(check_blinks),
        cmocka_unit_test(check_subjects),   cmocka_unit_test(check_lash_picture),
        cmocka_unit_test(check_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
