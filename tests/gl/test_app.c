// The viewer's state machine, options and scripts; no OpenGL
#include "app/app.h"
#include "app/events.h"
#include "common/vec.h"
#include "app/frame_request.h"
#include "app/gizmo.h"
#include "app/keys.h"
#include "app/light_list.h"
#include "app/script.h"
#include "cli/program/say.h"
#include "draw/visible_lights.h"
#include "owned.h"
#include "format/coder/coding.h"
#include "session/options.h"
#include "window/context.h"

#include <relume/relight/tone.h>

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
    OWNED_APP picture = make_app(RELUME_PLANAR, true);
    assert_int_equal(picture.now.camera.framing, RELUME_FRAME_VIEW);
    OWNED_APP unfolded = make_app(RELUME_SPHERICAL, false);
    assert_int_equal(unfolded.now.camera.framing, RELUME_FRAME_VIEW);
    OWNED_APP look = make_app(RELUME_CYLINDRICAL, true);
    assert_int_equal(look.now.camera.framing, RELUME_FRAME_LOOK);
    assert_int_equal(look.width, 1024);
    assert_int_equal(look.height, 512);
    OWNED_APP slab = make_app(RELUME_SLAB, true);
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
    OWNED_APP app = make_app(RELUME_SLAB, true);
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
    OWNED_APP app = make_app(RELUME_SPHERICAL, true);
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

static double angle(struct relume_vec3 a, struct relume_vec3 b)
{
    return 2 * asin(0.5 * hypot(hypot(a.x - b.x, a.y - b.y), a.z - b.z)) * 180 / acos(-1);
}

static struct relume_vec3 seen_at(const struct app *app, double x, double y)
{
    return relume_pan_tilt_ray(app->now.camera.look, app->width, app->height, x, y);
}

// A pixel of 1024 is a twentieth of a degree; where pan and tilt cannot hold the place, the middle
// stays.
static void a_panorama_zooms_about_the_cursor(void **state)
{
    (void)state;
    static const struct relume_pan_tilt looks[] = {
        {0, 0, 1, false}, {170, 20, 1.5, false}, {-60, -40, 1, false}, {40, 10, 1.5, true}};
    static const double cursors[][2] = {{512, 256}, {100, 400}, {1000, 30}, {700, 256}};
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++)
        for (size_t k = 0; k < sizeof cursors / sizeof *cursors; k++) {
            OWNED_APP app = make_app(RELUME_SPHERICAL, true);
            app.now.camera.look = looks[i];
            const double x = cursors[k][0], y = cursors[k][1];
            const struct relume_vec3 before = seen_at(&app, x, y);
            app_handle(&app, &(struct app_event){.kind = APP_WHEEL, .wheel = 3, .x = x, .y = y});
            assert_float_equal(app.now.camera.look.zoom, looks[i].zoom * 1.331, 1e-9);
            assert_true(angle(before, seen_at(&app, x, y)) < 0.05);
        }
    OWNED_APP app = make_app(RELUME_SPHERICAL, true);
    app.now.camera.look = (struct relume_pan_tilt){0, -90, 0.5, true};
    app_handle(&app, &(struct app_event){.kind = APP_WHEEL, .wheel = 3, .x = 512, .y = 400});
    assert_true(app.now.camera.look.tilt_deg == -90);
}

static void fields_of_view_have_limits(void **state)
{
    (void)state;
    for (int stereographic = 0; stereographic < 2; stereographic++) {
        const double widest = stereographic ? 340 : 150;
        const double field = stereographic ? 4 : 2;
        OWNED_APP app = make_app(RELUME_SPHERICAL, true);
        app.now.camera.look.stereographic = stereographic;
        const struct relume_pan_tilt *look = &app.now.camera.look;
        const struct app_event out = {.kind = APP_WHEEL, .wheel = -100, .x = 512, .y = 256};
        const struct app_event in = {.kind = APP_WHEEL, .wheel = 100, .x = 512, .y = 256};
        app_handle(&app, &out);
        assert_float_equal(field * atan(1 / look->zoom) * 180 / acos(-1), widest, 0.01);
        app_handle(&app, &in);
        assert_float_equal(field * atan(1 / look->zoom) * 180 / acos(-1), field, 0.01);
    }
}

// ---------------------------------------------------------------- time

// A drag of `dx` pixels in a fifth of a second.
static void throw_panorama(struct app *app, double dx, double dy)
{
    app_handle(app, &(struct app_event){.kind = APP_PRESS, .x = 500, .y = 250});
    for (int i = 1; i <= 10; i++) {
        app_handle(app, &(struct app_event){
                            .kind = APP_MOVE, .x = 500 + dx * i / 10, .y = 250 + dy * i / 10});
        assert_false(app_advance(app, 0.02));  // what the hand does, the hand has shown
    }
    app_handle(app, &(struct app_event){.kind = APP_RELEASE});
}

static void a_panorama_glides_to_a_stop(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_SPHERICAL, true);
    throw_panorama(&app, -100, 0);
    const double released = app.now.camera.look.pan_deg;
    assert_float_equal(released, 100 * 90.0 / 1024, 1e-9);
    double before = released, step = INFINITY;
    int frames = 0;
    for (; app_advance(&app, 1.0 / 60); frames++) {
        const double pan = app.now.camera.look.pan_deg;
        assert_true(pan > before && pan - before < step);  // ever slower
        step = pan - before;
        before = pan;
    }
    assert_true(frames > 20 && frames < 200);
    assert_true(step < 0.02);  // degrees in a frame: no jolt at the end
    // 500 pixels a second, all but lost in 0.35 s: 175 pixels at most, the hand's mean being below
    const double way = (before - released) / 90 * 1024;
    assert_true(way > 160 && way < 175);
    assert_true(app.now.camera.look.tilt_deg == 0);
    for (int i = 0; i < 10; i++)
        assert_false(app_advance(&app, 1));
    assert_true(app.now.camera.look.pan_deg == before);
}

static void a_glide_does_not_depend_on_frames(void **state)
{
    (void)state;
    OWNED_APP fast = make_app(RELUME_SPHERICAL, true);
    struct app slow = fast;
    throw_panorama(&fast, -100, 40);
    throw_panorama(&slow, -100, 40);
    for (int i = 0; i < 60; i++)
        app_advance(&fast, 0.005);
    for (int i = 0; i < 3; i++)
        app_advance(&slow, 0.1);
    assert_float_equal(fast.now.camera.look.pan_deg, slow.now.camera.look.pan_deg, 1e-9);
    assert_float_equal(fast.now.camera.look.tilt_deg, slow.now.camera.look.tilt_deg, 1e-9);
}

