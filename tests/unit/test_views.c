// Nine cameras before two textured planes, in closed form: names, order and depth.
#include "made_exif.h"
#include "test.h"

enum { GRID = 3, SIZE = 64, MIDDLE = 1 };
// Disparity (view.h) of a square in front of a wall behind the st plane.
static const double wall = -0.1, square = 0.25;

static double texture(double s, double t, double phase)
{
    return 0.5 + 0.2 * sin(23.0 * s + phase) * cos(19.0 * t) +
           0.2 * sin(41.0 * t - 7.0 * s * s + phase);
}

static bool in_square(double s, double t)
{
    return fabs(s) < 0.4 && fabs(t) < 0.4;
}

static double camera_u(int column)
{
    return 0.5 * (column - MIDDLE);
}

static double camera_v(int row)
{
    return 0.5 * (MIDDLE - row);
}

// What the middle camera would see in (s, t) of a plane that the camera at (u, v) sees in pixel x,
// y.
static void middle_st(double st[2], int x, int y, double u, double v, double q)
{
    st[0] = (x + 0.5) / SIZE * 2.0 - 1.0 + q * u;
    st[1] = 1.0 - (y + 0.5) / SIZE * 2.0 + q * v;
}

static void render(struct relume_image *image, double u, double v)
{
    CHECK_OK(relume_image_create(image, SIZE, SIZE, 3));
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            double front[2], back[2];
            middle_st(front, x, y, u, v, square);
            middle_st(back, x, y, u, v, wall);
            const double value = in_square(front[0], front[1]) ? texture(front[0], front[1], 0.0)
                                                               : texture(back[0], back[1], 2.0);
            for (int c = 0; c < 3; c++)
                image->data[(y * SIZE + x) * 3 + c] = (float)(value * (1.0 - 0.2 * c));
        }
}

typedef void name_function(char name[64], int row, int column);

static void name_rows(char name[64], int row, int column)
{
    snprintf(name, 64, "view_%02d_%02d.exr", 2 * row, 2 * column);
}

static void name_below(char name[64], int row, int column)
{
    snprintf(name, 64, "view_%02d_%02d.exr", 4 - 2 * row, 2 * column);
}

static void name_lytro(char name[64], int row, int column)
{
    snprintf(name, 64, "input_Cam%03d.exr", row * GRID + column);
}

static void name_archive(char name[64], int row, int column)
{
    snprintf(name, 64, "out_%02d_%02d_%.3f_%.3f_.exr", row, column, 100.5 - 50.0 * row,
             -20.25 + 50.0 * column);
}

// The first date is shorter than nine digits, which no number of a grid is.
static void name_dated(char name[64], int row, int column)
{
    const int i = row * GRID + column;
    snprintf(name, 64, "view_%s_%02d_%02d.exr", i ? "20260101120000" : "7", row, column);
}

static void name_own(char name[64], int row, int column)
{
    snprintf(name, 64, "shot7_x%d.y%d.exr", column, row);
}

// What follows a position is not its exponent.
static void name_exponent(char name[64], int row, int column)
{
    snprintf(name, 64, "at %.1fe4 %.1f.exr", 0.5 * column, 8.0 - 0.5 * row);
}

struct photos {
    char folder[64], out[96];
    char path[GRID * GRID][160];
    const char *list[GRID * GRID];
};

static void shoot(struct photos *p, name_function *name)
{
    test_folder(p->folder);
    snprintf(p->out, sizeof p->out, "%s/out", p->folder);
    for (int i = 0; i < GRID * GRID; i++) {
        char text[64];
        struct relume_image image;
        name(text, i / GRID, i % GRID);
        snprintf(p->path[i], sizeof p->path[i], "%s/%s", p->folder, text);
        p->list[i] = p->path[i];
        render(&image, camera_u(i % GRID), camera_v(i / GRID));
        CHECK_OK(relume_image_save(&image, p->path[i], NULL));
        relume_image_destroy(&image);
    }
}

