// Billboard clouds: known planes of known shapes, every triangle against its plane by its own
// measure, texels against the surface, pictures of clouds against those of the mesh.
#include "shape/distance/lod.h"

#include "in_folder.h"

#include <relume/shape/billboards.h>
#include <relume/world/object.h>

static struct relume_mesh mesh_of(const float (*position)[3], size_t vertices,
                                  const uint32_t (*triangle)[3], size_t triangles)
{
    return (struct relume_mesh){.vertex_count = vertices,
                                .triangle_count = triangles,
                                .position = (float(*)[3])(uintptr_t)position,
                                .triangle = (uint32_t(*)[3])(uintptr_t)triangle};
}

// Turned, so that its faces lie along no axis.
static void cube(float position[8][3])
{
    const double c = cos(0.4), s = sin(0.4);
    for (int i = 0; i < 8; i++) {
        const double x = i & 1, y = i >> 1 & 1, z = i >> 2;
        const double u = c * x - s * y, v = s * x + c * y;
        position[i][0] = (float)u;
        position[i][1] = (float)(c * v - s * z);
        position[i][2] = (float)(s * v + c * z);
    }
}
static const uint32_t cube_faces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                           {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                           {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};

// A ball of radius 1.
enum { ACROSS = 32, DOWN = 16, BALL = ACROSS * (DOWN + 1) };
static float ball_position[BALL][3];
static uint32_t ball_triangle[2 * ACROSS * DOWN][3];

static struct relume_mesh ball(void)
{
    for (int j = 0; j <= DOWN; j++)
        for (int i = 0; i < ACROSS; i++) {
            const double theta = M_PI * j / DOWN, phi = 2.0 * M_PI * i / ACROSS;
            float *p = ball_position[j * ACROSS + i];
            p[0] = (float)(sin(theta) * cos(phi));
            p[1] = (float)cos(theta);
            p[2] = (float)(-sin(theta) * sin(phi));
        }
    for (uint32_t j = 0; j < DOWN; j++)
        for (uint32_t i = 0; i < ACROSS; i++) {
            const uint32_t a = j * ACROSS + i, b = j * ACROSS + (i + 1) % ACROSS;
            const uint32_t quad[2][3] = {{a, a + ACROSS, b + ACROSS}, {a, b + ACROSS, b}};
            memcpy(ball_triangle[2 * a], quad, sizeof quad);
        }
    return mesh_of((const float(*)[3])ball_position, BALL, (const uint32_t(*)[3])ball_triangle,
                   sizeof ball_triangle / sizeof *ball_triangle);
}

static struct relume_billboards made(const struct relume_mesh *mesh,
                                     const struct relume_billboards_params *params)
{
    struct relume_billboards cloud;
    assert_int_equal(relume_billboards_create(&cloud, mesh, params), RELUME_OK);
    return cloud;
}

static double dot(const float a[3], const float b[3])
{
    return (double)a[0] * (double)b[0] + (double)a[1] * (double)b[1] + (double)a[2] * (double)b[2];
}

// The area that texels say is covered.
static double covered(const struct relume_billboards *c)
{
    double sum = 0.0;
    for (size_t i = 0; i < c->texels; i++)
        sum += (double)c->texel[i].coverage;
    return sum * (double)c->side * (double)c->side;
}

static void a_cube_has_six(void **state)
{
    (void)state;
    float position[8][3];
    cube(position);
    const struct relume_mesh mesh = mesh_of((const float(*)[3])position, 8, cube_faces, 12);
    for (int method = 0; method < 2; method++) {
        struct relume_billboards c =
            made(&mesh, relume_billboards_params(.method = (enum relume_billboards_method)method,
                                                 .error = 1e-4, .texel = 0.01));
        assert_int_equal(c.count, 6);
        CHECK_NEAR(c.error, 0.0, 1e-6);
        // each rectangle is its face, whatever the face's axes
        CHECK_NEAR(covered(&c), 6.0, 1e-3);
        assert_true((double)c.texels * (double)c.side * (double)c.side < 6.3);
        for (int face = 0; face < 6; face++)
            assert_int_equal(c.owner[2 * face], c.owner[2 * face + 1]);
        relume_billboards_free(&c);
    }
    struct relume_billboards six = made(&mesh, relume_billboards_params(.count = 6));
    assert_int_equal(six.count, 6);
    CHECK_NEAR(six.error, 0.0, 1e-6);
    relume_billboards_free(&six);
}

// Two squares that face the same way, `gap` apart.
static size_t layers(double gap, double error, enum relume_billboards_method method, float *largest)
{
    const float z = (float)gap;
    const float position[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                  {0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}};
    const uint32_t triangle[4][3] = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    const struct relume_mesh mesh = mesh_of(position, 8, triangle, 4);
    struct relume_billboards c =
        made(&mesh, relume_billboards_params(.method = method, .error = error));
    const size_t count = c.count;
    *largest = c.error;
    // what lies in front is seen
    for (size_t i = 0; count == 1 && i < c.texels; i++)
        assert_true(c.texel[i].triangle >= 2);
    relume_billboards_free(&c);
    return count;
}

static void near_layers_become_one(void **state)
{
    (void)state;
    float error;
    for (int i = 0; i < 2; i++) {
        const enum relume_billboards_method method = (enum relume_billboards_method)i;
        assert_int_equal(layers(0.03, 0.02, method, &error), 1);
        CHECK_NEAR(error, 0.015, 1e-6);
        assert_int_equal(layers(0.05, 0.02, method, &error), 2);
        CHECK_NEAR(error, 0.0, 1e-6);
    }
}

static double height_of(const struct relume_billboard *b, const float p[3])
{
    return dot(p, b->normal) - dot(b->corner, b->normal);
}

static void every_triangle_is_near_its_plane(void **state)
{
    (void)state;
    const struct relume_mesh mesh = ball();
    for (int method = 0; method < 2; method++) {
        const double error = 0.03;  // of a side of 2
        struct relume_billboards c =
            made(&mesh, relume_billboards_params(.method = (enum relume_billboards_method)method,
                                                 .error = error));
        double largest = 0.0, most_turned = 1.0;
        size_t flat = 0;
        for (size_t i = 0; i < mesh.triangle_count; i++) {
            if (c.owner[i] == RELUME_BILLBOARD_NONE) {
                flat++;  // at the poles, where quads are triangles
                continue;
            }
            const struct relume_billboard *b = &c.billboard[c.owner[i]];
            float middle[3] = {0};
            for (int k = 0; k < 3; k++) {
                const float *p = mesh.position[mesh.triangle[i][k]];
                largest = fmax(largest, fabs(height_of(b, p)));
                for (int a = 0; a < 3; a++)
                    middle[a] += p[a];
            }
            most_turned = fmin(most_turned, dot(middle, b->normal) / sqrt(dot(middle, middle)));
        }
        assert_int_equal(flat, 2 * ACROSS);
        assert_true(largest <= 2.0 * error * (1.0 + 1e-5));
        CHECK_NEAR(c.error, largest, 1e-5);
        assert_true(c.count >= 6 && c.count < 200);
        if (method == RELUME_BILLBOARDS_CLUSTERS)
            assert_true(most_turned > cos(61.0 * M_PI / 180.0));
        relume_billboards_free(&c);
    }
}

// The place of the surface that a texel names lies over the texel, and no farther than the error.
static void texels_show_what_is_over_them(void **state)
{
    (void)state;
    const struct relume_mesh mesh = ball();
    struct relume_billboards c = made(&mesh, relume_billboards_params(.error = 0.02));
    size_t shown = 0;
    for (size_t n = 0; n < c.count; n++) {
        const struct relume_billboard *b = &c.billboard[n];
        for (int i = 0; i < b->width * b->height; i++) {
            const struct relume_billboard_texel *t = &c.texel[b->first + (size_t)i];
            float at[3] = {0};
            assert_true((t->coverage > 0.0f) == (t->triangle != RELUME_BILLBOARD_NONE));
            if (t->triangle == RELUME_BILLBOARD_NONE)
                continue;
            const float weight[3] = {1.0f - t->weight[0] - t->weight[1], t->weight[0],
                                     t->weight[1]};
            for (int k = 0; k < 3; k++)
                for (int a = 0; a < 3; a++)
                    at[a] += weight[k] * mesh.position[mesh.triangle[t->triangle][k]][a];
            const double x = (dot(at, b->across) - dot(b->corner, b->across)) / (double)c.side;
            const double y = (dot(at, b->up) - dot(b->corner, b->up)) / (double)c.side;
            CHECK_NEAR(x, i % b->width + 0.5, 0.51);
            CHECK_NEAR(y, i / b->width + 0.5, 0.51);
            assert_true(fabs(height_of(b, at)) <= 0.04 * (1.0 + 1e-4));
            shown++;
        }
    }
    assert_true(shown > 1000);
    relume_billboards_free(&c);
}

// However the square lies in its texels.
static void coverage_is_area(void **state)
{
    (void)state;
    const float position[5][3] = {
        {0, 0, 0}, {0.8f, 0, 0.6f}, {0.8f, 1, 0.6f}, {0, 1, 0}, {-0.4f, 0.5f, -0.3f}};
    const uint32_t triangle[3][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
    const struct relume_mesh square = mesh_of(position, 4, triangle, 2);
    const struct relume_mesh house = mesh_of(position, 5, triangle, 3);
    for (int i = 0; i < 4; i++) {
        const double texel = 0.013 + 0.017 * i;
        struct relume_billboards c = made(&square, relume_billboards_params(.texel = texel));
        assert_int_equal(c.count, 1);
        CHECK_NEAR(covered(&c), 1.0, 1e-5);
        relume_billboards_free(&c);
        c = made(&house, relume_billboards_params(.texel = texel));
        assert_int_equal(c.count, 1);
        CHECK_NEAR(covered(&c), 1.25, 1e-5);
        relume_billboards_free(&c);
    }
}

static void finer_errors_take_more(void **state)
{
    (void)state;
    const struct relume_mesh mesh = ball();
    size_t count = 0, texels = 0;
    for (double error = 0.08; error > 0.015; error *= 0.5) {
        struct relume_billboards c = made(&mesh, relume_billboards_params(.error = error));
        assert_true(c.count > count && c.texels > texels);
        count = c.count, texels = c.texels;
        relume_billboards_free(&c);
    }
}

static void what_cannot_be_is_refused(void **state)
{
    (void)state;
    float position[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}};
    uint32_t triangle[1][3] = {{0, 1, 2}};
    const struct relume_mesh mesh =
        mesh_of((const float(*)[3])position, 4, (const uint32_t(*)[3])triangle, 1);
    const struct relume_mesh none = {.vertex_count = 0};
    struct relume_billboards c;
    assert_int_equal(relume_billboards_create(&c, &none, NULL), RELUME_EUNFIT);
    assert_null(c.billboard);
    assert_int_equal(relume_billboards_create(&c, &mesh, relume_billboards_params(.error = -1)),
                     RELUME_EINVAL);
    assert_int_equal(relume_billboards_create(&c, &mesh, relume_billboards_params(.waste = NAN)),
                     RELUME_EINVAL);
    assert_int_equal(
        relume_billboards_create(
            &c, &mesh, relume_billboards_params(.method = RELUME_BILLBOARDS_GREEDY, .count = 3)),
        RELUME_EINVAL);
    assert_int_equal(relume_billboards_create(&c, &mesh, relume_billboards_params(.texel = 1e-5)),
                     RELUME_ELIMIT);
    triangle[0][2] = 4;
    assert_int_equal(relume_billboards_create(&c, &mesh, NULL), RELUME_EINVAL);
    triangle[0][2] = 3;  // in one line
    assert_int_equal(relume_billboards_create(&c, &mesh, NULL), RELUME_EUNFIT);
    triangle[0][2] = 2;
    position[1][1] = NAN;
    assert_int_equal(relume_billboards_create(&c, &mesh, NULL), RELUME_EINVAL);
}

static void a_sheet_holds_all_texels(void **state)
{
    (void)state;
    const struct relume_mesh mesh = ball();
    struct relume_billboards c = made(&mesh, relume_billboards_params(.error = 0.05));
    struct relume_mesh quads;
    struct relume_image picture;
    assert_int_equal(relume_billboards_sheet(&quads, &picture, &c, &mesh, NULL, NULL), RELUME_OK);
    assert_int_equal(quads.triangle_count, 2 * c.count);
    double sum = 0.0;
    for (size_t i = 0; i < (size_t)picture.width * (size_t)picture.height; i++)
        sum += (double)picture.data[4 * i + 3];
    CHECK_NEAR(sum * (double)c.side * (double)c.side, covered(&c), 1e-4);
    // a quad's corners in the picture are as far apart, in texels, as in the world
    for (size_t q = 0; q < c.count; q++) {
        const float *a = quads.texture[4 * q], *b = quads.texture[4 * q + 2];
        CHECK_NEAR((double)(b[0] - a[0]) * picture.width, c.billboard[q].width, 1e-3);
        CHECK_NEAR((double)(b[1] - a[1]) * picture.height, c.billboard[q].height, 1e-3);
    }
    relume_mesh_free(&quads);
    relume_image_destroy(&picture);
    relume_billboards_free(&c);
}

// ---------------------------------------------------------------- drawn

static void render(struct relume_image *out, const char *billboards)
{
    char text[512];
    relume_objects *o;
    struct relume_window window;
    const struct relume_light light = {
        .kind = RELUME_LIGHT_DIRECTIONAL, .direction = {0.5, 0.6, 0.8}, .rgb = {1, 1, 1}};
    snprintf(text, sizeof text,
             "{\"format\": \"relume-objects\", \"version\": 1, \"objects\": [{\"mesh\": "
             "\"ball.obj\"%s, \"parts\": [{\"material\": {\"diffuse\": [0.8, 0.5, 0.3]}}]}]}",
             billboards);
    write_text("ball.json", text);
    assert_int_equal(relume_objects_open(&o, path_of("ball.json"), NULL), RELUME_OK);
    assert_true(relume_objects_window(&window, o, (struct relume_vec3){3, 2, 8}, NULL, 64, 64));
    assert_int_equal(relume_image_create(out, 64, 64, 3), RELUME_OK);
    assert_int_equal(
        relume_objects_render(out, o, &window, &light, 1, relume_render_params(.samples = 2)),
        RELUME_OK);
    relume_objects_destroy(&o);
}

static double psnr_of(const char *billboards, const struct relume_image *reference)
{
    struct relume_image image;
    struct relume_difference difference;
    render(&image, billboards);
    assert_int_equal(
        relume_image_compare(&difference, reference, &image,
                             relume_compare_params(.no_ssim = true, .no_delta_e = true)),
        RELUME_OK);
    relume_image_destroy(&image);
    return difference.psnr_db;
}

static void a_cloud_looks_like_its_mesh(void **state)
{
    (void)state;
    struct relume_mesh mesh = ball();
    struct relume_image reference;
    mesh.normal = mesh.position;
    assert_int_equal(relume_mesh_write(&mesh, path_of("ball.obj"), NULL), RELUME_OK);
    render(&reference, "");
    const double fine = psnr_of(", \"billboards\": 0.005", &reference);
    const double coarse = psnr_of(", \"billboards\": 0.04", &reference);
    assert_true(fine > 32.0);
    assert_true(coarse > 18.0 && coarse < fine);
    relume_image_destroy(&reference);
}

static void bad_descriptions_are_refused(void **state)
{
    (void)state;
    relume_objects *o;
    write_text("bad.json", "{\"format\": \"relume-objects\", \"version\": 1, \"objects\": [{"
                           "\"mesh\": \"ball.obj\", \"billboards\": 2, \"parts\": [{\"material\": "
                           "{\"diffuse\": 1}}]}]}");
    assert_int_equal(relume_objects_open(&o, path_of("bad.json"), NULL), RELUME_EFORMAT);
}

// ---------------------------------------------------------------- how much is needed

static void errors_are_seen_as_pixels(void **state)
{
    (void)state;
    // 90 degrees over 1000 pixels: at distance d 2 d are seen
    CHECK_NEAR(relume_lod_pixels(0.01, 5.0, M_PI_2, 1000), 1.0, 1e-12);
    CHECK_NEAR(relume_lod_pixels(0.01, 50.0, M_PI_2, 1000), 0.1, 1e-12);
    assert_true(isinf(relume_lod_pixels(0.01, 0.0, M_PI_2, 1000)));
    const double error[4] = {0.0, 0.01, 0.02, 0.04};
    assert_int_equal(relume_lod_choose(error, 4, 1.0, 4.9, M_PI_2, 1000), 0);
    assert_int_equal(relume_lod_choose(error, 4, 1.0, 5.1, M_PI_2, 1000), 1);
    assert_int_equal(relume_lod_choose(error, 4, 1.0, 10.1, M_PI_2, 1000), 2);
    assert_int_equal(relume_lod_choose(error, 4, 1.0, 1000.0, M_PI_2, 1000), 3);
    assert_int_equal(relume_lod_choose(error, 4, 1.0, 0.0, M_PI_2, 1000), 0);
    // too coarse and too fine are as urgent; what is unseen comes behind all that is seen
    CHECK_NEAR(relume_lod_priority(4.0, 1.0, true), 4.0, 1e-12);
    CHECK_NEAR(relume_lod_priority(1.0, 4.0, true), 4.0, 1e-12);
    CHECK_NEAR(relume_lod_priority(1.0, 1.0, true), 1.0, 1e-12);
    CHECK_NEAR(relume_lod_priority(4.0, 1.0, false), 0.75, 1e-12);
}

// Progress that ascends, until it is stopped at the n-th call.
struct stop {
    int calls, at;
    double last;
};

static bool stops(void *user, const char *what, double done)
{
    struct stop *s = user;
    assert_true(strlen(what) > 0 && done >= 0.0 && done <= 1.0);
    s->last = done;
    return ++s->calls != s->at;
}

static void it_can_be_stopped(void **state)
{
    (void)state;
    const struct relume_mesh mesh = ball();
    for (int method = 0; method < 2; method++)
        for (int at = 0, last = 1; at <= last; at += at < 2 || at == last ? 1 : last - at) {
            struct stop stop = {.at = at};
            const struct relume_log log = {.progress = stops, .user = &stop};
            struct relume_billboards cloud;
            const relume_status status = relume_billboards_create(
                &cloud, &mesh,
                relume_billboards_params(.log = &log, .error = 0.5,
                                         .method = (enum relume_billboards_method)method));
            assert_int_equal(status, at ? RELUME_ECANCEL : RELUME_OK);
            last = at ? last : stop.calls;
            assert_true((cloud.count > 0) == !at);
            relume_billboards_free(&cloud);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_has_six),
        cmocka_unit_test(near_layers_become_one),
        cmocka_unit_test(every_triangle_is_near_its_plane),
        cmocka_unit_test(texels_show_what_is_over_them),
        cmocka_unit_test(coverage_is_area),
        cmocka_unit_test(finer_errors_take_more),
        cmocka_unit_test(what_cannot_be_is_refused),
        cmocka_unit_test(a_sheet_holds_all_texels),
        cmocka_unit_test(a_cloud_looks_like_its_mesh),
        cmocka_unit_test(bad_descriptions_are_refused),
        cmocka_unit_test(errors_are_seen_as_pixels),
        cmocka_unit_test(it_can_be_stopped),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
