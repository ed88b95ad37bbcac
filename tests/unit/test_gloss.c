// Highlights that wander: the model against the GGX of maps, a glossy dome under lights that no
// file has seen, what files are checked for
#include "in_folder.h"
#include "test.h"

#include "format/pack/views.h"
#include "material/maps/maps.h"
#include "relight/light/environment.h"
#include "relight/shadow/gloss.h"
#include "relight/shadow/moving.h"

#include <relume/material/maps.h>

enum { SIDE = 32, LIGHTS = 40, PIXELS = SIDE * SIDE, MEET = 9 };

static vec3 light_at(int i, int n)
{
    const double z = 1.0 - 0.75 * (i + 0.5) / n, a = 2.399963 * i, r = sqrt(1.0 - z * z);
    return vec3_of(r * cos(a), r * sin(a), z);
}

// A shallow dome: normals within 37 degrees of the eye.
static vec3 normal_at(int i)
{
    const double x = 0.6 * ((i % SIDE + 0.5) / SIDE * 2.0 - 1.0) / 1.5;
    const double y = 0.6 * (1.0 - (i / SIDE + 0.5) / SIDE * 2.0) / 1.5;
    return vec3_of(x, y, sqrt(1.0 - x * x - y * y));
}

// Blinn's highlight, which is not the model's.
static void show(float *rgb, vec3 light)
{
    static const float colour[3] = {0.3f, 0.2f, 0.1f};
    const vec3 half = vec3_unit(vec3_add(light, vec3_of(0.0, 0.0, 1.0)));
    for (int i = 0; i < PIXELS; i++) {
        const vec3 n = normal_at(i);
        const float cosine = (float)fmax(vec3_dot(n, light), 0.0);
        const float shine = cosine > 0.0f ? 0.4f * (float)pow(vec3_dot(n, half), 120.0) : 0.0f;
        for (int c = 0; c < 3; c++)
            rgb[3 * i + c] = colour[c] * cosine + shine;
    }
}

struct scene {
    float *pictures;  // [LIGHTS][PIXELS][3]
    struct relume_vec3 light[LIGHTS];
    relume_capture *capture;
};

static void scene_open(struct scene *s, int lights, bool perspective)
{
    s->pictures = calloc((size_t)LIGHTS * PIXELS * 3, sizeof *s->pictures);
    assert_non_null(s->pictures);
    for (int i = 0; i < lights; i++) {
        s->light[i] = light_at(i, lights);
        show(s->pictures + (size_t)i * PIXELS * 3, s->light[i]);
    }
    struct relume_manifest m = {.lights = lights,
                                .directions = s->light,
                                .geometry = relume_geometry_default(RELUME_PLANAR, SIDE, SIDE)};
    m.geometry.perspective = perspective;
    const struct relume_pictures pictures = {
        .width = SIDE, .height = SIDE, .channels = 3, .data = s->pictures};
    CHECK_OK(relume_capture_create(&s->capture, &m, &pictures, NULL));
}

static void scene_close(struct scene *s)
{
    relume_capture_destroy(&s->capture);
    free(s->pictures);
}

