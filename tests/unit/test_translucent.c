// Light below surfaces: the dipole against closed forms and the table of its paper, hierarchies
// against sums over all points, bodies of every size, open and flipped ones, and descriptions.
#include "core/base/memory.h"
#include "in_folder.h"
#include "relight/light/environment.h"
#include "world/stage/shapes.h"
#include "world/transport/glow.h"

// ---------------------------------------------------------------- the dipole

static struct dipole dipole_of(const char *preset, double mm)
{
    struct dipole d;
    assert_non_null(scattering_find(preset));
    dipole_make(&d, &scattering_find(preset)->scattering, mm);
    return d;
}

// Figure 5 of the paper prints two digits; its chickens are darker in blue than its own formula.
static void presets_show_what_their_table_says(void **state)
{
    (void)state;
    for (const struct scattering_preset *p = scattering_presets; p->name; p++) {
        const struct dipole d = dipole_of(p->name, 1.0);
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(dipole_disc(&d, c, INFINITY), p->white[c],
                       strncmp(p->name, "chicken", 7) ? 0.0125 : 0.035);
    }
    assert_null(scattering_find("jade"));
}

// The integral over rings, in steps of equal ratio; with no absorption it falls as 1/r.
static void discs_are_integrals(void **state)
{
    (void)state;
    enum { STEPS = 20000 };
    const struct dipole d = dipole_of("skin1", 3.0);
    for (int c = 0; c < 3; c++) {
        double sum = 0.0;
        const double least = 1e-5 * d.below[c], most = 400.0 * d.below[c];
        const double step = log(most / least) / STEPS;
        for (int i = 0; i < STEPS; i++) {
            const double r = least * exp((i + 0.5) * step);
            sum += dipole_exact(&d, c, r) * 2.0 * M_PI * r * r * step;
        }
        CHECK_NEAR(sum, dipole_disc(&d, c, most), 1e-5);
        assert_true(dipole_disc(&d, c, INFINITY) < 1.0);
    }
    const struct dipole white = dipole_of("spectralon", 1.0);
    CHECK_NEAR(dipole_disc(&white, 0, INFINITY), 1.0, 1e-6);
}

static void the_table_is_the_formula(void **state)
{
    (void)state;
    for (const struct scattering_preset *p = scattering_presets; p->name; p++) {
        const struct dipole d = dipole_of(p->name, 0.3);
        for (double r = 0.0; r < 1e5; r = 1.07 * r + 1e-3)
            for (int c = 0; c < 3; c++) {
                float rgb[3];
                dipole_at(rgb, &d, r);
                CHECK_NEAR(rgb[c], dipole_exact(&d, c, r), 2e-4 * dipole_exact(&d, c, 0.0));
            }
    }
}

static void boundaries_keep_to_fresnel(void **state)
{
    (void)state;
    const struct dipole d = dipole_of("marble", 1.0);
    CHECK_NEAR(dipole_passes(1.5, 1.0), 0.96, 1e-12);
    CHECK_NEAR(dipole_passes(1.5, 0.0), 0.0, 1e-12);
    CHECK_NEAR(dipole_passes(1.0, 0.3), 1.0, 1e-12);
    CHECK_NEAR(d.enters, 1.0 - 0.0918, 1e-3);  // Walsh 1926, for 1.5
}

// ---------------------------------------------------------------- hierarchies

struct lit {
    struct mesh mesh;
    struct spread spread;
    bool *thin;
    struct glow_tree tree;
    struct glow glow;
};

// Its mesh is there.
static void cover(struct lit *l, size_t points, const char *preset, double mm)
{
    uint32_t *all = malloc(l->mesh.triangle_count * sizeof *all);
    for (size_t i = 0; i < l->mesh.triangle_count; i++)
        all[i] = (uint32_t)i;
    CHECK_OK(spread_make(&l->spread, &l->mesh, all, l->mesh.triangle_count, points));
    free(all);
    l->thin = calloc(l->spread.count + 1, sizeof *l->thin);
    CHECK_OK(
        glow_tree_make(&l->tree, &l->spread, l->thin, &scattering_find(preset)->scattering, mm, 0));
    CHECK_OK(glow_make(&l->glow, &l->tree));
}

static void shine(struct lit *l, double (*light)(const struct spread_point *))
{
    for (size_t i = 0; i < l->spread.count; i++)
        for (int c = 0; c < 3; c++)
            l->glow.light[i][c] = (float)light(&l->spread.point[i]);
    glow_sum_up(&l->glow);
}

