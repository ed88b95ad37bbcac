// test_outdir.c - tests of src/core/base/outdir.h: folders, and files that others write, that
// appear whole or not at all
#include "test.h"

#include "core/base/beside.h"
#include "core/base/inventory.h"
#include "core/base/outdir.h"

#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

static char folder[64], path[96];

static int setup(void **state)
{
    (void)state;
    test_folder(folder);
    snprintf(path, sizeof path, "%s/out", folder);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

static int entries(const char *where)
{
    int n = -2;
    DIR *dir = opendir(where);
    assert_non_null(dir);
    while (readdir(dir))
        n++;
    closedir(dir);
    return n;
}

static bool has(const char *name)
{
    char where[400];
    snprintf(where, sizeof where, "%s/%s", path, name);
    return !access(where, F_OK);
}

static void put(const outdir *dir, const char *name)
{
    char where[160];
    snprintf(where, sizeof where, "%s/%s", outdir_path(dir), name);
    test_write(where, name, strlen(name));
}

static void make(const char *name, bool force)
{
    outdir *dir;
    CHECK_OK(outdir_open(&dir, path, force, NULL));
    put(dir, name);
    CHECK_OK(outdir_commit(&dir));
}

static void write_in(const char *name, const char *text)
{
    char where[400];
    snprintf(where, sizeof where, "%s/%s", path, name);
    test_write(where, text, strlen(text));
}

static void test_whole_or_not_at_all(void **state)
{
    (void)state;
    outdir *dir;
    char slash[128];
    struct test_log log;
    test_log_init(&log);
    snprintf(slash, sizeof slash, "%s//", path);
    CHECK_OK(outdir_open(&dir, slash, false, NULL));
    put(dir, "a");
    assert_false(has("a"));
    CHECK_OK(outdir_commit(&dir));
    assert_true(has("a") && has(".relume"));

    assert_int_equal(outdir_open(&dir, path, false, &log.log), RELUME_EINVAL);
    assert_null(dir);
    assert_non_null(strstr(log.text, "--force"));
    CHECK_OK(outdir_open(&dir, path, true, NULL));
    put(dir, "b");
    outdir_abort(&dir);
    assert_true(has("a"));
    make("b", true);
    assert_true(has("b") && !has("a"));

    char where[160];
    snprintf(where, sizeof where, "%s/b", path);
    unlink(where);  // an empty folder may be filled
    make("c", false);
    assert_int_equal(entries(path), 2);
    assert_int_equal(entries(folder), 1);
    assert_int_equal(outdir_open(&dir, "/nowhere/at/all", false, &log.log), RELUME_EIO);
    test_folder_remove(path);
}

static void expect_refused(const char *pattern)
{
    outdir *dir;
    struct test_log log;
    test_log_init(&log);
    assert_int_equal(outdir_open(&dir, path, true, &log.log), RELUME_EINVAL);
    if (!strstr(log.text, pattern))
        fail_msg("expected '%s'; found '%s'", pattern, log.text);
    assert_int_equal(log.lines, 1);
    assert_int_equal(entries(folder), 1);
}

static void test_never_removes_others(void **state)
{
    (void)state;
    outdir *dir;
    mkdir(path, 0777);
    write_in("photo.jpg", "mine");
    expect_refused("not made by relume");
    write_in(".relume", "relume made this folder, 1\n");
    expect_refused("holds photo.jpg");
    write_in(".relume", "relume made this folder, 1\n5 photo.jpg\n");
    expect_refused("photo.jpg was changed");
    test_folder_remove(path);

    make("a", false);
    CHECK_OK(outdir_open(&dir, path, true, NULL));
    put(dir, "b");
    write_in("notes", "added meanwhile");
    assert_int_equal(outdir_commit(&dir), RELUME_EINVAL);
    assert_true(has("a") && has("notes") && !has("b"));
    test_folder_remove(path);

    // Links that were made with it are listed, and go without what they lead to
    char target[80], name[128];
    outdir *linked;
    snprintf(target, sizeof target, "%s/target", folder);
    test_write(target, "mine", 4);
    for (int i = 0; i < 2; i++) {
        CHECK_OK(outdir_open(&linked, path, i > 0, NULL));
        put(linked, "a");
        snprintf(name, sizeof name, "%s/link", outdir_path(linked));
        assert_int_equal(symlink(i ? "../target" : "nowhere", name), 0);
        CHECK_OK(outdir_commit(&linked));
        assert_int_equal(entries(path), 3);
    }
    make("b", true);
    assert_true(has("b") && !has("link"));
    assert_int_equal(access(target, F_OK), 0);
    unlink(target);
    test_folder_remove(path);

    // A list that names what lies behind a link
    char other[80], photo[100], link[128];
    snprintf(other, sizeof other, "%s/other", folder);
    snprintf(photo, sizeof photo, "%s/photo", other);
    snprintf(link, sizeof link, "%s/link", path);
    mkdir(other, 0777);
    test_write(photo, "mine", 4);
    mkdir(path, 0777);
    assert_int_equal(symlink(other, link), 0);
    write_in(".relume", "relume made this folder, 1\n-1 link\n4 link/photo\n");
    assert_int_equal(outdir_open(&dir, path, true, NULL), RELUME_EINVAL);
    inventory_remove(path, folder, NULL);  // without the check: what is not listed is set apart
    assert_int_equal(access(photo, F_OK), 0);
    assert_false(has("link"));
    assert_int_equal(entries(folder), 2);
    char command[160];
    snprintf(command, sizeof command, "rm -r %s/kept-by-relume-*", folder);
    assert_int_equal(system(command), 0);
    mkdir(path, 0777);
    test_folder_remove(other);
    test_folder_remove(path);
    assert_int_equal(entries(folder), 0);
}

static void expect_kept(const struct test_log *log, const char *name, const char *why)
{
    char where[100], entry[160];
    const char *colon = strstr(log->text, ": this old folder could not be removed");
    assert_int_equal(log->lines, 1);
    if (!colon || !strstr(log->text, why))
        fail_msg("expected where it is kept, and '%s'; found '%s'", why, log->text);
    snprintf(where, sizeof where, "%.*s", (int)(colon - log->text), log->text);
    snprintf(entry, sizeof entry, "%s/%s", where, name);
    assert_int_equal(access(entry, F_OK), 0);
    test_folder_remove(where);
    assert_int_equal(entries(folder), 0);
}

// An old folder that cannot be removed stays, and a line says where.
static void test_kept(void **state)
{
    (void)state;
    struct test_log log;
    struct rlimit files, none;
    test_log_init(&log);
    make("a", false);
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &files), 0);
    none = files;
    none.rlim_cur = 0;  // its list cannot be opened
    setrlimit(RLIMIT_NOFILE, &none);
    inventory_remove(path, folder, &log.log);
    setrlimit(RLIMIT_NOFILE, &files);
    expect_kept(&log, "a", strerror(EMFILE));

    outdir *dir;
    char old[160], name[200];
    test_log_init(&log);
    CHECK_OK(outdir_open(&dir, path, false, &log.log));
    snprintf(old, sizeof old, "%.*sold", (int)(strlen(outdir_path(dir)) - 3), outdir_path(dir));
    make("a", false);
    write_in("notes", "mine");
    assert_int_equal(rename(path, old), 0);
    snprintf(name, sizeof name, "%s/a", old);
    outdir_abort(&dir);
    assert_int_not_equal(access(name, F_OK), 0);
    expect_kept(&log, "notes", "what was not made with it");
}