// The lobe is that of maps, but for Fresnel's term: under lights to 75 degrees from the eye it
// changes the lobe by (1 - cos 37.5)^5 / f0, 1 % of 0.04.
static void pixels_show_what_maps_show(void **state)
{
    (void)state;
    static const float roughness[2] = {0.3f, 0.7f}, colour[3] = {0.5f, 0.3f, 0.2f};
    struct relume_maps m = {.width = 2, .height = 1, .pixel = 1.0, .gain = 1.0};
    m.geometry = relume_geometry_default(RELUME_PLANAR, 2, 1);
    CHECK_OK(relume_image_create(&m.normal, 2, 1, 3));
    CHECK_OK(relume_image_create(&m.base_color, 2, 1, 3));
    CHECK_OK(relume_image_create(&m.specular, 2, 1, 3));
    CHECK_OK(relume_image_create(&m.roughness, 2, 1, 1));
    CHECK_OK(relume_image_create(&m.metallic, 2, 1, 1));
    const vec3 n = vec3_unit(vec3_of(0.2, -0.3, 1.0));
    float pixel[2][RELUME_GLOSS_CHANNELS];
    for (int i = 0; i < 2; i++) {
        const bool metal = i == 1;
        const float f0 = metal ? 0.0f : 0.04f;
        m.roughness.data[i] = pixel[i][RELUME_GLOSS_ROUGHNESS] = roughness[i];
        m.metallic.data[i] = metal;
        pixel[i][RELUME_GLOSS_SHINE] = metal ? -1.0f : f0;
        pixel[i][RELUME_GLOSS_NORMAL] = m.normal.data[3 * i] = (float)n.x;
        pixel[i][RELUME_GLOSS_NORMAL + 1] = m.normal.data[3 * i + 1] = (float)n.y;
        m.normal.data[3 * i + 2] = (float)n.z;
        for (int c = 0; c < 3; c++) {
            m.base_color.data[3 * i + c] = colour[c];
            m.specular.data[3 * i + c] = metal ? colour[c] : f0;
            pixel[i][c] = colour[c] * (1.0f - f0);
        }
    }
    for (int k = 0; k < MEET; k++) {
        struct relume_image want;
        float got[3];
        CHECK_OK(relume_maps_relight(&want, &m, light_at(k, MEET), 1));
        for (int i = 0; i < 2; i++) {
            gloss_shown(got, pixel[i], light_at(k, MEET));
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(got[c], fminf(want.data[3 * i + c], 1.0f), 0.01 * got[c] + 1e-3);
        }
        relume_image_destroy(&want);
    }
    relume_maps_destroy(&m);
}

static void encode(const struct scene *s, const char *path, const struct relume_image *gloss,
                   const char *interpolant)
{
    relume_coder *coder;
    CHECK_OK(relume_coder_learn(
        &coder, relume_basis_find("table"), s->capture,
        relume_coder_params(.interpolant =
                                interpolant ? relume_interpolant_find(interpolant) : NULL,
                            .choose = !interpolant),
        NULL));
    CHECK_OK(relume_pack_encode(
        s->capture, coder, path_of(path), NULL,
        relume_pack_encode_params(.storage = RELUME_STORE_FLOAT, .gloss = gloss)));
    relume_coder_destroy(&coder);
}

// Mean squared error under lights between the captured ones.
static double error_of(const char *path)
{
    relume_pack *pack;
    relume_renderer *renderer;
    float want[3 * PIXELS];
    double sum = 0.0;
    CHECK_OK(relume_pack_open(&pack, path_of(path), NULL));
    CHECK_OK(relume_renderer_create(&renderer, pack, NULL));
    for (int k = 0; k < MEET; k++) {
        struct relume_image got;
        const struct relume_light light = {.kind = RELUME_LIGHT_DIRECTIONAL,
                                           .direction = light_at(k, MEET),
                                           .rgb = {1.0f, 1.0f, 1.0f}};
        const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW};
        show(want, light.direction);
        CHECK_OK(relume_renderer_set_lights(renderer, &light, 1));
        CHECK_OK(relume_renderer_frame(&got, renderer, &camera));
        for (int i = 0; i < 3 * PIXELS; i++)
            sum += (double)(got.data[i] - want[i]) * (double)(got.data[i] - want[i]);
        relume_image_destroy(&got);
    }
    relume_renderer_destroy(&renderer);
    relume_pack_destroy(&pack);
    return sum;
}

