// Frames drawn by OpenGL against the library's: picture, slab, panoramas
//
// Compares: shared/footprint.glsl, shared/panorama.glsl, shared/panorama_discs.glsl,
// shared/slab_depth.glsl, shared/slab_lens.glsl, slab_cell.glsl, slab_lens.frag.glsl with
// footprint.h, panorama.c, panorama_discs.c, slab.c, slab_depth.c, slab_lens.c.
#include "format/coder/coding.h"
#include "relight/view/view.h"

#include "fixture.h"
#include "request.h"

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
    struct relume_light light[LIGHTS];
    struct app_light_state lamp[LIGHTS] = {{.off = false}};
    memcpy(light, lights, sizeof lights);
    const struct app_state start = {
        .camera = *camera, .light = light, .light_state = lamp, .lights = LIGHTS};
    struct app app;
    assert_int_equal(app_start(&app, file, &start, false, &fixture_log), RELUME_OK);
    return app;
}

static double compare_frame(struct gl_renderer *r, const struct app *app,
                            const struct relume_image *want)
{
    struct relume_image got;
    assert_int_equal(draw_app(r, app), RELUME_OK);
    assert_int_equal(gl_renderer_read(&got, r), RELUME_OK);
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
    const struct code_source source = {fixture_fetch, NULL, &f, NULL, NULL};
    struct gl_renderer r;
    assert_int_equal(
        gl_renderer_create(&r, &fixture_gl, &source, &file.geometry, NULL, 2, &fixture_log),
        RELUME_OK);
    const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW, .view = 1};
    OWNED_APP app = make_app(&file, &camera);
    struct relume_image want = fixture_relight(&f, 1, lights, LIGHTS);
    assert_below("view", compare_frame(&r, &app, &want), same_grid_bound);
    app.now.exposure_ev = -2;
    for (int i = 0; i < 3 * W * H; i++)
        want.data[i] *= 0.25f;
    assert_below("view, exposure -2", compare_frame(&r, &app, &want), same_grid_bound);
    relume_image_destroy(&want);
    gl_renderer_destroy(&r);
    fixture_free(&f);
}

// Half the size: every pixel is the mean of the four it covers, in linear light.
static void a_reduced_view_is_averaged(void **state)
{
    (void)state;
    enum { W = 32, H = 20 };
    struct fixture_file f = fixture_make(1, W, H, RELUME_STORE_8, RELUME_DOMAIN_DISPLAY, false);
    const struct app_file file = {.geometry = {.projection = RELUME_PLANAR}, W, H, 1, {0}, {0}};
    const struct code_source source = {fixture_fetch, NULL, &f, NULL, NULL};
    struct gl_renderer r;
    assert_int_equal(
        gl_renderer_create(&r, &fixture_gl, &source, &file.geometry, NULL, 1, &fixture_log),
        RELUME_OK);
    const struct relume_camera camera = {
        .framing = RELUME_FRAME_VIEW, .width = W / 2, .height = H / 2};
    OWNED_APP app = make_app(&file, &camera);
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
    gl_renderer_destroy(&r);
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
    struct gl_renderer renderer;
    struct relume_image views[CAMERAS];
    double uv[CAMERAS][2];
    int texels;  // read of parts
};

static relume_status fetch_part(struct relume_codes_part *out, void *user, int view,
                                const struct relume_rect *at)
{
    struct slab_test *t = user;
    const struct relume_codes *codes;
    assert_int_equal(fixture_fetch(&codes, &t->file, view), RELUME_OK);
    t->texels += at->width * at->height;
    return relume_codes_crop(out, codes, at);
}

