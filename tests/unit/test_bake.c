// Baked objects against closed forms (a furnace, a bowl, Lambert's sphere in spherical harmonics),
// against the objects themselves where nothing is left out, and files that are broken.
#include "in_folder.h"
#include "made_btf.h"

#include "format/coder/coding.h"
#include "relight/light/environment.h"
#include "world/object/object.h"

enum { SMALL = TEST_SANITIZED };

// ---------------------------------------------------------------- meshes

// The sphere of radius 1, or the half of it below z = 0 seen from within.
static void write_sphere(const char *name, bool bowl)
{
    enum { ROUND = 24, HIGH = 12 };
    FILE *f = fopen(path_of(name), "w");
    assert_non_null(f);
    for (int j = 0; j <= HIGH; j++)
        for (int i = 0; i <= ROUND; i++) {
            const double theta = M_PI * (bowl ? 0.5 + 0.5 * j / HIGH : (double)j / HIGH);
            const double phi = 2.0 * M_PI * i / ROUND, side = bowl ? -1 : 1;
            const double x = sin(theta) * cos(phi), y = sin(theta) * sin(phi), z = cos(theta);
            fprintf(f, "v %.9g %.9g %.9g\nvn %.9g %.9g %.9g\n", x, y, z, side * x, side * y,
                    side * z);
        }
    for (int j = 0; j < HIGH; j++)
        for (int i = 0; i < ROUND; i++) {
            const int a = j * (ROUND + 1) + i + 1, b = a + ROUND + 1;
            fprintf(f, "f %d//%d %d//%d %d//%d %d//%d\n", a, a, b, b, b + 1, b + 1, a + 1, a + 1);
        }
    fclose(f);
}

// A floor, and a square that hangs over its middle.
static const char hanging[] =
    "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
    "v -.4 -.4 .5\nv .4 -.4 .5\nv .4 .4 .5\nv -.4 .4 .5\n"
    "vt 0 0\nvt .6 0\nvt .6 .6\nvt 0 .6\nvt .7 .7\nvt 1 .7\nvt 1 1\nvt .7 1\n"
    "vn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\nf 5/5/1 6/6/1 7/7/1 8/8/1\n";

static relume_objects *of(const char *mesh, const char *material)
{
    char text[512];
    relume_objects *o;
    snprintf(text, sizeof text,
             "{\"format\": \"relume-objects\", \"version\": 1, \"objects\": [{\"mesh\": \"%s\", "
             "\"parts\": [{\"material\": %s}]}]}",
             mesh, material);
    write_text("objects.json", text);
    CHECK_OK(relume_objects_open(&o, path_of("objects.json"), NULL));
    return o;
}

static void fill(const void *context, struct relume_vec3 v, struct relume_vec3 l, float *rgb)
{
    (void)context;
    for (int i = 0; i < 4 * 4 * 3; i++)
        rgb[i] = (float)(l.z * (0.5 + 0.3 * l.x * v.x + 0.2 * v.y + 0.1 * l.y + 0.02 * (i % 5)));
}

static int make_all(void **state)
{
    make_folder(state);
    write_sphere("sphere.obj", false);
    write_sphere("bowl.obj", true);
    write_text("hanging.obj", hanging);
    relume_btf *btf =
        made_btf(&(struct made_btf){.name = "sample", .width = 4, .height = 4, .fill = fill});
    CHECK_OK(relume_btf_save(btf, path_of("sample"), NULL));
    relume_btf_destroy(&btf);
    return 0;
}

// ---------------------------------------------------------------- looking

// The baked objects as objects, by way of a file.
static relume_objects *baked_objects(relume_objects *o, const struct relume_bake_params *params,
                                     double *error)
{
    relume_baked *b;
    relume_objects *out;
    CHECK_OK(relume_bake(&b, o, params));
    if (error)
        *error = relume_baked_info(b)->error;
    CHECK_OK(relume_baked_save(b, path_of("baked.exr"), NULL));
    relume_baked_destroy(&b);
    CHECK_OK(relume_objects_open(&out, path_of("baked.exr"), NULL));
    return out;
}

