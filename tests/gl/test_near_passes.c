// Near lights and environments on the GPU against the library, for every kind of coefficients; and
// views that are read in the background
//
// Compares: light/captured.glsl, light/light.glsl, light/light_patches.glsl, light/triangles.glsl,
// near.frag.glsl, shared/pole.glsl, shared/triangles.glsl, shared/weight_grid.glsl with cells.c,
// coder.c, directions.c, gonio.c, light.c, near_lights.c, triangles.c, vec.h, zone.c.
#include "format/coder/coding.h"
#include "relight/light/environment.h"
#include "relight/light/refit.h"

#include "fixture.h"
#include "test.h"

#include <time.h>

enum { W = 33, H = 21, MOST_CODES = 300 };

static struct relume_image slide;
static relume_ies *lamp;
static relume_environment *sky;
static relume_gonio *faces;

static const char lamp_text[] = "IESNA:LM-63-1995\nTILT=NONE\n"
                                "1 1000 1 4 4 1 2 0 0 0\n1 1 10\n"
                                "0 30 60 90\n0 30 60 90\n"
                                "100 80 40 0\n100 90 20 0\n100 60 50 0\n100 80 10 0\n";

static int open_all(void **state)
{
    struct relume_image map;
    if (fixture_open(state) || relume_image_create(&slide, 6, 4, 3) ||
        relume_image_create(&map, 32, 16, 3))
        return -1;
    for (int i = 0; i < 6 * 4 * 3; i++)
        slide.data[i] = 0.2f + 0.1f * (float)(i * 7 % 9);
    for (int i = 0; i < 32 * 16 * 3; i++)
        map.data[i] = i % 97 == 3 ? 20.0f : 0.1f * (float)(i % 5);
    relume_status status = relume_environment_create(&sky, &map, NULL);
    for (int i = 0; i < 32 * 16 * 3; i++)
        map.data[i] = 0.2f + 0.1f * (float)(i * 7 % 11);
    if (!status)
        status = relume_gonio_create(&faces, &map, NULL);
    relume_image_destroy(&map);
    return status || relume_ies_parse(&lamp, lamp_text, sizeof lamp_text - 1, "lamp", &fixture_log);
}

static int close_all(void **state)
{
    relume_image_destroy(&slide);
    relume_ies_destroy(&lamp);
    relume_gonio_destroy(&faces);
    relume_environment_destroy(&sky);
    return fixture_close(state);
}

// A tilted wavy surface with a hole of background.
static relume_status find_surface(struct relume_image *out, void *user, int view)
{
    (void)user;
    const relume_status status = relume_image_create(out, W, H, 3);
    for (int i = 0; !status && i < W * H; i++) {
        const double x = 2.0 * (i % W) / W - 1.0, y = 1.0 - 2.0 * (i / W) / (double)H;
        const bool hole = i % W > 20 && i % W < 24 && i / W < 6;
        float *p = out->data + 3 * i;
        p[0] = (float)x;
        p[1] = (float)y;
        p[2] = hole ? INFINITY : (float)(0.2 * x + 0.1 * sin(4.0 * y) + 0.05 * view);
    }
    return status;
}

static struct relume_light light_of(enum relume_light_kind kind)
{
    return (struct relume_light){
        .kind = kind,
        .direction = kind == RELUME_LIGHT_DIRECTIONAL ? (struct relume_vec3){0.2, 0.3, 0.8}
                                                      : (struct relume_vec3){0.1, -0.2, -1},
        .position = {0.3, 0.4, 1.5},
        .u = {0.5, 0, 0.1},
        .v = {0, -0.4, 0},  // u x v points at the surface
        .half_angle_deg = kind == RELUME_LIGHT_SPOT ? 30 : 25,
        .rotate_deg = 40,
        .rgb = {1, 0.9f, 0.7f},
        .image = &slide,
        .environment = sky,
        .ies = lamp,
        .gonio = faces,
    };
}

struct source_file {
    struct relume_codes codes;
};

