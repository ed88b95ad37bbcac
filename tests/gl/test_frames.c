// Frames drawn by OpenGL against the library's: picture, slab, panoramas
#include "fixture.h"

static const struct relume_light lights[] = {
    {.direction = {0.2, 0.3, 0.8}, .rgb = {1, 0.9f, 0.8f}},
    {.direction = {-2, 1, 0.5}, .rgb = {0.1f, 0.4f, 0.6f}},
};
enum { LIGHTS = sizeof lights / sizeof *lights };

// Random codes differ by about 2 from texel to texel, the worst case for positions. Float positions
// in some tens of texels are good to 1e-5 of a texel; GL's atan, good to 1e-5 of a radian, moves a
// panorama's by ten times that.
static const double same_grid_bound = 1e-4;
static const double look_bound = 1e-3;

static struct app make_app(const struct app_file *file, const struct relume_camera *camera)
{
    struct app_state start = {.camera = *camera, .lights = LIGHTS};
    memcpy(start.light, lights, sizeof lights);
    struct app app;
    assert_int_equal(app_start(&app, file, &start, false, &fixture_log), RELUME_OK);
    return app;
}

static double compare_frame(struct renderer *r, const struct app *app,
                            const struct relume_image *want)
{
    struct relume_image got;
    assert_int_equal(renderer_draw(r, app), RELUME_OK);
    assert_int_equal(renderer_read(&got, r), RELUME_OK);
    const double difference = fixture_difference(&got, want);
    relume_image_destroy(&got);
    return difference;
}

// ---------------------------------------------------------------- picture

static void a_view_is_drawn_texel_by_texel(void **state)
{
    (void)state;
    enum { W = 53, H = 31 };
    struct fixture_file f = fixture_make(2, W, H, RELUME_STORE_8, RELUME_DOMAIN_DISPLAY, false);
    const struct app_file file = {.geometry = {.projection = RELUME_PLANAR}, W, H, 2, {0}, {0}};
    const struct code_source source = {fixture_fetch, NULL, &f, NULL};
    struct renderer r;
    assert_int_equal(
        renderer_create(&r, &fixture_gl, &source, &file.geometry, NULL, 2, &fixture_log),
        RELUME_OK);
    const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW, .view = 1};
    struct app app = make_app(&file, &camera);
    struct relume_image want = fixture_relight(&f, 1, lights, LIGHTS);
    assert_below("view", compare_frame(&r, &app, &want), same_grid_bound);
    app.now.exposure_ev = -2;
    for (int i = 0; i < 3 * W * H; i++)
        want.data[i] *= 0.25f;
    assert_below("view, exposure -2", compare_frame(&r, &app, &want), same_grid_bound);
    relume_image_destroy(&want);
    renderer_destroy(&r);
    fixture_free(&f);
}

// Half the size: every pixel is the mean of the four it covers, in linear light.
static void a_reduced_view_is_averaged(void **state)
{
    (void)state;
    enum { W = 32, H = 20 };
    struct fixture_file f = fixture_make(1, W, H, RELUME_STORE_8, RELUME_DOMAIN_DISPLAY, false);
    const struct app_file file = {.geometry = {.projection = RELUME_PLANAR}, W, H, 1, {0}, {0}};
    const struct code_source source = {fixture_fetch, NULL, &f, NULL};
    struct renderer r;
    assert_int_equal(
        renderer_create(&r, &fixture_gl, &source, &file.geometry, NULL, 1, &fixture_log),
        RELUME_OK);
    const struct relume_camera camera = {
        .framing = RELUME_FRAME_VIEW, .width = W / 2, .height = H / 2};
    struct app app = make_app(&file, &camera);
    struct relume_image full = fixture_relight(&f, 0, lights, LIGHTS), want;
    assert_int_equal(relume_image_create(&want, W / 2, H / 2, 3), RELUME_OK);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            for (int c = 0; c < 3; c++)
                want.data[3 * (y / 2 * (W / 2) + x / 2) + c] +=
                    0.25f * full.data[3 * (y * W + x) + c];
    assert_below("half size", compare_frame(&r, &app, &want), same_grid_bound);
    relume_image_destroy(&full);
    relume_image_destroy(&want);
    renderer_destroy(&r);
    fixture_free(&f);
}

// ---------------------------------------------------------------- slab

