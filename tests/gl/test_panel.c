// The panel without a window: real clicks change the app, and it is drawn; passes and the inspector
// against the library
//
// Compares: enhance.frag.glsl, shared/enhance.glsl, shared/luminance.glsl with enhance.c,
// luminance.h.
#include "fixture.h"

#include "app/light_list.h"
#include "panel/draw_panel.h"
#include "relight/light/refit.h"
#include "relight/normals/enhance.h"
#include "relight/view/view.h"
#include "relit/enhancer.h"
#include "session/inspect.h"

#include <stdlib.h>
#include <unistd.h>

static struct app make_app(void)
{
    const struct app_file file = {
        .geometry = {.projection = RELUME_PLANAR, .window_min = {-1, -1}, .window_max = {1, 1}},
        .width = 400,
        .height = 400,
        .views = 1,
    };
    const struct app_state start = {0};
    struct app app;
    assert_int_equal(app_start(&app, &file, &start, false, &fixture_log), RELUME_OK);
    app.width = 640;
    app.height = 560;
    app.panel = true;
    return app;
}

static struct panel *make_panel(struct app *app)
{
    static const struct panel_facts none = {0};
    struct panel *panel;
    assert_int_equal(panel_create(&panel, 1, NULL), RELUME_OK);
    panel_build(panel, app, &none);
    panel_build(panel, app, &none);
    return panel;
}

static bool tell(struct panel *panel, enum app_event_kind kind, double x, double y)
{
    const struct app_event e = {.kind = kind, .x = x, .y = y};
    return panel_takes(panel, &e);
}

static bool drag(struct panel *panel, struct app *app, double x0, double y0, double x1, double y1)
{
    static const struct panel_facts none = {0};
    (void)tell(panel, APP_MOVE, x0, y0);
    assert_true(tell(panel, APP_PRESS, x0, y0));
    assert_true(tell(panel, APP_MOVE, x1, y1));
    assert_true(tell(panel, APP_RELEASE, x1, y1));
    return panel_build(panel, app, &none);
}

// ---------------------------------------------------------------- events

// The ball of the first light has its middle at (76, 126) and a radius of 55 pixels.
static void the_ball_turns_the_light(void **state)
{
    (void)state;
    OWNED_APP app = make_app();
    struct panel *panel = make_panel(&app);
    assert_true(drag(panel, &app, 76, 126, 76 + 33, 126 - 22));
    const struct relume_vec3 d = app.now.light[0].direction;
    assert_float_equal(d.x, 0.6, 0.02);  // pixels: 1 / 55
    assert_float_equal(d.y, 0.4, 0.02);
    assert_float_equal(d.x * d.x + d.y * d.y + d.z * d.z, 1, 1e-9);
    panel_destroy(&panel);
}

static void a_click_turns_the_light_off(void **state)
{
    (void)state;
    OWNED_APP app = make_app();
    struct panel *panel = make_panel(&app);
    assert_true(drag(panel, &app, 25, 49, 25, 49));
    assert_true(app.now.light_state[0].off);
    assert_true(drag(panel, &app, 25, 49, 25, 49));
    assert_false(app.now.light_state[0].off);
    panel_destroy(&panel);
}

// What begins beside the panel is the app's, wherever it ends; the wheel goes to what is under it.
static void the_picture_keeps_its_events(void **state)
{
    (void)state;
    OWNED_APP app = make_app();
    struct panel *panel = make_panel(&app);
    assert_false(tell(panel, APP_PRESS, 500, 300));
    assert_false(tell(panel, APP_MOVE, 76, 126));
    assert_false(tell(panel, APP_RELEASE, 76, 126));
    assert_false(tell(panel, APP_WHEEL, 500, 300));
    assert_true(tell(panel, APP_WHEEL, 76, 126));
    const struct app_event key = {.kind = APP_KEY_DOWN, .key = 'r'};
    assert_false(panel_takes(panel, &key));
    panel_destroy(&panel);
}

