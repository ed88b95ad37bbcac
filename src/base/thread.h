// thread.h - loops over independent items on several cores
#ifndef BASE_THREAD_H
#define BASE_THREAD_H

#include <relume/base.h>

// `threads` <= 0 means all cores; never more than 256.
int thread_count(int threads);

// Call body(context, item, worker) once for every item in [0, items), worker in [0, threads).
// Items start in ascending order; which worker takes one is open, so results must not depend on it.
// A machine that starts fewer threads is merely slower.
void thread_for(int threads, size_t items, void (*body)(void *context, size_t item, int worker),
                void *context);

#endif
