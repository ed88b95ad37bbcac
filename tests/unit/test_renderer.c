// A file drawn again and again: the frames of relume_frame, into any memory, and what is kept
#include "test.h"

#include "capture_fixture.h"
#include "relight/frame/renderer.h"
#include "relight/frame/renderer_views.h"
#include "relight/view/view.h"

enum { W = 31, H = 23, GAP = 24 };

static char folder[64], slab_path[96];
static relume_pack *slab;

static const struct relume_light lights[] = {{.direction = {0.1, 0.2, 0.9}, .rgb = {1, 1, 1}},
                                             {.direction = {0.8, 0.2, 0.3}, .rgb = {1, 2, 3}}};

static const struct relume_camera cameras[] = {
    {.framing = RELUME_FRAME_VIEW, .view = 1, .width = W, .height = H},
    {.framing = RELUME_FRAME_VIEW, .view = 0, .width = 50, .height = 20},  // borders beside it
    {.framing = RELUME_FRAME_EYE, .eye = {0.2, 0, 3.0}, .width = 40, .height = 30},
    {.framing = RELUME_FRAME_EYE,
     .eye = {0.2, 0, 3.0},
     .look_at = {.field_of_view_deg = 30.0},
     .width = 20,
     .height = 20},
};
enum { CAMERAS = sizeof cameras / sizeof *cameras };

static int setup(void **state)
{
    (void)state;
    test_folder(folder);
    fixture_write(
        &(struct fixture){.width = W, .height = H, .lights = 12, .views = 2, .depth = true},
        folder);
    snprintf(slab_path, sizeof slab_path, "%s/slab.exr", folder);
    return fixture_encode(folder, slab_path, &relume_basis_sh, 9, NULL) ||
           relume_pack_open(&slab, slab_path, NULL);
}

static int teardown(void **state)
{
    (void)state;
    relume_pack_destroy(&slab);
    test_folder_remove(folder);
    return 0;
}

static relume_renderer *make_renderer(const struct relume_frame_params *params)
{
    relume_renderer *r;
    CHECK_OK(relume_renderer_create(&r, slab, params));
    CHECK_OK(relume_renderer_set_lights(r, lights, 2));
    return r;
}

static struct relume_image frame_of(const struct relume_camera *camera,
                                    const struct relume_frame_params *params)
{
    struct relume_image out;
    CHECK_OK(relume_frame(&out, slab, camera, lights, 2, params));
    return out;
}

static bool is_black(const float *rgb)
{
    return rgb[0] == 0.0f && rgb[1] == 0.0f && rgb[2] == 0.0f;
}

// A byte may round to the other side where the coder's pieces and the curve differ by 1e-5.
static void check_pixel(const unsigned char *at, enum relume_target_format format,
                        const float *want, double ev)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    float value[4];
    if (format != RELUME_TARGET_RGBA8) {
        memcpy(value, at, (format == RELUME_TARGET_RGBA ? 4 : 3) * sizeof *value);
        assert_memory_equal(value, want, 3 * sizeof *value);
        assert_true(format != RELUME_TARGET_RGBA || value[3] == 1.0f || is_black(want));
        return;
    }
    for (int c = 0; c < 3; c++) {
        const float clipped = fminf(fmaxf(want[c] * exp2f((float)ev), 0.0f), 1.0f);
        CHECK_NEAR(at[c], 255.0 * (double)relume_transfer_encode(srgb, clipped), 0.51);
    }
    assert_true(at[3] == 255 || is_black(want));
}

