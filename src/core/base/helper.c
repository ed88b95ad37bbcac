// helper.c - work that may crash: in processes of its own
#include "core/base/helper.h"

#include "core/base/channel.h"
#include "core/base/clock.h"
#include "core/base/inputs.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/module.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

// The program, once it is started; these are under the lock. It ends by itself when nobody asks for
// long.
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static int control = -1;
static pid_t program;

// ---------------------------------------------------------------- patience

// Where processor time is limited (ulimit -t), patience is too.
static double patience_s(double processor_s)
{
    struct rlimit l;
    if (!getrlimit(RLIMIT_CPU, &l) && l.rlim_cur < processor_s)
        processor_s = (double)l.rlim_cur;
    return 10 * processor_s;
}

// By the clock, in steps: time in which this process was stopped counts as one of them.
static bool answer_comes(int channel, double processor_s, double *waited_s)
{
    static const double step_s = 1;
    struct pollfd answer = {.fd = channel, .events = POLLIN};
    while (*waited_s < patience_s(processor_s)) {
        const double start = now_s();
        if (poll(&answer, 1, (int)(1e3 * step_s)) > 0)
            return true;
        const double step = now_s() - start;
        *waited_s += step < step_s ? step : step_s;
    }
    return false;
}

// ---------------------------------------------------------------- the program

// This process' environment, in which libraries of mathematics start no threads.
static char **quiet_environment(void)
{
    static char quiet[][32] = {"OPENBLAS_NUM_THREADS=1", "OMP_NUM_THREADS=1"};
    enum { QUIET = sizeof quiet / sizeof *quiet };
    size_t n = 0;
    while (environ[n])
        n++;
    char **all = mem_array(n + QUIET + 1, sizeof *all);
    if (!all)
        return NULL;
    for (size_t i = 0; i < QUIET; i++)
        all[i] = quiet[i];
    memcpy(all + QUIET, environ, (n + 1) * sizeof *all);
    return all;
}

// Nothing is open there but its channel; what its libraries print is for nobody, unless sanitizers
// have something to say.
static int spawn(const char *path, int end)
{
    posix_spawn_file_actions_t files;
    char *const arguments[] = {(char[]){"relume-helper"}, NULL};
    char **environment = quiet_environment();
    if (!environment)
        return ENOMEM;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, end, HELPER_CHANNEL);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
#if !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
#endif
    const int error = posix_spawn(&program, path, &files, NULL, arguments, environment);
    posix_spawn_file_actions_destroy(&files);
    mem_free(environment);
    return error;
}

static bool start_program(struct helper_reply *reply)
{
    int ends[2];
    char path[PATH_MAX];
    if (!module_program("relume-helper", path)) {
        snprintf(reply->why, HELPER_WHY, "relume-helper is missing beside the library");
        return false;
    }
    reply->error = channel_pair(ends) ? 0 : errno;
    if (!reply->error) {
        reply->error = spawn(path, ends[1]);
        close(ends[1]);
        if (reply->error)
            close(ends[0]);
    }
    if (reply->error)
        snprintf(reply->why, HELPER_WHY, "relume-helper cannot be started; %s",
                 strerror(reply->error));
    else
        control = ends[0];
    return !reply->error;
}

static bool addresses_are_limited(void)
{
    struct rlimit l;
    return !getrlimit(RLIMIT_AS, &l) && l.rlim_cur != RLIM_INFINITY;
}

// Where addresses are limited (ulimit -v), the program or what it loads does not fit, and the
// linker and libraries end it in their own ways.
static void drop_program(struct helper_reply *reply, bool late)
{
    close(control);
    control = -1;
    kill(program, SIGKILL);
    while (waitpid(program, NULL, 0) < 0 && errno == EINTR)
        ;
    snprintf(reply->why, sizeof reply->why, "relume-helper %s",
             late ? "does not answer" : "has ended");
    reply->error = !late && addresses_are_limited() ? ENOMEM : 0;
}