static void a_hand_that_rests_lets_go_of_nothing(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_SPHERICAL, true);
    app_handle(&app, &(struct app_event){.kind = APP_PRESS, .x = 500, .y = 250});
    app_handle(&app, &(struct app_event){.kind = APP_MOVE, .x = 400, .y = 250});
    app_advance(&app, 0.02);
    app_advance(&app, 1);
    app_handle(&app, &(struct app_event){.kind = APP_RELEASE});
    assert_false(app_advance(&app, 0.1));
    // a touch stops a glide; a drag in no time at all has no speed
    throw_panorama(&app, -100, 0);
    assert_true(app_advance(&app, 0.01));
    drag(&app, APP_LEFT, 10, 0);
    assert_false(app_advance(&app, 0.1));
    OWNED_APP slab = make_app(RELUME_SLAB, true);
    drag(&slab, APP_LEFT, 10, 0);
    assert_false(app_advance(&slab, 0.1));
    assert_false(app_advance(&slab, 0));
    assert_false(app_advance(&slab, NAN));
}

static void automatic_exposure_adapts(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, true);
    app.now.auto_exposure = true;
    app.now.exposure_ev = 1;
    app_meter(&app, 2);  // the first frame: at once, and a stop brighter as the user wants it
    assert_float_equal(app_exposure_ev(&app), 4, 1e-12);
    app_meter(&app, -1);
    assert_false(app_advance(&app, 1));
    app_meter(&app, -3);  // two stops too bright
    struct app slow = app;
    assert_true(app_advance(&app, 0.5));
    assert_float_equal(app_exposure_ev(&app), 2 + 2 * exp(-1), 1e-9);
    for (int i = 0; i < 5; i++)
        app_advance(&slow, 0.1);
    assert_float_equal(app_exposure_ev(&slow), app_exposure_ev(&app), 1e-9);
    int frames = 0;
    while (app_advance(&app, 0.1))
        assert_true(++frames < 100);
    assert_float_equal(app_exposure_ev(&app), 2, 0.02);
    assert_true(key(&app, 'e'));
    assert_true(app_exposure_ev(&app) == 1);
    assert_true(key(&app, 'e'));
    app_meter(&app, 2);
    assert_true(app_exposure_ev(&app) == 1);  // from here on gently
    assert_true(app_advance(&app, 0.1) && app_exposure_ev(&app) > 1.1);
}

static void the_picture_moves_and_zooms_about_the_cursor(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, true);
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
    OWNED_APP app = make_app(RELUME_PLANAR, true);
    assert_true(
        app_handle(&app, &(struct app_event){.kind = APP_SIZE, .width = 800, .height = 800}));
    const struct app_rectangle p = app_picture(&app);
    assert_true(p.left == 0 && p.right == 800 && p.top == 200 && p.bottom == 600);
    assert_false(app_handle(&app, &(struct app_event){.kind = APP_SIZE}));
}

static void one_side_gives_the_other(void **state)
{
    (void)state;
    const struct app_file file = make_file(RELUME_PLANAR);
    const struct app_state start = {.camera = {.height = 3 * file.height}};
    OWNED_APP app = {0};
    assert_int_equal(app_start(&app, &file, &start, true, NULL), RELUME_OK);
    assert_true(app.width == 3 * file.width && app.height == 3 * file.height);
}

static void the_light_turns_like_a_ball(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, true);
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
    OWNED_APP app = make_app(RELUME_PLANAR, true);
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
    OWNED_APP app = make_app(RELUME_SPHERICAL, true);
    app.now.camera.look = (struct relume_pan_tilt){90, 30, 1, false};
    const struct relume_vec3 before = app_light_direction(&app, 0);
    assert_float_equal(before.x, 1, 1e-12);  // looking to +x, the light at +z is on the right
    drag(&app, APP_RIGHT, -256, 0);          // a quarter turn to the left: now behind the viewer
    const struct relume_vec3 after = app_light_direction(&app, 0);
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
    OWNED_APP app = make_app(RELUME_PLANAR, true);
    assert_true(key(&app, '+') && key(&app, '+') && key(&app, '-'));
    assert_float_equal(app.now.exposure_ev, 0.25, 1e-12);
    assert_true(key(&app, 'b'));
    assert_true(app.now.ball);
    static const int of_slabs_and_panoramas[] = {'[', ']', 'a', 'd', ',', '.', 'o'};
    for (size_t i = 0; i < sizeof of_slabs_and_panoramas / sizeof(int); i++)
        assert_false(key(&app, of_slabs_and_panoramas[i]));
    for (int i = 1; relume_tones[i]; i++)
        assert_true(key(&app, 't') && app.now.tone == i);
    assert_true(key(&app, 't') && app.now.tone == 0);
    assert_false(key(&app, 'q'));  // has no meaning
    assert_true(key(&app, 'r'));
    assert_true(app.now.exposure_ev == 0 && !app.now.ball);
    assert_false(app.quit);
    key(&app, APP_KEY_ENTER);
    assert_false(app.quit);
    key(&app, APP_CONTROL | 's');
    assert_int_equal(app.action, APP_ACTION_PNG);
    key(&app, APP_KEY_F11);
    assert_int_equal(app.action, APP_ACTION_FULL_SCREEN);
    key(&app, APP_CONTROL | 'q');
    assert_true(app.quit);
}

// Esc closes one thing after the other; only then it asks, and only Enter means yes.
static void escape_never_quits_unasked(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, true);
    app.panel = app.inspect = true;
    key(&app, '?');
    assert_true(key(&app, APP_KEY_ESCAPE) && !app.help && app.inspect && app.panel);
    assert_true(key(&app, APP_KEY_ESCAPE) && !app.inspect && app.panel && !app.asks);
    assert_true(key(&app, APP_KEY_ESCAPE) && !app.panel && !app.asks);
    assert_true(key(&app, APP_KEY_ESCAPE) && app.asks && !app.quit);
    assert_true(key(&app, APP_KEY_ESCAPE) && !app.asks && !app.quit);
    key(&app, APP_KEY_ESCAPE);
    assert_true(key(&app, 'z') && !app.asks &&
                app.now.light_state[0].solo);  // whoever goes on stays
    assert_false(app.quit);
    key(&app, APP_KEY_ESCAPE);
    key(&app, APP_KEY_ENTER);
    assert_true(app.quit);
}

// Nobody can answer a script: its Esc closes what is open, then quits.
static void escape_of_a_script_is_not_asked_about(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, true);
    const struct app_event escape = {.kind = APP_KEY_DOWN, .key = APP_KEY_ESCAPE, .unasked = true};
    app.help = true;
    app_handle(&app, &escape);
    assert_false(app.help || app.quit);
    app_handle(&app, &escape);
    assert_true(app.quit);
}

// ---------------------------------------------------------------- over and beside the picture

static void the_ball_in_the_corner_turns_the_light(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, true);  // 400 x 200: 18 pixels around (374.8, 174.8)
    const struct gizmo_circle ball = gizmo_ball(&app);
    const struct app_event press = {
        .kind = APP_PRESS, .x = ball.x + 0.6 * ball.radius, .y = ball.y - 0.3 * ball.radius};
    const struct app_event move = {.kind = APP_MOVE, .x = ball.x - 9000, .y = ball.y};
    assert_false(app_handle(&app, &press));  // it is not there: the picture is moved
    app_handle(&app, &(struct app_event){.kind = APP_RELEASE});
    app.now.ball = true;
    assert_true(app_handle(&app, &press));
    struct relume_vec3 d = app.now.light[0].direction;
    assert_float_equal(d.x, 0.6, 1e-12);
    assert_float_equal(d.y, 0.3, 1e-12);
    assert_float_equal(d.z, sqrt(1 - 0.45), 1e-12);
    assert_true(app_handle(&app, &move));  // beyond the rim: from the side
    d = app.now.light[0].direction;
    assert_float_equal(d.x, -1, 1e-12);
    assert_float_equal(d.z, 0, 1e-12);
    assert_true(app.now.shift[0] == 0);
    app_handle(&app, &(struct app_event){.kind = APP_RELEASE});
    drag(&app, APP_LEFT, 10, 0);
    assert_true(app.now.shift[0] == 10 && app.now.light[0].direction.x < -0.99);
}

