// bench.h - wall time of a task, several runs, median and spread
#ifndef BENCH_H
#define BENCH_H

#include "cli/measure/times.h"

#include <relume/extensions.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

static inline void bench_print(const char *what, const struct times *b)
{
    printf("  %-44s %8.2f ms  (%.2f to %.2f, %d runs)\n", what, 1e3 * times_median(b),
           1e3 * b->s[0], 1e3 * b->s[b->n - 1], b->n);
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
