// The viewer's state machine, options and scripts; no OpenGL
#include "app.h"
#include "options.h"
#include "script.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

static char said[1024];

static void keep_message(void *user, enum relume_level level, const char *text)
{
    (void)user, (void)level;
    snprintf(said, sizeof said, "%s", text);
}
static const struct relume_log keep = {.message = keep_message};

static struct app_file make_file(enum relume_projection projection)
{
    return (struct app_file){
        .geometry = {.projection = projection, .uv_z = 3},
        .width = 400,
        .height = 200,
        .views = projection == RELUME_SLAB ? 9 : 1,
        .uv_min = {-1, -0.5},
        .uv_max = {1, 0.5},
    };
}

static struct app make_app(enum relume_projection projection, bool look_ahead)
{
    const struct app_file file = make_file(projection);
    const struct app_state start = {0};
    struct app app;
    assert_int_equal(app_start(&app, &file, &start, look_ahead, NULL), RELUME_OK);
    return app;
}

static void drag(struct app *app, enum app_button button, double dx, double dy)
{
    const struct app_event press = {.kind = APP_PRESS, .button = button, .x = 50, .y = 50};
    const struct app_event move = {.kind = APP_MOVE, .x = 50 + dx, .y = 50 + dy};
    const struct app_event release = {.kind = APP_RELEASE, .button = button};
    assert_false(app_handle(app, &press));
    assert_true(app_handle(app, &move));
    assert_false(app_handle(app, &release));
    assert_false(app_handle(app, &(struct app_event){.kind = APP_MOVE, .x = 7, .y = 7}));
}

static bool key(struct app *app, int k)
{
    const bool changed = app_handle(app, &(struct app_event){.kind = APP_KEY_DOWN, .key = k});
    app_handle(app, &(struct app_event){.kind = APP_KEY_UP, .key = k});
    return changed;
}

// ---------------------------------------------------------------- start

static void framing_suits_the_file(void **state)
{
    (void)state;
    assert_int_equal(make_app(RELUME_PLANAR, true).now.camera.framing, RELUME_FRAME_VIEW);
    assert_int_equal(make_app(RELUME_SPHERICAL, false).now.camera.framing, RELUME_FRAME_VIEW);
    const struct app look = make_app(RELUME_CYLINDRICAL, true);
    assert_int_equal(look.now.camera.framing, RELUME_FRAME_LOOK);
    assert_int_equal(look.width, 1024);
    assert_int_equal(look.height, 512);
    const struct app slab = make_app(RELUME_SLAB, true);
    assert_int_equal(slab.now.camera.framing, RELUME_FRAME_EYE);
    assert_true(slab.now.camera.eye.x == 0 && slab.now.camera.eye.z == 3);
    assert_int_equal(slab.width, 400);
    assert_int_equal(slab.now.lights, 1);
    assert_true(slab.now.light[0].direction.z == 1 && slab.now.light[0].rgb[2] == 1);
}

static void cameras_that_do_not_fit_are_refused(void **state)
{
    (void)state;
    static const struct {
        enum relume_projection projection;
        enum relume_framing framing;
        int view;
    } wrong[] = {
        {RELUME_PLANAR, RELUME_FRAME_EYE, 0}, {RELUME_PLANAR, RELUME_FRAME_LOOK, 0},
        {RELUME_SLAB, RELUME_FRAME_LOOK, 0},  {RELUME_CUBE, RELUME_FRAME_EYE, 0},
        {RELUME_SLAB, RELUME_FRAME_VIEW, 9},  {RELUME_PLANAR, RELUME_FRAME_VIEW, 1},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const struct app_file file = make_file(wrong[i].projection);
        const struct app_state start = {
            .camera = {.framing = wrong[i].framing, .view = wrong[i].view}};
        struct app app;
        said[0] = '\0';
        assert_int_equal(app_start(&app, &file, &start, true, &keep), RELUME_EINVAL);
        assert_non_null(strstr(said, "expected"));
    }
}

// ---------------------------------------------------------------- mouse