static void notes_fade(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, true);
    assert_true(isinf(app_steady_s(&app)));
    assert_false(app_fade(&app, 1));
    app.hint_s = 8;
    app.toast_s = 4;
    const double steady = app_steady_s(&app);
    assert_true(steady > 3 && steady < 4);
    assert_false(app_fade(&app, steady - 0.1));
    assert_true(app_note_alpha(app.toast_s) == 1);
    assert_true(app_fade(&app, 0.3));
    assert_true(app_note_alpha(app.toast_s) < 1 && app_note_alpha(app.toast_s) > 0);
    assert_true(app_fade(&app, 1));
    assert_true(app.toast_s == 0 && app_note_alpha(app.hint_s) == 1);
    app_handle(&app, &(struct app_event){.kind = APP_PRESS, .x = 5, .y = 5});
    assert_true(app.hint_s == 0);  // whoever has begun needs no hint
    assert_true(isinf(app_steady_s(&app)));
}

// The frame keeps what the panel leaves of the window, and its events their places.
static void a_panel_stands_beside_the_picture(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, true);
    app.dock_width = 150;
    app.dock = APP_DOCK_LEFT;
    key(&app, APP_KEY_TAB);
    assert_true(app.width == 250 && app.beside[0] == 150 && app_window_width(&app) == 400);
    app_handle(&app, &(struct app_event){.kind = APP_MOVE, .x = 200, .y = 10});
    assert_true(app.cursor[0] == 50);
    app_handle(&app, &(struct app_event){.kind = APP_SIZE, .width = 600, .height = 300});
    assert_true(app.width == 450 && app.height == 300);
    app.dock = APP_DOCK_RIGHT;
    app_arrange(&app);
    assert_true(app.beside[0] == 0 && app.beside[1] == 150 && app.width == 450);
    key(&app, APP_KEY_TAB);
    assert_true(app.width == 600 && app.beside[1] == 0);
    key(&app, APP_KEY_TAB);
    app_handle(&app, &(struct app_event){.kind = APP_SIZE, .width = 290, .height = 300});
    assert_true(app.width == 290);  // too narrow for both: over the picture
}

static void keys_of_a_slab(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_SLAB, true);
    double want = 0.25;  // an eighth of the cameras' extent of 2
    for (int i = 0; i < 4; i++, want *= 2)
        assert_true(key(&app, 'a') && app.now.aperture == want);
    assert_true(key(&app, 'a') && app.now.aperture == 0);
    assert_true(app.now.focus_z == 0);
    for (int i = 0; i < 500; i++)
        key(&app, '.');
    assert_true(app.now.focus_z < -1);
    for (int i = 0; i < 5000; i++)
        key(&app, ',');
    assert_true(app.now.focus_z > 2 && app.now.focus_z < 3);  // never behind the cameras
    assert_true(key(&app, 'd') && app.now.interpolation == RELUME_INTERPOLATE_LINEAR);
    assert_true(key(&app, 'd') && app.now.interpolation == RELUME_INTERPOLATE_CONSTANT);
    assert_true(key(&app, 'd') && app.now.interpolation == RELUME_INTERPOLATE_DEFAULT);
}

static void a_planet_and_back(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_CUBE, true);
    app.now.camera.look = (struct relume_pan_tilt){30, 10, 2, false};
    assert_true(key(&app, 'o'));
    const struct relume_pan_tilt planet = app.now.camera.look;
    assert_true(planet.stereographic && planet.tilt_deg == -90 && planet.pan_deg == 30);
    assert_true(key(&app, 'o'));
    assert_false(app.now.camera.look.stereographic);
    assert_true(app.now.camera.look.tilt_deg == 10 && app.now.camera.look.zoom == 2);
}

static void a_focus_behind_the_cameras_is_refused(void **state)
{
    (void)state;
    const struct app_file file = make_file(RELUME_SLAB);
    struct app_state start = {.focused = true, .focus_z = 3};
    OWNED_APP app;
    said[0] = '\0';
    assert_int_equal(app_start(&app, &file, &start, true, &keep), RELUME_EINVAL);
    assert_non_null(strstr(said, "--focus: expected"));
    start.focus_z = -2;
    assert_int_equal(app_start(&app, &file, &start, true, &keep), RELUME_OK);
    assert_true(app.now.focus_z == -2);
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
    assert_int_equal(parse(&o, "a.exr --size 640"), RELUME_OK);
    assert_true(o.start.camera.width == 640 && o.start.camera.height == 0);
    assert_int_equal(parse(&o, "a.exr --size x480"), RELUME_OK);
    assert_true(o.start.camera.width == 0 && o.start.camera.height == 480);
    assert_int_equal(parse(&o, "--pan 20 --tilt -5 a.exr --zoom 2 --ball"), RELUME_OK);
    assert_int_equal(o.start.camera.framing, RELUME_FRAME_LOOK);
    assert_true(o.start.camera.look.tilt_deg == -5 && o.start.ball);
    assert_int_equal(parse(&o, "a.exr --exposure auto --tone filmic --white 8"), RELUME_OK);
    assert_true(o.start.auto_exposure && o.start.tone == 2 && o.start.white == 8);
    assert_int_equal(parse(&o, "a.exr --projection planet --pan 5"), RELUME_OK);
    assert_true(o.start.camera.look.stereographic && o.start.camera.look.tilt_deg == -90);
    assert_int_equal(parse(&o, "a.exr --interpolate constant --aperture 0.5 --focus -1"),
                     RELUME_OK);
    assert_int_equal(o.start.interpolation, RELUME_INTERPOLATE_CONSTANT);
    assert_true(o.start.aperture == 0.5 && o.start.focused && o.start.focus_z == -1);
    char option[] = "--light";
    char first[] = "dir 1 0 1";
    char second[] = "dir 0 0 2 rgb 1 2 3";
    char file[] = "a.exr";
    char *lit[] = {file, file, option, first, option, second};
    assert_int_equal(options_parse(&o, 6, lit, &keep), RELUME_OK);
    assert_int_equal(relume_rig_count(o.rig), 2);
    assert_true(relume_rig_entry(o.rig, 1)->light.rgb[2] == 3);
    options_release(&o);
    assert_int_equal(parse(&o, "--nonsense --help"), RELUME_OK);
    assert_null(o.file);
}

