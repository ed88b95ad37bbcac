// Large surfaces: cuts against all cuts, tiles, lookups through maps, files, pictures.
#include "made_btf.h"

#include "material/btf/values.h"
#include "material/model/environment.h"
#include "material/surface/surface.h"
#include "material/surface/texels.h"
#include "material/synthesis/cut.h"
#include "relight/light/environment.h"

// ---------------------------------------------------------------- samples

typedef double pattern(int x, int y);

struct made {
    int width, height;
    pattern *value;
};

static void fill(const void *context, vec3 v, vec3 l, float *rgb)
{
    const struct made *m = context;
    for (int i = 0; i < m->width * m->height; i++)
        for (int c = 0; c < 3; c++)
            rgb[3 * i + c] =
                (float)(m->value(i % m->width, i / m->width) * (l.z + 0.1 * v.x) * (1.0 - 0.1 * c));
}

static relume_btf *make(int width, int height, pattern *value)
{
    return made_btf(&(struct made_btf){.width = width,
                                       .height = height,
                                       .fill = fill,
                                       .context = &(struct made){width, height, value}});
}

static relume_btf_fitted *fit(const relume_btf *btf, const char *name, int levels)
{
    relume_btf_fitted *m;
    CHECK_OK(relume_btf_fit(&m, btf, relume_btf_model_find(name),
                            relume_btf_fit_params(.levels = levels, .components = 3)));
    return m;
}

static double waves(int x, int y)
{
    return 0.5 + 0.2 * sin(0.7 * x + 0.2 * y) + 0.2 * cos(0.5 * y - 0.3 * x * y / 20.0);
}

// Repeats every 8 texels.
static double checks(int x, int y)
{
    return 0.4 + 0.3 * sin(2.0 * M_PI * x / 8.0) * cos(2.0 * M_PI * y / 8.0) + 0.02 * (x % 8);
}

static double numbered(int x, int y)
{
    return 0.1 + 0.01 * x + 0.1 * y;
}

// ---------------------------------------------------------------- cuts

enum { GRID_WIDTH = 4, GRID_HEIGHT = 4, CELLS = GRID_WIDTH * GRID_HEIGHT };

static long cost(const unsigned char *side, const int *right, const int *down)
{
    long sum = 0;
    for (int i = 0; i < CELLS; i++) {
        if ((i + 1) % GRID_WIDTH && side[i] != side[i + 1])
            sum += right[i];
        if (i + GRID_WIDTH < CELLS && side[i] != side[i + GRID_WIDTH])
            sum += down[i];
    }
    return sum;
}

// Against every way to divide the cells that may be on either side.
static void test_cut(void **state)
{
    (void)state;
    uint32_t seed = 7;
    for (int round = 0; round < 40; round++) {
        unsigned char side[CELLS], all[CELLS];
        int right[CELLS], down[CELLS], free_cell[CELLS], n = 0;
        for (int i = 0; i < CELLS; i++) {
            right[i] = (int)(test_random(&seed) % 10);
            down[i] = (int)(test_random(&seed) % 10);
            side[i] = CUT_EITHER;
            if (test_random(&seed) % 3 == 0)
                side[i] = test_random(&seed) % 2 ? CUT_OLD : CUT_NEW;
            else
                free_cell[n++] = i;
        }
        memcpy(all, side, sizeof all);
        long least = 1000000;
        for (int k = 0; k < 1 << n; k++) {
            for (int i = 0; i < n; i++)
                all[free_cell[i]] = k >> i & 1 ? CUT_OLD : CUT_NEW;
            const long now = cost(all, right, down);
            least = now < least ? now : least;
        }
        unsigned char out[CELLS];
        memcpy(out, side, sizeof out);
        CHECK_OK(cut_grid(out, GRID_WIDTH, GRID_HEIGHT, right, down));
        assert_int_equal(cost(out, right, down), least);
        for (int i = 0; i < CELLS; i++)
            assert_true(side[i] == CUT_EITHER ? out[i] != CUT_EITHER : out[i] == side[i]);
    }
}

// ---------------------------------------------------------------- tiles

