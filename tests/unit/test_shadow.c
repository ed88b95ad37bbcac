// Shadows traced through the depth of a view: a thin disc that floats above a floor, and what
// stands around an eye, whose shadows have closed forms
#include "format/coder/coding.h"
#include "format/pack/pack_write.h"
#include "format/pack/views.h"
#include "relight/light/environment.h"
#include "relight/shadow/moving.h"
#include "relight/view/view.h"

#include "in_folder.h"
#include "test.h"

enum { SIDE = 64, LIGHTS = 48, PIXELS = SIDE * SIDE, MEET = 9 };

static const double RADIUS = 0.35, HEIGHT = 0.5, CAMERA = 4.0;

// ---------------------------------------------------------------- a disc above a floor

static vec3 light_at(int i, int n)
{
    const double z = 1.0 - 0.75 * (i + 0.5) / n, a = 2.399963 * i, r = sqrt(1.0 - z * z);
    return vec3_of(r * cos(a), r * sin(a), z);
}

static bool is_disc(double x, double y)
{
    return hypot(x + 0.2, y - 0.1) < RADIUS;
}

// Of the floor: where the ray passes the height of the disc.
static bool is_lit(double x, double y, vec3 light)
{
    return is_disc(x, y) ||
           !is_disc(x + light.x / light.z * HEIGHT, y + light.y / light.z * HEIGHT);
}

static double across(int i)
{
    return 2.0 * (i + 0.5) / SIDE - 1.0;
}

struct scene {
    float *pictures;  // [LIGHTS][PIXELS][3]
    float depth[PIXELS];
    struct relume_vec3 light[LIGHTS];
    relume_capture *capture;
    struct relume_geometry geometry;
};

// The 16 places of a pixel that are looked at.
static float share_lit(int x, int y, vec3 light)
{
    int lit = 0;
    for (int i = 0; i < 16; i++)
        lit += is_lit(across(x) + (i % 4 - 1.5) / (2.0 * SIDE),
                      -across(y) + (i / 4 - 1.5) / (2.0 * SIDE), light);
    return (float)lit / 16.0f;
}

static void show(float *rgb, vec3 light)
{
    static const float floor_colour[3] = {0.6f, 0.5f, 0.4f}, disc_colour[3] = {0.2f, 0.4f, 0.8f};
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % SIDE, y = i / SIDE;
        const float *colour = is_disc(across(x), -across(y)) ? disc_colour : floor_colour;
        for (int c = 0; c < 3; c++)
            rgb[3 * i + c] = colour[c] * (float)light.z * share_lit(x, y, light);
    }
}

static void scene_open(struct scene *s)
{
    s->pictures = calloc((size_t)LIGHTS * PIXELS * 3, sizeof *s->pictures);
    assert_non_null(s->pictures);
    for (int i = 0; i < PIXELS; i++)
        s->depth[i] =
            (float)(is_disc(across(i % SIDE), -across(i / SIDE)) ? CAMERA - HEIGHT : CAMERA);
    for (int i = 0; i < LIGHTS; i++) {
        s->light[i] = light_at(i, LIGHTS);
        show(s->pictures + (size_t)i * PIXELS * 3, s->light[i]);
    }
    s->geometry = relume_geometry_default(RELUME_PLANAR, SIDE, SIDE);
    const struct relume_manifest m = {
        .lights = LIGHTS, .directions = s->light, .geometry = s->geometry};
    const struct relume_pictures pictures = {
        .width = SIDE, .height = SIDE, .channels = 3, .data = s->pictures, .depth = s->depth};
    CHECK_OK(relume_capture_create(&s->capture, &m, &pictures, NULL));
}

static void scene_close(struct scene *s)
{
    relume_capture_destroy(&s->capture);
    free(s->pictures);
}

// As things are that nobody has learnt: as thick as can be, black.
static void unlearnt(struct relume_image *model, int width, int height, float thick)
{
    CHECK_OK(relume_image_create(model, width, height, RELUME_SHADOW_CHANNELS));
    for (int i = 0; i < width * height; i++)
        model->data[(size_t)i * RELUME_SHADOW_CHANNELS + RELUME_SHADOW_THICK] = thick;
}

static relume_shadows *make(const struct scene *s, const struct relume_image *model)
{
    struct relume_image depth = {SIDE, SIDE, 1, .data = (float *)(uintptr_t)s->depth};
    relume_shadows *shadows;
    CHECK_OK(relume_shadows_create(&shadows, &s->geometry, (double[2]){0}, &depth, model));
    return shadows;
}

// Pixels whose shadow is right, of those that are wholly lit or dark.
static double agreement(const relume_shadows *shadows, vec3 light)
{
    uint8_t *reached = malloc(PIXELS);
    int right = 0, all = 0;
    CHECK_OK(relume_shadows_trace(reached, shadows, light, 2));
    for (int i = 0; i < PIXELS; i++) {
        const float share = share_lit(i % SIDE, i / SIDE, light);
        if (share > 0.0f && share < 1.0f)
            continue;
        all++;
        right += (2 * reached[i] > RELUME_SHADOW_REACHED) == (share > 0.5f);
    }
    free(reached);
    return (double)right / all;
}