// Half the squared error at least, 3 dB: a highlight that fades is two faint ones.
static void highlights_move_in_files(void **state)
{
    (void)state;
    struct scene s;
    struct relume_image model, read;
    struct relume_shadows_gain gain;
    relume_pack *pack;
    scene_open(&s, LIGHTS, false);
    CHECK_OK(relume_gloss_judge(&gain, s.capture, false, NULL));
    assert_true(gain.traced_db > gain.faded_db + 1.0);
    CHECK_OK(relume_gloss_learn(&model, s.capture, false, NULL));
    encode(&s, "moves.exr", &model, NULL);
    encode(&s, "fades.exr", NULL, NULL);
    assert_true(error_of("moves.exr") < 0.5 * error_of("fades.exr"));
    CHECK_OK(relume_pack_open(&pack, path_of("moves.exr"), NULL));
    assert_true(relume_pack_info(pack)->has_gloss);
    CHECK_OK(relume_pack_gloss(&read, pack, 0));
    assert_int_equal(read.width, model.width);
    relume_image_destroy(&read);
    relume_pack_destroy(&pack);
    CHECK_OK(relume_pack_check(path_of("moves.exr"), NULL));
    relume_image_destroy(&model);
    scene_close(&s);
}

enum { SUNS = 4 };

// Squared errors under suns one after the other, at z = 0.10, 0.17, 0.44 and 0.90: the first two
// are beyond the lamps, which reach down to 0.26.
static void errors_under_suns(double error[SUNS], const char *path)
{
    enum { WIDE = 64, HIGH = 32 };
    static const int sun[SUNS] = {12 * WIDE + 49, 19 * WIDE + 14, 20 * WIDE + 53, 14 * WIDE + 4};
    relume_pack *pack;
    relume_renderer *renderer;
    CHECK_OK(relume_pack_open(&pack, path_of(path), NULL));
    CHECK_OK(relume_renderer_create(&renderer, pack, NULL));
    for (int k = 0; k < SUNS; k++) {
        static float map[3 * WIDE * HIGH];
        const struct relume_image image = {WIDE, HIGH, 3, .data = map};
        const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW};
        float want[3 * PIXELS] = {0.0f}, shown[3 * PIXELS];
        struct relume_image got;
        relume_environment *environment;
        int cells;
        memset(map, 0, sizeof map);
        for (int c = 0; c < 3; c++)
            map[3 * sun[k] + c] = 400.0f;
        CHECK_OK(relume_environment_create(&environment, &image, NULL));
        const struct relume_environment_cell *cell = relume_environment_cells(&cells, environment);
        const struct relume_light light = {.kind = RELUME_LIGHT_ENVIRONMENT,
                                           .environment = environment,
                                           .rgb = {1.0f, 1.0f, 1.0f}};
        for (int j = 0; j < cells; j++) {
            show(shown, cell[j].direction);
            for (int i = 0; i < 3 * PIXELS; i++)
                want[i] += cell[j].rgb[0] * shown[i];
        }
        CHECK_OK(relume_renderer_set_lights(renderer, &light, 1));
        CHECK_OK(relume_renderer_frame(&got, renderer, &camera));
        error[k] = 0.0;
        for (int i = 0; i < 3 * PIXELS; i++)
            error[k] += pow((double)(got.data[i] - want[i]), 2.0);
        relume_image_destroy(&got);
        relume_environment_destroy(&environment);
    }
    relume_renderer_destroy(&renderer);
    relume_pack_destroy(&pack);
}

// Environments are sums over flat triangles, whatever interpolates lights one by one: what is taken
// off is what these show, and suns beyond the lamps fade. A fifth of the squared error are 7 dB:
// the weights of "chord" leave 5.
static void highlights_of_suns_move(void **state)
{
    (void)state;
    struct scene s;
    struct relume_image model;
    double moves[SUNS], fades[SUNS];
    scene_open(&s, LIGHTS, false);
    CHECK_OK(relume_gloss_learn(&model, s.capture, false, NULL));
    encode(&s, "moves.exr", &model, "chord");
    encode(&s, "fades.exr", NULL, "chord");
    errors_under_suns(moves, "moves.exr");
    errors_under_suns(fades, "fades.exr");
    for (int k = 0; k < SUNS; k++)
        assert_true(moves[k] <= fades[k]);
    assert_true(moves[2] < 0.2 * fades[2]);
    relume_image_destroy(&model);
    scene_close(&s);
}

