// Several slabs around a painted ball: what any eye sees of it is known in closed form
#include "image/geometry/geometry.h"
#include "relight/view/slab_set.h"
#include "relight/view/view.h"

#include "test.h"

#include <relume/relight/slab_set.h>

#define PI 3.14159265358979323846

enum { RING = 6, SIDE = 4, GRID = SIDE * SIDE, VIEWS = RING * GRID, W = 72 };
static const double radius = 0.7;
static const double uv_z = 3.0;
static const double window = 1.3;

// Where neighbours of the ring meet, on the uv plane.
static double seam(void)
{
    return uv_z * tan(PI / RING);
}

static double place(int i)
{
    return 1.15 * seam() * (2.0 * i / (SIDE - 1) - 1.0);
}

static struct relume_geometry slab_of_ring(int i)
{
    const double a = 2 * PI * i / RING;
    return (struct relume_geometry){
        .projection = RELUME_SLAB,
        .uv_z = uv_z,
        .st_min = {-window, -window},
        .st_max = {window, window},
        .pose = {.axis = {{cos(a), 0, -sin(a)}, {0, 1, 0}, {sin(a), 0, cos(a)}}},
    };
}

// What the ray sees and how far away; black and infinity beside the ball.
static double look(float rgb[3], vec3 eye, vec3 way)
{
    const double a = vec3_dot(way, way), b = vec3_dot(eye, way),
                 c = vec3_dot(eye, eye) - radius * radius;
    const double root = b * b - a * c;
    rgb[0] = rgb[1] = rgb[2] = 0;
    if (root <= 0)
        return (double)INFINITY;
    const double s = (-b - sqrt(root)) / a;
    const vec3 p = vec3_along(eye, way, s);
    rgb[0] = (float)(0.5 + 0.3 * sin(5 * p.x));
    rgb[1] = (float)(0.5 + 0.3 * sin(5 * p.y + 1));
    rgb[2] = (float)(0.5 + 0.3 * sin(5 * p.z + 2));
    return s * sqrt(a);
}

static vec3 ray_of(const struct relume_window *w, double x, double y)
{
    return vec3_along(vec3_along(vec3_sub(w->corner, w->eye), w->right, x), w->down, y);
}

static void render(struct relume_image *rgb, struct relume_image *depth,
                   const struct relume_window *w, int width, int height)
{
    CHECK_OK(relume_image_create(rgb, width, height, 3));
    CHECK_OK(relume_image_create(depth, width, height, 1));
    for (int i = 0; i < width * height; i++)
        depth->data[i] =
            (float)look(rgb->data + 3 * i, w->eye,
                        ray_of(w, (i % width + 0.5) / width, (i / width + 0.5) / height));
}

struct captured {
    struct relume_geometry slab[RING];
    double uv[VIEWS][2];
    int slab_of[VIEWS];
    relume_slab_set *slabs;
    struct relume_image view[VIEWS], disparity[VIEWS];
};
static struct captured c;

// Views of all slabs in turn, so that numbers are no run of one slab.
static int capture(void **state)
{
    (void)state;
    for (int i = 0; i < RING; i++)
        c.slab[i] = slab_of_ring(i);
    for (int i = 0; i < VIEWS; i++) {
        c.slab_of[i] = i % RING;
        c.uv[i][0] = place(i / RING % SIDE);
        c.uv[i][1] = place(i / RING / SIDE);
    }
    CHECK_OK(
        relume_slab_set_create(&c.slabs, c.slab, RING, (const double(*)[2])c.uv, c.slab_of, VIEWS));
    for (int i = 0; i < VIEWS; i++) {
        const struct relume_geometry *g = &c.slab[c.slab_of[i]];
        const vec3 camera = {c.uv[i][0], c.uv[i][1], uv_z};
        const struct relume_window w = relume_slab_window(g, relume_pose_world(&g->pose, camera));
        struct relume_image depth;
        render(&c.view[i], &depth, &w, W, W);
        CHECK_OK(relume_slab_disparity(&c.disparity[i], relume_slab_set_slab(c.slabs, c.slab_of[i]),
                                       c.uv[i], &depth));
        relume_image_destroy(&depth);
    }
    return 0;
}

static int release(void **state)
{
    (void)state;
    for (int i = 0; i < VIEWS; i++) {
        relume_image_destroy(&c.view[i]);
        relume_image_destroy(&c.disparity[i]);
    }
    relume_slab_set_destroy(&c.slabs);
    return 0;
}

static vec3 eye_at(double azimuth_deg, double height, double distance)
{
    const double a = azimuth_deg * PI / 180;
    return (vec3){distance * sin(a), height, distance * cos(a)};
}

