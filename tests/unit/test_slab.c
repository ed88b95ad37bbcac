// test_slab.c - one slab: rays, blends and frames against closed forms
#include "relight/view/view.h"

#include <relume/relight/view.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { COLUMNS = 4, ROWS = 3, VIEWS = COLUMNS * ROWS };
static const double columns[COLUMNS] = {-1.0, -0.2, 0.1, 1.0};
static const double rows[ROWS] = {-0.5, 0.25, 0.5};
static const double uv_z = 3.0;
// Where each crossing stands in the list of views: any order must do.
static const int order[VIEWS] = {7, 0, 3, 11, 2, 9, 1, 10, 5, 4, 8, 6};

static double uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

static struct relume_geometry geometry(void)
{
    return (struct relume_geometry){
        .projection = RELUME_SLAB,
        .uv_z = uv_z,
        .st_z = 0.0,
        .st_min = {-1.0, -0.75},
        .st_max = {1.0, 0.75},
    };
}

static relume_slab *make_slab(void)
{
    double uv[VIEWS][2];
    for (int i = 0; i < VIEWS; i++) {
        uv[order[i]][0] = columns[i % COLUMNS];
        uv[order[i]][1] = rows[i / COLUMNS];
    }
    const struct relume_geometry g = geometry();
    relume_slab *slab;
    assert_int_equal(relume_slab_create(&slab, &g, (const double(*)[2])uv, VIEWS), RELUME_OK);
    return slab;
}

static void make_images(struct relume_image *images, int width, int height)
{
    for (int i = 0; i < VIEWS; i++)
        assert_int_equal(relume_image_create(&images[i], width, height, 3), RELUME_OK);
}

static void destroy_images(struct relume_image *images)
{
    for (int i = 0; i < VIEWS; i++)
        relume_image_destroy(&images[i]);
}

static void fill_random(struct relume_image *image, uint64_t *state)
{
    for (int i = 0; i < 3 * image->width * image->height; i++)
        image->data[i] = (float)(uniform(state) - 0.25);
}

// ---------------------------------------------------------------- grid

static relume_status try_grid(const double (*uv)[2], int n)
{
    const struct relume_geometry g = geometry();
    relume_slab *slab;
    const relume_status status = relume_slab_create(&slab, &g, uv, n);
    assert_true((status == RELUME_OK) == (slab != NULL));
    relume_slab_destroy(&slab);
    return status;
}

static void finds_an_uneven_grid_in_any_order(void **state)
{
    (void)state;
    relume_slab *slab = make_slab();
    const struct relume_slab_grid grid = relume_slab_grid(slab);
    assert_int_equal(grid.columns, COLUMNS);
    assert_int_equal(grid.rows, ROWS);
    assert_memory_equal(grid.u, columns, sizeof columns);
    assert_memory_equal(grid.v, rows, sizeof rows);
    assert_memory_equal(grid.view, order, sizeof order);
    const struct relume_vec3 middle = relume_slab_middle(slab);
    assert_true(middle.x == 0.0 && middle.y == 0.0 && middle.z == uv_z);
    relume_slab_destroy(&slab);
    assert_null(slab);
    relume_slab_destroy(&slab);
}

static void takes_lines_and_single_cameras(void **state)
{
    (void)state;
    const double row[][2] = {{0.5, 1}, {-1, 1}, {0, 1}};
    const double column[][2] = {{2, 1}, {2, -1}};
    const double nearly[][2] = {{0, 0}, {1, 1e-9}, {1e-9, 1}, {1, 1}};
    assert_int_equal(try_grid(row, 3), RELUME_OK);
    assert_int_equal(try_grid(column, 2), RELUME_OK);
    assert_int_equal(try_grid(column, 1), RELUME_OK);
    assert_int_equal(try_grid(nearly, 4), RELUME_OK);
}

static void refuses_what_is_no_grid(void **state)
{
    (void)state;
    const double missing[][2] = {{0, 0}, {1, 0}, {0, 1}};
    const double twice[][2] = {{0, 0}, {1, 0}, {0, 1}, {0, 1}};
    const double diagonal[][2] = {{0, 0}, {1, 1}};
    const double same[][2] = {{1, 1}, {1, 1}};
    const double broken[][2] = {{0, 0}, {NAN, 0}};
    assert_int_equal(try_grid(missing, 3), RELUME_EINVAL);
    assert_int_equal(try_grid(twice, 4), RELUME_EINVAL);
    assert_int_equal(try_grid(diagonal, 2), RELUME_EINVAL);
    assert_int_equal(try_grid(same, 2), RELUME_EINVAL);
    assert_int_equal(try_grid(broken, 2), RELUME_EINVAL);
    assert_int_equal(try_grid(same, 0), RELUME_EINVAL);
}