// Asks the program, which is started where there is none, or where it has ended in the meantime.
// Its libraries take a third of a second to load, from a slow disk some more.
static bool ask(struct helper_reply *reply, const struct helper_order *order, int end)
{
    static const double PROCESSOR_S = 6;
    bool late = false;
    *reply = (struct helper_reply){0};
    for (int attempt = 0; attempt < 2 && !late; attempt++) {
        double waited_s = 0;
        if (control < 0 && !start_program(reply))
            return false;
        if (channel_send(control, order, sizeof *order, end) &&
            !(late = !answer_comes(control, PROCESSOR_S, &waited_s)) &&
            channel_receive(control, reply, sizeof *reply, NULL))
            break;
        drop_program(reply, late);
    }
    reply->why[HELPER_WHY - 1] = '\0';
    return control >= 0;
}

static bool ask_in_turn(struct helper_reply *reply, const struct helper_order *order, int end)
{
    pthread_mutex_lock(&lock);
    const bool good = ask(reply, order, end);
    pthread_mutex_unlock(&lock);
    return good;
}

// ---------------------------------------------------------------- processes

struct helper_process {
    struct helper_process *next;
    enum helper_kind kind;
    int jobs;              // these are the table's, under its lock
    struct timespec idle;  // since when it has none
    int channel;
    pid_t id;
    pthread_mutex_t lock;  // one message at a time; what follows is under it
    atomic_bool ended;
    char *blamed, how[HELPER_WHY];  // at which file, and how
};

static pthread_mutex_t table_lock = PTHREAD_MUTEX_INITIALIZER;
static struct helper_process *table;

static struct helper_process *new_process(enum helper_kind kind, struct helper_reply *reply)
{
    const struct helper_order order = {.version = RELUME_VERSION, .kind = kind};
    struct helper_process *p = mem_zeroed(1, sizeof *p);
    int ends[2] = {-1, -1};
    *reply = (struct helper_reply){.error = p ? 0 : ENOMEM};
    if (p && !channel_pair(ends))
        reply->error = errno;
    const bool good = !reply->error && ask_in_turn(reply, &order, ends[1]) && reply->process > 0;
    if (ends[1] >= 0)
        close(ends[1]);
    if (!good) {
        if (ends[0] >= 0)
            close(ends[0]);
        mem_free(p);
        return NULL;
    }
    p->kind = kind;
    p->channel = ends[0];
    p->id = reply->process;
    pthread_mutex_init(&p->lock, NULL);
    return p;
}

static void free_process(struct helper_process *p)
{
    close(p->channel);
    pthread_mutex_destroy(&p->lock);
    mem_free(p->blamed);
    mem_free(p);
}

// One that will not wait much longer for work, or does not any more.
static bool is_stale(const struct helper_process *p)
{
    struct timespec now;
    struct pollfd end = {.fd = p->channel, .events = POLLIN};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return p->jobs == 0 &&
           (now.tv_sec - p->idle.tv_sec >= HELPER_IDLE_S / 2 || poll(&end, 1, 0) != 0);
}

static void drop_stale(void)
{
    for (struct helper_process **at = &table, *p; (p = *at);)
        if (is_stale(p)) {
            *at = p->next;
            free_process(p);
        } else {
            at = &p->next;
        }
}

// How many processes there may be before a second job is given to one.
static int most_processes(enum helper_kind kind)
{
    enum { MOST = 16 };
    const int cpus = relume_cpu_count();
    return kind != HELPER_PICTURE ? INT_MAX : cpus < MOST ? cpus : MOST;
}

// The living one with the fewest jobs; NULL where another one may be made.
static struct helper_process *least_busy(enum helper_kind kind)
{
    const int most = most_processes(kind);
    struct helper_process *least = NULL;
    int count = 0;
    for (struct helper_process *p = table; p; p = p->next)
        if (p->kind == kind && !atomic_load(&p->ended)) {
            count++;
            if (!least || p->jobs < least->jobs)
                least = p;
        }
    return least && (least->jobs == 0 || count >= most) ? least : NULL;
}

static struct helper_process *process_for(enum helper_kind kind, struct helper_reply *reply)
{
    pthread_mutex_lock(&table_lock);
    drop_stale();
    struct helper_process *p = least_busy(kind);
    if (!p && (p = new_process(kind, reply))) {
        p->next = table;
        table = p;
    }
    if (p)
        p->jobs++;
    pthread_mutex_unlock(&table_lock);
    return p;
}

// ---------------------------------------------------------------- jobs

