// Objects covered with measured materials: OpenGL against the ray traced reference, for every
// model under every kind of light, and shadows.
//
// Compares: between/scene_normal.glsl, btf/btf.glsl, btf/bump.frag.glsl, btf/cast.frag.glsl,
// btf/cmf.frag.glsl, btf/fields.glsl, btf/fmf.frag.glsl, btf/gbrdf.frag.glsl, btf/laf.frag.glsl,
// btf/lafortune.glsl, btf/lit.frag.glsl, btf/lpca.frag.glsl, btf/measured.frag.glsl,
// btf/painted.frag.glsl, btf/qmf.frag.glsl, btf/rfnl.frag.glsl, btf/rfnlc.frag.glsl,
// btf/rfp.frag.glsl, btf/share.frag.glsl, btf/skin.glsl, btf/sky.frag.glsl, btf/slaf.frag.glsl,
// btf/surface.frag.glsl, btf/upright.glsl, btf/vpca.frag.glsl, light_sample.glsl,
// shared/baked.glsl, sky.glsl with ambient.c, bilinear.h, btf.c, direction_mesh.c, fields.c,
// gbrdf.c, light_samples.c, lit.c, meso.c, model.c, model_bump.c, model_cmf.c, model_fmf.c,
// model_laf.c, model_lit.c, model_lpca.c, model_painted.c, model_qmf.c, model_rfnl.c,
// model_rfnlc.c, model_rfp.c, model_vpca.c, prefiltered_maps.c, render.c, scalar.h, scene.c,
// skin.c, sky.c, surface.c, vec.h.
#include "draw/objects_drawer.h"
#include "world/object/drawn_objects.h"
#include "fixture.h"
#include "test.h"

#include <relume/world/bake.h>

#include <unistd.h>

enum { SIDE = 48, TEXELS = 8, PARTS = 7 };
static char folder[64];
static const char *const models[] = {"lit", "bump", "laf",  "slaf", "rfp", "rfnl", "rfnlc",
                                     "cmf", "vpca", "lpca", "fmf",  "qmf", NULL};

static const char *path_of(const char *name)
{
    static char path[4][128];
    static int next;
    char *p = path[next++ % 4];
    snprintf(p, sizeof path[0], "%s/%s", folder, name);
    return p;
}

// A bowl over the unit square with a mirrored half, in four parts, and a ball above it that throws
// a shadow, in three.
static void write_mesh(const char *path)
{
    enum { N = 12 };
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    int count = 0;
    for (int ball = 0; ball < 2; ball++) {
        for (int j = 0; j <= N; j++)
            for (int i = 0; i <= N; i++) {
                const double u = (double)i / N, v = (double)j / N;
                const double phi = 2 * 3.14159265358979 * u, theta = 3.14159265358979 * v;
                const double x = 2 * u - 1, y = 2 * v - 1;
                const double n[3] = {-sin(theta) * sin(phi), -cos(theta), -sin(theta) * cos(phi)};
                if (ball)
                    fprintf(file, "v %.9f %.9f %.9f\nvt %.9f %.9f\nvn %.9f %.9f %.9f\n",
                            0.2 + 0.25 * n[0], 0.1 + 0.25 * n[1], 0.6 + 0.25 * n[2], u, v, n[0],
                            n[1], n[2]);
                else
                    fprintf(file, "v %.9f %.9f %.9f\nvt %.9f %.9f\nvn %.9f %.9f 1\n", x, y,
                            0.2 * (x * x + y * y), fabs(x), v, -0.4 * x, -0.4 * y);
                count++;
            }
        for (int j = 0; j < N; j++) {
            if (j % (ball ? 4 : 3) == 0)
                fprintf(file, "usemtl %s%d\n", ball ? "ball" : "bowl", j);
            for (int i = 0; i < N; i++) {
                const int a = count - (N + 1) * (N + 1) + j * (N + 1) + i + 1, b = a + N + 1;
                fprintf(file, "f %d/%d/%d %d/%d/%d %d/%d/%d\nf %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a,
                        a, a + 1, a + 1, a + 1, b + 1, b + 1, b + 1, a, a, a, b + 1, b + 1, b + 1,
                        b, b, b);
            }
        }
    }
    fclose(file);
}

