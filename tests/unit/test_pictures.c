// test_pictures.c - a capture of pictures in memory is the capture of the same pictures in files
#include "test.h"

#include "core/base/memory.h"

#include <sys/stat.h>

enum { WIDTH = 9, HEIGHT = 20, LIGHTS = 7, VIEWS = 2, PIXELS = WIDTH * HEIGHT };

static char folder[64];
static struct relume_vec3 directions[LIGHTS];
static float values[VIEWS][LIGHTS][PIXELS * 3], depth[VIEWS][PIXELS], mask[VIEWS][PIXELS];
static uint8_t bytes[VIEWS][LIGHTS][PIXELS * 3];
static const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};

static int setup(void **state)
{
    (void)state;
    uint32_t seed = 5;
    test_folder(folder);
    if (relume_directions_make(directions, LIGHTS, relume_pattern_find("hammersley"),
                               relume_directions_params(.hemisphere = true)))
        return 1;
    for (int v = 0; v < VIEWS; v++) {
        for (int i = 0; i < LIGHTS; i++)
            for (int p = 0; p < 3 * PIXELS; p++) {
                bytes[v][i][p] = (uint8_t)(40 + test_random(&seed) % 200);
                values[v][i][p] = (float)test_uniform(&seed);
            }
        for (int p = 0; p < PIXELS; p++) {
            depth[v][p] = 2.0f + 0.1f * (float)(p % 7);
            mask[v][p] = (float)(p % 5 > 0);
        }
    }
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

// ---------------------------------------------------------------- files of the same

static void save(const char *name, const float *data, int channels)
{
    const struct relume_image image = {WIDTH, HEIGHT, channels, .data = (float *)(uintptr_t)data};
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    CHECK_OK(relume_image_save(&image, path, NULL));
}

// PNG holds the codes that these linear values are the light of.
static void save_codes(const char *name, const uint8_t *codes)
{
    float linear[PIXELS * 3];
    for (int i = 0; i < PIXELS * 3; i++)
        linear[i] = relume_transfer_decode(srgb, (float)codes[i] / 255.0f);
    save(name, linear, 3);
}

static void name_images(struct relume_manifest_view *view, const char *ending)
{
    static const char *names[VIEWS][LIGHTS];
    static char text[VIEWS][LIGHTS][32];
    for (int v = 0; v < VIEWS; v++) {
        for (int i = 0; i < LIGHTS; i++) {
            snprintf(text[v][i], sizeof text[v][i], "%d-%d.%s", v, i, ending);
            names[v][i] = text[v][i];
        }
        view[v] = (struct relume_manifest_view){.uv = {v, 0},
                                                .images = names[v],
                                                .depth = v ? "d1.exr" : "d0.exr",
                                                .mask = v ? "m1.exr" : "m0.exr"};
    }
}

static void save_all(struct relume_manifest *m, struct relume_manifest_view *view,
                     const char *ending)
{
    char path[128];
    name_images(view, ending);
    m->view = view;
    for (int v = 0; v < VIEWS; v++) {
        for (int i = 0; i < LIGHTS; i++)
            if (!strcmp(ending, "exr"))
                save(view[v].images[i], values[v][i], 3);
            else
                save_codes(view[v].images[i], bytes[v][i]);
        save(view[v].depth, depth[v], 1);
        save(view[v].mask, mask[v], 1);
    }
    snprintf(path, sizeof path, "%s/capture.json", folder);
    CHECK_OK(relume_manifest_write(m, path, NULL));
}

// ---------------------------------------------------------------- the same capture twice

static void check_same_planes(const relume_capture *a, const relume_capture *b)
{
    struct relume_image x, y;
    for (int v = 0; v < VIEWS; v++) {
        CHECK_OK(relume_capture_depth(&x, a, v, NULL));
        CHECK_OK(relume_capture_depth(&y, b, v, NULL));
        assert_memory_equal(x.data, y.data, PIXELS * sizeof *x.data);
        relume_image_destroy(&x);
        relume_image_destroy(&y);
        CHECK_OK(relume_capture_mask(&x, a, v, NULL));
        CHECK_OK(relume_capture_mask(&y, b, v, NULL));
        assert_memory_equal(x.data, y.data, PIXELS * sizeof *x.data);
        relume_image_destroy(&x);
        relume_image_destroy(&y);
    }
}

static void check_same_images(const relume_capture *a, const relume_capture *b)
{
    struct relume_image x, y;
    float white[2][3];
    for (int i = 0; i < LIGHTS; i++) {
        CHECK_OK(relume_capture_image(&x, a, i % VIEWS, i, NULL));
        CHECK_OK(relume_capture_image(&y, b, i % VIEWS, i, NULL));
        assert_memory_equal(x.data, y.data, 3 * PIXELS * sizeof *x.data);
        relume_image_destroy(&x);
        relume_image_destroy(&y);
        relume_capture_white(a, i, white[0]);
        relume_capture_white(b, i, white[1]);
        assert_memory_equal(white[0], white[1], sizeof white[0]);
    }
}

static void encode(struct relume_buffer *out, const relume_capture *capture)
{
    const struct relume_writer writer = relume_buffer_writer(out);
    relume_coder *coder;
    CHECK_OK(relume_coder_learn(&coder, &relume_basis_sh, capture,
                                relume_coder_params(.coefficients = 4), NULL));
    CHECK_OK(relume_pack_encode(capture, coder, NULL, NULL,
                                relume_pack_encode_params(.writer = &writer)));
    relume_coder_destroy(&coder);
}

static void check_same(struct relume_manifest *m, const struct relume_pictures *pictures,
                       const char *ending)
{
    struct relume_manifest_view view[VIEWS];
    struct relume_buffer a = {0}, b = {0};
    relume_capture *files, *memory;
    save_all(m, view, ending);
    CHECK_OK(relume_capture_open(&files, folder, NULL));
    CHECK_OK(relume_capture_create(&memory, m, pictures, NULL));
    check_same_planes(files, memory);
    check_same_images(files, memory);
    encode(&a, files);
    encode(&b, memory);
    assert_int_equal(a.size, b.size);
    assert_memory_equal(a.data, b.data, a.size);
    relume_buffer_destroy(&a);
    relume_buffer_destroy(&b);
    relume_capture_destroy(&files);
    relume_capture_destroy(&memory);
}

static const struct relume_pictures floats = {.width = WIDTH,
                                              .height = HEIGHT,
                                              .channels = 3,
                                              .data = values,
                                              .depth = depth[0],
                                              .mask = mask[0]};

static struct relume_manifest slab(void)
{
    return (struct relume_manifest){
        .geometry = relume_geometry_default(RELUME_SLAB, WIDTH, HEIGHT),
        .lights = LIGHTS,
        .directions = directions,
        .views = VIEWS,
    };
}

static void test_floats(void **state)
{
    (void)state;
    float intensities[LIGHTS][3];
    for (int i = 0; i < LIGHTS; i++)
        for (int c = 0; c < 3; c++)
            intensities[i][c] = 1.0f + 0.25f * (float)((i + c) % 3);
    struct relume_manifest m = slab();
    check_same(&m, &floats, "exr");
    m.intensities = (const float(*)[3])intensities;
    check_same(&m, &floats, "exr");
}

static void test_bytes(void **state)
{
    (void)state;
    struct relume_pictures pictures = floats;
    pictures.sample = RELUME_SAMPLE_8;
    pictures.data = bytes;
    struct relume_manifest m = slab();
    check_same(&m, &pictures, "png");
    m.transfer = (struct relume_transfer){.curve = RELUME_CURVE_GAMMA, .gamma = 1.5f};
    check_same(&m, &pictures, "png");
}

static void test_near_lights(void **state)
{
    (void)state;
    struct relume_vec3 positions[LIGHTS];
    for (int i = 0; i < LIGHTS; i++)  // numbers that a file holds exactly
        positions[i] =
            (struct relume_vec3){round(24 * directions[i].x) / 8, round(24 * directions[i].y) / 8,
                                 1 + round(24 * directions[i].z) / 8};
    struct relume_manifest m = slab();
    m.positions = positions;
    m.directions = positions;  // of any length
    check_same(&m, &floats, "exr");
}

// One view, nothing but lights: what the user of an array begins with.
static void test_the_least(void **state)
{
    (void)state;
    static uint16_t words[LIGHTS][PIXELS];
    const struct relume_pictures pictures = {
        .sample = RELUME_SAMPLE_16, .width = WIDTH, .height = HEIGHT, .channels = 1, .data = words};
    struct relume_vec3 longer[LIGHTS];
    relume_capture *c;
    struct relume_image image;
    for (int i = 0; i < LIGHTS; i++) {
        longer[i] =
            (struct relume_vec3){7 * directions[i].x, 7 * directions[i].y, 7 * directions[i].z};
        for (int p = 0; p < PIXELS; p++)
            words[i][p] = (uint16_t)(300 * p + i);
    }
    // Places of lamps alone: directions follow.
    const struct relume_manifest m = {.lights = LIGHTS, .positions = longer};
    CHECK_OK(relume_capture_create(&c, &m, &pictures, NULL));
    relume_capture_destroy(&c);
    const struct relume_manifest distant = {.lights = LIGHTS, .directions = longer};
    CHECK_OK(relume_capture_create(&c, &distant, &pictures, NULL));
    const struct relume_manifest *understood = relume_capture_manifest(c);
    CHECK_NEAR(understood->directions[3].x, directions[3].x, 1e-15);
    CHECK_NEAR(understood->geometry.window_max[1], (double)HEIGHT / WIDTH, 1e-15);
    assert_int_equal(understood->views, 1);
    CHECK_OK(relume_capture_image(&image, c, 0, 5, NULL));
    for (int p = 0; p < PIXELS; p++)
        for (int k = 0; k < 3; k++)  // grey is spread
            assert_true(image.data[3 * p + k] ==
                        relume_transfer_decode(srgb, (float)words[5][p] / 65535.0f));
    relume_image_destroy(&image);
    relume_capture_destroy(&c);
}

// ---------------------------------------------------------------- errors

static void check_refused(const struct relume_manifest *m, const char *sentence)
{
    struct test_log log;
    relume_capture *c = (void *)1;
    test_log_init(&log);
    assert_int_equal(relume_capture_create(&c, m, &floats, relume_capture_params(.log = &log.log)),
                     RELUME_EFORMAT);
    assert_null(c);
    assert_string_equal(log.text, sentence);
}

static void test_manifests_that_cannot_be(void **state)
{
    (void)state;
    struct relume_manifest_view view[VIEWS] = {{.uv = {0}}};
    struct relume_vec3 vectors[LIGHTS];
    float dark[LIGHTS][3] = {{1, 1, 0}};
    struct relume_manifest m = slab();
    m.view = view;
    m.directions = vectors;
    memcpy(vectors, directions, sizeof vectors);
    vectors[2] = (struct relume_vec3){0};
    check_refused(&m, "memory: lights.directions[2]; expected a direction; found a zero vector");
    vectors[2].y = NAN;
    check_refused(&m, "memory: lights.directions[2]; expected three finite numbers");
    m.directions = directions;
    m.intensities = (const float(*)[3])dark;
    check_refused(&m, "memory: lights.intensities; expected three numbers from 1e-30 to 1e30 for "
                      "every light");
    m.intensities = NULL;
    m.geometry.st_max[0] = m.geometry.st_min[0];
    check_refused(&m, "memory: window; expected min below max");
    m.geometry = relume_geometry_default(RELUME_SLAB, 1, 1);
    m.slabs = 1;
    m.slab = &m.geometry;
    view[1].slab = 1;
    check_refused(&m, "memory: views[1].slab; expected 0 to 0");
}

static void test_pictures_that_cannot_be(void **state)
{
    (void)state;
    const struct relume_manifest m = {.lights = LIGHTS, .directions = directions};
    const struct relume_manifest none = {.lights = LIGHTS},
                                 many = {.lights = LIGHTS, .directions = directions, .views = 2};
    struct relume_pictures two = floats, empty = floats, wide = floats;
    relume_capture *c;
    two.channels = 2;
    empty.data = NULL;
    wide.width = 1 << 20;
    assert_int_equal(relume_capture_create(&c, &m, &two, NULL), RELUME_EINVAL);
    assert_int_equal(relume_capture_create(&c, &m, &empty, NULL), RELUME_EINVAL);
    assert_int_equal(relume_capture_create(&c, &m, &wide, NULL), RELUME_EINVAL);
    assert_int_equal(relume_capture_create(&c, &none, &floats, NULL), RELUME_EINVAL);
    assert_int_equal(relume_capture_create(&c, &many, &floats, NULL), RELUME_EINVAL);
    assert_null(c);
}

static void test_values_that_are_not_finite(void **state)
{
    (void)state;
    const struct relume_manifest m = {.lights = LIGHTS, .directions = directions};
    struct test_log log;
    relume_capture *c;
    struct relume_image image;
    const float kept = values[0][4][7];
    test_log_init(&log);
    CHECK_OK(relume_capture_create(&c, &m, &floats, NULL));
    values[0][4][7] = NAN;
    assert_int_equal(relume_capture_image(&image, c, 0, 4, &log.log), RELUME_EDAMAGED);
    assert_string_equal(log.text, "memory (view 0, light 4): holds NaN or infinite values; "
                                  "expected finite radiance");
    values[0][4][7] = kept;
    relume_capture_destroy(&c);
}

static void test_short_of_memory(void **state)
{
    (void)state;
    struct relume_manifest_view view[VIEWS] = {{.uv = {0}}, {.uv = {1, 0}}};
    struct relume_manifest m = slab();
    m.view = view;
    m.positions = directions;
    int n = 0;
    for (bool done = false; !done;) {
        relume_capture *c = (void *)1;
        mem_fail_after(++n);
        const relume_status status = relume_capture_create(&c, &m, &floats, NULL);
        done = mem_fail_pending();
        mem_fail_after(0);
        assert_int_equal(status, done ? RELUME_OK : RELUME_ENOMEM);
        assert_true(done || !c);
        if (done)
            relume_capture_destroy(&c);
    }
    assert_true(n > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_floats),
        cmocka_unit_test(test_bytes),
        cmocka_unit_test(test_near_lights),
        cmocka_unit_test(test_the_least),
        cmocka_unit_test(test_manifests_that_cannot_be),
        cmocka_unit_test(test_pictures_that_cannot_be),
        cmocka_unit_test(test_values_that_are_not_finite),
        cmocka_unit_test(test_short_of_memory),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