static void look(float rgb[3], const relume_objects *o, vec3 eye, vec3 at,
                 const struct relume_light *lights, int n)
{
    struct lighting l;
    struct surface_point p;
    CHECK_OK(lighting_create(&l, o, lights, n, NULL));
    assert_true(objects_hit(&p, o, eye, vec3_unit(vec3_sub(at, eye))));
    objects_shade(rgb, o, &p, eye, &l);
    lighting_destroy(&l);
}

static struct relume_light from(vec3 direction)
{
    return (struct relume_light){.direction = direction, .rgb = {1, 1, 1}};
}

// An environment that is 1 all over.
static relume_environment *even(void)
{
    struct relume_image map;
    relume_environment *e;
    CHECK_OK(relume_image_create(&map, 64, 32, 3));
    for (int i = 0; i < 3 * 64 * 32; i++)
        map.data[i] = 1.0f;
    CHECK_OK(relume_environment_create(&e, &map, NULL));
    relume_image_destroy(&map);
    return e;
}

static struct relume_light sky_of(const relume_environment *e)
{
    return (struct relume_light){
        .kind = RELUME_LIGHT_ENVIRONMENT, .environment = e, .rgb = {1, 1, 1}};
}

// ---------------------------------------------------------------- closed forms

// Of light from one direction, spherical harmonics of degree 5 say of n.l the sum over l of
// (2 l + 1) / (4 pi) A_l P_l(n.l), A = pi, 2 pi / 3, pi / 4, 0, -pi / 24, 0 (Ramamoorthi and
// Hanrahan 2001); under an even sky it is white.
static void a_sphere_is_lamberts(void **state)
{
    (void)state;
    relume_objects *o = of("sphere.obj", "{\"diffuse\": 1}");
    relume_objects *b =
        baked_objects(o,
                      relume_bake_params(.width = 32, .components = 12, .clusters = 4,
                                         .bounces = -1, .lights = 256),
                      NULL);
    relume_environment *e = even();
    const struct relume_light sky = sky_of(e);
    for (int i = 0; i < (SMALL ? 4 : 12); i++) {
        const vec3 n = vec3_unit(vec3_of(cos(2.4 * i), sin(2.4 * i), -1.0 + (i + 0.5) / 6.0));
        const struct relume_light lamp = from(vec3_of(0.3, -0.5, 0.6));
        const double c = vec3_dot(n, vec3_unit(lamp.direction));
        const double p2 = 1.5 * c * c - 0.5;
        const double p4 = (35.0 * c * c * c * c - 30.0 * c * c + 3.0) / 8.0;
        const double want = fmax(0.25 + 0.5 * c + 5.0 / 16.0 * p2 - 9.0 / 96.0 * p4, 0.0);
        float rgb[3];
        look(rgb, b, vec3_scale(n, 3.0), vec3_of(0, 0, 0), &lamp, 1);
        CHECK_NEAR(rgb[1], want, 0.03);
        look(rgb, b, vec3_scale(n, 3.0), vec3_of(0, 0, 0), &sky, 1);
        CHECK_NEAR(rgb[1], 1.0, 0.02);
    }
    relume_environment_destroy(&e);
    relume_objects_destroy(&b);
    relume_objects_destroy(&o);
}