static void wrong_options_are_refused(void **state)
{
    (void)state;
    static const char *const wrong[][2] = {
        {"--offscreen b.png", "expected 'relume-view FILE'"},
        {"--record sweep -o b", "expected 'relume-view FILE'"},
        {"a.exr --dock top", "unknown --dock 'top'"},
        {"a.exr b.exr", "expected one FILE"},
        {"a.exr --exposrue 1", "did you mean '--exposure'"},
        {"a.exr --zzzzzzzzzzzz", "--help"},
        {"a.exr --view", "after it; found none"},
        {"a.exr --view 1.5", "whole number"},
        {"a.exr --view x", "found 'x'"},
        {"a.exr --eye 1,2", "three numbers"},
        {"a.exr --eye 1,2,3,4", "three numbers"},
        {"a.exr --eye 1,2,3 --look-at 1,2", "three numbers"},
        {"a.exr --eye 1,2,3 --fov 180", "from 0.01 to 179"},
        {"a.exr --up 0,1,0", "need --eye"},
        {"a.exr --size 0x10", "WxH"},
        {"a.exr --size x", "WxH"},
        {"a.exr --size 10x10x10", "WxH"},
        {"a.exr --zoom 0", "from"},
        {"a.exr --pan nan", "found 'nan'"},
        {"a.exr --view 0 --eye 0,0,3", "found two"},
        {"a.exr --ball=1", "takes no value"},
        {"a.exr --exposure bright", "found 'bright'"},
        {"a.exr --tone sepia", "filmic"},
        {"a.exr --white 0", "from"},
        {"a.exr --projection flat", "planet"},
        {"a.exr --projection planet --eye 0,0,3", "found two"},
        {"a.exr --interpolate cubic", "constant linear depth"},
        {"a.exr --aperture -1", "from"},
        {"a.exr --glare-magnify 0", "from 0.01 to 1000"},
        {"a.exr --nits nan", "found 'nan'"},
        {"a.exr --squint 1", "0 to 0.95"},
        {"a.exr --glare-mode quick", "hybrid"},
        {"a.exr --glare-size 63", "from 128"},
        {"a.exr --glare-size 129", "even"},
        {"a.exr --glare-by hand", "passes"},
        {"a.exr --light up", ""},
    };
    struct options o;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(parse(&o, wrong[i][0]), RELUME_EINVAL);
        assert_non_null(strstr(said, wrong[i][1]));
        assert_true(said[0] != '\0');
        options_release(&o);
    }
}

// ---------------------------------------------------------------- scripts

struct frames {
    struct app *app;
    int count;
    char path[4][64];
    struct app at[4];
    struct relume_light light[4][2];  // the first of them
    double waited;
};

static void host_send(void *user, const struct app_event *event)
{
    app_handle(((struct frames *)user)->app, event);
}

static relume_status host_light(void *user, const char *spec, bool replace,
                                const struct relume_log *log)
{
    struct app *app = ((struct frames *)user)->app;
    relume_rig *rig;
    assert_int_equal(relume_rig_create(&rig), RELUME_OK);
    const relume_status status = relume_rig_add(rig, spec, NULL, log);
    if (!status && replace)
        app->now.lights = 0;
    if (!status)
        assert_true(light_list_add(&app->now, &relume_rig_entry(rig, 0)->light, -1));
    relume_rig_destroy(&rig);
    return status;
}

static relume_status host_rig(void *user, const char *path, const struct relume_log *log)
{
    (void)user, (void)path, (void)log;
    return RELUME_OK;
}

static relume_status host_open(void *user, const char *path, const struct relume_log *log)
{
    (void)user, (void)log;
    return strcmp(path, "none.exr") ? RELUME_OK
                                    : say(log, RELUME_ENOTFOUND, "none.exr: no such file");
}

static relume_status host_wait(void *user, double seconds)
{
    struct frames *f = user;
    f->waited = seconds;
    for (double left = seconds; left > 0; left -= 1.0 / 60)
        (void)app_advance(f->app, fmin(left, 1.0 / 60));
    return RELUME_OK;
}

static relume_status host_frame(void *user, const char *path)
{
    struct frames *f = user;
    snprintf(f->path[f->count], sizeof f->path[0], "%s", path);
    for (int i = 0; i < 2 && i < f->app->now.lights; i++)
        f->light[f->count][i] = f->app->now.light[i];
    f->at[f->count++] = *f->app;
    return RELUME_OK;
}

static relume_status host_glare(void *user, const char *words, const char **expected)
{
    struct app *app = ((struct frames *)user)->app;
    return observer_say(&app->now.observer, words, expected) ? RELUME_OK : RELUME_EFORMAT;
}

static struct script_host host_of(struct frames *frames)
{
    return (struct script_host){frames,     frames->app, host_send,  host_light, host_rig,
                                host_open,  host_wait,   host_frame, host_frame, &keep,
                                host_glare, host_open,   host_open};
}

static relume_status play(struct app *app, struct frames *frames, const char *text)
{
    char path[] = "/tmp/relume-script-XXXXXX";
    const int fd = mkstemp(path);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, text, strlen(text)), (ssize_t)strlen(text));
    close(fd);
    *frames = (struct frames){.app = app};
    said[0] = '\0';
    const struct script_host host = host_of(frames);
    const relume_status status = script_play(path, &host);
    unlink(path);
    return status;
}

// The eye's time is that of the app while it looks.
static void scripts_let_an_eye_live(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_SPHERICAL, true);
    static struct frames frames;
    assert_int_equal(play(&app, &frames,
                          "wait 1\nglare on\nglare squint 0.3\nwait 0.5\nglare pause\nwait 1\n"
                          "glare run\nkey h\nwait 1\nglare on\nwait 0.25\nframe a\n"),
                     RELUME_OK);
    assert_float_equal(frames.at[0].eye_s, 0.75, 1e-9);
    assert_true(frames.at[0].now.observer.on && frames.at[0].now.observer.squint == 0.3);
    app_reset(&app);
    assert_false(app.now.observer.on);
    assert_int_equal(play(&app, &frames, "glare\n"), RELUME_EFORMAT);
    assert_int_equal(play(&app, &frames, "\nglare squint 2\n"), RELUME_EFORMAT);
    assert_non_null(strstr(said, "line 2, column 7; expected how far"));
}

static void scripts_play_events(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_SLAB, false);
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
    assert_int_equal(frames.at[0].width, 800);
    assert_float_equal(frames.at[0].now.camera.eye.x, -0.5, 1e-12);
    assert_float_equal(frames.light[1][0].direction.x, 1, 1e-12);
    assert_true(frames.at[1].now.exposure_ev == 0.25);
    assert_true(frames.light[2][0].direction.y == 1 && frames.light[2][0].rgb[0] == 2);
}