// A thin disc stops light, and lets through what passes below it: nothing of that can be seen from
// above. Steps of 0.7 pixels and a start of one pixel leave an edge of a pixel, which is 2 % of the
// picture where the shadow is long.
static void thickness_is_learnt_from_light_that_arrives(void **state)
{
    (void)state;
    struct scene s;
    struct relume_image thick, thin, learnt;
    scene_open(&s);
    unlearnt(&thick, SIDE, SIDE, 10.0f);
    unlearnt(&thin, SIDE, SIDE, 0.02f);
    CHECK_OK(relume_shadows_learn(&learnt, s.capture, 0, NULL));
    relume_shadows *by[] = {make(&s, &thick), make(&s, &thin), make(&s, &learnt)};
    double mean[3] = {0};
    for (int i = 0; i < MEET; i++)
        for (int k = 0; k < 3; k++)
            mean[k] += agreement(by[k], light_at(i, MEET)) / MEET;
    assert_true(mean[0] < 0.97);
    assert_true(mean[1] > 0.99);
    assert_true(mean[2] > 0.99);
    for (int k = 0; k < 3; k++)
        relume_shadows_destroy(&by[k]);
    relume_image_destroy(&thick);
    relume_image_destroy(&thin);
    relume_image_destroy(&learnt);
    scene_close(&s);
}

// All is matte: colour times a + b.L is what the pictures show in full light, with 8 significant
// bits and a ridge of a hundredth beside 20 lights or more.
static void full_light_is_learnt(void **state)
{
    (void)state;
    struct scene s;
    struct relume_image model;
    scene_open(&s);
    CHECK_OK(relume_shadows_learn(&model, s.capture, 0, NULL));
    const float *p = model.data + RELUME_SHADOW_CHANNELS * (size_t)(2 * SIDE + 2);
    const double floor_colour[3] = {0.6, 0.5, 0.4};
    for (int i = 0; i < MEET; i++)
        for (int c = 0; c < 3; c++) {
            const vec3 l = light_at(i, MEET);
            const double lit =
                (double)p[RELUME_SHADOW_MATTE] + (double)p[RELUME_SHADOW_MATTE + 1] * l.x +
                (double)p[RELUME_SHADOW_MATTE + 2] * l.y + (double)p[RELUME_SHADOW_MATTE + 3] * l.z;
            CHECK_NEAR((double)p[RELUME_SHADOW_COLOUR + c] * lit, floor_colour[c] * l.z, 0.02);
        }
    relume_image_destroy(&model);
    scene_close(&s);
}

// ---------------------------------------------------------------- other views

// From the point p of a floor at y = -1 light from above is stopped by a thin cap around the
// vertical, a part of the unit sphere.
static void rays_go_through_panoramas(void **state)
{
    (void)state;
    enum { WIDTH = 192, HIGH = 96 };
    static const enum relume_projection projection[] = {RELUME_SPHERICAL, RELUME_CYLINDRICAL};
    const vec3 up = vec3_of(0.0, 1.0, 0.0);
    for (int k = 0; k < 2; k++) {
        struct relume_geometry g = relume_geometry_default(projection[k], WIDTH, HIGH);
        struct relume_image depth, model;
        uint8_t *reached = malloc(WIDTH * HIGH);
        relume_shadows *shadows;
        int dark = 0, wrong = 0;
        g.v_min = -3.0;
        g.v_max = 3.0;
        const double cap = k ? 0.6 : 0.3;  // radians; the cylinder sees it from 0.32 on
        unlearnt(&model, WIDTH, HIGH, 0.05f);
        CHECK_OK(relume_image_create(&depth, WIDTH, HIGH, 1));
        for (int i = 0; i < WIDTH * HIGH; i++) {
            const vec3 d = relume_panorama_ray(&g, WIDTH, HIGH, i % WIDTH + 0.5, i / WIDTH + 0.5);
            depth.data[i] = d.y < -0.1                 ? (float)(-1.0 / d.y)
                            : acos(fmin(d.y, 1)) < cap ? 1.0f
                                                       : INFINITY;
        }
        CHECK_OK(relume_shadows_create(&shadows, &g, (double[2]){0}, &depth, &model));
        CHECK_OK(relume_shadows_trace(reached, shadows, up, 1));
        for (int i = 0; i < WIDTH * HIGH; i++) {
            const vec3 d = relume_panorama_ray(&g, WIDTH, HIGH, i % WIDTH + 0.5, i / WIDTH + 0.5);
            const double r = hypot(d.x, d.z) / -d.y;
            const double least = k ? sin(0.33) : 0.0, most = sin(cap);
            if (d.y >= -0.1 || fabs(r - most) < 0.05 || (k && fabs(r - least) < 0.05))
                continue;
            const bool is_dark = r < most && r > least;
            dark += is_dark;
            wrong += (2 * reached[i] > RELUME_SHADOW_REACHED) == is_dark;
        }
        assert_true(dark > 300);
        assert_int_equal(wrong, 0);
        relume_shadows_destroy(&shadows);
        relume_image_destroy(&depth);
        relume_image_destroy(&model);
        free(reached);
    }
}

