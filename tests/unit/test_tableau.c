// Scene files: what hides what, whose shadow falls where, poses, near and far, bad input.
#include "capture_fixture.h"
#include "in_folder.h"
#include "world/stage/scene.h"

#include "relight/light/environment.h"
#include "world/stage/shapes.h"
#include "world/tableau/which.h"

#include <relume/exchange.h>
#include <sys/stat.h>

#define HEAD "{\"format\":\"relume-scene\",\"version\":1,"

static relume_tableau *open_scene(const char *text)
{
    relume_tableau *t;
    write_text("scene.json", text);
    assert_true(relume_kind_of(path_of("scene.json")) == RELUME_KIND_SCENE);
    CHECK_OK(relume_tableau_open(&t, path_of("scene.json"), NULL));
    return t;
}

static struct relume_image frame_of(relume_tableau *t, const struct relume_camera *camera,
                                    const struct relume_light *light)
{
    struct relume_image image;
    CHECK_OK(relume_tableau_frame(&image, t, camera, light, 1, NULL));
    return image;
}

static int which_at(relume_tableau *t, const struct relume_camera *camera, int x, int y)
{
    struct relume_image which;
    CHECK_OK(relume_tableau_which(&which, t, camera));
    const int found = (int)which.data[y * which.width + x];
    relume_image_destroy(&which);
    return found;
}

// ---------------------------------------------------------------- planes

// White matte squares from -1 to 1, seen straight from above; four lights, one of them slanted.
static const struct relume_vec3 lamps[4] = {
    {0, 0, 1}, {0.70710678, 0, 0.70710678}, {0, 0.70710678, 0.70710678}, {-0.6, 0, 0.8}};
enum { SIDE = 16 };

static void encode_folder(const char *name)
{
    char file[64];
    snprintf(file, sizeof file, "%s.exr", name);
    CHECK_OK(fixture_encode(path_of(name), path_of(file), &relume_basis_table, 0,
                            relume_pack_encode_params(.storage = RELUME_STORE_FLOAT)));
}

static void write_plane(const char *name, float value)
{
    char file[64];
    struct relume_image image;
    mkdir(path_of(name), 0777);
    CHECK_OK(relume_image_create(&image, SIDE, SIDE, 3));
    for (int l = 0; l < 4; l++) {
        for (int i = 0; i < SIDE * SIDE * 3; i++)
            image.data[i] = value * (float)lamps[l].z;
        snprintf(file, sizeof file, "%.32s/%d.exr", name, l);
        CHECK_OK(relume_image_save(&image, path_of(file), NULL));
    }
    relume_image_destroy(&image);
    snprintf(file, sizeof file, "%s/capture.json", name);
    write_text(file, "{\"format\":\"relume-capture\",\"version\":1,\"projection\":\"planar\","
                     "\"transfer\":\"linear\",\"lights\":{\"directions\":[[0,0,1],"
                     "[0.70710678,0,0.70710678],[0,0.70710678,0.70710678],[-0.6,0,0.8]]},"
                     "\"views\":[{\"images\":[\"0.exr\",\"1.exr\",\"2.exr\",\"3.exr\"]}]}");
    encode_folder(name);
}

// From 4 above; a pixel is a fifteenth of a unit on z = 0.
static const struct relume_camera above = {.framing = RELUME_FRAME_EYE,
                                           .eye = {0, 0, 4},
                                           .look_at = {true, {0, 0, 0}, {0, 1, 0}, 28.0725},
                                           .width = 30,
                                           .height = 30};

static float at(const struct relume_image *image, double x, double y)
{
    const int column = (int)floor(15.0 + 15.0 * x), row = (int)floor(15.0 - 15.0 * y);
    return image->data[3 * (row * image->width + column)];
}

#define TWO_PLANES                                                                                 \
    HEAD "\"captures\":[{\"file\":\"grey.exr\"},{\"file\":\"white.exr\",\"name\":\"upper\","       \
         "\"pose\":{\"scale\":0.25,\"translate\":[0,0,1]}}]}"