// Every photograph stands where it was taken; they come in any order.
static void check_places(const struct photos *p)
{
    relume_capture *capture;
    CHECK_OK(relume_capture_open(&capture, p->out, NULL));
    const struct relume_manifest *m = relume_capture_manifest(capture);
    assert_int_equal(m->views, GRID * GRID);
    assert_int_equal(m->geometry.projection, RELUME_SLAB);
    for (int i = 0; i < GRID * GRID; i++) {
        int k = 0;
        const char *name = strrchr(p->path[i], '/');
        while (k < m->views && !strstr(m->view[k].images[0], name))
            k++;
        assert_true(k < m->views);
        CHECK_NEAR(m->view[k].uv[0], camera_u(i % GRID), 1e-9);
        CHECK_NEAR(m->view[k].uv[1], camera_v(i / GRID), 1e-9);
    }
    relume_capture_destroy(&capture);
}

static void test_names(void **state)
{
    (void)state;
    static const struct {
        name_function *name;
        const char *pattern;
    } cases[] = {{name_rows, NULL},
                 {name_lytro, NULL},
                 {name_archive, NULL},
                 {name_dated, NULL},
                 {name_own, "*x{column}.y{row}"},
                 {name_lytro, "input_Cam{n}"},
                 {name_archive, "out_*_{v}_{u}_"},
                 {name_archive, "*u*_*_{v}_{u}_*"},
                 {name_exponent, "at {u}e4 {v}"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct photos p;
        struct test_log log;
        test_log_init(&log);
        shoot(&p, cases[i].name);
        CHECK_OK(relume_slab_ingest(p.out, p.list, GRID * GRID,
                                    relume_slab_ingest_params(.names = cases[i].pattern),
                                    relume_ingest_params(.log = &log.log)));
        // that the grid is square is assumed where names hold no positions
        const bool positions = cases[i].name == name_archive || cases[i].name == name_exponent;
        assert_int_equal(log.lines, !positions);
        assert_true(positions || strstr(log.text, "as far apart as columns"));
        check_places(&p);
        test_folder_remove(p.folder);
    }
}

static void name_high(char name[64], int row, int column)
{
    snprintf(name, 64, "out_%02d_%02d_%.3f_%.3f_.exr", row, column, 80.0 - 20.0 * row,
             5.0 + 50.0 * column);
}

// Rows stand as far apart as names or the caller say: 2/5 of the columns' way, and 0.7.
static void test_grids_that_are_not_square(void **state)
{
    (void)state;
    static const struct {
        name_function *name;
        double baseline_v, want;
    } cases[] = {{name_high, 0.0, 0.4}, {name_high, 0.7, 0.7}, {name_rows, 0.7, 0.7}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct photos p;
        relume_capture *capture;
        struct test_log log;
        test_log_init(&log);
        shoot(&p, cases[i].name);
        CHECK_OK(relume_slab_ingest(
            p.out, p.list, GRID * GRID,
            relume_slab_ingest_params(.baseline_v = cases[i].baseline_v, .keep_order = true),
            relume_ingest_params(.log = &log.log)));
        assert_int_equal(log.lines, 0);
        CHECK_OK(relume_capture_open(&capture, p.out, NULL));
        const struct relume_manifest *m = relume_capture_manifest(capture);
        double high[2] = {0, 0};
        for (int k = 0; k < m->views; k++)
            for (int axis = 0; axis < 2; axis++)
                high[axis] = fmax(high[axis], m->view[k].uv[axis]);
        CHECK_NEAR(2 * high[0], 1, 1e-9);
        CHECK_NEAR(2 * high[1], cases[i].want, 1e-9);
        relume_capture_destroy(&capture);
        test_folder_remove(p.folder);
    }
    struct photos p;
    shoot(&p, name_rows);
    assert_int_equal(relume_slab_ingest(p.out, p.list, GRID,  // one row
                                        relume_slab_ingest_params(.names = "view_{row}_{column}",
                                                                  .baseline_v = 0.5),
                                        NULL),
                     RELUME_EINVAL);
    assert_int_equal(relume_slab_ingest(p.out, p.list, GRID * GRID,
                                        relume_slab_ingest_params(.baseline_v = -1), NULL),
                     RELUME_EINVAL);
    test_folder_remove(p.folder);
}

// Rows that count upwards contradict the parallax of columns.
static void test_rows_from_below(void **state)
{
    (void)state;
    struct photos p;
    struct test_log log;
    test_log_init(&log);
    shoot(&p, name_below);
    CHECK_OK(relume_slab_ingest(p.out, p.list, GRID * GRID, NULL,
                                relume_ingest_params(.log = &log.log)));
    assert_non_null(strstr(log.text, "rows run against the names"));
    check_places(&p);
    test_folder_remove(p.folder);
}

static void refuse(const struct photos *p, int n, const char *pattern, const char *why)
{
    struct test_log log;
    test_log_init(&log);
    assert_true(relume_status_is_input(
        relume_slab_ingest(p->out, p->list, n, relume_slab_ingest_params(.names = pattern),
                           relume_ingest_params(.log = &log.log))));
    if (!strstr(log.text, why))
        fail_msg("expected '%s' in '%s'", why, log.text);
    assert_int_not_equal(access(p->out, F_OK), 0);
}

static void test_bad_grids(void **state)
{
    (void)state;
    struct photos p;
    struct test_log log;
    test_log_init(&log);
    shoot(&p, name_rows);
    refuse(&p, GRID * GRID - 1, NULL, "row 4, column 4");
    refuse(&p, 1, NULL, "a single camera");
    refuse(&p, GRID * GRID, "x{row}_{column}", "does not match");
    refuse(&p, GRID * GRID, "view_{row}_*", "does not match");
    CHECK_OK(relume_slab_ingest(
        p.out, p.list, GRID * GRID - 1,
        relume_slab_ingest_params(.fill = true, .keep_order = true, .baseline_v = 1),
        relume_ingest_params(.log = &log.log)));
    assert_non_null(strstr(log.text, "filled by"));
    struct photos twice = p;
    snprintf(twice.out, sizeof twice.out, "%s/twice", p.folder);
    twice.list[4] = p.path[3];
    refuse(&twice, GRID * GRID, NULL, "expected one camera there");
    test_folder_remove(p.folder);
}

static double true_disparity(int x, int y, double u, double v)
{
    double st[2];
    middle_st(st, x, y, u, v, square);
    return in_square(st[0], st[1]) ? square : wall;
}

// The middle view, where all that it sees is seen by others: two depths, sharp to two pixels.
static void test_depth(void **state)
{
    (void)state;
    struct photos p;
    char with[128];
    relume_capture *capture;
    struct relume_image depth;
    shoot(&p, name_rows);
    snprintf(with, sizeof with, "%s/with", p.folder);
    CHECK_OK(relume_slab_ingest(p.out, p.list, GRID * GRID, NULL, NULL));
    CHECK_OK(relume_capture_open(&capture, p.out, NULL));
    struct relume_slab_depth_report report;
    CHECK_OK(relume_slab_depth(&report, capture, with, NULL));
    relume_capture_destroy(&capture);
    assert_true(report.trusted > 0.7);
    assert_int_equal(report.compared, 0);
    // Distances of the planes are 3 / (1 + q).
    assert_true(report.range[0] < 3.0 / (1.0 + square) && report.range[1] > 3.0 / (1.0 + wall));

    CHECK_OK(relume_capture_open(&capture, with, NULL));
    CHECK_OK(relume_capture_depth(&depth, capture, 4, NULL));
    int bad = 0;
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            const double s = (x + 0.5) / SIZE * 2.0 - 1.0, t = 1.0 - (y + 0.5) / SIZE * 2.0;
            const double whole = sqrt(s * s + t * t + 9.0);
            const double q = whole / (double)depth.data[y * SIZE + x] - 1.0;
            bad += fabs(q - true_disparity(x, y, 0.0, 0.0)) > report.plane_step;
        }
    // The rim of the square is 102 pixels long: off by two on either side at most.
    assert_true(bad < 4 * 102);
    relume_image_destroy(&depth);
    relume_capture_destroy(&capture);
    test_folder_remove(p.folder);
}

