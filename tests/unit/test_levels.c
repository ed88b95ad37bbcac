// Objects in levels of detail: against the surface that is known, before and after each change of
// level, and as pictures against those of the full mesh.
#include "in_folder.h"

#include "world/object/drawn_objects.h"
#include "world/object/levels.h"
#include "world/object/object.h"

#include <relume/image/jnd.h>
#include <relume/world/object.h>

enum { ACROSS = 96, DOWN = 48, PICTURE = 64 };
static const double RADIUS = 1.0, TUBE = 0.4, PIXELS = 0.25;

static void write_torus(const char *path)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (int j = 0; j <= DOWN; j++)
        for (int i = 0; i <= ACROSS; i++) {
            const double a = 2.0 * M_PI * (i % ACROSS) / ACROSS, b = 2.0 * M_PI * (j % DOWN) / DOWN;
            const double x = cos(a) * cos(b), y = sin(a) * cos(b), z = sin(b);
            fprintf(file, "v %.9g %.9g %.9g\nvt %.9g %.9g\nvn %.9g %.9g %.9g\n",
                    cos(a) * RADIUS + x * TUBE, sin(a) * RADIUS + y * TUBE, z * TUBE,
                    (double)i / ACROSS, (double)j / DOWN, x, y, z);
        }
    for (int j = 0; j < DOWN; j++)
        for (int i = 0; i < ACROSS; i++) {
            const int a = j * (ACROSS + 1) + i + 1, b = a + ACROSS + 1;
            fprintf(file, "f %d/%d/%d %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, a + 1, a + 1, a + 1,
                    b + 1, b + 1, b + 1, b, b, b);
        }
    fclose(file);
}

static relume_objects *open_torus(const char *member, const char *material)
{
    char text[512];
    relume_objects *o;
    snprintf(text, sizeof text,
             "{\"format\": \"relume-objects\", \"version\": 1, \"objects\": [{\"mesh\": "
             "\"torus.obj\"%s, \"parts\": [{\"material\": {\"%s\": [0.8, 0.5, 0.3]}}]}]}",
             member, material);
    write_text("torus.json", text);
    CHECK_OK(relume_objects_open(&o, path_of("torus.json"), NULL));
    return o;
}

static relume_objects *full, *levels;

static int setup(void **state)
{
    make_folder(state);
    write_torus(path_of("torus.obj"));
    full = open_torus("", "diffuse");
    levels = open_torus(", \"levels\": true", "diffuse");
    return 0;
}

static int teardown(void **state)
{
    relume_objects_destroy(&full);
    relume_objects_destroy(&levels);
    return remove_folder(state);
}

// At a distance of 1; a picture is 0.64 wide there.
static const double PIXEL = 0.01;
static vec3 eye_at(double distance)
{
    return vec3_scale(vec3_unit(vec3_of(0.3, 0.5, 0.8)), distance);
}

static relume_objects *shown_at(double distance, double pixel, bool rays)
{
    relume_objects *shown = NULL;
    CHECK_OK(relume_objects_shown(&shown, levels, eye_at(distance), pixel, rays));
    return shown;
}

static const struct relume_objects_info *drawn(const relume_objects *shown)
{
    return relume_objects_info(shown ? shown : levels);
}

static double torus_distance(const float p[3])
{
    const double x = (double)p[0], y = (double)p[1], z = (double)p[2];
    return fabs(hypot(hypot(x, y) - RADIUS, z) - TUBE);
}

static size_t triangles_at(double distance)
{
    relume_objects *shown = shown_at(distance, PIXEL, false);
    const size_t n = drawn(shown)->triangle_count;
    relume_objects_destroy(&shown);
    return n;
}

// ---------------------------------------------------------------- the surface

static void triangles_fall_with_distance(void **state)
{
    (void)state;
    assert_null(shown_at(1.2, PIXEL, false));
    assert_null(shown_at(100.0, 0.0, false));
    size_t before = 2 * ACROSS * DOWN;
    assert_int_equal(triangles_at(1.2), before);
    for (double d = 2.0; d < 200.0; d *= 1.4) {
        const size_t n = triangles_at(d);
        assert_true(n <= before);
        before = n;
    }
    assert_in_range(before, 8, 2 * ACROSS * DOWN / 50);
}