static struct relume_window window_from(vec3 eye)
{
    struct relume_window w;
    assert_true(relume_slab_set_window(&w, c.slabs, eye, NULL, W, W));
    return w;
}

static struct relume_image draw(const struct relume_window *w,
                                const struct relume_view_params *params)
{
    struct relume_image out;
    CHECK_OK(relume_image_create(&out, W, W, 3));
    CHECK_OK(relume_slab_set_frame(&out, c.slabs, w, c.view, params));
    return out;
}

static double difference(const struct relume_image *a, const struct relume_image *b)
{
    double most = 0;
    for (int i = 0; i < 3 * a->width * a->height; i++)
        most = fmax(most, fabs((double)a->data[i] - (double)b->data[i]));
    return most;
}

// How close a ray passes the ball's middle, 1 at its rim.
static double depth_in_ball(const struct relume_window *w, int pixel)
{
    const vec3 way = ray_of(w, (pixel % W + 0.5) / W, (pixel / W + 0.5) / W);
    const double b = vec3_dot(w->eye, way);
    return sqrt(vec3_dot(w->eye, w->eye) - b * b / vec3_dot(way, way)) / radius;
}

// Over the ball but its rim: silhouettes are a texel wide, and there are as many from every eye.
static double psnr_at(vec3 eye)
{
    const struct relume_window w = window_from(eye);
    struct relume_image got = draw(&w, relume_view_params(.disparity = c.disparity)), want, depth;
    double square = 0;
    int n = 0;
    render(&want, &depth, &w, W, W);
    for (int i = 0; i < 3 * W * W; i++) {
        if (depth_in_ball(&w, i / 3) > 0.85)
            continue;
        square += pow((double)got.data[i] - (double)want.data[i], 2);
        n++;
    }
    assert_true(n > 1000);
    relume_image_destroy(&got);
    relume_image_destroy(&want);
    relume_image_destroy(&depth);
    return -10 * log10(square / n);
}

// ---------------------------------------------------------------- frames

// Eyes between cameras, in the middle of a cell of slab 0 and on the seam of two slabs, on the ring
// and before and behind it.
static void the_seam_is_as_good_as_the_inside(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        const double distance = 3.0 + 0.6 * (i - 1);
        const double inside = psnr_at(eye_at(atan(place(2) / uv_z) * 90 / PI, 0.3, distance));
        const double between = psnr_at(eye_at(180.0 / RING, 0.3, distance));
        const double far = psnr_at(eye_at(180.0 + 180.0 / RING, -0.2, distance));
        // bilinear between texels of paint that bends 25 x 0.3 a square unit errs by 60 dB
        assert_true(inside > 57);
        assert_true(between > 57);
        assert_true(far > 57);
    }
}

// No ray of the last eyes passes a camera grid; all but the first two were black or refused.
static void eyes_beside_the_cameras_see_by_depth(void **state)
{
    (void)state;
    const double eyes[][3] = {{0, 1.2, 2}, {30, 1.2, 1.2}, {0, 2, 2},  {30, 2, 1.2},
                              {0, 3, 1.2}, {10, 5, 3},     {30, 9, 2}, {0, -9, 5}};
    for (size_t i = 0; i < sizeof eyes / sizeof *eyes; i++)
        // where cameras graze the ball a ray meets it up to a texel beside, which is worth 0.3 x 5
        // x 2.6 / 72 of white there
        CHECK_NEAR(fmin(psnr_at(eye_at(eyes[i][0], eyes[i][1], eyes[i][2])), 41), 41, 0);
}

// An eye that rises over the edge of the grid: rays that just pass it and that just do not.
static void nothing_jumps_at_the_edge_of_the_grid(void **state)
{
    (void)state;
    const double edge = place(SIDE - 1);
    const struct relume_view_params params = {.disparity = c.disparity};
    const struct relume_window below = window_from(eye_at(0, edge - 2e-4, 3)),
                               above = window_from(eye_at(0, edge + 2e-4, 3));
    assert_true(relume_slab_set_passes(c.slabs, &below, 0.5, 0.5));
    assert_false(relume_slab_set_passes(c.slabs, &above, 0.5, 0.5));
    struct relume_image a = draw(&below, &params), b = draw(&above, &params);
    for (int i = 0; i < 3 * W * W; i++)
        if (depth_in_ball(&below, i / 3) < 0.85)
            CHECK_NEAR(a.data[i], b.data[i], 5e-3);
    relume_image_destroy(&a);
    relume_image_destroy(&b);
}

