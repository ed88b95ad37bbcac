// loops.h - the hot loops of the library on data made for them, beside what memory and arithmetic
// of the machine allow (the roofline of Williams, Waterman, Patterson 2009)
//
// The data are larger than caches where a user's are. Bytes and operations are the least that a
// loop needs: what is read and written once, multiplications and additions of the sums it is asked
// for.
#ifndef MEASURE_LOOPS_H
#define MEASURE_LOOPS_H

#include "cli/measure/times.h"

#include <relume/base.h>

typedef struct loops loops;

struct hot_loop {
    const char *name, *what;
    double bytes, flops;  // of one run; 0: not counted
    double readme_s;      // what docs/measurements/README.md has; 0: nothing
    relume_status (*run)(loops *l);
};
extern const struct hot_loop hot_loops[];  // ends with a NULL name
// The two roofs, and what is said of others; the rest is in any order.
enum { LOOP_READ, LOOP_ARITHMETIC, LOOP_RELIGHT, LOOP_COPY, LOOP_LOOK_UP };

// Data of all loops. `threads` as everywhere. RELUME_ENOMEM.
relume_status loops_create(loops **out, int threads);
void loops_destroy(loops **l);
// The set of instructions that is chosen here, as RELUME_CPU has it, and the processor's name.
const char *loops_set(void);
void loops_processor(char name[49]);

// The shortest time that the roofs allow a loop; 0: not counted.
double loop_bound_s(const struct hot_loop *loop, double bytes_a_second, double flops_a_second);

#endif
