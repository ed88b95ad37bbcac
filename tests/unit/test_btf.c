// Measured materials: directions, containers, the reference, readers of folders.
#include "test.h"

#include "core/base/half.h"
#include "core/base/memory.h"
#include "material/btf/btf.h"
#include "material/btf/values.h"

#include <relume/capture.h>
#include <sys/stat.h>

static vec3 *set_directions(const char *name, int *n)
{
    const struct relume_btf_set *set = relume_btf_set_find(name);
    assert_non_null(set);
    vec3 *d = malloc((size_t)set->count * sizeof *d);
    assert_non_null(d);
    relume_btf_set_directions(set, d);
    *n = set->count;
    return d;
}

static void test_sets(void **state)
{
    (void)state;
    // rings of the Bonn laboratory: elevation from the pole, count
    static const int rings[6][2] = {{0, 1}, {15, 6}, {30, 12}, {45, 18}, {60, 20}, {75, 24}};
    int n;
    vec3 *d = set_directions("bonn", &n);
    assert_int_equal(n, 81);
    for (int r = 0, at = 0; r < 6; r++)
        for (int i = 0; i < rings[r][1]; i++, at++) {
            CHECK_NEAR(acos(fmin(d[at].z, 1.0)) * 180.0 / M_PI, rings[r][0], 1e-6);
            CHECK_NEAR(vec3_length(d[at]), 1.0, 1e-12);
            // the direction of phi + 180 degrees is in the same ring (all counts but 1 are even)
            const int half = rings[r][1] / 2;
            if (half && i < half)
                CHECK_NEAR(d[at].x + d[at + half].x, 0.0, 1e-12);
        }
    free(d);
    d = set_directions("dome", &n);
    assert_int_equal(n, 151);
    for (const struct relume_btf_set *const *s = relume_btf_sets; *s; s++) {
        int sum = 0;
        for (int r = 0; r < (*s)->rings; r++)
            sum += (*s)->ring[r].count;
        assert_int_equal(sum, (*s)->count);
    }
    free(d);
}

static void check_mesh(const char *name)
{
    int n;
    vec3 *d = set_directions(name, &n);
    relume_direction_mesh *mesh;
    CHECK_OK(relume_direction_mesh_create(&mesh, d, n, NULL));
    for (int i = 0; i < n; i++) {
        const struct relume_direction_blend b = relume_direction_mesh_at(mesh, d[i]);
        assert_int_equal(b.count, 1);
        assert_int_equal(b.index[0], i);
        CHECK_NEAR(b.weight[0], 1.0, 0.0);
        CHECK_NEAR(b.rim, 1.0, 1e-12);
    }
    uint32_t seed = 3;
    for (int i = 0; i < 2000; i++) {
        vec3 q = test_direction(&seed);
        q.z = fabs(q.z);
        const struct relume_direction_blend b = relume_direction_mesh_at(mesh, q);
        vec3 mean = {0, 0, 0};
        double sum = 0.0;
        for (int k = 0; k < b.count; k++) {
            assert_true(b.weight[k] > 0.0);
            sum += b.weight[k];
            mean = vec3_add(mean, vec3_scale(d[b.index[k]], b.weight[k]));
        }
        CHECK_NEAR(sum, 1.0, 1e-12);
        // barycentric weights give the direction back; below the rim, the one of its azimuth there
        CHECK_NEAR(vec3_angle(vec3_unit(mean), b.direction), 0.0, 1e-7);
        if (b.rim == 1.0)
            CHECK_NEAR(vec3_angle(q, b.direction), 0.0, 1e-7);
        CHECK_NEAR(atan2(q.y, q.x), atan2(b.direction.y, b.direction.x), 1e-6);
        CHECK_NEAR(b.rim * b.direction.z, q.z, 1e-7);
    }
    relume_direction_mesh_destroy(&mesh);
    free(d);
}

