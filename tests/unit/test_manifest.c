// test_manifest.c - tests of src/capture/manifest/manifest.h: reading what describes a capture into
// one form; images are not touched here
#include "test.h"

#include "capture/manifest/manifest.h"

static char folder[64], path[96];

static int setup(void **state)
{
    (void)state;
    test_folder(folder);
    snprintf(path, sizeof path, "%s/capture.json", folder);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

static void test_round_trip(void **state)
{
    (void)state;
    const struct relume_vec3 directions[2] = {{0, 0, 1}, {0.6, -0.8, 0}};
    const struct relume_vec3 positions[2] = {{0, 0, 5}, {6, -8, 0}};
    const float intensities[2][3] = {{1, 2, 0.5f}, {0.125f, 3, 1}};
    const char *images[2] = {"a \"b\".exr", "c/\xc3\xa9\\.png"};
    for (int p = RELUME_PLANAR; p <= RELUME_CUBE; p++) {
        const struct relume_manifest_view view = {
            .uv = {0.25, -0.5}, .images = images, .depth = "d.exr", .mask = p ? "m.png" : NULL};
        struct relume_manifest m = {.transfer = {.curve = RELUME_CURVE_GAMMA, .gamma = 2.2f},
                                    .geometry =
                                        relume_geometry_default((enum relume_projection)p, 4, 3),
                                    .lights = 2,
                                    .directions = directions,
                                    .positions = p % 2 ? positions : NULL,
                                    .intensities = p > 1 ? intensities : NULL,
                                    .intensities_at_origin = p % 2 != 0,
                                    .views = 1,
                                    .view = &view};
        m.geometry.perspective = true;
        m.geometry.camera_z = 7.5;
        m.geometry.uv_z = 2.5;
        m.geometry.v_max = 1.25;
        m.geometry.center = (struct relume_vec3){1, 2, 3};
        CHECK_OK(relume_manifest_write(&m, path, NULL));
        struct draft d;
        CHECK_OK(manifest_read(&d, path, relume_capture_params(.log = NULL)));
        assert_int_equal(d.m.geometry.projection, p);
        assert_int_equal(d.m.transfer.curve, RELUME_CURVE_GAMMA);
        CHECK_NEAR(d.m.transfer.gamma, 2.2, 1e-6);
        assert_int_equal(d.m.lights, 2);
        for (int i = 0; i < 2; i++) {  // written with nine digits
            CHECK_NEAR(d.m.directions[i].x, directions[i].x, 1e-9);
            CHECK_NEAR(d.m.directions[i].y, directions[i].y, 1e-9);
            if (p % 2)
                CHECK_NEAR(d.m.positions[i].y, positions[i].y, 1e-8);
            for (int c = 0; c < 3 && p > 1; c++)
                CHECK_NEAR(d.m.intensities[i][c], intensities[i][c], 0.0);
            char want[256];
            snprintf(want, sizeof want, "%s/%s", folder, images[i]);
            assert_string_equal(d.m.view[0].images[i], want);
        }
        assert_true((d.m.positions != NULL) == p % 2 && (d.m.intensities != NULL) == (p > 1));
        assert_true(d.m.intensities_at_origin == (p % 2 != 0));
        assert_true((d.m.view[0].mask != NULL) == (p > 0));
        assert_non_null(d.m.view[0].depth);
        const struct relume_geometry *g = &d.m.geometry;
        if (p == RELUME_PLANAR) {
            assert_true(g->perspective && d.has_window);
            CHECK_NEAR(g->camera_z, 7.5, 0.0);
            CHECK_NEAR(g->window_max[1], 0.75, 0.0);
        } else if (p == RELUME_SLAB) {
            CHECK_NEAR(g->uv_z, 2.5, 0.0);
            CHECK_NEAR(d.m.view[0].uv[1], -0.5, 0.0);
        } else {
            CHECK_NEAR(g->v_max, 1.25, 0.0);
            CHECK_NEAR(g->center.z, 3.0, 0.0);
        }
        draft_free(&d);
    }
}

// A whole manifest with one place to break.
static const char *const frame =
    "{\"format\": \"relume-capture\", \"version\": 1, %s\"lights\": {\"directions\": [[0,0,1],"
    "[1,0,0]]%s}, \"views\": [{\"images\": [\"a\", \"b\"]%s}]%s}";

static void expect(const char *a, const char *b, const char *c, const char *d, const char *said)
{
    char text[2048];
    struct draft draft;
    struct test_log log;
    test_log_init(&log);
    snprintf(text, sizeof text, frame, a, b, c, d);
    test_write(path, text, strlen(text));
    const relume_status status =
        manifest_read(&draft, path, relume_capture_params(.log = &log.log));
    if (!said) {
        assert_string_equal(log.text, "");
        CHECK_OK(status);
        draft_free(&draft);
        return;
    }
    if (!relume_status_is_input(status) || log.lines != 1 || !strstr(log.text, said) ||
        !strstr(log.text, path))
        fail_msg("%s: status %d, '%s'; expected '%s'", text, status, log.text, said);
    assert_null(draft.view);
}

static void test_bad(void **state)
{
    (void)state;
    expect("", "", "", "", NULL);
    expect("\"transfer\": null, ", ", \"intensities\": null", ", \"depth\": null", "", NULL);
    expect("\"transfer\": \"log\", ", "", "", "", "transfer");
    expect("\"transfer\": 3, ", "", "", "", "transfer");
    expect("\"projection\": \"fisheye\", ", "", "", "", "projection");
    expect("\"projection\": 1, ", "", "", "", "projection");
    expect("\"projection\": \"slab\", ", "", "", "", "slab");
    expect("\"projection\": \"slab\", \"slab\": {}, ", "", "", "", "uv");
    expect("\"projection\": \"slab\", \"slab\": {\"uv_plane_z\": 0}, ", "", "", "",
           "two different");
    expect("\"window\": {\"min\": [1, 1], \"max\": [0, 0]}, ", "", "", "", "below");
    expect("\"window\": {\"min\": [1]}, ", "", "", "", "min; expected 2 numbers");
    expect("\"window\": {\"camera\": \"fish\"}, ", "", "", "", "camera");
    expect("\"panorama\": {\"v_min\": 3}, ", "", "", "", "v_min");
    expect("\"panorama\": {\"center\": [1, 2]}, ", "", "", "", "center");
    expect("\"panorama\": {\"discs\": 8}, ", "", "", "", "none but of a cylinder");
    expect("\"projection\": \"cylindrical\", \"panorama\": {\"discs\": 8}, ", "", "", "", NULL);
    expect("\"projection\": \"cylindrical\", \"panorama\": {\"discs\": true}, ", "", "", "",
           "panorama.discs");
    expect("\"projection\": \"cylindrical\", \"panorama\": {\"discs\": -1}, ", "", "", "",
           "panorama.discs");
    expect("\"projection\": \"cylindrical\", \"panorama\": {\"v_min\": 0, \"discs\": 8}, ", "", "",
           "", "v_min below 0");
    expect("\"version\": 1, ", "", "", "", "JSON");
    expect("", ", \"positions\": [[0,0,1]]", "", "", "as many positions");
    expect("", ", \"positions\": [[0,0,1],[0,0,\"x\"]]", "", "", "positions[1]");
    expect("", ", \"intensities_at\": \"sun\"", "", "", "intensities_at; expected lamp or origin");
    expect("", ", \"intensities\": [[1,1,1]]", "", "", "intensities");
    expect("", ", \"intensities\": [[1,1,1],[0,1,1]]", "", "", "intensities");
    expect("", ", \"intensities\": [[1,1,1],[1,-1,1]]", "", "", "intensities");
    expect("", ", \"intensities\": [[1,1,1],[1,1e-60,1]]", "", "", "intensities");
    expect("", ", \"intensities\": [[1,1,1],[1,1]]", "", "", "intensities");
    expect("", "", ", \"mask\": 3", "", "mask");
    expect("", "", ", \"depth\": \"\"", "", "depth");
    expect("", "", ", \"uv\": [1]", "", "uv");
    expect("", "", "", ", ", "JSON");
    expect("", "", "}, {\"images\": [\"a\"]", "", "expected 2 images for 2 lights, found 1");
    expect("", "", "}, {\"images\": [\"a\", 3]", "", "views[1].images");
    expect("", "", "}, {\"images\": \"a\"", "", "views[1].images");
    expect("", "", "}, {", "", "views[1].images");
}

static void test_directions(void **state)
{
    (void)state;
    static const struct {
        const char *text, *said;
    } rows[] = {
        {"{\"format\": \"relume-capture\", \"version\": 1}", "lights"},
        {"{\"format\": \"relume-capture\", \"version\": 2}", "newer"},
        {"{\"format\": \"relume-capture\", \"version\": 0}", "version"},
        {"{\"format\": \"relume-capture\", \"version\": \"1\"}", "version"},
        {"{\"format\": \"other\", \"version\": 1}", "relume-capture"},
        {"[]", "format"},
        {"3", "JSON"},
        {"", "an empty file, no capture"},
        {"{\"format\": \"relume-capture\", \"version\": 1, \"lights\": {\"directions\": []}}",
         "directions"},
        {"{\"format\": \"relume-capture\", \"version\": 1, \"lights\": {\"directions\": "
         "[[0,0,1],[0,0,0]]}}",
         "directions[1]; expected a direction; found a zero"},
        {"{\"format\": \"relume-capture\", \"version\": 1, \"lights\": {\"directions\": "
         "[[0,0,1],[0,0]]}}",
         "directions[1]; expected three finite numbers"},
        {"{\"format\": \"relume-capture\", \"version\": 1, \"lights\": {\"directions\": "
         "[[0,0,NaN]]}}",
         "JSON"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct draft d;
        struct test_log log;
        test_log_init(&log);
        test_write(path, rows[i].text, strlen(rows[i].text));
        assert_true(relume_status_is_input(
            manifest_read(&d, path, relume_capture_params(.log = &log.log))));
        if (log.lines != 1 || !strstr(log.text, rows[i].said) || !strstr(log.text, path))
            fail_msg("%s: '%s'; expected '%s'", rows[i].text, log.text, rows[i].said);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_bad),
        cmocka_unit_test(test_directions),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