// A surface of two tiles of the sample, in a matrix of 3 x 2.
static void make_surface(const relume_btf_fitted *model, const char *name)
{
    enum { TILE = 5 };
    static const uint16_t matrix[6] = {0, 1, 1, 1, 0, 0};
    uint32_t texel[2 * TILE * TILE];
    for (int i = 0; i < 2 * TILE * TILE; i++)
        texel[i] = (uint32_t)(i * 11 % (TEXELS * TEXELS));
    const struct relume_btf_map_info info = {
        .sample_width = TEXELS,
        .sample_height = TEXELS,
        .tiles = 2,
        .width = TILE,
        .height = TILE,
        .texel = texel,
        .columns = 3,
        .rows = 2,
        .matrix = matrix,
    };
    relume_btf_map *map;
    relume_btf_surface *surface;
    assert_int_equal(relume_btf_map_create(&map, &info, &fixture_log), RELUME_OK);
    assert_int_equal(relume_btf_surface_create(&surface, model, map, &fixture_log), RELUME_OK);
    assert_int_equal(relume_btf_surface_save(surface, path_of(name), NULL), RELUME_OK);
    relume_btf_surface_destroy(&surface);
    relume_btf_map_destroy(&map);
}

// Of the model of the tiled surface, and of another.
static bool with_levels(const char *model)
{
    return !strcmp(model, "vpca") || !strcmp(model, "rfnlc");
}

// Every model of one small sample, and the sample.
static void make_materials(void)
{
    const struct relume_btf_set *set = relume_btf_set_find("coarse");
    struct relume_vec3 d[64];
    relume_btf *btf;
    relume_btf_set_directions(set, d);
    assert_int_equal(
        relume_btf_synth(&btf, relume_btf_material_find("weave"),
                         relume_btf_synth_params(.log = &fixture_log, .size = TEXELS, .view = d,
                                                 .views = set->count, .light = d,
                                                 .lights = set->count, .samples = 1)),
        RELUME_OK);
    assert_int_equal(relume_btf_save(btf, path_of("measured"), NULL), RELUME_OK);
    for (const char *const *m = models; *m; m++) {
        relume_btf_fitted *fitted;  // of few clusters, so that texels share them
        assert_int_equal(relume_btf_fit(&fitted, btf, relume_btf_model_find(*m),
                                        relume_btf_fit_params(.log = &fixture_log, .components = 6,
                                                              .clusters = 12,
                                                              .levels = with_levels(*m) ? -1 : 1)),
                         RELUME_OK);
        assert_int_equal(relume_btf_fitted_save(fitted, path_of(*m), NULL), RELUME_OK);
        if (!strcmp(*m, "vpca"))
            make_surface(fitted, "surface");
        relume_btf_fitted_destroy(&fitted);
    }
    relume_btf_destroy(&btf);
}

// A g-BRDF with a relief to follow rays into, as a file, and on a tiled surface, where its texels
// have other neighbours.
static void make_gbrdf(void)
{
    relume_btf_fitted *planted;
    assert_int_equal(
        relume_gbrdf_plant(&planted,
                           relume_gbrdf_plant_params(.log = &fixture_log, .size = TEXELS,
                                                     .directions = relume_btf_set_find("coarse"))),
        RELUME_OK);
    assert_int_equal(relume_btf_fitted_save(planted, path_of("gbrdf.exr"), NULL), RELUME_OK);
    make_surface(planted, "surface-gbrdf");
    relume_btf_fitted_destroy(&planted);
}

