// Slabs whose surface is known in closed form: by depth, and through an aperture
#include "relight/view/view.h"

#include "test.h"

enum { SIDE = 4, VIEWS = SIDE * SIDE, W = 120, H = 90 };
static const double uv_z = 3.0;

// A horizontal sheet, for x and y within its half sizes.
struct sheet {
    double z, half[2];
    void (*paint)(float rgb[3], double x, double y);
};
struct scene {
    const struct sheet *sheet;  // from near to far
    int sheets;
};

static void paint_ramp(float rgb[3], double x, double y)
{
    rgb[0] = (float)(0.5 + 0.3 * x);
    rgb[1] = (float)(0.5 - 0.2 * y);
    rgb[2] = (float)(0.4 + 0.1 * x + 0.2 * y);
}

static void paint_red(float rgb[3], double x, double y)
{
    (void)x, (void)y;
    rgb[0] = 1;
    rgb[1] = rgb[2] = 0;
}

static void paint_green(float rgb[3], double x, double y)
{
    (void)x, (void)y;
    rgb[1] = 1;
    rgb[0] = rgb[2] = 0;
}

static void paint_stripes(float rgb[3], double x, double y)
{
    (void)y;
    rgb[0] = rgb[1] = rgb[2] = sin(40 * x) > 0 ? 1 : 0;
}

static struct relume_geometry geometry(void)
{
    return (struct relume_geometry){
        .projection = RELUME_SLAB,
        .uv_z = uv_z,
        .st_min = {-1, -0.75},
        .st_max = {1, 0.75},
    };
}

static double place(int i)
{
    return 0.2 * (i - 0.5 * (SIDE - 1));
}

static relume_slab *make_slab(void)
{
    double uv[VIEWS][2];
    for (int i = 0; i < VIEWS; i++) {
        uv[i][0] = place(i % SIDE);
        uv[i][1] = place(i / SIDE);
    }
    const struct relume_geometry g = geometry();
    relume_slab *slab;
    CHECK_OK(relume_slab_create(&slab, &g, (const double(*)[2])uv, VIEWS));
    return slab;
}

// The sheet that the ray from `eye` through (s, t, 0) meets first; -1: none.
static int look(const struct scene *scene, struct relume_vec3 eye, double s, double t, float rgb[3],
                double *distance)
{
    rgb[0] = rgb[1] = rgb[2] = 0;
    *distance = (double)INFINITY;
    for (int i = 0; i < scene->sheets; i++) {
        const struct sheet *p = &scene->sheet[i];
        const double part = (eye.z - p->z) / eye.z;
        const double x = eye.x + part * (s - eye.x), y = eye.y + part * (t - eye.y);
        if (part <= 0 || fabs(x) > p->half[0] || fabs(y) > p->half[1])
            continue;
        p->paint(rgb, x, y);
        *distance =
            part * sqrt((s - eye.x) * (s - eye.x) + (t - eye.y) * (t - eye.y) + eye.z * eye.z);
        return i;
    }
    return -1;
}

static void render(struct relume_image *rgb, struct relume_image *depth, const struct scene *scene,
                   struct relume_vec3 eye, int width, int height)
{
    const struct relume_geometry g = geometry();
    CHECK_OK(relume_image_create(rgb, width, height, 3));
    CHECK_OK(relume_image_create(depth, width, height, 1));
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const double s = g.st_min[0] + (x + 0.5) / width * (g.st_max[0] - g.st_min[0]);
            const double t = g.st_max[1] - (y + 0.5) / height * (g.st_max[1] - g.st_min[1]);
            double distance;
            look(scene, eye, s, t, &rgb->data[3 * (y * width + x)], &distance);
            depth->data[y * width + x] = (float)distance;
        }
}

struct captured {
    relume_slab *slab;
    struct relume_image views[VIEWS], disparity[VIEWS];
};

