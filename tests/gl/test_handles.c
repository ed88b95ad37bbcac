// Reflections edited by hand, without OpenGL: what the mouse and words do to the edits of a ball
#include "app/app.h"
#include "app/events.h"
#include "app/handles.h"
#include "app/handles_drag.h"
#include "app/handles_say.h"
#include "common/vec.h"
#include "world/object/drawn_objects.h"
#include "world/reflect/reflection.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

// The eye stands at (0, 0, 4) and sees the ball of radius 1 about the origin through a window of
// the plane z = 0.
enum { RINGS = 48, AROUND = 2 * RINGS, SIDE = 200 };
static const double half = 1.5;     // of the window
static const double coarse = 5e-3;  // a ball of triangles is not round
static char folder[64], last[512];
static relume_objects *objects;
static struct app app;

static void hear(void *user, enum relume_level level, const char *text)
{
    (void)user, (void)level;
    snprintf(last, sizeof last, "%s", text);
}
static const struct relume_log hearing = {.message = hear};

static void write_ball(const char *path)
{
    FILE *file = fopen(path, "w");
    for (int i = 0; i < (RINGS + 1) * (AROUND + 1); i++) {
        const double t = M_PI * (i / (AROUND + 1)) / RINGS, p = M_PI * (i % (AROUND + 1)) / RINGS;
        const double x = sin(t) * sin(p), y = cos(t), z = sin(t) * cos(p);
        fprintf(file, "v %.8f %.8f %.8f\nvt %.5f %.5f\nvn %.8f %.8f %.8f\n", x, y, z,
                p / (2 * M_PI), 1 - t / M_PI, x, y, z);
    }
    for (int j = 0; j < RINGS; j++)
        for (int i = 0; i < AROUND; i++) {
            const int a = j * (AROUND + 1) + i + 1, b = a + AROUND + 1;
            fprintf(file, "f %d/%d/%d %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, b, b, b, b + 1, b + 1,
                    b + 1, a + 1, a + 1, a + 1);
        }
    fclose(file);
}

static int set_up(void **state)
{
    char path[128];
    (void)state;
    strcpy(folder, "/tmp/relume-handles-XXXXXX");
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/ball.obj", folder);
    write_ball(path);
    snprintf(path, sizeof path, "%s/ball.json", folder);
    FILE *file = fopen(path, "w");
    fputs("{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"ball.obj\","
          "\"parts\":[{\"material\":{\"mirror\":1}}]}]}",
          file);
    fclose(file);
    assert_int_equal(relume_objects_open(&objects, path, NULL), RELUME_OK);
    const struct app_file shown = {
        .geometry = {.projection = RELUME_PLANAR,
                     .perspective = true,
                     .camera_z = 4,
                     .window_min = {-half, -half},
                     .window_max = {half, half}},
        .width = SIDE,
        .height = SIDE,
        .views = 1,
        .objects = objects,
    };
    const struct app_state start = {.exposure_ev = 0};
    assert_int_equal(app_start(&app, &shown, &start, false, NULL), RELUME_OK);
    assert_true(handles_turn_on(&app, true));
    last[0] = '\0';
    return 0;
}

static int tear_down(void **state)
{
    char path[128];
    (void)state;
    app_release(&app);
    relume_objects_destroy(&objects);
    for (int i = 0; i < 2; i++) {
        snprintf(path, sizeof path, "%s/ball.%s", folder, i ? "obj" : "json");
        (void)!unlink(path);
    }
    return rmdir(folder);
}

// ---------------------------------------------------------------- closed forms

static struct relume_vec3 ray_of(double x, double y)
{
    return vec3_unit(
        (struct relume_vec3){half * (2 * x / SIDE - 1), half * (1 - 2 * y / SIDE), -4});
}

static const struct relume_vec3 eye = {0, 0, 4};

// Where the ray of a pixel hits the round ball, and what it reflects there.
static struct relume_vec3 hit_of(double x, double y, struct relume_vec3 *reflected)
{
    const struct relume_vec3 d = ray_of(x, y);
    const double b = vec3_dot(eye, d), t = -b - sqrt(b * b - vec3_dot(eye, eye) + 1);
    const struct relume_vec3 p = vec3_along(eye, d, t);
    *reflected = vec3_along(d, p, -2 * vec3_dot(d, p));
    return p;
}