// Vertices are those of the torus or on a chord between two; flat triangles cut off an arc.
static void errors_are_within_what_may_be_seen(void **state)
{
    (void)state;
    for (double d = 2.2; d < 100.0; d *= 1.1) {
        relume_objects *shown = shown_at(d, PIXEL, false);
        const struct relume_objects_info *info = drawn(shown);
        const double nearest = d - 0.5 * vec3_length(vec3_sub(info->max, info->min));
        const double allowed = fmax(PIXELS * PIXEL * nearest, 0.002);
        for (size_t i = 0; i < info->triangle_count; i++) {
            float middle[3] = {0};
            for (int k = 0; k < 3; k++) {
                const float *p = info->vertices[info->triangles[i][k]].position;
                assert_true(torus_distance(p) <= allowed);
                for (int c = 0; c < 3; c++)
                    middle[c] += p[c] / 3.0f;
            }
            assert_true(torus_distance(middle) <= 2.0 * allowed);
        }
        relume_objects_destroy(&shown);
    }
}

static double farthest(const struct relume_objects_info *from, const struct relume_objects_info *to)
{
    double most = 0.0;
    for (size_t i = 0; i < from->vertex_count; i++) {
        double least = INFINITY;
        for (size_t k = 0; k < to->vertex_count; k++)
            least =
                fmin(least, vec3_length(vec3_sub(vec3_of((double)from->vertices[i].position[0],
                                                         (double)from->vertices[i].position[1],
                                                         (double)from->vertices[i].position[2]),
                                                 vec3_of((double)to->vertices[k].position[0],
                                                         (double)to->vertices[k].position[1],
                                                         (double)to->vertices[k].position[2]))));
        most = fmax(most, least);
    }
    return most;
}

// The two distances between which the level changes, very near to each other.
static void find_change(double at[2])
{
    const size_t n = triangles_at(at[0]);
    for (int i = 0; i < 40; i++) {
        const double middle = 0.5 * (at[0] + at[1]);
        at[triangles_at(middle) == n ? 0 : 1] = middle;
    }
}

// Where the level changes, all vertices of the finer one have come to lie on those of the coarser
// one; a third of the way before they had not.
static void a_change_of_level_moves_nothing(void **state)
{
    (void)state;
    int changes = 0;
    for (double d = 2.3; d < 60.0 && changes < 3; d *= 1.2) {
        double at[2] = {d, 1.2 * d};
        if (triangles_at(at[0]) == triangles_at(at[1]))
            continue;
        find_change(at);
        relume_objects *shown[3] = {shown_at(at[0], PIXEL, false), shown_at(at[1], PIXEL, false),
                                    shown_at(0.7 * at[0], PIXEL, false)};
        const struct relume_objects_info *after = drawn(shown[1]);
        const double here = farthest(drawn(shown[0]), after);
        const double before = farthest(drawn(shown[2]), after);
        assert_true(drawn(shown[0])->triangle_count > after->triangle_count);
        assert_true(here < 0.01);
        assert_true(before > 10.0 * here);
        for (int i = 0; i < 3; i++)
            relume_objects_destroy(&shown[i]);
        changes++;
    }
    assert_int_equal(changes, 3);
}

// ---------------------------------------------------------------- pictures

// The objects from there in a window about all of them, under a lamp and its shadows.
static struct relume_image picture_of(const relume_objects *o, double distance,
                                      struct relume_light light, bool shadows)
{
    struct relume_image out;
    struct relume_window window;
    const struct relume_look_at look = {.field_of_view_deg = 2.0 * atan(0.32) * 180.0 / M_PI};
    assert_true(relume_objects_window(&window, o, eye_at(distance), &look, PICTURE, PICTURE));
    CHECK_OK(relume_image_create(&out, PICTURE, PICTURE, 3));
    CHECK_OK(relume_objects_render(&out, o, &window, &light, 1,
                                   relume_render_params(.samples = 3, .no_shadows = !shadows)));
    return out;
}

static struct relume_image picture(const relume_objects *o, double distance)
{
    const struct relume_light light = {
        .kind = RELUME_LIGHT_DIRECTIONAL, .direction = {0.5, 0.6, 0.62}, .rgb = {1, 1, 1}};
    return picture_of(o, distance, light, true);
}

