// Views relit by the library behind the relighter: the same pictures, light by light, and no more
// work than the light that moved
#include "fixture.h"

#include "app/light_list.h"
#include "relight/light/environment.h"
#include "relight/light/refit.h"

enum { W = 23, H = 17, MANY = 40 };

static struct relume_image sky_map;
static relume_environment *sky;

static int open_all(void **state)
{
    if (fixture_open(state) || relume_image_create(&sky_map, 32, 16, 3))
        return -1;
    for (int i = 0; i < 32 * 16 * 3; i++)
        sky_map.data[i] = 0.1f * (float)(i % 7);
    return relume_environment_create(&sky, &sky_map, NULL);
}

static int close_all(void **state)
{
    relume_image_destroy(&sky_map);
    relume_environment_destroy(&sky);
    return fixture_close(state);
}

// A source that counts who looks at codes.
struct lender {
    struct fixture_file file;
    int lent;
    relume_weight_grid *grid;  // of its coder, for what is wanted
    relume_refit *refit;       // of view 0, likewise
};

static relume_status lend(const struct relume_codes **out, void *user, int view)
{
    struct lender *l = user;
    l->lent++;
    return fixture_fetch(out, &l->file, view);
}

static void take_back(void *user, int view)
{
    (void)view;
    ((struct lender *)user)->lent--;
}

static relume_status find_surface(struct relume_image *out, void *user, int view)
{
    (void)user;
    const relume_status status = relume_image_create(out, W, H, 3);
    for (int i = 0; !status && i < W * H; i++) {
        out->data[3 * i] = 2.0f * (float)(i % W) / W - 1.0f;
        out->data[3 * i + 1] = 1.0f - 2.0f * (float)(i / W) / H;
        out->data[3 * i + 2] = i % 5 == 0 ? NAN : 0.1f * (float)view;
    }
    return status;
}

static struct lender make_lender(int views, enum relume_domain domain)
{
    struct lender l = {.file = fixture_make(views, W, H, RELUME_STORE_8, domain, false)};
    assert_int_equal(relume_weight_grid_create(&l.grid, l.file.coder, NULL), RELUME_OK);
    const struct relume_codes *codes;
    assert_int_equal(fixture_fetch(&codes, &l.file, 0), RELUME_OK);
    if (domain == RELUME_DOMAIN_DISPLAY)
        assert_int_equal(relume_refit_create(&l.refit, codes, NULL), RELUME_OK);
    return l;
}

// All that was lent has been given back.
static void free_lender(struct lender *l)
{
    assert_int_equal(l->lent, 0);
    relume_weight_grid_destroy(&l->grid);
    relume_refit_destroy(&l->refit);
    fixture_free(&l->file);
}

static struct code_source source_of(struct lender *l)
{
    return (struct code_source){lend, take_back, l, find_surface, NULL};
}

static void begin(struct gl_relighter *r, const struct gl *gl, struct lender *l, int views)
{
    const struct code_source source = source_of(l);
    assert_int_equal(gl_relighter_create(r, gl, &source, views, &fixture_log), RELUME_OK);
}

static void make_lights(struct relume_light *lights, int n)
{
    static const enum relume_light_kind kinds[] = {RELUME_LIGHT_DIRECTIONAL, RELUME_LIGHT_POINT,
                                                   RELUME_LIGHT_SPOT, RELUME_LIGHT_ENVIRONMENT};
    for (int i = 0; i < n; i++)
        lights[i] = (struct relume_light){
            .kind = kinds[i % 4],
            .direction = {0.1 * (i % 3), 0.2, i % 4 == 2 ? -1.0 : 1.0},
            .position = {cos(i), sin(i), 1.5},
            .half_angle_deg = 20 + i % 9,
            .rotate_deg = 10.0 * i,
            .environment = sky,
            .rgb = {1.0f / (float)n, 0.9f / (float)n, 0.7f / (float)n},
        };
}

static void expect_view(struct gl_relighter *r, struct lender *l, int view,
                        const struct relume_light *lights, int n, double bound, const char *what)
{
    struct relume_image surface, want = {0}, got;
    const struct relume_codes *codes;
    const struct target *target;
    assert_int_equal(find_surface(&surface, NULL, view), RELUME_OK);
    assert_int_equal(fixture_fetch(&codes, &l->file, view), RELUME_OK);
    assert_int_equal(relume_relight(&want, codes, lights, n,
                                    relume_relight_params(.surface = &surface, .grid = l->grid,
                                                          .refit = l->refit)),
                     RELUME_OK);
    assert_int_equal(gl_relighter_begin(r, lights, n), RELUME_OK);
    assert_int_equal(gl_relighter_view(&target, r, view), RELUME_OK);
    assert_int_equal(target_read(&got, target, &fixture_gl), RELUME_OK);
    assert_below(what, fixture_difference(&got, &want), bound);
    relume_image_destroy(&surface);
    relume_image_destroy(&want);
    relume_image_destroy(&got);
}