enum { COLUMNS = 4, ROWS = 3, CAMERAS = COLUMNS * ROWS };
static const double columns[COLUMNS] = {-1.0, -0.2, 0.1, 1.0};
static const double rows[ROWS] = {-0.5, 0.25, 0.5};

static struct relume_geometry slab_geometry(void)
{
    return (struct relume_geometry){
        .projection = RELUME_SLAB,
        .uv_z = 3,
        .st_min = {-1, -0.75},
        .st_max = {1, 0.75},
    };
}

struct slab_test {
    struct fixture_file file;
    struct app_file about;
    struct renderer renderer;
    struct relume_image views[CAMERAS];
    double uv[CAMERAS][2];
};

static void open_slab(struct slab_test *t, int width, int height)
{
    for (int i = 0; i < CAMERAS; i++) {
        t->uv[i][0] = columns[(i * 5 % CAMERAS) % COLUMNS];
        t->uv[i][1] = rows[(i * 5 % CAMERAS) / COLUMNS];
    }
    t->file = fixture_make(CAMERAS, width, height, RELUME_STORE_8, RELUME_DOMAIN_LINEAR, false);
    t->about = (struct app_file){slab_geometry(), width, height, CAMERAS, {-1, -0.5}, {1, 0.5}};
    const struct code_source source = {fixture_fetch, NULL, &t->file, NULL};
    assert_int_equal(renderer_create(&t->renderer, &fixture_gl, &source, &t->about.geometry,
                                     (const double(*)[2])t->uv, CAMERAS, &fixture_log),
                     RELUME_OK);
    for (int i = 0; i < CAMERAS; i++)
        t->views[i] = fixture_relight(&t->file, i, lights, LIGHTS);
}

static void close_slab(struct slab_test *t)
{
    renderer_destroy(&t->renderer);
    fixture_free(&t->file);
    for (int i = 0; i < CAMERAS; i++)
        relume_image_destroy(&t->views[i]);
}

// No eye has a pixel's centre on the rim of the cameras: there a rounding decides on black or not.
static void slab_frames_are_the_library_s(void **state)
{
    (void)state;
    static const struct relume_vec3 eyes[] = {{0, 0, 3},      {-1, 0.5, 3},   {-1, -0.5, 3},
                                              {0.1, 0.25, 3}, {1, 0, 3},      {0.4, 0.1, 3},
                                              {0.3, -0.2, 6}, {0, 0, 2},      {1.2, -0.31, 6},
                                              {0, 0, 1.2},    {-0.6, 0.4, 9}, {-0.2, 0.25, 3.2}};
    struct slab_test t;
    open_slab(&t, 40, 30);
    const struct relume_geometry g = slab_geometry();
    relume_slab *slab;
    assert_int_equal(relume_slab_create(&slab, &g, (const double(*)[2])t.uv, CAMERAS), RELUME_OK);
    for (size_t i = 0; i < sizeof eyes / sizeof *eyes; i++) {
        const int width = i % 2 ? 40 : 67;
        const int height = i % 2 ? 30 : 45;
        struct relume_image want;
        char text[64];
        snprintf(text, sizeof text, "eye %g %g %g", eyes[i].x, eyes[i].y, eyes[i].z);
        assert_int_equal(relume_image_create(&want, width, height, 3), RELUME_OK);
        assert_int_equal(relume_slab_frame(&want, slab, eyes[i], t.views, NULL), RELUME_OK);
        const struct relume_camera camera = {
            .framing = RELUME_FRAME_EYE, .eye = eyes[i], .width = width, .height = height};
        const struct app app = make_app(&t.about, &camera);
        assert_below(text, compare_frame(&t.renderer, &app, &want), same_grid_bound);
        relume_image_destroy(&want);
    }
    relume_slab_destroy(&slab);
    close_slab(&t);
}