// The floor of the first scene seen by a slab's camera that stands beside the middle, in a frame
// that is turned: the same shadow.
static void rays_go_through_slabs(void **state)
{
    (void)state;
    const double uv[2] = {0.3, -0.2};
    struct relume_geometry g = relume_geometry_default(RELUME_SLAB, SIDE, SIDE);
    struct relume_image depth, model;
    struct relume_image places;
    uint8_t reached[PIXELS];
    relume_shadows *shadows;
    const vec3 local = vec3_unit(vec3_of(0.5, 0.3, 0.8));
    g.pose = (struct relume_pose){.origin = {1.0, 2.0, 3.0},
                                  .axis = {{0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}, {1.0, 0.0, 0.0}}};
    unlearnt(&model, SIDE, SIDE, 0.02f);
    CHECK_OK(relume_image_create(&depth, SIDE, SIDE, 1));
    for (int i = 0; i < PIXELS; i++) {
        const vec3 eye = vec3_of(uv[0], uv[1], g.uv_z);
        const vec3 d = vec3_sub(vec3_of(across(i % SIDE), -across(i / SIDE), g.st_z), eye);
        const double at = (eye.z - HEIGHT) / -d.z;
        const bool disc = is_disc(eye.x + at * d.x, eye.y + at * d.y);
        depth.data[i] = (float)(vec3_length(d) * (disc ? at : eye.z / -d.z));
    }
    CHECK_OK(relume_view_positions(&places, &g, uv, &depth, SIDE, SIDE));
    CHECK_OK(relume_shadows_create(&shadows, &g, uv, &depth, &model));
    CHECK_OK(relume_shadows_trace(reached, shadows, relume_pose_turn(&g.pose, local), 1));
    int dark = 0, wrong = 0;
    for (int i = 0; i < PIXELS; i++) {
        const float *q = places.data + 3 * i;
        const vec3 p =
            relume_pose_local(&g.pose, vec3_of((double)q[0], (double)q[1], (double)q[2]));
        const double near = fabs(
            hypot(p.x + local.x / local.z * HEIGHT + 0.2, p.y + local.y / local.z * HEIGHT - 0.1) -
            RADIUS);
        const double rim = fabs(hypot(p.x + 0.2, p.y - 0.1) - RADIUS);
        if (near < 0.05 || rim < 0.05 || p.z > 0.5 * HEIGHT)
            continue;
        const bool lit =
            !is_disc(p.x + local.x / local.z * HEIGHT, p.y + local.y / local.z * HEIGHT);
        dark += !lit;
        wrong += (2 * reached[i] > RELUME_SHADOW_REACHED) != lit;
    }
    assert_true(dark > 100);
    assert_true(wrong * 100 < PIXELS);
    relume_shadows_destroy(&shadows);
    relume_image_destroy(&depth);
    relume_image_destroy(&places);
    relume_image_destroy(&model);
}

// ---------------------------------------------------------------- pictures

static double psnr_of(const struct relume_image *a, const float *want)
{
    double sum = 0.0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        const double d = (double)(a->data[i] - want[i]);
        sum += d * d;
    }
    return -10.0 * log10(sum / (3 * PIXELS));
}

struct file {
    relume_pack *pack;
    relume_renderer *renderer;
};

static void file_open(struct file *f, const char *path)
{
    CHECK_OK(relume_pack_open(&f->pack, path_of(path), NULL));
    CHECK_OK(relume_renderer_create(&f->renderer, f->pack, NULL));
}

static void file_close(struct file *f)
{
    relume_renderer_destroy(&f->renderer);
    relume_pack_destroy(&f->pack);
}

static void relit(struct relume_image *out, const struct file *f, vec3 direction)
{
    const struct relume_light light = {
        .kind = RELUME_LIGHT_DIRECTIONAL, .direction = direction, .rgb = {1.0f, 1.0f, 1.0f}};
    const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW};
    CHECK_OK(relume_renderer_set_lights(f->renderer, &light, 1));
    CHECK_OK(relume_renderer_frame(out, f->renderer, &camera));
}

static void encode(const struct scene *s, const char *path, bool shadows)
{
    relume_coder *coder;
    CHECK_OK(relume_coder_learn(&coder, relume_basis_find("table"), s->capture, NULL, NULL));
    CHECK_OK(relume_pack_encode(
        s->capture, coder, path_of(path), NULL,
        relume_pack_encode_params(.storage = RELUME_STORE_FLOAT, .shadows = shadows)));
    relume_coder_destroy(&coder);
}