// Neither the number of threads nor views that no ray needs change a frame beside the cameras.
static void frames_beside_the_cameras_are_sure(void **state)
{
    (void)state;
    const struct relume_window w = window_from(eye_at(20, 2.5, 2));
    struct relume_image view[VIEWS], want = draw(&w, relume_view_params(.disparity = c.disparity));
    bool needed[VIEWS];
    for (int flat = 0; flat < 2; flat++) {
        struct relume_view_params params = {.disparity = flat ? NULL : c.disparity, .threads = 3};
        relume_slab_set_needs(needed, c.slabs, &w, W, &params);
        for (int i = 0; i < VIEWS; i++)
            view[i] = needed[i] ? c.view[i] : (struct relume_image){0};
        struct relume_image got;
        CHECK_OK(relume_image_create(&got, W, W, 3));
        CHECK_OK(relume_slab_set_frame(&got, c.slabs, &w, view, &params));
        assert_true(flat || difference(&got, &want) == 0);
        relume_image_destroy(&got);
    }
    relume_image_destroy(&want);
}

static void look_at_ball(float rgb[3], double azimuth_deg, const struct relume_view_params *params)
{
    const vec3 eye = eye_at(azimuth_deg, 0.4, 3.3);
    const vec3 way = {0.3 - eye.x, 0.02 - eye.y, -eye.z};
    CHECK_OK(relume_slab_set_value(rgb, c.slabs, eye, way, c.view, params));
}

// A ray onto the ball, from an eye that goes around it: nowhere does its value jump, also where
// without depth two slabs show different things. In a step uv moves by 5e-4, weights by 2e-3 at
// most, and what they weigh differs by 0.6; a camera that leaves takes its 1e-4 with it.
static void nothing_jumps_across_a_seam(void **state)
{
    (void)state;
    const double step_deg = 0.01;
    const struct relume_view_params ways[] = {{.disparity = c.disparity}, {0}};
    for (int way = 0; way < 2; way++)
        for (int i = 0; i<6000; i += i> 2400 && i < 3600 ? 1 : 20) {
            float before[3], now[3];
            look_at_ball(before, step_deg * i, &ways[way]);
            look_at_ball(now, step_deg * (i + 1), &ways[way]);
            for (int k = 0; k < 3; k++)
                CHECK_NEAR(now[k], before[k], 1.5e-3);
        }
}

// Seen through a slab's own window from one of its cameras, where no other slab has a say.
static void a_camera_sees_its_view(void **state)
{
    (void)state;
    for (int i = 0; i < VIEWS; i += 7) {
        const struct relume_geometry *g = &c.slab[c.slab_of[i]];
        if (fabs(c.uv[i][0]) > 1)
            continue;
        const vec3 camera = {c.uv[i][0], c.uv[i][1], uv_z};
        const struct relume_window w = relume_slab_window(g, relume_pose_world(&g->pose, camera));
        struct relume_image got = draw(&w, relume_view_params(.disparity = c.disparity));
        // the window's edge has no weight, and the ball does not reach there
        assert_true(difference(&got, &c.view[i]) < 1e-4);
        relume_image_destroy(&got);
    }
}

// What is true of the world is true of the world turned and moved.
static void poses_turn_with_the_world(void **state)
{
    (void)state;
    const struct relume_pose turn = {{0.3, -2, 1},
                                     {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}};
    struct relume_geometry slab[RING];
    relume_slab_set *turned;
    for (int i = 0; i < RING; i++) {
        slab[i] = c.slab[i];
        slab[i].pose.origin = relume_pose_world(&turn, slab[i].pose.origin);
        for (int k = 0; k < 3; k++)
            slab[i].pose.axis[k] = relume_pose_turn(&turn, slab[i].pose.axis[k]);
        assert_true(relume_pose_normalise(&slab[i].pose));
    }
    CHECK_OK(
        relume_slab_set_create(&turned, slab, RING, (const double(*)[2])c.uv, c.slab_of, VIEWS));
    const struct relume_window w = window_from(eye_at(25, 0.3, 3.1));
    const struct relume_window there = {
        relume_pose_world(&turn, w.eye), relume_pose_world(&turn, w.corner),
        relume_pose_turn(&turn, w.right), relume_pose_turn(&turn, w.down)};
    const struct relume_view_params params = {.interpolation = RELUME_INTERPOLATE_LINEAR};
    struct relume_image want = draw(&w, &params), got;
    CHECK_OK(relume_image_create(&got, W, W, 3));
    CHECK_OK(relume_slab_set_frame(&got, turned, &there, c.view, &params));
    assert_true(difference(&got, &want) < 1e-5);
    relume_image_destroy(&got);
    relume_image_destroy(&want);
    relume_slab_set_destroy(&turned);
}