// The light comes from x = z: the upper square, of half side 0.25 at z = 1, throws its shadow on
// -1.25 < x < -0.75.
static void captures_hide_and_shade_each_other(void **state)
{
    (void)state;
    write_plane("grey", 0.5f);
    write_plane("white", 1.0f);
    relume_tableau *t = open_scene(TWO_PLANES);
    const struct relume_light slanted = {.direction = lamps[1], .rgb = {1, 1, 1}};
    struct relume_image got = frame_of(t, &above, &slanted);
    const double cosine = lamps[1].z;
    CHECK_NEAR(at(&got, 0.02, 0.02), cosine, 1e-5);
    CHECK_NEAR(at(&got, 0.7, 0.7), 0.5 * cosine, 1e-5);
    CHECK_NEAR(at(&got, -0.9, 0.02), 0.0, 1e-5);
    CHECK_NEAR(at(&got, -0.9, 0.3), 0.5 * cosine, 1e-5);
    CHECK_NEAR(at(&got, -0.65, 0.02), 0.5 * cosine, 1e-5);
    assert_int_equal(which_at(t, &above, 15, 15), 1);
    assert_int_equal(which_at(t, &above, 2, 2), 0);
    relume_image_destroy(&got);
    const struct relume_light straight = {.direction = {0, 0, 1}, .rgb = {1, 1, 1}};
    got = frame_of(t, &above, &straight);  // another lamp, the same eye
    CHECK_NEAR(at(&got, 0.02, 0.02), 1.0, 1e-5);
    CHECK_NEAR(at(&got, 0.7, 0.7), 0.5, 1e-5);
    relume_image_destroy(&got);
    relume_tableau_destroy(&t);
}

// A lamp of value 1 shows 1 on a white surface a unit away, also on one that is made smaller.
static void near_lamps_keep_their_strength(void **state)
{
    (void)state;
    relume_tableau *t = open_scene(TWO_PLANES);
    const struct relume_light lamp = {
        .kind = RELUME_LIGHT_POINT, .position = {0, 0, 3}, .rgb = {1, 1, 1}};
    struct relume_image got = frame_of(t, &above, &lamp);
    const double slant = 9.0 / (9.0 + 2.0 * 0.7 * 0.7);  // squared cosine at (0.7, 0.7, 0)
    CHECK_NEAR(at(&got, 0.02, 0.02), 1.0 / 4.0, 2e-3);
    CHECK_NEAR(at(&got, 0.7, 0.7), 0.5 / 9.0 * pow(slant, 1.5), 2e-3);
    relume_image_destroy(&got);
    relume_tableau_destroy(&t);
}

// ---------------------------------------------------------------- poses

static void photograph(const char *kind, const char *name, int size, int columns)
{
    relume_scene *scene;
    CHECK_OK(relume_scene_create(&scene, relume_scene_find(kind), NULL));
    CHECK_OK(
        relume_scene_capture(scene, path_of(name),
                             relume_synth_params(.size = size, .grid = {columns, columns},
                                                 .lights = lamps, .light_count = 4, .samples = 4)));
    relume_scene_destroy(&scene);
    encode_folder(name);
}

// Turned by 90 degrees about y: +x becomes -z, +z becomes +x.
static vec3 turned(vec3 v)
{
    return vec3_of(v.z, v.y, -v.x);
}

static vec3 placed(vec3 v)
{
    return vec3_add(vec3_scale(turned(v), 0.5), vec3_of(3, -1, 2));
}

// A slab that is turned, made smaller and moved looks the same to an eye and a light that are, too.
static void poses_move_captures(void **state)
{
    (void)state;
    photograph("teapot", "slab", 40, 2);
    relume_tableau *t = open_scene(
        HEAD "\"captures\":[{\"file\":\"grey.exr\"},{\"file\":\"slab.exr\",\"pose\":{\"scale\":0.5,"
             "\"rotate\":[0,1,0,90],\"translate\":[3,-1,2]}}]}");
    const struct relume_camera own = {.framing = RELUME_FRAME_EYE,
                                      .eye = {0.1, 0.2, 3},
                                      .look_at = {true, {0, 0, 0}, {0, 1, 0}, 50.0},
                                      .width = 48,
                                      .height = 32};
    struct relume_camera moved = own;
    moved.eye = placed(own.eye);
    moved.look_at.at = placed(own.look_at.at);
    const struct relume_light light = {.direction = lamps[1], .rgb = {1, 1, 1}},
                              also = {.direction = turned(lamps[1]), .rgb = {1, 1, 1}};
    relume_pack *pack;
    struct relume_image want, got = frame_of(t, &moved, &also), which;
    CHECK_OK(relume_pack_open(&pack, path_of("slab.exr"), NULL));
    CHECK_OK(relume_frame(&want, pack, &own, &light, 1, NULL));
    CHECK_OK(relume_tableau_which(&which, t, &moved));
    int seen = 0;
    for (int i = 0; i < 48 * 32; i++) {
        if (which.data[i] != 1.0f)
            continue;
        seen++;
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(got.data[3 * i + c], want.data[3 * i + c], 1e-4);
    }
    assert_true(seen > 300);
    relume_image_destroy(&want);
    relume_image_destroy(&got);
    relume_image_destroy(&which);
    relume_pack_destroy(&pack);
    relume_tableau_destroy(&t);
}

