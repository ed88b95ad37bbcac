// Captures of many objects: what becomes of each, a run that is stopped, what a folder tells
#include "in_folder.h"
#include "made_ball.h"

#include <sys/stat.h>

enum { LAMPS = 5, OBJECTS = 3 };

static struct relume_vec3 lamp_at(int i)
{
    const double z = 0.55 + 0.4 * i / LAMPS, phi = 2.4 * i, r = sqrt(1.0 - z * z);
    return (struct relume_vec3){r * cos(phi), r * sin(phi), z};
}

static void photograph(const char *name)
{
    struct made_scene s = {
        .balls = 1, .middle = {{0.4, 0, 0}}, .radius = {0.3}, .brightness = 4.0, .distant = true};
    char path[192];
    assert_int_equal(mkdir(path_of(name), 0777), 0);
    for (int i = 0; i < LAMPS; i++) {
        struct relume_image image;
        s.lamp = lamp_at(i);
        CHECK_OK(made_photograph(&image, &s, 0.003));
        snprintf(path, sizeof path, "%s/p%d.png", path_of(name), i);
        CHECK_OK(relume_image_save(&image, path, NULL));
        relume_image_destroy(&image);
    }
}

static const char *const names[OBJECTS] = {"one", "two", "three"};
static char paths[OBJECTS][128];
static const char *folders[OBJECTS];

static int photograph_all(void **state)
{
    make_folder(state);
    for (int i = 0; i < OBJECTS; i++) {
        photograph(names[i]);
        snprintf(paths[i], sizeof paths[i], "%s", path_of(names[i]));
        folders[i] = paths[i];
    }
    return 0;
}

// ---------------------------------------------------------------- a run that is stopped

static bool until_the_first(void *user, const char *what, double done)
{
    (void)what, (void)done;
    return access(user, F_OK) != 0;
}

static void a_run_that_is_stopped_goes_on(void **state)
{
    (void)state;
    char out[128], first[160];
    struct relume_captured_objects objects;
    snprintf(out, sizeof out, "%s", path_of("stopped"));
    snprintf(first, sizeof first, "%s/one", out);
    const struct relume_log log = {.progress = until_the_first, .user = first};
    assert_int_equal(relume_capture_objects(out, folders, OBJECTS,
                                            relume_capture_objects_params(.log = &log), &objects),
                     RELUME_ECANCEL);
    assert_int_equal(objects.count, OBJECTS);
    assert_int_equal(objects.object[0].status, RELUME_OK);
    assert_int_equal(objects.object[1].status, RELUME_ECANCEL);
    assert_null(objects.object[1].reason);
    assert_int_equal(objects.object[2].status, RELUME_ECANCEL);
    assert_int_equal(access(objects.object[1].path, F_OK), -1);
    assert_int_equal(access(path_of("stopped/report.html"), F_OK), 0);
    relume_captured_objects_destroy(&objects);

    CHECK_OK(relume_capture_objects(out, folders, OBJECTS, NULL, &objects));
    for (int i = 0; i < OBJECTS; i++)
        assert_int_equal(objects.object[i].kept, i == 0);
    relume_captured_objects_destroy(&objects);
}

// ---------------------------------------------------------------- what a folder tells

static void check_same(const struct relume_acquisition *a, const struct relume_acquisition *b)
{
    assert_int_equal(a->lights, b->lights);
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->left_out, b->left_out);
    assert_int_equal(a->warnings, b->warnings);
    for (int i = 0; i < a->warnings; i++)
        assert_string_equal(a->warning[i], b->warning[i]);
    for (int i = 0; i < a->lights; i++) {
        assert_string_equal(a->photo[i].path, b->photo[i].path);
        CHECK_NEAR(a->photo[i].sigma_deg, b->photo[i].sigma_deg, 0.00501);  // two decimals
        CHECK_NEAR(vec3_dot(a->direction[i], b->direction[i]), 1.0, 1e-9);
    }
    CHECK_NEAR(a->direction_error_deg, b->direction_error_deg, 0.00501);
}