static void the_slab_turns_with_the_cursor(void **state)
{
    (void)state;
    struct app app = make_app(RELUME_SLAB, true);
    drag(&app, APP_LEFT, 100, 0);  // a quarter of the frame: a quarter of the cameras' width
    assert_float_equal(app.now.camera.eye.x, -0.5, 1e-12);
    drag(&app, APP_LEFT, 0, 50);  // the object's front goes down: the eye sees it from above
    assert_float_equal(app.now.camera.eye.y, 0.25, 1e-12);
    drag(&app, APP_LEFT, 5000, -5000);
    assert_true(app.now.camera.eye.x == -1 && app.now.camera.eye.y == -0.5);
    assert_true(key(&app, ']'));
    assert_true(app.now.camera.eye.z > 3);
    for (int i = 0; i < 100; i++)
        key(&app, '[');
    assert_float_equal(app.now.camera.eye.z, 0.75, 1e-9);
}

static void the_panorama_follows_the_cursor(void **state)
{
    (void)state;
    struct app app = make_app(RELUME_SPHERICAL, true);
    drag(&app, APP_LEFT, -512, 0);  // half a frame of 90 degrees
    assert_float_equal(app.now.camera.look.pan_deg, 45, 1e-9);
    drag(&app, APP_LEFT, 0, 256);
    assert_float_equal(app.now.camera.look.tilt_deg, 22.5, 1e-9);
    drag(&app, APP_LEFT, 0, 9000);
    assert_true(app.now.camera.look.tilt_deg == 90);
    drag(&app, APP_LEFT, -2048, 0);
    assert_true(fabs(app.now.camera.look.pan_deg) <= 180);
    assert_true(app_handle(&app, &(struct app_event){.kind = APP_WHEEL, .wheel = 2}));
    assert_float_equal(app.now.camera.look.zoom, 1.21, 1e-9);
}

static void the_picture_moves_and_zooms_about_the_cursor(void **state)
{
    (void)state;
    struct app app = make_app(RELUME_PLANAR, true);
    struct app_rectangle p = app_picture(&app);
    assert_true(p.left == 0 && p.top == 0 && p.right == 400 && p.bottom == 200);
    drag(&app, APP_LEFT, 30, -20);
    p = app_picture(&app);
    assert_true(p.left == 30 && p.top == -20);
    const double fixed[2] = {(100 - p.left) / (p.right - p.left),
                             (50 - p.top) / (p.bottom - p.top)};
    app_handle(&app, &(struct app_event){.kind = APP_WHEEL, .wheel = 5, .x = 100, .y = 50});
    p = app_picture(&app);
    assert_float_equal((100 - p.left) / (p.right - p.left), fixed[0], 1e-12);
    assert_float_equal((50 - p.top) / (p.bottom - p.top), fixed[1], 1e-12);
    assert_true(p.right - p.left > 600);
}

static void windows_keep_the_proportions(void **state)
{
    (void)state;
    struct app app = make_app(RELUME_PLANAR, true);
    assert_true(
        app_handle(&app, &(struct app_event){.kind = APP_SIZE, .width = 800, .height = 800}));
    struct app_rectangle p = app_picture(&app);
    assert_true(p.right == 800 && p.bottom == 800);
    app.letterbox = true;
    p = app_picture(&app);
    assert_true(p.left == 0 && p.right == 800 && p.top == 200 && p.bottom == 600);
    assert_false(app_handle(&app, &(struct app_event){.kind = APP_SIZE}));
}

static void the_light_turns_like_a_ball(void **state)
{
    (void)state;
    struct app app = make_app(RELUME_PLANAR, true);
    drag(&app, APP_RIGHT, 100, 0);  // half the frame's shorter side: a quarter turn to the right
    struct relume_vec3 d = app.now.light[0].direction;
    assert_float_equal(d.x, 1, 1e-12);
    assert_float_equal(d.z, 0, 1e-12);
    key(&app, 'r');
    drag(&app, APP_RIGHT, 0, -50);  // up
    d = app.now.light[0].direction;
    assert_float_equal(d.y, sqrt(0.5), 1e-12);
    assert_float_equal(d.z, sqrt(0.5), 1e-12);
}

static void l_and_drag_turn_the_light_too(void **state)
{
    (void)state;
    struct app app = make_app(RELUME_PLANAR, true);
    app_handle(&app, &(struct app_event){.kind = APP_KEY_DOWN, .key = 'l'});
    drag(&app, APP_LEFT, -100, 0);
    assert_float_equal(app.now.light[0].direction.x, -1, 1e-12);
    app_handle(&app, &(struct app_event){.kind = APP_KEY_UP, .key = 'l'});
    drag(&app, APP_LEFT, 10, 0);
    assert_true(app.now.shift[0] == 10);
}