static double jnd_between(const relume_objects *a, const relume_objects *b, double distance)
{
    struct relume_image image[2] = {picture(a, distance), picture(b, distance)};
    struct relume_jnd jnd;
    CHECK_OK(relume_image_jnd(&jnd, NULL, &image[0], &image[1], NULL));
    for (int i = 0; i < 2; i++)
        relume_image_destroy(&image[i]);
    return jnd.most;
}

static void levels_look_like_the_mesh(void **state)
{
    (void)state;
    const double found = jnd_between(levels, full, 6.0);
    assert_true(found > 0.0);
    assert_true(found < 4.0);
}

// Pixels that a surface shades itself in, where the full one throws no shadow.
static int count_slivers(const relume_objects *coarse, const struct relume_light *light)
{
    int n = 0;
    struct relume_image image[4];
    for (int i = 0; i < 4; i++)
        image[i] = picture_of(i < 2 ? coarse : full, 4.0, *light, i % 2);
    for (int i = 0; i < 3 * PICTURE * PICTURE; i += 3)
        n += image[1].data[i] < 0.8f * image[0].data[i] && image[2].data[i] > 0.02f &&
             image[3].data[i] > 0.95f * image[2].data[i];
    for (int i = 0; i < 4; i++)
        relume_image_destroy(&image[i]);
    return n;
}

static void folds_of_coarse_levels_throw_no_slivers(void **state)
{
    (void)state;
    const struct relume_light light[] = {
        {.kind = RELUME_LIGHT_DIRECTIONAL, .direction = {0.9, 0.1, 0.4}, .rgb = {1, 1, 1}},
        {.kind = RELUME_LIGHT_DIRECTIONAL, .direction = {0.1, 0.95, 0.3}, .rgb = {1, 1, 1}},
        {.kind = RELUME_LIGHT_DIRECTIONAL, .direction = {-0.8, 0.5, 0.3}, .rgb = {1, 1, 1}},
        {.kind = RELUME_LIGHT_DIRECTIONAL, .direction = {-0.6, -0.7, 0.4}, .rgb = {1, 1, 1}},
    };
    enum { LIGHTS = sizeof light / sizeof *light };
    relume_objects *coarse = shown_at(4.0, 0.07, true);
    assert_non_null(coarse);
    int slivers[2] = {0, 0};  // with what is known of the level's error, and without
    for (int without = 0; without < 2; without++) {
        if (without)
            coarse->fold[0] = 0.0f;
        for (int i = 0; i < LIGHTS; i++)
            slivers[without] += count_slivers(coarse, &light[i]);
    }
    assert_true(slivers[1] >= 10);
    assert_true(slivers[0] <= slivers[1] / 2);
    relume_objects_destroy(&coarse);
}

static void no_frame_pops(void **state)
{
    (void)state;
    const int frames = TEST_SANITIZED ? 4 : 12;
    relume_objects *before = shown_at(5.0, PIXEL, true);
    assert_non_null(before);
    for (int i = 1; i < frames; i++) {
        const double d = 5.0 * pow(1.07, i);
        relume_objects *now = shown_at(d, PIXEL, true);
        assert_true(jnd_between(now, before, d) < 1.0);
        relume_objects_destroy(&before);
        before = now;
    }
    relume_objects_destroy(&before);
}

// ---------------------------------------------------------------- what is asked for

static void what_is_shown_stays(void **state)
{
    (void)state;
    relume_objects *shown = shown_at(50.0, PIXEL, false);
    const relume_objects *first = shown;
    CHECK_OK(relume_objects_shown(&shown, levels, eye_at(50.0), PIXEL, false));
    assert_ptr_equal(shown, first);
    CHECK_OK(relume_objects_shown(&shown, levels, eye_at(60.0), PIXEL, false));
    assert_ptr_not_equal(shown, first);
    CHECK_OK(relume_objects_shown(&shown, levels, eye_at(1.0), PIXEL, false));
    assert_null(shown);
}

