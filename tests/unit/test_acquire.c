// The whole way from ray-traced photographs of balls to a capture with known lights
#include "made_ball.h"
#include "test.h"

enum { LAMPS = 4 };

static struct relume_vec3 lamp_at(int i, double distance)
{
    const double z = 0.6 + 0.3 * i / LAMPS, phi = 2.4 * i, r = sqrt(1.0 - z * z);
    return (struct relume_vec3){distance * r * cos(phi), distance * r * sin(phi), distance * z};
}

struct photographs {
    char folder[64], out[96];
    char path[LAMPS][96];
    const char *list[LAMPS];
};

// `dark`: one of them shows no lamp; -1: none.
static void photograph(struct photographs *p, struct made_scene s, double distance, int dark)
{
    test_folder(p->folder);
    snprintf(p->out, sizeof p->out, "%s/out", p->folder);
    for (int i = 0; i < LAMPS; i++) {
        struct relume_image image;
        s.lamp = i == dark ? (struct relume_vec3){0, 0, -9} : lamp_at(i, distance);
        CHECK_OK(made_photograph(&image, &s, 0.003));
        char *path = p->path[i];
        snprintf(path, sizeof p->path[i], "%.63s/p%d.png", p->folder, i);
        p->list[i] = p->path[i];
        CHECK_OK(relume_image_save(&image, p->path[i], NULL));
        relume_image_destroy(&image);
    }
}

static void check_positions(double fov_deg, double tolerance)
{
    struct made_scene s = {.fov_deg = fov_deg,
                           .balls = 3,
                           .middle = {{-0.65, -0.35, 0}, {0.0, 0.38, 0}, {0.65, -0.3, 0}},
                           .radius = {0.26, 0.26, 0.26},
                           .brightness = 4.0};
    struct photographs p;
    struct relume_acquisition acquisition;
    double squares = 0.0;
    photograph(&p, s, 3.0, -1);
    struct relume_acquire_params params = {0};
    params.near = true;
    params.balls = 3;
    params.fov_deg = fov_deg;
    CHECK_OK(relume_capture_photographs(p.out, p.list, LAMPS, &params, &acquisition));
    assert_int_equal(acquisition.lights, LAMPS);
    for (int i = 0; i < LAMPS; i++) {
        const struct relume_vec3 off = vec3_sub(acquisition.position[i], lamp_at(i, 3.0));
        squares += vec3_dot(off, off) / LAMPS;
    }
    CHECK_NEAR(sqrt(squares) / 3.0, 0.0, tolerance);
    assert_true(acquisition.position_error < 0.05);
    relume_capture *capture;
    CHECK_OK(relume_capture_open(&capture, p.out, NULL));
    const struct relume_manifest *m = relume_capture_manifest(capture);
    assert_non_null(m->positions);
    assert_int_equal(m->geometry.perspective, fov_deg > 0.0);
    CHECK_NEAR(m->positions[2].z, acquisition.position[2].z, 1e-6);
    relume_capture_destroy(&capture);
    relume_acquisition_destroy(&acquisition);
    test_folder_remove(p.folder);
}

// Without options all balls are found, and they decide whether lamps are near.
static void check_found(struct made_scene s, bool distant, bool near)
{
    struct photographs p;
    struct relume_acquisition acquisition;
    struct relume_acquire_params params = {.distant = distant};
    photograph(&p, s, s.distant ? 1.0 : 3.0, -1);
    CHECK_OK(relume_capture_photographs(p.out, p.list, LAMPS, &params, &acquisition));
    assert_int_equal(acquisition.balls, 3);
    assert_true((acquisition.position != NULL) == near);
    if (near) {
        double squares = 0.0;
        for (int i = 0; i < LAMPS; i++) {
            const struct relume_vec3 off = vec3_sub(acquisition.position[i], lamp_at(i, 3.0));
            squares += vec3_dot(off, off) / LAMPS;
        }
        CHECK_NEAR(sqrt(squares) / 3.0, 0.0, 0.02);
    }
    relume_acquisition_destroy(&acquisition);
    test_folder_remove(p.folder);
}

