// Mirrors among objects: what they show of panoramas and environments against closed forms, and the
// descriptions of edited reflections, good and broken.
#include "relight/light/environment.h"
#include "relight/view/view.h"
#include "world/object/drawn_objects.h"
#include "world/reflect/reflection.h"

#include "capture_fixture.h"
#include "in_folder.h"

static char last[512];
static int warnings;

static void hear(void *user, enum relume_level level, const char *text)
{
    (void)user;
    snprintf(last, sizeof last, "%s", text);
    warnings += level == RELUME_WARNING;
}
static const struct relume_log hearing = {.message = hear};
#define CHECK_OK(call) assert_int_equal((call), RELUME_OK)

static FILE *file_of(const char *name)
{
    FILE *file = fopen(path_of(name), "w");
    assert_non_null(file);
    return file;
}

// A ball of radius 1.
static void write_ball(void)
{
    enum { RINGS = 48, AROUND = 2 * RINGS };
    FILE *file = file_of("ball.obj");
    for (int i = 0; i < (RINGS + 1) * (AROUND + 1); i++) {
        const double t = M_PI * (i / (AROUND + 1)) / RINGS, p = M_PI * (i % (AROUND + 1)) / RINGS;
        const double x = sin(t) * sin(p), y = cos(t), z = sin(t) * cos(p);
        fprintf(file, "v %.8f %.8f %.8f\nvt %.5f %.5f\nvn %.8f %.8f %.8f\n", x, y, z,
                p / (2 * M_PI), 1 - t / M_PI, x, y, z);
    }
    for (int j = 0; j < RINGS; j++)
        for (int i = 0; i < AROUND; i++) {
            const int a = j * (AROUND + 1) + i + 1, b = a + AROUND + 1;
            fprintf(file, "f %d/%d/%d %d/%d/%d %d/%d/%d\nf %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a,
                    b, b, b, b + 1, b + 1, b + 1, a, a, a, b + 1, b + 1, b + 1, a + 1, a + 1,
                    a + 1);
        }
    fclose(file);
}

#define OBJECTS "{\"format\":\"relume-objects\",\"version\":1,\"objects\":["
#define EDITS   "{\"format\":\"relume-reflections\",\"version\":1,\"edits\":["
#define BALL(pose, mirror)                                                                         \
    "{\"mesh\":\"ball.obj\",\"pose\":" pose ",\"parts\":[{\"material\":{\"mirror\":" mirror "}}]}"

static relume_objects *open_objects(const char *text)
{
    relume_objects *o;
    write_text("objects.json", text);
    CHECK_OK(
        relume_objects_open(&o, path_of("objects.json"), relume_objects_params(.log = &hearing)));
    return o;
}

// The colour of a direction.
static float code(const double d[3], int c)
{
    return (float)(0.5 + 0.4 * d[c]);
}

static vec3 lat_long(double x, double y, int width, int height)
{
    const double phi = 2 * M_PI * x / width - M_PI, up = 0.5 * M_PI - M_PI * y / height;
    return vec3_of(cos(up) * sin(phi), sin(up), -cos(up) * cos(phi));
}

static struct relume_image coded_sphere(int width, int height)
{
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, width, height, 3));
    for (int i = 0; i < width * height; i++) {
        const vec3 d = lat_long(i % width + 0.5, i / width + 0.5, width, height);
        for (int c = 0; c < 3; c++)
            image.data[3 * i + c] = code((const double[3]){d.x, d.y, d.z}, c);
    }
    return image;
}

// Where a ray first meets a ball, from outside or, `inside`, from within.
static bool meet(vec3 *at, vec3 origin, vec3 d, vec3 centre, double radius, bool inside)
{
    const vec3 o = vec3_sub(origin, centre);
    const double b = vec3_dot(o, d), disc = b * b - vec3_dot(o, o) + radius * radius;
    if (disc < 0.0)
        return false;
    *at = vec3_along(origin, d, -b + (inside ? sqrt(disc) : -sqrt(disc)));
    return true;
}