// One slab through its window is relume_slab_frame, wherever the window's border has not faded.
static void one_slab_is_a_slab(void **state)
{
    (void)state;
    struct relume_geometry g = c.slab[0];
    struct relume_image view[GRID], disparity[GRID];
    double uv[GRID][2];
    relume_slab_set *slabs;
    relume_slab *slab;
    for (int i = 0; i < GRID; i++) {
        view[i] = c.view[RING * i];
        disparity[i] = c.disparity[RING * i];
        memcpy(uv[i], c.uv[RING * i], sizeof uv[i]);
    }
    CHECK_OK(relume_slab_set_create(&slabs, &g, 1, (const double(*)[2])uv, NULL, GRID));
    CHECK_OK(relume_slab_create(&slab, &g, (const double(*)[2])uv, GRID));
    for (int i = 0; i < 6; i++) {
        const vec3 eye = {0.2 * i - 0.5, 0.3, i % 2 ? 2.4 : 3.5};
        const struct relume_view_params params = {
            .interpolation = i < 4 ? RELUME_INTERPOLATE_DEFAULT : RELUME_INTERPOLATE_CONSTANT,
            .disparity = i < 2 ? NULL : disparity,
        };
        const struct relume_window w = relume_slab_window(&g, eye);
        struct relume_image got, want;
        CHECK_OK(relume_image_create(&got, W, W, 3));
        CHECK_OK(relume_image_create(&want, W, W, 3));
        CHECK_OK(relume_slab_set_frame(&got, slabs, &w, view, &params));
        CHECK_OK(relume_slab_frame(&want, slab, eye, view, &params));
        assert_true(difference(&got, &want) < 1e-5);
        relume_image_destroy(&got);
        relume_image_destroy(&want);
    }
    relume_slab_destroy(&slab);
    relume_slab_set_destroy(&slabs);
}

// A frame of slab 0, `n` times in the same place.
static struct relume_image draw_copies(int n)
{
    const struct relume_geometry same[2] = {c.slab[0], c.slab[0]};
    const struct relume_window w = window_from(eye_at(5, 0.4, 3.2));
    struct relume_image view[2 * GRID], disparity[2 * GRID], out;
    double uv[2 * GRID][2];
    int slab_of[2 * GRID];
    relume_slab_set *slabs;
    for (int i = 0; i < n * GRID; i++) {
        const int from = RING * (i / n);
        view[i] = c.view[from];
        disparity[i] = c.disparity[from];
        memcpy(uv[i], c.uv[from], sizeof uv[i]);
        slab_of[i] = i % n;
    }
    CHECK_OK(relume_slab_set_create(&slabs, same, n, (const double(*)[2])uv, slab_of, n * GRID));
    CHECK_OK(relume_image_create(&out, W, W, 3));
    CHECK_OK(
        relume_slab_set_frame(&out, slabs, &w, view, relume_view_params(.disparity = disparity)));
    relume_slab_set_destroy(&slabs);
    return out;
}

// Slabs that lie in one another say the same twice.
static void copies_are_one(void **state)
{
    (void)state;
    struct relume_image one = draw_copies(1), two = draw_copies(2);
    assert_true(difference(&one, &two) < 1e-5);
    relume_image_destroy(&one);
    relume_image_destroy(&two);
}

static void only_needed_views_are_read(void **state)
{
    (void)state;
    const struct relume_window w = window_from(eye_at(30, 0.2, 3.2));
    const struct relume_view_params params = {.disparity = c.disparity};
    struct relume_image view[VIEWS], disparity[VIEWS], got, want = draw(&w, &params);
    bool needed[VIEWS];
    const int n = relume_slab_set_needs(needed, c.slabs, &w, W, &params);
    int marked = 0, first = -1;
    for (int i = 0; i < VIEWS; i++) {
        view[i] = needed[i] ? c.view[i] : (struct relume_image){0};
        disparity[i] = needed[i] ? c.disparity[i] : (struct relume_image){0};
        marked += needed[i];
        first = needed[i] ? i : first;
        assert_true(!needed[i] || c.slab_of[i] <= 1);  // the two that meet there
    }
    assert_int_equal(marked, n);
    assert_true(n > 0 && n < VIEWS / 3);
    CHECK_OK(relume_image_create(&got, W, W, 3));
    CHECK_OK(
        relume_slab_set_frame(&got, c.slabs, &w, view, relume_view_params(.disparity = disparity)));
    assert_true(difference(&got, &want) == 0);
    view[first].data = NULL;
    assert_int_equal(
        relume_slab_set_frame(&got, c.slabs, &w, view, relume_view_params(.disparity = disparity)),
        RELUME_EINVAL);
    view[first] = c.view[first];
    disparity[first].width--;
    assert_int_equal(
        relume_slab_set_frame(&got, c.slabs, &w, view, relume_view_params(.disparity = disparity)),
        RELUME_EINVAL);
    relume_image_destroy(&got);
    relume_image_destroy(&want);
}