static void balls_decide_near(void **state)
{
    (void)state;
    struct made_scene s = {.balls = 3,
                           .middle = {{-0.65, -0.35, 0}, {0.0, 0.38, 0}, {0.65, -0.3, 0}},
                           .radius = {0.26, 0.26, 0.26},
                           .brightness = 4.0};
    check_found(s, false, true);
    if (TEST_SANITIZED)
        return;
    check_found(s, true, false);
    s.distant = true;
    check_found(s, false, false);
}

// The target is 2 %; balls of 42 pixels are less than half of what the guide recommends.
static void positions_orthographic(void **state)
{
    (void)state;
    check_positions(0.0, 0.02);
}

static void positions_perspective(void **state)
{
    (void)state;
    check_positions(40.0, 0.02);
}

static void check_stone(bool matte)
{
    const struct made_scene s = {.balls = 1,
                                 .middle = {{0.4, 0, 0}},
                                 .radius = {0.3},
                                 .matte = matte,
                                 .brightness = matte ? 0.5 : 4.0,
                                 .distant = true};
    struct photographs p;
    struct relume_acquisition acquisition;
    photograph(&p, s, 1.0, -1);
    for (int i = 0; i < LAMPS; i++) {
        struct relume_image image = {0};
        CHECK_OK(relume_image_load(&image, p.path[i], NULL));
        for (int k = 0; k < image.width * image.height; k++)
            if (hypot(k % image.width - 0.22 * image.width, k / image.width - 0.5 * image.height) <
                0.14 * image.width)
                image.data[3 * k] = image.data[3 * k + 1] = image.data[3 * k + 2] = 0.9f;
        CHECK_OK(relume_image_save(&image, p.path[i], NULL));
        relume_image_destroy(&image);
    }
    struct relume_acquire_params params = {0};
    params.matte = matte;
    CHECK_OK(relume_capture_photographs(p.out, p.list, LAMPS, &params, &acquisition));
    assert_true(acquisition.ball[0].x > 0.5 * MADE_WIDTH);
    relume_acquisition_destroy(&acquisition);
    test_folder_remove(p.folder);
}

// A round stone with a sharper outline than the ball's: white all over, so it shows no lamp and is
// not shaded by one.
static void a_round_stone_is_no_ball(void **state)
{
    (void)state;
    check_stone(false);
    check_stone(true);
}

// The horizon of a table in a mirror on it looks like an outline, too: what a small circle shows of
// low lamps is that they stand behind the ball.
static void an_outline_too_small(void **state)
{
    (void)state;
    const struct made_scene s = {
        .balls = 1, .middle = {{0, 0, 0}}, .radius = {0.4}, .brightness = 12.0, .distant = true};
    static const double outline[2][3] = {
        {0.5 * MADE_WIDTH, 0.5 * MADE_HEIGHT, 0.2 * MADE_WIDTH},
        {0.5 * MADE_WIDTH, 0.5 * MADE_HEIGHT, 0.12 * MADE_WIDTH},
    };
    struct photographs p;
    struct relume_acquisition acquisition;
    photograph(&p, s, 1.0, -1);
    for (int round = 0; round < 2; round++) {
        struct relume_acquire_params params = {0};
        params.ball = &outline[round];
        params.balls = 1;
        params.force = true;
        CHECK_OK(relume_capture_photographs(p.out, p.list, LAMPS, &params, &acquisition));
        int said = 0;
        for (int i = 0; i < acquisition.warnings; i++)
            said += strstr(acquisition.warning[i], "behind it") != NULL;
        assert_int_equal(said, round);
        relume_acquisition_destroy(&acquisition);
    }
    test_folder_remove(p.folder);
}

