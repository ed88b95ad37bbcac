// Slabs with poses in a manifest and in a file: what goes in comes out, what is wrong is refused
#include "test.h"

#include "capture/manifest/manifest.h"
#include "format/coder/coding.h"
#include "format/pack/pack_write.h"
#include "image/geometry/geometry.h"
#include "relight/view/view.h"
#include "capture_fixture.h"

static char folder[64], path[96], json[96];

static int setup(void **state)
{
    (void)state;
    test_folder(folder);
    snprintf(path, sizeof path, "%s/pack.exr", folder);
    snprintf(json, sizeof json, "%s/capture.json", folder);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

// ---------------------------------------------------------------- poses

// 3-4-5 triangles twice: exact in decimals.
static const struct relume_pose turned = {{0.5, -2, 1},
                                          {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}};

static void poses_go_there_and_back(void **state)
{
    (void)state;
    struct relume_pose pose = turned, world = {0};
    assert_true(relume_pose_normalise(&pose));
    const vec3 p = {0.25, -1.5, 2};
    const vec3 q = relume_pose_world(&pose, p);
    CHECK_NEAR(q.x, 0.5 + 0.36 * 0.25 + 0.8 * 1.5 + 0.48 * 2, 1e-12);
    CHECK_NEAR(q.y, -2 + 0.48 * 0.25 - 0.6 * 1.5 + 0.64 * 2, 1e-12);
    CHECK_NEAR(q.z, 1 - 0.8 * 0.25 + 0.6 * 2, 1e-12);
    const vec3 back = relume_pose_local(&pose, q), turn = relume_pose_turn(&pose, p);
    CHECK_NEAR(back.x, p.x, 1e-12);
    CHECK_NEAR(back.y, p.y, 1e-12);
    CHECK_NEAR(back.z, p.z, 1e-12);
    CHECK_NEAR(relume_pose_turn_back(&pose, turn).y, p.y, 1e-12);
    // all zero is the world, before it is normalised and after
    CHECK_NEAR(relume_pose_world(&world, p).y, p.y, 0);
    assert_true(relume_pose_normalise(&world));
    CHECK_NEAR(world.axis[1].y, 1, 0);
    CHECK_NEAR(relume_pose_local(&world, p).z, p.z, 0);
}

static void only_rotations_are_poses(void **state)
{
    (void)state;
    const struct relume_pose wrong[] = {
        {.axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}},    // a mirror
        {.axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1.01}}},  // too long
        {.axis = {{1, 0, 0}, {0.01, 1, 0}, {0, 0, 1}}},  // askew
        {.axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 0}}},     // flat
        {.axis = {{(double)NAN, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {.origin = {(double)INFINITY, 0, 0}},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct relume_pose pose = wrong[i];
        assert_false(relume_pose_normalise(&pose));
    }
    struct relume_pose nearly = {.axis = {{1, 0.0004, 0}, {0, 1, 0}, {0, 0, 0.9995}}};
    assert_true(relume_pose_normalise(&nearly));
    const vec3 *a = nearly.axis;
    CHECK_NEAR(a[0].x * a[0].x + a[0].y * a[0].y + a[0].z * a[0].z, 1, 1e-15);
    CHECK_NEAR(a[0].x * a[1].x + a[0].y * a[1].y + a[0].z * a[1].z, 0, 1e-15);
}

// ---------------------------------------------------------------- manifest

static void write_json(const char *slabs, const char *views)
{
    FILE *f = fopen(json, "w");
    assert_non_null(f);
    fprintf(f,
            "{\"format\": \"relume-capture\", \"version\": 1, \"projection\": \"slab\", %s,"
            "\"lights\": {\"directions\": [[0, 0, 1]]}, \"views\": [%s]}",
            slabs, views);
    fclose(f);
}

#define VIEW(slab)    "{\"uv\": [0, 0], " slab "\"images\": [\"a.exr\"]}"
#define AXES(x, y, z) "\"slabs\": [{\"axes\": [" x ", " y ", " z "]}]"

static void wrong_manifests_are_refused(void **state)
{
    (void)state;
    char many[65 * 4 + 32] = "\"slabs\": [";
    for (int i = 0; i < 65; i++)
        strcat(many, i ? ", {}" : "{}");
    strcat(many, "]");
    const struct {
        const char *slabs, *views, *says;
    } wrong[] = {
        {"\"slabs\": []", VIEW("\"slab\": 0, "), "slabs"},
        {many, VIEW("\"slab\": 0, "), "1 to 64"},
        {"\"slabs\": [{}], \"slab\": {}", VIEW("\"slab\": 0, "), "one of them"},
        {"\"slabs\": [{}, {}]", VIEW("\"slab\": 0, "), "slabs[1]"},
        {"\"slabs\": [{}]", VIEW(""), "views[0].slab"},
        {"\"slabs\": [{}]", VIEW("\"slab\": 1, "), "0 to 0"},
        {"\"slabs\": [{}]", VIEW("\"slab\": -1, "), "views[0].slab"},
        {"\"slabs\": [{}]", VIEW("\"slab\": \"0\", "), "views[0].slab"},
        {AXES("[1,0,0]", "[0,1,0]", "[0,0,-1]"), VIEW("\"slab\": 0, "), "rotation"},
        {AXES("[1,0,0]", "[0,1,0]", "[0,0]"), VIEW("\"slab\": 0, "), "three vectors"},
        {"\"slabs\": [{\"axes\": [[1,0,0]]}]", VIEW("\"slab\": 0, "), "three vectors"},
        {"\"slabs\": [{\"origin\": 3}]", VIEW("\"slab\": 0, "), "origin"},
        {"\"slabs\": [{\"uv_plane_z\": 0}]", VIEW("\"slab\": 0, "), "two different planes"},
        {"\"slabs\": [{\"st_min\": [2, 0]}]", VIEW("\"slab\": 0, "), "min below max"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct test_log log;
        struct draft d;
        test_log_init(&log);
        write_json(wrong[i].slabs, wrong[i].views);
        assert_int_equal(manifest_read(&d, json, relume_capture_params(.log = &log.log)),
                         RELUME_EFORMAT);
        if (log.lines != 1 || !strstr(log.text, wrong[i].says))
            fail_msg("%zu says '%s'; expected '%s'", i, log.text, wrong[i].says);
    }
}

// ---------------------------------------------------------------- file

enum { SLABS = 2, VIEWS = 3 };

static void make_slabs(struct relume_geometry slab[SLABS])
{
    slab[0] = slab[1] = relume_geometry_default(RELUME_SLAB, 4, 4);
    slab[1].pose = turned;
    slab[1].uv_z = 2.5;
    slab[1].st_max[1] = 1.5;
    for (int i = 0; i < SLABS; i++)
        assert_true(relume_pose_normalise(&slab[i].pose));
}

// The fixture's slab of three views becomes two slabs; the last two views are of the second.
static relume_capture *capture_slabs(void)
{
    const struct fixture f = {.width = 6, .height = 4, .lights = 9, .views = VIEWS, .depth = true};
    struct relume_geometry slab[SLABS];
    struct relume_manifest_view view[VIEWS];
    relume_capture *capture;
    fixture_write(&f, folder);
    make_slabs(slab);
    CHECK_OK(relume_capture_open(&capture, folder, NULL));
    struct relume_manifest m = *relume_capture_manifest(capture);
    for (int i = 0; i < VIEWS; i++) {
        view[i] = m.view[i];
        view[i].slab = i > 0;
    }
    m.view = view;
    m.slabs = SLABS;
    m.slab = slab;
    CHECK_OK(relume_manifest_write(&m, json, NULL));
    relume_capture_destroy(&capture);
    CHECK_OK(relume_capture_open(&capture, folder, relume_capture_params(.allow_outside = true)));
    return capture;
}

static void check_slabs(const struct relume_geometry *slab, double tolerance)
{
    const vec3 p = {0.3, -0.7, 1.1};
    struct relume_geometry want[SLABS];
    make_slabs(want);
    for (int i = 0; i < SLABS; i++) {
        const vec3 a = relume_pose_world(&slab[i].pose, p), b = relume_pose_world(&want[i].pose, p);
        CHECK_NEAR(a.x, b.x, tolerance);
        CHECK_NEAR(a.y, b.y, tolerance);
        CHECK_NEAR(a.z, b.z, tolerance);
        CHECK_NEAR(slab[i].uv_z, want[i].uv_z, 0);
        CHECK_NEAR(slab[i].st_max[1], want[i].st_max[1], 0);
        assert_int_equal(slab[i].projection, RELUME_SLAB);
    }
}

static void slabs_go_into_a_file(void **state)
{
    (void)state;
    relume_capture *capture = capture_slabs();
    const struct relume_manifest *m = relume_capture_manifest(capture);
    assert_int_equal(m->slabs, SLABS);
    assert_int_equal(m->view[0].slab, 0);
    assert_int_equal(m->view[2].slab, 1);
    assert_true(relume_capture_pole_y(capture));
    check_slabs(m->slab, 1e-8);  // written with nine digits
    CHECK_OK(fixture_encode(folder, path, &relume_basis_sh, 4, NULL));
    relume_pack *pack;
    CHECK_OK(relume_pack_open(&pack, path, NULL));
    const struct relume_pack_info *info = relume_pack_info(pack);
    assert_int_equal(info->version, 2);
    assert_int_equal(info->slabs, SLABS);
    assert_true(relume_coder_info(info->coder)->pole_y);
    check_slabs(info->slab, 5e-7);  // single precision
    for (int i = 0; i < VIEWS; i++) {
        assert_int_equal(info->slab_of[i], i > 0);
        assert_ptr_equal(relume_pack_geometry(pack, i), &info->slab[i > 0]);
        CHECK_NEAR(info->uv[i][0], i, 0);
    }
    relume_pack_destroy(&pack);
    relume_capture_destroy(&capture);
}

// What a pixel of a turned slab sees lies where a point of the slab lies.
static void surfaces_are_in_the_world(void **state)
{
    (void)state;
    struct relume_geometry slab[SLABS];
    struct relume_image depth, there, here;
    const double uv[2] = {0.2, -0.1};
    make_slabs(slab);
    CHECK_OK(relume_image_create(&depth, 3, 2, 1));
    for (int i = 0; i < 6; i++)
        depth.data[i] = (float)(1 + 0.3 * i);
    CHECK_OK(relume_view_positions(&there, &slab[1], uv, &depth, 3, 2));
    const struct relume_pose pose = slab[1].pose;
    slab[1].pose = (struct relume_pose){0};
    CHECK_OK(relume_view_positions(&here, &slab[1], uv, &depth, 3, 2));
    for (int i = 0; i < 6; i++) {
        const float *p = here.data + 3 * i, *q = there.data + 3 * i;
        const vec3 want =
            relume_pose_world(&pose, (vec3){(double)p[0], (double)p[1], (double)p[2]});
        CHECK_NEAR(q[0], want.x, 1e-6);
        CHECK_NEAR(q[1], want.y, 1e-6);
        CHECK_NEAR(q[2], want.z, 1e-6);
    }
    relume_image_destroy(&depth);
    relume_image_destroy(&there);
    relume_image_destroy(&here);
}

static void spoil(struct relume_pack_contents *c, struct relume_geometry *slab,
                  struct relume_pack_view *view, int how)
{
    switch (how) {
    case 0: slab[1].pose.axis[0].x = -slab[1].pose.axis[0].x; break;
    case 1: slab[1].pose.origin.y = (double)INFINITY; break;
    case 2: slab[1].uv_z = slab[1].st_z; break;
    case 3: slab[0].st_max[0] = slab[0].st_min[0]; break;
    case 4: view[2].slab = SLABS; break;
    case 5: view[2].slab = -1; break;
    case 6: view[0].slab = 1; break;  // slab 0 has none
    case 7: c->slabs = RELUME_MOST_SLABS + 1; break;
    }
}

static void wrong_files_are_refused(void **state)
{
    (void)state;
    enum { WAYS = 8 };
    relume_capture *capture = capture_slabs();
    relume_coder *coder;
    relume_coefficients *coefficients[VIEWS];
    CHECK_OK(relume_coder_learn(&coder, &relume_basis_sh, capture,
                                relume_coder_params(.coefficients = 4), NULL));
    for (int i = 0; i < VIEWS; i++)
        CHECK_OK(relume_project(&coefficients[i], coder, capture, i,
                                relume_project_params(.scratch = path)));
    for (int how = 0; how <= WAYS; how++) {
        struct relume_geometry slab[RELUME_MOST_SLABS + 1];
        struct relume_pack_view view[VIEWS] = {{0}};
        make_slabs(slab);
        for (int i = SLABS; i <= RELUME_MOST_SLABS; i++)
            slab[i] = slab[0];
        for (int i = 0; i < VIEWS; i++) {
            view[i].coefficients = coefficients[i];
            view[i].uv[0] = i;
            view[i].slab = i > 0;
        }
        struct relume_pack_contents contents = {.coder = coder,
                                                .domain = RELUME_DOMAIN_LINEAR,
                                                .display = {.curve = RELUME_CURVE_SRGB},
                                                .slabs = SLABS,
                                                .slab = slab,
                                                .views = VIEWS,
                                                .view = view};
        relume_pack *pack;
        struct test_log log;
        test_log_init(&log);
        spoil(&contents, slab, view, how);
        contents.geometry = slab[0];
        CHECK_OK(relume_pack_write(&contents, path, NULL));
        const relume_status status =
            relume_pack_open(&pack, path, relume_pack_params(.log = &log.log));
        if (status != (how < WAYS ? RELUME_EDAMAGED : RELUME_OK) || log.lines != (how < WAYS))
            fail_msg("way %d: %s, '%s'", how, relume_status_text(status), log.text);
        relume_pack_destroy(&pack);
    }
    for (int i = 0; i < VIEWS; i++)
        relume_coefficients_destroy(&coefficients[i]);
    relume_coder_destroy(&coder);
    relume_capture_destroy(&capture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(poses_go_there_and_back),     cmocka_unit_test(only_rotations_are_poses),
        cmocka_unit_test(wrong_manifests_are_refused), cmocka_unit_test(slabs_go_into_a_file),
        cmocka_unit_test(surfaces_are_in_the_world),   cmocka_unit_test(wrong_files_are_refused),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
