// test_rig.c - lights in words and as JSON
#include "test.h"

#include "core/base/memory.h"

#include <sys/stat.h>

static char folder[64];
static struct test_log heard;

static int setup(void **state)
{
    (void)state;
    struct relume_image image;
    char path[128];
    static const char ies[] = "TILT=NONE\n1 1 1 2 1 1 2 0 0 0 1 1 1\n0 90\n0\n5 4\n";
    test_folder(folder);
    CHECK_OK(relume_image_create(&image, 8, 4, 3));
    for (int i = 0; i < 8 * 4 * 3; i++)
        image.data[i] = 0.25f;
    snprintf(path, sizeof path, "%s/my map.exr", folder);
    CHECK_OK(relume_image_save(&image, path, NULL));
    relume_image_destroy(&image);
    snprintf(path, sizeof path, "%s/a.ies", folder);
    test_write(path, ies, sizeof ies - 1);
    snprintf(path, sizeof path, "%s/sub", folder);
    assert_int_equal(mkdir(path, 0755), 0);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

static relume_rig *create(void)
{
    relume_rig *rig;
    CHECK_OK(relume_rig_create(&rig));
    test_log_init(&heard);
    return rig;
}

static const struct relume_light *add(relume_rig *rig, const char *spec)
{
    if (relume_rig_add(rig, spec, folder, &heard.log))
        fail_msg("%s", heard.text);
    return &relume_rig_entry(rig, relume_rig_count(rig) - 1)->light;
}

static const char *const specs[] = {
    "dir 1 2 3",
    "point 1 2 3 nofall",
    "spot 1 2 3 0 0 -1 25",
    "slide 1 2 3 0 0.5 -1 30 'my map.exr' nofall",
    "area 1 2 3 1 0 0 0 0.5 0",
    "area 1 2 3 1 0 0 0 0.5 0 disc",
    "env \"my map.exr\" -30.5",
    "env 'my map.exr'",
    "ies 1 2 3 0 -1 0 a.ies",
    "gonio 1 2 3 0 -1 0 'my map.exr' nofall",
};
enum { SPECS = sizeof specs / sizeof *specs };

static void test_words(void **state)
{
    (void)state;
    relume_rig *rig = create();
    for (int i = 0; i < SPECS; i++)
        add(rig, specs[i]);
    const struct relume_light *l = add(rig, " \tspot 1 2 3  0 0 -2 45 rgb 1 .5 2e-1  nofall ");
    assert_int_equal(l->kind, RELUME_LIGHT_SPOT);
    CHECK_NEAR(l->position.z, 3, 0);
    CHECK_NEAR(l->direction.z, -2, 0);
    CHECK_NEAR(l->half_angle_deg, 45, 0);
    CHECK_NEAR(l->rgb[2], 0.2, 1e-8);
    assert_true(l->nofall);
    assert_false(relume_rig_entry(rig, 2)->light.nofall);
    assert_true(relume_rig_entry(rig, 5)->light.disc && !relume_rig_entry(rig, 4)->light.disc);
    CHECK_NEAR(relume_rig_entry(rig, 4)->light.v.y, 0.5, 0);
    CHECK_NEAR(relume_rig_entry(rig, 6)->light.rotate_deg, -30.5, 0);
    assert_non_null(relume_rig_entry(rig, 3)->light.image);
    // a file is opened once
    assert_ptr_equal(relume_rig_entry(rig, 6)->light.environment,
                     relume_rig_entry(rig, 7)->light.environment);
    assert_int_equal(relume_rig_count(rig), SPECS + 1);
    assert_null(relume_rig_entry(rig, SPECS + 1));
    // the words of an entry make it again
    for (int i = 0; i < SPECS; i++) {
        CHECK_OK(relume_rig_add(rig, relume_rig_entry(rig, i)->spec, NULL, &heard.log));
        assert_string_equal(relume_rig_entry(rig, SPECS + 1 + i)->spec,
                            relume_rig_entry(rig, i)->spec);
    }
    relume_rig_destroy(&rig);
    assert_null(rig);
}

static void test_wrong_words(void **state)
{
    (void)state;
    static const struct {
        const char *spec, *why;
        relume_status status;
    } wrong[] = {
        {"", "unknown kind", RELUME_EINVAL},
        {"spto 1 2 3 0 0 -1 20", "did you mean 'spot'?", RELUME_EINVAL},
        {"dir 1 2", "expected \"dir x y z [rgb r g b]\", found 'the end'", RELUME_EINVAL},
        {"dir 0 0 0", "expected a direction, found zero", RELUME_EINVAL},
        {"dir 1 2 nan", "found 'nan'", RELUME_EINVAL},
        {"dir 1 2 3 nofall", "found 'nofall'", RELUME_EINVAL},
        {"dir 1 2 3 rgb 1 2", "found 'the end'", RELUME_EINVAL},
        {"dir 1 2 3x", "found '3x'", RELUME_EINVAL},
        {"dir 1 2 3 rgb 1 1e30 1", "values", RELUME_EINVAL},
        {"spot 1 2 3 0 0 -1", "half_angle", RELUME_EINVAL},
        {"spot 1 2 3 0 0 -1 90", "between 0 and 90", RELUME_EINVAL},
        {"spot 1 2 3 0 0 0 20", "direction", RELUME_EINVAL},
        {"slide 1 2 3 0 0 -1 30", "picture", RELUME_EINVAL},
        {"slide 1 2 3 0 0 -1 30 'a.png", "found ''a.png'", RELUME_EINVAL},
        {"slide 1 2 3 0 0 -1 30 none.png", "none.png: no such file", RELUME_ENOTFOUND},
        {"area 1 2 3 1 0 0 2 0 0", "span an area", RELUME_EINVAL},
        {"area 1 2 3 1 0 0 0 1 0 nofall", "found 'nofall'", RELUME_EINVAL},
        {"env", "found 'the end'", RELUME_EINVAL},
        {"env none.hdr", "none.hdr: no such file", RELUME_ENOTFOUND},
        {"env 'my map.exr' ten", "found 'ten'", RELUME_EINVAL},
        {"ies 1 2 3 0 -1 0 none.ies", "none.ies: cannot be opened", RELUME_ENOTFOUND},
        {"gonio 1 2 3 0 -1 0 none.exr", "none.exr", RELUME_ENOTFOUND},
        {"ies 1 2 3 0 -1 0 'my map.exr'", "TILT=", RELUME_EFORMAT},
    };
    relume_rig *rig = create();
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        test_log_init(&heard);
        assert_int_equal(relume_rig_add(rig, wrong[i].spec, folder, &heard.log), wrong[i].status);
        if (heard.lines != 1 || !strstr(heard.text, wrong[i].why))
            fail_msg("'%s': %d lines, '%s'", wrong[i].spec, heard.lines, heard.text);
        assert_int_equal(relume_rig_count(rig), 0);
    }
    relume_rig_destroy(&rig);
}