static void only_views_that_matter_are_relit(void **state)
{
    (void)state;
    struct slab_test t;
    open_slab(&t, 8, 8);
    t.file.asked = 0;
    const struct relume_camera camera = {.framing = RELUME_FRAME_EYE, .eye = {1, 0.5, 3}};
    struct app app = make_app(&t.about, &camera);
    assert_int_equal(renderer_draw(&t.renderer, &app), RELUME_OK);
    assert_int_equal(t.file.asked, 1);
    app.now.camera.eye = (struct relume_vec3){0.5, 0.4, 3};
    assert_int_equal(renderer_draw(&t.renderer, &app), RELUME_OK);
    assert_int_equal(t.file.asked, 4);
    // An eye that sees nothing gives a black frame, not an error.
    app.now.camera.eye = (struct relume_vec3){9, 9, 3};
    struct relume_image black;
    assert_int_equal(relume_image_create(&black, 8, 8, 3), RELUME_OK);
    assert_true(compare_frame(&t.renderer, &app, &black) == 0);
    relume_image_destroy(&black);
    close_slab(&t);
}

static void one_row_and_one_camera_are_drawn(void **state)
{
    (void)state;
    static const double uv[][2] = {{0.5, 0.2}, {-0.5, 0.2}};
    const struct relume_geometry g = slab_geometry();
    for (int n = 1; n <= 2; n++) {
        struct fixture_file f = fixture_make(n, 9, 7, RELUME_STORE_8, RELUME_DOMAIN_LINEAR, false);
        const struct app_file file = {g, 9, 7, n, {-0.5, 0.2}, {0.5, 0.2}};
        const struct code_source source = {fixture_fetch, NULL, &f, NULL};
        struct renderer r;
        assert_int_equal(renderer_create(&r, &fixture_gl, &source, &g, uv, n, &fixture_log),
                         RELUME_OK);
        const struct relume_camera camera = {.framing = RELUME_FRAME_EYE, .eye = {0.5, 0.2, 3}};
        const struct app app = make_app(&file, &camera);
        struct relume_image want = fixture_relight(&f, 0, lights, LIGHTS);
        assert_below("camera itself", compare_frame(&r, &app, &want), same_grid_bound);
        relume_image_destroy(&want);
        renderer_destroy(&r);
        fixture_free(&f);
    }
}

static void cameras_without_a_grid_are_refused(void **state)
{
    (void)state;
    static const double uv[][2] = {{0, 0}, {1, 1}};
    const struct relume_geometry g = slab_geometry();
    const struct code_source source = {fixture_fetch, NULL, NULL, NULL};
    struct renderer r;
    assert_int_equal(renderer_create(&r, &fixture_gl, &source, &g, uv, 2, NULL), RELUME_EDATA);
}

// ---------------------------------------------------------------- panorama

static void compare_panorama(const struct relume_geometry *g, int width, int height)
{
    static const struct relume_look looks[] = {{0, 0, 1},   {180, 0, 1},    {-90, 40, 1.5},
                                               {30, 90, 1}, {70, -80, 0.7}, {135, 35, 2}};
    struct fixture_file f =
        fixture_make(1, width, height, RELUME_STORE_8, RELUME_DOMAIN_LINEAR, true);
    const struct app_file file = {*g, width, height, 1, {0}, {0}};
    const struct code_source source = {fixture_fetch, NULL, &f, NULL};
    struct renderer r;
    assert_int_equal(renderer_create(&r, &fixture_gl, &source, g, NULL, 1, &fixture_log),
                     RELUME_OK);
    struct relume_image image = fixture_relight(&f, 0, lights, LIGHTS), want;
    assert_int_equal(relume_image_create(&want, 90, 60, 3), RELUME_OK);
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++) {
        char text[64];
        snprintf(text, sizeof text, "%s, pan %g tilt %g", relume_projection_name(g->projection),
                 looks[i].pan_deg, looks[i].tilt_deg);
        assert_int_equal(relume_panorama_frame(&want, g, &image, looks[i], NULL), RELUME_OK);
        const struct relume_camera camera = {
            .framing = RELUME_FRAME_LOOK, .look = looks[i], .width = 90, .height = 60};
        const struct app app = make_app(&file, &camera);
        assert_below(text, compare_frame(&r, &app, &want), look_bound);
    }
    relume_image_destroy(&want);
    relume_image_destroy(&image);
    renderer_destroy(&r);
    fixture_free(&f);
}