// Only the pieces that are looked at show the dome: 8 pixels in the middle of each 16. The rest is
// white under every light, as if shone from below.
static void few_pieces_judge(void **state)
{
    (void)state;
    enum { WIDE = 128, HIGH = 4, FEW = 16 };
    static float small[FEW][HIGH][WIDE / 2][3], large[FEW][HIGH][WIDE][3];
    struct relume_vec3 light[FEW];
    struct relume_shadows_gain want, got;
    for (int i = 0; i < FEW; i++) {
        float rgb[3 * PIXELS];
        light[i] = light_at(i, FEW);
        show(rgb, light[i]);
        for (int y = 0; y < HIGH; y++)
            for (int x = 0; x < WIDE; x++)
                for (int c = 0; c < 3; c++) {
                    const int to = 8 * (x / 16) + x % 16 - 4;
                    large[i][y][x][c] = 1.0f;
                    if (x % 16 < 4 || x % 16 >= 12)
                        continue;
                    large[i][y][x][c] = rgb[3 * (SIDE * (4 * y + to / SIDE) + to % SIDE) + c];
                    small[i][y][to][c] = large[i][y][x][c];
                }
    }
    for (int k = 0; k < 2; k++) {
        relume_capture *capture;
        const struct relume_manifest m = {.lights = FEW, .directions = light};
        const struct relume_pictures pictures = {.width = k ? WIDE : WIDE / 2,
                                                 .height = HIGH,
                                                 .channels = 3,
                                                 .data = k ? (void *)large : (void *)small};
        CHECK_OK(relume_capture_create(&capture, &m, &pictures, NULL));
        CHECK_OK(relume_gloss_judge(k ? &got : &want, capture, true, NULL));
        relume_capture_destroy(&capture);
    }
    assert_int_equal(got.lights, 4);
    CHECK_NEAR(got.faded_db, want.faded_db, 0.0);
    CHECK_NEAR(got.traced_db, want.traced_db, 0.0);
}

static void what_cannot_be_is_refused(void **state)
{
    (void)state;
    struct scene s;
    struct relume_image model;
    struct relume_shadows_gain gain;
    relume_shadows *shadows;
    scene_open(&s, 8, false);
    assert_int_equal(relume_gloss_learn(&model, s.capture, true, NULL), RELUME_EINVAL);
    assert_int_equal(relume_gloss_judge(&gain, s.capture, true, NULL), RELUME_EINVAL);
    scene_close(&s);
    scene_open(&s, LIGHTS, true);
    assert_int_equal(relume_gloss_learn(&model, s.capture, true, NULL), RELUME_EINVAL);
    scene_close(&s);
    CHECK_OK(relume_image_create(&model, 2, 2, 3));
    assert_int_equal(relume_gloss_create(&shadows, &model), RELUME_EINVAL);
    relume_image_destroy(&model);
    // Highlights have no triangles of captured lights.
    const relume_coder *between;
    relume_coder *coder;
    CHECK_OK(relume_coder_create(&coder, &relume_basis_sh, s.light, LIGHTS, NULL));
    CHECK_OK(relume_image_create(&model, 2, 2, RELUME_GLOSS_CHANNELS));
    CHECK_OK(relume_gloss_create(&shadows, &model));
    assert_int_equal(relume_shadows_between(&between, shadows, coder), RELUME_EINVAL);
    assert_null(between);
    relume_shadows_destroy(&shadows);
    relume_coder_destroy(&coder);
    relume_image_destroy(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_show_what_maps_show), cmocka_unit_test(highlights_move_in_files),
        cmocka_unit_test(highlights_of_suns_move),    cmocka_unit_test(few_pieces_judge),
        cmocka_unit_test(what_cannot_be_is_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