static void test_meshes(void **state)
{
    (void)state;
    check_mesh("bonn");
    check_mesh("dome");
    check_mesh("coarse");
    struct test_log log;
    test_log_init(&log);
    relume_direction_mesh *mesh;
    const vec3 below[3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    assert_int_equal(relume_direction_mesh_create(&mesh, below, 3, &log.log), RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "direction 1"));
    const vec3 line[3] = {{0, 0, 1}, {0.6, 0, 0.8}, {-0.6, 0, 0.8}};
    assert_int_equal(relume_direction_mesh_create(&mesh, line, 3, &log.log), RELUME_EUNFIT);
    assert_null(mesh);
}

// Raw sizes of the thesis, Tab. 3.3.
static void test_sizes(void **state)
{
    (void)state;
    const double gib = 1073741824.0;
    CHECK_NEAR((double)relume_btf_bytes(128, 128, 81, 81) / gib, 0.601, 5e-4);
    CHECK_NEAR((double)relume_btf_bytes(256, 256, 81, 81) / gib, 2.403, 5e-4);
    CHECK_NEAR((double)relume_btf_bytes(512, 512, 81, 81) / gib, 9.611, 5e-4);
}

enum { W = 3, H = 2 };

// A value that is linear in both directions, so that barycentric blends are known.
static double known(int x, int y, int c, vec3 v, vec3 l)
{
    return 0.3 + 0.1 * c + 0.05 * x - 0.03 * y + 0.1 * v.x - 0.05 * l.y;
}

static relume_btf *make_btf(const char *set, bool without_cosine)
{
    int n;
    vec3 *d = set_directions(set, &n);
    const struct relume_btf_info info = {.name = "linear",
                                         .width = W,
                                         .height = H,
                                         .views = n,
                                         .lights = n,
                                         .view = d,
                                         .light = d,
                                         .without_cosine = without_cosine};
    relume_btf *btf;
    CHECK_OK(relume_btf_create(&btf, &info, NULL));
    for (int v = 0; v < n; v++)
        for (int l = 0; l < n; l++) {
            float rgb[H * W * 3];
            for (int i = 0; i < H * W * 3; i++)
                rgb[i] = (float)known(i / 3 % W, i / 3 / W, i % 3, d[v], d[l]);
            relume_btf_store(btf, v, l, rgb);
        }
    free(d);
    return btf;
}

// Three views times three lights, by hand.
static double blended(const relume_btf *btf, int x, int y, int c,
                      const struct relume_direction_blend *v,
                      const struct relume_direction_blend *l)
{
    const struct relume_btf_info *info = relume_btf_info(btf);
    double sum = 0.0;
    for (int i = 0; i < v->count; i++)
        for (int j = 0; j < l->count; j++)
            sum += v->weight[i] * l->weight[j] *
                   known(x, y, c, info->view[v->index[i]], info->light[l->index[j]]);
    return sum;
}

static void check_reference(bool without_cosine)
{
    relume_btf *btf = make_btf("bonn", without_cosine);
    uint32_t seed = 5;
    for (int i = 0; i < 200; i++) {
        vec3 v = test_direction(&seed), l = test_direction(&seed);
        v.z = fabs(v.z), l.z = fabs(l.z);
        const struct relume_direction_blend at_v = relume_direction_mesh_at(btf->views, v);
        const struct relume_direction_blend at_l = relume_direction_mesh_at(btf->lights, l);
        float rgb[3];
        relume_btf_evaluate(btf, i % W, i % H, v, l, rgb);
        for (int c = 0; c < 3; c++)
            // half floats below 1: 2^-11 relative
            CHECK_NEAR(rgb[c],
                       blended(btf, i % W, i % H, c, &at_v, &at_l) *
                           (without_cosine ? l.z : at_l.rim / at_l.length),
                       5e-4);
    }
    float rgb[3] = {1.0f, 1.0f, 1.0f};
    relume_btf_evaluate(btf, 0, 0, vec3_of(0, 0, 1), vec3_of(0.6, 0, -0.8), rgb);
    CHECK_NEAR(rgb[0] + rgb[1] + rgb[2], 0.0, 0.0);
    relume_btf_destroy(&btf);
}

