// test_environment.c - maps of distant light: solid angles, directions, and the one weight vector
// that they fold into, against sums over the map
#include "flat_coder.h"

#include "core/math/vec.h"
#include "format/coder/coding.h"
#include "relight/light/environment.h"
#include "learned_fixture.h"

static struct test_log heard;

static relume_environment *create(const struct relume_image *map)
{
    relume_environment *e;
    test_log_init(&heard);
    CHECK_OK(relume_environment_create(
        &e, map, relume_environment_params(.log = &heard.log, .name = "map")));
    return e;
}

static struct relume_image map_of(int width, int height, float value)
{
    struct relume_image map;
    CHECK_OK(relume_image_create(&map, width, height, 3));
    for (int i = 0; i < width * height * 3; i++)
        map.data[i] = value;
    return map;
}

// All of a uniform map of radiance 1: 4 pi / pi; its mean direction is none.
static void test_solid_angles(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {2, 1}, {7, 3}, {64, 32}, {300, 151}, {1100, 550}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct relume_image map = map_of(sizes[i][0], sizes[i][1], 1);
        relume_environment *e = create(&map);
        double sum = 0, x = 0, y = 0, z = 0, above = 0;
        int n;
        const struct relume_environment_cell *cell = relume_environment_cells(&n, e);
        assert_true(n <= 256 * 128);
        for (int k = 0; k < n; k++) {
            const struct relume_vec3 d = cell[k].direction;
            CHECK_NEAR(vec3_dot(d, d), 1, 1e-9);
            sum += (double)cell[k].rgb[1];
            x += (double)cell[k].rgb[1] * d.x;
            y += (double)cell[k].rgb[1] * d.y;
            z += (double)cell[k].rgb[1] * d.z;
            above += d.y > 0 ? (double)cell[k].rgb[2] * d.y : 0;
        }
        CHECK_NEAR(sum, 4, 1e-5);  // float cells
        CHECK_NEAR(fabs(x) + fabs(z), 0, 1e-5);
        CHECK_NEAR(y, 0, 1e-5);
        CHECK_NEAR(above, 1, 5e-4);  // cos-weighted upper half; cells of 1.4 degrees
        relume_environment_destroy(&e);
        relume_image_destroy(&map);
    }
}

// One bright pixel: its own direction, though its cell holds 64 pixels; and where it turns to.
static void test_directions(void **state)
{
    (void)state;
    struct relume_image map = map_of(2048, 1024, 0);
    map.data[3 * (300 * 2048 + 1411)] = 7;
    relume_environment *e = create(&map);
    int n;
    const struct relume_environment_cell *cell = relume_environment_cells(&n, e);
    assert_int_equal(n, 1);
    const double phi = (1411.5 / 2048 * 360 - 180) * M_PI / 180;
    const double elevation = (90 - 300.5 / 1024 * 180) * M_PI / 180;
    CHECK_NEAR(cell->direction.x, sin(phi) * cos(elevation), 1e-9);
    CHECK_NEAR(cell->direction.y, sin(elevation), 1e-9);
    CHECK_NEAR(cell->direction.z, -cos(phi) * cos(elevation), 1e-9);
    const double dw = 2 * M_PI / 2048 * M_PI / 1024 * cos(elevation);
    CHECK_NEAR((double)cell->rgb[0] / (7 * dw / M_PI), 1, 1e-4);  // sin of a thin row
    const struct relume_image *shown = relume_environment_map(e);
    assert_true(shown->width == 1024 && shown->height == 512);
    CHECK_NEAR(shown->data[3 * (150 * 1024 + 705)], 7.0 / 4, 1e-6);
    relume_environment_destroy(&e);
    relume_image_destroy(&map);
    const struct relume_vec3 turned = relume_environment_turn((struct relume_vec3){0, 0, -1}, 90);
    CHECK_NEAR(turned.x, 1, 1e-12);  // from -z towards +x
    const struct relume_vec3 back = relume_environment_turn((struct relume_vec3){0.6, 0.8, 0}, -90);
    CHECK_NEAR(back.z, -0.6, 1e-12);
    CHECK_NEAR(back.y, 0.8, 0);
}