static relume_objects *open_objects(double repeat)
{
    enum { MOST = 16 };
    char kept[MOST][128];
    const char *materials[MOST];
    int n = 0;
    snprintf(kept[n++], sizeof kept[0], "%s", path_of("measured"));
    for (const char *const *m = models; *m; m++)
        snprintf(kept[n++], sizeof kept[0], "%s", path_of(*m));
    snprintf(kept[n++], sizeof kept[0], "%s", path_of("surface"));
    snprintf(kept[n++], sizeof kept[0], "%s", path_of("gbrdf.exr"));
    snprintf(kept[n++], sizeof kept[0], "%s", path_of("surface-gbrdf"));
    for (int i = 0; i < n; i++)
        materials[i] = kept[i];
    relume_objects *o;
    assert_int_equal(relume_objects_of_mesh(&o, path_of("mesh.obj"), materials, n, repeat,
                                            relume_objects_params(.log = &fixture_log)),
                     RELUME_OK);
    assert_int_equal(relume_objects_info(o)->materials, n);
    assert_int_equal(relume_objects_info(o)->parts, PARTS);
    return o;
}

static struct relume_window window_of(const relume_objects *o)
{
    struct relume_window w;
    assert_true(
        relume_objects_window(&w, o, (struct relume_vec3){0.9, -1.6, 3.2}, NULL, SIDE, SIDE));
    return w;
}

static struct relume_image draw(struct objects_drawer *t, const struct relume_window *w,
                                const struct relume_light *lights, int n)
{
    const struct gl *gl = &fixture_gl;
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    struct frame_projection projection;
    struct target frame;
    struct relume_image image;
    GLuint array;
    gl->GenVertexArrays(1, &array);
    gl->BindVertexArray(array);
    const struct frame_area area = {SIDE, SIDE, {0, 0, SIDE, SIDE}, 1};
    assert_true(
        frame_projection_of_window(&projection, w, area.picture, SIDE, SIDE, info->min, info->max));
    assert_int_equal(objects_drawer_light(t, lights, n), RELUME_OK);
    assert_int_equal(objects_drawer_shade(t, &projection, SIDE, SIDE, -1), RELUME_OK);
    assert_int_equal(target_create(&frame, gl, SIDE, SIDE, &fixture_log), RELUME_OK);
    target_begin(&frame, gl);
    objects_drawer_over(t, &area, 0, false);
    assert_int_equal(target_read(&image, &frame, gl), RELUME_OK);
    target_destroy(&frame, gl);
    gl->DeleteVertexArrays(1, &array);
    return image;
}

// Pixels that differ by more than `tolerance` of what they show (or of white, where that is less),
// and the brightest pixel of the reference.
static int count_apart(const struct relume_image *a, const struct relume_image *b, double tolerance,
                       double *brightest)
{
    int count = 0;
    *brightest = 0;
    for (int i = 0; i < a->width * a->height; i++) {
        bool apart = false;
        for (int c = 0; c < 3; c++) {
            const double x = (double)a->data[3 * i + c], y = (double)b->data[3 * i + c];
            apart |= !(fabs(x - y) <= tolerance * fmax(1.0, fabs(x)));
            *brightest = fmax(*brightest, x);
        }
        count += apart;
    }
    return count;
}

struct picture {
    struct relume_image cpu, gl;
};

static struct picture both(struct objects_drawer *t, const struct relume_light *lights, int n,
                           bool no_shadows)
{
    struct picture p = {0};
    const struct relume_window w = window_of(t->objects);
    t->shadows.off = no_shadows;
    assert_int_equal(relume_image_create(&p.cpu, SIDE, SIDE, 3), RELUME_OK);
    assert_int_equal(relume_objects_render(&p.cpu, t->objects, &w, lights, n,
                                           relume_render_params(.no_shadows = no_shadows)),
                     RELUME_OK);
    p.gl = draw(t, &w, lights, n);
    return p;
}

static void destroy(struct picture *p)
{
    relume_image_destroy(&p->cpu);
    relume_image_destroy(&p->gl);
}

static void choose(relume_objects *o, int material)
{
    for (int i = 0; i < relume_objects_info(o)->parts; i++)
        assert_int_equal(relume_objects_choose(o, i, material), RELUME_OK);
}

static void start(struct objects_drawer *t, double repeat)
{
    assert_int_equal(objects_drawer_create(t, &fixture_gl, open_objects(repeat), &fixture_log),
                     RELUME_OK);
}

static void finish(struct objects_drawer *t)
{
    relume_objects *o = t->objects;
    objects_drawer_destroy(t);
    relume_objects_destroy(&o);
}