static double angle_to_rim(vec3 n, vec3 d)
{
    return -vec3_dot(n, d);
}

// Each pixel in the middle part of a ball shows the colour of the direction that the law of
// reflection says, times Schlick's reflectance.
static void a_ball_shows_the_environment(void **state)
{
    (void)state;
    enum { SIDE = 40 };
    struct relume_image map = coded_sphere(256, 128), out;
    relume_environment *e;
    CHECK_OK(relume_environment_create(&e, &map, NULL));
    relume_objects *o = open_objects(OBJECTS BALL("{}", "[0.9,0.5,0]") "]}");
    const struct relume_window window = {{0, 0, 5}, {-1, 1, 0}, {2, 0, 0}, {0, -2, 0}};
    for (int k = 0; k < 2; k++) {
        const struct relume_light light = {.kind = RELUME_LIGHT_ENVIRONMENT,
                                           .environment = e,
                                           .rotate_deg = k ? 70 : 0,
                                           .rgb = {2, 1, 0.5f}};
        CHECK_OK(relume_image_create(&out, SIDE, SIDE, 3));
        CHECK_OK(relume_objects_render(&out, o, &window, &light, 1, NULL));
        int compared = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            const vec3 at = vec3_of((i % SIDE + 0.5) / SIDE * 2 - 1,
                                    1 - (i / SIDE + 0.5) / SIDE * 2, 0),
                       d = vec3_unit(vec3_sub(at, window.eye));
            vec3 n;
            if (!meet(&n, window.eye, d, vec3_of(0, 0, 0), 1.0, false) || angle_to_rim(n, d) < 0.3)
                continue;
            vec3 r = vec3_along(d, n, -2 * vec3_dot(d, n));
            r = relume_environment_turn(r, -light.rotate_deg);
            const double f[3] = {0.9, 0.5, 0}, rest = pow(1 + vec3_dot(d, n), 5);
            for (int c = 0; c < 3; c++)  // 48 rings: normals and places are off by 1e-3
                CHECK_NEAR((double)out.data[3 * i + c],
                           (double)light.rgb[c] * (f[c] + (1 - f[c]) * rest) *
                               (double)code((const double[3]){r.x, r.y, r.z}, c),
                           0.012);
            compared++;
        }
        assert_true(compared > SIDE * SIDE / 2);
        relume_image_destroy(&out);
    }
    relume_environment_destroy(&e);
    relume_image_destroy(&map);
    // without an environment it is black, which is said
    const struct relume_light lamp = {.direction = {0, 0, 1}, .rgb = {1, 1, 1}};
    CHECK_OK(relume_image_create(&out, SIDE, SIDE, 3));
    warnings = 0;
    CHECK_OK(
        relume_objects_render(&out, o, &window, &lamp, 1, relume_render_params(.log = &hearing)));
    assert_int_equal(warnings, 1);
    assert_non_null(strstr(last, "mirrors are black"));
    CHECK_NEAR((double)out.data[3 * (SIDE * SIDE / 2 + SIDE / 2)], 0.0, 0.0);
    relume_image_destroy(&out);
    relume_objects_destroy(&o);
}

// ---------------------------------------------------------------- a panorama

enum { ACROSS = 256, HIGH = ACROSS / 2 };
static const double ROOM = 3.0;