static void open_slab(struct slab_test *t, int width, int height)
{
    for (int i = 0; i < CAMERAS; i++) {
        t->uv[i][0] = columns[(i * 5 % CAMERAS) % COLUMNS];
        t->uv[i][1] = rows[(i * 5 % CAMERAS) / COLUMNS];
    }
    t->file = fixture_make(CAMERAS, width, height, RELUME_STORE_8, RELUME_DOMAIN_LINEAR, false);
    t->about = (struct app_file){.geometry = slab_geometry(),
                                 .width = width,
                                 .height = height,
                                 .views = CAMERAS,
                                 .uv_min = {-1, -0.5},
                                 .uv_max = {1, 0.5}};
    const struct code_source source = {fixture_fetch, NULL, &t->file, NULL, NULL};
    assert_int_equal(gl_renderer_create(&t->renderer, &fixture_gl, &source, &t->about.geometry,
                                        (const double(*)[2])t->uv, CAMERAS, &fixture_log),
                     RELUME_OK);
    for (int i = 0; i < CAMERAS; i++)
        t->views[i] = fixture_relight(&t->file, i, lights, LIGHTS);
}

// How views get onto the GPU: whole, as parts because nothing fits, as parts that the library
// relights.
enum { WHOLE, PARTS, PARTS_BY_LIBRARY, WAYS };

static void open_slab_by(struct slab_test *t, int way)
{
    open_slab(t, 40, 30);
    const struct part_source parts = {fetch_part, t};
    const struct relume_pack_info info = {
        .width = 40, .height = 30, .planes = t->file.codes[0].planes, .storage = RELUME_STORE_8};
    t->texels = 0;
    if (way == WHOLE)
        return;
    gl_renderer_use_parts(&t->renderer, &parts, &info);
    t->renderer.relighter.memory.most = 1;
    t->renderer.relighter.by_library = way == PARTS_BY_LIBRARY;
}

static void close_slab(struct slab_test *t)
{
    gl_renderer_destroy(&t->renderer);
    fixture_free(&t->file);
    for (int i = 0; i < CAMERAS; i++)
        relume_image_destroy(&t->views[i]);
}

// No eye has a pixel's centre on the rim of the cameras: there a rounding decides on black or not.
static void check_slab_frames(int way)
{
    static const struct relume_vec3 eyes[] = {{0, 0, 3},      {-1, 0.5, 3},   {-1, -0.5, 3},
                                              {0.1, 0.25, 3}, {1, 0, 3},      {0.4, 0.1, 3},
                                              {0.3, -0.2, 6}, {0, 0, 2},      {1.2, -0.31, 6},
                                              {0, 0, 1.2},    {-0.6, 0.4, 9}, {-0.2, 0.25, 3.2}};
    struct slab_test t;
    open_slab_by(&t, way);
    const struct relume_geometry g = slab_geometry();
    relume_slab *slab;
    assert_int_equal(relume_slab_create(&slab, &g, (const double(*)[2])t.uv, CAMERAS), RELUME_OK);
    for (size_t i = 0; i < sizeof eyes / sizeof *eyes; i++) {
        const int width = i % 2 ? 40 : 68;
        const int height = i % 2 ? 30 : 51;
        struct relume_image want;
        char text[64];
        snprintf(text, sizeof text, "eye %g %g %g", eyes[i].x, eyes[i].y, eyes[i].z);
        assert_int_equal(relume_image_create(&want, width, height, 3), RELUME_OK);
        assert_int_equal(relume_slab_frame(&want, slab, eyes[i], t.views, NULL), RELUME_OK);
        const struct relume_camera camera = {
            .framing = RELUME_FRAME_EYE, .eye = eyes[i], .width = width, .height = height};
        OWNED_APP app = make_app(&t.about, &camera);
        assert_below(text, compare_frame(&t.renderer, &app, &want), same_grid_bound);
        relume_image_destroy(&want);
    }
    assert_true((t.texels > 0) == (way != WHOLE));
    relume_slab_destroy(&slab);
    close_slab(&t);
}

static void slab_frames_are_the_library_s(void **state)
{
    (void)state;
    for (int way = WHOLE; way < WAYS; way++)
        check_slab_frames(way);
}