static const char *const sunlight = "dir -0.4 0.5 0.8 rgb 1 0.9 0.8";

static relume_rig *rig_of(const char *const *specs)
{
    relume_rig *rig;
    assert_int_equal(relume_rig_create(&rig), RELUME_OK);
    for (; *specs; specs++)
        assert_int_equal(relume_rig_add(rig, *specs, folder, &fixture_log), RELUME_OK);
    return rig;
}

static void compare_about(struct objects_drawer *t, relume_rig *rig, const char *what,
                          double tolerance)
{
    const struct relume_light *lights;
    double brightest;
    int n;
    assert_int_equal(relume_rig_lights(&lights, &n, rig), RELUME_OK);
    struct picture p = both(t, lights, n, true);
    // pixels of the outline may fall to either side, a few of the 200 that it crosses
    const int apart = count_apart(&p.cpu, &p.gl, tolerance, &brightest);
    if (apart > 16 || !(brightest > 0.02))
        fail_msg("%s: %d of %d pixels differ, the brightest is %g", what, apart, SIDE * SIDE,
                 brightest);
    destroy(&p);
}

// floats against doubles: 1e-3
static void compare(struct objects_drawer *t, relume_rig *rig, const char *what)
{
    compare_about(t, rig, what, 1e-3);
}

static int material_of(const relume_objects *o, const char *model)
{
    const struct relume_objects_info *info = relume_objects_info(o);
    for (int i = 0; i < info->materials; i++)
        if (!strcmp(info->material[i].model, model))
            return i;
    fail_msg("no %s", model);
    return -1;
}

static void models_agree(void **state)
{
    (void)state;
    struct objects_drawer t;
    start(&t, 0.7);  // texels are wider than pixels
    relume_rig *rig = rig_of((const char *const[]){sunlight, NULL});
    for (int i = 0; i < relume_objects_info(t.objects)->materials; i++) {
        choose(t.objects, i);
        compare(&t, rig, relume_objects_info(t.objects)->material[i].model);
    }
    relume_rig_destroy(&rig);
    finish(&t);
}

// The models that have code of their own for environments, and two that are summed over the
// lights; one on each part.
static void models_agree_under_the_sky(void **state)
{
    (void)state;
    static const char *const list[PARTS] = {"lit", "laf", "slaf", "lpca", "rfnl", "rfnlc", "bump"};
    struct objects_drawer t;
    start(&t, 0.7);
    relume_rig *rig = rig_of((const char *const[]){"env sky.exr 30 rgb 1 0.8 1.1", NULL});
    for (int i = 0; i < PARTS; i++)
        assert_int_equal(relume_objects_choose(t.objects, i, material_of(t.objects, list[i])),
                         RELUME_OK);
    compare(&t, rig, "all at once");
    choose(t.objects, material_of(t.objects, "gbrdf"));
    compare(&t, rig, "gbrdf");
    relume_rig_destroy(&rig);
    finish(&t);
}

// Sums over lights and many components, which llvmpipe cut off after 65535 rounds.
static void long_sums_agree(void **state)
{
    (void)state;
    static const char *const list[] = {"fmf", "qmf"};
    relume_btf *btf;
    if (TEST_SANITIZED)  // the same code as with few components
        return;
    assert_int_equal(relume_btf_open(&btf, path_of("measured"), NULL), RELUME_OK);
    for (int i = 0; i < 2; i++) {
        relume_btf_fitted *fitted;
        assert_int_equal(relume_btf_fit(&fitted, btf, relume_btf_model_find(list[i]),
                                        relume_btf_fit_params(.components = 64, .ratio = 2)),
                         RELUME_OK);
        assert_int_equal(
            relume_btf_fitted_save(fitted, path_of("long"), relume_btf_params(.force = true)),
            RELUME_OK);
        relume_btf_fitted_destroy(&fitted);
        const char *const materials[] = {path_of("long")};
        struct objects_drawer t;
        relume_objects *o;
        assert_int_equal(relume_objects_of_mesh(&o, path_of("mesh.obj"), materials, 1, 2.0,
                                                relume_objects_params(.log = &fixture_log)),
                         RELUME_OK);
        assert_int_equal(objects_drawer_create(&t, &fixture_gl, o, &fixture_log), RELUME_OK);
        for (int k = 0; k < 2; k++) {
            relume_rig *rig = rig_of((const char *const[]){k ? "env sky.exr 30" : sunlight, NULL});
            compare_about(&t, rig, list[i], 5e-3);
            relume_rig_destroy(&rig);
        }
        finish(&t);
    }
    relume_btf_destroy(&btf);
}