static void test_tiles(void **state)
{
    (void)state;
    relume_btf *btf = make(28, 26, waves);
    relume_btf_fitted *sample;
    relume_btf_map *map, *again, *other;
    CHECK_OK(relume_btf_as_model(&sample, btf, NULL));
    struct relume_btf_tiles_params p = {.tiles = 9, .side = 16, .columns = 7, .rows = 6, .seed = 3};
    CHECK_OK(relume_btf_map_tiles(&map, sample, &p));
    p.threads = 3;
    CHECK_OK(relume_btf_map_tiles(&again, sample, &p));
    p.seed = 4;
    CHECK_OK(relume_btf_map_tiles(&other, sample, &p));
    const struct relume_btf_map_info *i = relume_btf_map_info(map);
    assert_int_equal(i->tiles, 9);
    assert_int_equal(i->width, 16);
    CHECK_OK(map_check(i, "map", NULL));
    const size_t bytes = 9 * 16 * 16 * sizeof *i->texel;
    assert_memory_equal(i->texel, relume_btf_map_info(again)->texel, bytes);
    assert_memory_not_equal(i->texel, relume_btf_map_info(other)->texel, bytes);
    for (int tile = 1; tile < 9; tile++) {
        int changed = 0;
        for (int k = 0; k < 16 * 16; k++) {
            const int x = k % 16, y = k / 16;
            const bool differs = i->texel[tile * 16 * 16 + k] != i->texel[k];
            // the border is one
            assert_true(!differs || (x >= 2 && y >= 2 && x < 14 && y < 14));
            changed += differs;
        }
        assert_true(changed > 40);
    }
    for (int k = 0; k < 42; k++)  // no tile beside itself
        assert_int_not_equal(i->matrix[k], i->matrix[k / 7 * 7 + (k + 1) % 7]);
    relume_btf_map_destroy(&map);
    relume_btf_map_destroy(&again);
    relume_btf_map_destroy(&other);
    relume_btf_fitted_destroy(&sample);
    relume_btf_destroy(&btf);
}

static struct relume_btf_seams seams_of(pattern *value, bool cut)
{
    relume_btf *btf = make(40, 40, value);
    relume_btf_fitted *sample;
    relume_btf_map *map;
    struct relume_btf_seams s;
    CHECK_OK(relume_btf_as_model(&sample, btf, NULL));
    if (cut) {
        CHECK_OK(relume_btf_map_tiles(
            &map, sample,
            relume_btf_tiles_params(.tiles = 3, .side = 24, .columns = 4, .rows = 4)));
    } else {  // squares of the sample as they are
        uint32_t texel[24 * 24];
        const uint16_t matrix = 0;
        for (int k = 0; k < 24 * 24; k++)
            texel[k] = (uint32_t)(k / 24 * 40 + k % 24);
        const struct relume_btf_map_info info = {40, 40, 1, 24, 24, texel, 1, 1, &matrix};
        CHECK_OK(relume_btf_map_create(&map, &info, NULL));
    }
    CHECK_OK(relume_btf_map_seams(&s, map, sample, NULL));
    relume_btf_map_destroy(&map);
    relume_btf_fitted_destroy(&sample);
    relume_btf_destroy(&btf);
    return s;
}

static void test_seams(void **state)
{
    (void)state;
    // a pattern that repeats is continued without a trace: steps over cuts are those inside
    struct relume_btf_seams s = seams_of(checks, true);
    assert_true(s.across < 1.2 * s.inside);
    assert_true(s.inside > 0.0 && s.share < 0.2);
    // others are cut where it shows least: well below texels that have nothing in common, and
    // below squares side by side
    s = seams_of(waves, true);
    assert_true(s.across < 0.6 * s.unrelated);
    const struct relume_btf_seams squares = seams_of(waves, false);
    assert_true(s.across < 0.7 * squares.across);
    CHECK_NEAR(squares.share, 2.0 * 24 / (2.0 * 24 * 24), 1e-12);
}

// ---------------------------------------------------------------- lookups

static const struct relume_btf_ray ray = {.view = {0.28, 0.0, 0.96}, .light = {-0.48, 0.36, 0.8}};

static void check_value(const relume_btf_surface *s, double x, double y, double level,
                        const double want[3], double tolerance)
{
    float got[3];
    relume_btf_surface_evaluate(s, x, y, level, &ray, got);
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(got[c], want[c], tolerance);
}

static void texel_value(double out[3], const relume_btf_fitted *m, int x, int y)
{
    float rgb[3];
    relume_btf_fitted_evaluate(m, x, y, ray.view, ray.light, rgb);
    for (int c = 0; c < 3; c++)
        out[c] = (double)rgb[c];
}