static void uncover(struct lit *l)
{
    glow_free(&l->glow);
    glow_tree_free(&l->tree);
    spread_free(&l->spread);
    free(l->thin);
    mesh_free(&l->mesh);
    *l = (struct lit){.thin = NULL};
}

static double even(const struct spread_point *p)
{
    (void)p;
    return 1.0;
}

static double from_above(const struct spread_point *p)
{
    return fmax((double)p->normal[1], 0.0);
}

static double on_the_back(const struct spread_point *p)
{
    return p->normal[2] < -0.5f ? 1.0 : 0.0;
}

static double area_of(const struct spread *s)
{
    double area = 0.0;
    for (size_t i = 0; i < s->count; i++)
        area += (double)s->point[i].area;
    return area;
}

static void points_share_the_area(void **state)
{
    (void)state;
    struct lit l = {.thin = NULL};
    shape_sphere(&l.mesh, vec3_of(1, 2, 3), 2.0, 64);
    cover(&l, 5000, "marble", 1.0);
    assert_true(l.spread.count > 3000 && l.spread.count < 8000);
    CHECK_NEAR(area_of(&l.spread), 16.0 * M_PI, 0.15);  // of 64 sides
    double middle = 0.0;
    for (size_t i = 0; i < l.spread.count; i++) {
        const float *p = l.spread.point[i].position, *n = l.spread.point[i].normal;
        CHECK_NEAR((p[0] - 1.0f) * n[0] + (p[1] - 2.0f) * n[1] + (p[2] - 3.0f) * n[2], 2.0, 0.02);
        middle += (double)(p[1] * l.spread.point[i].area);
    }
    CHECK_NEAR(middle / area_of(&l.spread), 2.0, 0.003);
    uncover(&l);
}

// A wide plane in even light shows all that R_d sums up to, whether points are a tenth of a mean
// free path apart or thirty of them.
static void planes_show_their_white(void **state)
{
    (void)state;
    static const double mm[] = {3.0, 30.0, 1000.0};
    for (size_t i = 0; i < sizeof mm / sizeof *mm; i++) {
        struct lit l = {.thin = NULL};
        shape_quad(&l.mesh, vec3_of(-10, -10, 0), vec3_of(20, 0, 0), vec3_of(0, 20, 0));
        cover(&l, 20000, "skin1", mm[i]);
        shine(&l, even);
        for (double x = -1.0; x < 1.0; x += 0.0931) {
            float rgb[3];
            (void)glow_leaves(rgb, &l.glow, vec3_of(x, 0.7 * x, 0), vec3_of(0, 0, 1), 0.02);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(rgb[c], dipole_disc(&l.tree.dipole, c, INFINITY), 0.008);
        }
        uncover(&l);
    }
}

// Of a ball the surface within a chord r is pi r^2, as of a plane: in even light it shows what a
// disc of its diameter as radius does.
static void balls_show_a_disc(void **state)
{
    (void)state;
    static const double mm[] = {0.3, 2.0, 20.0};
    for (size_t i = 0; i < sizeof mm / sizeof *mm; i++) {
        struct lit l = {.thin = NULL};
        shape_sphere(&l.mesh, vec3_of(0, 0, 0), 1.0, 96);
        cover(&l, 20000, "marble", mm[i]);
        shine(&l, even);
        for (double a = 0.0; a < 6.0; a += 0.5) {
            const vec3 n = vec3_of(cos(a) * 0.8, 0.6, sin(a) * 0.8);
            float rgb[3];
            (void)glow_leaves(rgb, &l.glow, n, n, 0.02);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(rgb[c], dipole_disc(&l.tree.dipole, c, 2.0), 0.01);
        }
        uncover(&l);
    }
}