static void a_ray_is_its_pixel(void **state)
{
    (void)state;
    const struct relume_window w = window_from(eye_at(28, 0.5, 2.8));
    for (int i = 0; i < 2; i++) {
        const struct relume_view_params params = {.one = true, .disparity = i ? c.disparity : NULL};
        struct relume_image frame = draw(&w, &params);
        for (int at = 11; at < W * W; at += 397) {
            const vec3 way = ray_of(&w, (at % W + 0.5) / W, (at / W + 0.5) / W);
            float rgb[3];
            const relume_status status =
                relume_slab_set_value(rgb, c.slabs, w.eye, way, c.view, &params);
            // the walk's steps follow the range of the views that a frame needs, a ray fewer
            for (int k = 0; k < 3 && !status; k++)
                CHECK_NEAR(rgb[k], frame.data[3 * at + k], i ? 0.02 : 1e-6);
        }
        relume_image_destroy(&frame);
    }
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    const struct relume_window w = window_from(eye_at(100, 0.5, 3));
    struct relume_image one = draw(&w, relume_view_params(.threads = 1, .disparity = c.disparity));
    struct relume_image three =
        draw(&w, relume_view_params(.threads = 3, .disparity = c.disparity));
    assert_memory_equal(one.data, three.data, 3 * W * W * sizeof(float));
    relume_image_destroy(&one);
    relume_image_destroy(&three);
}

// ---------------------------------------------------------------- lenses

static double uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

// A pinhole anywhere on the lens with a window on the plane in focus, by hand.
static struct relume_window random_pinhole(const struct relume_window *w, double aperture,
                                           double focus, uint64_t *random)
{
    const double away = sqrt(vec3_dot(w->eye, w->eye));  // windows here go through the origin
    double x, y;
    do {
        x = 2 * uniform(random) - 1;
        y = 2 * uniform(random) - 1;
    } while (x * x + y * y > 1);
    const vec3 none = {0, 0, 0};
    const double r = 0.5 * aperture, wide = sqrt(vec3_dot(w->right, w->right)),
                 high = sqrt(vec3_dot(w->down, w->down)), near = 1 - focus / away;
    return (struct relume_window){
        .eye = vec3_along(vec3_along(w->eye, w->right, r * x / wide), w->down, r * y / high),
        .corner = vec3_along(w->eye, vec3_sub(w->corner, w->eye), near),
        .right = vec3_along(none, w->right, near),
        .down = vec3_along(none, w->down, near),
    };
}

// Over the ball's inside, where no silhouette is blurred in, or over all of the picture.
static double psnr(const struct relume_image *a, const struct relume_image *b,
                   const struct relume_window *inside)
{
    double square = 0;
    int n = 0;
    for (int i = 0; i < 3 * W * W; i++) {
        if (inside && depth_in_ball(inside, i / 3) > 0.6)
            continue;
        square += pow((double)a->data[i] - (double)b->data[i], 2);
        n++;
    }
    return -10 * log10(square / n);
}

// The ball itself seen from many places of the lens, averaged.
static struct relume_image render_lens(const struct relume_window *w, double aperture, double focus)
{
    enum { MANY = 600 };
    struct relume_image sum, one, depth;
    uint64_t random = 3;
    CHECK_OK(relume_image_create(&sum, W, W, 3));
    for (int k = 0; k < MANY; k++) {
        const struct relume_window from = random_pinhole(w, aperture, focus, &random);
        render(&one, &depth, &from, W, W);
        for (int i = 0; i < 3 * W * W; i++)
            sum.data[i] += one.data[i] / MANY;
        relume_image_destroy(&one);
        relume_image_destroy(&depth);
    }
    return sum;
}