// Two tiles of 4 x 4 texels, cut from a sample of 16 x 4: texels 0 to 3 and, on the grid, 8 to 11.
static relume_btf_map *two_tiles(void)
{
    relume_btf_map *map;
    uint32_t texel[2][4][4];
    const uint16_t matrix[2] = {1, 0};
    for (uint32_t i = 0; i < 32; i++)
        texel[i / 16][i / 4 % 4][i % 4] = i / 4 % 4 * 16 + i % 4 + (i / 16) * 8;
    const struct relume_btf_map_info info = {16, 4, 2, 4, 4, &texel[0][0][0], 2, 1, matrix};
    CHECK_OK(relume_btf_map_create(&map, &info, NULL));
    return map;
}

static void check_lookups(const relume_btf_fitted *m, const char *name)
{
    relume_btf_map *map = two_tiles();
    relume_btf_surface *s;
    double a[3], b[3], mid[3], coarse[3];
    CHECK_OK(relume_btf_surface_create(&s, m, map, NULL));
    const struct relume_btf_surface_info *info = relume_btf_surface_info(s);
    assert_int_equal(info->width, 8);
    assert_int_equal(info->height, 4);
    assert_int_equal(info->levels, !strcmp(name, "table") ? 1 : 3);
    const double tight = 1e-6;  // one rounding of floats
    // the matrix puts tile 1, texels 8 to 11, first
    texel_value(a, m, 8, 2);
    check_value(s, 0.5, 2.5, 0.0, a, tight);
    check_value(s, 0.5 + 8.0, 2.5 - 4.0, 0.0, a, tight);  // repeated
    texel_value(a, m, 11, 1);
    texel_value(b, m, 0, 1);
    for (int c = 0; c < 3; c++)
        mid[c] = 0.75 * a[c] + 0.25 * b[c];
    check_value(s, 3.75, 1.5, 0.0, mid, tight);  // over the border of tiles: texels 11 and 0
    if (info->levels > 1) {
        texel_value(coarse, relume_btf_fitted_level(m, 1), 4, 1);
        check_value(s, 1.0, 3.0, 1.0, coarse, tight);  // 2 x 2 texels from (8, 2)
        float filtered[3];
        const struct relume_btf_footprint two = {1.0, 3.0, {2.0, 0.0}, {0.0, -2.0}};
        relume_btf_surface_filter(s, &two, &ray, filtered);
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(filtered[c], coarse[c], tight);
        float fine[3];
        relume_btf_surface_evaluate(s, 1.0, 3.0, 0.0, &ray, fine);
        for (int c = 0; c < 3; c++)
            mid[c] = 0.5 * (double)fine[c] + 0.5 * coarse[c];
        check_value(s, 1.0, 3.0, 0.5, mid, tight);
    }
    // long and thin: three texels of the finest level, which 3.0625 to 1 counts as
    const struct relume_btf_footprint thin = {1.5, 1.5, {3.0625, 0.0}, {0.0, 1.0}};
    const double level = info->levels > 1 ? log2(3.0625 / 3.0) : 0.0;
    float got[3], one[3];
    relume_btf_surface_filter(s, &thin, &ray, got);
    for (int c = 0; c < 3; c++)
        mid[c] = 0.0;
    for (int x = 0; x < 3; x++) {
        relume_btf_surface_evaluate(s, x + 0.5, 1.5, level, &ray, one);
        for (int c = 0; c < 3; c++)
            mid[c] += (double)one[c] / 3.0;
    }
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(got[c], mid[c], tight);
    // a footprint that grows longer by 0.1 % never changes what it shows by more than a little:
    // there is no place where a picture gets sharper at once (it did by 0.1 at 1 to 1)
    for (double longer = 1.4; longer < 20.0; longer *= 1.001) {
        const struct relume_btf_footprint f = {1.8, 1.5, {longer, 0.0}, {0.0, 1.5}};
        float before[3];
        memcpy(before, got, sizeof before);
        relume_btf_surface_filter(s, &f, &ray, got);
        for (int c = 0; c < 3 && longer > 1.4; c++)
            CHECK_NEAR(got[c], before[c], 4e-3);
    }
    relume_btf_surface_destroy(&s);
    relume_btf_map_destroy(&map);
}

static void test_lookups(void **state)
{
    (void)state;
    relume_btf *btf = make(16, 4, numbered);
    for (const struct relume_btf_model *const *k = relume_btf_models; *k; k++) {
        relume_btf_fitted *m = fit(btf, relume_btf_model_name(*k), -1);
        check_lookups(m, relume_btf_model_name(*k));
        relume_btf_fitted_destroy(&m);
    }
    relume_btf_fitted *table;
    CHECK_OK(relume_btf_as_model(&table, btf, NULL));
    check_lookups(table, "table");
    relume_btf_fitted_destroy(&table);
    relume_btf_destroy(&btf);
}