// A floor that rises to the right with a block on it, as the camera at (u, v) sees it: smooth, with
// jumps, and some background.
static relume_status make_depth(struct relume_image *out, void *user, int view)
{
    const struct slab_test *t = user;
    const struct relume_geometry g = slab_geometry();
    const double *eye = t->uv[view];
    const int width = t->about.width, height = t->about.height;
    assert_int_equal(relume_image_create(out, width, height, 1), RELUME_OK);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const double s = g.st_min[0] + (x + 0.5) / width * 2;
            const double v = g.st_max[1] - (y + 0.5) / height * 1.5;
            const double block = (g.uv_z - 1) / g.uv_z;  // how far down the ray z = 1 lies
            const double at[2] = {eye[0] + block * (s - eye[0]), eye[1] + block * (v - eye[1])};
            const double slope[2] = {0.2, -0.4};  // floor: z = 0.2 x - 0.4
            const double floor =
                (g.uv_z - slope[1] - slope[0] * eye[0]) / (g.uv_z + slope[0] * (s - eye[0]));
            const bool on_block = fabs(at[0]) < 0.2 && fabs(at[1] - 0.1) < 0.15;
            const double part = on_block ? block : y < 2 ? (double)INFINITY : floor;
            const double length = hypot(hypot(s - eye[0], v - eye[1]), g.uv_z);
            out->data[y * width + x] = (float)(part * length);
        }
    return RELUME_OK;
}

// Where a walk meets the surface hangs on comparisons of rounded numbers: of a hundred pixels one
// may find another texel.
static void compare_most(const char *what, const struct relume_image *got,
                         const struct relume_image *want)
{
    const int pixels = got->width * got->height;
    int wrong = 0;
    for (int i = 0; i < pixels; i++) {
        bool off = false;
        for (int c = 0; c < 3; c++)
            off |= !(fabs((double)got->data[3 * i + c] - (double)want->data[3 * i + c]) < 1e-3);
        wrong += off;
    }
    assert_below(what, wrong, 0.01 * pixels);
}

static void check_slab_frames_by_depth(int way)
{
    static const struct relume_vec3 eyes[] = {{0, 0, 3},      {-0.6, 0.3, 3}, {0.1, 0.25, 3},
                                              {0.4, 0.25, 3}, {0.3, 0, 5},    {-0.2, 0.11, 2.3},
                                              {0.1, 0, 1.4}};
    struct slab_test t;
    open_slab_by(&t, way);
    const struct depth_source source = {make_depth, &t};
    assert_int_equal(gl_renderer_use_depth(&t.renderer, &source), RELUME_OK);
    struct relume_image disparity[CAMERAS];
    for (int i = 0; i < CAMERAS; i++) {
        struct relume_image depth;
        assert_int_equal(make_depth(&depth, &t, i), RELUME_OK);
        assert_int_equal(
            relume_slab_disparity(&disparity[i], t.renderer.views.grid, t.uv[i], &depth),
            RELUME_OK);
        relume_image_destroy(&depth);
    }
    for (size_t i = 0; i < sizeof eyes / sizeof *eyes; i++) {
        struct relume_image want, got;
        char text[64];
        snprintf(text, sizeof text, "by depth, eye %g %g %g", eyes[i].x, eyes[i].y, eyes[i].z);
        assert_int_equal(relume_image_create(&want, 68, 51, 3), RELUME_OK);
        assert_int_equal(relume_slab_frame(&want, t.renderer.views.grid, eyes[i], t.views,
                                           relume_view_params(.disparity = disparity)),
                         RELUME_OK);
        const struct relume_camera camera = {
            .framing = RELUME_FRAME_EYE, .eye = eyes[i], .width = 68, .height = 51};
        OWNED_APP app = make_app(&t.about, &camera);
        assert_int_equal(draw_app(&t.renderer, &app), RELUME_OK);
        assert_int_equal(gl_renderer_read(&got, &t.renderer), RELUME_OK);
        compare_most(text, &got, &want);
        relume_image_destroy(&got);
        // and not by accident: without depth it is another frame
        app.now.interpolation = RELUME_INTERPOLATE_LINEAR;
        if (i != 2)
            assert_true(compare_frame(&t.renderer, &app, &want) > 0.1);
        relume_image_destroy(&want);
    }
    for (int i = 0; i < CAMERAS; i++)
        relume_image_destroy(&disparity[i]);
    assert_true((t.texels > 0) == (way != WHOLE));
    close_slab(&t);
}