static void capture(struct captured *c, const struct scene *scene)
{
    c->slab = make_slab();
    for (int i = 0; i < VIEWS; i++) {
        const double uv[2] = {place(i % SIDE), place(i / SIDE)};
        struct relume_image depth;
        render(&c->views[i], &depth, scene, (struct relume_vec3){uv[0], uv[1], uv_z}, W, H);
        CHECK_OK(relume_slab_disparity(&c->disparity[i], c->slab, uv, &depth));
        relume_image_destroy(&depth);
    }
}

static void release(struct captured *c)
{
    for (int i = 0; i < VIEWS; i++) {
        relume_image_destroy(&c->views[i]);
        relume_image_destroy(&c->disparity[i]);
    }
    relume_slab_destroy(&c->slab);
}

static struct relume_image draw(const struct captured *c, struct relume_vec3 eye,
                                const struct relume_view_params *params)
{
    struct relume_image out;
    CHECK_OK(relume_image_create(&out, W, H, 3));
    CHECK_OK(relume_slab_frame(&out, c->slab, eye, c->views, params));
    return out;
}

// How many pixels, `margin` from the border left out, differ by more than `bound`.
static int count_wrong(const struct relume_image *a, const struct relume_image *b, int margin,
                       double bound)
{
    int wrong = 0;
    for (int y = margin; y < H - margin; y++)
        for (int x = margin; x < W - margin; x++) {
            bool off = false;
            for (int k = 0; k < 3; k++) {
                const int i = 3 * (y * W + x) + k;
                off |= !(fabs((double)a->data[i] - (double)b->data[i]) <= bound);
            }
            wrong += off;
        }
    return wrong;
}

static const struct relume_vec3 eyes[] = {
    {0.05, -0.03, 3}, {0.1, 0.2, 3}, {-0.21, 0.07, 3}, {0.02, 0.03, 3.5}, {-0.1, 0.05, 2.7},
};
enum { EYES = sizeof eyes / sizeof *eyes };

// ---------------------------------------------------------------- disparity

static void disparity_is_that_of_the_plane(void **state)
{
    (void)state;
    static const double heights[] = {-2, -0.5, 0, 0.8, 1.5};
    relume_slab *slab = make_slab();
    for (size_t i = 0; i < sizeof heights / sizeof *heights; i++) {
        const struct sheet sheet = {heights[i], {0.5, 0.5}, paint_red};
        const struct scene scene = {&sheet, 1};
        const double uv[2] = {place(3), place(0)};
        struct relume_image rgb, depth, disparity;
        double range[2];
        render(&rgb, &depth, &scene, (struct relume_vec3){uv[0], uv[1], uv_z}, W, H);
        CHECK_OK(relume_slab_disparity(&disparity, slab, uv, &depth));
        assert_true(relume_slab_range(range, &disparity));
        const double want = relume_slab_plane_disparity(slab, heights[i]);
        CHECK_NEAR(want, heights[i] / (uv_z - heights[i]), 1e-12);
        // distances of about 3 in single precision, divided by what is left to the cameras
        CHECK_NEAR(range[0], want, 1e-6);
        CHECK_NEAR(range[1], want, 1e-6);
        assert_true(disparity.data[0] == RELUME_SLAB_BACKGROUND || depth.data[0] < INFINITY);
        relume_image_destroy(&rgb);
        relume_image_destroy(&depth);
        relume_image_destroy(&disparity);
    }
    relume_slab_destroy(&slab);
}

// An antialiased texel beside a surface is of neither.
static void background_beside_a_surface_is_told(void **state)
{
    (void)state;
    const double uv[2] = {0, 0};
    relume_slab *slab = make_slab();
    struct relume_image depth, disparity;
    CHECK_OK(relume_image_create(&depth, 6, 5, 1));
    for (int i = 0; i < 30; i++)
        depth.data[i] = INFINITY;
    depth.data[2 * 6 + 2] = 3;
    CHECK_OK(relume_slab_disparity(&disparity, slab, uv, &depth));
    for (int y = 0; y < 5; y++)
        for (int x = 0; x < 6; x++) {
            const bool beside = abs(x - 2) <= 1 && abs(y - 2) <= 1;
            if (x != 2 || y != 2)
                assert_true(disparity.data[y * 6 + x] == (beside ? 2 : 1) * RELUME_SLAB_BACKGROUND);
        }
    relume_image_destroy(&depth);
    relume_image_destroy(&disparity);
    relume_slab_destroy(&slab);
}