// A drag that takes time throws the panorama; waiting lets it glide.
static void scripts_let_time_pass(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_SPHERICAL, true);
    static struct frames frames;
    assert_int_equal(play(&app, &frames,
                          "drag left 500 250 400 250 0.2\n"
                          "frame let-go.png\n"
                          "wait 0.1\n"
                          "frame gliding.png\n"
                          "wait 10\n"
                          "frame stopped.png\n"
                          "wait 10\n"
                          "frame stopped.png\n"),
                     RELUME_OK);
    double pan[4];
    for (int i = 0; i < 4; i++)
        pan[i] = frames.at[i].now.camera.look.pan_deg;
    assert_float_equal(pan[0], 100 * 90.0 / 1024, 1e-9);
    assert_true(pan[1] > pan[0] + 1 && pan[2] > pan[1] + 1 && pan[3] == pan[2]);
}

static void scripts_set_numbers(void **state)
{
    (void)state;
    static struct frames frames;
    OWNED_APP slab = make_app(RELUME_SLAB, true);
    assert_int_equal(play(&slab, &frames,
                          "set gain 3.5\nset highlight 1\nset exponent 20\nset radius 7\n"
                          "set range 0.1 0.4\nset exposure -1\nset eye 0.5 0.25 2\n"
                          "set aperture 0.5\nset focus 0.3\nset zoom 2\npass unsharp\nframe a\n"),
                     RELUME_OK);
    const struct app_state *s = &frames.at[0].now;
    assert_true(s->enhance.gain == 3.5f && s->enhance.specular == 1 && s->enhance.exponent == 20);
    assert_true(s->enhance.radius == 7 && s->enhance.low == 0.1f && s->enhance.top == 0.4f);
    assert_true(s->exposure_ev == -1 && s->camera.eye.x == 0.5 && s->camera.eye.z == 2);
    assert_true(s->aperture == 0.5 && s->focus_z == 0.3 && s->zoom == 2);
    assert_int_equal(s->pass, RELUME_PASS_UNSHARP);
    OWNED_APP look = make_app(RELUME_SPHERICAL, true);
    assert_int_equal(play(&look, &frames, "set pan 30\nset tilt -9\nset zoom 3\nframe a\n"),
                     RELUME_OK);
    assert_true(frames.at[0].now.camera.look.pan_deg == 30 && frames.at[0].now.zoom == 1);
    assert_true(frames.at[0].now.camera.look.tilt_deg == -9 &&
                frames.at[0].now.camera.look.zoom == 3);
    assert_int_equal(play(&look, &frames, "set aperture 1\n"), RELUME_EFORMAT);
    assert_non_null(strstr(said, "line 1, column 5; expected aperture A, of a slab"));
    assert_true(look.now.aperture == 0);
}

// F, then the next press is a place to focus on; the drag that follows moves nothing.
static void the_next_click_is_in_focus(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_SLAB, true);
    const double x = app.now.camera.eye.x;
    assert_true(key(&app, 'f') && app.picks_focus);
    app_handle(&app, &(struct app_event){.kind = APP_PRESS, .x = 120, .y = 70});
    app_handle(&app, &(struct app_event){.kind = APP_MOVE, .x = 150, .y = 70});
    assert_int_equal(app.action, APP_ACTION_FOCUS);
    assert_true(!app.picks_focus && app.now.camera.eye.x == x);
    key(&app, 'f');
    key(&app, APP_KEY_ESCAPE);
    assert_false(app.picks_focus || app.asks);
    OWNED_APP picture = make_app(RELUME_PLANAR, true);
    key(&picture, 'f');
    assert_false(picture.picks_focus);
}

// A plane that leans, z = 0.2 + 0.1 x, as nine cameras at z = 3 see it through the window of +-1 on
// z = 0.
static relume_status leaning_plane(struct relume_image *out, void *user, int view)
{
    const double(*uv)[2] = user;
    const relume_status status = relume_image_create(out, 400, 200, 3);
    for (int i = 0; !status && i < 400 * 200; i++) {
        const double s = 2 * (i % 400 + 0.5) / 400 - 1, t = 1 - 2 * (i / 400 + 0.5) / 200;
        // from (u, v, 3) towards (s, t, 0): z = 3 (1 - k), x = u + k (s - u)
        const double u = uv[view][0], v = uv[view][1];
        const double k = (2.8 - 0.1 * u) / (3 + 0.1 * (s - u));
        out->data[3 * i] = (float)(u + k * (s - u));
        out->data[3 * i + 1] = (float)(v + k * (t - v));
        out->data[3 * i + 2] = (float)(3 - 3 * k);
    }
    return status;
}

static void a_click_finds_the_surface(void **state)
{
    (void)state;
    double uv[9][2];
    for (int i = 0; i < 9; i++) {
        uv[i][0] = i % 3 - 1;
        uv[i][1] = 0.5 * (i / 3 - 1);
    }
    OWNED_APP app = make_app(RELUME_SLAB, true);
    memcpy(app.file.geometry.st_min, (double[]){-1, -1}, sizeof app.file.geometry.st_min);
    memcpy(app.file.geometry.st_max, (double[]){1, 1}, sizeof app.file.geometry.st_max);
    struct hiding_scene scene = {
        .source = {.user = uv, .surface = leaning_plane}, .uv = (const double(*)[2])uv, .views = 9};
    static const double eyes[][2] = {{0, 0}, {0.4, -0.2}, {-0.7, 0.45}};
    struct frame_request q = {0};
    for (int i = 0; i < 3; i++) {
        const struct relume_vec3 eye = {eyes[i][0], eyes[i][1], 3};
        struct relume_vec3 p;
        app.now.camera.eye = eye;
        assert_int_equal(frame_request_make(&q, &app), RELUME_OK);
        assert_true(visible_surface(&p, &q, &scene, 300, 50));  // s = 0.5, t = 0.5
        // a pixel of a view is 0.005 wide, and the plane leans by a tenth of that
        assert_float_equal(p.z, 0.2 + 0.1 * p.x, 2e-3);
        const double k = (3 - p.z) / 3;
        assert_float_equal(p.x, eye.x + k * (0.5 - eye.x), 1e-9);
        assert_float_equal(p.y, eye.y + k * (0.5 - eye.y), 1e-9);
    }
    hiding_scene_forget(&scene);
    scene.source.surface = NULL;
    struct relume_vec3 p;
    assert_false(visible_surface(&p, &q, &scene, 300, 50));
    frame_request_free(&q);
    hiding_scene_forget(&scene);
}