// From its middle a panorama is what `relume relight --pan` shows.
static void panoramas_are_seen_from_inside(void **state)
{
    (void)state;
    photograph("attic", "room", 64, 1);
    relume_tableau *t = open_scene(HEAD "\"captures\":[{\"file\":\"room.exr\"}],\"size\":[64,64]}");
    const struct relume_light light = {.direction = lamps[2], .rgb = {1, 1, 1}};
    const struct relume_camera look = {
        .framing = RELUME_FRAME_LOOK, .look = {.zoom = 1.0}, .width = 64, .height = 64};
    relume_pack *pack;
    struct relume_image want, got = frame_of(t, NULL, &light);
    double sum = 0.0, all = 0.0;
    CHECK_OK(relume_pack_open(&pack, path_of("room.exr"), NULL));
    CHECK_OK(relume_frame(&want, pack, &look, &light, 1, NULL));
    for (int i = 0; i < 64 * 64 * 3; i++) {
        sum += fabs((double)got.data[i] - (double)want.data[i]);
        all += (double)want.data[i];
    }
    // one is a bilinear value, the other a mean over the pixel; gaps of the mesh are black
    assert_true(all > 0.0 && sum < 0.05 * all);
    relume_image_destroy(&want);
    relume_image_destroy(&got);
    relume_pack_destroy(&pack);
    relume_tableau_destroy(&t);
}

// ---------------------------------------------------------------- near and far

static void write_ball(void)
{
    struct mesh m = {0};
    shape_sphere(&m, vec3_of(0, 0, 0), 1.0, 32);
    FILE *file = fopen(path_of("ball.obj"), "w");
    for (size_t i = 0; i < m.vertex_count; i++) {
        const float *p = m.vertices[i].position;
        fprintf(file, "v %.9g %.9g %.9g\n", (double)p[0], (double)p[1], (double)p[2]);
    }
    for (size_t i = 0; i < m.triangle_count; i++) {
        const uint32_t *v = m.triangles[i].vertex;
        fprintf(file, "f %u %u %u\n", v[0] + 1, v[1] + 1, v[2] + 1);
    }
    fclose(file);
    mesh_free(&m);
}

#define BALL                                                                                       \
    "\"objects\":[{\"mesh\":\"ball.obj\",\"name\":\"ball\",\"pose\":{\"scale\":0.5},\"parts\":[{"  \
    "\"material\":{\"diffuse\":0.5}}]}]"

// A ball of some 2000 triangles gives way to a picture where they are less than a pixel.
static void meshes_give_way_to_captures(void **state)
{
    (void)state;
    write_ball();
    relume_tableau *t = open_scene(
        HEAD "\"captures\":[{\"file\":\"grey.exr\"},{\"file\":\"white.exr\",\"pose\":{\"scale\":"
             "0.5},\"instead_of\":\"ball\"}]," BALL "}");
    struct relume_camera near = above, far = above;
    near.width = near.height = 300;
    far.eye.z = 60;
    assert_int_equal(relume_tableau_info(t)->entity[1].instead_of, 2);
    assert_int_equal(which_at(t, &near, 150, 150), 2);
    far.look_at.field_of_view_deg = 4.0;
    assert_int_not_equal(which_at(t, &far, 15, 15), 2);
    assert_int_equal(which_at(t, &near, 150, 150), 2);
    // the mesh is gone when it is read again: that is said each time
    struct relume_image unused;
    assert_int_not_equal(which_at(t, &far, 15, 15), 2);
    CHECK_OK(rename(path_of("ball.obj"), path_of("away.obj")));
    for (int i = 0; i < 2; i++)
        assert_true(relume_status_is_input(relume_tableau_which(&unused, t, &near)));
    CHECK_OK(rename(path_of("away.obj"), path_of("ball.obj")));
    assert_int_equal(which_at(t, &near, 150, 150), 2);
    relume_tableau_destroy(&t);
}