static void any_memory_gets_the_frame(void **state)
{
    (void)state;
    relume_renderer *r = make_renderer(NULL);
    for (int k = 0; k < CAMERAS; k++) {
        const struct relume_camera *c = &cameras[k];
        struct relume_image want = frame_of(c, NULL);
        for (int format = RELUME_TARGET_RGB; format <= RELUME_TARGET_RGBA8; format++)
            for (int gap = 0; gap < 3; gap++) {
                const size_t pixel = (const size_t[]){12, 16, 4}[format];
                const size_t row = (size_t)c->width * pixel + (gap ? GAP : 0);
                unsigned char *memory = malloc(row * (size_t)c->height);
                memset(memory, 0xa5, row * (size_t)c->height);
                const bool upwards = gap == 2;
                struct relume_target t = {
                    .data = upwards ? memory + row * (size_t)(c->height - 1) : memory,
                    .format = (enum relume_target_format)format,
                    .width = c->width,
                    .height = c->height,
                    .stride = gap ? upwards ? -(ptrdiff_t)row : (ptrdiff_t)row : 0,
                    .exposure_ev = -1.0f,
                };
                CHECK_OK(relume_renderer_draw(r, c, &t));
                for (int y = 0; y < c->height; y++) {
                    const unsigned char *at =
                        memory + row * (size_t)(upwards ? c->height - 1 - y : y);
                    for (int x = 0; x < c->width; x++)
                        check_pixel(at + pixel * (size_t)x, t.format,
                                    want.data + 3 * ((size_t)y * (size_t)c->width + (size_t)x),
                                    -1.0);
                    for (int i = 0; gap && i < GAP; i++)  // what lies between rows is not ours
                        assert_int_equal(at[pixel * (size_t)c->width + (size_t)i], 0xa5);
                }
                free(memory);
            }
        relume_image_destroy(&want);
    }
    struct relume_target none = {.width = 3, .height = 3};
    assert_int_equal(relume_renderer_draw(r, &cameras[0], &none), RELUME_EINVAL);
    relume_renderer_destroy(&r);
}

static void expect_frame(relume_renderer *r, const struct relume_camera *camera,
                         const struct relume_image *want)
{
    struct relume_image got;
    CHECK_OK(relume_renderer_frame(&got, r, camera));
    assert_int_equal(got.width, want->width);
    assert_int_equal(got.height, want->height);
    assert_memory_equal(got.data, want->data,
                        3 * (size_t)got.width * (size_t)got.height * sizeof *got.data);
    relume_image_destroy(&got);
}

// Whatever was drawn before, a frame is that of relume_frame.
static void what_is_kept_still_holds(void **state)
{
    (void)state;
    static const struct relume_frame_params styles[] = {
        {0},
        {.interpolation = RELUME_INTERPOLATE_LINEAR},
        {.aperture = 0.4, .interpolation = RELUME_INTERPOLATE_LINEAR},
        {.pass = RELUME_PASS_LUMINANCE},
        {.pass = RELUME_PASS_NORMALS},
        {.filter = RELUME_FILTER_NEAREST},
    };
    enum { STYLES = sizeof styles / sizeof *styles };
    static const uint64_t memory[] = {0, 1};
    for (int m = 0; m < 2; m++) {
        struct relume_frame_params p = {.memory = memory[m]};
        relume_renderer *r = make_renderer(&p);
        for (int round = 0; round < 2; round++)
            for (int s = 0; s < STYLES; s++)
                for (int k = 0; k < CAMERAS - 1; k++) {
                    struct relume_image want = frame_of(&cameras[k], &styles[s]);
                    p = styles[s];
                    p.memory = memory[m];
                    relume_renderer_set(r, &p);
                    expect_frame(r, &cameras[k], &want);
                    relume_image_destroy(&want);
                }
        relume_renderer_destroy(&r);
    }
}

// A slide's picture is changed behind the renderer's back: what is kept goes on showing the old
// one.
static void lights_alone_relight(void **state)
{
    (void)state;
    struct relume_image slide;
    CHECK_OK(relume_image_create(&slide, 2, 2, 3));
    for (int i = 0; i < 12; i++)
        slide.data[i] = 1.0f;
    const struct relume_light lamp = {.kind = RELUME_LIGHT_SLIDE,
                                      .position = {0, 0, 4},
                                      .direction = {0, 0, -1},
                                      .half_angle_deg = 60,
                                      .image = &slide,
                                      .rgb = {1, 1, 1}};
    relume_renderer *r = make_renderer(NULL);
    struct relume_image bright, dark;
    CHECK_OK(relume_renderer_set_lights(r, &lamp, 1));
    CHECK_OK(relume_renderer_frame(&bright, r, &cameras[2]));
    const uint64_t kept = relume_renderer_bytes(r);
    assert_true(kept >= (uint64_t)2 * W * H * 3 * sizeof(float));
    for (int i = 0; i < 12; i++)
        slide.data[i] = 0.25f;
    expect_frame(r, &cameras[2], &bright);
    assert_int_equal(relume_renderer_bytes(r), kept);
    CHECK_OK(relume_renderer_set_lights(r, &lamp, 1));
    CHECK_OK(relume_frame(&dark, slab, &cameras[2], &lamp, 1, NULL));
    expect_frame(r, &cameras[2], &dark);
    assert_true(memcmp(bright.data, dark.data, 3 * sizeof *dark.data) != 0);
    relume_renderer_forget(r);
    assert_int_equal(relume_renderer_bytes(r), 0);
    expect_frame(r, &cameras[2], &dark);
    relume_image_destroy(&bright);
    relume_image_destroy(&dark);
    relume_image_destroy(&slide);
    relume_renderer_destroy(&r);
}