static void check_near(struct relume_vec3 got, struct relume_vec3 want, double tolerance)
{
    if (vec3_length(vec3_sub(got, want)) <= tolerance)
        return;
    print_error("got %g %g %g, want %g %g %g\n", got.x, got.y, got.z, want.x, want.y, want.z);
    fail();
}

static struct relume_vec3 shown_at(double x, double y)
{
    struct relume_object_reflection seen;
    assert_true(relume_objects_reflect(&seen, objects, eye, ray_of(x, y)));
    return seen.edited;
}

// ---------------------------------------------------------------- the mouse

static void send(enum app_event_kind kind, double x, double y)
{
    (void)app_handle(&app, &(struct app_event){.kind = kind, .x = x, .y = y});
}

static void drag(double x0, double y0, double x1, double y1)
{
    send(APP_MOVE, x0, y0);
    send(APP_PRESS, x0, y0);
    for (int i = 1; i <= 8; i++)
        send(APP_MOVE, x0 + i * (x1 - x0) / 8, y0 + i * (y1 - y0) / 8);
    send(APP_RELEASE, x1, y1);
}

static void does(const char *words)
{
    if (handles_say(&app, words, &hearing)) {
        print_error("%s: %s\n", words, last);
        fail();
    }
}

static void fails(const char *words, const char *why)
{
    last[0] = '\0';
    assert_int_equal(handles_say(&app, words, &hearing), RELUME_EINVAL);
    if (!strstr(last, why)) {
        print_error("'%s' said '%s'\n", words, last);
        fail();
    }
}

static const struct relume_reflection_edit *edit_now(void)
{
    const relume_reflection *r = relume_objects_reflections(objects, 0);
    return r ? relume_reflection_edit(r) : NULL;
}

static void what_was_seen_follows_the_pointer(void **state)
{
    struct relume_vec3 from, to, there;
    (void)state;
    const struct relume_vec3 red = hit_of(90, 70, &from), green = hit_of(110, 120, &to);
    check_near(shown_at(90, 70), from, coarse);
    drag(90, 70, 110, 120);
    const struct relume_reflection_edit *e = edit_now();
    assert_non_null(e);
    assert_int_equal(e->constraints, 1);
    check_near(e->constraint[0].position, green, coarse);
    check_near(e->constraint[0].original, to, coarse);
    check_near(e->constraint[0].edited, from, coarse);
    check_near(e->constraint[0].eye, eye, 1e-9);
    check_near(app.handles->now[0].mark[0].red, red, coarse);
    check_near(shown_at(110, 120), from, coarse);
    // the green handle again, at a place of its own; then the red one: another thing is seen there
    drag(110, 120, 80, 100);
    (void)hit_of(80, 100, &there);
    assert_int_equal(edit_now()->constraints, 1);
    check_near(shown_at(80, 100), from, coarse);
    drag(90, 70, 130, 90);
    (void)hit_of(130, 90, &to);
    check_near(shown_at(80, 100), to, coarse);
    check_near(edit_now()->constraint[0].original, there, coarse);
    // beside the ball there is only what is far
    drag(130, 90, 10, 20);
    check_near(shown_at(80, 100), ray_of(10, 20), coarse);
}

static void changes_are_undone(void **state)
{
    (void)state;
    assert_false(handles_undo(app.handles));
    drag(90, 70, 110, 120);
    const struct relume_reflection_constraint first = edit_now()->constraint[0];
    drag(110, 120, 100, 140);
    const struct relume_vec3 shown = shown_at(97, 133);
    const struct relume_reflection_constraint second = edit_now()->constraint[0];
    assert_memory_not_equal(&first, &second, sizeof first);
    does("undo");
    assert_memory_equal(&edit_now()->constraint[0], &first, sizeof first);
    does("undo");
    assert_null(edit_now());
    fails("undo", "with a change left");
    does("redo");
    does("redo");
    fails("redo", "with a change left");
    assert_memory_equal(&edit_now()->constraint[0], &second, sizeof second);
    const struct relume_vec3 again = shown_at(97, 133);
    assert_memory_equal(&again, &shown, sizeof shown);
    // what was undone is forgotten by a change
    does("undo");
    drag(60, 100, 70, 100);
    fails("redo", "with a change left");
    assert_int_equal(edit_now()->constraints, 2);
    does("delete");
    assert_int_equal(edit_now()->constraints, 1);
    fails("delete", "with a constraint or a region chosen");
    does("undo");
    assert_int_equal(edit_now()->constraints, 2);
    (void)app_handle(&app, &(struct app_event){.kind = APP_KEY_DOWN, .key = APP_CONTROL | 'z'});
    assert_int_equal(edit_now()->constraints, 1);
    (void)app_handle(&app, &(struct app_event){.kind = APP_KEY_DOWN, .key = APP_CONTROL | 'y'});
    assert_int_equal(edit_now()->constraints, 2);
    // more changes than are kept
    for (int i = 0; i < 300; i++) {
        does(i % 2 ? "freeze" : "unfreeze");
    }
    int undone = 0;
    while (handles_undo(app.handles))
        undone++;
    assert_int_equal(undone, 256);
}

