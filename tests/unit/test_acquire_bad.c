// Photographs that are not what they should be, and the sentences that say so
#include "made_ball.h"
#include "test.h"

enum { LAMPS = 4, WIDE = 48, HIGH = 32 };

struct photographs {
    char folder[64], out[96];
    char path[LAMPS][96];
    const char *list[LAMPS];
    struct relume_acquire_params params;
    struct test_log log;
};

static void begin(struct photographs *p)
{
    *p = (struct photographs){0};
    char folder[64];
    memcpy(p->folder, test_folder(folder), sizeof folder);
    snprintf(p->out, sizeof p->out, "%s/out", folder);
    for (int i = 0; i < LAMPS; i++) {
        snprintf(p->path[i], sizeof p->path[i], "%.63s/p%d.png", folder, i);
        p->list[i] = p->path[i];
    }
    test_log_init(&p->log);
    p->params.log = &p->log.log;
}

static void save(const struct photographs *p, int i, struct relume_image *image)
{
    CHECK_OK(relume_image_save(image, p->path[i], NULL));
    relume_image_destroy(image);
}

// It is refused with that sentence, and nothing is left behind.
static void expect_refused(struct photographs *p, const char *sentence)
{
    struct relume_acquisition acquisition;
    assert_int_equal(relume_capture_photographs(p->out, p->list, LAMPS, &p->params, &acquisition),
                     RELUME_EUNFIT);
    if (!strstr(p->log.text, sentence))
        fail_msg("expected '%s', found '%s'", sentence, p->log.text);
    assert_int_equal(access(p->out, F_OK), -1);
}

static bool warns(const struct relume_acquisition *acquisition, const char *photograph,
                  const char *what)
{
    for (int i = 0; i < acquisition->warnings; i++)
        if (strstr(acquisition->warning[i], photograph) && strstr(acquisition->warning[i], what))
            return true;
    return false;
}

// ---------------------------------------------------------------- balls

static struct made_scene a_ball(double x)
{
    return (struct made_scene){
        .balls = 1, .middle = {{x, 0, 0}}, .radius = {0.4}, .brightness = 12.0, .distant = true};
}

static void photograph(const struct photographs *p, int i, struct made_scene s)
{
    struct relume_image image;
    const double phi = 2.4 * i;
    s.lamp = s.lamp.z != 0.0 ? s.lamp : (struct relume_vec3){0.5 * cos(phi), 0.5 * sin(phi), 0.8};
    CHECK_OK(made_photograph(&image, &s, 0.003));
    save(p, i, &image);
}

static void no_ball(void **state)
{
    (void)state;
    struct photographs p;
    begin(&p);
    for (int i = 0; i < LAMPS; i++)
        photograph(&p, i, (struct made_scene){0});
    expect_refused(&p, "p0.png: no mirror ball found; give --lights");
    test_folder_remove(p.folder);
}

static void a_ball_that_is_cut_off(void **state)
{
    (void)state;
    static const double circle[1][3] = {{0.9 * MADE_WIDTH, 0.5 * MADE_HEIGHT, 0.2 * MADE_WIDTH}};
    struct photographs p;
    struct relume_acquisition acquisition;
    begin(&p);
    for (int i = 0; i < LAMPS; i++)
        photograph(&p, i, a_ball(0.8));
    p.params.ball = circle;
    CHECK_OK(relume_capture_photographs(p.out, p.list, LAMPS, &p.params, &acquisition));
    assert_true(warns(&acquisition, "ball at 288,120", "cut off by the picture's border"));
    relume_acquisition_destroy(&acquisition);
    test_folder_remove(p.folder);
}

static void highlights_that_do_not_tell(void **state)
{
    (void)state;
    struct photographs p;
    struct relume_acquisition acquisition;
    begin(&p);
    struct made_scene two = a_ball(0.1), rim = a_ball(0.1);
    two.second = (struct relume_vec3){-0.5, 0.1, 1};
    two.lamp = (struct relume_vec3){0.5, 0.1, 1};
    rim.lamp = (struct relume_vec3){0.42, 0, -1};
    photograph(&p, 0, a_ball(0.1));
    photograph(&p, 1, two);
    photograph(&p, 2, rim);
    photograph(&p, 3, a_ball(0.1));
    CHECK_OK(relume_capture_photographs(p.out, p.list, LAMPS, &p.params, &acquisition));
    assert_true(warns(&acquisition, "p1.png", "two highlights"));
    assert_true(warns(&acquisition, "p2.png", "rim"));
    assert_false(warns(&acquisition, "p0.png", "of the ball") ||
                 warns(&acquisition, "p3.png", "of the ball"));
    relume_acquisition_destroy(&acquisition);
    test_folder_remove(p.folder);
}