static relume_status fetch(const struct relume_codes **out, void *user, int view)
{
    (void)view;
    *out = &((struct source_file *)user)->codes;
    return RELUME_OK;
}

// The grid of weights is kept as half floats (2^-11 of each of up to 30 products near 1, in random
// directions: 3e-3 at the very worst) and both sides must agree to 1/255 of white.
static const double BOUND = 1.0 / 255;

static void check_kind(struct gl_relighter *r, const struct relume_codes *codes, const char *name,
                       enum relume_light_kind kind, const struct relume_relight_params *shared)
{
    const struct relume_light lights[] = {light_of(kind), light_of(RELUME_LIGHT_DIRECTIONAL)};
    struct relume_image surface, want = {0}, got;
    const struct target *target;
    char what[96];
    struct relume_relight_params params = *shared;
    assert_int_equal(find_surface(&surface, NULL, 0), RELUME_OK);
    params.surface = &surface;
    for (int n = 1; n <= 2; n++) {
        snprintf(what, sizeof what, "%s, %s, %d lights", name, relume_light_kind_name(kind), n);
        assert_int_equal(relume_relight(&want, codes, lights, n, &params), RELUME_OK);
        assert_int_equal(gl_relighter_begin(r, lights, n), RELUME_OK);
        assert_int_equal(gl_relighter_view(&target, r, 0), RELUME_OK);
        assert_int_equal(target_read(&got, target, &fixture_gl), RELUME_OK);
        assert_below(what, fixture_difference(&got, &want), BOUND);
        double sum = 0;
        for (int i = 0; i < 3 * W * H; i++)
            sum += fabs((double)got.data[i]);
        assert_true(sum > 1.0);  // something arrived
        relume_image_destroy(&got);
        relume_image_destroy(&want);
    }
    relume_image_destroy(&surface);
}

static void check_codes(const struct relume_codes *codes, const char *name)
{
    struct source_file file = {*codes};
    const struct code_source source = {fetch, NULL, &file, find_surface, NULL};
    struct gl_relighter r;
    relume_weight_grid *grid;
    relume_refit *refit = NULL;
    if (TEST_SANITIZED && codes->domain == RELUME_DOMAIN_DISPLAY)
        return;
    assert_int_equal(relume_weight_grid_create(&grid, codes->coder, NULL), RELUME_OK);
    if (codes->domain == RELUME_DOMAIN_DISPLAY)
        assert_int_equal(relume_refit_create(&refit, codes, NULL), RELUME_OK);
    assert_int_equal(gl_relighter_create(&r, &fixture_gl, &source, 1, &fixture_log), RELUME_OK);
    for (int kind = RELUME_LIGHT_ENVIRONMENT; kind <= RELUME_LIGHT_GONIO; kind++)
        check_kind(&r, codes, name, (enum relume_light_kind)kind,
                   relume_relight_params(.grid = grid, .refit = refit));
    gl_relighter_destroy(&r);
    relume_refit_destroy(&refit);
    relume_weight_grid_destroy(&grid);
}

static void check_storage(enum relume_storage storage, enum relume_domain domain, bool pole_y,
                          const char *name)
{
    struct fixture_file f = fixture_make(1, W, H, storage, domain, pole_y);
    const struct relume_codes *codes;
    assert_int_equal(fixture_fetch(&codes, &f, 0), RELUME_OK);
    check_codes(codes, name);
    fixture_free(&f);
}

// With a delta at which the values here, sums of codes that no photograph has, stay near white.
static void logarithms(void **state)
{
    (void)state;
    struct fixture_file f = fixture_make(1, W, H, RELUME_STORE_12, RELUME_DOMAIN_DISPLAY, false);
    const struct relume_codes *codes;
    f.codes[0].display = (struct relume_transfer){.curve = RELUME_CURVE_LOG, .gamma = 0.5f};
    assert_int_equal(fixture_fetch(&codes, &f, 0), RELUME_OK);
    check_codes(codes, "sh 9, 12 bits, log");
    fixture_free(&f);
}