static void memory_is_bounded(void **state)
{
    (void)state;
    relume_renderer *r = make_renderer(relume_frame_params(.memory = 1));
    uint64_t bytes[3];
    for (int i = 0; i < 3; i++) {  // view 0, then twice view 1
        const struct relume_camera half = {.framing = RELUME_FRAME_VIEW, .view = i > 0, .width = 9};
        struct relume_image out;
        CHECK_OK(relume_renderer_frame(&out, r, &half));
        relume_image_destroy(&out);
        bytes[i] = relume_renderer_bytes(r);
    }
    // the last frame's views stay for one more, but for their codes
    assert_true(bytes[1] > bytes[0] && bytes[1] < 2 * bytes[0]);
    assert_int_equal(bytes[2], bytes[0]);
    relume_renderer_destroy(&r);
}

// A slab of eight cameras, whose middle an eye near the scene looks through.
static relume_pack *make_row(enum relume_storage storage)
{
    char path[96];
    relume_pack *pack;
    fixture_write(
        &(struct fixture){.width = 90, .height = 40, .lights = 12, .views = 8, .depth = true},
        folder);
    snprintf(path, sizeof path, "%s/row%d.exr", folder, (int)storage);
    CHECK_OK(fixture_encode(folder, path, &relume_basis_sh, 9,
                            relume_pack_encode_params(.storage = storage)));
    CHECK_OK(relume_pack_open(&pack, path, NULL));
    return pack;
}

// The frame from whole views, relit one by one.
static struct relume_image whole_frame(relume_pack *pack, vec3 eye,
                                       const struct relume_light *light, bool by_depth)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    struct relume_image views[8], disparity[8], out;
    relume_slab *grid;
    CHECK_OK(relume_slab_create(&grid, &info->geometry, info->uv, 8));
    for (int v = 0; v < 8; v++) {
        const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW, .view = v};
        struct relume_image depth;
        CHECK_OK(relume_frame(&views[v], pack, &camera, light, 1, NULL));
        CHECK_OK(relume_pack_depth(&depth, pack, v));
        CHECK_OK(relume_slab_disparity(&disparity[v], grid, info->uv[v], &depth));
        relume_image_destroy(&depth);
    }
    CHECK_OK(relume_image_create(&out, 90, 40, 3));
    CHECK_OK(relume_slab_frame(&out, grid, eye, views,
                               relume_view_params(.disparity = by_depth ? disparity : NULL)));
    for (int v = 0; v < 8; v++) {
        relume_image_destroy(&views[v]);
        relume_image_destroy(&disparity[v]);
        relume_pack_drop(pack, v);
    }
    relume_slab_destroy(&grid);
    return out;
}

// Near the scene a frame touches all cameras and sees little of each: no more is read and relit,
// and the picture is that of whole views bit by bit, wherever the eye was before.
static void near_eyes_cost_what_they_see(void **state)
{
    (void)state;
    static const vec3 eyes[] = {{0.7, 0, 0.6}, {0.71, 0, 0.6}, {3.5, 0, 2.9}, {1.4, 0, 1.2}};
    static const struct relume_light shining[] = {
        {.direction = {0.1, 0.2, 0.9}, .rgb = {1, 1, 1}},
        {.kind = RELUME_LIGHT_POINT, .position = {0.5, 1, 2}, .rgb = {1, 2, 3}}};
    relume_pack *pack = make_row(RELUME_STORE_8);
    for (int i = 0; i < 2; i++) {
        const bool by_depth = i == 0;
        relume_renderer *r[2];
        for (int m = 0; m < 2; m++)  // with any memory, and with none to keep anything in
            CHECK_OK(relume_renderer_create(
                &r[m], pack,
                relume_frame_params(.memory = (uint64_t)m,
                                    .interpolation = by_depth ? RELUME_INTERPOLATE_DEFAULT
                                                              : RELUME_INTERPOLATE_LINEAR)));
        for (int e = 0; e < 8; e += TEST_SANITIZED ? 5 : 1) {
            const struct relume_light *light = &shining[e / 4];
            const struct relume_camera camera = {.framing = RELUME_FRAME_EYE, .eye = eyes[e % 4]};
            struct relume_image want = whole_frame(pack, camera.eye, light, by_depth), got;
            for (int m = 0; m < 2; m++) {
                CHECK_OK(relume_renderer_set_lights(r[m], light, 1));
                CHECK_OK(relume_renderer_frame(&got, r[m], &camera));
                assert_memory_equal(got.data, want.data, sizeof(float) * 3 * 90 * 40);
                relume_image_destroy(&got);
                // of eight views of 27 codes, three floats and a disparity a pixel
                if (e == 0)
                    assert_true(relume_renderer_bytes(r[m]) < 8 * 90 * 40 * (27 + 12 + 4) / 2);
            }
            relume_image_destroy(&want);
        }
        for (int m = 0; m < 2; m++) {
            relume_renderer_forget(r[m]);
            assert_int_equal(relume_renderer_bytes(r[m]), 0);
            relume_renderer_destroy(&r[m]);
        }
    }
    relume_pack_destroy(&pack);
}