// A mirror on a bright table shows its horizon, a circle of 0.7 to 0.8 of the outline and clearer
// than it: directions were 20 degrees off.
static void check_table(double fov_deg, struct relume_vec3 middle, bool matte, double tolerance)
{
    const struct made_scene s = {.fov_deg = fov_deg,
                                 .balls = 1,
                                 .middle = {middle},
                                 .radius = {0.35},
                                 .matte = matte,
                                 .brightness = matte ? 0.45 : 40.0,
                                 .distant = true,
                                 .table = -0.38};
    struct photographs p;
    struct relume_acquisition acquisition;
    double squares = 0.0;
    photograph(&p, s, 1.0, -1);
    struct relume_acquire_params params = {0};
    params.fov_deg = fov_deg;
    params.matte = matte;
    CHECK_OK(relume_capture_photographs(p.out, p.list, LAMPS, &params, &acquisition));
    for (int i = 0; i < LAMPS; i++) {
        const double cosine = vec3_dot(acquisition.direction[i], lamp_at(i, 1.0));
        squares += (2.0 - 2.0 * cosine) / LAMPS;
    }
    CHECK_NEAR(sqrt(squares) * 180.0 / M_PI, 0.0, tolerance);
    relume_acquisition_destroy(&acquisition);
    test_folder_remove(p.folder);
}

static void a_mirror_on_a_table(void **state)
{
    (void)state;
    // 56 pixels: one is 2 degrees
    check_table(0.0, (struct relume_vec3){-0.2, 0.1, 0}, false, 0.8);
    check_table(40.0, (struct relume_vec3){-0.25, 0.12, 0}, false, 0.8);
}

// As bright as the table and before its pattern: the mean shows no outline, the change of light
// does.
static void a_matte_ball_on_a_table(void **state)
{
    (void)state;
    check_table(0.0, (struct relume_vec3){-0.2, 0.1, 0}, true, 0.5);
}

static void a_dark_photograph(void **state)
{
    (void)state;
    const struct made_scene s = {
        .balls = 1, .middle = {{0.2, 0, 0}}, .radius = {0.4}, .brightness = 12.0, .distant = true};
    struct photographs p;
    struct relume_acquisition acquisition;
    struct test_log log;
    photograph(&p, s, 1.0, 2);
    struct relume_acquire_params params = {0};
    test_log_init(&log);
    params.log = &log.log;
    CHECK_OK(relume_capture_photographs(p.out, p.list, LAMPS, &params, &acquisition));
    bool said = false;
    for (int i = 0; i < acquisition.warnings; i++)
        said |=
            strstr(acquisition.warning[i], "p2.png: left out: no highlight on the ball") != NULL;
    assert_true(said);
    assert_int_equal(acquisition.lights, LAMPS - 1);
    assert_int_equal(acquisition.left_out, 1);
    assert_non_null(strstr(acquisition.photo[2].path, "p3.png"));
    relume_acquisition_destroy(&acquisition);
    // what exists is not replaced unasked
    assert_int_equal(relume_capture_photographs(p.out, p.list, LAMPS, &params, &acquisition),
                     RELUME_EINVAL);
    test_folder_remove(p.folder);
}

// A ball in the dark in 7 of 10 photographs may be no ball.
static void mostly_dark_photographs(void **state)
{
    enum { MANY = 10 };
    (void)state;
    const struct made_scene s = {
        .balls = 1, .middle = {{0.2, 0, 0}}, .radius = {0.4}, .brightness = 12.0, .distant = true};
    struct photographs p;
    struct relume_acquisition acquisition;
    struct test_log log;
    const char *list[MANY];
    const double ball[1][3] = {{0.6 * MADE_WIDTH, 0.5 * MADE_HEIGHT, 0.2 * MADE_WIDTH}};
    photograph(&p, s, 1.0, 2);
    for (int i = 0; i < MANY; i++)
        list[i] = p.list[i < LAMPS ? i : 2];
    struct relume_acquire_params params = {.ball = ball, .balls = 1};
    test_log_init(&log);
    params.log = &log.log;
    assert_int_equal(relume_capture_photographs(p.out, list, MANY, &params, &acquisition),
                     RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "3 of 10 photographs show the lamp there"));
    assert_null(acquisition.photo);
    assert_int_equal(access(p.out, F_OK), -1);
    test_folder_remove(p.folder);
}