static void separate_channels(void **state)
{
    (void)state;
    check_storage(RELUME_STORE_8, RELUME_DOMAIN_LINEAR, false, "sh 9, 8 bits, linear");
    check_storage(RELUME_STORE_HALF, RELUME_DOMAIN_LINEAR, true, "sh 9, half, linear, y up");
    check_storage(RELUME_STORE_12, RELUME_DOMAIN_DISPLAY, false, "sh 9, 12 bits, display");
}

// The same codes under another coder, on one hemisphere.
static void check_dome(const struct relume_basis *basis, struct relume_coder_params p,
                       enum relume_domain domain, double lowest, const char *name)
{
    struct fixture_file f = fixture_make(1, W, H, RELUME_STORE_8, domain, false);
    const struct relume_codes *codes;
    struct relume_vec3 lights[FIXTURE_LIGHTS];
    relume_coder *coder;
    assert_int_equal(relume_directions_make(lights, FIXTURE_LIGHTS,
                                            relume_pattern_find("hammersley"),
                                            relume_directions_params(.hemisphere = true)),
                     RELUME_OK);
    for (int i = 0; i < FIXTURE_LIGHTS; i++) {
        const double z = lowest + (1.0 - lowest) * lights[i].z;
        const double r = sqrt((1.0 - z * z) / (1.0 - lights[i].z * lights[i].z + 1e-12));
        lights[i] = (struct relume_vec3){r * lights[i].x, r * lights[i].y, z};
    }
    p.hemispherical = true;
    p.decode = true;
    assert_int_equal(relume_coder_create(&coder, basis, lights, FIXTURE_LIGHTS, &p), RELUME_OK);
    relume_coder_destroy(&f.coder);
    f.coder = coder;
    f.codes[0].coder = coder;
    f.codes[0].planes = relume_coder_info(coder)->planes;
    assert_true(f.codes[0].planes <= FIXTURE_PLANES);
    assert_int_equal(fixture_fetch(&codes, &f, 0), RELUME_OK);
    check_codes(codes, name);
    fixture_free(&f);
}

static void check_coder(const struct relume_basis *basis, struct relume_coder_params p,
                        enum relume_domain domain, const char *name)
{
    check_dome(basis, p, domain, 0.0, name);
}

// Near lights beyond what was captured: lamps above 76 degrees only.
static void high_domes(void **state)
{
    (void)state;
    check_dome(&relume_basis_ptm, (struct relume_coder_params){.coefficients = 6},
               RELUME_DOMAIN_LINEAR, 0.97, "ptm, high dome");
    check_dome(&relume_basis_hsh, (struct relume_coder_params){.coefficients = 9},
               RELUME_DOMAIN_DISPLAY, 0.97, "hsh 9, display, high dome");
}

static void other_bases(void **state)
{
    (void)state;
    check_coder(&relume_basis_ptm, (struct relume_coder_params){.coefficients = 6},
                RELUME_DOMAIN_LINEAR, "ptm");
    check_coder(&relume_basis_hsh, (struct relume_coder_params){.coefficients = 9},
                RELUME_DOMAIN_DISPLAY, "hsh 9, display");
    check_coder(&relume_basis_dct, (struct relume_coder_params){.coefficients = 6},
                RELUME_DOMAIN_LINEAR, "dct 6");
    check_coder(&relume_basis_ptm,
                (struct relume_coder_params){.coefficients = 6, .luminance = true},
                RELUME_DOMAIN_LINEAR, "ptm, luminance");
}

