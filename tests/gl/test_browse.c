// Folders to choose a file from, and the window that does it
#include "app/events.h"
#include "owned.h"
#include "panel/browse.h"
#include "panel/panel.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>

static char root[PATH_MAX];

static void make(const char *name, bool folder)
{
    char path[2 * PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", root, name);
    if (folder) {
        assert_int_equal(mkdir(path, 0777), 0);
        return;
    }
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fclose(file);
}

static int begin(void **state)
{
    char path[] = "/tmp/relume-browse-XXXXXX";
    (void)state;
    if (!mkdtemp(path) || !realpath(path, root))
        return -1;
    static const char *const folders[] = {"Zoo", "attic", ".hidden"};
    static const char *const files[] = {"b.exr", "A.EXR", "c.json", "notes.txt", ".d.exr", "exr"};
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
        make(folders[i], true);
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        make(files[i], false);
    make("attic/inside.exr", false);
    make("cap", true);
    make("cap/capture.json", false);
    return 0;
}

static int end(void **state)
{
    char command[PATH_MAX + 16];
    (void)state;
    snprintf(command, sizeof command, "rm -r '%s'", root);
    return system(command);
}

static void folders_come_first_and_only_what_opens(void **state)
{
    static const char *const want[] = {"attic", "cap", "Zoo", "A.EXR", "b.exr", "c.json"};
    struct browser b = {.count = 0};
    (void)state;
    assert_int_equal(browse_list(&b, root), RELUME_OK);
    assert_int_equal(b.count, 6);
    for (int i = 0; i < 6; i++) {
        assert_string_equal(b.entry[i].name, want[i]);
        assert_int_equal(b.entry[i].folder, i < 3);
        assert_int_equal(b.entry[i].opens, i == 1);
    }
    assert_null(b.trouble);
    browse_destroy(&b);
    browse_destroy(&b);
}

static void a_folder_that_cannot_be_read_says_why(void **state)
{
    struct browser b = {.count = 0};
    char path[PATH_MAX];
    (void)state;
    assert_int_equal(browse_list(&b, "/nonexistent/folder"), RELUME_OK);
    assert_non_null(b.trouble);
    assert_int_equal(b.count, 0);
    assert_true(browse_path(path, &b, ".."));
    assert_string_equal(path, "/nonexistent");
    browse_destroy(&b);
}

static void paths_lead_on(void **state)
{
    static const char *const cases[][3] = {
        {"/a/b", "..", "/a"},        {"/a", "..", "/"},       {"/", "..", "/"},
        {"/a/b", "c d", "/a/b/c d"}, {"/", "c", "/c"},        {"/a", "/x/y", "/x/y"},
        {"/a", "~/y", "/home/me/y"}, {"/a", "~", "/home/me"}, {"/a", "~y", "/a/~y"},
    };
    struct browser b = {.count = 0};
    char path[PATH_MAX], *home = getenv("HOME") ? strdup(getenv("HOME")) : NULL;
    (void)state;
    setenv("HOME", "/home/me", 1);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        snprintf(b.folder, sizeof b.folder, "%s", cases[i][0]);
        assert_true(browse_path(path, &b, cases[i][1]));
        assert_string_equal(path, cases[i][2]);
    }
    static char name[PATH_MAX];
    memset(name, 'x', sizeof name - 1);
    assert_false(browse_path(path, &b, name));
    if (home)
        setenv("HOME", home, 1);
    free(home);
}

// ---------------------------------------------------------------- the window

static struct panel *make_panel(struct app *app, const struct panel_facts *facts)
{
    const struct app_file file = {.width = 960, .height = 600, .views = 1, .empty = true};
    const struct app_state start = {.aperture = 0};
    struct panel *panel;
    assert_int_equal(app_start(app, &file, &start, false, NULL), RELUME_OK);
    app->browse = true;
    assert_int_equal(panel_create(&panel, 1, NULL), RELUME_OK);
    panel_build(panel, app, facts);
    return panel;
}

static void click(struct panel *panel, double x, double y)
{
    (void)panel_takes(panel, &(struct app_event){.kind = APP_MOVE, .x = x, .y = y});
    assert_true(panel_takes(panel, &(struct app_event){.kind = APP_PRESS, .x = x, .y = y}));
    assert_true(panel_takes(panel, &(struct app_event){.kind = APP_RELEASE, .x = x, .y = y}));
}

// Rows of 17 pixels, the first about y = 110: "..", attic, cap, Zoo, A.EXR, b.exr.
static double row(int i)
{
    return 110 + 17 * i;
}