struct counted {
    struct relume_log log;
    int alike, lines;
};

static void count_alike(void *user, enum relume_level level, const char *text)
{
    struct counted *c = user;
    c->lines += level == RELUME_WARNING && strstr(text, "two highlights");
    c->alike += strstr(text, "the worst of 4 photographs like it") != NULL;
}

// Dozens of like warnings hid what mattered: they are one line, the list keeps all.
static void many_alike(void **state)
{
    (void)state;
    static const double circle[1][3] = {{0.55 * MADE_WIDTH, 0.5 * MADE_HEIGHT, 0.2 * MADE_WIDTH}};
    struct photographs p;
    struct relume_acquisition acquisition;
    struct counted counted = {.log = {.message = count_alike}};
    begin(&p);
    counted.log.user = &counted;
    p.params.log = &counted.log;
    p.params.ball = circle;
    for (int i = 0; i < LAMPS; i++) {
        struct made_scene two = a_ball(0.1);
        // one that stays is left out of the ball
        two.second = (struct relume_vec3){-0.5, 0.3 - 0.3 * i, 1};
        two.lamp = (struct relume_vec3){0.5, 0.1 + 0.1 * i, 1};
        photograph(&p, i, two);
    }
    CHECK_OK(relume_capture_photographs(p.out, p.list, LAMPS, &p.params, &acquisition));
    for (int i = 0; i < LAMPS; i++)
        assert_true(warns(&acquisition, strrchr(p.path[i], '/') + 1, "two highlights"));
    assert_int_equal(counted.lines, 1);
    assert_int_equal(counted.alike, 1);
    relume_acquisition_destroy(&acquisition);
    test_folder_remove(p.folder);
}

// ---------------------------------------------------------------- pictures

// A flat board of grey squares, facing up; `scene` says which. White where gain is large.
static void board(const struct photographs *p, int i, uint32_t scene, double gain)
{
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, WIDE, HIGH, 3));
    uint32_t seed = scene;
    double square[8 * 12];
    for (int k = 0; k < 8 * 12; k++)
        square[k] = gain * (0.1 + 0.6 * test_uniform(&seed));
    for (int k = 0; k < 3 * WIDE * HIGH; k++)
        image.data[k] = (float)fmin(square[k / 3 / WIDE / 4 * 12 + k / 3 % WIDE / 4], 1.0);
    save(p, i, &image);
}

static void begin_boards(struct photographs *p, char lights[128])
{
    begin(p);
    snprintf(lights, 128, "%s/lights.txt", p->folder);
    static const char text[] = "0.5 0 0.8\n-0.4 0.4 0.8\n-0.4 -0.4 0.8\n0 0 1\n";
    test_write(lights, text, sizeof text - 1);
    p->params.lights = lights;
    for (int i = 0; i < LAMPS; i++)
        board(p, i, 1, 1.0);
}

static void another_scene(void **state)
{
    (void)state;
    char lights[128];
    struct photographs p;
    struct relume_acquisition acquisition;
    begin_boards(&p, lights);
    board(&p, 2, 2, 1.0);
    CHECK_OK(relume_capture_photographs(p.out, p.list, LAMPS, &p.params, &acquisition));
    assert_true(warns(&acquisition, "p2.png", "seems to show another scene"));
    assert_int_equal(acquisition.lights, LAMPS);
    relume_acquisition_destroy(&acquisition);
    p.params.skip_bad = p.params.force = true;
    CHECK_OK(relume_capture_photographs(p.out, p.list, LAMPS, &p.params, &acquisition));
    assert_true(warns(&acquisition, "p2.png", "left out: shows another scene"));
    assert_int_equal(acquisition.lights, LAMPS - 1);
    CHECK_NEAR(acquisition.direction[2].z, 1.0, 1e-9);  // the others keep their lights
    relume_acquisition_destroy(&acquisition);
    test_folder_remove(p.folder);
}

static void nothing_but_white(void **state)
{
    (void)state;
    char lights[128];
    struct photographs p;
    begin_boards(&p, lights);
    for (int i = 0; i < LAMPS; i++)
        board(&p, i, 1, 20.0);
    expect_refused(&p, "all 4 photographs are overexposed; expected shorter exposures");
    test_folder_remove(p.folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_ball),
        cmocka_unit_test(many_alike),
        cmocka_unit_test(a_ball_that_is_cut_off),
        cmocka_unit_test(highlights_that_do_not_tell),
        cmocka_unit_test(another_scene),
        cmocka_unit_test(nothing_but_white),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