// White in even light, with transport, nothing is to be seen of it.
static void light_goes_between_them(void **state)
{
    (void)state;
    enum { ROWS = 16, COLUMNS = 2 * ROWS };
    struct relume_image image, distance;
    mkdir(path_of("even"), 0777);
    CHECK_OK(relume_image_create(&image, COLUMNS, ROWS, 3));
    CHECK_OK(relume_image_create(&distance, COLUMNS, ROWS, 1));
    for (int i = 0; i < COLUMNS * ROWS; i++) {
        distance.data[i] = 3.0f;
        for (int c = 0; c < 3; c++)
            image.data[3 * i + c] = 1.0f;
    }
    CHECK_OK(relume_image_save(&image, path_of("even/light.exr"), NULL));
    CHECK_OK(relume_image_save(&distance, path_of("even/depth.exr"), NULL));
    relume_image_destroy(&image);
    relume_image_destroy(&distance);
    write_text("even/capture.json",
               "{\"format\":\"relume-capture\",\"version\":1,\"projection\":\"spherical\","
               "\"transfer\":\"linear\",\"lights\":{\"directions\":[[0,1,0]]},"
               "\"views\":[{\"images\":[\"light.exr\"],\"depth\":\"depth.exr\"}]}");
    encode_folder("even");
    relume_tableau *t = open_scene(
        HEAD "\"captures\":[{\"file\":\"even.exr\"}],\"objects\":[{\"mesh\":\"ball.obj\",\"pose\":{"
             "\"scale\":0.4,\"translate\":[0.3,-0.6,-1]},\"parts\":[{\"material\":{\"diffuse\":1}}]"
             "}],\"size\":[24,24]}");
    const struct relume_light light = {.direction = {0, 1, 0}, .rgb = {1, 1, 1}};
    struct relume_image got;
    double sum = 0.0;
    CHECK_OK(relume_tableau_frame(&got, t, NULL, &light, 1,
                                  relume_render_params(.samples = 1,
                                                       .transport = relume_transport_find("path"),
                                                       .transport_samples = 64, .bounces = 8)));
    for (int i = 0; i < 24 * 24 * 3; i++)
        sum += (double)got.data[i] / (24 * 24 * 3);
    CHECK_NEAR(sum, 1.0, 0.01);
    relume_image_destroy(&got);
    relume_tableau_destroy(&t);
}

// What a ball shows on average of an even sky, below a lid of half side 0.5 at `lid`.
static double below_lid(const char *lid, const char *way, int samples, relume_environment *even)
{
    const struct relume_camera aside = {.framing = RELUME_FRAME_EYE,
                                        .eye = {0, -3, 0.9},
                                        .look_at = {true, {0, 0, 0.3}, {0, 0, 1}, 20},
                                        .width = 40,
                                        .height = 30};
    const struct relume_light sky = {
        .kind = RELUME_LIGHT_ENVIRONMENT, .environment = even, .rgb = {1, 1, 1}};
    char text[1024];
    struct relume_image which, got;
    double sum = 0.0;
    int pixels = 0;
    snprintf(
        text, sizeof text,
        HEAD
        "\"captures\":[{\"file\":\"grey.exr\"},{\"file\":\"white.exr\",\"pose\":{\"scale\":"
        "0.5,\"translate\":[%s]}}],\"objects\":[{\"mesh\":\"ball.obj\",\"pose\":{\"scale\":0.2,"
        "\"translate\":[0,0,0.3]},\"parts\":[{\"material\":{\"diffuse\":0.8}}]}]}",
        lid);
    relume_tableau *t = open_scene(text);
    CHECK_OK(relume_tableau_which(&which, t, &aside));
    CHECK_OK(relume_tableau_frame(
        &got, t, &aside, &sky, 1,
        relume_render_params(.samples = samples, .transport = relume_transport_find(way))));
    for (int i = 0; i < 40 * 30; i++)
        if (which.data[i] == 2.0f) {
            sum += (double)got.data[3 * i];
            pixels++;
        }
    relume_image_destroy(&which);
    relume_image_destroy(&got);
    relume_tableau_destroy(&t);
    assert_true(pixels > 100);
    return sum / pixels;
}

// Also where the share of the sky is found once a pixel, for several rays.
static void captures_hide_skies_from_objects(void **state)
{
    (void)state;
    static const char *const ways[] = {"none", "ssdo"};
    relume_environment *even;
    struct relume_image map;
    CHECK_OK(relume_image_create(&map, 16, 8, 3));
    for (int i = 0; i < 16 * 8 * 3; i++)  // in patches for sanitizers: fewer cells to add up
        map.data[i] = !TEST_SANITIZED ? 1.0f : i / 3 % 2 || i / 48 % 2 ? 0.0f : 4.0f;
    CHECK_OK(relume_environment_create(&even, &map, NULL));
    relume_image_destroy(&map);
    for (int i = TEST_SANITIZED ? 1 : 0; i < 2; i++) {
        const double open = below_lid("50,0,0", ways[i], 3, even);
        const double once = below_lid("0,0,0.8", ways[i], 3, even);
        const double each = below_lid("0,0,0.8", ways[i], 1, even);
        assert_true(once < 0.8 * open);
        CHECK_NEAR(once, each, 0.02);
    }
    relume_environment_destroy(&even);
}