static void test_switches(void **state)
{
    (void)state;
    relume_rig *rig = create();
    const struct relume_light *lights;
    int n;
    CHECK_OK(relume_rig_lights(&lights, &n, rig));
    assert_int_equal(n, 0);
    for (int i = 0; i < 3; i++)
        add(rig, i == 1 ? "point 1 2 3" : "dir 1 2 3 rgb 1 2 4");
    struct relume_rig_entry e = *relume_rig_entry(rig, 0);
    e.intensity = 0.5;
    e.name = "key";
    e.light.direction.x = 7;
    e.light.kind = RELUME_LIGHT_AREA;  // not taken
    CHECK_OK(relume_rig_set(rig, 0, &e, NULL));
    assert_string_equal(relume_rig_entry(rig, 0)->name, "key");
    assert_string_equal(relume_rig_entry(rig, 0)->spec, "dir 7 2 3");
    CHECK_OK(relume_rig_lights(&lights, &n, rig));
    assert_int_equal(n, 3);
    assert_int_equal(lights[0].kind, RELUME_LIGHT_DIRECTIONAL);
    CHECK_NEAR(lights[0].rgb[2], 2, 0);
    e = *relume_rig_entry(rig, 0);
    e.on = false;
    CHECK_OK(relume_rig_set(rig, 0, &e, NULL));
    CHECK_OK(relume_rig_lights(&lights, &n, rig));
    assert_int_equal(n, 2);
    assert_int_equal(lights[0].kind, RELUME_LIGHT_POINT);
    e.solo = true;  // off all the same
    CHECK_OK(relume_rig_set(rig, 0, &e, NULL));
    CHECK_OK(relume_rig_lights(&lights, &n, rig));
    assert_int_equal(n, 2);
    e.on = true;
    CHECK_OK(relume_rig_set(rig, 0, &e, NULL));
    CHECK_OK(relume_rig_lights(&lights, &n, rig));
    assert_int_equal(n, 1);
    test_log_init(&heard);
    e.intensity = -1;
    assert_int_equal(relume_rig_set(rig, 0, &e, &heard.log), RELUME_EINVAL);
    assert_non_null(strstr(heard.text, "'key': expected an intensity"));
    e.intensity = 1e300;
    assert_int_equal(relume_rig_set(rig, 0, &e, NULL), RELUME_EINVAL);
    assert_int_equal(relume_rig_set(rig, 3, &e, NULL), RELUME_EINVAL);
    assert_int_equal(relume_rig_remove(rig, 3), RELUME_EINVAL);
    CHECK_OK(relume_rig_remove(rig, 0));
    assert_int_equal(relume_rig_count(rig), 2);
    assert_int_equal(relume_rig_entry(rig, 0)->light.kind, RELUME_LIGHT_POINT);
    relume_rig_destroy(&rig);
}