// A slab lit on its back sends to the front what lies beyond a disc as wide as it is thick, of what
// is left to it so that both sides together send no more than a plane does.
static void slabs_let_light_through(void **state)
{
    (void)state;
    struct lit l = {.thin = NULL};
    const double thick = 1.0;
    shape_box(&l.mesh, vec3_of(-12, -12, -thick), vec3_of(12, 12, 0));
    cover(&l, 60000, "skin1", 2.0);
    shine(&l, on_the_back);
    float rgb[3];
    (void)glow_leaves(rgb, &l.glow, vec3_of(0.3, 0.2, 0), vec3_of(0, 0, 1), 0.02);
    for (int c = 0; c < 3; c++) {
        const double plane = dipole_disc(&l.tree.dipole, c, INFINITY);
        const double beyond = plane - dipole_disc(&l.tree.dipole, c, thick);
        const double want = beyond * plane / (plane + beyond);
        CHECK_NEAR(rgb[c], want, 0.03 * want + 1e-5);
    }
    assert_true(rgb[0] > 2.0f * rgb[1] && rgb[1] > 1.3f * rgb[2]);
    uncover(&l);
}

// As pieces get smaller, the sum is that over all points: to nothing at 0, and never less by the
// way.
static void pieces_add_up(void **state)
{
    (void)state;
    enum { PLACES = 200 };
    static const double errors[] = {0.8, 0.2, 0.05, 0.01};
    struct lit l = {.thin = NULL};
    double before = 1.0, pieces_before = 0.0;
    shape_head(&l.mesh, 24);
    cover(&l, 30000, "marble", 40.0);
    shine(&l, from_above);
    for (size_t e = 0; e < sizeof errors / sizeof *errors; e++) {
        double wrong = 0.0, all = 0.0, pieces = 0.0;
        for (size_t i = 0; i < PLACES; i++) {
            const struct spread_point *p = &l.spread.point[i * l.spread.count / PLACES];
            const vec3 at = vec3_of(p->position[0], p->position[1], p->position[2]);
            const vec3 normal = vec3_of(p->normal[0], p->normal[1], p->normal[2]);
            float want[3], got[3];
            (void)glow_leaves(want, &l.glow, at, normal, 0.0);
            pieces += glow_leaves(got, &l.glow, at, normal, errors[e]);
            for (int c = 0; c < 3; c++) {
                wrong += pow((double)(got[c] - want[c]), 2.0);
                all += pow((double)want[c], 2.0);
            }
        }
        printf("pieces of %.2f: off by %.5f, %.0f of %zu\n", errors[e], sqrt(wrong / all),
               pieces / PLACES, l.spread.count);
        assert_true(sqrt(wrong / all) < before && pieces > pieces_before);
        before = sqrt(wrong / all), pieces_before = pieces;
    }
    assert_true(before < 5e-4);
    uncover(&l);
}

// What leaves is never more than what enters.
static void energy_is_not_made(void **state)
{
    (void)state;
    static const double mm[] = {1e-3, 1.0, 30.0, 1e6};
    for (size_t i = 0; i < sizeof mm / sizeof *mm; i++) {
        struct lit l = {.thin = NULL};
        double in = 0.0, out[3] = {0.0, 0.0, 0.0};
        shape_head(&l.mesh, 16);
        cover(&l, 5000, "spectralon", mm[i]);
        shine(&l, from_above);
        for (size_t k = 0; k < l.spread.count; k++) {
            const struct spread_point *p = &l.spread.point[k];
            float rgb[3];
            (void)glow_leaves(rgb, &l.glow, vec3_of(p->position[0], p->position[1], p->position[2]),
                              vec3_of(p->normal[0], p->normal[1], p->normal[2]), 0.05);
            in += (double)(l.glow.light[k][0] * p->area);
            for (int c = 0; c < 3; c++) {
                assert_true(rgb[c] >= 0.0f && isfinite(rgb[c]));
                out[c] += (double)(rgb[c] * p->area);
            }
        }
        printf("%g mm: %.4f of the light leaves\n", mm[i], out[0] / in);
        for (int c = 0; c < 3; c++)
            assert_true(out[c] <= 1.005 * in);
        uncover(&l);
    }
}

// ---------------------------------------------------------------- objects

static void write_mesh(const char *name, const struct mesh *m, bool flipped)
{
    FILE *file = fopen(path_of(name), "w");
    const double side = flipped ? -1.0 : 1.0;
    for (size_t i = 0; i < m->vertex_count; i++) {
        const struct vertex *v = &m->vertices[i];
        fprintf(file, "v %.9g %.9g %.9g\nvn %.9g %.9g %.9g\n", v->position[0], v->position[1],
                v->position[2], side * v->normal[0], side * v->normal[1], side * v->normal[2]);
    }
    for (size_t i = 0; i < m->triangle_count; i++) {
        const uint32_t *v = m->triangles[i].vertex;
        const uint32_t b = v[flipped ? 2 : 1] + 1, c = v[flipped ? 1 : 2] + 1;
        fprintf(file, "f %u//%u %u//%u %u//%u\n", v[0] + 1, v[0] + 1, b, b, c, c);
    }
    fclose(file);
}