static void text_goes_into_the_field(void **state)
{
    (void)state;
    static const struct panel_facts none = {0};
    OWNED_APP app = make_app();
    struct panel *panel = make_panel(&app);
    drag(panel, &app, 60, 269, 60, 269);  // the field for a SPEC
    for (const char *c = "dir 1 0 1"; *c; c++) {
        const struct app_event e = {.kind = APP_TEXT, .key = *c};
        assert_true(panel_takes(panel, &e));
    }
    const struct app_event down = {.kind = APP_KEY_DOWN, .key = APP_KEY_ENTER};
    assert_true(panel_takes(panel, &down));
    panel_build(panel, &app, &none);
    assert_int_equal(app.action, APP_ACTION_ADD_LIGHT);
    assert_string_equal(app.spec, "dir 1 0 1");
    panel_destroy(&panel);
}

static bool click(struct panel *panel, struct app *app, double x, double y)
{
    return drag(panel, app, x, y, x, y);
}

// The list of lights is closed: "Picture" is the second row, "Camera" comes behind it.
static void sliders_move_the_camera_and_strengthen_views(void **state)
{
    (void)state;
    static const struct panel_facts facts = {.range = {0.1f, 0.4f}};
    OWNED_APP app = make_app();
    struct panel *panel = make_panel(&app);
    (void)click(panel, &app, 100, 26);
    (void)click(panel, &app, 100, 49);
    (void)click(panel, &app, 100, 72);
    assert_true(drag(panel, &app, 106, 95, 140, 95));  // zoom, logarithmic from 0.1 to 64
    assert_true(app.now.zoom > 2 && app.now.zoom < 30);
    assert_true(click(panel, &app, 60, 118));  // fit the window
    assert_true(app.now.zoom == 1);
    (void)click(panel, &app, 100, 49);  // the view's slider lies below its list
    app.now.pass = RELUME_PASS_DIFFUSE_GAIN;
    assert_true(drag(panel, &app, 60, 164, 150, 164));
    assert_true(app.now.enhance.gain > 5 && app.now.enhance.gain < 20);
    app.now.pass = RELUME_PASS_FALSE_COLOUR;
    panel_build(panel, &app, &facts);
    const struct app_event press = {.kind = APP_PRESS, .x = 26, .y = 164};
    assert_true(panel_takes(panel, &press));
    assert_true(tell(panel, APP_RELEASE, 26, 164));
    panel_build(panel, &app, &facts);  // from now on fixed, as it was
    assert_true(app.now.enhance.low == 0.1f && app.now.enhance.top == 0.4f);
    panel_destroy(&panel);
}

// Esc closes a list that is open, and is not the app's then.
static void escape_closes_a_list(void **state)
{
    (void)state;
    static const struct panel_facts none = {0};
    const struct app_event escape = {.kind = APP_KEY_DOWN, .key = APP_KEY_ESCAPE};
    OWNED_APP app = make_app();
    app.near_lights = true;
    struct panel *panel = make_panel(&app);
    assert_false(panel_takes(panel, &escape));
    drag(panel, &app, 60, 215, 60, 215);  // kinds of light
    panel_build(panel, &app, &none);
    assert_true(panel_takes(panel, &escape));
    panel_build(panel, &app, &none);
    assert_false(panel_takes(panel, &escape));
    panel_destroy(&panel);
}

static int runs_of(struct panel *panel, struct app *app, const struct panel_facts *facts)
{
    struct panel_run run;
    int indices = 0;
    panel_build(panel, app, facts);
    for (int i = 0; panel_run_at(&run, panel, i); i++)
        indices += run.count;
    return indices;
}

// The pointer goes over `width` x `height` pixels in steps finer than the smallest control, and
// nothing under it is without a tip. Returns how often it found a tip.
static int walk(struct panel *panel, struct app *app, const struct panel_facts *facts, int width,
                int height)
{
    int tips = 0;
    (void)tell(panel, APP_MOVE, -9, -9);
    const int still = runs_of(panel, app, facts);
    for (int y = 4; y < height; y += 9)
        for (int x = 4; x < width; x += 12) {
            (void)tell(panel, APP_MOVE, x, y);
            tips += runs_of(panel, app, facts) > still;
            if (panel_is_mute(panel))
                fail_msg("the control at %d, %d has no tip", x, y);
        }
    return tips;
}