// A window shines in the ball, brighter than half of the lamp, in every photograph.
static void a_reflection_that_never_moves(void **state)
{
    enum { SIDE = 7 };
    (void)state;
    const struct made_scene s = {
        .balls = 1, .middle = {{0.2, 0, 0}}, .radius = {0.4}, .brightness = 12.0, .distant = true};
    struct photographs p;
    struct relume_acquisition acquisition;
    photograph(&p, s, 1.0, -1);
    for (int i = 0; i < LAMPS; i++) {
        struct relume_image image = {0};
        CHECK_OK(relume_image_load(&image, p.path[i], NULL));
        const int x0 = (int)(0.52 * image.width), y0 = (int)(0.6 * image.height);
        for (int y = y0; y < y0 + SIDE; y++)
            for (int x = x0; x < x0 + SIDE; x++)
                for (int c = 0; c < 3; c++)
                    image.data[3 * (y * image.width + x) + c] = 0.95f;
        CHECK_OK(relume_image_save(&image, p.path[i], NULL));
        relume_image_destroy(&image);
    }
    CHECK_OK(relume_capture_photographs(p.out, p.list, LAMPS, NULL, &acquisition));
    assert_int_equal(acquisition.lights, LAMPS);
    for (int i = 0; i < LAMPS; i++) {
        const double off =
            vec3_angle(acquisition.direction[i], vec3_unit(lamp_at(i, 1.0))) * 180.0 / M_PI;
        assert_true(off < 2.0);  // the window lies more than 20 degrees beside every lamp
    }
    relume_acquisition_destroy(&acquisition);
    test_folder_remove(p.folder);
}

// ---------------------------------------------------------------- uneven light

enum { WIDE = 48, HIGH = 32 };
enum unevenness { ROUND, SLANTED };

static double unevenness(enum unevenness u, int light, int x, int y)
{
    const double dx = x + 0.5 - WIDE / 2, dy = y + 0.5 - HIGH / 2;
    const double r2 = 4.0 * (dx * dx + dy * dy) / (WIDE * WIDE + HIGH * HIGH);
    return u == ROUND ? 1.0 - 0.4 * r2 : 1.0 + 0.4 * dx / WIDE * (light - 1.5);
}

static void save_uneven(const char *path, enum unevenness u, int light, const double rgb[3])
{
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, WIDE, HIGH, 3));
    for (int i = 0; i < WIDE * HIGH; i++)
        for (int c = 0; c < 3; c++)
            image.data[3 * i + c] = (float)(rgb[c] * unevenness(u, light, i % WIDE, i / WIDE));
    CHECK_OK(relume_image_save(&image, path, NULL));
    relume_image_destroy(&image);
}