// Many texels in a pixel: levels of detail, and means along the longer way. How wide a pixel is, GL
// knows from its neighbours and the library from rays: levels differ a little, and what is looked
// up along a line of n texels jumps with n.
static void levels_agree(void **state)
{
    (void)state;
    struct objects_drawer t;
    start(&t, 25.0);
    relume_rig *rig = rig_of((const char *const[]){sunlight, NULL});
    const struct relume_light *lights;
    const struct relume_objects_info *info = relume_objects_info(t.objects);
    int n, tried = 0;
    assert_int_equal(relume_rig_lights(&lights, &n, rig), RELUME_OK);
    for (int i = 0; i < info->materials; i++) {
        const int levels = relume_btf_surface_info(info->material[i].surface)->levels;
        double brightest;
        if (levels == 1)
            continue;
        assert_int_equal(levels, info->material[i].mapped ? 3 : 4);
        choose(t.objects, i);
        tried++;
        struct picture p = both(&t, lights, n, true);
        const int apart = count_apart(&p.cpu, &p.gl, 5e-3, &brightest);
        if (apart > 16 || !(brightest > 0.02))
            fail_msg("%s: %d pixels differ", info->material[i].model, apart);
        destroy(&p);
    }
    assert_int_equal(tried, 3);
    relume_rig_destroy(&rig);
    finish(&t);
}

static void lights_agree(void **state)
{
    (void)state;
    struct objects_drawer t;
    start(&t, 0.7);
    const char *const specs[] = {"point 0.3 0.9 1.4",
                                 "spot -0.5 -0.6 2 0.2 0.2 -1 24 nofall",
                                 "slide 0.1 0.2 2 0 0 -1 40 slide.exr",
                                 "area -0.3 0.4 1.5 0.3 0 0 0 -0.3 0",
                                 "area -0.3 0.4 1.5 0.3 0 0 0 -0.3 0 disc",
                                 "ies 0 0 2 0.1 0 -1 lamp.ies",
                                 "gonio 0.1 -0.3 2 0.2 0 -1 slide.exr",
                                 NULL};
    // what differs between lights is shared by all models
    choose(t.objects, 6);
    for (int i = 0; specs[i]; i++) {
        relume_rig *rig = rig_of((const char *const[]){specs[i], NULL});
        compare(&t, rig, specs[i]);
        relume_rig_destroy(&rig);
    }
    relume_rig *all = rig_of((const char *const[]){sunlight, specs[0], specs[1], specs[3], NULL});
    compare(&t, all, "all at once");
    relume_rig_destroy(&all);
    finish(&t);
}

// Shadows of rays and of maps differ along their edges only: within two texels of the map, and a
// pixel is some thirty texels wide. What few lamps reach is dark in both.
static void shadows_agree(void **state)
{
    (void)state;
    struct objects_drawer t;
    start(&t, 0.7);
    const char *const specs[] = {sunlight, "point 0.3 0.9 3.4", "point -0.6 -0.5 0.9",
                                 "env sky.exr 30", NULL};
    choose(t.objects, 6);
    for (int i = 0; specs[i]; i++) {
        const struct relume_light *lights;
        double brightest;
        int n, dark = 0;
        relume_rig *rig = rig_of((const char *const[]){specs[i], NULL});
        assert_int_equal(relume_rig_lights(&lights, &n, rig), RELUME_OK);
        struct picture open = both(&t, lights, n, true), shut = both(&t, lights, n, false);
        for (int k = 0; k < SIDE * SIDE; k++)
            dark += shut.cpu.data[3 * k + 1] < 0.85f * open.cpu.data[3 * k + 1] &&
                    open.cpu.data[3 * k + 1] > 0.01f;
        const int apart = count_apart(&shut.cpu, &shut.gl, 0.02, &brightest);
        if (apart > 12 || dark < 25)
            fail_msg("%s: %d pixels differ, %d are in shadow", specs[i], apart, dark);
        destroy(&open);
        destroy(&shut);
        relume_rig_destroy(&rig);
    }
    finish(&t);
}