static void eyes_before_the_cameras_bound_disparity(void **state)
{
    (void)state;
    relume_slab *slab = make_slab();
    const struct relume_vec3 on = {0, 0, uv_z}, back = {0, 0, 5}, front = {0, 0, 2};
    assert_true(isinf(relume_slab_eye_disparity(slab, on)));
    assert_true(isinf(relume_slab_eye_disparity(slab, back)));
    CHECK_NEAR(relume_slab_eye_disparity(slab, front), relume_slab_plane_disparity(slab, 2), 1e-12);
    relume_slab_destroy(&slab);
}

// ---------------------------------------------------------------- by depth

// Colours that are linear on the sheet are linear in every view, and bilinear look-ups are exact.
static void a_sheet_at_any_height_is_met(void **state)
{
    (void)state;
    static const double heights[] = {-1, 0.3, 0.9};
    for (size_t h = 0; h < sizeof heights / sizeof *heights; h++) {
        const struct sheet sheet = {heights[h], {9, 9}, paint_ramp};
        const struct scene scene = {&sheet, 1};
        struct captured c;
        capture(&c, &scene);
        for (int e = 0; e < EYES; e++) {
            struct relume_image want, depth;
            struct relume_image got =
                draw(&c, eyes[e], relume_view_params(.disparity = c.disparity));
            render(&want, &depth, &scene, eyes[e], W, H);
            // single precision; what lies near the border of the window is not in all views
            assert_int_equal(count_wrong(&got, &want, 12, 3e-6), 0);
            relume_image_destroy(&got);
            relume_image_destroy(&want);
            relume_image_destroy(&depth);
        }
        release(&c);
    }
}

// A red sheet before a green one. Every camera sees other parts of the green one; a pixel is wrong
// only where a silhouette passes within a texel of it.
static void silhouettes_are_sharp(void **state)
{
    (void)state;
    static const struct sheet sheets[] = {{1.0, {0.2, 0.15}, paint_red},
                                          {-0.5, {9, 9}, paint_green}};
    const struct scene scene = {sheets, 2};
    struct captured c;
    capture(&c, &scene);
    for (int e = 0; e < EYES; e++) {
        struct relume_image want, depth;
        struct relume_image got = draw(&c, eyes[e], relume_view_params(.disparity = c.disparity));
        struct relume_image flat =
            draw(&c, eyes[e], relume_view_params(.interpolation = RELUME_INTERPOLATE_LINEAR));
        render(&want, &depth, &scene, eyes[e], W, H);
        const int outline =
            126;  // pixels around 0.4 x 0.3, seen 1.5 times as large on the st plane
        assert_true(count_wrong(&got, &want, 12, 0.01) <= 1.5 * outline);
        assert_true(count_wrong(&flat, &want, 12, 0.01) > 2 * count_wrong(&got, &want, 12, 0.01));
        relume_image_destroy(&got);
        relume_image_destroy(&flat);
        relume_image_destroy(&want);
        relume_image_destroy(&depth);
    }
    release(&c);
}

static void captured_eyes_give_their_view_bit_by_bit(void **state)
{
    (void)state;
    static const struct sheet sheets[] = {{1.0, {0.2, 0.15}, paint_red},
                                          {-0.5, {9, 9}, paint_ramp}};
    const struct scene scene = {sheets, 2};
    struct captured c;
    capture(&c, &scene);
    for (int i = 0; i < VIEWS; i++) {
        const struct relume_vec3 eye = {place(i % SIDE), place(i / SIDE), uv_z};
        struct relume_image got = draw(&c, eye, relume_view_params(.disparity = c.disparity));
        assert_memory_equal(got.data, c.views[i].data, sizeof(float) * 3 * W * H);
        relume_image_destroy(&got);
    }
    release(&c);
}