static void test_oddities(void **state)
{
    (void)state;
    struct relume_image map = map_of(8, 4, 1);
    relume_environment *e = create(&map);
    assert_int_equal(heard.lines, 0);
    relume_environment_destroy(&e);
    map.data[0] = NAN;
    map.data[4] = -1;
    map.data[8] = INFINITY;
    e = create(&map);
    assert_int_equal(heard.lines, 1);
    assert_non_null(strstr(heard.text, "map: 3 pixels are negative, not finite"));
    int n;
    const struct relume_environment_cell *cell = relume_environment_cells(&n, e);
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += (double)cell[i].rgb[0] + (double)cell[i].rgb[1] + (double)cell[i].rgb[2];
    assert_true(sum > 11 && sum < 12);
    relume_environment_destroy(&e);
    relume_image_destroy(&map);
    map = map_of(9, 4, 1);
    e = create(&map);
    assert_non_null(strstr(heard.text, "9 x 4 pixels; expected a map twice as wide as high"));
    relume_environment_destroy(&e);
    map.channels = 1;
    assert_int_equal(relume_environment_create(&e, &map, NULL), RELUME_EINVAL);
    assert_null(e);
    map.channels = 3;
    relume_image_destroy(&map);
    assert_int_equal(relume_environment_load(&e, "/nonexistent.hdr", NULL), RELUME_ENOTFOUND);
    map = map_of(4, 2, 0);  // a black map is fine and gives nothing
    e = create(&map);
    struct relume_light out[3];
    const struct relume_light light = {
        .kind = RELUME_LIGHT_ENVIRONMENT, .environment = e, .rgb = {1, 1, 1}};
    CHECK_OK(relume_environment_sample(out, 3, &light, 1));
    assert_true(out[2].rgb[0] == 0.0f && out[2].direction.y == 1.0);
    relume_environment_destroy(&e);
    relume_image_destroy(&map);
}

// ---------------------------------------------------------------- weights

enum { MAP_W = 24, MAP_H = 12, CUT = 10 };

// Over flat triangles, or NULL: a direction is the sum of the lights by its weights.
static relume_coder *triangles_coder(const relume_coder *coder)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    struct relume_coder_triangles unused;
    relume_coder *out = NULL;
    if (info->basis == &relume_basis_table || relume_coder_hull(&unused, coder))
        CHECK_OK(relume_coder_create(
            &out, &relume_basis_table, info->directions, info->lights,
            relume_coder_params(.hemispherical = info->hemispherical, .pole_y = info->pole_y,
                                .interpolant = relume_interpolant_find("delaunay"))));
    return out;
}

static struct relume_vec3 shown_for(struct relume_vec3 from, const relume_coder *triangles)
{
    struct relume_vec3 sum = {0, 0, 0};
    float weights[LEARNED_PLANES], constant[3];
    if (!triangles)
        return from;
    const struct relume_coder_info *info = relume_coder_info(triangles);
    relume_coder_weights(triangles, from, weights, constant);
    for (int i = 0; i < info->lights; i++)
        sum = vec3_along(sum, info->directions[i], (double)weights[i]);
    return sum;
}

// Light from between lamps and from beyond them, as docs/lights.md has it.
static double share_of(const struct relume_coder_info *info, const relume_coder *coder,
                       const relume_coder *triangles, struct relume_vec3 d,
                       struct relume_vec3 *from)
{
    const double lone = relume_coder_clamp(from, coder, d);
    if (info->pole_y || !info->hemispherical)
        return lone;
    const struct relume_vec3 shown = shown_for(*from, triangles);
    if (d.z >= shown.z)
        return fmin(d.z / shown.z, 1.25);
    const double r = fmin(0.05 / (shown.z + 0.05), 0.25);
    return r + (1 - r) * pow(d.z / shown.z, 1 / (1 - 2 * r));
}

