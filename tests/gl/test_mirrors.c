// Mirrors on the GPU against the library: environments, edits with regions, strokes and a frozen
// eye; panoramas of each layout.
//
// Compares: follow.glsl, mirror.glsl, reflection.glsl with mirror.c, rotation.c, turn.c.
#include "fixture.h"

#include "common/vec.h"
#include "draw/objects_drawer.h"
#include "relight/light/environment.h"
#include "relight/view/view.h"
#include "world/object/object.h"

#include <unistd.h>

enum { SIDE = 96, RINGS = 24, AROUND = 2 * RINGS };
static char folder[64];

static const char *path_of(const char *name)
{
    static char path[4][128];
    static int next;
    char *p = path[next++ % 4];
    snprintf(p, sizeof path[0], "%s/%s", folder, name);
    return p;
}

// A ball of radius 1 that is not quite one, a square beside it, and their description.
static void write_ball(const char *parts)
{
    FILE *file = fopen(path_of("ball.obj"), "w");
    for (int i = 0; i < (RINGS + 1) * (AROUND + 1); i++) {
        const double t = M_PI * (i / (AROUND + 1)) / RINGS, p = M_PI * (i % (AROUND + 1)) / RINGS;
        const double x = sin(t) * sin(p), y = cos(t), z = sin(t) * cos(p);
        fprintf(file, "v %.8f %.8f %.8f\nvt %.5f %.5f\nvn %.8f %.8f %.8f\n", x, 0.8 * y, z,
                p / (2 * M_PI), 1 - t / M_PI, x, y, z);
    }
    for (int j = 0; j < RINGS; j++)
        for (int i = 0; i < AROUND; i++) {
            const int a = j * (AROUND + 1) + i + 1, b = a + AROUND + 1;
            fprintf(file, "f %d/%d/%d %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, b, b, b, b + 1, b + 1,
                    b + 1, a + 1, a + 1, a + 1);
        }
    fprintf(file, "v 0.95 0.2 0.9\nv 1.4 0.2 0.9\nv 1.4 0.7 0.9\nv 0.95 0.7 0.9\nvt 0 0\nvt 1 0\n"
                  "vt 1 1\nvt 0 1\nvn 0 0 1\nf -4/-4/-1 -3/-3/-1 -2/-2/-1 -1/-1/-1\n");
    fclose(file);
    file = fopen(path_of("objects.json"), "w");
    fprintf(
        file,
        "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"ball.obj\",%s}]}",
        parts);
    fclose(file);
}

#define MIRROR "\"parts\":[{\"material\":{\"mirror\":[0.9,0.6,0.1]}}]"
#define SEEN   "\"eye\":[0.4,0.5,4],"
// Apart, near each other, and both; a region that two share, a stroke.
static const char *const edits[] = {
    MIRROR,
    MIRROR ",\"reflections\":{\"constraints\":[{\"position\":[0,0,1]," SEEN
           "\"direction\":[1,1,0]}]}",
    MIRROR ",\"reflections\":{\"frozen\":[1,2,5],\"constraints\":["
           "{\"position\":[0,0,1]," SEEN "\"direction\":[1,1,0]},"
           "{\"position\":[0.02,0,1]," SEEN "\"direction\":[1,0.9,0.2]},"
           "{\"position\":[-0.5,0.3,0.75]," SEEN "\"target\":[-3,0,-1]}]}",
    MIRROR ",\"reflections\":{\"constraints\":["
           "{\"position\":[0,0,1]," SEEN "\"direction\":[1,1,0]},"
           "{\"position\":[0.3,0.2,0.9]," SEEN "\"direction\":[0,0,-1]},"
           "{\"position\":[-0.5,0.3,0.75]," SEEN "\"target\":[-3,0,-1]}],"
           "\"regions\":[{\"ball\":[0,0,1],\"radius\":0.3,\"border\":0.4},"
           "{\"stroke\":[[-0.6,0,0.7],[-0.5,0.3,0.75],[0,0.5,0.7]],\"radius\":0.2,"
           "\"border\":0.2}]}",
    // along the surface, which is up to half as far again on this side of the ball, and never
    // reaches the square
    MIRROR ",\"reflections\":{\"distance\":\"geodesic\",\"constraints\":["
           "{\"position\":[0,0,1]," SEEN "\"direction\":[1,1,0]},"
           "{\"position\":[0.3,0.2,0.9]," SEEN "\"direction\":[0,0,-1]},"
           "{\"position\":[-0.5,0.3,0.75]," SEEN "\"target\":[-3,0,-1]}],"
           "\"regions\":[{\"ball\":[0,0,1],\"radius\":0.3,\"border\":0.4},"
           "{\"geodesic\":[-0.4,0.3,0.8],\"radius\":0.5,\"border\":0.6},"
           "{\"stroke\":[[-0.6,0,0.7],[-0.5,0.3,0.75],[0,0.5,0.7]],\"radius\":0.2,"
           "\"border\":0.2}]}",
    MIRROR ",\"reflections\":{\"constraints\":["
           "{\"position\":[0,0,1]," SEEN "\"direction\":[1,1,0]},"
           "{\"position\":[0.3,0.2,0.9]," SEEN "\"direction\":[0,0,-1]}],"
           "\"regions\":[{\"geodesic\":[0,0,1],\"radius\":0.9,\"border\":0.3}]}",
    MIRROR ",\"reflections\":{\"distance\":\"geodesic\",\"constraints\":["
           "{\"position\":[0,0,1]," SEEN "\"direction\":[1,1,0]},"
           "{\"position\":[-0.5,0.3,0.75]," SEEN "\"target\":[-3,0,-1]}]}",
    NULL};