static void every_light_says_what_it_is(struct panel *panel, struct app *app)
{
    static const struct panel_facts none = {0};
    for (int kind = 0; kind <= RELUME_LIGHT_GONIO; kind++) {
        app->now.light[0] = (struct relume_light){
            .kind = (enum relume_light_kind)kind,
            .direction = {0, 0, -1},
            .rgb = {1, 1, 1},
            .position = {0, 0, 2},
            .u = {1, 0, 0},
            .v = {0, 1, 0},
            .half_angle_deg = 20,
        };
        assert_true(walk(panel, app, &none, 306, 400) > 100);
    }
}

static void every_view_says_what_it_is(struct panel *panel, struct app *app)
{
    static const struct panel_facts none = {0};
    for (int pass = 0; pass < RELUME_PASSES; pass++) {
        app->now.pass = (enum relume_pass)pass;
        assert_true(walk(panel, app, &none, 306, 350) > 100);
    }
}

// Each section alone, below those that are closed.
static void every_control_says_what_it_is_for(void **state)
{
    (void)state;
    enum { LIGHTS, PICTURE, CAMERA, GLARE, HISTOGRAM, FILE_SECTION, PANEL, SECTIONS };
    static const enum relume_framing framings[] = {RELUME_FRAME_VIEW, RELUME_FRAME_EYE,
                                                   RELUME_FRAME_LOOK};
    static const struct panel_facts none = {0};
    OWNED_APP app = make_app();
    struct panel *panel = make_panel(&app);
    app.near_lights = true;
    app.now.enhance.low = 0.1f;
    app.now.enhance.top = 0.4f;
    (void)click(panel, &app, 100, 26);
    (void)click(panel, &app, 100, 49);
    assert_true(walk(panel, &app, &none, 306, 220) > 100);  // the headers
    for (int i = 0; i < SECTIONS; i++) {
        (void)click(panel, &app, 100, 26 + 23 * i);
        if (i == LIGHTS)
            every_light_says_what_it_is(panel, &app);
        if (i == PICTURE)
            every_view_says_what_it_is(panel, &app);
        for (int k = 0; k < (i == CAMERA ? 3 : i >= GLARE); k++) {
            app.now.camera.framing = framings[k];
            assert_true(walk(panel, &app, &none, 306, 440) > 100);
        }
        (void)click(panel, &app, 100, 26 + 23 * i);
    }
    panel_destroy(&panel);
}

// The list of lights is closed: "Edits" is the second row; below it one chooses an operation, each
// with rows of its own. Buttons ask for what the session does, in words.
static void check_action(struct panel *panel, struct app *app, const struct panel_facts *facts,
                         double x, double y, const char *words)
{
    (void)tell(panel, APP_MOVE, x, y);
    assert_true(tell(panel, APP_PRESS, x, y));
    assert_true(tell(panel, APP_RELEASE, x, y));
    panel_build(panel, app, facts);
    panel_build(panel, app, facts);
    assert_int_equal(app->action, words ? APP_ACTION_EDIT : APP_ACTION_NONE);
    if (words)
        assert_string_equal(app->spec, words);
    app->action = APP_ACTION_NONE;
}

static void type_text(struct panel *panel, struct app *app, const struct panel_facts *facts,
                      const char *text)
{
    for (; *text; text++) {
        const struct app_event e = {.kind = APP_TEXT, .key = *text};
        assert_true(panel_takes(panel, &e));
    }
    panel_build(panel, app, facts);
}

static void edits_are_asked_for(void **state)
{
    (void)state;
    static const struct {
        const char *words;
        int rows;
        bool maps;
    } edits[] = {
        {"emboss \"a b.png\" height 0.02 at 0.5,0.5 size 1", 5, true},
        {"engrave \"a b.png\" height 0.02 at 0.5,0.5 size 1", 5, true},
        {"roughness 1", 3, true},
        {"tint 1,1,1", 3, true},
        {"channels GBR", 3, true},
        {"swap 0,1", 3, false},
        {"turn 90", 3, false},
        {"add-material 0.5 r0 0.04 highlight 1,1,1", 5, true},
    };
    for (int maps = 0; maps < 2; maps++) {
        const struct panel_facts facts = {
            .edits = "no edits", .edits_maps = maps, .edited_materials = maps ? 0 : 3};
        OWNED_APP app = make_app();
        struct panel *panel = make_panel(&app);
        (void)click(panel, &app, 100, 26);
        panel_build(panel, &app, &facts);
        panel_build(panel, &app, &facts);
        check_action(panel, &app, &facts, 60, 95, NULL);
        type_text(panel, &app, &facts, "a b.png");
        for (int i = 0, shown = 0; i < (int)(sizeof edits / sizeof *edits); i++) {
            if (maps && !edits[i].maps)
                continue;
            // maps have no labels to choose
            const bool labelled = !strstr(edits[i].words, "size") && i < 7 && i != 5;
            const double buttons = 95 + 23 * (edits[i].rows - (maps && labelled));
            check_action(panel, &app, &facts, 100, 72, NULL);
            check_action(panel, &app, &facts, 60, 96 + 17 * shown++, NULL);
            assert_true(walk(panel, &app, &facts, 306, 240) > 100);
            check_action(panel, &app, &facts, 36, buttons, edits[i].words);
            check_action(panel, &app, &facts, 88, buttons, "undo");
            check_action(panel, &app, &facts, 134, buttons, "redo");
        }
        panel_destroy(&panel);
    }
}