// A part of a view is that of the whole, bit by bit, by whatever light and pass, whatever was
// drawn before.
static void a_part_is_that_of_the_view(void **state)
{
    (void)state;
    static const struct relume_rect parts[] = {
        {3, 2, 10, 7}, {5, 4, 8, 9}, {0, 0, W, H}, {W - 1, H - 1, 1, 1}};
    static const struct relume_rect wrong[] = {
        {-1, 0, 1, 1}, {0, 0, W + 1, 1}, {0, H, 1, 1}, {0, 0, 0, 1}};
    static const struct relume_light near = {
        .kind = RELUME_LIGHT_POINT, .position = {0.5, 1, 2}, .rgb = {1, 2, 3}};
    struct relume_image out;
    for (int k = 0; k < 3; k++) {
        const struct relume_frame_params *params =
            relume_frame_params(.pass = k == 2 ? RELUME_PASS_UNSHARP : RELUME_PASS_COLOUR);
        relume_renderer *r;
        struct relume_image whole;
        CHECK_OK(relume_renderer_create(&r, slab, params));
        CHECK_OK(relume_renderer_set_lights(r, k == 1 ? &near : lights, k == 1 ? 1 : 2));
        CHECK_OK(relume_frame(&whole, slab, &cameras[0], k == 1 ? &near : lights, k == 1 ? 1 : 2,
                              params));
        relume_pack_drop(slab, 1);
        for (int i = 0; i < 4; i++) {
            const struct relume_rect *at = &parts[i];
            CHECK_OK(relume_renderer_part(&out, r, 1, at));
            assert_true(out.width == at->width && out.height == at->height);
            for (int y = 0; y < at->height; y++)
                assert_memory_equal(out.data + 3 * y * at->width,
                                    whole.data + 3 * ((at->top + y) * W + at->left),
                                    sizeof(float) * 3 * (size_t)at->width);
            relume_image_destroy(&out);
            assert_int_equal(relume_renderer_part(&out, r, 1, &wrong[i]), RELUME_EINVAL);
            assert_null(out.data);
        }
        assert_int_equal(relume_renderer_part(&out, r, 2, &parts[0]), RELUME_EINVAL);
        relume_image_destroy(&whole);
        relume_renderer_destroy(&r);
    }
}

// The sum of what is kept is carried from frame to frame: whatever came before, a frame adds what
// it adds to an empty renderer, and without what is kept there is nothing.
static void bytes_do_not_drift(void **state)
{
    (void)state;
    relume_renderer *r = make_renderer(relume_frame_params(.memory = 1 << 15));
    for (int k = 0; k < CAMERAS; k++) {
        struct relume_image out;
        relume_renderer *fresh = make_renderer(NULL);
        CHECK_OK(relume_renderer_frame(&out, fresh, &cameras[k]));
        relume_image_destroy(&out);
        for (int i = 0; i < CAMERAS; i++) {
            relume_renderer_set(r, relume_frame_params(.memory = 1 << 15, .assume_depth = i % 3));
            CHECK_OK(relume_renderer_frame(&out, r, &cameras[(k + i) % CAMERAS]));
            relume_image_destroy(&out);
        }
        relume_renderer_forget(r);
        assert_int_equal(relume_renderer_bytes(r), 0);
        CHECK_OK(relume_renderer_frame(&out, r, &cameras[k]));
        relume_image_destroy(&out);
        assert_int_equal(relume_renderer_bytes(r), relume_renderer_bytes(fresh));
        relume_renderer_destroy(&fresh);
    }
    relume_renderer_destroy(&r);
}