static relume_objects *open_objects(const char *parts)
{
    relume_objects *o;
    write_ball(parts);
    assert_int_equal(relume_objects_open(&o, path_of("objects.json"),
                                         relume_objects_params(.log = &fixture_log)),
                     RELUME_OK);
    return o;
}

// Smooth, and everywhere another colour.
static float code(struct relume_vec3 d, int c)
{
    return (float)(0.5 + 0.3 * (c == 0 ? d.x : c == 1 ? d.y : d.z) + 0.15 * d.x * d.y);
}

static struct relume_image draw(struct objects_drawer *t, const struct relume_window *w,
                                const struct relume_light *light)
{
    const struct gl *gl = &fixture_gl;
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    const struct frame_area area = {SIDE, SIDE, {0, 0, SIDE, SIDE}, 1};
    struct frame_projection projection;
    struct target frame;
    struct relume_image image;
    GLuint array;
    gl->GenVertexArrays(1, &array);
    gl->BindVertexArray(array);
    assert_true(
        frame_projection_of_window(&projection, w, area.picture, SIDE, SIDE, info->min, info->max));
    assert_int_equal(objects_drawer_light(t, light, 1), RELUME_OK);
    assert_int_equal(objects_drawer_shade(t, &projection, SIDE, SIDE, -1), RELUME_OK);
    assert_int_equal(target_create(&frame, gl, SIDE, SIDE, &fixture_log), RELUME_OK);
    target_begin(&frame, gl);
    objects_drawer_over(t, &area, 0, false);
    assert_int_equal(target_read(&image, &frame, gl), RELUME_OK);
    target_destroy(&frame, gl);
    gl->DeleteVertexArrays(1, &array);
    return image;
}

static int count_apart(const struct relume_image *a, const struct relume_image *b, double tolerance)
{
    int count = 0;
    for (int i = 0; i < a->width * a->height; i++) {
        bool apart = false;
        for (int c = 0; c < 3; c++)
            apart |= !(fabs((double)a->data[3 * i + c] - (double)b->data[3 * i + c]) <= tolerance);
        count += apart;
    }
    return count;
}