// Under an environment a surface is filtered as under a light.
static void test_ambient(void **state)
{
    (void)state;
    relume_btf *btf = make(16, 4, numbered);
    relume_btf_fitted *m = fit(btf, "vpca", 2);
    struct relume_image map;
    CHECK_OK(relume_image_create(&map, 16, 8, 3));
    for (int i = 0; i < 3 * 16 * 8; i++)
        map.data[i] = 0.1f * (float)(i % 7);
    relume_environment *e;
    CHECK_OK(relume_environment_create(&e, &map, NULL));
    relume_image_destroy(&map);
    const struct relume_light light = {
        .kind = RELUME_LIGHT_ENVIRONMENT, .environment = e, .rgb = {1.0f, 1.0f, 1.0f}};
    const struct relume_btf_frame frame = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    relume_prefiltered_maps *p;
    relume_btf_oriented_light *a;
    relume_btf_surface *s;
    CHECK_OK(relume_prefiltered_maps_create(&p, &light, NULL));
    CHECK_OK(relume_btf_oriented_light_create(&a, m, p, &frame, NULL));
    CHECK_OK(relume_btf_surface_create(&s, m, NULL, NULL));
    const struct relume_btf_ray under = {.view = ray.view, .ambient = a};
    float got[3], left[3], right[3], coarse[3];
    relume_btf_surface_evaluate(s, 3.0, 1.5, 0.0, &under, got);
    relume_btf_oriented_light_evaluate(a, 0, 2, 1, ray.view, left);
    relume_btf_oriented_light_evaluate(a, 0, 3, 1, ray.view, right);
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(got[c], 0.5 * (left[c] + right[c]), 1e-6);
    relume_btf_surface_evaluate(s, 3.0, 1.0, 1.0, &under, got);
    relume_btf_oriented_light_evaluate(a, 1, 1, 0, ray.view, coarse);
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(got[c], coarse[c], 1e-6);
    // one of the sums that a renderer of its own would make
    const float *w = relume_btf_oriented_light_weights(a);
    float total = 0.0f;
    for (int i = 0; i < MADE_DIRECTIONS; i++)
        total += w[3 * i];
    assert_true(total > 0.0f);
    relume_btf_surface_destroy(&s);
    relume_btf_oriented_light_destroy(&a);
    relume_prefiltered_maps_destroy(&p);
    relume_environment_destroy(&e);
    relume_btf_fitted_destroy(&m);
    relume_btf_destroy(&btf);
}

// ---------------------------------------------------------------- pictures

static void test_draw(void **state)
{
    (void)state;
    relume_btf *btf = make(16, 4, numbered);
    relume_btf_fitted *m = fit(btf, "vpca", -1);
    relume_btf_surface *s;
    struct relume_image image;
    CHECK_OK(relume_btf_surface_create(&s, m, NULL, NULL));
    CHECK_OK(relume_image_create(&image, 16, 4, 3));
    const struct relume_light light = {.kind = RELUME_LIGHT_DIRECTIONAL,
                                       .direction = {-0.96, 0.72, 1.6},  // ray.light, twice as long
                                       .rgb = {1.0f, 2.0f, 1.0f}};
    struct relume_btf_camera camera = {.eye = {0.56, 0.0, 1.92}};
    CHECK_OK(relume_btf_draw(&image, s, &camera, &light, 1, NULL));
    for (int i = 0; i < 64; i++) {
        double want[3];
        texel_value(want, m, i % 16, i / 16);
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(image.data[3 * i + c], want[c] * (c == 1 ? 2.0 : 1.0), 1e-5);
    }
    relume_image_destroy(&image);
    // from above, far away: the width of the surface fills a picture of 2 world units, x to the
    // right, row 0 up
    CHECK_OK(relume_image_create(&image, 16, 4, 3));
    camera = (struct relume_btf_camera){
        .perspective = true, .eye = {0, 0, 1000}, .fov_deg = 2.0 * atan(1e-3) * 180.0 / M_PI};
    CHECK_OK(relume_btf_draw(&image, s, &camera, &light, 1, NULL));
    for (int i = 0; i < 64; i++) {
        float want[3];
        relume_btf_fitted_evaluate(m, i % 16, i / 16, (vec3){0, 0, 1}, ray.light, want);
        CHECK_NEAR(image.data[3 * i], want[0], 2e-3);  // views up to 0.06 degrees off
    }
    // towards the horizon: sky above, surface below
    camera = (struct relume_btf_camera){
        .perspective = true, .eye = {0, -2, 0.5}, .at = {0, 0, 0.5}, .fov_deg = 60};
    CHECK_OK(relume_btf_draw(&image, s, &camera, &light, 1, NULL));
    assert_true(image.data[3 * 8] == 0.0f && image.data[3 * 56] > 0.0f);
    // refused
    struct test_log log;
    test_log_init(&log);
    camera.eye.z = 0.0;
    assert_int_equal(
        relume_btf_draw(&image, s, &camera, &light, 1, relume_btf_draw_params(.log = &log.log)),
        RELUME_EINVAL);
    assert_non_null(strstr(log.text, "eye with z > 0"));
    relume_image_destroy(&image);
    relume_btf_surface_destroy(&s);
    relume_btf_fitted_destroy(&m);
    relume_btf_destroy(&btf);
}