// One pixel by itself is that of the frame: bit by bit where it is a texel, and to rounding where
// four cameras are mixed in double precision along the ray and in single along the row.
static void a_pixel_is_that_of_the_frame(void **state)
{
    (void)state;
    relume_renderer *r = make_renderer(relume_frame_params(.filter = RELUME_FILTER_NEAREST));
    for (int k = 0; k < CAMERAS; k += 2) {
        struct relume_image frame;
        CHECK_OK(relume_renderer_frame(&frame, r, &cameras[k]));
        for (int i = 0; i < frame.width * frame.height; i += 7) {
            float rgb[3];
            CHECK_OK(relume_renderer_pixel(rgb, r, &cameras[k], i % frame.width + 0.5,
                                           (double)(i / frame.width) + 0.5));
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(rgb[c], frame.data[3 * i + c], 2e-5);
        }
        relume_image_destroy(&frame);
    }
    relume_renderer_destroy(&r);
}

static void places_are_where_depth_says(void **state)
{
    (void)state;
    relume_renderer *r = make_renderer(NULL);
    struct relume_image places, depth, surface;
    const struct relume_pack_info *info = relume_pack_info(slab);
    CHECK_OK(relume_renderer_places(&places, r, &cameras[0]));
    CHECK_OK(relume_pack_depth(&depth, slab, 1));
    CHECK_OK(
        relume_view_positions(&surface, relume_pack_geometry(slab, 1), info->uv[1], &depth, W, H));
    for (int i = 0; i < 3 * W * H; i++)
        if (isfinite(depth.data[i / 3]))
            assert_true(places.data[i] == surface.data[i]);
    relume_image_destroy(&places);
    relume_image_destroy(&depth);
    relume_image_destroy(&surface);
    relume_renderer_destroy(&r);
}

// ---------------------------------------------------------------- few rays

enum { RAYS = 200 };  // more than are few

static size_t found_texels(const relume_renderer *r)
{
    size_t n = 0;
    for (int v = 0; v < r->info->views; v++)
        for (int i = 0; r->kept[v].texel && i < r->info->width * r->info->height; i++)
            n += r->kept[v].texel[i] == r->lighting;
    return n;
}

// One at a time: the values of many together, and no more than `most` texels a ray.
static void check_rays(relume_pack *pack, const struct relume_ray *rays,
                       const struct relume_light *lamps, int n,
                       const struct relume_frame_params *params, size_t most)
{
    relume_renderer *all, *one;
    float want[RAYS][3];
    int seen = 0;
    CHECK_OK(relume_renderer_create(&all, pack, params));
    CHECK_OK(relume_renderer_create(&one, pack, params));
    CHECK_OK(relume_renderer_set_lights(all, lamps, n));
    CHECK_OK(relume_renderer_rays(want, all, rays, RAYS));
    assert_int_equal(found_texels(all), 0);
    for (int i = 0; i < RAYS; i++) {
        float got[3];
        if (isnan(want[i][0]))
            continue;
        CHECK_OK(relume_renderer_set_lights(one, lamps, n));  // forgets what was found
        CHECK_OK(relume_renderer_rays(&got, one, &rays[i], 1));
        assert_in_range(found_texels(one), 1, most);
        // the last pixels of a kernel's row are rounded once more: 2^-24 a term
        for (int c = 0; c < 3; c++)
            CHECK_NEAR((double)got[c], (double)want[i][c], 1e-6 * (1.0 + fabs((double)want[i][c])));
        seen++;
    }
    assert_true(seen > RAYS / 20);
    relume_renderer_destroy(&all);
    relume_renderer_destroy(&one);
}