// Through a file: under captured lights the photographs themselves, between them edges that have
// moved. 6 dB is half the error.
static void a_file_shows_shadows_that_move(void **state)
{
    (void)state;
    struct scene s;
    struct file traced, faded;
    struct relume_image a, b, model;
    float want[3 * PIXELS];
    double gain = 0.0;
    scene_open(&s);
    encode(&s, "traced.exr", true);
    encode(&s, "faded.exr", false);
    file_open(&traced, "traced.exr");
    file_open(&faded, "faded.exr");
    assert_true(relume_pack_info(traced.pack)->has_shadow);
    assert_false(relume_pack_info(faded.pack)->has_shadow);
    for (int i = 0; i < LIGHTS; i += 7) {
        relit(&a, &traced, s.light[i]);
        assert_true(psnr_of(&a, s.pictures + (size_t)i * PIXELS * 3) > 100.0);
        relume_image_destroy(&a);
    }
    for (int i = 0; i < MEET; i++) {
        show(want, light_at(i, MEET));
        relit(&a, &traced, light_at(i, MEET));
        relit(&b, &faded, light_at(i, MEET));
        gain += (psnr_of(&a, want) - psnr_of(&b, want)) / MEET;
        relume_image_destroy(&a);
        relume_image_destroy(&b);
    }
    assert_true(gain > 6.0);
    CHECK_OK(relume_pack_shadow(&model, traced.pack, 0));
    assert_int_equal(model.channels, RELUME_SHADOW_CHANNELS);
    relume_image_destroy(&model);
    CHECK_OK(relume_pack_shadow(&model, faded.pack, 0));
    assert_null(model.data);
    CHECK_OK(relume_pack_check(path_of("traced.exr"), NULL));
    file_close(&traced);
    file_close(&faded);
    scene_close(&s);
}

// A lamp in the room: every pixel has a direction of its own, and the disc is below the lamp. 3 dB
// is more than half of the error's energy.
static void near_lights_throw_shadows(void **state)
{
    (void)state;
    static const float floor_colour[3] = {0.6f, 0.5f, 0.4f}, disc_colour[3] = {0.2f, 0.4f, 0.8f};
    struct scene s;
    struct file file[2];
    struct relume_image got[2];
    float want[3 * PIXELS];
    const struct relume_light lamp = {.kind = RELUME_LIGHT_POINT,
                                      .position = {0.5, -0.3, 1.7},
                                      .nofall = true,
                                      .rgb = {1.0f, 1.0f, 1.0f}};
    const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW};
    for (int i = 0; i < PIXELS; i++) {
        const double x = across(i % SIDE), y = -across(i / SIDE);
        const bool disc = is_disc(x, y);
        const vec3 p = vec3_of(x, y, disc ? HEIGHT : 0.0), to = vec3_sub(lamp.position, p);
        const double at = HEIGHT / to.z;
        const bool lit = disc || !is_disc(x + at * to.x, y + at * to.y);
        for (int c = 0; c < 3; c++)
            want[3 * i + c] =
                (float)((double)(disc ? disc_colour : floor_colour)[c] * vec3_unit(to).z * lit);
    }
    scene_open(&s);
    for (int k = 0; k < 2; k++) {
        encode(&s, "lamp.exr", !k);
        file_open(&file[k], "lamp.exr");
        CHECK_OK(relume_renderer_set_lights(file[k].renderer, &lamp, 1));
        CHECK_OK(relume_renderer_frame(&got[k], file[k].renderer, &camera));
    }
    assert_true(psnr_of(&got[0], want) > psnr_of(&got[1], want) + 3.0);
    for (int k = 0; k < 2; k++) {
        file_close(&file[k]);
        relume_image_destroy(&got[k]);
    }
    scene_close(&s);
}

// With traced shadows a file shows what is wanted better, by so many dB, than without.
static void compare_files(const struct relume_light *light, const float *want, double least)
{
    struct scene s;
    struct relume_image got[2];
    const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW};
    scene_open(&s);
    for (int k = 0; k < 2; k++) {
        struct file file;
        encode(&s, "soft.exr", !k);
        file_open(&file, "soft.exr");
        CHECK_OK(relume_renderer_set_lights(file.renderer, light, 1));
        CHECK_OK(relume_renderer_frame(&got[k], file.renderer, &camera));
        file_close(&file);
    }
    assert_true(psnr_of(&got[0], want) > psnr_of(&got[1], want) + least);
    for (int k = 0; k < 2; k++)
        relume_image_destroy(&got[k]);
    scene_close(&s);
}

// An area is what many lamps all over it are. 3 dB is half of the error's energy.
static void areas_throw_soft_shadows(void **state)
{
    (void)state;
    enum { EVERY = 16 };
    static const float floor_colour[3] = {0.6f, 0.5f, 0.4f}, disc_colour[3] = {0.2f, 0.4f, 0.8f};
    static float want[3 * PIXELS];
    const struct relume_light area = {.kind = RELUME_LIGHT_AREA,
                                      .position = {0.5, -0.3, 1.7},
                                      .u = {0.1, 0.0, 0.0},
                                      .v = {0.0, -0.1, 0.0},
                                      .rgb = {150.0f, 150.0f, 150.0f}};
    struct relume_light_patch patch[EVERY * EVERY];
    relume_light_patches(patch, &area, EVERY);
    for (int i = 0; i < PIXELS; i++) {
        const double x = across(i % SIDE), y = -across(i / SIDE);
        const bool disc = is_disc(x, y);
        const vec3 p = vec3_of(x, y, disc ? HEIGHT : 0.0);
        double sum = 0.0;
        for (int k = 0; k < EVERY * EVERY; k++) {
            vec3 to;
            float rgb[3];
            if (relume_light_patch_at(&to, rgb, &patch[k], p) &&
                (disc || !is_disc(x + HEIGHT * to.x / to.z, y + HEIGHT * to.y / to.z)))
                sum += (double)rgb[0] * to.z;
        }
        for (int c = 0; c < 3; c++)
            want[3 * i + c] = (float)sum * (disc ? disc_colour : floor_colour)[c];
    }
    compare_files(&area, want, 3.0);
}