static struct relume_image cropped(const struct relume_image *image, const struct relume_rect *at)
{
    struct relume_image out;
    CHECK_OK(relume_image_create(&out, at->width, at->height, image->channels));
    for (int y = 0; y < at->height; y++)
        memcpy(out.data + y * at->width * image->channels,
               image->data + ((at->top + y) * image->width + at->left) * image->channels,
               sizeof(float) * (size_t)(at->width * image->channels));
    return out;
}

// Returns the texels that a frame reads, after drawing it from these alone.
static int draw_from_parts(struct relume_image *out, const struct captured *c,
                           struct relume_vec3 eye, struct relume_view_params params)
{
    struct relume_rect part[VIEWS];
    struct relume_image views[VIEWS] = {{0}}, disparity[VIEWS] = {{0}};
    const int frame[2] = {out->width, out->height};
    int texels = 0;
    params.size[0] = W;
    params.size[1] = H;
    assert_true(relume_slab_parts(part, c->slab, eye, frame, &params) > 0);
    params.part = part;
    for (int i = 0; i < VIEWS; i++) {
        if (part[i].width == 0)
            continue;
        views[i] = cropped(&c->views[i], &part[i]);
        disparity[i] = cropped(&c->disparity[i], &part[i]);
        texels += part[i].width * part[i].height;
    }
    params.disparity = params.disparity ? disparity : NULL;
    CHECK_OK(relume_slab_frame(out, c->slab, eye, views, &params));
    for (int i = 0; i < VIEWS; i++) {
        relume_image_destroy(&views[i]);
        relume_image_destroy(&disparity[i]);
    }
    return texels;
}

// What a frame reads of its views is all in the parts that it is said to read, bit by bit, and that
// is little of them for an eye that looks through the cameras.
static void parts_of_views_make_the_frame(void **state)
{
    (void)state;
    static const struct relume_vec3 near[] = {{0.05, -0.03, 1.8}, {0.02, 0.03, 0.9},
                                              {-0.1, 0.05, 2.7},  {0.1, 0.2, 3},
                                              {0.02, 0.03, 4.5},  {0.4, -0.3, 2}};
    static const int sizes[][2] = {{W, H}, {77, 95}, {20, 15}, {3, 2}};
    static const struct sheet sheets[] = {{1.0, {0.2, 0.15}, paint_red},
                                          {-0.5, {0.9, 9}, paint_stripes}};
    const struct scene scene = {sheets, 2};
    struct captured c;
    double range[VIEWS][2];
    capture(&c, &scene);
    for (int i = 0; i < VIEWS; i++)
        assert_true(relume_slab_range(range[i], &c.disparity[i]));
    for (int e = 0; e < 6; e++)
        for (int s = 0; s < 4; s++)
            for (int i = RELUME_INTERPOLATE_CONSTANT; i <= RELUME_INTERPOLATE_DEPTH; i++) {
                const bool by_depth = i == RELUME_INTERPOLATE_DEPTH;
                const struct relume_view_params params = {
                    .interpolation = (enum relume_interpolation)i,
                    .disparity = by_depth ? c.disparity : NULL,
                    .range = by_depth ? (const double(*)[2])range : NULL,
                };
                struct relume_image want, got;
                CHECK_OK(relume_image_create(&want, sizes[s][0], sizes[s][1], 3));
                CHECK_OK(relume_image_create(&got, sizes[s][0], sizes[s][1], 3));
                CHECK_OK(relume_slab_frame(&want, c.slab, near[e], c.views, &params));
                const int texels = draw_from_parts(&got, &c, near[e], params);
                assert_memory_equal(got.data, want.data,
                                    sizeof(float) * 3 * (size_t)(got.width * got.height));
                // sixteen views, of which an eye between the planes sees about four's worth
                assert_true(texels <= VIEWS * W * H && (e > 0 || 2 * texels < VIEWS * W * H));
                relume_image_destroy(&want);
                relume_image_destroy(&got);
            }
    struct relume_rect outside[VIEWS] = {{W - 3, 0, 4, 4}};
    struct relume_image out;
    CHECK_OK(relume_image_create(&out, W, H, 3));
    assert_int_equal(relume_slab_frame(&out, c.slab, near[0], c.views,
                                       relume_view_params(.part = outside, .size = {W, H})),
                     RELUME_EINVAL);
    relume_image_destroy(&out);
    release(&c);
}