static void every_window_says_what_it_is_for(void **state)
{
    (void)state;
    struct browser b = {.count = 0};
    assert_int_equal(browse_list(&b, "/"), RELUME_OK);
    const struct panel_facts facts = {.browser = &b};
    for (int i = 0; i < 3; i++) {
        OWNED_APP app = make_app();
        struct panel *panel = make_panel(&app);
        app.panel = false;
        app.file.empty = i == 0;
        app.browse = i == 1;
        app.asks = i == 2;
        panel_build(panel, &app, &facts);
        assert_true(walk(panel, &app, &facts, 640, 560) > 5);
        panel_destroy(&panel);
    }
    browse_destroy(&b);
}

// Notes are drawn while they last, and the pointer goes through them.
static void notes_are_drawn(void **state)
{
    (void)state;
    const struct panel_facts says = {.message = "saved statue-0001.png"};
    const struct panel_facts records = {.recording = "statue-0001-sweep", .recorded_s = 1};
    OWNED_APP app = make_app();
    app.panel = false;
    struct panel *panel = make_panel(&app);
    assert_int_equal(runs_of(panel, &app, &says), 0);
    assert_false(panel_shown(&app));
    app.toast_s = 4;
    assert_true(panel_shown(&app));
    const int toast = runs_of(panel, &app, &says);
    assert_true(toast > 0);
    for (int y = 0; y < app.height; y += 5)
        assert_false(tell(panel, APP_WHEEL, 320, y));
    app.hint_s = 8;
    assert_true(runs_of(panel, &app, &says) > toast);
    app.toast_s = app.hint_s = 0;
    app.recording = true;
    assert_true(runs_of(panel, &app, &records) > 0 && panel_shown(&app));
    panel_destroy(&panel);
}

static void the_question_is_answered_by_its_buttons(void **state)
{
    (void)state;
    for (int quits = 0; quits < 2; quits++) {
        OWNED_APP app = make_app();
        app.panel = false;
        app.asks = true;
        struct panel *panel = make_panel(&app);
        const double x = quits ? 285 : 370;  // beside the middle of 640 x 560
        (void)drag(panel, &app, x, 292, x, 292);
        assert_int_equal(app.quit, quits);
        assert_int_equal(app.asks, quits);
        panel_destroy(&panel);
    }
}

// The packaged font has the letters of names; a file that is none, or is cut off, is not taken.
static void the_font_is_a_file(void **state)
{
    (void)state;
    static const char packaged[] = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
    static const char cut[] = "\0\1\0\0\0\1\0\0\0\0\0\0glyf\0\0\0\0\0\0\0\20\0\0\0\40";
    char path[] = "/tmp/panel-XXXXXX";
    struct panel *panel;
    const int file = mkstemp(path);
    assert_true(file >= 0 && write(file, cut, sizeof cut - 1) == sizeof cut - 1 && !close(file));
    const char *const none[] = {NULL, "/nonexistent.ttf", "/", path};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(panel_create(&panel, 1, none[i]), RELUME_OK);
        assert_false(panel_has_font(panel));
        panel_destroy(&panel);
    }
    assert_int_equal(unlink(path), 0);
    if (access(packaged, R_OK)) {
        print_message("skipped: fonts-dejavu-core is not installed\n");
        return;
    }
    for (double scale = 0.5; scale <= 4; scale *= 2) {
        assert_int_equal(panel_create(&panel, scale, packaged), RELUME_OK);
        assert_true(panel_has_font(panel));
        assert_int_equal(panel_width(panel), (int)(306 * scale));
        panel_destroy(&panel);
    }
}