// In a panorama the light moves as seen on the screen, wherever one looks.
static void the_light_turns_as_seen_in_a_panorama(void **state)
{
    (void)state;
    struct app app = make_app(RELUME_SPHERICAL, true);
    app.now.camera.look = (struct relume_look){90, 30, 1};
    const struct relume_vec3 before = app_seen_light(&app, 0);
    assert_float_equal(before.x, 1, 1e-12);  // looking to +x, the light at +z is on the right
    drag(&app, APP_RIGHT, -256, 0);          // a quarter turn to the left: now behind the viewer
    const struct relume_vec3 after = app_seen_light(&app, 0);
    assert_float_equal(after.x, 0, 1e-12);
    assert_float_equal(after.y, 0, 1e-12);
    assert_float_equal(after.z, 1, 1e-12);
    const struct relume_vec3 world = app.now.light[0].direction;
    assert_float_equal(world.x, -sqrt(0.75), 1e-12);
    assert_float_equal(world.y, -0.5, 1e-12);
}

static void keys(void **state)
{
    (void)state;
    struct app app = make_app(RELUME_PLANAR, true);
    assert_true(key(&app, '+') && key(&app, '+') && key(&app, '-'));
    assert_float_equal(app.now.exposure_ev, 0.25, 1e-12);
    assert_true(key(&app, 'b'));
    assert_true(app.now.ball);
    assert_false(key(&app, '['));  // only a slab has an eye to move
    assert_false(key(&app, 'z'));  // has no meaning
    assert_true(key(&app, 'r'));
    assert_true(app.now.exposure_ev == 0 && !app.now.ball);
    assert_false(app.quit);
    key(&app, APP_KEY_ESCAPE);
    assert_true(app.quit);
}

// ---------------------------------------------------------------- options

enum { MOST = 16 };

static relume_status parse(struct options *o, const char *line)
{
    static char text[512];
    char *argv[MOST];
    int argc = 0;
    snprintf(text, sizeof text, "relume-view %s", line);
    for (char *word = strtok(text, " "); word && argc < MOST; word = strtok(NULL, " "))
        argv[argc++] = word;
    said[0] = '\0';
    return options_parse(o, argc, argv, &keep);
}

static void options_are_read(void **state)
{
    (void)state;
    struct options o;
    assert_int_equal(
        parse(&o, "a.exr --eye 1,-2,3.5 --size 800x600 --exposure=-1 --offscreen b.png"),
        RELUME_OK);
    assert_string_equal(o.file, "a.exr");
    assert_string_equal(o.offscreen, "b.png");
    assert_int_equal(o.start.camera.framing, RELUME_FRAME_EYE);
    assert_true(o.start.camera.eye.y == -2 && o.start.exposure_ev == -1);
    assert_true(o.start.camera.width == 800 && o.start.camera.height == 600);
    assert_int_equal(parse(&o, "--pan 20 --tilt -5 a.exr --zoom 2 --ball"), RELUME_OK);
    assert_int_equal(o.start.camera.framing, RELUME_FRAME_LOOK);
    assert_true(o.start.camera.look.tilt_deg == -5 && o.start.ball);
    char option[] = "--light";
    char first[] = "dir 1 0 1";
    char second[] = "dir 0 0 2 rgb 1 2 3";
    char file[] = "a.exr";
    char *lit[] = {file, file, option, first, option, second};
    assert_int_equal(options_parse(&o, 6, lit, &keep), RELUME_OK);
    assert_int_equal(o.start.lights, 2);
    assert_true(o.start.light[1].rgb[2] == 3);
    assert_int_equal(parse(&o, "--nonsense --help"), RELUME_OK);
    assert_null(o.file);
}

static void wrong_options_are_refused(void **state)
{
    (void)state;
    static const char *const wrong[][2] = {
        {"", "expected 'relume-view FILE'"},
        {"a.exr b.exr", "expected one FILE"},
        {"a.exr --exposrue 1", "did you mean '--exposure'"},
        {"a.exr --zzzzzzzzzzzz", "--help"},
        {"a.exr --view", "end of the line"},
        {"a.exr --view 1.5", "whole number"},
        {"a.exr --view x", "found 'x'"},
        {"a.exr --eye 1,2", "three numbers"},
        {"a.exr --eye 1,2,3,4", "three numbers"},
        {"a.exr --size 0x10", "WxH"},
        {"a.exr --size 10", "WxH"},
        {"a.exr --size 10x10x10", "WxH"},
        {"a.exr --zoom 0", "from"},
        {"a.exr --pan nan", "found 'nan'"},
        {"a.exr --view 0 --eye 0,0,3", "found two"},
        {"a.exr --ball=1", "takes no value"},
        {"a.exr --light up", ""},
    };
    struct options o;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(parse(&o, wrong[i][0]), RELUME_EINVAL);
        assert_non_null(strstr(said, wrong[i][1]));
        assert_true(said[0] != '\0');
    }
}

