// test_outfile.c - tests of src/core/base/outfile.h: files that appear whole or not at all
#include "test.h"

#include "core/base/infile.h"
#include "core/base/outfile.h"
#include "core/base/scratch.h"

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

static void print_number(const void *context, FILE *to)
{
    fprintf(to, "%d\n", *(const int *)context);
}

static void test_whole_or_not_at_all(void **state)
{
    (void)state;
    outfile *f;
    CHECK_OK(outfile_open(&f, path, NULL, NULL));
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

    CHECK_OK(outfile_open(&f, path, NULL, NULL));
    CHECK_OK(outfile_write(f, "new", 3, 0));
    outfile_abort(&f);
    outfile_abort(&f);  // NULL is fine
    expect_content(path, "hello world");
    CHECK_OK(outfile_save(path, "x", 1, NULL));
    expect_content(path, "x");
    CHECK_OK(relume_file_print(path, print_number, &(const int){42}, NULL));
    expect_content(path, "42\n");
    assert_int_equal(entries(folder), 1);
    unlink(path);
    assert_int_equal(relume_file_print("/nowhere/at/all", print_number, &(const int){1}, NULL),
                     RELUME_EIO);
}

static void test_refusals(void **state)
{
    (void)state;
    outfile *f = (void *)1;
    struct test_log log;
    test_log_init(&log);
    assert_int_equal(outfile_open(&f, folder, NULL, &log.log), RELUME_EIO);
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

static void test_replaces(void **state)
{
    (void)state;
    char link[128], name[320];
    struct stat s;
    struct test_log log;
    test_log_init(&log);
    test_write(path, "old", 3);
    chmod(path, 0640);
    snprintf(link, sizeof link, "%s/link", folder);
    assert_int_equal(symlink("out", link), 0);
    CHECK_OK(outfile_save(link, "new", 3, NULL));  // a link stays one
    expect_content(path, "new");
    assert_int_equal(lstat(link, &s), 0);
    assert_true(S_ISLNK(s.st_mode));
    assert_int_equal(stat(path, &s), 0);
    assert_int_equal(s.st_mode & 0777, 0640);
    unlink(path);
    CHECK_OK(outfile_save(link, "there", 5, NULL));  // and one that led nowhere
    expect_content(path, "there");
    unlink(link);
    assert_int_equal(symlink("link", link), 0);
    assert_int_equal(outfile_save(link, "x", 1, &log.log), RELUME_EIO);
    assert_non_null(strstr(log.text, "link: cannot be written; Too many levels"));
    unlink(link);
    unlink(path);

    snprintf(name, sizeof name, "%s/%0255d", folder, 0);  // as long as a name may be
    CHECK_OK(outfile_save(name, "a", 1, NULL));
    CHECK_OK(outfile_save(name, "b", 1, NULL));
    expect_content(name, "b");
    unlink(name);
    assert_int_equal(entries(folder), 0);
}

static void test_inputs(void **state)
{
    (void)state;
    relume_context *context;
    char hard[128];
    struct test_log log;
    test_log_init(&log);
    CHECK_OK(relume_context_create(&context, relume_context_params(.keep_inputs = true)));
    log.log.context = context;
    test_write(path, "photo", 5);
    snprintf(hard, sizeof hard, "%s/hard", folder);
    assert_int_equal(link(path, hard), 0);
    outfile *f;
    CHECK_OK(outfile_open(&f, hard, NULL, &log.log));
    CHECK_OK(outfile_write(f, "x", 1, 0));
    fclose(input_open(path, &log.log));  // met after the output was opened
    assert_int_equal(outfile_commit(&f), RELUME_EINVAL);
    assert_non_null(strstr(log.text, "hard: is read here"));
    assert_int_equal(outfile_open(&f, path, NULL, &log.log), RELUME_EINVAL);
    assert_int_equal(relume_file_check(hard, &log.log), RELUME_EINVAL);
    assert_int_equal(relume_file_check(folder, &log.log), RELUME_EIO);
    char nowhere[128];
    snprintf(nowhere, sizeof nowhere, "%s/new", folder);
    CHECK_OK(relume_file_check(nowhere, &log.log));
    CHECK_OK(relume_file_check("new", &log.log));
    snprintf(nowhere, sizeof nowhere, "%s/no/new", folder);
    assert_int_equal(relume_file_check(nowhere, &log.log), RELUME_EIO);
    assert_non_null(strstr(log.text, "/no: make it first"));
    expect_content(path, "photo");
    for (int i = 0; i < 1000; i++) {  // more than the table begins with
        char many[128];
        snprintf(many, sizeof many, "%s/%d", folder, i);
        test_write(many, "", 0);
        relume_context_note(context, many);
        assert_int_equal(relume_file_check(many, &log.log), RELUME_EINVAL);
        assert_int_equal(relume_file_check(path, &log.log), RELUME_EINVAL);
    }
    for (int i = 0; i < 1000; i++) {
        char many[128];
        snprintf(many, sizeof many, "%s/%d", folder, i);
        unlink(many);
    }
    unlink(path);
    unlink(hard);
    assert_int_equal(entries(folder), 0);
    relume_context_destroy(&context);  // numbers of files that were removed come back
    CHECK_OK(relume_context_create(&context, relume_context_params(.keep_inputs = true)));
    log.log.context = context;
    log.log.leave_unnoted = true;
    test_write(path, "photo", 5);
    fclose(input_open(path, &log.log));
    CHECK_OK(relume_file_check(path, &log.log));
    unlink(path);
    relume_context_destroy(&context);
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
        cmocka_unit_test(test_replaces),
        cmocka_unit_test(test_inputs),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
