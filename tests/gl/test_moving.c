// Shadows and highlights that move, by passes, against the library: lights near and far, and the
// suns of environments, for every kind of rays
//
// Compares: moving/near.frag.glsl, moving/shadow.frag.glsl, moving/shown.glsl,
// moving/trace.frag.glsl, shared/gloss.glsl, shared/moving.glsl, shared/near_shadow.glsl,
// shared/stage.glsl with gloss.c, relighter.c, shadows.c, shadows.h, stage.c.
#include "format/pack/views.h"
#include "relight/frame/relighter.h"
#include "relight/light/environment.h"
#include "relight/shadow/moving.h"
#include "relight/view/view.h"

#include "fixture.h"

enum { W = 33, H = 21, PIXELS = W * H };
enum { MAP = 256 };  // so wide that a pixel of the sky is a sun

static relume_environment *sky;

static int open_all(void **state)
{
    struct relume_image map;
    if (fixture_open(state) || relume_image_create(&map, MAP, MAP / 2, 3))
        return -1;
    for (int i = 0; i < MAP * MAP / 2; i++)
        for (int c = 0; c < 3; c++)
            map.data[3 * i + c] = i == 44 * MAP + 10    ? 4000.0f
                                  : i == 20 * MAP + 240 ? 3000.0f + 500.0f * (float)c
                                                        : 0.2f;
    const relume_status status = relume_environment_create(&sky, &map, NULL);
    relume_image_destroy(&map);
    return status ? -1 : 0;
}

static int close_all(void **state)
{
    relume_environment_destroy(&sky);
    return fixture_close(state);
}

// ---------------------------------------------------------------- views

// Something thin hangs before a wavy surface; a corner is background.
struct world {
    struct fixture_file file;
    struct relume_geometry geometry;
    double uv[2];
    struct relume_image depth, model;
    bool gloss;  // highlights move, no shadows
};

static void make_depth(struct relume_image *depth, double far)
{
    assert_int_equal(relume_image_create(depth, W, H, 1), RELUME_OK);
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % W, y = i / W;
        const bool hangs = x > 12 && x < 20 && y > 6 && y < 13;
        const double waves = 0.03 * sin(0.7 * x) * cos(0.5 * y);
        depth->data[i] = x > 28 && y < 4 ? INFINITY : (float)(far * (hangs ? 0.8 : 1.0 + waves));
    }
}

static void make_shadows(struct relume_image *model, uint64_t *random)
{
    assert_int_equal(relume_image_create(model, W, H, RELUME_SHADOW_CHANNELS), RELUME_OK);
    for (int i = 0; i < PIXELS; i++) {
        float *p = model->data + RELUME_SHADOW_CHANNELS * i;
        p[RELUME_SHADOW_THICK] = 0.1f;
        for (int c = 0; c < 3; c++)
            p[RELUME_SHADOW_COLOUR + c] = i % 50 ? (float)uniform(random) : 0.0f;
        p[RELUME_SHADOW_MATTE] = 0.5f;
        for (int c = 1; c < 4; c++)
            p[RELUME_SHADOW_MATTE + c] = (float)(0.4 * uniform(random) - 0.1);
    }
}

static void make_gloss(struct relume_image *model, uint64_t *random)
{
    assert_int_equal(relume_image_create(model, W, H, RELUME_GLOSS_CHANNELS), RELUME_OK);
    for (int i = 0; i < PIXELS; i++) {
        float *p = model->data + RELUME_GLOSS_CHANNELS * i;
        for (int c = 0; c < 3; c++)
            p[RELUME_GLOSS_COLOUR + c] = (float)uniform(random);
        for (int c = 0; c < 2; c++)
            p[RELUME_GLOSS_NORMAL + c] = (float)(0.8 * uniform(random) - 0.4);
        p[RELUME_GLOSS_ROUGHNESS] = (float)(0.2 + 0.5 * uniform(random));
        p[RELUME_GLOSS_SHINE] = i % 3 ? 0.05f : -1.0f;
        p[RELUME_GLOSS_SHARE] = i % 7 ? (float)uniform(random) : 0.0f;
    }
}

// A dome of few lights in place of harmonics: passes know weights over triangles as exactly as the
// library.
static void keep_photographs(struct fixture_file *f, bool pole_y)
{
    struct relume_vec3 lights[FIXTURE_K];
    for (int i = 0; i < FIXTURE_K; i++) {
        const double up = 1.0 - 0.9 * (i + 0.3) / FIXTURE_K, r = sqrt(1.0 - up * up);
        const double x = r * cos(2.4 * i), y = r * sin(2.4 * i);
        lights[i] = pole_y ? (struct relume_vec3){y, up, -x} : (struct relume_vec3){x, y, up};
    }
    relume_coder_destroy(&f->coder);
    assert_int_equal(relume_coder_create(&f->coder, &relume_basis_table, lights, FIXTURE_K,
                                         relume_coder_params(.hemispherical = true,
                                                             .pole_y = pole_y, .decode = true)),
                     RELUME_OK);
    f->codes->coder = f->coder;
    for (int i = 0; i < FIXTURE_PLANES; i++) {
        f->scale[i] = 1.0f / 255.0f;
        f->offset[i] = 0.0f;
    }
}

