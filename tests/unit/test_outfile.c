#include "test.h"

#include "base/outfile.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

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

static void expect_content(const char *where, const char *want)
{
    char text[64] = "";
    FILE *f = fopen(where, "rb");
    assert_non_null(f);
    text[fread(text, 1, sizeof text - 1, f)] = '\0';
    fclose(f);
    assert_string_equal(text, want);
}

static void test_whole_or_not_at_all(void **state)
{
    (void)state;
    outfile *f;
    CHECK_OK(outfile_open(&f, path, NULL));
    CHECK_OK(outfile_write(f, "world", 5, 6));
    CHECK_OK(outfile_write(f, "hello ", 6, 0));
    assert_int_not_equal(access(path, F_OK), 0);  // not yet
    CHECK_OK(outfile_commit(&f));
    assert_null(f);
    expect_content(path, "hello world");
    struct stat s;
    const mode_t mask = umask(0);
    umask(mask);
    assert_int_equal(stat(path, &s), 0);
    assert_int_equal(s.st_mode & 0777, 0666 & ~mask);

    CHECK_OK(outfile_open(&f, path, NULL));
    CHECK_OK(outfile_write(f, "new", 3, 0));
    outfile_abort(&f);
    outfile_abort(&f);  // NULL is fine
    expect_content(path, "hello world");
    CHECK_OK(outfile_save(path, "x", 1, NULL));
    expect_content(path, "x");
    assert_int_equal(entries(folder), 1);
    unlink(path);
}

static void test_refusals(void **state)
{
    (void)state;
    outfile *f = (void *)1;
    struct test_log log;
    test_log_init(&log);
    assert_int_equal(outfile_open(&f, folder, &log.log), RELUME_EIO);
    assert_null(f);
    assert_non_null(strstr(log.text, folder));
    assert_int_equal(outfile_save("/nowhere/at/all", "x", 1, &log.log), RELUME_EIO);
    assert_non_null(strstr(log.text, "/nowhere/at/all: cannot be written; No such"));
    if (!access("/dev/full", W_OK)) {
        assert_int_equal(outfile_save("/dev/full", "x", 1, &log.log), RELUME_EIO);
        assert_non_null(strstr(log.text, "/dev/full: writing failed; No space"));
    }
    assert_int_equal(log.lines, access("/dev/full", W_OK) ? 2 : 3);
    CHECK_OK(outfile_save("/dev/null", "x", 1, NULL));
    assert_int_equal(entries(folder), 0);
}

static void test_size_limit(void **state)
{
    (void)state;
    struct rlimit before, limit;
    getrlimit(RLIMIT_FSIZE, &before);
    limit = before;
    limit.rlim_cur = 100;
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &limit);
    const char bytes[200] = "";
    struct test_log log;
    test_log_init(&log);
    const relume_status status = outfile_save(path, bytes, sizeof bytes, &log.log);
    setrlimit(RLIMIT_FSIZE, &before);
    assert_int_equal(status, RELUME_EIO);
    assert_non_null(strstr(log.text, "File too large"));
    assert_int_equal(entries(folder), 0);
}

static void put(const outdir *dir, const char *name)
{
    char where[160];
    snprintf(where, sizeof where, "%s/%s", outdir_path(dir), name);
    test_write(where, name, strlen(name));
}

static void test_folders(void **state)
{
    (void)state;
    outdir *dir;
    char where[160], slash[128];
    struct test_log log;
    test_log_init(&log);
    snprintf(slash, sizeof slash, "%s//", path);
    CHECK_OK(outdir_open(&dir, slash, false, NULL));
    put(dir, "a");
    assert_int_not_equal(access(path, F_OK), 0);
    CHECK_OK(outdir_commit(&dir));
    assert_int_equal(entries(path), 1);

    assert_int_equal(outdir_open(&dir, path, false, &log.log), RELUME_EINVAL);
    assert_null(dir);
    assert_non_null(strstr(log.text, "--force"));
    CHECK_OK(outdir_open(&dir, path, true, NULL));
    put(dir, "b");
    outdir_abort(&dir);
    snprintf(where, sizeof where, "%s/a", path);
    expect_content(where, "a");
    CHECK_OK(outdir_open(&dir, path, true, NULL));
    put(dir, "b");
    CHECK_OK(outdir_commit(&dir));
    assert_int_not_equal(access(where, F_OK), 0);
    snprintf(where, sizeof where, "%s/b", path);
    expect_content(where, "b");

    unlink(where);  // an empty folder may be filled
    CHECK_OK(outdir_open(&dir, path, false, NULL));
    put(dir, "c");
    CHECK_OK(outdir_commit(&dir));
    assert_int_equal(entries(path), 1);
    assert_int_equal(entries(folder), 1);
    assert_int_equal(outdir_open(&dir, "/nowhere/at/all", false, &log.log), RELUME_EIO);
}

static void test_scratch(void **state)
{
    (void)state;
    char near[128], back[4];
    snprintf(near, sizeof near, "%s/x", folder);
    const int before = entries(folder), fd = scratch_open(near);
    assert_true(fd >= 0);
    assert_int_equal(entries(folder), before);  // it has no name
    assert_true(scratch_write(fd, "abcd", 4, 1000));
    assert_true(scratch_read(fd, back, 4, 1000));
    assert_memory_equal(back, "abcd", 4);
    assert_false(scratch_read(fd, back, 4, 1002));  // beyond the end
    close(fd);
    assert_true(scratch_open("/nowhere/at/all") < 0);
    assert_int_equal(errno, ENOENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_whole_or_not_at_all),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_size_limit),
        cmocka_unit_test(test_scratch),
        cmocka_unit_test(test_folders),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