// By depth from between cameras and on a seam, focus on the ball's front, its middle and behind it.
// A pinhole is worse by far, and so is another focus.
static void a_lens_sees_what_its_points_see(void **state)
{
    (void)state;
    static const double azimuth_deg[] = {8, 30, 38}, focus[] = {0.65, 0, -0.5};
    for (int i = TEST_SANITIZED ? 2 : 0; i < 3; i++) {
        const struct relume_window w = window_from(eye_at(azimuth_deg[i], 0.3, 3.1));
        const double aperture = 0.8;
        struct relume_view_params params = {
            .disparity = c.disparity, .aperture = aperture, .focus = focus[i]};
        struct relume_image want = render_lens(&w, aperture, focus[i]);
        struct relume_image got = draw(&w, &params);
        params.focus = focus[(i + 1) % 3];
        struct relume_image other = draw(&w, &params);
        params.aperture = params.focus = 0;
        struct relume_image sharp = draw(&w, &params);
        // the blur of 600 random points against that of a few; over all of the picture the errors
        // are silhouettes, a texel wide, as the pinhole's are
        assert_true(psnr(&got, &want, &w) > 48);
        assert_true(psnr(&other, &want, &w) < 47.5);
        assert_true(psnr(&got, &want, NULL) > psnr(&sharp, &want, NULL));
        relume_image_destroy(&want);
        relume_image_destroy(&got);
        relume_image_destroy(&other);
        relume_image_destroy(&sharp);
    }
}

// Without depth: what the library's own pinhole frames give, averaged.
static void a_lens_without_depth_is_the_mean_of_frames(void **state)
{
    (void)state;
    enum { MANY = 300 };
    if (TEST_SANITIZED)  // the frames above, very often
        return;
    const struct relume_window w = window_from(eye_at(27, 0.2, 3.3));
    const struct relume_view_params flat = {.interpolation = RELUME_INTERPOLATE_LINEAR};
    struct relume_image sum, got = draw(&w, relume_view_params(.aperture = 0.6, .focus = 0.4));
    struct relume_image sharp = draw(&w, &flat);
    uint64_t random = 5;
    CHECK_OK(relume_image_create(&sum, W, W, 3));
    for (int k = 0; k < MANY; k++) {
        const struct relume_window from = random_pinhole(&w, 0.6, 0.4, &random);
        struct relume_image one = draw(&from, &flat);
        for (int i = 0; i < 3 * W * W; i++)
            sum.data[i] += one.data[i] / MANY;
        relume_image_destroy(&one);
    }
    assert_true(psnr(&got, &sum, NULL) > 50);
    assert_true(psnr(&sharp, &sum, NULL) < 42);
    relume_image_destroy(&sum);
    relume_image_destroy(&got);
    relume_image_destroy(&sharp);
}

