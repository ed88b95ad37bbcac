// thread.h - loops over independent items on several cores
#ifndef BASE_THREAD_H
#define BASE_THREAD_H

#include <relume/base.h>

#include <pthread.h>

// `threads` <= 0 means all cores; never more than 256.
int thread_count(int threads);

// Call body(context, item, worker) once for every item in [0, items), worker in [0, threads).
// Items start in ascending order; which worker takes one is open, so results must not depend on it.
// A machine that starts fewer threads is merely slower.
void thread_for(int threads, size_t items, void (*body)(void *context, size_t item, int worker),
                void *context);

// The same, while a log hears how much of the work is done: from `from` on up to `to`. False where
// it asks to stop: then some items are left out.
struct thread_told {
    const struct relume_log *log;
    const char *what;
    double from, to;
};
bool thread_for_told(int threads, size_t items,
                     void (*body)(void *context, size_t item, int worker), void *context,
                     const struct thread_told *told);

// One piece of work beside the caller's; runs at once where no thread can be had. A zeroed task is
// idle; start only idle tasks.
struct thread_task {
    void (*body)(void *context);
    void *context;
    pthread_t id;
    bool running;
};
void thread_start(struct thread_task *task, void (*body)(void *context), void *context);
void thread_wait(struct thread_task *task);

#endif