static void mirrors_are_shown_in_full(void **state)
{
    (void)state;
    relume_objects *o = open_torus(", \"levels\": true", "mirror"), *shown = NULL;
    CHECK_OK(relume_objects_shown(&shown, o, eye_at(100.0), PIXEL, false));
    assert_null(shown);
    relume_objects_destroy(&o);
}

static void bad_levels_are_refused(void **state)
{
    (void)state;
    static const char *const bad[] = {"0", "-1", "101", "\"yes\"", "[1]", "1e999", "null"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char text[256];
        relume_objects *o;
        struct test_log log;
        test_log_init(&log);
        snprintf(text, sizeof text,
                 "{\"format\": \"relume-objects\", \"version\": 1, \"objects\": [{\"mesh\": "
                 "\"torus.obj\", \"levels\": %s}]}",
                 bad[i]);
        write_text("bad.json", text);
        assert_int_equal(
            relume_objects_open(&o, path_of("bad.json"), relume_objects_params(.log = &log.log)),
            RELUME_EFORMAT);
        assert_int_equal(log.lines, 1);
    }
}

// ---------------------------------------------------------------- parts

// A torus of three patches with vertices of their own, the last of which meets both others.
enum { PATCHES = 3 };
static relume_objects *open_patches(void)
{
    FILE *file = fopen(path_of("patches.obj"), "w");
    relume_objects *o;
    assert_non_null(file);
    for (int p = 0, first = 1; p < PATCHES; p++) {
        const int from = p * ACROSS / PATCHES, to = (p + 1) * ACROSS / PATCHES;
        fprintf(file, "usemtl patch%d\n", p);
        for (int j = 0; j <= DOWN; j++)
            for (int i = from; i <= to; i++) {
                const double a = 2 * M_PI * (i % ACROSS) / ACROSS, b = 2 * M_PI * (j % DOWN) / DOWN;
                const double x = cos(a) * cos(b), y = sin(a) * cos(b), z = sin(b);
                fprintf(file, "v %.9g %.9g %.9g\nvt %.9g %.9g\nvn %.9g %.9g %.9g\n",
                        cos(a) + x * TUBE, sin(a) + y * TUBE, z * TUBE, i / 9.0 + 20 * p, j / 9.0,
                        x, y, z);
            }
        for (int j = 0; j < DOWN; j++)
            for (int i = 0; i < to - from; i++) {
                const int a = first + j * (to - from + 1) + i, b = a + to - from + 1;
                fprintf(file, "f %d/%d/%d %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, a + 1, a + 1,
                        a + 1, b + 1, b + 1, b + 1, b, b, b);
            }
        first += (DOWN + 1) * (to - from + 1);
    }
    fclose(file);
    write_text("patches.json",
               "{\"format\": \"relume-objects\", \"version\": 1, \"objects\": [{\"mesh\": "
               "\"patches.obj\", \"levels\": true, \"parts\": [{\"material\": {\"diffuse\": "
               "0.5}}]}]}");
    CHECK_OK(relume_objects_open(&o, path_of("patches.json"), NULL));
    assert_int_equal(relume_objects_info(o)->parts, PATCHES);
    return o;
}

struct edge {
    float end[2][3];
};

static int by_ends(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(struct edge));
}

// The edges of a part, each from its lower end, and +1 or -1 for which way it goes.
static size_t take_edges(struct edge *edge, const struct relume_objects_info *info, int part)
{
    size_t n = 0;
    for (size_t t = info->part[part].first; t < info->part[part].first + info->part[part].count;
         t++)
        for (int k = 0; k < 3; k++, n++)
            for (int e = 0; e < 2; e++)
                for (int c = 0; c < 3; c++)
                    edge[n].end[e][c] =
                        info->vertices[info->triangles[t][(k + e) % 3]].position[c] + 0.0f;
    return n;
}