// Every place of half a sphere sees the sky by one half and, likewise, all of the bowl: B = r / 2
// (1 + B), of so many bounces the sum of (r / 2)^k; in a furnace, r = 1, it is 1.
static void a_bowl_adds_its_bounces(void **state)
{
    (void)state;
    relume_environment *e = even();
    const struct relume_light sky = sky_of(e);
    const struct {
        double reflectance;
        int bounces;
    } bowl[] = {{0.8, 1}, {0.8, 3}, {1.0, 10}};
    for (int i = 0; i < (SMALL ? 1 : 3); i++) {
        char material[64];
        snprintf(material, sizeof material, "{\"diffuse\": %g}", bowl[i].reflectance);
        relume_objects *o = of("bowl.obj", material);
        relume_objects *b = baked_objects(
            o,
            relume_bake_params(.width = 24, .components = 9, .clusters = 1,
                               .bounces = bowl[i].bounces, .coefficients = 9, .lights = 128),
            NULL);
        double want = 0.0, mean = 0.0;
        for (int k = 0; k <= (bowl[i].bounces < 0 ? 0 : bowl[i].bounces); k++)
            want += pow(0.5 * bowl[i].reflectance, k + 1);
        for (int k = 0; k < 16; k++) {
            const double phi = 0.7 * k, r = 0.85 * sqrt((k + 0.5) / 16);
            float rgb[3];
            look(rgb, b, vec3_of(0, 0, 0.3), vec3_of(r * cos(phi), r * sin(phi), -0.6), &sky, 1);
            CHECK_NEAR(rgb[0], want, 0.1);  // 64 rays, the same in every bounce
            mean += (double)rgb[0] / 16;
        }
        CHECK_NEAR(mean, want, 0.02);
        relume_objects_destroy(&b);
        relume_objects_destroy(&o);
    }
    relume_environment_destroy(&e);
}

// ---------------------------------------------------------------- against the objects

// Whether the middle of a texel lies within a triangle, and where that is on the mesh.
static bool place_of(vec3 *out, double place[2], const relume_baked *b, size_t texel)
{
    const int width = b->info.width;
    place[0] = ((int)(texel % (size_t)width) + 0.5) / width;
    place[1] = ((int)(texel / (size_t)width) + 0.5) / b->info.height;
    for (size_t i = 0; i < b->info.triangles; i++) {
        const struct atlas_corner *c = b->triangle[i];
        double w[3], area = 0.0;
        for (int k = 0; k < 3; k++) {
            const float *p = c[(k + 1) % 3].place, *q = c[(k + 2) % 3].place;
            w[k] = ((double)p[0] - place[0]) * ((double)q[1] - place[1]) -
                   ((double)q[0] - place[0]) * ((double)p[1] - place[1]);
            area += w[k];
        }
        *out = vec3_of(0, 0, 0);
        bool is = true;
        for (int k = 0; k < 3; k++) {
            is = is && w[k] / area > 1e-6;
            *out = vec3_along(*out, vec3_of(c[k].position[0], c[k].position[1], c[k].position[2]),
                              w[k] / area);
        }
        if (is)
            return true;
    }
    return false;
}

// With as many components as there are texels a texel shows what the objects show, from views of
// the map, under lights that are sampled: all is one matrix, and nothing of it is left out.
static void check_full_rank(const char *material, const struct relume_bake_params *params,
                            int views, double tolerance)
{
    static const int on_disc[] = {4, 1, 3, 5, 7};  // of a map of 3 x 3
    relume_objects *o = of("hanging.obj", material);
    relume_baked *b;
    int compared = 0, dark = 0;
    CHECK_OK(relume_bake(&b, o, params));
    CHECK_NEAR(b->info.error, 0.0, 2e-3);
    for (int l = 0; l < b->basis.directions; l += 7) {
        const struct relume_light lamp = from(b->basis.direction[l]);
        baked_lit *lit;
        CHECK_OK(lit_create(&lit, b, &frame_world, &lamp, 1, 0));
        for (size_t t = 0; t < (size_t)(b->info.width * b->info.height); t++) {
            struct baked_look at;
            float got[3], want[3], direct[3];
            vec3 place;
            if (!place_of(&place, at.place, b, t))
                continue;
            const vec3 v = view_direction(b->info.side, views > 1 ? on_disc[t % (size_t)views] : 0);
            const float *f = b->frame[t];
            const vec3 n = vec3_of(f[0], f[1], f[2]), x = vec3_of(f[3], f[4], f[5]);
            at.view = vec3_along(vec3_along(vec3_scale(n, v.z), x, v.x), vec3_cross(n, x), v.y);
            // from just above, before the square that hangs there
            look(want, o, vec3_along(place, at.view, 0.05), place, &lamp, 1);
            lit_colour(got, b, lit, &at);
            baked_lamp(direct, b, &at, vec3_unit(lamp.direction), lamp.rgb);
            for (int c = 0; c < 3; c++) {
                CHECK_NEAR(got[c], want[c], tolerance);
                CHECK_NEAR(direct[c], got[c], 1e-5);
            }
            compared++;
            dark += want[1] == 0.0f && lamp.direction.z > 0.2;
        }
        lit_destroy(&lit);
    }
    assert_true(compared > 200 && dark > 10);  // also in the shadow
    relume_baked_destroy(&b);
    relume_objects_destroy(&o);
}