static void write_ball(const char *name, bool flipped)
{
    struct mesh m = {0};
    shape_sphere(&m, vec3_of(0, 0, 0), 1.0, 96);
    write_mesh(name, &m, flipped);
    mesh_free(&m);
}

static void describe(const char *mesh, const char *material)
{
    char text[1024];
    snprintf(text, sizeof text,
             "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"%s\","
             "\"parts\":[{\"material\":%s}]}]}",
             mesh, material);
    write_text("objects.json", text);
}

static void render(struct relume_image *out, const char *mesh, const char *material,
                   const struct relume_light *light, int size)
{
    relume_objects *o;
    struct relume_window window;
    describe(mesh, material);
    CHECK_OK(relume_objects_open(&o, path_of("objects.json"), NULL));
    CHECK_OK(relume_image_create(out, size, size, 3));
    assert_true(relume_objects_window(&window, o, vec3_of(0, 0, 4), NULL, size, size));
    CHECK_OK(relume_objects_render(out, o, &window, light, 1, NULL));
    relume_objects_destroy(&o);
}

static const float *middle(const struct relume_image *image)
{
    return image->data + 3 * (size_t)(image->width * (image->height / 2) + image->width / 2);
}

#define MARBLE(mm) "{\"translucent\":{\"preset\":\"marble\",\"scale_mm\":" mm "}}"

static void balls_under_a_white_sky(void **state)
{
    (void)state;
    struct relume_image white, got;
    relume_environment *sky;
    CHECK_OK(relume_image_create(&white, 64, 32, 3));
    for (int i = 0; i < 64 * 32 * 3; i++)
        white.data[i] = 1.0f;
    CHECK_OK(relume_environment_create(&sky, &white, NULL));
    const struct relume_light light = {
        .kind = RELUME_LIGHT_ENVIRONMENT, .rgb = {1, 1, 1}, .environment = sky};
    write_ball("ball.obj", false);
    render(&got, "ball.obj", MARBLE("20"), &light, 48);
    const struct dipole d = dipole_of("marble", 20.0);
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(middle(&got)[c], dipole_disc(&d, c, 2.0) * dipole_passes(1.5, 1.0), 0.02);
    relume_environment_destroy(&sky);
    relume_image_destroy(&white);
    relume_image_destroy(&got);
}

// Normals that point inwards change nothing.
static void flipped_meshes_are_turned(void **state)
{
    (void)state;
    const struct relume_light light = {.direction = {1, 1, 0.5}, .rgb = {1, 1, 1}};
    struct relume_image as_is, flipped;
    write_ball("ball.obj", false);
    write_ball("flipped.obj", true);
    render(&as_is, "ball.obj", MARBLE("20"), &light, 48);
    render(&flipped, "flipped.obj", MARBLE("20"), &light, 48);
    assert_true(middle(&as_is)[0] > 0.1f);
    for (int i = 0; i < 48 * 48 * 3; i++)
        CHECK_NEAR(flipped.data[i], as_is.data[i], 0.02);
    relume_image_destroy(&as_is);
    relume_image_destroy(&flipped);
}

// A sheet without thickness lit from behind shows that in front, as much as from before.
static void sheets_are_lit_from_both_sides(void **state)
{
    (void)state;
    struct mesh m = {0};
    struct relume_image front, back;
    const struct relume_light before = {.direction = {0, 0, 1}, .rgb = {1, 1, 1}};
    const struct relume_light behind = {.direction = {0, 0, -1}, .rgb = {1, 1, 1}};
    shape_quad(&m, vec3_of(-1, -1, 0), vec3_of(2, 0, 0), vec3_of(0, 2, 0));
    write_mesh("sheet.obj", &m, false);
    mesh_free(&m);
    render(&front, "sheet.obj", MARBLE("20"), &before, 32);
    render(&back, "sheet.obj", MARBLE("20"), &behind, 32);
    for (int i = 0; i < 32 * 32 * 3; i++)
        CHECK_NEAR(back.data[i], front.data[i], 1e-4);
    const struct dipole d = dipole_of("marble", 20.0);
    CHECK_NEAR(middle(&front)[2],
               dipole_disc(&d, 2, INFINITY) * pow(dipole_passes(1.5, 1.0), 2.0) / d.enters, 0.02);
    relume_image_destroy(&front);
    relume_image_destroy(&back);
}