// Sum over the map in CUT x CUT pieces a pixel, the basis evaluated at each: in double.
static void slow(double *sum, const struct learned *l, const struct relume_image *map,
                 double rotate, const float tint[3])
{
    const struct relume_coder_info *info = relume_coder_info(l->coder);
    const int k = info->coefficients;
    float weights[LEARNED_PLANES], constant[3];
    relume_coder *flat = flat_coder(l->coder), *triangles = triangles_coder(l->coder);
    memset(sum, 0, (size_t)(3 * k + 3) * sizeof *sum);
    for (int y = 0; y < MAP_H * CUT; y++)
        for (int x = 0; x < MAP_W * CUT; x++) {
            const double phi = ((x + 0.5) / (MAP_W * CUT) * 360 - 180 + rotate) * M_PI / 180;
            const double top = M_PI * y / (MAP_H * CUT), low = M_PI * (y + 1) / (MAP_H * CUT);
            const double theta = (top + low) / 2;
            const double dw = 2 * M_PI / (MAP_W * CUT) * (cos(top) - cos(low));
            const struct relume_vec3 d = {sin(phi) * sin(theta), cos(theta),
                                          -cos(phi) * sin(theta)};
            if (info->hemispherical && (info->pole_y ? d.y : d.z) < 0)
                continue;
            struct relume_vec3 from;
            const double share = share_of(info, l->coder, triangles, d, &from);
            relume_coder_weights(flat ? flat : l->coder, from, weights, constant);
            const float *e = map->data + 3 * (y / CUT * MAP_W + x / CUT);
            for (int c = 0; c < 3; c++) {
                const double f = share * (double)e[c] * (double)tint[c] * dw / M_PI;
                for (int i = 0; i < k; i++)
                    sum[c * k + i] += f * (double)weights[c * k + i];
                sum[3 * k + c] += f * (double)constant[c];
            }
        }
    relume_coder_destroy(&flat);
    relume_coder_destroy(&triangles);
}

static void fold(float *weights, float constant[3], const struct learned *l,
                 const struct relume_light *light)
{
    relume_weight_grid *grid;
    // A third as fine as usual: sums over half the sphere do not see it. Triangles as usual.
    const int steps = relume_coder_info(l->coder)->basis == &relume_basis_table ? 0 : 32;
    CHECK_OK(relume_weight_grid_create(&grid, l->coder, relume_weight_grid_params(.steps = steps)));
    memset(weights, 0, LEARNED_PLANES * sizeof *weights);
    memset(constant, 0, 3 * sizeof *constant);
    relume_environment_weights(weights, constant, grid, light);
    relume_weight_grid_destroy(&grid);
}

static void check_pixels(const struct learned *l, const float *weights, const float constant[3],
                         const double *sum)
{
    const int k = relume_coder_info(l->coder)->coefficients;
    float want[LEARNED_PLANES], base[3];
    for (int i = 0; i < 3 * k; i++)
        want[i] = (float)sum[i];
    for (int c = 0; c < 3; c++)
        base[c] = (float)sum[3 * k + c];
    for (int x = 0; x < LEARNED_PIXELS; x++)
        for (int c = 0; c < 3; c++)
            // Cells of 1.4 degrees that the horizon cuts, the weight grid; radiance up to 2.
            CHECK_NEAR(learned_show(l, x, c, weights, constant), learned_show(l, x, c, want, base),
                       5e-3);
}