static void write_description(const char *name, const char *object)
{
    FILE *file = fopen(path_of(name), "w");
    assert_non_null(file);
    fprintf(file, "{\"format\": \"relume-objects\", \"version\": 1, \"objects\": [{%s}]}", object);
    fclose(file);
}

// ---------------------------------------------------------------- in the look of their own file

// A square of side 2 on z = 0, of a material.
static void write_square(const char *name, const char *material)
{
    FILE *file = fopen(path_of(name), "w");
    assert_non_null(file);
    fprintf(file,
            "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
            "\"nodes\":[{\"mesh\":0}],\"materials\":[{\"name\":\"own\",%s}],\"meshes\":"
            "[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"indices\":2,"
            "\"material\":0}]}],\"textures\":[{\"source\":0}],\"images\":[{\"uri\":"
            "\"alpha.png\"}],\"buffers\":[{\"byteLength\":92,\"uri\":"
            "\"data:application/octet-stream;base64,"
            "AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAACAPwAAgD8AAAAAAACAvwAAgD8AAAAAAAAAAAAA"
            "gD8AAIA/AACAPwAAgD8AAAAAAAAAAAAAAAAAAAEAAgAAAAIAAwA=\"}],\"bufferViews\":["
            "{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,"
            "\"byteLength\":32},{\"buffer\":0,\"byteOffset\":80,\"byteLength\":12}],\"accessors\":["
            "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\","
            "\"min\":[-1,-1,0],\"max\":[1,1,0]},{\"bufferView\":1,\"componentType\":5126,"
            "\"count\":4,\"type\":\"VEC2\"},{\"bufferView\":2,\"componentType\":5123,\"count\":6,"
            "\"type\":\"SCALAR\"}]}",
            material);
    fclose(file);
}

static void write_pictures(void)
{
    static const float alpha[16] = {1, .8f, .6f, 0, 1, 1, .9f, 1, .7f, 1, 1, 1, 1, .5f, 1, 1};
    struct relume_image image;
    assert_int_equal(relume_image_create(&image, 2, 2, 4), RELUME_OK);
    memcpy(image.data, alpha, sizeof alpha);
    assert_int_equal(relume_image_save(&image, path_of("alpha.png"), NULL), RELUME_OK);
    relume_image_destroy(&image);
    assert_int_equal(relume_image_create(&image, 4, 4, 3), RELUME_OK);
    for (int i = 0; i < 16; i++) {
        image.data[3 * i] = relume_transfer_decode(
            (struct relume_transfer){.curve = RELUME_CURVE_SRGB}, 0.35f + 0.1f * (float)(i % 4));
        image.data[3 * i + 1] = relume_transfer_decode(
            (struct relume_transfer){.curve = RELUME_CURVE_SRGB}, 0.4f + 0.07f * (float)(i / 4));
        image.data[3 * i + 2] = 0.8f;
    }
    assert_int_equal(relume_image_save(&image, path_of("normals.png"), NULL), RELUME_OK);
    relume_image_destroy(&image);
}

static void write_own(void)
{
    char command[512];
    snprintf(command, sizeof command, "(echo mtllib own.mtl; cat %s) > %s", path_of("mesh.obj"),
             path_of("own.obj"));
    assert_int_equal(system(command), 0);
    FILE *file = fopen(path_of("own.mtl"), "w");
    assert_non_null(file);
    fputs("newmtl bowl0\nKd .8 .2 .1\nPr .3\nnorm normals.png\nnewmtl bowl3\nKd 1 .8 .3\nPr .5\n"
          "Pm 1\nnewmtl bowl6\nKd .5 .5 .5\nPr 1\nKe .4 .2 .1\nmap_Ke normals.png\nnewmtl bowl9\n"
          "Kd .2 .3 .9\nPr 1\nnorm normals.png\nnewmtl ball0\nKd .3 .3 .3\nPr .3\nnewmtl ball4\n"
          "Kd .9 .9 .9\nPr .4\nPm .5\nnewmtl ball8\nKd .5 .1 .1\nKe 1.5 0 0\n",
          file);
    fclose(file);
}