static void broken_scripts_name_the_line(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        int column;
    } wrong[] = {
        {"jump", 1},
        {"size 800", 9},
        {"  size 0 5", 8},
        {"size 1e9 5", 6},
        {"size 5 5 5", 10},
        {"drag up 1 2 3 4", 6},
        {"drag left 1 2", 14},
        {"drag left 1 2 3 x", 17},
        {"wheel", 6},
        {"wheel 1 2", 10},
        {"wheel 1 2 nan", 11},
        {"key return", 5},
        {"key", 4},
        {"light \"lamp 1 2 3\"", 7},
        {"open", 5},
        {"open none.exr", 6},
        {"frame", 6},
        {"shot  ", 7},
        {"wait -1", 6},
        {"wait soon", 6},
        {"drag left 1 2 3 4 -1", 21},
        {"click 1", 8},
        {"press middle 1 1", 7},
        {"key ctrl+", 5},
        {"key ctrl+qq", 5},
        {"dock top", 6},
        {"set", 4},
        {"set gain", 5},
        {"set gain 0", 5},
        {"set gain 3 4", 5},
        {"set radius 2.5", 5},
        {"set range 2 1", 5},
        {"set brightness 2", 5},
        {"set exposure nan", 5},
        {"set eye 1 2 3", 5},
        {"pass difference", 6},
        {"hint 3", 6},
    };
    static struct frames frames;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char text[128];
        char place[64];
        OWNED_APP app = make_app(RELUME_PLANAR, false);
        snprintf(text, sizeof text, "size 8 8\n%s\n", wrong[i].line);
        snprintf(place, sizeof place, "line 2, column %d; ", wrong[i].column);
        assert_true(relume_status_is_input(play(&app, &frames, text)));
        if (!strstr(said, place))
            fail_msg("'%s' said '%s'", wrong[i].line, said);
    }
    OWNED_APP app = make_app(RELUME_PLANAR, false);
    frames.app = &app;
    const struct script_host host = host_of(&frames);
    assert_int_equal(script_play("/nonexistent/script", &host), RELUME_ENOTFOUND);
    assert_int_equal(script_play("/tmp", &host), RELUME_ENOTFOUND);
}

static void long_lines_are_refused(void **state)
{
    (void)state;
    static char text[8192];
    static struct frames frames;
    OWNED_APP app = make_app(RELUME_PLANAR, false);
    memset(text, ' ', sizeof text - 1);
    assert_int_equal(play(&app, &frames, text), RELUME_EFORMAT);
    assert_non_null(strstr(said, "longer"));
}

static void scripts_hold_keys_and_wait(void **state)
{
    (void)state;
    static struct frames frames;
    OWNED_APP app = make_app(RELUME_PLANAR, false);
    assert_int_equal(play(&app, &frames,
                          "hold l\ndrag left 0 0 100 0\nlet l\nwait 0.5\nframe a.png\n"
                          "drag left 0 0 100 0\nkey right\nkey tab\nadd \"dir 0 1 0\"\nshot b.png"),
                     RELUME_OK);
    assert_float_equal(frames.light[0][0].direction.x, 1, 1e-12);
    assert_true(frames.at[0].now.shift[0] == 0);
    assert_true(frames.waited == 0.5);
    assert_true(frames.at[1].now.shift[0] == 100);
    assert_true(frames.at[1].panel);
    assert_int_equal(frames.at[1].now.lights, 2);
}

// ---------------------------------------------------------------- lights

static void keys_change_the_selected_light(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, false);
    struct app_state *s = &app.now;
    assert_true(key(&app, 'm'));
    assert_true(s->lights == 2 && s->selected == 1);
    key(&app, APP_KEY_RIGHT);  // three degrees to the right
    assert_float_equal(s->light[1].direction.x, sin(3 * M_PI / 180), 1e-12);
    assert_true(s->light[0].direction.z == 1);
    key(&app, APP_KEY_UP_ARROW);
    assert_true(s->light[1].direction.y > 0.05);
    struct relume_light shining[2];
    key(&app, APP_KEY_PAGE_UP);
    assert_int_equal(light_list_shining(s, shining), 2);
    assert_float_equal(shining[1].rgb[0], exp2(0.25), 1e-6);
    key(&app, 'z');
    assert_int_equal(light_list_shining(s, shining), 1);
    assert_float_equal(shining[0].rgb[0], exp2(0.25), 1e-6);
    key(&app, 'x');  // solo and off: dark
    assert_int_equal(light_list_shining(s, shining), 0);
    key(&app, 'n');
    assert_int_equal(s->selected, 0);
    assert_true(key(&app, APP_KEY_DELETE));
    assert_true(s->lights == 1 && s->light_state[0].off && s->light[0].direction.y > 0.05);
    assert_false(key(&app, APP_KEY_DELETE));  // the last one stays
    for (int i = 1; i < APP_LIGHTS; i++)
        assert_true(key(&app, 'm'));
    assert_false(key(&app, 'm'));
    assert_int_equal(s->lights, APP_LIGHTS);
    assert_int_equal(gizmo_first(&app), APP_LIGHTS - GIZMOS);  // the last one is selected
    key(&app, 'r');
    assert_int_equal(s->lights, 1);
    assert_int_equal(gizmo_first(&app), 0);
}

static void arrangements_stand_on_the_pole(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, false);
    key(&app, '1');
    assert_int_equal(app.now.lights, 1);
    assert_float_equal(app.now.light[0].direction.z, sin(12 * M_PI / 180), 1e-12);
    assert_true(app.now.light[0].direction.x < -0.9);
    app_release(&app);
    app = make_app(RELUME_SPHERICAL, false);
    key(&app, '3');
    assert_int_equal(app.now.lights, 8);
    for (int i = 0; i < 8; i++)
        assert_float_equal(app.now.light[i].direction.y, sqrt(0.5), 1e-12);
}

// From the side of the light, which stays the side when the key is pressed again.
static void raking_light_is_a_captured_one(void **state)
{
    (void)state;
    struct relume_vec3 captured[] = {
        {-0.8, 0, 0.6}, {-0.6, 0.65, 0.3}, {0.1, 0.9, 0.4}, {0.8, 0.1, 0.5}, {0, -0.9, 0.35}};
    int number[] = {2, 5, 6, 8, 9};
    const struct relume_relief relief = {5, number, captured};
    OWNED_APP app = make_app(RELUME_PLANAR, false);
    app.file.relief = &relief;
    const struct relume_light *const light = app.now.light;
    key(&app, '1');  // light from the front: the upper left
    assert_int_equal(app.now.lights, 1);
    assert_memory_equal(&light[0].direction, &captured[1], sizeof *captured);
    key(&app, '1');
    assert_memory_equal(&light[0].direction, &captured[1], sizeof *captured);
    key(&app, '2');  // and a quarter turn to its right
    assert_int_equal(app.now.lights, 2);
    assert_memory_equal(&app.now.light[0].direction, &captured[1], sizeof *captured);
    assert_memory_equal(&app.now.light[1].direction, &captured[2], sizeof *captured);
    app.now.selected = 1;
    app_aim_light(&app, 1, (struct relume_vec3){0.5, -0.8, 0.33});
    key(&app, '1');
    assert_memory_equal(&app.now.light[0].direction, &captured[4], sizeof *captured);
    const struct relume_relief none = {0};
    app.file.relief = &none;
    key(&app, '1');
    assert_float_equal(app.now.light[0].direction.z, sin(12 * M_PI / 180), 1e-12);
}

static void pointers_are_in_pixels(void **state)
{
    (void)state;
    assert_true(context_pixels(100, 400, 800) == 200);  // a dense screen
    assert_true(context_pixels(101, 800, 800) == 101);
    assert_float_equal(context_pixels(30, 3, 4), 40, 1e-12);  // beyond the edge, dragged
    assert_true(context_pixels(7, 0, 0) == 7);                // minimised
    assert_true(context_pixels(7, 200, 0) == 7);
}