static void components(void **state)
{
    (void)state;
    static float transform[3 * 27 * FIXTURE_LIGHTS], mean[3 * FIXTURE_LIGHTS];
    uint64_t random = 3;
    for (size_t i = 0; i < sizeof transform / sizeof *transform; i++)
        transform[i] = (float)(0.4 * uniform(&random) - 0.2);
    for (int i = 0; i < 3 * FIXTURE_LIGHTS; i++)
        mean[i] = (float)uniform(&random);
    static const char *const interpolants[] = {"angular",
                                               "delaunay"};  // a grid with tiles, and triangles
    for (int i = 0; i < 2; i++) {
        char name[64];
        snprintf(name, sizeof name, "pca 26, %s, %s", interpolants[i], i ? "linear" : "display");
        check_coder(
            &relume_basis_pca,
            (struct relume_coder_params){.coefficients = 26,
                                         .transform = transform,
                                         .mean = mean,
                                         .interpolant = relume_interpolant_find(interpolants[i])},
            i ? RELUME_DOMAIN_LINEAR : RELUME_DOMAIN_DISPLAY, name);
    }
}

static void codebooks(void **state)
{
    (void)state;
    static float vectors[2][MOST_CODES * FIXTURE_PLANES];
    static uint16_t index[2][W * H];
    static const int counts[2] = {MOST_CODES, 70};
    uint64_t random = 5;
    relume_coder *coder = fixture_coder(false);
    for (int b = 0; b < 2; b++) {
        for (int i = 0; i < counts[b] * FIXTURE_PLANES; i++)
            vectors[b][i] = (float)((i % FIXTURE_PLANES < 3 ? 1.0 : 0.2) * uniform(&random) - 0.1);
        for (int i = 0; i < W * H; i++)
            index[b][i] = (uint16_t)(counts[b] * uniform(&random));
    }
    for (int k = 0; k < 2; k++) {  // how many books and in which domain know nothing of each other
        const struct relume_codes codes = {
            .coder = coder,
            .domain = k ? RELUME_DOMAIN_DISPLAY : RELUME_DOMAIN_LINEAR,
            .display = {.curve = RELUME_CURVE_SRGB},
            .width = W,
            .height = H,
            .planes = FIXTURE_PLANES,
            .books = 1 + k,
            .index = (const uint16_t *const[]){index[0], index[1]},
            .vectors = (const float *const[]){vectors[0], vectors[1]},
            .book_codes = counts,
        };
        char name[64];
        snprintf(name, sizeof name, "%d codebooks, %s", codes.books, k ? "display" : "linear");
        check_codes(&codes, name);
    }
    relume_coder_destroy(&coder);
}

static void without_a_surface(void **state)
{
    (void)state;
    struct fixture_file f = fixture_make(1, W, H, RELUME_STORE_8, RELUME_DOMAIN_LINEAR, false);
    const struct code_source source = {fixture_fetch, NULL, &f, NULL, NULL};
    const struct relume_light light = light_of(RELUME_LIGHT_POINT);
    struct gl_relighter r;
    const struct target *target;
    assert_int_equal(gl_relighter_create(&r, &fixture_gl, &source, 1, &fixture_log), RELUME_OK);
    assert_int_equal(gl_relighter_begin(&r, &light, 1), RELUME_OK);
    assert_int_equal(gl_relighter_view(&target, &r, 0), RELUME_EUNFIT);
    assert_null(target);
    gl_relighter_destroy(&r);
    fixture_free(&f);
}

// ---------------------------------------------------------------- in the background

static relume_status fetch_slowly(const struct relume_codes **out, void *user, int view)
{
    nanosleep(&(const struct timespec){0, 3000000}, NULL);
    return fixture_fetch(out, user, view);
}