static void regions_bound_the_effect(void **state)
{
    struct relume_vec3 middle, beside, inside;
    (void)state;
    const struct relume_vec3 centre = hit_of(100, 100, &middle);
    does("tool ball");
    drag(100, 100, 120, 100);
    does("border 0.25");
    const struct relume_reflection_region *r = handles_region(app.handles);
    assert_non_null(r);
    check_near(r->centre, centre, coarse);
    // 20 pixels at the distance of the front of the ball
    assert_true(fabs(r->radius - 20 * 2 * half / SIDE * 3 / 4) < 1e-3);
    assert_true(fabs(r->border - 0.25 * r->radius) < 1e-9);
    does("tool move");
    drag(100, 60, 104, 100);
    (void)hit_of(100, 60, &inside);
    check_near(shown_at(104, 100), inside, coarse);
    (void)hit_of(140, 100, &beside);
    check_near(shown_at(140, 100), beside, coarse);
    // by its handles: the middle, then the rim
    drag(100, 100, 110, 110);
    check_near(edit_now()->region[0].centre, hit_of(110, 110, &middle), coarse);
    does("choose region 0");
    does("radius 0.4");
    assert_true(fabs(edit_now()->region[0].border - 0.1) < 1e-9);
    does("radius 0.5");
    does("undo");  // both at once
    assert_true(fabs(edit_now()->region[0].radius - 20 * 2 * half / SIDE * 3 / 4) < 1e-3);
    // a constraint that is dragged out of its region is told of
    app.handles->said[0] = '\0';
    drag(104, 100, 104, 165);
    assert_non_null(strstr(app.handles->said, "outside every region"));
}

static void strokes_are_painted(void **state)
{
    (void)state;
    does("radius 0.1");
    does("tool brush");
    send(APP_MOVE, 70, 100);
    send(APP_PRESS, 70, 100);
    for (int x = 71; x <= 130; x++)
        send(APP_MOVE, x, 100);
    send(APP_MOVE, 2, 2);  // beside the ball nothing is painted
    send(APP_RELEASE, 2, 2);
    const struct relume_reflection_region *r = &edit_now()->region[0];
    assert_int_equal(edit_now()->regions, 1);
    assert_int_equal(r->shape, RELUME_REFLECTION_STROKES);
    assert_true(r->points > 10 && r->points < 40);
    for (int i = 0; i < r->points; i++) {
        assert_true(fabs(vec3_length(r->stroke[i]) - 1) < coarse);
        assert_true(fabs(r->stroke[i].y) < coarse);
        assert_true(!i || r->stroke[i].x - r->stroke[i - 1].x > 0.02);
    }
    does("tool along");
    drag(100, 60, 115, 60);
    assert_int_equal(edit_now()->region[1].shape, RELUME_REFLECTION_GEODESIC);
    does("undo");
    assert_int_equal(edit_now()->regions, 1);
    does("undo");
    assert_null(edit_now());
}

static void an_edit_is_frozen_and_seen_again(void **state)
{
    (void)state;
    drag(90, 70, 110, 120);
    does("freeze");
    assert_true(edit_now()->frozen);
    check_near(edit_now()->eye, eye, 1e-9);
    // from elsewhere it is what the stored eye sees
    struct relume_object_reflection here, there;
    assert_true(
        relume_objects_reflect(&here, objects, eye, vec3_sub(hit_of(110, 120, &here.edited), eye)));
    const struct relume_vec3 other = {1, 1, 3.6};
    assert_true(
        relume_objects_reflect(&there, objects, other, vec3_sub(here.place.position, other)));
    check_near(there.edited, here.edited, coarse);
    does("unfreeze");
    assert_false(edit_now()->frozen);
    does("distance geodesic");
    assert_true(edit_now()->geodesic);
    does("choose constraint 0");
    fails("view", "an eye that can move");  // a planar file has one
}