static void slab_frames_by_depth_are_the_library_s(void **state)
{
    (void)state;
    for (int way = WHOLE; way < WAYS; way++)
        check_slab_frames_by_depth(way);
}

static void other_ways_to_see_a_slab_are_the_library_s(void **state)
{
    (void)state;
    static const struct relume_view_params ways[] = {
        {.interpolation = RELUME_INTERPOLATE_CONSTANT},
        {.aperture = 0.3},
        {.focus = 0.6},
        {.aperture = 0.9, .focus = -0.7},
        {.aperture = 5, .focus = 1},
    };
    static const struct relume_vec3 eyes[] = {{0, 0, 3}, {-0.61, 0.33, 3}, {0.3, 0.01, 4.1}};
    struct slab_test t;
    open_slab(&t, 40, 30);
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++)
        for (size_t e = 0; e < sizeof eyes / sizeof *eyes; e++) {
            struct relume_image want;
            char text[96];
            snprintf(text, sizeof text, "way %d, aperture %g, focus %g, eye %g %g %g",
                     ways[i].interpolation, ways[i].aperture, ways[i].focus, eyes[e].x, eyes[e].y,
                     eyes[e].z);
            assert_int_equal(relume_image_create(&want, 68, 51, 3), RELUME_OK);
            assert_int_equal(
                relume_slab_frame(&want, t.renderer.views.grid, eyes[e], t.views, &ways[i]),
                RELUME_OK);
            const struct relume_camera camera = {
                .framing = RELUME_FRAME_EYE, .eye = eyes[e], .width = 68, .height = 51};
            OWNED_APP app = make_app(&t.about, &camera);
            app.now.interpolation = ways[i].interpolation;
            app.now.aperture = ways[i].aperture;
            app.now.focus_z = ways[i].focus;
            assert_below(text, compare_frame(&t.renderer, &app, &want), same_grid_bound);
            relume_image_destroy(&want);
        }
    close_slab(&t);
}

// Means over what a pixel covers. From the cameras' plane all rays of a frame pass one cell; from
// elsewhere samples of a pixel between two cells are of its middle's in the shader.
static void reduced_slab_frames_are_the_library_s(void **state)
{
    (void)state;
    static const struct relume_view_params ways[] = {{.interpolation = RELUME_INTERPOLATE_LINEAR},
                                                     {.aperture = 0.9, .focus = 0.4}};
    static const struct relume_vec3 eyes[] = {{0, 0, 3}, {-0.61, 0.33, 3}};
    static const int sizes[][2] = {{16, 12}, {28, 21}, {4, 3}};
    struct slab_test t;
    open_slab(&t, 40, 30);
    for (size_t w = 0; w < 2; w++)
        for (size_t e = 0; e < 2; e++)
            for (size_t k = 0; k < 3; k++) {
                struct relume_image want, one;
                struct relume_view_params single = ways[w];
                single.one = true;
                assert_int_equal(relume_image_create(&want, sizes[k][0], sizes[k][1], 3),
                                 RELUME_OK);
                assert_int_equal(relume_image_create(&one, sizes[k][0], sizes[k][1], 3), RELUME_OK);
                assert_int_equal(
                    relume_slab_frame(&want, t.renderer.views.grid, eyes[e], t.views, &ways[w]),
                    RELUME_OK);
                assert_int_equal(
                    relume_slab_frame(&one, t.renderer.views.grid, eyes[e], t.views, &single),
                    RELUME_OK);
                const struct relume_camera camera = {.framing = RELUME_FRAME_EYE,
                                                     .eye = eyes[e],
                                                     .width = sizes[k][0],
                                                     .height = sizes[k][1]};
                OWNED_APP app = make_app(&t.about, &camera);
                app.now.interpolation = ways[w].interpolation;
                app.now.aperture = ways[w].aperture;
                app.now.focus_z = ways[w].focus;
                assert_below("reduced", compare_frame(&t.renderer, &app, &want), same_grid_bound);
                assert_true(compare_frame(&t.renderer, &app, &one) > 0.05);
                relume_image_destroy(&want);
                relume_image_destroy(&one);
            }
    close_slab(&t);
}

