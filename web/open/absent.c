// absent.c - what the reader of dropped files has in place of what only encoding needs, and of
// processors to choose among
#include "core/math/lsq.h"
#include "format/coder/pca.h"
#include "format/lossy/av1.h"

#include <sched.h>

relume_status components_find(struct components *out, const relume_coder *coder)
{
    (void)coder;
    *out = (struct components){0};
    return RELUME_EUNFIT;
}

void components_destroy(struct components *c)
{
    (void)c;
}

bool lsq_eigenvectors(double *matrix, int n, int count, double *values, double *vectors)
{
    (void)matrix, (void)n, (void)count, (void)values, (void)vectors;
    return false;
}

// ---------------------------------------------------------------- one processor

int sched_getaffinity(pid_t process, size_t size, cpu_set_t *set)
{
    (void)process, (void)size, (void)set;
    return -1;
}

int __sched_cpucount(size_t size, const cpu_set_t *set)
{
    (void)size, (void)set;
    return 1;
}