// A grey board under reddish lamps, seen through a lens: even and grey when all is taken out.
static void check_even(enum unevenness u, int flats, bool radial)
{
    static const double lamp[3] = {0.5, 0.3, 0.2}, board[3] = {0.7, 0.7, 0.7};
    struct photographs p;
    struct relume_acquisition acquisition;
    char flat[LAMPS][96], lights[96], text[256] = "";
    const char *flat_list[LAMPS];
    test_folder(p.folder);
    snprintf(p.out, sizeof p.out, "%s/out", p.folder);
    snprintf(lights, sizeof lights, "%s/lights.txt", p.folder);
    for (int i = 0; i < LAMPS; i++) {
        const struct relume_vec3 d = lamp_at(i, 1.0);
        snprintf(p.path[i], sizeof p.path[i], "%.63s/p%d.exr", p.folder, i);
        snprintf(flat[i], sizeof flat[i], "%.63s/f%d.exr", p.folder, i);
        p.list[i] = p.path[i];
        flat_list[i] = flat[i];
        save_uneven(p.path[i], u, i, lamp);
        save_uneven(flat[i], u, i, board);
        snprintf(text + strlen(text), sizeof text - strlen(text), "%f %f %f\n", d.x, d.y, d.z);
    }
    FILE *f = fopen(lights, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
    struct relume_acquire_params params = {0};
    params.lights = lights;
    params.flats = flat_list;
    params.flat_count = flats;
    params.radial = radial;
    params.white[0] = 10, params.white[1] = 8, params.white[2] = 12, params.white[3] = 6;
    CHECK_OK(relume_capture_photographs(p.out, p.list, LAMPS, &params, &acquisition));
    relume_capture *capture;
    CHECK_OK(relume_capture_open(&capture, p.out, NULL));
    for (int i = 0; i < LAMPS; i++) {
        struct relume_image image;
        CHECK_OK(relume_capture_image(&image, capture, 0, i, NULL));
        for (int k = 0; k < 3 * WIDE * HIGH; k++)  // half floats: 2^-11; the fit of the polynomial
            CHECK_NEAR(image.data[k] / image.data[0], 1.0, 2e-3);
        relume_image_destroy(&image);
    }
    relume_capture_destroy(&capture);
    relume_acquisition_destroy(&acquisition);
    test_folder_remove(p.folder);
}

static void light_is_evened_out(void **state)
{
    (void)state;
    check_even(ROUND, 1, false);
    check_even(ROUND, 1, true);
    check_even(SLANTED, LAMPS, false);
}

// ---------------------------------------------------------------- what lies beside

// Four pictures of a board and the list of their lights.
static void save_board(struct photographs *p)
{
    static const double lamp[3] = {0.5, 0.5, 0.5};
    char path[128];
    test_folder(p->folder);
    snprintf(p->out, sizeof p->out, "%s/out", p->folder);
    snprintf(path, sizeof path, "%s/light_directions.txt", p->folder);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    for (int i = 0; i < LAMPS; i++) {
        const struct relume_vec3 d = lamp_at(i, 1.0);
        fprintf(f, "%f %f %f\n", d.x, d.y, d.z);
        snprintf(p->path[i], sizeof p->path[i], "%.63s/p%d.exr", p->folder, i);
        save_uneven(p->path[i], ROUND, i, lamp);
    }
    fclose(f);
}

// A folder is enough: photographs and lights are found in it, and by-products are written.
static void a_folder_of_photographs(void **state)
{
    (void)state;
    struct photographs p;
    struct relume_acquisition report;
    struct relume_image albedo;
    char path[128];
    save_board(&p);
    snprintf(path, sizeof path, "%s/albedo.exr", p.folder);
    const char *const folder = p.folder;
    CHECK_OK(relume_capture_photographs(p.out, &folder, 1, relume_acquire_params(.albedo = path),
                                        &report));
    assert_int_equal(report.lights, LAMPS);
    CHECK_NEAR(report.direction[1].x, lamp_at(1, 1.0).x, 1e-5);
    CHECK_NEAR(report.direction_error_deg, 0.0, 0.0);  // as the list says
    assert_int_equal(report.photometric.albedo.width, WIDE);
    CHECK_OK(relume_image_load(&albedo, path, NULL));
    assert_int_equal(albedo.width, WIDE);
    relume_image_destroy(&albedo);
    relume_acquisition_destroy(&report);
    test_folder_remove(p.folder);
}

// Members that need or exclude each other are refused before anything is read.
static void members_that_disagree(void **state)
{
    (void)state;
    const char *const nowhere = "nowhere";
    const double corner[4][2] = {{0, 0}};
    const struct {
        struct relume_acquire_params params;
        const char *sentence;
    } cases[] = {
        {{.fov_deg = 40, .focal_mm = 50}, "expected one of --fov and --focal"},
        {{.refine_lights = true, .refine_brightness = true}, "which refines brightness as well"},
        {{.ball_transfer = {.curve = RELUME_CURVE_SRGB}}, "--ball-transfer needs --ball-photos"},
        {{.refine_brightness = true, .integrable = true}, "--integrable needs --refine-lights"},
        {{.radial = true}, "--radial needs --flat FILE"},
        {{.white = {1, 1, 4, 4}, .target = "auto"}, "expected one of --white and --target"},
        {{.target_values = "values.txt"}, "--target-values needs --target FILE"},
        {{.target_corner = corner}, "--target-corners needs --target FILE"},
        {{.width_mm = 20}, "--width needs --height FILE"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct relume_acquire_params params = cases[i].params;
        struct test_log log;
        test_log_init(&log);
        params.struct_size = sizeof params;
        params.log = &log.log;
        assert_int_equal(relume_capture_photographs("out", &nowhere, 1, &params, NULL),
                         RELUME_EINVAL);
        if (!strstr(log.text, cases[i].sentence))
            fail_msg("expected '%s', found '%s'", cases[i].sentence, log.text);
    }
}

// ---------------------------------------------------------------- a camera on the lamp

// A model whose unit is 1.7 of the capture's, the object 5 of them before its camera.
static void write_model(const char *folder, int lamps)
{
    enum { FOCAL = 60 };
    const double eye = 2.0 * FOCAL / WIDE, unit = eye / 5.0;
    char path[128];
    snprintf(path, sizeof path, "%s/cameras.txt", folder);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fprintf(f, "1 PINHOLE %d %d %d %d %d %d\n", WIDE, HIGH, FOCAL, FOCAL, WIDE / 2, HIGH / 2);
    fclose(f);
    snprintf(path, sizeof path, "%s/images.txt", folder);
    f = fopen(path, "w");
    assert_non_null(f);
    fprintf(f, "1 1 0 0 0 0 0 0 1 p2.exr\n\n");
    for (int i = 0; i < lamps; i++) {  // half a turn about x: t = -R c
        const struct relume_vec3 p = lamp_at(i, 2.0);
        const double c[3] = {p.x / unit, -p.y / unit, (eye - p.z) / unit};
        fprintf(f, "%d 0 1 0 0 %.9f %.9f %.9f 1 lamp/%02d.jpg\n\n", 7 - i, -c[0], c[1], c[2], i);
    }
    fclose(f);
    snprintf(path, sizeof path, "%s/points3D.txt", folder);
    f = fopen(path, "w");
    assert_non_null(f);
    for (int i = 0; i < 9; i++)
        fprintf(f, "%d %g %g %g 0 0 0 0.1\n", i + 1, 0.1 * i, -0.1 * i, i == 4 ? 99.0 : 5.0);
    fclose(f);
}

static void a_camera_on_the_lamp(void **state)
{
    (void)state;
    static const double lamp[3] = {0.5, 0.5, 0.5};
    struct photographs p;
    struct relume_acquisition acquisition;
    struct test_log log;
    test_folder(p.folder);
    snprintf(p.out, sizeof p.out, "%s/out", p.folder);
    for (int i = 0; i < LAMPS; i++) {
        snprintf(p.path[i], sizeof p.path[i], "%.63s/p%d.exr", p.folder, i);
        p.list[i] = p.path[i];
        save_uneven(p.path[i], ROUND, i, lamp);
    }
    struct relume_acquire_params params = {0};
    test_log_init(&log);
    params.log = &log.log;
    params.lights = p.folder;
    params.near = true;
    write_model(p.folder, LAMPS - 1);
    assert_int_equal(relume_capture_photographs(p.out, p.list, LAMPS, &params, &acquisition),
                     RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "3 photographs from the lamp; expected 4"));
    write_model(p.folder, LAMPS);
    CHECK_OK(relume_capture_photographs(p.out, p.list, LAMPS, &params, &acquisition));
    for (int i = 0; i < LAMPS; i++) {
        const struct relume_vec3 off = vec3_sub(acquisition.position[i], lamp_at(i, 2.0));
        CHECK_NEAR(vec3_dot(off, off), 0.0, 1e-12);
    }
    relume_capture *capture;
    CHECK_OK(relume_capture_open(&capture, p.out, NULL));
    assert_true(relume_capture_manifest(capture)->geometry.perspective);
    CHECK_NEAR(relume_capture_manifest(capture)->geometry.camera_z, 2.5, 1e-6);
    relume_capture_destroy(&capture);
    relume_acquisition_destroy(&acquisition);
    test_folder_remove(p.folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_folder_of_photographs),  cmocka_unit_test(members_that_disagree),
        cmocka_unit_test(light_is_evened_out),      cmocka_unit_test(a_camera_on_the_lamp),
        cmocka_unit_test(positions_orthographic),   cmocka_unit_test(balls_decide_near),
        cmocka_unit_test(positions_perspective),    cmocka_unit_test(a_dark_photograph),
        cmocka_unit_test(mostly_dark_photographs),  cmocka_unit_test(a_reflection_that_never_moves),
        cmocka_unit_test(a_round_stone_is_no_ball), cmocka_unit_test(an_outline_too_small),
        cmocka_unit_test(a_mirror_on_a_table),      cmocka_unit_test(a_matte_ball_on_a_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