static void refuses_planes_and_windows_without_extent(void **state)
{
    (void)state;
    const double uv[][2] = {{0, 0}};
    struct relume_geometry flat = geometry();
    flat.uv_z = flat.st_z;
    struct relume_geometry empty = geometry();
    empty.st_max[1] = empty.st_min[1];
    relume_slab *slab;
    assert_int_equal(relume_slab_create(&slab, &flat, uv, 1), RELUME_EINVAL);
    assert_int_equal(relume_slab_create(&slab, &empty, uv, 1), RELUME_EINVAL);
}

// ---------------------------------------------------------------- rays and weights

static void rays_meet_the_uv_plane(void **state)
{
    (void)state;
    relume_slab *slab = make_slab();
    double uv[2];
    assert_true(relume_slab_uv(uv, slab, (struct relume_vec3){0.3, -0.7, uv_z}, 0.9, 0.1));
    assert_true(uv[0] == 0.3 && uv[1] == -0.7);
    // From twice the distance the uv plane lies half way.
    assert_true(relume_slab_uv(uv, slab, (struct relume_vec3){2, 1, 2 * uv_z}, 1, -0.5));
    assert_float_equal(uv[0], 1.5, 1e-15);
    assert_float_equal(uv[1], 0.25, 1e-15);
    // From half the distance it lies behind the eye.
    assert_true(relume_slab_uv(uv, slab, (struct relume_vec3){0, 0, 0.5 * uv_z}, 0.5, 0));
    assert_float_equal(uv[0], -0.5, 1e-15);
    assert_false(relume_slab_uv(uv, slab, (struct relume_vec3){0, 0, 0}, 0.5, 0));
    assert_false(relume_slab_uv(uv, slab, (struct relume_vec3){0, 0, -1}, 0.5, 0));
    assert_false(relume_slab_uv(uv, slab, (struct relume_vec3){NAN, 0, 3}, 0.5, 0));
    relume_slab_destroy(&slab);
}

static void blend_is_bilinear_and_sums_to_one(void **state)
{
    (void)state;
    relume_slab *slab = make_slab();
    uint64_t random = 1;
    for (int i = 0; i < 1000; i++) {
        const double uv[2] = {2 * uniform(&random) - 1, uniform(&random) - 0.5};
        int view[4];
        double w[4], sum = 0, at[2] = {0, 0};
        const int n = relume_slab_blend(view, w, slab, uv, NULL);
        for (int k = 0; k < n; k++) {
            int place = 0;
            while (order[place] != view[k])
                place++;
            assert_true(w[k] > 0);
            sum += w[k];
            at[0] += w[k] * columns[place % COLUMNS];
            at[1] += w[k] * rows[place / COLUMNS];
        }
        // Bilinear weights reproduce linear functions, the position itself among them.
        assert_float_equal(sum, 1, 1e-14);
        assert_float_equal(at[0], uv[0], 1e-14);
        assert_float_equal(at[1], uv[1], 1e-14);
    }
    relume_slab_destroy(&slab);
}

static void blend_at_crossings_borders_and_outside(void **state)
{
    (void)state;
    relume_slab *slab = make_slab();
    int view[4];
    double w[4];
    for (int i = 0; i < VIEWS; i++) {
        const double uv[2] = {columns[i % COLUMNS], rows[i / COLUMNS]};
        assert_int_equal(relume_slab_blend(view, w, slab, uv, NULL), 1);
        assert_int_equal(view[0], order[i]);
        assert_true(w[0] == 1.0);
    }
    const double border[2] = {1.0 + 1e-7, -0.5 - 1e-7};
    const double outside[2] = {1.0 + 1e-4, 0.0};
    const double broken[2] = {NAN, 0.0};
    assert_int_equal(relume_slab_blend(view, w, slab, border, NULL), 1);
    assert_int_equal(view[0], order[COLUMNS - 1]);
    assert_int_equal(relume_slab_blend(view, w, slab, outside, NULL), 0);
    assert_int_equal(relume_slab_blend(view, w, slab, broken, NULL), 0);
    const double near_second[2] = {-0.5, 0.3};
    assert_int_equal(
        relume_slab_blend(view, w, slab, near_second,
                          relume_view_params(.interpolation = RELUME_INTERPOLATE_CONSTANT)),
        1);
    assert_int_equal(view[0], order[COLUMNS + 1]);
    relume_slab_destroy(&slab);
}