// Sums of up to 40 floats near 1 in another order; environments of the display domain, of random
// codes, decode to tens.
static const double BOUND = 2e-5, BOUND_DISPLAY = 5e-4;

static void same_as_relight(void **state)
{
    (void)state;
    static const enum relume_domain domains[] = {RELUME_DOMAIN_LINEAR, RELUME_DOMAIN_DISPLAY};
    struct relume_light lights[MANY];
    for (int d = 0; d < 2; d++) {
        const double bound = d ? BOUND_DISPLAY : BOUND;
        struct lender l = make_lender(2, domains[d]);
        struct gl_relighter r;
        begin(&r, &fixture_gl, &l, 2);
        r.by_library = true;
        static const int counts[] = {1, 2, 4, MANY};
        for (int i = 0; i < 4; i++) {
            const int n = counts[i];
            make_lights(lights, n);
            expect_view(&r, &l, 0, lights, n, bound, d ? "display" : "linear");
        }
        lights[1].position.x += 0.1;
        expect_view(&r, &l, 0, lights, MANY, bound, "one of many moved");
        expect_view(&r, &l, 1, lights, 3, bound, "another view");
        expect_view(&r, &l, 0, lights, 0, BOUND, "darkness");
        gl_relighter_destroy(&r);
        free_lender(&l);
    }
}

// A view that leaves gives its codes back.
static void codes_are_given_back(void **state)
{
    (void)state;
    struct lender l = make_lender(3, RELUME_DOMAIN_LINEAR);
    struct relume_light lights[2];
    struct gl_relighter r;
    begin(&r, &fixture_gl, &l, 3);
    r.by_library = true;
    r.memory.most = 1;
    make_lights(lights, 2);
    for (int i = 0; i < 6; i++) {
        expect_view(&r, &l, i % 3, lights, 2, BOUND, "in turn");
        assert_int_equal(l.lent, 1);
        // two groups, their sum and the surface, three floats each; the target, four; the codes
        assert_int_equal(r.memory.bytes, W * H * (4 * 12 + 16 + 4 * ((FIXTURE_PLANES + 3) / 4)));
    }
    gl_relighter_destroy(&r);
    free_lender(&l);
}

// Planes that take several array textures: near lights go by the library, the others by passes.
static void near_lights_on_many_planes(void **state)
{
    (void)state;
    struct lender l = make_lender(1, RELUME_DOMAIN_DISPLAY);
    struct relume_light lights[3];
    struct gl narrow = fixture_gl;
    struct gl_relighter r;
    narrow.max_layers = 2;
    begin(&r, &narrow, &l, 1);
    make_lights(lights, 3);
    expect_view(&r, &l, 0, lights, 3, 1.0 / 255, "several arrays");
    assert_true(r.view[0].arrays > 1);
    gl_relighter_destroy(&r);
    free_lender(&l);
}

static void without_a_surface(void **state)
{
    (void)state;
    struct lender l = make_lender(1, RELUME_DOMAIN_LINEAR);
    const struct code_source source = {lend, take_back, &l, NULL, NULL};
    const struct relume_light light = {
        .kind = RELUME_LIGHT_POINT, .position = {0, 0, 1}, .rgb = {1, 1, 1}};
    const struct target *target;
    struct gl_relighter r;
    assert_int_equal(gl_relighter_create(&r, &fixture_gl, &source, 1, &fixture_log), RELUME_OK);
    r.by_library = true;
    assert_int_equal(gl_relighter_begin(&r, &light, 1), RELUME_OK);
    assert_int_equal(gl_relighter_view(&target, &r, 0), RELUME_EUNFIT);
    assert_null(target);
    gl_relighter_destroy(&r);
    free_lender(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(codes_are_given_back),
        cmocka_unit_test(near_lights_on_many_planes),
        cmocka_unit_test(same_as_relight),
        cmocka_unit_test(without_a_surface),
    };
    return cmocka_run_group_tests(tests, open_all, close_all);
}