// The inside of a ball of radius 3 about the eye, of the colour of the direction under any light;
// `step`: what is seen to the right stands at a third of that.
static relume_pack *open_room(bool step)
{
    struct relume_image image = coded_sphere(ACROSS, HIGH), depth;
    relume_pack *pack;
    CHECK_OK(relume_image_save(&image, path_of("light.exr"), NULL));
    CHECK_OK(relume_image_create(&depth, ACROSS, HIGH, 1));
    for (int i = 0; i < ACROSS * HIGH; i++)
        depth.data[i] = (float)(step && i % ACROSS > ACROSS / 2 ? ROOM / 3 : ROOM);
    CHECK_OK(relume_image_save(&depth, path_of("depth.exr"), NULL));
    write_text("capture.json",
               "{\"format\":\"relume-capture\",\"version\":1,\"transfer\":\"linear\","
               "\"projection\":\"spherical\",\"panorama\":{\"center\":[0,0,0]},"
               "\"lights\":{\"directions\":[[1,0,0],[0,1,0],[0,0,1],[-1,-1,-1]]},"
               "\"views\":[{\"images\":[\"light.exr\",\"light.exr\",\"light.exr\",\"light.exr\"],"
               "\"depth\":\"depth.exr\"}]}");
    CHECK_OK(fixture_encode(folder, path_of("room.exr"), &relume_basis_sh, 1,
                            relume_pack_encode_params(.storage = RELUME_STORE_HALF)));
    CHECK_OK(relume_pack_open(&pack, path_of("room.exr"), NULL));
    relume_image_destroy(&image);
    relume_image_destroy(&depth);
    return pack;
}

enum { WIDE = 48, TALL = 32 };
static struct relume_image look_at_room(relume_pack *pack, const relume_objects *o)
{
    const struct relume_camera camera = {.framing = RELUME_FRAME_LOOK,
                                         .look = {.pan_deg = 0, .tilt_deg = 0, .zoom = 2},
                                         .width = WIDE,
                                         .height = TALL};
    const struct relume_light light = {.direction = {0, 0, 1}, .rgb = {1, 1, 1}};
    struct relume_image out;
    relume_renderer *r;
    CHECK_OK(relume_renderer_create(&r, pack, NULL));
    CHECK_OK(relume_renderer_set_lights(r, &light, 1));
    CHECK_OK(relume_renderer_set_objects(
        r, o, relume_render_params(.samples = 1, .no_shadows = true, .log = &hearing)));
    CHECK_OK(relume_renderer_frame(&out, r, &camera));
    relume_renderer_destroy(&r);
    return out;
}

static vec3 look_ray(int i)
{
    const struct relume_pan_tilt look = {.zoom = 2};
    return relume_pan_tilt_ray(look, WIDE, TALL, i % WIDE + 0.5, i / WIDE + 0.5);
}

// Rays from mirrors end on the wall of such a room, or nowhere where there is no depth.
static void reflected_rays_end_on_the_wall(void **state)
{
    (void)state;
    static const struct relume_geometry sphere = {.projection = RELUME_SPHERICAL};
    struct relume_image places;
    CHECK_OK(relume_image_create(&places, ACROSS, HIGH, 3));
    for (int i = 0; i < ACROSS * HIGH; i++) {
        const vec3 d =
            relume_panorama_ray(&sphere, ACROSS, HIGH, i % ACROSS + 0.5, i / ACROSS + 0.5);
        const vec3 at = vec3_scale(d, ROOM);
        for (int c = 0; c < 3; c++)
            places.data[3 * i + c] = (float)(c == 0 ? at.x : c == 1 ? at.y : at.z);
    }
    const vec3 from = vec3_of(0.5, -1, 0.7);
    for (int i = 0; i < 50; i++) {
        const double y = 1 - (2 * i + 1) / 50.0, phi = 2.4 * i;
        const vec3 along = vec3_of(sqrt(1 - y * y) * cos(phi), y, sqrt(1 - y * y) * sin(phi));
        vec3 got, wall;
        assert_true(relume_objects_reflected_place(&got, &sphere, &places, from, along));
        assert_true(meet(&wall, from, along, vec3_of(0, 0, 0), ROOM, true));
        // a texel of the panorama is 0.07 wide there
        CHECK_NEAR(vec3_length(vec3_sub(got, wall)), 0.0, 0.07);
    }
    for (int i = 0; i < ACROSS * HIGH * 3; i++)
        places.data[i] = INFINITY;
    vec3 got;
    assert_false(relume_objects_reflected_place(&got, &sphere, &places, from, vec3_of(0, 0, 1)));
    relume_image_destroy(&places);
}