// ---------------------------------------------------------------- which views

// Marks what a dense look through the window from `eye` finds.
static void scan(bool *seen, const relume_slab *slab, struct relume_vec3 eye,
                 const struct relume_view_params *params)
{
    enum { STEPS = 160 };
    const struct relume_geometry g = geometry();
    memset(seen, 0, VIEWS * sizeof *seen);
    for (int j = 0; j <= STEPS; j++)
        for (int i = 0; i <= STEPS; i++) {
            double uv[2], w[4];
            int view[4];
            const double s = g.st_min[0] + (g.st_max[0] - g.st_min[0]) * i / STEPS;
            const double t = g.st_min[1] + (g.st_max[1] - g.st_min[1]) * j / STEPS;
            if (!relume_slab_uv(uv, slab, eye, s, t))
                continue;
            const int n = relume_slab_blend(view, w, slab, uv, params);
            for (int k = 0; k < n; k++)
                seen[view[k]] = true;
        }
}

static bool beside_a_seen_one(const bool *seen, int place)
{
    for (int i = 0; i < VIEWS; i++)
        if (seen[order[i]] && abs(i % COLUMNS - place % COLUMNS) <= 1 &&
            abs(i / COLUMNS - place / COLUMNS) <= 1)
            return true;
    return false;
}

static void compare_needs(const relume_slab *slab, struct relume_vec3 eye,
                          const struct relume_view_params *params)
{
    bool seen[VIEWS], needed[VIEWS];
    scan(seen, slab, eye, params);
    const int n = relume_slab_needs(needed, slab, eye, params);
    int marked = 0;
    for (int i = 0; i < VIEWS; i++) {
        marked += needed[order[i]];
        if (seen[order[i]])
            assert_true(needed[order[i]]);
        // The scan may step over a sliver, never over a whole cell.
        else if (needed[order[i]])
            assert_true(beside_a_seen_one(seen, i) || n <= 4);
    }
    assert_int_equal(marked, n);
}

static void needs_are_the_views_with_weight(void **state)
{
    (void)state;
    relume_slab *slab = make_slab();
    uint64_t random = 7;
    for (int i = 0; i < 150; i++) {
        const struct relume_vec3 eye = {3 * uniform(&random) - 1.5, 2 * uniform(&random) - 1,
                                        0.5 + 6 * uniform(&random)};
        compare_needs(slab, eye, NULL);
        compare_needs(slab, eye, relume_view_params(.interpolation = RELUME_INTERPOLATE_CONSTANT));
    }
    relume_slab_destroy(&slab);
}

static void captured_eyes_need_one_view(void **state)
{
    (void)state;
    relume_slab *slab = make_slab();
    bool needed[VIEWS];
    for (int i = 0; i < VIEWS; i++) {
        const struct relume_vec3 eye = {columns[i % COLUMNS], rows[i / COLUMNS], uv_z};
        assert_int_equal(relume_slab_needs(needed, slab, eye, NULL), 1);
        assert_true(needed[order[i]]);
    }
    const struct relume_vec3 beside = {1.5, 0, uv_z};
    assert_int_equal(relume_slab_needs(needed, slab, beside, NULL), 0);
    relume_slab_destroy(&slab);
}

// ---------------------------------------------------------------- frames

static void captured_eyes_give_their_view_bit_by_bit(void **state)
{
    (void)state;
    enum { W = 37, H = 23 };
    relume_slab *slab = make_slab();
    struct relume_image images[VIEWS], out;
    uint64_t random = 3;
    make_images(images, W, H);
    for (int i = 0; i < VIEWS; i++)
        fill_random(&images[i], &random);
    images[4].data[5] = -0.0f;
    images[4].data[6] = INFINITY;
    assert_int_equal(relume_image_create(&out, W, H, 3), RELUME_OK);
    for (int i = 0; i < VIEWS; i++) {
        const struct relume_vec3 eye = {columns[i % COLUMNS], rows[i / COLUMNS], uv_z};
        assert_int_equal(relume_slab_frame(&out, slab, eye, images, NULL), RELUME_OK);
        assert_memory_equal(out.data, images[order[i]].data, W * H * 3 * sizeof(float));
    }
    relume_image_destroy(&out);
    destroy_images(images);
    relume_slab_destroy(&slab);
}