// One ray is the pixel of the frame that looks along it.
static void a_ray_is_its_pixel(void **state)
{
    (void)state;
    static const struct sheet sheets[] = {{1.0, {0.2, 0.15}, paint_red},
                                          {-0.5, {9, 9}, paint_ramp}};
    const struct scene scene = {sheets, 2};
    const struct relume_geometry g = geometry();
    struct captured c;
    capture(&c, &scene);
    const struct relume_view_params params = {.disparity = c.disparity};
    for (int e = 0; e < 3; e++) {
        struct relume_image frame = draw(&c, eyes[e], &params);
        for (int i = 7; i < W * H; i += 13) {
            const double st[2] = {g.st_min[0] + (i % W + 0.5) / W * 2,
                                  g.st_max[1] - (i / W + 0.5) / H * 1.5};
            float rgb[3];
            CHECK_OK(relume_slab_value(rgb, c.slab, eyes[e], st, c.views, &params));
            for (int k = 0; k < 3; k++)
                CHECK_NEAR(rgb[k], frame.data[3 * i + k], 1e-6);
        }
        relume_image_destroy(&frame);
    }
    const double beyond[2] = {0, 0};
    float rgb[3];
    const struct relume_vec3 outside = {2, 0, uv_z};
    assert_int_equal(relume_slab_value(rgb, c.slab, outside, beyond, c.views, &params),
                     RELUME_EINVAL);
    assert_int_equal(relume_slab_value(rgb, c.slab, eyes[0], beyond, c.views, NULL), RELUME_EINVAL);
    release(&c);
}

// Nothing but background: the quadralinear basis.
static void background_is_on_the_st_plane(void **state)
{
    (void)state;
    const struct sheet sheet = {0.4, {9, 9}, paint_ramp};
    const struct scene scene = {&sheet, 1};
    struct captured c;
    capture(&c, &scene);
    for (int i = 0; i < VIEWS; i++)
        for (int k = 0; k < W * H; k++)
            c.disparity[i].data[k] = RELUME_SLAB_BACKGROUND;
    for (int e = 0; e < EYES; e++) {
        struct relume_image got = draw(&c, eyes[e], relume_view_params(.disparity = c.disparity));
        struct relume_image want = draw(&c, eyes[e], NULL);
        assert_int_equal(count_wrong(&got, &want, 0, 1e-6), 0);
        relume_image_destroy(&got);
        relume_image_destroy(&want);
    }
    release(&c);
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    static const struct sheet sheets[] = {{1.0, {0.2, 0.15}, paint_red},
                                          {-0.5, {9, 9}, paint_ramp}};
    const struct scene scene = {sheets, 2};
    struct captured c;
    capture(&c, &scene);
    const struct relume_view_params by_depth[2] = {{.threads = 1, .disparity = c.disparity},
                                                   {.threads = 7, .disparity = c.disparity}};
    const struct relume_view_params lens[2] = {{.threads = 1, .aperture = 0.3, .focus = 0.4},
                                               {.threads = 7, .aperture = 0.3, .focus = 0.4}};
    const struct relume_view_params *pairs[2] = {by_depth, lens};
    for (int i = 0; i < 2; i++) {
        struct relume_image one = draw(&c, eyes[3], &pairs[i][0]);
        struct relume_image many = draw(&c, eyes[3], &pairs[i][1]);
        assert_memory_equal(one.data, many.data, sizeof(float) * 3 * W * H);
        relume_image_destroy(&one);
        relume_image_destroy(&many);
    }
    release(&c);
}