// `far` from the eye; 0: of highlights.
static void world_open(struct world *w, const struct relume_geometry *geometry, double far,
                       enum relume_domain domain, bool pole_y)
{
    uint64_t random = 17;
    *w = (struct world){.file = fixture_make(1, W, H, RELUME_STORE_8, domain, pole_y),
                        .geometry = *geometry,
                        .uv = {0.1, -0.05},
                        .gloss = far <= 0.0};
    keep_photographs(&w->file, pole_y);
    make_depth(&w->depth, w->gloss ? geometry->camera_z : far);
    (w->gloss ? make_gloss : make_shadows)(&w->model, &random);
}

static void world_close(struct world *w)
{
    relume_image_destroy(&w->depth);
    relume_image_destroy(&w->model);
    fixture_free(&w->file);
}

static relume_status fetch(const struct relume_codes **out, void *user, int view)
{
    return fixture_fetch(out, &((struct world *)user)->file, view);
}

static relume_status find_surface(struct relume_image *out, void *user, int view)
{
    (void)view;
    const struct world *w = user;
    return relume_view_positions(out, &w->geometry, w->uv, &w->depth, W, H);
}

static relume_status find_shadows(relume_shadows **out, void *user, int view)
{
    (void)view;
    const struct world *w = user;
    return w->gloss ? relume_gloss_create(out, &w->model)
                    : relume_shadows_create(out, &w->geometry, w->uv, &w->depth, &w->model);
}

// ---------------------------------------------------------------- both sides

static void by_library(struct relume_image *out, struct world *w, const struct relume_light *lights,
                       int n, relume_shadows *shadows)
{
    const struct relume_codes *codes;
    struct relume_image surface;
    relume_relighter *relighter;
    *out = (struct relume_image){0};
    assert_int_equal(fetch(&codes, w, 0), RELUME_OK);
    assert_int_equal(find_surface(&surface, w, 0), RELUME_OK);
    assert_int_equal(relume_relighter_create(&relighter, 1, NULL), RELUME_OK);
    assert_int_equal(relume_relighter_relight(out, relighter,
                                              &(struct relume_relit){.codes = codes,
                                                                     .surface = &surface,
                                                                     .lights = lights,
                                                                     .count = n,
                                                                     .shadows = shadows}),
                     RELUME_OK);
    relume_relighter_destroy(&relighter);
    relume_image_destroy(&surface);
}

static double largest_at(const struct relume_image *a, const struct relume_image *b, int pixel)
{
    double most = 0.0;
    for (int c = 3 * pixel; c < 3 * pixel + 3; c++)
        most = fmax(most, fabs((double)a->data[c] - (double)b->data[c]));
    return most;
}

// A ray in single precision may pass a corner on the other side: so few pixels of a picture are
// left out.
enum { FEW = 2 };
static const double BOUND = 2e-5;  // of white; sums of 10 products near 1 in single precision

static int count_off(const struct relume_image *a, const struct relume_image *b, double by)
{
    int count = 0;
    for (int i = 0; i < PIXELS; i++)
        count += !(largest_at(a, b, i) <= by);
    return count;
}

static void check_lights(struct gl_relighter *r, struct world *w, const char *name,
                         const struct relume_light *lights, int n)
{
    relume_shadows *shadows;
    struct relume_image want, faded, got;
    const struct target *target;
    assert_int_equal(find_shadows(&shadows, w, 0), RELUME_OK);
    by_library(&want, w, lights, n, shadows);
    by_library(&faded, w, lights, n, NULL);
    assert_int_equal(gl_relighter_begin(r, lights, n), RELUME_OK);
    assert_int_equal(gl_relighter_view(&target, r, 0), RELUME_OK);
    assert_int_equal(target_read(&got, target, &fixture_gl), RELUME_OK);
    const int off = count_off(&got, &want, BOUND), moved = count_off(&faded, &want, 1e-2);
    print_message("  %s, %s: %d pixels off, %d moved\n", name,
                  n > 1 ? "all" : relume_light_kind_name(lights[0].kind), off, moved);
    assert_true(off <= FEW);
    assert_true(moved > 20 || (w->gloss && relume_light_is_near(lights[0].kind)));
    relume_image_destroy(&want);
    relume_image_destroy(&faded);
    relume_image_destroy(&got);
    relume_shadows_destroy(&shadows);
}