// Two that began when there was nothing: both are whole, the last has the name.
static void test_two_writers(void **state)
{
    (void)state;
    outdir *one, *two;
    struct test_log log;
    test_log_init(&log);
    CHECK_OK(outdir_open(&one, path, false, NULL));
    CHECK_OK(outdir_open(&two, path, false, &log.log));
    assert_string_not_equal(outdir_path(one), outdir_path(two));
    put(one, "one");
    put(two, "two");
    CHECK_OK(outdir_commit(&one));
    assert_true(has("one"));
    CHECK_OK(outdir_commit(&two));
    assert_true(has("two") && !has("one"));
    assert_non_null(strstr(log.text, "another run made this folder meanwhile"));
    assert_int_equal(entries(folder), 1);
    test_folder_remove(path);
}

// What a killed process left goes with the next output, what a living one has stays.
static void test_litter(void **state)
{
    (void)state;
    outdir *living, *dir;
    const pid_t child = fork();
    if (child == 0) {
        if (outdir_open(&dir, path, false, NULL))
            _exit(1);
        put(dir, "half");
        raise(SIGKILL);
    }
    int ended;
    assert_int_equal(waitpid(child, &ended, 0), child);
    assert_true(WIFSIGNALED(ended));
    assert_int_equal(entries(folder), 1);
    char mine[100], empty[100];
    snprintf(mine, sizeof mine, "%s/.relume-mine", folder);  // not such a name
    snprintf(empty, sizeof empty, "%s/.relume-0123456789ab", folder);
    mkdir(mine, 0777);
    mkdir(empty, 0777);
    CHECK_OK(outdir_open(&living, path, false, NULL));
    assert_int_equal(entries(folder), 2);
    CHECK_OK(outdir_open(&dir, path, false, NULL));
    assert_int_equal(access(outdir_path(living), F_OK), 0);
    outdir_abort(&dir);
    outdir_abort(&living);
    assert_int_equal(entries(folder), 1);
    rmdir(mine);

    // A folder of such a name that somebody else filled
    char inner[120];
    mkdir(empty, 0777);
    snprintf(inner, sizeof inner, "%s/lock", empty);
    test_write(inner, "mine", 4);
    make("a", false);
    assert_int_equal(access(inner, F_OK), 0);
    test_folder_remove(empty);
    test_folder_remove(path);
    assert_int_equal(entries(folder), 0);
}