static void test_reference(void **state)
{
    (void)state;
    check_reference(false);
    check_reference(true);  // the factor comes once, from the light that is asked for
}

static void test_folder_round_trip(void **state)
{
    (void)state;
    char folder[64], path[128];
    snprintf(path, sizeof path, "%s/btf", test_folder(folder));
    relume_btf *btf = make_btf("coarse", true), *back;
    CHECK_OK(relume_btf_save(btf, path, NULL));
    CHECK_OK(relume_btf_open(&back, path, NULL));
    const struct relume_btf_info *a = relume_btf_info(btf), *b = relume_btf_info(back);
    assert_string_equal(b->name, "linear");
    assert_true(b->without_cosine);
    assert_int_equal(b->views, a->views);
    for (int i = 0; i < a->views; i++)
        CHECK_NEAR(vec3_length(vec3_sub(a->view[i], b->view[i])), 0.0, 1e-15);
    for (int v = 0; v < a->views; v++)
        for (int l = 0; l < a->lights; l++)
            assert_memory_equal(relume_btf_picture(btf, v, l), relume_btf_picture(back, v, l),
                                W * H * 6);
    relume_btf_destroy(&back);
    // a file that ends early
    char values[160];
    snprintf(values, sizeof values, "%s/values.npy", path);
    assert_int_equal(truncate(values, 1000), 0);
    struct test_log log;
    test_log_init(&log);
    assert_int_equal(relume_btf_open(&back, path, relume_btf_params(.log = &log.log)),
                     RELUME_EDAMAGED);
    assert_non_null(strstr(log.text, "values.npy: expected"));
    assert_null(back);
    relume_btf_destroy(&btf);
    test_folder_remove(folder);
}

static void test_part(void **state)
{
    (void)state;
    relume_btf *btf = make_btf("coarse", false), *part;
    const int views[4] = {0, 7, 11, 15}, lights[5] = {0, 1, 3, 5, 9};
    CHECK_OK(relume_btf_part(&part, btf, views, 4, lights, 5, NULL));
    for (int v = 0; v < 4; v++)
        for (int l = 0; l < 5; l++)
            assert_ptr_equal(relume_btf_picture(part, v, l),
                             relume_btf_picture(btf, views[v], lights[l]));
    float got[2 * 4 * 5 * 3];
    btf_gather(part, 3, 2, got);
    const struct relume_btf_info *info = relume_btf_info(btf);
    CHECK_NEAR(got[4 * 5 * 3 + (2 * 5 + 4) * 3 + 1],
               known(4 % W, 4 / W, 1, info->view[11], info->light[9]), 5e-4);
    relume_btf *deeper;
    const int two[2] = {0, 1};
    assert_int_equal(relume_btf_part(&deeper, btf, two, 2, lights, 5, NULL), RELUME_EUNFIT);
    assert_int_equal(relume_btf_save(part, "nowhere", NULL), RELUME_EINVAL);
    relume_btf_destroy(&part);
    relume_btf_destroy(&btf);
}

// Pictures in both orders of names; `skip` leaves one out.
static void write_pictures(const char *folder, int skip)
{
    static const int angles[4][2] = {{0, 0}, {45, 0}, {45, 120}, {45, 240}};
    for (int v = 0; v < 4; v++)
        for (int l = 0; l < 4; l++) {
            if (v * 4 + l == skip)
                continue;
            char path[160];
            const int *a = angles[l], *b = angles[v];
            if (l % 2)
                snprintf(path, sizeof path, "%s/M_tl%03d_pl%03d_tv%03d_pv%03d.exr", folder, a[0],
                         a[1], b[0], b[1]);
            else
                snprintf(path, sizeof path, "%s/M_tv%03d.0_pv%03d_tl%03d_pl%03d.exr", folder, b[0],
                         b[1], a[0], a[1]);
            struct relume_image image;
            CHECK_OK(relume_image_create(&image, W, H, 3));
            for (int i = 0; i < W * H * 3; i++)
                image.data[i] = (float)(v * 4 + l) / 16.0f;
            CHECK_OK(relume_image_save(&image, path, NULL));
            relume_image_destroy(&image);
        }
}