// A picture on the plane z = st_z looks the same to every camera, and so from every eye.
static void a_picture_on_the_st_plane_stays(void **state)
{
    (void)state;
    enum { W = 24, H = 18 };
    relume_slab *slab = make_slab();
    struct relume_image images[VIEWS], out;
    make_images(images, W, H);
    for (int i = 0; i < VIEWS; i++) {
        uint64_t random = 5;
        fill_random(&images[i], &random);
    }
    assert_int_equal(relume_image_create(&out, W, H, 3), RELUME_OK);
    const struct relume_vec3 eyes[] = {{0, 0, 3}, {0.3, -0.1, 3}, {0.1, 0, 3.4}, {0.9, 0.4, 2.9}};
    for (int e = 0; e < 4; e++) {
        assert_int_equal(relume_slab_frame(&out, slab, eyes[e], images, NULL), RELUME_OK);
        for (int i = 0; i < W * H * 3; i++)
            // four weights, each rounded to float: a few times 2^-24
            assert_float_equal(out.data[i], images[0].data[i], 5e-7);
    }
    relume_image_destroy(&out);
    destroy_images(images);
    relume_slab_destroy(&slab);
}

// Each camera paints its own (u, v): a frame must show where its rays meet the uv plane, beside the
// grid its nearest place.
static void frames_blend_linearly_between_cameras(void **state)
{
    (void)state;
    enum { W = 16, H = 12, OUT_W = 40, OUT_H = 30 };
    relume_slab *slab = make_slab();
    const struct relume_geometry g = geometry();
    struct relume_image images[VIEWS], out;
    make_images(images, W, H);
    for (int i = 0; i < VIEWS; i++)
        for (int k = 0; k < W * H; k++) {
            images[order[i]].data[3 * k] = (float)columns[i % COLUMNS];
            images[order[i]].data[3 * k + 1] = (float)rows[i / COLUMNS];
            images[order[i]].data[3 * k + 2] = 1.0f;
        }
    assert_int_equal(relume_image_create(&out, OUT_W, OUT_H, 3), RELUME_OK);
    const struct relume_vec3 eye = {1.2, -0.3, 6.0};
    assert_int_equal(relume_slab_frame(&out, slab, eye, images, NULL), RELUME_OK);
    int outside = 0;
    for (int y = 0; y < OUT_H; y++)
        for (int x = 0; x < OUT_W; x++) {
            const float *rgb = &out.data[3 * (y * OUT_W + x)];
            const double s = g.st_min[0] + (x + 0.5) / OUT_W * (g.st_max[0] - g.st_min[0]);
            const double t = g.st_max[1] - (y + 0.5) / OUT_H * (g.st_max[1] - g.st_min[1]);
            double uv[2];
            assert_true(relume_slab_uv(uv, slab, eye, s, t));
            const bool inside = fabs(uv[0]) <= 1 && fabs(uv[1]) <= 0.5;
            outside += !inside;
            assert_float_equal(rgb[0], fmin(fmax(uv[0], -1), 1), 1e-6);
            assert_float_equal(rgb[1], fmin(fmax(uv[1], -0.5), 0.5), 1e-6);
            assert_float_equal(rgb[2], 1, 1e-6);
        }
    assert_true(outside > 0);
    relume_image_destroy(&out);
    destroy_images(images);
    relume_slab_destroy(&slab);
}

static double largest_step(const struct relume_image *a, const struct relume_image *b)
{
    double most = 0;
    for (int i = 0; i < 3 * a->width * a->height; i++)
        most = fmax(most, fabs(a->data[i] - b->data[i]));
    return most;
}