// Near lights stand about the eye, one of them behind what hangs there, which shades nothing then.
static void check_world(struct world *w, const char *name, struct relume_vec3 eye,
                        struct relume_vec3 behind)
{
    const struct code_source source = {fetch, NULL, w, find_surface, find_shadows};
    const struct relume_light lights[] = {
        {.kind = RELUME_LIGHT_POINT,
         .position = {eye.x + 0.3, eye.y + 0.2, eye.z - 0.1},
         .rgb = {1, 0.9f, 0.7f}},
        {.kind = RELUME_LIGHT_POINT, .position = behind, .rgb = {0.1f, 0.1f, 0.2f}},
        {.kind = RELUME_LIGHT_SPOT,
         .position = {eye.x - 0.2, eye.y + 0.3, eye.z},
         .direction = {0.1, -0.1, -1},
         .half_angle_deg = 35,
         .rgb = {0.7f, 0.8f, 1}},
        {.kind = RELUME_LIGHT_AREA,
         .position = {eye.x + 0.2, eye.y - 0.2, eye.z},
         .u = {0.3, 0, 0.1},
         .v = {0, -0.3, 0},
         .rgb = {3, 3, 3}},
        {.kind = RELUME_LIGHT_ENVIRONMENT, .environment = sky, .rotate_deg = 10, .rgb = {1, 1, 1}},
        {.kind = RELUME_LIGHT_DIRECTIONAL, .direction = {0.2, 0.3, 0.8}, .rgb = {1, 1, 0.5f}},
    };
    enum { LIGHTS = sizeof lights / sizeof *lights };
    struct gl_relighter r;
    assert_int_equal(gl_relighter_create(&r, &fixture_gl, &source, 1, &fixture_log), RELUME_OK);
    for (int i = 0; i < LIGHTS; i++)
        check_lights(&r, w, name, &lights[i], 1);
    check_lights(&r, w, name, lights, LIGHTS);
    gl_relighter_destroy(&r);
}

static void check(const char *name, const struct relume_geometry *g, double far,
                  enum relume_domain domain, bool pole_y, struct relume_vec3 eye,
                  struct relume_vec3 behind)
{
    struct world w;
    world_open(&w, g, far, domain, pole_y);
    check_world(&w, name, eye, behind);
    world_close(&w);
}

// ---------------------------------------------------------------- tests

static void parallel_rays(void **state)
{
    (void)state;
    const struct relume_geometry g = relume_geometry_default(RELUME_PLANAR, W, H);
    check("planar", &g, g.camera_z, RELUME_DOMAIN_LINEAR, false, (struct relume_vec3){0, 0, 1.5},
          (struct relume_vec3){0, 0.1, 0.4});
}

static void a_turned_slab(void **state)
{
    (void)state;
    struct relume_geometry g = relume_geometry_default(RELUME_SLAB, W, H);
    const double c = cos(0.4), s = sin(0.4);
    g.pose =
        (struct relume_pose){.axis = {{c, s, 0}, {-s, c, 0}, {0, 0, 1}}, .origin = {0.2, 0.1, 0.3}};
    check("slab", &g, g.uv_z - g.st_z, RELUME_DOMAIN_DISPLAY, false,
          (struct relume_vec3){0.2, 0.1, 1.8}, (struct relume_vec3){0.2, 0.2, 0.5});
}

static void rooms(void **state)
{
    (void)state;
    const struct relume_geometry cylinder = relume_geometry_default(RELUME_CYLINDRICAL, W, H);
    const struct relume_vec3 behind = {0, 0.1, -1.35};
    const struct relume_geometry sphere = relume_geometry_default(RELUME_SPHERICAL, W, H);
    check("cylinder", &cylinder, 1.5, RELUME_DOMAIN_LINEAR, true, cylinder.center, behind);
    check("sphere", &sphere, 1.5, RELUME_DOMAIN_LINEAR, true, sphere.center, behind);
}

static void highlights(void **state)
{
    (void)state;
    const struct relume_geometry g = relume_geometry_default(RELUME_PLANAR, W, H);
    check("highlights", &g, 0.0, RELUME_DOMAIN_DISPLAY, false, (struct relume_vec3){0, 0, 1.5},
          (struct relume_vec3){0, 0.1, 0.4});
}

// The library then has near lights.
static void triangles_that_no_texture_holds(void **state)
{
    (void)state;
    const struct relume_geometry g = relume_geometry_default(RELUME_PLANAR, W, H);
    struct gl small = fixture_gl;
    struct world w;
    struct gl_relighter r;
    const struct code_source source = {fetch, NULL, &w, find_surface, find_shadows};
    const struct relume_light light = {
        .kind = RELUME_LIGHT_POINT, .position = {0.3, 0.2, 1.4}, .rgb = {1, 1, 1}};
    small.max_texture = 100;
    world_open(&w, &g, g.camera_z, RELUME_DOMAIN_LINEAR, false);
    assert_int_equal(gl_relighter_create(&r, &small, &source, 1, &fixture_log), RELUME_OK);
    check_lights(&r, &w, "few texels", &light, 1);
    gl_relighter_destroy(&r);
    world_close(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parallel_rays),
        cmocka_unit_test(a_turned_slab),
        cmocka_unit_test(rooms),
        cmocka_unit_test(highlights),
        cmocka_unit_test(triangles_that_no_texture_holds),
    };
    return cmocka_run_group_tests(tests, open_all, close_all);
}