static void wrong_disparities_are_refused(void **state)
{
    (void)state;
    const struct sheet sheet = {0.4, {9, 9}, paint_ramp};
    const struct scene scene = {&sheet, 1};
    struct captured c;
    struct relume_image out, small;
    capture(&c, &scene);
    CHECK_OK(relume_image_create(&out, W, H, 3));
    CHECK_OK(relume_image_create(&small, 2, 2, 1));
    const struct relume_vec3 eye = eyes[0];
    assert_int_equal(
        relume_slab_frame(&out, c.slab, eye, c.views,
                          relume_view_params(.interpolation = RELUME_INTERPOLATE_DEPTH)),
        RELUME_EINVAL);
    struct relume_image mixed[VIEWS] = {{0}};
    assert_int_equal(
        relume_slab_frame(&out, c.slab, eye, c.views, relume_view_params(.disparity = mixed)),
        RELUME_EINVAL);
    for (int i = 0; i < VIEWS; i++)
        mixed[i] = small;
    assert_int_equal(
        relume_slab_frame(&out, c.slab, eye, c.views, relume_view_params(.disparity = mixed)),
        RELUME_EINVAL);
    relume_image_destroy(&out);
    relume_image_destroy(&small);
    release(&c);
}

// ---------------------------------------------------------------- aperture

// The width of a pinhole: the quadralinear basis.
static void a_narrow_aperture_is_quadralinear(void **state)
{
    (void)state;
    const struct sheet sheet = {0.4, {9, 9}, paint_stripes};
    const struct scene scene = {&sheet, 1};
    struct captured c;
    capture(&c, &scene);
    for (int e = 0; e < EYES; e++) {
        struct relume_image got = draw(&c, eyes[e], relume_view_params(.aperture = 1e-9));
        struct relume_image want = draw(&c, eyes[e], NULL);
        // an aperture of 1e-9 moves weights by 1e-8; four weights in single precision
        assert_int_equal(count_wrong(&got, &want, 0, 1e-6), 0);
        relume_image_destroy(&got);
        relume_image_destroy(&want);
    }
    release(&c);
}

static double contrast(const struct relume_image *image)
{
    double sum = 0, square = 0;
    int n = 0;
    for (int y = 20; y < H - 20; y++)
        for (int x = 20; x < W - 20; x++, n++) {
            const double v = (double)image->data[3 * (y * W + x)];
            sum += v;
            square += v * v;
        }
    return sqrt(square / n - sum / n * (sum / n));
}

static void the_plane_in_focus_is_sharp(void **state)
{
    (void)state;
    static const double heights[] = {-0.6, 0.7};
    for (size_t h = 0; h < 2; h++) {
        const struct sheet sheet = {heights[h], {9, 9}, paint_stripes};
        const struct scene scene = {&sheet, 1};
        struct captured c;
        capture(&c, &scene);
        const struct relume_vec3 eye = {0, 0, uv_z};
        struct relume_image sharp =
            draw(&c, eye, relume_view_params(.aperture = 0.5, .focus = heights[h]));
        struct relume_image blurred =
            draw(&c, eye, relume_view_params(.aperture = 0.5, .focus = -heights[h]));
        assert_true(contrast(&sharp) > 0.4);  // black and white stripes have 0.5
        assert_true(contrast(&blurred) < 0.5 * contrast(&sharp));
        relume_image_destroy(&sharp);
        relume_image_destroy(&blurred);
        release(&c);
    }
}

// Means of whatever cameras: a uniform picture stays, and a picture on the plane in focus too.
static void what_is_in_focus_keeps_its_value(void **state)
{
    (void)state;
    const struct sheet sheet = {0.5, {9, 9}, paint_ramp};
    const struct scene scene = {&sheet, 1};
    static const double apertures[] = {0, 0.15, 0.4, 3};
    struct captured c;
    capture(&c, &scene);
    for (int e = 0; e < EYES; e++)
        for (int a = 0; a < 4; a++) {
            struct relume_image want, depth;
            struct relume_image got =
                draw(&c, eyes[e], relume_view_params(.aperture = apertures[a], .focus = 0.5));
            render(&want, &depth, &scene, eyes[e], W, H);
            assert_int_equal(count_wrong(&got, &want, 12, 3e-6), 0);
            relume_image_destroy(&got);
            relume_image_destroy(&want);
            relume_image_destroy(&depth);
        }
    release(&c);
}