// Values differ by at most 1 from camera to camera and the narrowest cell is 0.25 wide, so a step
// of d along u and v changes a pixel by at most 2 d / 0.25.
static void frames_are_continuous_when_the_eye_moves(void **state)
{
    (void)state;
    enum { W = 12, H = 9, STEPS = 300 };
    relume_slab *slab = make_slab();
    struct relume_image images[VIEWS], now, before;
    uint64_t random = 9;
    make_images(images, W, H);
    for (int i = 0; i < VIEWS; i++)
        fill_random(&images[i], &random);
    assert_int_equal(relume_image_create(&now, W, H, 3), RELUME_OK);
    assert_int_equal(relume_image_create(&before, W, H, 3), RELUME_OK);
    for (int i = 0; i <= STEPS; i++) {
        const double part = (double)i / STEPS;
        const struct relume_vec3 eye = {-1 + 2 * part, 0.5 - part, uv_z};
        assert_int_equal(relume_slab_frame(&now, slab, eye, images, NULL), RELUME_OK);
        if (i)
            assert_true(largest_step(&now, &before) <= (2.0 / STEPS + 1.0 / STEPS) / 0.25 + 1e-6);
        memcpy(before.data, now.data, W * H * 3 * sizeof(float));
    }
    relume_image_destroy(&now);
    relume_image_destroy(&before);
    destroy_images(images);
    relume_slab_destroy(&slab);
}

static void frames_do_not_depend_on_threads(void **state)
{
    (void)state;
    enum { W = 31, H = 17 };
    relume_slab *slab = make_slab();
    struct relume_image images[VIEWS], one, many;
    uint64_t random = 2;
    make_images(images, 8, 8);
    for (int i = 0; i < VIEWS; i++)
        fill_random(&images[i], &random);
    assert_int_equal(relume_image_create(&one, W, H, 3), RELUME_OK);
    assert_int_equal(relume_image_create(&many, W, H, 3), RELUME_OK);
    const struct relume_vec3 eye = {0.15, 0.05, 4};
    assert_int_equal(relume_slab_frame(&one, slab, eye, images, relume_view_params(.threads = 1)),
                     RELUME_OK);
    assert_int_equal(relume_slab_frame(&many, slab, eye, images, relume_view_params(.threads = 7)),
                     RELUME_OK);
    assert_memory_equal(one.data, many.data, W * H * 3 * sizeof(float));
    relume_image_destroy(&one);
    relume_image_destroy(&many);
    destroy_images(images);
    relume_slab_destroy(&slab);
}

static void frames_refuse_blind_eyes_and_missing_views(void **state)
{
    (void)state;
    relume_slab *slab = make_slab();
    struct relume_image images[VIEWS], out;
    make_images(images, 4, 4);
    assert_int_equal(relume_image_create(&out, 4, 4, 3), RELUME_OK);
    const struct relume_vec3 far = {9, 0, uv_z};
    const struct relume_vec3 behind = {0, 0, -1};
    const struct relume_vec3 captured = {columns[2], rows[1], uv_z};
    assert_int_equal(relume_slab_frame(&out, slab, far, images, NULL), RELUME_EINVAL);
    assert_int_equal(relume_slab_frame(&out, slab, behind, images, NULL), RELUME_EINVAL);
    // Only the views that matter are looked at.
    for (int i = 0; i < VIEWS; i++)
        if (i != order[COLUMNS + 2])
            relume_image_destroy(&images[i]);
    assert_int_equal(relume_slab_frame(&out, slab, captured, images, NULL), RELUME_OK);
    relume_image_destroy(&images[order[COLUMNS + 2]]);
    assert_int_equal(relume_slab_frame(&out, slab, captured, images, NULL), RELUME_EINVAL);
    relume_image_destroy(&out);
    relume_slab_destroy(&slab);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_an_uneven_grid_in_any_order),
        cmocka_unit_test(takes_lines_and_single_cameras),
        cmocka_unit_test(refuses_what_is_no_grid),
        cmocka_unit_test(refuses_planes_and_windows_without_extent),
        cmocka_unit_test(rays_meet_the_uv_plane),
        cmocka_unit_test(blend_is_bilinear_and_sums_to_one),
        cmocka_unit_test(blend_at_crossings_borders_and_outside),
        cmocka_unit_test(needs_are_the_views_with_weight),
        cmocka_unit_test(captured_eyes_need_one_view),
        cmocka_unit_test(captured_eyes_give_their_view_bit_by_bit),
        cmocka_unit_test(a_picture_on_the_st_plane_stays),
        cmocka_unit_test(frames_blend_linearly_between_cameras),
        cmocka_unit_test(frames_are_continuous_when_the_eye_moves),
        cmocka_unit_test(frames_do_not_depend_on_threads),
        cmocka_unit_test(frames_refuse_blind_eyes_and_missing_views),
    };
    return cmocka_run_group_tests_name("slab", tests, NULL, NULL);
}