// A misfire makes a warning and a photograph that is left out.
static void a_kept_capture_is_known_again(void **state)
{
    (void)state;
    struct relume_image image;
    struct relume_captured_objects made, kept;
    char out[128];
    snprintf(out, sizeof out, "%s", path_of("known"));
    CHECK_OK(relume_image_load(&image, path_of("two/p0.png"), NULL));
    memset(image.data, 0, sizeof(float) * 3 * (size_t)image.width * (size_t)image.height);
    CHECK_OK(relume_image_save(&image, path_of("two/p<5> & \"6\".png"), NULL));
    relume_image_destroy(&image);
    CHECK_OK(relume_capture_objects(out, folders, 2, NULL, &made));
    CHECK_OK(relume_capture_objects(out, folders, 2, NULL, &kept));
    assert_int_equal(made.object[1].capture.left_out, 1);
    assert_true(made.object[1].capture.direction_error_deg > 0.0);
    for (int i = 0; i < 2; i++) {
        assert_false(made.object[i].kept);
        assert_true(kept.object[i].kept);
        check_same(&made.object[i].capture, &kept.object[i].capture);
    }
    relume_captured_objects_destroy(&made);
    relume_captured_objects_destroy(&kept);
}

// ---------------------------------------------------------------- what follows

struct following {
    int calls;
    bool fail;
};

static relume_status follow(void *user, const struct relume_captured_object *object,
                            const struct relume_log *log)
{
    struct following *f = user;
    char path[256];
    f->calls++;
    snprintf(path, sizeof path, "%s/more.txt", object->path);
    if (f->fail && !strcmp(object->name, "one")) {
        log->message(log->user, RELUME_ERROR, "there is no more");
        return RELUME_EUNFIT;
    }
    return relume_file_save(path, "more", 4, log);
}

static void what_follows_is_of_the_object(void **state)
{
    (void)state;
    struct following f = {.fail = true};
    struct test_log log;
    struct relume_captured_objects objects;
    const char *const files[] = {"more.txt"};
    char out[128];
    struct relume_acquire_params each = {0};
    struct relume_capture_objects_params p = {.log = &log.log,
                                              .each = &each,
                                              .follow = follow,
                                              .user = &f,
                                              .files = files,
                                              .file_count = 1};
    test_log_init(&log);
    snprintf(out, sizeof out, "%s", path_of("more"));
    assert_int_equal(relume_capture_objects(out, folders, 2, &p, &objects), RELUME_EUNFIT);
    assert_int_equal(f.calls, 2);
    assert_string_equal(objects.object[0].reason, "there is no more");
    assert_true(objects.object[0].capture.lights > 0);
    assert_int_equal(objects.object[1].status, RELUME_OK);
    assert_non_null(strstr(log.text, "1 of 2 objects failed: one"));
    relume_captured_objects_destroy(&objects);
    f.fail = false;
    CHECK_OK(relume_capture_objects(out, folders, 2, &p, &objects));
    assert_true(objects.object[0].kept);
    relume_captured_objects_destroy(&objects);
    each.force = true;
    CHECK_OK(relume_capture_objects(out, folders, 2, &p, NULL));
}

// ---------------------------------------------------------------- many or one

static void check_many(int count, const char *const *list, bool expected)
{
    bool many;
    CHECK_OK(relume_capture_find_objects(&many, list, count, NULL));
    assert_int_equal(many, expected);
}

static void folders_are_objects(void **state)
{
    (void)state;
    bool many;
    const char *const mixed[] = {folders[0], folders[1], path_of("one/p0.png")};
    const char *const list[] = {folders[0], path_of("a.txt"), folders[1]};
    const char *const none[] = {folders[0], folders[1], path_of("no")};
    write_text("a.txt", "0 0 1\n");
    check_many(3, folders, true);
    check_many(1, folders, false);
    check_many(3, list, true);
    check_many(2, list, false);
    check_many(3, none, false);
    check_many(2, mixed + 1, false);
    assert_int_equal(relume_capture_find_objects(&many, mixed, 3, NULL), RELUME_EINVAL);
    assert_false(many);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(folders_are_objects),
        cmocka_unit_test(a_run_that_is_stopped_goes_on),
        cmocka_unit_test(what_follows_is_of_the_object),
        cmocka_unit_test(a_kept_capture_is_known_again),
    };
    return cmocka_run_group_tests(tests, photograph_all, remove_folder);
}