// ---------------------------------------------------------------- scripts

struct frames {
    int count;
    char path[4][64];
    struct app app[4];
};

static relume_status keep_frame(void *user, const struct app *app, const char *path)
{
    struct frames *f = user;
    snprintf(f->path[f->count], sizeof f->path[0], "%s", path);
    f->app[f->count++] = *app;
    return RELUME_OK;
}

static relume_status play(struct app *app, struct frames *frames, const char *text)
{
    char path[] = "/tmp/relume-script-XXXXXX";
    const int fd = mkstemp(path);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, text, strlen(text)), (ssize_t)strlen(text));
    close(fd);
    *frames = (struct frames){0};
    said[0] = '\0';
    const relume_status status = script_play(app, path, keep_frame, frames, &keep);
    unlink(path);
    return status;
}

static void scripts_play_events(void **state)
{
    (void)state;
    struct app app = make_app(RELUME_SLAB, false);
    static struct frames frames;
    assert_int_equal(play(&app, &frames,
                          "# a comment\r\n\n"
                          "size 800 600\n"
                          "  drag left 100 100 300 100\n"
                          "frame one.png\r\n"
                          "drag right 0 0 300 0\n"
                          "wheel 1\n"
                          "wheel -1 10 10\n"
                          "key +\n"
                          "frame \"two words.png\"\n"
                          "light \"dir 0 1 0 rgb 2 2 2\"\n"
                          "frame three.png\n"
                          "key esc\n"
                          "frame never.png"),
                     RELUME_OK);
    assert_int_equal(frames.count, 3);
    assert_string_equal(frames.path[1], "two words.png");
    assert_int_equal(frames.app[0].width, 800);
    assert_float_equal(frames.app[0].now.camera.eye.x, -0.5, 1e-12);
    assert_float_equal(frames.app[1].now.light[0].direction.x, 1, 1e-12);
    assert_true(frames.app[1].now.exposure_ev == 0.25);
    assert_true(frames.app[2].now.light[0].direction.y == 1 &&
                frames.app[2].now.light[0].rgb[0] == 2);
}

static void broken_scripts_name_the_line(void **state)
{
    (void)state;
    static const char *const wrong[] = {
        "jump",          "size 800",
        "size 0 5",      "drag up 1 2 3 4",
        "drag left 1 2", "wheel",
        "key enter",     "light \"lamp 1 2 3\"",
        "frame",         "drag left 1 2 3 x",
    };
    static struct frames frames;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char text[128];
        struct app app = make_app(RELUME_PLANAR, false);
        snprintf(text, sizeof text, "size 8 8\n%s\n", wrong[i]);
        assert_int_equal(play(&app, &frames, text), RELUME_EDATA);
        assert_non_null(strstr(said, "line 2; expected"));
    }
    struct app app = make_app(RELUME_PLANAR, false);
    assert_int_equal(script_play(&app, "/nonexistent/script", keep_frame, &frames, &keep),
                     RELUME_EDATA);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(framing_suits_the_file),
        cmocka_unit_test(cameras_that_do_not_fit_are_refused),
        cmocka_unit_test(the_slab_turns_with_the_cursor),
        cmocka_unit_test(the_panorama_follows_the_cursor),
        cmocka_unit_test(the_picture_moves_and_zooms_about_the_cursor),
        cmocka_unit_test(windows_keep_the_proportions),
        cmocka_unit_test(the_light_turns_like_a_ball),
        cmocka_unit_test(l_and_drag_turn_the_light_too),
        cmocka_unit_test(the_light_turns_as_seen_in_a_panorama),
        cmocka_unit_test(keys),
        cmocka_unit_test(options_are_read),
        cmocka_unit_test(wrong_options_are_refused),
        cmocka_unit_test(scripts_play_events),
        cmocka_unit_test(broken_scripts_name_the_line),
    };
    return cmocka_run_group_tests_name("app", tests, NULL, NULL);
}
