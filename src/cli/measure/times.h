// times.h - wall times of a task: several runs, their median and spread
#ifndef MEASURE_TIMES_H
#define MEASURE_TIMES_H

#include "core/base/clock.h"

enum { TIMES_MOST = 64 };

struct times {
    double s[TIMES_MOST];  // ascending
    int n;
};

static inline void times_add(struct times *t, double seconds)
{
    int i = t->n++;
    for (; i > 0 && t->s[i - 1] > seconds; i--)
        t->s[i] = t->s[i - 1];
    t->s[i] = seconds;
}

static inline double times_median(const struct times *t)
{
    return t->s[t->n / 2];
}

#endif