// A sun in a black sky is some distant lights beside each other.
static void suns_throw_shadows(void **state)
{
    (void)state;
    enum { WIDE = 64, HIGH = 32, SUN = 20 * WIDE + 11 };
    static float want[3 * PIXELS], map[3 * WIDE * HIGH];
    const struct relume_image image = {WIDE, HIGH, 3, .data = map};
    for (int c = 0; c < 3; c++)
        map[3 * SUN + c] = 400.0f;
    relume_environment *environment;
    CHECK_OK(relume_environment_create(&environment, &image, NULL));
    int cells;
    const struct relume_environment_cell *cell = relume_environment_cells(&cells, environment);
    const struct relume_light light = {.kind = RELUME_LIGHT_ENVIRONMENT,
                                       .environment = environment,
                                       .rotate_deg = -30.0,
                                       .rgb = {1.0f, 1.0f, 1.0f}};
    for (int k = 0; k < cells; k++) {
        static float shown[3 * PIXELS];
        const vec3 from = relume_environment_turn(cell[k].direction, light.rotate_deg);
        assert_true(from.z > 0.3);
        show(shown, from);
        for (int i = 0; i < 3 * PIXELS; i++)
            want[i] += cell[k].rgb[0] * shown[i];
    }
    compare_files(&light, want, 3.0);
    relume_environment_destroy(&environment);
}

// What a sun takes off it has brought: the sky's light stays where the model is wrong, as at the
// edges of captured shadows, which were black.
static void suns_leave_the_sky(void **state)
{
    (void)state;
    enum { WIDE = 64, HIGH = 32, SUN = 20 * WIDE + 11 };
    static float map[2][3 * WIDE * HIGH];
    struct scene s;
    struct file file;
    struct relume_image got[2];
    const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW};
    for (int i = 0; i < 3 * WIDE * HIGH; i++)
        map[0][i] = map[1][i] = i / 3 == SUN ? 0.0f : 0.3f;
    for (int c = 0; c < 3; c++)
        map[1][3 * SUN + c] = 400.0f;
    scene_open(&s);
    encode(&s, "sky.exr", true);
    file_open(&file, "sky.exr");
    for (int k = 0; k < 2; k++) {
        const struct relume_image image = {WIDE, HIGH, 3, .data = map[k]};
        struct relume_light light = {
            .kind = RELUME_LIGHT_ENVIRONMENT, .rotate_deg = -30.0, .rgb = {1.0f, 1.0f, 1.0f}};
        relume_environment *environment;
        CHECK_OK(relume_environment_create(&environment, &image, NULL));
        light.environment = environment;
        CHECK_OK(relume_renderer_set_lights(file.renderer, &light, 1));
        CHECK_OK(relume_renderer_frame(&got[k], file.renderer, &camera));
        relume_environment_destroy(&environment);
    }
    for (int i = 0; i < 3 * PIXELS; i++)
        assert_true(got[1].data[i] > got[0].data[i] - 1e-4f);
    for (int k = 0; k < 2; k++)
        relume_image_destroy(&got[k]);
    file_close(&file);
    scene_close(&s);
}

// What is added to one light's picture ends where that is black: it takes nothing from another's.
static void lights_are_the_sum_of_their_pictures(void **state)
{
    (void)state;
    enum { N = 3 };
    struct scene s;
    struct file file;
    struct relume_image all, one;
    const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW};
    const struct relume_light light[N] = {
        {.direction = light_at(2, MEET), .rgb = {1.0f, 0.5f, 0.2f}},
        {.direction = light_at(7, MEET), .rgb = {0.3f, 0.9f, 1.0f}},
        {.kind = RELUME_LIGHT_POINT,
         .position = {0.5, -0.3, 1.7},
         .nofall = true,
         .rgb = {1.0f, 1.0f, 1.0f}}};
    scene_open(&s);
    encode(&s, "sum.exr", true);
    file_open(&file, "sum.exr");
    CHECK_OK(relume_renderer_set_lights(file.renderer, light, N));
    CHECK_OK(relume_renderer_frame(&all, file.renderer, &camera));
    for (int k = 0; k < N; k++) {
        CHECK_OK(relume_renderer_set_lights(file.renderer, &light[k], 1));
        CHECK_OK(relume_renderer_frame(&one, file.renderer, &camera));
        for (int i = 0; i < 3 * PIXELS; i++) {
            assert_true(one.data[i] >= -1e-6f);
            all.data[i] -= one.data[i];
        }
        relume_image_destroy(&one);
    }
    for (int i = 0; i < 3 * PIXELS; i++)
        CHECK_NEAR(all.data[i], 0.0, 1e-6);
    relume_image_destroy(&all);
    file_close(&file);
    scene_close(&s);
}