static void only_views_that_matter_are_relit(void **state)
{
    (void)state;
    struct slab_test t;
    open_slab(&t, 8, 8);
    t.file.asked = 0;
    const struct relume_camera camera = {.framing = RELUME_FRAME_EYE, .eye = {1, 0.5, 3}};
    OWNED_APP app = make_app(&t.about, &camera);
    assert_int_equal(draw_app(&t.renderer, &app), RELUME_OK);
    assert_int_equal(t.file.asked, 1);
    app.now.camera.eye = (struct relume_vec3){0.5, 0.4, 3};
    assert_int_equal(draw_app(&t.renderer, &app), RELUME_OK);
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
        const struct app_file file = {.geometry = g,
                                      .width = 9,
                                      .height = 7,
                                      .views = n,
                                      .uv_min = {-0.5, 0.2},
                                      .uv_max = {0.5, 0.2}};
        const struct code_source source = {fixture_fetch, NULL, &f, NULL, NULL};
        struct gl_renderer r;
        assert_int_equal(gl_renderer_create(&r, &fixture_gl, &source, &g, uv, n, &fixture_log),
                         RELUME_OK);
        const struct relume_camera camera = {.framing = RELUME_FRAME_EYE, .eye = {0.5, 0.2, 3}};
        OWNED_APP app = make_app(&file, &camera);
        struct relume_image want = fixture_relight(&f, 0, lights, LIGHTS);
        assert_below("camera itself", compare_frame(&r, &app, &want), same_grid_bound);
        relume_image_destroy(&want);
        gl_renderer_destroy(&r);
        fixture_free(&f);
    }
}

static void cameras_without_a_grid_are_refused(void **state)
{
    (void)state;
    static const double uv[][2] = {{0, 0}, {1, 1}};
    const struct relume_geometry g = slab_geometry();
    const struct code_source source = {fixture_fetch, NULL, NULL, NULL, NULL};
    struct gl_renderer r;
    assert_int_equal(gl_renderer_create(&r, &fixture_gl, &source, &g, uv, 2, NULL), RELUME_EUNFIT);
}

// ---------------------------------------------------------------- panorama

// All pixels within `bound`; 0: most of them.
static void compare_panorama(const struct relume_geometry *g, int width, int height, double bound)
{
    static const struct relume_pan_tilt looks[] = {
        {0, 0, 1, 0},      {180, 0, 1, 0},  {-90, 40, 1.5, 0}, {30, 90, 1, 0},
        {70, -80, 0.7, 0}, {135, 35, 2, 0}, {20, -90, 0.5, 1}, {-130, 25, 0.8, 1}};
    struct fixture_file f =
        fixture_make(1, width, height, RELUME_STORE_8, RELUME_DOMAIN_LINEAR, true);
    const struct app_file file = {.geometry = *g, .width = width, .height = height, .views = 1};
    const struct code_source source = {fixture_fetch, NULL, &f, NULL, NULL};
    struct gl_renderer r;
    assert_int_equal(gl_renderer_create(&r, &fixture_gl, &source, g, NULL, 1, &fixture_log),
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
        OWNED_APP app = make_app(&file, &camera);
        if (bound > 0) {
            assert_below(text, compare_frame(&r, &app, &want), bound);
            continue;
        }
        struct relume_image got;
        assert_int_equal(draw_app(&r, &app), RELUME_OK);
        assert_int_equal(gl_renderer_read(&got, &r), RELUME_OK);
        compare_most(text, &got, &want);
        relume_image_destroy(&got);
    }
    relume_image_destroy(&want);
    relume_image_destroy(&image);
    gl_renderer_destroy(&r);
    fixture_free(&f);
}