// ---------------------------------------------------------------- bad input

static void bad_scenes_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *says;
    } bad[] = {
        {HEAD "\"captures\":[]}", "captures: expected a list of 1 to 64"},
        {HEAD "\"size\":[4,4]}", "expected captures or objects"},
        {HEAD "\"capture\":[]}", "unknown member 'capture'; did you mean 'captures'?"},
        {"{\"format\":\"relume-scene\",\"version\":2}", "expected version 1; found 2"},
        {HEAD "\"captures\":[{\"file\":\"scene.json\"}]}", "is a scene file itself"},
        {HEAD "\"captures\":[{\"file\":\"none.exr\"}]}", "no such file"},
        {HEAD "\"captures\":[{\"name\":\"x\"}]}", "file: expected the name of a file"},
        {HEAD "\"captures\":[{\"file\":\"grey.exr\",\"pose\":{\"scale\":2}}]}",
         "leave out its pose"},
        {HEAD "\"captures\":[{\"file\":\"grey.exr\"},{\"file\":\"grey.exr\",\"pose\":{\"scale\":0}"
              "}]}",
         "scale: expected a number above 0"},
        {HEAD "\"captures\":[{\"file\":\"grey.exr\",\"instead_of\":\"cow\"}]}",
         "the first capture is always seen"},
        {HEAD
         "\"captures\":[{\"file\":\"grey.exr\"},{\"file\":\"grey.exr\",\"instead_of\":\"cow\"}]}",
         "expected the name of one of the objects; found 'cow'"},
        {HEAD "\"captures\":[{\"file\":\"grey.exr\"}],\"lights\":[3]}",
         "light 0: expected a text such as"},
        {HEAD "\"captures\":[{\"file\":\"grey.exr\"}],\"fov\":180}",
         "fov: expected degrees between 0 and 180"},
        {HEAD "\"captures\":[{\"file\":\"grey.exr\"}],\"size\":[0,4]}", "size: expected"},
        {HEAD "\"captures\":[{\"file\":\"grey.exr\"}],\"eye\":[0,0]}", "eye: expected [x, y, z]"},
        {HEAD "\"objects\":[{\"mesh\":\"scene.json\",\"parts\":[{\"material\":{\"diffuse\":1}}]}]}",
         "scene.json"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        relume_tableau *t;
        struct test_log log;
        test_log_init(&log);
        write_text("scene.json", bad[i].text);
        assert_true(relume_status_is_input(relume_tableau_open(
            &t, path_of("scene.json"), relume_tableau_params(.log = &log.log))));
        assert_null(t);
        if (!strstr(log.text, bad[i].says) || strchr(log.text, '\n'))
            fail_msg("%s: '%s' does not say '%s'", bad[i].text, log.text, bad[i].says);
    }
}

static void an_eye_must_look_somewhere(void **state)
{
    (void)state;
    relume_tableau *t = open_scene(TWO_PLANES);
    const struct relume_light light = {.direction = {0, 0, 1}, .rgb = {1, 1, 1}};
    struct relume_camera camera = above;
    struct relume_image image;
    camera.look_at.at = camera.eye;
    assert_int_equal(relume_tableau_frame(&image, t, &camera, &light, 1, NULL), RELUME_EINVAL);
    assert_null(image.data);
    assert_int_equal(relume_tableau_frame(&image, t, &above, &light, 1,
                                          relume_render_params(.transport_spacing = -3)),
                     RELUME_EINVAL);
    relume_tableau_destroy(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(captures_hide_and_shade_each_other),
        cmocka_unit_test(near_lamps_keep_their_strength),
        cmocka_unit_test(poses_move_captures),
        cmocka_unit_test(panoramas_are_seen_from_inside),
        cmocka_unit_test(meshes_give_way_to_captures),
        cmocka_unit_test(light_goes_between_them),
        cmocka_unit_test(captures_hide_skies_from_objects),
        cmocka_unit_test(bad_scenes_are_refused),
        cmocka_unit_test(an_eye_must_look_somewhere),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