static void test_depth_refuses(void **state)
{
    (void)state;
    struct photos p;
    char planar[128];
    relume_capture *capture;
    struct relume_slab_depth_report report;
    shoot(&p, name_rows);
    CHECK_OK(relume_slab_ingest(p.out, p.list, GRID * GRID, NULL, NULL));
    CHECK_OK(relume_capture_open(&capture, p.out, NULL));
    snprintf(planar, sizeof planar, "%s/not", p.folder);
    assert_int_equal(
        relume_slab_depth(&report, capture, planar, relume_slab_depth_params(.range = {4.0, 2.0})),
        RELUME_EINVAL);
    assert_int_equal(
        relume_slab_depth(&report, capture, planar, relume_slab_depth_params(.planes = 4)),
        RELUME_EINVAL);
    assert_int_not_equal(access(planar, F_OK), 0);
    relume_capture_destroy(&capture);
    test_folder_remove(p.folder);
}

// ---------------------------------------------------------------- cameras held on their side

// A JPEG that is upright when turned as EXIF orientation 6 says: its row 0 is the right side.
static void save_on_side(const struct relume_image *upright, const char *path)
{
    struct relume_image side;
    struct exif_bytes exif;
    CHECK_OK(relume_image_create(&side, upright->height, upright->width, 3));
    for (int y = 0; y < upright->height; y++)
        for (int x = 0; x < upright->width; x++)
            memcpy(side.data + 3 * ((side.height - 1 - x) * side.width + y),
                   upright->data + 3 * (y * upright->width + x), 3 * sizeof(float));
    CHECK_OK(relume_image_save(&side, path, NULL));
    exif_make(&exif, 6);
    exif_insert(path, 0xe1, &exif);
    relume_image_destroy(&side);
}