static void panorama_frames_are_the_library_s(void **state)
{
    (void)state;
    // A cylinder that reaches beyond all looks: its rim is a jump that one rounding moves. Near its
    // pole pixels cover any number of rows, of which the shader looks at 16, the library at 64.
    compare_panorama(
        &(struct relume_geometry){.projection = RELUME_CYLINDRICAL, .v_min = -80, .v_max = 80}, 64,
        48, 0.05);
    compare_panorama(
        &(struct relume_geometry){
            .projection = RELUME_CYLINDRICAL, .v_min = -0.75, .v_max = 1, .disc = 20},
        64, 18 + 20, look_bound);
    compare_panorama(&(struct relume_geometry){.projection = RELUME_SPHERICAL}, 64, 32, look_bound);
    compare_panorama(&(struct relume_geometry){.projection = RELUME_SPHERICAL}, 63, 32, look_bound);
    compare_panorama(&(struct relume_geometry){.projection = RELUME_CUBE}, 6 * 16, 16, look_bound);
    // So many texels that every pixel is a mean. Where a pixel covers a whole number of them a
    // rounding decides on one sample more.
    compare_panorama(&(struct relume_geometry){.projection = RELUME_SPHERICAL}, 512, 256, 0);
    compare_panorama(&(struct relume_geometry){.projection = RELUME_CUBE}, 6 * 96, 96, 0);
}

// ---------------------------------------------------------------- ball

static void the_ball_is_bright_where_the_light_comes_from(void **state)
{
    (void)state;
    enum { W = 200, H = 200 };
    struct fixture_file f = fixture_make(1, 4, 4, RELUME_STORE_8, RELUME_DOMAIN_LINEAR, false);
    const struct app_file file = {.geometry = {.projection = RELUME_PLANAR}, W, H, 1, {0}, {0}};
    const struct code_source source = {fixture_fetch, NULL, &f, NULL, NULL};
    struct gl_renderer r;
    assert_int_equal(
        gl_renderer_create(&r, &fixture_gl, &source, &file.geometry, NULL, 1, &fixture_log),
        RELUME_OK);
    const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW};
    OWNED_APP app = make_app(&file, &camera);
    app.now.ball = true;
    app.now.lights = 1;
    app.now.light[0] = (struct relume_light){.direction = {-1, 1, 0.5}, .rgb = {1, 1, 1}};
    struct relume_image got;
    assert_int_equal(draw_app(&r, &app), RELUME_OK);
    assert_int_equal(gl_renderer_read(&got, &r), RELUME_OK);
    // radius 0.09 x 200 = 18, middle 1.4 radii from the corner; look half a radius from the middle
    const int middle = (int)(200 - 1.4 * 18);
    const float *upper_left = &got.data[3 * ((middle - 9) * W + middle - 9)];
    const float *lower_right = &got.data[3 * ((middle + 9) * W + middle + 9)];
    assert_true(upper_left[0] > 0.5f);
    assert_true(lower_right[0] < 0.1f);
    relume_image_destroy(&got);
    gl_renderer_destroy(&r);
    fixture_free(&f);
}

// ---------------------------------------------------------------- screen

// The screen of an OSMesa context is the one pixel it was opened with.
static const struct window_place whole = {0, 1, 1};

static void the_screen_shows_srgb(void **state)
{
    (void)state;
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    struct program present;
    struct target frame;
    assert_int_equal(
        program_create_fragment(&present, &fixture_gl, &draw_present_fragment, &fixture_log),
        RELUME_OK);
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
        draw_present(&present, &fixture_gl, &frame, &whole, 0, 4, 0);
        fixture_gl.ReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, shown);
        const float code = relume_transfer_encode(srgb, fminf(fmaxf(values[i], 0), 1));
        assert_true(abs(shown[0] - (int)lroundf(255 * code)) <= 1);
        assert_int_equal(shown[2], 0);
    }
    fixture_gl.DeleteVertexArrays(1, &vertices);
    target_destroy(&frame, &fixture_gl);
    program_destroy(&present, &fixture_gl);
}