static void same(const struct relume_rig_entry *a, const struct relume_rig_entry *b)
{
    assert_string_equal(a->name, b->name);
    assert_int_equal(a->on, b->on);
    assert_int_equal(a->solo, b->solo);
    assert_true(a->intensity == b->intensity);
    assert_true(!memcmp(a->light.rgb, b->light.rgb, sizeof a->light.rgb));
    const struct relume_light *p = &a->light, *q = &b->light;
    assert_true(p->kind == q->kind && p->disc == q->disc && p->nofall == q->nofall);
    assert_true(p->half_angle_deg == q->half_angle_deg && p->rotate_deg == q->rotate_deg);
    assert_true(!memcmp(&p->direction, &q->direction, sizeof p->direction));
    assert_true(!memcmp(&p->position, &q->position, sizeof p->position));
    assert_true(!memcmp(&p->u, &q->u, sizeof p->u) && !memcmp(&p->v, &q->v, sizeof p->v));
    assert_true(!p->image == !q->image && !p->environment == !q->environment && !p->ies == !q->ies);
    assert_true(!p->gonio == !q->gonio);
}

// Bit by bit, from the folder itself and from one beside the files.
static void test_files(void **state)
{
    (void)state;
    static const char *const names[] = {"rig.json", "sub/rig.json"};
    relume_rig *rig = create(), *again;
    for (int i = 0; i < SPECS; i++)
        add(rig, specs[i]);
    struct relume_rig_entry e = *relume_rig_entry(rig, 2);
    e.name = "a \"name\", with \\ and \xc3\xa4";
    e.on = false;
    e.solo = true;
    e.intensity = 1.0 / 3;
    e.light.rgb[1] = 0.1f;
    e.light.position.y = -1.0 / 7;
    CHECK_OK(relume_rig_set(rig, 2, &e, NULL));
    for (int i = 0; i < 2; i++) {
        char path[128];
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        CHECK_OK(relume_rig_save(rig, path, &heard.log));
        if (relume_rig_load(&again, path, &heard.log))
            fail_msg("%s", heard.text);
        assert_int_equal(relume_rig_count(again), SPECS);
        for (int k = 0; k < SPECS; k++)
            same(relume_rig_entry(again, k), relume_rig_entry(rig, k));
        relume_rig_destroy(&again);
    }
    assert_int_equal(relume_rig_save(rig, "/nonexistent/rig.json", &heard.log), RELUME_EIO);
    relume_rig_destroy(&rig);
}

#define RIG(lights) "{ \"format\": \"relume-rig\", \"version\": 1, \"lights\": " lights " }"