static void open_own(struct objects_drawer *t, const char *square)
{
    char text[512];
    relume_objects *o;
    snprintf(text, sizeof text,
             "\"mesh\": \"own.obj\"}, {\"mesh\": \"%s\", \"pose\": {\"scale\": 0.6, "
             "\"translate\": [-0.3, -0.3, 0.8]}",
             square);
    write_description("own.json", text);
    assert_int_equal(
        relume_objects_open(&o, path_of("own.json"), relume_objects_params(.log = &fixture_log)),
        RELUME_OK);
    assert_int_equal(objects_drawer_create(t, &fixture_gl, o, &fixture_log), RELUME_OK);
}

static double mean_of(const struct relume_image *image)
{
    double sum = 0;
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        sum += (double)image->data[i] / (3 * SIDE * SIDE);
    return sum;
}

// Normals, gloss, emission, and a square with a corner cut out or blended, by lamp and sky, with
// shadows. The border of what is cut is as long as the outline.
static void own_looks_agree(void **state)
{
    (void)state;
    const char *const lights[] = {sunlight, "env sky.exr 30"};
    write_pictures();
    write_own();
    write_square("cut.gltf", "\"alphaMode\":\"MASK\",\"alphaCutoff\":0.6,"
                             "\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":"
                             "0.5,\"baseColorTexture\":{\"index\":0}}");
    write_square("pane.gltf", "\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{"
                              "\"metallicFactor\":0,\"baseColorFactor\":[1,0.5,0.2,0.4]}");
    for (int k = 0; k < 3; k++) {
        const struct relume_light *list;
        double brightest;
        int n;
        struct objects_drawer t;
        open_own(&t, k < 2 ? "cut.gltf" : "pane.gltf");
        relume_rig *rig = rig_of((const char *const[]){lights[k % 2], NULL});
        assert_int_equal(relume_rig_lights(&list, &n, rig), RELUME_OK);
        struct picture p = both(&t, list, n, k % 2);
        const int apart = count_apart(&p.cpu, &p.gl, 4e-3, &brightest);
        if (k < 2 && apart > 48)
            fail_msg("cut, %s: %d of %d pixels differ", lights[k % 2], apart, SIDE * SIDE);
        // a pattern of pixels in place of layers: as much light on the whole
        const double cpu = mean_of(&p.cpu), gl = mean_of(&p.gl);
        if (fabs(cpu - gl) > 0.01 * cpu)
            fail_msg("%d, %s: a mean of %g, expected %g", k, lights[k % 2], gl, cpu);
        destroy(&p);
        relume_rig_destroy(&rig);
        finish(&t);
    }
}

// Levels of detail on their way to the next, without and with shadows of the same surface.
static void details_agree(void **state)
{
    (void)state;
    const char *const lights[] = {sunlight, NULL};
    const struct relume_light *list;
    struct objects_drawer t;
    int n;
    write_description("details.json",
                      "\"mesh\": \"mesh.obj\", \"levels\": 0.7, \"parts\": [{\"material\": "
                      "{\"diffuse\": 0.6}}]");
    relume_objects *o;
    assert_int_equal(relume_objects_open(&o, path_of("details.json"), NULL), RELUME_OK);
    assert_int_equal(objects_drawer_create(&t, &fixture_gl, o, &fixture_log), RELUME_OK);
    relume_rig *rig = rig_of(lights);
    assert_int_equal(relume_rig_lights(&list, &n, rig), RELUME_OK);
    const size_t all = relume_objects_info(t.objects)->triangle_count;
    for (int k = 0; k < 2; k++) {
        double brightest;
        struct picture p = both(&t, list, n, k == 0);
        const int apart = count_apart(&p.cpu, &p.gl, 5e-3, &brightest);
        if (apart > 48 || !(brightest > 0.02))
            fail_msg("details: %d pixels differ", apart);
        assert_non_null(t.mesh.seen);
        assert_in_range(relume_objects_info(t.mesh.seen)->triangle_count, 12, all / 2);
        destroy(&p);
    }
    relume_rig_destroy(&rig);
    finish(&t);
}