// ---------------------------------------------------------------- sizes and files

// Thesis, 9.6: 1024 clusters with ten tiles of 256^2 and a matrix of 16 x 16, 4.3 MB of 2^20 bytes
// for what looks like 4096^2. The sample's own 256^2 numbers of clusters stay here, 0.125 MB.
static void test_bytes(void **state)
{
    (void)state;
    relume_btf_fitted m = {.model = relume_btf_model_find("rfnlc"),
                           .width = 256,
                           .height = 256,
                           .views = 81,
                           .lights = 81,
                           .texels = 65536,
                           .clusters = 1024,
                           .lobes = 2};
    m.model->layout(&m);
    model_settle(&m);
    const size_t texels = (size_t)10 * 256 * 256;
    uint32_t *texel = calloc(texels, sizeof *texel);
    const uint16_t matrix[256] = {0};
    const struct relume_btf_map_info info = {256, 256, 10, 256, 256, texel, 16, 16, matrix};
    relume_btf_map *map;
    relume_btf_surface *s;
    CHECK_OK(relume_btf_map_create(&map, &info, NULL));
    CHECK_OK(relume_btf_surface_create(&s, &m, map, NULL));
    const struct relume_btf_surface_info *i = relume_btf_surface_info(s);
    assert_int_equal(i->width, 4096);
    assert_int_equal(i->height, 4096);
    CHECK_NEAR((double)i->bytes / 1048576.0 - 0.125, 4.26, 0.01);
    relume_btf_surface_destroy(&s);
    relume_btf_map_destroy(&map);
    free(texel);
}

static void refuse(const char *folder, const char *sentence)
{
    struct test_log log;
    relume_btf_surface *s;
    test_log_init(&log);
    assert_true(relume_status_is_input(
        relume_btf_surface_open(&s, folder, relume_btf_params(.log = &log.log))));
    assert_null(s);
    if (!strstr(log.text, sentence))
        print_error("'%s' is not in '%s'\n", sentence, log.text);
    assert_non_null(strstr(log.text, sentence));
}

// One byte of a file, counted from its end, becomes `value`.
static void spoil(const char *folder, const char *name, long from_end, int value)
{
    char path[192];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "r+b");
    assert_non_null(f);
    assert_int_equal(fseek(f, -from_end, SEEK_END), 0);
    fputc(value, f);
    assert_int_equal(fclose(f), 0);
}