// Edges that are there more often one way than the other.
static int open_edges(struct edge *edge, size_t n)
{
    int open = 0;
    qsort(edge, n, sizeof *edge, by_ends);
    for (size_t i = 0; i < n; i++) {
        struct edge back;
        memcpy(back.end[0], edge[i].end[1], sizeof back.end[0]);
        memcpy(back.end[1], edge[i].end[0], sizeof back.end[1]);
        size_t first = i, last = i + 1;
        for (; last < n && !by_ends(&edge[last], &edge[i]); last++) {
        }
        const struct edge *opposite = bsearch(&back, edge, n, sizeof *edge, by_ends);
        size_t opposites = 0;
        for (const struct edge *e = opposite; e && e >= edge && !by_ends(e, &back); e--)
            opposites++;
        for (const struct edge *e = opposite ? opposite + 1 : NULL;
             e && e < edge + n && !by_ends(e, &back); e++)
            opposites++;
        open += last - first > opposites;
        i = last - 1;
    }
    return open;
}

// All parts in levels of their own, each moved by some.
static relume_objects *show_in(const relume_objects *o, const int level[PATCHES], int moved)
{
    struct level_choice choice[PATCHES];
    relume_objects *shown = NULL;
    for (int p = 0; p < PATCHES; p++)
        choice[p] = (struct level_choice){
            level[p], level[p] + 1 < objects_levels(o, p) ? moved * (p + 1) % 256 : 0};
    CHECK_OK(objects_show(&shown, o, choice, false));
    return shown;
}

static void patches_stay_closed_at_all_pairs_of_levels(void **state)
{
    (void)state;
    relume_objects *o = open_patches();
    struct edge *edge = malloc(6 * ACROSS * DOWN * sizeof *edge);
    const int levels_of = objects_levels(o, 0);
    size_t least = 2 * ACROSS * DOWN;
    int torn = 0;
    assert_in_range(levels_of, 4, 12);
    for (int a = 0; a < levels_of; a++)
        for (int b = 0; b < levels_of; b++) {
            relume_objects *shown = show_in(o, (int[]){a, b, (a + b) / 2}, 37 * (a + b));
            relume_objects *one = show_in(o, (int[]){a, a, a}, 0);
            relume_objects *other = show_in(o, (int[]){b, b, b}, 0);
            const struct relume_objects_info *info = relume_objects_info(shown);
            size_t n = 0;
            for (int p = 0; p < PATCHES; p++)
                n += take_edges(edge + n, info, p);
            assert_int_equal(open_edges(edge, n), 0);
            least = info->triangle_count < least ? info->triangle_count : least;
            for (size_t i = 0; i < info->vertex_count; i++)
                assert_true(torus_distance(info->vertices[i].position) < 0.3);
            // the control: each part as it is where all have its level
            n = take_edges(edge, relume_objects_info(one), 0);
            n += take_edges(edge + n, relume_objects_info(other), 1);
            n += take_edges(edge + n, relume_objects_info(one), 2);
            torn += open_edges(edge, n) > 0;
            relume_objects_destroy(&shown);
            relume_objects_destroy(&one);
            relume_objects_destroy(&other);
        }
    assert_in_range(least, 8, ACROSS * DOWN / 10);
    assert_in_range(torn, levels_of * (levels_of - 1) / 2, levels_of * (levels_of - 1));
    free(edge);
    relume_objects_destroy(&o);
}

// Near one end of a long thing the other end is coarse.
static void far_parts_are_coarser(void **state)
{
    (void)state;
    relume_objects *o = open_patches(), *shown = NULL;
    CHECK_OK(relume_objects_shown(&shown, o, vec3_of(0.8, 1.2, 0), 20 * PIXEL, false));
    assert_non_null(shown);
    const struct relume_objects_info *info = relume_objects_info(shown);
    assert_true(2 * info->part[1].count < info->part[0].count);
    relume_objects_destroy(&shown);
    relume_objects_destroy(&o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triangles_fall_with_distance),
        cmocka_unit_test(errors_are_within_what_may_be_seen),
        cmocka_unit_test(a_change_of_level_moves_nothing),
        cmocka_unit_test(levels_look_like_the_mesh),
        cmocka_unit_test(folds_of_coarse_levels_throw_no_slivers),
        cmocka_unit_test(no_frame_pops),
        cmocka_unit_test(what_is_shown_stays),
        cmocka_unit_test(mirrors_are_shown_in_full),
        cmocka_unit_test(bad_levels_are_refused),
        cmocka_unit_test(patches_stay_closed_at_all_pairs_of_levels),
        cmocka_unit_test(far_parts_are_coarser),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