static void full_rank_is_brute_force(void **state)
{
    (void)state;
    check_full_rank("{\"diffuse\": [0.9, 0.5, 0.2]}",
                    relume_bake_params(.basis = &relume_basis_table, .coefficients = 40,
                                       .width = 14, .clusters = 1, .components = 60, .bounces = -1),
                    1, 2e-3);
    if (SMALL)
        return;
    check_full_rank("{\"diffuse\": [0.9, 0.5, 0.2]}",
                    relume_bake_params(.cube = 4, .kept = 16, .width = 14, .clusters = 1,
                                       .components = 100, .bounces = -1),
                    1, 2e-3);
    check_full_rank("\"sample\"",
                    relume_bake_params(.basis = &relume_basis_table, .coefficients = 24,
                                       .width = 14, .side = 3, .clusters = 1, .components = 150,
                                       .bounces = -1),
                    5, 4e-3);
    check_full_rank("\"sample\"",
                    relume_bake_params(.basis = &relume_basis_table, .coefficients = 24,
                                       .width = 14, .side = 3, .clusters = 1, .components = 150,
                                       .bounces = -1, .per_view = true),
                    5, 4e-3);
}

// More numbers never fit worse; fewer wavelets never better.
static void more_is_closer(void **state)
{
    (void)state;
    relume_objects *o = of("hanging.obj", "\"sample\"");
    double before = 1.0;
    for (int n = 1; n <= (SMALL ? 4 : 16); n *= 4) {
        double error;
        relume_objects *b =
            baked_objects(o,
                          relume_bake_params(.width = 14, .clusters = 2, .components = n,
                                             .bounces = -1, .side = 3, .coefficients = 16),
                          &error);
        assert_true(error < before && error > 0.0);
        before = error;
        relume_objects_destroy(&b);
    }
    before = 1.0;
    for (int n = 2; n <= (SMALL ? 8 : 64); n *= 4) {
        double error;
        relume_objects *b = baked_objects(
            o,
            relume_bake_params(.width = 14, .clusters = 2, .components = 8, .bounces = -1,
                               .side = 1, .cube = SMALL ? 4 : 8, .kept = n),
            &error);
        assert_true(error <= before);
        before = error;
        relume_objects_destroy(&b);
    }
    relume_objects_destroy(&o);
}