static void environments_are_reflected_as_by_the_library(void **state)
{
    (void)state;
    enum { WIDE = 64, HIGH = 32 };
    static const struct relume_geometry sphere = {.projection = RELUME_SPHERICAL};
    struct relume_image map;
    relume_environment *e;
    assert_int_equal(relume_image_create(&map, WIDE, HIGH, 3), RELUME_OK);
    for (int i = 0; i < WIDE * HIGH * 3; i++)
        map.data[i] =
            code(relume_panorama_ray(&sphere, WIDE, HIGH, i / 3 % WIDE + 0.5, i / 3 / WIDE + 0.5),
                 i % 3);
    assert_int_equal(relume_environment_create(&e, &map, NULL), RELUME_OK);
    const struct relume_light light = {.kind = RELUME_LIGHT_ENVIRONMENT,
                                       .environment = e,
                                       .rotate_deg = 40,
                                       .rgb = {1, 0.8f, 1.2f}};
    struct relume_image before = {0};
    for (int k = 0; edits[k]; k++) {
        struct relume_window w;
        struct objects_drawer t;
        struct relume_image cpu;
        relume_objects *o = open_objects(edits[k]);
        assert_true(
            relume_objects_window(&w, o, (struct relume_vec3){0.4, 0.5, 4}, NULL, SIDE, SIDE));
        assert_int_equal(relume_image_create(&cpu, SIDE, SIDE, 3), RELUME_OK);
        assert_int_equal(relume_objects_render(&cpu, o, &w, &light, 1, NULL), RELUME_OK);
        assert_int_equal(objects_drawer_create(&t, &fixture_gl, o, &fixture_log), RELUME_OK);
        struct relume_image gl = draw(&t, &w, &light);
        // pixels of the outline, which is 270 long; single precision elsewhere
        const int apart = count_apart(&cpu, &gl, 4e-3);
        if (apart > 30)
            fail_msg("edit %d: %d pixels differ", k, apart);
        if (k)
            assert_true(count_apart(&cpu, &before, 0.1) > 100);
        relume_image_destroy(&before);
        before = cpu;
        relume_image_destroy(&gl);
        objects_drawer_destroy(&t);
        relume_objects_destroy(&o);
    }
    relume_image_destroy(&before);
    relume_image_destroy(&map);
    relume_environment_destroy(&e);
}

// An environment that stands where one of another map was is not taken for it.
static void another_environment_in_its_place_is_shown(void **state)
{
    (void)state;
    relume_objects *o = open_objects(MIRROR);
    struct relume_image map, shown[2];
    struct objects_drawer t;
    struct relume_window w;
    assert_int_equal(relume_image_create(&map, 8, 4, 3), RELUME_OK);
    assert_true(relume_objects_window(&w, o, (struct relume_vec3){0.4, 0.5, 4}, NULL, SIDE, SIDE));
    assert_int_equal(objects_drawer_create(&t, &fixture_gl, o, &fixture_log), RELUME_OK);
    for (int k = 0; k < 2; k++) {
        relume_environment *e;
        for (int i = 0; i < 8 * 4 * 3; i++)
            map.data[i] = k ? 0.25f : 1.0f;
        assert_int_equal(relume_environment_create(&e, &map, NULL), RELUME_OK);
        const struct relume_light light = {
            .kind = RELUME_LIGHT_ENVIRONMENT, .environment = e, .rgb = {1, 1, 1}};
        shown[k] = draw(&t, &w, &light);
        relume_environment_destroy(&e);
    }
    for (int i = 0; i < SIDE * SIDE * 3; i++)
        assert_true(fabsf(0.25f * shown[0].data[i] - shown[1].data[i]) < 1e-5f);
    assert_true(shown[0].data[3 * (SIDE * SIDE / 2 + SIDE / 3)] > 0.5f);
    relume_image_destroy(&shown[0]);
    relume_image_destroy(&shown[1]);
    relume_image_destroy(&map);
    objects_drawer_destroy(&t);
    relume_objects_destroy(&o);
}

// ---------------------------------------------------------------- panoramas

// Walls at other distances in each direction, of the colour of the direction.
static void make_room(struct relume_image *view, struct relume_image *places,
                      const struct relume_geometry *g, int width, int height)
{
    assert_int_equal(relume_image_create(view, width, height, 3), RELUME_OK);
    assert_int_equal(relume_image_create(places, width, height, 3), RELUME_OK);
    for (int i = 0; i < width * height; i++) {
        const struct relume_vec3 d =
            relume_panorama_ray(g, width, height, i % width + 0.5, i / width + 0.5);
        const double depth = 6.0 + d.x + 2.0 * d.y * d.z;
        const double at[3] = {g->center.x + depth * d.x, g->center.y + depth * d.y,
                              g->center.z + depth * d.z};
        for (int c = 0; c < 3; c++) {
            view->data[3 * i + c] = code(d, c);
            places->data[3 * i + c] = (float)at[c];
        }
    }
}