static void test_wrong_files(void **state)
{
    (void)state;
    static const struct {
        const char *text, *why;
    } wrong[] = {
        {"{\n  \"format\": }", "line 2, column 13; expected JSON"},
        {"[]", "line 1, column 1; format; expected a rig of lights"},
        {"{\n  \"format\": \"relume-capture\"}",
         "line 2, column 3; format; expected a rig of lights"},
        {"{\"format\": \"relume-rig\",\n \"version\": 2, \"lights\": []}",
         "line 2, column 2; version; expected 1"},
        {"{\"format\": \"relume-rig\", \"version\": 1}", "lights; expected an array"},
        {"{\"format\": \"relume-rig\", \"version\": 1, \"ligths\": []}",
         "line 1, column 40; ligths; expected format"},
        {RIG("[3]"), "light 1; expected an object"},
        {RIG("[{}]"), "light 1; light; expected words"},
        {RIG("[{\"light\": \"dir 0 0 1\"}, {\"light\": \"dir 0 0\"}]"), "light 2; light 'dir 0 0'"},
        {RIG("[{\"light\": \"dir 0 0 1\", \"colour\": 1}]"), "light 1; colour; expected name"},
        {RIG("[{\"light\": \"dir 0 0 1\", \"rgb\": [1, 2]}]"), "rgb; expected three numbers"},
        {RIG("[{\"light\": \"dir 0 0 1\", \"on\": 1}]"), "on; expected true or false"},
        {RIG("[{\"light\": \"dir 0 0 1\", \"name\": 1}]"), "name; expected a text"},
        {RIG("[{\"light\": \"dir 0 0 1\", \"intensity\": \"1\"}]"), "intensity; expected a number"},
        {RIG("[{\"light\": \"dir 0 0 1\", \"intensity\": -1}]"), "0 or more, found -1"},
        {RIG("[{\"light\": \"env none.hdr\"}]"), "none.hdr: no such file"},
        {RIG("[\n  3]"), "line 2, column 3; light 1; expected an object"},
        {RIG("[\n {\"name\": \"}],{\\\"light\\\":\", \"light\": \"dir 0 0 1\"},\n"
             " { \"name\": \"\u00e4\u20ac\", \"light\": \"dir 0 0\" }]"),
         "line 3, column 18; light 2; light 'dir 0 0'"},
        {RIG("[{\"light\": \"dir 0 0 1\",\n\t\"rgb\": [[1, 2], {}, 3]}]"),
         "line 2, column 2; light 1; rgb; expected three numbers"},
        {RIG("[{\"light\": \"dir 0 0 1\", \"rgb\": [1, 2, 3],\n\n  \"lihgt\": 3}]"),
         "line 3, column 3; light 1; lihgt; expected name"},
        {RIG("[{\"light\": \"dir 0 0 1\"},\n\n{}]"), "line 3, column 1; light 2; light; expected"},
    };
    char path[128];
    snprintf(path, sizeof path, "%s/wrong.json", folder);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        relume_rig *rig;
        test_write(path, wrong[i].text, strlen(wrong[i].text));
        test_log_init(&heard);
        assert_true(relume_status_is_input(relume_rig_load(&rig, path, &heard.log)));
        assert_null(rig);
        if (heard.lines != 1 || !strstr(heard.text, wrong[i].why) || !strstr(heard.text, path))
            fail_msg("expected '%s'; %d lines, '%s'", wrong[i].why, heard.lines, heard.text);
    }
    relume_rig *rig;
    assert_int_equal(relume_rig_load(&rig, "/nonexistent", &heard.log), RELUME_ENOTFOUND);
}

// Memory that runs out at any place is said; nothing half done is left.
static void test_allocations(void **state)
{
    (void)state;
    char path[128];
    snprintf(path, sizeof path, "%s/memory.json", folder);
    relume_rig *rig = create();
    for (int i = 0; i < SPECS; i++)
        add(rig, specs[i]);
    relume_status status = RELUME_ENOMEM;
    for (long n = 1; status; n++) {
        mem_fail_after(n);
        status = relume_rig_save(rig, path, NULL);
        assert_true(status == RELUME_OK || status == RELUME_ENOMEM);
        mem_fail_after(0);
    }
    status = RELUME_ENOMEM;
    for (long n = 1; status; n++) {
        relume_rig *again;
        mem_fail_after(n);
        status = relume_rig_load(&again, path, NULL);
        assert_true(status == RELUME_OK || status == RELUME_ENOMEM);
        assert_true(!again == !!status);
        mem_fail_after(0);
        relume_rig_destroy(&again);
    }
    relume_rig_destroy(&rig);
}

static void test_many(void **state)
{
    (void)state;
    enum { MANY = 10000 };
    relume_rig *rig = create(), *again;
    const struct relume_light *lights;
    char path[128], spec[64];
    int n;
    for (int i = 0; i < MANY; i++) {
        snprintf(spec, sizeof spec, i % 3 ? "dir %d 2 3" : "env 'my map.exr' %d", i);
        add(rig, spec);
    }
    snprintf(path, sizeof path, "%s/many.json", folder);
    CHECK_OK(relume_rig_save(rig, path, NULL));
    CHECK_OK(relume_rig_load(&again, path, NULL));
    CHECK_OK(relume_rig_lights(&lights, &n, again));
    assert_int_equal(n, MANY);
    CHECK_NEAR(lights[9998].direction.x, 9998, 0);
    relume_rig_destroy(&again);
    relume_rig_destroy(&rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_words),       cmocka_unit_test(test_wrong_words),
        cmocka_unit_test(test_switches),    cmocka_unit_test(test_files),
        cmocka_unit_test(test_wrong_files), cmocka_unit_test(test_many),
        cmocka_unit_test(test_allocations),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