static void test_pictures(void **state)
{
    (void)state;
    char folder[64];
    test_folder(folder);
    write_pictures(folder, -1);
    relume_btf *btf;
    CHECK_OK(relume_btf_open(&btf, folder, relume_btf_params(.threads = 2)));
    const struct relume_btf_info *info = relume_btf_info(btf);
    assert_int_equal(info->views, 4);
    assert_int_equal(info->lights, 4);
    CHECK_NEAR(info->view[2].y, sin(M_PI / 4) * sin(2.0 * M_PI / 3.0), 1e-9);
    for (int v = 0; v < 4; v++)
        for (int l = 0; l < 4; l++)
            CHECK_NEAR(float_from_half(relume_btf_picture(btf, v, l)[4]), (v * 4 + l) / 16.0, 0.0);
    relume_btf_destroy(&btf);
    test_folder_remove(folder);
}

// As Bonn packs them: a folder for each view; what else lies there does not matter.
static void test_view_folders(void **state)
{
    (void)state;
    static const int angles[4][2] = {{0, 0}, {45, 0}, {45, 120}, {45, 240}};
    char folder[64], path[200];
    test_folder(folder);
    for (int v = 0; v < 4; v++) {
        snprintf(path, sizeof path, "%s/tv%03d_pv%03d", folder, angles[v][0], angles[v][1]);
        assert_int_equal(mkdir(path, 0777), 0);
        for (int l = 0; l < 4; l++) {
            struct relume_image image;
            snprintf(path, sizeof path, "%s/tv%03d_pv%03d/%05d tl%03d pl%03d tv%03d pv%03d.png",
                     folder, angles[v][0], angles[v][1], 4 * v + l + 1, angles[l][0], angles[l][1],
                     angles[v][0], angles[v][1]);
            CHECK_OK(relume_image_create(&image, W, H, 3));
            for (int i = 0; i < W * H * 3; i++)
                image.data[i] = v == 2 && l == 3 ? 0.5f : 0.0f;
            CHECK_OK(relume_image_save(&image, path, NULL));
            relume_image_destroy(&image);
        }
    }
    snprintf(path, sizeof path, "%s/tv000_pv000/readme.txt", folder);
    test_write(path, "x", 1);
    snprintf(path, sizeof path, "%s/._tl000 pl000 tv000 pv000.png", folder);
    test_write(path, "x", 1);
    relume_btf *btf;
    CHECK_OK(relume_btf_open(&btf, folder, NULL));
    assert_int_equal(relume_btf_info(btf)->views, 4);
    assert_int_equal(relume_btf_info(btf)->lights, 4);
    // 8 bits
    CHECK_NEAR(float_from_half(relume_btf_picture(btf, 2, 3)[4]), 0.5, 0.005);
    CHECK_NEAR(float_from_half(relume_btf_picture(btf, 3, 2)[4]), 0.0, 0.0);
    relume_btf_destroy(&btf);
    test_folder_remove(folder);
}

static void expect_refusal(const char *folder, const char *sentence)
{
    struct test_log log;
    test_log_init(&log);
    relume_btf *btf;
    assert_true(
        relume_status_is_input(relume_btf_open(&btf, folder, relume_btf_params(.log = &log.log))));
    if (!strstr(log.text, sentence))
        fail_msg("expected '%s'; found '%s'", sentence, log.text);
    assert_null(btf);
}

