// bench.h - wall time of a task, several runs, median and spread
#ifndef BENCH_H
#define BENCH_H

#include <relume/relume.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

enum { BENCH_MOST_RUNS = 64 };

struct bench {
    double s[BENCH_MOST_RUNS];
    int runs;
};

static inline double bench_now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static inline void bench_add(struct bench *b, double seconds)
{
    int i = b->runs++;
    for (; i > 0 && b->s[i - 1] > seconds; i--)
        b->s[i] = b->s[i - 1];
    b->s[i] = seconds;
}

static inline double bench_median(const struct bench *b)
{
    return b->s[b->runs / 2];
}

static inline void bench_print(const char *what, const struct bench *b)
{
    printf("  %-44s %8.2f ms  (%.2f to %.2f, %d runs)\n", what, 1e3 * bench_median(b), 1e3 * b->s[0],
           1e3 * b->s[b->runs - 1], b->runs);
}

static inline void bench_check(relume_status status)
{
    if (!status)
        return;
    fprintf(stderr, "bench: %s\n", relume_status_text(status));
    exit(1);
}

static inline long bench_peak_mb(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
}

#endif