// A rectangle is what the whole picture shows there, any number of threads makes the same.
static void parts_and_threads_agree(void **state)
{
    (void)state;
    enum { LEFT = 11, TOP = 17, WIDE = 30, HIGH = 21 };
    struct scene s;
    struct relume_image model, again, whole, part;
    relume_coder *coder;
    scene_open(&s);
    CHECK_OK(relume_shadows_learn(&model, s.capture, 0, relume_shadows_params(.threads = 1)));
    CHECK_OK(relume_shadows_learn(&again, s.capture, 0, relume_shadows_params(.threads = 3)));
    assert_memory_equal(model.data, again.data,
                        PIXELS * RELUME_SHADOW_CHANNELS * sizeof *model.data);
    CHECK_OK(relume_coder_learn(&coder, relume_basis_find("table"), s.capture, NULL, NULL));
    const struct relume_codes codes = {.coder = coder, .domain = RELUME_DOMAIN_LINEAR};
    const struct relume_light light = {.kind = RELUME_LIGHT_DIRECTIONAL,
                                       .direction = light_at(4, MEET),
                                       .rgb = {1.0f, 0.5f, 2.0f}};
    relume_shadows *shadows = make(&s, &model);
    CHECK_OK(relume_image_create(&whole, SIDE, SIDE, 3));
    CHECK_OK(relume_image_create(&part, WIDE, HIGH, 3));
    for (int i = 0; i < 3 * PIXELS; i++)
        whole.data[i] = 1.0f;
    for (int i = 0; i < 3 * WIDE * HIGH; i++)
        part.data[i] = 1.0f;
    CHECK_OK(relume_shadows_add(&whole, 0, 0, shadows, &codes, &light, 3));
    CHECK_OK(relume_shadows_add(&part, LEFT, TOP, shadows, &codes, &light, 1));
    for (int y = 0; y < HIGH; y++)
        assert_memory_equal(part.data + 3 * y * WIDE, whole.data + 3 * ((TOP + y) * SIDE + LEFT),
                            3 * WIDE * sizeof *part.data);
    relume_shadows_destroy(&shadows);
    relume_coder_destroy(&coder);
    relume_image_destroy(&model);
    relume_image_destroy(&again);
    relume_image_destroy(&whole);
    relume_image_destroy(&part);
    scene_close(&s);
}

static void lights_left_out_decide(void **state)
{
    (void)state;
    struct scene s;
    struct relume_shadows_gain gain;
    scene_open(&s);
    CHECK_OK(relume_shadows_judge(&gain, s.capture, 0, false, NULL));
    assert_int_equal(gain.lights, 6);
    assert_true(gain.traced_db > gain.faded_db + 3.0);
    scene_close(&s);
}

// What a view of that depth shows of a light: none of this may take for ever.
static void reach(uint8_t *reached, const struct relume_geometry *g, const float *depth, vec3 light)
{
    const struct relume_image image = {SIDE, SIDE, 1, .data = (float *)(uintptr_t)depth};
    struct relume_image model;
    relume_shadows *shadows;
    unlearnt(&model, SIDE, SIDE, 0.01f);
    CHECK_OK(relume_shadows_create(&shadows, g, (double[2]){0}, &image, &model));
    CHECK_OK(relume_shadows_trace(reached, shadows, vec3_unit(light), 1));
    relume_shadows_destroy(&shadows);
    relume_image_destroy(&model);
}

// Renderers write background as some large number; rays along the axis went there in steps of
// pixels: 1e12 of them.
static void far_background_is_background(void **state)
{
    (void)state;
    static const float background[] = {1e4f, 65504.0f, 1e10f, 3e38f};
    static const double up[] = {1.0, -1.0};
    const struct relume_geometry g = relume_geometry_default(RELUME_PLANAR, SIDE, SIDE);
    float depth[PIXELS];
    uint8_t reached[PIXELS];
    for (int k = 0; k < 8; k++) {
        for (int i = 0; i < PIXELS; i++)
            depth[i] = i < PIXELS / 2 ? background[k % 4] : 4.0f;
        reach(reached, &g, depth, vec3_of(0.0, 0.0, up[k / 4]));
        assert_int_equal(reached[SIDE], RELUME_SHADOW_REACHED);
    }
}