relume_status helper_start(struct helper_job *job, enum helper_kind kind, const char *path,
                           const struct relume_log *log)
{
    static const char *const what[] = {
        [HELPER_PICTURE] = "image formats", [HELPER_MESH] = "models", [HELPER_AV1] = "AV1"};
    struct helper_reply reply;
    *job = (struct helper_job){.path = mem_text(path)};
    if (job->path && (job->process = process_for(kind, &reply)))
        return RELUME_OK;
    const int error = job->path ? reply.error : ENOMEM;
    mem_free(job->path);
    job->path = NULL;
    if (error == ENOMEM || error == EMFILE || error == ENFILE)
        return relume_input_fail(log, path, "cannot be read", error);
    return log_fail(log, RELUME_ESYSTEM, "%s: the module for %s cannot be loaded; %s", path,
                    what[kind], reply.why);
}

// Completes a warning that begins with the coder's name.
static void describe_coder_end(char how[HELPER_WHY], int number, bool late)
{
    if (late)
        snprintf(how, HELPER_WHY, "does not answer");
    else if (number == SIGKILL)
        snprintf(how, HELPER_WHY, "was killed; the machine may be short of memory");
    else
        snprintf(how, HELPER_WHY, "crashed (%s)", number ? strsignal(number) : "no answer");
}

// It has closed its channel, so it ends, or has; or it has not answered and is made to.
static void find_out(struct helper_process *p, const char *path, bool late)
{
    const struct helper_order order = {.version = RELUME_VERSION, .ended = p->id};
    struct helper_reply reply;
    shutdown(p->channel, SHUT_RDWR);
    atomic_store(&p->ended, true);
    p->blamed = mem_text(path);
    const int how = ask_in_turn(&reply, &order, -1) ? reply.how : 0;
    const int number = WIFSIGNALED(how) ? WTERMSIG(how) : 0;
    if (p->kind == HELPER_AV1)
        describe_coder_end(p->how, number, late);
    else if (late)
        snprintf(
            p->how, HELPER_WHY,
            "its reader does not answer; it is damaged, made to keep programs waiting, or on a "
            "disk that does not answer");
    else if (number == SIGXCPU)
        snprintf(p->how, HELPER_WHY,
                 "reading it takes too long; it is damaged, or made to keep machines busy");
    else if (number == SIGKILL)
        snprintf(p->how, HELPER_WHY, "its reader was killed; the machine may be short of memory");
    else
        snprintf(p->how, HELPER_WHY, "its reader crashed (%s); damaged, or made to do harm",
                 number ? strsignal(number) : "no answer");
}

static relume_status ask_process(struct helper_process *p, struct helper_job *job,
                                 const void *message, size_t size, int file, void *answer,
                                 size_t answer_size)
{
    const bool lost = atomic_load(&p->ended);
    bool late = false;
    if (!lost && channel_send(p->channel, message, size, file) &&
        !(late = !answer_comes(p->channel, job->processor_s, &job->waited_s)) &&
        channel_receive(p->channel, answer, answer_size, NULL))
        return RELUME_OK;
    if (!lost)
        find_out(p, job->path, late);
    if (!lost || (p->blamed && !strcmp(p->blamed, job->path)))
        snprintf(job->why, HELPER_WHY, "%s", p->how);
    else
        snprintf(job->why, HELPER_WHY, "was read beside %.200s: %.150s",
                 p->blamed ? p->blamed : "another", p->how);
    return RELUME_EDAMAGED;
}

relume_status helper_ask(struct helper_job *job, const void *message, size_t size, int file,
                         void *answer, size_t answer_size)
{
    struct helper_process *p = job->process;
    if (!p)
        return RELUME_EDAMAGED;
    pthread_mutex_lock(&p->lock);
    const relume_status status = ask_process(p, job, message, size, file, answer, answer_size);
    pthread_mutex_unlock(&p->lock);
    return status;
}

// A model's process, and one that has ended, serve no other job.
void helper_end(struct helper_job *job)
{
    struct helper_process *p = job->process, **at = &table;
    pthread_mutex_lock(&table_lock);
    if (p && --p->jobs == 0) {
        clock_gettime(CLOCK_MONOTONIC, &p->idle);
        while (*at != p)
            at = &(*at)->next;
        if (p->kind == HELPER_MESH || atomic_load(&p->ended)) {
            *at = p->next;
            free_process(p);
        }
    }
    pthread_mutex_unlock(&table_lock);
    mem_free(job->path);
    *job = (struct helper_job){0};
}