static void clicks_go_into_folders_and_open_files(void **state)
{
    struct browser b = {.count = 0};
    char want[2 * PATH_MAX];
    (void)state;
    assert_int_equal(browse_list(&b, root), RELUME_OK);
    const struct panel_facts facts = {.browser = &b};
    OWNED_APP app;
    struct panel *panel = make_panel(&app, &facts);
    click(panel, 400, row(1));
    panel_build(panel, &app, &facts);
    assert_int_equal(app.action, APP_ACTION_FOLDER);
    snprintf(want, sizeof want, "%s/attic", root);
    assert_string_equal(app.spec, want);
    app.action = APP_ACTION_NONE;
    click(panel, 400, row(5));  // one click chooses, two open
    panel_build(panel, &app, &facts);
    assert_int_equal(app.action, APP_ACTION_NONE);
    click(panel, 400, row(5));
    panel_build(panel, &app, &facts);
    assert_int_equal(app.action, APP_ACTION_OPEN);
    snprintf(want, sizeof want, "%s/b.exr", root);
    assert_string_equal(app.spec, want);
    app.action = APP_ACTION_NONE;
    click(panel, 400, row(2));  // a capture is opened as a file is
    panel_build(panel, &app, &facts);
    assert_int_equal(app.action, APP_ACTION_NONE);
    click(panel, 400, row(2));
    panel_build(panel, &app, &facts);
    assert_int_equal(app.action, APP_ACTION_OPEN);
    panel_destroy(&panel);
    browse_destroy(&b);
}

static void a_path_is_typed_at_once(void **state)
{
    struct browser b = {.count = 0};
    char want[2 * PATH_MAX];
    (void)state;
    assert_int_equal(browse_list(&b, root), RELUME_OK);
    const struct panel_facts facts = {.browser = &b};
    OWNED_APP app;
    struct panel *panel = make_panel(&app, &facts);
    for (const char *c = "c.json"; *c; c++)
        assert_true(panel_takes(panel, &(struct app_event){.kind = APP_TEXT, .key = *c}));
    const struct app_event enter = {.kind = APP_KEY_DOWN, .key = APP_KEY_ENTER};
    assert_true(panel_takes(panel, &enter));
    panel_build(panel, &app, &facts);
    assert_int_equal(app.action, APP_ACTION_OPEN);
    snprintf(want, sizeof want, "%s/c.json", root);
    assert_string_equal(app.spec, want);
    // Esc is the app's, which closes the list, also while the line has the keys
    const struct app_event escape = {.kind = APP_KEY_DOWN, .key = APP_KEY_ESCAPE};
    assert_false(panel_takes(panel, &escape));
    app_handle(&app, &escape);
    assert_false(app.browse || app.quit || app.asks);
    panel_destroy(&panel);
    browse_destroy(&b);
}

static void the_first_page_opens_the_list(void **state)
{
    static const struct panel_facts none = {.file = NULL};
    (void)state;
    OWNED_APP app;
    struct panel *panel = make_panel(&app, &none);
    app.browse = false;
    panel_build(panel, &app, &none);
    assert_true(panel_shown(&app));
    click(panel, 250, 242);  // its button
    panel_build(panel, &app, &none);
    assert_true(app.browse);
    assert_int_equal(app.action, APP_ACTION_FOLDER);
    panel_destroy(&panel);
}

// Without a file only what needs none has a meaning.
static void keys_wait_for_a_file(void **state)
{
    static const struct panel_facts none = {.file = NULL};
    (void)state;
    OWNED_APP app;
    struct panel *panel = make_panel(&app, &none);
    app.browse = false;
    for (int key = ' '; key < 127; key++)
        if (key != '?' && key != '/')
            assert_false(app_handle(&app, &(struct app_event){.kind = APP_KEY_DOWN, .key = key}));
    assert_true(app.action == APP_ACTION_NONE && app.now.lights == 1 && app.now.exposure_ev == 0);
    app_handle(&app, &(struct app_event){.kind = APP_KEY_DOWN, .key = APP_CONTROL | 'o'});
    assert_true(app.browse && app.action == APP_ACTION_FOLDER);
    panel_destroy(&panel);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(folders_come_first_and_only_what_opens),
        cmocka_unit_test(a_folder_that_cannot_be_read_says_why),
        cmocka_unit_test(paths_lead_on),
        cmocka_unit_test(clicks_go_into_folders_and_open_files),
        cmocka_unit_test(a_path_is_typed_at_once),
        cmocka_unit_test(the_first_page_opens_the_list),
        cmocka_unit_test(keys_wait_for_a_file),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