// A ray from the middle of a pixel through the eye itself, where pixels have no size.
static void rays_pass_the_eye(void **state)
{
    (void)state;
    enum { WIDTH = 255, TALL = 15, ALL = WIDTH * TALL };
    static const enum relume_projection projection[] = {RELUME_SPHERICAL, RELUME_CYLINDRICAL};
    struct relume_vec3 light[8];
    float *pictures = malloc(8 * 3 * ALL * sizeof *pictures), depth[ALL];
    for (int i = 0; i < 8 * 3 * ALL; i++)
        pictures[i] = 0.5f;
    for (int i = 0; i < ALL; i++)
        depth[i] = 2.0f;
    for (int i = 0; i < 8; i++)
        light[i] = vec3_unit(vec3_of(0.0, 0.1 * (i & 6), i & 1 ? -1.0 : 1.0));
    for (int k = 0; k < 2; k++) {
        struct relume_image model;
        const struct relume_manifest m = {.lights = 8,
                                          .directions = light,
                                          .geometry =
                                              relume_geometry_default(projection[k], WIDTH, TALL)};
        const struct relume_pictures all = {
            .width = WIDTH, .height = TALL, .channels = 3, .data = pictures, .depth = depth};
        relume_capture *capture;
        CHECK_OK(relume_capture_create(&capture, &m, &all, NULL));
        CHECK_OK(relume_shadows_learn(&model, capture, 0, NULL));
        relume_image_destroy(&model);
        relume_capture_destroy(&capture);
    }
    free(pictures);
}

// A slab is looked at from either side.
static void an_eye_behind_its_window_sees_the_same(void **state)
{
    (void)state;
    struct relume_geometry g = relume_geometry_default(RELUME_PLANAR, SIDE, SIDE), back;
    float depth[PIXELS];
    uint8_t reached[2][PIXELS];
    g.perspective = true;
    back = g;
    back.camera_z = -g.camera_z;
    const vec3 light = vec3_unit(vec3_of(0.5, 0.3, 0.8));
    int dark = 0;
    for (int i = 0; i < PIXELS; i++) {
        const vec3 d = vec3_of(across(i % SIDE), -across(i / SIDE), -g.camera_z);
        const double at = is_disc(d.x, d.y) ? 0.8 : 1.0;
        depth[i] = (float)(at * vec3_length(d));
    }
    reach(reached[0], &g, depth, light);
    reach(reached[1], &back, depth, vec3_of(light.x, light.y, -light.z));
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(reached[0][i], reached[1][i]);
        dark += reached[0][i] == 0;
    }
    assert_true(dark > 10);
    g.camera_z = 0.0;
    assert_false(relume_shadows_suit(&g));
}

// Radiance beyond what half floats hold.
static void what_is_learnt_can_be_stored(void **state)
{
    (void)state;
    struct scene s;
    struct relume_image model;
    scene_open(&s);
    for (int i = 0; i < LIGHTS * PIXELS * 3; i++)
        s.pictures[i] *= i / (PIXELS * 3) % 2 ? 1e6f : 3e37f;
    CHECK_OK(relume_shadows_learn(&model, s.capture, 0, NULL));
    for (int i = 0; i < PIXELS * RELUME_SHADOW_CHANNELS; i++)
        assert_true(isfinite(model.data[i]));
    relume_image_destroy(&model);
    scene_close(&s);
}

// A file with such a model: whether it is written, and what relume_pack_check says of it.
static relume_status checked(const struct relume_image *model)
{
    relume_coder *coder;
    relume_coefficients *coefficients;
    struct relume_image depth;
    const struct relume_vec3 front = {0.0, 0.0, 1.0};
    const char plane[PIXELS] = {0};
    const void *const planes[3] = {plane, plane, plane};
    CHECK_OK(relume_coder_create(&coder, relume_basis_find("table"), &front, 1, NULL));
    CHECK_OK(relume_image_create(&depth, SIDE, SIDE, 1));
    const struct relume_codes codes = {.coder = coder,
                                       .width = SIDE,
                                       .height = SIDE,
                                       .planes = 3,
                                       .storage = RELUME_STORE_8,
                                       .plane = planes,
                                       .scale = (float[]){1, 1, 1},
                                       .offset = (float[]){0, 0, 0}};
    CHECK_OK(relume_coefficients_keep(&coefficients, &codes,
                                      relume_project_params(.scratch = path_of("scratch"))));
    const struct relume_pack_view view = {
        .coefficients = coefficients, .depth = &depth, .shadow = model};
    const struct relume_pack_contents contents = {
        .coder = coder,
        .domain = RELUME_DOMAIN_LINEAR,
        .display = {.curve = RELUME_CURVE_SRGB},
        .geometry = relume_geometry_default(RELUME_PLANAR, SIDE, SIDE),
        .views = 1,
        .view = &view,
    };
    const relume_status status = relume_pack_write(&contents, path_of("model.exr"), NULL);
    relume_coefficients_destroy(&coefficients);
    relume_coder_destroy(&coder);
    relume_image_destroy(&depth);
    return status ? status : relume_pack_check(path_of("model.exr"), NULL);
}