// A ball in the room shows the wall where its ray ends, not where it would end from the room's
// middle.
static void a_ball_shows_the_room(void **state)
{
    (void)state;
    relume_pack *pack = open_room(false);
    relume_objects *o =
        open_objects(OBJECTS BALL("{\"scale\":0.6,\"translate\":[0.2,0.1,-1.9]}", "1") "]}");
    const vec3 centre = vec3_of(0.2, 0.1, -1.9);
    warnings = 0;
    struct relume_image out = look_at_room(pack, o);
    assert_int_equal(warnings, 0);
    int compared = 0;
    double distant = 0.0;
    for (int i = 0; i < WIDE * TALL; i++) {
        const vec3 d = look_ray(i);
        vec3 p, wall;
        if (!meet(&p, vec3_of(0, 0, 0), d, centre, 0.6, false))
            continue;
        const vec3 n = vec3_scale(vec3_sub(p, centre), 1 / 0.6);
        const vec3 r = vec3_along(d, n, -2 * vec3_dot(d, n));
        assert_true(meet(&wall, p, r, vec3_of(0, 0, 0), ROOM, true));
        if (angle_to_rim(n, d) < 0.3)
            continue;
        const double want[3] = {wall.x / ROOM, wall.y / ROOM, wall.z / ROOM};
        for (int c = 0; c < 3; c++)
            CHECK_NEAR((double)out.data[3 * i + c], (double)code(want, c), 0.015);
        distant = fmax(distant, vec3_length(vec3_sub(vec3_scale(wall, 1 / ROOM), r)));
        compared++;
    }
    assert_true(compared > 100);
    assert_true(distant > 0.3);  // a distant lookup would not pass
    relume_image_destroy(&out);
    relume_objects_destroy(&o);
    relume_pack_destroy(&pack);
}

// A ray that passes behind what stands before the wall comes out again: nothing of a nearer surface
// is seen where it has no place.
static void rays_pass_behind(void **state)
{
    (void)state;
    relume_pack *pack = open_room(true);
    relume_objects *o =
        open_objects(OBJECTS BALL("{\"scale\":0.4,\"translate\":[-0.5,0,-1.9]}", "1") "]}");
    struct relume_image out = look_at_room(pack, o);
    const vec3 centre = vec3_of(-0.5, 0, -1.9);
    int behind = 0;
    for (int i = 0; i < WIDE * TALL; i++) {
        const vec3 d = look_ray(i);
        vec3 p;
        if (!meet(&p, vec3_of(0, 0, 0), d, centre, 0.4, false))
            continue;
        const vec3 n = vec3_scale(vec3_sub(p, centre), 1 / 0.4);
        const vec3 r = vec3_along(d, n, -2 * vec3_dot(d, n));
        // along these z never comes back to where the near half of the room is
        if (angle_to_rim(n, d) < 0.3 || r.x < 0.5 || r.z > -0.3 || fabs(r.y) > 0.3)
            continue;
        // the end of the ray, infinitely far, as distant lookups have it
        const double want[3] = {r.x, r.y, r.z};
        for (int c = 0; c < 3; c++)
            CHECK_NEAR((double)out.data[3 * i + c], (double)code(want, c), 0.02);
        behind++;
    }
    assert_true(behind > 3);
    relume_image_destroy(&out);
    relume_objects_destroy(&o);
    relume_pack_destroy(&pack);
}

// ---------------------------------------------------------------- edits