static void tiny_frames_do_no_harm(void **state)
{
    (void)state;
    static const struct panel_facts none = {0};
    OWNED_APP app = make_app();
    struct panel *panel = make_panel(&app);
    app.help = app.inspect = app.gizmos = app.asks = true;
    app.hint_s = app.toast_s = 9;
    for (int side = 1; side < 100; side += 7) {
        app.width = app.height = side;
        panel_build(panel, &app, &none);
    }
    panel_destroy(&panel);
}

// ---------------------------------------------------------------- drawing

static void the_panel_is_drawn_where_it_is(void **state)
{
    (void)state;
    OWNED_APP app = make_app();
    struct panel *panel = make_panel(&app);
    struct panel_drawing drawing;
    struct target target;
    struct relume_image image;
    assert_int_equal(draw_panel_create(&drawing, &fixture_gl, panel, &fixture_log), RELUME_OK);
    assert_int_equal(target_create(&target, &fixture_gl, app.width, app.height, &fixture_log),
                     RELUME_OK);
    target_begin(&target, &fixture_gl);
    draw_panel(&drawing, &fixture_gl, panel, app.width, app.height);
    assert_int_equal(target_read(&image, &target, &fixture_gl), RELUME_OK);
    double inside = 0, beside = 0;
    for (int y = 0; y < app.height; y++)  // the screen's first row is the lowest
        for (int x = 0; x < app.width; x++) {
            const float *rgb = image.data + 3 * ((app.height - 1 - y) * app.width + x);
            const double sum = (double)(rgb[0] + rgb[1] + rgb[2]);
            if (x < 300 && y < 564)
                inside += sum;
            else
                beside += sum;
        }
    assert_true(inside > 10000);
    assert_true(beside == 0);
    // the white dot of the light in the middle of the ball
    assert_true(image.data[3 * ((app.height - 1 - 126) * app.width + 76)] > 0.99f);
    relume_image_destroy(&image);
    target_destroy(&target, &fixture_gl);
    draw_panel_destroy(&drawing, &fixture_gl);
    panel_destroy(&panel);
    assert_int_equal(gl_check(&fixture_gl, "test", &fixture_log), RELUME_OK);
}

// ---------------------------------------------------------------- passes