static bool surface(void *user, struct relume_vec3 *out, double x, double y)
{
    (void)user;
    *out = (struct relume_vec3){x, y, -3};
    return true;
}

// All that is reflected lies in the plane x = -5, if the ray goes there.
static bool reflected(void *user, struct relume_vec3 *out, struct relume_vec3 from,
                      struct relume_vec3 direction)
{
    (void)user;
    const double t = (-5 - from.x) / direction.x;
    *out = vec3_along(from, direction, t);
    return t > 0 && isfinite(t);
}

// Where the scene is known, a place of it is shown, not a direction.
static void places_of_a_scene_are_shown(void **state)
{
    struct relume_vec3 from, at;
    (void)state;
    app.scene = (struct app_scene){NULL, surface, reflected};
    const struct relume_vec3 red = hit_of(60, 100, &from), green = hit_of(110, 120, &at);
    assert_true(reflected(NULL, &at, red, from));
    drag(60, 100, 110, 120);
    check_near(shown_at(110, 120), vec3_unit(vec3_sub(at, green)), coarse);
    drag(60, 100, 2, 2);
    check_near(shown_at(110, 120), vec3_unit(vec3_sub((struct relume_vec3){2, 2, -3}, green)),
               coarse);
}

static void wrong_words_are_refused(void **state)
{
    (void)state;
    fails("paint", "expected on, off, tool");
    fails("", "expected on, off, tool");
    fails("tool hammer", "tool move, ball, along or brush");
    fails("choose constraint 0", "that is there");
    fails("choose region -1", "that is there");
    fails("choose constraint 0 7", "that is there");
    drag(90, 70, 110, 120);
    fails("choose constraint 0 0 7", "that is there");
    fails("choose constraint 0x", "that is there");
    fails("choose constraint 4294967296", "that is there");
    does("choose constraint 0 0");
    does("undo");
    fails("radius 0", "above 0");
    fails("radius nan", "above 0");
    fails("radius 1 2", "above 0");
    fails("radius 1e300", "up to 1000 sizes");
    fails("border -1", "0 to 1000");
    fails("border inf", "0 to 1000");
    fails("distance far", "straight or geodesic");
    fails("freeze now", "freeze");
    assert_null(edit_now());
    does("off");
    drag(90, 70, 110, 120);
    assert_null(edit_now());
    does("on");
    // presses that begin nothing
    drag(2, 2, 100, 100);
    assert_null(edit_now());
    struct app bare = app;
    bare.handles = NULL;
    bare.file.objects = NULL;
    assert_int_equal(handles_say(&bare, "on", &hearing), RELUME_EUNFIT);
    for (int i = 0; i < RELUME_REFLECTION_CONSTRAINTS_MOST + 1; i++) {
        struct handles_edit *e = handles_begin(app.handles, 0);
        const struct relume_reflection_constraint c = {
            {0, 0, 1}, {0, 0, 1}, {0, 0.01 * i, 1}, {0, 0, 4}};
        assert_int_equal(handles_add_constraint(app.handles, e, &c),
                         i < RELUME_REFLECTION_CONSTRAINTS_MOST);
        assert_true(handles_end(app.handles, NULL));
    }
    assert_non_null(strstr(app.handles->said, "at most 256"));
    // a number that is none is refused by the library; then all is as before
    struct handles_edit *e = handles_begin(app.handles, 0);
    assert_non_null(e);
    e->constraint[0].position.x = NAN;
    assert_false(handles_show(app.handles));
    assert_true(isfinite(app.handles->now[0].constraint[0].position.x));
}