static void check_file(const struct fixture *f, const char *name,
                       const struct relume_pack_encode_params *how)
{
    static const struct relume_light near[] = {
        {.direction = {0.1, 0.2, 0.9}, .rgb = {1, 1, 1}},
        {.kind = RELUME_LIGHT_POINT, .position = {0.4, 0.4, 2.5}, .rgb = {3, 2, 1}},
        {.kind = RELUME_LIGHT_POINT, .position = {-0.4, 0.4, 2.5}, .rgb = {1, 1, 1}},
    };
    char path[128];
    relume_pack *pack;
    struct relume_ray rays[RAYS];
    uint32_t state = 7;
    fixture_write(f, folder);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    CHECK_OK(fixture_encode(folder, path, &relume_basis_sh, 9, how));
    CHECK_OK(relume_pack_open(&pack, path, NULL));
    // through the cameras, which stand at v = 0, and the window
    const struct relume_geometry g = *relume_pack_geometry(pack, 0);
    const bool is_slab = g.projection == RELUME_SLAB;
    const double from = is_slab ? g.uv_z : 4.0, to = is_slab ? g.st_z : 0.0;
    for (int i = 0; i < RAYS; i++) {
        const double u = f->slabs ? test_uniform(&state) : 2.0 * test_uniform(&state);
        const double s = 1.8 * test_uniform(&state) - 0.9, t = 1.2 * test_uniform(&state) - 0.6;
        const struct relume_vec3 way = {s - u, t, to - from};
        rays[i] = (struct relume_ray){{u - 0.1 * way.x, -0.1 * way.y, from - 0.1 * way.z}, way};
    }
    for (int by = RELUME_INTERPOLATE_DEFAULT; by <= RELUME_INTERPOLATE_LINEAR; by++)
        check_rays(pack, rays, near, f->depth ? 3 : 1,
                   relume_frame_params(.interpolation = (enum relume_interpolation)by), 64);
    relume_pack_destroy(&pack);
}

static void one_ray_finds_its_texels(void **state)
{
    (void)state;
    const struct relume_books_params books = {.codes = 16};
    const struct fixture planar = {.width = W, .height = H, .lights = 12, .views = 1};
    const struct fixture deep = {.width = W, .height = H, .lights = 12, .views = 3, .depth = true};
    const struct fixture around = {
        .width = W, .height = H, .lights = 12, .views = 8, .slabs = 4, .depth = true};
    check_file(&planar, "planar.exr", NULL);
    check_file(&deep, "deep.exr", relume_pack_encode_params(.domain = RELUME_DOMAIN_LINEAR));
    check_file(&deep, "shown.exr", relume_pack_encode_params(.domain = RELUME_DOMAIN_DISPLAY));
    check_file(&deep, "books.exr", relume_pack_encode_params(.books = &books));
    check_file(&around, "around.exr", NULL);
}

// Outside of a view's mask a masked frame is black to the bit; inside it is the frame.
static void masked_frames_are_black_outside(void **state)
{
    (void)state;
    const struct fixture f = {.width = 17, .height = 13, .lights = 7, .views = 1, .mask = true};
    const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW};
    char folder_masked[64], path[96];
    relume_pack *pack;
    struct relume_image frame, masked, mask;
    int outside = 0;
    test_folder(folder_masked);
    fixture_write(&f, folder_masked);
    snprintf(path, sizeof path, "%s/pack.exr", folder_masked);
    CHECK_OK(fixture_encode(folder_masked, path, &relume_basis_sh, 4, NULL));
    CHECK_OK(relume_pack_open(&pack, path, NULL));
    CHECK_OK(relume_pack_mask(&mask, pack, 0));
    CHECK_OK(relume_frame(&frame, pack, &camera, lights, 2, NULL));
    CHECK_OK(relume_frame(&masked, pack, &camera, lights, 2, relume_frame_params(.masked = true)));
    for (int i = 0; i < 3 * 17 * 13; i++) {
        const bool inside = mask.data[i / 3] > 0.5f;
        outside += !inside;
        CHECK_NEAR(masked.data[i], inside ? frame.data[i] : 0.0f, 0.0);
    }
    assert_true(outside > 0);
    relume_image_destroy(&frame);
    relume_image_destroy(&masked);
    relume_image_destroy(&mask);
    relume_pack_destroy(&pack);
    test_folder_remove(folder_masked);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_memory_gets_the_frame),
        cmocka_unit_test(what_is_kept_still_holds),
        cmocka_unit_test(lights_alone_relight),
        cmocka_unit_test(memory_is_bounded),
        cmocka_unit_test(near_eyes_cost_what_they_see),
        cmocka_unit_test(a_part_is_that_of_the_view),
        cmocka_unit_test(bytes_do_not_drift),
        cmocka_unit_test(a_pixel_is_that_of_the_frame),
        cmocka_unit_test(places_are_where_depth_says),
        cmocka_unit_test(one_ray_finds_its_texels),
        cmocka_unit_test(masked_frames_are_black_outside),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