static void edits_move_what_is_reflected(void **state)
{
    (void)state;
    relume_pack *pack = open_room(false);
    relume_objects *o =
        open_objects(OBJECTS BALL("{\"scale\":0.6,\"translate\":[0,0,-1.9]}", "1") "]}");
    struct relume_image plain = look_at_room(pack, o);
    write_text("edit.json",
               EDITS "{\"constraints\":[{\"position\":[0,0,-1.3],\"eye\":[0,0,0],"
                     "\"target\":[0,3,-1.3]}],\"regions\":[{\"ball\":[0,0,-1.3],\"radius\":0.2,"
                     "\"border\":0.1}]}]}");
    CHECK_OK(relume_objects_load_reflections(o, path_of("edit.json"),
                                             relume_reflection_params(.log = &hearing)));
    struct relume_image edited = look_at_room(pack, o);
    struct relume_object_reflection seen;
    assert_true(relume_objects_reflect(&seen, o, vec3_of(0, 0, 0), vec3_of(0, 0, -1)));
    CHECK_NEAR(seen.original.z, 1.0, 1e-3);
    CHECK_NEAR(seen.edited.y, 1.0, 1e-3);
    assert_false(relume_objects_reflect(&seen, o, vec3_of(0, 0, 0), vec3_of(0, 0, 1)));
    // straight ahead the ceiling: the wall above (0, 0, -1.3)
    const int middle = TALL / 2 * WIDE + WIDE / 2;
    const double height = sqrt(ROOM * ROOM - 1.3 * 1.3);
    const double want[3] = {0, height / ROOM, -1.3 / ROOM};
    for (int c = 0; c < 3; c++)
        CHECK_NEAR((double)edited.data[3 * middle + c], (double)code(want, c), 0.05);
    // outside of the region nothing has changed
    int changed = 0;
    for (int i = 0; i < WIDE * TALL; i++) {
        vec3 p;
        const bool hit = meet(&p, vec3_of(0, 0, 0), look_ray(i), vec3_of(0, 0, -1.9), 0.6, false);
        const bool within = hit && vec3_length(vec3_sub(p, vec3_of(0, 0, -1.3))) < 0.31;
        const bool same = !memcmp(plain.data + 3 * i, edited.data + 3 * i, 3 * sizeof(float));
        changed += !same;
        assert_true(same || within);
    }
    assert_true(changed > 20);
    relume_image_destroy(&plain);
    relume_image_destroy(&edited);
    // written and read again it is the same edit
    CHECK_OK(relume_objects_save_reflections(o, path_of("again.json"), &hearing));
    CHECK_OK(relume_objects_save_reflections(o, path_of("again.json"), &hearing));
    // what is no such list is kept
    assert_int_equal(relume_objects_save_reflections(o, path_of("objects.json"), &hearing),
                     RELUME_EINVAL);
    assert_non_null(strstr(last, "is no list of reflections, and is kept"));
    assert_int_equal(relume_objects_save_reflections(o, path_of("ball.obj"), &hearing),
                     RELUME_EINVAL);
    const struct relume_reflection_constraint first =
        relume_reflection_edit(relume_objects_reflections(o, 0))->constraint[0];
    CHECK_OK(relume_objects_set_reflections(o, 0, NULL, NULL));
    assert_null(relume_objects_reflections(o, 0));
    CHECK_OK(relume_objects_load_reflections(o, path_of("again.json"),
                                             relume_reflection_params(.log = &hearing)));
    const struct relume_reflection_edit *again =
        relume_reflection_edit(relume_objects_reflections(o, 0));
    assert_int_equal(again->constraints, 1);
    assert_int_equal(again->regions, 1);
    CHECK_NEAR(vec3_length(vec3_sub(again->constraint[0].edited, first.edited)), 0.0, 1e-8);
    CHECK_NEAR(vec3_length(vec3_sub(again->constraint[0].original, first.original)), 0.0, 1e-8);
    CHECK_NEAR(again->region[0].border, 0.1, 0.0);
    relume_objects_destroy(&o);
    relume_pack_destroy(&pack);
}