// Under a sky of two suns and a dim rest, by wavelets: what the sum over all cells of the map
// shows, each a lamp with its shadow.
static void skies_are_their_cells(void **state)
{
    (void)state;
    struct relume_image map;
    relume_environment *e;
    CHECK_OK(relume_image_create(&map, 32, 16, 3));
    for (int i = 0; i < 3 * 32 * 16; i++)
        map.data[i] = 0.3f;
    for (int i = 0; i < 9; i++) {  // soft enough for texels of the cube
        map.data[3 * (32 * (2 + i / 3) + 7 + i % 3)] = 9.0f;
        map.data[3 * (32 * (8 + i / 3) + 20 + i % 3) + 1] = 6.0f;
    }
    CHECK_OK(relume_environment_create(&e, &map, NULL));
    int n;
    const struct relume_environment_cell *cell = relume_environment_cells(&n, e);
    struct relume_light *lamp = calloc((size_t)n, sizeof *lamp);
    for (int i = 0; i < n; i++) {
        lamp[i] = from(cell[i].direction);
        memcpy(lamp[i].rgb, cell[i].rgb, sizeof lamp[i].rgb);
    }
    const struct relume_light sky = sky_of(e);
    relume_objects *o = of("hanging.obj", "{\"diffuse\": 0.7}");
    relume_objects *b = baked_objects(
        o,
        relume_bake_params(.cube = SMALL ? 8 : 16, .kept = SMALL ? 64 : 256, .width = 28,
                           .clusters = 4, .components = 24, .bounces = -1),
        NULL);
    double error = 0.0, all = 0.0;
    for (int i = 0; i < 25; i++) {
        const vec3 at = vec3_of(-0.8 + 0.4 * (i % 5), -0.8 + 0.4 * (i / 5), 0);
        const vec3 eye = vec3_add(at, vec3_of(0, 0, 0.3));
        float got[3], want[3];
        look(got, b, eye, at, &sky, 1);
        look(want, o, eye, at, lamp, n);
        for (int c = 0; c < 3; c++) {
            error += pow((double)got[c] - (double)want[c], 2);
            all += pow((double)want[c], 2);
        }
    }
    CHECK_NEAR(sqrt(error / all), 0.0, SMALL ? 0.1 : 0.04);
    free(lamp);
    relume_image_destroy(&map);
    relume_environment_destroy(&e);
    relume_objects_destroy(&b);
    relume_objects_destroy(&o);
}

// A fixed light shows itself whatever shines: the lamp that it was baked under, from its side too.
static void fixed_light_stays(void **state)
{
    (void)state;
    relume_objects *o = of("sphere.obj", "\"sample\"");
    const struct relume_light lamp = from(vec3_of(0.2, 0.3, 1)), other = from(vec3_of(0, 0, -1));
    relume_objects *b =
        baked_objects(o,
                      relume_bake_params(.fixed = &lamp, .fixed_count = 1, .side = SMALL ? 6 : 10,
                                         .width = SMALL ? 32 : 56, .clusters = 64, .components = 8,
                                         .bounces = -1),
                      NULL);
    double error = 0.0, all = 0.0;
    for (int i = 0; i < 64; i++) {
        const vec3 eye = vec3_scale(
            vec3_unit(vec3_of(cos(2.4 * i), sin(2.4 * i), -0.5 + 1.5 * (i + 0.5) / 64)), 4.0);
        const vec3 at = vec3_of(0.3 * sin(i), 0.3 * cos(i), 0);
        float got[3], want[3], same[3];
        look(got, b, eye, at, &other, 1);
        look(same, b, eye, at, NULL, 0);
        look(want, o, eye, at, &lamp, 1);
        for (int c = 0; c < 3; c++) {
            assert_float_equal(got[c], same[c], 0);
            error += pow((double)got[c] - (double)want[c], 2);
            all += pow((double)want[c], 2);
        }
    }
    CHECK_NEAR(sqrt(error / all), 0.0,
               SMALL ? 0.3 : 0.15);  // a sample of 4 x 4 texels repeats over the sphere
    relume_objects_destroy(&b);
    relume_objects_destroy(&o);
}

// ---------------------------------------------------------------- in the world