static void tones_are_the_library_s(void **state)
{
    (void)state;
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    static const float values[][3] = {{0, 0, 0},    {0.18f, 0.18f, 0.18f}, {1, 0.5f, 0.25f},
                                      {3, 0.1f, 9}, {-1, 0.4f, 2},         {1e6f, 0, 1}};
    struct program present;
    struct target frame;
    GLuint vertices;
    assert_int_equal(
        program_create_fragment(&present, &fixture_gl, &draw_present_fragment, &fixture_log),
        RELUME_OK);
    assert_int_equal(target_create(&frame, &fixture_gl, 1, 1, &fixture_log), RELUME_OK);
    fixture_gl.GenVertexArrays(1, &vertices);
    fixture_gl.BindVertexArray(vertices);
    for (int t = 0; relume_tones[t]; t++)
        for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
            unsigned char shown[4];
            float want[3];
            target_begin(&frame, &fixture_gl);
            fixture_gl.ClearColor(values[i][0], values[i][1], values[i][2], 1);
            fixture_gl.Clear(GL_COLOR_BUFFER_BIT);
            draw_present(&present, &fixture_gl, &frame, &whole, t, 2.5, 0);
            fixture_gl.ReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, shown);
            relume_tones[t]->apply(want, values[i], 2.5f);
            for (int c = 0; c < 3; c++)
                assert_true(
                    abs(shown[c] - (int)lroundf(255 * relume_transfer_encode(srgb, want[c]))) <= 1);
        }
    fixture_gl.DeleteVertexArrays(1, &vertices);
    target_destroy(&frame, &fixture_gl);
    program_destroy(&present, &fixture_gl);
}

static void the_meter_sees_a_small_frame(void **state)
{
    (void)state;
    enum { W = 300, H = 170 };
    struct fixture_file f = fixture_make(1, W, H, RELUME_STORE_8, RELUME_DOMAIN_LINEAR, false);
    const struct app_file file = {.geometry = {.projection = RELUME_PLANAR}, W, H, 1, {0}, {0}};
    const struct code_source source = {.codes = fixture_fetch, .user = &f};
    struct gl_renderer r;
    assert_int_equal(
        gl_renderer_create(&r, &fixture_gl, &source, &file.geometry, NULL, 1, &fixture_log),
        RELUME_OK);
    const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW};
    OWNED_APP app = make_app(&file, &camera);
    double ev[2];
    for (int i = 0; i < 2; i++) {
        app.now.exposure_ev = 3 * i;
        assert_int_equal(draw_app(&r, &app), RELUME_OK);
        assert_int_equal(gl_renderer_meter(&ev[i], &r, &relume_tone_filmic), RELUME_OK);
    }
    assert_true(fabs(ev[0] - ev[1] - 3) < 0.1);
    struct relume_image frame;
    assert_int_equal(gl_renderer_read(&frame, &r), RELUME_OK);
    // noise is averaged in the small copy, which moves its logarithm by some tenths
    assert_below("metered", fabs(relume_tone_meter(&frame) - ev[1]), 0.5);
    relume_image_destroy(&frame);
    gl_renderer_destroy(&r);
    fixture_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_view_is_drawn_texel_by_texel),
        cmocka_unit_test(a_reduced_view_is_averaged),
        cmocka_unit_test(slab_frames_are_the_library_s),
        cmocka_unit_test(slab_frames_by_depth_are_the_library_s),
        cmocka_unit_test(other_ways_to_see_a_slab_are_the_library_s),
        cmocka_unit_test(reduced_slab_frames_are_the_library_s),
        cmocka_unit_test(only_views_that_matter_are_relit),
        cmocka_unit_test(one_row_and_one_camera_are_drawn),
        cmocka_unit_test(cameras_without_a_grid_are_refused),
        cmocka_unit_test(panorama_frames_are_the_library_s),
        cmocka_unit_test(the_ball_is_bright_where_the_light_comes_from),
        cmocka_unit_test(the_screen_shows_srgb),
        cmocka_unit_test(tones_are_the_library_s),
        cmocka_unit_test(the_meter_sees_a_small_frame),
    };
    return cmocka_run_group_tests_name("frames", tests, fixture_open, fixture_close);
}