// Edits of each object act on it alone; those in its description as those of a file.
static void edits_belong_to_objects(void **state)
{
    (void)state;
    relume_objects *o = open_objects(OBJECTS BALL(
        "{\"translate\":[-2,0,0]}",
        "1") ","
             "{\"mesh\":\"ball.obj\",\"pose\":{\"translate\":[2,0,0]},"
             "\"parts\":[{\"material\":{\"mirror\":1}}],\"reflections\":{\"distance\":\"geodesic\","
             "\"frozen\":[2,0,9],\"constraints\":[{\"position\":[2,0,1],\"eye\":[2,0,9],"
             "\"direction\":[1,0,0]}],\"regions\":[{\"geodesic\":[2,0,1],\"radius\":1},"
             "{\"stroke\":[[2,0,1],[2,1,0]],\"radius\":0.1,\"border\":0.2}]}}]}");
    struct relume_object_reflection seen;
    assert_int_equal(relume_objects_info(o)->objects, 2);
    assert_null(relume_objects_reflections(o, 0));
    assert_non_null(relume_objects_reflections(o, 1));
    assert_null(relume_objects_reflections(o, 2));
    assert_true(relume_objects_reflect(&seen, o, vec3_of(-2, 0, 9), vec3_of(0, 0, -1)));
    assert_int_equal(seen.object, 0);
    CHECK_NEAR(seen.edited.z, 1.0, 1e-3);
    assert_true(relume_objects_reflect(&seen, o, vec3_of(2, 0, 9), vec3_of(0, 0, -1)));
    assert_int_equal(seen.object, 1);
    CHECK_NEAR(seen.edited.x, 1.0, 1e-3);
    // frozen: from another eye the same
    assert_true(relume_objects_reflect(&seen, o, vec3_of(2, 5, 5), vec3_of(0, -5, -4)));
    CHECK_NEAR(seen.original.z, 1.0, 1e-2);
    relume_objects_destroy(&o);
}