static void test_files(void **state)
{
    (void)state;
    char folder[64], path[128];
    relume_btf *btf = make(16, 4, numbered);
    relume_btf_fitted *m = fit(btf, "vpca", 2);
    relume_btf_map *map = two_tiles();
    relume_btf_surface *s, *back;
    test_folder(folder);
    snprintf(path, sizeof path, "%s/s", folder);
    CHECK_OK(relume_btf_surface_create(&s, m, map, NULL));
    CHECK_OK(relume_btf_surface_save(s, path, NULL));
    CHECK_OK(relume_btf_surface_open(&back, path, NULL));
    assert_int_equal(relume_btf_surface_info(back)->bytes, relume_btf_surface_info(s)->bytes);
    assert_int_equal(relume_btf_surface_info(back)->levels, 2);
    for (int i = 0; i < 40; i++) {
        float a[3], b[3];
        relume_btf_surface_evaluate(s, 0.37 * i, 0.21 * i, 0.05 * i, &ray, a);
        relume_btf_surface_evaluate(back, 0.37 * i, 0.21 * i, 0.05 * i, &ray, b);
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(a[c], b[c], 1e-6);
    }
    relume_btf_surface_destroy(&back);
    spoil(path, "texel.npy", 1, 9);
    refuse(path, "expected a texel of 16 x 4; found number");
    spoil(path, "texel.npy", 1, 0);
    spoil(path, "matrix.npy", 2, 2);
    refuse(path, "matrix: row 0, column 1: expected one of 2 tiles; found 2");
    spoil(path, "matrix.npy", 2, 0);
    CHECK_OK(relume_btf_surface_open(&back, path, NULL));
    relume_btf_surface_destroy(&back);
    char file[160];
    snprintf(file, sizeof file, "%s/texel.npy", path);
    assert_int_equal(truncate(file, 100), 0);
    refuse(path, "texel.npy: ");
    // measured values are not copied into folders; a map of another sample
    relume_btf_fitted *table;
    CHECK_OK(relume_btf_as_model(&table, btf, NULL));
    CHECK_OK(relume_btf_surface_create(&back, table, map, NULL));
    snprintf(path, sizeof path, "%s/t", folder);
    assert_int_equal(relume_btf_surface_save(back, path, NULL), RELUME_EINVAL);
    relume_btf_surface_destroy(&back);
    assert_int_equal(relume_btf_surface_create(&back, relume_btf_fitted_level(m, 1), map, NULL),
                     RELUME_EINVAL);
    relume_btf_fitted_destroy(&table);
    relume_btf_surface_destroy(&s);
    relume_btf_map_destroy(&map);
    relume_btf_fitted_destroy(&m);
    relume_btf_destroy(&btf);
    test_folder_remove(folder);
}

// ---------------------------------------------------------------- index maps of others

static void refuse_map(const char *path, const char *sentence)
{
    struct test_log log;
    relume_btf_map *map;
    test_log_init(&log);
    assert_true(relume_status_is_input(
        relume_btf_map_open(&map, path, 16, 4, relume_btf_params(.log = &log.log))));
    assert_null(map);
    if (!strstr(log.text, sentence))
        print_error("'%s' is not in '%s'\n", sentence, log.text);
    assert_non_null(strstr(log.text, sentence));
}

static void test_index_maps(void **state)
{
    (void)state;
    char folder[64], path[128];
    relume_btf_map *map;
    test_folder(folder);
    snprintf(path, sizeof path, "%s/map.npy", folder);
    uint32_t number[2][3] = {{0, 1, 2}, {17, 63, 40}};
    const struct npy npy = {NPY_U32, 2, {2, 3}};
    CHECK_OK(npy_save(&npy, number, path, NULL));
    CHECK_OK(relume_btf_map_open(&map, path, 16, 4, NULL));
    assert_int_equal(relume_btf_map_info(map)->width, 3);
    assert_memory_equal(relume_btf_map_info(map)->texel, number, sizeof number);
    relume_btf_map_destroy(&map);
    number[1][1] = 64;
    CHECK_OK(npy_save(&npy, number, path, NULL));
    refuse_map(path, "map.npy: row 1, column 1: expected a texel of 16 x 4; found number 64");
    const struct npy halfs = {NPY_HALF, 2, {2, 3}};
    CHECK_OK(npy_save(&halfs, number, path, NULL));
    refuse_map(path, "expected uint16 or uint32");
    // a picture: places in red and green
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, 2, 1, 3));
    const float places[6] = {0.999f, 0.3f, 0.0f, 1.0f, 0.0f, 9.0f};
    memcpy(image.data, places, sizeof places);
    snprintf(path, sizeof path, "%s/map.exr", folder);
    CHECK_OK(relume_image_save(&image, path, NULL));
    CHECK_OK(relume_btf_map_open(&map, path, 16, 4, NULL));
    assert_int_equal(relume_btf_map_info(map)->texel[0], 16 + 15);
    assert_int_equal(relume_btf_map_info(map)->texel[1], 15);
    relume_btf_map_destroy(&map);
    image.data[3] = NAN;
    CHECK_OK(relume_image_save(&image, path, NULL));
    refuse_map(path, "row 0, column 1: expected a place from 0 to 1");
    relume_image_destroy(&image);
    test_folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cut),        cmocka_unit_test(test_tiles),
        cmocka_unit_test(test_seams),      cmocka_unit_test(test_lookups),
        cmocka_unit_test(test_ambient),    cmocka_unit_test(test_draw),
        cmocka_unit_test(test_bytes),      cmocka_unit_test(test_files),
        cmocka_unit_test(test_index_maps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
