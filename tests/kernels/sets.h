// sets.h - the instruction sets that this CPU runs, for tests that hold each against plain C
#ifndef SETS_H
#define SETS_H

#include "test.h"

#include "core/kernel/kernels.h"

static const struct kernels *sets[5];  // NULL behind the last; sets[0] is plain C

static inline int find_sets(void **state)
{
    static const unsigned off[] = {~0u, RELUME_CPU_AVX512, 0};
    int n = 0;
    (void)state;
    for (size_t i = 0; i < sizeof off / sizeof *off; i++) {
        const struct kernels *set = kernels_choose(off[i]);
        if (n == 0 || set != sets[n - 1])
            sets[n++] = set;
    }
    for (int i = 0; i < n; i++)
        print_message("set: %s\n", sets[i]->name);
    return 0;
}

#endif