static void panorama_frames_are_the_library_s(void **state)
{
    (void)state;
    // A cylinder that reaches beyond all looks: its rim is a jump that one rounding moves.
    compare_panorama(
        &(struct relume_geometry){.projection = RELUME_CYLINDRICAL, .v_min = -80, .v_max = 80}, 64,
        48);
    compare_panorama(&(struct relume_geometry){.projection = RELUME_SPHERICAL}, 64, 32);
    compare_panorama(&(struct relume_geometry){.projection = RELUME_SPHERICAL}, 63, 32);
    compare_panorama(&(struct relume_geometry){.projection = RELUME_CUBE}, 6 * 16, 16);
}

// ---------------------------------------------------------------- ball

static void the_ball_is_bright_where_the_light_comes_from(void **state)
{
    (void)state;
    enum { W = 200, H = 200 };
    struct fixture_file f = fixture_make(1, 4, 4, RELUME_STORE_8, RELUME_DOMAIN_LINEAR, false);
    const struct app_file file = {.geometry = {.projection = RELUME_PLANAR}, W, H, 1, {0}, {0}};
    const struct code_source source = {fixture_fetch, NULL, &f, NULL};
    struct renderer r;
    assert_int_equal(
        renderer_create(&r, &fixture_gl, &source, &file.geometry, NULL, 1, &fixture_log),
        RELUME_OK);
    const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW};
    struct app app = make_app(&file, &camera);
    app.now.ball = true;
    app.now.lights = 1;
    app.now.light[0] = (struct relume_light){.direction = {-1, 1, 0.5}, .rgb = {1, 1, 1}};
    struct relume_image got;
    assert_int_equal(renderer_draw(&r, &app), RELUME_OK);
    assert_int_equal(renderer_read(&got, &r), RELUME_OK);
    // radius 0.09 x 200 = 18, middle 1.4 radii from the corner; look half a radius from the middle
    const int middle = (int)(200 - 1.4 * 18);
    const float *upper_left = &got.data[3 * ((middle - 9) * W + middle - 9)];
    const float *lower_right = &got.data[3 * ((middle + 9) * W + middle + 9)];
    assert_true(upper_left[0] > 0.5f);
    assert_true(lower_right[0] < 0.1f);
    relume_image_destroy(&got);
    renderer_destroy(&r);
    fixture_free(&f);
}

// ---------------------------------------------------------------- screen

// The screen of an OSMesa context is the one pixel it was opened with.
static void the_screen_shows_srgb(void **state)
{
    (void)state;
    const struct relume_transfer srgb = {RELUME_CURVE_SRGB, 0};
    struct program present;
    struct target frame;
    assert_int_equal(draw_present_create(&present, &fixture_gl, &fixture_log), RELUME_OK);
    assert_int_equal(target_create(&frame, &fixture_gl, 1, 1, &fixture_log), RELUME_OK);
    GLuint vertices;
    fixture_gl.GenVertexArrays(1, &vertices);
    fixture_gl.BindVertexArray(vertices);
    static const float values[] = {-0.5f, 0, 0.001f, 0.0031308f, 0.02f, 0.18f, 0.5f, 1, 7};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        unsigned char shown[4];
        target_begin(&frame, &fixture_gl);
        fixture_gl.ClearColor(values[i], 0.25f, 0, 1);
        fixture_gl.Clear(GL_COLOR_BUFFER_BIT);
        draw_present(&present, &fixture_gl, &frame, 0, 4, 0);
        fixture_gl.ReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, shown);
        const float code = relume_transfer_encode(srgb, fminf(fmaxf(values[i], 0), 1));
        assert_true(abs(shown[0] - (int)lroundf(255 * code)) <= 1);
        assert_int_equal(shown[2], 0);
    }
    fixture_gl.DeleteVertexArrays(1, &vertices);
    target_destroy(&frame, &fixture_gl);
    program_destroy(&present, &fixture_gl);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_view_is_drawn_texel_by_texel),
        cmocka_unit_test(a_reduced_view_is_averaged),
        cmocka_unit_test(slab_frames_are_the_library_s),
        cmocka_unit_test(only_views_that_matter_are_relit),
        cmocka_unit_test(one_row_and_one_camera_are_drawn),
        cmocka_unit_test(cameras_without_a_grid_are_refused),
        cmocka_unit_test(panorama_frames_are_the_library_s),
        cmocka_unit_test(the_ball_is_bright_where_the_light_comes_from),
        cmocka_unit_test(the_screen_shows_srgb),
    };
    return cmocka_run_group_tests_name("frames", tests, fixture_open, fixture_close);
}