// Turned, an object is lit from elsewhere; another one throws its shadow on it, a near lamp shines.
static void it_stands_in_the_world(void **state)
{
    (void)state;
    relume_objects *o = of("sphere.obj", "{\"diffuse\": 1}"), *two;
    relume_objects *b =
        baked_objects(o,
                      relume_bake_params(.width = 28, .clusters = 4, .components = 12,
                                         .bounces = -1, .lights = 128),
                      NULL);
    write_text("two.json",
               "{\"format\": \"relume-objects\", \"version\": 1, \"objects\": ["
               "{\"baked\": \"baked.exr\", \"pose\": {\"scale\": 2, \"rotate\": [1, 0, 0, 90]}},"
               "{\"mesh\": \"hanging.obj\", \"pose\": {\"translate\": [0, 0, 4], \"scale\": 4}, "
               "\"parts\": [{\"material\": {\"diffuse\": 1}}]}]}");
    CHECK_OK(relume_objects_open(&two, path_of("two.json"), NULL));
    const vec3 eye = vec3_of(1, -3.6, 3.2), at = vec3_of(0, -1.2, 1.6);
    const struct relume_light above = from(vec3_of(0, 0, 1)), side = from(vec3_of(0, -1, 0.5));
    const struct relume_light lamp = {.kind = RELUME_LIGHT_POINT,
                                      .position = vec3_of(0, -1000, 500),
                                      .nofall = true,
                                      .rgb = {1, 1, 1}};
    float rgb[3], one[3], near[3];
    look(rgb, two, eye, at, &above, 1);
    CHECK_NEAR(rgb[0], 0.0, 0.0);
    look(rgb, two, eye, at, &side, 1);
    // its axes are those of the world again where nothing turns it
    look(one, b, vec3_of(0.5, 1.6, 1.8), vec3_of(0, 0.8, 0.6), &side, 1);
    assert_true(rgb[0] > 0.3f);
    CHECK_NEAR(one[0], 0.0, 0.1);
    look(near, two, eye, at, &lamp, 1);
    CHECK_NEAR(near[0], rgb[0], 0.03);
    relume_objects_destroy(&two);
    relume_objects_destroy(&b);
    relume_objects_destroy(&o);
}

// ---------------------------------------------------------------- files, refusals

static void threads_agree(void **state)
{
    (void)state;
    relume_objects *o = of("hanging.obj", "\"sample\"");
    size_t bytes[2];
    char *file[2];
    for (int i = 0; i < 2; i++) {
        relume_baked *b;
        CHECK_OK(relume_bake(&b, o,
                             relume_bake_params(.threads = i ? 3 : 1, .width = 16, .side = 3,
                                                .coefficients = 9, .clusters = 6, .bounces = 1)));
        CHECK_OK(relume_baked_save(b, path_of("threads.exr"), NULL));
        relume_baked_destroy(&b);
        file[i] = test_read(path_of("threads.exr"), &bytes[i]);
    }
    assert_int_equal(bytes[0], bytes[1]);
    assert_memory_equal(file[0], file[1], bytes[0]);
    free(file[0]);
    free(file[1]);
    relume_objects_destroy(&o);
}

// What is cut off or changed is an input's fault, or still numbers; nothing else.
static void broken_files_are_told(void **state)
{
    (void)state;
    relume_objects *o = of("hanging.obj", "{\"diffuse\": 0.5}");
    relume_baked *b;
    size_t n;
    CHECK_OK(relume_bake(&b, o, relume_bake_params(.width = 16, .coefficients = 4, .bounces = -1)));
    CHECK_OK(relume_baked_save(b, path_of("whole.exr"), NULL));
    relume_baked_destroy(&b);
    char *file = test_read(path_of("whole.exr"), &n);
    for (size_t i = 0; i < n; i += SMALL ? 397 : 61) {
        struct test_log log;
        test_log_init(&log);
        test_write(path_of("cut.exr"), file, i);
        const relume_status cut = relume_baked_open(&b, path_of("cut.exr"), NULL, &log.log);
        assert_true(relume_status_is_input(cut) && log.lines > 0);
        char *changed = malloc(n);
        memcpy(changed, file, n);
        changed[i] = (char)(changed[i] ^ 0x41);
        test_write(path_of("changed.exr"), changed, n);
        const relume_status status = relume_baked_open(&b, path_of("changed.exr"), NULL, NULL);
        assert_true(!status || relume_status_is_input(status));
        relume_baked_destroy(&b);
        free(changed);
    }
    free(file);
    relume_objects_destroy(&o);
}