// What a file cannot be relit with is not written, or check says so.
static void what_is_stored_is_checked(void **state)
{
    (void)state;
    static const struct {
        int channel;
        float value;
        relume_status status;
    } row[] = {{RELUME_SHADOW_THICK, INFINITY, RELUME_OK},
               {RELUME_SHADOW_THICK, NAN, RELUME_EINVAL},
               {RELUME_SHADOW_THICK, -1.0f, RELUME_EINVAL},
               {RELUME_SHADOW_COLOUR, INFINITY, RELUME_EINVAL},
               {RELUME_SHADOW_COLOUR, -1.0f, RELUME_EDAMAGED},
               {RELUME_SHADOW_MATTE, -65504.0f, RELUME_OK},
               {RELUME_SHADOW_MATTE, INFINITY, RELUME_EINVAL}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct relume_image model;
        unlearnt(&model, SIDE, SIDE, 1.0f);
        model.data[(size_t)(PIXELS / 3) * RELUME_SHADOW_CHANNELS + (size_t)row[i].channel] =
            row[i].value;
        assert_int_equal(checked(&model), row[i].status);
        relume_image_destroy(&model);
    }
}

static bool until(void *user, const char *what, double done)
{
    (void)what;
    return done < *(const double *)user;
}

static void learning_can_be_left(void **state)
{
    (void)state;
    static const double times[] = {0.1, 0.3, 0.7};
    struct scene s;
    scene_open(&s);
    for (int i = 0; i < 3; i++) {
        struct relume_image model;
        const struct relume_log log = {.progress = until, .user = (void *)(uintptr_t)&times[i]};
        assert_int_equal(relume_shadows_learn(&model, s.capture, 0,
                                              relume_shadows_params(.log = &log, .threads = 1)),
                         RELUME_ECANCEL);
        assert_null(model.data);
    }
    scene_close(&s);
}

static void what_cannot_be_is_refused(void **state)
{
    (void)state;
    struct scene s;
    struct relume_image model, depth, small;
    relume_shadows *shadows;
    scene_open(&s);
    const struct relume_geometry cube = relume_geometry_default(RELUME_CUBE, SIDE, SIDE);
    unlearnt(&model, SIDE, SIDE, 1.0f);
    unlearnt(&small, SIDE / 2, SIDE, 1.0f);
    CHECK_OK(relume_image_create(&depth, SIDE, SIDE, 1));
    assert_false(relume_shadows_suit(&cube));
    assert_true(relume_shadows_suit(&s.geometry));
    assert_int_equal(relume_shadows_create(&shadows, &cube, (double[2]){0}, &depth, &model),
                     RELUME_EINVAL);
    assert_int_equal(relume_shadows_create(&shadows, &s.geometry, (double[2]){0}, &depth, &small),
                     RELUME_EINVAL);
    assert_int_equal(relume_shadows_create(&shadows, &s.geometry, (double[2]){0}, &depth, &depth),
                     RELUME_EINVAL);
    // Depth that is all 0, all infinite or not a number is no reason to look for ever.
    for (int k = 0; k < 3; k++) {
        uint8_t reached[PIXELS];
        for (int i = 0; i < PIXELS; i++)
            depth.data[i] = k == 0 ? 0.0f : k == 1 ? INFINITY : NAN;
        CHECK_OK(relume_shadows_create(&shadows, &s.geometry, (double[2]){0}, &depth, &model));
        CHECK_OK(relume_shadows_trace(reached, shadows, vec3_unit(vec3_of(1.0, 1.0, 1.0)), 1));
        assert_int_equal(reached[PIXELS / 2], RELUME_SHADOW_REACHED);
        relume_shadows_destroy(&shadows);
    }
    relume_image_destroy(&model);
    relume_image_destroy(&small);
    relume_image_destroy(&depth);
    relume_capture_destroy(&s.capture);
    const struct relume_manifest m = {.lights = LIGHTS, .directions = s.light};
    const struct relume_pictures bare = {
        .width = SIDE, .height = SIDE, .channels = 3, .data = s.pictures};
    CHECK_OK(relume_capture_create(&s.capture, &m, &bare, NULL));
    assert_int_equal(relume_shadows_learn(&model, s.capture, 0, NULL), RELUME_EINVAL);
    scene_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thickness_is_learnt_from_light_that_arrives),
        cmocka_unit_test(full_light_is_learnt),
        cmocka_unit_test(rays_go_through_panoramas),
        cmocka_unit_test(rays_go_through_slabs),
        cmocka_unit_test(a_file_shows_shadows_that_move),
        cmocka_unit_test(near_lights_throw_shadows),
        cmocka_unit_test(areas_throw_soft_shadows),
        cmocka_unit_test(suns_throw_shadows),
        cmocka_unit_test(suns_leave_the_sky),
        cmocka_unit_test(lights_are_the_sum_of_their_pictures),
        cmocka_unit_test(parts_and_threads_agree),
        cmocka_unit_test(lights_left_out_decide),
        cmocka_unit_test(far_background_is_background),
        cmocka_unit_test(rays_pass_the_eye),
        cmocka_unit_test(an_eye_behind_its_window_sees_the_same),
        cmocka_unit_test(what_is_learnt_can_be_stored),
        cmocka_unit_test(what_is_stored_is_checked),
        cmocka_unit_test(learning_can_be_left),
        cmocka_unit_test(what_cannot_be_is_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