// The twins differ by single precision; the highlight's power of 40 multiplies its error by 40.
static void passes_are_those_of_the_library(void **state)
{
    (void)state;
    enum { W = 139, H = 13 };  // every other pixel is measured
    static const struct relume_light lights[] = {
        {.direction = {0.2, 0.3, 0.8}, .rgb = {1, 0.9f, 0.8f}},
        {.direction = {-2, 1, 0.5}, .rgb = {0.1f, 0.4f, 0.6f}},
    };
    static const struct relume_geometry panorama = {.projection = RELUME_SPHERICAL};
    static const struct relume_geometry planar = {.projection = RELUME_PLANAR};
    for (int turned = 0; turned < 2; turned++) {
        const struct relume_geometry *geometry = turned ? &panorama : &planar;
        struct fixture_file f =
            fixture_make(1, W, H, RELUME_STORE_16, RELUME_DOMAIN_LINEAR, turned);
        const struct code_source source = {.codes = fixture_fetch, .user = &f};
        struct gl_relighter relighter;
        struct enhancer enhancer;
        assert_int_equal(gl_relighter_create(&relighter, &fixture_gl, &source, 1, &fixture_log),
                         RELUME_OK);
        assert_int_equal(
            enhancer_create(&enhancer, &fixture_gl, &source, geometry, NULL, 1, &fixture_log),
            RELUME_OK);
        const struct target *relit, *shown;
        assert_int_equal(gl_relighter_begin(&relighter, lights, 2), RELUME_OK);
        assert_int_equal(gl_relighter_view(&relit, &relighter, 0), RELUME_OK);
        struct relume_normals normals;
        const struct relume_codes *codes;
        fixture_fetch(&codes, &f, 0);
        assert_int_equal(
            relume_normals_fit(&normals, codes,
                               relume_normals_params(.eye = relume_geometry_eye(geometry))),
            RELUME_OK);
        struct relume_image towards;
        assert_int_equal(relume_image_create(&towards, W, H, 3), RELUME_OK);
        for (int i = 0; i < W * H; i++) {
            const struct relume_vec3 ray =
                relume_panorama_ray(&panorama, W, H, i % W + 0.5, i / W + 0.5);
            towards.data[3 * i] = (float)-ray.x;
            towards.data[3 * i + 1] = (float)-ray.y;
            towards.data[3 * i + 2] = (float)-ray.z;
        }
        for (int p = RELUME_PASS_NORMALS; p < RELUME_PASS_DIFFERENCE; p++) {
            struct relume_image want = fixture_relight(&f, 0, lights, 2);
            struct relume_image got;
            assert_int_equal(
                relume_pass_apply(&want, (enum relume_pass)p, &normals, lights, 2,
                                  relume_pass_params(.towards = turned ? &towards : NULL)),
                RELUME_OK);
            if (p == RELUME_PASS_NORMALS)
                for (int i = 0; i < 3 * W * H; i++)
                    want.data[i] =
                        relume_transfer_decode((struct relume_transfer){.curve = RELUME_CURVE_SRGB},
                                               0.5f * want.data[i] + 0.5f);
            assert_int_equal(
                enhancer_view(&shown, &enhancer, 0, relit, (enum relume_pass)p, lights, 2),
                RELUME_OK);
            assert_int_equal(target_read(&got, shown, &fixture_gl), RELUME_OK);
            assert_below(relume_pass_name((enum relume_pass)p), fixture_difference(&got, &want),
                         1e-4);
            relume_image_destroy(&got);
            relume_image_destroy(&want);
        }
        relume_image_destroy(&towards);
        relume_normals_destroy(&normals);
        enhancer_destroy(&enhancer);
        gl_relighter_destroy(&relighter);
        fixture_free(&f);
    }
}

// ---------------------------------------------------------------- inspector

static void the_inspector_decodes_as_the_library(void **state)
{
    (void)state;
    static const enum relume_storage storages[] = {RELUME_STORE_8, RELUME_STORE_12,
                                                   RELUME_STORE_HALF};
    static const struct relume_light light = {.direction = {0.3, -0.2, 0.9}, .rgb = {1, 1, 1}};
    for (int i = 0; i < 6; i++) {
        const enum relume_domain domain = i < 3 ? RELUME_DOMAIN_LINEAR : RELUME_DOMAIN_DISPLAY;
        struct fixture_file f = fixture_make(1, 7, 5, storages[i % 3], domain, false);
        const struct relume_codes *codes;
        float coefficient[FIXTURE_PLANES], weights[FIXTURE_PLANES], constant[3], colour[3], rgb[3];
        double want[3];
        fixture_fetch(&codes, &f, 0);
        const double size = sqrt(0.3 * 0.3 + 0.2 * 0.2 + 0.9 * 0.9);
        const struct relume_vec3 d = {0.3 / size, -0.2 / size, 0.9 / size};
        relume_coder_weights(codes->coder, d, weights, constant);
        for (int at = 0; at < 35; at++) {
            inspect_coefficients(coefficient, colour, codes, at % 7, at / 7);
            inspect_value(rgb, codes, coefficient, colour, weights, constant);
            relume_relight_pixel(want, codes, at % 7, at / 7, &light, 1);
            for (int c = 0; c < 3; c++)  // single precision of values up to about 4
                assert_float_equal(rgb[c], want[c], 2e-5);
        }
        fixture_free(&f);
    }
}