// What the mouse held is a change then; a handle of another kind is not moved in its place.
static void a_drag_ends_by_another_button_or_word(void **state)
{
    (void)state;
    send(APP_PRESS, 90, 70);
    send(APP_MOVE, 110, 120);
    (void)app_handle(
        &app, &(struct app_event){.kind = APP_PRESS, .button = APP_RIGHT, .x = 110, .y = 120});
    assert_false(app.handles->changes);
    const struct relume_reflection_constraint dragged = edit_now()->constraint[0];
    send(APP_MOVE, 120, 130);
    send(APP_RELEASE, 120, 130);
    assert_memory_equal(&edit_now()->constraint[0], &dragged, sizeof dragged);
    does("tool ball");
    drag(60, 100, 75, 100);
    const struct relume_reflection_region region = edit_now()->region[0];
    send(APP_PRESS, 75, 100);
    does("choose constraint 0");
    send(APP_MOVE, 90, 100);
    send(APP_RELEASE, 90, 100);
    assert_memory_equal(&edit_now()->region[0], &region, sizeof region);
    does("undo");
    does("undo");
    assert_null(edit_now());
    // as small as there are numbers, and back
    does("tool ball");
    drag(60, 100, 75, 100);
    does("radius 1e-320");
    does("radius 0.5");
}

// Whatever a hand does, it can be undone to the beginning and redone to the end.
static void anything_is_undone(void **state)
{
    (void)state;
    static const char *const words[] = {"tool move",
                                        "tool ball",
                                        "tool brush",
                                        "tool along",
                                        "undo",
                                        "redo",
                                        "delete",
                                        "freeze",
                                        "unfreeze",
                                        "choose region 0",
                                        "choose region 1",
                                        "radius 0.3",
                                        "border 0.1",
                                        "choose constraint 0"};
    uint64_t seed = 7;
    for (int i = 0; i < 50; i++) {
        double u[5];
        for (int k = 0; k < 5; k++) {
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            u[k] = (double)(seed >> 11) * 0x1p-53;
        }
        if (u[4] < 0.5)
            (void)!handles_say(&app, words[(int)(u[0] * (sizeof words / sizeof *words))], NULL);
        else
            drag(SIDE * (0.3 + 0.4 * u[0]), SIDE * (0.3 + 0.4 * u[1]), SIDE * u[2], SIDE * u[3]);
        assert_false(app.handles->changes);
    }
    const struct relume_reflection_edit *e = edit_now();
    assert_non_null(e);
    const int constraints = e->constraints, regions = e->regions;
    assert_true(constraints > 1 && regions > 1);
    const struct relume_vec3 shown = shown_at(101, 97);
    int undone = 0;
    while (handles_undo(app.handles))
        undone++;
    assert_true(undone > 10);
    assert_null(edit_now());
    for (; undone; undone--)
        assert_true(handles_redo(app.handles));
    const struct relume_vec3 again = shown_at(101, 97);
    assert_int_equal(edit_now()->constraints, constraints);
    assert_int_equal(edit_now()->regions, regions);
    assert_memory_equal(&again, &shown, sizeof shown);
}

// Edits of a file have handles too; the red one by a search among the vertices.
static void edits_that_are_there_get_handles(void **state)
{
    struct relume_vec3 from, to;
    (void)state;
    const struct relume_vec3 red = hit_of(90, 70, &from), green = hit_of(110, 120, &to);
    const struct relume_reflection_constraint c[2] = {
        {.position = green, .original = to, .edited = from, .eye = eye},
        {.position = green, .original = to, .edited = {0, 0, -1}, .eye = eye}};
    const struct relume_reflection_edit edit = {.constraint = c, .constraints = 2};
    assert_int_equal(relume_objects_set_reflections(objects, 0, &edit, NULL), RELUME_OK);
    handles_destroy(&app.handles);
    assert_true(handles_turn_on(&app, true));
    assert_true(app.handles->now[0].mark[0].has_red);
    check_near(app.handles->now[0].mark[0].red, red, 0.05);  // an edge is 0.065 long
    assert_false(app.handles->now[0].mark[1].has_red);  // nothing reflects what is behind the ball
    struct handle all[HANDLES_MOST];
    assert_int_equal(handles_of(all, &app), 3);
    assert_true(all[1].grip == HANDLES_GREEN && fabs(all[1].x - 110) < 0.01 &&
                fabs(all[1].y - 120) < 0.01 && !all[1].hidden);
}

int main(void)
{
#define CASE(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        CASE(what_was_seen_follows_the_pointer),
        CASE(changes_are_undone),
        CASE(regions_bound_the_effect),
        CASE(strokes_are_painted),
        CASE(an_edit_is_frozen_and_seen_again),
        CASE(places_of_a_scene_are_shown),
        CASE(wrong_words_are_refused),
        CASE(a_drag_ends_by_another_button_or_word),
        CASE(anything_is_undone),
        CASE(edits_that_are_there_get_handles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
