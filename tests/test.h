// test.h - thin helpers over cmocka
#ifndef TEST_H
#define TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <relume/extensions.h>
#define RELUME_VEC3_SHORT
#include <relume/core/vec.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// Prints both values when they differ by more than `tol`; NaN fails.
#define CHECK_NEAR(got, want, tol) check_near((got), (want), (tol), #got, __FILE__, __LINE__)

static inline void check_near(double got, double want, double tol, const char *what,
                              const char *file, int line)
{
    if (fabs(got - want) <= tol)
        return;
    print_error("%s:%d: %s is %.17g, expected %.17g within %g\n", file, line, what, got, want, tol);
    _fail(file, line);
}

// Sanitizers look at accesses, not at sums: under them a test leaves out what would take a minute
// and what other tests reach.
#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
enum { TEST_SANITIZED = true };
#else
enum { TEST_SANITIZED = false };
#endif

#define CHECK_OK(call) assert_int_equal((call), RELUME_OK)

// A log that keeps the last line, to check that a failure says why.
struct test_log {
    struct relume_log log;
    char text[2048];
    int lines;
};

static inline void test_log_keep(void *user, enum relume_level level, const char *text)
{
    struct test_log *t = user;
    (void)level;
    snprintf(t->text, sizeof t->text, "%s", text);
    t->lines++;
}

static inline void test_log_init(struct test_log *t)
{
    *t = (struct test_log){.log = {.message = test_log_keep}};
    t->log.user = t;
}

// A new folder for the files of a test; removed by test_folder_remove.
static inline char *test_folder(char path[64])
{
    snprintf(path, 64, "/tmp/relume-test-XXXXXX");
    assert_non_null(mkdtemp(path));
    return path;
}

static inline void test_folder_remove(const char *path)
{
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", path);
    assert_int_equal(system(command), 0);
}

static inline void test_write(const char *path, const void *bytes, size_t size)
{
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, size, f), size);
    assert_int_equal(fclose(f), 0);
}

// All of a file, to be freed.
static inline void *test_read(const char *path, size_t *size)
{
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    fseek(f, 0, SEEK_END);
    *size = (size_t)ftell(f);
    rewind(f);
    void *bytes = malloc(*size);
    assert_int_equal(fread(bytes, 1, *size, f), *size);
    fclose(f);
    return bytes;
}

// A small generator, so that tests do not depend on the C library's.
static inline uint32_t test_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static inline double test_uniform(uint32_t *state)
{
    return test_random(state) / 16777216.0;
}

static inline struct relume_vec3 test_direction(uint32_t *state)
{
    const double z = 2.0 * test_uniform(state) - 1.0, phi = 6.283185307 * test_uniform(state);
    const double r = sqrt(1.0 - z * z);
    return (struct relume_vec3){r * cos(phi), r * sin(phi), z};
}

#endif