// A cell of the plot, magnified about the selected light, is the pixel under a light from there.
static void the_inspector_magnifies_about_the_light(void **state)
{
    (void)state;
    struct fixture_file f = fixture_make(1, 7, 5, RELUME_STORE_8, RELUME_DOMAIN_LINEAR, false);
    const struct relume_codes *codes;
    fixture_fetch(&codes, &f, 0);
    const struct relume_pack_info info = {.coder = codes->coder, .width = 7, .height = 5};
    const struct code_source source = {fixture_fetch, NULL, &f, NULL, NULL};
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    struct inspector in;
    bool shown;
    assert_int_equal(inspect_create(&in, &info, &source, NULL, NULL), RELUME_OK);
    OWNED_APP app = make_app();
    app.file.width = 7;
    app.file.height = 5;
    app.inspect = true;
    app.cursor[0] = app.cursor[1] = 200;
    app.now.exposure_ev = -3;  // nothing is clipped
    app.now.selected = 0;
    app.now.light[0] = (struct relume_light){.direction = {0.6, 0, 0.8}, .rgb = {1, 1, 1}};
    for (int zoom = 1; zoom <= 16; zoom *= 4) {
        app.inspect_zoom = zoom;
        assert_int_equal(inspect_update(&in, &app, &shown), RELUME_OK);
        assert_true(shown);
        const int cell[2] = {INSPECT_GRID / 2 + 4, INSPECT_GRID / 2 - 7};  // beside the marks
        const double middle = zoom > 1 ? 0.6 : 0;
        const double x = middle + (2 * (cell[0] + 0.5) / INSPECT_GRID - 1) / zoom;
        const double y = (1 - 2 * (cell[1] + 0.5) / INSPECT_GRID) / zoom;
        const struct relume_light from = {.direction = {x, y, sqrt(1 - x * x - y * y)},
                                          .rgb = {0.125f, 0.125f, 0.125f}};
        const float *got = in.plot.data + 3 * ((3 * cell[1] + 1) * INSPECT_SIDE + 3 * cell[0] + 1);
        double want[3];
        relume_relight_pixel(want, codes, in.x, in.y, &from, 1);
        for (int c = 0; c < 3; c++) {
            const float code = relume_transfer_encode(srgb, (float)want[c]);
            assert_float_equal(got[c], fminf(fmaxf(code, 0), 1), 1e-4);
        }
    }
    inspect_destroy(&in);
    fixture_free(&f);
}

static void the_cursor_finds_its_pixel(void **state)
{
    (void)state;
    OWNED_APP app = make_app();  // 400 x 400 in 640 x 560: 560 x 560 of them
    int view, pixel[2];
    assert_true(inspect_pick(&view, pixel, &app, NULL, 320, 280));
    assert_true(view == 0 && pixel[0] == 200 && pixel[1] == 200);
    assert_true(inspect_pick(&view, pixel, &app, NULL, 599.9, 0));
    assert_true(pixel[0] == 399 && pixel[1] == 0);
    assert_false(inspect_pick(&view, pixel, &app, NULL, 20, 280));
    assert_true(inspect_pick(&view, pixel, &app, NULL, 40.5, 280));
    assert_int_equal(pixel[0], 0);
    app.file.geometry.projection = RELUME_SPHERICAL;
    app.now.camera.framing = RELUME_FRAME_LOOK;  // ahead is the middle of the panorama
    app.now.camera.look = (struct relume_pan_tilt){.zoom = 1};
    assert_true(inspect_pick(&view, pixel, &app, NULL, 320.5, 280.5));
    assert_true(pixel[0] == 200 && pixel[1] == 200);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_ball_turns_the_light),
        cmocka_unit_test(a_click_turns_the_light_off),
        cmocka_unit_test(the_picture_keeps_its_events),
        cmocka_unit_test(text_goes_into_the_field),
        cmocka_unit_test(sliders_move_the_camera_and_strengthen_views),
        cmocka_unit_test(escape_closes_a_list),
        cmocka_unit_test(notes_are_drawn),
        cmocka_unit_test(the_question_is_answered_by_its_buttons),
        cmocka_unit_test(the_font_is_a_file),
        cmocka_unit_test(every_control_says_what_it_is_for),
        cmocka_unit_test(edits_are_asked_for),
        cmocka_unit_test(every_window_says_what_it_is_for),
        cmocka_unit_test(tiny_frames_do_no_harm),
        cmocka_unit_test(the_panel_is_drawn_where_it_is),
        cmocka_unit_test(passes_are_those_of_the_library),
        cmocka_unit_test(the_inspector_decodes_as_the_library),
        cmocka_unit_test(the_inspector_magnifies_about_the_light),
        cmocka_unit_test(the_cursor_finds_its_pixel),
    };
    return cmocka_run_group_tests(tests, fixture_open, fixture_close);
}