// A map of random radiance under every basis: what a sum over its directions says, turned too.
static void test_weights(void **state)
{
    (void)state;
    uint32_t seed = 11;
    struct relume_image map = map_of(MAP_W, MAP_H, 0);
    for (int i = 0; i < MAP_W * MAP_H * 3; i++)
        map.data[i] = (float)(2 * test_uniform(&seed));
    relume_environment *e = create(&map);
    struct relume_light light = {.kind = RELUME_LIGHT_ENVIRONMENT,
                                 .environment = e,
                                 .rotate_deg = 37,
                                 .rgb = {1, 0.5f, 0.25f}};
    for (const struct relume_basis *const *b = relume_bases; *b; b++)
        for (int half = (*b)->upper_only; half <= 2; half++) {  // sphere, dome about z, about y
            static struct learned l;
            double sum[LEARNED_PLANES + 3];
            float weights[LEARNED_PLANES], constant[3];
            learned_create(&l, *b, half > 0, half == 2, 0);
            slow(sum, &l, &map, light.rotate_deg, light.rgb);
            fold(weights, constant, &l, &light);
            check_pixels(&l, weights, constant, sum);
            learned_destroy(&l);
        }
    relume_environment_destroy(&e);
    relume_image_destroy(&map);
}

// A uniform sky of radiance 1 shows a convex white Lambertian as 1: on a whole sphere of lights for
// every normal, under a dome for the one that faces the pole.
static void test_uniform_sky(void **state)
{
    (void)state;
    struct relume_image map = map_of(2, 1, 1);
    relume_environment *e = create(&map);
    const struct relume_light light = {
        .kind = RELUME_LIGHT_ENVIRONMENT, .environment = e, .rgb = {1, 1, 1}};
    for (const struct relume_basis *const *b = relume_bases; *b; b++)
        for (int half = (*b)->upper_only; half <= 1; half++) {
            static struct learned l;
            float weights[LEARNED_PLANES], constant[3];
            learned_create(&l, *b, half, false, 0);
            fold(weights, constant, &l, &light);
            double worst = 0;
            for (int x = 0; x < LEARNED_PIXELS; x++) {
                // Seen from a tilted normal the dome is a cut sky: (1 + cos) / 2.
                const double want = half ? (1 + l.normal[x].z) / 2 : 1;
                worst = fmax(worst, fabs(learned_show(&l, x, 1, weights, constant) - want));
            }
            // What 64 lights leave open of a cosine; ptm's six functions fit least.
            if (!(worst < 0.06))
                fail_msg("%s %s: off by %g", (*b)->name, half ? "dome" : "sphere", worst);
            learned_destroy(&l);
        }
    relume_environment_destroy(&e);
    relume_image_destroy(&map);
}

// ---------------------------------------------------------------- sampling

static void test_sampling(void **state)
{
    (void)state;
    enum { N = 4000 };
    static struct relume_light out[N], again[N];
    struct relume_image map = map_of(64, 32, 0.1f);
    for (int c = 0; c < 3; c++)
        map.data[3 * (10 * 64 + 40) + c] = 500.0f * (float)(c + 1);
    relume_environment *e = create(&map);
    const struct relume_light light = {
        .kind = RELUME_LIGHT_ENVIRONMENT, .environment = e, .rotate_deg = -70, .rgb = {1, 2, 1}};
    CHECK_OK(relume_environment_sample(out, N, &light, 9));
    CHECK_OK(relume_environment_sample(again, N, &light, 9));
    assert_true(!memcmp(out, again, sizeof out));
    int cells;
    const struct relume_environment_cell *cell = relume_environment_cells(&cells, e);
    for (int c = 0; c < 3; c++) {
        double total = 0, drawn = 0, lit = 0, want = 0;
        const struct relume_vec3 n = {0.6, 0.64, -0.48};
        for (int i = 0; i < cells; i++) {
            const struct relume_vec3 d =
                relume_environment_turn(cell[i].direction, light.rotate_deg);
            const double v = (double)cell[i].rgb[c] * (double)light.rgb[c];
            total += v;
            want += v * fmax(vec3_dot(n, d), 0);
        }
        for (int i = 0; i < N; i++) {
            drawn += (double)out[i].rgb[c];
            lit += (double)out[i].rgb[c] * fmax(vec3_dot(n, out[i].direction), 0);
        }
        CHECK_NEAR(drawn / total, 1, 1e-5);  // floats
        CHECK_NEAR(lit / want, 1, 0.02);     // N^-1/2 would be 0.016 unstratified
    }
    relume_environment_destroy(&e);
    relume_image_destroy(&map);
}