static void test_bad_pictures(void **state)
{
    (void)state;
    char folder[64], path[160];
    expect_refusal(test_folder(folder), "expected btf.json, or pictures");
    write_pictures(folder, 6);
    expect_refusal(folder, "no picture for tl045_pl120_tv045_pv000");
    struct test_log log;
    test_log_init(&log);
    relume_btf *btf;
    CHECK_OK(relume_btf_open(&btf, folder, relume_btf_params(.fill = true, .log = &log.log)));
    assert_non_null(strstr(log.text, "1 missing picture"));
    // the mean of the view's other lights, 45 degrees and twice 75.5 away
    const double near = 1.0 / (M_PI / 4), far = 1.0 / acos(0.5 - 0.25);
    CHECK_NEAR(float_from_half(relume_btf_picture(btf, 1, 2)[0]),
               (near * 4 + far * 5 + far * 7) / (near + 2 * far) / 16.0, 1e-3);
    relume_btf_destroy(&btf);
    snprintf(path, sizeof path, "%s/M_tl095_pl000_tv000_pv000.exr", folder);
    test_write(path, "x", 1);
    expect_refusal(folder, "tl095_pl000_tv000_pv000.exr: angles");
    remove(path);
    // a typing error makes a light of one picture, which --fill must not complete
    snprintf(path, sizeof path, "%s/M_tl046_pl120_tv045_pv000.exr", folder);
    struct relume_image other;
    CHECK_OK(relume_image_create(&other, W, H, 3));
    CHECK_OK(relume_image_save(&other, path, NULL));
    relume_image_destroy(&other);
    for (int i = 0; i < 4; i++) {  // one of four views is not few
        char more[160];
        snprintf(more, sizeof more, "%s/M_tl000_pl000_tv050_pv%03d.exr", folder, 10 * i);
        CHECK_OK(relume_image_create(&other, W, H, 3));
        CHECK_OK(relume_image_save(&other, more, NULL));
        relume_image_destroy(&other);
    }
    expect_refusal(folder,
                   "M_tl046_pl120_tv045_pv000.exr: the angles seem wrong; expected pictures of "
                   "tl046_pl120 for 8 views, as of others; found 1");
    remove(path);
    for (int i = 0; i < 4; i++) {
        snprintf(path, sizeof path, "%s/M_tl000_pl000_tv050_pv%03d.exr", folder, 10 * i);
        remove(path);
    }
    CHECK_OK(relume_image_create(&other, W + 1, H, 3));
    snprintf(path, sizeof path, "%s/M_tl045_pl120_tv045_pv000.exr", folder);
    CHECK_OK(relume_image_save(&other, path, NULL));
    expect_refusal(folder, "4 x 2 pixels; expected 3 x 2");
    relume_image_destroy(&other);
    // one texel of six in one picture of sixteen is white: 1.04 %
    CHECK_OK(relume_image_create(&other, W, H, 3));
    other.data[4] = 1.0f;
    CHECK_OK(relume_image_save(&other, path, NULL));
    relume_image_destroy(&other);
    CHECK_OK(relume_btf_open(&btf, folder, relume_btf_params(.fill = true, .log = &log.log)));
    assert_non_null(strstr(log.text, "1 % of all texels are saturated, most in "
                                     "M_tl045_pl120_tv045_pv000.exr"));
    relume_btf_destroy(&btf);
    CHECK_OK(relume_image_create(&other, W, H, 3));
    other.data[5] = NAN;
    CHECK_OK(relume_image_save(&other, path, NULL));
    expect_refusal(folder, "NaN or infinity");
    relume_image_destroy(&other);
    test_folder_remove(folder);
}