static void every_key_is_bound_once(void **state)
{
    (void)state;
    for (const struct key_binding *a = key_bindings; a->key; a++) {
        assert_true(!a->shown == !a->what);
        for (const struct key_binding *b = a + 1; b->key; b++)
            assert_true(a->key != b->key);
    }
}

// ---------------------------------------------------------------- recordings

static void recordings_go_once_around(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, false);  // light from the front: lowered to 60 degrees
    for (int i = 0; i < 4; i++) {
        static const double sign[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
        assert_int_equal(record_pose(&app, RECORD_SWEEP, i / 4.0, &keep), RELUME_OK);
        const struct relume_vec3 d = app.now.light[0].direction;
        assert_float_equal(d.x, 0.5 * sign[i][0], 1e-12);
        assert_float_equal(d.y, 0.5 * sign[i][1], 1e-12);
        assert_float_equal(d.z, sqrt(0.75), 1e-12);
    }
    said[0] = '\0';
    assert_int_equal(record_pose(&app, RECORD_TURNTABLE, 0, &keep), RELUME_EINVAL);
    assert_non_null(strstr(said, "turntable"));
    app_release(&app);
    app = make_app(RELUME_SLAB, false);
    record_pose(&app, RECORD_TURNTABLE, 0.25, &keep);  // at the upper end of the cameras
    assert_float_equal(app.now.camera.eye.x, 0, 1e-12);
    assert_float_equal(app.now.camera.eye.y, 0.5, 1e-12);
    app_release(&app);
    app = make_app(RELUME_CYLINDRICAL, true);
    record_pose(&app, RECORD_TURNTABLE, 0.25, &keep);
    assert_float_equal(app.now.camera.look.pan_deg, 90, 1e-12);
}

// ---------------------------------------------------------------- handles

// A dome whose lowest ring stands 45 degrees high, 12 lamps: its border is half of their 21.1
// degrees of spacing lower, a little less between them, and drawn on the disc as a ring.
static void captured_light_is_outlined(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, false);
    struct relume_vec3 light[13] = {{0, 0, 1}};
    struct gizmo g;
    relume_coder *coder;
    assert_false(gizmo_border(&g, &app, 0));
    for (int i = 0; i < 12; i++)
        light[i + 1] = (struct relume_vec3){sqrt(0.5) * cos(i * M_PI / 6),
                                            sqrt(0.5) * sin(i * M_PI / 6), sqrt(0.5)};
    assert_int_equal(relume_coder_create(&coder, &relume_basis_ptm, light, 13,
                                         relume_coder_params(.hemispherical = true)),
                     RELUME_OK);
    app.file.zone = relume_coder_region(coder);
    const struct gizmo_circle disc = gizmo_disc(&app);
    for (int step = 0; step <= RELUME_CAPTURED_REGION_STEPS; step++) {
        assert_true(gizmo_border(&g, &app, step) && !g.behind);
        const double r = hypot(g.x - disc.x, g.y - disc.y) / disc.radius;
        assert_true(r > sin((45 + 8.5) * M_PI / 180) && r < sin((45 + 10.6) * M_PI / 180));
    }
    app.file.zone = NULL;
    relume_coder_destroy(&coder);
}

static void handles_are_grabbed_and_follow(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, false);  // 400 x 200
    key(&app, 'm');
    app_aim_light(&app, 1, (struct relume_vec3){0.6, 0, -0.8});
    const struct gizmo_circle disc = gizmo_disc(&app);
    struct gizmo g;
    assert_true(gizmo_of(&g, &app, 0) && !g.behind);
    assert_true(g.x == 200 && g.y == 100);
    assert_true(gizmo_of(&g, &app, 1) && g.behind);
    assert_float_equal(g.x, 200 + 0.6 * disc.radius, 1e-9);
    assert_int_equal(gizmo_hit(&app, 203, 97), 0);
    assert_int_equal(gizmo_hit(&app, g.x + 5, g.y + 5), 1);
    assert_int_equal(gizmo_hit(&app, 230, 100), -1);
    gizmo_drag(&app, 1, 200, 100 - 0.6 * disc.radius);  // stays behind
    assert_float_equal(app.now.light[1].direction.y, 0.6, 1e-12);
    assert_float_equal(app.now.light[1].direction.z, -0.8, 1e-12);
    gizmo_drag(&app, 0, 1000, 100);  // beyond the rim: from the side
    assert_float_equal(app.now.light[0].direction.x, 1, 1e-12);
}

static struct relume_light point_at(double x, double y, double z)
{
    return (struct relume_light){
        .kind = RELUME_LIGHT_POINT, .position = {x, y, z}, .rgb = {1, 1, 1}};
}

// A window of 2 x 1 world units shown as 400 x 200 pixels.
static void near_lights_stand_where_they_are(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, false);
    struct relume_geometry *g = &app.file.geometry;
    *g = (struct relume_geometry){.window_min = {-1, -0.5}, .window_max = {1, 0.5}, .camera_z = 4};
    struct gizmo at;
    app.now.light[0] = point_at(0.5, -0.25, 1);
    assert_true(gizmo_of(&at, &app, 0) && at.near);
    assert_true(at.x == 300 && at.y == 150);
    gizmo_drag(&app, 0, 100, 50);
    assert_true(app.now.light[0].position.x == -0.5 && app.now.light[0].position.y == 0.25 &&
                app.now.light[0].position.z == 1);
    // in perspective what is half way to the eye looks twice as far from the middle
    g->perspective = true;
    app.now.light[0] = point_at(0.25, 0, 2);
    assert_true(gizmo_of(&at, &app, 0) && at.x == 300 && at.y == 100);
    gizmo_drag(&app, 0, 200, 0);
    assert_float_equal(app.now.light[0].position.x, 0, 1e-12);
    assert_float_equal(app.now.light[0].position.y, 0.25, 1e-12);
    app.now.light[0] = point_at(0, 0, 5);  // behind the viewer
    assert_false(gizmo_of(&at, &app, 0));
    assert_int_equal(gizmo_hit(&app, 200, 100), -1);
}

// A look ahead with 90 degrees: what stands as far to the right as ahead is on the right border.
static void near_lights_stand_in_panoramas(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_SPHERICAL, true);
    struct gizmo at;
    app.now.light[0] = point_at(1, 0.25, -1);
    assert_true(gizmo_of(&at, &app, 0));
    assert_float_equal(at.x, 1024, 1e-9);
    assert_float_equal(at.y, 256 - 0.25 * 512, 1e-9);
    gizmo_drag(&app, 0, 512, 256);
    assert_float_equal(app.now.light[0].position.x, 0, 1e-12);
    assert_float_equal(app.now.light[0].position.z, -1, 1e-12);
    app.now.camera.look.pan_deg = 180;
    assert_false(gizmo_of(&at, &app, 0));
    app_release(&app);
    app = make_app(RELUME_SPHERICAL, false);  // unfolded: 400 x 200
    app.now.light[0] = point_at(2, 0, 0);
    assert_true(gizmo_of(&at, &app, 0));
    assert_float_equal(at.x, 300, 1e-9);
    assert_float_equal(at.y, 100, 1e-9);
    gizmo_drag(&app, 0, 200, 100);
    assert_float_equal(app.now.light[0].position.z, -2, 1e-9);
}