// Frames that are longer than 1 would be looked at beyond the map of views.
static void long_frames_are_refused(void **state)
{
    (void)state;
    struct test_log log;
    test_log_init(&log);
    relume_objects *o = of("hanging.obj", "\"sample\"");
    relume_baked *b;
    CHECK_OK(relume_bake(&b, o,
                         relume_bake_params(.width = 16, .coefficients = 4, .side = 3,
                                            .clusters = 2, .components = 1, .rays = 4)));
    CHECK_OK(relume_baked_save(b, path_of("frames.exr"), NULL));
    for (int i = 0; i < b->info.width * b->info.height; i++)
        for (int k = 0; k < 6; k++)
            b->frame[i][k] = 1.0f;
    CHECK_OK(relume_baked_save(b, path_of("long.exr"), NULL));
    relume_baked_destroy(&b);
    CHECK_OK(relume_baked_open(&b, path_of("frames.exr"), NULL, NULL));
    relume_baked_destroy(&b);
    const struct relume_limits little = {.max_memory = 7000};
    assert_int_equal(relume_baked_open(&b, path_of("frames.exr"), &little, &log.log),
                     RELUME_ELIMIT);
    assert_non_null(strstr(log.text, "the baked object takes"));
    assert_int_equal(relume_baked_open(&b, path_of("long.exr"), NULL, &log.log), RELUME_EFORMAT);
    assert_non_null(strstr(log.text, "frames"));
    relume_objects_destroy(&o);
}

static void what_cannot_be_is_refused(void **state)
{
    (void)state;
    struct test_log log;
    test_log_init(&log);
    relume_baked *b;
    relume_objects *o = of("hanging.obj", "{\"mirror\": 1}");
    assert_int_equal(relume_bake(&b, o, relume_bake_params(.log = &log.log)), RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "mirror"));
    relume_objects_destroy(&o);
    o = of("sphere.obj", "{\"diffuse\": 1}");
    assert_int_equal(relume_bake(&b, o, relume_bake_params(.log = &log.log, .width = 8)),
                     RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "too small"));
    assert_int_equal(relume_bake(&b, o, relume_bake_params(.log = &log.log, .cube = 5)),
                     RELUME_EINVAL);
    assert_int_equal(
        relume_bake(&b, o, relume_bake_params(.log = &log.log, .basis = &relume_basis_hsh)),
        RELUME_EINVAL);
    static const struct {
        struct relume_bake_params p;
        relume_status status;
        const char *said;
    } bad[] = {
        {{.components = 1000}, RELUME_EINVAL, "components: 1000; expected 1 to 256"},
        {{.rays = -1}, RELUME_EINVAL, "rays from each texel: -1"},
        {{.coefficients = 37}, RELUME_EINVAL, "sh cannot have 37 coefficients"},
        {{.coefficients = -4}, RELUME_EINVAL, "-4 coefficients"},
        {{.coefficients = 36, .lights = 20}, RELUME_EINVAL, "light from 20 directions"},
        {{.lights = 1 << 30}, RELUME_EINVAL, "light from 1073741824 directions"},
        // 32 x 32 views of 81 coefficients are a row of 82944
        {{.side = 32, .coefficients = 81, .clusters = 1, .components = 1, .width = 16},
         RELUME_ELIMIT,
         "part 'components' of its file would have 82944"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct relume_bake_params p = bad[i].p;
        p.struct_size = sizeof p;
        p.log = &log.log;
        assert_int_equal(relume_bake(&b, o, &p), bad[i].status);
        assert_null(b);
        assert_non_null(strstr(log.text, bad[i].said));
    }
    relume_objects_destroy(&o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sphere_is_lamberts),      cmocka_unit_test(a_bowl_adds_its_bounces),
        cmocka_unit_test(full_rank_is_brute_force),  cmocka_unit_test(more_is_closer),
        cmocka_unit_test(skies_are_their_cells),     cmocka_unit_test(fixed_light_stays),
        cmocka_unit_test(it_stands_in_the_world),    cmocka_unit_test(threads_agree),
        cmocka_unit_test(long_frames_are_refused),   cmocka_unit_test(broken_files_are_told),
        cmocka_unit_test(what_cannot_be_is_refused),
    };
    return cmocka_run_group_tests(tests, make_all, remove_folder);
}