// As matter becomes finer than what is seen, it is matte; where it is far larger, light is lost
// through it, and nothing is NaN.
static void sizes_from_tiny_to_huge(void **state)
{
    (void)state;
    const struct relume_light light = {.direction = {0, 0, 1}, .rgb = {1, 1, 1}};
    struct relume_image tiny, huge;
    write_ball("ball.obj", false);
    render(&tiny, "ball.obj", MARBLE("0.000001"), &light, 32);
    render(&huge, "ball.obj", MARBLE("1000000000"), &light, 32);
    for (int i = 0; i < 32 * 32 * 3; i++)
        assert_true(isfinite(tiny.data[i]) && isfinite(huge.data[i]) && tiny.data[i] < 0.01f);
    const struct dipole d = dipole_of("marble", 1.0);
    CHECK_NEAR(middle(&huge)[0],
               dipole_disc(&d, 0, INFINITY) * pow(dipole_passes(1.5, 1.0), 2.0) / d.enters, 0.02);
    relume_image_destroy(&tiny);
    relume_image_destroy(&huge);
}

static void threads_agree(void **state)
{
    (void)state;
    const struct relume_light light = {.direction = {1, 0.3, 0.2}, .rgb = {1, 1, 1}};
    struct relume_image image[2];
    relume_objects *o;
    struct relume_window window;
    write_ball("ball.obj", false);
    describe("ball.obj", MARBLE("10"));
    CHECK_OK(relume_objects_open(&o, path_of("objects.json"), NULL));
    assert_true(relume_objects_window(&window, o, vec3_of(0, 0, 4), NULL, 50, 40));
    for (int i = 0; i < 2; i++) {
        CHECK_OK(relume_image_create(&image[i], 50, 40, 3));
        CHECK_OK(relume_objects_render(&image[i], o, &window, &light, 1,
                                       relume_render_params(.samples = 2, .threads = 1 + 4 * i)));
    }
    assert_memory_equal(image[0].data, image[1].data, 50 * 40 * 3 * sizeof(float));
    for (int i = 0; i < 2; i++)
        relume_image_destroy(&image[i]);
    relume_objects_destroy(&o);
}

static void bad_materials_say_why(void **state)
{
    (void)state;
    static const struct {
        const char *material, *said;
    } bad[] = {
        {"\"jade\"", "expected one of apple, chicken1, chicken2, cream"},
        {"3", "expected the name of a material"},
        {"{}", "absorption: expected a number per mm"},
        {"{\"absorption\":-1,\"reduced_scattering\":1}", "absorption: expected from 0"},
        {"{\"absorption\":0,\"reduced_scattering\":0}", "reduced_scattering: expected above 0"},
        {"{\"absorption\":0,\"reduced_scattering\":[1,-2,1]}", "expected above 0"},
        {"{\"absorption\":0,\"reduced_scattering\":1,\"index\":0.9}", "index: expected 1 to 3"},
        {"{\"preset\":\"marble\",\"scale_mm\":0}", "scale_mm: expected how many mm"},
        {"{\"preset\":\"marble\",\"scale_mm\":\"big\"}", "scale_mm: expected how many mm"},
        {"{\"preset\":\"marble\",\"index\":1.2}", "not both"},
        {"{\"preset\":1}", "preset: expected a name"},
        {"{\"preset\":\"marble\",\"scale\":2}", "unknown member 'scale'"},
    };
    write_ball("ball.obj", false);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct test_log log;
        relume_objects *o;
        char material[256];
        test_log_init(&log);
        snprintf(material, sizeof material, "{\"translucent\":%s}", bad[i].material);
        describe("ball.obj", material);
        assert_int_equal(relume_objects_open(&o, path_of("objects.json"),
                                             relume_objects_params(.log = &log.log)),
                         RELUME_EFORMAT);
        assert_null(o);
        if (!strstr(log.text, bad[i].said))
            fail_msg("%s: said '%s', expected '%s'", bad[i].material, log.text, bad[i].said);
    }
}