// A spot that circles the scene keeps its distance and shines where it shone.
static void near_lights_turn_about_the_middle(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, false);
    app.now.light[0] = point_at(0, 0, 2);
    app.now.light[0].kind = RELUME_LIGHT_SPOT;
    app.now.light[0].direction = (struct relume_vec3){0, 0, -1};
    app_turn_light(&app, 90, 0);
    const struct relume_light *l = &app.now.light[0];
    assert_float_equal(l->position.x, 2, 1e-12);
    assert_float_equal(l->position.z, 0, 1e-12);
    assert_float_equal(l->direction.x, -1, 1e-12);
    app.now.light[0] = (struct relume_light){.kind = RELUME_LIGHT_ENVIRONMENT, .rgb = {1, 1, 1}};
    app_aim_light(&app, 0, (struct relume_vec3){1, 0, 0});  // from -z towards +x
    assert_float_equal(app.now.light[0].rotate_deg, 90, 1e-12);
}

static void kinds_become_one_another(void **state)
{
    (void)state;
    static const enum relume_light_kind kinds[] = {RELUME_LIGHT_POINT, RELUME_LIGHT_SPOT,
                                                   RELUME_LIGHT_AREA, RELUME_LIGHT_DIRECTIONAL};
    const struct relume_vec3 middle = {1, 2, 3};
    const struct relume_vec3 from = {0.6, 0, 0.8};
    OWNED_APP app = make_app(RELUME_PLANAR, false);
    app.now.light[0].direction = from;
    app.now.light[0].rgb[1] = 7;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        light_list_change_kind(&app.now, 0, kinds[i], middle, 5);
        const struct relume_light *l = &app.now.light[0];
        assert_int_equal(relume_light_check(l, "light", &keep), RELUME_OK);
        assert_true(l->kind == kinds[i] && l->rgb[1] == 7);
        assert_float_equal(vec3_dot(light_list_direction(l, middle), from), 1, 1e-12);
        if (kinds[i] == RELUME_LIGHT_DIRECTIONAL)
            continue;
        assert_float_equal(l->position.x, 4, 1e-12);
        assert_float_equal(vec3_dot(l->direction, from), -1, 1e-12);
        const struct relume_vec3 shines = {l->u.y * l->v.z - l->u.z * l->v.y,
                                           l->u.z * l->v.x - l->u.x * l->v.z,
                                           l->u.x * l->v.y - l->u.y * l->v.x};
        assert_true(vec3_dot(shines, from) < 0);
    }
}

static void held_keys_repeat_steps_only(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, false);
    struct app_event e = {.kind = APP_KEY_DOWN, .key = APP_KEY_TAB, .repeat = true};
    assert_false(app_handle(&app, &e));
    assert_false(app.panel);
    e.key = '+';
    assert_true(app_handle(&app, &e) && app_handle(&app, &e));
    assert_true(app.now.exposure_ev == 0.5);
}

// Hidden handles are not in the way of the camera.
static void handles_are_dragged_only_when_shown(void **state)
{
    (void)state;
    OWNED_APP app = make_app(RELUME_PLANAR, false);
    const struct app_event press = {.kind = APP_PRESS, .x = 200, .y = 100};
    const struct app_event move = {.kind = APP_MOVE, .x = 242, .y = 100};
    const struct app_event release = {.kind = APP_RELEASE};
    app_handle(&app, &press);
    app_handle(&app, &move);
    app_handle(&app, &release);
    assert_true(app.now.shift[0] == 42 && app.now.light[0].direction.x == 0);
    key(&app, 'r');
    key(&app, 'g');
    app_handle(&app, &press);
    app_handle(&app, &move);
    app_handle(&app, &release);
    assert_true(app.now.shift[0] == 0);
    assert_float_equal(app.now.light[0].direction.x, 42 / gizmo_disc(&app).radius, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(framing_suits_the_file),
        cmocka_unit_test(cameras_that_do_not_fit_are_refused),
        cmocka_unit_test(the_slab_turns_with_the_cursor),
        cmocka_unit_test(the_panorama_follows_the_cursor),
        cmocka_unit_test(a_panorama_zooms_about_the_cursor),
        cmocka_unit_test(fields_of_view_have_limits),
        cmocka_unit_test(a_panorama_glides_to_a_stop),
        cmocka_unit_test(a_glide_does_not_depend_on_frames),
        cmocka_unit_test(a_hand_that_rests_lets_go_of_nothing),
        cmocka_unit_test(automatic_exposure_adapts),
        cmocka_unit_test(the_picture_moves_and_zooms_about_the_cursor),
        cmocka_unit_test(windows_keep_the_proportions),
        cmocka_unit_test(one_side_gives_the_other),
        cmocka_unit_test(the_light_turns_like_a_ball),
        cmocka_unit_test(l_and_drag_turn_the_light_too),
        cmocka_unit_test(the_light_turns_as_seen_in_a_panorama),
        cmocka_unit_test(keys),
        cmocka_unit_test(escape_never_quits_unasked),
        cmocka_unit_test(escape_of_a_script_is_not_asked_about),
        cmocka_unit_test(the_ball_in_the_corner_turns_the_light),
        cmocka_unit_test(notes_fade),
        cmocka_unit_test(a_panel_stands_beside_the_picture),
        cmocka_unit_test(keys_of_a_slab),
        cmocka_unit_test(a_planet_and_back),
        cmocka_unit_test(a_focus_behind_the_cameras_is_refused),
        cmocka_unit_test(options_are_read),
        cmocka_unit_test(wrong_options_are_refused),
        cmocka_unit_test(scripts_play_events),
        cmocka_unit_test(scripts_let_an_eye_live),
        cmocka_unit_test(scripts_let_time_pass),
        cmocka_unit_test(scripts_set_numbers),
        cmocka_unit_test(the_next_click_is_in_focus),
        cmocka_unit_test(a_click_finds_the_surface),
        cmocka_unit_test(broken_scripts_name_the_line),
        cmocka_unit_test(long_lines_are_refused),
        cmocka_unit_test(scripts_hold_keys_and_wait),
        cmocka_unit_test(keys_change_the_selected_light),
        cmocka_unit_test(arrangements_stand_on_the_pole),
        cmocka_unit_test(raking_light_is_a_captured_one),
        cmocka_unit_test(pointers_are_in_pixels),
        cmocka_unit_test(every_key_is_bound_once),
        cmocka_unit_test(recordings_go_once_around),
        cmocka_unit_test(handles_are_grabbed_and_follow),
        cmocka_unit_test(captured_light_is_outlined),
        cmocka_unit_test(near_lights_stand_where_they_are),
        cmocka_unit_test(near_lights_stand_in_panoramas),
        cmocka_unit_test(near_lights_turn_about_the_middle),
        cmocka_unit_test(kinds_become_one_another),
        cmocka_unit_test(held_keys_repeat_steps_only),
        cmocka_unit_test(handles_are_dragged_only_when_shown),
    };
    return cmocka_run_group_tests_name("app", tests, NULL, NULL);
}