// Without an exchange of names the old folder has none for a moment; stopped there, it gets it
// back.
static void test_put_back(void **state)
{
    (void)state;
    char own[128], lock[160], old[160];
    make("precious", false);
    snprintf(own, sizeof own, "%s/.relume-0123456789ab", folder);
    snprintf(lock, sizeof lock, "%s/lock", own);
    snprintf(old, sizeof old, "%s/old", own);
    mkdir(own, 0700);
    test_write(lock, "relume, unfinished, 1\nout", 25);
    assert_int_equal(rename(path, old), 0);
    beside_sweep(folder, NULL);
    assert_true(has("precious"));
    assert_int_equal(entries(folder), 1);
    test_folder_remove(path);
}

static void test_longest_name(void **state)
{
    (void)state;
    snprintf(path, sizeof path, "%s/out", folder);
    char name[320];
    snprintf(name, sizeof name, "%s/%0255d", folder, 0);
    outdir *dir;
    for (int i = 0; i < 2; i++) {
        CHECK_OK(outdir_open(&dir, name, i > 0, NULL));
        put(dir, "a");
        CHECK_OK(outdir_commit(&dir));
    }
    assert_int_equal(entries(name), 2);
    assert_int_equal(entries(folder), 1);
}

static void test_temporary(void **state)
{
    (void)state;
    relume_making *m;
    const char *before = getenv("TMPDIR");
    char kept[512];
    snprintf(kept, sizeof kept, "%s", before ? before : "");
    setenv("TMPDIR", folder, 1);
    const int there = entries(folder);
    CHECK_OK(relume_making_open(&m, NULL, RELUME_MADE_FOLDER, false, NULL));
    assert_int_equal(strncmp(relume_making_path(m), folder, strlen(folder)), 0);
    put(m, "x");
    relume_making_abort(&m);
    assert_int_equal(entries(folder), there);
    if (*kept)
        setenv("TMPDIR", kept, 1);
    else
        unsetenv("TMPDIR");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_whole_or_not_at_all),
        cmocka_unit_test(test_never_removes_others),
        cmocka_unit_test(test_kept),
        cmocka_unit_test(test_two_writers),
        cmocka_unit_test(test_litter),
        cmocka_unit_test(test_put_back),
        cmocka_unit_test(test_longest_name),
        cmocka_unit_test(test_temporary),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
