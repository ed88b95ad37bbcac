// thread.c - loops over independent items on several cores
#include "core/base/thread.h"

#include "core/base/log.h"

#include <sched.h>
#include <stdatomic.h>

enum { MAX_THREADS = 256 };

// Our own code needs less than 128 kB (tests/threads/test_stack.c); the rest is for libraries, and
// for sanitizers, whose frames are several times as large.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { STACK = 8 << 20 };
#else
enum { STACK = 1 << 20 };
#endif

static bool start(pthread_t *id, void *(*body)(void *), void *context)
{
    pthread_attr_t attributes;
    if (pthread_attr_init(&attributes))
        return false;
    const bool good = !pthread_attr_setstacksize(&attributes, STACK) &&
                      !pthread_create(id, &attributes, body, context);
    pthread_attr_destroy(&attributes);
    return good;
}

struct loop {
    atomic_size_t next;
    size_t items;
    void (*body)(void *, size_t, int);
    void *context;
    const struct thread_told *told;  // NULL: nobody listens
    atomic_bool stopped;
};

struct worker {
    struct loop *loop;
    int index;
};

int relume_cpu_count(void)
{
    cpu_set_t set;
    const int n = sched_getaffinity(0, sizeof set, &set) ? 1 : CPU_COUNT(&set);
    return n < 1 ? 1 : n;
}

int thread_count(int threads)
{
    const int n = threads > 0 ? threads : relume_cpu_count();
    return n > MAX_THREADS ? MAX_THREADS : n;
}

// In the caller's thread, the first worker, alone.
static bool tell(const struct thread_told *t, size_t item, size_t items)
{
    const double share = ((double)item + 1.0) / (double)items;
    return log_progress(t->log, t->what, t->from + (t->to - t->from) * share);
}

static void *run_worker(void *argument)
{
    const struct worker *w = argument;
    struct loop *loop = w->loop;
    size_t item;
    while (!atomic_load(&loop->stopped) &&
           (item = atomic_fetch_add(&loop->next, 1)) < loop->items) {
        loop->body(loop->context, item, w->index);
        if (loop->told && w->index == 0 && !tell(loop->told, item, loop->items))
            atomic_store(&loop->stopped, true);
    }
    return NULL;
}

bool thread_for_told(int threads, size_t items, void (*body)(void *, size_t, int), void *context,
                     const struct thread_told *told)
{
    struct loop loop = {.items = items, .body = body, .context = context, .told = told};
    struct worker workers[MAX_THREADS];
    pthread_t ids[MAX_THREADS];
    int count = thread_count(threads);
    if ((size_t)count > items)
        count = items ? (int)items : 1;

    int started = 1;
    while (started < count) {
        workers[started] = (struct worker){&loop, started};
        if (!start(&ids[started], run_worker, &workers[started]))
            break;
        started++;
    }
    workers[0] = (struct worker){&loop, 0};
    run_worker(&workers[0]);
    for (int i = 1; i < started; i++)
        pthread_join(ids[i], NULL);
    return !atomic_load(&loop.stopped);
}

void thread_for(int threads, size_t items, void (*body)(void *, size_t, int), void *context)
{
    (void)thread_for_told(threads, items, body, context, NULL);
}

static void *run_task(void *argument)
{
    const struct thread_task *task = argument;
    task->body(task->context);
    return NULL;
}

void thread_start(struct thread_task *task, void (*body)(void *context), void *context)
{
    task->body = body;
    task->context = context;
    task->running = start(&task->id, run_task, task);
    if (!task->running)
        body(context);
}

void thread_wait(struct thread_task *task)
{
    if (task->running)
        pthread_join(task->id, NULL);
    task->running = false;
}