// The right half is dark: RMS against what was photographed, JPEG's loss apart, is 0.01; turned
// wrongly it is more than 0.1.
static void check_upright(const char *folder, int view, const struct relume_image *upright)
{
    relume_capture *capture;
    struct relume_image image;
    double squares = 0.0;
    CHECK_OK(relume_capture_open(&capture, folder, NULL));
    CHECK_OK(relume_capture_image(&image, capture, view, 0, NULL));
    assert_int_equal(image.width, upright->width);
    assert_int_equal(image.height, upright->height);
    const int n = 3 * image.width * image.height;
    for (int i = 0; i < n; i++)
        squares += pow(image.data[i] - upright->data[i], 2.0) / n;
    CHECK_NEAR(sqrt(squares), 0.0, 0.04);
    relume_image_destroy(&image);
    relume_capture_destroy(&capture);
}

static void render_dim(struct relume_image *image, double u, double v, int height)
{
    struct relume_image whole;
    render(&whole, u, v);
    CHECK_OK(relume_image_create(image, SIZE, height, 3));
    for (int i = 0; i < 3 * SIZE * height; i++)
        image->data[i] = whole.data[i] * (i / 3 % SIZE < SIZE / 2 ? 1.0f : 0.3f);
    relume_image_destroy(&whole);
}

static void test_turned(void **state)
{
    (void)state;
    struct photos p;
    struct relume_image first, image;
    test_folder(p.folder);
    snprintf(p.out, sizeof p.out, "%s/out", p.folder);
    for (int i = 0; i < GRID * GRID; i++) {
        snprintf(p.path[i], sizeof p.path[i], "%s/v_%d_%d.jpg", p.folder, i / GRID, i % GRID);
        p.list[i] = p.path[i];
        render_dim(&image, camera_u(i % GRID), camera_v(i / GRID), SIZE - 16);
        save_on_side(&image, p.path[i]);
        if (i == 0)
            first = image;
        else
            relume_image_destroy(&image);
    }
    CHECK_OK(relume_slab_ingest(p.out, p.list, GRID * GRID, NULL, NULL));
    check_upright(p.out, 0, &first);
    CHECK_OK(relume_panorama_ingest(p.out, p.list, 1, RELUME_PANORAMA_CYLINDER, NULL,
                                    relume_ingest_params(.force = true)));
    check_upright(p.out, 0, &first);
    relume_image_destroy(&first);
    test_folder_remove(p.folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_turned),
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_grids_that_are_not_square),
        cmocka_unit_test(test_rows_from_below),
        cmocka_unit_test(test_bad_grids),
        cmocka_unit_test(test_depth),
        cmocka_unit_test(test_depth_refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