static struct relume_image by_library(const relume_objects *o, const struct relume_window *w,
                                      const struct relume_geometry *g,
                                      const struct relume_image *view,
                                      const struct relume_image *places)
{
    const struct surround surround = {.geometry = g, .panorama = *view, .places = *places};
    const float reflectance[3] = {0.9f, 0.6f, 0.1f};
    struct relume_image out;
    assert_int_equal(relume_image_create(&out, SIDE, SIDE, 3), RELUME_OK);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const struct relume_vec3 at =
            vec3_along(vec3_along(w->corner, w->right, (i % SIDE + 0.5) / SIDE), w->down,
                       (i / SIDE + 0.5) / SIDE);
        const struct relume_vec3 ray = vec3_unit(vec3_sub(at, w->eye));
        struct relume_object_reflection seen;
        float *rgb = out.data + 3 * i;
        rgb[0] = rgb[1] = rgb[2] = 0.0f;
        if (!relume_objects_reflect(&seen, o, w->eye, ray))
            continue;
        surround_value(rgb, &surround, seen.place.position, seen.edited);
        const float rest = (float)pow(1.0 + fmin(vec3_dot(seen.normal, ray), 0.0), 5.0);
        for (int c = 0; c < 3; c++)
            rgb[c] *= reflectance[c] + (1.0f - reflectance[c]) * rest;
    }
    return out;
}

static void check_panorama(const struct relume_geometry *g, int width, int height)
{
    relume_objects *o = open_objects(edits[3]);
    struct relume_image view, places;
    struct relume_window w;
    struct objects_drawer t;
    struct target shown, where;
    assert_true(relume_objects_window(&w, o, (struct relume_vec3){0.4, 0.5, 4}, NULL, SIDE, SIDE));
    make_room(&view, &places, g, width, height);
    assert_int_equal(objects_drawer_create(&t, &fixture_gl, o, &fixture_log), RELUME_OK);
    assert_int_equal(target_create(&shown, &fixture_gl, width, height, &fixture_log), RELUME_OK);
    assert_int_equal(target_create(&where, &fixture_gl, width, height, &fixture_log), RELUME_OK);
    target_write(&shown, &fixture_gl, &view);
    target_write(&where, &fixture_gl, &places);
    t.panorama = (struct mirror_panorama){g, &shown, &where};
    const struct relume_light lamp = {.direction = {0, 0, 1}, .rgb = {1, 1, 1}};
    struct relume_image gl = draw(&t, &w, &lamp), cpu = by_library(o, &w, g, &view, &places);
    // besides the outline, texels of depth whose steps the two round to other sides
    const int apart = count_apart(&cpu, &gl, 8e-3);
    if (apart > 60)
        fail_msg("%s: %d pixels differ", relume_projection_name(g->projection), apart);
    relume_image_destroy(&gl);
    relume_image_destroy(&cpu);
    target_destroy(&shown, &fixture_gl);
    target_destroy(&where, &fixture_gl);
    objects_drawer_destroy(&t);
    relume_image_destroy(&view);
    relume_image_destroy(&places);
    relume_objects_destroy(&o);
}

static void panoramas_are_reflected_as_by_the_library(void **state)
{
    (void)state;
    const struct relume_vec3 centre = {0.5, 0.2, 3};
    check_panorama(&(struct relume_geometry){.projection = RELUME_SPHERICAL, .center = centre}, 128,
                   64);
    check_panorama(&(struct relume_geometry){.projection = RELUME_CUBE, .center = centre}, 192, 32);
    check_panorama(
        &(struct relume_geometry){
            .projection = RELUME_CYLINDRICAL, .center = centre, .v_min = -1.5, .v_max = 1.2},
        128, 48);
}

static int open_all(void **state)
{
    char command[128];
    snprintf(folder, sizeof folder, "/tmp/relume-mirrors-%ld", (long)getpid());
    snprintf(command, sizeof command, "mkdir -p %s", folder);
    return system(command) ? -1 : fixture_open(state);
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
        cmocka_unit_test(environments_are_reflected_as_by_the_library),
        cmocka_unit_test(another_environment_in_its_place_is_shown),
        cmocka_unit_test(panoramas_are_reflected_as_by_the_library),
    };
    return cmocka_run_group_tests(tests, open_all, close_all);
}