static void bad_edits_are_told(void **state)
{
    (void)state;
    static char many[600000];
    size_t used = (size_t)snprintf(many, sizeof many, "%s", EDITS "{\"constraints\":[");
    for (int i = 0; i < 10000; i++)
        used += (size_t)snprintf(many + used, sizeof many - used, "%s{\"position\":[0,0,1]}",
                                 i ? "," : "");
    snprintf(many + used, sizeof many - used, "]}]}");
#define GOOD "{\"position\":[0,0,1],\"eye\":[0,0,5],\"direction\":[1,0,0]}"
    const struct {
        const char *text, *sentence;
    } list[] = {
        {"{\"format\":\"other\",\"version\":1}", "relume-reflections"},
        {"{\"format\":\"relume-reflections\",\"version\":7}", "version"},
        {"{\"format\":\"relume-reflections\",\"version\":1}", "expected a list 'edits'"},
        {EDITS "{\"object\":3}]}", "object: expected a whole number from 0 to 0"},
        {EDITS "5]}", "expected constraints, regions"},
        {EDITS "{\"constraint\":[]}]}", "found constraint"},
        {EDITS "{\"constraints\":5}]}", "constraints: expected a list"},
        {EDITS "{\"constraints\":[{}]}]}", "constraint 0: position and eye"},
        {EDITS "{\"constraints\":[{\"position\":[0,0,1],\"eye\":[0,0,5]}]}]}",
         "as direction or as target"},
        {EDITS "{\"constraints\":[{\"position\":[0,0,1],\"eye\":[0,0,5],\"direction\":[1,0,0],"
               "\"target\":[1,0,0]}]}]}",
         "as direction or as target"},
        {EDITS "{\"constraints\":[{\"position\":[0,0,1],\"eye\":[0,0,5],\"direction\":[0,0,0]}]}]}",
         "constraint 0: original and edited"},
        {EDITS
         "{\"constraints\":[{\"position\":[0,0,1],\"eye\":[0,0,5],\"direction\":[NaN,0,0]}]}]}",
         "line 1"},
        {EDITS
         "{\"constraints\":[{\"position\":[0,0,-1],\"eye\":[0,0,5],\"direction\":[1,0,0]}]}]}",
         "its eye does not see the object"},
        {EDITS "{\"constraints\":[{\"position\":[0,0,1],\"eye\":[0,0,1],\"direction\":[1,0,0]}]}]}",
         "its eye does not see the object"},
        {EDITS "{\"constraints\":[{\"position\":[0,0,1e308],\"eye\":[0,0,-1e308],"
               "\"direction\":[1,0,0]}]}]}",
         "its eye does not see the object"},
        {many, "expected a list of at most 256"},
        {EDITS "{\"regions\":[{\"ball\":[0,0,0]}]}]}", "radius and border"},
        {EDITS "{\"regions\":[{\"ball\":[0,0,0],\"radius\":0}]}]}",
         "radius: expected a number above 0"},
        {EDITS "{\"regions\":[{\"ball\":[0,0,0],\"stroke\":[],\"radius\":1}]}]}",
         "expected one of ball, geodesic and stroke"},
        {EDITS "{\"regions\":[{\"stroke\":[],\"radius\":1}]}]}", "stroke: expected 1 to"},
        {EDITS "{\"regions\":[{\"stroke\":[[1,2]],\"radius\":1}]}]}", "stroke: expected points"},
        {EDITS "{\"distance\":\"far\"}]}", "distance: expected"},
        {EDITS "{\"frozen\":true}]}", "frozen: expected the eye"},
        {"{\"format\":\"relume-refl", "line 1"},
    };
    relume_objects *o = open_objects(OBJECTS BALL("{}", "1") "]}");
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        write_text("bad.json", list[i].text);
        last[0] = '\0';
        assert_true(relume_status_is_input(relume_objects_load_reflections(
            o, path_of("bad.json"), relume_reflection_params(.log = &hearing))));
        if (!strstr(last, list[i].sentence) || strchr(last, '\n'))
            fail_msg("%.200s: '%s' does not say '%s'", list[i].text, last, list[i].sentence);
        assert_null(relume_objects_reflections(o, 0));
    }
    // the eye sees a ball that stands before the one that is edited
    write_text("hidden.json", EDITS "{\"object\":0,\"constraints\":[" GOOD "]},{\"object\":1,"
                                    "\"constraints\":[" GOOD "]}]}");
    relume_objects *two =
        open_objects(OBJECTS BALL("{}", "1") "," BALL("{\"scale\":0.99}", "1") "]}");
    last[0] = '\0';
    assert_int_equal(relume_objects_load_reflections(two, path_of("hidden.json"),
                                                     relume_reflection_params(.log = &hearing)),
                     RELUME_EFORMAT);
    assert_non_null(strstr(last, "object 1: reflections: constraint 0: its eye sees object 0"));
    assert_null(relume_objects_reflections(two, 0));  // all edits of a file or none
    relume_objects_destroy(&two);
    // constraints that do nothing are said, and no mistake
    write_text("idle.json", EDITS "{\"constraints\":[" GOOD
                                  "],\"regions\":[{\"ball\":[0,0,-1],\"radius\":1}]}]}");
    warnings = 0;
    CHECK_OK(relume_objects_load_reflections(o, path_of("idle.json"),
                                             relume_reflection_params(.log = &hearing)));
    assert_int_equal(warnings, 1);
    assert_non_null(strstr(last, "object 0: reflections: constraint 0 lies outside every region"));
    relume_objects_destroy(&o);
    static const char *const mirrors[] = {BALL("{}", "2"), BALL("{}", "[1,1]"), BALL("{}", "\"a\""),
                                          BALL("{}", "1,\"gloss\":2"), BALL("{}", "[0,-1,0]")};
    for (size_t i = 0; i < sizeof mirrors / sizeof *mirrors; i++) {
        char text[512];
        snprintf(text, sizeof text, OBJECTS "%s]}", mirrors[i]);
        write_text("objects.json", text);
        last[0] = '\0';
        assert_true(relume_status_is_input(relume_objects_open(
            &o, path_of("objects.json"), relume_objects_params(.log = &hearing))));
        assert_non_null(strstr(last, i == 3 ? "gloss" : "mirror: expected"));
    }
}

static int open_all(void **state)
{
    const int status = make_folder(state);
    write_ball();
    return status;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_shows_the_environment),
        cmocka_unit_test(reflected_rays_end_on_the_wall),
        cmocka_unit_test(a_ball_shows_the_room),
        cmocka_unit_test(rays_pass_behind),
        cmocka_unit_test(edits_move_what_is_reflected),
        cmocka_unit_test(edits_belong_to_objects),
        cmocka_unit_test(bad_edits_are_told),
    };
    return cmocka_run_group_tests(tests, open_all, remove_folder);
}