// A pinhole has everything in focus; views that a lens does not need are not read.
static void small_lenses(void **state)
{
    (void)state;
    const struct relume_window w = window_from(eye_at(14, -0.3, 3.2));
    struct relume_image sharp = draw(&w, relume_view_params(.disparity = c.disparity));
    struct relume_image pinhole =
        draw(&w, relume_view_params(.disparity = c.disparity, .focus = 0.5));
    // the same rays, rounded differently: by a comparison of depths another texel here and there
    assert_true(psnr(&pinhole, &sharp, NULL) > 60);
    struct relume_view_params params = {.disparity = c.disparity, .aperture = 0.4};
    struct relume_image view[VIEWS], want = draw(&w, &params), got;
    bool needed[VIEWS];
    assert_true(relume_slab_set_needs(needed, c.slabs, &w, W, &params) < VIEWS / 3);
    for (int i = 0; i < VIEWS; i++)
        view[i] = needed[i] ? c.view[i] : (struct relume_image){0};
    CHECK_OK(relume_image_create(&got, W, W, 3));
    CHECK_OK(relume_slab_set_frame(&got, c.slabs, &w, view, &params));
    assert_true(difference(&got, &want) == 0);
    const struct relume_view_params wrong[] = {{.aperture = -1},
                                               {.aperture = (double)NAN},
                                               {.aperture = (double)INFINITY},
                                               {.focus = 3.3},
                                               {.aperture = 0.1, .focus = (double)NAN}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(relume_slab_set_frame(&got, c.slabs, &w, c.view, &wrong[i]),
                         RELUME_EINVAL);
    relume_image_destroy(&sharp);
    relume_image_destroy(&pinhole);
    relume_image_destroy(&want);
    relume_image_destroy(&got);
}

// Points lie within the disc, their mean is its middle, their mean square radius half the square of
// its own; a larger blur takes more of them.
static void pinholes_fill_the_lens(void **state)
{
    (void)state;
    const struct relume_window w = window_from(eye_at(20, 0.5, 3));
    int before = 1;
    for (int k = 0; k < 4; k++) {
        const double aperture = 0.05 * pow(4, k);
        const int n = relume_lens_points(&w, aperture, 0, 200);
        double square = 0;
        vec3 middle = {0, 0, 0};
        for (int i = 0; i < n; i++) {
            const struct relume_window from = relume_lens_window(&w, aperture, 0, i, n);
            const vec3 off = vec3_sub(from.eye, w.eye);
            assert_true(vec3_dot(off, off) < 0.25 * aperture * aperture);
            CHECK_NEAR(vec3_dot(off, ray_of(&w, 0.5, 0.5)), 0, 1e-12);
            square += vec3_dot(off, off) / n;
            middle = vec3_along(middle, off, 1.0 / n);
        }
        CHECK_NEAR(square, 0.125 * aperture * aperture, 1e-12);
        assert_true(sqrt(vec3_dot(middle, middle)) < 0.06 * aperture);
        assert_true(n >= before);
        before = n;
    }
    assert_int_equal(before, 64);
    assert_int_equal(relume_lens_points(&w, 0, 0.3, 200), 1);
}

// ---------------------------------------------------------------- weights, windows, rays

static void weights_fade_to_the_border(void **state)
{
    (void)state;
    const relume_slab *slab = relume_slab_set_slab(c.slabs, 0);
    const double edge = place(SIDE - 1), zero[2] = {0, 0}, rim[2] = {window, 0};
    const double quarter[2] = {0.75 * edge, 0.1}, border[2] = {edge, 0.1},
                 beyond[2] = {edge + 0.01, 0};
    CHECK_NEAR(relume_slab_weight(slab, zero, zero), 1, 0);
    CHECK_NEAR(relume_slab_weight(slab, quarter, zero), 0.5, 1e-12);  // half way down
    CHECK_NEAR(relume_slab_weight(slab, border, zero), 1e-4, 1e-12);
    CHECK_NEAR(relume_slab_weight(slab, beyond, zero), 0, 0);
    CHECK_NEAR(relume_slab_weight(slab, zero, rim), 0, 0);
    double before = 1;
    for (int i = 0; i <= 1000; i++) {
        const double uv[2] = {edge * i / 1000, 0};
        const double now = relume_slab_weight(slab, uv, zero);
        assert_true(now <= before && before - now < 4e-3);
        before = now;
    }
}

static void an_eye_before_a_slab_has_its_window(void **state)
{
    (void)state;
    const struct relume_geometry *g = relume_slab_set_geometry(c.slabs, 1);
    const vec3 eye = relume_slab_set_eye(c.slabs, 1);
    const struct relume_window got = window_from(eye), want = relume_slab_window(g, eye);
    const vec3 off[] = {vec3_sub(got.corner, want.corner), vec3_sub(got.right, want.right),
                        vec3_sub(got.down, want.down)};
    for (int i = 0; i < 3; i++)
        assert_true(vec3_dot(off[i], off[i]) < 1e-24);
    const vec3 middle = relume_slab_set_middle(c.slabs);
    assert_true(vec3_dot(middle, middle) < 1e-24);
}

static void eyes_look_where_they_are_told(void **state)
{
    (void)state;
    struct relume_window w;
    const struct relume_look_at look_at = {
        .aimed = true, .at = {0, 1, 0}, .up = {1, 0, 0}, .field_of_view_deg = 90};
    const vec3 eye = {0, 1, 2};
    assert_true(relume_slab_set_window(&w, c.slabs, eye, &look_at, 200, 100));
    const vec3 middle = ray_of(&w, 0.5, 0.5), side = ray_of(&w, 1, 0.5), top = ray_of(&w, 0.5, 0);
    assert_true(fabs(middle.x) < 1e-12 && fabs(middle.y) < 1e-12 && middle.z < 0);
    CHECK_NEAR(side.y / side.z, 1, 1e-12);  // up is +x, so right is -y; half of 90 degrees
    CHECK_NEAR(top.x / -top.z, 0.5, 1e-12);
    // from straight above the picture's top is -z, as of the slab above a cube
    assert_true(relume_slab_set_window(&w, c.slabs, (vec3){0, 4, 0}, NULL, 1, 1));
    assert_true(w.down.z > 0 && w.right.x > 0);
    const struct relume_look_at wrong[] = {{.aimed = true, .at = eye},
                                           {.up = {0, -1, -2}},
                                           {.field_of_view_deg = 180},
                                           {.field_of_view_deg = -1},
                                           {.aimed = true, .at = {(double)NAN, 0, 0}}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_false(relume_slab_set_window(&w, c.slabs, eye, &wrong[i], 1, 1));
    assert_false(relume_slab_set_window(&w, c.slabs, (vec3){0, 0, 0}, NULL, 1, 1));
}

static void the_nearest_view_is_found(void **state)
{
    (void)state;
    for (int i = 0; i < VIEWS; i += 5) {
        const struct relume_geometry *g = &c.slab[c.slab_of[i]];
        if (fabs(c.uv[i][0]) > 1)
            continue;
        const vec3 eye = relume_pose_world(&g->pose, (vec3){c.uv[i][0], c.uv[i][1], uv_z});
        const vec3 point = relume_pose_world(&g->pose, (vec3){0.5 * window, 0.25 * window, 0});
        int view;
        double at[2];
        assert_true(relume_slab_set_nearest(&view, at, c.slabs, eye, vec3_sub(point, eye)));
        assert_int_equal(view, i);
        CHECK_NEAR(at[0], 0.75, 1e-9);
        CHECK_NEAR(at[1], 0.375, 1e-9);
        assert_false(relume_slab_set_nearest(&view, at, c.slabs, eye, vec3_sub(eye, point)));
    }
}

// ---------------------------------------------------------------- refusals

static void wrong_slabs_are_refused(void **state)
{
    (void)state;
    struct relume_geometry many[RELUME_MOST_SLABS + 1];
    double uv[RELUME_MOST_SLABS + 1][2];
    int of[RELUME_MOST_SLABS + 1];
    relume_slab_set *slabs = (void *)1;
    for (int i = 0; i <= RELUME_MOST_SLABS; i++) {
        many[i] = slab_of_ring(i);
        uv[i][0] = uv[i][1] = 0;
        of[i] = i;
    }
    const double(*places)[2] = (const double(*)[2])uv;
    assert_int_equal(relume_slab_set_create(&slabs, many, 65, places, of, 65), RELUME_EINVAL);
    assert_null(slabs);
    assert_int_equal(relume_slab_set_create(&slabs, many, 0, places, of, 65), RELUME_EINVAL);
    CHECK_OK(relume_slab_set_create(&slabs, many, 64, places, of, 64));
    relume_slab_set_destroy(&slabs);
    of[3] = 2;  // slab 3 has no view, slab 2 two in one place
    assert_int_equal(relume_slab_set_create(&slabs, many, 64, places, of, 64), RELUME_EINVAL);
}

static void wrong_frames_are_refused(void **state)
{
    (void)state;
    const struct relume_window w = window_from(eye_at(0, 0, 3));
    const struct relume_view_params wrong[] = {
        {.aperture = -0.1}, {.focus = 3}, {.interpolation = RELUME_INTERPOLATE_DEPTH}};
    struct relume_image out;
    float rgb[3];
    CHECK_OK(relume_image_create(&out, W, W, 3));
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(relume_slab_set_frame(&out, c.slabs, &w, c.view, &wrong[i]),
                         RELUME_EINVAL);
    assert_int_equal(relume_slab_set_value(rgb, c.slabs, w.eye, (vec3){0, 0, 1}, c.view, NULL),
                     RELUME_EINVAL);
    relume_image_destroy(&out);
    CHECK_OK(relume_image_create(&out, W, W, 1));
    assert_int_equal(relume_slab_set_frame(&out, c.slabs, &w, c.view, NULL), RELUME_EINVAL);
    relume_image_destroy(&out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_seam_is_as_good_as_the_inside),
        cmocka_unit_test(nothing_jumps_across_a_seam),
        cmocka_unit_test(eyes_beside_the_cameras_see_by_depth),
        cmocka_unit_test(nothing_jumps_at_the_edge_of_the_grid),
        cmocka_unit_test(frames_beside_the_cameras_are_sure),
        cmocka_unit_test(a_camera_sees_its_view),
        cmocka_unit_test(poses_turn_with_the_world),
        cmocka_unit_test(one_slab_is_a_slab),
        cmocka_unit_test(copies_are_one),
        cmocka_unit_test(only_needed_views_are_read),
        cmocka_unit_test(a_ray_is_its_pixel),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(a_lens_sees_what_its_points_see),
        cmocka_unit_test(a_lens_without_depth_is_the_mean_of_frames),
        cmocka_unit_test(small_lenses),
        cmocka_unit_test(pinholes_fill_the_lens),
        cmocka_unit_test(weights_fade_to_the_border),
        cmocka_unit_test(an_eye_before_a_slab_has_its_window),
        cmocka_unit_test(eyes_look_where_they_are_told),
        cmocka_unit_test(the_nearest_view_is_found),
        cmocka_unit_test(wrong_slabs_are_refused),
        cmocka_unit_test(wrong_frames_are_refused),
    };
    return cmocka_run_group_tests(tests, capture, release);
}