static void views_arrive_later(void **state)
{
    (void)state;
    struct fixture_file f = fixture_make(4, W, H, RELUME_STORE_8, RELUME_DOMAIN_LINEAR, false);
    const struct code_source source = {fetch_slowly, NULL, &f, find_surface, NULL};
    const struct relume_light lights[] = {light_of(RELUME_LIGHT_DIRECTIONAL),
                                          light_of(RELUME_LIGHT_POINT)};
    const struct target *target;
    struct gl_relighter r;
    int frames = 0;
    assert_int_equal(gl_relighter_create(&r, &fixture_gl, &source, 4, &fixture_log), RELUME_OK);
    assert_int_equal(gl_relighter_stream(&r), RELUME_OK);
    for (bool all = false; !all; frames++) {
        all = true;
        assert_int_equal(gl_relighter_begin(&r, lights, 2), RELUME_OK);
        for (int i = 0; i < 4; i++) {
            assert_int_equal(gl_relighter_view(&target, &r, i), RELUME_OK);
            assert_true(frames > 0 || !target);
            all &= target != NULL;
        }
        assert_true(r.pending == !all);
    }
    assert_int_equal(f.asked, 4);  // each once
    for (int i = 0; i < 4; i++) {
        struct relume_image surface, want = {0}, got;
        assert_int_equal(find_surface(&surface, NULL, i), RELUME_OK);
        assert_int_equal(relume_relight(&want, &f.codes[i], lights, 2,
                                        relume_relight_params(.surface = &surface)),
                         RELUME_OK);
        assert_int_equal(gl_relighter_view(&target, &r, i), RELUME_OK);
        assert_int_equal(target_read(&got, target, &fixture_gl), RELUME_OK);
        assert_below("read in the background", fixture_difference(&got, &want), BOUND);
        relume_image_destroy(&surface);
        relume_image_destroy(&want);
        relume_image_destroy(&got);
    }
    gl_relighter_destroy(&r);
    fixture_free(&f);
}

static void a_view_can_be_waited_for(void **state)
{
    (void)state;
    struct fixture_file f = fixture_make(3, W, H, RELUME_STORE_8, RELUME_DOMAIN_LINEAR, false);
    const struct code_source source = {fetch_slowly, NULL, &f, NULL, NULL};
    const struct relume_light light = light_of(RELUME_LIGHT_DIRECTIONAL);
    const struct target *target;
    struct gl_relighter r;
    assert_int_equal(gl_relighter_create(&r, &fixture_gl, &source, 3, &fixture_log), RELUME_OK);
    assert_int_equal(gl_relighter_stream(&r), RELUME_OK);
    assert_int_equal(gl_relighter_begin(&r, &light, 1), RELUME_OK);
    assert_int_equal(gl_relighter_view(&target, &r, 0), RELUME_OK);
    assert_null(target);
    assert_int_equal(gl_relighter_wait(&target, &r, 2), RELUME_OK);
    assert_non_null(target);
    assert_true(gl_relighter_has(&r, 2));
    gl_relighter_destroy(&r);  // view 0 or 1 may just be read
    fixture_free(&f);
}

static relume_status refuse(const struct relume_codes **out, void *user, int view)
{
    (void)user, (void)view;
    *out = NULL;
    return RELUME_EDAMAGED;
}

static void a_broken_view_is_heard_of(void **state)
{
    (void)state;
    const struct code_source source = {refuse, NULL, NULL, NULL, NULL};
    const struct relume_light light = light_of(RELUME_LIGHT_DIRECTIONAL);
    const struct target *target;
    struct gl_relighter r;
    assert_int_equal(gl_relighter_create(&r, &fixture_gl, &source, 1, &fixture_log), RELUME_OK);
    assert_int_equal(gl_relighter_stream(&r), RELUME_OK);
    assert_int_equal(gl_relighter_begin(&r, &light, 1), RELUME_OK);
    assert_int_equal(gl_relighter_wait(&target, &r, 0), RELUME_EDAMAGED);
    assert_null(target);
    gl_relighter_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(separate_channels),
        cmocka_unit_test(logarithms),
        cmocka_unit_test(other_bases),
        cmocka_unit_test(high_domes),
        cmocka_unit_test(components),
        cmocka_unit_test(codebooks),
        cmocka_unit_test(without_a_surface),
        cmocka_unit_test(views_arrive_later),
        cmocka_unit_test(a_view_can_be_waited_for),
        cmocka_unit_test(a_broken_view_is_heard_of),
    };
    return cmocka_run_group_tests(tests, open_all, close_all);
}