static void weights_are_bilinear_beside_the_aperture(void **state)
{
    (void)state;
    relume_slab *slab = make_slab();
    const struct relume_slab_lens lens = relume_slab_lens(slab, 1, 2);
    CHECK_NEAR(lens.place[0], -0.1, 1e-12);
    CHECK_NEAR(lens.place[1], 0.1, 1e-12);
    static const double cases[][4] = {
        // u, v, radius, weight: a step of the grid is 0.2
        {-0.1, 0.1, 0, 1},    {-0.05, 0.1, 0, 0.75},   {-0.05, 0.15, 0, 0.5625},
        {0.1, 0.1, 0, 0},     {0.1, 0.1, 0.05, 0.25},  {0.1, 0.1, 0.2, 1},
        {0.1, 0.1, 0.1, 0.5}, {0.02, 0.26, 0.1, 0.42}, {-0.3, 0.1, 0.19, 0.95},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        CHECK_NEAR(relume_slab_lens_weight(&lens, cases[i], cases[i][2]), cases[i][3], 1e-9);
    relume_slab_destroy(&slab);
}

static void all_cameras_with_weight_are_needed(void **state)
{
    (void)state;
    enum { STEPS = 60 };
    relume_slab *slab = make_slab();
    const struct relume_geometry g = geometry();
    uint32_t random = 5;
    for (int i = 0; i < 100; i++) {
        const struct relume_vec3 eye = {test_uniform(&random) - 0.5, test_uniform(&random) - 0.5,
                                        1 + 4 * test_uniform(&random)};
        const double aperture = 0.6 * test_uniform(&random);
        bool needed[VIEWS];
        relume_slab_needs(needed, slab, eye, relume_view_params(.aperture = aperture));
        for (int k = 0; k < STEPS * STEPS; k++) {
            const double s = g.st_min[0] + (k % STEPS + 0.5) / STEPS * 2;
            const double t = g.st_min[1] + (k / STEPS + 0.5) / STEPS * 1.5;
            double uv[2];
            assert_true(relume_slab_uv(uv, slab, eye, s, t));
            for (int v = 0; v < VIEWS; v++) {
                const struct relume_slab_lens lens = relume_slab_lens(slab, v % SIDE, v / SIDE);
                if (relume_slab_lens_weight(&lens, uv, 0.5 * aperture) > 1e-5)
                    assert_true(needed[v]);
            }
        }
    }
    relume_slab_destroy(&slab);
}

static void wrong_lenses_are_refused(void **state)
{
    (void)state;
    const struct sheet sheet = {0.4, {9, 9}, paint_ramp};
    const struct scene scene = {&sheet, 1};
    static const struct relume_view_params wrong[] = {
        {.focus = 3}, {.focus = 5}, {.aperture = -1}, {.aperture = NAN}, {.focus = NAN},
    };
    struct captured c;
    struct relume_image out;
    capture(&c, &scene);
    CHECK_OK(relume_image_create(&out, W, H, 3));
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(relume_slab_frame(&out, c.slab, eyes[0], c.views, &wrong[i]),
                         RELUME_EINVAL);
    relume_image_destroy(&out);
    release(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(disparity_is_that_of_the_plane),
        cmocka_unit_test(background_beside_a_surface_is_told),
        cmocka_unit_test(eyes_before_the_cameras_bound_disparity),
        cmocka_unit_test(a_sheet_at_any_height_is_met),
        cmocka_unit_test(silhouettes_are_sharp),
        cmocka_unit_test(captured_eyes_give_their_view_bit_by_bit),
        cmocka_unit_test(parts_of_views_make_the_frame),
        cmocka_unit_test(a_ray_is_its_pixel),
        cmocka_unit_test(background_is_on_the_st_plane),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(wrong_disparities_are_refused),
        cmocka_unit_test(a_narrow_aperture_is_quadralinear),
        cmocka_unit_test(the_plane_in_focus_is_sharp),
        cmocka_unit_test(what_is_in_focus_keeps_its_value),
        cmocka_unit_test(weights_are_bilinear_beside_the_aperture),
        cmocka_unit_test(all_cameras_with_weight_are_needed),
        cmocka_unit_test(wrong_lenses_are_refused),
    };
    return cmocka_run_group_tests_name("slab_depth", tests, NULL, NULL);
}