// Every picture of a slab's views has one value, its own: by how its camera and light stand.
static void test_capture(void **state)
{
    (void)state;
    enum { VIEWS = 4, LIGHTS = 5 };
    static const double uv[VIEWS][2] = {{-1, -1}, {1, -1}, {1.5, 1}, {-1, 1}};
    const struct relume_vec3 light[LIGHTS] = {vec3_unit(vec3_of(1, 0, 2)), vec3_of(0, 0, -1),
                                              vec3_unit(vec3_of(-1, 1, 1)), vec3_of(0, 0, 1),
                                              vec3_unit(vec3_of(0, -1, 1))};
    char folder[64], path[256], name[VIEWS][LIGHTS][16];
    const char *images[VIEWS][LIGHTS];
    struct relume_manifest_view view[VIEWS] = {{.slab = 0}};
    test_folder(folder);
    for (int v = 0; v < VIEWS; v++) {
        memcpy(view[v].uv, uv[v], sizeof uv[v]);
        view[v].images = images[v];
        for (int l = 0; l < LIGHTS; l++) {
            struct relume_image image;
            snprintf(name[v][l], sizeof name[v][l], "%d-%d.exr", v, l);
            images[v][l] = name[v][l];
            snprintf(path, sizeof path, "%s/%.16s", folder, name[v][l]);
            CHECK_OK(relume_image_create(&image, W, H, 3));
            for (int i = 0; i < W * H * 3; i++)
                image.data[i] = (float)(0.125 * v + 0.015625 * l);
            image.data[0] = 1.0f;  // the upper left
            CHECK_OK(relume_image_save(&image, path, NULL));
            relume_image_destroy(&image);
        }
    }
    struct relume_manifest m = {.geometry = relume_geometry_default(RELUME_SLAB, W, H),
                                .lights = LIGHTS,
                                .directions = light,
                                .views = VIEWS,
                                .view = view};
    m.geometry.uv_z = 2.0;
    m.geometry.st_min[0] = 0.0, m.geometry.st_max[0] = 1.0;
    m.geometry.st_min[1] = -0.5, m.geometry.st_max[1] = 0.5;
    snprintf(path, sizeof path, "%s/capture.json", folder);
    CHECK_OK(relume_manifest_write(&m, path, NULL));
    relume_btf *btf;
    CHECK_OK(relume_btf_open(&btf, folder, NULL));
    const struct relume_btf_info *i = relume_btf_info(btf);
    assert_int_equal(i->views, VIEWS);
    assert_int_equal(i->lights, LIGHTS - 1);  // the second stands behind
    assert_int_equal(i->width, W);
    assert_false(i->without_cosine);
    for (int v = 0; v < VIEWS; v++) {
        const vec3 want = vec3_unit(vec3_of(uv[v][0] - 0.5, uv[v][1], 2.0));
        CHECK_NEAR(vec3_dot(i->view[v], want), 1.0, 1e-12);
        for (int l = 0; l < LIGHTS - 1; l++) {
            const int at = l ? l + 1 : 0;
            const uint16_t *p = relume_btf_picture(btf, v, l);
            CHECK_NEAR(vec3_dot(i->light[l], light[at]), 1.0, 1e-12);
            CHECK_NEAR(float_from_half(p[0]), 1.0, 0);
            CHECK_NEAR(float_from_half(p[3 * W * H - 1]), 0.125 * v + 0.015625 * at, 0);
        }
    }
    relume_btf_destroy(&btf);
    m.geometry = relume_geometry_default(RELUME_PLANAR, W, H);
    m.views = 1;
    CHECK_OK(relume_manifest_write(&m, path, NULL));
    expect_refusal(folder, "needs the views of one slab");
    m.geometry = relume_geometry_default(RELUME_SLAB, W, H);
    m.views = 2;
    CHECK_OK(relume_manifest_write(&m, path, NULL));
    snprintf(path, sizeof path, "%s: view directions: expected 3 or more; found 2", folder);
    expect_refusal(folder, path);
    test_folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sets),
        cmocka_unit_test(test_meshes),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_reference),
        cmocka_unit_test(test_folder_round_trip),
        cmocka_unit_test(test_part),
        cmocka_unit_test(test_pictures),
        cmocka_unit_test(test_view_folders),
        cmocka_unit_test(test_bad_pictures),
        cmocka_unit_test(test_capture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