// Baked, turned, with views of their own and without, under a lamp and a sky.
static void baked_objects_agree(void **state)
{
    (void)state;
    write_description("matte.json",
                      "\"mesh\": \"mesh.obj\", \"parts\": [{\"material\": {\"diffuse\": 0.6}}]");
    write_description("baked.json", "\"baked\": \"baked.exr\", "
                                    "\"pose\": {\"rotate\": [0, 0, 1, 70], \"scale\": 0.9}");
    const struct {
        int side;
        bool per_view;
        const char *light;
    } way[] = {{1, false, "env sky.exr"}, {4, false, sunlight}, {3, true, sunlight}};
    for (size_t i = TEST_SANITIZED ? 2 : 0; i < sizeof way / sizeof *way; i++) {
        relume_objects *o;
        relume_baked *b;
        struct objects_drawer t;
        assert_int_equal(relume_objects_open(&o, path_of("matte.json"), NULL), RELUME_OK);
        assert_int_equal(
            relume_bake(&b, o,
                        relume_bake_params(.width = TEST_SANITIZED ? 16 : 24, .side = way[i].side,
                                           .coefficients = 9, .clusters = 5, .components = 3,
                                           .bounces = 1, .rays = 8, .per_view = way[i].per_view)),
            RELUME_OK);
        assert_int_equal(relume_baked_save(b, path_of("baked.exr"), NULL), RELUME_OK);
        relume_baked_destroy(&b);
        relume_objects_destroy(&o);
        assert_int_equal(relume_objects_open(&o, path_of("baked.json"), NULL), RELUME_OK);
        assert_int_equal(objects_drawer_create(&t, &fixture_gl, o, &fixture_log), RELUME_OK);
        relume_rig *rig = rig_of((const char *const[]){way[i].light, NULL});
        compare(&t, rig, "baked");
        relume_rig_destroy(&rig);
        finish(&t);
    }
}

static void write_lights(void)
{
    struct relume_image image;
    assert_int_equal(relume_image_create(&image, 16, 8, 3), RELUME_OK);
    for (int i = 0; i < 16 * 8 * 3; i++)
        image.data[i] = 0.2f + 0.7f * (float)((i * 7) % 11) / 11.0f;
    assert_int_equal(relume_image_save(&image, path_of("slide.exr"), NULL), RELUME_OK);
    assert_int_equal(relume_image_save(&image, path_of("sky.exr"), NULL), RELUME_OK);
    relume_image_destroy(&image);
    FILE *file = fopen(path_of("lamp.ies"), "w");
    assert_non_null(file);
    fputs("IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 4 2 1 2 0 0 0\n1 1 100\n0 20 50 90\n0 90\n"
          "1000 800 300 0\n1000 600 200 0\n",
          file);
    fclose(file);
}

static int open_all(void **state)
{
    snprintf(folder, sizeof folder, "/tmp/relume-objects-%ld", (long)getpid());
    char command[128];
    snprintf(command, sizeof command, "mkdir -p %s", folder);
    if (system(command))
        return -1;
    write_mesh(path_of("mesh.obj"));
    write_lights();
    make_materials();
    make_gbrdf();
    return fixture_open(state);
}

static int close_all(void **state)
{
    char command[128];
    snprintf(command, sizeof command, "rm -r %s", folder);
    return fixture_close(state) || system(command);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models_agree),
        cmocka_unit_test(long_sums_agree),
        cmocka_unit_test(models_agree_under_the_sky),
        cmocka_unit_test(levels_agree),
        cmocka_unit_test(lights_agree),
        cmocka_unit_test(shadows_agree),
        cmocka_unit_test(baked_objects_agree),
        cmocka_unit_test(own_looks_agree),
        cmocka_unit_test(details_agree),
    };
    return cmocka_run_group_tests(tests, open_all, close_all);
}