// A sun in one cell is one light, with all that it sends; the others are the sky's, none twice.
static void test_a_small_sun_is_one_light(void **state)
{
    (void)state;
    enum { N = 64 };
    struct relume_light out[N];
    struct relume_image map = map_of(64, 32, 0.1f);
    for (int c = 0; c < 3; c++)
        map.data[3 * (10 * 64 + 40) + c] = 500.0f;
    relume_environment *e = create(&map);
    const struct relume_light light = {
        .kind = RELUME_LIGHT_ENVIRONMENT, .environment = e, .rgb = {1, 1, 1}};
    int cells, distinct = 0;
    const struct relume_environment_cell *cell = relume_environment_cells(&cells, e), *sun = cell;
    for (int i = 0; i < cells; i++)
        sun = cell[i].rgb[0] > sun->rgb[0] ? &cell[i] : sun;
    CHECK_OK(relume_environment_sample(out, N, &light, 0));
    double sent = 0;
    for (int i = 0; i < N; i++) {
        bool again = false;
        for (int k = 0; k < i; k++)
            again = again || vec3_dot(out[i].direction, out[k].direction) > 1 - 1e-9;
        distinct += !again;
        if (vec3_dot(out[i].direction, sun->direction) > 1 - 1e-9)
            sent += (double)out[i].rgb[0];
    }
    assert_int_equal(distinct, N);
    CHECK_NEAR(sent / (double)sun->rgb[0], 1, 1e-5);  // floats
    relume_environment_destroy(&e);
    relume_image_destroy(&map);
}

// Equal maps have equal numbers wherever they lie; another value or shape has another.
static void test_fingerprints(void **state)
{
    (void)state;
    static const int sizes[][2] = {{8, 4}, {8, 4}, {4, 8}, {8, 4}};
    uint64_t got[4];
    for (int i = 0; i < 4; i++) {
        struct relume_image map = map_of(sizes[i][0], sizes[i][1], 0.5f);
        map.data[95] += i == 3 ? 0.01f : 0;
        relume_environment *e = create(&map);
        got[i] = relume_environment_fingerprint(e);
        relume_environment_destroy(&e);
        relume_image_destroy(&map);
    }
    assert_true(got[0] == got[1]);
    assert_true(got[0] != got[2] && got[0] != got[3] && got[2] != got[3]);
}

static void test_nothing_but_a_lamp(void **state)
{
    (void)state;
    const struct relume_light lamp = {
        .kind = RELUME_LIGHT_DIRECTIONAL, .direction = {0, 3, 4}, .rgb = {1, 2, 0.5f}};
    relume_environment *e;
    int n;
    CHECK_OK(relume_environment_of_lamp(&e, &lamp));
    const struct relume_environment_cell *cell = relume_environment_cells(&n, e);
    assert_int_equal(n, 1);
    CHECK_NEAR(cell->direction.y, 0.6, 1e-12);
    CHECK_NEAR(cell->direction.z, 0.8, 1e-12);
    assert_memory_equal(cell->rgb, lamp.rgb, sizeof lamp.rgb);
    assert_null(relume_environment_map(e)->data);
    assert_true(relume_environment_fingerprint(e) == 0);
    relume_environment_destroy(&e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_solid_angles),       cmocka_unit_test(test_directions),
        cmocka_unit_test(test_oddities),           cmocka_unit_test(test_weights),
        cmocka_unit_test(test_uniform_sky),        cmocka_unit_test(test_sampling),
        cmocka_unit_test(test_fingerprints),       cmocka_unit_test(test_a_small_sun_is_one_light),
        cmocka_unit_test(test_nothing_but_a_lamp),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