// Wherever memory ends, nothing is left over (the sanitizer looks), and nothing is shown.
static void memory_may_end(void **state)
{
    (void)state;
    const struct relume_light light = {.direction = {1, 0.3, 0.2}, .rgb = {1, 1, 1}};
    struct relume_image image;
    relume_objects *o;
    struct relume_window window;
    struct mesh m = {0};
    bool pending = false;
    shape_box(&m, vec3_of(-1, -1, -1), vec3_of(1, 1, 1));
    write_mesh("box.obj", &m, false);
    mesh_free(&m);
    describe("box.obj", MARBLE("2"));
    CHECK_OK(relume_objects_open(&o, path_of("objects.json"), NULL));
    CHECK_OK(relume_image_create(&image, 8, 8, 3));
    assert_true(relume_objects_window(&window, o, vec3_of(0, 0, 4), NULL, 8, 8));
    int ended = 0;
    for (long n = 1; !pending; n++) {
        mem_fail_after(n);
        const relume_status status = relume_objects_render(&image, o, &window, &light, 1, NULL);
        pending = mem_fail_pending();
        mem_fail_after(0);
        ended += status == RELUME_ENOMEM;
        assert_true(status == RELUME_ENOMEM || status == RELUME_OK);  // some go on without
    }
    assert_true(ended > 10);
    relume_image_destroy(&image);
    relume_objects_destroy(&o);
}

static bool stop(void *user, const char *what, double done)
{
    (void)what;
    (void)done;
    return --*(int *)user > 0;
}

static void who_stops_is_heard(void **state)
{
    (void)state;
    const struct relume_light light = {.direction = {1, 0.3, 0.2}, .rgb = {1, 1, 1}};
    struct relume_image image;
    relume_objects *o;
    struct relume_window window;
    write_ball("ball.obj", false);
    describe("ball.obj", MARBLE("10"));
    CHECK_OK(relume_objects_open(&o, path_of("objects.json"), NULL));
    CHECK_OK(relume_image_create(&image, 32, 32, 3));
    assert_true(relume_objects_window(&window, o, vec3_of(0, 0, 4), NULL, 32, 32));
    for (int after = 1; after <= 8; after++) {
        int left = after;
        const struct relume_log log = {.progress = stop, .user = &left};
        assert_int_equal(
            relume_objects_render(&image, o, &window, &light, 1, relume_render_params(.log = &log)),
            RELUME_ECANCEL);
        assert_int_equal(left, 0);
    }
    relume_image_destroy(&image);
    relume_objects_destroy(&o);
}

// What is translucent is known by its numbers; elsewhere it is a matte surface as bright.
static void materials_are_kept_once(void **state)
{
    (void)state;
    relume_objects *o;
    write_ball("ball.obj", false);
    describe("ball.obj", "[{\"translucent\":\"skin\"},{\"translucent\":\"skin\"},"
                         "{\"translucent\":{\"preset\":\"skin\",\"scale_mm\":3}}]");
    CHECK_OK(relume_objects_open(&o, path_of("objects.json"), NULL));
    const struct relume_objects_info *info = relume_objects_info(o);
    assert_int_equal(info->materials, 2);
    assert_true(info->material[0].translucent && info->material[0].fitted);
    CHECK_NEAR(info->material[0].reflectance[0], 0.44 * dipole_of("skin", 1.0).enters, 0.01);
    relume_objects_destroy(&o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(presets_show_what_their_table_says),
        cmocka_unit_test(discs_are_integrals),
        cmocka_unit_test(the_table_is_the_formula),
        cmocka_unit_test(boundaries_keep_to_fresnel),
        cmocka_unit_test(points_share_the_area),
        cmocka_unit_test(planes_show_their_white),
        cmocka_unit_test(balls_show_a_disc),
        cmocka_unit_test(slabs_let_light_through),
        cmocka_unit_test(pieces_add_up),
        cmocka_unit_test(energy_is_not_made),
        cmocka_unit_test(balls_under_a_white_sky),
        cmocka_unit_test(flipped_meshes_are_turned),
        cmocka_unit_test(sheets_are_lit_from_both_sides),
        cmocka_unit_test(sizes_from_tiny_to_huge),
        cmocka_unit_test(threads_agree),
        cmocka_unit_test(bad_materials_say_why),
        cmocka_unit_test(memory_may_end),
        cmocka_unit_test(who_stops_is_heard),
        cmocka_unit_test(materials_are_kept_once),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
